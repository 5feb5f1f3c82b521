//! Section 6.4.1: the effect of restitution and force on the motion. The claims on the region, on
//! rotations and on the frequency are in files of their own.

mod region;
mod rotation;
mod snap_patterns;

use super::motions::{ending, endings, exceeds, places};
use super::numbers::{falling, marked_over_others, max, min, span};
use super::runs::{MANY, TableRuns, case, chapter, measured, near, of_runs};
use super::verdict::{Checked, Checks, Claim, Finding, Verdict, run_checks};
use crate::ReportError;
use crate::proved::{Proved, over_force, restitutions, with_restitution};
use crate::reading::first_exceeding;
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{CaseError, Parameters, Stop};
use snapload_verify::RoundedRun;
use std::f64::consts::TAU;

/// Checks the claims of this section.
pub(super) fn claims(table_runs: &TableRuns) -> Result<Vec<Claim>, ReportError> {
    let mut all = run_checks(&[region::CHECKS, rotation::CHECKS, CHECKS], table_runs)?;
    all.extend(run_checks(
        &[snap_patterns::CHECKS],
        &*table_runs.of(snap_patterns::FREQUENCIES)?,
    )?);
    Ok(all)
}

const CHECKS: &Checks<fn(&TableRuns) -> Checked> = &[
    ("6.4.1-15", |table_runs| {
        let members = table_runs.of(RESTITUTIONS)?;
        let of_member = |k: usize| Ok::<_, ReportError>(members[k].map(activity));
        let measured = in_parallel(members.len(), of_member)?;
        let column = |of: &[[f64; 3]; 4], k: usize| of.map(|activity| activity[k]);
        let finding = Finding::robust(&measured, |of| (0..3).all(|k| falling(&column(of, k))));
        let of = |k: usize| {
            measured
                .iter()
                .map(move |of| of.map(|activity| activity[k]))
        };
        Ok(finding
            .by_start("path", of(0))
            .by_start("x", of(1))
            .by_start("rho3", of(2)))
    }),
    ("6.4.1-16", |table_runs| {
        /// Velocities count as falling if their ratio is below the first number, and as not falling
        /// above the second.
        const FALLS: f64 = 0.5;
        const KEEPS: f64 = 0.8;
        let members = table_runs.of(RESTITUTIONS)?;
        let falls = |[first, others @ ..]: &[f64; 4]| *first > KEEPS && max(*others) < FALLS;
        let finding = measured("ratios", &members, later_to_earlier, falls);
        Ok(finding.values("falls keeps", [FALLS, KEEPS]))
    }),
    ("6.4.1-17", |table_runs| {
        /// An axis is too short if it should be this many times as long.
        const LONGER: f64 = 2.0;
        let members = table_runs.of(RESTITUTIONS)?;
        let longer = |[first, others @ ..]: &[f64; 4]| *first > LONGER * max(*others);
        let finding = measured("ends", &members, |run| run.end().t, longer);
        Ok(finding.value("longer", LONGER))
    }),
    ("6.4.1-18", |table_runs| {
        let [early, late, end] = divergence(&elastic(table_runs)?);
        let finding = Finding::of(late / early > CHAOS);
        Ok(finding.values("early late end chaos", [early, late, end, CHAOS]))
    }),
    ("6.4.1-36", |table_runs| {
        /// The start is off the middle, where a free motion would meet both boundaries at once for
        /// ever.
        const OFF: f64 = 0.02;
        let elastic = elastic(table_runs)?;
        let mut free = chapter(case(table_runs.study, RESTITUTIONS[0])?.parameters);
        (free.f_o, free.x, free.t_end) = (0.0, OFF, elastic[0].end().t);
        let runs = near(&free, MANY, RoundedRun::of_doubles)?;
        let [early, late, end] = divergence(&runs.iter().collect::<Vec<_>>());
        let [forced_early, forced_late, _] = divergence(&elastic);
        let [with, without] = [forced_late / forced_early, late / early];
        Ok(Finding::of(with > CHAOS && without < CHAOS)
            .values("off early late end", [OFF, early, late, end])
            .value("chaos", CHAOS)
            .condition("chaotic_without", without >= CHAOS))
    }),
    ("6.4.1-19", |table_runs| {
        let runs = elastic(table_runs)?;
        let rotates = |run: &&RoundedRun| run.end().reason == Stop::RotationLimit;
        Ok(Finding::robust(&runs, rotates)
            .value("ending", ending(runs[0].end()))
            .list("impacts", runs.iter().map(|run| run.snaps() as f64)))
    }),
    ("6.4.1-20", |table_runs| {
        /// The rounding error of one impact's energies.
        const ROUNDING: f64 = 1e-14;
        let runs = elastic(table_runs)?;
        let lost = |run: &&RoundedRun| {
            let energy = |state| run.system().energy(state);
            let hits = run.impacts().iter();
            max(hits.map(|hit| (energy(&hit.before) - energy(&hit.after)).abs()))
        };
        Ok(Finding::robust(&runs, |run| lost(run) < ROUNDING)
            .values("most rounding", [max(runs.iter().map(lost)), ROUNDING])
            .list("impacts", runs.iter().map(|run| run.snaps() as f64)))
    }),
    ("6.4.1-21", |table_runs| {
        let members = table_runs.of(RESTITUTIONS)?;
        let impulse = |run: &RoundedRun| max(run.impacts().iter().map(|hit| hit.impulse));
        let rho1 = |run: &RoundedRun| run.norms().rho1;
        let fall = measured("velocities", &members, rho1, |all| falling(all));
        Ok(fall.by_start("impulses", members.iter().map(|runs| runs.map(impulse))))
    }),
    ("6.4.1-22", settles_sooner),
    ("6.4.1-23", |table_runs| {
        let members = table_runs.of(FORCES)?;
        let only_last = |runs: &[&RoundedRun; 5]| {
            runs.map(exceeds) == [false, false, false, false, true]
                && runs[4].end().reason == Stop::RotationLimit
        };
        Ok(Finding::robust(&members, only_last).value("endings", endings(&members)))
    }),
    ("6.4.1-24", |_| {
        let first = first_rotating()?;
        let found: Vec<f64> = first.iter().flatten().copied().collect();
        Ok(Finding::robust(&first, |f_o| *f_o == Some(0.31))
            .values("found starts", [found.len(), first.len()])
            .list("first", found))
    }),
    ("6.4.1-25", settles_above_critical),
    ("6.4.1-39", forces_below_half),
    ("6.4.1-41", |_| loss_keeps_within_limits()),
];

