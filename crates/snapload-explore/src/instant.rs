//! `/api/instant`: the motion at exactly one time, and which cables are taut then.
use crate::motion::Columns;
use crate::refusal::Refusal;
use crate::request::{Values, case};
use crate::run::{BUDGET, too_long};
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::Playback;
use snapload::analysis::{Progress, record};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    t: f64,
}

#[derive(Serialize)]
struct Answer {
    /// Columns with one row.
    motion: Columns,
    /// Counted from 1.
    taut: Vec<usize>,
}

/// The answer, as JSON; at a time outside the run that at its end.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let case = case(request.values)?;
    let allowance = allowance.within(BUDGET);
    let on_progress = |progress: Progress| allowance.check(progress);
    let run = record(case.simulation(), &on_progress, |_, _| ())
        .map_err(|cancelled| too_long(case.parameters(), cancelled))?;
    let motion = Playback::new(&run).at(request.t);
    let answer = Answer {
        taut: motion.taut.iter().map(|cable| cable + 1).collect(),
        motion: Columns::at(&motion),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
