//! Runs of a case and of its neighbours, and what is read from them.

use super::{Claim, Verdict, ensemble};
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::{Case, CaseError, Impact, Parameters, Playback, Stop, Trajectory};

/// A claim as it was judged; the remark is kept only where we disagree.
pub(super) fn judged(
    (id, section): (&'static str, &'static str),
    claim: &'static str,
    verdict: Verdict,
    evidence: String,
    remark: &'static str,
) -> Claim {
    let remark = match verdict {
        Verdict::Reproduced => "",
        _ => remark,
    };
    Claim {
        id,
        section,
        claim,
        verdict,
        evidence,
        remark,
    }
}

/// The runs of a case and of its neighbours, as the parameters have them.
pub(super) fn near(
    parameters: &Parameters,
    neighbours: usize,
) -> Result<Vec<Trajectory>, CaseError> {
    ensemble(parameters, neighbours)
        .into_par_iter()
        .map(|member| Ok(Case::new(member)?.run()))
        .collect()
}

/// The same for several cases.
pub(super) fn near_all(
    cases: &[Parameters],
    neighbours: usize,
) -> Result<Vec<Vec<Trajectory>>, CaseError> {
    cases
        .par_iter()
        .map(|parameters| near(parameters, neighbours))
        .collect()
}

/// Runs by case, turned to runs by member: the cases themselves first, then each neighbour.
pub(super) fn by_member(cases: &[Vec<Trajectory>]) -> Vec<Vec<&Trajectory>> {
    let members = cases.iter().map(Vec::len).min().unwrap_or(0);
    (0..members)
        .map(|member| cases.iter().filter_map(|runs| runs.get(member)).collect())
        .collect()
}

/// Cases of the study with their neighbours, in the chapter's reading.
pub(super) struct Near {
    codes: Vec<&'static str>,
    runs: Vec<Vec<Trajectory>>,
}

impl Near {
    /// All cases that begin from rest under a code of Table 6.1, the printed variants left out.
    pub(super) fn table(study: &Study, neighbours: usize) -> Result<Self, CaseError> {
        let mut codes: Vec<&'static str> = Vec::new();
        for (_, code) in snapload::TABLE_6_1 {
            if !codes.contains(&code) {
                codes.push(code);
            }
        }
        let cases: Vec<Parameters> = codes
            .iter()
            .filter_map(|code| Some(Reading::Chapter.apply(study.case(code)?.parameters)))
            .collect();
        let runs = near_all(&cases, neighbours)?;
        Ok(Self { codes, runs })
    }

    /// The runs of some codes, by member.
    pub(super) fn of(&self, codes: &[&str]) -> Vec<Vec<&Trajectory>> {
        let members = self.runs.first().map_or(0, Vec::len);
        let run = |code: &&str, member: usize| {
            let place = self.codes.iter().position(|known| known == code)?;
            self.runs.get(place)?.get(member)
        };
        (0..members)
            .map(|m| codes.iter().filter_map(|code| run(code, m)).collect())
            .collect()
    }
}

/// Whether a run left the range: rotation limit or upper bound.
pub(super) fn exceeds(run: &Trajectory) -> bool {
    matches!(run.end().reason, Stop::RotationLimit | Stop::UpperBound)
}

/// When the first interval of rocking (at least two taut cables) begins, before the end of the run.
pub(super) fn first_rocking(parameters: Parameters) -> Result<Option<f64>, CaseError> {
    let mut simulation = Case::new(parameters)?.simulation();
    while let Some(step) = simulation.step() {
        if step.taut.len() > 1 && step.t_end > step.t_start {
            return Ok(Some(step.t_start));
        }
    }
    Ok(None)
}

/// Time and θ where the rotation turns back.
pub(super) fn turns(run: &Trajectory) -> Vec<(f64, f64)> {
    run.impacts()
        .iter()
        .filter(|hit| hit.before.vtheta == 0.0 || hit.before.vtheta * hit.after.vtheta < 0.0)
        .map(|hit| (hit.t, hit.before.theta))
        .collect()
}

/// The places at times a step apart, from a time to another one.
pub(super) fn places(run: &Trajectory, (from, to): (f64, f64), step: f64) -> Vec<(f64, f64)> {
    let mut playback = Playback::new(run);
    let count = ((to - from) / step).floor().max(0.0) as usize;
    (0..=count)
        .map(|k| from + k as f64 * step)
        .chain([to])
        .map(|t| playback.at(t).state)
        .map(|state| (state.x, state.y))
        .collect()
}

/// Least and largest of values.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .into_iter()
        .fold(start, |(low, high), v| (low.min(v), high.max(v)))
}

/// Mean of values; 0 of none.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The impacts that a printed plot shows.
pub(super) fn clear(run: &Trajectory, above: f64) -> Vec<&Impact> {
    run.impacts().iter().filter(|hit| hit.v_n > above).collect()
}

/// Whether each value is above the one before it.
pub(super) fn rising(values: &[f64]) -> bool {
    values
        .windows(2)
        .all(|pair| matches!(pair, [a, b] if a < b))
}

/// Whether each value is below the one before it.
pub(super) fn falling(values: &[f64]) -> bool {
    values
        .windows(2)
        .all(|pair| matches!(pair, [a, b] if a > b))
}

/// Values as a list in words.
pub(super) fn list(values: &[f64], digits: usize) -> String {
    let words: Vec<String> = values.iter().map(|v| format!("{v:.digits$}")).collect();
    words.join(", ")
}

/// How a run ended and when, in words.
pub(super) fn ending(run: &Trajectory) -> String {
    let reason = match run.end().reason {
        Stop::Settled => "settles",
        Stop::RotationLimit => "rotation limit",
        Stop::UpperBound => "upper bound",
        Stop::SlidingStart => "slides",
        Stop::EndTime => "goes on",
        Stop::ImpactLimit => "impact limit",
    };
    format!("{reason} at {:.3}", run.end().t)
}

/// The endings of the cases themselves.
pub(super) fn endings(members: &[Vec<&Trajectory>]) -> String {
    let words: Vec<String> = members
        .first()
        .into_iter()
        .flatten()
        .map(|run| ending(run))
        .collect();
    words.join(", ")
}

/// A value of each run of the cases themselves, as a list in words.
pub(super) fn nominal(
    members: &[Vec<&Trajectory>],
    digits: usize,
    value: impl Fn(&Trajectory) -> f64,
) -> String {
    let values: Vec<f64> = members
        .first()
        .into_iter()
        .flatten()
        .map(|run| value(run))
        .collect();
    list(&values, digits)
}
