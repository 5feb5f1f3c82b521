//! Where the latest step comes near an event that it does not have, or not yet.

use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::rules::Limit;
use crate::motion::events::{EventFunction, HasEvents, Jets};
use crate::motion::extremes::{first_above_zero, first_above_zero_before_last_rise};
use crate::motion::limits::Along;
use crate::motion::simulation::within::{LatestStep, SegmentMotion};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::taut_series::STILL;

/// The beginning of the last rise of a gap is found to this part of the step, and to the other one
/// where neighbours may be taut there.
const RISE: f64 = 1e-2;
const SAME_RISE: f64 = 1e-12;

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

impl<T: Real> Simulation<T> {
    /// How long after its start a cable that is slack in the latest step first came within
    /// `margin` > 0 of a gap of zero, if it did, before its end; if the cable closes there, before
    /// the last rise of its gap. If a cable was closed at the start, its gap is zero there for all
    /// neighbours, and the margin grows from zero. If it was at rest there, as one that has just
    /// lost its tension, it opens like −s³ or −s² in all neighbours, each from its own release, and
    /// may come near only when it begins to close again.
    #[inline(always)]
    pub(crate) fn comes_near(&self, step: &Step<T>, cable: usize, margin: T) -> Option<T> {
        let s = step.t_end - step.t_start;
        if s <= T::ZERO {
            return None;
        }
        let acceleration = self.gap_acceleration_bound(step, cable);
        let first = self.contact_at_start(step, cable).gap;
        let last = self.contact(cable).gap;
        if first.max(last) + margin + acceleration * s * s * 0.125 < T::ZERO {
            return None;
        }
        let (offset, slope) = if first < T::ZERO {
            (margin, T::ZERO)
        } else {
            (T::ZERO, margin / s)
        };
        self.first_near(step, cable, [offset, slope], acceleration)
    }

    /// How long after its start the gap of a cable was first above zero in a part of the latest
    /// step, from one time after its start to another, raised by margins at both and by what
    /// lies on the line between them within; none if it was not. If it is at the start of the
    /// part, and falls, that is left out.
    pub(crate) fn comes_near_between(
        &self,
        step: &Step<T>,
        cable: usize,
        [first, last]: [T; 2],
        [from, to]: [T; 2],
    ) -> Option<T> {
        let length = to - from;
        if length <= T::ZERO {
            return None;
        }
        let (bound, motion) = (
            self.gap_acceleration_bound(step, cable),
            self.motion(step.taut),
        );
        let slope = (last - first) / length;
        let nearness = |later: T| {
            let at = GapAndRate(&motion, cable, from + later);
            let (gap, rate) = dispatch_over::<T, _>(at);
            (gap + first + slope * later, rate + slope)
        };
        Some(from + first_above_zero(&nearness, length, bound)?)
    }

    /// How long after its start the gap of a cable rises for the last time in the latest step, if
    /// the cable closes at its end; the length of the step if it does not. On a stretch as long as
    /// the rate at its end over the bound on the acceleration the rate does not change its sign.
    /// Unless that is where the rise begins, the gap is below zero by more than the margin.
    pub(crate) fn last_rise(&self, step: &Step<T>, cable: usize, margin: impl Fn(T) -> T) -> T {
        let s = step.t_end - step.t_start;
        if !step.event.reached.gaps.contains(cable) {
            return s;
        }
        let (bound, motion) = (
            self.gap_acceleration_bound(step, cable),
            self.motion(step.taut),
        );
        let mut place = s;
        loop {
            let at = GapAndRate(&motion, cable, place);
            let (gap, rate) = dispatch_over::<T, _>(at);
            let back = rate / bound;
            if back >= place {
                return T::ZERO;
            }
            let is_near = back > s * SAME_RISE && gap + margin(place) >= T::ZERO;
            if back <= s * RISE && !is_near {
                return place;
            }
            place -= back;
        }
    }

    /// How long after its start the gap of a cable first came within a margin of zero in the latest
    /// step that grows at a rate; if the cable closes there, before the last rise of its gap.
    pub(crate) fn comes_near_by(
        &self,
        step: &Step<T>,
        cable: usize,
        margin_and_rate: [T; 2],
    ) -> Option<T> {
        let acceleration = self.gap_acceleration_bound(step, cable);
        self.first_near(step, cable, margin_and_rate, acceleration)
    }

    /// How long after its start the gap of a cable, raised by an offset and at a rate, was first
    /// above zero in the latest step, given a bound on its acceleration.
    #[inline(always)]
    fn first_near(
        &self,
        step: &Step<T>,
        cable: usize,
        [offset, slope]: [T; 2],
        acceleration: T,
    ) -> Option<T> {
        let s = step.t_end - step.t_start;
        let motion = self.motion(step.taut);
        let begun = if self.rested(step, cable) {
            begins_to_close(&motion, cable, s)?
        } else {
            T::ZERO
        };
        let nearness = |later: T| {
            let s = begun + later;
            let (gap, rate) = dispatch_over::<T, _>(GapAndRate(&motion, cable, s));
            (gap + offset + slope * s, rate + slope)
        };
        let s = s - begun;
        let near = if step.event.reached.gaps.contains(cable) {
            first_above_zero_before_last_rise(&nearness, s, acceleration)
        } else {
            first_above_zero(&nearness, s, acceleration)
        };
        Some(begun + near?)
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

    /// How long after its start the quantity of a limit first came within `margin` > 0 of its bound
    /// in the latest step, if it did; if the limit ends the step, before the last rise to it.
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
                jet.map_or((-T::ONE, T::ZERO), |jet| (jet.value + margin, jet.rate))
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
