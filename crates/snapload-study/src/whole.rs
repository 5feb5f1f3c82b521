//! Files of rows: written, joined in one pass, and read again.

use crate::metadata::Identity;
use crate::table::{batch, schema};
use crate::{Column, Row, StudyError};
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, SchemaRef};
use arrow_select::coalesce::BatchCoalescer;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::arrow::{ArrowWriter, ProjectionMask};
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Rows of a row group. A constant, as the bytes of a file hang on it.
const GROUP: usize = 1 << 16;

/// Rows as the bytes of a file of their own.
pub(crate) fn to_bytes(identity: &Identity, rows: &[Row]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let write = |bytes: &mut Vec<u8>| -> ParquetResult<()> {
        let mut writer = ArrowWriter::try_new(bytes, schema(), Some(properties(identity)?))?;
        writer.write(&batch(rows)?)?;
        writer.close()?;
        Ok(())
    };
    write(&mut bytes).map_err(to_io)?;
    Ok(bytes)
}

fn properties(identity: &Identity) -> ParquetResult<WriterProperties> {
    Ok(WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_max_row_group_row_count(Some(GROUP))
        .set_created_by(format!("snapload {}", identity.version))
        .set_key_value_metadata(Some(identity.to_metadata()))
        .build())
}

/// Puts the rows of files, one file after the other, into a new one, and has it on the disk when it returns.
/// Rows are taken out and written anew, so the bytes depend on the rows and not on how they were cut.
pub(crate) fn join(parts: &[PathBuf], out: &Path, identity: &Identity) -> Result<(), StudyError> {
    let wrong = |error: ParquetError| StudyError::write(out, to_io(error));
    let file = File::create(out).map_err(|error| StudyError::write(out, error))?;
    let properties = properties(identity).map_err(wrong)?;
    let mut writer =
        ArrowWriter::try_new(BufWriter::new(file), schema(), Some(properties)).map_err(wrong)?;
    let mut groups = BatchCoalescer::new(schema(), GROUP);
    for part in parts {
        for batch in open(part)?.build().map_err(|e| StudyError::read(part, e))? {
            let batch = batch.map_err(|error| StudyError::read(part, error))?;
            groups
                .push_batch(batch)
                .map_err(|error| StudyError::read(part, error))?;
            while let Some(group) = groups.next_completed_batch() {
                writer.write(&group).map_err(wrong)?;
            }
        }
    }
    groups
        .finish_buffered_batch()
        .map_err(|error| wrong(error.into()))?;
    if let Some(group) = groups.next_completed_batch() {
        writer.write(&group).map_err(wrong)?;
    }
    let mut buffer = writer.into_inner().map_err(wrong)?;
    buffer
        .flush()
        .and_then(|()| buffer.get_ref().sync_all())
        .map_err(|error| StudyError::write(out, error))
}

fn open(path: &Path) -> Result<ParquetRecordBatchReaderBuilder<File>, StudyError> {
    let file = File::open(path).map_err(|error| StudyError::read(path, error))?;
    ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| StudyError::read(path, error))
}

/// What a file says of itself, if it is one of this program's and has as many rows as it says.
pub fn identity_of(path: &Path) -> Option<Identity> {
    let reader = SerializedFileReader::new(File::open(path).ok()?).ok()?;
    let file = reader.metadata().file_metadata();
    let identity = Identity::from_metadata(file.key_value_metadata()?)?;
    let rows = identity.rows.end.checked_sub(identity.rows.start)?;
    (u64::try_from(file.num_rows()) == Ok(rows)).then_some(identity)
}

/// The system's error where there is one, such as a full disk.
fn to_io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

/// Joins parts of a study into the file that one run would have written, to the byte.
///
/// # Errors
/// [`StudyError::Input`] if the files are not all parts of one study by one version of the program, or do not
/// cover it exactly; [`StudyError::Failed`] if one can not be read, or the whole not be written.
pub fn merge(files: &[PathBuf], out: &Path) -> Result<(), StudyError> {
    let mut parts = Vec::new();
    for path in files {
        let identity = identity_of(path).ok_or_else(|| {
            let shown = path.display();
            StudyError::Input(match File::open(path) {
                Err(_) => format!("{shown}: there is no such file, or it can not be read"),
                Ok(_) => format!("{shown}: not a file of snapload sweep"),
            })
        })?;
        parts.push((identity, path));
    }
    parts.sort_by_key(|(identity, _)| (identity.rows.start, identity.rows.end));
    let Some((first, first_path)) = parts.first() else {
        return Err(StudyError::Input("there are no files to merge".to_owned()));
    };
    let mut next = 0;
    for (identity, path) in &parts {
        if !identity.goes_with(first) {
            return Err(StudyError::Input(format!(
                "{} and {} are parts of different studies, or of different versions of snapload",
                first_path.display(),
                path.display()
            )));
        }
        if identity.rows.start < next {
            let words = format!("{}: its rows are in another file, too", path.display());
            return Err(StudyError::Input(words));
        }
        if identity.rows.start > next {
            return Err(missing(next, identity.rows.start));
        }
        next = identity.rows.end;
    }
    if next < first.cases {
        return Err(missing(next, first.cases));
    }
    let whole = Identity {
        rows: 0..first.cases,
        ..first.clone()
    };
    let paths: Vec<PathBuf> = parts.iter().map(|(_, path)| path.to_path_buf()).collect();
    join(&paths, out, &whole)
}

