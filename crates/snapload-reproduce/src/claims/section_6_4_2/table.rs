//! Table 6.2 by its proofs, with the results of neighbours of its runs.

use crate::ReportError;
use crate::claims::numbers::spearman;
use crate::claims::runs::{NEVER, SAME, shown};
use crate::claims::verdict::Verdict;
use crate::critical_row::CriticalRow;
use crate::study::Study;
use snapload::natural_inertia;

/// An entry of Table 6.2.
pub(super) struct Entry<'a> {
    pub(super) row: &'a CriticalRow,
    /// The proved critical force; then the first amplitudes at which 5, 50 and 95 % of the
    /// neighbours exceed.
    pub(super) members: [f64; 4],
}

impl<'a> Entry<'a> {
    fn new(row: &'a CriticalRow) -> Self {
        let first = row.first().map(|(f_o, _)| f_o);
        let passes = [0.05, 0.5, 0.95].map(|part| row.probable.passes(part));
        let [p05, p50, p95] = passes;
        let members = [first, p05, p50, p95].map(|f_o| f_o.unwrap_or(NEVER));
        Self { row, members }
    }

    pub(super) fn name(&self) -> String {
        let (r, [a, b]) = (self.row.r, self.row.size);
        format!("r = {r}, {a} x {b}")
    }

    /// The proved critical force.
    pub(super) fn own(&self) -> f64 {
        self.members[0]
    }

    /// The same in words.
    pub(super) fn text(&self) -> String {
        shown(self.own())
    }

    /// Whether a smaller amplitude than the published one is proved to exceed.
    pub(super) fn smaller_exceeds(&self) -> bool {
        self.own() < self.row.published - SAME
    }

    pub(super) fn verdict(&self) -> Verdict {
        self.row.verdict()
    }
}

/// A value for each entry of the table.
pub(super) type Column = Vec<f64>;

/// The table.
pub(super) struct Table<'a> {
    pub(super) entries: Vec<Entry<'a>>,
    /// The proved critical forces; then the first amplitudes at which parts of the neighbours
    /// exceed.
    pub(super) columns: Vec<Column>,
    pub(super) published: Column,
}

impl<'a> Table<'a> {
    pub(super) fn new(study: &'a Study) -> Self {
        let entries: Vec<Entry> = study.critical.iter().map(Entry::new).collect();
        let column = |k: usize| entries.iter().map(|entry| entry.members[k]).collect();
        Self {
            columns: (0..4).map(column).collect(),
            published: entries.iter().map(|e| e.row.published).collect(),
            entries,
        }
    }

    fn place(&self, r: f64, size: [f64; 2]) -> Option<usize> {
        let mut rows = self.entries.iter().map(|e| e.row);
        rows.position(|row| row.r == r && row.size == size)
    }

