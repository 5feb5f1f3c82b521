//! Runs of cases and of their neighbours, and what is read from a run.

use super::verdict::{Finding, Verdict};
use crate::ReportError;
use crate::study::{CaseRuns, CriticalRow, Reading, Study, first_exceeding};
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{
    Case, CaseError, Impact, Outcome, Parameters, Playback, State, Stop, System, TautSet,
    Trajectory, table_6_1,
};

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

/// The case itself and up to eight `neighbours`, started 1e-12 away in directions that are always
/// the same.
pub(super) fn ensemble(parameters: &Parameters, neighbours: usize) -> Vec<Parameters> {
    let directions = DIRECTIONS.iter().take(neighbours);
    let near = directions.map(|[x, y, theta]| Parameters {
        x: parameters.x + NEAR * x,
        y: parameters.y + NEAR * y,
        theta: parameters.theta + NEAR * theta,
        ..*parameters
    });
    std::iter::once(*parameters).chain(near).collect()
}

/// The standard case with some values changed.
pub(super) fn standard(change: impl FnOnce(&mut Parameters)) -> Parameters {
    let mut case = Parameters::STANDARD;
    change(&mut case);
    case
}

/// A case that goes on after it has settled.
pub(super) fn past_settling(case: Parameters) -> Parameters {
    Parameters {
        stop_when_settled: false,
        ..case
    }
}

/// The shapes of Table 6.2, each under these force amplitudes.
pub(super) fn shapes_under(study: &Study, forces: &[f64]) -> Vec<Parameters> {
    let shapes = study.critical.iter().map(CriticalRow::parameters);
    let all = shapes.flat_map(|case| forces.iter().map(move |f_o| (case, *f_o)));
    all.map(|(case, f_o)| Parameters { f_o, ..case }).collect()
}

/// A case in the chapter's reading.
pub(super) fn chapter(parameters: Parameters) -> Parameters {
    Reading::Chapter.apply(parameters)
}

/// What becomes of many cases, in their order.
pub(super) fn each<T: Send>(
    cases: &[Parameters],
    what: impl Fn(&Parameters) -> Result<T, CaseError> + Sync,
) -> Result<Vec<T>, CaseError> {
    in_parallel(cases.len(), |k| what(&cases[k]))
}

/// What becomes of a case and of its neighbours.
pub(super) fn near<T: Send>(
    parameters: &Parameters,
    neighbours: usize,
    what: impl Fn(&Parameters) -> Result<T, CaseError> + Sync,
) -> Result<Vec<T>, CaseError> {
    each(&ensemble(parameters, neighbours), what)
}

/// What becomes of many cases from each start, the cases' own starts first: `[start][case]`.
pub(super) fn from_starts<T: Send>(
    cases: &[Parameters],
    neighbours: usize,
    what: impl Fn(&Parameters) -> Result<T, CaseError> + Sync,
) -> Result<Vec<Vec<T>>, CaseError> {
    let ensembles = cases.iter().map(|case| ensemble(case, neighbours));
    let ensembles: Vec<Vec<Parameters>> = ensembles.collect();
    in_parallel(neighbours + 1, |start| {
        in_parallel(ensembles.len(), |case| what(&ensembles[case][start]))
    })
}

/// The run of a case.
pub(super) fn run(parameters: &Parameters) -> Result<Trajectory, CaseError> {
    Ok(Case::new(*parameters)?.run())
}

/// The outcome of a case; its run is not kept.
pub(super) fn outcome(parameters: &Parameters) -> Result<Outcome, CaseError> {
    Ok(Outcome::of(&Case::new(*parameters)?))
}

/// The critical force of a case that never exceeds: above all that do.
pub(super) const NEVER: f64 = 9.0;
/// Two amplitudes of the scan are equal within this.
pub(super) const SAME: f64 = 0.005;

/// The critical force of a case, by the scan of Table 6.2.
pub(super) fn critical_force(parameters: &Parameters) -> Result<f64, CaseError> {
    let first = first_exceeding(parameters, ForceScan::default())?;
    Ok(first.map_or(NEVER, |(f_o, _)| f_o))
}

