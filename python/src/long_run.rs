//! Sections and diagrams of long motions, safe basins, basins of attraction, erosion.

use crate::case::Case;
use crate::errors::{error_of_case, error_of_work};
use crate::interrupt::{SharedProgress, interruptible};
use crate::orbit::Orbit;
use crate::run::to_json;
use crate::study::{Plain, axis};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use snapload::CaseError;
use snapload::analysis::{Progress, Unfinished};
use snapload_orbits::{
    AttractedCell, Attraction, AttractionRow, Basin, BasinRow, Cell, CellOutcome, DiagramRow,
    Erosion, ErosionRow, MOST_KEPT, Section, SectionOptions, SectionRow, Window,
};
use snapload_study::Values;
use std::ops::ControlFlow;

/// A key and its values.
type Side<'py> = (String, Bound<'py, PyAny>);

/// The most values of one key.
const MOST_VALUES: u64 = 1_000_000;

/// The values of an axis: a list, or the text `first:last:n`.
fn values_of((key, values): &Side<'_>) -> PyResult<(&'static str, Vec<f64>)> {
    let axis = axis(key, values)?;
    if axis.count() > MOST_VALUES {
        let words = format!("{key}: at most {MOST_VALUES} values");
        return Err(PyValueError::new_err(words));
    }
    let value = |k| axis.value(k).number().unwrap_or(f64::NAN);
    Ok((axis.key(), (0..axis.count()).map(value).collect()))
}

fn section_options(periods: u64, keep: u64, phase: f64) -> PyResult<SectionOptions> {
    snapload_orbits::section_options(periods, keep, phase).map_err(error_of_case)
}

/// A long motion once a period of the forcing, as JSON; with its impacts one by one if asked for.
#[pyfunction]
pub(crate) fn section(
    py: Python<'_>,
    case: &Case,
    periods: u64,
    keep: u64,
    phase: f64,
    impacts: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let options = SectionOptions {
        impacts,
        ..section_options(periods, keep, phase)?
    };
    let parameters = *case.parameters();
    let found = interruptible(py, progress, move |shared| {
        Section::of(&parameters, &options, &|progress| shared.report(progress))
    })?;
    let found = found.map_err(error_of_work)?;
    if let Some(kept) = found.impacts.as_ref().filter(|kept| kept.left_out > 0) {
        let count = kept.points.len() as u64 + kept.left_out;
        let allowed =
            format!("few enough periods for at most {MOST_KEPT} impacts; here there are {count}");
        return Err(error_of_case(CaseError::value("keep", keep, allowed)));
    }
    to_json(&SectionRow::new(&found, phase))
}

/// The attractor along the values of a key, as JSON: a row a value; with how many points there are
/// at each, and their states.
#[pyfunction]
pub(crate) fn diagram<'py>(
    py: Python<'py>,
    case: &Case,
    side: Side<'py>,
    down: bool,
    asked: (u64, u64, f64),
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(String, Vec<usize>, Bound<'py, PyByteArray>)> {
    let (periods, keep, phase) = asked;
    let options = section_options(periods, keep, phase)?;
    let (key, mut values) = values_of(&side)?;
    if down {
        values.reverse();
    }
    let parameters = *case.parameters();
    let found = interruptible(py, progress, move |shared| {
        let on_progress = |progress: Progress| shared.report(progress);
        snapload_orbits::diagram(&parameters, key, &values, &options, &on_progress)
    })?;
    let found = found.map_err(error_of_work)?;
    let rows: Vec<DiagramRow> = found.iter().map(DiagramRow::new).collect();
    let counts = found.iter().map(|at| at.section.points.len()).collect();
    let states = found
        .iter()
        .flat_map(|at| at.section.points.iter().flatten());
    let bytes: Vec<u8> = states.flat_map(|x| x.to_ne_bytes()).collect();
    Ok((to_json(&rows)?, counts, PyByteArray::new(py, &bytes)))
}

/// The window of two keys.
fn window(case: &Case, sides: &[Side<'_>; 2]) -> PyResult<Window> {
    let [(a, rows), (b, columns)] = [values_of(&sides[0])?, values_of(&sides[1])?];
    let window = Window {
        base: *case.parameters(),
        keys: [a, b],
        values: [rows, columns],
    };
    window.check().map_err(of_window)?;
    Ok(window)
}

/// What is the option `vary` of the command is an axis here.
fn of_window(error: CaseError) -> PyErr {
    let words = error.to_string();
    PyValueError::new_err(match words.strip_prefix("vary = ") {
        Some(rest) => format!("axis = {rest}"),
        None => words,
    })
}

fn of_unfinished(error: Unfinished) -> PyErr {
    match error {
        Unfinished::Case(error) => of_window(error),
        Unfinished::Cancelled(_) => error_of_work(error),
    }
}

/// Reports it in thousandths.
fn in_thousandths(shared: &SharedProgress, progress: Progress) -> ControlFlow<()> {
    let done = (1000.0 * progress.done / progress.of).floor();
    shared.report(Progress::new(progress.doing, done, 1000.0))
}

/// Name of a column, its type, its bytes, and its words.
type Filled<'py> = (
    &'static str,
    &'static str,
    Bound<'py, PyByteArray>,
    Vec<String>,
);

