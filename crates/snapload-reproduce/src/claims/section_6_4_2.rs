//! Section 6.4.2: the critical force.

mod curves;
mod table;

use super::numbers::{falling, span};
use super::runs::{FEW, chapter, ensemble};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::{Study, first_exceeding};
use rayon::prelude::*;
use snapload::analysis::ForceScan;
use snapload::{CaseError, Parameters, Stop, anchor_height, natural_inertia};
use table::{Column, Entry, NEVER, SAME, Table, rank, shown};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let table = Table::new(study)?;
    let mut all = of_table(&table);
    all.extend(of_standard_case(study, &table)?);
    all.push(claim(
        "6.4.2-19",
        "Shapes differ in their critical force as their connection points are at different places.",
        connection_points(&table)?,
    ));
    all.extend(curves::claims(study)?);
    Ok(all)
}

fn of_table(table: &Table) -> Vec<Claim> {
    vec![
        claim(
            "6.4.2-01",
            "What decides the critical force of the rigid body is the rotation limit, not the \
             upper boundary.",
            reasons(table),
        ),
        claim(
            "6.4.2-02",
            "The sixteen critical forces of Table 6.2.",
            values(table),
        ),
        claim(
            "6.4.2-03",
            "As a rule the critical force grows with size and moment of inertia.",
            growth(table),
        ),
        claim(
            "6.4.2-04",
            "There are exceptions to that growth.",
            exceptions(table),
        ),
        claim(
            "6.4.2-05",
            "Critical forces tend to be lower at r = 2.5 than at r = 1.5.",
            as_often_as_published(table, 8, |column| table.lower_when_long(column)),
        ),
        claim(
            "6.4.2-06",
            "Circles have lower critical forces than squares and rectangles.",
            as_often_as_published(table, 10, |column| table.circle_lower(column)),
        ),
    ]
}

/// The name of an entry.
fn name(entry: &Entry) -> String {
    let (r, [a, b]) = (entry.row.r, entry.row.size);
    format!("r = {r}, {a} x {b}")
}

fn reasons(table: &Table) -> Finding {
    let rotates = |found: &Option<(f64, Stop)>| matches!(found, Some((_, Stop::RotationLimit)));
    let by_rotation = |e: &Entry| e.members.iter().filter(|found| rotates(found)).count();
    let verdict = |e: &Entry| Verdict::robust(e.members.iter().map(rotates));
    let others = table
        .entries
        .iter()
        .filter(|e| verdict(e) != Verdict::Reproduced);
    let others: Vec<String> = others
        .map(|e| {
            format!(
                "{}: {} of {} starts",
                name(e),
                by_rotation(e),
                e.members.len()
            )
        })
        .collect();
    let sure = table.entries.len() - others.len();
    Finding::new(
        Verdict::all(table.entries.iter().map(verdict)),
        format!(
            "by rotation from all starts in {sure} of {} ({})",
            table.entries.len(),
            others.join("; ")
        ),
    )
    .because(
        Verdict::NotDecidable,
        sure > 0,
        "In the others the last digits of the start decide which limit comes first.",
    )
}

