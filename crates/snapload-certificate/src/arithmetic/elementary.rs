//! π, sine and cosine in balls.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;

/// The constants that sine and cosine need at one precision.
#[derive(Clone, Debug)]
pub(crate) struct Elementary {
    limbs: usize,
    half_pi: Ball,
    /// 1/k! from k = 0 on.
    inverse_factorials: Vec<Ball>,
    /// How often an argument is halved before its power series is used.
    halvings: i64,
}

impl Elementary {
    /// The constants for numbers of `limbs` limbs.
    pub(crate) fn new(limbs: usize) -> Self {
        let bits = 64 * limbs as i64;
        let halvings = 2 + bits.isqrt() / 4;
        // |t| ≤ 2^-halvings: terms are left out once t^k/k! is below the last bit.
        let (mut size, mut k) = (0.0, 0u64);
        while size < bits as f64 + 8.0 {
            k += 1;
            size += halvings as f64 + (k as f64).log2();
        }
        let mut inverse_factorials = vec![Ball::integer(1).with_limbs(limbs)];
        for j in 1..=k + 2 {
            let next = inverse_factorials[j as usize - 1].over_small(j);
            inverse_factorials.push(next);
        }
        Self {
            limbs,
            half_pi: half_pi(limbs),
            inverse_factorials,
            halvings,
        }
    }

    /// π/2.
    pub(crate) fn half_pi(&self) -> &Ball {
        &self.half_pi
    }

    /// Sine and cosine.
    ///
    /// Both change by no more than their argument does, so that the values at the midpoint, with
    /// the radius of the argument added to theirs, hold for the whole ball; and no two values
    /// differ by more than 2.
    pub(crate) fn sin_cos(&self, x: &Ball) -> (Ball, Ball) {
        let spread = x.radius().min(Radius::power_of_two(1));
        let mid = x.centre().with_limbs(self.limbs);
        let turns = (mid.to_f64() / std::f64::consts::FRAC_PI_2).round();
        if turns.abs() > 9e15 {
            let any = Ball::within(Radius::power_of_two(0));
            return (any.clone(), any);
        }
        let spread = spread.plus(mid.radius());
        let rest = mid.centre() - &self.half_pi * &Ball::integer(turns as i64);
        let (sine, cosine) = self.reduced(&rest);
        let (sine, cosine) = match (turns as i64).rem_euclid(4) {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        };
        (sine.widened(spread), cosine.widened(spread))
    }

    /// Sine and cosine of a small argument: with t = y/2^k, sin t and 1 − cos t by their series,
    /// then k times
    ///
    /// sin 2t = 2 sin t cos t = 2 s (1 − v),      1 − cos 2t = 2 sin² t = 2 s².
    ///
    /// For |t| ≤ 1 the terms of either series alternate and decrease, so that the remainder is at
    /// most the first term left out, and the result is widened by that.
    fn reduced(&self, y: &Ball) -> (Ball, Ball) {
        let mut halvings = self.halvings;
        while y.scaled(-halvings).upper() > Radius::power_of_two(0) {
            halvings += 1;
        }
        let t = y.scaled(-halvings);
        let square = -t.squared();
        let last = self.inverse_factorials.len() - 2;
        // Terms t^k/k! from the highest k that is left out down.
        let (mut odd, mut even) = (Ball::zero(), Ball::zero());
        for k in (1..=last).rev() {
            let sum = if k % 2 == 1 { &mut odd } else { &mut even };
            *sum = &*sum * &square + &self.inverse_factorials[k];
        }
        // odd = 1 − t²/3! + ..., even = 1/2! − t²/4! + ...; the first terms left out:
        let size = t.upper();
        let mut left_out = self.inverse_factorials[last + 1].upper();
        for _ in 0..last + 1 {
            left_out = left_out.times(size);
        }
        // One of the two series ends a term earlier, at the degree `last`, so that its first term
        // left out has the degree last + 1, and the other's a smaller one of the degree last + 2.
        let mut sine = (&odd * &t).widened(left_out);
        let mut versine = (-(&even * &square)).widened(left_out);
        for _ in 0..halvings {
            let next = (&sine * &(Ball::integer(1) - &versine)).twice();
            versine = sine.squared().twice();
            sine = next;
        }
        (sine, Ball::integer(1) - versine)
    }
}

/// π/2 = 2 (4 arctan 1/5 − arctan 1/239), Machin 1706.
fn half_pi(limbs: usize) -> Ball {
    let quarter = arctan_of_reciprocal(5, limbs).scaled(2) - arctan_of_reciprocal(239, limbs);
    quarter.twice()
}

/// arctan 1/k = Σ (−1)^j / ((2j + 1) k^(2j + 1)): the terms alternate and fall, so that the first
/// that is left out bounds the remainder.
fn arctan_of_reciprocal(k: u64, limbs: usize) -> Ball {
    let terms = 64 * limbs as u64 / (2 * u64::from(k.ilog2())) + 4;
    let mut power = Ball::integer(1).with_limbs(limbs).over_small(k);
    let mut sum = Ball::zero();
    for j in 0..terms {
        let term = power.over_small(2 * j + 1);
        sum = if j % 2 == 0 { sum + &term } else { sum - &term };
        power = power.over_small(k * k);
    }
    sum.widened(power.over_small(2 * terms + 1).upper())
}
