//! Section 6.4.2: the critical force. The claims on its curves, Figs 6.27-6.30, are in a file of
//! their own.

mod curves;
mod table;

use super::numbers::falling;
use super::runs::{FEW, NEVER, SAME, chapter, critical_force, from_starts, near, shown, standard};
use super::verdict::{Checked, Checks, Claim, Finding, Verdict, run_checks};
use crate::ReportError;
use crate::critical_row::NEIGHBOURS;
use crate::proved::{Proved, over_force};
use crate::study::Study;
use snapload::analysis::in_parallel;
use snapload::{Parameters, Stop, anchor_height, natural_inertia};
use table::{Column, Entry, Table};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let mut all = run_checks(&[CHECKS], &Table::new(study))?;
    all.extend(run_checks(&[curves::CHECKS], study)?);
    Ok(all)
}

const CHECKS: &Checks<fn(&Table) -> Checked> = &[
    ("6.4.2-01", reasons),
    ("6.4.2-02", values),
    ("6.4.2-03", growth),
    ("6.4.2-04", |table| {
        let exceptions = |column: &Column| STEPS - table.rising(column);
        let counts: Vec<usize> = table.columns.iter().map(exceptions).collect();
        Ok(Finding::new(to_the_rule(growth(table)?.verdict, &counts))
            .list("exceptions", counts.iter().map(|count| *count as f64))
            .values("steps published", [STEPS, exceptions(&table.published)])
            .condition("no_rule", growth(table)?.verdict == Verdict::NotReproduced))
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
        let first = table.entry(1.5, [0.1, 0.0])?.own();
        let above = over_force().filter(|(f_o, _)| *f_o > 0.31 - SAME);
        let exceeds = |proved: Option<&Proved>| proved.is_some_and(|p| p.reason.exceeds());
        let above: Vec<bool> = above.map(|(_, proved)| exceeds(proved)).collect();
        let finding = Finding::of((first - 0.31).abs() < SAME && some_but_not_all(&above));
        let exceed = above.iter().filter(|exceeds| **exceeds).count();
        Ok(finding
            .value("first", shown(first))
            .values("exceed all", [exceed, above.len()]))
    }),
    ("6.4.2-10", |_| {
        let (short, long) = (area(1.5), area(2.5));
        Ok(Finding::of(long > short).values("short long", [short, long]))
    }),
    ("6.4.2-17", |_| over_cable_length()),
    ("6.4.2-19", connection_points),
    ("6.4.2-20", published_exceed),
];

/// The number of steps in Table 6.2 to the next larger size of a family.
const STEPS: usize = 12;

/// Whether a statement holds for some but not for all.
fn some_but_not_all(holds: &[bool]) -> bool {
    holds.contains(&true) && holds.contains(&false)
}

/// Whether a rule has exceptions: a rule that does not hold has none.
fn to_the_rule(rule: Verdict, exceptions: &[usize]) -> Verdict {
    let some = Verdict::robust(exceptions.iter().map(|count| *count > 0));
    Verdict::all([rule, some])
}

/// Whether the first amplitude that exceeds does so by rotation, from the proof of each entry.
fn by_rotation(firsts: impl Iterator<Item = Option<Stop>>) -> Verdict {
    let rotates = |stop: Option<Stop>| Verdict::of(stop == Some(Stop::RotationLimit));
    Verdict::families(firsts.map(rotates))
}

fn reasons(table: &Table) -> Checked {
    let firsts = table.entries.iter().map(|e| (e, e.row.first()));
    let firsts: Vec<_> = firsts.collect();
    let stop = |(_, first): &(_, Option<(f64, &Proved)>)| first.map(|(_, proved)| proved.reason);
    let others = firsts
        .iter()
        .filter(|first| stop(first) != Some(Stop::RotationLimit));
    let others = others.map(|(e, first)| {
        let end = |(f_o, proved): (f64, &Proved)| {
            let (reason, t) = (proved.reason.label(), proved.time());
            format!(
                "{}: f_o = {f_o:.2} reaches the {reason} at t = {t:.2}",
                e.name()
            )
        };
        first.map_or_else(
            || format!("{}: no amplitude exceeds the limits", e.name()),
            end,
        )
    });
    let others: Vec<String> = others.collect();
    let entries = table.entries.len();
    Ok(Finding::new(by_rotation(firsts.iter().map(stop)))
        .values("sure entries", [entries - others.len(), entries])
        .value("others", others.join("; ")))
}

