//! Decimals: read exactly, and printed only where an enclosure decides every digit.

use crate::arithmetic::ball::Ball;
use dashu_int::{IBig, Sign, UBig};
use std::fmt;

/// The longest decimal that is read, and the largest power of ten in it.
const LONGEST: usize = 400;

/// `digits` · 10^−`places`, exactly.
#[derive(Clone, Debug)]
pub struct Decimal {
    digits: IBig,
    places: i64,
    text: String,
}

/// A decimal as the project writes it: an optional sign, digits, a point with digits, and a power
/// of ten.
fn parts(text: &str) -> Option<(&str, &str, &str, i64)> {
    let (sign, rest) = match text.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", text),
    };
    let (number, power) = match rest.split_once('e') {
        Some((number, power)) => {
            let bare = power.strip_prefix(['+', '-']).unwrap_or(power);
            if bare.is_empty() || !bare.bytes().all(|b| b.is_ascii_digit()) {
                return None;
            }
            (number, power.parse().ok()?)
        }
        None => (rest, 0),
    };
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
    (!whole.is_empty() && digits(whole) && digits(fraction))
        .then_some((sign, whole, fraction, power))
}

impl Decimal {
    /// A decimal as it is written, such as `-0.25` or `1e-6`; none if it is written otherwise, is
    /// longer than 400 characters or has a power of ten beyond ±400.
    pub fn parse(text: &str) -> Option<Self> {
        if text.len() > LONGEST {
            return None;
        }
        let (sign, whole, fraction, power) = parts(text)?;
        if power.unsigned_abs() > LONGEST as u64 {
            return None;
        }
        let digits: IBig = format!("{whole}{fraction}").parse().ok()?;
        Some(Self {
            digits: if sign == "-" { -digits } else { digits },
            places: fraction.len() as i64 - power,
            text: text.to_owned(),
        })
    }

    /// A number as people write it, such as `+0.3` or `3E-1`, as a decimal.
    pub fn typed(text: &str) -> Option<Self> {
        let text = text.trim();
        let text = text.strip_prefix('+').unwrap_or(text);
        let text = text.replace('_', "").replace('E', "e").replace("e+", "e");
        let text = match text.strip_prefix("-.") {
            Some(rest) => format!("-0.{rest}"),
            None => text,
        };
        let text = if text.starts_with('.') {
            format!("0{text}")
        } else {
            text
        };
        Self::parse(text.trim_end_matches('.').replace(".e", "e").as_str())
    }

    /// The shortest decimal that is read back as this double; none if that is not finite.
    pub fn shortest(value: f64) -> Option<Self> {
        let size = value.abs();
        let text = if size == 0.0 {
            "0".to_owned()
        } else if (1e-5..1e16).contains(&size) {
            format!("{value}")
        } else {
            format!("{value:e}")
        };
        Self::parse(&text)
    }

    /// The text from which it was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it has so many places after the point or more; a power of ten moves the point.
    pub(crate) fn has_places(&self, places: i64) -> bool {
        self.places >= places
    }

    /// Whether it has so many significant digits or more.
    pub(crate) fn has_digits(&self, digits: i64) -> bool {
        self.digits.clone().into_parts().1 >= power_of_ten(digits - 1)
    }

    pub(crate) fn integer(integer: i64) -> Self {
        Self {
            digits: IBig::from(integer),
            places: 0,
            text: integer.to_string(),
        }
    }

    /// Sum, difference and product are decimals again.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let places = self.places.max(other.places);
        Self::computed(self.scaled_to(places) + other.scaled_to(places), places)
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        let places = self.places.max(other.places);
        Self::computed(self.scaled_to(places) - other.scaled_to(places), places)
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        Self::computed(&self.digits * &other.digits, self.places + other.places)
    }

    fn computed(digits: IBig, places: i64) -> Self {
        Self {
            digits,
            places,
            text: String::new(),
        }
    }

    fn scaled_to(&self, places: i64) -> IBig {
        &self.digits * IBig::from(power_of_ten(places - self.places))
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.digits == IBig::ZERO
    }

    pub(crate) fn is_positive(&self) -> bool {
        self.digits > IBig::ZERO
    }

    pub(crate) fn abs(&self) -> Self {
        let (_, magnitude) = self.digits.clone().into_parts();
        Self::computed(magnitude.into(), self.places)
    }

    /// Half a unit of its last place.
    pub(crate) fn half_unit(&self) -> Self {
        Self::computed(IBig::from(5), self.places + 1)
    }

    /// A ball of at most `limbs` limbs around it; the digits and the power of ten are integers.
    pub(crate) fn ball(&self, limbs: usize) -> Ball {
        let digits = of_integer(&self.digits, limbs);
        let power = of_integer(&power_of_ten(self.places.abs()).into(), limbs);
        if self.places <= 0 {
            return digits * power;
        }
        // A power of ten is positive, and stays so when rounded to a ball, so that the division
        // succeeds.
        digits.over(&power).unwrap_or(digits)
    }
}

