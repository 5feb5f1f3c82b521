//! Coefficients of floating bodies: from an xarray dataset or a file to the results of `snapload
//! hydro`.

use crate::errors::{error_of_case, internal_error};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};
use snapload::CaseError;
use snapload_hydro::{
    Dataset, FirstColumn, FitOptions, Format, Given, GivenSource, HydroError, Line, Reading,
    Report, Request, Values, Variable, Weight, from_dataset, read,
};
use std::path::Path;

/// What a variable of a dataset holds.
#[derive(FromPyObject)]
pub(crate) enum VariableValues {
    Numbers(Vec<f64>),
    Words(Vec<String>),
}

/// A variable of a dataset: its name, the names of its dimensions, their lengths, its values.
type DatasetVariable = (String, Vec<String>, Vec<usize>, VariableValues);

/// What is asked, beside the coefficients.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct HydroOptions {
    density: Option<f64>,
    gravity: Option<f64>,
    #[serde(default, deserialize_with = "depth")]
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

fn first_column(word: &str) -> PyResult<FirstColumn> {
    FirstColumn::from_word(word).ok_or_else(|| {
        let allowed = FirstColumn::WORDS.join(", ");
        let message = format!("first_column = {word:?} is not allowed; allowed: {allowed}");
        PyValueError::new_err(message)
    })
}

/// A depth: a number, or "inf", for which JSON has no number.
fn depth<'de, D: Deserializer<'de>>(depth: D) -> Result<Option<f64>, D::Error> {
    let value = Value::deserialize(depth)?;
    match value.as_str() {
        Some("inf") => Ok(Some(f64::INFINITY)),
        _ => Option::deserialize(value).map_err(|_| D::Error::custom("expected a number or inf")),
    }
}

/// The options, or an error that names the one that is of another form.
fn read_options(text: &str) -> PyResult<HydroOptions> {
    let options: Map<String, Value> = serde_json::from_str(text).map_err(internal_error)?;
    for (key, value) in &options {
        let alone = Map::from_iter([(key.clone(), value.clone())]);
        if let Err(error) = HydroOptions::deserialize(Value::Object(alone)) {
            let words = error.to_string();
            let allowed = match words.split_once("expected ") {
                Some((_, "f64")) => "a number",
                Some((_, "fewer elements in array")) => "fewer numbers",
                Some((_, allowed)) => allowed,
                None => words.as_str(),
            };
            return Err(error_of_case(CaseError::value(
                key,
                value.to_string(),
                allowed,
            )));
        }
    }
    HydroOptions::deserialize(Value::Object(options)).map_err(internal_error)
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
    variables: Option<Vec<DatasetVariable>>,
    asked: &str,
) -> PyResult<(String, Vec<(String, String)>)> {
    let options = read_options(asked)?;
    let given = Given {
        density_kg_m3: options.density,
        gravity_m_s2: options.gravity,
        depth_m: options.depth,
        reference_m: options.reference,
        centre_of_gravity_m: options.file_centre,
        displaced_mass_kg: options.displaced_mass,
        unit_length_m: options.unit_length,
        first_column: options
            .first_column
            .as_deref()
            .map(first_column)
            .transpose()?,
        body: options.body,
        source: GivenSource::Options,
    };
    let line = |[ax, az, fx, fz, length_m]: [f64; 5]| Line {
        anchor_m: [ax, az],
        fairlead_m: [fx, fz],
        length_m,
    };
    let request = Request {
        weight: Weight {
            mass_kg: options.mass,
            centre_m: options.centre,
            inertia_kg_m2: options.inertia,
        },
        damping: options.damping.unwrap_or_default(),
        force: options.force.unwrap_or_default(),
        lines: options
            .lines
            .unwrap_or_default()
            .into_iter()
            .map(line)
            .collect(),
        fit: FitOptions {
            pairs: options.pairs,
        },
        memory: None,
    };
    let report = py.detach(|| {
        let reading = match variables {
            Some(variables) => of_variables(variables, &given).map_err(refused)?,
            None => read(Path::new(name), &given)
                .map_err(|error| PyValueError::new_err(format!("{name}: {error}")))?,
        };
        Report::new(name, reading, &request).map_err(refused)
    })?;
    let json = serde_json::to_string(&report.to_json()).map_err(internal_error)?;
    Ok((json, report.summary()))
}

fn of_variables(variables: Vec<DatasetVariable>, given: &Given) -> Result<Reading, HydroError> {
    let variable = |(name, dims, shape, values): DatasetVariable| {
        let values = match values {
            VariableValues::Numbers(numbers) => Values::Numbers(numbers),
            VariableValues::Words(words) => Values::Words(words),
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
