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
use crate::lane::{Lane, Mask, Turn, length, scaled, select2, sum};
use crate::mooring::{Moment, Mooring, NEVER};
use crate::real::Real;
use crate::tether::{GapJet, INFLATION, Instant, Tether};
use crate::{Cable, Harmonic, State};

/// A stop closer than this is left to the general search \[L\], \[rad\].
const NEAR_STOP: f64 = 1e-9;
/// The most evaluations of one search; three are usual.
const MOST_LOOKS: usize = 10;
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

/// A flight at its start.
struct TakeOff<L> {
    tethers: [Tether<L>; 2],
    /// g̈ and g⃛ there.
    bends: [[L; 2]; 2],
    /// The wave, seen from there.
    wave: Harmonic<L>,
    constant: [L; 2],
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
        let (speed, speed_before) = (length([state.vx, state.vy]), length([ux, uy]));
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
        let bends = [
            tethers[0].bend_at_start(force, force_rate, spin),
            tethers[1].bend_at_start(force, force_rate, spin),
        ];
        Self {
            tethers,
            bends,
            wave,
            constant: mooring.constant,
            spin,
        }
    }

    #[inline(always)]
    fn instant(&self, s: L) -> Instant<L> {
        Instant::at(s, self.constant, self.spin).with(&self.wave, s)
    }

    /// When the Taylor polynomial of a gap closes, about: the root of the parabola, and one step of Halley's
    /// towards that of the cubic.
    #[inline(always)]
    fn guess(&self, i: usize) -> L {
        let (tether, [accel, jerk]) = (&self.tethers[i], self.bends[i]);
        let (gap, rate) = (tether.gap, tether.gap_rate);
        let discriminant = rate * rate - accel * gap * 2.0;
        let root = discriminant.positive().sqrt();
        // Summands of one sign in either case.
        let rising = L::ZERO.below(rate);
        let above = L::select(rising, -gap * 2.0, root - rate);
        let below = L::select(rising, rate + root, accel);
        let s = above / below;
        let left = jerk * s * s * s * (1.0 / 6.0);
        let slope = rate + (accel + jerk * s * 0.5) * s;
        let bend = accel + jerk * s;
        let better = s - left * slope * 2.0 / (slope * slope * 2.0 - left * bend);
        let sound = (s * 0.5).below(better) & better.below(s * 2.0);
        let crosses = L::ZERO.at_most(discriminant) & L::ZERO.below(s);
        let s = L::select(sound, better, s);
        L::select(crosses, s, L::from_f64(NEVER))
    }

    /// When the gap of a tether closes, by Halley's iteration from a guess, and where that was found.
    ///
    /// The last step is short enough for its quadratic to be exact to rounding. Where the search looked is no part
    /// of the motion: over dual numbers the crossing moves by −∂g/ġ, whose digits that quadratic has not all.
    #[inline(always)]
    fn meet(&self, tether: &Tether<L>, guess: L, horizon: L) -> (L, L::Mask) {
        let [a, j, _] = tether.bounds;
        // 6 times what |g⃛|σ³/6 is to stay below goes with the noise.
        let third = (tether.speed * a * 3.0 + tether.length * j) * 2.0;
        let mut active = guess.below(horizon);
        let mut found = !(active | !active);
        let mut s = guess.detached();
        let mut meeting = s;
        for _ in 0..MOST_LOOKS {
            let jet = tether.jet(s, &self.instant(s));
            let discriminant = jet.rate * jet.rate - jet.accel * jet.value * 2.0;
            let step = -jet.value * 2.0 / (jet.rate + discriminant.positive().sqrt());
            let next = s + step;
            let size = step.abs();
            let rising =
                L::ZERO.below(jet.rate) & L::ZERO.at_most(discriminant) & L::ZERO.below(next);
            active = active & rising;
            let close = active & (third * size * size * size).at_most(jet.noise * 6.0);
            meeting = L::select(close, next, meeting);
            found = found | close;
            active = active & !close;
            if !active.any() {
                break;
            }
            s = L::select(active, next.detached(), s);
        }
        if L::CARRIES_SLOPES {
            let s = meeting.detached();
            let jet = tether.jet(s, &self.instant(s));
            meeting = s - (jet.value - jet.value.detached()) / jet.rate;
        }
        (meeting, found)
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
    /// |d| ≤ r at both ends, so in between it is at most r + |Ṗ|s/2.
    #[inline(always)]
    fn stays_open(&self, i: usize, s: L, end: &GapJet<L>, end_value: L) -> L::Mask {
        let (tether, [accel, jerk]) = (&self.tethers[i], self.bends[i]);
        let [a, j, k] = tether.bounds;
        let (early, late) = (s * EARLY, s * (1.0 - EARLY));
        let speed = tether.speed + a * s;
        let span = tether.length + speed * s * 0.5;
        let fourth = (a * a * 3.0 + speed * j * 4.0 + span * k) * (2.0 * INFLATION);
        let third = (speed * a * 3.0 + span * j) * (2.0 * INFLATION);

        let bound = (jerk + fourth * early * 0.25).positive() * early * (1.0 / 6.0);
        let bound = (accel.positive() * 0.5 + bound) * early * INFLATION + tether.gap_rate;
        let early_open = (tether.gap + bound * early).below(-tether.gap_error);

        let bound = end.accel.positive() * 0.5 + third * late * (1.0 / 6.0);
        let bound = bound * late * INFLATION - end.rate;
        let late_open = (end_value + bound * late).below(-end.noise);
        // The struck cable's own value at the end is zero, not its noise.
        let late_open = late_open | (L::ZERO.at_most(end_value) & bound.below(L::ZERO));
        early_open & late_open
    }
}

