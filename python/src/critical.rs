//! The critical force, and the probability of exceeding the limits.

use crate::case::Case;
use crate::errors::{error_of_study, error_of_work};
use crate::interrupt::interruptible;
use crate::run::{read_uncertainty, to_json};
use crate::study::Study;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use snapload::CaseError;
use snapload::analysis::{CriticalForce, ExceedanceCurve, ForceScan, Progress, Unfinished};
use snapload_report::{CriticalRow, Probability};
use std::sync::Arc;

/// The critical force of a case, as JSON.
#[pyfunction]
pub(crate) fn critical_force(py: Python<'_>, case: &Case, step: f64, max: f64) -> PyResult<String> {
    let scan = ForceScan::new(step, max).map_err(of_scan)?;
    let parameters = *case.parameters();
    let found = interruptible(py, None, move |shared| {
        CriticalForce::scan(&parameters, scan, &|progress| shared.report(progress))
    })?;
    to_json(&CriticalRow::new(found.map_err(error_of_work)?))
}

/// The critical force at every case of a grid, as JSON: a row a case, the last axis the quickest,
/// and what is no case as a row with words. With it the amplitudes.
#[pyfunction]
pub(crate) fn critical_force_over(
    py: Python<'_>,
    study: &Study,
    step: f64,
    max: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<f64>)> {
    let scan = ForceScan::new(step, max).map_err(of_scan)?;
    let study = Arc::clone(&study.study);
    let rows = interruptible(py, progress, move |shared| {
        let cases = study.cases(0..study.count())?;
        let all = cases.count() as f64;
        let rows = (0..cases.count()).map(|k| {
            let progress = Progress::new("critical force", k as f64, all);
            match cases.case(k) {
                Ok(case) => {
                    let parameters = case.parameters();
                    let found =
                        CriticalForce::scan(parameters, scan, &|_| shared.report(progress))?;
                    Ok(Row::Found(CriticalRow::new(found)))
                }
                Err(no_case) => Ok(Row::NoCase {
                    error: no_case.error.to_string(),
                }),
            }
        });
        Ok(rows.collect::<Result<Vec<_>, Unfinished>>())
    })?;
    let rows = rows.map_err(error_of_study)?;
    let rows = to_json(&rows.map_err(error_of_work)?)?;
    Ok((rows, scan.amplitudes().collect()))
}

/// What is found at one case of several.
#[derive(Serialize)]
#[serde(untagged)]
enum Row {
    Found(CriticalRow),
    NoCase { error: String },
}

/// The engine's `max` is Python's `largest`.
fn of_scan(error: CaseError) -> PyErr {
    let words = error.to_string();
    PyValueError::new_err(match words.strip_prefix("max ") {
        Some(rest) => format!("largest {rest}"),
        None => words,
    })
}

/// The critical force by its neighbours, and the probability of
/// exceeding at every amplitude, as JSON.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "called by one function of Python, by position"
)]
pub(crate) fn critical_force_of_ensemble(
    py: Python<'_>,
    case: &Case,
    step: f64,
    max: f64,
    uncertainty: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    members: u32,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let scan = ForceScan::new(step, max).map_err(of_scan)?;
    let uncertainty = read_uncertainty(&case.case, uncertainty, tolerance)?;
    let parameters = *case.parameters();
    let curve = interruptible(py, progress, move |shared| {
        ExceedanceCurve::scan(
            &parameters,
            scan,
            &uncertainty,
            members,
            seed,
            &|progress| shared.report(progress),
        )
    })?;
    let curve = curve.map_err(error_of_work)?;
    to_json(&WithProbability {
        row: CriticalRow::new(curve.critical_force()),
        curve: Probability::new(&curve, members, seed),
    })
}

#[derive(Serialize)]
struct WithProbability {
    #[serde(flatten)]
    row: CriticalRow,
    #[serde(flatten)]
    curve: Probability,
}
