//! From one impact to the next: a slack flight of a body on two cables under one sinusoid, and one cable
//! snapping taut at its end. Nearly every step of nearly every run is such a bounce.
//!
//! Written over [`Lane`], so that one text is the ordinary motion and that of several cases side by
//! side. A bounce is found by a guess and proven afterwards:
//!
//! 1. *Guess*, from the Taylor polynomial of both gaps at the start, which cable closes first, and when.
//! 2. *Meet*: Halley's iteration on that gap, until what its quadratic leaves out is below rounding.
//! 3. *Exclude*: with value, rate and bend known at *both* ends of the flight, and bounds on what is beyond, each
//!    gap is shown to stay open in between, the early part from the start and the late part from the end.
//!    The rotation and the height of the body are bounded likewise.
//! 4. *Law*: one cable, closed by itself and closing; p = (1 + e) v_n/w.
//!
//! Whatever does not fit (a bound that is too weak, cables that close together, a cable that may stick, a
//! stop, a graze) is left to the general loop in [`crate::simulate`]: a step is a bounce or it is not, by
//! what it is, and never by which lane it is in. So the bits of a run do not depend on lanes.

use crate::extremes::highest;
use crate::forcing::Push;
use crate::lane::{Lane, Mask, Turn, difference, length_bound, scaled, select2, sum};
use crate::mooring::{Moment, Mooring, NEVER};
use crate::real::Real;
use crate::tether::{GapJet, INFLATION, Instant, Tether};
use crate::{Cable, Harmonic, State};

/// A stop closer than this is left to the general search \[L\], \[rad\].
const NEAR_STOP: f64 = 1e-9;
/// The most looks of one search; one is usual.
const MOST_LOOKS: usize = 10;
/// What a look leaves out is so many times smaller than what rounding may come to.
const BELOW_ROUNDING: f64 = 16.0;
/// The part of a flight in which its start has to prove a gap open; there a higher derivative is known.
const EARLY: f64 = 0.6;
/// A normal velocity of this many roundings of the attachment's speed is zero: that of a taut cable which
/// an impulse neither loads nor unloads.
pub(crate) const UNMOVED: f64 = 64.0;

/// What a bounce came to, in the lanes in which it is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce<L: Lane> {
    /// Whether the flight ends as told here.
    pub(crate) arrived: L::Mask,
    /// Whether the highest point of the flight is known, too.
    pub(crate) topped: L::Mask,
    /// Whether, besides, the law of one cable is all that happens.
    pub(crate) plain: L::Mask,
    /// Which cable: the second instead of the first.
    pub(crate) second: L::Mask,
    /// How long the flight was.
    pub(crate) s: L,
    pub(crate) before: State<L>,
    pub(crate) v_n: L,
    pub(crate) impulse: L,
    /// After the impact, with the extremes of the flight.
    pub(crate) next: Moment<L>,
}

/// A flight seen at one instant near its end.
struct Look<L: Lane> {
    s: L,
    now: Instant<L>,
    jets: [GapJet<L>; 2],
    /// That of the cable that is to close.
    struck: GapJet<L>,
    /// How much later it closes, by the cubic.
    rest: L,
    /// Bounds on |g⁗| up to there.
    fourths: [L; 2],
    /// Whether the gap closes there.
    rising: L::Mask,
    /// Whether what the cubic leaves out is below rounding.
    near: L::Mask,
}

/// The end of a flight.
struct Arrival<L> {
    s: L,
    state: State<L>,
    jets: [GapJet<L>; 2],
}

impl<L: Lane> Arrival<L> {
    /// The same numbers with the derivatives of others.
    #[inline(always)]
    fn with_slopes_of(self, other: &Self) -> Self {
        let [jet, other_jet] = self.jets;
        let mut numbers = self.state.components();
        for (number, slopes) in numbers.iter_mut().zip(other.state.components()) {
            *number = with_slopes(*number, slopes);
        }
        Self {
            s: with_slopes(self.s, other.s),
            state: State::from_components(numbers),
            jets: [
                GapJet {
                    value: with_slopes(jet.value, other.jets[0].value),
                    ..jet
                },
                GapJet {
                    value: with_slopes(other_jet.value, other.jets[1].value),
                    ..other_jet
                },
            ],
        }
    }
}

