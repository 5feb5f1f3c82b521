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

use crate::analysis::trust::bounce_reach::{AtStart, OpenCable, Reach, SAFE};
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

    /// Carries the parts through a bounce, to `next`.
    #[inline(always)]
    pub(super) fn carry(
        &self,
        next: &mut Self,
        bounced: &Bounced<L>,
        map: &BounceMap<L>,
    ) -> Through<L> {
        let rounding = BounceRounding::of(self, bounced);
        let open = OpenCable::of(bounced);
        let columns = Columns {
            bounced,
            map,
            rounding: &rounding,
            open: &open,
        };
        (next.slant, next.tolerance) = (self.slant, self.tolerance);
        next.parts.take_signs(&self.parts);
        let rows = &mut next.parts.rows;
        // The columns of a single run lie side by side in registers: all are carried at once.
        let (squares, velocities_after) = if L::Mask::WIDTH == 1 {
            *rows = self.parts.rows;
            let squares = squares(&columns.carry(rows, true));
            rounding.add(map, rows, 0);
            let after = [square(&rows[3]), square(&rows[4]), square(&rows[5])];
            next.parts.rotate();
            (squares, after)
        } else {
            let squares = columns.carry_in_pairs(&self.parts.rows, rows);
            rounding.add(map, rows, 1);
            let after = [
                square_permuted(&rows[3]),
                square_permuted(&rows[4]),
                square_permuted(&rows[5]),
            ];
            next.parts.advance_signs();
            (squares, after)
        };
        let [x, y, theta, along_open, rest @ ..] = squares;
        let [met @ .., later, closing, along_other, at_end] = rest;
        let start = AtStart::of(bounced, &open, [x, y, theta], along_open);
        let reach = Reach::of(bounced, start, met, [later, closing], [along_other, at_end]);
        let known = reach.error(velocities_after, rounding.place_squared()) * SAFE;
        let within_tolerance = known.below(self.tolerance * self.tolerance)
            & reach.meets_all(bounced)
            & reach.leaves_the_other_open(bounced)
            & reach.rises_once(bounced)
            & reach.reaches_no_limit(bounced);
        Through {
            met,
            within_tolerance,
        }
    }
}

/// What is known of neighbours column by column: x, y and θ at the start, what that is along the
/// cable that is open there, the seven components at the neighbour's own impact, the delay of the
/// impact and its normal velocity, and the displacements along the other cable, at the previous
/// event's time and at the impact's.
const KNOWN: usize = 15;

/// The columns of a spread to be carried through a bounce.
struct Columns<'a, 'b, L: Lane> {
    bounced: &'a Bounced<'b, L>,
    map: &'a BounceMap<L>,
    rounding: &'a BounceRounding<L>,
    open: &'a OpenCable<L>,
}

impl<L: Lane> Columns<'_, '_, L> {
    /// Carries some of the columns, except for the rounding after the impact; `located` says
    /// whether the last of them contains the error of the impact's location.
    #[inline(always)]
    fn carry<const N: usize>(&self, rows: &mut Rows<L, N>, located: bool) -> [[L; N]; KNOWN] {
        let [x, y, theta, ..] = *rows;
        let Normal { n, arm } = self.open.normal;
        let mut along_open = [L::ZERO; N];
        for k in 0..N {
            along_open[k] = n.x.mul_add(x[k], n.y.mul_add(y[k], arm * theta[k]));
        }
        self.map.along(rows);
        if located {
            self.rounding.add_location(self.bounced, rows);
        }
        let later = self.map.meet(rows);
        let [a, b, c, d, e, f, g] = *rows;
        let [along_other, at_end] = self.map.along_other(self.bounced, rows, &later);
        let closing = self.map.through(rows);
        [
            x,
            y,
            theta,
            along_open,
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            later,
            closing,
            along_other,
            at_end,
        ]
    }

    /// Carries all columns to `next`, permuted as [`FactorParts::rotate`] does; returns the squares
    /// of what is known, which are those of [`square`]. Two columns at a time are few enough for
    /// the processor's registers; written out for all eight, the code took longer.
    #[inline(always)]
    fn carry_in_pairs(&self, rows: &Rows<L, COLUMNS>, next: &mut Rows<L, COLUMNS>) -> [L; KNOWN] {
        const HALF: usize = COLUMNS / 2;
        let mut sums = [[L::ZERO; KNOWN]; 2];
        for k in 0..HALF {
            let mut pair = [[L::ZERO; 2]; 7];
            for i in 0..7 {
                pair[i] = [rows[i][k], rows[i][k + HALF]];
            }
            let known = self.carry(&mut pair, k + 1 == HALF);
            for i in 0..7 {
                next[i][k + 1] = pair[i][0];
                next[i][(k + HALF + 1) % COLUMNS] = pair[i][1];
            }
            for i in 0..KNOWN {
                let [a, b] = known[i];
                sums[k % 2][i] = sums[k % 2][i] + a.mul_add(a, b * b);
            }
        }
        let [even, odd] = sums;
        let mut squares = even;
        for i in 0..KNOWN {
            squares[i] = even[i] + odd[i];
        }
        squares
    }
}

/// [`square`] of a row whose parts have been permuted.
#[inline(always)]
fn square_permuted<L: Lane>(row: &[L; COLUMNS]) -> L {
    let [last, a, b, c, d, e, f, g] = *row;
    square(&[a, b, c, d, e, f, g, last])
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
    fn add_location<const N: usize>(&self, bounced: &Bounced<L>, rows: &mut Rows<L, N>) {
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

    /// Adds the rounding of the stored state and of the impact law's inputs, each in its own
    /// column, where the columns are shifted by so many.
    #[inline(always)]
    fn add(&self, map: &BounceMap<L>, rows: &mut Rows<L, COLUMNS>, shift: usize) {
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
