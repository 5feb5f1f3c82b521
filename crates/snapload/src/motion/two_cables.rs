//! A body on two cables under one sinusoid, and a moment of its motion, as numbers that a lane can hold.

use crate::arithmetic::lane::{Lane, Turn, length};
use crate::arithmetic::real::Real;
use crate::model::cable::Cable;
use crate::model::forcing::Harmonic;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;

/// A limit that is never reached.
pub(crate) const NEVER: f64 = 1e300;

/// What does not change along a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoCableSystem<L> {
    pub(crate) cables: [Cable<L>; 2],
    /// Length of the fairleads.
    pub(crate) reach: [L; 2],
    pub(crate) inverse_inertia: L,
    pub(crate) restitution: L,
    pub(crate) constant: [L; 2],
    pub(crate) wave: Harmonic<L>,
    /// Bounds on the force and its derivatives.
    pub(crate) force: [L; 3],
    /// Bounds on ÿ and on |ÿ|.
    pub(crate) upward: L,
    pub(crate) vertical_acceleration_bound: L,
    pub(crate) rotation_limit: L,
    /// The upper bound, less what the outline reaches above the centre at most.
    pub(crate) level: L,
    pub(crate) t_end: L,
    pub(crate) v_stick: L,
}

/// A motion just after an impact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AfterImpact<L> {
    pub(crate) t: L,
    pub(crate) state: State<L>,
    /// The rotation by θ.
    pub(crate) turn: Turn<L>,
    /// ẋ, ẏ, θ̇ before the impact.
    pub(crate) before: [L; 3],
    /// What is known of the gaps: value and error.
    pub(crate) gaps: [[L; 2]; 2],
    pub(crate) y_max: L,
    pub(crate) theta_max: L,
}

/// How many numbers a [`AfterImpact`] is.
pub(crate) const STATE_NUMBERS: usize = 20;

impl<L: Copy> AfterImpact<L> {
    /// All its numbers, to take one lane from or put one in.
    pub(crate) fn numbers(&self) -> [L; STATE_NUMBERS] {
        let [x, y, theta, vx, vy, vtheta] = self.state.components();
        let [ux, uy, utheta] = self.before;
        let [[gap, error], [other_gap, other_error]] = self.gaps;
        let (t, y_max, theta_max) = (self.t, self.y_max, self.theta_max);
        let Turn {
            sine,
            cosine,
            versine,
            sine_deficit,
        } = self.turn;
        [
            t,
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
            ux,
            uy,
            utheta,
            gap,
            error,
            other_gap,
            other_error,
            y_max,
            theta_max,
            sine,
            cosine,
            versine,
            sine_deficit,
        ]
    }

    /// From its numbers, in the same order.
    pub(crate) fn from_numbers(
        [
            t,
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
            ux,
            uy,
            utheta,
            gap,
            error,
            other_gap,
            other_error,
            y_max,
            theta_max,
            sine,
            cosine,
            versine,
            sine_deficit,
        ]: [L; STATE_NUMBERS],
    ) -> Self {
        Self {
            t,
            state: State::from_components([x, y, theta, vx, vy, vtheta]),
            turn: Turn {
                sine,
                cosine,
                versine,
                sine_deficit,
            },
            before: [ux, uy, utheta],
            gaps: [[gap, error], [other_gap, other_error]],
            y_max,
            theta_max,
        }
    }
}

impl<L: Lane> AfterImpact<L> {
    /// One of two, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        let (mut numbers, others) = (no.numbers(), yes.numbers());
        for k in 0..STATE_NUMBERS {
            numbers[k] = L::select(mask, others[k], numbers[k]);
        }
        Self::from_numbers(numbers)
    }
}

/// How many numbers a [`TwoCableSystem`] is.
pub(crate) const SYSTEM_NUMBERS: usize = 36;

impl<L: Copy> TwoCableSystem<L> {
    /// All its numbers, to put one lane in.
    pub(crate) fn numbers(&self) -> [L; SYSTEM_NUMBERS] {
        let [a, b, c, d, e, f, g, h] = self.cables[0].numbers();
        let [i, j, k, l, m, n, o, p] = self.cables[1].numbers();
        let Harmonic {
            omega,
            cosine: [cx, cy],
            sine: [dx, dy],
        } = self.wave;
        let [force, rate, bend] = self.force;
        [
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
            i,
            j,
            k,
            l,
            m,
            n,
            o,
            p,
            self.reach[0],
            self.reach[1],
            self.inverse_inertia,
            self.restitution,
            self.constant[0],
            self.constant[1],
            omega,
            cx,
            cy,
            dx,
            dy,
            force,
            rate,
            bend,
            self.upward,
            self.vertical_acceleration_bound,
            self.rotation_limit,
            self.level,
            self.t_end,
            self.v_stick,
        ]
    }

    /// From its numbers, in the same order.
    pub(crate) fn from_numbers(n: [L; SYSTEM_NUMBERS]) -> Self {
        Self {
            cables: [
                Cable::from_numbers([n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]]),
                Cable::from_numbers([n[8], n[9], n[10], n[11], n[12], n[13], n[14], n[15]]),
            ],
            reach: [n[16], n[17]],
            inverse_inertia: n[18],
            restitution: n[19],
            constant: [n[20], n[21]],
            wave: Harmonic {
                omega: n[22],
                cosine: [n[23], n[24]],
                sine: [n[25], n[26]],
            },
            force: [n[27], n[28], n[29]],
            upward: n[30],
            vertical_acceleration_bound: n[31],
            rotation_limit: n[32],
            level: n[33],
            t_end: n[34],
            v_stick: n[35],
        }
    }
}

impl<T: Real> TwoCableSystem<T> {
    /// Of a system with two cables and one harmonic, without drag; others are left to the general loop.
    pub(crate) fn of(system: &System<T>, rules: &Rules<T>) -> Option<Self> {
        let ([first, second], [wave], None) = (
            &system.cables[..],
            &system.forcing.harmonics[..],
            &system.drag,
        ) else {
            return None;
        };
        // A rule that is added has to be answered for here: a bounce on its own ends no other way than by a limit,
        // by the end of time, or by too many impacts, which the lanes count; what else ends a run needs a cable
        // that sticks, and that is no such bounce.
        let Rules {
            rotation_limit,
            upper_bound,
            settled_below: _,
            sliding_above: _,
            t_end,
            max_impacts: _,
            v_stick,
        } = *rules;
        let never = T::from_f64(NEVER);
        let upward = system.forcing.upward_acceleration_bound();
        Some(Self {
            cables: [*first, *second],
            reach: [length(first.fairlead()), length(second.fairlead())],
            inverse_inertia: system.body.inverse_inertia(),
            restitution: system.restitution,
            constant: system.forcing.constant,
            wave: *wave,
            force: system.forcing.bounds(),
            upward,
            vertical_acceleration_bound: system.forcing.vertical_acceleration_bound(),
            rotation_limit: rotation_limit.unwrap_or(never),
            level: upper_bound.unwrap_or(never) - system.body.reach(),
            t_end,
            v_stick,
        })
    }
}
