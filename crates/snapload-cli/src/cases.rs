//! `snapload cases`: the built-in cases.
use crate::failure::{Failure, print};
use snapload::{Value, named_cases};
use std::fmt::Write;

/// Keys in which the built-in cases differ.
const KEYS_SHOWN: [&str; 7] = ["r", "e", "a", "b", "f_o", "nu", "omega"];

/// Lists them.
pub(crate) fn run() -> Result<(), Failure> {
    let mut text = format!("{:<16}", "CODE");
    for key in KEYS_SHOWN {
        let _ = write!(text, "  {key:<5}");
    }
    text.push_str("  SERIES\n");
    for case in named_cases() {
        let _ = write!(text, "{:<16}", case.code);
        for key in KEYS_SHOWN {
            let value = case
                .parameters
                .get(key)
                .map(|value: Value| value.to_string());
            let _ = write!(text, "  {:<5}", value.unwrap_or_default());
        }
        let _ = writeln!(text, "  {}", case.origin());
    }
    text.push_str(
        "\nAll start at rest at x = 0, y = 0.1, theta = 0. The examples have stop_when_settled = false.\nRun one with: snapload run --case CODE\n",
    );
    print(&text)
}
