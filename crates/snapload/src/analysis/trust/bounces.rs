//! The spread of neighbours through a bounce, of one run or of several side by side in the lanes of
//! the processor.
//!
//! The effect of a bounce on deviations is [`BounceMap`]; its rounding is treated as
//! [`crate::analysis::trust::rounding`] does for any step, written out for one closed cable: the
//! rounded position may be off along the end of that cable and by a turn about it, and, where the
//! other gap is known better, only as far as that allows. Whether neighbours may have other events
//! than the run is decided in [`crate::analysis::trust::bounce_reach`].
#![expect(
    clippy::needless_range_loop,
    reason = "a deviation is an entry of every row"
)]

use crate::analysis::trust::bounce_reach::{AtStart, Reach, SAFE};
use crate::analysis::trust::parts::{COLUMNS, FactorParts, square, squares};
use crate::analysis::trust::rounding::{BOUND_OF_GAP, ROUNDING};
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::plane::Vector2;
use crate::model::cable::Normal;
use crate::motion::bounce_map::{BounceMap, Bounced, Rows};

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
