//! One cable along a slack flight, in closed form.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::plane::{Rotation, Vector2};
use crate::arithmetic::processor::apart;
use crate::model::cable::Cable;
use crate::model::forcing::{Harmonic, Push};
use crate::model::state::State;

/// Bounds on derivatives are computed in rounded arithmetic; this factor makes them safe.
pub(crate) const INFLATION: f64 = 1.0 + 1e-9;

/// One cable's attachment at the start of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attachment<L> {
    /// d = P − A.
    pub(crate) span: Vector2<L>,
    /// ρ.
    pub(crate) lever: Vector2<L>,
    /// Ṗ.
    pub(crate) velocity: Vector2<L>,
    pub(crate) gap: L,
    pub(crate) gap_rate: L,
    pub(crate) gap_error: L,
    pub(crate) length: L,
    /// Bound on |Ṗ| at the start, before and after the event there.
    pub(crate) speed: L,
    /// Bounds on |P̈|, |P⃛|, |P⁗| over the flight.
    pub(crate) bounds: [L; 3],
}

/// The effect of the forces and the rotation at one instant of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<L> {
    pub(crate) push: Push<L>,
    /// The rotation by δ = θ̇s since the start.
    pub(crate) rotation: Rotation<L>,
    /// θ̇.
    pub(crate) spin: L,
}

/// A gap with its derivatives at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapJet<L> {
    pub(crate) value: L,
    pub(crate) rate: L,
    pub(crate) accel: L,
    pub(crate) jerk: L,
    /// Bound on the rounding error of `value`, not including errors of the motion's start.
    pub(crate) noise: L,
    /// Ṗ.
    pub(crate) velocity: Vector2<L>,
}

impl<L: Lane> Attachment<L> {
    /// The attachment of a cable whose fairlead is `reach` from the centre, where the body is
    /// turned by `rotation` and gap and error are known; `force` bounds the force and its
    /// derivatives.
    #[inline(always)]
    pub(crate) fn new(
        cable: &Cable<L>,
        reach: L,
        state: &State<L>,
        rotation: &Rotation<L>,
        [gap, gap_error]: [L; 2],
        speed: L,
        force: [L; 3],
    ) -> Self {
        apart!(L, {
            let span = cable.span_moved(cable.moved(state, rotation));
            let lever = cable.lever(rotation.sine, rotation.cosine);
            let spin = state.vtheta;
            let velocity = state.velocity().plus_scaled(lever.quarter_turn(), spin);
            let turning = spin.abs();
            let centripetal = spin * spin * reach;
            let jerk = centripetal * turning;
            Self {
                span,
                lever,
                velocity,
                gap,
                gap_rate: span.dot(velocity) * 2.0,
                gap_error,
                length: cable.length(),
                speed,
                bounds: [
                    (force[0] + centripetal) * INFLATION,
                    (force[1] + jerk) * INFLATION,
                    jerk.mul_add(turning, force[2]) * INFLATION,
                ],
            }
        })
    }

    /// g, ġ, g̈, g⃛ a time `s` into the flight.
    ///
    /// With P − P₀ = Ṗ₀ s + q, where q is of second order and free of cancellation, g = g₀ + ġ₀ s +
    /// 2 d₀·q + |P − P₀|²; so a gap that starts closed, and its rate, are known to a few roundings
    /// *of their own size*, however short the flight.
    #[inline(always)]
    pub(crate) fn jet(&self, s: L, now: &Instant<L>) -> GapJet<L> {
        apart!(L, {
            let (push, rotation, spin) = (&now.push, &now.rotation, now.spin);
            let (lever, quarter) = (self.lever, self.lever.quarter_turn());
            let bent =
                Vector2::combined(rotation.versine, lever, rotation.angle_minus_sine, quarter);
            let remainder = push.drift - bent;
            let moved = remainder.plus_scaled(self.velocity, s);
            let span = self.span + moved;
            // The changes of the lever and of its quarter turn.
            let turned = Vector2::combined(rotation.sine, quarter, -rotation.versine, lever);
            let lever = lever + turned;
            let gain = push.gain.plus_scaled(turned.quarter_turn(), spin);
            let velocity = self.velocity + gain;
            let square_spin = spin * spin;
            let accel = push.force.plus_scaled(lever, -square_spin);
            let jerk = push
                .rate
                .plus_scaled(lever.quarter_turn(), -(square_spin * spin));

            let two = L::from_f64(2.0);
            let linear = self.gap_rate * s;
            let along_span = self.span.dot(remainder);
            let square = moved.dot(moved);
            let size = self.gap.abs() + linear.abs() + square;
            let noise = (self.length * self.bounds[0] * 16.0).mul_add(s * s, size * 4.0);
            GapJet {
                value: self.gap + along_span.mul_add(two, linear + square),
                rate: (moved.dot(self.velocity) + span.dot(gain)).mul_add(two, self.gap_rate),
                accel: (velocity.dot(velocity) + span.dot(accel)) * 2.0,
                jerk: velocity
                    .dot(accel)
                    .mul_add(L::from_f64(3.0), span.dot(jerk))
                    * 2.0,
                noise: noise.mul_add(L::EPSILON, self.gap_error),
                velocity,
            }
        })
    }

