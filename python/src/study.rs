//! Studies: the rows of `snapload sweep`.

use crate::case::{Case, to_value};
use crate::errors::{of_program, of_study};
use crate::interrupt::interruptible;
use crate::table::{Table, array_of, field_of};
use arrow_array::RecordBatch;
use arrow_schema::Schema;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use snapload::Value;
use snapload::analysis::Progress;
use snapload_study::{
    Axis, Ending, Grid, Identity, Opened, Plan, StudyError, columns_of_files, read_all,
};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// A case and the axes of a grid.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Study {
    study: Arc<snapload_study::Study>,
}

#[pymethods]
impl Study {
    /// Of a case and the values of each axis, the first the slowest: a list, or the text
    /// `first:last:n`.
    #[new]
    fn new(case: &Case, axes: Vec<(String, Bound<'_, PyAny>)>, trust: bool) -> PyResult<Self> {
        let axes = axes.iter().map(|(key, values)| axis(key, values));
        let plan = Plan::grid(axes.collect::<PyResult<_>>()?).map_err(of_study)?;
        let base = case
            .given
            .iter()
            .map(|(key, value)| ((*key).to_owned(), value.clone()));
        let study = snapload_study::Study::new(base, plan, trust).map_err(of_study)?;
        Ok(Self {
            study: Arc::new(study),
        })
    }

    fn __len__(&self) -> usize {
        self.study.count() as usize
    }

    /// The study as a study file.
    fn describe(&self) -> String {
        self.study.describe()
    }

    /// Some of its rows, as a small Parquet file.
    #[pyo3(signature = (start, stop, threads=None))]
    fn chunk<'py>(
        &self,
        py: Python<'py>,
        start: u64,
        stop: u64,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let study = Arc::clone(&self.study);
        let bytes = interruptible(py, None, move |watch| {
            let on_progress = |progress: Progress| watch.go_on(progress);
            let chunk = || snapload_study::chunk(&study, start..stop, &on_progress);
            on_threads(threads, chunk)
        })?;
        Ok(PyBytes::new(py, &bytes.map_err(of_study)?))
    }

    /// Runs what is missing in a file, and completes it.
    #[pyo3(signature = (store, threads=None, progress=None))]
    fn sweep(
        &self,
        py: Python<'_>,
        store: &Store,
        threads: Option<usize>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (study, store) = (Arc::clone(&self.study), store.take()?);
        let swept = interruptible(py, progress, move |watch| {
            let on_progress = |progress: Progress| watch.go_on(progress);
            let sweep = || snapload_study::sweep(&study, store, Ending::AtNextCase, &on_progress);
            on_threads(threads, sweep)
        })?;
        swept.map_err(of_study)
    }
}

/// The file of a study, in the making.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Store {
    store: Mutex<Option<snapload_study::Store>>,
}

#[pymethods]
impl Store {
    /// Opens the place of a file; none if the file is complete.
    #[staticmethod]
    fn open(study: &Study, path: PathBuf, resume: bool) -> PyResult<Option<Self>> {
        let identity = Identity::new(&study.study, None);
        match snapload_study::Store::open(&path, identity, resume).map_err(of_study)? {
            Opened::Complete => Ok(None),
            Opened::Work(store) => Ok(Some(Self {
                store: Mutex::new(Some(store)),
            })),
        }
    }

    /// How many rows are safe.
    fn safe(&self) -> PyResult<u64> {
        self.with(|store| Ok(store.safe()))
    }

    /// The stretches of rows that are missing.
    fn gaps(&self) -> PyResult<Vec<(u64, u64)>> {
        self.with(|store| Ok(store.gaps().map(|gap| (gap.start, gap.end)).collect()))
    }

    /// Keeps rows that `Study.chunk` made.
    fn keep(&self, py: Python<'_>, start: u64, stop: u64, bytes: &[u8]) -> PyResult<()> {
        py.detach(|| self.with(|store| store.keep(start..stop, bytes)))
    }

    /// Joins all rows into the file.
    fn finish(&self, py: Python<'_>) -> PyResult<()> {
        let mut store = self.take()?;
        py.detach(move || store.finish()).map_err(of_study)
    }

    /// Lets go of the place; what is safe stays.
    fn close(&self) {
        let _ = self.take();
    }
}

impl Store {
    fn take(&self) -> PyResult<snapload_study::Store> {
        let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
        store.take().ok_or_else(closed)
    }

    fn with<T>(
        &self,
        ask: impl FnOnce(&mut snapload_study::Store) -> Result<T, StudyError>,
    ) -> PyResult<T> {
        let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
        ask(store.as_mut().ok_or_else(closed)?).map_err(of_study)
    }
}

fn closed() -> PyErr {
    of_program("this file is no longer in the making")
}

fn axis(key: &str, values: &Bound<'_, PyAny>) -> PyResult<Axis> {
    if let Ok(text) = values.extract::<String>() {
        return Axis::written(key, &text).map_err(of_study);
    }
    let values = values.try_iter()?.map(|value| to_value(key, &value?));
    let values: Vec<Value> = values.collect::<PyResult<_>>()?;
    Axis::listed(key, values).map_err(of_study)
}

/// As many threads as asked for, up to what helps; and where these are fewer, why.
#[pyfunction]
pub(crate) fn threads_for(asked: usize) -> (usize, Option<String>) {
    snapload_study::threads_for(asked)
}

/// On so many threads, or on as many as the machine has.
fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T, StudyError> + Send,
) -> Result<T, StudyError> {
    let Some(threads) = threads else {
        return work();
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool
        .map_err(|error| StudyError::Failed(format!("can not start {threads} threads: {error}")))?;
    pool.install(work)
}

/// Of which study some rows are: its text, version of the program, cases, first row.
type Origin = (String, String, u64, u64);

/// The rows of a Parquet file, and of which study they are.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: PathBuf) -> PyResult<(Table, Option<Origin>)> {
    let fields = columns_of_files()
        .into_iter()
        .map(|(name, holds)| field_of(name, holds));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let mut batches = Vec::new();
    let read = py.detach(|| {
        read_all(&path, |columns| {
            let columns = columns.into_iter().map(array_of).collect();
            batches.push(RecordBatch::try_new(Arc::clone(&schema), columns));
        })
    });
    let identity = read.map_err(of_study)?;
    let batches = batches
        .into_iter()
        .collect::<Result<_, _>>()
        .map_err(of_program)?;
    let identity = identity.map(|identity| {
        (
            identity.study,
            identity.version,
            identity.cases,
            identity.rows.start,
        )
    });
    Ok((Table::new(schema, batches), identity))
}

/// Evenly spaced values, each the double nearest to the decimal that one would write.
#[pyfunction]
pub(crate) fn evenly(first: &str, last: &str, count: u64) -> PyResult<Vec<f64>> {
    let grid = Grid::new(first, last, count).ok_or_else(|| {
        let words = format!("{first}:{last}:{count} is no range; allowed: two finite numbers, and a count of 1 or more");
        PyValueError::new_err(words)
    })?;
    Ok((0..count).map(|k| grid.value(k)).collect())
}
