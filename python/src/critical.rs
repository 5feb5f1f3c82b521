//! The critical force, and the probability of exceeding the limits.

use crate::case::Case;
use crate::errors::of_case;
use crate::interrupt::interruptible;
use crate::run::{doubt, to_json};
use pyo3::prelude::*;
use snapload::analysis::{CriticalForce, ExceedanceCurve, ForceScan};
use snapload_report::{CriticalRow, Probability};

/// The critical force of a case, as JSON.
#[pyfunction]
pub(crate) fn critical_force(py: Python<'_>, case: &Case, step: f64, max: f64) -> PyResult<String> {
    let scan = ForceScan::new(step, max).map_err(of_case)?;
    let parameters = *case.parameters();
    let found = interruptible(py, None, move |_| CriticalForce::scan(&parameters, scan))?;
    to_json(&CriticalRow(found.map_err(of_case)?))
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
    let doubt = doubt(&case.case, uncertainty, tolerance)?;
    let parameters = *case.parameters();
    let curve = interruptible(py, progress, move |pulse| {
        ExceedanceCurve::scan(&parameters, scan, &doubt, members, seed, |_| pulse.beat())
    })?;
    let curve = curve.map_err(of_case)?;
    to_json(&Probability {
        curve,
        members,
        seed,
    })
}
