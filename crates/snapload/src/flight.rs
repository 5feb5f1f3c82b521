//! Slack flight, in closed form.

use crate::contact::{Contact, Contacts};
use crate::event::{Jet, Jets, Watch, Watched};
use crate::forcing::Push;
use crate::real::{Real, dot, length, quarter_turn};
use crate::taut_set::MAX_CABLES;
use crate::{Harmonic, State, System};

/// Bounds on derivatives are computed in rounded arithmetic; this much more makes them safe.
const INFLATION: f64 = 1.0 + 1e-9;

/// One cable's attachment at the start of a flight.
#[derive(Clone, Copy, Debug, Default)]
struct Tether<T> {
    /// d = P − A.
    span: [T; 2],
    /// ρ.
    lever: [T; 2],
    /// Ṗ.
    velocity: [T; 2],
    gap: T,
    gap_rate: T,
    gap_error: T,
    resting: bool,
    length: T,
    /// The larger of |Ṗ| at the start and a bound on it just before the event there.
    speed: T,
    /// Bounds on |P̈|, |P⃛|, |P⁗| over the flight.
    bounds: [T; 3],
}

/// The free motion from a state, with no cable taut (docs/model.md section 4; any sum of sinusoids).
///
/// Positions are start + velocity · s + a remainder of second order, and the remainder is computed
/// without cancellation; so a gap that starts closed, and its rate, are known to a few roundings *of
/// their own size*, however short the flight.
#[derive(Clone, Debug)]
pub(crate) struct Flight<T> {
    start: State<T>,
    sine: T,
    cosine: T,
    constant: [T; 2],
    harmonics: Vec<Harmonic<T>>,
    tethers: [Tether<T>; MAX_CABLES],
    cables: usize,
    rotation_limit: Option<T>,
    upper_bound: Option<T>,
    outline: [[T; 2]; 4],
    outline_count: usize,
    outline_radius: T,
    outline_third: T,
    most_upward: T,
}

/// The centre and the rotation at one instant of a flight.
struct Instant<T> {
    push: Push<T>,
    /// 1 − cos δ and δ − sin δ of the turn δ = θ̇s.
    chord: [T; 2],
    cosine_turn: T,
    sine_turn: T,
}

impl<T: Real> Flight<T> {
    /// A flight not yet begun, with room for the forcing of `system`.
    pub(crate) fn new(
        system: &System<T>,
        rotation_limit: Option<T>,
        upper_bound: Option<T>,
    ) -> Self {
        let (points, radius) = system.body.outline();
        let mut outline = [[T::ZERO; 2]; 4];
        outline[..points.points().len()].copy_from_slice(points.points());
        Self {
            start: State::default(),
            sine: T::ZERO,
            cosine: T::ONE,
            constant: system.forcing.constant,
            harmonics: system.forcing.harmonics.clone(),
            tethers: [Tether::default(); MAX_CABLES],
            cables: system.cables.len(),
            rotation_limit,
            upper_bound,
            outline,
            outline_count: points.points().len(),
            outline_radius: radius,
            outline_third: T::ZERO,
            most_upward: system.forcing.most_upward(),
        }
    }

    /// Begins the flight at time `t` from `start`, which an event has made of the state `before`.
    pub(crate) fn begin(
        &mut self,
        system: &System<T>,
        t: T,
        start: &State<T>,
        before: &State<T>,
        contacts: &Contacts<T>,
    ) {
        self.start = *start;
        (self.sine, self.cosine) = start.theta.sin_cos();
        for (local, harmonic) in self.harmonics.iter_mut().zip(&system.forcing.harmonics) {
            *local = harmonic.shifted(t);
        }
        let force_bounds = system.forcing.bounds();
        let spin = start.vtheta.abs();
        for (index, cable) in system.cables.iter().enumerate() {
            let lever = cable.lever(self.sine, self.cosine);
            let span = cable.span(start);
            let turn = quarter_turn(lever);
            let velocity = [
                start.vx + start.vtheta * turn[0],
                start.vy + start.vtheta * turn[1],
            ];
            let contact: &Contact<T> = &contacts[index];
            let reach = length(cable.fairlead());
            let mut bounds = force_bounds;
            let mut centripetal = spin * spin * reach;
            for bound in &mut bounds {
                *bound = (*bound + centripetal) * INFLATION;
                centripetal = centripetal * spin;
            }
            self.tethers[index] = Tether {
                span,
                lever,
                velocity,
                gap: contact.gap,
                gap_rate: if contact.resting {
                    T::ZERO
                } else {
                    dot(span, velocity) * 2.0
                },
                gap_error: contact.error,
                resting: contact.resting,
                length: cable.length(),
                speed: length(velocity)
                    .max(length([before.vx, before.vy]) + before.vtheta.abs() * reach),
                bounds,
            };
        }
        let reach = length(self.outline[0]);
        self.outline_third = (force_bounds[1] + spin * spin * spin * reach) * INFLATION;
    }

