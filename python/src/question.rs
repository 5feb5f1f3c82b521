//! Questions about one case: one function for all questions of the report crate.

use crate::case::{Case, checked};
use crate::errors::{error_of_work, internal_error};
use crate::interrupt::interruptible;
use crate::run::to_json;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use snapload::analysis::Progress;
use snapload::{CASE, Entries};
use snapload_report::question;
use std::sync::Arc;

/// Asks a question of a case, with its options by name: the answer for a person and for a program,
/// as JSON.
#[pyfunction]
pub(crate) fn answer(
    py: Python<'_>,
    name: &str,
    case: &Case,
    options: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let no_question = || internal_error(format!("there is no question {name:?}"));
    let question = question(name).ok_or_else(no_question)?;
    let options = checked(options, |name| question.option(name))?;
    let theirs = Arc::clone(&case.case);
    // Python's numbers are doubles.
    let entries = Entries::new(&CASE);
    let answer = interruptible(py, progress, move |shared| {
        let on_progress = |progress: Progress| shared.report(progress);
        question.ask(&theirs, &entries, options, &on_progress)
    })?;
    let answer = answer.map_err(error_of_work)?;
    to_json(&answer.about(&case.name, &case.case, &Entries::new(&CASE)))
}