/// A number with the derivatives of another.
#[inline(always)]
fn with_slopes<L: Lane>(number: L, slopes: L) -> L {
    number.detached() + (slopes - slopes.detached())
}

/// A flight at its start.
struct TakeOff<L> {
    tethers: [Tether<L>; 2],
    /// g̈, g⃛ and g⁗ there.
    bends: [[L; 3]; 2],
    /// The wave, seen from there.
    wave: Harmonic<L>,
    constant: [L; 2],
    /// Bounds on the force and its derivatives.
    force: [L; 3],
    spin: L,
}

impl<L: Lane> TakeOff<L> {
    #[inline(always)]
    fn new(mooring: &Mooring<L>, from: &Moment<L>) -> Self {
        let state = &from.state;
        let turn = &from.turn;
        let spin = state.vtheta;
        let wave = mooring.wave.shifted(from.t);
        let force = sum(mooring.constant, wave.cosine);
        let force_rate = scaled(wave.sine, wave.omega);
        let [ux, uy, turning] = from.before;
        let (speed, speed_before) = (length_bound([state.vx, state.vy]), length_bound([ux, uy]));
        let speeds = [
            speed_bound(speed, spin, mooring.reach[0]).larger(speed_bound(
                speed_before,
                turning,
                mooring.reach[0],
            )),
            speed_bound(speed, spin, mooring.reach[1]).larger(speed_bound(
                speed_before,
                turning,
                mooring.reach[1],
            )),
        ];
        let tethers = [
            Tether::new(
                &mooring.cables[0],
                mooring.reach[0],
                state,
                turn,
                from.gaps[0],
                speeds[0],
                mooring.force,
            ),
            Tether::new(
                &mooring.cables[1],
                mooring.reach[1],
                state,
                turn,
                from.gaps[1],
                speeds[1],
                mooring.force,
            ),
        ];
        let force_bend = scaled(wave.cosine, -(wave.omega * wave.omega));
        let forces = [force, force_rate, force_bend];
        let bends = [
            tethers[0].bends_at_start(forces, spin),
            tethers[1].bends_at_start(forces, spin),
        ];
        Self {
            tethers,
            bends,
            wave,
            constant: mooring.constant,
            force: mooring.force,
            spin,
        }
    }

    /// Which cable closes first, and about when, by their Taylor polynomials at the start: the root of the parabola, a step of
    /// Newton's from there to that of the cubic, and for the first of them one more to that of fourth order.
    #[inline(always)]
    fn guess(&self) -> (L::Mask, L) {
        let parabolas = [self.parabola(0), self.parabola(1)];
        let [(left, slope), (other_left, other_slope)] = [
            self.beyond(0, parabolas[0].0),
            self.beyond(1, parabolas[1].0),
        ];
        // One division serves both.
        let shared = L::ONE / (slope * other_slope);
        let slowness = [other_slope * shared, slope * shared];
        let guesses = [
            better(parabolas[0], left * slowness[0]),
            better(parabolas[1], other_left * slowness[1]),
        ];
        let second = guesses[1].below(guesses[0]);
        let s = guesses[0].smaller(guesses[1]);
        let slowness = L::select(second, slowness[1], slowness[0]);
        let value = self.fourth_order(second, s);
        (second, nearby(s, (-value).mul_add(slowness, s)))
    }

    /// The Taylor polynomial of a gap.
    #[inline(always)]
    fn fourth_order(&self, second: L::Mask, s: L) -> L {
        let [first, other] = &self.tethers;
        let gap = L::select(second, other.gap, first.gap);
        let rate = L::select(second, other.gap_rate, first.gap_rate);
        let [[a, b, c], [d, e, f]] = self.bends;
        let accel = L::select(second, d, a) * 0.5;
        let jerk = L::select(second, e, b) * (1.0 / 6.0);
        let fourth = L::select(second, f, c) * (1.0 / 24.0);
        let value = fourth.mul_add(s, jerk).mul_add(s, accel);
        value.mul_add(s, rate).mul_add(s, gap)
    }

