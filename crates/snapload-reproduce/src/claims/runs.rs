//! Runs of cases and of their neighbours, and what is read from a run.

use super::numbers::list;
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::{Case, CaseError, Impact, Parameters, Playback, Stop, TABLE_6_1, Trajectory};

/// How far the neighbours of a start are from it.
const NEAR: f64 = 1e-12;

/// Directions in x, y and θ in which the neighbours lie.
const DIRECTIONS: [[f64; 3]; 8] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [-1.0, -1.0, 1.0],
];

/// Neighbours where few cases are asked.
pub(super) const MANY: usize = 8;
/// Neighbours where many cases are asked.
pub(super) const FEW: usize = 3;

/// The case itself and up to eight `neighbours`, started 1e-12 away in directions that are always the
/// same.
pub(super) fn ensemble(parameters: &Parameters, neighbours: usize) -> Vec<Parameters> {
    let near = DIRECTIONS
        .iter()
        .take(neighbours)
        .map(|[x, y, theta]| Parameters {
            x: parameters.x + NEAR * x,
            y: parameters.y + NEAR * y,
            theta: parameters.theta + NEAR * theta,
            ..*parameters
        });
    std::iter::once(*parameters).chain(near).collect()
}

/// A case in the chapter's reading.
pub(super) fn chapter(parameters: Parameters) -> Parameters {
    Reading::Chapter.apply(parameters)
}

/// What becomes of many cases, in their order.
pub(super) fn of_all<T: Send>(
    cases: &[Parameters],
    what: impl Fn(Case) -> T + Sync,
) -> Result<Vec<T>, CaseError> {
    cases
        .par_iter()
        .map(|parameters| Ok(what(Case::new(*parameters)?)))
        .collect()
}

/// The runs of many cases, in their order.
pub(super) fn run_all(cases: &[Parameters]) -> Result<Vec<Trajectory>, CaseError> {
    of_all(cases, |case| case.run())
}

