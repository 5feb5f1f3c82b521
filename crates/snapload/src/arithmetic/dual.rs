//! Dual numbers: a number and its derivatives, carried through any formula.

use crate::arithmetic::real::Real;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number a with its derivatives a' with respect to N quantities: a + Σ a'_i ε_i, ε_i ε_j = 0.
///
/// With dual numbers in the laws of motion no derivative has to be written by hand, not even at an
/// event: the last step of the search, s − f/ḟ, has the derivative −f'/ḟ of the implicit function
/// theorem, so that the saltation matrix (Müller 1995) follows without being written down.
///
/// Comparisons use the value alone, so a motion over dual numbers under up to eight frequencies
/// takes the same branches, with the same bits, as the ordinary one. Under more frequencies it
/// agrees with the ordinary one to rounding: duals sum up the waves one by one, doubles by a
/// polynomial. Sums and products are inlined everywhere, as they are compiled with the instructions
/// of whatever code uses them (`apart!`).
#[derive(Clone, Copy, Debug)]
pub struct Dual<T, const N: usize> {
    /// The number.
    pub value: T,
    /// Its derivatives.
    pub slope: [T; N],
}

impl<T: Real, const N: usize> Dual<T, N> {
    /// A constant.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        Self {
            value,
            slope: [T::ZERO; N],
        }
    }

    /// The i-th of the quantities with respect to which derivatives are taken.
    pub fn variable(value: T, i: usize) -> Self {
        let mut variable = Self::constant(value);
        variable.slope[i] = T::ONE;
        variable
    }

    /// f(self), from the value and the derivative of f.
    #[inline(always)]
    fn chain(mut self, value: T, derivative: T) -> Self {
        self.value = value;
        for slope in &mut self.slope {
            *slope = *slope * derivative;
        }
        self
    }
}

impl<T: Real, const N: usize> Default for Dual<T, N> {
    fn default() -> Self {
        Self::constant(T::ZERO)
    }
}

impl<T: Real, const N: usize> PartialEq for Dual<T, N> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Real, const N: usize> PartialOrd for Dual<T, N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<T: Real, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for (slope, more) in self.slope.iter_mut().zip(other.slope) {
            *slope += more;
        }
        self
    }
}

impl<T: Real, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self.value -= other.value;
        for (slope, less) in self.slope.iter_mut().zip(other.slope) {
            *slope -= less;
        }
        self
    }
}

impl<T: Real, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut product = Self::constant(self.value * other.value);
        for (i, slope) in product.slope.iter_mut().enumerate() {
            *slope = self.slope[i] * other.value + self.value * other.slope[i];
        }
        product
    }
}

impl<T: Real, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let mut quotient = Self::constant(self.value / other.value);
        for (i, slope) in quotient.slope.iter_mut().enumerate() {
            *slope = (self.slope[i] - quotient.value * other.slope[i]) / other.value;
        }
        quotient
    }
}

impl<T: Real, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -T::ONE)
    }
}

impl<T: Real, const N: usize> Add<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: f64) -> Self {
        self.value = self.value + other;
        self
    }
}

impl<T: Real, const N: usize> Sub<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: f64) -> Self {
        self.value = self.value - other;
        self
    }
}

impl<T: Real, const N: usize> Mul<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, T::from_f64(other))
    }
}

impl<T: Real, const N: usize> Div<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(mut self, other: f64) -> Self {
        self.value = self.value / other;
        for slope in &mut self.slope {
            *slope = *slope / other;
        }
        self
    }
}

impl<T: Real, const N: usize> AddAssign for Dual<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real, const N: usize> SubAssign for Dual<T, N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Real, const N: usize> Real for Dual<T, N> {
    const EPSILON: Self = Self {
        value: T::EPSILON,
        slope: [T::ZERO; N],
    };
    const ZERO: Self = Self {
        value: T::ZERO,
        slope: [T::ZERO; N],
    };
    const ONE: Self = Self {
        value: T::ONE,
        slope: [T::ZERO; N],
    };
    const NEWTON_STEPS: usize = T::NEWTON_STEPS;
    const CARRIES_SLOPES: bool = true;

