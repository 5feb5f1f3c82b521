//! The routes of the server.
use crate::host_check::{Names, host_check};
use crate::refusal::{LARGEST_BODY, Refusal};
use crate::request::{Body, OfCase};
use crate::schema::{Start, schema};
use crate::structure::{self, Latest, Opened};
use crate::work::{Allowance, compute, compute_in_lines};
use crate::{basin, case_file, export, instant, map, outcome, page, proof, question, run, section};
use axum::extract::{DefaultBodyLimit, Path, State};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router, body};
use std::convert::Infallible;
use std::sync::Arc;
use tokio::sync::Semaphore;
use tokio_stream::Stream;

/// Runs at one time; further ones wait.
const WORKERS: usize = 4;
/// Files at one time. They have workers of their own, so that writing files does not delay the
/// page.
const WRITERS: usize = 2;
/// Lines of maps at one time. As each takes all processors, maps take turns.
const MAPPERS: usize = 1;
/// Proofs, questions, sections and neighbours of runs at one time.
const PROVERS: usize = 2;

/// The state that answers share.
struct Shared {
    start: Start,
    /// The structure with which the program was started, if there was one.
    opened: Option<Opened>,
    latest: Latest,
    workers: Arc<Semaphore>,
    writers: Arc<Semaphore>,
    mappers: Arc<Semaphore>,
    provers: Arc<Semaphore>,
}

/// The handler of each path, on a server at this port whose first case is this one.
pub(crate) fn router(start: Start, opened: Option<Opened>, port: u16) -> Router {
    let shared = Shared {
        start,
        opened,
        latest: Latest::default(),
        workers: Arc::new(Semaphore::new(WORKERS)),
        writers: Arc::new(Semaphore::new(WRITERS)),
        mappers: Arc::new(Semaphore::new(MAPPERS)),
        provers: Arc::new(Semaphore::new(PROVERS)),
    };
    Router::new()
        .route("/", get(answer_page))
        .route("/api/schema", get(answer_schema))
        .route("/api/case", post(answer_case))
        .route("/api/run", post(answer_run))
        .route("/api/instant", post(answer_instant))
        .route("/api/map", post(answer_map))
        .route("/api/outcome", post(answer_outcome))
        .route("/api/proof", post(answer_proof))
        .route("/api/question/{name}", post(answer_question))
        .route("/api/section", post(answer_section))
        .route("/api/basin", post(answer_basin))
        .route("/api/export/{name}", post(answer_export))
        .route(
            "/api/structure",
            get(answer_structure).post(answer_structure_file),
        )
        .route("/api/structure/run", post(answer_structure_run))
        .route("/api/structure/instant", post(answer_structure_instant))
        .route("/api/structure/elastic", post(answer_structure_elastic))
        .route("/api/structure/waves", post(answer_structure_waves))
        .route(
            "/api/structure/export/{name}",
            post(answer_structure_export),
        )
        .fallback_service(get(page::file).fallback(wrong_method))
        .method_not_allowed_fallback(wrong_method)
        .layer(DefaultBodyLimit::max(LARGEST_BODY))
        .layer(from_fn_with_state(Arc::new(Names::at(port)), host_check))
        .with_state(Arc::new(shared))
}

async fn wrong_method() -> Refusal {
    let message = "this path does not accept this method";
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, message)
}

/// The page of the case or structure with which the program was started.
async fn answer_page(State(shared): State<Arc<Shared>>) -> Result<Response, Refusal> {
    page::named(match shared.opened {
        Some(_) => "structure.html",
        None => "index.html",
    })
}

async fn answer_schema(State(shared): State<Arc<Shared>>) -> impl IntoResponse {
    Json(schema(&shared.start))
}

/// The values of a case file that differ from the defaults.
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

async fn answer_instant(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<instant::Request>,
) -> Result<Response, Refusal> {
    let work = move |allowance: &Allowance| instant::answer(request, allowance);
    compute(&shared.workers, work).await.map(json)
}

async fn answer_outcome(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<OfCase>,
) -> Result<Response, Refusal> {
    let work = move |allowance: &Allowance| outcome::answer(request, allowance);
    compute(&shared.provers, work).await.map(json)
}

