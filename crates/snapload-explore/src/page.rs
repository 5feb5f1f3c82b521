//! The files of the page: part of the program, and in debug builds read from the disk.
use crate::refusal::Refusal;
use axum::http::Uri;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use rust_embed::RustEmbed;

#[derive(RustEmbed)]
#[folder = "page/"]
struct Page;

/// The file of a path; the page itself at `/`.
pub(crate) async fn file(uri: Uri) -> Result<Response, Refusal> {
    let name = match uri.path().trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    // Our own names have no other characters; what is not ours is not even looked for on the disk.
    let ours = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    if !name.chars().all(ours) || name.split('/').any(|part| part.is_empty() || part == "..") {
        return Err(Refusal::nothing_there());
    }
    let file = Page::get(name).ok_or_else(Refusal::nothing_there)?;
    let kind = file.metadata.mimetype();
    let kind = match kind.starts_with("text/") {
        true => format!("{kind}; charset=utf-8"),
        false => kind.to_owned(),
    };
    Ok(([(CONTENT_TYPE, kind)], file.data).into_response())
}
