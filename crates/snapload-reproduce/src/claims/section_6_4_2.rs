//! Section 6.4.2: the critical force.

mod curves;

use super::tools::{Finding, ensemble, first_exceeding, judged, range, robust, spearman};
use super::{Claim, Verdict};
use crate::study::{CriticalRow, Reading, Study};
use rayon::prelude::*;
use snapload::analysis::{ForceScan, Outcome};
use snapload::{Case, CaseError, Parameters, Stop, anchor_height, natural_inertia};

/// Neighbours of an entry of Table 6.2, and of a point of a curve.
const NEIGHBOURS: [usize; 2] = [4, 3];
/// The rank of a case that never exceeds: above all that do.
const NEVER: f64 = 9.0;
/// Two amplitudes of the scan are equal within this.
const SAME: f64 = 0.005;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let table = Table::new(study)?;
    let mut all = of_table(&table);
    all.extend(of_standard_case(study, &table));
    all.extend(curves::claims(study)?);
    all.push(judged(
        "6.4.2-17",
        "As the cables grow from r = 1.5 to 2.5 the critical force of the standard case falls from \
         0.31 to 0.10.",
        over_cable_length(&table)?,
        "Other values at the ends.",
    ));
    all.sort_by_key(|claim| claim.id);
    Ok(all)
}

/// An entry of Table 6.2 with its neighbours.
struct Entry<'a> {
    row: &'a CriticalRow,
    /// f_cr and its reason, the case itself first.
    members: Vec<Option<(f64, Stop)>>,
    /// Whether the published amplitude exceeds.
    at_published: Vec<bool>,
    /// Whether there is one amplitude below the published one that exceeds from all starts.
    smaller_exceeds: bool,
}

impl<'a> Entry<'a> {
    fn new(row: &'a CriticalRow) -> Result<Self, CaseError> {
        let [a, b] = row.size;
        let parameters = Reading::Chapter.apply(Parameters {
            r: row.r,
            a,
            b,
            inertia: natural_inertia(a, b),
            ..Parameters::STANDARD
        });
        let all = ensemble(&parameters, NEIGHBOURS[0]);
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
    fn critical(&self) -> impl Iterator<Item = f64> {
        self.members.iter().map(|found| rank(found.map(|x| x.0)))
    }

    /// Whether the published value is that of all members, of none for a reason that is sure, or open.
    fn verdict(&self) -> Verdict {
        let published = self.row.published;
        let equal = |f_cr: f64| (f_cr - published).abs() < SAME;
        let all: Vec<f64> = self.critical().collect();
        if all.iter().all(|f| equal(*f)) {
            return Verdict::Reproduced;
        }
        let settles = self.at_published.iter().all(|exceeds| !exceeds);
        if all.iter().all(|f| !equal(*f)) && (settles || self.smaller_exceeds) {
            Verdict::NotReproduced
        } else {
            Verdict::NotDecidable
        }
    }

    fn text(&self) -> String {
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
    members
        .par_iter()
        .map(|member| Ok(Outcome::of(&Case::new(Parameters { f_o, ..*member })?).exceeds()))
        .collect()
}

fn rank(f_cr: Option<f64>) -> f64 {
    f_cr.unwrap_or(NEVER)
}

fn shown(f_cr: f64) -> String {
    if f_cr < NEVER {
        format!("{f_cr:.2}")
    } else {
        "none".to_owned()
    }
}

/// Table 6.2 with the neighbours of each entry.
struct Table<'a> {
    entries: Vec<Entry<'a>>,
}

/// A value for each entry of the table.
type Column = Vec<f64>;

impl<'a> Table<'a> {
    fn new(study: &'a Study) -> Result<Self, CaseError> {
        let entries = study.critical.par_iter().map(Entry::new);
        Ok(Self {
            entries: entries.collect::<Result<_, _>>()?,
        })
    }

    /// The critical forces by member of the ensembles.
    fn columns(&self) -> Vec<Column> {
        let by_entry: Vec<Column> = self
            .entries
            .iter()
            .map(|e| e.critical().collect())
            .collect();
        (0..=NEIGHBOURS[0])
            .map(|k| {
                by_entry
                    .iter()
                    .filter_map(|all| all.get(k).copied())
                    .collect()
            })
            .collect()
    }

    fn published(&self) -> Column {
        self.entries.iter().map(|e| e.row.published).collect()
    }

    /// The value of a column for one shape.
    fn value(&self, column: &Column, r: f64, [a, b]: [f64; 2]) -> f64 {
        let of_shape = |e: &Entry| e.row.r == r && e.row.size == [a, b];
        let place = self.entries.iter().position(of_shape);
        place.and_then(|k| column.get(k).copied()).unwrap_or(NEVER)
    }

    fn entry(&self, r: f64, size: [f64; 2]) -> Option<&Entry<'a>> {
        self.entries
            .iter()
            .find(|e| e.row.r == r && e.row.size == size)
    }

