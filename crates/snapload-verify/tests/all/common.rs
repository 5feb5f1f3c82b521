//! The oracle's files, which lie beside the library, as cases.

use serde_json::Value;

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
