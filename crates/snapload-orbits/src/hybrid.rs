//! Hybrid systems: flows between events, events on surfaces, laws at events.
//!
//! Orbits, multipliers and branches are found for everything that implements [`Hybrid`]: a body on
//! cables ([`crate::Moored`]), or an oscillator against a wall. It is used over plain doubles and
//! over [`Jet`]s, whose derivatives by state, time and parameters are needed for Newton's method
//! and the saltation matrices.

use snapload::{Dual, Limit, PerCable, Real, Stop, TautSet};

/// Six numbers: x, y, θ, ẋ, ẏ, θ̇, of which a system may use fewer.
pub type Point<T = f64> = [T; 6];

/// A number with its derivatives by the six components of the state at the start of a leg, by the
/// time there, by the leg's duration, and by two parameters.
pub type Jet = Dual<f64, 10>;

/// The index of the time among the derivatives of a [`Jet`].
pub const TIME: usize = 6;
/// The index of the duration.
pub const DURATION: usize = 7;
/// The index of the first of two parameters.
pub const PARAMETER: usize = 8;

/// A system with a flow, surfaces, and a jump at each surface. A surface that is held (a taut
/// cable) is a constraint of the flow.
pub trait Hybrid<T: Real> {
    /// All surfaces.
    fn surfaces(&self) -> TautSet;

    /// The state a time `s`, of either sign, after `z` at time `t`,
    /// with the surfaces of `taut` taut.
    fn flow(&self, taut: TautSet, t: T, z: &Point<T>, s: T) -> Point<T>;

    /// The same motion at any time from 0 to `s`, for many evaluations: equal to [`Hybrid::flow`]
    /// up to rounding.
    fn path(&self, taut: TautSet, t: T, z: &Point<T>, _s: T) -> impl Fn(T) -> Point<T> {
        let z = *z;
        move |s| self.flow(taut, t, &z, s)
    }

    /// How far the state is beyond a surface, as a length: negative where it is legal.
    fn gap(&self, surface: usize, z: &Point<T>) -> T;

    /// The velocity v_n at which it closes.
    fn speed(&self, surface: usize, z: &Point<T>) -> T;

    /// The force by which a held surface holds; it is released where this is zero.
    fn tension(&self, surface: usize, taut: TautSet, t: T, z: &Point<T>) -> T;

    /// The law where `struck` surfaces are reached and those of `pulling` take impulses: the state
    /// after it, and the impulses.
    fn law(&self, struck: TautSet, pulling: TautSet, z: &Point<T>) -> (Point<T>, PerCable<T>);

    /// The state projected onto `closed` surfaces, with its velocity along `still` ones.
    fn placed(&self, closed: TautSet, still: TautSet, z: &Point<T>) -> Point<T>;
}

/// For each limit quantity − bound, in the order of [`Limit::ALL`]; −∞ for a limit that is off.
pub type Limits = [f64; Limit::ALL.len()];

/// Hybrid systems with two parameters, forced periodically.
pub trait Family: Sync {
    /// The system over doubles.
    type Plain: Hybrid<f64>;
    /// The same over jets.
    type Jets: Hybrid<Jet>;

    /// Which components of a [`Point`] it uses.
    fn variables(&self) -> &'static [usize];

    /// The system at two values of the parameters.
    fn plain(&self, at: [f64; 2]) -> Self::Plain;

    /// The same over jets, with the derivatives by the parameters.
    fn jets(&self, at: [f64; 2]) -> Self::Jets;

    /// The period of the forcing, with its derivatives by the parameters.
    fn forcing_period(&self, at: [f64; 2]) -> Jet;

    /// The rate at which volumes shrink in flight: the negative divergence, which is the trace of
    /// M⁻¹ D for a mass matrix M and a damping matrix D; `None` if it is not constant.
    fn contraction(&self, at: [f64; 2]) -> Option<f64>;

    /// The factor by which one snap multiplies volumes: e².
    fn snap_contraction(&self, at: [f64; 2]) -> f64;

    /// The limits at a state; by default there are none.
    fn limits(&self, _system: &Self::Plain, _z: &Point) -> Limits {
        [f64::NEG_INFINITY; Limit::ALL.len()]
    }

    /// A gap that is given as a length, in the measure in which it is reported.
    fn reported_gap(&self, _system: &Self::Plain, _surface: usize, length: f64) -> f64 {
        length
    }

    /// The actual motion, with its events detected, from `z` at time `t` to `t_end`. None if the
    /// system has only the prescribed motion of [`crate::scan()`].
    fn simulate(&self, at: [f64; 2], t: f64, z: &Point, t_end: f64) -> Option<Simulated>;
}

/// The result of a simulation, or why there is none.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// Its events.
    pub lap: crate::sequence::Timed,
    /// Where it ended.
    pub end: Point,
    /// Why and when it stopped early.
    pub stop: Option<(Stop, f64)>,
    /// A start that is not legal, in words.
    pub illegal: Option<String>,
}

/// A jet without derivatives.
pub fn constant(value: f64) -> Jet {
    Jet::constant(value)
}

/// A state with respect to whose components derivatives are taken.
pub fn variable(z: &Point) -> Point<Jet> {
    std::array::from_fn(|i| Jet::variable(z[i], i))
}

/// The values of a state's components.
pub fn values(z: &Point<Jet>) -> Point {
    z.map(|component| component.value)
}

/// The largest difference of two states.
pub fn distance(a: &Point, b: &Point) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}
