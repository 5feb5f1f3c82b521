//! The critical force, and the probability of exceeding the limits.

use crate::case::Case;
use crate::errors::{of_case, of_work};
use crate::interrupt::interruptible;
use crate::run::{read_uncertainty, to_json};
use pyo3::prelude::*;
use snapload::analysis::{CriticalForce, ExceedanceCurve, ForceScan};
use snapload_report::{CriticalRow, Probability};

/// The critical force of a case, as JSON.
#[pyfunction]
pub(crate) fn critical_force(py: Python<'_>, case: &Case, step: f64, max: f64) -> PyResult<String> {
    let scan = ForceScan::new(step, max).map_err(of_case)?;
    let parameters = *case.parameters();
    let found = interruptible(py, None, move |watch| {
        CriticalForce::scan(&parameters, scan, &|progress| watch.go_on(progress))
    })?;
    to_json(&CriticalRow::new(found.map_err(of_work)?))
}

/// The probability of exceeding at every amplitude, as JSON.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "called by one function of Python, by position"
)]
pub(crate) fn probability(
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
    let scan = ForceScan::new(step, max).map_err(of_case)?;
    let uncertainty = read_uncertainty(&case.case, uncertainty, tolerance)?;
    let parameters = *case.parameters();
    let curve = interruptible(py, progress, move |watch| {
        ExceedanceCurve::scan(
            &parameters,
            scan,
            &uncertainty,
            members,
            seed,
            &|progress| watch.go_on(progress),
        )
    })?;
    let curve = curve.map_err(of_work)?;
    to_json(&Probability::new(&curve, members, seed))
}