    /// Bound on the change of the gap a time `s` into the flight by the rounding of the velocities
    /// at its start.
    #[inline(always)]
    pub(crate) fn start_noise(&self, s: L) -> L {
        self.length * self.speed * s * L::EPSILON * 16.0
    }

    /// |d| within a flight of length `s` on which |Ṗ| ≤ `speed`; it is at most r at both ends.
    #[inline(always)]
    fn span_bound(&self, speed: L, s: L) -> L {
        speed.mul_add(s * 0.5, self.length)
    }

    /// |g⃛| ≤ 2 (3 |Ṗ||P̈| + |d||P⃛|) up to `s`, where |Ṗ| grows by at most |P̈|s, and |d| exceeds
    /// r by at most |Ṗ|s/2 if |d| ≤ r at both ends.
    #[inline(always)]
    pub(crate) fn third(&self, s: L) -> L {
        let [a, j, _] = self.bounds;
        let speed = a.mul_add(s, self.speed);
        (self.span_bound(speed, s).mul_add(j, speed * a * 3.0)) * 2.0
    }

    /// |g⁗| ≤ 2 (3 |P̈|² + 4 |Ṗ||P⃛| + |d||P⁗|), likewise.
    #[inline(always)]
    pub(crate) fn fourth(&self, s: L) -> L {
        let [a, j, k] = self.bounds;
        let speed = a.mul_add(s, self.speed);
        let fixed = (speed * 4.0).mul_add(j, a * a * 3.0);
        self.span_bound(speed, s).mul_add(k, fixed) * 2.0
    }

    /// g̈ = 2 (|Ṗ|² + d·P̈), g⃛ = 2 (3 Ṗ·P̈ + d·P⃛) and g⁗ = 2 (3 |P̈|² + 4 Ṗ·P⃛ + d·P⁗) at the
    /// start, with the force and its derivatives there: P̈ = f − θ̇²ρ, P⃛ = ḟ − θ̇³ k×ρ, P⁗ = f̈ +
    /// θ̇⁴ρ.
    #[inline(always)]
    pub(crate) fn gap_derivatives_at_start(&self, force: [Vector2<L>; 3], spin: L) -> [L; 3] {
        let square = spin * spin;
        let [force, rate, second] = force;
        let three = L::from_f64(3.0);
        let (span, velocity) = (self.span, self.velocity);
        let accel = force.plus_scaled(self.lever, -square);
        let jerk = rate.plus_scaled(self.lever.quarter_turn(), -(square * spin));
        let snap = second.plus_scaled(self.lever, square * square);
        let fourth = accel.dot(accel).mul_add(three, span.dot(snap));
        [
            (velocity.dot(velocity) + span.dot(accel)) * 2.0,
            velocity.dot(accel).mul_add(three, span.dot(jerk)) * 2.0,
            velocity.dot(jerk).mul_add(L::from_f64(4.0), fourth) * 2.0,
        ]
    }
}

impl<L: Lane> Instant<L> {
    /// The state, from that at the start.
    #[inline(always)]
    pub(crate) fn state(&self, start: &State<L>, s: L) -> State<L> {
        advanced(start, s, [self.push.drift, self.push.gain])
    }

    /// The effect a time `s` into a flight with angular velocity `spin` under a constant force;
    /// harmonics are added.
    #[inline(always)]
    pub(crate) fn at(s: L, constant: Vector2<L>, spin: L) -> Self {
        Self {
            push: Push::constant(constant, s),
            rotation: Rotation::by(spin * s),
            spin,
        }
    }

