//! `/api/structure/elastic`: the same structure on elastic lines, as by `snapload elastic`.
use super::Latest;
use super::motion::Columns;
use super::opened::{Asked, Opened};
use super::run::too_long;
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use serde_json::Value as JsonValue;
use snapload::analysis::Progress;
use snapload_structure::{Prepared, both_models};
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(60);
/// The time between the states that are kept \[s\], and the number of states in a long record.
const EVERY_S: f64 = 0.02;
const MOST_KEPT: f64 = 200_000.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: Asked,
    /// The time interval that is shown \[s\].
    window: [f64; 2],
}

#[derive(Serialize)]
struct Answer {
    /// As by `snapload elastic --json`, without its lists of pulls and snaps.
    elastic: JsonValue,
    motion: Columns,
    shell: String,
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
    let go_on = |progress: Progress| allowance.go_on(progress);
    let every_s = EVERY_S.max(case.structure.duration_s / MOST_KEPT);
    let both = latest.both.of(&request.case.fingerprint(), || {
        let prepared = Prepared::for_springs(case.structure.clone())?;
        both_models(prepared, 1.0, every_s, &go_on)
    });
    let both = both.map_err(|unfinished| too_long(&case, BUDGET, unfinished))?;
    let mut told = both.to_json(&case.opened.name);
    if let Some(told) = told.as_object_mut() {
        told.remove("pulls");
        told.remove("inextensible");
    }
    let answer = Answer {
        elastic: told,
        motion: Columns::of_elastic(&both.elastic, &both.sprung.model.scales, request.window),
        shell: case.command("elastic"),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
