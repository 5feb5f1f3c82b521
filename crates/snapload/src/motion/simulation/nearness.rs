//! Where the latest step comes near an event that it does not have, or not yet.

use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::motion::events::{EventFunction, HasEvents, Jets};
use crate::motion::extremes::{
    first_above_zero, first_above_zero_before_last_rise, first_above_zero_between,
};
use crate::motion::limits::law::Along;
use crate::motion::simulation::within::{LatestStep, SegmentMotion};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::taut_series::STILL;

/// The beginning of the last rise of a gap is found to this part of the step, and to the other one
/// where neighbours may be taut there.
const RISE: f64 = 1e-2;
const SAME_RISE: f64 = 1e-12;
/// After so many places on the way the search for it ends: with a bound that is not finite it would
/// go on for ever.
const MOST_PLACES: u32 = 1 << 20;

/// A gap to be evaluated, by the best instructions for it.
struct GapAndRate<'a, T: Real>(&'a SegmentMotion<'a, T>, usize, T);

impl<T: Real> Kernel for GapAndRate<'_, T> {
    type Output = (T, T);
    #[inline(always)]
    fn run(self) -> (T, T) {
        self.0.gap_and_rate(self.1, self.2)
    }
}

/// Its rate, likewise.
struct GapRateAndAcceleration<'a, T: Real>(&'a SegmentMotion<'a, T>, usize, T);

impl<T: Real> Kernel for GapRateAndAcceleration<'_, T> {
    type Output = (T, T);
    #[inline(always)]
    fn run(self) -> (T, T) {
        self.0.gap_rate_and_acceleration(self.1, self.2)
    }
}

/// A gap and its rate a time `s` into a step, and how far the gaps of neighbours exceed it there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapAt<T> {
    pub(crate) s: T,
    pub(crate) gap: T,
    pub(crate) rate: T,
    pub(crate) margin: T,
}

/// The gap of a slack cable along the latest step. The motion, which may have to be computed again
/// ([`LatestStep`]), is computed once for many instants.
pub(crate) struct SlackGap<'a, T: Real> {
    simulation: &'a Simulation<T>,
    step: &'a Step<T>,
    cable: usize,
    motion: SegmentMotion<'a, T>,
    /// A bound on |g̈|.
    acceleration: T,
}

