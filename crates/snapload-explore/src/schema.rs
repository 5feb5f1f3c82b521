//! `/api/schema`: the keys, and the cases to start from.
use crate::map::COLUMNS;
use serde_json::{Map, Value as JsonValue, json};
use snapload::analysis::{Certainty, Counter, ThreadResults, no_progress, on_all_threads};
use snapload::{
    Bounds, Case, DefaultValue, KEYS, Key, Kind, Lanes, Outcome, Parameters, Stop, named_cases,
};
use snapload_report::{QUESTIONS, Question, ValueRow};
use std::sync::LazyLock;

/// The first case of the thesis's model on the page.
#[derive(Clone, Debug)]
pub struct Start {
    /// Its code, or the name of its file.
    pub name: String,
    /// Its values.
    pub parameters: Parameters,
}

/// The whole schema.
pub(crate) fn schema(start: &Start) -> JsonValue {
    let cases = named_cases().enumerate().map(|(k, case)| {
        let (values, summary) = (differing(&case.parameters), CASE_SUMMARIES.get(k));
        json!({ "code": case.code, "title": case.origin(), "happens": summary, "values": values })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "keys": KEYS.iter().map(key).collect::<Vec<_>>(),
        "cases": cases.collect::<Vec<_>>(),
        "questions": QUESTIONS.iter().map(question).collect::<Vec<_>>(),
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

/// A description of each built-in case's run, in their order; they are run when a page first asks
/// for it.
static CASE_SUMMARIES: LazyLock<Vec<String>> = LazyLock::new(|| {
    // All of them are legal; if one were not, there would be no descriptions.
    let cases: Result<Vec<Case>, _> = named_cases()
        .map(|case| Case::new(case.parameters))
        .collect();
    let cases = cases.unwrap_or_default();
    let counter = Counter::new("the built-in cases", 0, cases.len() as u64, &no_progress);
    let outcomes = on_all_threads(cases.len(), |numbers| {
        let cases = numbers.map(|k| cases[k].clone());
        Certainty::with_outcomes(Lanes::best(), cases, &counter)
    });
    let outcomes = outcomes.map(ThreadResults::into_vec).unwrap_or_default();
    outcomes.iter().map(case_summary).collect()
});

/// A description of a run in a few words; numbers that depend on rounding are preceded by "about".
fn case_summary((outcome, certainty): &(Outcome, Certainty)) -> String {
    let (t, snaps) = (outcome.end.t, outcome.snaps());
    let (about, past) = match certainty.decides_the_end() {
        true => ("", ""),
        false => ("about ", ", past the horizon"),
    };
    match outcome.end.reason {
        Stop::Settled => format!("settles after {about}{snaps} snaps"),
        Stop::RotationLimit => format!("turns over at t = {about}{t:.1}"),
        Stop::SlidingStart => format!("begins to slide at t = {about}{t:.1}"),
        Stop::EndTime if outcome.rocking > 0.5 * t => format!("rocks on both cables{past}"),
        Stop::EndTime if outcome.sliding > 0.0 => format!("slides on one cable at times{past}"),
        Stop::EndTime => format!("continues to snap, {about}{snaps} times by t = {t:.0}"),
        Stop::ImpactLimit => format!("snaps more than {snaps} times by t = {about}{t:.1}"),
        Stop::Standstill => format!("can not be computed beyond t = {about}{t:.1}"),
        limit => format!("reaches the {} at t = {about}{t:.1}", limit.label()),
    }
}

/// The keys in which a case differs from the standard one.
pub(crate) fn differing(parameters: &Parameters) -> Map<String, JsonValue> {
    let entries = parameters.differing().into_iter();
    entries
        .map(|(key, value)| (key.to_owned(), json!(ValueRow(value))))
        .collect()
}

/// The type of a key and its range.
pub(crate) fn kind(key: &Key) -> JsonValue {
    match key.kind {
        Kind::Number(Bounds {
            low,
            low_included,
            high,
        }) => json!({ "type": "number", "low": low, "low_included": low_included, "high": high }),
        Kind::Count(low, high) => json!({ "type": "count", "low": low, "high": high }),
        Kind::Flag => json!({ "type": "flag" }),
        Kind::Choice(words) => json!({ "type": "choice", "options": words }),
        Kind::PerFreedom(high) => json!({ "type": "per_freedom", "low": 0.0, "high": high }),
        Kind::Pair(_) | Kind::Triple(_) | Kind::Text => json!({ "type": "text" }),
    }
}

/// A question about one case, with its options.
fn question(question: &Question) -> JsonValue {
    let options = question.options.iter().map(|key| {
        json!({
            "name": key.name,
            "unit": key.unit,
            "meaning": key.meaning,
            "kind": kind(key),
            "allowed": key.allowed(),
            "default": key.default.value().map(ValueRow),
        })
    });
    json!({
        "name": question.name,
        "asks": question.asks,
        "options": options.collect::<Vec<_>>(),
    })
}

fn key(key: &Key) -> JsonValue {
    json!({
        "name": key.name,
        "symbol": key.symbol,
        "unit": key.unit,
        "meaning": key.meaning,
        "title": key.title(),
        "group": key.group,
        "kind": kind(key),
        "allowed": key.allowed(),
        "default": Parameters::STANDARD.get(key.name).map(ValueRow),
        "default_in_words": match key.default {
            DefaultValue::Derived(words) => words,
            _ => "",
        },
        // The only key whose default is a formula in other keys.
        "derived": key.name == "inertia",
        "usual": key.usual.map(|[low, high]| json!({ "low": low, "high": high })),
    })
}
