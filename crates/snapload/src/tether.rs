//! One cable along a slack flight, in closed form.

use crate::forcing::Push;
use crate::lane::{Lane, Turn, combined, difference, dot, quarter_turn, scaled, select2, sum};
use crate::{Cable, Harmonic, State};

/// Bounds on derivatives are computed in rounded arithmetic; this much more makes them safe.
pub(crate) const INFLATION: f64 = 1.0 + 1e-9;

/// One cable's attachment at the start of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tether<L> {
    /// d = P − A.
    pub(crate) span: [L; 2],
    /// ρ.
    pub(crate) lever: [L; 2],
    /// Ṗ.
    pub(crate) velocity: [L; 2],
    pub(crate) gap: L,
    pub(crate) gap_rate: L,
    pub(crate) gap_error: L,
    pub(crate) length: L,
    /// Bound on |Ṗ| at the start, before and after the event there.
    pub(crate) speed: L,
    /// Bounds on |P̈|, |P⃛|, |P⁗| over the flight.
    pub(crate) bounds: [L; 3],
}

/// What the forces and the rotation have done at one instant of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<L> {
    pub(crate) push: Push<L>,
    /// The turn δ = θ̇s since the start.
    pub(crate) turn: Turn<L>,
    /// θ̇.
    pub(crate) spin: L,
}

/// A gap with its derivatives at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapJet<L> {
    pub(crate) value: L,
    pub(crate) rate: L,
    pub(crate) accel: L,
    /// Bound on the rounding error of `value`, the motion taken as exact.
    pub(crate) noise: L,
    /// Ṗ.
    pub(crate) velocity: [L; 2],
}

impl<L: Lane> Tether<L> {
    /// Of a cable whose fairlead is `reach` from the centre, where θ is a `turn` from rest and gap and error are
    /// known; `force` bounds the force and its derivatives.
    #[inline(always)]
    pub(crate) fn new(
        cable: &Cable<L>,
        reach: L,
        state: &State<L>,
        turn: &Turn<L>,
        [gap, gap_error]: [L; 2],
        speed: L,
        force: [L; 3],
    ) -> Self {
        let span = cable.span_moved(cable.moved(state, turn));
        let lever = cable.lever(turn.sine, turn.cosine);
        let spin = state.vtheta;
        let velocity = sum([state.vx, state.vy], scaled(quarter_turn(lever), spin));
        let turning = spin.abs();
        let centripetal = spin * spin * reach;
        let jerk = centripetal * turning;
        Self {
            span,
            lever,
            velocity,
            gap,
            gap_rate: dot(span, velocity) * 2.0,
            gap_error,
            length: cable.length(),
            speed,
            bounds: [
                (force[0] + centripetal) * INFLATION,
                (force[1] + jerk) * INFLATION,
                (force[2] + jerk * turning) * INFLATION,
            ],
        }
    }

    /// g, ġ, g̈ a time `s` into the flight.
    ///
    /// With P − P₀ = Ṗ₀ s + q, where q is of second order and free of cancellation,
    /// g = g₀ + ġ₀ s + 2 d₀·q + |P − P₀|²; so a gap that starts closed, and its rate, are known to a few
    /// roundings *of their own size*, however short the flight.
    #[inline(always)]
    pub(crate) fn jet(&self, s: L, now: &Instant<L>) -> GapJet<L> {
        let (push, turn, spin) = (&now.push, &now.turn, now.spin);
        let quarter = quarter_turn(self.lever);
        let bent = combined(turn.chord, self.lever, turn.lag, quarter);
        let remainder = difference(push.drift, bent);
        let moved = sum(scaled(self.velocity, s), remainder);
        let span = sum(self.span, moved);
        // What the lever and its quarter turn have changed by.
        let turned = combined(turn.sine, quarter, -turn.chord, self.lever);
        let lever = sum(self.lever, turned);
        let gain = sum(push.gain, scaled(quarter_turn(turned), spin));
        let velocity = sum(self.velocity, gain);
        let accel = difference(push.force, scaled(lever, spin * spin));

        let linear = self.gap_rate * s;
        let bend = dot(self.span, remainder) * 2.0;
        let square = dot(moved, moved);
        let size = self.gap.abs() + linear.abs() + square;
        let noise = size * 4.0 + self.length * self.bounds[0] * s * s * 16.0;
        GapJet {
            value: self.gap + (linear + bend + square),
            rate: self.gap_rate + (dot(moved, self.velocity) + dot(span, gain)) * 2.0,
            accel: (dot(velocity, velocity) + dot(span, accel)) * 2.0,
            noise: self.gap_error + noise * L::EPSILON,
            velocity,
        }
    }

