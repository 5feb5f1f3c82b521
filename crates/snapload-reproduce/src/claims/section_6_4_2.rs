//! Section 6.4.2: the critical force. The claims on its curves, Figs 6.27-6.30, have a file of
//! their own.

mod curves;
mod table;

use super::numbers::falling;
use super::runs::{FEW, NEVER, SAME, chapter, critical_force, from_starts, shown, standard};
use super::verdict::{Claim, Finding, Judged, Judges, Verdict, ask};
use crate::ReportError;
use crate::study::Study;
use snapload::analysis::in_parallel;
use snapload::{Parameters, Stop, anchor_height, natural_inertia};
use table::{Column, Entry, Table};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let mut all = ask(&[JUDGES], &Table::new(study)?)?;
    all.extend(ask(&[curves::JUDGES], study)?);
    Ok(all)
}

const JUDGES: &Judges<fn(&Table) -> Judged> = &[
    ("6.4.2-01", reasons),
    ("6.4.2-02", values),
    ("6.4.2-03", growth),
    ("6.4.2-04", |table| {
        let exceptions = |column: &Column| STEPS - table.rising(column);
        let counts = table.columns.iter().map(|column| exceptions(column) as f64);
        Ok(Finding::measured("exceptions", counts, |count| count > 0.0)
            .values("steps published", [STEPS, exceptions(&table.published)]))
    }),
    ("6.4.2-05", |table| {
        as_often_as_published(table, Table::lower_when_long)
    }),
    ("6.4.2-06", |table| {
        as_often_as_published(table, Table::circle_lower)
    }),
    ("6.4.2-07", |table| of_standard_case(table, 1.5, 0.31)),
    ("6.4.2-08", |table| of_standard_case(table, 2.5, 0.10)),
    ("6.4.2-09", |table| {
        let found = &table.entry(1.5, [0.1, 0.0])?.row.computed.chapter;
        let first = found.first.map_or(NEVER, |first| first.f_o);
        let count = |[from, to]: &[f64; 2]| ((to - from) * 100.0).round() as usize + 1;
        let exceed: usize = found.exceeding.iter().map(count).sum();
        let finding = Finding::of((first - 0.31).abs() < SAME && (1..70).contains(&exceed));
        Ok(finding.value("first", shown(first)).value("exceed", exceed))
    }),
    ("6.4.2-10", |_| {
        let (short, long) = (area(1.5), area(2.5));
        Ok(Finding::of(long > short).values("short long", [short, long]))
    }),
    ("6.4.2-17", |_| over_cable_length()),
    ("6.4.2-19", connection_points),
];

/// The steps of Table 6.2 to the next larger size of a family.
const STEPS: usize = 12;

fn reasons(table: &Table) -> Judged {
    let rotates = |found: &Option<(f64, Stop)>| matches!(found, Some((_, Stop::RotationLimit)));
    let verdict = |e: &Entry| Verdict::robust(e.members.iter().map(rotates));
    let entries = table.entries.iter();
    let others = entries
        .clone()
        .filter(|e| verdict(e) != Verdict::Reproduced);
    let others = others.map(|e| {
        let by_rotation = e.members.iter().filter(|found| rotates(found)).count();
        format!("{}: {by_rotation} of {} starts", e.name(), e.members.len())
    });
    let others: Vec<String> = others.collect();
    let sure = table.entries.len() - others.len();
    Ok(Finding::new(Verdict::all(entries.map(verdict)))
        .values("sure entries", [sure, table.entries.len()])
        .value("others", others.join("; "))
        .found("sure_of_some", sure > 0))
}

fn values(table: &Table) -> Judged {
    let entries = || table.entries.iter();
    let with = |which| entries().filter(move |e| e.verdict() == which);
    let text = |e: &Entry| format!("{} ({:.2})", e.text(), e.row.published);
    let settled = with(Verdict::NotReproduced).filter(|e| e.settles_at_published());
    let settled: Vec<String> = settled.map(Entry::name).collect();
    let verdicts = [
        Verdict::Reproduced,
        Verdict::NotDecidable,
        Verdict::NotReproduced,
    ];
    let [agree, open, differ] = verdicts.map(|which| with(which).count());
    Ok(Finding::new(Verdict::all(entries().map(Entry::verdict)))
        .value("forces", entries().map(text).collect::<Vec<_>>().join(", "))
        .values(
            "agree open differ smaller",
            [agree, open, differ, differ - settled.len()],
        )
        .found("a_smaller_exceeds", differ > settled.len())
        .found("none_exceeds", !settled.is_empty())
        .value("settled", settled.join("; ")))
}

