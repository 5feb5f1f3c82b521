//! Tables as CSV: the names of the columns, and a line a row.

use crate::StudyError;
use crate::parquet_file::Values;
use crate::study_file::Columns;
use csv::Writer;
use std::io::{self, Write};
use std::path::Path;

/// A number with the fewest digits that are read back to the same double, and with a fraction also
/// where it is whole, for a column of CSV: a reader that judges its type by the first rows would
/// otherwise take it for one of whole numbers.
pub fn in_digits_with_fraction(number: f64) -> String {
    format!("{number:?}")
}

/// Writes columns of equal lengths, each with its name.
///
/// # Errors
/// Those of `out`.
pub fn write_csv(columns: &[(&'static str, Values)], out: &mut dyn Write) -> io::Result<()> {
    let (names, values): (Vec<&str>, Vec<&Values>) =
        columns.iter().map(|(name, values)| (*name, values)).unzip();
    let mut csv = Writer::from_writer(out);
    csv.write_record(names)?;
    write_rows(&values, &mut csv)?;
    csv.flush()
}

/// Writes the rows of a study's file, all of its columns, some tens of thousands of rows at a time.
///
/// # Errors
/// [`StudyError::Damaged`] if the file can not be read; the inner errors are those of `out`.
pub fn write_study_csv(file: &Path, out: &mut dyn Write) -> Result<io::Result<()>, StudyError> {
    let mut csv = Writer::from_writer(out);
    let mut written = csv.write_record(Columns::names());
    Columns::all(file)?.each(|columns| {
        if written.is_ok() {
            let columns: Vec<&Values> = columns.iter().collect();
            written = write_rows(&columns, &mut csv);
        }
    })?;
    Ok(written.map_err(Into::into).and_then(|()| csv.flush()))
}

fn write_rows(columns: &[&Values], csv: &mut Writer<&mut dyn Write>) -> csv::Result<()> {
    for row in 0..columns.first().map_or(0, |values| values.len()) {
        for values in columns {
            csv.write_field(cell(values, row))?;
        }
        csv.write_record(None::<&str>)?;
    }
    Ok(())
}

/// A value, or nothing where it is missing.
fn cell(values: &Values, row: usize) -> String {
    fn text<T: ToString>(value: Option<&T>) -> String {
        value.map(T::to_string).unwrap_or_default()
    }
    match values {
        Values::Numbers(list) => list[row].map(in_digits_with_fraction).unwrap_or_default(),
        Values::Counts(list) => text(list[row].as_ref()),
        Values::Flags(list) => text(list[row].as_ref()),
        Values::Words(list) => text(list[row].as_ref()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_read_back_and_empty_where_nothing_is() -> Result<(), Box<dyn std::error::Error>> {
        // The numbers are of the kinds that are easily shortened: 0.1 + 0.2 differs from 0.3 in the
        // last bit, and 5e-324 is the least double.
        let numbers = [0.1 + 0.2, 1.0, -0.0, 1e300, 5e-324];
        let all = numbers.map(Some).into_iter().chain([None]);
        let words = ["a,b", "two\nlines", "say \"no\"", "", "x", "y"].map(|word| Some(word.into()));
        let columns = [
            ("number", Values::Numbers(all.collect())),
            ("count", Values::Counts(vec![Some(i64::MAX); 6])),
            ("flag", Values::Flags([None, Some(true)].repeat(3))),
            ("word", Values::Words(words.to_vec())),
        ];
        let mut bytes = Vec::new();
        write_csv(&columns, &mut bytes)?;
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        assert_eq!(reader.headers()?, vec!["number", "count", "flag", "word"]);
        let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>()?;
        for (row, number) in rows.iter().zip(numbers) {
            assert!(row[0].contains(['.', 'e']), "{}", &row[0]);
            assert_eq!(row[0].parse::<f64>()?.to_bits(), number.to_bits());
        }
        assert_eq!(&rows[5][0], "");
        assert_eq!((&rows[1][1], &rows[1][2]), ("9223372036854775807", "true"));
        assert_eq!((&rows[0][2], &rows[1][3]), ("", "two\nlines"));
        assert_eq!((&rows[0][3], &rows[2][3]), ("a,b", "say \"no\""));
        Ok(())
    }
}
