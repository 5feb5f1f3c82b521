//! The range of an axis, and the ticks on it.

use crate::plot::{Range, TickStyle, drawable};
use std::f64::consts::FRAC_PI_4;

/// An interval shown by an axis; the first number is the smaller.
pub(crate) type Span = (f64, f64);

/// The interval that `range` asks for, given the values of the data.
pub(crate) fn resolve(range: Range, data: impl Iterator<Item = f64>) -> Span {
    if let Range::Fixed(a, b) = range
        && let Some(span) = ordered(a, b).filter(|&span| !thin(span))
    {
        return span;
    }
    let asked = match range {
        Range::AtLeast(a, b) => ordered(a, b),
        Range::Auto | Range::Fixed(..) => None,
    };
    match (data.map(|v| (v, v)).reduce(union).map(with_air), asked) {
        (Some(seen), Some(asked)) => union(seen, asked),
        (Some(seen), None) => seen,
        (None, asked) => asked.filter(|&span| !thin(span)).unwrap_or((0.0, 1.0)),
    }
}

/// The smallest interval that holds both.
pub(crate) fn union(a: Span, b: Span) -> Span {
    (a.0.min(b.0), a.1.max(b.1))
}

fn ordered(a: f64, b: f64) -> Option<Span> {
    drawable(&[a, b]).then(|| (a.min(b), a.max(b)))
}

/// Whether an interval is too short, for its place or at all, to put ticks on it.
fn thin((lo, hi): Span) -> bool {
    hi - lo <= 1e-10 * lo.abs().max(hi.abs()) || hi - lo < 1e-100
}

/// The interval of the data with a little air at its ends, which does not reach across zero.
fn with_air((lo, hi): Span) -> Span {
    if thin((lo, hi)) {
        let middle = lo + (hi - lo) / 2.0;
        let half = if middle.abs() < 1e-100 {
            1.0
        } else {
            0.1 * middle.abs()
        };
        return (middle - half, middle + half);
    }
    let air = 0.04 * (hi - lo);
    let lower = if lo >= 0.0 {
        (lo - air).max(0.0)
    } else {
        lo - air
    };
    let upper = if hi <= 0.0 {
        (hi + air).min(0.0)
    } else {
        hi + air
    };
    (lower, upper)
}

/// The ticks on an axis and what is written at them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// Each tick's place and text.
    pub(crate) at: Vec<(f64, String)>,
    /// A power of ten that multiplies all the texts, such as "×10⁻¹²"; empty for one.
    pub(crate) factor: String,
}

/// Three to nine ticks on the interval.
pub(crate) fn ticks(style: TickStyle, span: Span) -> Ticks {
    // A multiple of π with many digits says less than a power of ten.
    let few_turns = span.0.abs().max(span.1.abs()) < 1e4;
    if style == TickStyle::Angle && few_turns && span.1 - span.0 >= 3.0 * FRAC_PI_4 {
        angle_ticks(span)
    } else {
        decimal_ticks(span)
    }
}

/// Ticks at the largest step of 1, 2 or 5 times a power of ten that puts three on the interval.
fn decimal_ticks((lo, hi): Span) -> Ticks {
    let (mantissa, exponent) = step_of((hi - lo) / 3.0);
    // Whole multiples of the step, so that a tick is exact and prints without 0.30000000000000004.
    let step = scaled(mantissa, exponent);
    let slack = 1e-9 * (hi - lo) / step;
    let first = (lo / step - slack).ceil() as i64;
    let last = (hi / step + slack).floor() as i64;

    let largest = lo.abs().max(hi.abs());
    let power = if (1e-3..1e5).contains(&largest) {
        0
    } else {
        largest.log10().floor() as i32
    };
    let at = (first..=last)
        .map(|k| {
            let digits = k.saturating_mul(mantissa);
            (scaled(digits, exponent), decimal(digits, exponent - power))
        })
        .collect();
    let factor = if power == 0 {
        String::new()
    } else {
        format!("×10{}", superscript(power))
    };
    Ticks { at, factor }
}

/// The largest `(m, e)` with `m` one of 1, 2, 5 and `m × 10^e` not above `bound`.
fn step_of(bound: f64) -> (i64, i32) {
    let guess = bound.log10().floor() as i32;
    let bound = bound * (1.0 + 1e-9);
    // The logarithm may be off by one at a power of ten.
    [(guess + 1, 1), (guess, 5), (guess, 2), (guess, 1)]
        .into_iter()
        .find(|&(e, m)| scaled(m, e) <= bound)
        .map_or((5, guess - 1), |(e, m)| (m, e))
}

/// `digits × 10^exponent`, rounded once where the power is exact.
fn scaled(digits: i64, exponent: i32) -> f64 {
    let power = 10_f64.powi(exponent.abs());
    if exponent < 0 {
        digits as f64 / power
    } else {
        digits as f64 * power
    }
}

/// `digits × 10^exponent` in plain decimals, with a true minus sign.
fn decimal(digits: i64, exponent: i32) -> String {
    let sign = if digits < 0 { "−" } else { "" };
    let whole = digits.unsigned_abs().to_string();
    if exponent >= 0 {
        let zeros = if digits == 0 { 0 } else { exponent as usize };
        return format!("{sign}{whole}{}", "0".repeat(zeros));
    }
    let places = exponent.unsigned_abs() as usize;
    let padded = format!("{whole:0>width$}", width = places + 1);
    let (units, fraction) = padded.split_at(padded.len() - places);
    format!("{sign}{units}.{fraction}")
}

fn superscript(n: i32) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            _ => '⁰',
        })
        .collect()
}

