//! The limits that end a run where they are reached: everything that the motion needs to know of
//! each.
//!
//! A limit bounds a quantity q of the state: the run ends where q reaches its bound. That instant
//! is located like any other event, so a limit supplies its event function h = q − bound with its
//! derivatives in flight, its power series in taut motion, the sensitivity of q to a deviation of
//! the state, a bound on q within a step, and the bound for flights side by side. A new limit is a
//! new variant of [`Limit`], and the compiler reports every match below that lacks it.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::arithmetic::vector_series::VectorSeries;
use crate::model::body::{Body, Outline};
use crate::model::forcing::Push;
use crate::model::rules::{Limit, LimitBounds, Rules};
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::attachment::INFLATION;
use crate::motion::events::{EventFunction, Jet, Jets};

/// A limit that is never reached.
pub(crate) const NEVER: f64 = 1e300;
/// Where a close bound on a quantity is needed, a step is evaluated at the ends of this many equal
/// parts.
const EVALUATIONS: usize = 64;

impl Limit {
    /// The quantity that it bounds: |θ|, or y of the highest point of the body.
    pub fn quantity<T: Real>(self, system: &System<T>, state: &State<T>) -> T {
        match self {
            Self::Rotation => state.theta.abs(),
            Self::UpperBound => system.top(state),
        }
    }

    /// Bounds on |∂q/∂z|, z = (x, y, θ, ẋ, ẏ, θ̇), wherever q is below `_bound`.
    pub(crate) fn slope_bounds(self, system: &System, _bound: f64) -> [f64; 6] {
        match self {
            Self::Rotation => [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            Self::UpperBound => [0.0, 1.0, system.body.reach(), 0.0, 0.0, 0.0],
        }
    }

    /// A bound on |q̈| along a step; for the upper bound, on that of each point of the outline.
    #[inline(always)]
    pub(crate) fn acceleration_bound<T: Real>(self, system: &System<T>, step: &impl Along<T>) -> T {
        let theta_accel = step.derivative_bound(2, 2);
        match self {
            Self::Rotation => theta_accel,
            Self::UpperBound => {
                let [start, _] = step.ends();
                let spin = start.vtheta.abs() + theta_accel * step.duration();
                let turning = (spin * spin + theta_accel) * system.body.reach();
                step.derivative_bound(2, 1) + turning
            }
        }
    }

    /// A bound on q along a step, close where it is above `floor`.
    #[inline(always)]
    pub(crate) fn largest_along<T: Real>(
        self,
        system: &System<T>,
        step: &impl Along<T>,
        floor: T,
    ) -> T {
        match self {
            Self::Rotation => farthest_turned(step, floor),
            Self::UpperBound => highest(system, step, floor),
        }
    }
}

/// A step of the motion, as it is needed to bound a quantity within it.
pub(crate) trait Along<T> {
    /// How long it takes.
    fn duration(&self) -> T;
    /// The states at its start and just before the event at its end.
    fn ends(&self) -> [&State<T>; 2];
    /// The largest value of a quantity at the ends of so many equal parts of it.
    fn largest_seen(&self, parts: usize, quantity: impl Fn(&State<T>) -> T) -> T;
    /// A bound on the n-th derivative, n = 2, 3 or 4, of x, y or θ (0, 1, 2) within it; that of θ
    /// is zero in flight.
    fn derivative_bound(&self, n: usize, coordinate: usize) -> T;
}

/// A bound on how much a quantity whose second derivative is at most `accel` exceeds its values at
/// the ends of [`EVALUATIONS`] parts of a step.
#[inline(always)]
fn between_evaluations<T: Real>(step: &impl Along<T>, accel: T) -> T {
    let width = step.duration() / EVALUATIONS as f64;
    accel * width * width * 0.125
}

/// A bound on |θ|. In a flight it is largest at an end.
#[inline(always)]
fn farthest_turned<T: Real>(step: &impl Along<T>, floor: T) -> T {
    let [start, end] = step.ends();
    let ends = start.theta.abs().max(end.theta.abs());
    let accel = step.derivative_bound(2, 2);
    if accel == T::ZERO {
        return ends;
    }
    let s = step.duration();
    let rough = ends + accel * s * s * 0.125;
    if rough < floor {
        return rough;
    }
    ends.max(step.largest_seen(EVALUATIONS, |state| state.theta.abs()))
        + between_evaluations(step, accel)
}

/// A bound on y of the highest point of the body.
#[inline(always)]
fn highest<T: Real>(system: &System<T>, step: &impl Along<T>, floor: T) -> T {
    let ([start, end], s) = (step.ends(), step.duration());
    let y_accel = step.derivative_bound(2, 1);
    let rough = start.y.max(end.y) + y_accel * s * s * 0.125 + system.body.reach();
    if rough < floor {
        return rough;
    }
    let accel = Limit::UpperBound.acceleration_bound(system, step);
    start
        .y
        .max(step.largest_seen(EVALUATIONS, |state| system.top(state)))
        + between_evaluations(step, accel)
}

/// The bounds with which flights side by side compare.
pub(crate) struct LaneLimits<T> {
    /// The bound on |θ|.
    pub(crate) rotation: T,
    /// The bound on y of the centre: the upper bound minus the largest height of the outline above
    /// the centre.
    pub(crate) level: T,
}

impl<T: Real> LaneLimits<T> {
    /// The bounds from the limits of a run; none if one of the limits is not available for flights
    /// side by side, so that the run is left to the general loop.
    pub(crate) fn of(limits: &LimitBounds<T>, body: &Body<T>) -> Option<Self> {
        let never = T::from_f64(NEVER);
        let mut known = Self {
            rotation: never,
            level: never - body.reach(),
        };
        for (limit, bound) in limits.iter() {
            match limit {
                Limit::Rotation => known.rotation = bound,
                Limit::UpperBound => known.level = bound - body.reach(),
            }
        }
        Some(known)
    }
}

/// The limits of a run, as event functions.
#[derive(Clone, Debug)]
pub(crate) struct Limits<T> {
    bounds: LimitBounds<T>,
    outline: Outline<T>,
    /// Radius of the disc about each point of the outline.
    radius: T,
    /// How far the points of the outline are from the centre.
    reach: T,
    /// Bounds on the force and its derivatives.
    force: [T; 3],
}

/// A flight at one instant, as it is needed by the limits.
pub(crate) struct Flying<'a, T> {
    pub(crate) state: &'a State<T>,
    /// sin θ and cos θ.
    pub(crate) sine: T,
    pub(crate) cosine: T,
    /// The force, which is the acceleration of the centre, and its rate.
    pub(crate) push: &'a Push<T>,
}

