//! The files of the page, which are embedded in the program.
use crate::refusal::Refusal;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::http::{HeaderValue, Uri};
use axum::response::{IntoResponse, Response};
use include_dir::{Dir, include_dir};

static PAGE: Dir = include_dir!("$CARGO_MANIFEST_DIR/page");

const ICON: &str = "icon.svg";
/// The path at which a browser requests an icon if a document names none, such as a picture that is
/// opened by itself.
const ICON_OF_OTHERS: &str = "favicon.ico";

/// The file of a path.
pub(crate) async fn file(uri: Uri) -> Result<Response, Refusal> {
    named(uri.path().trim_start_matches('/'))
}

/// The file of a name.
pub(crate) fn named(name: &str) -> Result<Response, Refusal> {
    let name = if name == ICON_OF_OTHERS { ICON } else { name };
    let kind = kind(name).ok_or_else(Refusal::not_found)?;
    let file = PAGE.get_file(name).ok_or_else(Refusal::not_found)?;
    let mut answer = ([(CONTENT_TYPE, kind)], file.contents()).into_response();
    if name == ICON {
        // Otherwise a browser requests it again with each change of the address, of which a run
        // makes many.
        let an_hour = HeaderValue::from_static("max-age=3600");
        answer.headers_mut().insert(CACHE_CONTROL, an_hour);
    }
    Ok(answer)
}

/// The media type of a file, by the ending of its name.
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
