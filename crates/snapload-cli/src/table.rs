//! `--out` for tables: Parquet, or CSV if the name ends in .csv.
use crate::failure::Failure;
use crate::json::{folder_for, refuse_directory};
use crate::stage::{Room, Stage};
use snapload_report::tables::in_digits;
use snapload_study::{Axis, Values, write_table};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The place of a table.
pub(crate) struct TableFile(Option<(Room, PathBuf)>);

impl TableFile {
    /// Opens it, so that an error is known before anything is computed.
    pub(crate) fn open(stage: &mut Stage, path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else {
            return Ok(Self(None));
        };
        refuse_directory(path)?;
        let ending = path.extension().and_then(|ending| ending.to_str());
        if !matches!(ending, Some("parquet" | "csv")) {
            let message = format!(
                "--out {}: write a name that ends in .parquet or .csv",
                path.display()
            );
            return Err(Failure::BadInput(message));
        }
        Ok(Self(Some((
            stage.open(&folder_for(path))?,
            path.to_owned(),
        ))))
    }

    /// Stages the table.
    pub(crate) fn stage(
        self,
        stage: &mut Stage,
        columns: &[(&'static str, Values)],
    ) -> Result<(), Failure> {
        let Some((room, path)) = self.0 else {
            return Ok(());
        };
        let plain = path.extension().is_some_and(|ending| ending == "csv");
        stage.write(room, path, |out| match plain {
            true => write_csv(columns, out),
            false => write_table(columns, out),
        })
    }
}

fn write_csv(columns: &[(&'static str, Values)], out: &mut dyn Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(columns.iter().map(|(name, _)| *name))?;
    let cells: Vec<Vec<String>> = columns.iter().map(|(_, values)| texts(values)).collect();
    for row in 0..cells.first().map_or(0, Vec::len) {
        csv.write_record(cells.iter().map(|column| &column[row]))?;
    }
    csv.flush()
}

fn texts(values: &Values) -> Vec<String> {
    fn all<T: ToString>(list: &[Option<T>]) -> Vec<String> {
        let text = |value: &Option<T>| value.as_ref().map(T::to_string).unwrap_or_default();
        list.iter().map(text).collect()
    }
    match values {
        Values::Numbers(list) => {
            let text = |value: &Option<f64>| value.map(in_digits).unwrap_or_default();
            list.iter().map(text).collect()
        }
        Values::Counts(list) => all(list),
        Values::Flags(list) => all(list),
        Values::Words(list) => all(list),
    }
}

/// A column of numbers.
pub(crate) fn numbers(values: impl IntoIterator<Item = f64>) -> Values {
    Values::Numbers(values.into_iter().map(Some).collect())
}

/// A column of names, some of which may be missing.
pub(crate) fn names(values: impl IntoIterator<Item = Option<&'static str>>) -> Values {
    let word = |name: Option<&'static str>| name.map(Into::into);
    Values::Words(values.into_iter().map(word).collect())
}

/// A key and its values, from `KEY=first:last:n`.
pub(crate) fn axis(option: &str, text: &str) -> Result<(&'static str, Vec<f64>), Failure> {
    let Some((key, range)) = text.split_once('=') else {
        return Err(Failure::BadInput(format!(
            "{option} {text:?}: no values; write {option} KEY=first:last:n, such as {option} y=0.02:0.72:36"
        )));
    };
    let axis = Axis::written(key.trim(), range.trim())
        .map_err(|error| Failure::from(error).with_prefix(option))?;
    if axis.count() > MOST_VALUES {
        let message = format!("{option} {text:?}: n must be at most {MOST_VALUES}");
        return Err(Failure::BadInput(message));
    }
    let value = |k| axis.value(k).number().unwrap_or(f64::NAN);
    Ok((axis.key(), (0..axis.count()).map(value).collect()))
}

/// The most values of one key.
const MOST_VALUES: u64 = 1_000_000;