fn values(table: &Table) -> Checked {
    let entries = || table.entries.iter();
    let with = |which| entries().filter(move |e| e.verdict() == which);
    let text = |e: &Entry| format!("{} ({:.2})", e.text(), e.row.published);
    let differing = || with(Verdict::NotReproduced);
    let smaller = differing().filter(|e| e.smaller_exceeds()).count();
    let settled: Vec<String> = differing()
        .filter(|e| !e.smaller_exceeds())
        .map(Entry::name)
        .collect();
    let open: Vec<String> = with(Verdict::NotDecidable).map(Entry::name).collect();
    let [agree, differ] = [Verdict::Reproduced, Verdict::NotReproduced].map(|v| with(v).count());
    Ok(
        Finding::new(Verdict::families(entries().map(Entry::verdict)))
            .value("forces", entries().map(text).collect::<Vec<_>>().join(", "))
            .values("agree differ smaller", [agree, differ, smaller])
            .value("neighbours", NEIGHBOURS as usize)
            .values("settled open", [settled.join("; "), open.join("; ")]),
    )
}

/// Whether the published amplitudes are proved to exceed the limits.
fn published_exceed(table: &Table) -> Checked {
    let ends = table
        .entries
        .iter()
        .map(|e| (e, e.row.at_published().map(|proved| proved.reason)));
    let ends: Vec<(&Entry, Option<Stop>)> = ends.collect();
    let exceeds = |(_, stop): &(&Entry, Option<Stop>)| match stop {
        Some(stop) => Verdict::of(stop.exceeds()),
        None => Verdict::NotDecidable,
    };
    let not = ends
        .iter()
        .filter(|end| exceeds(end) != Verdict::Reproduced);
    let not = not.map(|(e, stop)| {
        let words = stop.map_or("open", Stop::label);
        format!("{} at {:.2}: {words}", e.name(), e.row.published)
    });
    let not: Vec<String> = not.collect();
    Ok(Finding::new(Verdict::families(ends.iter().map(exceeds)))
        .values("exceed entries", [ends.len() - not.len(), ends.len()])
        .value("not", not.join("; ")))
}

fn growth(table: &Table) -> Checked {
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
    let words = |columns: &[Column]| columns.iter().map(text).collect::<Vec<_>>().join("; ");
    Ok(Finding::robust(&table.columns, grows)
        .value("computed", text(&table.columns[0]))
        .value("crossings", words(&table.columns[1..]))
        .value("published", text(&table.published))
        .value("most", most.map(Entry::name).unwrap_or_default())
        .condition("of_the_published", grows(&table.published)))
}

/// Checks a tendency by whether it occurs as often as in the published table.
fn as_often_as_published<'a>(
    table: &Table<'a>,
    count: fn(&Table<'a>, &Column) -> usize,
) -> Checked {
    let counts = table.columns.iter().map(|of| count(table, of) as f64);
    let published = count(table, &table.published);
    Ok(
        Finding::measured("counts", counts, |count| count >= published as f64)
            .value("published", published),
    )
}

/// The critical force of the standard case with cables of this length.
fn of_standard_case(table: &Table, r: f64, published: f64) -> Checked {
    let entry = table.entry(r, [0.1, 0.0])?;
    let slides_on = entry.row.computed.sliding_on.first.map_or(NEVER, |x| x.f_o);
    let alone = entry.row.limits_alone.map_or(NEVER, |(f_o, _)| f_o);
    let finding = Finding::robust(&entry.members, |f_cr| (f_cr - published).abs() < SAME);
    let crossings = entry.members[1..].iter().map(|f_o| shown(*f_o));
    Ok(finding
        .value("f_cr", entry.text())
        .value("crossings", crossings.collect::<Vec<_>>().join(", "))
        .values("slides_on alone", [slides_on, alone].map(shown)))
}

/// The area, down from the anchors' level, in which the standard body can be without rotation.
fn area(r: f64) -> f64 {
    let (a, steps) = (Parameters::STANDARD.a, 20_000);
    let h = anchor_height(r, a);
    let width = |k: i32| {
        let below = h * (f64::from(k) + 0.5) / f64::from(steps);
        2.0 * ((r * r - below * below).sqrt() - (1.0 - a))
    };
    (0..steps).map(width).sum::<f64>() * h / f64::from(steps)
}

fn over_cable_length() -> Checked {
    let cases = [1.5, 1.75, 2.0, 2.25, 2.5].map(|r| chapter(standard(|p| p.r = r)));
    let members = from_starts(&cases, FEW, critical_force)?;
    let words = |all: &Vec<f64>| all.iter().map(|f| shown(*f)).collect::<Vec<_>>().join(", ");
    let mut words: Vec<String> = members.iter().map(words).collect();
    words.dedup();
    Ok(Finding::robust(&members, |f_cr| falling(f_cr))
        .value("forces", words.join("; from other starts ")))
}

/// The critical forces by connection points, those of the circle and of the square of the same
/// width, and by moment of inertia, of a circle and of a square.
type Crossed = [[f64; 2]; 2];

