//! `/api/schema`: which keys there are, and the cases to start from.
use crate::request::{object, to_json};
use serde_json::{Value as Json, json};
use snapload::{KEYS, Key, Kind, Parameters, named_cases};

/// The case that the page begins with.
#[derive(Clone, Debug)]
pub struct Start {
    /// Its code, or the name of its file.
    pub name: String,
    /// Its values.
    pub parameters: Parameters,
}

/// All there is to say.
pub(crate) fn schema(start: &Start) -> Json {
    let cases = named_cases().map(|case| {
        let values = object(case.parameters.differing());
        json!({ "code": case.code, "title": case.origin(), "values": values })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "keys": KEYS.iter().map(key).collect::<Vec<_>>(),
        "cases": cases.collect::<Vec<_>>(),
        "start": { "name": start.name, "values": object(start.parameters.differing()) },
    })
}

fn key(key: &Key) -> Json {
    let kind = match key.kind {
        Kind::Number {
            low,
            low_included,
            high,
        } => json!({ "type": "number", "low": low, "low_included": low_included, "high": high }),
        Kind::Count { low, high } => json!({ "type": "count", "low": low, "high": high }),
        Kind::Flag => json!({ "type": "flag" }),
        Kind::Choice(words) => json!({ "type": "choice", "options": words }),
    };
    json!({
        "name": key.name,
        "symbol": key.symbol,
        "unit": key.unit,
        "meaning": key.meaning,
        "group": key.group.name(),
        "kind": kind,
        "allowed": key.allowed(),
        "default": key.get(&Parameters::STANDARD).as_ref().map(to_json),
        "default_in_words": key.derived_default(),
        "usual": key.usual.map(|[low, high]| json!({ "low": low, "high": high })),
    })
}
