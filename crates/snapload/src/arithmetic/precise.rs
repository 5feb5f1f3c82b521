//! Numbers of many digits, which verify results computed in doubles.

use crate::arithmetic::real::Real;
use nearest::{Operand, SPARE};
use operations::{Binary, Number, Unary};
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

mod decimals;
mod nearest;
#[cfg(test)]
mod nearest_tests;
mod operations;

/// A number with a significand of 64 `WORDS` − 2 bits, rounded to nearest after every operation.
///
/// Quotients, roots, sines and cosines are those of the crate `dashu-float`. Its numbers live on
/// the heap and are cloned, so that every formula of the motion would be full of clones; here they
/// are kept in an array of fixed size, so that this type is copied as a double is. Sums, products,
/// comparisons and quotients by doubles, of which a motion mostly consists, are computed in the
/// array itself: a run takes a quarter of the time that it takes with those of the crate.
///
/// Libraries considered: `rug` (MPFR) is faster but needs a C compiler and the LGPL; `f256` is
/// limited to 71 digits; `astro-float` has had no release for a long time. `dashu-float` is plain
/// Rust, is maintained, has the same licences as this library, and rounds its sines and cosines
/// correctly.
///
/// A result without a value, such as 0/0 or one beyond the exponents, behaves like a NaN.
///
/// No operation is inlined: each takes far longer than a call, and inlining the thousands of them
/// in a motion would take most of the time to compile this library.
#[derive(Clone, Copy, Debug)]
pub struct Precise<const WORDS: usize> {
    /// The significand, an integer: its topmost bit is set, but for zero.
    limbs: [u64; WORDS],
    exponent: i64,
    negative: bool,
    valid: bool,
}

impl<const WORDS: usize> Precise<WORDS> {
    /// Bits of the significand.
    const BITS: usize = 64 * WORDS - SPARE as usize;

    /// Decimal digits that it holds.
    pub const DIGITS: u32 = (Self::BITS as f64 * std::f64::consts::LOG10_2) as u32;

    const NO_VALUE: Self = Self {
        limbs: [0; WORDS],
        exponent: 0,
        negative: false,
        valid: false,
    };

    const fn power_of_two(exponent: i64) -> Self {
        let mut limbs = [0; WORDS];
        limbs[WORDS - 1] = 1 << 63;
        Self {
            limbs,
            exponent: exponent - 64 * WORDS as i64 + 1,
            negative: false,
            valid: true,
        }
    }

    fn operand(&self) -> Operand<'_> {
        Operand {
            limbs: &self.limbs,
            exponent: self.exponent,
            negative: self.negative,
        }
    }

    fn repr(&self) -> Number {
        operations::number(self.operand())
    }

    fn from_repr(number: Option<Number>) -> Self {
        let Some(number) = number else {
            return Self::NO_VALUE;
        };
        let mut limbs = [0; WORDS];
        let scale = operations::write(&number, &mut limbs);
        Self::scaled(limbs, scale)
    }

    fn scaled(limbs: [u64; WORDS], scale: Option<nearest::Scale>) -> Self {
        let Some((exponent, negative)) = scale else {
            return Self::NO_VALUE;
        };
        Self {
            limbs,
            exponent,
            negative,
            valid: true,
        }
    }

    /// An operation of this library, if both operands have a value.
    fn nearest(
        self,
        other: Self,
        operation: impl Fn(Operand, Operand, &mut [u64]) -> Option<nearest::Scale>,
    ) -> Self {
        if !(self.valid && other.valid) {
            return Self::NO_VALUE;
        }
        let mut limbs = [0; WORDS];
        let scale = operation(self.operand(), other.operand(), &mut limbs);
        Self::scaled(limbs, scale)
    }

    /// An operation of `dashu-float`, if both operands have a value.
    fn binary(self, other: Self, operation: Binary) -> Self {
        if !(self.valid && other.valid) {
            return Self::NO_VALUE;
        }
        Self::from_repr(operation(Self::BITS, &self.repr(), &other.repr()))
    }

    fn unary(self, operation: Unary) -> Self {
        if !self.valid {
            return Self::NO_VALUE;
        }
        Self::from_repr(operation(Self::BITS, &self.repr()))
    }

    fn is_zero(&self) -> bool {
        self.valid && self.limbs[WORDS - 1] == 0
    }

    /// Terms that bring the series of [`Real::versines`] below half a rounding at |z| ≤ 1: where
    /// (2k + 2)! passes 2^BITS.
    fn versine_terms() -> u32 {
        let mut bits = 0.0;
        let mut n = 1;
        while bits < Self::BITS as f64 {
            n += 1;
            bits += f64::from(n).log2();
        }
        n / 2
    }
}

