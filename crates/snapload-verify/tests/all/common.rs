//! The oracle's files, which lie beside the library, as cases.

use serde_json::Value;
use snapload::{Precise, Real};

pub fn oracle(file: &str) -> Vec<Value> {
    let path = format!(
        "{}/../snapload/tests/oracle/{file}",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(&path).expect(&path);
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    whole["cases"].as_array().expect("cases").clone()
}

/// A decimal string or a number of the oracle.
pub fn number(value: &Value) -> f64 {
    match value {
        Value::String(text) => text.parse().expect("a decimal number"),
        other => other.as_f64().expect("a number"),
    }
}

/// The keys of a case of the oracle's files.
pub fn keys_of_oracle(reference: &Value) -> impl Iterator<Item = (&'static str, snapload::Value)> {
    let keys = [
        ("r", "r"),
        ("e", "e"),
        ("a", "a"),
        ("b", "b"),
        ("f_o", "f0"),
        ("nu", "nu"),
        ("omega", "Om"),
    ];
    keys.into_iter().filter_map(|(ours, theirs)| {
        let value = reference["params"].get(theirs)?;
        Some((ours, snapload::Value::Number(number(value))))
    })
}

/// A decimal, read exactly: digits over a power of ten.
pub fn exact<const WORDS: usize>(text: &str) -> Precise<WORDS> {
    let (sign, digits) = text
        .strip_prefix('-')
        .map_or((1.0, text), |rest| (-1.0, rest));
    let (digits, power) = digits.split_once('e').unwrap_or((digits, "0"));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mut value = Precise::ZERO;
    for digit in whole.chars().chain(fraction.chars()) {
        value = value * 10.0 + f64::from(digit.to_digit(10).expect("a digit"));
    }
    let power = power.parse::<i32>().expect("a power") - fraction.len() as i32;
    for _ in 0..power.abs() {
        value = if power < 0 {
            value / 10.0
        } else {
            value * 10.0
        };
    }
    value * sign
}
