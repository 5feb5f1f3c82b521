//! `/api/basin`: how much of the window of a map is safe.
use crate::map::AxisGiven;
use crate::refusal::Refusal;
use crate::request::{Values, entries};
use crate::section::unfinished;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::Parameters;
use snapload_orbits::{Basin, BasinRow, Window, basin_in_words};
use std::time::Duration;

/// What it may take.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    x: AxisGiven,
    y: AxisGiven,
}

#[derive(Serialize)]
struct Answer {
    words: String,
    #[serde(flatten)]
    basin: BasinRow,
}

/// The answer, as JSON.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let base = Parameters::from_entries(entries(request.values)?)?;
    let (x, y) = (request.x.read(), request.y.read());
    let x = x.map_err(|no| no.of_field("x"))?;
    let y = y.map_err(|no| no.of_field("y"))?;
    let window = Window {
        base,
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
