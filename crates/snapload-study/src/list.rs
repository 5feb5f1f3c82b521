//! A list of cases in a CSV or Parquet file, of which only the needed rows are read.

use crate::StudyError;
use crate::checksum::Sum;
use crate::lines::{CheckedFile, EmptyCells, line_of, records};
use crate::parquet_file::{Reader as ParquetReader, Values, is_parquet};
use csv::{ByteRecord, Reader, ReaderBuilder, Trim};
use parquet::basic::ConvertedType;
use parquet::schema::types::Type;
use snapload::{CaseError, Value, key_named};
use std::error::Error;
use std::fmt::Display;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};

/// The interval between rows of a CSV file whose positions are stored.
const MARK_EVERY: u64 = 1024;

/// The contents of one row: keys with their values, or why it can not be read.
pub(crate) type ListRow = Result<Vec<(&'static str, Value)>, CaseError>;

/// Why rows can not be read: an error of the system, of CSV or of Parquet.
type Unreadable = Box<dyn Error>;

/// A file with one row for each case and one column for each key. For an empty cell the base case's
/// value is used.
#[derive(Debug)]
pub struct List {
    path: PathBuf,
    /// What errors call it.
    called: String,
    keys: Vec<&'static str>,
    count: u64,
    sha256: String,
    format: Format,
}

#[derive(Debug)]
enum Format {
    Csv(Csv),
    Parquet,
}

/// The rows of a CSV file.
#[derive(Debug)]
struct Csv {
    /// The first bytes of every 1024th row.
    marks: Vec<u64>,
    /// Whether it has one column, in which an empty line is a row with an empty cell.
    empty_cells: bool,
    /// The number of empty lines after the last row.
    empty_at_end: u64,
}

impl List {
    /// Opens a list. A file that begins as one of Parquet does, or whose name ends in `.parquet`,
    /// is a Parquet file, any other a CSV file.
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is no such file, if it is of another kind, holds no case, or
    /// if a column is no key.
    pub fn open(path: &Path) -> Result<Self, StudyError> {
        Self::open_named(path, &path.display().to_string())
    }

    /// The same of a file that errors call otherwise, as it is a copy, or was made for this.
    ///
    /// # Errors
    /// As for [`List::open`].
    pub fn open_named(path: &Path, called: &str) -> Result<Self, StudyError> {
        let input = |error: &dyn Display| StudyError::read(called, error).of_input();
        let about = path.metadata().map_err(|error| input(&error))?;
        if !about.is_file() {
            // It is read more than once, from any row, and has to be finite.
            return Err(input(
                &"a list must be a file, which can be read more than once",
            ));
        }
        let named_so = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"));
        let parquet = named_so || is_parquet(path).map_err(|error| input(&error))?;
        let (names, count, format) = if parquet {
            let file = File::open(path).map_err(|error| input(&error))?;
            let reader = ParquetReader::open(file)
                .map_err(|error| input(&format!("it is not a Parquet file ({error})")))?;
            if let Some(codec) = reader.codec_without_reader() {
                return Err(input(&format!(
                    "its columns are compressed with {codec}; allowed: no compression, {}; write it again with one of \
                     these, or as CSV",
                    ParquetReader::CODECS
                )));
            }
            let count = reader.about().num_rows();
            let names = named_columns(called, &reader)?;
            (names, count.unsigned_abs(), Format::Parquet)
        } else {
            let (names, count, csv) = index(path).map_err(|error| input(&error))?;
            (names, count, Format::Csv(csv))
        };
        let keys = keys(called, &names)?;
        let sha256 = digest(path).map_err(|error| input(&error))?;
        if count == 0 {
            let words = match names.is_empty() {
                true => "it is empty; its first line must name keys, such as f_o,omega",
                false => "it contains no case, only names of columns",
            };
            return Err(input(&words));
        }
        Ok(Self {
            path: path.to_owned(),
            called: called.to_owned(),
            keys,
            count,
            sha256,
            format,
        })
    }

    /// How many cases.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The name of the file, without its folder.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The line of the file in which a row begins; none if it has no lines.
    pub fn line(&self, row: u64) -> Option<u64> {
        match &self.format {
            // The first line contains the keys.
            Format::Csv(csv) => line_of(&self.path, csv.empty_cells, row + 1).ok()?,
            Format::Parquet => None,
        }
    }

    /// The number of empty lines at the end of a CSV file of one column, which are no rows.
    pub fn empty_lines_at_end(&self) -> u64 {
        match &self.format {
            Format::Csv(csv) => csv.empty_at_end,
            Format::Parquet => 0,
        }
    }

    /// The keys of its columns, in their order.
    pub fn keys(&self) -> &[&'static str] {
        &self.keys
    }

    /// The SHA-256 of the file, as `sha256sum` prints it.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The rows of a range.
    pub(crate) fn read(&self, range: Range<u64>) -> Result<Vec<ListRow>, StudyError> {
        let rows = match &self.format {
            Format::Csv(csv) => self.read_csv(csv, &range),
            Format::Parquet => self.read_parquet(&range),
        };
        let rows = rows.map_err(|error| StudyError::read(&self.called, error))?;
        if rows.len() as u64 == range.end - range.start {
            return Ok(rows);
        }
        Err(StudyError::read(
            &self.called,
            "it has fewer rows than before",
        ))
    }

    fn read_csv(&self, csv: &Csv, range: &Range<u64>) -> Result<Vec<ListRow>, Unreadable> {
        let mark = range.start / MARK_EVERY;
        let mut file = File::open(&self.path)?;
        // With no mark, which only an empty range has, nothing is read.
        let byte = csv.marks.get(mark as usize).copied().unwrap_or_default();
        file.seek(SeekFrom::Start(byte))?;
        let rows: Box<dyn Read> = match csv.empty_cells {
            true => Box::new(EmptyCells::new(file)),
            false => Box::new(file),
        };
        as_csv(rows, false)
            .into_byte_records()
            .skip((range.start - mark * MARK_EVERY) as usize)
            .take((range.end - range.start) as usize)
            .map(|record| Ok(self.row(&record?)))
            .collect()
    }

    fn row(&self, record: &ByteRecord) -> ListRow {
        if record.len() != self.keys.len() {
            let fields = |count| match count {
                1 => "1 field".to_owned(),
                _ => format!("{count} fields"),
            };
            let shown = format!("(a row with {})", fields(record.len()));
            let allowed = format!("{}, as in the first line", fields(self.keys.len()));
            return Err(CaseError::value("list", shown, allowed));
        }
        let cells = self.keys.iter().zip(record);
        Ok(cells
            .filter_map(|(key, cell)| Some((*key, value(&String::from_utf8_lossy(cell))?)))
            .collect())
    }

    fn read_parquet(&self, range: &Range<u64>) -> Result<Vec<ListRow>, Unreadable> {
        let reader = ParquetReader::open(File::open(&self.path)?)?;
        let places: Vec<usize> = (0..self.keys.len()).collect();
        let (mut rows, mut first) = (Vec::new(), 0);
        for (group, length) in reader.groups().enumerate() {
            let end = first + length;
            let in_group =
                range.start.clamp(first, end) - first..range.end.clamp(first, end) - first;
            if !in_group.is_empty() {
                let columns = reader.read(group, &places, in_group)?;
                rows.extend(self.rows_of(&columns));
            }
            first = end;
        }
        Ok(rows)
    }

    fn rows_of(&self, columns: &[Values]) -> Vec<ListRow> {
        let cells = |row| {
            let cells = self.keys.iter().zip(columns);
            Ok(cells
                .filter_map(|(key, column)| Some((*key, cell(column, row)?)))
                .collect())
        };
        (0..columns.first().map_or(0, Values::len))
            .map(cells)
            .collect()
    }
}

fn digest(path: &Path) -> std::io::Result<String> {
    let mut sum = Sum::default();
    sum.add(File::open(path)?)?;
    Ok(sum.digits())
}

fn as_csv<R: Read>(file: R, headers: bool) -> Reader<R> {
    let mut builder = ReaderBuilder::new();
    let builder = builder.has_headers(headers).flexible(true);
    builder.trim(Trim::All).from_reader(file)
}

/// The names of the columns, the number of rows, and where they are.
fn index(path: &Path) -> Result<(Vec<String>, u64, Csv), Unreadable> {
    let mut reader = as_csv(CheckedFile::open(path)?, true);
    let names = reader.byte_headers()?.iter();
    let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
    let names: Vec<String> = names.collect();
    if names.iter().any(|name| name.contains('\0')) {
        // Every second byte of such a text in UTF-16 is a zero.
        return Err("not a text file in UTF-8; save it as CSV in UTF-8".into());
    }
    let empty_cells = names.len() == 1;
    let (mut marks, mut count) = (Vec::new(), 0);
    let empty_at_end = records(path, empty_cells, |start| {
        if start.number % MARK_EVERY == 1 {
            marks.push(start.byte);
        }
        count = start.number;
        ControlFlow::Continue(())
    })?;
    let csv = Csv {
        marks,
        empty_cells,
        empty_at_end,
    };
    Ok((names, count, csv))
}

/// The names of the columns of a Parquet file, if each is of a type that a key could have.
fn named_columns(called: &str, reader: &ParquetReader) -> Result<Vec<String>, StudyError> {
    let fields = reader.fields().map(|(field, column_type)| {
        let (name, allowed) = (field.name(), "numbers, texts, or true and false");
        column_type.map(|_| name.to_owned()).ok_or_else(|| {
            let shown = CaseError::value(name, "", allowed).key;
            let kind = shown_type(field);
            StudyError::Input(format!(
                "{called}: column {shown} holds {kind}; allowed: {allowed}"
            ))
        })
    });
    fields.collect()
}

/// The type of a column that no key can have, in the format's terms.
fn shown_type(field: &Type) -> String {
    let about = field.get_basic_info();
    match (about.logical_type_ref(), about.converted_type()) {
        (Some(kind), _) => {
            let kind = format!("{kind:?}");
            kind.split(['(', ' ']).next().unwrap_or(&kind).to_owned()
        }
        (None, ConvertedType::NONE) if field.is_primitive() => {
            field.get_physical_type().to_string()
        }
        (None, ConvertedType::NONE) => "columns of its own".to_owned(),
        (None, kind) => kind.to_string(),
    }
}

/// The keys that the columns are named after, each once.
fn keys(called: &str, names: &[String]) -> Result<Vec<&'static str>, StudyError> {
    let wrong = |words: String| StudyError::Input(format!("{called}: {words}"));
    let mut keys = Vec::new();
    for name in names {
        let key = key_named(name).map_err(|error| {
            let hint = if name.contains(';') {
                "the columns of a CSV file are separated by commas"
            } else if name.is_empty() {
                "a column without a name holds the names or numbers of rows; write the file without it, in R with \
                 row.names=FALSE, in pandas with index=False"
            } else {
                "a list has one column per key, named in the first line of a CSV file, and no others"
            };
            wrong(format!("{error}\nhint: {hint}"))
        })?;
        if keys.contains(&key.name) {
            return Err(wrong(format!("two columns are named {}", key.name)));
        }
        keys.push(key.name);
    }
    Ok(keys)
}

/// A cell of a CSV file; none if it is empty. A cell that is neither number nor flag is a word.
fn value(cell: &str) -> Option<Value> {
    Some(match cell {
        "" => return None,
        "true" | "True" | "TRUE" => Value::Bool(true),
        "false" | "False" | "FALSE" => Value::Bool(false),
        _ => match (cell.parse::<i64>(), cell.parse::<f64>()) {
            (Ok(integer), _) => Value::Integer(integer),
            // A number too large for a double stays as it is written; "inf" has no digit.
            (_, Ok(number))
                if number.is_finite() || !cell.contains(|c: char| c.is_ascii_digit()) =>
            {
                Value::Number(number)
            }
            _ => Value::Text(cell.to_owned()),
        },
    })
}

fn cell(column: &Values, row: usize) -> Option<Value> {
    match column {
        Values::Numbers(list) => list[row].map(Value::Number),
        Values::Counts(list) => list[row].map(Value::Integer),
        Values::Flags(list) => list[row].map(Value::Bool),
        Values::Words(list) => list[row].clone().map(|text| Value::Text(text.into_owned())),
    }
}
