//! A run, and its trust.

use crate::case::Case;
use crate::errors::{error_of_case, error_of_work, internal_error};
use crate::interrupt::{interruptible, on_this_thread};
use crate::schema::in_cf;
use crate::table::{Table, array_of};
use arrow_array::builder::{Int64Builder, ListBuilder};
use arrow_array::{ArrayRef, Float64Array, StringArray};
use arrow_schema::{Field, Schema};
use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use serde::Serialize;
use snapload::analysis::{Cancelled, Counter, Ensemble, Progress, Uncertainty, record};
use snapload::{ModeInterval, Playback, Sampling, Trajectory};
use snapload_report::tables::{IMPACTS, ImpactRow, impact_rows};
use snapload_report::{
    CaseEcho, EndRow, NormsRow, OutcomeRow, Report, RunWithTrust, ShareRow, TOLERANCE, TrustRow,
    summary, summary_lines, trust_in_words,
};
use std::collections::HashMap;
use std::iter::{once, repeat};
use std::sync::Arc;

/// A finished run.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Run {
    /// None of a system of one's own.
    case: Option<Case>,
    data: Arc<RunData>,
}

/// The run itself, and the trust in it if that was requested.
enum RunData {
    WithoutTrust(Box<Trajectory>),
    WithTrust(Box<RunWithTrust>),
}

impl RunData {
    fn run(&self) -> &Trajectory {
        match self {
            Self::WithoutTrust(run) => run,
            Self::WithTrust(trusted) => &trusted.run,
        }
    }

    fn trusted(&self) -> Option<&RunWithTrust> {
        match self {
            Self::WithoutTrust(_) => None,
            Self::WithTrust(trusted) => Some(&**trusted),
        }
    }
}

/// What a run comes to, without its tables.
#[derive(Serialize)]
struct Head<'a> {
    case: Option<CaseEcho<'a>>,
    end: EndRow,
    state: [f64; 6],
    outcome: Option<OutcomeRow>,
    trust: Option<TrustRow<'a>>,
    norms: NormsRow,
}

impl Run {
    /// A run without a word on trust.
    pub(crate) fn without_trust(case: Option<Case>, run: Trajectory) -> Self {
        let data = Arc::new(RunData::WithoutTrust(Box::new(run)));
        Self { case, data }
    }

    /// A run with what is known of it.
    pub(crate) fn from_trusted(case: Option<Case>, run: RunWithTrust) -> Self {
        let data = Arc::new(RunData::WithTrust(Box::new(run)));
        Self { case, data }
    }

    /// The case that was run.
    pub(crate) fn case(&self) -> PyResult<&Case> {
        let no_case = || internal_error("this run does not belong to a case");
        self.case.as_ref().ok_or_else(no_case)
    }

    /// The run itself.
    pub(crate) fn trajectory(&self) -> &Trajectory {
        self.data.run()
    }
}

#[pymethods]
impl Run {
    /// How it ended, norms, outcome and trust, as JSON.
    fn head(&self) -> PyResult<String> {
        let (run, trusted) = (self.data.run(), self.data.trusted());
        to_json(&Head {
            case: self.case.as_ref().map(|case| CaseEcho(case.parameters())),
            end: EndRow::new(run.end()),
            state: run.end().state.components(),
            outcome: trusted.map(OutcomeRow::new),
            trust: trusted.map(TrustRow::new),
            norms: NormsRow::new(run.norms()),
        })
    }

    /// The line that `snapload run --json -` writes.
    #[pyo3(signature = (dt=None))]
    fn to_json(&self, py: Python<'_>, dt: Option<f64>) -> PyResult<String> {
        let sampling = dt.map(|dt| self.sampling(dt)).transpose()?;
        let (case, trusted) = (self.case()?, self.with_trust()?);
        let text = on_this_thread(py, |on_progress| {
            let report = Report::new(case.parameters(), trusted, sampling, on_progress);
            serde_json::to_string(&report)
        })?;
        text.map_err(internal_error)
    }

