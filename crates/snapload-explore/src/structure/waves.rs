//! `/api/structure/waves`: the same structure in regular waves of other heights and periods.
use super::opened::{CaseRequest, Opened};
use super::run::too_long;
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::analysis::{Progress, Unfinished};
use snapload_structure::note::{self, ScanCell};
use std::time::Duration;

/// The time budget for all runs together.
const BUDGET: Duration = Duration::from_secs(120);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: CaseRequest,
}

#[derive(Serialize)]
struct Answer {
    periods_s: Vec<f64>,
    heights_m: Vec<f64>,
    /// All heights for the first period, then for the next.
    cells: Vec<Answered>,
    /// Whether cells are the largest utilisation; otherwise the fastest snap \[m/s\].
    utilisation: bool,
    /// The number of periods of each wave that are run.
    length: f64,
}

/// A cell, and whether its value is a lower bound, or why it has none.
#[derive(Serialize)]
struct Answered {
    value: Option<f64>,
    kind: &'static str,
}

impl From<ScanCell> for Answered {
    fn from(cell: ScanCell) -> Self {
        let (value, kind) = match cell {
            ScanCell::Known(value) => (Some(value), "known"),
            ScanCell::AtLeast(value) => (Some(value), "at least"),
            ScanCell::NotJudged => (None, "not judged"),
            ScanCell::Fails => (None, "fails"),
        };
        Self { value, kind }
    }
}

/// The answer, as JSON.
pub(crate) fn answer(
    request: &Request,
    start: Option<&Opened>,
    allowance: &Allowance,
) -> Result<Vec<u8>, Refusal> {
    let case = request.case.read(start)?;
    let allowance = allowance.within(BUDGET);
    let on_progress = |progress: Progress| allowance.check(progress);
    let scan = note::scan(&case.structure, &on_progress)
        .map_err(|cancelled| too_long(&case, "assess", BUDGET, Unfinished::Cancelled(cancelled)))?
        .ok_or_else(|| {
            Refusal::values("other waves are computed around a regular wave; the case has none")
        })?;
    let answer = Answer {
        periods_s: scan.periods_s,
        heights_m: scan.heights_m,
        cells: scan.cells.into_iter().map(Answered::from).collect(),
        utilisation: case.structure.utilisations_known(),
        length: note::LENGTH,
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
