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

/// So many evaluations are made at most in one search: a bound that overflows would otherwise
/// exclude nothing, down to every double of the stretch. A search takes some dozens.
const MOST_EVALUATIONS: u32 = 1 << 20;

/// A place with value and rate there.
pub(crate) type Place<T> = (T, (T, T));

/// An instant is found to this part of the stretch that is searched.
const INSTANT: f64 = 1e-6;

/// The first instant inside \[0, s\] at which a function with |f̈| ≤ `bound` is above zero; none if
/// it is not. If it is at the start, and falls, that is left out.
#[inline(always)]
pub(crate) fn first_above_zero<T: Real>(f: &impl Fn(T) -> (T, T), s: T, bound: T) -> Option<T> {
    first_above_zero_between([(T::ZERO, f(T::ZERO)), (s, f(s))], f, bound)
}

/// The same between two places at which the function is known.
#[inline(always)]
pub(crate) fn first_above_zero_between<T: Real>(
    [left, right]: [Place<T>; 2],
    f: &impl Fn(T) -> (T, T),
    bound: T,
) -> Option<T> {
    let least = (right.0 - left.0) * INSTANT;
    first_above([left, right], f, bound, least)
}

/// The same for a function that passes zero in its last rise: the first instant before that rise.
/// On a stretch as long as the rate at its end over `bound` the rate does not change its sign.
#[inline(always)]
pub(crate) fn first_above_zero_before_last_rise<T: Real>(
    f: &impl Fn(T) -> (T, T),
    s: T,
    bound: T,
) -> Option<T> {
    let least = s * INSTANT;
    let mut last = (s, f(s));
    for _ in 0..MOST_EVALUATIONS {
        let above = last.1.0 >= T::ZERO;
        if !above {
            return first_above([(T::ZERO, f(T::ZERO)), last], f, bound, least);
        }
        let back = last.1.1 / bound;
        if back >= last.0 {
            return None;
        }
        if back <= least * INSTANT {
            break;
        }
        let place = last.0 - back;
        last = (place, f(place));
    }
    let first = first_above([(T::ZERO, f(T::ZERO)), last], f, bound, least);
    first.or(Some(last.0))
}

fn first_above<T: Real>(
    places: [Place<T>; 2],
    f: &impl Fn(T) -> (T, T),
    bound: T,
    least: T,
) -> Option<T> {
    let mut left = MOST_EVALUATIONS;
    first_above_within(places, f, [bound, least], &mut left)
}

/// The same with at most so many evaluations more; where they do not suffice, the function may
/// be above zero where they end.
fn first_above_within<T: Real>(
    [left, right]: [Place<T>; 2],
    f: &impl Fn(T) -> (T, T),
    [bound, least]: [T; 2],
    evaluations: &mut u32,
) -> Option<T> {
    let width = right.0 - left.0;
    let falls = left.1.1 + bound * width <= T::ZERO;
    let rises = right.1.1 - bound * width >= T::ZERO;
    let stays_below = most_between([left, right], bound, bound) <= T::from_f64(RESOLUTION);
    if falls || stays_below || rises && right.1.0 <= T::ZERO {
        return None;
    }
    if left.1.0 > T::ZERO && left.1.1 >= T::ZERO {
        return Some(left.0);
    }
    let middle = left.0 + width * 0.5;
    let crosses = left.1.0 <= T::ZERO && right.1.0 > T::ZERO;
    if !(left.0 < middle && middle < right.0) || width <= least && (crosses || left.1.0 > T::ZERO) {
        return crosses.then_some(left.0);
    }
    if *evaluations == 0 {
        return Some(left.0);
    }
    *evaluations -= 1;
    let centre = (middle, f(middle));
    first_above_within([left, centre], f, [bound, least], evaluations)
        .or_else(|| first_above_within([centre, right], f, [bound, least], evaluations))
}

/// A bound between two places: the maximum exceeds the values there by at most the effect of the
/// curvature over the width, or of the rate at one of them and its possible increase.
#[inline(always)]
fn most_between<T: Real>([left, right]: [Place<T>; 2], up: T, bound: T) -> T {
    let width = right.0 - left.0;
    let bulge = bound * width * width * 0.125;
    let gain = up.max(T::ZERO) * width * 0.5;
    let from_left = left.1.0 + ((left.1.1 + gain) * width).max(T::ZERO);
    let from_right = right.1.0 + ((gain - right.1.1) * width).max(T::ZERO);
    let most = left.1.0.max(right.1.0) + bulge;
    most.min(from_left).min(from_right)
}

/// The larger of `record` and the maximum over \[0, s\] of a function given with its derivative, by
/// bisecting the intervals on which, with f̈ ≤ `up` and |f̈| ≤ `bound`, the record could be
/// exceeded.
pub(crate) fn highest<T: Real>(f: &impl Fn(T) -> (T, T), s: T, up: T, bound: T, record: T) -> T {
    let (first, last) = (f(T::ZERO), f(s));
    let mut best = Best {
        record: record.max(first.0).max(last.0),
        evaluations: MOST_EVALUATIONS,
    };
    let both = [(T::ZERO, first), (s, last)];
    search(f, both, [up, bound], MOST_SECANTS, &mut best);
    best.record
}

