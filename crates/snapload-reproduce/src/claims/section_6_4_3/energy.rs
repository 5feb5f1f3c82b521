//! How soon and how effectively energy is dissipated.

use super::{Sweep, Sweeps, Swept, USUAL, below_critical, place};
use crate::claims::numbers::{count, max, min, span};
use crate::claims::runs::{FEW, chapter, from_starts, past_settling, run, standard};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::{CaseError, Parameters, Playback, Stop};

pub(super) const CHECKS: &Checks<fn(&Sweeps) -> Checked> =
    &[("6.4.3-18", dissipated), ("6.4.3-20", optimum)];

/// A measure of how effectively energy is dissipated; larger is better.
type Effect = (&'static str, fn(&Swept) -> f64);
const EFFECTS: [Effect; 3] = [
    ("energy lost in the impacts", |run| run.lost),
    ("the same per unit of time", |run| run.lost / run.t),
    ("least sum of snap velocities", |run| -run.norms.rho3),
];

/// Whether a quantity is greatest at an inner one of the runs, and the force of that run.
fn greatest(runs: &[&Swept], of: fn(&Swept) -> f64) -> Option<(bool, f64)> {
    let values: Vec<f64> = runs.iter().map(|run| of(run)).collect();
    let k = place(&values, 0, values.len(), 1.0)?;
    Some((k > 0 && k + 1 < values.len(), runs[k].f_o))
}

fn optimum(sweeps: &Sweeps) -> Checked {
    let settled = |sweep: &'_ Sweep| -> Vec<Swept> {
        let settled = sweep.iter().filter(|run| run.reason == Stop::Settled);
        settled.cloned().collect()
    };
    let starts: Vec<Vec<Swept>> = sweeps.long.iter().map(settled).collect();
    let by_effect = EFFECTS.map(|(name, of)| {
        let best = starts
            .iter()
            .map(|runs| greatest(&runs.iter().collect::<Vec<_>>(), of));
        let best: Vec<Option<(bool, f64)>> = best.collect();
        let forces = || best.iter().flatten().map(|best| best.1);
        let same = max(forces()) - min(forces()) < 0.015;
        let inside = best
            .iter()
            .map(|best| same && best.is_some_and(|best| best.0));
        (
            Verdict::robust(inside),
            format!("{name} at f_o = {}", span(forces(), 2)),
        )
    });
    let words = by_effect
        .each_ref()
        .map(|(_, words)| words.as_str())
        .join("; ");
    let verdicts = by_effect.each_ref().map(|(verdict, _)| *verdict);
    let lost = starts
        .iter()
        .map(|runs| runs.iter().map(|run| run.lost).collect::<Vec<_>>());
    Ok(Finding::new(Verdict::families(verdicts))
        .value("best", words)
        .by_start("lost", lost))
}

/// Energy counts as dissipated if at least this part is gone of what the body has at the start
/// above its lowest position.
const DISSIPATED_PART: f64 = 0.9;
/// The time by which it has to be gone, and the end of the runs.
const DISSIPATION_TIME: f64 = 10.0;

/// The time at which a run exceeds, if it does, and its mechanical energy at t = 10.
type Left = (Option<f64>, f64);

/// The result for a case that only the limits end.
fn without_stops(case: &Parameters) -> Result<Left, CaseError> {
    let case = Parameters {
        stop_when_sliding: false,
        t_end: 2.0 * DISSIPATION_TIME,
        ..past_settling(*case)
    };
    let run = run(&case)?;
    let exceeds = run.end().reason.exceeds().then_some(run.end().t);
    Ok((exceeds, Playback::new(&run).at(DISSIPATION_TIME).energy))
}

/// Whether a run has dissipated its energy by t = 10: it has not exceeded until then, and has
/// little of its first energy left.
fn is_dissipated((exceeds, energy): &Left) -> bool {
    exceeds.is_none_or(|t| t > DISSIPATION_TIME)
        && *energy <= (1.0 - DISSIPATED_PART) * Parameters::STANDARD.y
}

fn dissipated(sweeps: &Sweeps) -> Checked {
    let of_length = |r: f64, sweep: &Sweep| {
        let cases = below_critical(sweep).iter();
        let cases = cases.map(|run| chapter(standard(|p| (p.r, p.f_o) = (r, run.f_o))));
        from_starts(&cases.collect::<Vec<_>>(), FEW, without_stops)
    };
    let lengths = [
        of_length(1.5, &sweeps.short[0])?,
        of_length(2.5, &sweeps.long[0])?,
    ];
    let mut verdicts = Vec::new();
    let words = lengths.map(|starts| {
        let usual = |runs: &Vec<_>| count(runs, is_dissipated) as f64 >= USUAL * runs.len() as f64;
        verdicts.push(Verdict::robust(starts.iter().map(usual)));
        let spans = |holds: &dyn Fn(&Left) -> bool| {
            span(starts.iter().map(|runs| count(runs, holds) as f64), 0)
        };
        let exceed = spans(&|run| run.0.is_some_and(|t| t <= DISSIPATION_TIME));
        format!(
            "{} of {} ({exceed} exceed the limits before)",
            spans(&is_dissipated),
            starts[0].len()
        )
    });
    let soon = |sweep: &Sweep| {
        count(below_critical(sweep), |run| {
            run.reason == Stop::Settled && run.t < DISSIPATION_TIME
        }) as f64
    };
    let stopped = [&sweeps.short, &sweeps.long].map(|starts| span(starts.iter().map(soon), 0));
    Ok(Finding::new(Verdict::families(verdicts))
        .values("short long", words)
        .value("stopped", stopped.join(" and "))
        .values(
            "gone usual soon",
            [100.0 * DISSIPATED_PART, 100.0 * USUAL, DISSIPATION_TIME],
        ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload_verify::RoundedRun;

    #[test]
    fn a_stop_is_no_dissipation() {
        // Little energy left; much of it; little, but the limit was reached before.
        assert!(is_dissipated(&(None, 0.005)) && is_dissipated(&(Some(12.0), 0.005)));
        assert!(!is_dissipated(&(None, 0.05)) && !is_dissipated(&(Some(8.0), 0.005)));
    }

    #[test]
    fn an_optimum_lies_inside() -> Result<(), CaseError> {
        let run = RoundedRun::of_doubles(&Parameters {
            e: 0.5,
            ..Parameters::STANDARD
        })?;
        let losing = |lost: f64| Swept {
            lost,
            ..Swept::new(&run)
        };
        let inside = |lost: [f64; 3]| {
            let runs = lost.map(losing);
            greatest(&runs.each_ref(), EFFECTS[0].1).is_some_and(|best| best.0)
        };
        assert!(inside([1.0, 3.0, 2.0]));
        // A minimum in between is no optimum, nor is a maximum at an end.
        assert!(!inside([3.0, 1.0, 2.0]) && !inside([1.0, 2.0, 3.0]));
        Ok(())
    }
}
