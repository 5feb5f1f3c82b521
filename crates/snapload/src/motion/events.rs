//! The earliest crossing, with the bound that excludes earlier ones.
//!
//! Every event of a run is the zero of a function of time that is negative before: a gap that
//! closes, a tension that is lost (as −T), a limit that is reached. The search does not sample for
//! changes of sign.
//! With f, ḟ, f̈ known at s and |f⃛(s + σ)| ≤ K for 0 ≤ σ ≤ H, Taylor's theorem gives
//!
//! ```text
//! f(s + σ) ≤ U(σ) = f + ḟσ + f̈σ²/2 + Kσ³/6        (0 ≤ σ ≤ H)
//! ```
//!
//! so f has no zero before the first root of U, and the search steps to just there. Near a simple
//! zero U differs from f by a third-order term, so the steps converge cubically, always from below;
//! near a maximum of f just below zero, U stays negative once the step is short enough, and the
//! search steps past it. Cables closed at the start of the search (just struck, or released) have f
//! = 0 as a *known* value, not an evaluated one, so that they are not found again at once, without
//! a tolerance or waiting time.

use crate::arithmetic::real::Real;
use crate::model::rules::{LIMIT_FUNCTIONS, Limit, LimitSet};
use crate::model::taut_set::MAX_CABLES;

/// An event function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EventFunction {
    /// The gap of a slack cable.
    Gap(usize),
    /// Minus the tension of a taut cable.
    Tension(usize),
    /// What a limit bounds, less its bound.
    Limit(Limit),
}

/// An event function at one instant of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet<T> {
    pub(crate) function: EventFunction,
    /// f ≤ 0.
    pub(crate) value: T,
    /// ḟ.
    pub(crate) rate: T,
    /// f̈.
    pub(crate) accel: T,
    /// |f⃛(s + σ)| ≤ `third` + `fourth` σ.
    pub(crate) third: T,
    pub(crate) fourth: T,
    /// Bound on the rounding error of `value`, not including errors of the motion's start.
    pub(crate) noise: T,
    /// Bound on the change of `value` by the rounding of the velocities at the motion's start; for
    /// a function at rest, the bound below which it counts as zero.
    pub(crate) start_noise: T,
    /// Whether f = ḟ = 0 is known here, the cable being at rest on its constraint; then `jerk` is
    /// f⃛.
    pub(crate) resting: bool,
    pub(crate) jerk: T,
}

impl<T: Real> Jet<T> {
    /// A function with known value and rate only; the rest is filled in by struct update.
    pub(crate) fn new(function: EventFunction, value: T, rate: T, accel: T) -> Self {
        Self {
            function,
            value,
            rate,
            accel,
            third: T::ZERO,
            fourth: T::ZERO,
            noise: T::ZERO,
            start_noise: T::ZERO,
            resting: false,
            jerk: T::ZERO,
        }
    }
}

/// The most event functions of a motion: a gap or a tension of each cable, and those of the
/// limits.
const MAX_EVENT_FUNCTIONS: usize = MAX_CABLES + LIMIT_FUNCTIONS;

/// The jets of all event functions at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jets<T> {
    list: [Option<Jet<T>>; MAX_EVENT_FUNCTIONS],
    count: usize,
}

impl<T: Real> Jets<T> {
    pub(crate) fn new() -> Self {
        Self {
            list: [None; MAX_EVENT_FUNCTIONS],
            count: 0,
        }
    }
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }
    pub(crate) fn push(&mut self, jet: Jet<T>) {
        self.list[self.count] = Some(jet);
        self.count += 1;
    }
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Jet<T>> {
        self.list[..self.count].iter().flatten()
    }
}

/// A motion between two events, as the search sees it.
pub(crate) trait HasEvents<T> {
    /// All event functions at `s` after the motion's start.
    fn jets_at(&self, s: T, jets: &mut Jets<T>);
}

/// Where the search ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing<T> {
    /// Time since the motion's start.
    pub(crate) s: T,
    /// The functions that reach zero there: more than one if their intervals of location overlap.
    pub(crate) reached: Reached,
}

/// The functions that reach zero at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Reached {
    pub(crate) gaps: crate::model::taut_set::TautSet,
    pub(crate) tensions: crate::model::taut_set::TautSet,
    pub(crate) limits: LimitSet,
}

impl Reached {
    /// Whether tensions are lost, and nothing else happens.
    pub(crate) fn is_of_tensions(&self) -> bool {
        let tensions = Self {
            tensions: self.tensions,
            ..Self::default()
        };
        !self.tensions.is_empty() && *self == tensions
    }

