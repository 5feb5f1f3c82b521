//! The source of a number of the report: a command, and the number's place in its JSON.

use crate::critical_row::{CriticalRow, NEIGHBOURS};
use crate::study::Reading;

/// The prefix of a number that is past the horizon of its run.
pub(crate) const PAST_HORIZON_MARK: &str = "~";

/// A number (or a word) of the report, with its source.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    /// The text that the report shows.
    pub(crate) shown: String,
    /// The value in full precision, for the tables beside the report.
    pub(crate) exact: String,
    /// The command.
    pub(crate) command: String,
    /// The place in the command's JSON, as a jq expression.
    pub(crate) key: String,
}

impl Number {
    /// A number, shown with `places` decimals.
    pub(crate) fn new(value: f64, places: usize, command: &str, key: impl Into<String>) -> Self {
        Self {
            shown: decimals(value, places),
            ..Self::word(value.to_string(), command, key)
        }
    }

    /// A number given as a decimal text, shown with `places` decimals.
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

    /// The number marked as one that depends on rounding.
    pub(crate) fn mark_past_horizon(mut self) -> Self {
        self.shown.insert_str(0, PAST_HORIZON_MARK);
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

/// The command that proves the end of its run under one amplitude.
pub(crate) fn amplitude(row: &CriticalRow, f_o: f64) -> String {
    let scan = scan(row, Reading::Chapter);
    let set = scan.trim_start_matches("snapload critical");
    format!("snapload certify{set} --set f_o={f_o} --json -")
}

/// The command that prints the number of its neighbours that exceed.
pub(crate) fn probability(row: &CriticalRow) -> String {
    let scan = scan(row, Reading::Chapter);
    format!("{scan} --ensemble {NEIGHBOURS} --json -")
}

/// The command that scans for the critical force of a row.
pub(crate) fn scan(row: &CriticalRow, reading: Reading) -> String {
    let ([a, b], r) = (row.size, row.r);
    format!(
        "snapload critical --set r={r} --set a={a} --set b={b}{}",
        reading.option()
    )
}

/// The command that makes claims, tables and figures, in whatever directory.
pub(crate) const REPORT: &str = "snapload reproduce";

/// A number with `places` decimals and a true minus sign.
pub(crate) fn decimals(value: f64, places: usize) -> String {
    format!("{value:.places$}").replace('-', "−")
}
