//! A run, and what is known of it.

use crate::case::Case;
use crate::errors::{of_case, of_program};
use crate::interrupt::interruptible;
use crate::table::Table;
use arrow_array::builder::{Int64Builder, ListBuilder};
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{Field, Schema};
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use serde::Serialize;
use snapload::analysis::{Ensemble, START_KEYS, Uncertainty};
use snapload::{CaseError, Playback, Value};
use snapload_report::{
    CaseEcho, EndRow, MOST_ROWS, MotionRow, NormsRow, OutcomeRow, Report, Sampling, ShareRow,
    TrustRow, Trusted, Verified, VerifiedRow, components, summary,
};
use std::collections::HashMap;
use std::sync::Arc;

/// A finished run.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Run {
    pub(crate) case: Case,
    pub(crate) trusted: Arc<Trusted>,
}

/// What a run comes to, without its tables.
#[derive(Serialize)]
struct Head<'a> {
    case: CaseEcho<'a>,
    end: EndRow,
    state: [f64; 6],
    outcome: OutcomeRow,
    trust: TrustRow<'a>,
    norms: NormsRow,
}

/// The numbers of a [`MotionRow`].
const COMPONENTS: usize = 10;

#[pymethods]
impl Run {
    /// How it ended, norms, outcome and trust, as JSON.
    fn head(&self) -> PyResult<String> {
        let run = &self.trusted.run;
        to_json(&Head {
            case: CaseEcho(self.case.parameters()),
            end: EndRow::new(run.end()),
            state: components(&run.end().state),
            outcome: OutcomeRow::new(&self.trusted),
            trust: TrustRow::new(&self.trusted),
            norms: NormsRow::new(run.norms()),
        })
    }

    /// The line that `snapload run --json -` writes.
    #[pyo3(signature = (dt=None))]
    fn to_json(&self, dt: Option<f64>) -> PyResult<String> {
        let sampling = dt.map(|dt| self.sampling(dt)).transpose()?;
        let report = Report::new(self.case.parameters(), &self.trusted, sampling, &|_| ());
        to_json(&report)
    }

    /// What `snapload run` prints.
    fn summary(&self) -> String {
        summary(&self.case.name, self.case.parameters(), &self.trusted, &[])
    }

    /// The impacts, a row an impact and cable.
    fn impacts(&self) -> PyResult<Table> {
        let impacts = self.trusted.run.impacts();
        let number = |of: &dyn Fn(&snapload::Impact) -> f64| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(impacts.iter().map(of)))
        };
        let cables = impacts.iter().map(|impact| impact.cable as i64 + 1);
        let mut columns: Vec<(String, &str, &str, ArrayRef)> = vec![
            ("t".into(), "T", "time", number(&|i| i.t)),
            (
                "cable".into(),
                "",
                "cable, 1 or 2",
                Arc::new(Int64Array::from_iter_values(cables)),
            ),
            (
                "v_n".into(),
                "L/T",
                "normal velocity just before; 0 where an impulse was passed on",
                number(&|i| i.v_n),
            ),
            (
                "impulse".into(),
                "m L/T",
                "impulse in the cable",
                number(&|i| i.impulse),
            ),
            (
                "energy_lost".into(),
                "F L",
                "energy lost",
                number(&|i| i.energy_lost),
            ),
        ];
        for (k, name) in START_KEYS.into_iter().enumerate() {
            let unit = UNITS[k];
            columns.push((
                format!("before_{name}"),
                unit,
                "just before",
                number(&|i| i.before.components()[k]),
            ));
        }
        for (k, name) in START_KEYS.into_iter().enumerate() {
            let unit = UNITS[k];
            columns.push((
                format!("after_{name}"),
                unit,
                "just after",
                number(&|i| i.after.components()[k]),
            ));
        }
        let digits: ArrayRef =
            Arc::new(Float64Array::from_iter_values(self.trusted.trust.digits()));
        columns.push((
            "digits".into(),
            "1",
            "decimal digits expected to be right",
            digits,
        ));
        table(columns)
    }

    /// The mode intervals.
    fn modes(&self) -> PyResult<Table> {
        let modes = self.trusted.run.modes();
        let mut taut = ListBuilder::new(Int64Builder::new());
        for mode in modes {
            for cable in mode.taut.iter() {
                taut.values().append_value(cable as i64 + 1);
            }
            taut.append(true);
        }
        let names = modes.iter().map(|mode| mode.taut.mode().name());
        let starts = modes.iter().map(|mode| mode.t_start);
        let ends = modes.iter().map(|mode| mode.t_end);
        table(vec![
            (
                "mode".into(),
                "",
                "slack, sliding or rocking",
                Arc::new(StringArray::from_iter_values(names)),
            ),
            (
                "taut".into(),
                "",
                "the taut cables",
                Arc::new(taut.finish()),
            ),
            (
                "t_start".into(),
                "T",
                "from",
                Arc::new(Float64Array::from_iter_values(starts)),
            ),
            (
                "t_end".into(),
                "T",
                "to",
                Arc::new(Float64Array::from_iter_values(ends)),
            ),
        ])
    }

    /// The motion at times, given as doubles: ten doubles a time, in the order of `motion_names`.
    fn motion_at<'py>(
        &self,
        py: Python<'py>,
        times: PyBuffer<f64>,
    ) -> PyResult<Bound<'py, PyByteArray>> {
        let times = times.to_vec(py)?;
        self.play(py, times)
    }

    /// The same at every multiple of `dt` and at the end.
    fn motion<'py>(&self, py: Python<'py>, dt: f64) -> PyResult<Bound<'py, PyByteArray>> {
        let times = self.sampling(dt)?.times().collect();
        self.play(py, times)
    }
}

