//! `/api/case`: the kind of a case file, and its values.
use crate::refusal::Refusal;
use crate::schema::differing;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as JsonValue};
use snapload::{CASE, Entries, Parameters};
use snapload_structure::is_structure;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    /// Its name in errors.
    name: String,
    text: String,
}

#[derive(Serialize)]
pub(crate) struct Answer {
    /// Whether it is the case of a structure, which has a page of its own.
    structure: bool,
    /// The keys in which it differs from the standard case. Whether they can be run is checked with
    /// the run.
    values: Map<String, JsonValue>,
}

/// The kind and the values of a case file.
pub(crate) fn answer(request: &Request) -> Result<Answer, Refusal> {
    if is_structure(&request.text) {
        return Ok(Answer {
            structure: true,
            values: Map::new(),
        });
    }
    let entries = Entries::parse(&CASE, &request.name, &request.text)?;
    let parameters = Parameters::from_entries(entries.values("case"));
    let parameters = parameters.map_err(|error| entries.locate(error))?;
    Ok(Answer {
        structure: false,
        values: differing(&parameters),
    })
}
