//! The arithmetic of doubles.

use crate::arithmetic::elementary;
use crate::arithmetic::real::Real;

impl Real for f64 {
    const EPSILON: Self = f64::EPSILON;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const NEWTON_STEPS: usize = 2;
    const FUSES: bool = true;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn from_decimal(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn half_pi() -> Self {
        std::f64::consts::FRAC_PI_2
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        f64::mul_add(self, by, plus)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // IEEE 754 asks for correct rounding: the same bits on every platform.
        f64::sqrt(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }
    #[inline(always)]
    fn versines(self) -> (Self, Self) {
        elementary::versines(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference values of (1 − cos z)/z² and (z − sin z)/z², from mpmath at 40 digits.
    #[test]
    fn versines_agree_with_forty_digits() {
        let known = [
            (1e-9, 0.5, 1.666_666_666_666_666_8e-10),
            (0.3, 0.496_261_231_937_710_9, 0.049_775_481_540_671_386),
            (0.999, 0.459_775_584_832_508_15, 0.158_386_352_461_950_03),
            (1.001, 0.459_619_736_035_745_9, 0.158_671_631_776_558_17),
            (-2.5, 0.288_182_978_487_509_4, -0.304_244_456_943_366_96),
            (40.0, 0.001_041_836_288_532_663_7, 0.024_534_304_274_700_407),
        ];
        for (z, even, odd) in known {
            let (c, s) = f64::versines(z);
            assert!(
                (c - even).abs() <= 3e-16 * even.abs(),
                "z = {z}: {c} {even}"
            );
            assert!((s - odd).abs() <= 6e-16 * odd.abs(), "z = {z}: {s} {odd}");
        }
        assert_eq!(f64::versines(0.0), (0.5, 0.0));
    }
}