    /// The first root of g + ġs + g̈s²/2, and whether there is one.
    #[inline(always)]
    fn parabola(&self, i: usize) -> (L, L::Mask) {
        let (tether, [accel, ..]) = (&self.tethers[i], self.bends[i]);
        let (gap, rate) = (tether.gap, tether.gap_rate);
        let discriminant = rate.mul_add(rate, accel * gap * -2.0);
        let root = discriminant.positive().sqrt();
        // Summands of one sign in either case.
        let rising = L::ZERO.below(rate);
        let above = L::select(rising, -gap * 2.0, root - rate);
        let below = L::select(rising, rate + root, accel);
        let s = above / below;
        (s, L::ZERO.at_most(discriminant) & L::ZERO.below(s))
    }

    /// Value and slope of the cubic at a root of the parabola.
    #[inline(always)]
    fn beyond(&self, i: usize, s: L) -> (L, L) {
        let [accel, jerk, _] = self.bends[i];
        let left = jerk * s * s * s * (1.0 / 6.0);
        (
            left,
            (jerk * 0.5)
                .mul_add(s, accel)
                .mul_add(s, self.tethers[i].gap_rate),
        )
    }

    /// Looks at the flight at `s`, and from there for where the gap of one cable closes.
    #[inline(always)]
    fn look(&self, s: L, second: L::Mask) -> Look<L> {
        let now = Instant::at(s, self.constant, self.spin).with(&self.wave, s);
        let jets = [self.tethers[0].jet(s, &now), self.tethers[1].jet(s, &now)];
        let struck = GapJet::select(second, &jets[1], &jets[0]);
        let (rest, left, below) = struck.root();
        let ahead = s + rest;
        let longest = s.larger(ahead);
        let fourths = [
            self.tethers[0].fourth(longest),
            self.tethers[1].fourth(longest),
        ];
        let square = rest * rest;
        let quartic = square * square * (1.0 / 24.0);
        let left = L::select(second, fourths[1], fourths[0]).mul_add(quartic, left.abs());
        // Both to be well below rounding: of the gap, and of the velocities.
        let lost = self.force[2] * self.wave.omega.abs() * quartic;
        let speed = self.force[0].mul_add(longest, self.tethers[0].speed);
        let near = (left * BELOW_ROUNDING).at_most(struck.noise)
            & (lost * BELOW_ROUNDING).at_most(speed * L::EPSILON);
        Look {
            s,
            now,
            jets,
            struck,
            rest,
            fourths,
            rising: L::ZERO.below(struck.rate) & L::ZERO.below(below) & L::ZERO.below(ahead),
            near,
        }
    }

    /// When the gap of a cable closes: looks on from a guess, until what the cubic at the last look leaves out is below
    /// rounding. One look is usual.
    #[inline(always)]
    fn meet(&self, second: L::Mask, guess: L, horizon: L) -> (Look<L>, L::Mask) {
        let mut active = guess.below(horizon);
        let mut s = guess.detached();
        let mut looks = 1;
        loop {
            let look = self.look(s, second);
            active = active & look.rising;
            let again = active & !look.near;
            if looks == MOST_LOOKS || !again.any() {
                let found = active & look.near;
                return (look, found);
            }
            // A lane that is near looks again where it did, and sees the same.
            s = L::select(again, (s + look.rest).detached(), s);
            looks += 1;
        }
    }

