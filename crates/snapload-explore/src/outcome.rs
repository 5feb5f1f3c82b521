//! `/api/outcome`: how a run and its neighbours end, where rounding may decide how the run ends.
use crate::export::SEED;
use crate::refusal::Refusal;
use crate::request::{OfCase, case};
use crate::section::unfinished;
use crate::work::Allowance;
use serde::Serialize;
use snapload::analysis::{Progress, Uncertainty};
use snapload_report::{RunWithTrust, outcome_in_words};
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Serialize)]
struct Answer {
    /// As in the summary of the command.
    words: String,
}

/// The answer, as JSON.
pub(crate) fn answer(request: OfCase, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let case = case(request.values)?;
    let allowance = allowance.within(BUDGET);
    let on_progress = |progress: Progress| allowance.check(progress);
    let run = RunWithTrust::run(&case, Uncertainty::default(), None, SEED, &on_progress);
    let run = run.map_err(|why| unfinished(why, BUDGET, "snapload run"))?;
    let words = outcome_in_words(&run);
    serde_json::to_vec(&Answer { words }).map_err(Refusal::failed)
}
