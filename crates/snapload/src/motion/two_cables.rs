//! A body on two cables under one sinusoid, and a motion at one instant, as numbers that a lane can
//! hold: the fast path uses them in place of a system, its rules and a state.

use crate::arithmetic::lane::zip;
use crate::arithmetic::plane::{Rotation, Vector2};
use crate::arithmetic::real::Real;
use crate::model::body::Body;
use crate::model::cable::Cable;
use crate::model::contact_law::ContactLaw;
use crate::model::forcing::{Forcing, Harmonic};
use crate::model::mass::Mass;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::limits::law::LaneLimits;

/// The numbers that are constant along a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TwoCableSystem<L> {
    pub(crate) cables: [Cable<L>; 2],
    /// Length of the fairleads.
    pub(crate) reach: [L; 2],
    pub(crate) inverse_inertia: L,
    pub(crate) contact: ContactLaw<L>,
    pub(crate) constant: Vector2<L>,
    pub(crate) wave: Harmonic<L>,
    /// Bounds on the force and its derivatives.
    pub(crate) force: [L; 3],
    /// Bound on ÿ.
    pub(crate) upward_acceleration_bound: L,
    /// Bound on |ÿ|.
    pub(crate) vertical_acceleration_bound: L,
    pub(crate) rotation_limit: L,
    /// The largest distance of the outline from the centre.
    pub(crate) outline: L,
    /// The upper bound minus the largest height of the outline above the centre.
    pub(crate) level: L,
    pub(crate) t_end: L,
    /// More impacts than this stop a run.
    pub(crate) max_impacts: L,
    pub(crate) v_stick: L,
}

/// A motion just after an impact.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AfterImpact<L> {
    pub(crate) t: L,
    pub(crate) state: State<L>,
    /// The rotation by θ.
    pub(crate) rotation: Rotation<L>,
    /// ẋ, ẏ, θ̇ before the impact.
    pub(crate) before: [L; 3],
    /// The gaps: value and error of each.
    pub(crate) gaps: [[L; 2]; 2],
    pub(crate) y_max: L,
    pub(crate) theta_max: L,
}

impl<L: Copy> AfterImpact<L> {
    /// A function of each number and the other motion's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &AfterImpact<M>,
        number: impl Fn(L, M) -> U + Copy,
    ) -> AfterImpact<U> {
        AfterImpact {
            t: number(self.t, other.t),
            state: self.state.zip_with(&other.state, number),
            rotation: self.rotation.zip_with(&other.rotation, number),
            before: zip(self.before, other.before, number),
            gaps: zip(self.gaps, other.gaps, |a, b| zip(a, b, number)),
            y_max: number(self.y_max, other.y_max),
            theta_max: number(self.theta_max, other.theta_max),
        }
    }
}

impl<L: Copy> TwoCableSystem<L> {
    /// A function of each number and the other system's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &TwoCableSystem<M>,
        number: impl Fn(L, M) -> U + Copy,
    ) -> TwoCableSystem<U> {
        TwoCableSystem {
            cables: zip(self.cables, other.cables, |a, b| a.zip_with(&b, number)),
            reach: zip(self.reach, other.reach, number),
            inverse_inertia: number(self.inverse_inertia, other.inverse_inertia),
            contact: self.contact.zip_with(other.contact, number),
            constant: self.constant.zip_with(other.constant, number),
            wave: self.wave.zip_with(&other.wave, number),
            force: zip(self.force, other.force, number),
            upward_acceleration_bound: number(
                self.upward_acceleration_bound,
                other.upward_acceleration_bound,
            ),
            vertical_acceleration_bound: number(
                self.vertical_acceleration_bound,
                other.vertical_acceleration_bound,
            ),
            rotation_limit: number(self.rotation_limit, other.rotation_limit),
            outline: number(self.outline, other.outline),
            level: number(self.level, other.level),
            t_end: number(self.t_end, other.t_end),
            max_impacts: number(self.max_impacts, other.max_impacts),
            v_stick: number(self.v_stick, other.v_stick),
        }
    }
}

impl<T: Real> TwoCableSystem<T> {
    /// The entry point of the fast path: accepts a body of unit mass on two cables under one
    /// sinusoid, without drag and not afloat; other systems are left to the general loop.
    ///
    /// All fields of a system and its rules are named here, so that a new field does not compile
    /// before its meaning for the fast path is decided.
    pub(crate) fn of(system: &System<T>, rules: &Rules<T>) -> Option<Self> {
        let System {
            body,
            cables,
            forcing,
            drag,
            floating,
            // Contained in the law of contact.
            restitution: _,
        } = system;
        let Forcing {
            constant,
            harmonics,
        } = forcing;
        let Body {
            mass,
            // Only its largest extent matters, which is `outline`.
            shape: _,
        } = body;
        let Rules {
            limits,
            // These two rules apply where a cable sticks or two are taut, which is no bounce.
            settled_below: _,
            sliding_above: _,
            t_end,
            // The lanes count impacts.
            max_impacts,
            v_stick,
        } = *rules;
        let ([first, second], [wave], None, None, Mass::Unit { inverse_inertia }) =
            (&cables[..], &harmonics[..], drag, floating, mass)
        else {
            return None;
        };
        let LaneLimits { rotation, level } = LaneLimits::of(&limits, body)?;
        Some(Self {
            cables: [*first, *second],
            reach: [first.fairlead().length(), second.fairlead().length()],
            inverse_inertia: *inverse_inertia,
            contact: system.contact_law(),
            constant: *constant,
            wave: *wave,
            force: forcing.bounds(),
            upward_acceleration_bound: forcing.upward_acceleration_bound(),
            vertical_acceleration_bound: forcing.vertical_acceleration_bound(),
            rotation_limit: rotation,
            outline: body.reach(),
            level,
            t_end,
            max_impacts: T::from_f64(max_impacts as f64),
            v_stick,
        })
    }
}