    /// The end of the flight, a little after a look.
    #[inline(always)]
    fn arrival(&self, second: L::Mask, look: &Look<L>, from: &Moment<L>) -> Arrival<L> {
        let arrival = self.after(look, look.rest.detached(), from);
        if !L::CARRIES_SLOPES {
            return arrival;
        }
        // Where the search looked is no part of the motion: the crossing moves by −∂g/ġ, as seen from the crossing, as the
        // slopes of what is moved there by its cubic have an order less.
        let there = self.look(arrival.s.detached(), second);
        let value = there.struck.value;
        let moved = (value.detached() - value) / there.struck.rate;
        arrival.with_slopes_of(&self.after(&there, moved, from))
    }

    #[inline(always)]
    fn after(&self, look: &Look<L>, rest: L, from: &Moment<L>) -> Arrival<L> {
        let s = look.s + rest;
        let [jet, other] = &look.jets;
        let now = look.now.later(rest, self.force_bend(&look.now));
        Arrival {
            s,
            state: now.state(&from.state, s),
            jets: [
                jet.later(rest, look.fourths[0]),
                other.later(rest, look.fourths[1]),
            ],
        }
    }

    /// f̈ = −Ω² (f − f₀), where f₀ is constant.
    #[inline(always)]
    fn force_bend(&self, now: &Instant<L>) -> [L; 2] {
        let square = -(self.wave.omega * self.wave.omega);
        scaled(difference(now.push.force, self.constant), square)
    }

    /// Whether a gap is proven to stay open within a flight of length `s`, at whose end it is `end`.
    ///
    /// Early, g(σ) ≤ g₀ + ġ₀σ + g̈₀σ²/2 + g⃛₀σ³/6 + Kσ⁴/24 with |g⁗| ≤ K = 2 (3 |P̈|² + 4 |Ṗ||P⃛| + |d||P⁗|);
    /// late, told backwards from the end, g ≤ g₁ − ġ₁σ + g̈₁σ²/2 + Kσ³/6 with
    /// |g⃛| ≤ K = 2 (3 |Ṗ||P̈| + |d||P⃛|). In either case g ≤ g₀ + σB, where B is the sum of what multiplies σ
    /// with each term after the first at its largest, so it is enough that g₀ ≤ 0 and that g₀ + σB is below
    /// zero at the end of the stretch. A cable that closed at the end, or that was closed at the start, is
    /// known to have g = 0 there.
    ///
    /// |d| ≤ r at both ends, so in between it is at most r + |Ṗ|s/2. The jet at the end is that of a look nearby, moved by
    /// its cubic over `rest`: ġ₁ may be off by K rest³/6 and g̈₁ by K rest²/2, with the K of g⁗.
    #[inline(always)]
    fn stays_open(&self, i: usize, s: L, look: &Look<L>, end: &GapJet<L>, end_value: L) -> L::Mask {
        let (tether, [accel, jerk, _]) = (&self.tethers[i], self.bends[i]);
        let (early, late) = (s * EARLY, s * (1.0 - EARLY));
        let (third, fourth) = (tether.third(s) * INFLATION, look.fourths[i] * INFLATION);
        let astray = fourth * look.rest * look.rest;

        let half = L::from_f64(0.5);
        let bound = fourth.mul_add(early * 0.25, jerk).positive() * early * (1.0 / 6.0);
        let bound = accel
            .positive()
            .mul_add(half, bound)
            .mul_add(early * INFLATION, tether.gap_rate);
        let early_open = bound.mul_add(early, tether.gap).below(-tether.gap_error);

        let bound = (end.accel + astray)
            .positive()
            .mul_add(half, third * late * (1.0 / 6.0));
        let slowest = astray.mul_add(-look.rest.abs(), end.rate);
        let bound = bound.mul_add(late * INFLATION, -slowest);
        let late_open = bound.mul_add(late, end_value).below(-end.noise);
        // The struck cable's own value at the end is zero, not its noise.
        let late_open = late_open | (L::ZERO.at_most(end_value) & bound.below(L::ZERO));
        early_open & late_open
    }
}

/// A guess less a step, where it is one.
#[inline(always)]
fn better<L: Lane>((s, crosses): (L, L::Mask), step: L) -> L {
    L::select(crosses, nearby(s, s - step), L::from_f64(NEVER))
}

