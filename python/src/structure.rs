//! Structures in SI units: assessed, in many records of a sea, and on elastic lines.

use crate::errors::{error_of_case, error_of_work, internal_error};
use crate::interrupt::interruptible;
use pyo3::prelude::*;
use snapload::{CaseError, Entries};
use snapload_structure::note::{self, Source};
use snapload_structure::{
    ElasticComparison, Lines, ModelAtRest, STRUCTURE, checked_every, compare_elastic, moordyn,
};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The example of the manual.
const EXAMPLE: &str = include_str!("../../docs/examples/cylinder.toml");

/// A structure that was read and checked.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Structure {
    name: String,
    /// The folder of the files that the case names.
    folder: PathBuf,
    entries: Entries,
    structure: snapload_structure::Structure,
}

impl Structure {
    fn of(
        name: &str,
        folder: &Path,
        mut entries: Entries,
        changes: &[String],
    ) -> Result<Self, CaseError> {
        changes.iter().try_for_each(|change| entries.set(change))?;
        let structure = snapload_structure::Structure::from_entries_beside(&entries, folder);
        let structure = structure.map_err(|error| match error.place {
            Some(_) => error,
            None => error.at(name.to_owned()),
        })?;
        Ok(Self {
            name: name.to_owned(),
            folder: folder.to_owned(),
            entries,
            structure,
        })
    }
}

#[pymethods]
impl Structure {
    /// Reads the text of a case, with the files that it names in this folder; `changes` are keys
    /// such as `wave.height=2`.
    #[staticmethod]
    fn parse(name: &str, folder: PathBuf, text: &str, changes: Vec<String>) -> PyResult<Self> {
        let entries = Entries::parse(&STRUCTURE, name, text).map_err(error_of_case)?;
        Self::of(name, &folder, entries, &changes).map_err(error_of_case)
    }

