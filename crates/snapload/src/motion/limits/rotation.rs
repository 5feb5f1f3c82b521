//! The limit of the rotation: q = |θ|.

use crate::arithmetic::real::Real;
use crate::model::body::Body;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::events::{EventFunction, Jet, Jets};
use crate::motion::limits::law::{
    Along, EventSeries, FlightChange, Flying, LaneLimits, LimitLaw, LimitedSystem, TautMotion,
};

pub(super) struct RotationLimit;

impl LimitLaw for RotationLimit {
    #[inline(always)]
    fn quantity<T: Real>(_system: &System<T>, state: &State<T>) -> T {
        state.theta.abs()
    }

    fn slope_bounds(_system: &System, _bound: f64) -> [f64; 6] {
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn acceleration_bound<T: Real>(_system: &System<T>, step: &impl Along<T>) -> T {
        step.derivative_bound(2, 2)
    }

    #[inline(always)]
    fn rough_along<T: Real>(_system: &System<T>, step: &impl Along<T>) -> T {
        let ([start, end], s) = (step.ends(), step.duration());
        start.theta.abs().max(end.theta.abs()) + step.derivative_bound(2, 2) * s * s * 0.125
    }

    /// θ is linear in time in flight.
    #[inline(always)]
    fn in_flight<T: Real>(
        _system: &LimitedSystem<T>,
        now: &Flying<T>,
        bound: T,
        jets: &mut Jets<T>,
    ) {
        let state = now.state;
        let side = if state.vtheta < T::ZERO {
            -T::ONE
        } else {
            T::ONE
        };
        jets.push(Jet {
            noise: bound * T::EPSILON,
            ..Jet::new(
                EventFunction::Limit(Limit::Rotation),
                side * state.theta - bound,
                side * state.vtheta,
                T::ZERO,
            )
        });
    }

    #[inline(always)]
    fn in_taut_motion<T: Real>(
        _system: &LimitedSystem<T>,
        motion: &TautMotion<T>,
        bound: T,
        events: &mut Vec<EventSeries<T>>,
    ) {
        let [_, _, theta] = motion.place;
        for mut side in [*theta, theta.negated()] {
            side[0] -= bound;
            motion.add(Limit::Rotation, side, motion.left_out, events);
        }
    }

    /// The rate of rotation is constant.
    fn change_in_flight(_change: &FlightChange, _outline: [f64; 2]) -> f64 {
        0.0
    }

    fn in_lanes<T: Real>(
        limits: LaneLimits<T>,
        bound: T,
        _body: &Body<T>,
    ) -> Option<LaneLimits<T>> {
        Some(LaneLimits {
            rotation: bound,
            ..limits
        })
    }
}
