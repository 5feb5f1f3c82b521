//! Table 6.2 with the neighbours of each entry.

use crate::ReportError;
use crate::claims::numbers::{max, min, spearman};
use crate::claims::runs::{NEVER, SAME, chapter, each, ensemble, outcome, shown};
use crate::claims::verdict::Verdict;
use crate::study::{CriticalRow, Study, first_exceeding};
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{CaseError, Parameters, Stop, natural_inertia};

/// Neighbours of an entry.
const NEIGHBOURS: usize = 4;

/// An entry of Table 6.2 with its neighbours.
pub(super) struct Entry<'a> {
    pub(super) row: &'a CriticalRow,
    /// f_cr and its reason, the case itself first.
    pub(super) members: Vec<Option<(f64, Stop)>>,
    /// Whether the published amplitude exceeds.
    at_published: Vec<bool>,
    /// Whether there is one amplitude below the published one that exceeds from all starts.
    smaller_exceeds: bool,
}

impl<'a> Entry<'a> {
    fn new(row: &'a CriticalRow) -> Result<Self, CaseError> {
        let all = ensemble(&chapter(row.parameters()), NEIGHBOURS);
        let first = row.computed.chapter.first.map(|x| (x.f_o, x.reason));
        let others = each(&all[1..], |member| {
            first_exceeding(member, ForceScan::default())
        })?;
        let mut entry = Self {
            row,
            members: [vec![first], others].concat(),
            at_published: exceed(&all, row.published)?,
            smaller_exceeds: false,
        };
        let largest = max(entry.critical());
        entry.smaller_exceeds =
            largest < row.published - SAME && exceed(&all, largest)?.iter().all(|exceeds| *exceeds);
        Ok(entry)
    }

    pub(super) fn name(&self) -> String {
        let (r, [a, b]) = (self.row.r, self.row.size);
        format!("r = {r}, {a} x {b}")
    }

    /// f_cr of every member.
    pub(super) fn critical(&self) -> impl Iterator<Item = f64> {
        let members = self.members.iter();
        members.map(|found| found.map_or(NEVER, |x| x.0))
    }

    /// f_cr of the case itself.
    pub(super) fn own(&self) -> f64 {
        self.critical().next().unwrap_or(NEVER)
    }

    /// Whether the published amplitude exceeds from no start.
    pub(super) fn settles_at_published(&self) -> bool {
        self.at_published.iter().all(|exceeds| !exceeds)
    }

    /// Whether the published value is that of all members, of none for a reason that is sure, or
    /// open.
    pub(super) fn verdict(&self) -> Verdict {
        let equal = |f_cr: f64| (f_cr - self.row.published).abs() < SAME;
        let sure = self.settles_at_published() || self.smaller_exceeds;
        match Verdict::robust(self.critical().map(equal)) {
            Verdict::NotReproduced if !sure => Verdict::NotDecidable,
            verdict => verdict,
        }
    }

    /// f_cr over the starts, in words.
    pub(super) fn text(&self) -> String {
        let (low, high) = (min(self.critical()), max(self.critical()));
        if high - low < SAME {
            shown(low)
        } else {
            format!("{}-{}", shown(low), shown(high))
        }
    }
}

/// Which members of an ensemble exceed at an amplitude.
fn exceed(members: &[Parameters], f_o: f64) -> Result<Vec<bool>, CaseError> {
    each(members, |member| {
        Ok(outcome(&Parameters { f_o, ..*member })?.exceeds())
    })
}

/// A value for each entry of the table.
pub(super) type Column = Vec<f64>;

/// Table 6.2 with the neighbours of each entry.
pub(super) struct Table<'a> {
    pub(super) entries: Vec<Entry<'a>>,
    /// The critical forces by member of the ensembles, and the published ones.
    pub(super) columns: Vec<Column>,
    pub(super) published: Column,
}

impl<'a> Table<'a> {
    pub(super) fn new(study: &'a Study) -> Result<Self, CaseError> {
        let entries = in_parallel(study.critical.len(), |k| Entry::new(&study.critical[k]))?;
        let of_start = |k| entries.iter().filter_map(|e| e.critical().nth(k)).collect();
        Ok(Self {
            columns: (0..=NEIGHBOURS).map(of_start).collect(),
            published: entries.iter().map(|e| e.row.published).collect(),
            entries,
        })
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
    use crate::study::Both;
    use snapload::analysis::{CriticalForce, ExceedanceCurve, unwatched};

    /// The standard case as a row that publishes this value, from few amplitudes.
    fn row(published: f64) -> Result<CriticalRow, CaseError> {
        let force = ForceScan::new(0.01, 0.4)?;
        let scan = || {
            let found = CriticalForce::scan(&chapter(Parameters::STANDARD), force, &unwatched);
            found.map_err(|_| CaseError::value("f_o", "", "a legal case"))
        };
        let none = || ExceedanceCurve { points: Vec::new() };
        Ok(CriticalRow {
            r: 1.5,
            shape: "circle",
            size: [0.1, 0.0],
            published,
            computed: Both {
                chapter: scan()?,
                sliding_on: scan()?,
            },
            probable: Both {
                chapter: none(),
                sliding_on: none(),
            },
        })
    }

    #[test]
    fn an_altered_published_value_is_not_reproduced() -> Result<(), CaseError> {
        assert_eq!(Entry::new(&row(0.31)?)?.verdict(), Verdict::Reproduced);
        // One that settles, and one that exceeds though it is not the first.
        for published in [0.25, 0.33] {
            let row = row(published)?;
            assert_eq!(Entry::new(&row)?.verdict(), Verdict::NotReproduced);
        }
        Ok(())
    }
}