fn values(table: &Table) -> Finding {
    let entries = &table.entries;
    let count = |which| entries.iter().filter(|e| e.verdict() == which).count();
    let (yes, no) = (count(Verdict::Reproduced), count(Verdict::NotReproduced));
    let open = count(Verdict::NotDecidable);
    let texts: Vec<String> = entries
        .iter()
        .map(|e| format!("{} ({:.2})", e.text(), e.row.published))
        .collect();
    let differ = || {
        entries
            .iter()
            .filter(|e| e.verdict() == Verdict::NotReproduced)
    };
    let settled: Vec<String> = differ()
        .filter(|e| e.settles_at_published())
        .map(name)
        .collect();
    let earlier = no - settled.len();
    Finding::new(
        Verdict::all(entries.iter().map(Entry::verdict)),
        format!(
            "computed (published): {}; {yes} agree, {open} open, {no} differ",
            texts.join(", ")
        ),
    )
    .because(
        Verdict::NotReproduced,
        earlier > 0,
        format!("For {earlier} of those that differ a smaller amplitude exceeds already."),
    )
    .because(
        Verdict::NotReproduced,
        !settled.is_empty(),
        format!(
            "At the published values of {} no start exceeds: another inertia or geometry of these \
             bodies, or a slip.",
            settled.join("; ")
        ),
    )
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
    let published = table.published();
    let off = |e: &Entry| (e.own() - e.row.published).abs();
    let most = table
        .entries
        .iter()
        .max_by(|p, q| off(p).total_cmp(&off(q)));
    Finding::new(
        Verdict::robust(columns.iter().map(holds)),
        format!("{computed}; published values: {}", text(&published)),
    )
    .because(
        Verdict::NotReproduced,
        holds(&published),
        format!(
            "It holds of the published numbers, which differ most from ours for {}.",
            most.map(name).unwrap_or_default()
        ),
    )
}

fn exceptions(table: &Table) -> Finding {
    let columns = table.columns();
    let exceptions = |column: &Column| 12 - table.rising(column);
    let counts = columns.iter().map(|column| exceptions(column) as f64);
    Finding::new(
        Verdict::robust(columns.iter().map(|column| exceptions(column) > 0)),
        format!(
            "{} of 12 steps do not rise; of the published values {}",
            span(counts, 0),
            exceptions(&table.published())
        ),
    )
}

/// Judges a tendency by how often it is met in the published table, from which it was read.
fn as_often_as_published(table: &Table, of: usize, count: impl Fn(&Column) -> usize) -> Finding {
    let counts: Vec<usize> = table.columns().iter().map(&count).collect();
    let published = count(&table.published());
    Finding::new(
        Verdict::robust(counts.iter().map(|n| *n >= published)),
        format!(
            "{} of {of} by start; published values: {published}",
            span(counts.iter().map(|n| *n as f64), 0)
        ),
    )
}

fn of_standard_case(study: &Study, table: &Table) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        claim(
            "6.4.2-07",
            "At e = 0.9, Ω = 0.9, r = 1.5 the critical force is about 0.31 (Figs 6.27, 6.28).",
            standard(table, 1.5, 0.31),
        ),
        claim(
            "6.4.2-08",
            "For r = 2.5 it is about 0.10 (Figs 6.29, 6.30).",
            standard(table, 2.5, 0.10),
        ),
        claim(
            "6.4.2-09",
            "Above 0.31 the standard case may exceed the limits, but need not.",
            may_exceed(study),
        ),
        claim("6.4.2-10", "The body has more room at r = 2.5.", room()),
        claim(
            "6.4.2-17",
            "The critical force of the standard case falls as longer cables give it more room.",
            over_cable_length()?,
        ),
    ])
}

fn standard(table: &Table, r: f64, published: f64) -> Finding {
    let Some(entry) = table.entry(r, [0.1, 0.0]) else {
        return Finding::new(Verdict::NotReproduced, "no such entry");
    };
    let slides_on = rank(entry.row.computed.sliding_on.first.map(|x| x.f_o));
    let all = entry.critical().chain([slides_on]);
    Finding::new(
        Verdict::robust(all.map(|f_cr| (f_cr - published).abs() < SAME)),
        format!(
            "{} from {} starts; {} where sliding goes on",
            entry.text(),
            entry.members.len(),
            shown(slides_on)
        ),
    )
}