    fn instant(&self, s: T) -> Instant<T> {
        let mut push = Push::constant(self.constant, s);
        for harmonic in &self.harmonics {
            push = push.with_harmonic(harmonic, s);
        }
        let turn = self.start.vtheta * s;
        let (even, odd) = turn.versines();
        let chord = [turn * turn * even, turn * turn * odd];
        Instant {
            push,
            chord,
            cosine_turn: T::ONE - chord[0],
            sine_turn: turn - chord[1],
        }
    }

    /// The state a time `s` into the flight.
    pub(crate) fn state(&self, s: T) -> State<T> {
        self.state_at(s, &self.instant(s))
    }

    fn state_at(&self, s: T, now: &Instant<T>) -> State<T> {
        let start = &self.start;
        State {
            x: start.x + (start.vx * s + now.push.drift[0]),
            y: start.y + (start.vy * s + now.push.drift[1]),
            theta: start.theta + start.vtheta * s,
            vx: start.vx + now.push.gain[0],
            vy: start.vy + now.push.gain[1],
            vtheta: start.vtheta,
        }
    }

    /// The largest upward acceleration during any flight.
    pub(crate) fn most_upward(&self) -> T {
        self.most_upward
    }

    /// Bound on |ÿ|.
    pub(crate) fn steepest(&self) -> T {
        let down = self.constant[1] - (self.most_upward - self.constant[1]);
        self.most_upward.abs().max(down.abs())
    }

    /// The gap of a cable a time `s` into the flight.
    pub(crate) fn contact(&self, cable: usize, s: T) -> Contact<T> {
        let jet = self.gap_jet(cable, s, &self.instant(s));
        Contact {
            gap: jet.value,
            error: jet.noise,
            resting: false,
        }
    }

    /// g and ġ of a cable a time `s` into the flight.
    pub(crate) fn gap_and_rate(&self, cable: usize, s: T) -> (T, T) {
        let jet = self.gap_jet(cable, s, &self.instant(s));
        (jet.value, jet.rate)
    }

    /// The gap of a cable at the flight's start.
    pub(crate) fn gap_at_start(&self, cable: usize) -> T {
        self.tethers[cable].gap
    }

    /// Bound on |g̈| = 2 |Ṗ² + d·P̈| over the first `s` of the flight.
    pub(crate) fn gap_bend(&self, cable: usize, s: T) -> T {
        let tether = &self.tethers[cable];
        let speed = length(tether.velocity) + tether.bounds[0] * s;
        (speed * speed + tether.length * tether.bounds[0]) * 2.0
    }

    /// g, ġ, g̈ of a cable, with |g⃛| ≤ 2 (3 |Ṗ||P̈| + r |P⃛|) from there on.
    ///
    /// |P − A| ≤ r holds up to the first crossing, which is all that the bound is used for. |Ṗ| grows
    /// by at most |P̈| σ.
    fn gap_jet(&self, cable: usize, s: T, now: &Instant<T>) -> Jet<T> {
        let tether = &self.tethers[cable];
        let omega = self.start.vtheta;
        let turn = quarter_turn(tether.lever);
        let remainder = [0, 1]
            .map(|i| now.push.drift[i] - (now.chord[0] * tether.lever[i] + now.chord[1] * turn[i]));
        let moved = [0, 1].map(|i| tether.velocity[i] * s + remainder[i]);
        let span = [0, 1].map(|i| tether.span[i] + moved[i]);
        let turned = [0, 1].map(|i| turn[i] * now.sine_turn - tether.lever[i] * now.chord[0]);
        let lever = [0, 1].map(|i| tether.lever[i] + turned[i]);
        let swing = quarter_turn(turned);
        let gain = [0, 1].map(|i| now.push.gain[i] + omega * swing[i]);
        let velocity = [0, 1].map(|i| tether.velocity[i] + gain[i]);
        let accel = [0, 1].map(|i| now.push.force[i] - omega * omega * lever[i]);

        let linear = tether.gap_rate * s;
        let bend = dot(tether.span, remainder) * 2.0;
        let square = dot(moved, moved);
        let [a, j, _] = tether.bounds;
        let noise = ((tether.gap.abs() + linear.abs() + square) * 4.0
            + tether.length * a * s * s * 16.0)
            * T::EPSILON;
        Jet {
            third: (length(velocity) * a * 3.0 + tether.length * j) * 2.0,
            fourth: a * a * 6.0,
            noise: tether.gap_error + noise,
            blur: tether.length * tether.speed * s * T::EPSILON * 16.0,
            ..Jet::new(
                Watch::Gap(cable),
                tether.gap + (linear + bend + square),
                tether.gap_rate + (dot(moved, tether.velocity) + dot(span, gain)) * 2.0,
                (dot(velocity, velocity) + dot(span, accel)) * 2.0,
            )
        }
    }