fn filled<'py>(py: Python<'py>, name: &'static str, values: Values) -> Filled<'py> {
    let plain = Plain::of(values);
    let bytes = PyByteArray::new(py, &plain.bytes);
    (name, plain.kind, bytes, plain.words)
}

fn words<'a>(of: impl Iterator<Item = Option<&'static str>> + 'a) -> Values {
    Values::Words(of.map(|word| word.map(Into::into)).collect())
}

/// Which starts of a window stay below the limits: measures as JSON, and the cells, the second key
/// varying fastest.
#[pyfunction]
pub(crate) fn safe_basin<'py>(
    py: Python<'py>,
    case: &Case,
    sides: [Side<'py>; 2],
    trust: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(String, Vec<Filled<'py>>)> {
    let window = window(case, &sides)?;
    let basin = interruptible(py, progress, move |shared| {
        Basin::of(window, trust, &|progress| in_thousandths(shared, progress))
    })?;
    let basin = basin.map_err(of_unfinished)?;
    let cells = || basin.cells.iter();
    let flags = |flag: fn(&Cell) -> bool| Values::Flags(cells().map(|c| Some(flag(c))).collect());
    let ends = words(cells().map(|cell| cell.end.map(|(stop, _)| stop.name())));
    let times = cells().map(|cell| cell.end.map(|(_, t)| t)).collect();
    let mut columns = vec![
        filled(py, "outcome", ends),
        filled(py, "t", Values::Numbers(times)),
        filled(py, "legal", flags(|cell| cell.end.is_some())),
        filled(py, "safe", flags(Cell::is_safe)),
    ];
    if trust {
        let decided = flags(|cell| cell.end.is_some() && cell.decided);
        let trusted = flags(|cell| cell.end.is_some() && cell.trusted);
        columns.push(filled(py, "decided", decided));
        columns.push(filled(py, "trusted", trusted));
    }
    Ok((to_json(&BasinRow::new(&basin))?, columns))
}

/// Which attractor the starts of a window come to: measures as JSON, the cells, and the attractors
/// whose orbits are closed.
#[pyfunction]
pub(crate) fn basins_of_attraction<'py>(
    py: Python<'py>,
    case: &Case,
    sides: [Side<'py>; 2],
    transient: u64,
    trust: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(String, Vec<Filled<'py>>, Vec<Option<Orbit>>)> {
    let window = window(case, &sides)?;
    let found = interruptible(py, progress, move |shared| {
        Attraction::of(window, transient, trust, &|progress| {
            in_thousandths(shared, progress)
        })
    })?;
    let found = found.map_err(of_unfinished)?;
    let outcomes = || found.cells.iter().map(|cell| &cell.outcome);
    let outcome = |outcome: &CellOutcome| match outcome {
        CellOutcome::Illegal => None,
        CellOutcome::Stopped(stop, _) => Some(stop.name()),
        CellOutcome::Attracted(_) => Some("attracted"),
        CellOutcome::Aperiodic => Some("aperiodic"),
    };
    let number = |outcome: &CellOutcome| match outcome {
        CellOutcome::Attracted(k) => Some(*k as i64 + 1),
        _ => None,
    };
    let mut columns = vec![
        filled(py, "outcome", words(outcomes().map(outcome))),
        filled(
            py,
            "attractor",
            Values::Counts(outcomes().map(number).collect()),
        ),
    ];
    if trust {
        let flags = |flag: fn(&AttractedCell) -> bool| {
            let of =
                |cell: &AttractedCell| Some(cell.outcome != CellOutcome::Illegal && flag(cell));
            Values::Flags(found.cells.iter().map(of).collect())
        };
        columns.push(filled(py, "decided", flags(|cell| cell.decided)));
        columns.push(filled(py, "trusted", flags(|cell| cell.trusted)));
    }
    let orbits = found.attractors.iter().map(|attractor| {
        let orbit = attractor.orbit.clone();
        orbit.map(|orbit| Orbit::of_case(case.clone(), orbit))
    });
    let orbits = orbits.collect();
    Ok((to_json(&AttractionRow::new(&found))?, columns, orbits))
}

/// How the safe part of a window shrinks along a third key, as JSON.
#[pyfunction]
pub(crate) fn erosion<'py>(
    py: Python<'py>,
    case: &Case,
    sides: [Side<'py>; 2],
    over: Side<'py>,
    trust: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<String> {
    let window = window(case, &sides)?;
    let (key, values) = values_of(&over)?;
    let found = interruptible(py, progress, move |shared| {
        let on_progress = |progress: Progress| in_thousandths(shared, progress);
        Erosion::of(&window, key, &values, trust, &on_progress)
    })?;
    to_json(&ErosionRow::new(&found.map_err(of_unfinished)?))
}
