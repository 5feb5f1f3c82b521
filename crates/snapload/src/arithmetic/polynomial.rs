//! Truncated power series.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::real::Real;
use std::ops::{Index, IndexMut};

/// The highest power. At order p a step is about ρ ε^{1/p} for a radius of convergence ρ. Where the
/// cost grows as p² the work per unit of time is least near p = −½ ln ε ≈ 18 (Jorba & Zou 2005);
/// sums in blocks ([`crate::arithmetic::vector_series`]) make it grow more slowly, so the least
/// lies higher: 28 and 32 cost alike, 24 a tenth more.
pub(crate) const ORDER: usize = 28;

/// The highest derivative for which a bound is available.
const MOST_DERIVED: usize = 4;

/// k (k − 1) … (k − n + 1), what the n-th derivative makes of the k-th power.
const FALLING: [[f64; ORDER + 1]; MOST_DERIVED + 1] = {
    let mut all = [[1.0; ORDER + 1]; MOST_DERIVED + 1];
    let mut n = 1;
    while n <= MOST_DERIVED {
        let mut k = 0;
        while k <= ORDER {
            all[n][k] = all[n - 1][k] * (k as f64 - (n as f64 - 1.0));
            k += 1;
        }
        n += 1;
    }
    all
};

/// A bound on the error of the value at s, in roundings of Σ |c_k| s^k.
const ROUNDINGS: f64 = 8.0;

/// A polynomial of degree at most [`ORDER`], lowest power first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polynomial<T>([T; ORDER + 1]);

impl<L: Lane> Default for Polynomial<L> {
    fn default() -> Self {
        Self([L::ZERO; ORDER + 1])
    }
}

impl<T> Index<usize> for Polynomial<T> {
    type Output = T;
    fn index(&self, power: usize) -> &T {
        &self.0[power]
    }
}

impl<T> IndexMut<usize> for Polynomial<T> {
    fn index_mut(&mut self, power: usize) -> &mut T {
        &mut self.0[power]
    }
}

impl<T: Real> Polynomial<T> {
    /// Value and first two derivatives at s, of the powers up to `order`.
    #[inline(always)]
    pub(crate) fn jet(&self, s: T, order: usize) -> [T; 3] {
        self.jet_and_size(s, order).0
    }

    /// The same, and Σ |c_k| s^k, to which the rounding error of the value is proportional.
    #[inline(always)]
    fn jet_and_size(&self, s: T, order: usize) -> ([T; 3], T) {
        let (mut value, mut rate, mut half_accel) = (T::ZERO, T::ZERO, T::ZERO);
        let mut size = T::ZERO;
        for coefficient in self.0[..=order].iter().rev() {
            half_accel = half_accel.mul_add(s, rate);
            rate = rate.mul_add(s, value);
            value = value.mul_add(s, *coefficient);
            size = size.mul_add(s, coefficient.abs());
        }
        ([value, rate, half_accel * 2.0], size)
    }

    /// Values at some places, of the powers up to `order`.
    #[inline(always)]
    pub(crate) fn values<const N: usize>(&self, places: &[T; N], order: usize) -> [T; N] {
        let mut values = [T::ZERO; N];
        for coefficient in self.0[..=order].iter().rev() {
            for (value, place) in values.iter_mut().zip(places) {
                *value = value.mul_add(*place, *coefficient);
            }
        }
        values
    }

    /// Value and first two derivatives at s, and the rounding error of the value.
    #[inline(always)]
    pub(crate) fn jet_and_noise(&self, s: T, order: usize) -> ([T; 3], T) {
        let (jet, size) = self.jet_and_size(s, order);
        (jet, size * T::EPSILON * ROUNDINGS)
    }

    /// Whether it is provably below zero on all of \[0, s\], by more than its rounding and a
    /// further error.
    #[inline(always)]
    pub(crate) fn stays_negative(&self, s: T, order: usize, error: T) -> bool {
        let size = self.derivative_bound(0, s, order);
        let constant = self.0[0];
        let largest = size - constant.abs() + constant;
        largest < -(size * T::EPSILON * (2.0 * ROUNDINGS) + error)
    }