    pub(super) fn entry(&self, r: f64, size: [f64; 2]) -> Result<&Entry<'a>, ReportError> {
        let missing = || ReportError::Claim(format!("Table 6.2 has no row r = {r}, {size:?}"));
        let place = self.place(r, size).ok_or_else(missing)?;
        Ok(&self.entries[place])
    }

    /// The value of a column for one shape.
    fn value(&self, column: &Column, r: f64, size: [f64; 2]) -> f64 {
        self.place(r, size).map_or(NEVER, |k| column[k])
    }

    /// How many of the twelve steps to the next larger size of a family raise the critical force.
    pub(super) fn rising(&self, column: &Column) -> usize {
        let families = [
            [[0.1, 0.0], [0.2, 0.0], [0.3, 0.0]],
            [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]],
            [[0.1, 0.1], [0.2, 0.1], [0.3, 0.1]],
        ];
        let rises = |r: f64| {
            let steps = families.iter().flat_map(|sizes| sizes.windows(2));
            let value = |size| self.value(column, r, size);
            let rises = |step: &&[_]| value(step[1]) > value(step[0]) + SAME;
            steps.filter(rises).count()
        };
        rises(1.5) + rises(2.5)
    }

    /// Rank correlation with the moment of inertia, by cable length.
    pub(super) fn with_inertia(&self, column: &Column) -> [f64; 2] {
        [1.5, 2.5].map(|r| {
            let pairs = self.entries.iter().zip(column);
            let points = pairs.filter(|(e, _)| e.row.r == r).filter_map(|(e, f)| {
                let inertia = natural_inertia(e.row.size[0], e.row.size[1]);
                Some((inertia?, *f))
            });
            spearman(&points.collect::<Vec<_>>())
        })
    }

    /// How many of the eight shapes have a lower value with the longer cables.
    pub(super) fn lower_when_long(&self, column: &Column) -> usize {
        let short = self.entries.iter().filter(|e| e.row.r == 1.5);
        let value = |r, e: &Entry| self.value(column, r, e.row.size);
        let lower = |e: &&Entry| value(2.5, e) < value(1.5, e) - SAME;
        short.filter(lower).count()
    }

    /// In how many of the ten pairs of one width the circle has the lower value.
    pub(super) fn circle_lower(&self, column: &Column) -> usize {
        let boxes = self.entries.iter().filter(|e| e.row.size[1] > 0.0);
        let value = |e: &Entry, b: f64| self.value(column, e.row.r, [e.row.size[0], b]);
        let lower = |e: &&Entry| value(e, 0.0) < value(e, e.row.size[1]) - SAME;
        boxes.filter(lower).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::critical_row::NEIGHBOURS;
    use crate::proved::{Proved, amplitudes};
    use crate::study::Both;
    use snapload::analysis::{CriticalForce, ExceedanceCurve, Exceeding, ForceScan, Share};
    use snapload::{CaseError, End, State, Stop};

    /// A row with a published value: proved ends of amplitudes up to 0.4, of which those from 0.31
    /// on exceed, and the numbers of exceeding neighbours at two of them.
    fn row(published: f64, at: [(f64, usize); 2]) -> Result<CriticalRow, CaseError> {
        let none = || CriticalForce {
            first: None,
            exceeding: Vec::new(),
            uncertain: Vec::new(),
            cut_short: Vec::new(),
            up_to: 0.4,
            certain: true,
        };
        let reason = |f_o: f64| match f_o < 0.305 {
            true => Stop::Settled,
            false => Stop::RotationLimit,
        };
        let share = |f_o: f64| {
            let of = NEIGHBOURS as usize;
            let known = at.iter().find(|(force, _)| *force == f_o);
            let count = known.map_or(if f_o < 0.305 { 0 } else { of }, |(_, count)| *count);
            let share = Share {
                count,
                of,
                clear: false,
            };
            let end = End {
                reason: reason(f_o),
                t: 20.0,
                t_limit: None,
                state: State::default(),
            };
            Exceeding {
                f_o,
                end,
                part: share.part(),
                share: Some(share),
                members_cut_short: 0,
            }
        };
        let proof = |f_o: f64| Proved {
            reason: reason(f_o),
            t: "20.0".to_owned(),
            impacts: 9,
        };
        let parameters = crate::reading::published()[0].0;
        let mut proved = amplitudes(&parameters, |case| Some(proof(case.f_o)), published);
        proved.truncate(40);
        Ok(CriticalRow {
            r: 1.5,
            shape: "circle",
            size: [0.1, 0.0],
            published,
            computed: Both {
                chapter: none(),
                sliding_on: none(),
            },
            limits_alone: None,
            probable: ExceedanceCurve {
                points: ForceScan::new(0.01, 0.4)?.amplitudes().map(share).collect(),
            },
            proved,
        })
    }

    #[test]
    fn an_altered_published_value_is_not_reproduced() -> Result<(), CaseError> {
        let agreed = [(0.31, 100), (0.2, 0)];
        assert_eq!(row(0.31, agreed)?.verdict(), Verdict::Reproduced);
        // One amplitude that settles, and one that exceeds although it is not the first.
        for published in [0.25, 0.33] {
            assert_eq!(row(published, agreed)?.verdict(), Verdict::NotReproduced);
        }
        // Five of a hundred neighbours exceed below it, or do not exceed at it, so that nothing is
        // certain.
        for at in [[(0.3, 5), (0.2, 0)], [(0.31, 95), (0.2, 0)]] {
            assert_eq!(row(0.31, at)?.verdict(), Verdict::NotDecidable);
        }
        // It crosses at t = 20, so a run that ends before does not exceed.
        let row = row(0.31, agreed)?;
        assert_eq!(row.first().map(|first| first.0), Some(0.31));
        assert!(row.first_by(18.0).is_none());
        Ok(())
    }
}
