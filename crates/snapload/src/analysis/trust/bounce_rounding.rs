//! What rounding adds to the deviation of a run in a bounce: [`crate::analysis::trust::rounding`],
//! which treats any step, written out for one closed cable. The rounded position may be off along
//! the end of that cable and by a turn about it, and, where the other gap is known better, only as
//! far as that allows.
#![expect(
    clippy::needless_range_loop,
    reason = "a deviation is an entry of every row"
)]

use crate::analysis::trust::parts::COLUMNS;
use crate::analysis::trust::rounding::{BOUND_OF_GAP, ROUNDING};
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::plane::Vector2;
use crate::model::cable::Normal;
use crate::motion::bounce_map::{BounceMap, Bounced, Rows};

/// Standard deviations of the rounding in a bounce.
pub(super) struct BounceRounding<L> {
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
    /// The rounding of a bounce, where the error of the cables' direction is `slant` roundings.
    #[inline(always)]
    pub(super) fn of(bounced: &Bounced<L>, slant: L) -> Self {
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

    /// The same multiplied by the signs of a step; the location has a sign of its own.
    #[inline(always)]
    pub(super) fn with_signs(mut self, [sign, other_sign]: [L; 2]) -> Self {
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
        self
    }

    /// Adds the error of the impact's location, which is a displacement across the end of the
    /// cable.
    #[inline(always)]
    pub(super) fn add_location<const N: usize>(&self, bounced: &Bounced<L>, rows: &mut Rows<L, N>) {
        let n = bounced.facts.normal.n;
        for (row, direction) in rows.iter_mut().zip([n.x, n.y]) {
            // See [`add`].
            let first = if L::Mask::WIDTH == 1 { N / 2 } else { N - 1 };
            for k in first..N {
                let location = if k == N - 1 { self.location } else { L::ZERO };
                row[k] = location.mul_add(direction, row[k]);
            }
        }
    }

    /// Adds the rounding of the stored state and of the impact law's inputs, where the columns are
    /// shifted by so many. Each has its own column, but that of the law's direction shares one with
    /// the displacement by x, and that of its rotation the one of the turn.
    #[inline(always)]
    pub(super) fn add(&self, map: &BounceMap<L>, rows: &mut Rows<L, COLUMNS>, shift: usize) {
        let [first, second] = self.along.map(Some);
        let along = [first, second, None, None];
        let (low, high) = (shift, COLUMNS / 2 + shift);
        add_products(&mut rows[0], low, along, self.across.x);
        add_products(&mut rows[1], low, along, self.across.y);
        for i in 0..3 {
            let turned = Some(self.turned[i]);
            add(&mut rows[i], low, [None, None, turned, None]);
        }
        let by_direction = map.law_of_turning(L::ZERO, self.direction, self.direction);
        let by_turn = map.law_of_turning(L::ZERO, L::ZERO, -self.turn);
        for (i, speed) in [Some(self.speed), None, None].into_iter().enumerate() {
            let law = [Some(by_direction[i]), None, Some(by_turn[i]), speed];
            add(&mut rows[3 + i], low, law);
        }
        add(&mut rows[4], high, [Some(self.speed), None, None, None]);
        add(&mut rows[5], high, [None, Some(self.spin), None, None]);
        add(&mut rows[6], high, [None, None, Some(self.time), None]);
    }

    /// A bound on the squares of what is added to the position and the time.
    #[inline(always)]
    pub(super) fn place_squared(&self) -> L {
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

/// Adds the given entries to half of a row, from its column `first` on. For a single run, of which
/// a vector register holds half a row, zeros are added to the other entries: writing one entry
/// alone would delay the next read of the whole row.
#[inline(always)]
fn add<L: Lane>(row: &mut [L; COLUMNS], first: usize, more: [Option<L>; COLUMNS / 2]) {
    for k in 0..COLUMNS / 2 {
        if more[k].is_some() || L::Mask::WIDTH == 1 {
            row[first + k] = row[first + k] + more[k].unwrap_or(L::ZERO);
        }
    }
}

/// The same with the entries multiplied by a factor.
#[inline(always)]
fn add_products<L: Lane>(
    row: &mut [L; COLUMNS],
    first: usize,
    more: [Option<L>; COLUMNS / 2],
    factor: L,
) {
    for k in 0..COLUMNS / 2 {
        if more[k].is_some() || L::Mask::WIDTH == 1 {
            row[first + k] = more[k].unwrap_or(L::ZERO).mul_add(factor, row[first + k]);
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
