//! The limits that end a run where they are reached, each in a file of its own.

pub(crate) mod law;
mod rotation;
mod upper_bound;

use crate::arithmetic::real::Real;
use crate::model::body::Body;
use crate::model::rules::{Limit, LimitBounds, Rules};
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::events::Jets;
use law::{
    Along, EventSeries, FlightChange, Flying, LaneLimits, LimitLaw, LimitedSystem, NEVER,
    TautMotion,
};

/// Calls a function of [`LimitLaw`] for one of the limits.
macro_rules! of_limit {
    ($limit:expr, $function:ident($($argument:expr),*)) => {
        match $limit {
            Limit::Rotation => rotation::RotationLimit::$function($($argument),*),
            Limit::UpperBound => upper_bound::UpperBound::$function($($argument),*),
        }
    };
}

impl Limit {
    /// The quantity that it bounds: |θ|, or y of the highest point of the body.
    pub fn quantity<T: Real>(self, system: &System<T>, state: &State<T>) -> T {
        of_limit!(self, quantity(system, state))
    }

    /// Bounds on |∂q/∂z|, z = (x, y, θ, ẋ, ẏ, θ̇), wherever q is below `bound`.
    pub(crate) fn slope_bounds(self, system: &System, bound: f64) -> [f64; 6] {
        of_limit!(self, slope_bounds(system, bound))
    }

    /// A bound on |q̈| along a step; for the upper bound, on that of each point of the outline.
    #[inline(always)]
    pub(crate) fn acceleration_bound<T: Real>(self, system: &System<T>, step: &impl Along<T>) -> T {
        of_limit!(self, acceleration_bound(system, step))
    }

    /// A bound on q along a step, close where it is above `floor`.
    #[inline(always)]
    pub(crate) fn largest_along<T: Real>(
        self,
        system: &System<T>,
        step: &impl Along<T>,
        floor: T,
    ) -> T {
        of_limit!(self, largest_along(system, step, floor))
    }

    /// A bound on the derivative of q̈ by an uncertain key in a flight.
    pub(crate) fn change_in_flight(self, change: &FlightChange, outline: [f64; 2]) -> f64 {
        of_limit!(self, change_in_flight(change, outline))
    }
}

impl<T: Real> LaneLimits<T> {
    /// The bounds from the limits of a run; none if one of the limits is not available for flights
    /// side by side.
    pub(crate) fn of(limits: &LimitBounds<T>, body: &Body<T>) -> Option<Self> {
        let never = T::from_f64(NEVER);
        let mut known = Self {
            rotation: never,
            level: never - body.reach(),
        };
        for (limit, bound) in limits.iter() {
            known = of_limit!(limit, in_lanes(known, bound, body))?;
        }
        Some(known)
    }
}

/// The limits of a run, as event functions.
#[derive(Clone, Debug)]
pub(crate) struct Limits<T> {
    bounds: LimitBounds<T>,
    system: LimitedSystem<T>,
}

impl<T: Real> Limits<T> {
    /// The limits of a system under the rules of a run.
    pub(crate) fn of(system: &System<T>, rules: &Rules<T>) -> Self {
        Self {
            bounds: rules.limits,
            system: LimitedSystem::of(system),
        }
    }

    /// Their event functions in flight.
    #[inline(always)]
    pub(crate) fn in_flight(&self, now: &Flying<T>, jets: &mut Jets<T>) {
        for (limit, bound) in self.bounds.iter() {
            of_limit!(limit, in_flight(&self.system, now, bound, jets));
        }
    }

    /// Adds their event functions in taut motion, as power series, to those of the step; those
    /// that provably are not reached within the step are left out.
    #[inline(always)]
    pub(crate) fn add_event_series(
        &self,
        motion: &TautMotion<T>,
        events: &mut Vec<EventSeries<T>>,
    ) {
        for (limit, bound) in self.bounds.iter() {
            of_limit!(limit, in_taut_motion(&self.system, motion, bound, events));
        }
    }
}