    /// How many of the twelve steps to the next larger size of a family raise the critical force.
    fn rising(&self, column: &Column) -> usize {
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
    fn with_inertia(&self, column: &Column) -> [f64; 2] {
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
    fn lower_when_long(&self, column: &Column) -> usize {
        let short = self.entries.iter().filter(|e| e.row.r == 1.5);
        short
            .map(|e| e.row.size)
            .filter(|size| self.value(column, 2.5, *size) < self.value(column, 1.5, *size) - SAME)
            .count()
    }

    /// In how many of the ten pairs of one width the circle has the lower value.
    fn circle_lower(&self, column: &Column) -> usize {
        let boxes = self.entries.iter().filter(|e| e.row.size[1] > 0.0);
        boxes
            .filter(|e| {
                let [a, b] = e.row.size;
                self.value(column, e.row.r, [a, 0.0]) < self.value(column, e.row.r, [a, b]) - SAME
            })
            .count()
    }
}

/// Judges a count in all columns, with the least and greatest count and the published one.
fn counted(table: &Table, of: usize, least: usize, count: impl Fn(&Column) -> usize) -> Finding {
    let counts: Vec<usize> = table.columns().iter().map(&count).collect();
    let low = counts.iter().min().copied().unwrap_or(0);
    let high = counts.iter().max().copied().unwrap_or(0);
    let published = count(&table.published());
    let span = if low == high {
        low.to_string()
    } else {
        format!("{low} to {high}")
    };
    let evidence = format!("{span} of {of} by start; published values: {published}");
    (robust(counts.iter().map(|n| *n >= least)), evidence)
}

fn of_table(table: &Table) -> Vec<Claim> {
    vec![
        judged(
            "6.4.2-01",
            "What decides the critical force of the rigid body is the rotation limit, not the upper \
             boundary.",
            reasons(table),
            "Above the critical force the upper bound comes first in many cases; for the circles it \
             is the rotation always.",
        ),
        judged(
            "6.4.2-02",
            "The sixteen critical forces of Table 6.2.",
            values(table),
            "Some published values exceed but are not the first to; the small squares settle at the \
             published values from every start: another inertia or \
             geometry of squares, or a slip.",
        ),
        judged(
            "6.4.2-03",
            "As a rule the critical force grows with size and moment of inertia.",
            growth(table),
            "It holds of the published numbers, which differ most from ours for the small squares.",
        ),
        judged(
            "6.4.2-04",
            "The published table has exceptions to that growth.",
            exceptions(table),
            "",
        ),
        judged(
            "6.4.2-05",
            "Critical forces are lower at r = 2.5 than at r = 1.5.",
            counted(table, 8, 7, |column| table.lower_when_long(column)),
            "Not so for too many shapes.",
        ),
        judged(
            "6.4.2-06",
            "Circles have lower critical forces than squares and rectangles.",
            counted(table, 10, 10, |column| table.circle_lower(column)),
            "Clear at r = 1.5; at r = 2.5 single entries hang on the last digits of the start. The \
             published table breaks the rule once itself.",
        ),
    ]
}

fn reasons(table: &Table) -> Finding {
    let mut sure = 0;
    let mut open = Vec::new();
    for entry in &table.entries {
        let found = entry.members.iter().flatten();
        let rotated = found.filter(|x| x.1 == Stop::RotationLimit).count();
        if rotated == entry.members.len() {
            sure += 1;
        } else {
            let (r, [a, b]) = (entry.row.r, entry.row.size);
            let members = entry.members.len();
            open.push((
                rotated,
                format!("r {r}, {a} x {b}: {rotated} of {members} starts"),
            ));
        }
    }
    let verdict = match open.iter().all(|(rotated, _)| *rotated == 0) {
        false => Verdict::NotDecidable,
        true => Verdict::of(open.is_empty()),
    };
    let others: Vec<String> = open.into_iter().map(|(_, text)| text).collect();
    let others = others.join("; ");
    (
        verdict,
        format!("by rotation from all starts in {sure} of 16 ({others})"),
    )
}

fn values(table: &Table) -> Finding {
    let verdicts: Vec<Verdict> = table.entries.iter().map(Entry::verdict).collect();
    let count = |which| verdicts.iter().filter(|v| **v == which).count();
    let (yes, no) = (count(Verdict::Reproduced), count(Verdict::NotReproduced));
    let open = count(Verdict::NotDecidable);
    let verdict = match (yes == verdicts.len(), no > 0) {
        (true, _) => Verdict::Reproduced,
        (_, true) => Verdict::NotReproduced,
        _ => Verdict::NotDecidable,
    };
    let texts: Vec<String> = table
        .entries
        .iter()
        .map(|e| format!("{} ({:.2})", e.text(), e.row.published))
        .collect();
    let settled = |e: &&Entry| e.at_published.iter().all(|exceeds| !exceeds);
    let settled = table.entries.iter().filter(settled).count();
    let evidence = format!(
        "computed (published): {}; {yes} agree, {open} open, {no} differ; {settled} published values \
         do not exceed from any start",
        texts.join(", ")
    );
    (verdict, evidence)
}

fn growth(table: &Table) -> Finding {
    let holds = |column: &Column| {
        table.rising(column) > 6 && table.with_inertia(column).iter().all(|rho| *rho > 0.0)
    };
    let columns = table.columns();
    let text = |column: &Column| {
        let [short, long] = table.with_inertia(column);
        let rising = table.rising(column);
        format!("{rising} of 12 steps rise, rank correlation with I {short:.2} and {long:.2}")
    };
    let computed = columns.first().map(text).unwrap_or_default();
    let published = text(&table.published());
    (
        robust(columns.iter().map(holds)),
        format!("{computed}; published values: {published}"),
    )
}

fn exceptions(table: &Table) -> Finding {
    let not_rising = 12 - table.rising(&table.published());
    let evidence = format!("{not_rising} of 12 steps of the published values do not rise");
    (Verdict::of(not_rising > 0), evidence)
}

fn of_standard_case(study: &Study, table: &Table) -> Vec<Claim> {
    vec![
        judged(
            "6.4.2-07",
            "At e = 0.9, Ω = 0.9, r = 1.5 the critical force is about 0.31 (Figs 6.27, 6.28).",
            standard(table, 1.5, 0.31),
            "Another value.",
        ),
        judged(
            "6.4.2-08",
            "For r = 2.5 it is about 0.10 (Figs 6.29, 6.30).",
            standard(table, 2.5, 0.10),
            "Another value.",
        ),
        judged(
            "6.4.2-09",
            "Above 0.31 the standard case may exceed the limits, but need not.",
            may_exceed(study),
            "",
        ),
        judged("6.4.2-10", "The body has more room at r = 2.5.", room(), ""),
    ]
}

fn standard(table: &Table, r: f64, published: f64) -> Finding {
    let Some(entry) = table.entry(r, [0.1, 0.0]) else {
        return (Verdict::NotReproduced, "no such entry".to_owned());
    };
    let slides_on = rank(entry.row.computed.sliding_on.first.map(|x| x.f_o));
    let all = entry.critical().chain([slides_on]);
    let verdict = robust(all.map(|f_cr| (f_cr - published).abs() < SAME));
    let members = entry.members.len();
    let (text, slides_on) = (entry.text(), shown(slides_on));
    (
        verdict,
        format!("{text} from {members} starts; {slides_on} where sliding goes on"),
    )
}

fn may_exceed(study: &Study) -> Finding {
    let Some(row) = study.critical.first() else {
        return (Verdict::NotReproduced, "no entry".to_owned());
    };
    let found = &row.computed.chapter;
    let first = rank(found.first.map(|x| x.f_o));
    let count = |[from, to]: &[f64; 2]| ((to - from) * 100.0).round() as usize + 1;
    let exceed: usize = found.exceeding.iter().map(count).sum();
    let holds = (first - 0.31).abs() < SAME && (1..70).contains(&exceed);
    let evidence = format!(
        "the first is {}; {exceed} of the 70 amplitudes 0.31 to 1.00",
        shown(first)
    );
    (Verdict::of(holds), evidence)
}

fn room() -> Finding {
    let area = |r: f64| {
        let (a, steps) = (0.1, 20_000);
        let h = anchor_height(r, a);
        let width = |k: i32| {
            let below = h * (f64::from(k) + 0.5) / f64::from(steps);
            2.0 * ((r * r - below * below).sqrt() - (1.0 - a))
        };
        (0..steps).map(width).sum::<f64>() * h / f64::from(steps)
    };
    let (short, long) = (area(1.5), area(2.5));
    let evidence = format!("area at θ = 0: {short:.3} (r = 1.5), {long:.3} (r = 2.5)");
    (Verdict::of(long > short), evidence)
}

fn over_cable_length(table: &Table) -> Result<Finding, CaseError> {
    let between = [1.75, 2.0, 2.25]
        .into_par_iter()
        .map(|r| {
            let case = Reading::Chapter.apply(Parameters {
                r,
                ..Parameters::STANDARD
            });
            let found = first_exceeding(&case, ForceScan::default())?;
            Ok(shown(rank(found.map(|x| x.0))))
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let ends = [standard(table, 1.5, 0.31), standard(table, 2.5, 0.10)];
    let holds = ends.iter().all(|end| end.0 == Verdict::Reproduced);
    let at = |r| {
        table
            .entry(r, [0.1, 0.0])
            .map(Entry::text)
            .unwrap_or_default()
    };
    let (first, last, between) = (at(1.5), at(2.5), between.join(", "));
    let evidence = format!("{first}, {between}, {last} at r = 1.5, 1.75, 2, 2.25, 2.5");
    Ok((Verdict::of(holds), evidence))
}