/// The largest value so far, and how many evaluations are left.
struct Best<T> {
    record: T,
    evaluations: u32,
}

/// An interval is divided so often at most where the rate, taken as linear, passes through zero,
/// which takes few steps unless the rate is almost flat there; after that it is bisected.
const MOST_SECANTS: u32 = 40;

fn search<T: Real>(
    f: &impl Fn(T) -> (T, T),
    [left, right]: [Place<T>; 2],
    [up, bound]: [T; 2],
    secants: u32,
    best: &mut Best<T>,
) {
    let width = right.0 - left.0;
    // No maximum inside if the rate stays negative throughout, or positive throughout.
    if left.1.1 + up.max(T::ZERO) * width <= T::ZERO
        || right.1.1 - up.max(T::ZERO) * width >= T::ZERO
    {
        return;
    }
    if most_between([left, right], up, bound) <= best.record + RESOLUTION {
        return;
    }
    // On a concave function, where the rate, taken as linear, passes through zero.
    let secant = left.0 + width * (left.1.1 / (left.1.1 - right.1.1));
    let middle = if up <= T::ZERO && secants > 0 && left.0 < secant && secant < right.0 {
        secant
    } else {
        left.0 + width * 0.5
    };
    if !(left.0 < middle && middle < right.0) || best.evaluations == 0 {
        return;
    }
    best.evaluations -= 1;
    let centre = (middle, f(middle));
    best.record = best.record.max(centre.1.0);
    let remaining = secants.saturating_sub(1);
    search(f, [left, centre], [up, bound], remaining, best);
    search(f, [centre, right], [up, bound], remaining, best);
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

    /// Where the waves' force cancels the weight for an instant in which the body is at its
    /// top, the rate has a triple zero there: the secant's steps, a thousandth of the
    /// interval each, would be thousands.
    #[test]
    fn finds_a_top_with_a_flat_rate_in_few_steps() {
        let evaluations = std::cell::Cell::new(0);
        for place in [0.3, 0.5, 0.9] {
            let flat = |s: f64| {
                evaluations.set(evaluations.get() + 1);
                (-(s - place).powi(4), -4.0 * (s - place).powi(3))
            };
            assert!(highest(&flat, 1.0, 0.0, 12.0, -9.0).abs() < 1e-14);
        }
        assert!(evaluations.get() < 600, "{}", evaluations.get());
    }

    /// A bound that is infinite or no number excludes nothing, and the searches end all the same,
    /// with the best that they have seen: it is not below the ends, nor above the top.
    #[test]
    fn a_search_without_a_bound_ends() {
        for bound in [f64::INFINITY, f64::NAN, 1e300] {
            let evaluations = std::cell::Cell::new(0_u32);
            let throw = |s: f64| {
                evaluations.set(evaluations.get() + 1);
                (s - 0.5 * s * s, 1.0 - s)
            };
            let top = highest(&throw, 3.0, bound, bound, -9.0);
            assert!((0.0..=0.5).contains(&top), "{bound}: {top}");
            let below = |s: f64| (throw(s).0 - 9.0, throw(s).1);
            first_above_zero(&below, 3.0, bound);
            let above = |s: f64| (throw(s).0 + 9.0, 1.0);
            first_above_zero_before_last_rise(&above, 3.0, bound);
            assert!(evaluations.get() < 5 * MOST_EVALUATIONS, "{bound}");
        }
    }

    /// −½ − cos 3s passes zero at cos 3s = −½, and again in its last rise before s = 2.9; a
    /// parabola that begins above zero passes it at 1 + √½ alone.
    #[test]
    fn finds_where_a_function_first_passes_zero() {
        let near = |found: Option<f64>, place: f64| {
            found.is_some_and(|found| place - 1e-5 < found && found <= place)
        };
        let wave = |s: f64| (-0.5 - (3.0 * s).cos(), 3.0 * (3.0 * s).sin());
        let first = 2.0 * std::f64::consts::PI / 9.0;
        assert!(near(first_above_zero(&wave, 2.9, 9.0), first));
        let before = |s: f64| first_above_zero_before_last_rise(&wave, s, 9.0);
        assert!(near(before(2.9), first));
        assert_eq!(before(0.9), None);
        let parabola = |s: f64| ((s - 1.0).powi(2) - 0.5, 2.0 * (s - 1.0));
        assert!(near(
            first_above_zero(&parabola, 2.0, 2.0),
            1.0 + 0.5_f64.sqrt()
        ));
        assert_eq!(first_above_zero(&parabola, 1.7, 2.0), None);
        assert_eq!(first_above_zero_before_last_rise(&parabola, 2.0, 2.0), None);
    }
}
