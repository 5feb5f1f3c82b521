//! Tables, shared by the Arrow C data interface: pandas, Polars and PyArrow read the same memory
//! without a copy.

use crate::errors::internal_error;
use arrow_array::builder::{Int64Builder, ListBuilder};
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyCapsule, PyList};
use snapload_study::Values;
use std::collections::HashMap;
use std::sync::Arc;

/// Columns of equal length, without gaps.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Table {
    schema: SchemaRef,
    batch: RecordBatch,
}

impl Table {
    pub(crate) fn new(schema: SchemaRef, columns: Vec<ArrayRef>) -> PyResult<Self> {
        let batch = RecordBatch::try_new(Arc::clone(&schema), columns).map_err(internal_error)?;
        Ok(Self { schema, batch })
    }
}

#[pymethods]
impl Table {
    fn __len__(&self) -> usize {
        self.batch.num_rows()
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
        // A requested schema is only a preference; the protocol allows a producer to use its own.
        let _ = requested_schema;
        let reader = RecordBatchIterator::new([Ok(self.batch.clone())], self.schema.clone());
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.schema.as_ref()).map_err(internal_error)?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    /// A column for NumPy: its type and bytes, or a list of Python's own values.
    fn column<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(&'static str, Bound<'py, PyAny>)> {
        let place = self.schema.column_with_name(name);
        let (place, field) = place.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let array = self.batch.column(place);
        let bytes = |bytes: Vec<u8>| PyByteArray::new(py, &bytes).into_bound_py_any(py);
        match field.data_type() {
            DataType::Float64 => {
                let values = array.as_primitive::<Float64Type>().values();
                let all = values.iter().flat_map(|x| x.to_ne_bytes());
                Ok(("float64", bytes(all.collect())?))
            }
            DataType::Int64 => {
                let values = array.as_primitive::<Int64Type>().values();
                let all = values.iter().flat_map(|n| n.to_ne_bytes());
                Ok(("int64", bytes(all.collect())?))
            }
            DataType::Boolean => {
                let values = array.as_boolean().values().iter().map(u8::from);
                Ok(("bool", bytes(values.collect())?))
            }
            DataType::Utf8 => {
                let values: Vec<_> = array.as_string::<i32>().iter().collect();
                Ok(("object", PyList::new(py, values)?.into_any()))
            }
            _ => {
                let lists = array.as_list::<i32>().iter().flatten();
                let lists = lists.map(|list| list.as_primitive::<Int64Type>().values().to_vec());
                let lists: Vec<_> = lists.collect();
                Ok(("object", PyList::new(py, lists)?.into_any()))
            }
        }
    }

    /// Its columns as `Table.of` takes them.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Vec<Part<'py>>> {
        let fields = self.schema.fields().iter();
        let parts = fields.map(|field| {
            let (_, values) = self.column(py, field.name())?;
            let kind = kind_of(field.data_type()).to_owned();
            let words = field.metadata().iter();
            let words = words.map(|(key, word)| (key.clone(), word.clone()));
            Ok((field.name().clone(), kind, words.collect(), values))
        });
        parts.collect()
    }

    /// A table of columns: name, kind (`float64`, `int64`, `bool`, `words` or `lists` of whole
    /// numbers), metadata, and what `column` gives of such a one.
    #[staticmethod]
    fn of(parts: Vec<Part<'_>>) -> PyResult<Self> {
        let mut fields = Vec::new();
        let mut arrays = Vec::new();
        for (name, kind, metadata, values) in parts {
            let array = array_from(&kind, &values)?;
            let field = Field::new(name, array.data_type().clone(), false);
            fields.push(field.with_metadata(metadata));
            arrays.push(array);
        }
        Self::new(Arc::new(Schema::new(fields)), arrays)
    }
}

/// Name, kind, metadata and values of a column.
type Part<'py> = (String, String, HashMap<String, String>, Bound<'py, PyAny>);

fn kind_of(of: &DataType) -> &'static str {
    match of {
        DataType::Float64 => "float64",
        DataType::Int64 => "int64",
        DataType::Boolean => "bool",
        DataType::Utf8 => "words",
        _ => "lists",
    }
}

fn array_from(kind: &str, values: &Bound<'_, PyAny>) -> PyResult<ArrayRef> {
    Ok(match kind {
        "float64" => {
            let bytes: Vec<u8> = values.extract()?;
            let numbers = bytes.as_chunks::<8>().0.iter();
            let numbers = numbers.map(|bytes| f64::from_ne_bytes(*bytes));
            Arc::new(Float64Array::from_iter_values(numbers))
        }
        "int64" => {
            let bytes: Vec<u8> = values.extract()?;
            let numbers = bytes.as_chunks::<8>().0.iter();
            let numbers = numbers.map(|bytes| i64::from_ne_bytes(*bytes));
            Arc::new(Int64Array::from_iter_values(numbers))
        }
        "bool" => {
            let bytes: Vec<u8> = values.extract()?;
            let flags: Vec<bool> = bytes.into_iter().map(|byte| byte != 0).collect();
            Arc::new(BooleanArray::from(flags))
        }
        "words" => {
            let words: Vec<String> = values.extract()?;
            Arc::new(StringArray::from_iter_values(words))
        }
        _ => {
            let lists: Vec<Vec<i64>> = values.extract()?;
            let mut builder = ListBuilder::new(Int64Builder::new());
            for list in lists {
                builder.values().append_slice(&list);
                builder.append(true);
            }
            Arc::new(builder.finish())
        }
    })
}

/// Values as an array that holds one each.
pub(crate) fn array_of(values: Values) -> ArrayRef {
    match values {
        Values::Numbers(list) => {
            Arc::new(Float64Array::from_iter_values(list.into_iter().flatten()))
        }
        Values::Counts(list) => Arc::new(Int64Array::from_iter_values(list.into_iter().flatten())),
        Values::Flags(list) => {
            let flags: Vec<bool> = list.into_iter().flatten().collect();
            Arc::new(BooleanArray::from(flags))
        }
        Values::Words(list) => Arc::new(StringArray::from_iter_values(list.into_iter().flatten())),
    }
}