/// Two decimals are equal if they are the same number, however it is written.
impl PartialEq for Decimal {
    fn eq(&self, other: &Self) -> bool {
        self.minus(other).is_zero()
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn power_of_ten(power: i64) -> UBig {
    UBig::from(10u8).pow(usize::try_from(power).unwrap_or(0))
}

fn of_integer(integer: &IBig, limbs: usize) -> Ball {
    let (sign, magnitude) = integer.clone().into_parts();
    let mut words = Vec::new();
    for chunk in magnitude.to_le_bytes().chunks(8) {
        let mut bytes = [0; 8];
        bytes[..chunk.len()].copy_from_slice(chunk);
        words.push(u64::from_le_bytes(bytes));
    }
    if words.is_empty() {
        words.push(0);
    }
    Ball::from_limbs(sign == Sign::Negative, &words, 0, limbs)
}

/// An integer within one of the midpoint of a ball.
fn nearest_integer(ball: &Ball) -> IBig {
    let number = ball.mid();
    let bytes: Vec<u8> = number.limbs.iter().flat_map(|l| l.to_le_bytes()).collect();
    let mut magnitude = UBig::from_le_bytes(&bytes);
    let power = number.unit();
    if power >= 0 {
        magnitude <<= power.min(1 << 16) as usize;
    } else {
        // Half is added before the digits below the point are cut off, which rounds.
        let shift = (-power).min(1 << 20) as usize;
        magnitude = (magnitude + (UBig::ONE << (shift - 1))) >> shift;
    }
    let integer = IBig::from(magnitude);
    if number.negative { -integer } else { integer }
}

/// The number in a ball as an integer of units of the last of `places` places after the point, if
/// every number of the ball is within half a unit of it.
fn rounded(ball: &Ball, places: i64) -> Option<IBig> {
    let limbs = ball.mid().limbs.len() + 1;
    let power = of_integer(&power_of_ten(places.abs()).into(), limbs);
    let scaled = if places >= 0 {
        ball * &power
    } else {
        ball.over(&power)?
    };
    let digits = nearest_integer(&scaled);
    let off = (scaled - of_integer(&digits, limbs)).twice();
    // 2 |off| < 1, strictly: at a tie the digit would not be decided.
    off.abs().is_below(&Ball::integer(1)).then_some(digits)
}

/// The number with `places` places after the point, or up to two fewer where it is close to a tie;
/// none if the ball is too wide.
pub(crate) fn fixed(ball: &Ball, places: i64) -> Option<String> {
    (places - 2..=places).rev().find_map(|places| {
        let (sign, magnitude) = rounded(ball, places)?.into_parts();
        let width = places as usize + 1;
        let digits = format!("{:0>width$}", magnitude.to_string());
        let (whole, fraction) = digits.split_at(digits.len() - places as usize);
        let sign = if sign == Sign::Negative { "-" } else { "" };
        Some(format!("{sign}{whole}.{fraction}"))
    })
}

/// The number with `digits` significant digits, or up to two fewer, as d.ddde-k.
pub(crate) fn significant(ball: &Ball, digits: i64) -> Option<String> {
    if ball.is_zero() {
        return Some("0".to_owned());
    }
    let exponent = ball.mid().to_f64().abs().log10().floor();
    if !exponent.is_finite() {
        // The number is too small for a double, or may be zero.
        return None;
    }
    let exponent = exponent as i64;
    (digits - 2..=digits).rev().find_map(|digits| {
        let (sign, magnitude) = rounded(ball, digits - 1 - exponent)?.into_parts();
        let text = magnitude.to_string();
        let power = exponent + text.len() as i64 - digits;
        let (first, rest) = text.split_at(1);
        let sign = if sign == Sign::Negative { "-" } else { "" };
        Some(match power {
            0 => format!("{sign}{first}.{rest}"),
            _ => format!("{sign}{first}.{rest}e{power}"),
        })
    })
}
