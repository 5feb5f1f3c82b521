//! Complete files of rows: writing, joining in one pass, and reading.

use crate::checksum::{blank_entry, damage, write_checksum};
use crate::metadata::{Identity, Shard};
use crate::parquet_file::{ColumnType, Reader, Values, is_parquet};
use crate::parquet_writer::{Field, Writer};
use crate::table::{columns_of, fields};
use crate::{Column, Row, StudyError};
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesBuilder};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Cursor, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Rows of a row group. A constant, as the bytes of a file depend on it.
pub(crate) const GROUP: usize = 1 << 15;

/// The level of compression; higher levels make columns no shorter.
const LEVEL: i32 = 1;

/// The most missing parts that are named in a message.
const MOST_NAMES: usize = 10;

/// Rows as the bytes of a file of their own.
pub(crate) fn to_bytes(identity: &Identity, rows: &[&Row]) -> io::Result<Vec<u8>> {
    let write = || {
        let mut writer = Writer::new(Vec::new(), &fields(), properties(identity)?)?;
        writer.write(&columns_of(identity.rows.clone(), rows))?;
        writer.into_inner()
    };
    let mut bytes = write().map_err(to_io)?;
    write_checksum(Cursor::new(&mut bytes[..]))?;
    Ok(bytes)
}

/// How columns are encoded. There are few different words, which are in a dictionary. The results
/// of runs are all different, and the numbers of keys follow a pattern, which is compressed without
/// the time for making a dictionary. Statistics are those of a row group, which is small enough.
fn properties(identity: &Identity) -> ParquetResult<WriterProperties> {
    let mut notes = identity.to_metadata();
    notes.push(blank_entry());
    let described = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(LEVEL)?))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_offset_index_disabled(true)
        .set_dictionary_enabled(false)
        .set_created_by(format!("snapload {}", identity.version))
        .set_key_value_metadata(Some(notes));
    let fields = fields();
    let words = fields
        .iter()
        .filter(|field| field.column_type == ColumnType::Words);
    let with = |properties: WriterPropertiesBuilder, field: &Field| {
        properties.set_column_dictionary_enabled(field.name.into(), true)
    };
    Ok(words.fold(described, with).build())
}

/// Copies the rows of files, one file after the other, into a new one, and returns when it is
/// synced to the disk. Row groups that coincide with those of the new file are copied unchanged,
/// and have the same bytes as if their rows were decoded and written again, as all others are. So
/// the bytes depend on the rows and not on how they were divided.
///
/// # Errors
/// [`StudyError::Damaged`] if one of the files is wrong, and [`StudyError::Failed`] if the new one
/// can not be written.
pub(crate) fn join(parts: &[PathBuf], out: &Path, identity: &Identity) -> Result<(), StudyError> {
    let wrong = |error: ParquetError| StudyError::write(out, to_io(error));
    let mut made = OpenOptions::new();
    let made = made.read(true).write(true).create(true).truncate(true);
    let file = made
        .open(out)
        .map_err(|error| StudyError::write(out, error))?;
    let properties = properties(identity).map_err(wrong)?;
    let fields = fields();
    let mut writer = Writer::new(BufWriter::new(file), &fields, properties).map_err(wrong)?;
    let nothing = || fields.iter().map(|field| Values::none(field.column_type));
    let mut waiting: Vec<Values> = nothing().collect();
    for part in parts {
        let columns = Columns::all(part)?;
        for (group, rows) in columns.reader.groups().enumerate() {
            let last =
                part == &parts[parts.len() - 1] && group + 1 == columns.reader.groups().len();
            if waiting[0].len() == 0 && (last || rows == GROUP as u64) {
                writer.take(&columns.reader, group).map_err(wrong)?;
                continue;
            }
            for (list, more) in waiting.iter_mut().zip(columns.read(group, 0..rows)?) {
                list.append(more);
            }
            while waiting[0].len() >= GROUP {
                let group = waiting.iter_mut().map(|list| list.take_first(GROUP));
                writer.write(&group.collect::<Vec<_>>()).map_err(wrong)?;
            }
        }
    }
    if waiting[0].len() > 0 {
        writer.write(&waiting).map_err(wrong)?;
    }
    let mut buffer = writer.into_inner().map_err(wrong)?;
    buffer
        .flush()
        .and_then(|()| write_checksum(buffer.get_ref()))
        .and_then(|()| buffer.get_ref().sync_all())
        .map_err(|error| StudyError::write(out, error))
}

fn open(path: &Path) -> Result<Reader, StudyError> {
    let file = File::open(path).map_err(|error| StudyError::damaged(path, error))?;
    Reader::open(file).map_err(|error| StudyError::damaged(path, error))
}

/// The identity in a file's metadata, if it is one of this program's and has as many rows as it
/// says.
pub fn identity_of(path: &Path) -> Option<Identity> {
    identity(&open(path).ok()?)
}

