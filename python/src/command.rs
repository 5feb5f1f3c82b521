//! The command `snapload`, and the chapter reproduced.

use crate::errors::internal_error;
use crate::interrupt::interruptible;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use snapload_reproduce::{Report, Study};
use std::ffi::OsString;

/// Does what a command line asks for, whose first word is the name of the program, and gives the
/// exit status.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, line: Vec<OsString>) -> u8 {
    py.detach(|| snapload_cli::command(line))
}

/// A file: its place below the directory of the report, and what it holds.
type Place<'py> = (String, Bound<'py, PyBytes>);

/// The files of the report on the chapter. The progress is reported in thousandths.
#[pyfunction]
pub(crate) fn reproduce<'py>(
    py: Python<'py>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<Place<'py>>> {
    let report = interruptible(py, progress, |shared| {
        let study = Study::compute(&|progress| {
            let thousandths = (1000.0 * progress.done / progress.of).floor();
            shared.report(snapload::analysis::Progress::new(
                progress.doing,
                thousandths,
                1000.0,
            ))
        });
        let study = study.map_err(|error| error.to_string())?;
        Report::new(&study).map_err(|error| error.to_string())
    })?;
    let files = report.map_err(internal_error)?.files.into_iter();
    let files = files.map(|(place, bytes)| (place, PyBytes::new(py, &bytes)));
    Ok(files.collect())
}