    fn from_f64(value: f64) -> Self {
        Self::constant(T::from_f64(value))
    }
    fn from_decimal(value: f64) -> Self {
        Self::constant(T::from_decimal(value))
    }
    fn half_pi() -> Self {
        Self::constant(T::half_pi())
    }
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    #[inline(always)]
    fn mul_add(self, by: Self, plus: Self) -> Self {
        let mut all = Self::constant(self.value.mul_add(by.value, plus.value));
        for (i, slope) in all.slope.iter_mut().enumerate() {
            *slope = self.slope[i] * by.value + self.value * by.slope[i] + plus.slope[i];
        }
        all
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::ONE / (root * 2.0))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
    fn versines(self) -> (Self, Self) {
        // C = (1 − cos z)/z² = 1/2 − z²/24 + …, S = (z − sin z)/z² = z/6 − z³/120 + …
        let z = self.value;
        let (even, odd) = z.versines();
        let (even_slope, odd_slope) = if z.abs() < T::from_f64(SMALL_ANGLE) {
            versine_slopes(z)
        } else {
            // z² C' = sin z − 2 z C and z² S' = 1 − cos z − 2 z S, by differentiating z² C, z² S.
            let square = z * z;
            let sine = z - square * odd;
            (
                (sine - z * even * 2.0) / square,
                (square * even - z * odd * 2.0) / square,
            )
        };
        (self.chain(even, even_slope), self.chain(odd, odd_slope))
    }
    fn detached(self) -> Self {
        Self::constant(self.value.detached())
    }
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
}

/// Below this the slopes of the versines are taken from their series, as the quotients would
/// cancel.
const SMALL_ANGLE: f64 = 0.5;

/// (C', S') by their series:
/// C' = Σ (−1)^k 2k z^{2k−1}/(2k + 2)!, S' = Σ (−1)^k (2k + 1) z^{2k}/(2k + 3)!.
fn versine_slopes<T: Real>(z: T) -> (T, T) {
    let square = z * z;
    let (mut even, mut odd) = (T::ZERO, T::ZERO);
    // (−1)^k z^{2k}/(2k + 2)!
    let mut term = T::from_f64(0.5);
    let mut k = 0.0;
    while term.abs() > T::EPSILON * 1e-3 {
        odd += term * (2.0 * k + 1.0) / (2.0 * k + 3.0);
        let next = -(term * square) / ((2.0 * k + 3.0) * (2.0 * k + 4.0));
        k += 1.0;
        if z != T::ZERO {
            even += next * (2.0 * k) / z;
        }
        term = next;
    }
    (even, odd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type D = Dual<f64, 2>;

    /// Central difference of order four.
    fn difference(f: impl Fn(f64) -> f64, z: f64) -> f64 {
        let h = 1e-3;
        (8.0 * (f(z + h) - f(z - h)) - (f(z + 2.0 * h) - f(z - 2.0 * h))) / (12.0 * h)
    }

    proptest! {
        #[test]
        fn slopes_are_derivatives(z in -3.0..3.0f64, w in 0.5..2.0f64) {
            let formula = |z: f64, w: f64| ((z * w - 1.5) / (w + 4.0) + z.sin() * z.cos()).abs() * w.sqrt();
            let (x, y) = (D::variable(z, 0), D::variable(w, 1));
            let (sine, cosine) = x.sin_cos();
            let value = ((x * y - 1.5) / (y + 4.0) + sine * cosine).abs() * y.sqrt();
            prop_assume!(value.value > 0.05);
            prop_assert!((value.slope[0] - difference(|z| formula(z, w), z)).abs() < 1e-9);
            prop_assert!((value.slope[1] - difference(|w| formula(z, w), w)).abs() < 1e-9);
        }

        #[test]
        fn versines_have_their_slopes(z in -3.0..3.0f64) {
            let (even, odd) = D::variable(z, 0).versines();
            prop_assert!((even.slope[0] - difference(|z| f64::versines(z).0, z)).abs() < 1e-11);
            prop_assert!((odd.slope[0] - difference(|z| f64::versines(z).1, z)).abs() < 1e-11);
        }
    }

    #[test]
    fn slopes_of_versines_join_where_the_series_ends() {
        let at = |z: f64| D::variable(z, 0).versines();
        let (below, above) = (at(SMALL_ANGLE * (1.0 - 1e-15)), at(SMALL_ANGLE));
        assert!((below.0.slope[0] - above.0.slope[0]).abs() < 1e-14);
        assert!((below.1.slope[0] - above.1.slope[0]).abs() < 1e-14);
        assert_eq!(at(0.0).0.slope[0], 0.0);
        assert!((at(0.0).1.slope[0] - 1.0 / 6.0).abs() < 1e-16);
    }
}
