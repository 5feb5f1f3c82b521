//! A list of cases in a CSV or Parquet file, read where it is needed and never as a whole.

use crate::StudyError;
use crate::parquet_file::{Reader as ParquetReader, Values};
use csv::{ByteRecord, Position, Reader, ReaderBuilder, Trim};
use parquet::basic::ConvertedType;
use parquet::errors::Result as ParquetResult;
use parquet::schema::types::Type;
use sha2::{Digest, Sha256};
use snapload::{CaseError, Value, key_named};
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The place of every so many rows of a CSV file is remembered.
const MARK_EVERY: u64 = 1024;

/// What one row gives: keys with their values, or why it can not be read.
pub(crate) type ListRow = Result<Vec<(&'static str, Value)>, CaseError>;

/// A file with a row a case and a column a key. An empty cell leaves the key to the base case.
#[derive(Debug)]
pub struct List {
    path: PathBuf,
    keys: Vec<&'static str>,
    count: u64,
    sha256: String,
    format: Format,
}

#[derive(Debug)]
enum Format {
    Csv { marks: Vec<Position> },
    Parquet,
}

impl List {
    /// Opens a list; a name that ends in `.parquet` is a Parquet file, any other a CSV file.
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is no such file, if it is of another kind, holds no case, or if a column
    /// is no key.
    pub fn open(path: &Path) -> Result<Self, StudyError> {
        let input = |error: &dyn std::fmt::Display| StudyError::read(path, error).of_input();
        let sha256 = digest(path).map_err(|error| input(&error))?;
        let parquet = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"));
        let (names, count, format) = if parquet {
            let file = File::open(path).map_err(|error| input(&error))?;
            let reader = ParquetReader::open(file)
                .map_err(|error| input(&format!("it is no Parquet file ({error})")))?;
            let count = reader.about().num_rows();
            let names = named_columns(path, &reader)?;
            (names, count.unsigned_abs(), Format::Parquet)
        } else {
            let (names, marks, count) = index(path).map_err(|error| input(&error))?;
            (names, count, Format::Csv { marks })
        };
        let keys = keys(path, &names)?;
        if count == 0 {
            return Err(input(&"it holds no case, only names of columns"));
        }
        Ok(Self {
            path: path.to_owned(),
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

    /// The name of the file, without the way to it.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// What `sha256sum` prints of the file.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The rows of a range.
    pub(crate) fn read(&self, range: Range<u64>) -> Result<Vec<ListRow>, StudyError> {
        let rows = match &self.format {
            Format::Csv { marks } => self.read_csv(marks, &range),
            Format::Parquet => self.read_parquet(&range),
        };
        let rows = rows.map_err(|words| StudyError::read(&self.path, words))?;
        if rows.len() as u64 == range.end - range.start {
            return Ok(rows);
        }
        Err(StudyError::read(
            &self.path,
            "it has fewer rows than before",
        ))
    }

    fn read_csv(&self, marks: &[Position], range: &Range<u64>) -> Result<Vec<ListRow>, String> {
        let mark = range.start / MARK_EVERY;
        let mut reader = open_csv(&self.path).map_err(|error| error.to_string())?;
        let position = marks
            .get(mark as usize)
            .cloned()
            .unwrap_or_else(Position::new);
        reader.seek(position).map_err(|error| error.to_string())?;
        reader
            .into_byte_records()
            .skip((range.start - mark * MARK_EVERY) as usize)
            .take((range.end - range.start) as usize)
            .map(|record| Ok(self.row(&record.map_err(|error| error.to_string())?)))
            .collect()
    }

    fn row(&self, record: &ByteRecord) -> ListRow {
        if record.len() != self.keys.len() {
            let shown = format!("(a row with {} fields)", record.len());
            let allowed = format!("{} fields, as in the first line", self.keys.len());
            return Err(CaseError::value("list", shown, allowed));
        }
        let cells = self.keys.iter().zip(record);
        Ok(cells
            .filter_map(|(key, cell)| Some((*key, value(&String::from_utf8_lossy(cell))?)))
            .collect())
    }

    fn read_parquet(&self, range: &Range<u64>) -> Result<Vec<ListRow>, String> {
        let file = File::open(&self.path).map_err(|error| error.to_string())?;
        let read = || -> ParquetResult<Vec<ListRow>> {
            let reader = ParquetReader::open(file)?;
            let places: Vec<usize> = (0..self.keys.len()).collect();
            let (mut rows, mut first) = (Vec::new(), 0);
            for (group, length) in reader.groups().enumerate() {
                let end = first + length;
                let wanted =
                    range.start.clamp(first, end) - first..range.end.clamp(first, end) - first;
                if !wanted.is_empty() {
                    let columns = reader.read(group, &places, wanted)?;
                    rows.extend(self.rows_of(&columns));
                }
                first = end;
            }
            Ok(rows)
        };
        read().map_err(|error| error.to_string())
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
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let length = file.read(&mut buffer)?;
        if length == 0 {
            let bytes = hash.finalize();
            return Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect());
        }
        hash.update(&buffer[..length]);
    }
}

fn open_csv(path: &Path) -> csv::Result<Reader<File>> {
    ReaderBuilder::new()
        .flexible(true)
        .trim(Trim::All)
        .from_path(path)
}

/// The names of the columns, the place of every 1024th row, and how many rows there are.
fn index(path: &Path) -> csv::Result<(Vec<String>, Vec<Position>, u64)> {
    let mut reader = open_csv(path)?;
    let names = reader.byte_headers()?.iter();
    let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
    let names = names.collect();
    let (mut marks, mut count) = (Vec::new(), 0_u64);
    let mut record = ByteRecord::new();
    loop {
        let position = reader.position().clone();
        if !reader.read_byte_record(&mut record)? {
            return Ok((names, marks, count));
        }
        if count.is_multiple_of(MARK_EVERY) {
            marks.push(position);
        }
        count += 1;
    }
}

/// The names of the columns of a Parquet file, if each is of a type that a key could have.
fn named_columns(path: &Path, reader: &ParquetReader) -> Result<Vec<String>, StudyError> {
    let fields = reader.fields().map(|(field, holds)| {
        let (name, allowed) = (field.name(), "numbers, texts, or true and false");
        holds.map(|_| name.to_owned()).ok_or_else(|| {
            let (shown, file) = (CaseError::value(name, "", allowed).key, path.display());
            let kind = shown_type(field);
            StudyError::Input(format!(
                "{file}: column {shown} holds {kind}; allowed: {allowed}"
            ))
        })
    });
    fields.collect()
}

/// What a column holds that no key could, in the format's own words.
fn shown_type(field: &Type) -> String {
    let about = field.get_basic_info();
    match (about.logical_type_ref(), about.converted_type()) {
        (Some(kind), _) => format!("{kind:?}"),
        (None, ConvertedType::NONE) if field.is_primitive() => {
            field.get_physical_type().to_string()
        }
        (None, ConvertedType::NONE) => "columns of its own".to_owned(),
        (None, kind) => kind.to_string(),
    }
}

/// The keys that the columns are named after, each once.
fn keys(path: &Path, names: &[String]) -> Result<Vec<&'static str>, StudyError> {
    let wrong = |words: String| StudyError::Input(format!("{}: {words}", path.display()));
    let mut keys = Vec::new();
    for name in names {
        let key = key_named(name).map_err(|error| {
            wrong(format!(
                "{error}\nhint: a list has the names of keys in its first line, and nothing else beside them"
            ))
        })?;
        if keys.contains(&key.name) {
            return Err(wrong(format!("{} stands over two columns", key.name)));
        }
        keys.push(key.name);
    }
    Ok(keys)
}

/// A cell of a CSV file; none where it is empty. What is neither number nor flag is a word.
fn value(cell: &str) -> Option<Value> {
    Some(match cell {
        "" => return None,
        "true" | "True" | "TRUE" => Value::Bool(true),
        "false" | "False" | "FALSE" => Value::Bool(false),
        _ => match (cell.parse::<i64>(), cell.parse::<f64>()) {
            (Ok(integer), _) => Value::Integer(integer),
            (_, Ok(number)) => Value::Number(number),
            _ => Value::Text(cell.to_owned()),
        },
    })
}

fn cell(column: &Values, row: usize) -> Option<Value> {
    match column {
        Values::Numbers(list) => list[row].map(Value::Number),
        Values::Counts(list) => list[row].map(Value::Integer),
        Values::Flags(list) => list[row].map(Value::Bool),
        Values::Words(list) => list[row].clone().map(Value::Text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use half::f16;
    use parquet::data_type::{ByteArray, ByteArrayType, FixedLenByteArray, FixedLenByteArrayType};
    use parquet::data_type::{FloatType, Int32Type, Int64Type};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;
    use std::io::Write;
    use std::sync::Arc;

    fn csv(text: &str) -> tempfile::NamedTempFile {
        let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
        file.write_all(text.as_bytes()).unwrap();
        file
    }

    #[test]
    fn a_csv_file_is_read_from_anywhere() {
        let mut text = "f_o, e ,body\n".to_owned();
        for k in 0..5000 {
            text += &format!("0.{k:04},1,\"rigid\"\n");
        }
        let file = csv(&text);
        let list = List::open(file.path()).unwrap();
        assert_eq!(list.count(), 5000);
        for range in [0..3, 1023..1026, 4999..5000, 2048..2049] {
            for (row, k) in list.read(range.clone()).unwrap().into_iter().zip(range) {
                let f_o = format!("0.{k:04}").parse::<f64>().unwrap();
                let wanted: ListRow = Ok(vec![
                    ("f_o", Value::Number(f_o)),
                    ("e", Value::Integer(1)),
                    ("body", Value::Text("rigid".to_owned())),
                ]);
                assert_eq!(row, wanted);
            }
        }
    }

    /// A file with a column each of the types that other programs write, two groups of so many rows.
    fn parquet(rows: usize) -> tempfile::NamedTempFile {
        let columns = "message schema {
            optional float f_o;
            required binary body (STRING);
            required int32 max_impacts (INTEGER(16,false));
            optional int64 e (DECIMAL(6,3));
            required fixed_len_byte_array(2) omega (DECIMAL(4,1));
            required fixed_len_byte_array(2) c (FLOAT16);
            optional int32 a (UNKNOWN);
        }";
        let schema = Arc::new(parse_message_type(columns).unwrap());
        let mut file = tempfile::Builder::new();
        let file = file.suffix(".parquet").tempfile().unwrap();
        let mut writer = SerializedFileWriter::new(&file, schema, Arc::default()).unwrap();
        for start in [0, rows] {
            let rows = start..start + rows;
            let mut group = writer.next_row_group().unwrap();
            macro_rules! put {
                ($kind:ty, $values:expr, $there:expr) => {
                    let mut column = group.next_column().unwrap().unwrap();
                    let values: Vec<_> = $values.collect();
                    let written = column.typed::<$kind>().write_batch(&values, $there, None);
                    written.unwrap();
                    column.close().unwrap();
                };
            }
            let there: Vec<i16> = rows.clone().map(|k| i16::from(k % 3 > 0)).collect();
            let nowhere = vec![0; there.len()];
            let fixed = |bytes: [u8; 2]| FixedLenByteArray::from(ByteArray::from(bytes.to_vec()));
            let odd = rows.clone().filter(|k| k % 3 > 0);
            put!(FloatType, odd.clone().map(|k| k as f32), Some(&there));
            put!(
                ByteArrayType,
                rows.clone().map(|_| ByteArray::from(b"point".to_vec())),
                None
            );
            put!(Int32Type, rows.clone().map(|k| k as i32), None);
            put!(Int64Type, odd.map(|k| k as i64), Some(&there));
            put!(
                FixedLenByteArrayType,
                rows.clone().map(|k| fixed((-(k as i16)).to_be_bytes())),
                None
            );
            put!(
                FixedLenByteArrayType,
                rows.clone()
                    .map(|_| fixed(f16::from_f64(0.25).to_le_bytes())),
                None
            );
            put!(Int32Type, std::iter::empty(), Some(&nowhere));
            group.close().unwrap();
        }
        writer.close().unwrap();
        file
    }

    #[test]
    fn a_parquet_file_is_read_from_anywhere() {
        let file = parquet(200);
        let list = List::open(file.path()).unwrap();
        assert_eq!(list.count(), 400);
        for range in [123..125, 198..203, 399..400, 0..400] {
            let rows = list.read(range.clone()).unwrap();
            for (row, k) in rows.into_iter().zip(range) {
                let mut wanted = vec![
                    ("body", "point".into()),
                    ("max_impacts", Value::Integer(k as i64)),
                    ("omega", Value::Number(-(k as f64) / 10.0)),
                    ("c", Value::Number(0.25)),
                ];
                if k % 3 > 0 {
                    wanted.insert(0, ("f_o", Value::Number(k as f64)));
                    wanted.insert(3, ("e", Value::Number(k as f64 / 1000.0)));
                }
                assert_eq!(row, Ok(wanted));
            }
        }
    }

    #[test]
    fn bad_rows_are_errors_of_their_own_and_empty_cells_nothing() {
        let file = csv("f_o,stop_when_settled\n0.1,\n0.2\n,false\nx,True\n");
        let rows = List::open(file.path()).unwrap().read(0..4).unwrap();
        assert_eq!(rows[0], Ok(vec![("f_o", Value::Number(0.1))]));
        let error = rows[1].clone().unwrap_err().to_string();
        assert!(
            error.contains("(a row with 1 fields)") && error.contains("2 fields"),
            "{error}"
        );
        assert_eq!(rows[2], Ok(vec![("stop_when_settled", Value::Bool(false))]));
        assert_eq!(rows[3].as_ref().unwrap()[0].1, Value::Text("x".to_owned()));
    }

    #[test]
    fn a_list_with_other_columns_is_refused() {
        for (text, wanted) in [
            ("f_o,omgea\n1,2\n", "did you mean omega?"),
            ("f_o,f_o\n1,2\n", "f_o stands over two columns"),
            ("f_o\n", "holds no case"),
        ] {
            let error = List::open(csv(text).path()).unwrap_err().to_string();
            assert!(error.contains(wanted), "{error}");
        }
        let error = List::open(Path::new("/no/such/list.csv")).unwrap_err();
        assert!(matches!(&error, StudyError::Input(words) if words.contains("No such file")));
    }
}
