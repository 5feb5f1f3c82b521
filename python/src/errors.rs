//! Errors of the library as Python's, with the same words.

use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use snapload::CaseError;
use snapload_study::StudyError;
use std::fmt::Display;

/// A value that is not allowed.
pub(crate) fn of_case(error: CaseError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A study that is not allowed, or that can not be read or written.
pub(crate) fn of_study(error: StudyError) -> PyErr {
    match error {
        // The words are the command's; an option is a keyword here.
        StudyError::Input(words) => PyValueError::new_err(
            words
                .replace("--resume", "resume=True")
                .replace("--out", "out"),
        ),
        StudyError::Failed(words) => PyOSError::new_err(words),
    }
}

/// What can not happen as long as the program is right.
pub(crate) fn of_program(error: impl Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}
