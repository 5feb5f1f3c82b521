//! Errors of the library as Python exceptions, with the same messages.

use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use snapload::CaseError;
use snapload::analysis::Unfinished;
use snapload_study::{StudyError, no_random_range};
use std::fmt::Display;

/// A value that is not allowed.
pub(crate) fn error_of_case(error: CaseError) -> PyErr {
    PyValueError::new_err(error.off_the_command_line().to_string())
}

/// A value that is not allowed, or work that was interrupted.
pub(crate) fn error_of_work(error: Unfinished) -> PyErr {
    match error {
        Unfinished::Case(error) => error_of_case(error),
        Unfinished::Cancelled(cancelled) => PyKeyboardInterrupt::new_err(cancelled.to_string()),
    }
}

/// A study that is not allowed, or that can not be read or written.
pub(crate) fn error_of_study(error: StudyError) -> PyErr {
    match error {
        StudyError::Failed(message) => PyOSError::new_err(message),
        StudyError::Damaged { .. } => PyOSError::new_err(error.to_string()),
        StudyError::Occupied(there) => PyValueError::new_err(there.in_words("resume=True", "out")),
        StudyError::NoRandomRange(most) => {
            PyValueError::new_err(no_random_range(most, "its two ends, such as e=(0.5, 0.9)"))
        }
        StudyError::Cancelled(cancelled) => error_of_work(cancelled.into()),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// What can not happen as long as the program is right.
pub(crate) fn internal_error(error: impl Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}
