//! `/api/case`: the values that a case file gives.
use crate::refusal::Refusal;
use crate::schema::differing;
use serde::Deserialize;
use serde_json::{Map, Value as JsonValue};
use snapload::{CASE, Entries, Parameters};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    /// What errors call it.
    name: String,
    text: String,
}

/// The keys in which it differs from the standard case. Whether they can be run is asked with the
/// run.
pub(crate) fn answer(request: &Request) -> Result<Map<String, JsonValue>, Refusal> {
    let entries = Entries::parse(&CASE, &request.name, &request.text)?;
    let parameters = Parameters::from_entries(entries.values("case"));
    let parameters = parameters.map_err(|error| entries.locate(error))?;
    Ok(differing(&parameters))
}