/// The runs of a case and of its neighbours.
pub(super) fn near(
    parameters: &Parameters,
    neighbours: usize,
) -> Result<Vec<Trajectory>, CaseError> {
    run_all(&ensemble(parameters, neighbours))
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

/// Things by case and member, turned to things by member and case: the cases themselves first, then
/// each neighbour.
pub(super) fn by_member<T>(cases: &[Vec<T>]) -> Vec<Vec<&T>> {
    let members = cases.iter().map(Vec::len).min().unwrap_or(0);
    (0..members)
        .map(|member| cases.iter().filter_map(|all| all.get(member)).collect())
        .collect()
}

/// The codes of Table 6.1, each once.
pub(super) fn table_codes() -> Vec<&'static str> {
    let mut codes: Vec<&'static str> = Vec::new();
    for (_, code) in TABLE_6_1 {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    codes
}

/// The cases of Table 6.1 with their neighbours, in the chapter's reading. The force is that of the
/// code where the printed one differs.
pub(super) struct Tabled {
    codes: Vec<&'static str>,
    runs: Vec<Vec<Trajectory>>,
}

impl Tabled {
    pub(super) fn new(study: &Study) -> Result<Self, CaseError> {
        let codes = table_codes();
        let cases: Vec<Parameters> = codes
            .iter()
            .filter_map(|code| Some(chapter(study.case(code)?.parameters)))
            .collect();
        let runs = near_all(&cases, MANY)?;
        Ok(Self { codes, runs })
    }

    /// The runs of all codes, by member.
    pub(super) fn all(&self) -> Vec<Vec<&Trajectory>> {
        by_member(&self.runs)
    }

    /// The runs of some codes, by member.
    pub(super) fn of(&self, codes: &[&str]) -> Vec<Vec<&Trajectory>> {
        let place = |code: &&str| self.codes.iter().position(|known| known == code);
        let places: Vec<usize> = codes.iter().filter_map(place).collect();
        let mut all = self.all();
        for runs in &mut all {
            *runs = places.iter().map(|k| runs[*k]).collect();
        }
        all
    }
}

/// Whether a run left the range: rotation limit or upper bound.
pub(super) fn exceeds(run: &Trajectory) -> bool {
    matches!(run.end().reason, Stop::RotationLimit | Stop::UpperBound)
}

/// When the first interval of rocking (at least two taut cables) begins, before the end of the run.
pub(super) fn first_rocking(case: &Case) -> Option<f64> {
    let mut simulation = case.simulation();
    while let Some(step) = simulation.step() {
        if step.taut.len() > 1 && step.t_end > step.t_start {
            return Some(step.t_start);
        }
    }
    None
}

/// Time and θ where the rotation turns back.
pub(super) fn turns(run: &Trajectory) -> Vec<(f64, f64)> {
    run.impacts()
        .iter()
        .filter(|hit| hit.before.vtheta == 0.0 || hit.before.vtheta * hit.after.vtheta < 0.0)
        .map(|hit| (hit.t, hit.before.theta))
        .collect()
}

/// A swing of θ between two turns that is large \[rad\].
pub(super) const LARGE_SWING: f64 = 0.5;

/// The sizes of the swings of θ between its turns.
pub(super) fn swings(run: &Trajectory) -> Vec<f64> {
    let size = |pair: &[(f64, f64)]| match pair {
        [p, q] => (q.1 - p.1).abs(),
        _ => 0.0,
    };
    turns(run).windows(2).map(size).collect()
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

/// What a printed plot shows of a snap velocity.
pub(super) const CLEAR: f64 = 1e-2;

/// The impacts that a printed plot shows.
pub(super) fn clear(run: &Trajectory) -> impl Iterator<Item = &Impact> + Clone {
    run.impacts().iter().filter(|hit| hit.v_n > CLEAR)
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
    let own = members.first().into_iter().flatten();
    let words: Vec<String> = own.map(|run| ending(run)).collect();
    words.join(", ")
}

/// A value of each run of the cases themselves, as a list in words.
pub(super) fn nominal(
    members: &[Vec<&Trajectory>],
    digits: usize,
    value: impl Fn(&Trajectory) -> f64,
) -> String {
    let own = members.first().into_iter().flatten();
    let values: Vec<f64> = own.map(|run| value(run)).collect();
    list(&values, digits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::first_exceeding;
    use snapload::analysis::ForceScan;

    #[test]
    fn neighbours_are_near_and_differ() {
        let all = ensemble(&Parameters::STANDARD, MANY);
        assert_eq!((all.len(), all[0]), (9, Parameters::STANDARD));
        for (k, member) in all.iter().enumerate() {
            assert!(all[..k].iter().all(|other| other != member));
            assert!((member.y - 0.1).abs() <= 1.1 * NEAR);
        }
    }

    #[test]
    fn members_and_cases_change_places() {
        let cases = vec![vec![1, 2, 3], vec![4, 5, 6]];
        assert_eq!(by_member(&cases), [[&1, &4], [&2, &5], [&3, &6]]);
    }

    #[test]
    fn a_run_is_read_as_it_went() -> Result<(), CaseError> {
        let standard = chapter(Parameters::STANDARD);
        let strong = Parameters {
            f_o: 0.5,
            ..standard
        };
        let runs = run_all(&[standard, strong])?;
        assert_eq!(runs.iter().map(exceeds).collect::<Vec<_>>(), [false, true]);
        assert!(ending(&runs[0]).starts_with("settles at 7.2"));
        assert!(clear(&runs[0]).all(|hit| hit.v_n > CLEAR));
        assert_eq!(swings(&runs[0]).len() + 1, turns(&runs[0]).len());
        // The first that exceeds, and nothing below it.
        let scan = ForceScan::new(0.1, 1.0)?;
        let first = first_exceeding(&standard, scan)?;
        assert_eq!(first, Some((0.5, Stop::RotationLimit)));
        let calm = ForceScan::new(0.1, 0.4)?;
        assert_eq!(first_exceeding(&standard, calm)?, None);
        Ok(())
    }
}
