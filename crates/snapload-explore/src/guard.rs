//! Whom the server answers, and what it tells the browser about its answers.
//!
//! A page of another site can make the browser send requests here. It can not read the answers, unless its own
//! name was made to lead here (DNS rebinding): that is why the name that is asked for has to be ours.
use crate::api::Shared;
use crate::refusal::Refusal;
use axum::body::{Body, to_bytes};
use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_LENGTH, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, HeaderName, ORIGIN,
    REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;
use std::time::Duration;

/// The page may load what the program serves, and nothing else.
const POLICY: &str = "default-src 'self'; img-src 'self' data: blob:; media-src 'self' blob:; \
    style-src 'self' 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; \
    object-src 'none'";

/// What every answer carries.
const HEADERS: [(HeaderName, &str); 5] = [
    (CONTENT_SECURITY_POLICY, POLICY),
    (X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (REFERRER_POLICY, "no-referrer"),
    (CACHE_CONTROL, "no-store"),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
];

/// The longest body of a request: a case has some twenty values.
const LARGEST_BODY: usize = 64 << 10;
/// So long a body may take to arrive.
const BODY_WITHIN: Duration = Duration::from_secs(10);

/// The names by which the server may be asked.
pub(crate) struct Names {
    hosts: [String; 2],
    origins: [String; 2],
}

impl Names {
    /// Of a server at this port.
    pub(crate) fn at(port: u16) -> Self {
        let hosts = ["127.0.0.1", "localhost"].map(|host| match port {
            80 => host.to_owned(),
            port => format!("{host}:{port}"),
        });
        let origins = hosts.each_ref().map(|host| format!("http://{host}"));
        Self { hosts, origins }
    }

    fn refuse(&self, request: &Request) -> Option<Refusal> {
        let among = |names: &[String; 2], header: &HeaderName| {
            let given = request.headers().get_all(header).iter();
            given
                .map(|value| names.iter().any(|name| value == name.as_str()))
                .collect::<Vec<bool>>()
        };
        let authority = request.uri().authority();
        let absolute =
            authority.is_none_or(|name| self.hosts.iter().any(|host| host == name.as_str()));
        let [host, ..] = &self.hosts;
        if among(&self.hosts, &HOST) != [true] || !absolute {
            let words = format!("this server answers to http://{host}/ only");
            return Some(Refusal::new(StatusCode::MISDIRECTED_REQUEST, words));
        }
        if among(&self.origins, &ORIGIN).contains(&false) {
            let words = format!("only the page of http://{host}/ itself is answered");
            return Some(Refusal::new(StatusCode::FORBIDDEN, words));
        }
        None
    }
}

/// Refuses who is not our own page, and puts the headers on every answer.
pub(crate) async fn guard(
    State(shared): State<Arc<Shared>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match shared.names.refuse(&request) {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        let value = HeaderValue::from_static(value);
        response.headers_mut().insert(name, value);
    }
    response
}

/// Lets bodies through that are JSON, of some size, and come in time.
pub(crate) async fn json_only(request: Request, next: Next) -> Result<Response, Refusal> {
    let kind = request.headers().get(CONTENT_TYPE);
    let kind = kind.and_then(|kind| kind.to_str().ok()).unwrap_or_default();
    let kind = kind.split(';').next().unwrap_or_default().trim();
    if !kind.eq_ignore_ascii_case("application/json") {
        let words = "the request has to be application/json";
        return Err(Refusal::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, words));
    }
    let too_large = || {
        let words = format!("the request is larger than {LARGEST_BODY} bytes");
        Refusal::new(StatusCode::PAYLOAD_TOO_LARGE, words)
    };
    let length = request.headers().get(CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    if length.is_some_and(|length| length > LARGEST_BODY as u64) {
        return Err(too_large());
    }
    let (parts, body) = request.into_parts();
    let body = tokio::time::timeout(BODY_WITHIN, to_bytes(body, LARGEST_BODY)).await;
    let body = body.map_err(|_| {
        let words = "the request did not arrive in time";
        Refusal::new(StatusCode::REQUEST_TIMEOUT, words)
    })?;
    let body = body.map_err(|_| too_large())?;
    Ok(next.run(Request::from_parts(parts, Body::from(body))).await)
}
