//! Sections 6.3 to 6.3.2: the numbering of the cases, the stop rules and the standard case.

use super::near::{
    Near, by_member, ending, exceeds, first_rocking, judged, near, near_all, places, range,
};
use super::{Claim, Verdict, ensemble, robust};
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::analysis::Outcome;
use snapload::{Case, CaseError, Parameters, Stop, Trajectory, natural_inertia};

/// Table 6.1 as printed.
const PRINTED: &str = include_str!("../../data/table_6_1.csv");

/// Checks the claims of these sections.
///
/// # Errors
/// [`CaseError`] only for a fault of the program.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let table = Table::read(PRINTED);
    let near = Near::table(study, 3)?;
    Ok(vec![
        codes(&table),
        one_parameter(&table),
        standard_code(),
        heights(&table),
        forced_and_free(study)?,
        parts_pass_first(study)?,
        little_energy(study, &near)?,
        rocks_while_settling()?,
        slides_for_a_while(study)?,
        above_critical(study)?,
        initial_spin()?,
    ])
}

/// A printed table: columns by name.
struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

impl Table {
    fn read(text: &'static str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').collect());
        Self {
            columns: lines.next().unwrap_or_default(),
            rows: lines.collect(),
        }
    }

    fn text(&self, row: &[&'static str], column: &str) -> &'static str {
        let place = self.columns.iter().position(|name| *name == column);
        place.and_then(|k| row.get(k)).copied().unwrap_or("")
    }

    /// NaN, which agrees with nothing, where there is no number.
    fn number(&self, row: &[&'static str], column: &str) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }
}

/// The keys in the order in which a case number lists them, the frequency after them.
const PLACES: [&str; 12] = [
    "r", "e", "a", "b", "x", "vx", "y", "vy", "theta", "vtheta", "f_o", "nu",
];

/// The case number of values.
fn encode(value: impl Fn(&str) -> f64) -> String {
    let mut code = String::new();
    for key in PLACES {
        let v = value(key);
        let digit = match key {
            "r" => v.floor(),
            "e" if v == 1.0 => 1.0,
            _ => (10.0 * v).round(),
        };
        if key == "f_o" {
            code.push('-');
        }
        code.push_str(&format!("{digit:.0}"));
    }
    let omega = format!("{:?}", value("omega")).replace('.', "");
    code.push_str(omega.strip_prefix('0').unwrap_or(&omega));
    code
}

fn codes(table: &Table) -> Claim {
    let wrong: Vec<&Vec<&str>> = table
        .rows
        .iter()
        .filter(|row| encode(|key| table.number(row, key)) != table.text(row, "case"))
        .collect();
    let mut series: Vec<&str> = wrong.iter().map(|row| table.text(row, "series")).collect();
    series.dedup();
    let only_force = wrong
        .iter()
        .filter(|row| {
            let read = |key: &str| match key {
                "f_o" => 0.3,
                _ => table.number(row, key),
            };
            encode(read) == table.text(row, "case")
        })
        .count();
    let evidence = format!(
        "{} of {} rows agree; {} do not (series {}), {only_force} of them in f_o alone: 0.3 by the number",
        table.rows.len() - wrong.len(),
        table.rows.len(),
        wrong.len(),
        series.join(", ")
    );
    judged(
        ("6.3-01", "6.3"),
        "A case number spells out the values in its row of Table 6.1.",
        Verdict::of(wrong.is_empty() && !table.rows.is_empty()),
        evidence,
        "A slip in the table: the figures name the same numbers with the lower force. The number is \
         taken; both are computed.",
    )
}

fn one_parameter(table: &Table) -> Claim {
    let mut found = Vec::new();
    let mut holds = true;
    let same = |a: &Vec<&str>, b: &Vec<&str>| a.first() == b.first();
    for rows in table.rows.chunk_by(same) {
        let varies = |column: &&&str| {
            let mut values = rows.iter().map(|row| table.text(row, column));
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let columns: Vec<&str> = table.columns.iter().filter(varies).copied().collect();
        let keys: Vec<&str> = columns
            .into_iter()
            .filter(|column| !["series", "case", "h"].contains(column))
            .collect();
        holds &= keys.len() == 1;
        let series = rows.first().map_or("", |row| table.text(row, "series"));
        found.push(format!("{series}: {}", keys.join(" and ")));
    }
    judged(
        ("6.3-02", "6.3"),
        "Every series of Table 6.1 varies a single parameter.",
        Verdict::of(holds),
        format!("varied in series {}", found.join("; ")),
        "The first series is a grid of cable length and shape, and a square cannot vary its width \
         alone. Minor.",
    )
}

fn standard_code() -> Claim {
    let value = |key: &str| match Parameters::STANDARD.get(key) {
        Some(snapload::Value::Number(v)) => v,
        _ => f64::NAN,
    };
    let (named, follows) = ("1910001000-559", encode(value));
    judged(
        ("6.3-03", "6.3"),
        "The standard case bears the number 1910001000-559.",
        Verdict::of(follows == named),
        format!("the values of eq. 6.1 give {follows}"),
        "Perhaps left over from the standard case of the point mass, whose force is 0.5.",
    )
}

fn heights(table: &Table) -> Claim {
    let wrong: Vec<String> = table
        .rows
        .iter()
        .filter_map(|row| {
            let h = level(table.number(row, "r"), table.number(row, "a"));
            let printed = table.number(row, "h");
            let agrees = (h - printed).abs() <= 5.1e-4;
            let code = table.text(row, "case");
            (!agrees).then(|| format!("{code} prints {printed:.3} for {h:.3}"))
        })
        .collect();
    let (all, bad) = (table.rows.len(), wrong.len());
    judged(
        ("6.3-04", "6.3 (Table 6.1)"),
        "The column of heights h follows from r and a.",
        Verdict::of(wrong.is_empty() && all > 0),
        format!("{} of {all} rows; {}", all - bad, wrong.join(", ")),
        "Misprints; the runs do not depend on them.",
    )
}

/// How high the anchors are above the centre at rest, the half-height of the body left out.
fn level(r: f64, a: f64) -> f64 {
    (r * r - (1.0 - a).powi(2)).sqrt()
}

fn chapter(parameters: Parameters) -> Parameters {
    Reading::Chapter.apply(parameters)
}

fn unforced(parameters: Parameters) -> Parameters {
    Parameters {
        f_o: 0.0,
        ..parameters
    }
}

/// The standard case with initial spins -6, -5 … 6.
fn spins() -> Vec<Parameters> {
    (-6..=6)
        .map(|v| {
            chapter(Parameters {
                vtheta: f64::from(v),
                ..Parameters::STANDARD
            })
        })
        .collect()
}

fn count_exceeding(runs: &[&Trajectory]) -> usize {
    runs.iter().filter(|run| exceeds(run)).count()
}

fn forced_and_free(study: &Study) -> Result<Claim, CaseError> {
    let cases: Vec<Parameters> = study
        .cases
        .iter()
        .filter(|case| {
            snapload::TABLE_6_1
                .iter()
                .any(|(_, code)| *code == case.code)
        })
        .map(|case| chapter(case.parameters))
        .collect();
    let still: Vec<Parameters> = cases.iter().copied().map(unforced).collect();
    let (forced, free) = (near_all(&cases, 3)?, near_all(&still, 3)?);
    let counts: Vec<(usize, usize)> = by_member(&forced)
        .iter()
        .zip(by_member(&free))
        .map(|(forced, free)| (count_exceeding(forced), count_exceeding(&free)))
        .collect();
    let spun = near_all(&spins(), 0)?;
    let spun_free = near_all(&spins().into_iter().map(unforced).collect::<Vec<_>>(), 0)?;
    let of = |runs: &[Vec<Trajectory>]| by_member(runs).first().map_or(0, |r| count_exceeding(r));
    let (with, without) = counts.first().copied().unwrap_or_default();
    let evidence = format!(
        "{with} of {} cases exceed under forcing, {without} without; the standard case with initial \
         spins -6 to 6: {} of 13 and {}",
        cases.len(),
        of(&spun),
        of(&spun_free)
    );
    Ok(judged(
        ("6.3.1-01", "6.3.1"),
        "Forced motion reaches the rotation limit more easily than free motion.",
        robust(counts.iter().map(|(forced, free)| forced > free)),
        evidence,
        "From the chapter's start free motion is symmetric and does not rotate.",
    ))
}

/// The highest point of a body above its centre.
fn top(a: f64, b: f64, theta: f64) -> f64 {
    if b == 0.0 {
        a
    } else {
        a * theta.sin().abs() + b * theta.cos().abs()
    }
}

fn parts_pass_first(study: &Study) -> Result<Claim, CaseError> {
    let tilts = (-90..=90).map(|k| f64::from(k).to_radians());
    let least = study.critical.iter().flat_map(|row| {
        let [a, b] = row.size;
        tilts.clone().map(move |theta| top(a, b, theta))
    });
    let (least, _) = range(least);
    let strong = study.critical.iter().flat_map(|row| {
        let [a, b] = row.size;
        [0.6, 0.7, 0.8, 0.9].map(|f_o| {
            chapter(Parameters {
                r: row.r,
                a,
                b,
                inertia: natural_inertia(a, b),
                f_o,
                ..Parameters::STANDARD
            })
        })
    });
    let below: Vec<Option<f64>> = strong
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|p| {
            let end = Outcome::of(&Case::new(p)?).end;
            let stopped = end.reason == Stop::UpperBound;
            Ok(stopped.then(|| level(p.r, p.a) + p.b - end.state.y))
        })
        .collect::<Result<_, CaseError>>()?;
    let stops = below.iter().flatten().count();
    let (nearest, _) = range(below.into_iter().flatten());
    Ok(judged(
        ("6.3.1-02", "6.3.1"),
        "Some part of a body that rotates passes the upper level before its centre does.",
        Verdict::of(stops > 0 && nearest > 0.0 && least > 0.0),
        format!(
            "the top is at least {least:.2} above the centre in every shape; at {stops} stops at the \
             level the centre is at least {nearest:.2} below it"
        ),
        "",
    ))
}

/// A settled case that goes on for 20 T: whether it stays low, by member, and how it went.
struct GoneOn {
    low: Verdict,
    words: String,
}

fn go_on(code: &str, parameters: &Parameters, settled: f64) -> Result<GoneOn, CaseError> {
    let runs = near(
        &Parameters {
            stop_when_settled: false,
            t_end: settled + 20.0,
            ..*parameters
        },
        3,
    )?;
    let after = |run: &Trajectory| {
        range(
            places(run, (settled, run.end().t), 0.05)
                .iter()
                .map(|p| p.1),
        )
        .1
    };
    let low = robust(runs.iter().map(|run| !exceeds(run) && after(run) < 0.1));
    let words = match runs.first() {
        Some(run) if exceeds(run) => format!("{code} {}", ending(run)),
        Some(run) => format!("{code} rises to {:.3}", after(run)),
        None => String::new(),
    };
    Ok(GoneOn { low, words })
}

fn little_energy(study: &Study, near: &Near) -> Result<Claim, CaseError> {
    let settled = study.cases.iter().filter_map(|case| {
        let members = near.of(&[case.code]);
        let run = *members.first()?.first()?;
        let settles = run.end().reason == Stop::Settled;
        settles.then_some((case.code, case.parameters, run.end().t))
    });
    let gone_on: Vec<GoneOn> = settled
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|(code, parameters, t)| go_on(code, &parameters, t))
        .collect::<Result<_, _>>()?;
    let with = |verdict: Verdict| gone_on.iter().filter(move |case| case.low == verdict);
    let (low, high) = (with(Verdict::Reproduced), with(Verdict::NotReproduced));
    let (low, high): (usize, Vec<&str>) = (low.count(), high.map(|case| &*case.words).collect());
    let verdict = match (low == gone_on.len(), high.is_empty()) {
        (true, _) => Verdict::Reproduced,
        (false, false) => Verdict::NotReproduced,
        (false, true) => Verdict::NotDecidable,
    };
    let evidence = format!(
        "of {} cases that settle {low} stay below y = 0.1 for another 20 T; not so: {}",
        gone_on.len(),
        high.join(", ")
    );
    Ok(judged(
        ("6.3.1-03", "6.3.1"),
        "A body that the settling rule stops has too little energy left to rise far again.",
        verdict,
        evidence,
        "The rule stops a run but is not rest: the body may still spin, and the forcing then pumps its \
         rocking up, in the standard case past the rotation limit.",
    ))
}

fn rocks_while_settling() -> Result<Claim, CaseError> {
    let amplitudes: Vec<f64> = (1..=27).map(|k| f64::from(k) / 100.0).collect();
    let rocks: Vec<Verdict> = amplitudes
        .par_iter()
        .map(|&f_o| {
            let case = Parameters {
                f_o,
                stop_when_settled: false,
                ..Parameters::STANDARD
            };
            let starts = ensemble(&case, 3).into_iter().map(first_rocking);
            let starts: Vec<Option<f64>> = starts.collect::<Result<_, _>>()?;
            Ok(robust(starts.iter().map(Option::is_some)))
        })
        .collect::<Result<_, CaseError>>()?;
    let count = rocks.iter().filter(|v| **v == Verdict::Reproduced).count();
    Ok(judged(
        ("6.3.1-04", "6.3.1"),
        "While a body settles both cables can become taut, and it rocks.",
        Verdict::of(count > 0),
        format!(
            "f_o = 0.01 to 0.27: {count} of {} come to rock",
            rocks.len()
        ),
        "",
    ))
}

fn slides_for_a_while(study: &Study) -> Result<Claim, CaseError> {
    let case = study.case("1921001000-559");
    let runs = near(
        &case.map_or(Parameters::STANDARD, |case| case.parameters),
        8,
    )?;
    let slides: Vec<Option<(f64, f64)>> = runs
        .iter()
        .map(|run| run.modes().iter().find(|mode| mode.taut.len() == 1))
        .map(|mode| mode.map(|mode| (mode.t_start, mode.t_end)))
        .collect();
    let long = |slide: &Option<(f64, f64)>| slide.is_some_and(|(from, to)| to - from > 0.1);
    let evidence = match slides.first() {
        Some(Some((from, to))) => format!("slides from t = {from:.3} to {to:.3}"),
        _ => "does not slide".to_owned(),
    };
    Ok(judged(
        ("6.3.1-05", "6.3.1"),
        "The forcing can hold a body at one boundary, its cable taut, for a finite time.",
        robust(slides.iter().map(long)),
        evidence,
        "",
    ))
}

fn above_critical(study: &Study) -> Result<Claim, CaseError> {
    let case = study.case("1910001000-559");
    let parameters = case.map_or(Parameters::STANDARD, |case| case.parameters);
    let runs = near(&chapter(parameters), 8)?;
    let evidence = runs.first().map_or(String::new(), |run| {
        format!("{} after {} impacts", ending(run), run.impacts().len())
    });
    Ok(judged(
        ("6.3.2-01", "6.3.2"),
        "A force amplitude of 0.5 is above the critical one of the standard rigid body.",
        robust(runs.iter().map(exceeds)),
        evidence,
        "",
    ))
}

fn initial_spin() -> Result<Claim, CaseError> {
    let runs = near_all(&spins(), 3)?;
    let members = by_member(&runs);
    let spun = |k: usize| k as f64 - 6.0;
    let exceeding = |runs: &[&Trajectory]| -> Vec<f64> {
        let found = runs.iter().enumerate().filter(|(_, run)| exceeds(run));
        found.map(|(k, _)| spun(k)).collect()
    };
    let found: Vec<Vec<f64>> = members.iter().map(|runs| exceeding(runs)).collect();
    let evidence = format!(
        "of initial spins -6 to 6 those of {:?} exceed; 0 {}",
        found.first().map_or(&[][..], |spins| spins),
        if found.iter().any(|spins| spins.contains(&0.0)) {
            "does too"
        } else {
            "does not"
        }
    );
    let holds = |spins: &Vec<f64>| !spins.is_empty() && !spins.contains(&0.0);
    Ok(judged(
        ("6.3.2-02", "6.3.2"),
        "An initial rotation can take the standard case past the rotation limit.",
        robust(found.iter().map(holds)),
        evidence,
        "",
    ))
}