    /// What `snapload run` prints.
    fn summary(&self) -> PyResult<String> {
        let (case, trusted) = (self.case()?, self.with_trust()?);
        Ok(summary(
            &case.in_words(),
            case.parameters(),
            trusted,
            None,
            &[],
        ))
    }

    /// The same as labels and texts.
    fn summary_lines(&self) -> PyResult<Vec<(&'static str, String)>> {
        let (case, trusted) = (self.case()?, self.with_trust()?);
        Ok(summary_lines(
            &case.in_words(),
            case.parameters(),
            trusted,
            None,
        ))
    }

    /// Where trust ends, and why.
    fn trust_in_words(&self) -> PyResult<String> {
        Ok(trust_in_words(self.with_trust()?))
    }

    /// The impacts, a row an impact and cable; the digits that are known of them only where it is
    /// known how far the run can be trusted.
    fn impacts(&self) -> PyResult<Table> {
        let rows: Vec<ImpactRow> = match &*self.data {
            RunData::WithoutTrust(run) => impact_rows(run, repeat(f64::NAN)).collect(),
            RunData::WithTrust(trusted) => {
                impact_rows(&trusted.run, trusted.trust.digits()).collect()
            }
        };
        let shown = IMPACTS
            .iter()
            .filter(|column| column.name != "digits" || self.data.trusted().is_some());
        let columns = shown.map(|column| {
            let values = array_of(column.values(rows.iter().map(Some)));
            (column.name, column.unit, column.meaning, values)
        });
        table(columns.collect())
    }

    /// The mode intervals.
    fn modes(&self) -> PyResult<Table> {
        let modes = self.data.run().modes();
        let mut taut = ListBuilder::new(Int64Builder::new());
        for mode in modes {
            for cable in mode.taut.iter() {
                taut.values().append_value(cable as i64 + 1);
            }
            taut.append(true);
        }
        let names = StringArray::from_iter_values(modes.iter().map(|mode| mode.taut.mode().name()));
        let times = |of: fn(&ModeInterval) -> f64| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(modes.iter().map(of)))
        };
        let (starts, ends) = (times(|mode| mode.t_start), times(|mode| mode.t_end));
        table(vec![
            ("mode", "", "slack, sliding or rocking", Arc::new(names)),
            ("taut", "", "the taut cables", Arc::new(taut.finish())),
            ("t_start", "T", "from", starts),
            ("t_end", "T", "to", ends),
        ])
    }

    /// The motion at times, given as doubles: a row a time, of the time, the state, the tensions of
    /// all cables, and the energy.
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

impl Run {
    fn with_trust(&self) -> PyResult<&RunWithTrust> {
        self.data.trusted().ok_or_else(|| {
            PyValueError::new_err(
                "this run was made with trust=False, so how far it can be trusted is not known; \
                 run the case without trust=False",
            )
        })
    }

    fn sampling(&self, dt: f64) -> PyResult<Sampling> {
        let end = self.data.run().end().t;
        Sampling::every(dt, end).map_err(|allowed| {
            PyValueError::new_err(format!("dt = {dt:?} is not allowed; allowed: {allowed}"))
        })
    }

    fn play<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyByteArray>> {
        let run = self.data.run();
        let bytes = on_this_thread(py, |on_progress| {
            let counter = Counter::new("playing", 0, times.len() as u64, on_progress);
            let mut playback = Playback::new(run);
            let cables = run.system().cables.len();
            let mut bytes = Vec::with_capacity(8 * (8 + cables) * times.len());
            for t in times {
                let motion = playback.at(t);
                let row = once(motion.t).chain(motion.state.components());
                let tensions = &motion.tensions[..cables];
                let row = row.chain(tensions.iter().copied()).chain([motion.energy]);
                bytes.extend(row.flat_map(f64::to_ne_bytes));
                counter.add(1)?;
            }
            Ok(bytes)
        })?;
        let bytes = bytes.map_err(|cancelled: Cancelled| error_of_work(cancelled.into()))?;
        Ok(PyByteArray::new(py, &bytes))
    }
}

