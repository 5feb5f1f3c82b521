//! `/api/structure/elastic`: the same structure on elastic lines, as by `snapload elastic`.
use super::Latest;
use super::motion::Columns;
use super::opened::{CaseRequest, Opened};
use super::run::too_long;
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use serde_json::Value as JsonValue;
use snapload::analysis::Progress;
use snapload_structure::{ModelAtRest, compare_elastic};
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(60);
/// The time between the states that are kept \[s\], and the number of states in a long record.
const EVERY_S: f64 = 0.02;
const MOST_KEPT: f64 = 200_000.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: CaseRequest,
    /// The time interval that is shown \[s\].
    window: [f64; 2],
}

#[derive(Serialize)]
struct Answer {
    /// As by `snapload elastic --json`, without its lists of pulls and snaps.
    elastic: JsonValue,
    motion: Columns,
}

/// The answer, as JSON.
pub(crate) fn answer(
    request: &Request,
    start: Option<&Opened>,
    latest: &Latest,
    allowance: &Allowance,
) -> Result<Vec<u8>, Refusal> {
    let case = request.case.read(start)?;
    let allowance = allowance.within(BUDGET);
    let on_progress = |progress: Progress| allowance.check(progress);
    let every_s = EVERY_S.max(case.structure.duration_s / MOST_KEPT);
    let comparison = latest.comparison.of(&request.case.fingerprint(), || {
        let prepared = ModelAtRest::for_elastic_lines(case.structure.clone())?;
        compare_elastic(prepared, 1.0, every_s, &on_progress)
    });
    let comparison =
        comparison.map_err(|unfinished| too_long(&case, "elastic", BUDGET, unfinished))?;
    let mut json = comparison.to_json(&case.opened.name);
    if let Some(json) = json.as_object_mut() {
        json.remove("pulls");
        json.remove("inextensible");
    }
    let answer = Answer {
        elastic: json,
        motion: Columns::of_elastic(
            &comparison.elastic,
            &comparison.elastic_case.model.scales,
            request.window,
        ),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