fn growth(table: &Table) -> Judged {
    let grows = |column: &Column| {
        2 * table.rising(column) > STEPS && table.with_inertia(column).iter().all(|rho| *rho > 0.0)
    };
    let text = |column: &Column| {
        let [short, long] = table.with_inertia(column);
        let rising = table.rising(column);
        format!("{rising} of {STEPS} steps rise, rank correlation with I {short:.2} and {long:.2}")
    };
    let off = |e: &Entry| (e.own() - e.row.published).abs();
    let entries = table.entries.iter();
    let most = entries.max_by(|p, q| off(p).total_cmp(&off(q)));
    Ok(Finding::robust(&table.columns, grows)
        .value("computed", text(&table.columns[0]))
        .value("published", text(&table.published))
        .value("most", most.map(Entry::name).unwrap_or_default())
        .found("of_the_published", grows(&table.published)))
}

/// Judges a tendency by how often it is met in the published table, from which it was read.
fn as_often_as_published<'a>(table: &Table<'a>, count: fn(&Table<'a>, &Column) -> usize) -> Judged {
    let counts = table.columns.iter().map(|of| count(table, of) as f64);
    let published = count(table, &table.published);
    Ok(
        Finding::measured("counts", counts, |count| count >= published as f64)
            .value("published", published),
    )
}

/// The critical force of the standard case with cables of this length.
fn of_standard_case(table: &Table, r: f64, published: f64) -> Judged {
    let entry = table.entry(r, [0.1, 0.0])?;
    let slides_on = entry.row.computed.sliding_on.first.map_or(NEVER, |x| x.f_o);
    let all: Vec<f64> = entry.critical().chain([slides_on]).collect();
    let finding = Finding::robust(&all, |f_cr| (f_cr - published).abs() < SAME);
    Ok(finding
        .value("f_cr", entry.text())
        .value("starts", entry.members.len())
        .value("slides_on", shown(slides_on)))
}

/// The area in which the standard body may be without rotation, down from the anchors' level.
fn area(r: f64) -> f64 {
    let (a, steps) = (Parameters::STANDARD.a, 20_000);
    let h = anchor_height(r, a);
    let width = |k: i32| {
        let below = h * (f64::from(k) + 0.5) / f64::from(steps);
        2.0 * ((r * r - below * below).sqrt() - (1.0 - a))
    };
    (0..steps).map(width).sum::<f64>() * h / f64::from(steps)
}

fn over_cable_length() -> Judged {
    let cases = [1.5, 1.75, 2.0, 2.25, 2.5].map(|r| chapter(standard(|p| p.r = r)));
    let members = from_starts(&cases, FEW, critical_force)?;
    let words = |all: &Vec<f64>| all.iter().map(|f| shown(*f)).collect::<Vec<_>>().join(", ");
    let mut words: Vec<String> = members.iter().map(words).collect();
    words.dedup();
    Ok(Finding::robust(&members, |f_cr| falling(f_cr))
        .value("forces", words.join("; by other starts ")))
}

/// The critical forces by connection points, of the circle and of the square as wide, and by moment
/// of inertia, of a circle and of a square.
fn crossed(table: &Table, r: f64, a: f64) -> Result<[[f64; 2]; 2], ReportError> {
    let own = |b: f64| Ok::<_, ReportError>(table.entry(r, [a, b])?.own());
    let with = |b: f64, inertia: Option<f64>| {
        let values = (r, a, b, inertia);
        critical_force(&chapter(standard(|p| (p.r, p.a, p.b, p.inertia) = values)))
    };
    let (ring, square) = (natural_inertia(a, 0.0), natural_inertia(a, a));
    Ok([[own(0.0)?, with(0.0, square)?], [with(a, ring)?, own(a)?]])
}

fn connection_points(table: &Table) -> Judged {
    let bodies = [1.5, 2.5].map(|r| [0.1, 0.2, 0.3].map(|a| (r, a)));
    let bodies = bodies.as_flattened();
    let found = in_parallel(bodies.len(), |k| crossed(table, bodies[k].0, bodies[k].1))?;
    // Of the pairs that differ in one thing only: in which the circle's has the lower force.
    let count = |lower: fn(&[[f64; 2]; 2], usize) -> bool| {
        let pairs = found.iter().flat_map(|all| [0, 1].map(|k| lower(all, k)));
        pairs.filter(|lower| *lower).count()
    };
    let points = count(|all, k| all[0][k] < all[1][k] - SAME);
    let inertia = count(|all, k| all[k][0] < all[k][1] - SAME);
    let pairs = 2 * found.len();
    Ok(Finding::of(4 * points >= 3 * pairs && points > inertia)
        .values("points inertia pairs", [points, inertia, pairs]))
}
