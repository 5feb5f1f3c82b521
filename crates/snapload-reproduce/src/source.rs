//! What makes a number of the report again: a command, and where in its JSON the number stands.

use crate::study::{CriticalRow, NEIGHBOURS, Reading};

/// A number (or a word) of the report, with what makes it again.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    /// As the report shows it.
    pub(crate) shown: String,
    /// In full precision, as the tables beside the report have it.
    pub(crate) exact: String,
    /// The command.
    pub(crate) command: String,
    /// The place in the JSON that the command prints, in the language of jq.
    pub(crate) key: String,
}

impl Number {
    /// A number, shown with so many decimals.
    pub(crate) fn new(value: f64, places: usize, command: &str, key: impl Into<String>) -> Self {
        Self {
            shown: decimals(value, places),
            ..Self::word(value.to_string(), command, key)
        }
    }

    /// A decimal as words, shown with so many decimals.
    pub(crate) fn decimal(text: &str, places: usize, command: &str, key: &str) -> Self {
        Self {
            shown: text
                .parse()
                .map_or(text.to_owned(), |value| decimals(value, places)),
            ..Self::word(text, command, key)
        }
    }

    /// A word, or a whole number.
    pub(crate) fn word(text: impl ToString, command: &str, key: impl Into<String>) -> Self {
        Self {
            shown: text.to_string(),
            exact: text.to_string(),
            command: command.to_owned(),
            key: key.into(),
        }
    }

    /// `yes` or `no`.
    pub(crate) fn answer(yes: bool, command: &str, key: impl Into<String>) -> Self {
        Self {
            exact: yes.to_string(),
            ..Self::word(if yes { "yes" } else { "no" }, command, key)
        }
    }
}

/// The command that prints the run of a built-in case as JSON.
pub(crate) fn run(code: &str, reading: Reading) -> String {
    format!("snapload run --case {code}{} --json -", reading.option())
}

/// The command that proves it.
pub(crate) fn proof(code: &str, reading: Reading) -> String {
    format!(
        "snapload certify --case {code}{} --json -",
        reading.option()
    )
}

/// The command that prints the critical force of a row of Table 6.2 as JSON.
pub(crate) fn critical(row: &CriticalRow, reading: Reading) -> String {
    format!("{} --json -", scan(row, reading))
}

/// The command that prints how many of its neighbours exceed.
pub(crate) fn probability(row: &CriticalRow, reading: Reading) -> String {
    let (scan, max) = (scan(row, reading), row.looked_up_to());
    format!("{scan} --max {max} --ensemble {NEIGHBOURS} --json -")
}

fn scan(row: &CriticalRow, reading: Reading) -> String {
    let ([a, b], r) = (row.size, row.r);
    format!(
        "snapload critical --set r={r} --set a={a} --set b={b}{}",
        reading.option()
    )
}

/// The command that makes claims, tables and figures.
pub(crate) const REPORT: &str = "snapload reproduce --out reproduction";

/// A number with so many decimals and a true minus.
pub(crate) fn decimals(value: f64, places: usize) -> String {
    format!("{value:.places$}").replace('-', "−")
}
