//! What the motion needs to know of a limit.
//!
//! A limit bounds a quantity q of the state: the run ends where q reaches its bound. That instant
//! is located like any other event, so a limit supplies its event function h = q − bound with its
//! derivatives in flight, its power series in all other motion, the sensitivity of q to a deviation
//! of the state and to an uncertain key, a bound on q within a step, and, where there is one, the
//! bound for flights side by side.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::arithmetic::vector_series::VectorSeries;
use crate::model::body::{Body, Outline};
use crate::model::forcing::Push;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::events::{EventFunction, Jets};

/// A limit that is never reached.
pub(crate) const NEVER: f64 = 1e300;
/// Where a close bound on a quantity is needed, a step is evaluated at the ends of this many equal
/// parts.
const EVALUATIONS: usize = 64;

/// A limit, with the quantity q that it bounds.
pub(super) trait LimitLaw {
    /// q.
    fn quantity<T: Real>(system: &System<T>, state: &State<T>) -> T;

    /// Bounds on |∂q/∂z|, z = (x, y, θ, ẋ, ẏ, θ̇), wherever q is below its bound.
    fn slope_bounds(system: &System, bound: f64) -> [f64; 6];

    /// A bound on |q̈| along a step; where q is the largest of several, on that of each.
    fn acceleration_bound<T: Real>(system: &System<T>, step: &impl Along<T>) -> T;

    /// A bound on q along a step that is quickly computed.
    fn rough_along<T: Real>(system: &System<T>, step: &impl Along<T>) -> T;

    /// A bound on q along a step, close where it is above `floor`. Between two evaluations at a
    /// distance d, q exceeds the larger by at most |q̈| d²/8.
    #[inline(always)]
    fn largest_along<T: Real>(system: &System<T>, step: &impl Along<T>, floor: T) -> T {
        let rough = Self::rough_along(system, step);
        if rough < floor {
            return rough;
        }
        let quantity = |state: &State<T>| Self::quantity(system, state);
        let [start, end] = step.ends();
        let ends = quantity(start).max(quantity(end));
        let accel = Self::acceleration_bound(system, step);
        if accel == T::ZERO {
            return ends;
        }
        let width = step.duration() / EVALUATIONS as f64;
        ends.max(step.largest_seen(EVALUATIONS, quantity)) + accel * width * width * 0.125
    }

    /// Adds its event functions in flight, where the motion is known exactly: h, ḣ, ḧ, a bound on
    /// |h⃛| and one on the rounding error of h.
    fn in_flight<T: Real>(system: &LimitedSystem<T>, now: &Flying<T>, bound: T, jets: &mut Jets<T>);

    /// Adds its event functions in all other motion, as power series in the time, by
    /// [`TautMotion::add`].
    fn in_taut_motion<T: Real>(
        system: &LimitedSystem<T>,
        motion: &TautMotion<T>,
        bound: T,
        events: &mut Vec<EventSeries<T>>,
    );

    /// A bound on the derivative of q̈ by an uncertain key in a flight. The points of the outline
    /// are at most `outline[0]` from the centre, and their derivatives are at most `outline[1]`.
    fn change_in_flight(change: &FlightChange, outline: [f64; 2]) -> f64;

    /// The limits of flights side by side with this one among them; none where they do not have
    /// what it needs, so that the run is left to the general loop.
    fn in_lanes<T: Real>(
        _limits: LaneLimits<T>,
        _bound: T,
        _body: &Body<T>,
    ) -> Option<LaneLimits<T>> {
        None
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

/// The bounds with which flights side by side compare.
pub(crate) struct LaneLimits<T> {
    /// The bound on |θ|.
    pub(crate) rotation: T,
    /// The bound on y of the centre: the upper bound minus the largest height of the outline above
    /// the centre.
    pub(crate) level: T,
}

/// What the limits need to know of a system.
#[derive(Clone, Debug)]
pub(super) struct LimitedSystem<T> {
    pub(super) body: Body<T>,
    /// Its outline.
    pub(super) outline: Outline<T>,
    /// How far the points of the outline are from the centre.
    pub(super) reach: T,
    /// Bounds on the force and its derivatives.
    pub(super) force: [T; 3],
}

impl<T: Real> LimitedSystem<T> {
    pub(super) fn of(system: &System<T>) -> Self {
        let (outline, _) = system.body.outline();
        Self {
            body: system.body,
            reach: outline.points()[0].length(),
            outline,
            force: system.forcing.bounds(),
        }
    }
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
    /// Bound on the truncation error of the series of x, y and θ within the step.
    pub(crate) left_out: T,
    /// Bound on that of (cos θ, sin θ).
    pub(crate) circle_left_out: T,
}

impl<T: Real> TautMotion<'_, T> {
    /// Adds an event function that is known to the last order, with a bound on its truncation
    /// error, if it may be reached within the step.
    #[inline(always)]
    pub(super) fn add(
        &self,
        limit: Limit,
        series: Polynomial<T>,
        left_out: T,
        events: &mut Vec<EventSeries<T>>,
    ) {
        let event = EventSeries {
            function: EventFunction::Limit(limit),
            series,
            order: ORDER,
            left_out,
        };
        if !event.stays_negative(self.step) {
            events.push(event);
        }
    }
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

/// Bounds on what of a flight an uncertain key changes: for each the quantity itself and its
/// derivative by the key.
pub(crate) struct FlightChange {
    pub(crate) force: [f64; 2],
    pub(crate) speed: [f64; 2],
    pub(crate) spin: [f64; 2],
    /// Of the place and of the rotation the derivatives alone.
    pub(crate) place: f64,
    pub(crate) turn: f64,
}

impl FlightChange {
    /// Of the acceleration f(t) − θ̇²Rρ of a point ρ of the body, from |ρ| and |∂ρ|, the length of
    /// its derivative; that of |ρ| may be shorter.
    pub(crate) fn of_acceleration(&self, [reach, moved]: [f64; 2]) -> f64 {
        let [spin, spin_slope] = self.spin;
        let centripetal = spin * spin * (moved + reach * self.turn);
        self.force[1] + 2.0 * spin * spin_slope * reach + centripetal
    }
}
