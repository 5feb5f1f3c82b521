//! Which requests the server accepts, and the headers of its answers.
//!
//! A page of another site can make the browser send requests here. It can not read the answers,
//! unless its own host name was made to resolve to this machine (DNS rebinding): that is why the
//! host name of a request has to be ours.
use crate::refusal::Refusal;
use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, HeaderName, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

/// The page may load files of this server, and nothing else.
const POLICY: &str = "default-src 'self'; img-src 'self' data: blob:; media-src 'self' blob:; \
    style-src 'self' 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; \
    object-src 'none'";

/// The headers of every answer that does not set them itself.
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

/// The host names that the server accepts.
pub(crate) struct Names {
    hosts: [String; 2],
    origins: [String; 2],
}

impl Names {
    /// The names of a server at this port.
    pub(crate) fn at(port: u16) -> Self {
        let hosts = ["127.0.0.1", "localhost"].map(|host| match port {
            80 => host.to_owned(),
            port => format!("{host}:{port}"),
        });
        let origins = hosts.each_ref().map(|host| format!("http://{host}"));
        Self { hosts, origins }
    }

    fn refuse(&self, request: &Request) -> Option<Refusal> {
        // For each value of a header, which may be given more than once, whether it is one of our
        // names.
        let among = |names: &[String; 2], header: &HeaderName| -> Vec<bool> {
            let given = request.headers().get_all(header).iter();
            given
                .map(|value| names.iter().any(|name| value == name.as_str()))
                .collect()
        };
        let [host, ..] = &self.hosts;
        let authority = request.uri().authority();
        let other = authority.is_some_and(|name| !self.hosts.iter().any(|host| name == host));
        if among(&self.hosts, &HOST) != [true] || other {
            let message = format!("this server only accepts requests for http://{host}/");
            return Some(Refusal::new(StatusCode::MISDIRECTED_REQUEST, message));
        }
        if among(&self.origins, &ORIGIN).contains(&false) {
            let message =
                format!("this server only accepts requests from its own page, http://{host}/");
            return Some(Refusal::new(StatusCode::FORBIDDEN, message));
        }
        None
    }
}

/// Refuses requests that are not from our own page, and adds the headers to every answer.
pub(crate) async fn host_check(
    State(names): State<Arc<Names>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match names.refuse(&request) {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        let value = HeaderValue::from_static(value);
        response.headers_mut().entry(name).or_insert(value);
    }
    response
}