impl<const WORDS: usize> Default for Precise<WORDS> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const WORDS: usize> PartialEq for Precise<WORDS> {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl<const WORDS: usize> PartialOrd for Precise<WORDS> {
    #[inline(never)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        (self.valid && other.valid).then(|| nearest::compare(self.operand(), other.operand()))
    }
}

impl<const WORDS: usize> Add for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        self.nearest(other, nearest::add)
    }
}

impl<const WORDS: usize> Sub for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const WORDS: usize> Mul for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        self.nearest(other, nearest::multiply)
    }
}

impl<const WORDS: usize> Div for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let by_limb =
            |divisor| self.nearest(other, |a, b, out| nearest::divide(a, b, divisor, out));
        match other.operand().single_limb() {
            Some(divisor) => by_limb(divisor),
            None => self.binary(other, operations::divide),
        }
    }
}

impl<const WORDS: usize> Neg for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn neg(mut self) -> Self {
        self.negative = !self.negative && !self.is_zero();
        self
    }
}

impl<const WORDS: usize> Add<f64> for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: f64) -> Self {
        self + Self::from_f64(other)
    }
}

impl<const WORDS: usize> Sub<f64> for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: f64) -> Self {
        self - Self::from_f64(other)
    }
}

impl<const WORDS: usize> Mul<f64> for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: f64) -> Self {
        self * Self::from_f64(other)
    }
}

impl<const WORDS: usize> Div<f64> for Precise<WORDS> {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: f64) -> Self {
        self / Self::from_f64(other)
    }
}

impl<const WORDS: usize> AddAssign for Precise<WORDS> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const WORDS: usize> SubAssign for Precise<WORDS> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const WORDS: usize> Real for Precise<WORDS> {
    const EPSILON: Self = Self::power_of_two(1 - Self::BITS as i64);
    const ZERO: Self = Self {
        valid: true,
        ..Self::NO_VALUE
    };
    const ONE: Self = Self::power_of_two(0);
    // Each doubles the 30 bits that 1e-9 leaves.
    const NEWTON_STEPS: usize = (Self::BITS / 30).ilog2() as usize + 1;

    #[inline(never)]
    fn from_f64(value: f64) -> Self {
        let mut limbs = [0; WORDS];
        let scale = nearest::of_double(value, &mut limbs);
        Self::scaled(limbs, scale)
    }

    #[inline(never)]
    fn from_decimal(value: f64) -> Self {
        // Rust writes a double as the shortest decimal that is read back as the same double.
        Self::of_decimal(&format!("{value:e}")).unwrap_or(Self::NO_VALUE)
    }

    #[inline(never)]
    fn half_pi() -> Self {
        Self::from_repr(Some(operations::pi(Self::BITS))) * 0.5
    }

    #[inline(never)]
    fn to_f64(self) -> f64 {
        if self.valid {
            operations::to_double(Self::BITS, self.repr())
        } else {
            f64::NAN
        }
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        self.unary(operations::root)
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        if !self.valid {
            return (Self::NO_VALUE, Self::NO_VALUE);
        }
        let [sine, cosine] = operations::sine_and_cosine(Self::BITS, &self.repr());
        (Self::from_repr(sine), Self::from_repr(cosine))
    }