    fn add(&mut self, function: EventFunction) {
        match function {
            EventFunction::Gap(cable) => self.gaps = self.gaps.with(cable),
            EventFunction::Tension(cable) => self.tensions = self.tensions.with(cable),
            EventFunction::Limit(limit) => self.limits.insert(limit),
        }
    }
}

/// A search that goes forward by no more than a rounding so often does not get on: its bounds are
/// not finite, or so large that none of them tells anything. Near a zero it takes a few such steps.
const MOST_CRAWLS: u32 = 1000;

/// The first instant in (0, horizon] after time `t` at which an event function reaches zero from
/// below, or `None`.
///
/// The error of the crossing is (rounding of f)/ḟ plus a rounding of s. Functions whose intervals
/// of location overlap, or whose times are bit-equal, cross at one instant; the intervals include
/// the rounding of the velocities, too, so that impacts which are simultaneous by symmetry stay so
/// although rounding breaks the symmetry. Where the search does not get on, nothing is reached, a
/// time of zero later: the motion stands still.
#[inline(always)]
pub(crate) fn first_crossing<T: Real>(
    motion: &impl HasEvents<T>,
    t: T,
    horizon: T,
) -> Option<Crossing<T>> {
    let mut jets = Jets::new();
    let mut s = T::ZERO;
    let mut crawls = 0;
    loop {
        jets.clear();
        motion.jets_at(s, &mut jets);
        if let Some(crossing) = located(&jets, t, s) {
            return (crossing.s <= horizon).then_some(crossing);
        }
        // A horizon that is no number ends the search, too.
        let ahead = s < horizon;
        if !ahead {
            return None;
        }
        let remaining = horizon - s;
        let step = jets
            .iter()
            .fold(remaining, |step, jet| safe_step(jet, step));
        // At least a rounding forward, so that the search terminates.
        let least = (s + horizon * T::EPSILON) * T::EPSILON;
        let gets_on = step > least;
        if !gets_on {
            crawls += 1;
            if crawls > MOST_CRAWLS {
                let (s, reached) = (T::ZERO, Reached::default());
                return Some(Crossing { s, reached });
            }
        }
        let next = s + step.max(least);
        s = if next < horizon {
            next.detached()
        } else {
            horizon
        };
    }
}

/// The crossing here, if a function is within its rounding of zero and still rising.
///
/// It is where the tangent reaches zero, which has to be near: within √ε of the unit of time the
/// curvature changes a function by less than its rounding. One that rises so slowly that its
/// tangent needs longer may turn back, or others may cross before; it counts as just below zero,
/// and the search continues.
fn located<T: Real>(jets: &Jets<T>, t: T, s: T) -> Option<Crossing<T>> {
    let rises_soon = |jet: &&Jet<T>| {
        let near = |jet: &Jet<T>| jet.value.squared() <= jet.rate.squared() * T::EPSILON;
        jet.rate > T::ZERO && (jet.value >= T::ZERO || near(jet))
    };
    // A contact known at the start (value and noise 0) that rises at once is located there, too.
    let touches = |jet: &&Jet<T>| jet.value >= -jet.noise && rises_soon(jet);
    let root = |jet: &Jet<T>| s - jet.value / jet.rate;
    let spread = |jet: &Jet<T>| (jet.noise + jet.start_noise) / jet.rate + s * T::EPSILON;
    let first = jets
        .iter()
        .filter(touches)
        .reduce(|a, b| if root(b) < root(a) { b } else { a })?;
    // The interval of a slow function is as wide as the uncertainty of its tangent, so it is
    // compared only if the first is as slow.
    let comparable = |jet: &&Jet<T>| rises_soon(jet) || jet.rate * 2.0 >= first.rate;
    let mut reached = Reached::default();
    for jet in jets.iter().filter(comparable) {
        let same_time = t + root(jet) == t + root(first);
        if same_time || root(jet) - spread(jet) <= root(first) + spread(first) {
            reached.add(jet.function);
        }
    }
    Some(Crossing {
        s: root(first).max(T::ZERO),
        reached,
    })
}