/// A better guess, if it is one.
#[inline(always)]
fn nearby<L: Lane>(s: L, better: L) -> L {
    let sound = (s * 0.5).below(better) & better.below(s * 2.0);
    L::select(sound, better, s)
}

/// Bound on the speed of an attachment: |v| + |θ̇| |ρ|.
#[inline(always)]
fn speed_bound<L: Lane>(speed: L, spin: L, reach: L) -> L {
    spin.abs().mul_add(reach, speed)
}

/// The larger of `record` and the highest y of a flight of length `s` that begins at `from`.
#[inline(always)]
pub(crate) fn highest_point<T: Real>(mooring: &Mooring<T>, from: &Moment<T>, s: T, record: T) -> T {
    let wave = mooring.wave.shifted(from.t);
    let height = |s: T| {
        let push = Push::constant(mooring.constant, s).with_harmonic(&wave, s);
        let y = from.state.y + (from.state.vy * s + push.drift[1]);
        (y, from.state.vy + push.gain[1])
    };
    highest(&height, s, mooring.upward, mooring.steepest, record)
}

/// The bounce that begins at `from`.
#[inline(always)]
pub(crate) fn bounce<L: Lane>(mooring: &Mooring<L>, from: &Moment<L>) -> Bounce<L> {
    let start = TakeOff::new(mooring, from);
    let (second, guess) = start.guess();
    let horizon = mooring.t_end - from.t;
    let (look, found) = start.meet(second, guess, horizon);

    let Arrival { s, state, jets } = start.arrival(second, &look, from);
    let blurs = [start.tethers[0].blur(s), start.tethers[1].blur(s)];
    let alone = closes_alone(from.t, s, second, &jets, blurs);
    let end_value = [
        L::select(second, jets[0].value, L::ZERO),
        L::select(second, L::ZERO, jets[1].value),
    ];
    let open = start.stays_open(0, s, &look, &jets[0], end_value[0])
        & start.stays_open(1, s, &look, &jets[1], end_value[1]);
    let arrived = found & s.below(horizon) & alone & open & stops_nowhere(mooring, from, s, &state);
    let topped = !rises_above(mooring, from, s, &state);
    land(mooring, from, (s, second), &state, &jets, (arrived, topped))
}

/// Whether the struck cable is closing at s, to rounding, and the other one does not close at the same
/// instant: no sooner than the errors of both times, and of t + s, allow (see [`crate::event`]).
#[inline(always)]
fn closes_alone<L: Lane>(
    t: L,
    s: L,
    second: L::Mask,
    jets: &[GapJet<L>; 2],
    blurs: [L; 2],
) -> L::Mask {
    let struck = GapJet::select(second, &jets[1], &jets[0]);
    let other = GapJet::select(second, &jets[0], &jets[1]);
    let struck_blur = L::select(second, blurs[1], blurs[0]);
    let other_blur = L::select(second, blurs[0], blurs[1]);
    // The times' errors, both sides times the rate.
    let spread =
        ((t.abs() + s) * L::EPSILON * 4.0).mul_add(struck.rate, struck.noise + struck_blur);
    let margin = other
        .rate
        .positive()
        .mul_add(spread, (other.noise + other_blur) * struck.rate);
    L::ZERO.below(struck.rate) & (other.value * struck.rate).below(-(margin * 2.0))
}

/// Whether no stop is near: the rotation is largest at an end, as it is linear in time, and the height exceeds
/// its ends by at most |ÿ|s²/8.
#[inline(always)]
fn stops_nowhere<L: Lane>(
    mooring: &Mooring<L>,
    from: &Moment<L>,
    s: L,
    state: &State<L>,
) -> L::Mask {
    let bulge = s * s * 0.125;
    let height = mooring
        .steepest
        .mul_add(bulge, from.state.y.larger(state.y));
    state.theta.abs().below(mooring.rotation_limit - NEAR_STOP)
        & height.below(mooring.level - NEAR_STOP)
}