impl<T: Real> SlackGap<'_, T> {
    /// The state a time `s` into the step.
    #[inline(always)]
    pub(crate) fn state(&self, s: T) -> State<T> {
        self.motion.state(s)
    }

    /// The gap and its rate then.
    #[inline(always)]
    pub(crate) fn gap_and_rate(&self, s: T) -> (T, T) {
        self.motion.gap_and_rate(self.cable, s)
    }

    #[inline(always)]
    fn duration(&self) -> T {
        self.step.t_end - self.step.t_start
    }

    #[inline(always)]
    fn closes(&self) -> bool {
        self.step.event.reached.gaps.contains(self.cable)
    }

    /// How long after the start of the step the cable first came within `margin` > 0 of a gap of
    /// zero, if it did, before its end; if the cable closes there, before the last rise of its gap.
    /// If a cable was closed at the start, its gap is zero there for all neighbours, and the margin
    /// grows from zero. If it was at rest there, as one that has just lost its tension, it opens
    /// like −s³ or −s² in all neighbours, each from its own release, and may come near only when it
    /// begins to close again.
    #[inline(always)]
    pub(crate) fn comes_near(&self, margin: T) -> Option<T> {
        if self.simulation.stays_away(self.step, self.cable, margin) {
            return None;
        }
        let open = self.simulation.contact_at_start(self.step, self.cable).gap < T::ZERO;
        self.first_near(match open {
            true => [margin, T::ZERO],
            false => [T::ZERO, margin / self.duration()],
        })
    }

    /// How long after the start of the step the gap was first above zero between two instants,
    /// raised by the margins at both and by what lies on the line between them within; none if it
    /// was not. If it is at the first of them, and falls, that is left out.
    #[inline(always)]
    pub(crate) fn comes_near_between(&self, [left, right]: [&GapAt<T>; 2]) -> Option<T> {
        let length = right.s - left.s;
        if length <= T::ZERO {
            return None;
        }
        let slope = (right.margin - left.margin) / length;
        let raised = |(gap, rate): (T, T), later: T| {
            let margin = left.margin + slope * later;
            (gap + margin, rate + slope)
        };
        let nearness = |later: T| {
            let at = GapAndRate(&self.motion, self.cable, left.s + later);
            raised(dispatch_over::<T, _>(at), later)
        };
        let ends = [
            (T::ZERO, raised((left.gap, left.rate), T::ZERO)),
            (length, raised((right.gap, right.rate), length)),
        ];
        let near = first_above_zero_between(ends, &nearness, self.acceleration)?;
        Some(left.s + near)
    }

    /// How long after the start of the step the gap rises for the last time, if the cable closes at
    /// its end; the length of the step if it does not. On a stretch as long as the rate at its end
    /// over the bound on the acceleration the rate does not change its sign. Unless that is where
    /// the rise begins, the gap is below zero by more than the margin.
    #[inline(always)]
    pub(crate) fn last_rise(&self, at: impl Fn(T) -> GapAt<T>) -> GapAt<T> {
        let s = self.duration();
        let mut place = at(s);
        if !self.closes() {
            return place;
        }
        for _ in 0..MOST_PLACES {
            let back = place.rate / self.acceleration;
            if back >= place.s {
                return at(T::ZERO);
            }
            let is_near = back > s * SAME_RISE && place.gap + place.margin >= T::ZERO;
            if back <= s * RISE && !is_near {
                return place;
            }
            place = at(place.s - back);
        }
        place
    }

    /// How long after the start of the step the gap, raised by an offset and at a rate, was first
    /// above zero; if the cable closes at its end, before the last rise.
    #[inline(always)]
    pub(crate) fn first_near(&self, [offset, slope]: [T; 2]) -> Option<T> {
        let s = self.duration();
        let begun = if self.simulation.rested(self.step, self.cable) {
            begins_to_close(&self.motion, self.cable, s)?
        } else {
            T::ZERO
        };
        let nearness = |later: T| {
            let s = begun + later;
            let (gap, rate) = dispatch_over::<T, _>(GapAndRate(&self.motion, self.cable, s));
            (gap + offset + slope * s, rate + slope)
        };
        let s = s - begun;
        let near = if self.closes() {
            first_above_zero_before_last_rise(&nearness, s, self.acceleration)
        } else {
            first_above_zero(&nearness, s, self.acceleration)
        };
        Some(begun + near?)
    }
}

impl<T: Real> Simulation<T> {
    /// The gap of a cable that is slack in the latest step.
    #[inline(always)]
    pub(crate) fn slack_gap<'a>(&'a self, step: &'a Step<T>, cable: usize) -> SlackGap<'a, T> {
        SlackGap {
            simulation: self,
            step,
            cable,
            motion: self.motion(step.taut),
            acceleration: self.gap_acceleration_bound(step, cable),
        }
    }

    /// Whether, by the gap at both ends of the latest step and a bound on its acceleration, a cable
    /// stays farther than `margin` from a gap of zero.
    #[inline(always)]
    pub(crate) fn stays_away(&self, step: &Step<T>, cable: usize, margin: T) -> bool {
        let s = step.t_end - step.t_start;
        let acceleration = self.gap_acceleration_bound(step, cable);
        let first = self.contact_at_start(step, cable).gap;
        let last = self.contact(cable).gap;
        s <= T::ZERO || first.max(last) + margin + acceleration * s * s * 0.125 < T::ZERO
    }

