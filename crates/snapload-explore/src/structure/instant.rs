//! `/api/structure/instant`: the motion at exactly one time, which lines are taut then, and the
//! snaps before and after it.
use super::Latest;
use super::motion::Columns;
use super::opened::{CaseRequest, Opened};
use super::run::{RunRequest, assessed};
use super::snaps;
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::Playback;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: CaseRequest,
    /// Whether to run all of a long record, and not its beginning alone.
    #[serde(default)]
    whole: bool,
    /// \[s\]
    t: f64,
}

#[derive(Serialize)]
struct Answer {
    /// Columns with one row.
    motion: Columns,
    /// Counted from 1.
    taut: Vec<usize>,
    /// The times of the snaps before and after that time, which the page may not list \[s\].
    previous: Option<f64>,
    next: Option<f64>,
}

/// The answer, as JSON; at a time outside the run that at its end.
pub(crate) fn answer(
    request: &Request,
    start: Option<&Opened>,
    latest: &Latest,
    allowance: &Allowance,
) -> Result<Vec<u8>, Refusal> {
    let case = request.case.read(start)?;
    let wanted_run = RunRequest::alone(&case, request.whole);
    let assessment = assessed(&request.case, &case, wanted_run, latest, allowance)?;
    let scales = &assessment.prepared.model.scales;
    let motion = Playback::new(&assessment.run).at(request.t / scales.time_s);
    let [previous, next] = snaps::around(&assessment.snaps, request.t);
    let answer = Answer {
        taut: motion.taut.iter().map(|line| line + 1).collect(),
        motion: Columns::at_instant(&assessment.run, scales, &motion),
        previous,
        next,
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
