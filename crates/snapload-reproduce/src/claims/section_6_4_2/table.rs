//! Table 6.2 with the neighbours of each entry.

use crate::claims::numbers::{range, spearman};
use crate::claims::runs::{chapter, ensemble, of_all};
use crate::claims::verdict::Verdict;
use crate::study::{CriticalRow, Study, first_exceeding};
use rayon::prelude::*;
use snapload::analysis::ForceScan;
use snapload::{CaseError, Outcome, Parameters, Stop, natural_inertia};

/// Neighbours of an entry.
pub(super) const NEIGHBOURS: usize = 4;
/// The rank of a case that never exceeds: above all that do.
pub(super) const NEVER: f64 = 9.0;
/// Two amplitudes of the scan are equal within this.
pub(super) const SAME: f64 = 0.005;

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
        let parameters = chapter(row.parameters());
        let all = ensemble(&parameters, NEIGHBOURS);
        let first = row.computed.chapter.first.map(|x| (x.f_o, x.reason));
        let others = all
            .par_iter()
            .skip(1)
            .map(|member| first_exceeding(member, ForceScan::default()))
            .collect::<Result<Vec<_>, CaseError>>()?;
        let members: Vec<Option<(f64, Stop)>> = std::iter::once(first).chain(others).collect();
        let (_, largest) = range(members.iter().map(|found| rank(found.map(|x| x.0))));
        let smaller = largest < row.published - SAME && exceed(&all, largest)?.iter().all(|x| *x);
        Ok(Self {
            row,
            members,
            at_published: exceed(&all, row.published)?,
            smaller_exceeds: smaller,
        })
    }

    /// f_cr of every member.
    pub(super) fn critical(&self) -> impl Iterator<Item = f64> {
        self.members.iter().map(|found| rank(found.map(|x| x.0)))
    }

    /// f_cr of the case itself.
    pub(super) fn own(&self) -> f64 {
        self.critical().next().unwrap_or(NEVER)
    }

    /// Whether the published amplitude exceeds from no start.
    pub(super) fn settles_at_published(&self) -> bool {
        self.at_published.iter().all(|exceeds| !exceeds)
    }

    /// Whether the published value is that of all members, of none for a reason that is sure, or open.
    pub(super) fn verdict(&self) -> Verdict {
        let published = self.row.published;
        let equal = |f_cr: f64| (f_cr - published).abs() < SAME;
        let all: Vec<f64> = self.critical().collect();
        if all.iter().all(|f| equal(*f)) {
            return Verdict::Reproduced;
        }
        let sure = self.settles_at_published() || self.smaller_exceeds;
        if all.iter().all(|f| !equal(*f)) && sure {
            Verdict::NotReproduced
        } else {
            Verdict::NotDecidable
        }
    }

    /// f_cr over the starts, in words.
    pub(super) fn text(&self) -> String {
        let (low, high) = range(self.critical());
        if high - low < SAME {
            shown(low)
        } else {
            format!("{}-{}", shown(low), shown(high))
        }
    }
}

/// Which members of an ensemble exceed at an amplitude.
fn exceed(members: &[Parameters], f_o: f64) -> Result<Vec<bool>, CaseError> {
    let cases: Vec<Parameters> = members.iter().map(|m| Parameters { f_o, ..*m }).collect();
    of_all(&cases, |case| Outcome::of(&case).exceeds())
}

pub(super) fn rank(f_cr: Option<f64>) -> f64 {
    f_cr.unwrap_or(NEVER)
}

pub(super) fn shown(f_cr: f64) -> String {
    if f_cr < NEVER {
        format!("{f_cr:.2}")
    } else {
        "none".to_owned()
    }
}

/// Table 6.2 with the neighbours of each entry.
pub(super) struct Table<'a> {
    pub(super) entries: Vec<Entry<'a>>,
}

/// A value for each entry of the table.
pub(super) type Column = Vec<f64>;

impl<'a> Table<'a> {
    pub(super) fn new(study: &'a Study) -> Result<Self, CaseError> {
        let entries = study.critical.par_iter().map(Entry::new);
        Ok(Self {
            entries: entries.collect::<Result<_, _>>()?,
        })
    }

    /// The critical forces by member of the ensembles.
    pub(super) fn columns(&self) -> Vec<Column> {
        let by_entry: Vec<Column> = self
            .entries
            .iter()
            .map(|e| e.critical().collect())
            .collect();
        (0..=NEIGHBOURS)
            .map(|k| {
                by_entry
                    .iter()
                    .filter_map(|all| all.get(k).copied())
                    .collect()
            })
            .collect()
    }

    pub(super) fn published(&self) -> Column {
        self.entries.iter().map(|e| e.row.published).collect()
    }

    /// The value of a column for one shape.
    fn value(&self, column: &Column, r: f64, [a, b]: [f64; 2]) -> f64 {
        let of_shape = |e: &Entry| e.row.r == r && e.row.size == [a, b];
        let place = self.entries.iter().position(of_shape);
        place.and_then(|k| column.get(k).copied()).unwrap_or(NEVER)
    }

    pub(super) fn entry(&self, r: f64, size: [f64; 2]) -> Option<&Entry<'a>> {
        self.entries
            .iter()
            .find(|e| e.row.r == r && e.row.size == size)
    }

    /// How many of the twelve steps to the next larger size of a family raise the critical force.
    pub(super) fn rising(&self, column: &Column) -> usize {
        let families = [
            [[0.1, 0.0], [0.2, 0.0], [0.3, 0.0]],
            [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]],
            [[0.1, 0.1], [0.2, 0.1], [0.3, 0.1]],
        ];
        [1.5, 2.5]
            .iter()
            .flat_map(|r| families.iter().map(move |sizes| (*r, sizes)))
            .flat_map(|(r, sizes)| sizes.windows(2).map(move |pair| (r, pair)))
            .filter(|(r, pair)| {
                let value = |k: usize| {
                    pair.get(k)
                        .map_or(NEVER, |size| self.value(column, *r, *size))
                };
                value(1) > value(0) + SAME
            })
            .count()
    }

    /// Rank correlation with the moment of inertia, by cable length.
    pub(super) fn with_inertia(&self, column: &Column) -> [f64; 2] {
        [1.5, 2.5].map(|r| {
            let of_length = self
                .entries
                .iter()
                .zip(column)
                .filter(|(e, _)| e.row.r == r);
            let points: Vec<(f64, f64)> = of_length
                .filter_map(|(e, f)| Some((natural_inertia(e.row.size[0], e.row.size[1])?, *f)))
                .collect();
            spearman(&points)
        })
    }

    /// How many of the eight shapes have a lower value with the longer cables.
    pub(super) fn lower_when_long(&self, column: &Column) -> usize {
        let short = self.entries.iter().filter(|e| e.row.r == 1.5);
        short
            .map(|e| e.row.size)
            .filter(|size| self.value(column, 2.5, *size) < self.value(column, 1.5, *size) - SAME)
            .count()
    }

    /// In how many of the ten pairs of one width the circle has the lower value.
    pub(super) fn circle_lower(&self, column: &Column) -> usize {
        let boxes = self.entries.iter().filter(|e| e.row.size[1] > 0.0);
        boxes
            .filter(|e| {
                let [a, b] = e.row.size;
                self.value(column, e.row.r, [a, 0.0]) < self.value(column, e.row.r, [a, b]) - SAME
            })
            .count()
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