async fn answer_proof(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<OfCase>,
) -> Result<impl IntoResponse, Refusal> {
    let answer = compute(&shared.provers, move |allowance| {
        proof::answer(request, allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

async fn answer_question(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Body(request): Body<question::Request>,
) -> Result<Response, Refusal> {
    let question = snapload_report::question(&name).ok_or_else(Refusal::not_found)?;
    let work = move |allowance: &Allowance| question::answer(question, request, allowance);
    compute(&shared.provers, work).await.map(json)
}

async fn answer_section(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<section::Request>,
) -> Result<impl IntoResponse, Refusal> {
    let answer = compute(&shared.provers, move |allowance| {
        section::answer(request, allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

/// A basin takes all processors, as a map does.
async fn answer_basin(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<basin::Request>,
) -> Result<Response, Refusal> {
    let progress = request.progress;
    let work = move |allowance: &Allowance| basin::answer(request, allowance);
    progress_or(json, progress, &shared.mappers, work).await
}

async fn answer_map(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<map::Request>,
) -> Result<impl IntoResponse, Refusal> {
    let lines = map::lines(request, Arc::clone(&shared.mappers))?;
    Ok(line_by_line(lines))
}

/// An answer of several lines, each an object of JSON.
fn line_by_line(
    lines: impl Stream<Item = Result<body::Bytes, Infallible>> + Send + 'static,
) -> Response {
    let body = body::Body::from_stream(lines);
    ([(CONTENT_TYPE, "application/x-ndjson")], body).into_response()
}

/// An object of JSON.
fn json(bytes: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, "application/json")], bytes).into_response()
}

/// The result of some work as an answer of its own, or, if its progress is requested, as the last
/// line of an answer.
async fn progress_or(
    whole: impl FnOnce(Vec<u8>) -> Response,
    progress: bool,
    workers: &Arc<Semaphore>,
    work: impl FnOnce(&Allowance) -> Result<Vec<u8>, Refusal> + Send + 'static,
) -> Result<Response, Refusal> {
    match progress {
        true => Ok(line_by_line(compute_in_lines(workers, work))),
        false => compute(workers, work).await.map(whole),
    }
}

async fn answer_export(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Body(request): Body<export::Request>,
) -> Result<Response, Refusal> {
    let file = export::File::named(&name).ok_or_else(Refusal::not_found)?;
    let kind = file.content_type();
    let bytes = compute(&shared.writers, move |allowance| {
        file.write(request, allowance)
    })
    .await?;
    Ok(file_named(&name, kind, bytes))
}

/// An answer that the browser saves as a file.
fn file_named(name: &str, kind: &str, bytes: Vec<u8>) -> Response {
    let place = format!("attachment; filename=\"{name}\"");
    let headers = [(CONTENT_TYPE, kind), (CONTENT_DISPOSITION, place.as_str())];
    (headers, bytes).into_response()
}

async fn answer_structure(State(shared): State<Arc<Shared>>) -> impl IntoResponse {
    Json(structure::schema(shared.opened.as_ref()))
}

/// The values of a structure's case file that was opened on the page.
async fn answer_structure_file(
    Body(file): Body<structure::CaseFile>,
) -> Result<impl IntoResponse, Refusal> {
    structure::opened(&file).map(Json)
}

async fn answer_structure_run(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<structure::RunRequest>,
) -> Result<Response, Refusal> {
    let workers = Arc::clone(&shared.workers);
    let progress = request.progress;
    let work = move |allowance: &Allowance| {
        structure::run(&request, shared.opened.as_ref(), &shared.latest, allowance)
    };
    progress_or(json, progress, &workers, work).await
}

async fn answer_structure_instant(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<structure::InstantRequest>,
) -> Result<Response, Refusal> {
    let workers = Arc::clone(&shared.workers);
    let work = move |allowance: &Allowance| {
        structure::instant(&request, shared.opened.as_ref(), &shared.latest, allowance)
    };
    compute(&workers, work).await.map(json)
}

async fn answer_structure_elastic(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<structure::ElasticRequest>,
) -> Result<impl IntoResponse, Refusal> {
    let workers = Arc::clone(&shared.workers);
    let answer = compute(&workers, move |allowance| {
        structure::elastic(&request, shared.opened.as_ref(), &shared.latest, allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

async fn answer_structure_waves(
    State(shared): State<Arc<Shared>>,
    Body(request): Body<structure::WavesRequest>,
) -> Result<impl IntoResponse, Refusal> {
    let mappers = Arc::clone(&shared.mappers);
    let answer = compute(&mappers, move |allowance| {
        structure::waves(&request, shared.opened.as_ref(), allowance)
    })
    .await?;
    Ok(([(CONTENT_TYPE, "application/json")], answer))
}

async fn answer_structure_export(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Body(request): Body<structure::ExportRequest>,
) -> Result<Response, Refusal> {
    let file = structure::File::named(&name).ok_or_else(Refusal::not_found)?;
    let writers = Arc::clone(&shared.writers);
    let progress = request.progress;
    let work = move |allowance: &Allowance| {
        file.write(&request, shared.opened.as_ref(), &shared.latest, allowance)
    };
    let whole = |bytes| file_named(&name, file.content_type(), bytes);
    progress_or(whole, progress, &writers, work).await
}
