//! From one impact to the next: a slack flight of a body on two cables under one sinusoid, and one
//! cable snapping taut at its end. Nearly every step of nearly every run is such a bounce.
//!
//! Written over [`Lane`], so that the same code computes the ordinary motion and that of several
//! cases side by side. A bounce is found by a guess and proved afterwards:
//!
//! 1. *Guess*, from the Taylor polynomials of both gaps at the start, which cable closes first, and
//!    when.
//! 2. *Search*: evaluate both gaps there, to the third derivative. The root of the cubic is the
//!    crossing if the error of the cubic is below rounding; otherwise evaluate again at its root.
//! 3. *Exclude* an earlier crossing: with value, rate and second derivative known at *both* ends of
//!    the flight, and bounds on the higher derivatives, each gap is shown to stay open in between,
//!    the early part from the start and the late part from the end. The rotation and the height of
//!    the body are bounded likewise.
//! 4. *Law*: one cable, closed by itself and closing; p = (1 + e) v_n/w.
//!
//! Whatever does not fit (a bound that is too weak, cables that close together, a cable that may
//! stick, a stop, a graze) is left to the general loop in [`crate::motion::simulation`]. Whether a
//! step is a bounce depends on the motion alone and never on its lane, so the bits of a run do not
//! depend on lanes.

use crate::arithmetic::lane::{Lane, select_each};
use crate::arithmetic::plane::{Rotation, Vector2};
use crate::arithmetic::processor::{Kernel, apart, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::cable::{Cable, Normal};
use crate::model::contact_law::Snap;
use crate::model::forcing::{Harmonic, Push};
use crate::model::state::State;
use crate::motion::attachment::GapJet;
use crate::motion::extremes::highest;
use crate::motion::two_cable_flight::{FlightEnd, Openness, TwoCableFlight, speed_bound};
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

/// Closer than this to a limit a bounce is left to the general search \[L\], \[rad\].
const NEAR_STOP: f64 = 1e-9;
/// A normal velocity below this many roundings of the attachment's speed counts as zero: that of a
/// taut cable which an impulse neither loads nor unloads.
pub(crate) const UNMOVED: f64 = 64.0;

/// The result of a bounce, in the lanes in which it is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce<L: Lane> {
    /// Whether the flight ends as computed here.
    pub(crate) arrived: L::Mask,
    /// Whether the highest point of the flight is known, as well.
    pub(crate) top_known: L::Mask,
    /// Whether, in addition, the law of one cable is all that applies.
    pub(crate) plain: L::Mask,
    /// Whether the second cable snaps, instead of the first.
    pub(crate) second: L::Mask,
    /// The duration of the flight.
    pub(crate) s: L,
    pub(crate) before: State<L>,
    pub(crate) v_n: L,
    pub(crate) impulse: L,
    /// Normal velocity after it.
    pub(crate) v_after: L,
    /// The motion after the impact, with the extremes of the flight.
    pub(crate) next: AfterImpact<L>,
    pub(crate) facts: FlightFacts<L>,
}

/// Facts about a bounce for code that follows a run, besides its result.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightFacts<L> {
    /// The force at the start of the flight and at its end.
    pub(crate) forces: [Vector2<L>; 2],
    /// A slope B of the gap that does not close: in the early part of the flight g ≤ g₀ + σ B.
    pub(crate) slope: L,
    /// A bound on the same gap in the late part.
    pub(crate) late: L,
    /// The same slope of the gap that closes, and how deep it is before its last rise
    /// ([`Openness`]).
    pub(crate) struck_slope: L,
    pub(crate) bend: L,
    pub(crate) depth: L,
    /// The normal of the cable that closes, at the end.
    pub(crate) normal: Normal<L>,
    /// n·ρ of that cable.
    pub(crate) swing: L,
    /// The normal of the other cable.
    pub(crate) other: Normal<L>,
}

/// Height and its rate a time into a flight, by the best instructions for it.
struct HeightAt<'a, T: Real> {
    from: &'a State<T>,
    constant: Vector2<T>,
    wave: &'a Harmonic<T>,
    s: T,
}

impl<T: Real> Kernel for HeightAt<'_, T> {
    type Output = (T, T);
    #[inline(always)]
    fn run(self) -> (T, T) {
        let (from, s) = (self.from, self.s);
        let push = Push::constant(self.constant, s).with_harmonic(self.wave, s);
        let y = from.y + (from.vy * s + push.drift.y);
        (y, from.vy + push.gain.y)
    }
}

