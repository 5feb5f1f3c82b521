//! Lists of cases are read from any row on, and never completely.
use half::f16;
use parquet::basic::{BrotliLevel, Compression, GzipLevel};
use parquet::data_type::{ByteArray, ByteArrayType, FixedLenByteArray, FixedLenByteArrayType};
use parquet::data_type::{FloatType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use snapload::{CaseError, Value};
use snapload_study::{List, Plan, Study, StudyError};
use std::fs;
use std::io::Write;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// What a row gives, or why it can not be read.
type Row = Result<Vec<(&'static str, Value)>, CaseError>;

/// Some rows of a list.
fn read(list: List, range: Range<u64>) -> Vec<Row> {
    let study = Study::new([], Plan::List(list), false).unwrap();
    let cases = study.cases(range).unwrap();
    (0..cases.count()).map(|k| cases.given(k)).collect()
}

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
    assert_eq!(List::open(file.path()).unwrap().count(), 5000);
    for range in [0..3, 1023..1026, 4999..5000, 2048..2049] {
        let list = List::open(file.path()).unwrap();
        for (row, k) in read(list, range.clone()).into_iter().zip(range) {
            let f_o = format!("0.{k:04}").parse::<f64>().unwrap();
            let expected: Row = Ok(vec![
                ("f_o", Value::Number(f_o)),
                ("e", Value::Integer(1)),
                ("body", Value::Text("rigid".to_owned())),
            ]);
            assert_eq!(row, expected);
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
        required fixed_len_byte_array(2) nu (FLOAT16);
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
    assert_eq!(List::open(file.path()).unwrap().count(), 400);
    for range in [123..125, 198..203, 399..400, 0..400] {
        let rows = read(List::open(file.path()).unwrap(), range.clone());
        for (row, k) in rows.into_iter().zip(range) {
            let mut expected = vec![
                ("body", "point".into()),
                ("max_impacts", Value::Integer(k as i64)),
                ("omega", Value::Number(-(k as f64) / 10.0)),
                ("nu", Value::Number(0.25)),
            ];
            if k % 3 > 0 {
                expected.insert(0, ("f_o", Value::Number(k as f64)));
                expected.insert(3, ("e", Value::Number(k as f64 / 1000.0)));
            }
            assert_eq!(row, Ok(expected));
        }
    }
}

/// Lines are counted as in a text editor: empty lines are no rows, and two bytes may end a line.
#[test]
fn rows_know_their_lines() {
    let file = csv("\u{feff}\"f_o\",body\r\n1,rigid\r\n\r\n2,\"po,\"\"int\"\r\n\n3,rigid");
    let list = List::open(file.path()).unwrap();
    assert_eq!((list.count(), list.keys()), (3, &["f_o", "body"][..]));
    let lines = (0..4).map(|row| list.line(row));
    assert_eq!(lines.collect::<Vec<_>>(), [Some(2), Some(4), Some(6), None]);
}

/// R writes an empty cell of its only column as an empty line; which row a value belongs to is the
/// number of its line. Quotes and empty lines at the end are those of R and of editors.
#[test]
fn an_empty_line_of_one_column_is_an_empty_cell() {
    let given = |f_o: f64| Ok(vec![("f_o", Value::Number(f_o))]);
    for (text, lines) in [
        ("\"f_o\"\n\n0.3\n\n\n0.5\n", [2, 3, 4, 5, 6]),
        ("\u{feff}f_o\r\n\r\n0.3\r\n\r\n\"\"\r\n0.5", [2, 3, 4, 5, 6]),
        ("\n\nf_o\n  \n.3\n\n\n\"0.5\"\n\n\n", [4, 5, 6, 7, 8]),
    ] {
        let list = List::open(csv(text).path()).unwrap();
        assert_eq!(list.count(), 5, "{text:?}");
        let file = csv(text);
        let list = List::open(file.path()).unwrap();
        assert_eq!(
            (0..5).filter_map(|row| list.line(row)).collect::<Vec<_>>(),
            lines
        );
        let end = list.empty_lines_at_end();
        assert_eq!(end, if text.starts_with('\n') { 2 } else { 0 }, "{text:?}");
        let rows = read(list, 0..5);
        let empty = || Ok(Vec::new());
        assert_eq!(rows, [empty(), given(0.3), empty(), empty(), given(0.5)]);
    }
    // From any row on: every third line is empty.
    let line = |k: u32| match k % 3 {
        0 => String::new(),
        _ => format!("0.{k:04}"),
    };
    let lines: Vec<String> = (1..=5000).map(line).collect();
    let file = csv(&format!("f_o\r\n{}\r\n", lines.join("\r\n")));
    for range in [0..3, 1022..1030, 2047..2050, 4998..5000] {
        let rows = read(List::open(file.path()).unwrap(), range.clone());
        for (row, k) in rows.into_iter().zip(range) {
            let expected = match lines[k as usize].parse() {
                Ok(f_o) => given(f_o),
                Err(_) => Ok(Vec::new()),
            };
            assert_eq!(row, expected, "{k}");
        }
    }
}

/// What other programs write instead of a list in CSV is named, or read as what it is.
#[test]
fn files_of_other_kinds_are_known_by_their_contents() {
    let utf_16 = |order: fn(u16) -> [u8; 2]| {
        let units = "\u{feff}f_o,e\n0.5,0.5\n".encode_utf16();
        units.flat_map(order).collect::<Vec<u8>>()
    };
    for bytes in [utf_16(u16::to_le_bytes), utf_16(u16::to_be_bytes)] {
        let file = csv("");
        fs::write(file.path(), bytes).unwrap();
        let error = List::open(file.path()).unwrap_err().to_string();
        assert!(
            error.contains("not a text file in UTF-8; save it as"),
            "{error}"
        );
    }
    let file = csv("");
    fs::copy(counts(&[7], Compression::SNAPPY).path(), file.path()).unwrap();
    let rows = read(List::open(file.path()).unwrap(), 0..1);
    assert_eq!(rows, [Ok(vec![("max_impacts", Value::Integer(7))])]);
}

/// A file with a column of whole numbers without a sign, in some compression.
fn counts(values: &[u64], codec: Compression) -> tempfile::NamedTempFile {
    let columns = "message schema { required int64 max_impacts (INTEGER(64,false)); }";
    let schema = Arc::new(parse_message_type(columns).unwrap());
    let mut file = tempfile::Builder::new();
    let file = file.suffix(".parquet").tempfile().unwrap();
    let properties = WriterProperties::builder().set_compression(codec).build();
    let mut writer = SerializedFileWriter::new(&file, schema, Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    let values: Vec<i64> = values.iter().map(|n| *n as i64).collect();
    column
        .typed::<Int64Type>()
        .write_batch(&values, None, None)
        .unwrap();
    column.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
    file
}

/// A number that no key accepts is an error of its own row only.
#[test]
fn a_count_that_is_too_large_spoils_its_own_row() {
    let file = counts(&[7, u64::MAX, 9], Compression::UNCOMPRESSED);
    let plan = Plan::List(List::open(file.path()).unwrap());
    let study = Study::new([], plan, false).unwrap();
    let cases = study.cases(0..3).unwrap();
    let runs = (0..3).map(|k| cases.case(k).is_ok());
    assert_eq!(runs.collect::<Vec<_>>(), [true, false, true]);
    let error = cases.case(1).unwrap_err().error.to_string();
    assert!(error.contains("max_impacts = 1.8"), "{error}");
}

/// Files of pandas, Spark and R are read, except for one compression, which the message names.
#[test]
fn compressions_are_read_or_named() {
    let level = || GzipLevel::try_new(6).unwrap();
    for codec in [
        Compression::SNAPPY,
        Compression::GZIP(level()),
        Compression::BROTLI(BrotliLevel::default()),
        Compression::LZ4,
        Compression::LZ4_RAW,
    ] {
        let file = counts(&[5; 5000], codec);
        let rows = read(List::open(file.path()).unwrap(), 4999..5000);
        assert_eq!(rows, [Ok(vec![("max_impacts", Value::Integer(5))])]);
    }
    // The codec follows the name of the column, as a number of the format that is stored doubled; 3
    // is LZO.
    let file = counts(&[5], Compression::UNCOMPRESSED);
    let mut bytes = fs::read(file.path()).unwrap();
    let name = b"max_impacts\x15\x00";
    let place = bytes.windows(name.len()).rposition(|some| some == name);
    bytes[place.unwrap() + name.len() - 1] = 6;
    fs::write(file.path(), bytes).unwrap();
    let error = List::open(file.path()).unwrap_err().to_string();
    assert!(
        error.contains(
            "compressed with lzo; allowed: no compression, snappy, gzip, brotli, lz4, zstd"
        ),
        "{error}"
    );
}

#[test]
fn bad_rows_are_errors_of_their_own_and_empty_cells_nothing() {
    let file = csv("f_o,stop_when_settled\n0.1,\n0.2\n,false\nx,True\n");
    let rows = read(List::open(file.path()).unwrap(), 0..4);
    assert_eq!(rows[0], Ok(vec![("f_o", Value::Number(0.1))]));
    let error = rows[1].clone().unwrap_err().to_string();
    assert!(
        error.contains("(a row with 1 field)") && error.contains("2 fields"),
        "{error}"
    );
    assert_eq!(rows[2], Ok(vec![("stop_when_settled", Value::Bool(false))]));
    assert_eq!(rows[3].as_ref().unwrap()[0].1, Value::Text("x".to_owned()));
    // What no double holds is reported as it is written.
    let file = csv("f_o\n1e400\n-inf\n");
    let rows = read(List::open(file.path()).unwrap(), 0..2);
    assert_eq!(rows[0], Ok(vec![("f_o", Value::Text("1e400".to_owned()))]));
    assert_eq!(rows[1], Ok(vec![("f_o", Value::Number(f64::NEG_INFINITY))]));
}

/// The base case has a value for each key, and that is not the value of a row that is not read.
#[test]
fn a_row_that_can_not_be_read_has_no_values() {
    let file = csv("f_o,e\n0.55\n0.6,0.8,0.8\n2e3,0.8\n");
    let plan = Plan::List(List::open(file.path()).unwrap());
    let base = ["f_o", "r"].map(|key| (key.to_owned(), 1.25.into()));
    let study = Study::new(base, plan, false).unwrap();
    let cases = study.cases(0..3).unwrap();
    let values = |row| {
        let keys = cases.case(row).unwrap_err().keys;
        ["f_o", "e", "r"].map(|name| {
            let place = snapload::KEYS.iter().position(|key| key.name == name);
            keys[place.unwrap()].as_ref().and_then(Value::number)
        })
    };
    assert_eq!(values(0), [None, None, Some(1.25)]);
    assert_eq!(values(1), [None, None, Some(1.25)]);
    assert_eq!(values(2), [Some(2e3), Some(0.8), Some(1.25)]);
}

#[test]
fn a_sign_for_a_missing_value_is_refused_with_what_to_write() {
    let file = csv("f_o\nNaN\nNA\nmissing\n0.5x\n2e3\n");
    let study = Study::new([], Plan::List(List::open(file.path()).unwrap()), false).unwrap();
    let cases = study.cases(0..5).unwrap();
    let errors: Vec<String> = (0..5)
        .map(|k| cases.case(k).unwrap_err().error.to_string())
        .collect();
    let hinted = errors
        .iter()
        .map(|error| error.contains("leave the cell empty"));
    assert_eq!(hinted.collect::<Vec<_>>(), [true, true, true, false, false]);
}

#[test]
fn a_list_with_other_columns_is_refused() {
    for (text, expected) in [
        ("\"\",\"f_o\"\n\"1\",0.3\n", "in R with row.names=FALSE"),
        ("f_o,omgea\n1,2\n", "did you mean omega?"),
        ("f_o,f_o\n1,2\n", "two columns are named f_o"),
        ("f_o;e\n1;2\n", "are separated by commas"),
        ("f_o\n", "contains no case"),
    ] {
        let error = List::open(csv(text).path()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let far = format!("f_o,body\n1,rigid\n2,{}\n", "x".repeat(2_000_000));
    for (text, expected) in [
        (
            "f_o,body\n\r\n1,rigid\n2,\"point\n3,rigid\n",
            "line 4 opens a quote",
        ),
        (
            "f_o,body\r\n1,\"ri\"\"gid\"\r\n2,\"point",
            "line 3 opens a quote",
        ),
        (far.as_str(), "line 3 is longer than 1048576 bytes"),
    ] {
        let error = List::open(csv(text).path()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    let error = List::open(folder.path()).unwrap_err().to_string();
    assert!(error.contains("a list must be a file"), "{error}");
    let error = List::open(Path::new("/no/such/list.csv")).unwrap_err();
    assert!(matches!(&error, StudyError::Input(words) if words.contains("No such file")));
}