    /// Bounds on |∂ġ/∂z|, z = (x, y, θ, ẋ, ẏ, θ̇), along the latest step: of ġ = 2 d·Ṗ, |d| ≤ r.
    pub(crate) fn slope_bounds_of_gap_rate(&self, step: &Step<T>, cable: usize) -> [T; 6] {
        let latest = LatestStep {
            simulation: self,
            step,
        };
        let s = step.t_end - step.t_start;
        let [x, y, turn] = [0, 1, 2].map(|i| latest.derivative_bound(2, i) * s);
        let tether = &self.system().cables[cable];
        let (reach, r) = (tether.fairlead().length(), tether.length());
        let spin = step.start.vtheta.abs() + turn;
        let speed = step.start.velocity().length() + x + y + spin * reach;
        let by_turn = reach * (speed + spin * r);
        [speed, speed, by_turn, r, r, r * reach].map(|slope| slope * 2.0)
    }

    /// Bound on |g̈| = 2 |Ṗ² + d·P̈| along the latest step.
    #[inline(always)]
    fn gap_acceleration_bound(&self, step: &Step<T>, cable: usize) -> T {
        if let Some(series) = self.expanded(step.taut) {
            return series.gap_acceleration_bound(cable);
        }
        let tether = &self.system().cables[cable];
        let (start, reach) = (&step.start, tether.fairlead().length());
        let spin = start.vtheta.abs();
        let accel = self.system().forcing.bounds()[0] + spin * spin * reach;
        let s = step.t_end - step.t_start;
        let speed = start.velocity().length() + spin * reach + accel * s;
        (speed * speed + tether.length() * accel) * 2.0
    }

    /// How long after its start the quantity of a limit first came within `margin` > 0 and rounding
    /// of its bound in the latest step, if it did; if the limit ends the step, before the last rise
    /// to it.
    pub(crate) fn comes_near_limit(&self, step: &Step<T>, limit: Limit, margin: T) -> Option<T> {
        let s = step.t_end - step.t_start;
        let motion = self.motion(step.taut);
        let jets_at = |s: T| {
            let mut jets = Jets::new();
            match &motion {
                SegmentMotion::Closed(flight) => flight.jets_at(s, &mut jets),
                SegmentMotion::Expanded(series) => series.jets_at(s, &mut jets),
            }
            jets
        };
        let function = EventFunction::Limit(limit);
        let ends = jets_at(s);
        let count = ends.iter().filter(|jet| jet.function == function).count();
        let latest = LatestStep {
            simulation: self,
            step,
        };
        let acceleration = limit.acceleration_bound(self.system(), &latest);
        let near = |k: usize| {
            // Which of the points of the body's outline.
            let nearness = |s: T| {
                let jets = jets_at(s);
                let jet = jets.iter().filter(|jet| jet.function == function).nth(k);
                jet.map_or((-T::ONE, T::ZERO), |jet| {
                    (jet.value + jet.noise + margin, jet.rate)
                })
            };
            if step.event.reached.limits.contains(limit) {
                first_above_zero_before_last_rise(&nearness, s, acceleration)
            } else {
                first_above_zero(&nearness, s, acceleration)
            }
        };
        let all = (0..count).filter(|_| s > T::ZERO).filter_map(near);
        all.reduce(T::min)
    }
}

/// When the gap of a cable that was at rest at the start of a motion of length `s` begins to close,
/// if it does.
fn begins_to_close<T: Real>(motion: &SegmentMotion<'_, T>, cable: usize, s: T) -> Option<T> {
    let jerk = match motion {
        SegmentMotion::Closed(flight) => flight.gap_jerk_bound(cable, s),
        SegmentMotion::Expanded(series) => series.gap_jerk_bound(cable),
    };
    let rate = |s: T| {
        let (rate, acceleration) = dispatch_over::<T, _>(GapRateAndAcceleration(motion, cable, s));
        (rate - STILL, acceleration)
    };
    first_above_zero(&rate, s, jerk)
}