/// Bound on the speed of an attachment: |v| + |θ̇| |ρ|.
#[inline(always)]
fn speed_bound<L: Lane>(speed: L, spin: L, reach: L) -> L {
    speed + spin.abs() * reach
}

/// The larger of `record` and the highest y of a flight of length `s` that begins at `from`.
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
    let guesses = [start.guess(0), start.guess(1)];
    let second = guesses[1].below(guesses[0]);
    let [first_tether, second_tether] = &start.tethers;
    let tether = Tether::select(second, second_tether, first_tether);
    let horizon = mooring.t_end - from.t;
    let (s, found) = start.meet(&tether, guesses[0].smaller(guesses[1]), horizon);

    let now = start.instant(s);
    let jets = [first_tether.jet(s, &now), second_tether.jet(s, &now)];
    let blurs = [first_tether.blur(s), second_tether.blur(s)];
    let alone = closes_alone(from.t, s, second, &jets, blurs);
    let end_value = [
        L::select(second, jets[0].value, L::ZERO),
        L::select(second, L::ZERO, jets[1].value),
    ];
    let open = start.stays_open(0, s, &jets[0], end_value[0])
        & start.stays_open(1, s, &jets[1], end_value[1]);
    let state = now.state(&from.state, s);
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
    let closes = L::ZERO.below(struck.rate) & struck.value.abs().at_most(struck.noise * 2.0);
    let spread = (struck.noise + struck_blur) / struck.rate + (t.abs() + s) * L::EPSILON * 4.0;
    let margin = other.noise + other_blur + other.rate.positive() * spread;
    closes & other.value.below(-(margin * 2.0))
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
    let height = from.state.y.larger(state.y) + mooring.steepest * s * s * 0.125;
    state.theta.abs().below(mooring.rotation_limit - NEAR_STOP)
        & height.below(mooring.level - NEAR_STOP)
}

/// Whether y may have a maximum within the flight that is higher than any before.
#[inline(always)]
fn rises_above<L: Lane>(mooring: &Mooring<L>, from: &Moment<L>, s: L, state: &State<L>) -> L::Mask {
    let height = from.state.y.larger(state.y) + mooring.steepest * s * s * 0.125;
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
    let off = struck.gap_moved(moved) / (struck.length() * 2.0);
    let before = State {
        x: state.x - off * normal.n[0],
        y: state.y - off * normal.n[1],
        ..*state
    };
    let e = mooring.restitution;
    let v_n = normal.velocity(&before);
    let w = normal.coupling(&normal, mooring.inverse_inertia);
    let impulse = (v_n + e * v_n) / w;
    let mut after = before;
    normal.kick(&mut after, impulse, mooring.inverse_inertia);

    let first = speed_bound(length([before.vx, before.vy]), before.vtheta, reach);
    let last = speed_bound(length([after.vx, after.vy]), after.vtheta, reach);
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
