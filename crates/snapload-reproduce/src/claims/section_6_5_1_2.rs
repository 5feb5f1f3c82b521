//! 6.5.1.2: when bodies slide; the sliding example has a file of its own.

mod example;

use super::numbers::{max, min, span};
use super::runs::{
    FEW, MANY, chapter, ensemble, from_starts, near, outcome, run, shapes_under, standard,
    table_codes,
};
use super::verdict::{Checked, Checks, Claim, Finding, Verdict, run_checks};
use crate::ReportError;
use crate::critical_row::CriticalRow;
use crate::proved::Proved;
use crate::study::{CaseRuns, Study, exact};
use example::Example;
use snapload::analysis::{ForceScan, Unfinished, in_parallel, no_progress, outcomes};
use snapload::{Case, CaseError, Parameters, Stop, named_case};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let shapes = in_parallel(study.critical.len(), |k| Shape::of(&study.critical[k]))?;
    let mut all = run_checks(&[CHECKS], &(study, shapes))?;
    let runs = near(&named_case("sliding-example")?.parameters, MANY, run)?;
    all.extend(run_checks(&[example::CHECKS], &Example::of(&runs))?);
    Ok(all)
}

/// The study, and the results for each shape of Table 6.2 over all amplitudes.
type Material<'a> = (&'a Study, Vec<Shape>);

const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.1.2-01", table_6_1),
    ("6.5.1.2-02", |(_, shapes)| {
        // Whether a statement holds somewhere in each class.
        let everywhere = |holds: fn(&Shape) -> bool| {
            let of_class = |of: &Shape| shapes.iter().any(|s| s.class == of.class && holds(s));
            shapes.iter().all(of_class)
        };
        let robust = shapes.iter().filter(|s| s.robust).count();
        let verdict = match everywhere(|s| s.robust) {
            false if everywhere(|s| s.counts[0][0] > 0) => Verdict::NotDecidable,
            robustly => Verdict::of(robustly),
        };
        let amplitudes = shapes
            .iter()
            .flat_map(|s| s.counts.iter().map(|counts| counts[0]));
        Ok(Finding::new(verdict)
            .list("amplitudes", amplitudes.map(|count| count as f64))
            .values("shapes robust", [shapes.len(), robust]))
    }),
    ("6.5.1.2-03", |(_, shapes)| {
        /// The least number of intervals that no simple rule explains, and the number of shapes
        /// that may have fewer.
        const SCATTERED: usize = 2;
        const EXCEPTIONS: usize = 2;
        let all = shapes.len();
        let scattered = |start: usize| {
            let of_shapes = shapes.iter().map(|s| s.counts[start][1]);
            of_shapes
                .filter(|intervals| *intervals >= SCATTERED)
                .count()
        };
        let scattered: Vec<usize> = (0..=MANY).map(scattered).collect();
        let intervals = shapes
            .iter()
            .flat_map(|s| s.counts.iter().map(|counts| counts[1]));
        Ok(Finding::robust(&scattered, |count| {
            count + EXCEPTIONS >= all && all > EXCEPTIONS
        })
        .list("intervals", intervals.map(|count| count as f64))
        .list("scattered", scattered.iter().map(|count| *count as f64))
        .values("shapes several but", [all, SCATTERED, EXCEPTIONS]))
    }),
    ("6.5.1.2-04", |_| decaying_snaps()),
    ("6.5.1.2-16", ends),
];

fn ends_sliding(reason: Stop) -> bool {
    reason == Stop::SlidingStart
}

fn slides(parameters: &Parameters) -> Result<bool, CaseError> {
    Ok(ends_sliding(outcome(&chapter(*parameters))?.end.reason))
}

fn table_6_1((study, _): &Material) -> Checked {
    let codes = table_codes();
    let cases = study.cases.iter();
    let (table, printed): (Vec<_>, Vec<_>) = cases.partition(|case| codes.contains(&case.code));
    let cases: Vec<Parameters> = table.iter().map(|case| case.parameters).collect();
    let found = from_starts(&cases, MANY, slides)?;
    let slides = |k: usize| found.iter().map(move |all| all[k]);
    let some = (0..cases.len())
        .filter(|k| slides(*k).any(|slides| slides))
        .count();
    let none = (0..cases.len()).map(|k| Verdict::robust(slides(k).map(|slides| !slides)));
    let own = found[0].iter().filter(|slides| **slides).count();
    let slid = |case: &&&CaseRuns| ends_sliding(case.exact.end().reason);
    let mut others: Vec<&str> = printed.iter().filter(slid).map(|case| case.code).collect();
    if others.is_empty() {
        others.push("none");
    }
    Ok(Finding::new(Verdict::all(none))
        .values("own cases some", [own, cases.len(), some])
        .value("others", others.join(", ")))
}

