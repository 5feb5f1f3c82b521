//! The keys of a structure, and the values of a case.
use super::opened::{File, Opened};
use crate::refusal::Refusal;
use crate::schema::kind;
use serde_json::{Map, Value as JsonValue, json};
use snapload::{DefaultValue, Heading};
use snapload_report::ValueRow;
use snapload_structure::STRUCTURE;

/// The keys, and the case with which the program was started, if it is a structure's.
pub(crate) fn schema(start: Option<&Opened>) -> JsonValue {
    let tables = STRUCTURE.tables.iter().map(|table| {
        let keys = table.keys.iter().map(|key| {
            json!({
                "name": key.name,
                "symbol": key.symbol,
                "unit": key.unit,
                "meaning": key.meaning,
                "title": key.title(),
                "kind": kind(key),
                "default": key.default.value().map(ValueRow),
                "default_in_words": match key.default {
                    DefaultValue::Derived(words) => words,
                    _ => "",
                },
                "usual": key.usual.map(|[low, high]| json!({ "low": low, "high": high })),
            })
        });
        json!({
            "name": table.name,
            "meaning": table.meaning,
            "many": table.heading == Heading::Many,
            "keys": keys.collect::<Vec<_>>(),
        })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "tables": tables.collect::<Vec<_>>(),
        "start": start.map(case),
    })
}

/// The values of a file that was opened on the page.
pub(crate) fn opened(file: &File) -> Result<JsonValue, Refusal> {
    let opened = file.read()?;
    opened.structure()?;
    Ok(case(&opened))
}

/// A case: its name and checksum, its waves and lines, and its values, by path.
fn case(opened: &Opened) -> JsonValue {
    let mut given = Map::new();
    for table in STRUCTURE.tables {
        for index in 0..opened.entries.count(table.name) {
            let fields = opened.entries.table(table.name, index);
            for key in table.keys {
                if let Some(value) = fields.given(key.name) {
                    given.insert(fields.path(key.name), json!(ValueRow(value.clone())));
                }
            }
        }
    }
    json!({
        "name": opened.name,
        "checksum": opened.checksum(),
        "water": opened.water(),
        "lines": opened.entries.count("line"),
        "floats": opened.entries.count("float") > 0,
        "given": given,
    })
}
