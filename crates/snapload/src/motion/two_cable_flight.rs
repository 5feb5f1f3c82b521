//! A flight from its start: when a cable closes, the state there, and the proof that none closed before.

use crate::arithmetic::lane::{Lane, Mask, difference, length_bound, scaled, sum};
use crate::model::forcing::Harmonic;
use crate::model::state::State;
use crate::motion::attachment::{Attachment, GapJet, INFLATION, Instant, flown};
use crate::motion::two_cables::{AfterImpact, NEVER, TwoCableSystem};

/// The most looks of one search; one is usual.
const MOST_LOOKS: usize = 10;
/// What a look leaves out is so many times smaller than what rounding may come to.
const BELOW_ROUNDING: f64 = 16.0;
/// The part of a flight in which its start has to prove a gap open; there a higher derivative is known.
const EARLY: f64 = 0.6;

/// A flight seen at one instant near its end.
pub(crate) struct Look<L: Lane> {
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

/// Where the parabola of a gap crosses zero.
struct Parabola<L: Lane> {
    s: L,
    slope: L,
    crosses: L::Mask,
}

/// The end of a flight.
pub(crate) struct FlightEnd<L> {
    pub(crate) s: L,
    pub(crate) state: State<L>,
    pub(crate) jets: [GapJet<L>; 2],
}

impl<L: Lane> FlightEnd<L> {
    /// The same numbers with the derivatives of others.
    #[inline(always)]
    fn with_slopes_of(self, other: &Self) -> Self {
        let [jet, second_jet] = self.jets;
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
                    value: with_slopes(second_jet.value, other.jets[1].value),
                    ..second_jet
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
pub(crate) struct TwoCableFlight<L> {
    pub(crate) attachments: [Attachment<L>; 2],
    /// g̈, g⃛ and g⁗ there.
    bends: [[L; 3]; 2],
    /// The wave, seen from there.
    wave: Harmonic<L>,
    constant: [L; 2],
    /// Bounds on the force and its derivatives.
    force: [L; 3],
    spin: L,
}

impl<L: Lane> TwoCableFlight<L> {
    #[inline(always)]
    pub(crate) fn new(two_cables: &TwoCableSystem<L>, from: &AfterImpact<L>) -> Self {
        let spin = from.state.vtheta;
        let wave = two_cables.wave.shifted(from.t);
        let force = sum(two_cables.constant, wave.cosine);
        let force_rate = scaled(wave.sine, wave.omega);
        let attachments = [
            attachment(two_cables, from, 0),
            attachment(two_cables, from, 1),
        ];
        let force_bend = scaled(wave.cosine, -(wave.omega * wave.omega));
        let forces = [force, force_rate, force_bend];
        let bends = [
            attachments[0].bends_at_start(forces, spin),
            attachments[1].bends_at_start(forces, spin),
        ];
        Self {
            attachments,
            bends,
            wave,
            constant: two_cables.constant,
            force: two_cables.force,
            spin,
        }
    }

    /// Which cable closes first, and about when, by their Taylor polynomials at the start: the root of the parabola, a step of
    /// Newton's from there to that of the cubic, and for the first of them one more to that of fourth order.
    #[inline(always)]
    pub(crate) fn guess(&self) -> (L::Mask, L) {
        let (first, other) = (self.parabola(0), self.parabola(1));
        // One division serves both.
        let shared = L::ONE / (first.slope * other.slope);
        let (guess, per_slope) = self.beyond(0, &first, other.slope * shared);
        let (other_guess, other_per_slope) = self.beyond(1, &other, first.slope * shared);
        let second = other_guess.below(guess);
        let s = guess.smaller(other_guess);
        let (value, slope) = self.fourth_order(second, s);
        let per_slope = reciprocal(L::select(second, other_per_slope, per_slope), slope);
        (second, within_twice(s, (-value).mul_add(per_slope, s)))
    }

    /// The Taylor polynomial of a gap, and its slope.
    #[inline(always)]
    fn fourth_order(&self, second: L::Mask, s: L) -> (L, L) {
        let [first, other] = &self.attachments;
        let gap = L::select(second, other.gap, first.gap);
        let rate = L::select(second, other.gap_rate, first.gap_rate);
        let [[a, b, c], [d, e, f]] = self.bends;
        let accel = L::select(second, d, a) * 0.5;
        let jerk = L::select(second, e, b) * (1.0 / 6.0);
        let fourth = L::select(second, f, c) * (1.0 / 24.0);
        let value = fourth.mul_add(s, jerk).mul_add(s, accel);
        let slope = (fourth * 4.0).mul_add(s, jerk * 3.0);
        (
            value.mul_add(s, rate).mul_add(s, gap),
            slope.mul_add(s, accel * 2.0).mul_add(s, rate),
        )
    }

    /// The first root of g + ġs + g̈s²/2.
    #[inline(always)]
    fn parabola(&self, i: usize) -> Parabola<L> {
        let (attachment, [accel, ..]) = (&self.attachments[i], self.bends[i]);
        let (gap, rate) = (attachment.gap, attachment.gap_rate);
        let discriminant = rate.mul_add(rate, accel * gap * -2.0);
        let slope = discriminant.positive().sqrt();
        // Summands of one sign in either case.
        let rising = L::ZERO.below(rate);
        let above = L::select(rising, -gap * 2.0, slope - rate);
        let below = L::select(rising, rate + slope, accel);
        let s = above / below;
        let crosses = L::ZERO.below(discriminant);
        Parabola {
            s,
            slope: L::select(crosses, slope, L::ONE),
            crosses: crosses & L::ZERO.below(s),
        }
    }

    /// A step of Newton's from the root of a parabola to that of the cubic, and the reciprocal of the slope for it;
    /// `per_slope` is that of the parabola. A gap that does not cross never closes.
    #[inline(always)]
    fn beyond(&self, i: usize, parabola: &Parabola<L>, per_slope: L) -> (L, L) {
        let [_, jerk, _] = self.bends[i];
        let s = parabola.s;
        let bend = jerk * s * s;
        let per_slope = reciprocal(per_slope, bend.mul_add(L::from_f64(0.5), parabola.slope));
        let step = bend * s * (1.0 / 6.0) * per_slope;
        let stepped = within_twice(s, s - step);
        let never = L::from_f64(NEVER);
        (L::select(parabola.crosses, stepped, never), per_slope)
    }

    /// Looks at the flight at `s`, and from there for where the gap of one cable closes.
    #[inline(always)]
    fn look(&self, s: L, second: L::Mask) -> Look<L> {
        let now = Instant::at(s, self.constant, self.spin).with(&self.wave, s);
        let jets = [
            self.attachments[0].jet(s, &now),
            self.attachments[1].jet(s, &now),
        ];
        let struck = GapJet::select(second, &jets[1], &jets[0]);
        let (rest, left) = struck.root();
        let ahead = s + rest;
        let longest = s.larger(ahead);
        let fourths = [
            self.attachments[0].fourth(longest),
            self.attachments[1].fourth(longest),
        ];
        let square = rest * rest;
        let quartic = square * square * (1.0 / 24.0);
        let left = L::select(second, fourths[1], fourths[0]).mul_add(quartic, left.abs());
        // Both to be well below rounding: of the gap, and of the velocities, of which the centre's speed is a part. Positions
        // are off by less, as a length times that is what the gap is off by.
        let lost = self.force[2] * self.wave.omega.abs() * quartic;
        let speed = self.force[0].mul_add(longest, self.attachments[0].speed);
        // The bounds hold as long as the look is at most half of the flight away.
        let near = (left * BELOW_ROUNDING).at_most(struck.noise)
            & (lost * BELOW_ROUNDING).at_most(speed * L::EPSILON)
            & (rest.abs() * 2.0).at_most(s);
        Look {
            s,
            now,
            jets,
            struck,
            rest,
            fourths,
            rising: L::ZERO.below(struck.rate) & L::ZERO.below(ahead),
            near,
        }
    }

    /// When the gap of a cable closes: looks on from a guess, until what the cubic at the last look leaves out is below
    /// rounding. One look is usual.
    #[inline(always)]
    pub(crate) fn meet(&self, second: L::Mask, guess: L, horizon: L) -> (Look<L>, L::Mask) {
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
    pub(crate) fn arrival(
        &self,
        second: L::Mask,
        look: &Look<L>,
        from: &AfterImpact<L>,
    ) -> FlightEnd<L> {
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
    fn after(&self, look: &Look<L>, rest: L, from: &AfterImpact<L>) -> FlightEnd<L> {
        let s = look.s + rest;
        let [jet, other] = &look.jets;
        let push = look.now.push.later(rest, self.force_bend(&look.now));
        FlightEnd {
            s,
            state: flown(&from.state, s, push),
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
    /// |d| ≤ r at both ends, so in between it is at most r + |Ṗ|s/2, and up to a look later by less than half of that. That
    /// the other gap is open at the end is seen with an error told by K itself; twice that is allowed for, and the K of the
    /// |d| so allowed is not twice as large.
    ///
    /// The jet at the end is that of a look nearby, moved by
    /// its cubic over `rest`: ġ₁ may be off by K rest³/6 and g̈₁ by K rest²/2, with the K of g⁗; `astray` and
    /// `astray` times `rest` are more than that.
    #[inline(always)]
    pub(crate) fn stays_open(
        &self,
        i: usize,
        s: L,
        look: &Look<L>,
        end: &GapJet<L>,
        end_value: L,
    ) -> L::Mask {
        let (attachment, [accel, jerk, _]) = (&self.attachments[i], self.bends[i]);
        let (early, late) = (s * EARLY, s * (1.0 - EARLY));
        let (third, fourth) = (attachment.third(s) * INFLATION, look.fourths[i] * INFLATION);
        let astray = fourth * look.rest * look.rest;

        let half = L::from_f64(0.5);
        let bound = fourth.mul_add(early * 0.25, jerk).positive() * early * (1.0 / 6.0);
        let bound = accel
            .positive()
            .mul_add(half, bound)
            .mul_add(early * INFLATION, attachment.gap_rate);
        let early_open = bound
            .mul_add(early, attachment.gap)
            .below(-attachment.gap_error);

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

/// One cable at the start of a flight.
#[inline(always)]
fn attachment<L: Lane>(
    two_cables: &TwoCableSystem<L>,
    from: &AfterImpact<L>,
    i: usize,
) -> Attachment<L> {
    let (state, [ux, uy, turning]) = (&from.state, from.before);
    let (cable, reach) = (&two_cables.cables[i], two_cables.reach[i]);
    let speed = speed_bound(length_bound([state.vx, state.vy]), state.vtheta, reach);
    let before = speed_bound(length_bound([ux, uy]), turning, reach);
    let speed = speed.larger(before);
    Attachment::new(
        cable,
        reach,
        state,
        &from.turn,
        from.gaps[i],
        speed,
        two_cables.force,
    )
}

/// A step of Newton's from the reciprocal of another number, not far away, to that of `x`.
#[inline(always)]
fn reciprocal<L: Lane>(near: L, x: L) -> L {
    near * (-x).mul_add(near, L::from_f64(2.0))
}

/// `next` where it is between half and twice `s`, else `s`: a longer step of Newton's is none.
#[inline(always)]
fn within_twice<L: Lane>(s: L, next: L) -> L {
    let sound = (s * 0.5).below(next) & next.below(s * 2.0);
    L::select(sound, next, s)
}

/// Bound on the speed of an attachment: |v| + |θ̇| |ρ|.
#[inline(always)]
pub(crate) fn speed_bound<L: Lane>(speed: L, spin: L, reach: L) -> L {
    spin.abs().mul_add(reach, speed)
}
