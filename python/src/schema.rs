//! The keys of a case, the columns of a study and the built-in cases, as Python's own lists.

use crate::case::Case;
use crate::errors::error_of_case;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use snapload::{KEYS, Kind, Limit, Parameters, Quantity, Stop};
use snapload::{named_cases as all_named_cases, title_of};

/// A unit as metadata after CF. A number in units of the case's own scales has no dimension: its
/// unit is 1, and `scale` says what it is to be multiplied by.
pub(crate) fn in_cf(unit: &str) -> [(&'static str, &str); 2] {
    match unit {
        "" => [("units", ""), ("scale", "")],
        "1" | "rad" => [("units", unit), ("scale", "")],
        _ => [("units", "1"), ("scale", unit)],
    }
}

/// Every key of a case, in its order: name, symbol, unit, meaning, type, what is allowed, default.
#[pyfunction]
pub(crate) fn keys(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let entries = KEYS.iter().map(|key| {
        let entry = PyDict::new(py);
        entry.set_item("name", key.name)?;
        entry.set_item("group", key.group)?;
        entry.set_item("symbol", key.symbol)?;
        entry.set_item("unit", key.unit)?;
        entry.set_item("cf", in_cf(key.unit).to_vec())?;
        entry.set_item("meaning", key.meaning)?;
        let title = match key.group {
            "start" => format!("start: {}", key.title()),
            _ => key.title().to_owned(),
        };
        entry.set_item("title", title)?;
        let (kind, words): (_, &[&str]) = match key.kind {
            Kind::Number { .. } => ("float", &[]),
            Kind::Count { .. } => ("int", &[]),
            Kind::Flag => ("bool", &[]),
            Kind::Choice(words) => ("str", words),
            Kind::Pair(_) | Kind::PerFreedom(_) | Kind::Triple(_) | Kind::Text => ("str", &[]),
        };
        entry.set_item("kind", kind)?;
        entry.set_item("words", words.to_vec())?;
        entry.set_item("allowed", key.allowed())?;
        entry.set_item("default", key.default_words())?;
        entry.set_item(
            "standard",
            crate::case::to_python(py, Parameters::STANDARD.get(key.name))?,
        )?;
        Ok(entry)
    });
    entries.collect()
}

/// Why a run may end; of a limit of the motion also the text of its bound.
#[pyfunction]
pub(crate) fn stops() -> Vec<(&'static str, Option<&'static str>)> {
    let name_and_bound = |stop: Stop| (stop.name(), stop.limit().map(Limit::bound_text));
    Stop::ALL.map(name_and_bound).to_vec()
}

/// The columns with the results of the runs of a study.
#[pyfunction]
pub(crate) fn columns(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let entries = snapload_study::columns().iter().map(|column| {
        let entry = PyDict::new(py);
        entry.set_item("name", column.name)?;
        entry.set_item("symbol", column.symbol)?;
        entry.set_item("unit", column.unit)?;
        entry.set_item("cf", in_cf(column.unit).to_vec())?;
        entry.set_item("meaning", column.meaning)?;
        entry.set_item("title", title_of(column.meaning))?;
        entry.set_item("words", column.words())?;
        Ok(entry)
    });
    entries.collect()
}

/// The quantities of runs, long motions, basins and branches.
#[pyfunction]
pub(crate) fn quantities(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let all = snapload::QUANTITIES.iter();
    let entries = all.chain(&snapload_orbits::QUANTITIES);
    let entry = |quantity: &Quantity| {
        let entry = PyDict::new(py);
        entry.set_item("name", quantity.name)?;
        entry.set_item("symbol", quantity.symbol)?;
        entry.set_item("unit", quantity.unit)?;
        entry.set_item("cf", in_cf(quantity.unit).to_vec())?;
        entry.set_item("meaning", quantity.meaning)?;
        entry.set_item("title", title_of(quantity.meaning))?;
        Ok(entry)
    };
    entries.map(entry).collect()
}

/// The built-in case of a code.
#[pyfunction]
pub(crate) fn named_case(code: &str) -> PyResult<Case> {
    let hint = "print(snapload.cases) lists them all";
    let named = snapload::named_case(code).map_err(|error| error_of_case(error.with_hint(hint)))?;
    Case::new(named.code.to_owned(), named.entries()).map_err(error_of_case)
}

/// The built-in cases: code, what there is to say of it, case.
#[pyfunction]
pub(crate) fn named_cases() -> PyResult<Vec<(&'static str, String, Case)>> {
    let cases = all_named_cases().map(|named| {
        let case = Case::new(named.code.to_owned(), named.entries()).map_err(error_of_case)?;
        Ok((named.code, named.origin(), case))
    });
    cases.collect()
}
