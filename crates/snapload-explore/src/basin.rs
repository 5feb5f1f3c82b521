//! `/api/basin`: how much of the window of a map is safe.
use crate::map::{Map, Request};
use crate::refusal::Refusal;
use crate::section::unfinished;
use crate::work::Allowance;
use serde::Serialize;
use snapload::Parameters;
use snapload_orbits::{Basin, BasinRow, Window, basin_in_words};
use std::time::Duration;

/// What it may take.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Serialize)]
struct Answer {
    words: String,
    #[serde(flatten)]
    basin: BasinRow,
}

/// The answer, as JSON.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let Map { base, x, y } = Map::read(request)?;
    let window = Window {
        base: Parameters::from_entries(base)?,
        keys: [x.key, y.key],
        values: [x.values, y.values],
    };
    let allowance = allowance.within(BUDGET);
    let basin = Basin::of(window, true, &|progress| allowance.go_on(progress));
    let basin = basin.map_err(|why| unfinished(why, "snapload basin"))?;
    let answer = Answer {
        words: basin_in_words(&basin),
        basin: BasinRow::new(&basin),
    };
    serde_json::to_vec(&answer).map_err(Refusal::failed)
}