    /// The same with a harmonic added, which is given relative to the flight's start.
    #[inline(always)]
    pub(crate) fn with(self, wave: &Harmonic<L>, s: L) -> Self {
        Self {
            push: self.push.with_harmonic(wave, s),
            ..self
        }
    }
}

/// The state a time `s` after `start`, from the drift of position and the gain of velocity by the
/// forces.
#[inline(always)]
pub(crate) fn advanced<L: Lane>(
    start: &State<L>,
    s: L,
    [drift, gain]: [Vector2<L>; 2],
) -> State<L> {
    State {
        x: start.x + start.vx.mul_add(s, drift.x),
        y: start.y + start.vy.mul_add(s, drift.y),
        theta: start.vtheta.mul_add(s, start.theta),
        vx: start.vx + gain.x,
        vy: start.vy + gain.y,
        vtheta: start.vtheta,
    }
}

impl<L: Lane> GapJet<L> {
    /// The jet a little later, by its cubic, where |g⁗| ≤ `fourth` in between; Ṗ is not updated.
    #[inline(always)]
    pub(crate) fn later(&self, s: L, fourth: L) -> Self {
        let sixth = self.jerk * L::sixth();
        let square = s * s;
        Self {
            value: self.value + self.rise(s, sixth),
            rate: (self.jerk * 0.5)
                .mul_add(s, self.accel)
                .mul_add(s, self.rate),
            accel: self.jerk.mul_add(s, self.accel),
            noise: (fourth * (1.0 / 24.0)).mul_add(square * square, self.noise),
            ..*self
        }
    }

    /// The increase of the cubic in a time `s`, given a sixth of the third derivative.
    #[inline(always)]
    fn rise(&self, s: L, sixth: L) -> L {
        let quadratic = sixth.mul_add(s, self.accel * 0.5);
        quadratic.mul_add(s, self.rate) * s
    }

    /// An approximation to the time until the cubic is zero, by reversion of its series to the
    /// third order, and the value of the cubic there.
    #[inline(always)]
    pub(crate) fn root(&self) -> (L, L) {
        let sixth = self.jerk * L::sixth();
        let per_rate = L::ONE / self.rate;
        let u = -(self.value * per_rate);
        let (quadratic, cubic) = (self.accel * 0.5 * per_rate, sixth * per_rate);
        let third = (quadratic * 2.0).mul_add(quadratic, -cubic);
        let s = u.mul_add(third, -quadratic).mul_add(u, L::ONE) * u;
        let s = (-per_rate).mul_add(self.value + self.rise(s, sixth), s);
        (s, self.value + self.rise(s, sixth))
    }

    /// One of two jets, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            value: L::select(mask, yes.value, no.value),
            rate: L::select(mask, yes.rate, no.rate),
            accel: L::select(mask, yes.accel, no.accel),
            jerk: L::select(mask, yes.jerk, no.jerk),
            noise: L::select(mask, yes.noise, no.noise),
            velocity: Vector2::select(mask, yes.velocity, no.velocity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::precise::Precise;
    use crate::arithmetic::real::Real;

    /// The update of a flight to its crossing is exact to the last digit of any arithmetic: with 1,
    /// 2 and 6 as derivatives the cubic is g + s + s² + s³, and a force that grows by 6 drifts by
    /// s³.
    #[test]
    fn cubics_keep_all_digits() {
        type Digits = Precise<8>;
        let [g, rate, accel, jerk, s] =
            [-0.015625, 1.0, 2.0, 6.0, 0.125].map(<Digits as Real>::from_f64);
        let zero = <Digits as Real>::ZERO;
        let jet = GapJet {
            value: g,
            rate,
            accel,
            jerk,
            noise: zero,
            velocity: Vector2::ZERO,
        };
        let off = |got: Digits, exact: Digits| (got - exact).to_f64().abs();
        let cubic = |s: Digits| g + s * (rate + s * (rate + s));
        assert!(off(jet.later(s, zero).value, cubic(s)) < 1e-150);
        let (root, left) = jet.root();
        assert!(off(left, cubic(root)) < 1e-150 && left.to_f64().abs() < 1e-7);

        let push = Push {
            drift: Vector2::ZERO,
            gain: Vector2::ZERO,
            force: Vector2::ZERO,
            rate: [jerk, zero].into(),
        };
        let [drift, gain] = push.later(s, [zero, jerk].into());
        assert!(off(drift.x, s * s * s) < 1e-150 && off(gain.y, s * s * s) < 1e-150);
    }
}
