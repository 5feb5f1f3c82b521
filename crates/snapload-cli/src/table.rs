//! Tables: their columns, and the values of a key from `KEY=first:last:n`.
use crate::failure::Failure;
use snapload_study::{Axis, Values};

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