/// The larger of `record` and the highest y of a flight of length `s` that begins at `from`.
#[inline(always)]
pub(crate) fn highest_point<T: Real>(
    two_cables: &TwoCableSystem<T>,
    from: &AfterImpact<T>,
    s: T,
    record: T,
) -> T {
    let wave = two_cables.wave.shifted(from.t);
    let height = |s: T| {
        dispatch_over::<T, _>(HeightAt {
            from: &from.state,
            constant: two_cables.constant,
            wave: &wave,
            s,
        })
    };
    highest(
        &height,
        s,
        two_cables.upward_acceleration_bound,
        two_cables.vertical_acceleration_bound,
        record,
    )
}

/// The bounce that begins at `from`.
#[inline(always)]
pub(crate) fn bounce<L: Lane>(two_cables: &TwoCableSystem<L>, from: &AfterImpact<L>) -> Bounce<L> {
    apart!(L, {
        let start = TwoCableFlight::new(two_cables, from);
        let (second, guess) = start.guess();
        let horizon = two_cables.t_end - from.t;
        let (trial, found) = start.search(second, guess, horizon);

        let end = start.arrival(second, &trial, from);
        let FlightEnd { s, state, jets, .. } = &end;
        let start_noises = [
            start.attachments[0].start_noise(*s),
            start.attachments[1].start_noise(*s),
        ];
        let alone = closes_alone(from.t, *s, second, jets, start_noises);
        let end_value = [
            L::select(second, jets[0].value, L::ZERO),
            L::select(second, L::ZERO, jets[1].value),
        ];
        let openness = [
            start.stays_open(0, *s, &trial, &jets[0], end_value[0]),
            start.stays_open(1, *s, &trial, &jets[1], end_value[1]),
        ];
        let open = openness[0].open & openness[1].open;
        let arrived =
            found & s.below(horizon) & alone & open & reaches_no_limit(two_cables, from, *s, state);
        let top_known = !rises_above(two_cables, from, *s, state);
        let forces = [start.force_at_start, end.force];
        let known = [arrived, top_known];
        impact_after_flight(two_cables, from, second, &end, known, (forces, openness))
    })
}

/// Whether the struck cable is closing, and the other one does not close at the same instant, given
/// the errors of both times and of t + s (see [`crate::motion::events`]).
#[inline(always)]
fn closes_alone<L: Lane>(
    t: L,
    s: L,
    second: L::Mask,
    jets: &[GapJet<L>; 2],
    start_noises: [L; 2],
) -> L::Mask {
    let struck = GapJet::select(second, &jets[1], &jets[0]);
    let other = GapJet::select(second, &jets[0], &jets[1]);
    let struck_noise = L::select(second, start_noises[1], start_noises[0]);
    let other_noise = L::select(second, start_noises[0], start_noises[1]);
    // The errors of the times; both sides are multiplied by the rate.
    let spread =
        ((t.abs() + s) * L::EPSILON * 4.0).mul_add(struck.rate, struck.noise + struck_noise);
    let margin = other
        .rate
        .positive()
        .mul_add(spread, (other.noise + other_noise) * struck.rate);
    L::ZERO.below(struck.rate) & (other.value * struck.rate).below(-(margin * 2.0))
}

/// Bound on y along a flight: it exceeds the values at the ends by at most |ÿ|s²/8.
#[inline(always)]
fn height_bound<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    from: &AfterImpact<L>,
    s: L,
    state: &State<L>,
) -> L {
    let ends = from.state.y.larger(state.y);
    two_cables
        .vertical_acceleration_bound
        .mul_add(s * s * 0.125, ends)
}

/// Whether no limit is near: the rotation is largest at an end, as it is linear in time, and the
/// height exceeds its values at the ends by at most |ÿ|s²/8.
#[inline(always)]
fn reaches_no_limit<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    from: &AfterImpact<L>,
    s: L,
    state: &State<L>,
) -> L::Mask {
    let height = height_bound(two_cables, from, s, state);
    state
        .theta
        .abs()
        .below(two_cables.rotation_limit - NEAR_STOP)
        & height.below(two_cables.level - NEAR_STOP)
}

/// Whether y may have a maximum within the flight that exceeds all before.
#[inline(always)]
fn rises_above<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    from: &AfterImpact<L>,
    s: L,
    state: &State<L>,
) -> L::Mask {
    let height = height_bound(two_cables, from, s, state);
    let change = two_cables.upward_acceleration_bound.positive() * s;
    let falls = (from.state.vy + change).at_most(L::ZERO);
    let climbs = L::ZERO.at_most(state.vy - change);
    from.y_max.below(height) & !falls & !climbs
}