    #[inline(never)]
    fn versines(self) -> (Self, Self) {
        let square = self * self;
        if square <= Self::ONE {
            // As for doubles: Horner from the smallest term.
            let (mut even, mut odd) = (Self::ONE, Self::ONE);
            for k in (1..Self::versine_terms()).rev() {
                let n = 2.0 * f64::from(k);
                even = Self::ONE - even * square / ((n + 1.0) * (n + 2.0));
                odd = Self::ONE - odd * square / ((n + 2.0) * (n + 3.0));
            }
            (even * 0.5, self * odd / 6.0)
        } else {
            let half_sine = (self * 0.5).sin_cos().0;
            (
                half_sine * half_sine * 2.0 / square,
                (self - self.sin_cos().0) / square,
            )
        }
    }

    #[inline(never)]
    fn abs(self) -> Self {
        Self {
            negative: false,
            ..self
        }
    }

    fn is_finite(self) -> bool {
        self.valid
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_float::Repr;
    use dashu_int::{IBig, UBig};

    type P = Precise<4>;

    #[test]
    fn a_tenth_is_a_tenth() {
        let tenth = P::from_decimal(0.1);
        assert!(tenth != P::from_f64(0.1));
        assert!((tenth * 10.0 - P::ONE).abs() <= P::EPSILON);
        for value in [0.0, 1.0, -2.5, 1e22, 6.02e-23, 0.005, 1.0 / 3.0] {
            assert_eq!(P::from_decimal(value).to_f64(), value);
        }
        assert_eq!(P::DIGITS, 76);
        assert_eq!(P::NEWTON_STEPS, 4);
    }

    #[test]
    fn epsilon_is_the_spacing_next_to_one() {
        let half = P::EPSILON * 0.5;
        assert!(P::ONE + P::EPSILON > P::ONE);
        assert!(P::ONE + half * 0.99 == P::ONE);
    }

    /// To 60 digits, from mpmath.
    #[test]
    fn elementary_functions_agree_with_sixty_digits() {
        let close = |got: P, digits: &str| {
            // The reference as a fraction of integers, which is not read by our own parser.
            let scale = UBig::from(10u8).pow(60);
            let integer: IBig = digits.parse().expect("digits");
            let reference = P::from_repr(Some(Repr::new(integer, 0)))
                / P::from_repr(Some(Repr::new(IBig::from(scale), 0)));
            assert!((got - reference).abs().to_f64() < 1e-59, "{digits}");
        };
        let (sine, cosine) = P::from_decimal(0.7).sin_cos();
        close(sine, SINE_OF_0_7);
        close(cosine, COSINE_OF_0_7);
        close(P::half_pi(), HALF_PI);
        close(P::from_f64(2.0).sqrt(), ROOT_OF_2);
        close(P::from_decimal(0.7).versines().0, EVEN_AT_0_7);
        close(P::from_decimal(0.7).versines().1, ODD_AT_0_7);
        close(P::from_decimal(1.7).versines().0, EVEN_AT_1_7);
        close(P::from_decimal(1.7).versines().1, ODD_AT_1_7);
    }

    #[test]
    fn what_has_no_value_poisons_and_compares_as_nothing() {
        let nothing = P::ZERO / P::ZERO;
        assert!(!nothing.is_finite() && nothing.to_f64().is_nan());
        assert!(!(P::ONE / P::ZERO).is_finite());
        assert!(!(-P::ONE).sqrt().is_finite());
        assert!(!(nothing + 1.0).is_finite() && nothing.partial_cmp(&P::ONE).is_none());
        assert!(nothing != nothing);
        assert!(-P::ZERO == P::ZERO);
    }

    const SINE_OF_0_7: &str = "644217687237691053672614351398720183065813844573689644743963";
    const COSINE_OF_0_7: &str = "764842187284488426255859990191864909268210550373703356072932";
    const HALF_PI: &str = "1570796326794896619231321691639751442098584699687552910487472";
    const ROOT_OF_2: &str = "1414213562373095048801688724209698078569671875376948073176680";
    const EVEN_AT_0_7: &str = "479913903501044028049265326139051205575080509441421722300138";
    const ODD_AT_0_7: &str = "113841454616957033321195201227101667212624806992470112767422";
    const EVEN_AT_1_7: &str = "390603631244126188265620365859817824948664387420485458938333";
    const ODD_AT_1_7: &str = "245098681504336119257393287665094929963038210668815319956020";
}