    /// The text of the manual's example.
    #[staticmethod]
    fn example() -> &'static str {
        EXAMPLE
    }

    /// Reads an input file of MoorDyn; returns what of it was left out or taken otherwise, too.
    #[staticmethod]
    fn from_moordyn(
        name: &str,
        folder: PathBuf,
        text: &str,
        changes: Vec<String>,
    ) -> PyResult<(Self, Vec<String>)> {
        let reading = moordyn::read(name, text).map_err(error_of_case)?;
        let structure = Self::of(name, &folder, reading.entries, &changes);
        let structure = structure.map_err(error_of_case)?;
        Ok((structure, reading.notes))
    }

    /// An input file for MoorDyn.
    fn to_moordyn(&self, segments: u32) -> PyResult<String> {
        moordyn::write(&self.name, &self.structure, segments).map_err(error_of_case)
    }

    /// The same with other values of keys.
    fn replace(&self, changes: Vec<String>) -> PyResult<Self> {
        let changed = Self::of(&self.name, &self.folder, self.entries.clone(), &changes);
        changed.map_err(error_of_case)
    }

    /// The same without the tables of a name.
    fn without(&self, table: &str) -> PyResult<Self> {
        let mut entries = self.entries.clone();
        entries.remove(table);
        Self::of(&self.name, &self.folder, entries, &[]).map_err(error_of_case)
    }

    /// Whether all inputs are equal, including those that are left out or read from files.
    fn __eq__(&self, other: &Self) -> bool {
        self.structure == other.structure
    }

    /// Equal for equal structures: 0 and -0 are equal and have one hash.
    fn __hash__(&self) -> u64 {
        let structure = &self.structure;
        let lengths = structure.lines.iter().map(|line| line.length_m);
        let numbers = [structure.duration_s, structure.body.mass_kg].into_iter();
        let mut hasher = DefaultHasher::new();
        for number in numbers.chain(lengths) {
            (number + 0.0).to_bits().hash(&mut hasher);
        }
        hasher.finish()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn folder(&self) -> &Path {
        &self.folder
    }

    /// The case as TOML.
    fn to_toml(&self) -> String {
        self.entries.to_toml()
    }

    /// Runs it with its neighbours.
    fn assess(
        &self,
        py: Python<'_>,
        neighbours: u32,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Assessment> {
        let structure = self.structure.clone();
        let found = interruptible(py, progress, move |shared| {
            snapload_structure::assess(structure, neighbours, &|progress| shared.report(progress))
        })?;
        Ok(Assessment {
            name: self.name.clone(),
            found: found.map_err(error_of_work)?,
        })
    }

    /// Runs it in many records of its sea; the answer is JSON, a summary and a page.
    fn seas(
        &self,
        py: Python<'_>,
        seeds: u32,
        elastic: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(String, String, String)> {
        let structure = self.structure.clone();
        let lines = match elastic {
            true => Lines::Elastic,
            false => Lines::Inextensible,
        };
        let found = interruptible(py, progress, move |shared| {
            snapload_structure::seas(structure, seeds, lines, &|progress| shared.report(progress))
        })?;
        let seas = found.map_err(error_of_work)?;
        let page = note::seas_page(source(&self.name), &seas).map_err(internal_error)?;
        Ok((
            seas.to_json(&self.name).to_string(),
            seas.summary(&self.name),
            page,
        ))
    }

    /// Runs it on elastic and on inextensible lines.
    fn elastic(
        &self,
        py: Python<'_>,
        stiffer: f64,
        every_s: f64,
        neighbours: u32,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Elastic> {
        let structure = self.structure.clone();
        let every_s = checked_every(structure.duration_s, every_s).map_err(error_of_case)?;
        let found = interruptible(py, progress, move |shared| {
            let prepared = ModelAtRest::for_elastic_lines(structure)?;
            let report = |progress: snapload::analysis::Progress| shared.report(progress);
            compare_elastic(prepared, stiffer, every_s, &report)?
                .with_neighbours(neighbours, &report)
        })?;
        Ok(Elastic {
            name: self.name.clone(),
            found: found.map_err(error_of_work)?,
        })
    }
}

/// A page that was made from Python has no command that makes it again.
fn source(name: &str) -> Source<'_> {
    Source {
        name,
        command: "snapload.Structure in Python",
        sha256: None,
    }
}

/// Times, x, z, θ, and the tension of each line.
type MotionColumns = (Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<Vec<f64>>);

/// A structure that was run.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Assessment {
    name: String,
    found: snapload_structure::Assessment,
}

#[pymethods]
impl Assessment {
    fn json(&self) -> String {
        self.found.to_json(&self.name).to_string()
    }

    fn summary(&self) -> String {
        self.found.summary(&self.name)
    }

    /// The page for a design note, without a scan of other waves.
    fn page(&self) -> PyResult<String> {
        note::page(source(&self.name), &self.found, None).map_err(internal_error)
    }

    /// The motion at times within the run.
    fn motion(&self, times_s: Vec<f64>) -> PyResult<MotionColumns> {
        let samples = self.found.motion_at(&times_s).map_err(error_of_case)?;
        Ok((
            times_s,
            samples.iter().map(|sample| sample.place_m[0]).collect(),
            samples.iter().map(|sample| sample.place_m[1]).collect(),
            samples.iter().map(|sample| sample.theta_rad).collect(),
            samples.into_iter().map(|sample| sample.tension_n).collect(),
        ))
    }
}

/// The same case on both models of a line.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Elastic {
    name: String,
    found: ElasticComparison,
}

#[pymethods]
impl Elastic {
    fn json(&self) -> String {
        self.found.to_json(&self.name).to_string()
    }

    fn summary(&self) -> String {
        self.found.summary(&self.name)
    }

    /// The motion on elastic lines, at the times that were kept.
    fn motion(&self) -> MotionColumns {
        let samples = &self.found.elastic.samples;
        let scales = &self.found.elastic_case.model.scales;
        let place = |k: usize| {
            let places = samples
                .iter()
                .map(|sample| scales.to_si([sample.state.x, sample.state.y])[k]);
            places.collect()
        };
        (
            samples.iter().map(|sample| sample.t_s).collect(),
            place(0),
            place(1),
            samples
                .iter()
                .map(|sample| 0.0 - sample.state.theta)
                .collect(),
            samples
                .iter()
                .map(|sample| sample.tension_n.clone())
                .collect(),
        )
    }
}
