//! Writes columns of Parquet files.

use crate::parquet_file::{ColumnType, Reader, Values};
use bytes::Bytes;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::{
    ColumnCloseResult, ColumnWriter, get_column_writer, get_typed_column_writer_mut,
};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::reader::FileReader;
use parquet::file::statistics::Statistics;
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnDescPtr, Type, TypePtr};
use rayon::prelude::*;
use std::io::Write;
use std::sync::Arc;

/// The name of a column, its type, and whether each row has a value.
pub(crate) struct Field {
    pub name: &'static str,
    pub column_type: ColumnType,
    pub required: bool,
}

fn schema(fields: &[Field]) -> Result<TypePtr> {
    let column = |field: &Field| {
        let (physical, logical) = match field.column_type {
            ColumnType::Numbers => (Physical::DOUBLE, None),
            ColumnType::Counts => (Physical::INT64, None),
            ColumnType::Flags => (Physical::BOOLEAN, None),
            ColumnType::Words => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let repetition = if field.required {
            Repetition::REQUIRED
        } else {
            Repetition::OPTIONAL
        };
        let column = Type::primitive_type_builder(field.name, physical)
            .with_repetition(repetition)
            .with_logical_type(logical);
        Ok(Arc::new(column.build()?))
    };
    let columns = fields.iter().map(column).collect::<Result<_>>()?;
    let whole = Type::group_type_builder("schema").with_fields(columns);
    Ok(Arc::new(whole.build()?))
}

/// A file that is written, one group of rows after the other.
pub(crate) struct Writer<W: Write + Send>(SerializedFileWriter<W>);

impl<W: Write + Send> Writer<W> {
    pub(crate) fn new(out: W, fields: &[Field], properties: WriterProperties) -> Result<Self> {
        SerializedFileWriter::new(out, schema(fields)?, Arc::new(properties)).map(Self)
    }

    /// Writes a group of rows, given by its columns. They are encoded on all threads, and written
    /// one after the other.
    pub(crate) fn write(&mut self, columns: &[Values]) -> Result<()> {
        let places = self.0.schema_descr().columns();
        if places.len() != columns.len() {
            let words = "a group does not have the columns of the file";
            return Err(ParquetError::General(words.to_owned()));
        }
        let properties = self.0.properties();
        let encode = |(place, values): (&ColumnDescPtr, &Values)| {
            encoded(Arc::clone(place), Arc::clone(properties), values)
        };
        let encoded: Vec<_> = places.par_iter().zip(columns).map(encode).collect();
        let mut group = self.0.next_row_group()?;
        for column in encoded {
            let (bytes, close) = column?;
            group.append_column(&bytes, close)?;
        }
        group.close()?;
        Ok(())
    }

    /// Copies a group of rows from another file without decoding it. The encoding has to be the
    /// same as in this file.
    pub(crate) fn take(&mut self, from: &Reader, group: usize) -> Result<()> {
        let about = from.reader.metadata().row_group(group);
        let mut taken = self.0.next_row_group()?;
        for column in about.columns() {
            let close = ColumnCloseResult {
                bytes_written: column.compressed_size().unsigned_abs(),
                rows_written: about.num_rows().unsigned_abs(),
                metadata: column.clone(),
                bloom_filter: None,
                column_index: None,
                offset_index: None,
            };
            taken.append_column(&from.file, close)?;
        }
        taken.close()?;
        Ok(())
    }

    /// Ends the file.
    pub(crate) fn into_inner(self) -> Result<W> {
        self.0.into_inner()
    }
}

/// A column of a group by itself, as bytes.
fn encoded(
    place: ColumnDescPtr,
    properties: WriterPropertiesPtr,
    values: &Values,
) -> Result<(Bytes, ColumnCloseResult)> {
    let mut bytes = TrackedWrite::new(Vec::new());
    let pages = Box::new(SerializedPageWriter::new(&mut bytes));
    let mut column = get_column_writer(place, properties, pages);
    match values {
        Values::Numbers(list) => put::<DoubleType, _>(&mut column, list, |n| *n)?,
        Values::Counts(list) => put::<Int64Type, _>(&mut column, list, |n| *n)?,
        Values::Flags(list) => put::<BoolType, _>(&mut column, list, |flag| *flag)?,
        Values::Words(list) => {
            // Most words equal that of the row before, and share its bytes.
            let mut latest = ByteArray::from("");
            put::<ByteArrayType, _>(&mut column, list, |word| {
                if latest.data() != word.as_bytes() {
                    latest = word.as_bytes().to_vec().into();
                }
                latest.clone()
            })?;
        }
    }
    let mut close = column.close()?;
    close.metadata = without_old_bounds(close.metadata)?;
    Ok((bytes.into_inner()?.into(), close))
}

/// A column's metadata without the least and largest value in the fields of the format's first
/// version. Readers ignore these, so they would be lost if a group is copied from another file.
fn without_old_bounds(about: ColumnChunkMetaData) -> Result<ColumnChunkMetaData> {
    let new = match about.statistics().cloned() {
        Some(Statistics::Boolean(bounds)) => {
            Statistics::Boolean(bounds.with_backwards_compatible_min_max(false))
        }
        Some(Statistics::Int64(bounds)) => {
            Statistics::Int64(bounds.with_backwards_compatible_min_max(false))
        }
        Some(Statistics::Double(bounds)) => {
            Statistics::Double(bounds.with_backwards_compatible_min_max(false))
        }
        _ => return Ok(about),
    };
    about.into_builder().set_statistics(new).build()
}

fn put<D: DataType, V>(
    column: &mut ColumnWriter<'_>,
    list: &[Option<V>],
    write: impl FnMut(&V) -> D::T,
) -> Result<()> {
    let values: Vec<D::T> = list.iter().flatten().map(write).collect();
    let there: Vec<i16> = list
        .iter()
        .map(|value| i16::from(value.is_some()))
        .collect();
    get_typed_column_writer_mut::<D>(column).write_batch(&values, Some(&there), None)?;
    Ok(())
}
