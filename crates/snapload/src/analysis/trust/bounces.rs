//! The spread of neighbours through a bounce, of one run or of several side by side in the lanes of
//! the processor.
//!
//! The effect of a bounce on deviations is [`BounceMap`]; its rounding is treated as
//! [`crate::analysis::trust::rounding`] does for any step, written out for one closed cable: the
//! rounded position may be off along the end of that cable and by a turn about it, and, where the
//! other gap is known better, only as far as that allows. Whether neighbours may have other events
//! than the run is decided by bounds here, without roots; where a bound does not hold,
//! [`crate::analysis::trust::causes`] decides.
#![expect(
    clippy::needless_range_loop,
    reason = "a deviation is an entry of every row"
)]

use crate::analysis::trust::causes::SIGMA_REACH;
use crate::analysis::trust::parts::{COLUMNS, FactorParts, square, squares};
use crate::analysis::trust::rounding::{BOUND_OF_GAP, ROUNDING};
use crate::analysis::trust::spread::ERROR;
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::plane::Vector2;
use crate::model::cable::{Cable, Normal};
use crate::motion::bounce_map::{BounceMap, Bounced, Rows};

/// Bounds are computed in rounded arithmetic; this factor makes them safe.
const SAFE: f64 = 1.001;

/// The data of a run that are carried through bounces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed<L> {
    pub(super) parts: FactorParts<L>,
    /// See [`crate::analysis::trust::rounding::slant`].
    pub(super) slant: L,
    pub(super) tolerance: L,
}

/// The spread of the neighbours through a bounce.
pub(super) struct Through<L: Lane> {
    /// Squares of the standard deviations just before the impact.
    pub(super) met: [L; 7],
    /// Whether it is certain that no neighbour has another event, and that the error is within the
    /// tolerance.
    pub(super) within_tolerance: L::Mask,
}

impl<L: Lane> Followed<L> {
    /// Applies a function to each of its numbers and the other's.
    #[inline(always)]
    pub(super) fn pairwise<M>(&mut self, other: &Followed<M>, mut each: impl FnMut(&mut L, &M)) {
        self.parts.pairwise(&other.parts, &mut each);
        each(&mut self.slant, &other.slant);
        each(&mut self.tolerance, &other.tolerance);
    }

    /// The parts just before the impact: at the previous event's time, and at the impact's own
    /// time.
    #[inline(always)]
    pub(super) fn before(&self, bounced: &Bounced<L>, map: &BounceMap<L>) -> [Rows<L, COLUMNS>; 2] {
        let mut rows = self.parts.rows;
        map.along(&mut rows);
        BounceRounding::of(self, bounced).add_location(bounced, &mut rows);
        let along = rows;
        map.meet(&mut rows);
        [along, rows]
    }

    /// Carries the parts through a bounce, in place, as they are large.
    #[inline(always)]
    pub(super) fn carry(&mut self, bounced: &Bounced<L>, map: &BounceMap<L>) -> Through<L> {
        let rounding = BounceRounding::of(self, bounced);
        let rows = &mut self.parts.rows;
        let start = AtStart::of(bounced, rows);
        map.along(rows);
        rounding.add_location(bounced, rows);
        let later = map.meet(rows);
        let met = squares(rows);
        let other = map.along_other(bounced, rows, &later);
        let closing = map.through(rows);
        rounding.add(map, rows);
        let reach = Reach::of(
            bounced,
            start,
            met,
            [square(&later), square(&closing)],
            [square(&other[0]), square(&other[1])],
        );
        let known = reach.error(rows, rounding.place_squared()) * SAFE;
        let within_tolerance = known.below(self.tolerance * self.tolerance)
            & reach.meets_all(bounced)
            & reach.leaves_the_other_open(bounced)
            & reach.rises_once(bounced)
            & reach.reaches_no_limit(bounced);
        self.parts.rotate();
        Through {
            met,
            within_tolerance,
        }
    }
}

/// Standard deviations of the rounding in a bounce.
struct BounceRounding<L> {
    /// Across the end of the cable that snaps, where the impact is located.
    location: L,
    /// Along its end: by x and by y.
    along: [L; 2],
    /// The displacement of the body when rounding turns it.
    turned: [L; 3],
    /// Of the velocities, the time, and of the direction and the rotation that the impact law uses.
    speed: L,
    spin: L,
    time: L,
    direction: L,
    turn: L,
    across: Vector2<L>,
}

