//! A case, from keys and values of Python.

use crate::errors::error_of_case;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyString};
use pyo3::{IntoPyObjectExt, intern};
use snapload::{CaseError, Key, Parameters, Value, key_named};
use snapload_report::case_in_words;
use std::sync::Arc;

/// A case that was checked.
#[pyclass(frozen, from_py_object, module = "snapload._engine")]
#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) name: String,
    /// What was given; what follows from it, such as the inertia, follows anew where one of it
    /// changes.
    pub(crate) given: Vec<(&'static str, Value)>,
    pub(crate) case: Arc<snapload::Case>,
}

impl Case {
    pub(crate) fn new(
        name: String,
        entries: impl IntoIterator<Item = (&'static str, Value)>,
    ) -> Result<Self, CaseError> {
        let given = latest(entries);
        let parameters = Parameters::from_entries(given.iter().cloned())?;
        let case = Arc::new(snapload::Case::new(parameters)?);
        Ok(Self { name, given, case })
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        self.case.parameters()
    }

    /// Its parameters with other values of some keys; the start need not be legal.
    pub(crate) fn parameters_with(
        &self,
        entries: Vec<(&'static str, Value)>,
    ) -> Result<Parameters, CaseError> {
        Parameters::from_entries(latest(self.given.iter().cloned().chain(entries)))
    }
}

/// The last value of each key.
fn latest(entries: impl IntoIterator<Item = (&'static str, Value)>) -> Vec<(&'static str, Value)> {
    let mut given: Vec<(&'static str, Value)> = Vec::new();
    for (key, value) in entries {
        given.retain(|(known, _)| *known != key);
        given.push((key, value));
    }
    given
}

#[pymethods]
impl Case {
    /// A case of keys and values, under the name that is shown for it.
    #[new]
    fn of(name: String, entries: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::new(name, read_entries(entries)?).map_err(error_of_case)
    }

    /// The same case with some keys changed.
    fn replace(&self, entries: &Bound<'_, PyDict>) -> PyResult<Self> {
        let given = self.given.iter().cloned().chain(read_entries(entries)?);
        Self::new(self.name.clone(), given).map_err(error_of_case)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The keys that were given.
    fn given<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let given = self
            .given
            .iter()
            .map(|(key, value)| (*key, Some(value.clone())));
        to_dict(py, given)
    }

    /// Every key in effect.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(py, self.parameters().entries())
    }

    /// Name, and where the case differs from the standard one.
    pub(crate) fn in_words(&self) -> String {
        case_in_words(&self.name, self.parameters())
    }
}

/// Keys and values, in order.
pub(crate) fn read_entries(entries: &Bound<'_, PyDict>) -> PyResult<Vec<(&'static str, Value)>> {
    checked(entries, key_named)
}

/// Values by name, in order, each checked by the key that `key_named` gives.
pub(crate) fn checked(
    given: &Bound<'_, PyDict>,
    key_named: impl Fn(&str) -> Result<&'static Key, CaseError>,
) -> PyResult<Vec<(&'static str, Value)>> {
    let read = given.iter().map(|(name, value)| {
        let name: String = name.extract()?;
        let key = key_named(&name);
        let value = match plain_value(&value)? {
            Ok(value) => value,
            Err(shown) => {
                return Err(error_of_case(
                    key.map_err(error_of_case)?.refuse(&name, shown),
                ));
            }
        };
        let key = key.map_err(|error| error_of_case(error.given(&value)))?;
        key.check(key.name, &value).map_err(error_of_case)?;
        Ok((key.name, value))
    });
    read.collect()
}

/// A value of Python or NumPy as one of the engine; what is none is refused in the words of the
/// key.
pub(crate) fn to_value(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    match plain_value(value)? {
        Ok(value) => Ok(value),
        Err(shown) => {
            let key = key_named(name).map_err(error_of_case)?;
            Err(error_of_case(key.refuse(name, shown)))
        }
    }
}

/// A value of Python or NumPy as one of the engine; else what is shown of it.
fn plain_value(value: &Bound<'_, PyAny>) -> PyResult<Result<Value, String>> {
    // NumPy's mark of a masked value would give 0.
    if value.get_type().name()? == "MaskedConstant" {
        return Ok(Err("(a masked value)".to_owned()));
    }
    // NumPy's scalars, and its arrays without dimensions, give Python's own.
    let plain = value.call_method0(intern!(value.py(), "item")).ok();
    let value = plain.as_ref().unwrap_or(value);
    let read = if value.is_instance_of::<PyBool>() {
        value.extract().ok().map(Value::Bool)
    } else if value.is_instance_of::<PyInt>() {
        value.extract().ok().map(Value::Integer)
    } else if value.is_instance_of::<PyString>() {
        value.extract().ok().map(Value::Text)
    } else {
        value.extract().ok().map(Value::Number)
    };
    Ok(match read {
        Some(value) => Ok(value),
        None if value.is_instance_of::<PyInt>() => Err(value.to_string()),
        None => Err(format!("(a {})", value.get_type().name()?)),
    })
}

/// A value as Python's own.
pub(crate) fn to_python(py: Python<'_>, value: Option<Value>) -> PyResult<Bound<'_, PyAny>> {
    match value {
        None => Ok(py.None().into_bound(py)),
        Some(Value::Number(number)) => number.into_bound_py_any(py),
        Some(Value::Integer(number)) => number.into_bound_py_any(py),
        Some(Value::Bool(flag)) => flag.into_bound_py_any(py),
        Some(Value::Text(text)) => text.into_bound_py_any(py),
        Some(Value::List(values)) => {
            let values = values.into_iter().map(|value| to_python(py, Some(value)));
            values.collect::<PyResult<Vec<_>>>()?.into_bound_py_any(py)
        }
    }
}

fn to_dict<'py>(
    py: Python<'py>,
    entries: impl Iterator<Item = (&'static str, Option<Value>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in entries {
        dict.set_item(key, to_python(py, value)?)?;
    }
    Ok(dict)
}
