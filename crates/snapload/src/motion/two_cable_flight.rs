//! The slack flight of a body on two cables: when a cable closes, the state there, and the proof
//! that none closed before.

use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::plane::Vector2;
use crate::arithmetic::processor::apart;
use crate::model::forcing::Harmonic;
use crate::model::state::State;
use crate::motion::attachment::{Attachment, GapJet, INFLATION, Instant, advanced};
use crate::motion::limits::law::NEVER;
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

/// The most trials of one search; usually one is enough.
const MAX_TRIALS: usize = 10;
/// A trial is near enough if the error of its cubic is smaller than the rounding by this factor.
const BELOW_ROUNDING: f64 = 16.0;
/// The part of a flight in which the proof that a gap stays open starts from the beginning of the
/// flight, where one more derivative is known.
pub(crate) const EARLY: f64 = 0.6;

/// A flight evaluated at an instant near its end.
pub(crate) struct Trial<L: Lane> {
    s: L,
    now: Instant<L>,
    jets: [GapJet<L>; 2],
    /// The jet of the cable that is to close.
    struck: GapJet<L>,
    /// The time until that cable closes, by its cubic.
    to_root: L,
    /// Bounds on |g⁗| up to there.
    fourths: [L; 2],
    /// Whether the gap closes there.
    closes: L::Mask,
    /// Whether the error of the cubic is below rounding.
    near_enough: L::Mask,
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
    /// The force there, with a relative error of 1e-8 or less.
    pub(crate) force: Vector2<L>,
}

/// The bounds that are proved for a gap within a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Openness<L: Lane> {
    /// Whether it stays open.
    pub(crate) open: L::Mask,
    /// A slope B: in the early part, [`EARLY`] of the flight, g ≤ g₀ + σ B.
    pub(crate) slope: L,
    /// A bound on g in the late part.
    pub(crate) late: L,
    /// If the cable closes at the end, ġ is at least its value there, less this times the time to
    /// the end over that of the late part; and g is below zero by at least `depth` times the same.
    pub(crate) bend: L,
    pub(crate) depth: L,
}

impl<L: Lane> FlightEnd<L> {
    /// The same numbers with the derivatives of `other`.
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
            force: self.force,
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
    gap_derivatives: [[L; 3]; 2],
    /// The wave, relative to the start.
    wave: Harmonic<L>,
    constant: Vector2<L>,
    /// The force there.
    pub(crate) force_at_start: Vector2<L>,
    /// Bounds on the force and its derivatives.
    force: [L; 3],
    spin: L,
}

impl<L: Lane> TwoCableFlight<L> {
    #[inline(always)]
    pub(crate) fn new(two_cables: &TwoCableSystem<L>, from: &AfterImpact<L>) -> Self {
        let spin = from.state.vtheta;
        let wave = two_cables.wave.shifted(from.t);
        let force = two_cables.constant + wave.cosine;
        let force_rate = wave.sine.scaled(wave.omega);
        let attachments = [
            attachment(two_cables, from, 0),
            attachment(two_cables, from, 1),
        ];
        let force_second_derivative = wave.cosine.scaled(-(wave.omega * wave.omega));
        let forces = [force, force_rate, force_second_derivative];
        let gap_derivatives = [
            attachments[0].gap_derivatives_at_start(forces, spin),
            attachments[1].gap_derivatives_at_start(forces, spin),
        ];
        Self {
            attachments,
            gap_derivatives,
            wave,
            constant: two_cables.constant,
            force_at_start: force,
            force: two_cables.force,
            spin,
        }
    }

