//! `/api/section`: the state of a long motion once per period of its forcing.
use crate::refusal::Refusal;
use crate::request::{Values, case};
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::analysis::Unfinished;
use snapload_orbits::{Section, SectionRow, section_options, section_summary};
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(20);
/// The default numbers of periods and of points kept; and the largest numbers.
const PERIODS: u64 = 800;
const KEEP: u64 = 400;
const MOST_PERIODS: u64 = 20_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    #[serde(default)]
    periods: Option<u64>,
    #[serde(default)]
    keep: Option<u64>,
}

#[derive(Serialize)]
struct Answer {
    words: String,
    #[serde(flatten)]
    section: SectionRow,
}

/// The answer, as JSON.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let case = case(request.values)?;
    let periods = request.periods.unwrap_or(PERIODS).min(MOST_PERIODS);
    let options = section_options(periods, request.keep.unwrap_or(KEEP.min(periods)), 0.0)?;
    let allowance = allowance.within(BUDGET);
    let section = Section::of(case.parameters(), &options, &|progress| {
        allowance.check(progress)
    });
    let section = section.map_err(|why| unfinished(why, BUDGET, "snapload section"))?;
    let answer = Answer {
        words: section_summary(&section),
        section: SectionRow::new(&section, options.phase),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}

/// The refusal of work that did not end within its time.
pub(crate) fn unfinished(why: Unfinished, time: Duration, command: &str) -> Refusal {
    match why {
        Unfinished::Case(error) => error.into(),
        Unfinished::Cancelled(_) => Refusal::values(format!(
            "this takes more than {} s, the limit of the page\nhint: {command} has no time limit",
            time.as_secs()
        )),
    }
}