/// A critical force in words.
pub(super) fn shown(f_cr: f64) -> String {
    if f_cr < NEVER {
        format!("{f_cr:.2}")
    } else {
        "none".to_owned()
    }
}

/// A case of the study.
pub(super) fn case<'a>(study: &'a Study, code: &str) -> Result<&'a CaseRuns, ReportError> {
    let missing = || ReportError::Claim(format!("the study has no case {code}"));
    study.case(code).ok_or_else(missing)
}

/// A row of Table 6.2.
pub(super) fn row(study: &Study, r: f64, size: [f64; 2]) -> Result<&CriticalRow, ReportError> {
    let mut rows = study.critical.iter();
    rows.find(|row| row.r == r && row.size == size)
        .ok_or_else(|| ReportError::Claim(format!("Table 6.2 has no row r = {r}, {size:?}")))
}

/// The codes of Table 6.1, each once.
pub(super) fn table_codes() -> Vec<&'static str> {
    let mut codes: Vec<&'static str> = Vec::new();
    for (_, code) in table_6_1() {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    codes
}

/// The cases of Table 6.1 with their neighbours, in the chapter's reading. The force is that of the
/// code where the printed one differs.
pub(super) struct Tabled<'a> {
    pub(super) study: &'a Study,
    pub(super) codes: Vec<&'static str>,
    pub(super) cases: Vec<Parameters>,
    /// `[start][case]`.
    runs: Vec<Vec<Trajectory>>,
}

impl<'a> Tabled<'a> {
    pub(super) fn new(study: &'a Study) -> Result<Self, ReportError> {
        let codes = table_codes();
        let case = |code: &&str| Ok(chapter(case(study, code)?.parameters));
        let cases: Vec<Parameters> = codes.iter().map(case).collect::<Result<_, ReportError>>()?;
        let runs = from_starts(&cases, MANY, run)?;
        Ok(Self {
            study,
            codes,
            cases,
            runs,
        })
    }

    /// The runs of all codes.
    pub(super) fn own(&self) -> &[Trajectory] {
        &self.runs[0]
    }

    /// The runs of some codes from each start, the cases' own first.
    pub(super) fn of<const N: usize>(
        &self,
        codes: [&str; N],
    ) -> Result<Vec<[&Trajectory; N]>, ReportError> {
        let mut places = [0; N];
        for (place, code) in places.iter_mut().zip(codes) {
            let found = self.codes.iter().position(|known| *known == code);
            *place = found.ok_or_else(|| ReportError::Claim(format!("no case {code}")))?;
        }
        let runs = self.runs.iter();
        Ok(runs.map(|runs| places.map(|k| &runs[k])).collect())
    }
}

/// Of a statement on a figure of each of some runs, asked from every start; gives the cases' own.
pub(super) fn measured<const N: usize>(
    name: &'static str,
    members: &[[&Trajectory; N]],
    figure: impl Fn(&Trajectory) -> f64,
    holds: impl Fn(&[f64; N]) -> bool,
) -> Finding {
    let figures = |runs: &[&Trajectory; N]| runs.map(&figure);
    Finding::robust(members, |runs| holds(&figures(runs))).list(name, figures(&members[0]))
}

/// A statement of each case by itself, from all starts.
pub(super) fn by_case<const N: usize>(
    members: &[[&Trajectory; N]],
    holds: impl Fn(&Trajectory) -> bool,
) -> [Verdict; N] {
    std::array::from_fn(|k| Verdict::robust(members.iter().map(|runs| holds(runs[k]))))
}

/// Whether a run left the range: rotation limit or upper bound.
pub(super) fn exceeds(run: &Trajectory) -> bool {
    run.end().reason.exceeds()
}