fn may_exceed(study: &Study) -> Finding {
    let Some(row) = study.critical.first() else {
        return Finding::new(Verdict::NotReproduced, "no entry");
    };
    let found = &row.computed.chapter;
    let first = rank(found.first.map(|x| x.f_o));
    let count = |[from, to]: &[f64; 2]| ((to - from) * 100.0).round() as usize + 1;
    let exceed: usize = found.exceeding.iter().map(count).sum();
    Finding::new(
        Verdict::of((first - 0.31).abs() < SAME && (1..70).contains(&exceed)),
        format!(
            "the first is {}; {exceed} of the 70 amplitudes 0.31 to 1.00",
            shown(first)
        ),
    )
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

fn room() -> Finding {
    let (short, long) = (area(1.5), area(2.5));
    Finding::new(
        Verdict::of(long > short),
        format!("area without rotation: {short:.3} (r = 1.5), {long:.3} (r = 2.5)"),
    )
}

fn over_cable_length() -> Result<Finding, CaseError> {
    let lengths = [1.5, 1.75, 2.0, 2.25, 2.5];
    let of_member = |k: usize| {
        let start = |r: f64| {
            let case = chapter(Parameters {
                r,
                ..Parameters::STANDARD
            });
            ensemble(&case, FEW)[k]
        };
        let found = lengths
            .par_iter()
            .map(|r| first_exceeding(&start(*r), ForceScan::default()))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(found.iter().map(|x| rank(x.map(|x| x.0))).collect())
    };
    let members: Vec<Vec<f64>> = (0..=FEW).map(of_member).collect::<Result<_, CaseError>>()?;
    let words = members
        .iter()
        .map(|all| all.iter().map(|f| shown(*f)).collect::<Vec<_>>().join(", "));
    let mut words: Vec<String> = words.collect();
    words.dedup();
    Ok(Finding::new(
        Verdict::robust(members.iter().map(|f_cr| falling(f_cr))),
        format!(
            "r = 1.5, 1.75, 2, 2.25, 2.5: {}",
            words.join("; by other starts ")
        ),
    ))
}

/// The critical forces by connection points, of the circle and of the square as wide, and by moment of
/// inertia, of a circle and of a square.
fn crossed(table: &Table, r: f64, a: f64) -> Result<[[f64; 2]; 2], CaseError> {
    let own = |b: f64| table.entry(r, [a, b]).map_or(NEVER, Entry::own);
    let with = |b: f64, inertia: Option<f64>| {
        let case = chapter(Parameters {
            r,
            a,
            b,
            inertia,
            ..Parameters::STANDARD
        });
        let found = first_exceeding(&case, ForceScan::default())?;
        Ok(rank(found.map(|x| x.0)))
    };
    let (ring, square) = (natural_inertia(a, 0.0), natural_inertia(a, a));
    Ok([[own(0.0), with(0.0, square)?], [with(a, ring)?, own(a)]])
}

fn connection_points(table: &Table) -> Result<Finding, CaseError> {
    let bodies = [1.5, 2.5]
        .iter()
        .flat_map(|r| [0.1, 0.2, 0.3].map(|a| (*r, a)));
    let bodies: Vec<(f64, f64)> = bodies.collect();
    let found = bodies
        .par_iter()
        .map(|(r, a)| crossed(table, *r, *a))
        .collect::<Result<Vec<_>, CaseError>>()?;
    // Of the twelve pairs that differ in one thing only: in which the circle's has the lower force.
    let by_points = |all: &[[f64; 2]; 2]| [0, 1].map(|k| all[0][k] < all[1][k] - SAME);
    let by_inertia = |all: &[[f64; 2]; 2]| [0, 1].map(|k| all[k][0] < all[k][1] - SAME);
    let points = found
        .iter()
        .flat_map(by_points)
        .filter(|lower| *lower)
        .count();
    let inertia = found
        .iter()
        .flat_map(by_inertia)
        .filter(|lower| *lower)
        .count();
    let of = 2 * found.len();
    Ok(Finding::new(
        Verdict::of(4 * points >= 3 * of && points > inertia),
        format!(
            "at equal inertia the circle's connection points give a lower critical force than the \
             square's in {points} of {of} pairs; at equal points the circle's inertia does in \
             {inertia} of {of}"
        ),
    ))
}
