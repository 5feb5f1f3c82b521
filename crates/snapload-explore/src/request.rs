//! What a request says, checked.
use crate::refusal::Refusal;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use snapload::{Case, CaseError, Parameters, Value, check_entry, key_named};

/// The values that a request gives, by key.
pub(crate) type Values = serde_json::Map<String, Json>;

/// The body of a request.
pub(crate) fn read<T: DeserializeOwned>(body: &[u8]) -> Result<T, Refusal> {
    // An object first: a list would be taken for the fields in their order.
    let object: Values = serde_json::from_slice(body).map_err(Refusal::malformed)?;
    serde_json::from_value(Json::Object(object)).map_err(Refusal::malformed)
}

/// Keys and values, each of them legal by itself; `null` is a key left out.
pub(crate) fn entries(values: Values) -> Result<Vec<(&'static str, Value)>, CaseError> {
    let mut entries = Vec::new();
    for (name, json) in values {
        let Some(value) = value(&name, json)? else {
            key_named(&name)?;
            continue;
        };
        entries.push((check_entry(&name, &value)?.name, value));
    }
    Ok(entries)
}

/// The case of some values.
pub(crate) fn case(values: Values) -> Result<Case, CaseError> {
    Case::new(Parameters::from_entries(entries(values)?)?)
}

fn value(name: &str, json: Json) -> Result<Option<Value>, CaseError> {
    let what = match json {
        Json::Null => return Ok(None),
        Json::Bool(flag) => return Ok(Some(Value::Bool(flag))),
        Json::String(text) => return Ok(Some(Value::Text(text))),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => return Ok(Some(Value::Integer(whole))),
            (None, Some(number)) => return Ok(Some(Value::Number(number))),
            (None, None) => "(a number beyond all bounds)",
        },
        Json::Array(_) => "(a list)",
        Json::Object(_) => "(a table)",
    };
    Err(key_named(name)?.refuse_text(what))
}

/// A value as JSON.
pub(crate) fn to_json(value: &Value) -> Json {
    match value {
        Value::Number(number) => (*number).into(),
        Value::Integer(number) => (*number).into(),
        Value::Bool(flag) => (*flag).into(),
        Value::Text(text) => text.as_str().into(),
    }
}

/// Keys and values as JSON.
pub(crate) fn object(entries: Vec<(&'static str, Value)>) -> Json {
    let pairs = entries.iter().map(|(key, value)| (*key, to_json(value)));
    pairs.map(|(key, value)| (key.to_owned(), value)).collect()
}
