//! Slack flight in closed form (docs/model.md, section 4), and bounds on how the watched values
//! bend along it.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::{Force, Model, State, Watched};

/// A flight from a state at a time, which is a number.
pub(crate) struct Flight<'a> {
    pub(crate) model: &'a Model,
    pub(crate) begin: Ball,
    pub(crate) state: State,
    force: Force,
}

impl<'a> Flight<'a> {
    pub(crate) fn new(model: &'a Model, begin: Ball, state: State) -> Self {
        let force = model.force(&begin);
        Self {
            model,
            begin,
            state,
            force,
        }
    }

    /// vₓ + (f_o/Ω)(sin Ωt − sin Ωt₀) and v_y − τ − ν (f_o/Ω)(cos Ωt − cos Ωt₀), with the force then.
    pub(crate) fn velocity(&self, tau: &Ball) -> ([Ball; 2], Force) {
        let (m, start) = (self.model, &self.force);
        let force = m.force(&(&self.begin + tau));
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

    pub(crate) fn watched(&self, tau: &Ball) -> Vec<Watched> {
        self.model.watched(&self.at(tau).0)
    }

    /// Second derivatives of the watched values over a stretch of time about `middle`:
    ///
    /// g̈ = 2 (|Ṗ|² + D·P̈),   P̈ = f − θ̇² ρ,
    ///
    /// with D at the middle and, by the mean value theorem, Ṗ times half the length away from it.
    pub(crate) fn bends(&self, middle: &Ball, half: Radius) -> Vec<Ball> {
        let m = self.model;
        let reach = Ball::within(half);
        let (state, _) = self.at(middle);
        let stretch = middle.clone().widened(half);
        let (velocity, force) = self.velocity(&stretch);
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
