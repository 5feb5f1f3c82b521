//! The limits that end a run where they are reached: all that the motion has to know of each, in
//! one place.
//!
//! A limit bounds a quantity q of the state: the run ends where q reaches its bound. That instant
//! is located like any other event, so a limit tells its event function h = q − bound with its
//! derivatives in flight, its power series in taut motion, and what a deviation of the state
//! changes it by. Whoever adds a limit adds a variant to [`Limit`] and is led by the compiler
//! through every match below.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::arithmetic::vector_series::VectorSeries;
use crate::model::body::Outline;
use crate::model::rules::{Limit, Rules};
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::attachment::INFLATION;
use crate::motion::events::{EventFunction, Jet, Jets};

impl Limit {
    /// The quantity that it bounds: |θ|, or y of the highest point of the body.
    pub(crate) fn quantity<T: Real>(self, system: &System<T>, state: &State<T>) -> T {
        match self {
            Self::Rotation => state.theta.abs(),
            Self::UpperBound => system.top(state),
        }
    }

    /// Bounds on |∂q/∂z|, z = (x, y, θ, ẋ, ẏ, θ̇), wherever the body is.
    pub(crate) fn slope_bounds(self, system: &System) -> [f64; 6] {
        match self {
            Self::Rotation => [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            Self::UpperBound => [0.0, 1.0, system.body.reach(), 0.0, 0.0, 0.0],
        }
    }

    /// What q̈ holds beside ∇q·z̈: that of a point which turns about the centre.
    pub(crate) fn centripetal(self, system: &System, state: &State) -> f64 {
        match self {
            Self::Rotation => 0.0,
            Self::UpperBound => {
                let height = system.top(state) - state.y;
                -(height * state.vtheta * state.vtheta)
            }
        }
    }
}

/// The limits of a run, as event functions.
#[derive(Clone, Debug)]
pub(crate) struct Limits<T> {
    rotation: Option<T>,
    upper_bound: Option<T>,
    outline: Outline<T>,
    /// Radius of the disc about each point of the outline.
    radius: T,
    /// How far the points of the outline are from the centre.
    reach: T,
}

/// A flight at one instant, as far as limits ask.
pub(crate) struct Flying<'a, T> {
    pub(crate) state: &'a State<T>,
    /// sin θ and cos θ.
    pub(crate) sine: T,
    pub(crate) cosine: T,
    /// The force, which is the acceleration of the centre.
    pub(crate) force: Vector2<T>,
    /// A bound on |ḟ| over the flight.
    pub(crate) force_rate: T,
}

/// Every limit has its event functions in [`Limits::in_flight`] and in [`Limits::watch_series`], which
/// ask for each in turn. Whoever adds a limit is stopped here until it has them.
const _: fn(Limit) = |limit| match limit {
    Limit::Rotation | Limit::UpperBound => {}
};

impl<T: Real> Limits<T> {
    /// Those of a system under the rules of a run.
    pub(crate) fn of(system: &System<T>, rules: &Rules<T>) -> Self {
        let (outline, radius) = system.body.outline();
        Self {
            rotation: Limit::Rotation.bound(rules),
            upper_bound: Limit::UpperBound.bound(rules),
            reach: outline.points()[0].length(),
            outline,
            radius,
        }
    }

    /// Their event functions in flight. With ÿ = f_y a point p of the outline is at the height
    /// y + p_x sin θ + p_y cos θ, whose third derivative is at most |ḟ| + |θ̇|³ |p|.
    #[inline(always)]
    pub(crate) fn in_flight(&self, now: &Flying<T>, jets: &mut Jets<T>) {
        let state = now.state;
        if let Some(limit) = self.rotation {
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
        let Some(level) = self.upper_bound else {
            return;
        };
        let spin = state.vtheta.abs();
        let third = (now.force_rate + spin * spin * spin * self.reach) * INFLATION;
        for &Vector2 { x: px, y: py } in self.outline.points() {
            let height = px * now.sine + py * now.cosine;
            let swing = px * now.cosine - py * now.sine;
            jets.push(Jet {
                third,
                noise: (level.abs() + state.y.abs() + height.abs()) * T::EPSILON * 4.0,
                ..Jet::new(
                    EventFunction::Limit(Limit::UpperBound),
                    state.y + height + self.radius - level,
                    state.vy + state.vtheta * swing,
                    now.force.y - state.vtheta.squared() * height,
                )
            });
        }
    }

    /// Their event functions in taut motion, as power series of y, θ, and cos θ and sin θ, added to
    /// those that are watched; the ones that provably are not reached within `step` are left out.
    #[inline(always)]
    pub(crate) fn watch_series(
        &self,
        y: &Polynomial<T>,
        theta: &Polynomial<T>,
        circle: &VectorSeries<T, 2>,
        step: T,
        watched: &mut Vec<(EventFunction, Polynomial<T>, usize)>,
    ) {
        if let Some(limit) = self.rotation {
            for mut side in [*theta, theta.negated()] {
                side[0] -= limit;
                if !side.stays_negative(step, ORDER, T::ZERO) {
                    watched.push((EventFunction::Limit(Limit::Rotation), side, ORDER));
                }
            }
        }
        let Some(level) = self.upper_bound else {
            return;
        };
        for &Vector2 { x: px, y: py } in self.outline.points() {
            let mut top = Polynomial::default();
            for k in 0..=ORDER {
                let [cosine, sine] = circle[k];
                top[k] = y[k] + px * sine + py * cosine;
            }
            top[0] = top[0] + self.radius - level;
            if !top.stays_negative(step, ORDER, T::ZERO) {
                watched.push((EventFunction::Limit(Limit::UpperBound), top, ORDER));
            }
        }
    }
}
