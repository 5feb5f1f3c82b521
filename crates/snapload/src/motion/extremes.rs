//! The highest point and the largest rotation reached along a motion.

use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::state::State;

/// y_max and |θ|_max so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extremes<T> {
    pub(crate) y_max: T,
    pub(crate) theta_max: T,
}

/// The accuracy of a maximum between two events; its time, where the motion is flat, is known to
/// the square root of it.
const RESOLUTION: f64 = 1e-15;

impl<T: Real> Extremes<T> {
    pub(crate) fn at(state: &State<T>) -> Self {
        Self {
            y_max: state.y,
            theta_max: state.theta.abs(),
        }
    }

    /// Takes in a segment of motion of duration `s` from `first` to `last`, on which ÿ ≤ `up`, |ÿ|
    /// ≤ `y_accel` and |θ̈| ≤ `theta_accel`. `state` gives the state within.
    #[inline(always)]
    pub(crate) fn cover(
        &mut self,
        state: impl Fn(T) -> State<T>,
        s: T,
        [first, last]: [&State<T>; 2],
        [up, y_accel, theta_accel]: [T; 3],
    ) {
        apart!(T, {
            let bulge = s * s * 0.125;
            let y = first.y.max(last.y) + y_accel * bulge;
            let theta = first.theta.abs().max(last.theta.abs()) + theta_accel * bulge;
            if y <= self.y_max && theta <= self.theta_max {
                return;
            }
            let height = |s: T| {
                let now = state(s);
                (now.y, now.vy)
            };
            self.y_max = highest(&height, s, up, y_accel, self.y_max);
            for side in [T::ONE, -T::ONE] {
                let rotation = |s: T| {
                    let now = state(s);
                    (side * now.theta, side * now.vtheta)
                };
                self.theta_max = highest(&rotation, s, theta_accel, theta_accel, self.theta_max);
            }
        })
    }
}

/// Whether a function with |f̈| ≤ `bound` has a maximum above zero inside \[0, s\].
#[inline(always)]
pub(crate) fn rises_above_zero<T: Real>(f: &impl Fn(T) -> (T, T), s: T, bound: T) -> bool {
    let mut record = T::ZERO;
    search(
        f,
        (T::ZERO, f(T::ZERO)),
        (s, f(s)),
        bound,
        bound,
        &mut record,
    );
    record > T::ZERO
}

/// The larger of `record` and the maximum over \[0, s\] of a function given with its derivative, by
/// bisecting the intervals on which, with f̈ ≤ `up` and |f̈| ≤ `bound`, the record could be
/// exceeded.
pub(crate) fn highest<T: Real>(f: &impl Fn(T) -> (T, T), s: T, up: T, bound: T, record: T) -> T {
    let (first, last) = (f(T::ZERO), f(s));
    let mut record = record.max(first.0).max(last.0);
    search(f, (T::ZERO, first), (s, last), up, bound, &mut record);
    record
}

fn search<T: Real>(
    f: &impl Fn(T) -> (T, T),
    left: (T, (T, T)),
    right: (T, (T, T)),
    up: T,
    bound: T,
    record: &mut T,
) {
    let width = right.0 - left.0;
    // No maximum inside if the rate stays negative throughout, or positive throughout.
    if left.1.1 + up.max(T::ZERO) * width <= T::ZERO
        || right.1.1 - up.max(T::ZERO) * width >= T::ZERO
    {
        return;
    }
    // The maximum exceeds the values at the ends by at most the effect of the curvature over the
    // width, or of the rate at one end and its possible increase.
    let bulge = bound * width * width * 0.125;
    let gain = up.max(T::ZERO) * width * 0.5;
    let from_left = left.1.0 + ((left.1.1 + gain) * width).max(T::ZERO);
    let from_right = right.1.0 + ((gain - right.1.1) * width).max(T::ZERO);
    let most = left.1.0.max(right.1.0) + bulge;
    if most.min(from_left).min(from_right) <= *record + RESOLUTION {
        return;
    }
    // On a concave function, where the rate, taken as linear, passes through zero.
    let secant = left.0 + width * (left.1.1 / (left.1.1 - right.1.1));
    let middle = if up <= T::ZERO && left.0 < secant && secant < right.0 {
        secant
    } else {
        left.0 + width * 0.5
    };
    if !(left.0 < middle && middle < right.0) {
        return;
    }
    let centre = (middle, f(middle));
    *record = record.max(centre.1.0);
    search(f, left, centre, up, bound, record);
    search(f, centre, right, up, bound, record);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_top_of_a_throw_and_of_a_wave() {
        let throw = |s: f64| (s - 0.5 * s * s, 1.0 - s);
        assert!((highest(&throw, 3.0, -1.0, 1.0, -9.0) - 0.5).abs() < 1e-14);
        let wave = |s: f64| ((7.0 * s).sin() + 0.3 * s, 7.0 * (7.0 * s).cos() + 0.3);
        let known = (0..=2_000_000)
            .map(|k| wave(k as f64 * 1e-6).0)
            .fold(0.0, f64::max);
        assert!((highest(&wave, 2.0, 49.0, 49.0, 0.0) - known).abs() < 1e-10);
        assert_eq!(highest(&throw, 3.0, -1.0, 1.0, 7.0), 7.0);
    }
}
