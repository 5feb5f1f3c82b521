//! Coefficients of floating bodies: from an xarray dataset or a file to the results of `snapload
//! hydro`.

use crate::errors::{of_case, of_program};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::{Map, Value};
use snapload::CaseError;
use snapload_hydro::{
    Dataset, FirstColumn, FitOptions, Format, Given, HydroError, Line, Reading, Report, Request,
    Values, Variable, Weight, from_dataset, read,
};
use std::path::Path;

/// What a variable of a dataset holds.
#[derive(FromPyObject)]
pub(crate) enum Held {
    Numbers(Vec<f64>),
    Words(Vec<String>),
}

/// A variable of a dataset: its name, the names of its dimensions, their lengths, its values.
type Told = (String, Vec<String>, Vec<usize>, Held);

/// What is asked, beside the coefficients.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    density: Option<f64>,
    gravity: Option<f64>,
    depth: Option<f64>,
    reference: Option<[f64; 2]>,
    displaced_mass: Option<f64>,
    file_centre: Option<[f64; 2]>,
    unit_length: Option<f64>,
    first_column: Option<String>,
    body: Option<String>,
    mass: Option<f64>,
    centre: Option<[f64; 2]>,
    inertia: Option<f64>,
    damping: Option<[f64; 3]>,
    force: Option<[f64; 3]>,
    pairs: Option<usize>,
    lines: Option<Vec<[f64; 5]>>,
}

fn first_column(word: Option<&str>) -> PyResult<FirstColumn> {
    match word {
        None | Some("period") => Ok(FirstColumn::Period),
        Some("frequency") => Ok(FirstColumn::Frequency),
        Some("wavenumber") => Ok(FirstColumn::WaveNumber),
        Some(other) => {
            let words = format!(
                "first_column = {other:?} is not allowed; allowed: period, frequency or wavenumber"
            );
            Err(PyValueError::new_err(words))
        }
    }
}

/// The options, or an error that names the one that is of another form.
fn read_asked(text: &str) -> PyResult<Asked> {
    let options: Map<String, Value> = serde_json::from_str(text).map_err(of_program)?;
    for (key, value) in &options {
        let alone = Map::from_iter([(key.clone(), value.clone())]);
        if let Err(error) = Asked::deserialize(Value::Object(alone)) {
            let words = error.to_string();
            let allowed = match words.split_once("expected ") {
                Some((_, "f64")) => "a number",
                Some((_, "fewer elements in array")) => "fewer numbers",
                Some((_, allowed)) => allowed,
                None => words.as_str(),
            };
            return Err(of_case(CaseError::value(key, value.to_string(), allowed)));
        }
    }
    Asked::deserialize(Value::Object(options)).map_err(of_program)
}

fn refused(error: HydroError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The answers about a dataset's variables, or about the file of
/// that name where there are none: as JSON, and as labels with their words.
#[pyfunction]
#[pyo3(signature = (name, variables, asked, /))]
pub(crate) fn hydro(
    py: Python<'_>,
    name: &str,
    variables: Option<Vec<Told>>,
    asked: &str,
) -> PyResult<(String, Vec<(String, String)>)> {
    let asked = read_asked(asked)?;
    let given = Given {
        density_kg_m3: asked.density,
        gravity_m_s2: asked.gravity,
        depth_m: asked.depth,
        reference_m: asked.reference,
        centre_of_gravity_m: asked.file_centre,
        displaced_mass_kg: asked.displaced_mass,
        unit_length_m: asked.unit_length,
        first_column: first_column(asked.first_column.as_deref())?,
        body: asked.body,
    };
    let line = |[ax, az, fx, fz, length_m]: [f64; 5]| Line {
        anchor_m: [ax, az],
        fairlead_m: [fx, fz],
        length_m,
    };
    let request = Request {
        weight: Weight {
            mass_kg: asked.mass,
            centre_m: asked.centre,
            inertia_kg_m2: asked.inertia,
        },
        damping: asked.damping.unwrap_or_default(),
        force: asked.force.unwrap_or_default(),
        lines: asked
            .lines
            .unwrap_or_default()
            .into_iter()
            .map(line)
            .collect(),
        fit: FitOptions { pairs: asked.pairs },
        memory: None,
    };
    let report = py.detach(|| {
        let reading = match variables {
            Some(variables) => of_variables(variables, &given)?,
            None => read(Path::new(name), &given)?,
        };
        Report::new(name, reading, &request)
    });
    let report = report.map_err(refused)?;
    let json = serde_json::to_string(&report.to_json()).map_err(of_program)?;
    Ok((json, report.summary()))
}

fn of_variables(variables: Vec<Told>, given: &Given) -> Result<Reading, HydroError> {
    let variable = |(name, dims, shape, held): Told| {
        let values = match held {
            Held::Numbers(numbers) => Values::Numbers(numbers),
            Held::Words(words) => Values::Words(words),
        };
        let variable = Variable {
            dims,
            shape,
            values,
        };
        (name, variable)
    };
    let dataset = Dataset::new(variables.into_iter().map(variable))?;
    Reading::new(Format::Capytaine, from_dataset(&dataset, given)?)
}