/// The longest step up to `limit` that provably passes no zero of the function.
fn safe_step<T: Real>(jet: &Jet<T>, limit: T) -> T {
    if jet.resting {
        return safe_step_from_rest(jet, limit);
    }
    // Past a maximum that lies within rounding of zero the function counts as just below it.
    let value = jet.value.min(-jet.noise);
    if jet.third == T::ZERO && jet.fourth == T::ZERO && jet.accel == T::ZERO {
        return if jet.rate > T::ZERO {
            (-value / jet.rate).min(limit)
        } else {
            limit
        };
    }
    let mut reach = limit.min(parabola_root(value, jet.rate, jet.accel).unwrap_or(limit));
    // The bound on f⃛ is for the whole stretch, so that a stretch much longer than the resulting
    // step is shortened.
    for _ in 0..3 {
        let step = cubic_root(
            value,
            jet.rate,
            jet.accel,
            jet.third + jet.fourth * reach,
            reach,
        );
        if step * 4.0 >= reach {
            return step;
        }
        reach = step * 4.0;
    }
    cubic_root(
        value,
        jet.rate,
        jet.accel,
        jet.third + jet.fourth * reach,
        reach,
    )
}

/// The first step from f = ḟ = 0, f̈ ≤ 0: below the root of f̈/2 + f⃛σ/6 + Kσ²/24, where `fourth` =
/// K bounds the fourth derivative over one unit of time, to which the step is held.
fn safe_step_from_rest<T: Real>(jet: &Jet<T>, limit: T) -> T {
    let limit = limit.min(T::ONE);
    let (a, b, c) = (
        jet.accel.min(T::ZERO) * 0.5,
        jet.jerk * (1.0 / 6.0),
        jet.fourth * (1.0 / 24.0),
    );
    let root = if a < T::ZERO {
        parabola_root(a, b, c * 2.0).unwrap_or(limit)
    } else if b < T::ZERO && c > T::ZERO {
        -b / c
    } else if b <= T::ZERO && c == T::ZERO {
        limit
    } else {
        T::ZERO
    };
    let bound = |step: T| (a + (b + c * step) * step) * step * step;
    let mut harmless = limit;
    // While the function provably stays within a rounding of zero it may be stepped over, so that
    // the search does not stop at a touch of higher order than the bound resolves.
    while bound(harmless) > jet.start_noise {
        harmless = harmless * 0.5;
    }
    root.max(harmless).min(limit)
}

/// The first positive root of f + ḟσ + f̈σ²/2 with f ≤ 0, if there is one; at f = 0, ḟ < 0 the one
/// after the start.
fn parabola_root<T: Real>(f: T, rate: T, accel: T) -> Option<T> {
    let discriminant = rate.squared() - accel * f * 2.0;
    if discriminant < T::ZERO {
        return None;
    }
    let root = discriminant.sqrt();
    let s = if rate > T::ZERO {
        // Both summands of the denominator have one sign: no cancellation.
        -f * 2.0 / (rate + root)
    } else if accel > T::ZERO {
        (root - rate) / accel
    } else {
        return None;
    };
    Some(s)
}

/// The first root in (0, reach] of U(σ) = f + ḟσ + f̈σ²/2 + kσ³/6 with f ≤ 0 ≤ k, or `reach`.
///
/// U is concave up to its turning point −f̈/k and convex after it. On the concave side Newton's
/// iteration from the left, on the convex side from the right, is monotone: neither passes the root
/// in exact arithmetic, and a rounding past it is what `noise` allows for.
fn cubic_root<T: Real>(f: T, rate: T, accel: T, k: T, reach: T) -> T {
    let value = |s: T| ((k * s * (1.0 / 6.0) + accel * 0.5) * s + rate) * s + f;
    let slope = |s: T| (k * s * 0.5 + accel) * s + rate;
    if f == T::ZERO && rate <= T::ZERO {
        // A contact that opens: U/σ is a parabola.
        return parabola_root(rate, accel * 0.5, k * (1.0 / 3.0)).map_or(reach, |s| s.min(reach));
    }
    if accel < T::ZERO && rate > T::ZERO {
        let turning = if k * reach > -accel {
            -accel / k
        } else {
            reach
        };
        let discriminant = accel.squared() - k * rate * 2.0;
        let summit = if discriminant > T::ZERO {
            (rate * 2.0 / (discriminant.sqrt() - accel)).min(turning)
        } else {
            turning
        };
        if value(summit) >= T::ZERO {
            return newton(value, slope, T::ZERO);
        }
    }
    if value(reach) < T::ZERO {
        return reach;
    }
    newton(value, slope, reach)
}

/// Newton's iteration from a point from which it is monotone, until it no longer changes.
fn newton<T: Real>(value: impl Fn(T) -> T, slope: impl Fn(T) -> T, from: T) -> T {
    let mut s = from;
    for _ in 0..80 {
        let next = s - value(s) / slope(s);
        let moves = (next - s).abs() > s.abs() * T::EPSILON * 2.0;
        // A slope of zero gives infinity or NaN, which also ends the iteration.
        if !moves || !next.is_finite() {
            break;
        }
        s = next;
    }
    s
}