fn identity(reader: &Reader) -> Option<Identity> {
    let about = reader.about();
    let identity = Identity::from_metadata(about.key_value_metadata()?)?;
    let rows = identity.rows.end.checked_sub(identity.rows.start)?;
    (u64::try_from(about.num_rows()) == Ok(rows)).then_some(identity)
}

/// The system's error if there is one, such as a full disk.
pub(crate) fn to_io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

/// Joins parts of a study into the file that a single run would have written, to the byte.
///
/// # Errors
/// [`StudyError::Input`] if the files are not all parts of one study by one version of the program,
/// if one is damaged, or if they do not cover it exactly; [`StudyError::Failed`] if the whole can
/// not be written.
pub fn merge(files: &[PathBuf], out: &Path) -> Result<(), StudyError> {
    let mut parts = Vec::new();
    for path in files {
        parts.push((identity_of_part(path)?, path));
    }
    parts.sort_by_key(|(identity, _)| (identity.rows.start, identity.rows.end));
    let Some((first, first_path)) = parts.first() else {
        return Err(StudyError::Input("there are no files to merge".to_owned()));
    };
    let mut next = 0;
    for (identity, path) in &parts {
        if !identity.is_same_study_as(first) {
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
            return Err(missing(next..identity.rows.start, &parts));
        }
        next = identity.rows.end;
    }
    if next < first.cases {
        return Err(missing(next..first.cases, &parts));
    }
    let whole = Identity {
        rows: 0..first.cases,
        shard: None,
        ..first.clone()
    };
    let paths: Vec<PathBuf> = parts.iter().map(|(_, path)| path.to_path_buf()).collect();
    join(&paths, out, &whole).map_err(|error| match error {
        StudyError::Damaged { .. } => StudyError::Input(error.to_string()),
        other => other,
    })
}

/// The identity of a part, after its checksum is checked.
fn identity_of_part(path: &Path) -> Result<Identity, StudyError> {
    let shown = path.display();
    if File::open(path).is_err() {
        let words = format!("{shown}: there is no such file, or it can not be read");
        return Err(StudyError::Input(words));
    }
    if let Some(why) = damage(path) {
        return Err(StudyError::Input(format!(
            "{shown} can not be used: {why}\nhint: if it was copied here, copy it again; else remove it and compute \
             that part again, with the snapload sweep --shard that made it"
        )));
    }
    identity_of(path).ok_or_else(|| {
        let words = format!("{shown}: not a Parquet file of snapload sweep");
        StudyError::Input(words)
    })
}

/// The error of rows that are in none of the parts, with the names of the missing parts.
fn missing(rows: Range<u64>, parts: &[(Identity, &PathBuf)]) -> StudyError {
    let there: Option<Vec<Shard>> = parts.iter().map(|(identity, _)| identity.shard).collect();
    let there = there.unwrap_or_default();
    let cases = parts.first().map_or(0, |(identity, _)| identity.cases);
    let known = there.first().copied();
    let absent = known.into_iter().flat_map(Shard::all);
    let absent = absent.filter(|part| !part.rows(cases).is_empty() && !there.contains(part));
    let mut names: Vec<String> = absent
        .take(MOST_NAMES + 1)
        .map(|part| part.to_string())
        .collect();
    if names.len() > MOST_NAMES {
        names[MOST_NAMES] = "...".to_owned();
    }
    let give = match &names[..] {
        [] => "give every part of the study".to_owned(),
        names => format!("missing: --shard {}", names.join(", ")),
    };
    StudyError::Input(format!(
        "rows {} to {} are in none of the files; {give}",
        rows.start,
        rows.end - 1
    ))
}

/// How the runs of a file ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudyEnds {
    /// The number of runs for each kind of end.
    pub ends: BTreeMap<String, u64>,
    /// The number of runs whose certainty was computed.
    pub judged: u64,
    /// The number of these whose end is certain.
    pub certain: u64,
    /// The number of rows with an error.
    pub errors: u64,
    /// The number of the first row with an error, and the error.
    pub first_error: Option<(u64, String)>,
}

/// Counts how the runs of a file ended.
///
/// # Errors
/// [`StudyError::Damaged`] if it can not be read.
pub fn ends(path: &Path) -> Result<StudyEnds, StudyError> {
    let mut tally = StudyEnds::default();
    let mut row = identity_of(path).map_or(0, |identity| identity.rows.start);
    let columns = Columns::named(path, &["end", "certain", "error"])?;
    columns.each(|columns| {
        let [
            Values::Words(ends),
            Values::Flags(certain),
            Values::Words(errors),
        ] = &columns[..]
        else {
            return;
        };
        for certain in certain.iter().flatten() {
            tally.judged += 1;
            tally.certain += u64::from(*certain);
        }
        for (end, error) in ends.iter().zip(errors) {
            if let Some(end) = end {
                match tally.ends.get_mut(&**end) {
                    Some(count) => *count += 1,
                    None => _ = tally.ends.insert(end.to_string(), 1),
                }
            }
            if let Some(error) = error {
                tally.errors += 1;
                tally
                    .first_error
                    .get_or_insert_with(|| (row, error.to_string()));
            }
            row += 1;
        }
    })?;
    Ok(tally)
}

