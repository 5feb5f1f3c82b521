//! Numbers of many digits as decimals.

use super::{Precise, operations};
use dashu_int::UBig;

/// The longest decimal that is read, in characters, and the largest power of ten in it.
const LONGEST: usize = 399;
const LARGEST_POWER: i32 = 400;

impl<const WORDS: usize> Precise<WORDS> {
    /// The number of a decimal such as `0.1` or `-2.5E+3`, to within its last two digits; none if
    /// the text is no decimal, has more than 399 characters or a power of ten beyond 400.
    pub fn of_decimal(text: &str) -> Option<Self> {
        if text.len() > LONGEST {
            return None;
        }
        let text = text.trim().replace('_', "").replace('E', "e");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let integer = operations::integer(Self::BITS, &format!("{whole}{fraction}"))?;
        let power = power.parse::<i32>().ok();
        let power = power.filter(|power| power.abs() <= LARGEST_POWER)? - fraction.len() as i32;
        let integer = Self::from_repr(Some(integer));
        let scale = operations::power_of_ten(Self::BITS, power.unsigned_abs());
        let scale = Self::from_repr(scale);
        Some(match power {
            ..0 => integer / scale,
            _ => integer * scale,
        })
    }

    /// The number with so many decimals, rounded to nearest once; `nan` where it has no value.
    pub fn to_decimals(&self, decimals: usize) -> String {
        if !self.valid {
            return "nan".to_owned();
        }
        let number = self.repr();
        let (_, magnitude) = number.significand().clone().into_parts();
        let scaled = magnitude * UBig::from(10u8).pow(decimals);
        let bits = number.exponent().unsigned_abs();
        let whole = match number.exponent() {
            0.. => scaled << bits,
            _ => (scaled + (UBig::ONE << (bits - 1))) >> bits,
        };
        let text = format!("{:0>width$}", whole.to_string(), width = decimals + 1);
        let (integer, fraction) = text.split_at(text.len() - decimals);
        let sign = if self.negative && whole != UBig::ZERO {
            "-"
        } else {
            ""
        };
        let point = if decimals > 0 { "." } else { "" };
        format!("{sign}{integer}{point}{fraction}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::real::Real;

    type P = Precise<4>;

    #[test]
    fn decimals_are_rounded_once() {
        let third = P::ONE / P::from_f64(3.0);
        assert_eq!(third.to_decimals(20), "0.33333333333333333333");
        assert_eq!((-third).to_decimals(3), "-0.333");
        assert_eq!((third * 2.0).to_decimals(0), "1");
        assert_eq!(
            P::from_decimal(0.1).to_decimals(60),
            format!("0.1{}", "0".repeat(59))
        );
        assert_eq!(
            P::from_f64(-1e22).to_decimals(1),
            "-10000000000000000000000.0"
        );
        assert_eq!(P::from_decimal(-1e-30).to_decimals(2), "0.00");
        assert_eq!(P::ZERO.to_decimals(2), "0.00");
        assert_eq!((P::ZERO / P::ZERO).to_decimals(2), "nan");
    }

    #[test]
    fn a_decimal_is_read_with_all_its_digits() {
        let digits = "0.12345678901234567890123456789012345678901234567890";
        let number = P::of_decimal(digits).expect("a decimal");
        assert_eq!(format!("0.{}", &number.to_decimals(50)[2..]), digits);
        for (text, same) in [
            ("+1_000.5", 1000.5),
            ("-2.5E+3", -2500.0),
            ("5.", 5.0),
            (".5", 0.5),
            ("25e-2", 0.25),
            ("-0", 0.0),
        ] {
            assert_eq!(P::of_decimal(text), Some(P::from_f64(same)), "{text}");
        }
        let long = format!("0.{}1", "0".repeat(397));
        for text in [
            "",
            "-",
            ".",
            "1e",
            "0x10",
            "inf",
            "nan",
            "1e401",
            "1e-9999999999",
            &long,
        ] {
            assert_eq!(P::of_decimal(text), None, "{text}");
        }
    }
}
