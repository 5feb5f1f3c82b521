//! Error responses: a status, the message that the command line would print, and the key to change.
use axum::Json;
use axum::extract::rejection::JsonRejection;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use snapload::CaseError;
use std::fmt::Display;

/// The largest body of a request, in bytes: a case has some twenty values.
pub(crate) const LARGEST_BODY: usize = 64 << 10;

/// Why a request is refused.
#[derive(Debug, Serialize)]
pub(crate) struct Refusal {
    #[serde(skip)]
    status: StatusCode,
    /// The key of the case, or the field of the request, that has to be changed; none if there is
    /// no single one.
    key: Option<String>,
    message: String,
}

impl Refusal {
    /// A refusal with a status and a message.
    pub(crate) fn new(status: StatusCode, message: impl Into<String>) -> Self {
        Self {
            status,
            key: None,
            message: message.into(),
        }
    }

    /// The message.
    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// As JSON, for the last line of a streamed answer.
    pub(crate) fn in_a_line(&self) -> serde_json::Value {
        serde_json::json!({ "key": self.key, "message": self.message })
    }

    /// The same for a field of the request, whose name is put before the message.
    pub(crate) fn of_field(self, field: &str) -> Self {
        Self {
            status: self.status,
            key: Some(field.to_owned()),
            message: format!("{field}: {}", self.message),
        }
    }

    /// A body that this path does not accept.
    pub(crate) fn malformed(error: impl Display) -> Self {
        // The message may repeat the wrong part, and a body can be long.
        let message: String = error.to_string().chars().take(300).collect();
        Self::new(StatusCode::BAD_REQUEST, format!("the request: {message}"))
    }

    /// Values that are not allowed.
    pub(crate) fn values(message: impl Into<String>) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, message)
    }

    /// A path that does not exist.
    pub(crate) fn not_found() -> Self {
        Self::new(StatusCode::NOT_FOUND, "there is nothing at this path")
    }

    /// Work that ended without an answer, which would be an error of the program.
    pub(crate) fn failed(error: impl Display) -> Self {
        let message = format!("the program failed: {error}");
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, message)
    }
}

impl From<CaseError> for Refusal {
    fn from(error: CaseError) -> Self {
        // The page changes values in fields, not on a command line.
        let error = error.off_the_command_line();
        Self {
            key: Some(error.key.clone()),
            ..Self::values(error.to_string())
        }
    }
}

impl From<JsonRejection> for Refusal {
    fn from(rejection: JsonRejection) -> Self {
        match rejection.status() {
            StatusCode::BAD_REQUEST | StatusCode::UNPROCESSABLE_ENTITY => {
                Self::malformed(rejection.body_text())
            }
            status @ StatusCode::PAYLOAD_TOO_LARGE => {
                let most = LARGEST_BODY >> 10;
                Self::new(
                    status,
                    format!(
                        "the request has more than {most} KiB, which no case needs; open a case file in TOML"
                    ),
                )
            }
            status => Self::new(status, rejection.body_text()),
        }
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.status, Json(self)).into_response()
    }
}
