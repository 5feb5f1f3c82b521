//! Balls: a midpoint and a radius. A ball encloses an unknown number; the result of an operation is
//! a ball that encloses what the operation makes of any numbers within the balls given.

use crate::arithmetic::number::{Number, Rounded};
use crate::arithmetic::radius::Radius;
use std::ops::{Add, Mul, Neg, Sub};

/// All numbers that differ from the midpoint by at most the radius.
#[derive(Clone, Debug)]
pub(crate) struct Ball {
    mid: Number,
    radius: Radius,
}

/// How many steps of Newton's method a reciprocal or a root needs: a double gives the first digits,
/// each step doubles them, up to two limbs more than `limbs`.
fn newton_steps(limbs: usize) -> u32 {
    (64 * limbs / 45).ilog2() + 1
}

impl Ball {
    /// A rounded midpoint differs from the exact one by less than two units of its last bit, which
    /// the radius has to include.
    fn rounded((mid, inexact): Rounded, radius: Radius) -> Self {
        let radius = if inexact {
            radius.plus(Radius::power_of_two(mid.unit() + 1))
        } else {
            radius
        };
        Self { mid, radius }
    }

    pub(crate) fn exact(mid: Number) -> Self {
        Self {
            mid,
            radius: Radius::ZERO,
        }
    }

    pub(crate) fn zero() -> Self {
        Self::exact(Number::zero())
    }

    pub(crate) fn integer(integer: i64) -> Self {
        Self::exact(Number::from_integer(integer))
    }

    /// The ball of one double, exactly; infinity and NaN give zero.
    pub(crate) fn double(value: f64) -> Self {
        Self::exact(Number::from_f64(value).unwrap_or_else(Number::zero))
    }

    /// ± the integer of these limbs · 2^power, rounded to at most `most` limbs.
    pub(crate) fn from_limbs(negative: bool, limbs: &[u64], power: i64, most: usize) -> Self {
        let rounded = Number::from_limbs(negative, limbs, power, most);
        Self::rounded(rounded, Radius::ZERO)
    }

    /// The value of a bound as a ball without a radius, exactly.
    pub(crate) fn bound(radius: Radius) -> Self {
        let (mantissa, exponent) = radius.parts();
        Self::from_limbs(false, &[mantissa], exponent, 1)
    }

    /// [−radius, radius].
    pub(crate) fn within(radius: Radius) -> Self {
        Self {
            mid: Number::zero(),
            radius,
        }
    }

    /// This ball with its midpoint at `limbs` limbs; results computed from it then have that
    /// precision.
    pub(crate) fn with_limbs(&self, limbs: usize) -> Self {
        Self::rounded(self.mid.with_limbs(limbs), self.radius)
    }

    /// The midpoint as a ball of radius zero.
    pub(crate) fn centre(&self) -> Self {
        Self::exact(self.mid.clone())
    }

    pub(crate) fn mid(&self) -> &Number {
        &self.mid
    }

    pub(crate) fn radius(&self) -> Radius {
        self.radius
    }

    /// The ball with its radius enlarged by `by`.
    pub(crate) fn widened(mut self, by: Radius) -> Self {
        self.radius = self.radius.plus(by);
        self
    }

    /// A ball that contains both balls.
    ///
    /// Its midpoint is the middle between the two midpoints; the distance from there to any number
    /// of either ball is at most half the distance of the midpoints plus the larger radius.
    pub(crate) fn hull(&self, other: &Self) -> Self {
        let distance = (&self.centre() - &other.centre()).upper().scaled(-1);
        let middle = (&self.centre() + &other.centre()).half();
        middle
            .widened(distance)
            .widened(self.radius.max(other.radius))
    }

    /// At least as large as the magnitude of all its numbers.
    pub(crate) fn upper(&self) -> Radius {
        magnitude_above(&self.mid).plus(self.radius)
    }

    /// At most as large as the magnitude of any of its numbers.
    pub(crate) fn lower(&self) -> Radius {
        magnitude_below(&self.mid).minus(self.radius)
    }

    /// Whether all its numbers are above zero.
    pub(crate) fn is_positive(&self) -> bool {
        !self.mid.negative && !self.lower().is_zero()
    }

    /// Whether all its numbers are below zero.
    pub(crate) fn is_negative(&self) -> bool {
        self.mid.negative && !self.lower().is_zero()
    }

    /// Whether every number of this one is below every number of the other.
    pub(crate) fn is_below(&self, other: &Self) -> bool {
        (self - other).is_negative()
    }

    /// Whether the ball contains zero and no other number.
    pub(crate) fn is_zero(&self) -> bool {
        self.mid.is_zero() && self.radius.is_zero()
    }

    /// Times 2^power, exactly.
    pub(crate) fn scaled(&self, power: i64) -> Self {
        let mut mid = self.mid.clone();
        if !mid.is_zero() {
            mid.exponent += power;
        }
        Self {
            mid,
            radius: self.radius.scaled(power),
        }
    }

    pub(crate) fn half(&self) -> Self {
        self.scaled(-1)
    }

    pub(crate) fn twice(&self) -> Self {
        self.scaled(1)
    }

    pub(crate) fn squared(&self) -> Self {
        self * self
    }

    pub(crate) fn abs(&self) -> Self {
        let mut result = self.clone();
        result.mid.negative = false;
        result
    }

    /// Divided by an integer above zero: |x/d − m/d| = |x − m|/d.
    pub(crate) fn over_small(&self, divisor: u64) -> Self {
        let radius = self.radius.over(Radius::below(divisor, 0));
        Self::rounded(self.mid.over_small(divisor), radius)
    }