fn missing(from: u64, to: u64) -> StudyError {
    StudyError::Input(format!(
        "rows {from} to {} are in none of the files; give every part of the study",
        to - 1
    ))
}

/// How the runs of a file ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// How many in which way.
    pub ends: BTreeMap<String, u64>,
    /// Of how many it was found out whether the end is certain.
    pub judged: u64,
    /// How many of these are.
    pub certain: u64,
    /// How many rows have an error.
    pub errors: u64,
    /// The number of the first of those, and its error.
    pub first_error: Option<(u64, String)>,
}

/// Counts how the runs of a file ended.
///
/// # Errors
/// [`StudyError::Failed`] if it can not be read.
pub fn ends(path: &Path) -> Result<Tally, StudyError> {
    let mut tally = Tally::default();
    let mut row = identity_of(path).map_or(0, |identity| identity.rows.start);
    read_columns(path, &["end", "certain", "error"], |columns| {
        let (ends, errors) = (columns[0].as_string::<i32>(), columns[2].as_string::<i32>());
        for certain in columns[1].as_boolean().iter().flatten() {
            tally.judged += 1;
            tally.certain += u64::from(certain);
        }
        for (end, error) in ends.iter().zip(errors) {
            if let Some(end) = end {
                match tally.ends.get_mut(end) {
                    Some(count) => *count += 1,
                    None => _ = tally.ends.insert(end.to_owned(), 1),
                }
            }
            if let Some(error) = error {
                tally.errors += 1;
                tally
                    .first_error
                    .get_or_insert_with(|| (row, error.to_owned()));
            }
            row += 1;
        }
    })?;
    Ok(tally)
}

/// What a column holds in one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown<'a> {
    /// A number.
    Number(f64),
    /// A word, or `true` or `false`.
    Word(&'a str),
    /// Nothing, as the run has no such thing.
    Nothing,
    /// Nothing, as there was no run.
    Fault,
}

/// Shows one column of a file, row by row from its first one, which counts as 0.
///
/// # Errors
/// [`StudyError::Failed`] if it can not be read.
pub fn read_shown(
    path: &Path,
    column: &Column,
    mut visit: impl FnMut(u64, Shown),
) -> Result<(), StudyError> {
    let mut row = 0;
    read_columns(path, &[column.name, "error"], |columns| {
        let (values, errors) = (&columns[0], columns[1].as_string::<i32>());
        for k in 0..values.len() {
            let shown = match values.data_type() {
                _ if errors.is_valid(k) => Shown::Fault,
                _ if values.is_null(k) => Shown::Nothing,
                DataType::Float64 => Shown::Number(values.as_primitive::<Float64Type>().value(k)),
                DataType::Int64 => {
                    Shown::Number(values.as_primitive::<Int64Type>().value(k) as f64)
                }
                DataType::Boolean if values.as_boolean().value(k) => Shown::Word("true"),
                DataType::Boolean => Shown::Word("false"),
                _ => Shown::Word(values.as_string::<i32>().value(k)),
            };
            visit(row, shown);
            row += 1;
        }
    })
}

/// All columns of a file, as it is: a file of a study, or any other.
///
/// # Errors
/// [`StudyError::Failed`] if the file can not be read.
pub fn read_all(path: &Path) -> Result<(SchemaRef, Vec<RecordBatch>), StudyError> {
    let reader = open(path)?;
    let schema = reader.schema().clone();
    let batches = reader
        .build()
        .map_err(|error| StudyError::read(path, error))?;
    let batches: Result<Vec<RecordBatch>, _> = batches.collect();
    Ok((
        schema,
        batches.map_err(|error| StudyError::read(path, error))?,
    ))
}

fn read_columns(
    path: &Path,
    names: &[&str],
    mut visit: impl FnMut(&[ArrayRef]),
) -> Result<(), StudyError> {
    let reader = open(path)?;
    let mask = ProjectionMask::columns(reader.parquet_schema(), names.iter().copied());
    let reader = reader.with_projection(mask).build();
    for batch in reader.map_err(|error| StudyError::read(path, error))? {
        let batch = batch.map_err(|error| StudyError::read(path, error))?;
        let columns = names.iter().filter_map(|name| batch.column_by_name(name));
        let columns: Vec<ArrayRef> = columns.cloned().collect();
        if columns.len() == names.len() {
            visit(&columns);
        }
    }
    Ok(())
}