impl<L: Lane> BounceRounding<L> {
    /// The rounding of a bounce, multiplied by the signs of the step.
    #[inline(always)]
    fn of(followed: &Followed<L>, bounced: &Bounced<L>) -> Self {
        let mut rounding = Self::sizes(bounced, followed.slant);
        let [sign, other_sign] = followed.parts.signs();
        rounding.give(sign, other_sign);
        rounding
    }

    #[inline(always)]
    fn sizes(bounced: &Bounced<L>, slant: L) -> Self {
        let (start, before, after) = (&bounced.from.state, bounced.before, bounced.after);
        let s = bounced.t - bounced.from.t;
        let moved = [
            start.vx.abs().larger(before.vx.abs()) * s,
            start.vy.abs().larger(before.vy.abs()) * s,
            before.vtheta.abs() * s,
        ];
        let place = |at: L, moved: L| (at.abs() + moved) * ROUNDING;
        let places = [
            place(before.x, moved[0]),
            place(before.y, moved[1]),
            place(before.theta, moved[2]),
        ];
        let (along, turned) = displacements(bounced, places);
        let speed = before
            .velocity()
            .length_bound()
            .larger(after.velocity().length_bound());
        let spin = before.vtheta.abs().larger(after.vtheta.abs());
        Self {
            location: location(bounced, slant, moved),
            along,
            turned,
            speed: speed * ROUNDING,
            spin: spin * ROUNDING,
            time: bounced.t * (ROUNDING * std::f64::consts::SQRT_2),
            direction: slant * (0.5 * ROUNDING),
            turn: L::from_f64(ROUNDING),
            across: bounced.facts.normal.n.quarter_turn(),
        }
    }

    /// Multiplies them by the signs of a step; the location has a sign of its own.
    #[inline(always)]
    fn give(&mut self, sign: L, other_sign: L) {
        self.location = self.location * other_sign;
        for k in 0..2 {
            self.along[k] = self.along[k] * sign;
        }
        for k in 0..3 {
            self.turned[k] = self.turned[k] * sign;
        }
        self.speed = self.speed * sign;
        self.spin = self.spin * sign;
        self.time = self.time * sign;
        self.direction = self.direction * sign;
        self.turn = self.turn * sign;
    }

    /// Adds the error of the impact's location, which is a displacement across the end of the
    /// cable.
    #[inline(always)]
    fn add_location(&self, bounced: &Bounced<L>, rows: &mut Rows<L, COLUMNS>) {
        let n = bounced.facts.normal.n;
        let location = [None, None, None, Some(self.location)];
        add_products(half(&mut rows[0], 1), location, n.x);
        add_products(half(&mut rows[1], 1), location, n.y);
    }

    /// Adds the rounding of the stored state and of the impact law's inputs, each in its own
    /// column.
    #[inline(always)]
    fn add(&self, map: &BounceMap<L>, rows: &mut Rows<L, COLUMNS>) {
        let [first, second] = self.along.map(Some);
        add_products(
            half(&mut rows[0], 0),
            [first, second, None, None],
            self.across.x,
        );
        add_products(
            half(&mut rows[1], 0),
            [first, second, None, None],
            self.across.y,
        );
        for i in 0..3 {
            let turned = Some(self.turned[i]);
            add(half(&mut rows[i], 0), [None, None, turned, None]);
        }
        let by_direction = map.law_of_turning(L::ZERO, self.direction, self.direction);
        let by_turn = map.law_of_turning(L::ZERO, L::ZERO, -self.turn);
        for (i, speed) in [Some(self.speed), None, None].into_iter().enumerate() {
            let law = [Some(by_direction[i]), None, Some(by_turn[i]), speed];
            add(half(&mut rows[3 + i], 0), law);
        }
        add(half(&mut rows[4], 1), [Some(self.speed), None, None, None]);
        add(half(&mut rows[5], 1), [None, Some(self.spin), None, None]);
        add(half(&mut rows[6], 1), [None, None, Some(self.time), None]);
    }

