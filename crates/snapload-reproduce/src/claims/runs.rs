//! Runs of cases and of their neighbours, and quantities of a run.

use super::numbers::between;
use super::verdict::{Finding, Verdict};
use crate::ReportError;
use crate::critical_row::CriticalRow;
use crate::reading::first_exceeding;
use crate::study::{CaseRuns, LARGEST, Reading, Study};
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{Case, CaseError, Outcome, Parameters, Trajectory, table_6_1};
use snapload_verify::RoundedRun;

/// The distance of neighbours from a start.
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

/// The number of neighbours where few cases are run.
pub(crate) const MANY: usize = 8;
/// The number of neighbours where many cases are run.
pub(crate) const FEW: usize = 3;

/// The case itself and up to eight `neighbours`, whose starts are 1e-12 away in fixed directions.
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

/// A case that continues after it has settled.
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

/// The results for many cases, in their order.
pub(super) fn each<T: Send>(
    cases: &[Parameters],
    what: impl Fn(&Parameters) -> Result<T, CaseError> + Sync,
) -> Result<Vec<T>, CaseError> {
    in_parallel(cases.len(), |k| what(&cases[k]))
}

/// The results for a case and its neighbours.
pub(super) fn near<T: Send>(
    parameters: &Parameters,
    neighbours: usize,
    what: impl Fn(&Parameters) -> Result<T, CaseError> + Sync,
) -> Result<Vec<T>, CaseError> {
    each(&ensemble(parameters, neighbours), what)
}

/// The results for many cases from each start, the cases' own starts first: `[start][case]`.
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

/// A function of the runs of many cases from each start, `[start][case]`, in doubles.
pub(super) fn of_runs<T: Send>(
    cases: &[Parameters],
    neighbours: usize,
    what: impl Fn(&RoundedRun) -> T + Sync,
) -> Result<Vec<Vec<T>>, CaseError> {
    from_starts(cases, neighbours, |case| {
        Ok(what(&RoundedRun::of_doubles(case)?))
    })
}

/// The same, with the first runs in 76 digits.
pub(super) fn of_exact_runs<T: Send>(
    cases: &[Parameters],
    neighbours: usize,
    what: impl Fn(&RoundedRun) -> T + Sync,
) -> Result<Vec<Vec<T>>, CaseError> {
    let mut of_starts = of_runs(cases, neighbours, &what)?;
    of_starts[0] = each(cases, |case| Ok(what(&RoundedRun::of_76_digits(case)?)))?;
    Ok(of_starts)
}

/// The outcome of a case; its run is not kept.
pub(super) fn outcome(parameters: &Parameters) -> Result<Outcome, CaseError> {
    Ok(Outcome::of(&Case::new(*parameters)?))
}

/// A stand-in for the critical force of a case that never exceeds: larger than any real one.
pub(super) const NEVER: f64 = 9.0;
/// Two amplitudes of the scan that differ by less than this are equal.
pub(super) const SAME: f64 = 0.005;