/// The value of a column in one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShownValue<'a> {
    /// A number.
    Number(f64),
    /// A word, or `true` or `false`.
    Word(&'a str),
    /// None, as the run has no such value.
    Nothing,
    /// None, as there was no run.
    Fault,
}

/// Passes the values of one column of a file, row by row from its first one, which is number 0, and
/// the number of the impact at which trust in the run ends, if it ends before the run does.
///
/// # Errors
/// [`StudyError::Damaged`] if it can not be read.
pub fn read_shown(
    path: &Path,
    column: &Column,
    mut visit: impl FnMut(u64, ShownValue, Option<i64>),
) -> Result<(), StudyError> {
    let mut row = 0;
    let columns = Columns::named(path, &[column.name, "error", "horizon_impact"])?;
    columns.each(|columns| {
        let [values, Values::Words(errors), Values::Counts(horizons)] = &columns[..] else {
            return;
        };
        for (k, error) in errors.iter().enumerate() {
            let shown = match values {
                _ if error.is_some() => Some(ShownValue::Fault),
                Values::Numbers(list) => list[k].map(ShownValue::Number),
                Values::Counts(list) => list[k].map(|n| ShownValue::Number(n as f64)),
                Values::Flags(list) => {
                    list[k].map(|flag| ShownValue::Word(if flag { "true" } else { "false" }))
                }
                Values::Words(list) => list[k].as_deref().map(ShownValue::Word),
            };
            visit(row, shown.unwrap_or(ShownValue::Nothing), horizons[k]);
            row += 1;
        }
    })
}

/// The names and types of the columns of a study's file, in their order.
pub fn columns_of_files() -> Vec<(&'static str, ColumnType)> {
    fields()
        .iter()
        .map(|field| (field.name, field.column_type))
        .collect()
}

/// The identity of a study's file, after its checksum is checked; none if it is another file.
///
/// # Errors
/// [`StudyError::Damaged`] if the file can not be read, or has changed since it was written.
pub fn checked_identity(path: &Path) -> Result<Option<Identity>, StudyError> {
    if !is_parquet(path).map_err(|error| StudyError::damaged(path, error))? {
        return Ok(None);
    }
    let Some(identity) = identity(&open(path)?) else {
        return Ok(None);
    };
    match damage(path) {
        Some(why) => Err(StudyError::damaged(path, why)),
        None => Ok(Some(identity)),
    }
}

/// One column of a file, some tens of thousands of rows at a time, limited to these rows; the first
/// row of the file is number 0. The type of the column is known from the values even if there are
/// no rows.
///
/// # Errors
/// [`StudyError::Damaged`] if it can not be read.
pub fn read_rows(
    path: &Path,
    name: &str,
    rows: Range<u64>,
    mut visit: impl FnMut(Values),
) -> Result<(), StudyError> {
    let columns = Columns::named(path, &[name])?;
    let (_, kind) = columns.reader.fields().nth(columns.places[0]).unzip();
    kind.flatten().map(Values::none).map(&mut visit);
    let mut begin = 0;
    for (group, count) in columns.reader.groups().enumerate() {
        let overlap = rows.start.max(begin)..rows.end.min(begin + count);
        if overlap.start < overlap.end {
            let here = overlap.start - begin..overlap.end - begin;
            columns.read(group, here)?.into_iter().for_each(&mut visit);
        }
        begin += count;
    }
    Ok(())
}

/// Some columns of a file of rows.
pub(crate) struct Columns<'a> {
    path: &'a Path,
    reader: Reader,
    places: Vec<usize>,
}

impl<'a> Columns<'a> {
    /// The names of all columns of a study's file.
    pub(crate) fn names() -> Vec<&'static str> {
        fields().iter().map(|field| field.name).collect()
    }

    /// All columns of a study's file.
    pub(crate) fn all(path: &'a Path) -> Result<Self, StudyError> {
        Self::named(path, &Self::names())
    }

    fn named(path: &'a Path, names: &[&str]) -> Result<Self, StudyError> {
        let reader = open(path)?;
        let place = |name: &&str| {
            let found = reader.fields().position(|(field, _)| field.name() == *name);
            found.ok_or_else(|| StudyError::damaged(path, format!("it has no column {name}")))
        };
        let places = names.iter().map(place).collect::<Result<_, _>>()?;
        Ok(Self {
            path,
            reader,
            places,
        })
    }

    /// Their values in some rows of a group.
    fn read(&self, group: usize, rows: Range<u64>) -> Result<Vec<Values>, StudyError> {
        let columns = self.reader.read(group, &self.places, rows);
        columns.map_err(|error| StudyError::damaged(self.path, error))
    }

    /// All of their values, group by group.
    pub(crate) fn each(&self, mut visit: impl FnMut(Vec<Values>)) -> Result<(), StudyError> {
        for (group, rows) in self.reader.groups().enumerate() {
            visit(self.read(group, 0..rows)?);
        }
        Ok(())
    }
}
