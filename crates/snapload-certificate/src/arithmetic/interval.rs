//! Intervals of doubles, for bounds that need few digits.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::elementary::Elementary;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::Scalar;

/// All numbers from `low` to `high`, which may be infinite but are never NaN.
///
/// An operation of IEEE 754 on two doubles is rounded to a double next to the exact result, in
/// whatever direction. So the exact result lies between the two neighbours of the computed double,
/// also where that is zero by underflow or infinite by overflow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    const ZERO: Self = Self {
        low: 0.0,
        high: 0.0,
    };
    const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Encloses exact ends that were rounded to these doubles, in whatever direction.
    fn rounded(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self {
            low: low.next_down(),
            high: high.next_up(),
        }
    }

    /// All numbers of a ball.
    ///
    /// Let d be a double next to the midpoint: the interval is d ± e, with e a bound on the
    /// distance of any number of the ball from d. Where e is too small for a double, the smallest
    /// positive double is used.
    pub(crate) fn of(ball: &Ball) -> Self {
        let near = ball.to_f64();
        if !near.is_finite() {
            return Self::ALL;
        }
        let reach = (ball - &Ball::double(near)).upper();
        if reach.is_zero() {
            return Self {
                low: near,
                high: near,
            };
        }
        let reach = reach.to_f64().next_up();
        Self::rounded(near - reach, near + reach)
    }

    /// A ball that contains the interval; none if the interval is unbounded.
    pub(crate) fn ball(&self) -> Option<Ball> {
        let is_finite = self.low.is_finite() && self.high.is_finite();
        is_finite.then(|| Ball::double(self.low).hull(&Ball::double(self.high)))
    }

    /// A bound on the magnitude of all its numbers; none if the interval is unbounded.
    pub(crate) fn upper(&self) -> Option<Radius> {
        let largest = self.low.abs().max(self.high.abs());
        largest.is_finite().then(|| Ball::double(largest).upper())
    }
}

impl Scalar for Interval {
    type Constant = Self;

    fn zero() -> Self {
        Self::ZERO
    }
    fn constant(constant: &Self) -> Self {
        *constant
    }
    fn plus(&self, other: &Self) -> Self {
        Self::rounded(self.low + other.low, self.high + other.high)
    }
    fn minus(&self, other: &Self) -> Self {
        Self::rounded(self.low - other.high, self.high - other.low)
    }
    /// The extremes of a product are among the products of the ends. Zero times infinity is NaN,
    /// which `rounded` takes for all numbers.
    fn times(&self, other: &Self) -> Self {
        let products = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        if products.iter().sum::<f64>().is_nan() {
            return Self::ALL;
        }
        let [a, b, c, d] = products;
        Self::rounded(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
    fn scaled(&self, by: &Self) -> Self {
        self.times(by)
    }
    /// An integer below 2⁵³ is a double.
    fn times_small(&self, factor: u32) -> Self {
        let factor = f64::from(factor);
        Self::rounded(self.low * factor, self.high * factor)
    }
    fn over_small(&self, divisor: u32) -> Self {
        let divisor = f64::from(divisor);
        Self::rounded(self.low / divisor, self.high / divisor)
    }
    fn reciprocal(&self) -> Option<Self> {
        let has_sign = self.low > 0.0 || self.high < 0.0;
        has_sign.then(|| Self::rounded(1.0 / self.high, 1.0 / self.low))
    }
    fn sqrt(&self) -> Option<Self> {
        (self.low > 0.0).then(|| Self::rounded(self.low.sqrt(), self.high.sqrt()))
    }
    fn sin_cos(&self, functions: &Elementary) -> Option<(Self, Self)> {
        let (sine, cosine) = functions.sin_cos(&self.ball()?);
        Some((Self::of(&sine), Self::of(&cosine)))
    }
    fn is_exact_zero(&self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn interval() -> impl Strategy<Value = (Interval, f64)> {
        let number = prop_oneof![
            -4.0..4.0,
            -1e-300..1e-300,
            -1e300..1e300,
            Just(0.0),
            Just(f64::MIN_POSITIVE / 8.0),
        ];
        (number, 0.0..1e-3, 0.0..1.0).prop_map(|(low, width, share): (f64, f64, f64)| {
            let high = low + width;
            let inside = (low + share * width).clamp(low, high);
            (Interval { low, high }, inside)
        })
    }

    /// Whether an interval holds a number that balls say exactly.
    fn holds(interval: &Interval, exact: &Ball) -> bool {
        let above = |low: f64| low == f64::NEG_INFINITY || !exact.is_below(&Ball::double(low));
        let below = |high: f64| high == f64::INFINITY || !Ball::double(high).is_below(exact);
        above(interval.low) && below(interval.high)
    }

    proptest! {
        /// Sums, differences, products, quotients and roots of numbers of intervals are in the
        /// intervals', computed in balls of 40 limbs.
        #[test]
        fn intervals_hold_exact_results((a, x) in interval(), (b, y) in interval(), k in 1u32..1000) {
            let [exact_x, exact_y] = [x, y].map(|z| Ball::double(z).with_limbs(40));
            prop_assert!(holds(&a.plus(&b), &(&exact_x + &exact_y)));
            prop_assert!(holds(&a.minus(&b), &(&exact_x - &exact_y)));
            prop_assert!(holds(&a.times(&b), &(&exact_x * &exact_y)));
            prop_assert!(holds(&a.over_small(k), &exact_x.over_small(u64::from(k))));
            prop_assert!(holds(&a.times_small(k), &(&exact_x * &Ball::integer(i64::from(k)))));
            if let (Some(ours), Some(exact)) = (Scalar::reciprocal(&a), exact_x.reciprocal()) {
                prop_assert!(holds(&ours, &exact));
            }
            if let (Some(ours), Some(exact)) = (Scalar::sqrt(&a), exact_x.sqrt()) {
                prop_assert!(holds(&ours, &exact));
            }
            prop_assert!(holds(&Interval::of(&exact_x), &exact_x));
        }
    }
}
