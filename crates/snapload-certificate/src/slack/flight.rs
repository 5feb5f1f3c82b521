//! Slack flight in closed form (docs/model.md, section 4), and bounds on the second and third
//! derivatives of the event functions along it.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::{EventValue, FIRST_TOP, Force, Model, State};
use crate::slack::search::{Path, name};

/// A flight from a state at a time; the time is a single number.
pub(crate) struct Flight<'a> {
    pub(crate) model: &'a Model,
    pub(crate) start: Ball,
    pub(crate) state: State,
    force: Force,
}

impl<'a> Flight<'a> {
    pub(crate) fn new(model: &'a Model, start: Ball, state: State) -> Self {
        let force = model.force(&start);
        Self {
            model,
            start,
            state,
            force,
        }
    }

    /// vₓ + (f_o/Ω)(sin Ωt − sin Ωt₀) and v_y − τ − ν (f_o/Ω)(cos Ωt − cos Ωt₀), with the force
    /// then.
    pub(crate) fn velocity(&self, tau: &Ball) -> ([Ball; 2], Force) {
        let (m, start) = (self.model, &self.force);
        let force = m.force(&(&self.start + tau));
        let [.., vx, vy, _] = &self.state;
        let velocity = if m.is_steady {
            [vx + &(tau * &force.x), vy - tau]
        } else {
            let [along, across] = [&force.sine - &start.sine, &force.cosine - &start.cosine];
            [
                vx + &(&m.f_over_omega * &along),
                vy - tau - &m.nu * &m.f_over_omega * &across,
            ]
        };
        (velocity, force)
    }

    /// The state after τ, and the force then:
    ///
    /// x + vₓτ + (f_o/Ω)((cos Ωt₀ − cos Ωt)/Ω − τ sin Ωt₀),
    /// y + v_yτ − τ²/2 + ν (f_o/Ω)(τ cos Ωt₀ − (sin Ωt − sin Ωt₀)/Ω),   θ + θ̇τ.
    pub(crate) fn at(&self, tau: &Ball) -> (State, Force) {
        let (m, start) = (self.model, &self.force);
        let ([ux, uy], force) = self.velocity(tau);
        let [x, y, theta, vx, vy, spin] = &self.state;
        let mut x = x + &(vx * tau);
        let mut y = y + &((vy - &tau.half()) * tau);
        if m.is_steady {
            x = x + (&force.x * &tau.squared()).half();
        } else {
            let drift = (&start.cosine - &force.cosine) * &m.inverse_omega - tau * &start.sine;
            x = x + &m.f_over_omega * &drift;
            let drift = tau * &start.cosine - (&force.sine - &start.sine) * &m.inverse_omega;
            y = y + &m.nu * &m.f_over_omega * &drift;
        }
        ([x, y, theta + &(spin * tau), ux, uy, spin.clone()], force)
    }
}

impl Path for Flight<'_> {
    fn count(&self) -> usize {
        FIRST_TOP + if self.model.has_corners() { 2 } else { 1 }
    }

    fn event_value(&self, which: usize, tau: &Ball) -> EventValue {
        self.model.event_value(which, &self.at(tau).0)
    }

    fn event_name(&self, which: usize) -> String {
        name(which).to_owned()
    }

    fn event_values(&self, tau: &Ball) -> Vec<EventValue> {
        self.model.event_values(&self.at(tau).0)
    }

    /// The third derivative of a gap: g⃛ = 2 (3 Ṗ·P̈ + D·P⃛), with P̈ = f − θ̇² ρ and P⃛ = ḟ − θ̇³
    /// ρ⟂.
    fn third(&self, which: usize, middle: &Ball, half: Radius) -> Option<Ball> {
        if which >= FIRST_TOP {
            return None;
        }
        let m = self.model;
        let over = middle.clone().widened(half);
        let (state, force) = self.at(&over);
        let end = m.end(which, &state, &m.turn(&state[2]));
        let ([dx, dy], [px, py], [ux, uy]) = (&end.reach, &end.arm, &end.velocity);
        let squared = state[5].squared();
        let cubed = &squared * &state[5];
        let second = [&force.x - &(&squared * px), &force.y - &(&squared * py)];
        let change = if m.is_steady {
            [Ball::zero(), Ball::zero()]
        } else {
            let swing = &m.f_o * &m.omega;
            [-(&swing * &force.sine), &m.nu * &swing * &force.cosine]
        };
        let third = [&change[0] + &(&cubed * py), &change[1] - &(&cubed * px)];
        let turning = (ux * &second[0] + uy * &second[1]) * Ball::integer(3);
        Some((turning + dx * &third[0] + dy * &third[1]).twice())
    }

    /// Second derivatives of the event functions over a stretch of time about `middle`:
    ///
    /// g̈ = 2 (|Ṗ|² + D·P̈),   P̈ = f − θ̇² ρ,
    ///
    /// with D enclosed by its value at the middle and, by the mean value theorem, Ṗ times half the
    /// length.
    fn second_derivatives(&self, middle: &Ball, half: Radius) -> Vec<Ball> {
        let m = self.model;
        let reach = Ball::within(half);
        let (state, _) = self.at(middle);
        let span = middle.clone().widened(half);
        let (velocity, force) = self.velocity(&span);
        let turn_then = m.turn(&state[2]);
        let spin = &state[5];
        let turn = m.turn(&(&state[2] + &(spin * &reach)));
        let [x, y, theta, _, _, _] = state.clone();
        let [vx, vy] = velocity;
        let moving = [x, y, theta, vx, vy, spin.clone()];
        let squared = spin.squared();
        let (mut gaps, mut tops) = (Vec::with_capacity(4), Vec::with_capacity(2));
        for cable in 0..2 {
            let [dx, dy] = m.end(cable, &state, &turn_then).reach;
            let end = m.end(cable, &moving, &turn);
            let ([px, py], [ux, uy]) = (end.arm, end.velocity);
            let pull = [&force.x - &(&squared * &px), &force.y - &(&squared * &py)];
            let along = (dx + &ux * &reach) * &pull[0] + (dy + &uy * &reach) * &pull[1];
            gaps.push((ux.squared() + uy.squared() + along).twice());
            let [_, up] = pull;
            tops.push(up);
        }
        if m.has_corners() {
            gaps.extend(tops);
        } else {
            gaps.push(force.y);
        }
        gaps
    }
}