    /// A bound on the squares of what is added to the position and the time.
    #[inline(always)]
    fn place_squared(&self) -> L {
        let mut sum = self.time * self.time;
        for part in self.along {
            sum = part.mul_add(part, sum);
        }
        for part in self.turned {
            sum = part.mul_add(part, sum);
        }
        sum
    }
}

/// Half of a row, which is as much as a vector register holds.
#[inline(always)]
fn half<L>(row: &mut [L; COLUMNS], which: usize) -> &mut [L; COLUMNS / 2] {
    &mut row.as_chunks_mut().0[which]
}

/// Adds the given entries to half of a row. For a single run zeros are added to the other entries:
/// writing one entry alone would delay the next read of the whole row.
#[inline(always)]
fn add<L: Lane>(half: &mut [L; COLUMNS / 2], more: [Option<L>; COLUMNS / 2]) {
    for (entry, more) in half.iter_mut().zip(more) {
        if more.is_some() || L::Mask::WIDTH == 1 {
            *entry = *entry + more.unwrap_or(L::ZERO);
        }
    }
}

/// The same with the entries multiplied by a factor.
#[inline(always)]
fn add_products<L: Lane>(half: &mut [L; COLUMNS / 2], more: [Option<L>; COLUMNS / 2], factor: L) {
    for (entry, more) in half.iter_mut().zip(more) {
        if more.is_some() || L::Mask::WIDTH == 1 {
            *entry = more.unwrap_or(L::ZERO).mul_add(factor, *entry);
        }
    }
}

/// Standard deviation of the impact's location across the end of the cable that snaps.
#[inline(always)]
fn location<L: Lane>(bounced: &Bounced<L>, slant: L, moved: [L; 3]) -> L {
    let before = bounced.before;
    let Normal { n, arm } = bounced.facts.normal;
    let s = bounced.t - bounced.from.t;
    let [per_length, _] = bounced.each(|k| bounced.two_cables.cables[k].per_length());
    let [gap, _] = bounced.each(|k| bounced.from.gaps[k][0]);
    let [gap_error, _] = bounced.each(|k| bounced.from.gaps[k][1]);
    let [reach, _] = bounced.each(|k| bounced.two_cables.reach[k]);
    // An error of the cable's direction displaces its end; but a cable that was closed at the start
    // has its end where the body is.
    let speed = before.velocity().length_bound();
    let travelled = before.vtheta.abs().mul_add(reach, speed) * s;
    let place = before.x.abs() + before.y.abs();
    let away = before.theta.abs().mul_add(reach, place);
    let swung = (slant - 1.0) * L::select(L::ZERO.at_most(gap), travelled, away);
    let offs = [moved[0] * n.x, moved[1] * n.y, moved[2] * arm, swung];
    let known = gap_error * per_length * BOUND_OF_GAP;
    let mut square = known * known;
    for off in offs {
        let off = off * ROUNDING;
        square = off.mul_add(off, square);
    }
    square.sqrt()
}

/// The displacements of the body by rounding along the end of the cable, in x and in y, and by
/// turning it. They change the other gap; where that gap is known better, they are limited to what
/// its error allows.
#[inline(always)]
fn displacements<L: Lane>(bounced: &Bounced<L>, [x, y, theta]: [L; 3]) -> ([L; 2], [L; 3]) {
    let Normal { n, arm } = bounced.facts.normal;
    let other = bounced.facts.other;
    let [_, per_length] = bounced.each(|k| bounced.two_cables.cables[k].per_length());
    let tangent = n.quarter_turn();
    let along = [x * tangent.x, y * tangent.y];
    let slide = tangent.dot(other.n);
    let roll = other.arm - arm * n.dot(other.n);
    let known = bounced.other_gap[1] * per_length * BOUND_OF_GAP;
    let [a, b, c] = [along[0] * slide, along[1] * slide, theta * roll];
    let better =
        (known * known).below(a.mul_add(a, b.mul_add(b, c * c))) & L::EPSILON.below(slide * slide);
    let per_slide = L::ONE / slide;
    let aside = L::select(better, -(c * per_slide), L::ZERO);
    let inward = -(theta * arm);
    (
        [
            L::select(better, known * per_slide, along[0]),
            L::select(better, L::ZERO, along[1]),
        ],
        [
            inward.mul_add(n.x, aside * tangent.x),
            inward.mul_add(n.y, aside * tangent.y),
            theta,
        ],
    )
}

