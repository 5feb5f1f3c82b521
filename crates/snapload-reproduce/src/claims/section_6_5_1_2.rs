//! 6.5.1.2: when bodies slide; the sliding example has a file of its own.

mod example;

use super::numbers::{max, min, span};
use super::runs::{
    MANY, chapter, each, ensemble, first_interval, from_starts, near, outcome, past_settling, run,
    shapes_under, standard, table_codes,
};
use super::verdict::{Claim, Finding, Judged, Judges, Verdict, ask};
use crate::ReportError;
use crate::critical_row::CriticalRow;
use crate::study::{CaseRuns, Study};
use example::Example;
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{Case, CaseError, Parameters, Stop, named_case};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let shapes = in_parallel(study.critical.len(), |k| Shape::of(&study.critical[k]))?;
    let mut all = ask(&[JUDGES], &(study, shapes))?;
    let runs = near(&named_case("sliding-example")?.parameters, MANY, run)?;
    all.extend(ask(&[example::JUDGES], &Example::of(&runs))?);
    Ok(all)
}

/// The study, and what each shape of Table 6.2 does over all amplitudes.
type Material<'a> = (&'a Study, Vec<Shape>);

const JUDGES: &Judges<fn(&Material) -> Judged> = &[
    ("6.5.1.2-01", table_6_1),
    ("6.5.1.2-02", |(_, shapes)| {
        // Whether it holds somewhere in each class.
        let everywhere = |holds: fn(&Shape) -> bool| {
            let of_class = |of: &Shape| shapes.iter().any(|s| s.class == of.class && holds(s));
            shapes.iter().all(of_class)
        };
        let robust = shapes.iter().filter(|s| s.robust).count();
        let verdict = match everywhere(|s| s.robust) {
            false if everywhere(|s| s.amplitudes > 0) => Verdict::NotDecidable,
            robustly => Verdict::of(robustly),
        };
        Ok(Finding::new(verdict)
            .list("amplitudes", shapes.iter().map(|s| s.amplitudes as f64))
            .values("shapes robust", [shapes.len(), robust]))
    }),
    ("6.5.1.2-03", |(_, shapes)| {
        let (scattered, all) = (
            shapes.iter().filter(|s| s.intervals >= 2).count(),
            shapes.len(),
        );
        Ok(Finding::of(scattered + 2 >= all && all > 2)
            .list("intervals", shapes.iter().map(|s| s.intervals as f64))
            .values("scattered shapes", [scattered, all]))
    }),
    ("6.5.1.2-04", |_| dying_snaps()),
    ("6.5.1.2-16", ends),
];

fn ends_sliding(reason: Stop) -> bool {
    reason == Stop::SlidingStart
}

fn slides(parameters: &Parameters) -> Result<bool, CaseError> {
    Ok(ends_sliding(outcome(&chapter(*parameters))?.end.reason))
}

fn table_6_1((study, _): &Material) -> Judged {
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

/// What a shape of Table 6.2 does over all amplitudes.
struct Shape {
    /// Its outline, and whether its cables are the longer ones.
    class: (&'static str, bool),
    /// So many amplitudes slide, and in so many intervals.
    amplitudes: usize,
    intervals: usize,
    /// Whether all neighbours slide, too, at one amplitude.
    robust: bool,
}

impl Shape {
    fn of(row: &CriticalRow) -> Result<Self, CaseError> {
        let with = |f_o| Parameters {
            f_o,
            ..row.parameters()
        };
        let cases: Vec<Parameters> = ForceScan::default().amplitudes().map(with).collect();
        let found = each(&cases, slides)?;
        // One start after the other, as most amplitudes fail at the first neighbours.
        let from_all = |case| -> Result<bool, CaseError> {
            for start in ensemble(case, MANY) {
                if !slides(&start)? {
                    return Ok(false);
                }
            }
            Ok(true)
        };
        let mut robust = false;
        for (case, _) in cases.iter().zip(&found).filter(|(_, slides)| **slides) {
            robust = robust || from_all(case)?;
        }
        let intervals = found.chunk_by(|p, q| p == q).filter(|part| part[0]);
        Ok(Self {
            class: (row.shape, row.r > 2.0),
            amplitudes: found.iter().filter(|slides| **slides).count(),
            intervals: intervals.count(),
            robust,
        })
    }
}

fn dying_snaps() -> Judged {
    /// A difference of times that no plot shows.
    const SAME: f64 = 1e-3;
    /// Velocities at which a cable is taken to stick. If the snaps die out there, it does not
    /// matter which.
    const STICKS: [f64; 2] = [1e-6, 1e-8];
    let mut verdicts = Vec::new();
    let mut words = Vec::new();
    for f_o in [0.2, 0.27, 0.4, 0.44] {
        let with = |v_stick| past_settling(standard(|p| (p.f_o, p.v_stick) = (f_o, v_stick)));
        let cases = STICKS.map(with);
        let first_slide = |case: &_| first_interval(case, |taut| taut.len() == 1);
        let starts: Vec<f64> = each(&cases, first_slide)?.into_iter().flatten().collect();
        let same = max(starts.iter().copied()) - min(starts.iter().copied()) < SAME;
        verdicts.push(Verdict::of(same && starts.len() == cases.len()));
        words.push(format!("{} at f_o = {f_o}", span(starts, 4)));
    }
    Ok(Finding::new(Verdict::all(verdicts)).value("times", words.join(", ")))
}

/// Why a run stops that has slid, and with how many taut cables.
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

/// Whether each of the ways to end is met.
fn all_met(ways: [usize; 3]) -> bool {
    !ways.contains(&0)
}

fn ends((study, _): &Material) -> Judged {
    let forces: Vec<f64> = (1..=18).map(|k| f64::from(k) / 20.0).collect();
    let cases = shapes_under(study, &forces);
    let [mut settle, mut limit, mut rock, mut going] = [0; 4];
    let mut at_bound = Vec::new();
    for (case, end) in cases.iter().zip(each(&cases, end_if_slid)?) {
        match end {
            None => {}
            Some((Stop::Settled, _)) => settle += 1,
            Some((Stop::RotationLimit, _)) => limit += 1,
            Some((Stop::UpperBound, _)) => at_bound.push(case.f_o),
            Some((_, taut)) if taut > 1 => rock += 1,
            Some(_) => going += 1,
        }
    }
    let (bound, named) = (at_bound.len(), settle + limit + rock);
    let all = named + bound + going;
    Ok(Finding::of(all_met([settle, limit, rock]))
        .values("all settle limit", [all, settle, limit])
        .values("rock going bound", [rock, going, bound])
        .found("others", bound + going > 0)
        .list("forces", at_bound))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_that_is_never_met_is_seen() {
        assert!(all_met([3, 1, 2]) && !all_met([3, 0, 2]));
    }
}
