//! `/api/schema`: which keys there are, and the cases to start from.
use crate::map::COLUMNS;
use serde_json::{Map, Value as JsonValue, json};
use snapload::{Bounds, DefaultValue, KEYS, Key, Kind, Parameters, Stop, named_cases};
use snapload_report::ValueRow;

/// The case that the page begins with.
#[derive(Clone, Debug)]
pub struct Start {
    /// Its code, or the name of its file.
    pub name: String,
    /// Its values.
    pub parameters: Parameters,
}

/// All there is to say.
pub(crate) fn schema(start: &Start) -> JsonValue {
    let cases = named_cases().map(|case| {
        let values = differing(&case.parameters);
        json!({ "code": case.code, "title": case.origin(), "values": values })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "keys": KEYS.iter().map(key).collect::<Vec<_>>(),
        "cases": cases.collect::<Vec<_>>(),
        "stops": Stop::ALL.map(Stop::name),
        "map": COLUMNS.each_ref().map(|column| {
            json!({ "name": column.name, "unit": column.unit, "meaning": column.meaning })
        }),
        "start": { "name": start.name, "values": differing(&start.parameters) },
    })
}

/// The keys in which a case differs from the standard one.
fn differing(parameters: &Parameters) -> Map<String, JsonValue> {
    let entries = parameters.differing().into_iter();
    entries
        .map(|(key, value)| (key.to_owned(), json!(ValueRow(value))))
        .collect()
}

fn key(key: &Key) -> JsonValue {
    let kind = match key.kind {
        Kind::Number(Bounds {
            low,
            low_included,
            high,
        }) => json!({ "type": "number", "low": low, "low_included": low_included, "high": high }),
        Kind::Count(low, high) => json!({ "type": "count", "low": low, "high": high }),
        Kind::Flag => json!({ "type": "flag" }),
        Kind::Choice(words) => json!({ "type": "choice", "options": words }),
        Kind::Pair(_) | Kind::Text => json!({ "type": "text" }),
    };
    json!({
        "name": key.name,
        "symbol": key.symbol,
        "unit": key.unit,
        "meaning": key.meaning,
        "title": key.title(),
        "group": key.group,
        "kind": kind,
        "allowed": key.allowed(),
        "default": Parameters::STANDARD.get(key.name).map(ValueRow),
        "default_in_words": match key.default {
            DefaultValue::Derived(words) => words,
            _ => "",
        },
        // The one key whose default is a formula in other keys.
        "derived": key.name == "inertia",
        "usual": key.usual.map(|[low, high]| json!({ "low": low, "high": high })),
    })
}