/// How far neighbours reach at the start of a flight, each just after its own event: squares of
/// standard deviations.
struct AtStart<L> {
    theta: L,
    height: L,
    /// Of what they reach from there within the flight along the cable that is open at the start
    /// ([`crate::analysis::trust::causes`]).
    open: L,
}

impl<L: Lane> AtStart<L> {
    #[inline(always)]
    fn of(bounced: &Bounced<L>, rows: &Rows<L, COLUMNS>) -> Self {
        let (two_cables, from) = (bounced.two_cables, bounced.from);
        // The one that snapped last is closed.
        let second = from.gaps[1][0].below(from.gaps[0][0]);
        let cable = Cable::select(second, &two_cables.cables[1], &two_cables.cables[0]);
        let lever = cable.lever(from.rotation.sine, from.rotation.cosine);
        let span = cable.span_moved(cable.moved(&from.state, &from.rotation));
        let Normal { n, arm } = cable.normal_along(span, lever);
        let mut along = [L::ZERO; COLUMNS];
        for k in 0..COLUMNS {
            let [x, y, theta] = [rows[0][k], rows[1][k], rows[2][k]];
            along[k] = n.x.mul_add(x, n.y.mul_add(y, arm * theta));
        }
        let [x, y, theta] = [0, 1, 2].map(|i| square(&rows[i]));
        let reach = L::select(second, two_cables.reach[1], two_cables.reach[0]);
        let before = bounced.before;
        let s = bounced.t - from.t;
        let speed = before
            .vtheta
            .abs()
            .mul_add(reach, before.velocity().length_bound());
        let turned = two_cables.force[0].mul_add(s, speed) * s * cable.per_length() * 0.25;
        let place = (reach * reach).mul_add(theta, x + y) * 2.0;
        Self {
            theta,
            height: y,
            open: (turned * turned).mul_add(place, square(&along)) * 2.0,
        }
    }
}

/// How far neighbours reach: squares of standard deviations.
struct Reach<L> {
    /// Of each component, at the neighbour's own impact.
    met: [L; 7],
    /// For the delay of the impact, and for its normal velocity.
    later: L,
    closing: L,
    /// Along a gap that was open at the start of the flight, there: a bound for each.
    start: L,
    /// Along the other cable, the largest of the values at the start, at the end at the previous
    /// event's time, and at the impact's; for the rotation and the height, bounds that hold at all
    /// of them.
    other: L,
    theta: L,
    height: L,
}

impl<L: Lane> Reach<L> {
    #[inline(always)]
    fn of(
        bounced: &Bounced<L>,
        start: AtStart<L>,
        met: [L; 7],
        [later, closing]: [L; 2],
        [along, at_end]: [L; 2],
    ) -> Self {
        let before = bounced.before;
        let doubled = |square: L, rate: L| (rate * rate).mul_add(later, square) * 2.0;
        let [_, gap] = bounced.each(|k| bounced.from.gaps[k][0]);
        let of_other = L::select(gap.below(L::ZERO), start.open, L::ZERO);
        Self {
            met,
            later,
            closing,
            start: start.open,
            other: along.larger(at_end).larger(of_other),
            theta: doubled(met[2], before.vtheta).larger(start.theta),
            height: doubled(met[1], before.vy).larger(start.height),
        }
    }

    /// A bound on the square of the error. What rounding adds to the position is given by
    /// `place_added`, as (a + b)² ≤ (1 + 1/64) a² + 65 b².
    #[inline(always)]
    fn error(&self, after: &Rows<L, COLUMNS>, place_added: L) -> L {
        let mut sum = place_added * 65.0;
        for square in self.met {
            sum = square.mul_add(L::from_f64(1.0 + 1.0 / 64.0), sum);
        }
        for row in &after[3..6] {
            sum = sum + square(row);
        }
        sum * (ERROR * ERROR)
    }

