//! Answers that say no, in the words that the command line would print.
use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde_json::json;
use snapload::CaseError;
use std::fmt::Display;

/// Why a request gets no answer.
#[derive(Debug)]
pub(crate) struct Refusal {
    status: StatusCode,
    words: String,
}

impl Refusal {
    /// With a status and what to say.
    pub(crate) fn new(status: StatusCode, words: impl Into<String>) -> Self {
        Self {
            status,
            words: words.into(),
        }
    }

    /// What it says.
    pub(crate) fn words(self) -> String {
        self.words
    }

    /// A body that is not what this path takes.
    pub(crate) fn malformed(error: impl Display) -> Self {
        // What is wrong may be repeated in the words, and a body can be long.
        let words: String = error.to_string().chars().take(300).collect();
        Self::new(StatusCode::BAD_REQUEST, format!("the request: {words}"))
    }

    /// Values that can not be computed with.
    pub(crate) fn values(words: impl Display) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, words.to_string())
    }

    /// A path where there is nothing.
    pub(crate) fn nothing_there() -> Self {
        Self::new(StatusCode::NOT_FOUND, "there is nothing at this path")
    }

    /// Work that ended without an answer, which would be a fault of the program.
    pub(crate) fn failed(error: impl Display) -> Self {
        let words = format!("the program failed: {error}");
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, words)
    }
}

impl From<CaseError> for Refusal {
    fn from(error: CaseError) -> Self {
        Self::values(error)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "error": self.words }))).into_response()
    }
}
