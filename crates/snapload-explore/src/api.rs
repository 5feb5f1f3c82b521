//! The paths of the server.
use crate::guard::{Names, guard, json_only};
use crate::refusal::Refusal;
use crate::schema::{Start, schema};
use crate::work::compute;
use crate::{export, map, page, run};
use axum::body::{Body, Bytes};
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::middleware::{from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodRouter, get, post};
use axum::{Json, Router};
use std::sync::Arc;
use tokio::sync::Semaphore;

/// Runs at one time; others wait.
const WORKERS: usize = 4;
/// Maps at one time, each of which takes all processors.
const MAPPERS: usize = 2;

/// What all requests share.
pub(crate) struct Shared {
    start: Start,
    pub(crate) names: Names,
    workers: Arc<Semaphore>,
    mappers: Arc<Semaphore>,
}

impl Shared {
    pub(crate) fn new(start: Start, port: u16) -> Self {
        Self {
            start,
            names: Names::at(port),
            workers: Arc::new(Semaphore::new(WORKERS)),
            mappers: Arc::new(Semaphore::new(MAPPERS)),
        }
    }
}

type Paths = MethodRouter<Arc<Shared>>;

/// Which path is answered by what.
pub(crate) fn router(shared: Arc<Shared>) -> Router {
    let taking_json = |paths: Paths| paths.route_layer(from_fn(json_only));
    Router::new()
        .route("/api/schema", get(answer_schema))
        .route("/api/run", taking_json(post(answer_run)))
        .route("/api/map", taking_json(post(answer_map)))
        .route("/api/export/{name}", taking_json(post(answer_export)))
        .fallback_service(get(page::file).fallback(wrong_method))
        .method_not_allowed_fallback(wrong_method)
        .layer(from_fn_with_state(Arc::clone(&shared), guard))
        .with_state(shared)
}

async fn wrong_method() -> Refusal {
    let words = "this path is not asked in this way";
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, words)
}

async fn answer_schema(State(shared): State<Arc<Shared>>) -> impl IntoResponse {
    Json(schema(&shared.start))
}

async fn answer_run(State(shared): State<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let answer = compute(&shared.workers, move |leash| run::answer(&body, leash)).await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer).into_response())
}

async fn answer_map(State(shared): State<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let lines = map::lines(&body, Arc::clone(&shared.mappers))?;
    let body = Body::from_stream(lines);
    Ok(([(CONTENT_TYPE, "application/x-ndjson")], body).into_response())
}

async fn answer_export(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    body: Bytes,
) -> Result<Response, Refusal> {
    let file = export::File::named(&name).ok_or_else(Refusal::nothing_there)?;
    let kind = file.content_type();
    let bytes = compute(&shared.workers, move |leash| file.write(&body, leash)).await?;
    let place = format!("attachment; filename=\"{name}\"");
    let headers = [(CONTENT_TYPE, kind), (CONTENT_DISPOSITION, place.as_str())];
    Ok((headers, bytes).into_response())
}
