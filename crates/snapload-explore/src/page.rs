//! The files of the page: part of the program.
use crate::refusal::Refusal;
use axum::http::Uri;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use include_dir::{Dir, include_dir};

static PAGE: Dir = include_dir!("$CARGO_MANIFEST_DIR/page");

/// The file of a path.
pub(crate) async fn file(uri: Uri) -> Result<Response, Refusal> {
    named(uri.path().trim_start_matches('/'))
}

/// The file of a name.
pub(crate) fn named(name: &str) -> Result<Response, Refusal> {
    let kind = kind(name).ok_or_else(Refusal::nothing_there)?;
    let file = PAGE.get_file(name).ok_or_else(Refusal::nothing_there)?;
    Ok(([(CONTENT_TYPE, kind)], file.contents()).into_response())
}

/// What a browser is told that a file is, by the end of its name.
fn kind(name: &str) -> Option<&'static str> {
    match name.rsplit_once('.')?.1 {
        "css" => Some("text/css; charset=utf-8"),
        "html" => Some("text/html; charset=utf-8"),
        "js" => Some("text/javascript; charset=utf-8"),
        "svg" => Some("image/svg+xml"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_page_is_of_a_known_kind() {
        for file in PAGE.files() {
            let name = file.path().to_str().expect("a name of plain letters");
            assert!(kind(name).is_some(), "{name}");
        }
        assert!(PAGE.get_file("index.html").is_some() && PAGE.get_file("structure.html").is_some());
        assert!(PAGE.dirs().next().is_none());
    }
}
