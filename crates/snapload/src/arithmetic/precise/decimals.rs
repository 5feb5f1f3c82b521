//! Numbers of many digits as decimals.

use super::Precise;
use dashu_int::UBig;

impl<const WORDS: usize> Precise<WORDS> {
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
}
