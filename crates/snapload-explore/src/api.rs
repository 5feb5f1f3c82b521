//! The paths of the server.
use crate::guard::{Names, guard};
use crate::refusal::Refusal;
use crate::request::{Body, LARGEST_BODY};
use crate::schema::{Start, schema};
use crate::work::compute;
use crate::{case_file, export, map, page, proof, run};
use axum::extract::{DefaultBodyLimit, Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router, body};
use std::sync::Arc;
use tokio::sync::Semaphore;

/// Runs at one time; others wait.
const WORKERS: usize = 4;
/// Files at one time. They have workers of their own, so that a page whose files are written goes on.
const WRITERS: usize = 2;
/// Lines of maps at one time, each of which takes all processors: maps take turns.
const MAPPERS: usize = 1;
/// Proofs at one time.
const PROVERS: usize = 2;

/// What the answers are made from.
struct Shared {
    start: Start,
    workers: Arc<Semaphore>,
    writers: Arc<Semaphore>,
    mappers: Arc<Semaphore>,
    provers: Arc<Semaphore>,
}

/// Which path is answered by what, on a server at this port that begins with this case.
pub(crate) fn router(start: Start, port: u16) -> Router {
    let shared = Shared {
        start,
        workers: Arc::new(Semaphore::new(WORKERS)),
        writers: Arc::new(Semaphore::new(WRITERS)),
        mappers: Arc::new(Semaphore::new(MAPPERS)),
        provers: Arc::new(Semaphore::new(PROVERS)),
    };
    Router::new()
        .route("/api/schema", get(answer_schema))
        .route("/api/case", post(answer_case))
        .route("/api/run", post(answer_run))
        .route("/api/map", post(answer_map))
        .route("/api/proof", post(answer_proof))
        .route("/api/export/{name}", post(answer_export))
        .fallback_service(get(page::file).fallback(wrong_method))
        .method_not_allowed_fallback(wrong_method)
        .layer(DefaultBodyLimit::max(LARGEST_BODY))
        .layer(from_fn_with_state(Arc::new(Names::at(port)), guard))
        .with_state(Arc::new(shared))
}

async fn wrong_method() -> Refusal {
    let message = "this path is not asked in this way";
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, message)
}

async fn answer_schema(State(shared): State<Arc<Shared>>) -> impl IntoResponse {
    Json(schema(&shared.start))
}

/// The values of a case file, as far as they differ from the defaults.
async fn answer_case(
    Body(request): Body<case_file::Request>,
) -> Result<impl IntoResponse, Refusal> {
    case_file::answer(&request).map(Json)
}

async fn answer_run(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<run::Request>,
) -> Result<impl IntoResponse, Refusal> {
    let answer = compute(&shared.workers, move |allowance| {
        run::answer(request, allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

async fn answer_proof(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<proof::Request>,
) -> Result<impl IntoResponse, Refusal> {
    let answer = compute(&shared.provers, move |allowance| {
        proof::answer(request, allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

async fn answer_map(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<map::Request>,
) -> Result<impl IntoResponse, Refusal> {
    let lines = map::lines(request, Arc::clone(&shared.mappers))?;
    let body = body::Body::from_stream(lines);
    Ok(([(CONTENT_TYPE, "application/x-ndjson")], body))
}

async fn answer_export(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Body(request): Body<export::Request>,
) -> Result<Response, Refusal> {
    let file = export::File::named(&name).ok_or_else(Refusal::nothing_there)?;
    let kind = file.content_type();
    let bytes = compute(&shared.writers, move |allowance| {
        file.write(request, allowance)
    })
    .await?;
    let place = format!("attachment; filename=\"{name}\"");
    let headers = [(CONTENT_TYPE, kind), (CONTENT_DISPOSITION, place.as_str())];
    Ok((headers, bytes).into_response())
}