/// A step of taut motion as power series.
pub(crate) struct TautMotion<'a, T> {
    /// x, y and θ.
    pub(crate) place: [&'a Polynomial<T>; 3],
    /// cos θ and sin θ.
    pub(crate) circle: &'a VectorSeries<T, 2>,
    /// How long the step is.
    pub(crate) step: T,
    /// Bound on the truncation error of the series of the position within the step.
    pub(crate) left_out: T,
}

/// An event function that may be reached within a step, as a power series.
#[derive(Clone, Debug)]
pub(crate) struct EventSeries<T> {
    pub(crate) function: EventFunction,
    pub(crate) series: Polynomial<T>,
    /// The last order that is known.
    pub(crate) order: usize,
    /// Bound on its truncation error within the step.
    pub(crate) left_out: T,
}

impl<T: Real> EventSeries<T> {
    /// Whether it provably stays below zero.
    #[inline(always)]
    pub(crate) fn stays_negative(&self, step: T) -> bool {
        let Self {
            order, left_out, ..
        } = *self;
        self.series.stays_negative(step, order, left_out)
    }
}

impl<T: Real> Limits<T> {
    /// The limits of a system under the rules of a run.
    pub(crate) fn of(system: &System<T>, rules: &Rules<T>) -> Self {
        let (outline, radius) = system.body.outline();
        Self {
            bounds: rules.limits,
            reach: outline.points()[0].length(),
            outline,
            radius,
            force: system.forcing.bounds(),
        }
    }

    /// Their event functions in flight.
    #[inline(always)]
    pub(crate) fn in_flight(&self, now: &Flying<T>, jets: &mut Jets<T>) {
        for (limit, bound) in self.bounds.iter() {
            match limit {
                Limit::Rotation => rotation_in_flight(now, bound, jets),
                Limit::UpperBound => self.height_in_flight(now, bound, jets),
            }
        }
    }

    /// With ÿ = f_y a point p of the outline is at the height y + p_x sin θ + p_y cos θ, whose
    /// third derivative is at most |ḟ| + |θ̇|³ |p|.
    #[inline(always)]
    fn height_in_flight(&self, now: &Flying<T>, level: T, jets: &mut Jets<T>) {
        let &Flying {
            state,
            sine,
            cosine,
            push,
        } = now;
        let spin = state.vtheta.abs();
        let third = (self.force[1] + spin * spin * spin * self.reach) * INFLATION;
        for &Vector2 { x: px, y: py } in self.outline.points() {
            let height = px * sine + py * cosine;
            let swing = px * cosine - py * sine;
            jets.push(Jet {
                third,
                noise: (level.abs() + state.y.abs() + height.abs()) * T::EPSILON * 4.0,
                ..Jet::new(
                    EventFunction::Limit(Limit::UpperBound),
                    state.y + height + self.radius - level,
                    state.vy + state.vtheta * swing,
                    push.force.y - state.vtheta.squared() * height,
                )
            });
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
        let [_, y, theta] = motion.place;
        for (limit, bound) in self.bounds.iter() {
            match limit {
                Limit::Rotation => {
                    for mut side in [*theta, theta.negated()] {
                        side[0] -= bound;
                        add_event(limit, side, motion.left_out, motion.step, events);
                    }
                }
                Limit::UpperBound => {
                    for &Vector2 { x: px, y: py } in self.outline.points() {
                        let mut top = Polynomial::default();
                        for k in 0..=ORDER {
                            let [cosine, sine] = motion.circle[k];
                            top[k] = y[k] + px * sine + py * cosine;
                        }
                        top[0] = top[0] + self.radius - bound;
                        add_event(limit, top, motion.left_out, motion.step, events);
                    }
                }
            }
        }
    }
}

/// Adds an event function that is known to the last order, if it may be reached within the step.
#[inline(always)]
fn add_event<T: Real>(
    limit: Limit,
    series: Polynomial<T>,
    left_out: T,
    step: T,
    events: &mut Vec<EventSeries<T>>,
) {
    let event = EventSeries {
        function: EventFunction::Limit(limit),
        series,
        order: ORDER,
        left_out,
    };
    if !event.stays_negative(step) {
        events.push(event);
    }
}

/// θ is linear in time in flight.
#[inline(always)]
fn rotation_in_flight<T: Real>(now: &Flying<T>, limit: T, jets: &mut Jets<T>) {
    let state = now.state;
    let side = if state.vtheta < T::ZERO {
        -T::ONE
    } else {
        T::ONE
    };
    jets.push(Jet {
        noise: limit * T::EPSILON,
        ..Jet::new(
            EventFunction::Limit(Limit::Rotation),
            side * state.theta - limit,
            side * state.vtheta,
            T::ZERO,
        )
    });
}