    /// Whether all neighbours have the impact before the end of time, and rebound from it.
    #[inline(always)]
    fn meets_all(&self, bounced: &Bounced<L>) -> L::Mask {
        const SQUARE: f64 = SIGMA_REACH * SIGMA_REACH * SAFE;
        let (two_cables, before) = (bounced.two_cables, bounced.before);
        let [one, two] = two_cables.reach;
        let reach = one.larger(two);
        // The closing velocity of the gap decreases at most at the rate |P̈|.
        let slowing = (before.vtheta * before.vtheta).mul_add(reach, two_cables.force[0]);
        let v_n = bounced.v_n;
        let closes = (self.later * slowing * slowing * (4.0 * SQUARE)).below(v_n * v_n);
        let left = v_n - two_cables.v_stick;
        let rebounds = (self.closing * SQUARE).below(left * left);
        let left = two_cables.t_end - bounced.t;
        closes & rebounds & (self.met[6] * SQUARE).below(left * left)
    }

    /// Whether the gap that closes is open by more than the neighbours' reach up to its last rise.
    /// At the end that is its rate times their reach in time; before, the normal had another
    /// direction, by no more than the way over the cable's length; and they reach as far as at the
    /// start, unless all of them begin with this cable closed.
    #[inline(always)]
    fn rises_once(&self, bounced: &Bounced<L>) -> L::Mask {
        const FACTOR: f64 = 8.0 * SIGMA_REACH * SIGMA_REACH * SAFE;
        let (before, s) = (bounced.before, bounced.t - bounced.from.t);
        let [length, _] = bounced.each(|k| bounced.two_cables.cables[k].length());
        let [reach, _] = bounced.each(|k| bounced.two_cables.reach[k]);
        let speed = before
            .vtheta
            .abs()
            .mul_add(reach, before.velocity().length_bound());
        let way = bounced.two_cables.force[0].mul_add(s, speed) * s;
        let place = self.met[0] + (reach * reach).mul_add(self.met[2], self.met[1]);
        let place = (speed * speed).mul_add(self.later, place) * 4.0;
        let rate = length * bounced.v_n;
        let at_end = (rate * rate).mul_add(self.later, place * way * way) * FACTOR;
        let [gap, _] = bounced.each(|k| bounced.from.gaps[k][0]);
        let at_start = self.start * length * length * (FACTOR * 0.5);
        let at_start = L::select(gap.below(L::ZERO), at_start, L::ZERO);
        bounced.is_open_before_last_rise(at_end.larger(at_start))
    }

    /// Whether the other gap stays open by more than the neighbours' reach. A cable that was closed
    /// at the start of the flight is closed for all neighbours then, and their gaps spread from
    /// zero.
    #[inline(always)]
    fn leaves_the_other_open(&self, bounced: &Bounced<L>) -> L::Mask {
        let [_, gap] = bounced.each(|k| bounced.from.gaps[k][0]);
        let [_, length] = bounced.each(|k| bounced.two_cables.cables[k].length());
        let s = bounced.t - bounced.from.t;
        let largest = Bounced::largest_early(gap, bounced.facts.slope, s)
            .larger(bounced.facts.late)
            .larger(bounced.other_gap[0]);
        const FACTOR: f64 = 4.0 * SIGMA_REACH * SIGMA_REACH * SAFE;
        let margin = length * length * self.other * FACTOR;
        largest.below(L::ZERO) & margin.below(largest * largest)
    }

    /// Whether no neighbour reaches a limit.
    #[inline(always)]
    fn reaches_no_limit(&self, bounced: &Bounced<L>) -> L::Mask {
        const SQUARE: f64 = SIGMA_REACH * SIGMA_REACH * SAFE;
        let two_cables = bounced.two_cables;
        let (start, end) = (&bounced.from.state, bounced.before);
        let s = bounced.t - bounced.from.t;
        let turned = start.theta.abs().larger(end.theta.abs());
        let left = two_cables.rotation_limit - turned;
        let turns = L::ZERO.below(left) & (self.theta * SQUARE).below(left * left);
        let bulge = two_cables.vertical_acceleration_bound * s * s * 0.125;
        let left = two_cables.level - (start.y.larger(end.y) + bulge);
        let outline = two_cables.outline;
        let top = (outline * outline).mul_add(self.theta, self.height) * 2.0;
        turns & L::ZERO.below(left) & (top * SQUARE).below(left * left)
    }
}