/// The results for a shape of Table 6.2 over all amplitudes.
struct Shape {
    /// Its outline, and whether its cables are the longer ones.
    class: (&'static str, bool),
    /// The number of amplitudes with slides, and of their intervals, from each start.
    counts: Vec<[usize; 2]>,
    /// Whether all starts slide at one of the amplitudes.
    robust: bool,
}

impl Shape {
    fn of(row: &CriticalRow) -> Result<Self, Unfinished> {
        let forces: Vec<f64> = ForceScan::default().amplitudes().collect();
        let case = row.parameters();
        let starts = ensemble(&chapter(case), MANY);
        let with = |start: &Parameters, f_o| Case::new(Parameters { f_o, ..*start });
        let cases = starts
            .iter()
            .flat_map(|start| forces.iter().map(|f_o| with(start, *f_o)));
        let ends = outcomes(&cases.collect::<Result<Vec<_>, CaseError>>()?, &no_progress)?;
        let slides: Vec<bool> = ends.iter().map(|of| ends_sliding(of.end.reason)).collect();
        let of_starts: Vec<&[bool]> = slides.chunks(forces.len()).collect();
        Ok(Self {
            class: (row.shape, row.r > 2.0),
            counts: of_starts.iter().map(|slides| sliding(slides)).collect(),
            robust: (0..forces.len()).any(|k| of_starts.iter().all(|slides| slides[k])),
        })
    }
}

/// The number of amplitudes with slides, and of their intervals.
fn sliding(slides: &[bool]) -> [usize; 2] {
    let intervals = slides.chunk_by(|p, q| p == q).filter(|part| part[0]);
    [
        slides.iter().filter(|slides| **slides).count(),
        intervals.count(),
    ]
}

fn decaying_snaps() -> Checked {
    /// A difference of times that is not visible in a plot.
    const SAME: f64 = 1e-3;
    /// Two velocities below which a cable is taken to stick. If the snaps die out, the result does
    /// not depend on which is used.
    const STICKS: [f64; 2] = [1e-6, 1e-8];
    let forces = [0.2, 0.27, 0.4, 0.44];
    let starts = in_parallel(forces.len(), |k| {
        let with = |v_stick| chapter(standard(|p| (p.f_o, p.v_stick) = (forces[k], v_stick)));
        let cases = STICKS.map(with);
        let sticks: Result<Vec<_>, CaseError> = cases.iter().map(sticks).collect();
        Ok::<Vec<f64>, CaseError>(sticks?.into_iter().flatten().collect())
    })?;
    let same = |times: &Vec<f64>| {
        let apart = max(times.iter().copied()) - min(times.iter().copied());
        Verdict::of(times.len() == STICKS.len() && apart < SAME)
    };
    let verdict = Verdict::all(starts.iter().map(same));
    let words = starts.iter().zip(forces);
    let words = words.map(|(times, f_o)| format!("{} at f_o = {f_o}", span(times.clone(), 4)));
    Ok(Finding::new(verdict)
        .value("times", words.collect::<Vec<_>>().join(", "))
        .value("same", SAME))
}

/// When the first cable sticks, in many digits, if one does.
fn sticks(case: &Parameters) -> Result<Option<f64>, CaseError> {
    let run = exact(case, Proved::stored(case))?;
    let stuck = [Stop::Settled, Stop::SlidingStart].contains(&run.end().reason);
    Ok(stuck.then_some(run.end().t))
}

/// Why a run that has slid stops, and the number of taut cables then.
fn end_if_slid(parameters: &Parameters) -> Result<Option<(Stop, usize)>, CaseError> {
    let mut simulation = Case::new(*parameters)?.simulation();
    let mut slid = false;
    while let Some(step) = simulation.step() {
        slid |= step.taut.len() == 1 && step.t_end > step.t_start;
    }
    let end = simulation
        .stop()
        .map(|stop| (stop, simulation.taut().len()));
    Ok(end.filter(|_| slid))
}

/// Whether each kind of end occurs.
fn all_met(ways: [usize; 3]) -> bool {
    !ways.contains(&0)
}

/// The ends of runs that slide: settled, at the rotation limit, rocking; at the upper bound, and
/// not yet.
type Ends = [usize; 5];

fn counted(ends: &[Option<(Stop, usize)>]) -> Ends {
    let mut counts = Ends::default();
    for (stop, taut) in ends.iter().flatten() {
        let way = match stop {
            Stop::Settled => 0,
            Stop::RotationLimit => 1,
            Stop::UpperBound => 3,
            _ if *taut > 1 => 2,
            _ => 4,
        };
        counts[way] += 1;
    }
    counts
}

fn ends((study, _): &Material) -> Checked {
    let forces: Vec<f64> = (1..=18).map(|k| f64::from(k) / 20.0).collect();
    let cases = shapes_under(study, &forces);
    let starts = from_starts(&cases, FEW, end_if_slid)?;
    let counts: Vec<Ends> = starts.iter().map(|ends| counted(ends)).collect();
    let number = |way: usize| counts.iter().map(move |counts| counts[way] as f64);
    let all = counts
        .iter()
        .map(|counts| counts.iter().sum::<usize>() as f64);
    Ok(Finding::robust(&counts, |[settle, limit, rock, ..]| {
        all_met([*settle, *limit, *rock])
    })
    .list("settle", number(0))
    .list("limit", number(1))
    .list("rock", number(2))
    .list("bound", number(3))
    .list("going", number(4))
    .condition(
        "others",
        counts.iter().any(|counts| counts[3] + counts[4] > 0),
    )
    .list("all", all)
    .value("runs", cases.len())
    .list("forces", forces))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_that_is_never_reached_is_noticed() {
        assert!(all_met([3, 1, 2]) && !all_met([3, 0, 2]));
        let ends = [
            Some((Stop::Settled, 1)),
            None,
            Some((Stop::EndTime, 2)),
            Some((Stop::EndTime, 1)),
        ];
        assert_eq!(counted(&ends), [1, 0, 1, 0, 1]);
    }

    #[test]
    fn one_interval_is_not_two() {
        assert_eq!(sliding(&[false, true, true, false]), [2, 1]);
        assert_eq!(sliding(&[true, false, true]), [2, 2]);
    }
}
