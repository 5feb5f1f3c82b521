//! The keys of a case as a file.

use crate::entries::{Entries, Value};
use crate::schema::{Need, TABLES};
use std::fmt::Write as _;

impl Entries {
    /// Required keys that are not there: `body.width`. Of waves none are asked for where there are none.
    pub fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        for table in TABLES {
            let count = match (table.many, table.name) {
                (true, _) => self.lines(),
                (false, "wave" | "sea") if !self.has(table.name) => 0,
                _ => 1,
            };
            for index in 0..count {
                let fields = self.table(table.name, index);
                let required = table.keys.iter().filter(|key| key.need == Need::Required);
                missing.extend(
                    required
                        .filter(|key| self.given(table.name, index, key.name).is_none())
                        .map(|key| fields.path(key.name)),
                );
            }
        }
        missing
    }

    /// A case file with these keys, in the order of the schema.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        for table in TABLES.iter().filter(|table| self.has(table.name)) {
            let count = if table.many { self.lines() } else { 1 };
            for index in 0..count {
                let header = if table.many {
                    format!("[[{}]]", table.name)
                } else {
                    format!("[{}]", table.name)
                };
                let gap = if text.is_empty() { "" } else { "\n" };
                let _ = writeln!(text, "{gap}{header}");
                for key in table.keys {
                    if let Some(value) = self.given(table.name, index, key.name) {
                        let _ = writeln!(text, "{} = {}", key.name, toml(value));
                    }
                }
            }
        }
        text
    }
}

fn toml(value: &Value) -> String {
    match value {
        Value::Number(number) => number_words(*number),
        Value::Pair([x, z]) => format!("[{}, {}]", number_words(*x), number_words(*z)),
        // Words are those of the schema, none of which has a quote in it.
        Value::Word(word) => format!("\"{word}\""),
    }
}

/// The shortest digits that read as the same number; no integer beyond those of TOML.
fn number_words(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < 1e15 {
        format!("{}", number + 0.0)
    } else {
        format!("{number:?}")
    }
}