/// The critical force of a case, in hundredths.
pub(super) fn critical_force(parameters: &Parameters) -> Result<f64, CaseError> {
    let first = first_exceeding(parameters, ForceScan::new(0.01, LARGEST)?)?;
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

/// The least and the greatest of critical forces in words.
pub(super) fn shown_span(forces: impl IntoIterator<Item = f64>) -> String {
    between(forces, shown)
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

/// The cases of Table 6.1 in many digits, with their neighbours in doubles, in the chapter's
/// reading. The force is that of the code if the printed one differs.
pub(super) struct TableRuns<'a> {
    pub(super) study: &'a Study,
    pub(super) codes: Vec<&'static str>,
    pub(super) cases: Vec<Parameters>,
    /// `[start][case]`.
    runs: Vec<Vec<RoundedRun>>,
}

impl<'a> TableRuns<'a> {
    pub(super) fn new(study: &'a Study) -> Result<Self, ReportError> {
        let codes = table_codes();
        let runs = codes.iter().map(|code| case(study, code));
        let of_codes: Vec<&CaseRuns> = runs.collect::<Result<_, ReportError>>()?;
        let cases = of_codes.iter().map(|case| chapter(case.parameters));
        let cases: Vec<Parameters> = cases.collect();
        let mut runs = from_starts(&cases, MANY, RoundedRun::of_doubles)?;
        runs[0] = of_codes.iter().map(|case| case.exact.clone()).collect();
        Ok(Self {
            study,
            codes,
            cases,
            runs,
        })
    }

    /// The runs of all codes.
    pub(super) fn own(&self) -> &[RoundedRun] {
        &self.runs[0]
    }

    /// The runs of all codes from each start, those in many digits first.
    pub(super) fn members(&self) -> impl Iterator<Item = &[RoundedRun]> {
        self.runs.iter().map(Vec::as_slice)
    }

    /// The runs of some codes from each start, the cases' own first.
    pub(super) fn of<const N: usize>(
        &self,
        codes: [&str; N],
    ) -> Result<Vec<[&RoundedRun; N]>, ReportError> {
        let mut places = [0; N];
        for (place, code) in places.iter_mut().zip(codes) {
            let found = self.codes.iter().position(|known| *known == code);
            *place = found.ok_or_else(|| ReportError::Claim(format!("no case {code}")))?;
        }
        let runs = self.runs.iter();
        Ok(runs.map(|runs| places.map(|k| &runs[k])).collect())
    }
}

/// The finding on a statement about a quantity of each of some runs, from every start.
pub(super) fn measured<const N: usize>(
    name: &'static str,
    members: &[[&RoundedRun; N]],
    figure: impl Fn(&RoundedRun) -> f64,
    holds: impl Fn(&[f64; N]) -> bool,
) -> Finding {
    let figures: Vec<[f64; N]> = members.iter().map(|runs| runs.map(&figure)).collect();
    Finding::robust(&figures, holds).by_start(name, figures)
}

/// The finding on a statement about each case by itself, from all starts.
pub(super) fn by_case<const N: usize>(
    members: &[[&RoundedRun; N]],
    holds: impl Fn(&RoundedRun) -> bool,
) -> [Verdict; N] {
    std::array::from_fn(|k| Verdict::robust(members.iter().map(|runs| holds(runs[k]))))
}

/// When rocking (at least two taut cables) first begins, before the end of the run.
pub(super) fn first_rocking(parameters: &Parameters) -> Result<Option<f64>, CaseError> {
    let mut simulation = Case::new(*parameters)?.simulation();
    while let Some(step) = simulation.step() {
        if step.taut.len() > 1 && step.t_end > step.t_start {
            return Ok(Some(step.t_start));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::motions::{CLEAR, clear, ending, exceeds, swings, turns};
    use snapload::Stop;

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
    fn cases_are_computed_start_by_start() -> Result<(), CaseError> {
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
    fn runs_are_described_as_computed() -> Result<(), CaseError> {
        let standard = chapter(Parameters::STANDARD);
        let strong = Parameters {
            f_o: 0.5,
            ..standard
        };
        let runs = each(&[standard, strong], RoundedRun::of_76_digits)?;
        assert_eq!(runs.iter().map(exceeds).collect::<Vec<_>>(), [false, true]);
        assert_eq!(ending(runs[0].end()), "settles at 7.246");
        assert!(clear(&runs[0]).all(|hit| hit.v_n > CLEAR));
        assert_eq!(swings(&runs[0]).len() + 1, turns(&runs[0]).len());
        // The first amplitude exceeds, and there is no smaller one.
        let scan = ForceScan::new(0.1, 1.0)?;
        let first = first_exceeding(&standard, scan)?;
        assert_eq!(first, Some((0.5, Stop::RotationLimit)));
        let calm = ForceScan::new(0.1, 0.4)?;
        assert_eq!(first_exceeding(&standard, calm)?, None);
        Ok(())
    }
}
