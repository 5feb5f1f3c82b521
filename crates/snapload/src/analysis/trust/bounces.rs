//! The spread of neighbours through a bounce, of one run or of several side by side in the lanes of
//! the processor.
//!
//! The effect of a bounce on deviations is [`BounceMap`], and its rounding [`BounceRounding`].
//! Whether neighbours may have other events than the run is decided in
//! [`crate::analysis::trust::bounce_reach`].

use crate::analysis::trust::bounce_reach::{AtStart, OpenCable, Reach, SAFE};
use crate::analysis::trust::bounce_rounding::BounceRounding;
use crate::analysis::trust::covariance::seven_of_both;
use crate::analysis::trust::parts::{COLUMNS, FactorParts, LAST, square, squares};
use crate::arithmetic::lane::{Lane, Mask};
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
        self.rounding(bounced).add_location(bounced, &mut rows);
        let along = rows;
        map.meet(&mut rows);
        [along, rows]
    }

    /// The rounding of a bounce, with the signs of the step.
    #[inline(always)]
    fn rounding(&self, bounced: &Bounced<L>) -> BounceRounding<L> {
        BounceRounding::of(bounced, self.slant).with_signs(self.parts.signs())
    }

    /// Carries the parts through a bounce, to `next`.
    #[inline(always)]
    pub(super) fn carry(
        &self,
        next: &mut Self,
        bounced: &Bounced<L>,
        map: &BounceMap<L>,
    ) -> Through<L> {
        let rounding = self.rounding(bounced);
        let columns = Columns::of(bounced, map, &rounding);
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
        let start = columns.start(&squares);
        columns.judge(start, &squares, velocities_after, self.tolerance)
    }
}

impl Followed<f64> {
    /// Carries the parts through a bounce, to `next`, with its rounding added up exactly. There
    /// have to be seven parts: the error of the impact's location is put into the eighth column.
    /// The other roundings are parts of their own, and all are combined to seven at the end.
    #[inline(always)]
    pub(super) fn carry_exactly(
        &self,
        next: &mut Self,
        bounced: &Bounced<f64>,
        map: &BounceMap<f64>,
    ) -> Through<f64> {
        let rounding = BounceRounding::of(bounced, self.slant);
        let columns = Columns::of(bounced, map, &rounding);
        let before = self.parts.rows;
        debug_assert!(before.iter().all(|row| row[LAST] == 0.0));
        let mut rows = before;
        let squares = squares(&columns.carry(&mut rows, true));
        let mut start = columns.start(&squares);
        if let Some(nearer) = OpenCable::nearer(bounced) {
            let [x, y, theta, ..] = squares;
            let along = square(&nearer.along(&before));
            start = start.with_open(&AtStart::of(bounced, &nearer, [x, y, theta], along));
        }
        let mut more = [[0.0; COLUMNS]; 7];
        rounding.add(map, &mut more, 0);
        let rows = seven_of_both(&rows, &more);
        let after = [square(&rows[3]), square(&rows[4]), square(&rows[5])];
        *next = Self {
            parts: self.parts.with(rows),
            ..*self
        };
        columns.judge(start, &squares, after, self.tolerance)
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
    open: OpenCable<L>,
}

impl<'a, 'b, L: Lane> Columns<'a, 'b, L> {
    #[inline(always)]
    fn of(
        bounced: &'a Bounced<'b, L>,
        map: &'a BounceMap<L>,
        rounding: &'a BounceRounding<L>,
    ) -> Self {
        Self {
            bounced,
            map,
            rounding,
            open: OpenCable::of(bounced),
        }
    }

    /// Carries some of the columns, except for the rounding after the impact; `located` says
    /// whether the last of them contains the error of the impact's location.
    #[inline(always)]
    fn carry<const N: usize>(&self, rows: &mut Rows<L, N>, located: bool) -> [[L; N]; KNOWN] {
        let [x, y, theta, ..] = *rows;
        let along_open = self.open.along(rows);
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

    /// How far neighbours reach at the start, given the squares of what is known of them.
    #[inline(always)]
    fn start(&self, [x, y, theta, along_open, ..]: &[L; KNOWN]) -> AtStart<L> {
        AtStart::of(self.bounced, &self.open, [*x, *y, *theta], *along_open)
    }

    /// Whether it is certain that all neighbours have this bounce, given the squares of what is
    /// known of them and of their velocities after it.
    #[inline(always)]
    fn judge(
        &self,
        start: AtStart<L>,
        squares: &[L; KNOWN],
        velocities_after: [L; 3],
        tolerance: L,
    ) -> Through<L> {
        let [_, _, _, _, rest @ ..] = *squares;
        let [met @ .., later, closing, along_other, at_end] = rest;
        let reach = Reach::of(
            self.bounced,
            start,
            met,
            [later, closing],
            [along_other, at_end],
        );
        let known = reach.error(velocities_after, self.rounding.place_squared()) * SAFE;
        let within_tolerance = known.below(tolerance * tolerance)
            & reach.meets_all(self.bounced)
            & reach.leaves_the_other_open(self.bounced)
            & reach.rises_once(self.bounced)
            & reach.reaches_no_limit(self.bounced);
        Through {
            met,
            within_tolerance,
        }
    }
}

/// [`square`] of a row whose parts have been permuted.
#[inline(always)]
fn square_permuted<L: Lane>(row: &[L; COLUMNS]) -> L {
    let [last, a, b, c, d, e, f, g] = *row;
    square(&[a, b, c, d, e, f, g, last])
}
