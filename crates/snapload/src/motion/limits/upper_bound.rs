//! The upper bound: q is y of the highest point of the body.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::model::body::Body;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::attachment::INFLATION;
use crate::motion::events::{EventFunction, Jet, Jets};
use crate::motion::limits::law::{
    Along, EventSeries, FlightChange, Flying, LaneLimits, LimitLaw, LimitedSystem, TautMotion,
};

pub(super) struct UpperBound;

impl LimitLaw for UpperBound {
    #[inline(always)]
    fn quantity<T: Real>(system: &System<T>, state: &State<T>) -> T {
        system.top(state)
    }

    fn slope_bounds(system: &System, _bound: f64) -> [f64; 6] {
        [0.0, 1.0, system.body.reach(), 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn acceleration_bound<T: Real>(system: &System<T>, step: &impl Along<T>) -> T {
        let theta_accel = step.derivative_bound(2, 2);
        let [start, _] = step.ends();
        let spin = start.vtheta.abs() + theta_accel * step.duration();
        let turning = (spin * spin + theta_accel) * system.body.reach();
        step.derivative_bound(2, 1) + turning
    }

    #[inline(always)]
    fn rough_along<T: Real>(system: &System<T>, step: &impl Along<T>) -> T {
        let ([start, end], s) = (step.ends(), step.duration());
        let y_accel = step.derivative_bound(2, 1);
        start.y.max(end.y) + y_accel * s * s * 0.125 + system.body.reach()
    }

    /// With ÿ = f_y a point p of the outline is at the height y + p_x sin θ + p_y cos θ, whose
    /// third derivative is at most |ḟ| + |θ̇|³ |p|.
    #[inline(always)]
    fn in_flight<T: Real>(
        system: &LimitedSystem<T>,
        now: &Flying<T>,
        bound: T,
        jets: &mut Jets<T>,
    ) {
        let &Flying {
            state,
            sine,
            cosine,
            push,
        } = now;
        let spin = state.vtheta.abs();
        let third = (system.force[1] + spin * spin * spin * system.reach) * INFLATION;
        for &Vector2 { x: px, y: py } in system.outline.points() {
            let height = px * sine + py * cosine;
            let swing = px * cosine - py * sine;
            jets.push(Jet {
                third,
                noise: (bound.abs() + state.y.abs() + height.abs()) * T::EPSILON * 4.0,
                ..Jet::new(
                    EventFunction::Limit(Limit::UpperBound),
                    state.y + height + system.body.disc_radius() - bound,
                    state.vy + state.vtheta * swing,
                    push.force.y - state.vtheta.squared() * height,
                )
            });
        }
    }

    #[inline(always)]
    fn in_taut_motion<T: Real>(
        system: &LimitedSystem<T>,
        motion: &TautMotion<T>,
        bound: T,
        events: &mut Vec<EventSeries<T>>,
    ) {
        let [_, y, _] = motion.place;
        let left_out = motion.left_out + system.reach * motion.circle_left_out;
        for &Vector2 { x: px, y: py } in system.outline.points() {
            let mut top = Polynomial::default();
            for k in 0..=ORDER {
                let [cosine, sine] = motion.circle[k];
                top[k] = y[k] + px * sine + py * cosine;
            }
            top[0] = top[0] + system.body.disc_radius() - bound;
            motion.add(Limit::UpperBound, top, left_out, events);
        }
    }

    fn change_in_flight(change: &FlightChange, outline: [f64; 2]) -> f64 {
        change.of_acceleration(outline)
    }

    fn in_lanes<T: Real>(limits: LaneLimits<T>, bound: T, body: &Body<T>) -> Option<LaneLimits<T>> {
        Some(LaneLimits {
            level: bound - body.reach(),
            ..limits
        })
    }
}