/// Ticks at multiples of π/4, π/2 or a round number of π.
fn angle_ticks((lo, hi): Span) -> Ticks {
    let third = (hi - lo) / 3.0 / FRAC_PI_4;
    // The step in quarters of π.
    let quarters = if third < 2.0 {
        1
    } else if third < 4.0 {
        2
    } else {
        let (mantissa, exponent) = step_of(third / 4.0);
        (4.0 * scaled(mantissa, exponent)) as i64
    };
    let step = quarters as f64 * FRAC_PI_4;
    let (first, last) = ((lo / step).ceil() as i64, (hi / step).floor() as i64);
    let at = (first..=last)
        .map(|k| (k as f64 * step, angle(k.saturating_mul(quarters))))
        .collect();
    Ticks {
        at,
        factor: String::new(),
    }
}

/// `quarters × π/4`, as a fraction in lowest terms.
fn angle(quarters: i64) -> String {
    let sign = if quarters < 0 { "−" } else { "" };
    let n = quarters.unsigned_abs();
    let (top, bottom) = match n {
        0 => return "0".to_string(),
        n if n % 4 == 0 => (n / 4, ""),
        n if n % 2 == 0 => (n / 2, "/2"),
        n => (n, "/4"),
    };
    let top = if top == 1 {
        String::new()
    } else {
        top.to_string()
    };
    format!("{sign}{top}π{bottom}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(style: TickStyle, span: Span) -> Vec<String> {
        ticks(style, span)
            .at
            .into_iter()
            .map(|(_, text)| text)
            .collect()
    }

    #[test]
    fn ticks_are_written_as_a_reader_would() {
        use TickStyle::{Angle, Decimal};
        assert_eq!(texts(Decimal, (0.0, 0.65)), ["0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(
            texts(Decimal, (-1.0, 1.0)),
            ["−1.0", "−0.5", "0.0", "0.5", "1.0"]
        );
        assert_eq!(texts(Decimal, (0.0, 30.0)), ["0", "10", "20", "30"]);
        assert_eq!(
            texts(Angle, (-1.7, 1.7)),
            ["−π/2", "−π/4", "0", "π/4", "π/2"]
        );
        assert_eq!(texts(Angle, (0.0, 10.0)), ["0", "π", "2π", "3π"]);
        assert_eq!(texts(Angle, (0.0, 0.3)), ["0.0", "0.1", "0.2", "0.3"]);
    }

    #[test]
    fn large_and_small_numbers_share_a_power_of_ten() {
        let small = ticks(TickStyle::Decimal, (0.0, 3.0e-12));
        assert_eq!(small.factor, "×10⁻¹²");
        let words: Vec<_> = small.at.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(words, ["0", "1", "2", "3"]);
        assert_eq!(ticks(TickStyle::Decimal, (0.0, 3.0e6)).factor, "×10⁶");
        assert_eq!(ticks(TickStyle::Decimal, (0.0, 300.0)).factor, "");
    }

    #[test]
    fn a_range_is_never_empty() {
        assert_eq!(resolve(Range::Auto, std::iter::empty()), (0.0, 1.0));
        assert_eq!(
            resolve(Range::Fixed(1.0, 1.0), [2.0].into_iter()),
            (1.8, 2.2)
        );
        assert_eq!(
            resolve(Range::AtLeast(0.0, 0.0), std::iter::empty()),
            (0.0, 1.0)
        );
        assert_eq!(
            resolve(Range::AtLeast(0.0, 0.0), [0.0, 1.0].into_iter()),
            (0.0, 1.04)
        );
        assert_eq!(
            resolve(Range::AtLeast(-1.0, 3.0), [2.0].into_iter()),
            (-1.0, 3.0)
        );
    }

    proptest! {
        #[test]
        fn ticks_cover_the_range_in_steps_of_one_two_five(
            middle in -1.0e3..1.0e3_f64, size in -12.0..8.0_f64, angle in any::<bool>(),
        ) {
            let half = 10_f64.powf(size);
            let span = resolve(Range::Fixed(middle - half, middle + half), std::iter::empty());
            let style = if angle { TickStyle::Angle } else { TickStyle::Decimal };
            let at: Vec<f64> = ticks(style, span).at.into_iter().map(|(v, _)| v).collect();
            prop_assert!((3..=9).contains(&at.len()), "{at:?} on {span:?}");
            let step = (at[at.len() - 1] - at[0]) / (at.len() - 1) as f64;
            let air = 1e-3 * step;
            prop_assert!(at[0] >= span.0 - air && at[0] - step < span.0 + air);
            prop_assert!(at[at.len() - 1] <= span.1 + air && at[at.len() - 1] + step > span.1 - air);
            if !angle {
                let mantissa = step / 10_f64.powf((step * 1.001).log10().floor());
                prop_assert!([1.0, 2.0, 5.0].iter().any(|m| (mantissa / m - 1.0).abs() < 1e-2));
            }
        }

        #[test]
        fn any_two_numbers_make_a_range(a in any::<f64>(), b in any::<f64>(), v in -1e99..1e99_f64) {
            for range in [Range::Fixed(a, b), Range::AtLeast(a, b), Range::Auto] {
                for data in [vec![], vec![v], vec![v, 0.0], vec![v, v * (1.0 + 1e-12)]] {
                    let span = resolve(range, data.into_iter());
                    prop_assert!(span.0 < span.1 && span.0.is_finite() && span.1.is_finite());
                    let count = ticks(TickStyle::Decimal, span).at.len();
                    prop_assert!((3..=9).contains(&count), "{count} on {span:?}");
                }
            }
        }
    }
}