    /// Bound on the n-th derivative over \[0, s\].
    #[inline(always)]
    pub(crate) fn derivative_bound(&self, n: usize, s: T, order: usize) -> T {
        let mut bound = T::ZERO;
        let (coefficients, falling) = (&self.0[n..=order], &FALLING[n][n..=order]);
        for k in (0..coefficients.len()).rev() {
            bound = bound.mul_add(s, coefficients[k].abs() * falling[k]);
        }
        bound
    }

    /// The longest length up to `step`, which is at most 1, found by repeated division by √2, on
    /// which the last two terms are below a twentieth of a rounding of `scale`, or of the largest
    /// of the other terms if that is more.
    ///
    /// The constant term is not among them: where a motion has just begun to leave an equilibrium,
    /// its last terms are small against the position and yet not converged.
    ///
    /// Zero where the last coefficients are not finite: nothing is known of the terms then.
    #[inline(always)]
    pub(crate) fn converged_within(&self, mut step: T, order: usize, scale: T) -> T {
        let tolerance = T::EPSILON * 0.05;
        let tail = [self.0[order - 1].abs(), self.0[order].abs()];
        if !(tail[0].is_finite() && tail[1].is_finite()) {
            return T::ZERO;
        }
        // A step is at most 1, so no term is larger than its coefficient.
        let inner = &self.0[1..order - 1];
        let mut ceiling = scale;
        for coefficient in inner {
            ceiling = ceiling.max(coefficient.abs());
        }
        while step > T::EPSILON {
            let power = power(step, order - 1);
            let last = (tail[0] * power).max(tail[1] * power * step);
            if last <= scale * tolerance
                || last <= ceiling * tolerance && last <= largest(inner, step, scale) * tolerance
            {
                break;
            }
            step = step * 0.7;
        }
        step
    }

    /// Adds coefficients times `even` where the power is even, and times `odd` where it is odd.
    #[inline(always)]
    pub(crate) fn add_alternating(&mut self, factors: &[T; ORDER + 1], even: T, odd: T) {
        let parts = [even, odd];
        for k in 0..=ORDER {
            self.0[k] = factors[k].mul_add(parts[k % 2], self.0[k]);
        }
    }

    /// With all signs changed.
    #[inline(always)]
    pub(crate) fn negated(&self) -> Self {
        let mut negated = *self;
        for coefficient in &mut negated.0 {
            *coefficient = -*coefficient;
        }
        negated
    }
}

/// x^n by repeated squaring.
#[inline(always)]
fn power<T: Real>(x: T, n: usize) -> T {
    let (mut power, mut square, mut left) = (T::ONE, x, n);
    while left > 0 {
        if left % 2 == 1 {
            power = power * square;
        }
        square = square * square;
        left /= 2;
    }
    power
}

/// The largest of |c_1| x, |c_2| x², …, and of `least`.
#[inline(always)]
fn largest<T: Real>(coefficients: &[T], x: T, least: T) -> T {
    let (mut power, mut most) = (T::ONE, least);
    for coefficient in coefficients {
        power = power * x;
        most = most.max(coefficient.abs() * power);
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jet_and_bounds_of_a_cubic() {
        let mut p = Polynomial::<f64>::default();
        (p[0], p[1], p[2], p[3]) = (1.0, -2.0, 3.0, -4.0);
        assert_eq!(p.jet(0.5, ORDER), [0.25, -2.0, -6.0]);
        assert_eq!(p.derivative_bound(3, 7.0, ORDER), 24.0);
        assert_eq!(p.derivative_bound(2, 0.5, ORDER), 6.0 + 12.0);
        assert_eq!(p.negated().jet(0.5, 1)[0], 0.0);
        assert_eq!(p.values(&[0.0, 0.5, -1.0], ORDER), [1.0, 0.25, 10.0]);
    }
}
