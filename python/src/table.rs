//! Tables, handed over by the Arrow C data interface: pandas, Polars and PyArrow read the very
//! memory.

use crate::errors::of_program;
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    StringArray,
};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{DataType, Field, SchemaRef};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyCapsule, PyList};
use snapload_study::{Holds, Values};
use std::sync::Arc;

/// Columns of equal length.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

impl Table {
    pub(crate) fn new(schema: SchemaRef, batches: Vec<RecordBatch>) -> Self {
        Self { schema, batches }
    }
}

#[pymethods]
impl Table {
    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// Name and type of each column.
    fn columns(&self) -> Vec<(String, String)> {
        let fields = self.schema.fields().iter();
        fields
            .map(|field| (field.name().clone(), field.data_type().to_string()))
            .collect()
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Another schema is a wish; the protocol lets a producer answer with its own.
        let _ = requested_schema;
        let batches: Vec<_> = self.batches.iter().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, self.schema.clone());
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.schema.as_ref()).map_err(of_program)?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    /// A column for NumPy: its type and bytes, or a list of Python's own values. Numbers that are
    /// missing are NaN, and make whole numbers and flags doubles.
    fn column<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(&'static str, Bound<'py, PyAny>)> {
        let place = self.schema.column_with_name(name);
        let (place, field) = place.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let arrays: Vec<_> = self
            .batches
            .iter()
            .map(|batch| batch.column(place).as_ref())
            .collect();
        let whole = arrays.iter().all(|array| array.null_count() == 0);
        let bytes = |bytes: Vec<u8>| PyByteArray::new(py, &bytes).into_bound_py_any(py);
        match field.data_type() {
            DataType::Float64 => Ok(("float64", bytes(doubles(&arrays))?)),
            DataType::Int64 if whole => {
                let values = arrays
                    .iter()
                    .flat_map(|a| a.as_primitive::<Int64Type>().values());
                Ok((
                    "int64",
                    bytes(values.flat_map(|n| n.to_ne_bytes()).collect())?,
                ))
            }
            DataType::Boolean if whole => {
                let values = arrays.iter().flat_map(|a| a.as_boolean().iter().flatten());
                Ok(("bool", bytes(values.map(u8::from).collect())?))
            }
            DataType::Int64 | DataType::Boolean => Ok(("float64", bytes(doubles(&arrays))?)),
            DataType::Utf8 => {
                let values = arrays.iter().flat_map(|a| a.as_string::<i32>().iter());
                Ok((
                    "object",
                    PyList::new(py, values.collect::<Vec<_>>())?.into_any(),
                ))
            }
            _ => {
                let lists = arrays.iter().flat_map(|a| a.as_list::<i32>().iter());
                let lists = lists.map(|list| match list {
                    Some(list) => list.as_primitive::<Int64Type>().values().to_vec(),
                    None => Vec::new(),
                });
                Ok((
                    "object",
                    PyList::new(py, lists.collect::<Vec<_>>())?.into_any(),
                ))
            }
        }
    }
}

/// A column of a study's file.
pub(crate) fn field_of(name: &str, holds: Holds) -> Field {
    let kind = match holds {
        Holds::Numbers => DataType::Float64,
        Holds::Counts => DataType::Int64,
        Holds::Flags => DataType::Boolean,
        Holds::Words => DataType::Utf8,
    };
    Field::new(name, kind, name != "row")
}

/// Its values.
pub(crate) fn array_of(values: Values) -> ArrayRef {
    match values {
        Values::Numbers(list) => Arc::new(Float64Array::from(list)),
        Values::Counts(list) => Arc::new(Int64Array::from(list)),
        Values::Flags(list) => Arc::new(BooleanArray::from(list)),
        Values::Words(list) => Arc::new(StringArray::from(list)),
    }
}

/// The bytes of numbers and flags as doubles.
fn doubles(arrays: &[&dyn Array]) -> Vec<u8> {
    let of = |array: &dyn Array, k: usize| match array.data_type() {
        _ if array.is_null(k) => f64::NAN,
        DataType::Float64 => array.as_primitive::<Float64Type>().value(k),
        DataType::Int64 => array.as_primitive::<Int64Type>().value(k) as f64,
        _ => f64::from(u8::from(array.as_boolean().value(k))),
    };
    let values = arrays
        .iter()
        .flat_map(|array| (0..array.len()).map(move |k| of(*array, k)));
    values.flat_map(f64::to_ne_bytes).collect()
}