/// The critical forces of bodies of a half-width, from each start; the table's own are the proved
/// ones and come first.
fn crossed(table: &Table, r: f64, a: f64) -> Result<Vec<Crossed>, ReportError> {
    let with = |b: f64, inertia: Option<f64>| {
        let values = (r, a, b, inertia);
        let case = chapter(standard(|p| (p.r, p.a, p.b, p.inertia) = values));
        near(&case, FEW, critical_force)
    };
    let own = |b: f64, inertia: Option<f64>| {
        let mut forces = with(b, inertia)?;
        forces[0] = table.entry(r, [a, b])?.own();
        Ok::<_, ReportError>(forces)
    };
    let (ring, square) = (natural_inertia(a, 0.0), natural_inertia(a, a));
    let circles = [own(0.0, ring)?, with(0.0, square)?];
    let squares = [with(a, ring)?, own(a, square)?];
    let of_start = |k: usize| [&circles, &squares].map(|of| of.each_ref().map(|forces| forces[k]));
    Ok((0..=FEW).map(of_start).collect())
}

/// Among the pairs that differ in one property: in how many the circle's connection points have the
/// lower force, and in how many its inertia has.
fn lower_by(found: &[Crossed]) -> [usize; 2] {
    let count = |lower: fn(&Crossed, usize) -> bool| {
        let pairs = found.iter().flat_map(|all| [0, 1].map(|k| lower(all, k)));
        pairs.filter(|lower| *lower).count()
    };
    [
        count(|all, k| all[0][k] < all[1][k] - SAME),
        count(|all, k| all[k][0] < all[k][1] - SAME),
    ]
}

/// The least part of pairs that counts as a rule.
const AS_A_RULE: f64 = 0.75;

/// Whether connection points determine the difference, as a rule and more often than inertia does.
fn points_decide([points, inertia]: [usize; 2], pairs: usize) -> bool {
    points as f64 >= AS_A_RULE * pairs as f64 && points > inertia
}

fn connection_points(table: &Table) -> Checked {
    let bodies = [1.5, 2.5].map(|r| [0.1, 0.2, 0.3].map(|a| (r, a)));
    let bodies = bodies.as_flattened();
    let found = in_parallel(bodies.len(), |k| crossed(table, bodies[k].0, bodies[k].1))?;
    let of_start = |k: usize| found.iter().map(|starts| starts[k]).collect::<Vec<_>>();
    let counts: Vec<[usize; 2]> = (0..=FEW).map(|k| lower_by(&of_start(k))).collect();
    let pairs = 2 * bodies.len();
    let of = |which: usize| counts.iter().map(move |counts| counts[which] as f64);
    Ok(
        Finding::robust(&counts, |counts| points_decide(*counts, pairs))
            .list("points", of(0))
            .list("inertia", of(1))
            .value("pairs", pairs)
            .value("rule", 100.0 * AS_A_RULE),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_that_fails_has_no_exceptions() {
        let judged = |rule, exceptions: &[usize]| to_the_rule(rule, exceptions);
        assert_eq!(
            judged(Verdict::NotReproduced, &[5, 5]),
            Verdict::NotReproduced
        );
        assert_eq!(judged(Verdict::Reproduced, &[2, 3]), Verdict::Reproduced);
        assert_eq!(judged(Verdict::Reproduced, &[0, 0]), Verdict::NotReproduced);
    }

    #[test]
    fn one_entry_that_reaches_the_bound_first_is_a_counterexample() {
        let judged = |stops: [Stop; 2]| by_rotation(stops.into_iter().map(Some));
        assert_eq!(judged([Stop::RotationLimit; 2]), Verdict::Reproduced);
        assert_eq!(
            judged([Stop::RotationLimit, Stop::UpperBound]),
            Verdict::Mixed
        );
        assert_eq!(judged([Stop::UpperBound; 2]), Verdict::NotReproduced);
    }

    #[test]
    fn what_always_or_never_is_so_is_no_may() {
        assert!(some_but_not_all(&[true, false]));
        assert!(!some_but_not_all(&[true, true]) && !some_but_not_all(&[false]));
    }

    #[test]
    fn points_that_matter_less_than_inertia_do_not_decide() {
        // Connection points in rows, inertia in columns.
        let by_points = [[[0.1, 0.1], [0.3, 0.3]]; 2];
        let by_inertia = [[[0.1, 0.3], [0.1, 0.3]]; 2];
        assert_eq!(lower_by(&by_points), [4, 0]);
        assert_eq!(lower_by(&by_inertia), [0, 4]);
        assert!(points_decide([4, 0], 4) && !points_decide([0, 4], 4));
        assert!(!points_decide([4, 4], 4) && !points_decide([2, 0], 4));
    }
}