/// When the first interval begins, before the end of the run, in which such cables are taut.
pub(super) fn first_interval(
    parameters: &Parameters,
    such: impl Fn(TautSet) -> bool,
) -> Result<Option<f64>, CaseError> {
    let mut simulation = Case::new(*parameters)?.simulation();
    while let Some(step) = simulation.step() {
        if such(step.taut) && step.t_end > step.t_start {
            return Ok(Some(step.t_start));
        }
    }
    Ok(None)
}

/// When rocking (at least two taut cables) first begins.
pub(super) fn first_rocking(parameters: &Parameters) -> Result<Option<f64>, CaseError> {
    first_interval(parameters, |taut| taut.len() > 1)
}

/// Time and θ where the rotation turns back.
pub(super) fn turns(run: &Trajectory) -> Vec<(f64, f64)> {
    let turns =
        |hit: &&Impact| hit.before.vtheta == 0.0 || hit.before.vtheta * hit.after.vtheta < 0.0;
    let turning = run.impacts().iter().filter(turns);
    turning.map(|hit| (hit.t, hit.before.theta)).collect()
}

/// A swing of θ between two turns that is large \[rad\].
pub(super) const LARGE_SWING: f64 = 0.5;

/// The sizes of the swings of θ between its turns.
pub(super) fn swings(run: &Trajectory) -> Vec<f64> {
    let size = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1).abs();
    turns(run).windows(2).map(size).collect()
}

/// The largest rotation of a run.
pub(super) fn rotation(run: &Trajectory) -> f64 {
    run.norms().theta_max
}

/// The places at times a step apart, from a time to another one.
pub(super) fn places(run: &Trajectory, (from, to): (f64, f64), step: f64) -> Vec<[f64; 2]> {
    let mut playback = Playback::new(run);
    let count = ((to - from) / step).floor().max(0.0) as usize;
    (0..=count)
        .map(|k| from + k as f64 * step)
        .chain([to])
        .map(|t| playback.at(t).state)
        .map(|state| [state.x, state.y])
        .collect()
}

/// What a printed plot shows of a snap velocity.
pub(super) const CLEAR: f64 = 1e-2;

/// The impacts that a printed plot shows.
pub(super) fn clear(run: &Trajectory) -> impl Iterator<Item = &Impact> + Clone {
    run.impacts().iter().filter(|hit| hit.v_n > CLEAR)
}

/// The push of the wave at a time on a body in some state, away from the anchor of a cable.
pub(super) fn push(system: &System, cable: usize, t: f64, state: &State) -> f64 {
    let [nx, ny] = system.cables[cable].normal(state).n.components();
    let [fx, fy] = system.forcing.at(t).components();
    nx * fx + ny * (fy - system.forcing.constant.y)
}

/// The speed of the point of the body to which a cable is attached.
pub(super) fn attachment_speed(system: &System, cable: usize, state: &State) -> f64 {
    let (s, c) = state.theta.sin_cos();
    let [x, y] = system.cables[cable].lever(s, c).components();
    (state.vx - state.vtheta * y).hypot(state.vy + state.vtheta * x)
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

/// The endings of the cases themselves, the first of the members.
pub(super) fn endings<const N: usize>(members: &[[&Trajectory; N]]) -> String {
    members[0].map(ending).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn cases_are_asked_start_by_start() -> Result<(), CaseError> {
        let cases = [0.1, 0.2].map(|f_o| Parameters {
            f_o,
            ..Parameters::STANDARD
        });
        let found = from_starts(&cases, FEW, |case| Ok(*case))?;
        assert_eq!((found.len(), &found[0][..]), (4, &cases[..]));
        for (start, all) in found.iter().enumerate() {
            for (case, near) in cases.iter().zip(all) {
                assert_eq!(near, &ensemble(case, FEW)[start]);
            }
        }
        Ok(())
    }

    #[test]
    fn a_run_is_read_as_it_went() -> Result<(), CaseError> {
        let standard = chapter(Parameters::STANDARD);
        let strong = Parameters {
            f_o: 0.5,
            ..standard
        };
        let runs = each(&[standard, strong], run)?;
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