/// e = 1, 0.9, 0.7, 0.5.
const RESTITUTIONS: [&str; 4] = [
    "1110001000-359",
    "1910001000-359",
    "1710001000-359",
    "1510001000-359",
];
/// f_o = 0.1, 0.2 … 0.5.
const FORCES: [&str; 5] = [
    "1910001000-159",
    "1910001000-259",
    "1910001000-359",
    "1910001000-459",
    "1910001000-559",
];

/// The runs with e = 1.
fn elastic<'a>(table_runs: &'a TableRuns) -> Result<Vec<&'a RoundedRun>, ReportError> {
    let runs = table_runs.of([RESTITUTIONS[0]])?;
    Ok(runs.into_iter().flatten().collect())
}

/// Length of the centre's path, range of x, and ρ3.
fn activity(run: &RoundedRun) -> [f64; 3] {
    let points = places(|t| run.at(t), (0.0, run.end().t), 0.01);
    let step = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
    let x = || points.iter().map(|p| p[0]);
    [
        points.windows(2).map(step).sum(),
        max(x()) - min(x()),
        run.norms().rho3,
    ]
}

/// Ratio of the mean snap velocities in the second and the first half of the time.
fn later_to_earlier(run: &RoundedRun) -> f64 {
    let half = run.end().t / 2.0;
    marked_over_others(run.impacts().iter().map(|hit| (hit.t >= half, hit.v_n)))
}

/// The largest distance of neighbours from the first run in x, y and θ, in the first period of
/// their motion and in the last (over a whole period, as the distance oscillates); and when the
/// first of them ends.
fn divergence(runs: &[&RoundedRun]) -> [f64; 3] {
    let end = min(runs.iter().map(|run| run.end().t));
    let late = end - TAU / Parameters::STANDARD.omega;
    let [first, last] = [0.0, late].map(|from| {
        let paths = runs.iter().map(|run| {
            let times = (0..=100).map(|k| from + (end - late) * f64::from(k) / 100.0);
            let states = times.map(|t| run.at(t));
            states.flat_map(|s| [s.x, s.y, s.theta]).collect()
        });
        let paths: Vec<Vec<f64>> = paths.collect();
        let pairs = paths.iter().flat_map(|path| path.iter().zip(&paths[0]));
        max(pairs.map(|(p, q)| (p - q).abs()))
    });
    [first, last, end]
}

/// A growth of differences that no regular motion has over so short a run.
const CHAOS: f64 = 1e4;

fn settles_sooner(table_runs: &TableRuns) -> Checked {
    let members = table_runs.of(RESTITUTIONS)?;
    let times = |runs: &[&RoundedRun; 4]| -> Vec<f64> {
        let settled = runs.iter().filter(|run| run.end().reason == Stop::Settled);
        settled.map(|run| run.end().t).collect()
    };
    let sooner = |times: &[f64]| times.len() == 3 && falling(times);
    let [steps, _] = restitutions();
    let ends = steps.iter().map(|e| Proved::stored(&with_restitution(*e)));
    let settled = ends.flatten().filter(|end| end.reason == Stop::Settled);
    let fine: Vec<f64> = settled.map(Proved::time).collect();
    let back = fine.windows(2).filter(|pair| !falling(pair)).count();
    Ok(Finding::robust(&members, |runs| sooner(&times(runs)))
        .by_start("times", members.iter().map(times))
        .values("settle steps back", [fine.len(), steps.len(), back])
        .list("fine", fine))
}