/// Whether y may have a maximum within the flight that is higher than any before.
#[inline(always)]
fn rises_above<L: Lane>(mooring: &Mooring<L>, from: &Moment<L>, s: L, state: &State<L>) -> L::Mask {
    let bulge = s * s * 0.125;
    let height = mooring
        .steepest
        .mul_add(bulge, from.state.y.larger(state.y));
    let change = mooring.upward.positive() * s;
    let falls = (from.state.vy + change).at_most(L::ZERO);
    let climbs = L::ZERO.at_most(state.vy - change);
    from.y_max.below(height) & !falls & !climbs
}

/// The impact at the end of a flight, docs/model.md section 5: p = (1 + e) v_n/w.
///
/// Before it the body is put back onto the cable, from which it is a rounding away: by a translation, as
/// the metric does not matter for so little, so that its rotation is known already.
#[inline(always)]
fn land<L: Lane>(
    mooring: &Mooring<L>,
    from: &Moment<L>,
    (s, second): (L, L::Mask),
    state: &State<L>,
    jets: &[GapJet<L>; 2],
    (arrived, topped): (L::Mask, L::Mask),
) -> Bounce<L> {
    let turn = Turn::by(state.theta);
    let struck = Cable::select(second, &mooring.cables[1], &mooring.cables[0]);
    let reach = L::select(second, mooring.reach[1], mooring.reach[0]);
    let moved = struck.moved(state, &turn);
    let lever = struck.lever(turn.sine, turn.cosine);
    let normal = struck.normal_along(struck.span_moved(moved), lever);
    let off = struck.gap_moved(moved) * struck.per_length() * -0.5;
    let before = State {
        x: off.mul_add(normal.n[0], state.x),
        y: off.mul_add(normal.n[1], state.y),
        ..*state
    };
    let e = mooring.restitution;
    let v_n = normal.velocity(&before);
    let w = normal.coupling(&normal, mooring.inverse_inertia);
    let impulse = e.mul_add(v_n, v_n) / w;
    let mut after = before;
    normal.kick(&mut after, impulse, mooring.inverse_inertia);

    let first = speed_bound(length_bound([before.vx, before.vy]), before.vtheta, reach);
    let last = speed_bound(length_bound([after.vx, after.vy]), after.vtheta, reach);
    let rounding = first.larger(last) * L::EPSILON;
    let rebounds =
        mooring.v_stick.at_most(v_n) & L::ZERO.below(v_n) & (rounding * UNMOVED).below(e * v_n);
    let t = from.t + s;
    let other = other_gap(mooring, second, state, &turn, jets);
    let closed = [L::ZERO; 2];
    Bounce {
        arrived,
        topped,
        plain: arrived & topped & rebounds & from.t.below(t),
        second,
        s,
        before,
        v_n,
        impulse,
        next: Moment {
            t,
            state: after,
            turn,
            before: [before.vx, before.vy, before.vtheta],
            gaps: [
                select2(second, other, closed),
                select2(second, closed, other),
            ],
            y_max: from.y_max.larger(state.y),
            theta_max: from.theta_max.larger(state.theta.abs()),
        },
    }
}

/// Value and error of the gap that did not close: carried forward, or evaluated afresh where that is better
/// known.
#[inline(always)]
fn other_gap<L: Lane>(
    mooring: &Mooring<L>,
    second: L::Mask,
    state: &State<L>,
    turn: &Turn<L>,
    jets: &[GapJet<L>; 2],
) -> [L; 2] {
    let cable = Cable::select(second, &mooring.cables[0], &mooring.cables[1]);
    let reach = L::select(second, mooring.reach[0], mooring.reach[1]);
    let moved = cable.moved(state, turn);
    let error = cable.gap_error(moved, state.theta, reach);
    let carried = GapJet::select(second, &jets[0], &jets[1]);
    let better = carried.noise.below(error);
    [
        L::select(better, carried.value, cable.gap_moved(moved)),
        L::select(better, carried.noise, error),
    ]
}
