//! Evenly spaced values, each the double nearest to the exact decimal number.

use dashu_int::IBig;
use dashu_int::UBig;
use dashu_int::ops::Gcd;
use dashu_ratio::RBig;
use std::fmt;

/// The most digits, and the largest power of ten, of a bound: those of doubles, with a margin.
const MOST_DIGITS: usize = 400;

/// Doubles hold all whole numbers up to this one.
const EXACT: i64 = 1 << 53;

/// `n` values from a first to a last one, both included.
///
/// They are computed as fractions of the decimal texts and rounded once, so there is no sum whose
/// errors would show as 0.30000000000000004.
///
/// ```
/// use snapload_study::Grid;
/// let grid = Grid::new("0.01", "0.6", 60).unwrap();
/// assert_eq!((grid.value(2), grid.value(56)), (0.03, 0.57));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    text: String,
    first: RBig,
    span: RBig,
    /// Numerators of both and their common denominator, where doubles hold them.
    small: Option<[i64; 3]>,
    count: u64,
}

impl Grid {
    /// A grid from two decimal numbers and the number of values, at least one; none if a text is
    /// not a number.
    pub fn new(first: &str, last: &str, count: u64) -> Option<Self> {
        let (first, last) = (first.trim(), last.trim());
        let from = decimal(first)?;
        let span = decimal(last)? - from.clone();
        let intervals = count.checked_sub(1)?.max(1);
        let span = span / RBig::from(intervals);
        Some(Self {
            text: format!("{first}:{last}:{count}"),
            small: over_one_denominator(&from, &span),
            first: from,
            span,
            count,
        })
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The k-th value, from 0.
    pub fn value(&self, k: u64) -> f64 {
        if let Some([first, span, denominator]) = self.small {
            let numerator = i128::from(first) + i128::from(span) * i128::from(k);
            if numerator.abs() <= EXACT.into() {
                // Both are doubles, and their quotient is rounded once.
                return numerator as f64 / denominator as f64;
            }
        }
        let exact = &self.first + &self.span * RBig::from(k);
        exact.to_f64().value()
    }
}

impl fmt::Display for Grid {
    /// In its notation, `first:last:n`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The numerators of two fractions and their common denominator, if doubles hold all three.
fn over_one_denominator(one: &RBig, other: &RBig) -> Option<[i64; 3]> {
    let (a, b) = (one.denominator(), other.denominator());
    let common = a * b / a.gcd(b);
    let of = |number: &RBig| number.numerator() * (&common / number.denominator());
    let small = |number: IBig| {
        let number = i64::try_from(number).ok()?;
        (number.abs() <= EXACT).then_some(number)
    };
    Some([
        small(of(one))?,
        small(of(other))?,
        small(common.clone().into())?,
    ])
}

/// A decimal number, exactly.
fn decimal(text: &str) -> Option<RBig> {
    // Texts that are not the decimal of a finite double are refused: `inf`, `1e999`, `0x10`, the
    // empty text.
    text.parse::<f64>()
        .ok()
        .filter(|number| number.is_finite())?;
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let exponent = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?;
    let size = usize::try_from(exponent.unsigned_abs()).ok()?;
    if digits.len() > MOST_DIGITS || size > MOST_DIGITS {
        return None;
    }
    let digits: IBig = digits.parse().ok()?;
    let power = UBig::from(10_u8).pow(size);
    Some(if exponent < 0 {
        RBig::from_parts(digits, power)
    } else {
        RBig::from(digits * IBig::from(power))
    })
}