/// For each start of the standard case the first of the amplitudes 0.01, 0.02 … that exceeds, if it
/// exceeds by rotation.
fn first_rotating() -> Result<Vec<Option<f64>>, CaseError> {
    near(&chapter(Parameters::STANDARD), MANY, |start| {
        let first = first_exceeding(start, ForceScan::default())?;
        Ok(first.filter(|f| f.1 == Stop::RotationLimit).map(|f| f.0))
    })
}

fn settles_above_critical(table_runs: &TableRuns) -> Checked {
    let members = table_runs.of(FORCES)?;
    let first = first_rotating()?;
    let settles = |runs: &[&RoundedRun; 5], first: Option<f64>| {
        let mut others = runs[..4].iter();
        others.all(|run| run.end().reason == Stop::Settled) && first.is_some_and(|f_o| f_o < 0.4)
    };
    let pairs = members.iter().zip(first);
    let holds = pairs.map(|(runs, first)| settles(runs, first));
    Ok(Finding::new(Verdict::robust(holds))
        .list("ends", members.iter().map(|runs| runs[3].end().t))
        .value("exceeding", exceeding()))
}

/// The amplitudes up to 1 that are proved to exceed, in hundredths, as intervals.
fn exceeding() -> String {
    let forces: Vec<(f64, bool)> = over_force()
        .map(|(f_o, proved)| (f_o, proved.is_some_and(|proved| proved.reason.exceeds())))
        .collect();
    let intervals = forces.chunk_by(|p, q| p.1 == q.1).filter(|part| part[0].1);
    let words = intervals.map(|part| span(part.iter().map(|p| p.0), 2));
    words.collect::<Vec<_>>().join(", ")
}

/// The results for the rows of Table 6.1 with a force below a half: those of the series f_o, and
/// all; and for the rows of shapes, at 0.3 by their number, and at 0.5 as printed.
fn forces_below_half(table_runs: &TableRuns) -> Checked {
    let settles = |runs: &[RoundedRun], k: usize| runs[k].end().reason == Stop::Settled;
    let weak = |k: &usize| table_runs.cases[*k].f_o < 0.5;
    let places: Vec<usize> = (0..table_runs.codes.len()).filter(weak).collect();
    let of_case = |k: &usize| Verdict::robust(table_runs.members().map(|runs| settles(runs, *k)));
    let (series, others): (Vec<usize>, Vec<usize>) = places
        .into_iter()
        .partition(|k| FORCES.contains(&table_runs.codes[*k]));
    let verdicts = [&series, &others].map(|of| Verdict::all(of.iter().map(of_case)));
    let own = table_runs.own();
    let words = |k: &usize| format!("{} {}", table_runs.codes[*k], ending(own[*k].end()));
    let not = others.iter().filter(|k| !settles(own, **k));
    let not: Vec<String> = not.map(words).collect();
    let printed = table_runs
        .study
        .cases
        .iter()
        .filter(|case| case.code.ends_with("-559"));
    let printed = printed.filter(|case| !FORCES.contains(&case.code));
    let printed: Vec<String> = printed
        .map(|case| format!("{} {}", case.code, ending(case.exact.end())))
        .collect();
    Ok(Finding::new(Verdict::families(verdicts))
        .values("series others", [series.len(), others.len()])
        .values("not printed", [not.join(", "), printed.join(", ")])
        .value("count", not.len()))
}

/// Whether the loss of energy keeps a case within the limits: the cases with the least loss exceed,
/// and none with a larger loss does.
fn loss_keeps_within_limits() -> Checked {
    let [_, steps] = restitutions();
    let cases: Vec<Parameters> = steps.into_iter().map(with_restitution).collect();
    let mut exceeding = of_runs(&cases, MANY, exceeds)?;
    // The first are the proved ends of the motion itself.
    let proved = cases.iter().map(Proved::stored);
    exceeding[0] = proved
        .map(|proved| proved.is_some_and(|proved| proved.reason.exceeds()))
        .collect();
    let least = |all: &Vec<bool>| {
        let first = all.iter().take_while(|exceeds| **exceeds).count();
        (1..all.len()).contains(&first) && !all[first..].contains(&true)
    };
    let own = cases
        .iter()
        .zip(&exceeding[0])
        .filter(|(_, exceeds)| **exceeds);
    let same = exceeding.iter().filter(|all| **all == exceeding[0]).count();
    Ok(Finding::robust(&exceeding, least)
        .list("exceeding", own.map(|(case, _)| case.e))
        .values("same starts", [same, exceeding.len()]))
}
