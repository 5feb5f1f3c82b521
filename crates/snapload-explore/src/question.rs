//! `/api/question/NAME`: the answer to a question about one case, for all questions of the report
//! crate.
use crate::refusal::Refusal;
use crate::request::{Values, case, options};
use crate::section::unfinished;
use crate::work::Allowance;
use serde::Deserialize;
use snapload::{CASE, Entries};
use snapload_report::Question;
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    /// By name; options that are left out have their defaults.
    #[serde(default)]
    options: Values,
}

/// The answer, as JSON: `words` for people, and `answer`, which is the output of the command.
pub(crate) fn answer(
    question: &Question,
    request: Request,
    allowance: &Allowance,
) -> Result<Vec<u8>, Refusal> {
    let case = case(request.values)?;
    let options = options(question, request.options)?;
    let allowance = allowance.within(BUDGET);
    // The fields of the page hold doubles.
    let entries = Entries::new(&CASE);
    let answer = question.ask(&case, &entries, options, &|progress| {
        allowance.check(progress)
    });
    let command = format!("snapload {}", question.name);
    let answer = answer.map_err(|why| unfinished(why, BUDGET, &command))?;
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