    /// What the rounding of the velocities at the flight's start may have changed the gap by, a time `s` into
    /// it.
    #[inline(always)]
    pub(crate) fn blur(&self, s: L) -> L {
        self.length * self.speed * s * L::EPSILON * 16.0
    }

    /// g̈ = 2 (|Ṗ|² + d·P̈) and g⃛ = 2 (3 Ṗ·P̈ + d·P⃛) at the start, with the force f and its
    /// rate ḟ there: P̈ = f − θ̇²ρ, P⃛ = ḟ − θ̇³ k×ρ.
    #[inline(always)]
    pub(crate) fn bend_at_start(&self, force: [L; 2], force_rate: [L; 2], spin: L) -> [L; 2] {
        let square = spin * spin;
        let accel = difference(force, scaled(self.lever, square));
        let jerk = difference(force_rate, scaled(quarter_turn(self.lever), square * spin));
        [
            (dot(self.velocity, self.velocity) + dot(self.span, accel)) * 2.0,
            (dot(self.velocity, accel) * 3.0 + dot(self.span, jerk)) * 2.0,
        ]
    }

    /// One of two tethers, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        let [a, j, k] = yes.bounds;
        let [b, l, m] = no.bounds;
        Self {
            span: select2(mask, yes.span, no.span),
            lever: select2(mask, yes.lever, no.lever),
            velocity: select2(mask, yes.velocity, no.velocity),
            gap: L::select(mask, yes.gap, no.gap),
            gap_rate: L::select(mask, yes.gap_rate, no.gap_rate),
            gap_error: L::select(mask, yes.gap_error, no.gap_error),
            length: L::select(mask, yes.length, no.length),
            speed: L::select(mask, yes.speed, no.speed),
            bounds: [
                L::select(mask, a, b),
                L::select(mask, j, l),
                L::select(mask, k, m),
            ],
        }
    }
}

impl<L: Lane> Instant<L> {
    /// The state, from that at the start.
    #[inline(always)]
    pub(crate) fn state(&self, start: &State<L>, s: L) -> State<L> {
        let push = &self.push;
        State {
            x: start.x + (start.vx * s + push.drift[0]),
            y: start.y + (start.vy * s + push.drift[1]),
            theta: start.theta + start.vtheta * s,
            vx: start.vx + push.gain[0],
            vy: start.vy + push.gain[1],
            vtheta: start.vtheta,
        }
    }

    /// A time `s` into a flight that turns at `spin` under a constant force; harmonics are added.
    #[inline(always)]
    pub(crate) fn at(s: L, constant: [L; 2], spin: L) -> Self {
        Self {
            push: Push::constant(constant, s),
            turn: Turn::by(spin * s),
            spin,
        }
    }

    /// With a harmonic that is given relative to the flight's start.
    #[inline(always)]
    pub(crate) fn with(self, wave: &Harmonic<L>, s: L) -> Self {
        Self {
            push: self.push.with_harmonic(wave, s),
            ..self
        }
    }
}

impl<L: Lane> GapJet<L> {
    /// One of two jets, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            value: L::select(mask, yes.value, no.value),
            rate: L::select(mask, yes.rate, no.rate),
            accel: L::select(mask, yes.accel, no.accel),
            noise: L::select(mask, yes.noise, no.noise),
            velocity: select2(mask, yes.velocity, no.velocity),
        }
    }
}