    /// The jet of a cable known to be closed and at rest, at the start of the flight: with ġ = 0
    /// exact, f⃛ exact, and |g⁗| ≤ 2 (3 |P̈|² + 4 |Ṗ||P⃛| + r |P⁗|).
    fn resting_jet(&self, cable: usize, jet: Jet<T>) -> Jet<T> {
        let tether = &self.tethers[cable];
        let omega = self.start.vtheta;
        let now = self.instant(T::ZERO);
        let turn = quarter_turn(tether.lever);
        let accel = [0, 1].map(|i| now.push.force[i] - omega * omega * tether.lever[i]);
        let mut jerk = [0, 1].map(|i| -(omega * omega * omega) * turn[i]);
        for harmonic in &self.harmonics {
            for (i, component) in jerk.iter_mut().enumerate() {
                *component += harmonic.omega * harmonic.sine[i];
            }
        }
        let [a, j, k] = tether.bounds;
        // Over one unit of time; a longer first step is never needed.
        let speed = length(tether.velocity) + a;
        Jet {
            resting: true,
            blur: tether.length.squared() * T::EPSILON * 4.0,
            jerk: (dot(tether.velocity, accel) * 3.0 + dot(tether.span, jerk)) * 2.0,
            fourth: (a * a * 3.0 + speed * j * 4.0 + tether.length * k) * 2.0,
            ..jet
        }
    }

    fn watch_stops(&self, s: T, now: &Instant<T>, jets: &mut Jets<T>) {
        let state = self.state_at(s, now);
        if let Some(limit) = self.rotation_limit {
            let side = if state.vtheta < T::ZERO {
                -T::ONE
            } else {
                T::ONE
            };
            jets.push(Jet {
                noise: limit * T::EPSILON,
                ..Jet::new(
                    Watch::Rotation,
                    side * state.theta - limit,
                    side * state.vtheta,
                    T::ZERO,
                )
            });
        }
        let Some(level) = self.upper_bound else {
            return;
        };
        let sine = self.sine * now.cosine_turn + self.cosine * now.sine_turn;
        let cosine = self.cosine * now.cosine_turn - self.sine * now.sine_turn;
        for [px, py] in &self.outline[..self.outline_count] {
            let height = *px * sine + *py * cosine;
            let swing = *px * cosine - *py * sine;
            jets.push(Jet {
                third: self.outline_third,
                noise: (level.abs() + state.y.abs() + height.abs()) * T::EPSILON * 4.0,
                ..Jet::new(
                    Watch::Top,
                    state.y + height + self.outline_radius - level,
                    state.vy + state.vtheta * swing,
                    now.push.force[1] - state.vtheta.squared() * height,
                )
            });
        }
    }
}

impl<T: Real> Watched<T> for Flight<T> {
    fn watch(&self, s: T, jets: &mut Jets<T>) {
        let now = self.instant(s);
        for cable in 0..self.cables {
            let jet = self.gap_jet(cable, s, &now);
            let at_rest = s == T::ZERO && self.tethers[cable].resting;
            jets.push(if at_rest {
                self.resting_jet(cable, jet)
            } else {
                jet
            });
        }
        self.watch_stops(s, &now, jets);
    }
}