/// Of the components of a state.
const UNITS: [&str; 6] = ["L", "L", "rad", "L/T", "L/T", "rad/T"];

impl Run {
    fn sampling(&self, dt: f64) -> PyResult<Sampling> {
        let end = self.trusted.run.end().t;
        let right = dt > 0.0 && dt.is_finite();
        right.then(|| Sampling::every(dt, end)).flatten().ok_or_else(|| {
            let least = end / (MOST_ROWS - 1) as f64 * 1.05;
            PyValueError::new_err(format!(
                "dt = {dt:?} is not allowed; allowed: a number above 0 that gives no more than 10,000,000 rows \
                 for this run, which ends at t = {end}: {least:.1e} or above"
            ))
        })
    }

    fn play<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyByteArray>> {
        let trusted = Arc::clone(&self.trusted);
        let bytes = interruptible(py, None, move |pulse| {
            let mut playback = Playback::new(&trusted.run);
            let mut bytes = Vec::with_capacity(8 * COMPONENTS * times.len());
            for t in times {
                let row = MotionRow::new(&playback.at(t)).numbers();
                bytes.extend(row.into_iter().flat_map(f64::to_ne_bytes));
                pulse.beat();
            }
            bytes
        })?;
        Ok(PyByteArray::new(py, &bytes))
    }
}

/// A table whose columns say their unit and what they mean, in the words of CF.
fn table(columns: Vec<(String, &str, &str, ArrayRef)>) -> PyResult<Table> {
    let fields = columns.iter().map(|(name, unit, meaning, array)| {
        let words = [("units", *unit), ("long_name", *meaning)];
        let words = words.into_iter().filter(|(_, word)| !word.is_empty());
        let words: HashMap<String, String> = words
            .map(|(key, word)| (key.to_owned(), word.to_owned()))
            .collect();
        Field::new(name, array.data_type().clone(), false).with_metadata(words)
    });
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.into_iter().map(|(.., array)| array).collect();
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(of_program)?;
    Ok(Table::new(schema, vec![batch]))
}

pub(crate) fn to_json(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(of_program)
}

/// What of a case is in doubt: nothing, so much of every start value, or a size for every key that is.
pub(crate) fn doubt(
    case: &snapload::Case,
    uncertainty: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<Uncertainty> {
    let mut doubt = Uncertainty {
        tolerance: positive("tolerance", tolerance)?,
        ..Uncertainty::default()
    };
    let mut set = |name: &str, size: f64| {
        let within = |error: CaseError| PyValueError::new_err(format!("uncertainty: {error}"));
        doubt.set(name, size).map_err(within)
    };
    let Some(uncertainty) = uncertainty else {
        return Ok(doubt);
    };
    let Ok(sizes) = uncertainty.cast::<PyDict>() else {
        let size = uncertainty.extract()?;
        START_KEYS.iter().try_for_each(|key| set(key, size))?;
        return Ok(doubt);
    };
    for (name, size) in sizes.iter() {
        let (name, size): (String, f64) = (name.extract()?, size.extract()?);
        if START_KEYS.contains(&name.as_str()) && !case.parameters().moves_by(&name) {
            return Err(PyValueError::new_err(format!(
                "uncertainty of {name}: this case has no such quantity"
            )));
        }
        set(&name, size)?;
    }
    Ok(doubt)
}

fn positive(key: &str, value: f64) -> PyResult<f64> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    let allowed = "a number above 0, such as 1e-3";
    Err(of_case(CaseError::value(
        key,
        Value::Number(value),
        allowed,
    )))
}

/// Runs the neighbours of a case: how they end, as JSON.
#[pyfunction]
pub(crate) fn ensemble(
    py: Python<'_>,
    case: &Case,
    uncertainty: Option<&Bound<'_, PyAny>>,
    members: u32,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let doubt = doubt(&case.case, uncertainty, Uncertainty::default().tolerance)?;
    let ensemble = Ensemble::about(&case.case, &doubt, members, seed);
    let tally = interruptible(py, progress, move |pulse| ensemble.tally(|| pulse.beat()))?;
    let shares = tally.map_err(of_case)?.shares();
    let rows: Vec<ShareRow> = shares.into_iter().map(ShareRow::new).collect();
    to_json(&rows)
}

/// Runs a case beside the same with many digits: the answer as JSON, and in words.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    case: &Case,
    digits: u32,
    tolerance: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, String)> {
    let tolerance = positive("tolerance", tolerance)?;
    let theirs = Arc::clone(&case.case);
    let found = interruptible(py, progress, move |pulse| {
        snapload::analysis::verify(&theirs, digits, tolerance, |_| pulse.beat())
    })?;
    let verified = Verified::new(&case.case, found.map_err(of_case)?, tolerance);
    let row: VerifiedRow<'_> = verified.row();
    Ok((to_json(&row)?, verified.told(&case.told())))
}
