//! The motion within the latest step.

use crate::arithmetic::processor::Kernel;
use crate::arithmetic::real::Real;
use crate::model::floating::Complex;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::contact::Contact;
use crate::motion::events::{EventFunction, HasEvents, Jet, Jets};
use crate::motion::flight::Flight;
use crate::motion::limits::law::Along;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::taut_series::Series;
use std::borrow::Cow;

/// The motion along a segment.
pub(in crate::motion) enum SegmentMotion<'a, T: Real> {
    /// In closed form: slack, under few sinusoids.
    Closed(Cow<'a, Flight<T>>),
    /// By a series: with taut cables, drag, afloat, with a mass other than the unit one, or under
    /// many sinusoids.
    Expanded(&'a Series<T>),
}

/// A state to be evaluated, by the best instructions for it.
pub(in crate::motion) struct StateAt<'a, T: Real>(
    pub(in crate::motion) &'a SegmentMotion<'a, T>,
    pub(in crate::motion) T,
);

impl<T: Real> Kernel for StateAt<'_, T> {
    type Output = State<T>;
    #[inline(always)]
    fn run(self) -> State<T> {
        self.0.state(self.1)
    }
}

impl<T: Real> SegmentMotion<'_, T> {
    /// The state a time `s` into it.
    #[inline(always)]
    pub(super) fn state(&self, s: T) -> State<T> {
        match self {
            Self::Closed(flight) => flight.state(s),
            Self::Expanded(series) => series.state(s),
        }
    }

    /// The gap of a slack cable at that time, with its error.
    #[inline(always)]
    pub(super) fn contact(&self, cable: usize, s: T) -> Contact<T> {
        match self {
            Self::Closed(flight) => flight.contact(cable, s),
            Self::Expanded(series) => series.contact(cable, s),
        }
    }

    /// g and ġ of a slack cable then.
    #[inline(always)]
    pub(super) fn gap_and_rate(&self, cable: usize, s: T) -> (T, T) {
        match self {
            Self::Closed(flight) => flight.gap_and_rate(cable, s),
            Self::Expanded(series) => series.gap_and_rate(cable, s),
        }
    }

    /// ġ and g̈ of a slack cable then.
    #[inline(always)]
    pub(super) fn gap_rate_and_acceleration(&self, cable: usize, s: T) -> (T, T) {
        match self {
            Self::Closed(flight) => flight.gap_rate_and_acceleration(cable, s),
            Self::Expanded(series) => series.gap_rate_and_acceleration(cable, s),
        }
    }

    /// Bounds on ÿ, |ÿ| and |θ̈| along it.
    #[inline(always)]
    pub(in crate::motion) fn acceleration_bounds(&self, system: &System<T>) -> [T; 3] {
        let forcing = &system.forcing;
        match self {
            Self::Closed(_) => [
                forcing.upward_acceleration_bound(),
                forcing.vertical_acceleration_bound(),
                T::ZERO,
            ],
            Self::Expanded(series) => {
                let y = series.derivative_bound(2, 1);
                [y, y, series.derivative_bound(2, 2)]
            }
        }
    }
}

/// The latest step. The motion along it, which may have to be computed again, is computed only
/// where it is needed.
pub(super) struct LatestStep<'a, T: Real> {
    pub(super) simulation: &'a Simulation<T>,
    pub(super) step: &'a Step<T>,
}

impl<T: Real> Along<T> for LatestStep<'_, T> {
    #[inline(always)]
    fn duration(&self) -> T {
        self.step.t_end - self.step.t_start
    }

    #[inline(always)]
    fn ends(&self) -> [&State<T>; 2] {
        [&self.step.start, &self.step.before]
    }

    #[inline(always)]
    fn largest_seen(&self, parts: usize, quantity: impl Fn(&State<T>) -> T) -> T {
        let motion = self.simulation.motion(self.step.taut);
        let width = self.duration() / parts as f64;
        let seen = |k: usize| quantity(&motion.state(width * k as f64));
        (1..=parts).map(seen).fold(seen(0), T::max)
    }

    #[inline(always)]
    fn derivative_bound(&self, n: usize, coordinate: usize) -> T {
        let forcing = &self.simulation.system.forcing;
        match (self.simulation.expanded(self.step.taut), n, coordinate) {
            (Some(series), ..) => series.derivative_bound(n, coordinate),
            (None, _, 2) => T::ZERO,
            (None, 2, 1) => forcing.vertical_acceleration_bound(),
            (None, ..) => forcing.bounds()[n - 2],
        }
    }
}

impl<T: Real> Simulation<T> {
    /// The state a time `s` into the segment that the latest step made.
    #[inline(always)]
    pub fn within(&self, step: &Step<T>, s: T) -> State<T> {
        self.motion(step.taut).state(s)
    }

    /// The state as a function of the time since the latest step began, for many times.
    pub(crate) fn state_along(&self, step: &Step<T>) -> impl Fn(T) -> State<T> {
        let motion = self.motion(step.taut);
        move |s| motion.state(s)
    }

    /// The gap of a slack cable as such a function.
    pub(crate) fn gap_along(&self, step: &Step<T>, cable: usize) -> impl Fn(T) -> T {
        let motion = self.motion(step.taut);
        move |s| motion.contact(cable, s).gap
    }

