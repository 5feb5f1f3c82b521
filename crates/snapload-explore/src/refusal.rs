//! Answers that say no: a status, the words that the command line would print, and the key that is
//! to be changed.
use axum::Json;
use axum::extract::rejection::JsonRejection;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use snapload::CaseError;
use std::fmt::Display;

/// The largest body of a request, in bytes: a case has some twenty values.
pub(crate) const LARGEST_BODY: usize = 64 << 10;

/// Why a request gets no answer.
#[derive(Debug, Serialize)]
pub(crate) struct Refusal {
    #[serde(skip)]
    status: StatusCode,
    /// The key of the case, or the field of the request, that is to be changed; none where no
    /// single one is.
    key: Option<String>,
    message: String,
}

impl Refusal {
    /// With a status and what to say.
    pub(crate) fn new(status: StatusCode, message: impl Into<String>) -> Self {
        Self {
            status,
            key: None,
            message: message.into(),
        }
    }

    /// What it says.
    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// As JSON, for the last line of a streamed answer.
    pub(crate) fn in_a_line(&self) -> serde_json::Value {
        serde_json::json!({ "key": self.key, "message": self.message })
    }

    /// The same about a field of the request, whose name stands before the message.
    pub(crate) fn of_field(self, field: &str) -> Self {
        Self {
            status: self.status,
            key: Some(field.to_owned()),
            message: format!("{field}: {}", self.message),
        }
    }

    /// A body that is not what this path takes.
    pub(crate) fn malformed(error: impl Display) -> Self {
        // What is wrong may be repeated in the message, and a body can be long.
        let message: String = error.to_string().chars().take(300).collect();
        Self::new(StatusCode::BAD_REQUEST, format!("the request: {message}"))
    }

    /// Values that can not be computed with.
    pub(crate) fn values(message: impl Into<String>) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, message)
    }

    /// A path where there is nothing.
    pub(crate) fn nothing_there() -> Self {
        Self::new(StatusCode::NOT_FOUND, "there is nothing at this path")
    }

    /// Work that ended without an answer, which would be a fault of the program.
    pub(crate) fn failed(error: impl Display) -> Self {
        let message = format!("the program failed: {error}");
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, message)
    }
}

impl From<CaseError> for Refusal {
    fn from(error: CaseError) -> Self {
        // What is changed on the page stands in a field.
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
                    format!("more than {most} KiB, which no case needs; open a case file in TOML"),
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