    /// The reciprocal; none if zero is in the ball.
    ///
    /// For any x and every β in the ball, |1/β − x| = |1 − βx|/|β|. The numerator is bounded by
    /// evaluating 1 − βx in balls, the denominator by the ball's smallest magnitude. Newton's
    /// method only makes x so good that the bound is small; the proof does not depend on it.
    pub(crate) fn reciprocal(&self) -> Option<Self> {
        let least = self.lower();
        if least.is_zero() {
            return None;
        }
        let n = self.mid.limbs.len();
        // The mantissa, in [1/2, 1), as a double; the power of two is put back exactly.
        let mut mantissa = self.mid.clone();
        mantissa.exponent = 0;
        let mut x = Number::from_f64(1.0 / mantissa.to_f64())?;
        x.exponent -= self.mid.exponent;
        let one = Number::from_integer(1);
        for _ in 0..newton_steps(n) {
            let rest = one.add(&self.mid.mul(&x).0.negated()).0;
            x = x.add(&x.mul(&rest).0).0;
        }
        let x = Self::exact(x);
        let rest = &Self::integer(1) - &(self * &x);
        let radius = rest.upper().over(least);
        Some(x.widened(radius))
    }

    /// The quotient; none if zero is in the divisor.
    pub(crate) fn over(&self, divisor: &Self) -> Option<Self> {
        Some(self * &divisor.reciprocal()?)
    }

    /// The square root; none unless all numbers of the ball are positive.
    ///
    /// For any s > 0 and every α in the ball, |√α − s| = |α − s²|/(√α + s) ≤ |α − s²|/s, and the
    /// numerator is bounded by evaluating it in balls. s comes from Newton's method for 1/√α.
    pub(crate) fn sqrt(&self) -> Option<Self> {
        if !self.is_positive() {
            return None;
        }
        let n = self.mid.limbs.len();
        // α = 4^k m with m in [1/4, 1).
        let k = (self.mid.exponent + 1).div_euclid(2);
        let mut m = self.mid.clone();
        m.exponent -= 2 * k;
        let mut y = Number::from_f64(1.0 / m.to_f64().sqrt())?;
        let one = Number::from_integer(1);
        for _ in 0..newton_steps(n) {
            let rest = one.add(&m.mul(&y).0.mul(&y).0.negated()).0;
            let mut change = y.mul(&rest).0;
            change.exponent -= i64::from(!change.is_zero());
            y = y.add(&change).0;
        }
        let mut s = m.mul(&y).0;
        s.exponent += k;
        let s = Self::exact(s);
        let least = s.lower();
        if least.is_zero() || s.mid.negative {
            return None;
        }
        let radius = (self - &s.squared()).upper().over(least);
        Some(s.widened(radius))
    }

    /// A double next to the midpoint.
    pub(crate) fn to_f64(&self) -> f64 {
        self.mid.to_f64()
    }
}

/// A bound on |number| from its top 32 bits plus one unit of them; see [`Number`] for the power of
/// two.
fn magnitude_above(number: &Number) -> Radius {
    let top = number.limbs.last().copied().unwrap_or(0);
    if top == 0 {
        return Radius::ZERO;
    }
    // The bits cut off below the top may be set: the number is below (top + 1) · 2^(exponent − 64).
    let exact = number.limbs[..number.limbs.len() - 1]
        .iter()
        .all(|limb| *limb == 0);
    match top.checked_add(u64::from(!exact)) {
        Some(integer) => Radius::above(integer, number.exponent - 64),
        None => Radius::power_of_two(number.exponent),
    }
}

fn magnitude_below(number: &Number) -> Radius {
    let top = number.limbs.last().copied().unwrap_or(0);
    Radius::below(top, number.exponent - 64)
}

impl Add for &Ball {
    type Output = Ball;
    /// |(a + b) − (m + n)| ≤ |a − m| + |b − n|.
    fn add(self, other: &Ball) -> Ball {
        let radius = self.radius.plus(other.radius);
        Ball::rounded(self.mid.add(&other.mid), radius)
    }
}

impl Neg for Ball {
    type Output = Ball;
    fn neg(self) -> Ball {
        Ball {
            mid: self.mid.negated(),
            radius: self.radius,
        }
    }
}

impl Neg for &Ball {
    type Output = Ball;
    fn neg(self) -> Ball {
        -self.clone()
    }
}

impl Sub for &Ball {
    type Output = Ball;
    fn sub(self, other: &Ball) -> Ball {
        self + &-other
    }
}

impl Mul for &Ball {
    type Output = Ball;
    /// a b − m n = m (b − n) + (a − m) b, and |b| ≤ |n| + |b − n|.
    fn mul(self, other: &Ball) -> Ball {
        let radius = match (self.radius.is_zero(), other.radius.is_zero()) {
            (true, true) => Radius::ZERO,
            (true, false) => magnitude_above(&self.mid).times(other.radius),
            (false, _) => {
                let first = magnitude_above(&self.mid).times(other.radius);
                first.plus(self.radius.times(other.upper()))
            }
        };
        Ball::rounded(self.mid.mul(&other.mid), radius)
    }
}

/// The same operators for operands passed by value.
macro_rules! by_value {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator<Ball> for Ball {
            type Output = Ball;
            fn $method(self, other: Ball) -> Ball {
                (&self).$method(&other)
            }
        }
        impl $operator<&Ball> for Ball {
            type Output = Ball;
            fn $method(self, other: &Ball) -> Ball {
                (&self).$method(other)
            }
        }
        impl $operator<Ball> for &Ball {
            type Output = Ball;
            fn $method(self, other: Ball) -> Ball {
                self.$method(&other)
            }
        }
    )*};
}

by_value!(Add add, Sub sub, Mul mul);