    /// The state of the water's memory when the latest step began.
    #[inline(always)]
    pub(crate) fn memory_at_start(&self) -> Box<[Complex<T>]> {
        let mut memory: Box<[Complex<T>]> = self.memory().into();
        if let (Some(series), false) = (&self.series, memory.is_empty()) {
            series.memory_at_start(&mut memory);
        }
        memory
    }

    /// The force of the water's memory a time `s` into the segment that the latest step made.
    #[inline(always)]
    pub(crate) fn memory_force_within(&self, step: &Step<T>, s: T) -> [T; 3] {
        match self.expanded(step.taut) {
            Some(series) => series.memory_force(s),
            None => [T::ZERO; 3],
        }
    }

    /// The external forces on the body at a time of the latest step.
    #[inline(always)]
    pub(crate) fn surroundings(&self, t: T) -> Surroundings<T> {
        self.waves.at(&self.system, t)
    }

    /// The motion of the latest segment.
    #[inline(always)]
    pub(super) fn motion(&self, taut: TautSet) -> SegmentMotion<'_, T> {
        match self.expanded(taut) {
            Some(series) => SegmentMotion::Expanded(series),
            None => SegmentMotion::Closed(self.latest_flight()),
        }
    }

    /// The series of the latest segment; none if that has a closed form.
    #[inline(always)]
    pub(super) fn expanded(&self, taut: TautSet) -> Option<&Series<T>> {
        let series = self.series.as_deref();
        series.filter(|_| !self.system.has_closed_form(taut))
    }

    /// The flight of the latest step.
    #[inline(always)]
    fn latest_flight(&self) -> Cow<'_, Flight<T>> {
        let Some(from) = &self.bounce_start else {
            return Cow::Borrowed(&self.flight);
        };
        let mut flight = self.flight.clone();
        let [vx, vy, vtheta] = from.before;
        let before = State {
            vx,
            vy,
            vtheta,
            ..from.state
        };
        let mut contacts = self.contacts;
        for (contact, [gap, error]) in contacts.iter_mut().zip(from.gaps) {
            *contact = Contact {
                gap,
                error,
                resting: false,
            };
        }
        flight.begin(&self.system, from.t, &from.state, &before, &contacts);
        Cow::Owned(flight)
    }

    /// Whether the latest step was a bounce ([`crate::motion::bounce`]).
    pub(crate) fn has_bounced(&self) -> bool {
        self.bounce_start.is_some()
    }

    /// The gap of a cable at the time reached, with its error.
    pub(crate) fn contact(&self, cable: usize) -> &Contact<T> {
        &self.contacts[cable]
    }

    /// The gap of a slack cable at the start of the latest step, with its error; exactly 0 if it
    /// was closed.
    #[inline(always)]
    pub(crate) fn contact_at_start(&self, step: &Step<T>, cable: usize) -> Contact<T> {
        match (self.expanded(step.taut), &self.bounce_start) {
            (Some(series), _) => series.contact(cable, T::ZERO),
            (None, Some(from)) => {
                let [gap, error] = from.gaps[cable];
                Contact {
                    gap,
                    error,
                    resting: false,
                }
            }
            (None, None) => self.flight.contact_at_start(cable),
        }
    }

    /// Whether the tension of a cable is known to be zero at the start or at the end of the latest
    /// step, and positive besides.
    pub(crate) fn touches_zero(&self, step: &Step<T>, cable: usize) -> bool {
        let series = self.expanded(step.taut);
        let at_start = series.is_some_and(|series| series.rises_from_zero(cable));
        at_start || self.touching.contains(cable)
    }

    /// Whether a cable was known to be closed and at rest at the start of the latest step.
    pub(crate) fn rested(&self, step: &Step<T>, cable: usize) -> bool {
        match (self.expanded(step.taut), &self.bounce_start) {
            (Some(series), _) => series.rested(cable),
            (None, Some(_)) => false,
            (None, None) => self.flight.rested(cable),
        }
    }

    /// A bound, along the latest step, on the quantity of a limit, close where it is above `floor`.
    #[inline(always)]
    pub(crate) fn largest_within(&self, step: &Step<T>, limit: Limit, floor: T) -> T {
        let latest = LatestStep {
            simulation: self,
            step,
        };
        limit.largest_along(&self.system, &latest, floor)
    }

    /// The event function of a limit at the end of the latest step, where it was reached.
    pub(crate) fn limit_reached(&self, step: &Step<T>, limit: Limit) -> Option<Jet<T>> {
        self.reached_at_end(step, EventFunction::Limit(limit))
    }

    /// Minus the tension of a cable at the end of the latest step, where that was lost.
    pub(crate) fn tension_lost(&self, step: &Step<T>, cable: usize) -> Option<Jet<T>> {
        self.reached_at_end(step, EventFunction::Tension(cable))
    }

    fn reached_at_end(&self, step: &Step<T>, function: EventFunction) -> Option<Jet<T>> {
        let mut jets = Jets::new();
        let s = step.t_end - step.t_start;
        match self.motion(step.taut) {
            SegmentMotion::Closed(flight) => flight.jets_at(s, &mut jets),
            SegmentMotion::Expanded(series) => series.jets_at(s, &mut jets),
        }
        jets.iter()
            .filter(|jet| jet.function == function)
            .copied()
            .reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// How far the latest Taylor series may be used.
    pub(crate) fn expansion(&self) -> T {
        self.series.as_ref().map_or(T::ZERO, |series| series.step())
    }
}