    /// Which cable closes first, and approximately when, by the Taylor polynomials of the gaps at
    /// the start: the root of the parabola, a step of Newton's method from there to the root of the
    /// cubic, and for the cable that closes first one more to the root of the polynomial of fourth
    /// order.
    #[inline(always)]
    pub(crate) fn guess(&self) -> (L::Mask, L) {
        let (first, other) = (self.parabola(0), self.parabola(1));
        // One division for both reciprocals.
        let shared = L::ONE / (first.slope * other.slope);
        let (guess, per_slope) = self.root_of_cubic(0, &first, other.slope * shared);
        let (other_guess, other_per_slope) = self.root_of_cubic(1, &other, first.slope * shared);
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
        let [[a, b, c], [d, e, f]] = self.gap_derivatives;
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
        let (attachment, [accel, ..]) = (&self.attachments[i], self.gap_derivatives[i]);
        let (gap, rate) = (attachment.gap, attachment.gap_rate);
        let discriminant = rate.mul_add(rate, accel * gap * -2.0);
        let slope = discriminant.positive().sqrt();
        // Either way the summands have the same sign.
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

    /// A step of Newton's method from the root of a parabola to that of the cubic, and the
    /// reciprocal of the slope for it; `per_slope` is that of the parabola. A gap whose parabola
    /// does not cross zero is taken to stay open.
    #[inline(always)]
    fn root_of_cubic(&self, i: usize, parabola: &Parabola<L>, per_slope: L) -> (L, L) {
        let [_, jerk, _] = self.gap_derivatives[i];
        let s = parabola.s;
        let cubic = jerk * s * s;
        let per_slope = reciprocal(per_slope, cubic.mul_add(L::from_f64(0.5), parabola.slope));
        let step = cubic * s * (1.0 / 6.0) * per_slope;
        let stepped = within_twice(s, s - step);
        let never = L::from_f64(NEVER);
        (L::select(parabola.crosses, stepped, never), per_slope)
    }

    /// Evaluates the flight at `s`, and finds from there the time at which the gap of one cable
    /// closes.
    #[inline(always)]
    fn trial(&self, s: L, second: L::Mask) -> Trial<L> {
        apart!(L, {
            let now = Instant::at(s, self.constant, self.spin).with(&self.wave, s);
            let jets = [
                self.attachments[0].jet(s, &now),
                self.attachments[1].jet(s, &now),
            ];
            let struck = GapJet::select(second, &jets[1], &jets[0]);
            let (to_root, left) = struck.root();
            let root = s + to_root;
            let longest = s.larger(root);
            let fourths = [
                self.attachments[0].fourth(longest),
                self.attachments[1].fourth(longest),
            ];
            let square = to_root * to_root;
            let quartic = square * square * (1.0 / 24.0);
            let left = L::select(second, fourths[1], fourths[0]).mul_add(quartic, left.abs());
            // Two errors have to be well below rounding: that of the gap, and that of the
            // velocities, which include the centre's speed. Positions have smaller errors, as a
            // length times such an error is an error of the gap.
            let lost = self.force[2] * self.wave.omega.abs() * quartic;
            let speed = self.force[0].mul_add(longest, self.attachments[0].speed);
            // The bounds hold if the root is at most half of the flight away.
            let near_enough = (left * BELOW_ROUNDING).at_most(struck.noise)
                & (lost * BELOW_ROUNDING).at_most(speed * L::EPSILON)
                & (to_root.abs() * 2.0).at_most(s);
            Trial {
                s,
                now,
                jets,
                struck,
                to_root,
                fourths,
                closes: L::ZERO.below(struck.rate) & L::ZERO.below(root),
                near_enough,
            }
        })
    }

    /// Searches from a guess for the time at which the gap of a cable closes: each trial is at the
    /// root of the cubic of the one before, until the error of the cubic is below rounding. Usually
    /// one trial is enough. Returns the last one, and whether it is near enough.
    #[inline(always)]
    pub(crate) fn search(&self, second: L::Mask, guess: L, horizon: L) -> (Trial<L>, L::Mask) {
        let mut active = guess.below(horizon);
        let mut s = guess.detached();
        let mut trials = 1;
        loop {
            let trial = self.trial(s, second);
            active = active & trial.closes;
            let again = active & !trial.near_enough;
            if trials == MAX_TRIALS || !again.any() {
                let found = active & trial.near_enough;
                return (trial, found);
            }
            // A lane that is near enough is evaluated again at the same time, and does not change.
            s = L::select(again, (s + trial.to_root).detached(), s);
            trials += 1;
        }
    }

    /// The end of the flight, a little after a trial.
    #[inline(always)]
    pub(crate) fn arrival(
        &self,
        second: L::Mask,
        trial: &Trial<L>,
        from: &AfterImpact<L>,
    ) -> FlightEnd<L> {
        let arrival = self.after(trial, trial.to_root.detached(), from);
        if !L::CARRIES_SLOPES {
            return arrival;
        }
        // The times of the search's trials do not depend on the parameters; the crossing moves by
        // −∂g/ġ. Both derivatives are taken at the crossing itself, as those of values that its
        // cubic moves there are of lower order.
        let there = self.trial(arrival.s.detached(), second);
        let value = there.struck.value;
        let moved = (value.detached() - value) / there.struck.rate;
        arrival.with_slopes_of(&self.after(&there, moved, from))
    }

    /// The flight a time `later` after a trial, by the cubics there.
    #[inline(always)]
    fn after(&self, trial: &Trial<L>, later: L, from: &AfterImpact<L>) -> FlightEnd<L> {
        let s = trial.s + later;
        let [jet, other] = &trial.jets;
        let push = trial
            .now
            .push
            .later(later, self.force_second_derivative(&trial.now));
        FlightEnd {
            s,
            state: advanced(&from.state, s, push),
            jets: [
                jet.later(later, trial.fourths[0]),
                other.later(later, trial.fourths[1]),
            ],
            force: trial.now.push.force.plus_scaled(trial.now.push.rate, later),
        }
    }

    /// f̈ = −Ω² (f − f₀), where f₀ is constant.
    #[inline(always)]
    fn force_second_derivative(&self, now: &Instant<L>) -> Vector2<L> {
        let square = -(self.wave.omega * self.wave.omega);
        (now.push.force - self.constant).scaled(square)
    }

    /// Whether a gap is proven to stay open within a flight of length `s`, at whose end it is
    /// `end`.
    ///
    /// In the early part, g(σ) ≤ g₀ + ġ₀σ + g̈₀σ²/2 + g⃛₀σ³/6 + Kσ⁴/24 with |g⁗| ≤ K = 2 (3 |P̈|² +
    /// 4 |Ṗ||P⃛| + |d||P⁗|); in the late part, backwards from the end, g ≤ g₁ − ġ₁σ + g̈₁σ²/2 +
    /// Kσ³/6 with |g⃛| ≤ K = 2 (3 |Ṗ||P̈| + |d||P⃛|). In either part g ≤ g₀ + σB, where B is the
    /// sum of what multiplies σ, with each term after the first at its largest, so it is enough
    /// that g₀ ≤ 0 and that g₀ + σB is below zero at the end of the part. A cable that closes at
    /// the end, or that was closed at the start, is known to have g = 0 there.
    ///
    /// |d| ≤ r at both ends, so in between it is at most r + |Ṗ|s/2, and up to the trial, which may
    /// be later than the end, by less than half of that. The error of the other gap at the end is
    /// bounded by K itself: twice that is allowed for, and the K that belongs to the |d| so allowed
    /// is not twice as large.
    ///
    /// The jet at the end is that of the trial, moved to the end by its cubic over the time h =
    /// `to_root`: ġ₁ may be off by K h³/6 and g̈₁ by K h²/2, with the K of g⁗. `shift_error` and
    /// `shift_error` times h are more than that.
    #[inline(always)]
    pub(crate) fn stays_open(
        &self,
        i: usize,
        s: L,
        trial: &Trial<L>,
        end: &GapJet<L>,
        end_value: L,
    ) -> Openness<L> {
        let (attachment, [accel, jerk, _]) = (&self.attachments[i], self.gap_derivatives[i]);
        let (early, late) = (s * EARLY, s * (1.0 - EARLY));
        let (third, fourth) = (
            attachment.third(s) * INFLATION,
            trial.fourths[i] * INFLATION,
        );
        let shift_error = fourth * trial.to_root * trial.to_root;

        let half = L::from_f64(0.5);
        let bound = fourth.mul_add(early * 0.25, jerk).positive() * early * (1.0 / 6.0);
        let slope = accel
            .positive()
            .mul_add(half, bound)
            .mul_add(early * INFLATION, attachment.gap_rate);
        let early_open = slope
            .mul_add(early, attachment.gap)
            .below(-attachment.gap_error);

        let rises = (end.accel + shift_error).positive();
        let bend = (third * late).mul_add(half, rises) * (late * INFLATION);
        let bound = rises.mul_add(half, third * late * (1.0 / 6.0));
        let slowest = shift_error.mul_add(-trial.to_root.abs(), end.rate);
        let bound = bound.mul_add(late * INFLATION, -slowest);
        let latest = bound.mul_add(late, end_value);
        let late_open = latest.below(-end.noise);
        // The struck cable's gap at the end is known to be zero, without rounding.
        let late_open = late_open | (L::ZERO.at_most(end_value) & bound.below(L::ZERO));
        Openness {
            open: early_open & late_open,
            slope,
            late: latest.larger(end_value),
            bend,
            depth: -latest,
        }
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
    let speed = speed_bound(state.velocity().length_bound(), state.vtheta, reach);
    let before = speed_bound(Vector2::from([ux, uy]).length_bound(), turning, reach);
    let speed = speed.larger(before);
    Attachment::new(
        cable,
        reach,
        state,
        &from.rotation,
        from.gaps[i],
        speed,
        two_cables.force,
    )
}

/// About 1/x, by one step of Newton's method from the reciprocal of a number close to x.
#[inline(always)]
fn reciprocal<L: Lane>(estimate: L, x: L) -> L {
    estimate * (-x).mul_add(estimate, L::from_f64(2.0))
}

/// `next` if it is between half and twice `s`, else `s`: a longer step of Newton's method would not
/// help.
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
