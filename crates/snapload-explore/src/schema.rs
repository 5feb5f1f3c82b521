//! `/api/schema`: which keys there are, and the cases to start from.
use crate::map::COLUMNS;
use serde_json::{Map, Value as JsonValue, json};
use snapload::analysis::Certainty;
use snapload::{
    Bounds, Case, DefaultValue, KEYS, Key, Kind, Outcome, Parameters, Stop, named_cases,
};
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
        let happens = Case::new(case.parameters).map(|case| what_happens(&case));
        json!({ "code": case.code, "title": case.origin(), "happens": happens.ok(), "values": values })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "keys": KEYS.iter().map(key).collect::<Vec<_>>(),
        "cases": cases.collect::<Vec<_>>(),
        "stops": Stop::ALL.map(Stop::name),
        "map": COLUMNS.iter().map(|column| json!({
            "name": column.name,
            "unit": column.unit,
            "meaning": column.meaning,
            "kind": if column.is_number() { "number" } else { "word" },
        })).collect::<Vec<_>>(),
        "start": { "name": start.name, "values": differing(&start.parameters) },
    })
}

/// What happens in the run of a case, in a few words; what rounding may decide is said with "about".
fn what_happens(case: &Case) -> String {
    let outcome = Outcome::of(case);
    let (t, snaps) = (outcome.end.t, outcome.snaps());
    let about = match Certainty::of(case).decides_the_end() {
        true => "",
        false => "about ",
    };
    match outcome.end.reason {
        Stop::Settled => format!("settles after {about}{snaps} snaps"),
        Stop::RotationLimit => format!("turns over at t = {about}{t:.1}"),
        Stop::UpperBound => format!("passes the anchors at t = {about}{t:.1}"),
        Stop::SlidingStart => format!("begins to slide at t = {about}{t:.1}"),
        Stop::EndTime if outcome.rocking > 0.5 * t => "rocks on with both cables taut".to_owned(),
        Stop::EndTime if outcome.sliding > 0.0 => "slides on one cable, time and again".to_owned(),
        Stop::EndTime => format!("goes on snapping, {about}{snaps} times by t = {t:.0}"),
        Stop::ImpactLimit => format!("snaps more than {snaps} times by t = {about}{t:.1}"),
    }
}

/// The keys in which a case differs from the standard one.
pub(crate) fn differing(parameters: &Parameters) -> Map<String, JsonValue> {
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
