//! What makes a number of the report again: a command, and where in its JSON the number stands.

use crate::study::{CriticalRow, NEIGHBOURS, Reading};

/// A number (or a word) of the report, with what makes it again.
#[derive(Clone, Debug)]
pub struct Number {
    /// What stands before it, such as `θ = `.
    pub name: &'static str,
    /// As the report shows it.
    pub shown: String,
    /// The command.
    pub command: String,
    /// The place in the JSON that the command prints, in the language of jq.
    pub key: String,
}

/// The command that prints the run of a built-in case as JSON.
pub(crate) fn run(code: &str, reading: Reading) -> String {
    format!("snapload run --case {code}{} --json -", reading.option())
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

/// Where `snapload run` tells the number of snaps; an impulse passed into a taut cable is none.
pub(crate) const SNAPS: &str = "[.impacts[] | select(.v_n > 0)] | length";

/// A number with so many decimals and a true minus.
pub(crate) fn decimals(value: f64, places: usize) -> String {
    format!("{value:.places$}").replace('-', "−")
}
