//! Studies: the rows of `snapload sweep`.

use crate::case::{Case, to_value};
use crate::errors::{error_of_study, error_of_work, internal_error};
use crate::interrupt::{interruptible, on_this_thread};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use snapload::Value;
use snapload::analysis::{Cancelled, Progress};
use snapload_study::{
    Axis, Grid, Identity, List, Opened, Plan, RandomRange, StudyError, Values, check_name,
    checked_identity, folder_of, read_rows, written_grid,
};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// A case and the axes of a grid.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Study {
    pub(crate) study: Arc<snapload_study::Study>,
}

#[pymethods]
impl Study {
    /// Of a case and the values of each axis, the first the slowest: a list, or the text
    /// `first:last:n`.
    #[staticmethod]
    fn grid(case: &Case, axes: Vec<(String, Bound<'_, PyAny>)>, trust: bool) -> PyResult<Self> {
        let axes = axes.iter().map(|(key, values)| axis(key, values));
        let plan = Plan::grid(axes.collect::<PyResult<_>>()?).map_err(error_of_study)?;
        Self::of(case, plan, trust)
    }

    /// Of a case and a box, each side a pair or the text `low:high`, with so many points in it.
    #[staticmethod]
    fn random(
        case: &Case,
        sides: Vec<(String, Bound<'_, PyAny>)>,
        count: u64,
        seed: u64,
        trust: bool,
    ) -> PyResult<Self> {
        let ranges = sides.iter().map(|(key, ends)| side(key, ends));
        let ranges = ranges.collect::<PyResult<_>>()?;
        let plan = Plan::random(ranges, count, seed).map_err(error_of_study)?;
        Self::of(case, plan, trust)
    }

    /// Of a case and a file with a row a case, which has to stay as long as the study does;
    /// `called` is what errors call it.
    #[staticmethod]
    fn listed(
        py: Python<'_>,
        case: &Case,
        path: PathBuf,
        called: String,
        trust: bool,
    ) -> PyResult<Self> {
        let list = py
            .detach(|| List::open_named(&path, &called))
            .map_err(error_of_study)?;
        Self::of(case, Plan::List(list), trust)
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
        let bytes = interruptible(py, None, move |shared| {
            let on_progress = |progress: Progress| shared.report(progress);
            let chunk = || snapload_study::chunk(&study, start..stop, &on_progress);
            on_threads(threads, chunk)
        })?;
        Ok(PyBytes::new(py, &bytes.map_err(error_of_study)?))
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
        let swept = interruptible(py, progress, move |shared| {
            let on_progress = |progress: Progress| shared.report(progress);
            let sweep = || snapload_study::sweep(&study, store, &on_progress);
            on_threads(threads, sweep)
        })?;
        swept.map_err(error_of_study)
    }
}

impl Study {
    fn of(case: &Case, plan: Plan, trust: bool) -> PyResult<Self> {
        let base = case
            .given
            .iter()
            .map(|(key, value)| ((*key).to_owned(), value.clone()));
        let study = snapload_study::Study::new(base, plan, trust).map_err(error_of_study)?;
        Ok(Self {
            study: Arc::new(study),
        })
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
        match snapload_study::Store::open(&path, identity, resume).map_err(error_of_study)? {
            Opened::Complete => Ok(None),
            Opened::Work(store) => Ok(Some(Self {
                store: Mutex::new(Some(store)),
            })),
        }
    }

    /// How many rows are safe.
    fn safe(&self) -> PyResult<u64> {
        self.with(|store| Ok(store.saved()))
    }

    /// The stretches of rows that are missing.
    fn gaps(&self) -> PyResult<Vec<(u64, u64)>> {
        self.with(|store| Ok(store.gaps().map(|gap| (gap.start, gap.end)).collect()))
    }

    /// Keeps rows that `Study.chunk` made.
    fn keep(&self, py: Python<'_>, start: u64, stop: u64, bytes: &[u8]) -> PyResult<()> {
        py.detach(|| self.with(|store| store.save_chunk(start..stop, bytes)))
    }

    /// Joins all rows into the file.
    fn finish(&self, py: Python<'_>) -> PyResult<()> {
        let mut store = self.take()?;
        py.detach(move || store.finish()).map_err(error_of_study)
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
        ask(store.as_mut().ok_or_else(closed)?).map_err(error_of_study)
    }
}

fn closed() -> PyErr {
    internal_error("this file is no longer being written")
}

/// The values along one axis, a list or the text `first:last:n`.
pub(crate) fn axis(key: &str, values: &Bound<'_, PyAny>) -> PyResult<Axis> {
    if let Ok(text) = values.extract::<String>() {
        return Axis::written(key, &text).map_err(error_of_study);
    }
    let values = values.try_iter()?.map(|value| to_value(key, &value?));
    let values: Vec<Value> = values.collect::<PyResult<_>>()?;
    Axis::listed(key, values).map_err(error_of_study)
}

/// The ends of one side of a box, a pair or the text `low:high`.
pub(crate) fn side(key: &str, ends: &Bound<'_, PyAny>) -> PyResult<RandomRange> {
    if let Ok(text) = ends.extract::<String>() {
        return RandomRange::written(key, &text).map_err(error_of_study);
    }
    let (low, high) = ends.extract().map_err(|_| {
        let allowed = "the ends of its range, such as (0.1, 0.6) or \"0.1:0.6\"";
        PyValueError::new_err(format!("{key} = {ends} is not allowed; allowed: {allowed}"))
    })?;
    RandomRange::new(key, low, high).map_err(error_of_study)
}

/// As many threads as asked for, up to what helps; and where these are fewer, why.
#[pyfunction]
pub(crate) fn threads_for(asked: usize) -> (usize, Option<String>) {
    snapload_study::threads_for(asked)
}

/// On so many threads, or on as many as the machine has.
pub(crate) fn on_threads<T: Send>(
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

/// Of which study some rows are: its text, version of the program,
/// cases, first row, number of rows.
type Origin = (String, String, u64, u64, u64);

/// Of which study the rows of a file are, once it was compared with its checksum.
#[pyfunction]
pub(crate) fn identity(py: Python<'_>, path: PathBuf) -> PyResult<Option<Origin>> {
    let read = py
        .detach(|| checked_identity(&path))
        .map_err(error_of_study)?;
    Ok(read.map(|identity| {
        let rows = identity.rows;
        let (first, count) = (rows.start, rows.end - rows.start);
        (
            identity.study,
            identity.version,
            identity.cases,
            first,
            count,
        )
    }))
}

/// Some rows of one column of a file, as its type and bytes.
///
/// The type depends on the column alone, whatever its rows contain. Numbers and counts are doubles,
/// NaN where there are none; flags are not set then. Words are places in a list of words, which
/// comes with them and begins with the empty one, that of rows without.
#[pyfunction]
pub(crate) fn read_column<'py>(
    py: Python<'py>,
    path: PathBuf,
    name: &str,
    start: u64,
    stop: u64,
) -> PyResult<(&'static str, Bound<'py, PyByteArray>, Vec<String>)> {
    let mut plain = Plain::none();
    let read = py.detach(|| read_rows(&path, name, start..stop, |values| plain.take(values)));
    read.map_err(error_of_study)?;
    Ok((plain.kind, PyByteArray::new(py, &plain.bytes), plain.words))
}

/// Values for NumPy: their type, their bytes, and the words that they are places in.
pub(crate) struct Plain {
    pub(crate) kind: &'static str,
    pub(crate) bytes: Vec<u8>,
    pub(crate) words: Vec<String>,
    places: HashMap<String, i32>,
}

impl Plain {
    /// None yet; the first word is the empty one.
    fn none() -> Self {
        Self {
            kind: "",
            bytes: Vec::new(),
            words: vec![String::new()],
            places: HashMap::from([(String::new(), 0)]),
        }
    }

    /// Of values.
    pub(crate) fn of(values: Values) -> Self {
        let mut plain = Self::none();
        plain.take(values);
        plain
    }

    /// Takes in more values of the same column.
    fn take(&mut self, values: Values) {
        self.kind = match values {
            Values::Numbers(list) => {
                let list = list.into_iter().map(|value| value.unwrap_or(f64::NAN));
                self.bytes.extend(list.flat_map(f64::to_ne_bytes));
                "float64"
            }
            Values::Counts(list) => {
                let list = list.into_iter().map(|n| n.map_or(f64::NAN, |n| n as f64));
                self.bytes.extend(list.flat_map(f64::to_ne_bytes));
                "float64"
            }
            Values::Flags(list) => {
                let flags = list.into_iter().map(|flag| u8::from(flag == Some(true)));
                self.bytes.extend(flags);
                "bool"
            }
            Values::Words(list) => {
                for word in list {
                    let place = self.place(word.unwrap_or_default().into_owned());
                    self.bytes.extend(place.to_ne_bytes());
                }
                "words"
            }
        };
    }

    fn place(&mut self, word: String) -> i32 {
        let words = &mut self.words;
        *self.places.entry(word).or_insert_with_key(|word| {
            words.push(word.clone());
            words.len() as i32 - 1
        })
    }
}

/// Checks that a file of rows can be written at a place: its ending, and that its folder exists.
#[pyfunction]
pub(crate) fn check_place(out: PathBuf) -> PyResult<()> {
    check_name(&out).map_err(error_of_study)?;
    folder_of(&out).map(|_| ()).map_err(error_of_study)
}

/// Joins the parts of a study into one file.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, parts: Vec<PathBuf>, out: PathBuf) -> PyResult<()> {
    let joined = interruptible(py, None, move |_| snapload_study::merge(&parts, &out))?;
    joined.map_err(error_of_study)
}

/// The number of values between two checks for signals.
const VALUES: u64 = 1 << 12;

/// Evenly spaced values, each the double nearest to the decimal that one would write.
#[pyfunction]
pub(crate) fn evenly<'py>(
    py: Python<'py>,
    first: &str,
    last: &str,
    count: u64,
) -> PyResult<Bound<'py, PyByteArray>> {
    let grid = Grid::new(first, last, count).ok_or_else(|| {
        let words = format!(
            "{first}:{last}:{count} is not a range; allowed: two finite numbers, and a count of 1 or more"
        );
        PyValueError::new_err(words)
    })?;
    values_of_grid(py, &grid)
}

/// The values of a range of a key, which need not be one of a case, in the notation
/// `first:last:n`.
#[pyfunction]
pub(crate) fn range_values<'py>(
    py: Python<'py>,
    key: &str,
    text: &str,
    most: u64,
) -> PyResult<Bound<'py, PyByteArray>> {
    let grid = written_grid(key, text).map_err(error_of_study)?;
    if grid.count() > most {
        let words =
            format!("{key} = {text:?} is not allowed; allowed: a range of at most {most} values");
        return Err(PyValueError::new_err(words));
    }
    values_of_grid(py, &grid)
}

fn values_of_grid<'py>(py: Python<'py>, grid: &Grid) -> PyResult<Bound<'py, PyByteArray>> {
    let count = grid.count();
    let bytes = on_this_thread(py, |on_progress| {
        let mut bytes = Vec::new();
        for k in 0..count {
            if k % VALUES == 0 {
                Progress::new("values", k as f64, count as f64).report(on_progress)?;
            }
            bytes.extend(grid.value(k).to_ne_bytes());
        }
        Ok(bytes)
    })?;
    let bytes = bytes.map_err(|cancelled: Cancelled| error_of_work(cancelled.into()))?;
    Ok(PyByteArray::new(py, &bytes))
}