/// Projects the body onto the cable that has closed, from which it is off by a rounding: by a
/// translation, so that its rotation stays known; for so little the metric does not matter. Returns
/// the cable's normal and the state.
#[inline(always)]
fn project<L: Lane>(
    struck: &Cable<L>,
    state: &State<L>,
    rotation: &Rotation<L>,
) -> (Normal<L>, State<L>) {
    let moved = struck.moved(state, rotation);
    let lever = struck.lever(rotation.sine, rotation.cosine);
    let normal = struck.normal_along(struck.span_moved(moved), lever);
    let off = struck.gap_moved(moved) * struck.per_length() * -0.5;
    let before = State {
        x: off.mul_add(normal.n.x, state.x),
        y: off.mul_add(normal.n.y, state.y),
        ..*state
    };
    (normal, before)
}

/// The impact at the end of a flight, docs/model.md section 5: p = (1 + e) v_n/w.
#[inline(always)]
fn impact_after_flight<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    from: &AfterImpact<L>,
    second: L::Mask,
    end: &FlightEnd<L>,
    [arrived, top_known]: [L::Mask; 2],
    (forces, openness): ([Vector2<L>; 2], [Openness<L>; 2]),
) -> Bounce<L> {
    apart!(L, {
        let FlightEnd { s, state, jets, .. } = end;
        let rotation = Rotation::by(state.theta);
        let struck = Cable::select(second, &two_cables.cables[1], &two_cables.cables[0]);
        let reach = L::select(second, two_cables.reach[1], two_cables.reach[0]);
        let (normal, before) = project(&struck, state, &rotation);
        let v_n = normal.velocity(&before);
        let w = normal.coupling(&normal, two_cables.inverse_inertia);
        let Snap { impulse, v_after } = two_cables.contact.snap(v_n, w);
        let mut after = before;
        normal.apply_impulse(&mut after, impulse, two_cables.inverse_inertia);
        let first = speed_bound(before.velocity().length_bound(), before.vtheta, reach);
        let last = speed_bound(after.velocity().length_bound(), after.vtheta, reach);
        let rounding = first.larger(last) * L::EPSILON;
        let closes = two_cables.v_stick.at_most(v_n) & L::ZERO.below(v_n);
        let rebounds = closes & (rounding * UNMOVED).below(-v_after);
        let (other, other_normal) = other_cable(two_cables, second, state, &rotation, jets);
        let closed = [L::ZERO; 2];
        let [first_open, second_open] = openness;
        let lever = struck.lever(rotation.sine, rotation.cosine);
        Bounce {
            arrived,
            top_known,
            plain: arrived & top_known & rebounds & from.t.below(from.t + *s),
            second,
            s: *s,
            before,
            v_n,
            impulse,
            v_after,
            next: AfterImpact {
                t: from.t + *s,
                state: after,
                rotation,
                before: [before.vx, before.vy, before.vtheta],
                gaps: [
                    select_each(second, other, closed),
                    select_each(second, closed, other),
                ],
                y_max: from.y_max.larger(state.y),
                theta_max: from.theta_max.larger(state.theta.abs()),
            },
            facts: FlightFacts {
                forces,
                slope: L::select(second, first_open.slope, second_open.slope),
                late: L::select(second, first_open.late, second_open.late),
                struck_slope: L::select(second, second_open.slope, first_open.slope),
                bend: L::select(second, second_open.bend, first_open.bend),
                depth: L::select(second, second_open.depth, first_open.depth),
                normal,
                swing: lever.dot(normal.n),
                other: other_normal,
            },
        }
    })
}

/// Value and error of the gap that did not close, carried forward, or evaluated from the state
/// where that is more precise; and that cable's normal.
#[inline(always)]
fn other_cable<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    second: L::Mask,
    state: &State<L>,
    rotation: &Rotation<L>,
    jets: &[GapJet<L>; 2],
) -> ([L; 2], Normal<L>) {
    let cable = Cable::select(second, &two_cables.cables[0], &two_cables.cables[1]);
    let reach = L::select(second, two_cables.reach[0], two_cables.reach[1]);
    let moved = cable.moved(state, rotation);
    let error = cable.gap_error(moved, state.theta, reach);
    let carried = GapJet::select(second, &jets[0], &jets[1]);
    let better = carried.noise.below(error);
    let gap = [
        L::select(better, carried.value, cable.gap_moved(moved)),
        L::select(better, carried.noise, error),
    ];
    let lever = cable.lever(rotation.sine, rotation.cosine);
    (gap, cable.normal_along(cable.span_moved(moved), lever))
}
