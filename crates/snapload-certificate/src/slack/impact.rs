//! The law of impact (docs/model.md, section 5), and its effect on small deviations.

use crate::arithmetic::ball::Ball;
use crate::model::{CableEnd, Force, Model, State};
use crate::verdict::ProofFailure;

/// A 3 × 3 block on positions or velocities.
type Block = [[Ball; 3]; 3];
pub(crate) type Matrix = [[Ball; 6]; 6];

/// A cable at the instant at which its gap is zero and closes.
pub(crate) struct Impact {
    pub(crate) end: CableEnd,
    /// G = (n_x, n_y, s), the derivative of the gap by (x, y, θ) over 2 r.
    pub(crate) g: [Ball; 3],
    /// u = M⁻¹ G.
    pub(crate) u: [Ball; 3],
    pub(crate) inverse_w: Ball,
    /// G·v⁻, above zero.
    pub(crate) v_n: Ball,
}

impl Impact {
    pub(crate) fn new(model: &Model, cable: usize, state: &State) -> Result<Self, ProofFailure> {
        let end = model.end(cable, state, &model.turn(&state[2]));
        let n = [
            &end.reach[0] * &model.inverse_r,
            &end.reach[1] * &model.inverse_r,
        ];
        let s = &end.arm[0] * &n[1] - &end.arm[1] * &n[0];
        let [n_x, n_y] = n;
        let spun = &s * &model.inverse_inertia;
        let w = Ball::integer(1) + &s * &spun;
        let inverse_w = w
            .reciprocal()
            .ok_or(ProofFailure::undecided("an effective mass"))?;
        let v_n = &n_x * &end.velocity[0] + &n_y * &end.velocity[1];
        Ok(Self {
            end,
            u: [n_x.clone(), n_y.clone(), spun],
            g: [n_x, n_y, s],
            inverse_w,
            v_n,
        })
    }

    /// W_ij = G_iᵀ M⁻¹ G_j of this cable and another.
    pub(crate) fn coupling(&self, other: &Self) -> Ball {
        let [a, b, c] = &self.u;
        a * &other.g[0] + b * &other.g[1] + c * &other.g[2]
    }

    /// v − share · v_n u / w: the velocity after the impact if share = 1 + e; with share = 1 the
    /// normal velocity is zero.
    pub(crate) fn velocity(&self, state: &State, share: &Ball) -> [Ball; 3] {
        let impulse = share * &self.v_n * &self.inverse_w;
        std::array::from_fn(|i| &state[3 + i] - &(&impulse * &self.u[i]))
    }

    /// T r w for a cable that stays taut at this state, which has the sign of its tension T: r b
    /// with the normal velocity set to zero, as g̈/(2r) = b − w T = 0.
    pub(crate) fn pull(&self, state: &State, force: &Force) -> Ball {
        self.load(&self.velocity(state, &Ball::integer(1)), force)
    }

    /// r b = |Ṗ|² + D·(f − θ̇² ρ), with b = g̈/(2r) for zero tension, at a velocity of the body.
    pub(crate) fn load(&self, [vx, vy, spin]: &[Ball; 3], force: &Force) -> Ball {
        let ([px, py], [dx, dy]) = (&self.end.arm, &self.end.reach);
        let (ux, uy) = (vx - &(spin * py), vy + &(spin * px));
        let squared = spin.squared();
        let along = dx * &(&force.x - &(&squared * px)) + dy * &(&force.y - &(&squared * py));
        ux.squared() + uy.squared() + along
    }

    /// The Jacobian of the state after an impact, at a fixed time, by the state before it, at a
    /// fixed time: with 3 × 3 blocks on positions and velocities
    ///
    /// J = [1 τ₂; 0 1] · [A 0; C A] · [1 τ₁; 0 1],
    /// A = 1 − (1 + e) u Gᵀ/w,   C = Q − (Q v⁻ + (A − 1) a) Gᵀ/v_n,
    ///
    /// where τ₁ and τ₂ are the times from the first fixed time to the impact and from there to the
    /// second, Q = ∂v⁺/∂q at fixed v⁻, and a the force. The instant moves by δt = −G·δq/v_n; at
    /// fixed time this shifts the position by (v⁻ − v⁺) δt, which makes the upper left block A, and
    /// the velocity by the terms that C subtracts.
    pub(crate) fn jacobian(
        &self,
        model: &Model,
        state: &State,
        force: &Force,
        before: &Ball,
        after: &Ball,
    ) -> Result<Matrix, ProofFailure> {
        let v = &state[3..6];
        let k = Ball::integer(1) + &model.e;
        let scale = &k * &self.inverse_w;
        let a: Block = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let unit = Ball::integer(i64::from(i == j));
                unit - &scale * &self.u[i] * &self.g[j]
            })
        });
        let q = self.derivative_at_fixed_velocity(model, v, &k);
        let inverse_v = self.v_n.reciprocal();
        let inverse_v = inverse_v.ok_or(ProofFailure::undecided("whether the cable closes"))?;
        let driven = &scale * &(&self.g[0] * &force.x + &self.g[1] * &force.y);
        let late: [Ball; 3] = std::array::from_fn(|i| {
            let turned = &q[i][0] * &v[0] + &q[i][1] * &v[1] + &q[i][2] * &v[2];
            (turned - &driven * &self.u[i]) * &inverse_v
        });
        let c: Block =
            std::array::from_fn(|i| std::array::from_fn(|j| &q[i][j] - &(&late[i] * &self.g[j])));
        let lower: [[Ball; 6]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| match j {
                0..3 => c[i][j].clone(),
                _ => &a[i][j - 3] + &(&c[i][j - 3] * before),
            })
        });
        Ok(std::array::from_fn(|i| match i {
            0..3 => std::array::from_fn(|j| {
                let flight_term = match j {
                    0..3 => a[i][j].clone(),
                    _ => &a[i][j - 3] * before,
                };
                flight_term + after * &lower[i][j]
            }),
            _ => lower[i - 3].clone(),
        }))
    }

    /// Q = ∂v⁺/∂q at fixed v⁻, with v⁺ = v − (1 + e) β u and β = G·v/w:
    ///
    /// Q = −(1 + e) (M⁻¹ ∂G β + u ∂β),   ∂β = (∂G·v − β ∂w)/w,   ∂w = 2 s ∂s/I.
    fn derivative_at_fixed_velocity(&self, model: &Model, v: &[Ball], k: &Ball) -> Block {
        let [px, py] = &self.end.arm;
        let beta = &self.v_n * &self.inverse_w;
        let one = &model.inverse_r;
        // ∂n/∂q: D moves with x and y, and by (−ρ_y, ρ_x) with θ.
        let dn = [
            [one.clone(), Ball::zero()],
            [Ball::zero(), one.clone()],
            [-(py * one), px * one],
        ];
        let mut q: Block = std::array::from_fn(|_| std::array::from_fn(|_| Ball::zero()));
        for (j, [dx, dy]) in dn.iter().enumerate() {
            let mut ds = px * dy - py * dx;
            if j == 2 {
                // ∂ρ/∂θ: the arm turns with the body.
                ds = ds - (py * &self.g[1] + px * &self.g[0]);
            }
            let spun = &ds * &model.inverse_inertia;
            let dw_beta = (&beta * &self.u[2] * &ds).twice();
            let dbeta = (dx * &v[0] + dy * &v[1] + &ds * &v[2] - dw_beta) * &self.inverse_w;
            for (i, dg) in [dx, dy, &spun].into_iter().enumerate() {
                q[i][j] = -(k * &(dg * &beta + &self.u[i] * &dbeta));
            }
        }
        q
    }
}
