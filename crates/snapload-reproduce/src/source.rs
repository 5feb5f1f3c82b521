//! What makes a number of the report again: a command, and where in its JSON the number stands.

use crate::critical_row::{CriticalRow, NEIGHBOURS};
use crate::study::Reading;

/// What stands before a number that lies past the horizon of its run.
pub(crate) const DOUBTFUL: &str = "~";

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

    /// Marked as one that rounding decides.
    pub(crate) fn doubtful(mut self) -> Self {
        self.shown.insert_str(0, DOUBTFUL);
        self
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

/// The command that proves how its run under one amplitude ends.
pub(crate) fn amplitude(row: &CriticalRow, f_o: f64) -> String {
    let scan = scan(row, Reading::Chapter);
    let set = scan.trim_start_matches("snapload critical");
    format!("snapload certify{set} --set f_o={f_o} --json -")
}

/// The command that prints how many of its neighbours exceed.
pub(crate) fn probability(row: &CriticalRow) -> String {
    let scan = scan(row, Reading::Chapter);
    format!("{scan} --ensemble {NEIGHBOURS} --json -")
}

/// The command that looks for the critical force of a row.
pub(crate) fn scan(row: &CriticalRow, reading: Reading) -> String {
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