/// A table whose columns say their unit and what they mean, in the words of CF.
fn table(columns: Vec<(&str, &str, &str, ArrayRef)>) -> PyResult<Table> {
    let fields = columns.iter().map(|(name, unit, meaning, array)| {
        let words = in_cf(unit).into_iter().chain([("long_name", *meaning)]);
        let words = words.filter(|(_, word)| !word.is_empty());
        let words: HashMap<String, String> = words
            .map(|(key, word)| (key.to_owned(), word.to_owned()))
            .collect();
        Field::new(*name, array.data_type().clone(), false).with_metadata(words)
    });
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.into_iter().map(|(.., array)| array).collect();
    Table::new(schema, arrays)
}

pub(crate) fn to_json(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(internal_error)
}

/// What of a case is in doubt: nothing, so much of every start value, or a size for every key that
/// is.
pub(crate) fn read_uncertainty(
    case: &snapload::Case,
    given: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
) -> PyResult<Uncertainty> {
    let mut uncertain = Uncertainty {
        tolerance: checked_tolerance(tolerance)?,
        ..Uncertainty::default()
    };
    let mut set = |key: Option<&str>, size: f64| {
        let set = uncertain.set_for(case.parameters(), key, size);
        set.map_err(|error| PyValueError::new_err(format!("uncertainty: {error}")))
    };
    let Some(given) = given else {
        return Ok(uncertain);
    };
    let Ok(sizes) = given.cast::<PyDict>() else {
        set(None, given.extract()?)?;
        return Ok(uncertain);
    };
    for (name, size) in sizes.iter() {
        let name: String = name.extract()?;
        set(Some(&name), size.extract()?)?;
    }
    Ok(uncertain)
}

/// What counts as known, checked.
pub(crate) fn checked_tolerance(tolerance: f64) -> PyResult<f64> {
    let checked = TOLERANCE.check(TOLERANCE.name, &tolerance.into());
    checked.map(|()| tolerance).map_err(error_of_case)
}

/// Runs a case; see `snapload.Case.run`.
#[pyfunction]
pub(crate) fn run(
    py: Python<'_>,
    case: &Case,
    uncertainty: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    members: Option<u32>,
    seed: u64,
) -> PyResult<Run> {
    let uncertainty = read_uncertainty(&case.case, uncertainty, tolerance)?;
    let shared_case = Arc::clone(&case.case);
    // The run itself takes one thread, and would be over before others had started. Neighbours take
    // all threads.
    let run_only = on_this_thread(py, |on_progress| {
        RunWithTrust::run_alone(&shared_case, uncertainty, on_progress)
    })?
    .map_err(error_of_work)?;
    let trusted = if run_only.trust.decides_the_end() || members == Some(0) {
        on_this_thread(py, |on_progress| {
            run_only.completed(&shared_case, members, seed, on_progress)
        })?
    } else {
        interruptible(py, None, move |shared| {
            let on_progress = |progress: Progress| shared.report(progress);
            run_only.completed(&shared_case, members, seed, &on_progress)
        })?
    };
    Ok(Run::from_trusted(
        Some(case.clone()),
        trusted.map_err(error_of_work)?,
    ))
}

/// Runs a case without a word on how far the run can be trusted.
#[pyfunction]
pub(crate) fn run_alone(py: Python<'_>, case: &Case) -> PyResult<Run> {
    let run = on_this_thread(py, |on_progress| {
        record(case.case.simulation(), on_progress, |_, _| {})
    })?;
    let run = run.map_err(|cancelled| error_of_work(cancelled.into()))?;
    Ok(Run::without_trust(Some(case.clone()), run))
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
    let uncertainty = read_uncertainty(&case.case, uncertainty, Uncertainty::default().tolerance)?;
    let ensemble = Ensemble::about(&case.case, &uncertainty, members, seed);
    let tally = interruptible(py, progress, move |shared| {
        ensemble.tally(&|progress| shared.report(progress))
    })?;
    let shares = tally.map_err(error_of_work)?.shares();
    let rows: Vec<ShareRow> = shares.into_iter().map(ShareRow::new).collect();
    to_json(&rows)
}
