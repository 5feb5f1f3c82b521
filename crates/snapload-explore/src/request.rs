//! Reads and checks requests.
use crate::refusal::Refusal;
use axum::Json;
use axum::extract::{FromRequest, Request};
use axum::http::StatusCode;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value as JsonValue;
use snapload::{Case, CaseError, Key, Parameters, Value, key_named};
use snapload_report::Question;
use std::time::Duration;

/// How long a body may take to arrive.
const BODY_WITHIN: Duration = Duration::from_secs(10);

/// The values that a request gives, by key.
pub(crate) type Values = serde_json::Map<String, JsonValue>;

/// A request about a case and nothing else.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OfCase {
    #[serde(default)]
    pub(crate) values: Values,
}

/// The body of a request: an object of JSON.
pub(crate) struct Body<T>(pub(crate) T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequest<S> for Body<T> {
    type Rejection = Refusal;

    async fn from_request(request: Request, state: &S) -> Result<Self, Refusal> {
        // Read as an object first: serde would accept a list as the fields in their order.
        let body = Json::<Values>::from_request(request, state);
        let body = tokio::time::timeout(BODY_WITHIN, body).await.map_err(|_| {
            let message = "the request did not arrive in time";
            Refusal::new(StatusCode::REQUEST_TIMEOUT, message)
        })?;
        let body = serde_json::from_value(JsonValue::Object(body?.0));
        body.map(Self).map_err(Refusal::malformed)
    }
}

/// Keys and values, each of them legal by itself; a key that is `null` is left out.
pub(crate) fn entries(values: Values) -> Result<Vec<(&'static str, Value)>, CaseError> {
    checked(values, key_named)
}

/// The same for the options of a question.
pub(crate) fn options(
    question: &Question,
    values: Values,
) -> Result<Vec<(&'static str, Value)>, CaseError> {
    checked(values, |name| question.option(name))
}

fn checked(
    values: Values,
    key_named: impl Fn(&str) -> Result<&'static Key, CaseError>,
) -> Result<Vec<(&'static str, Value)>, CaseError> {
    let mut entries = Vec::new();
    for (name, json) in values {
        let key = key_named(&name);
        match value(json) {
            Ok(Some(value)) => {
                let key = key.map_err(|error| error.given(&value))?;
                key.check(key.name, &value)?;
                entries.push((key.name, value));
            }
            Ok(None) => _ = key?,
            Err(shown) => return Err(key?.refuse(&name, shown)),
        }
    }
    Ok(entries)
}

/// The case with given values.
pub(crate) fn case(values: Values) -> Result<Case, CaseError> {
    Case::new(Parameters::from_entries(entries(values)?)?)
}

/// A value of JSON, none for `null`; as an error, what it is instead, in words.
fn value(json: JsonValue) -> Result<Option<Value>, &'static str> {
    Ok(Some(match json {
        JsonValue::Null => return Ok(None),
        JsonValue::Bool(flag) => Value::Bool(flag),
        JsonValue::String(text) => Value::Text(text),
        JsonValue::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Value::Integer(whole),
            (None, Some(number)) => Value::Number(number),
            (None, None) => return Err("(a number out of range)"),
        },
        JsonValue::Array(_) => return Err("(a list)"),
        JsonValue::Object(_) => return Err("(a table)"),
    }))
}
