//! `/api/basin`: which cells of a window are safe, or how the safe part of it shrinks along a third
//! key.
use crate::map::{AxisGiven, Map};
use crate::refusal::Refusal;
use crate::request::Values;
use crate::section::unfinished;
use crate::work::Allowance;
use serde::{Deserialize, Serialize};
use snapload::Parameters;
use snapload::analysis::Progress;
use snapload_orbits::{
    Basin, BasinRow, Cell, Erosion, ErosionRow, Window, basin_summary, erosion_summary,
};
use std::time::Duration;

/// Its time budget.
const BUDGET: Duration = Duration::from_secs(20);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    #[serde(default)]
    values: Values,
    x: AxisGiven,
    y: AxisGiven,
    /// The third key and its values.
    #[serde(default)]
    over: Option<AxisGiven>,
    /// Whether to report the progress, line by line.
    #[serde(default)]
    pub(crate) progress: bool,
}

#[derive(Serialize)]
struct Picture {
    words: String,
    #[serde(flatten)]
    basin: BasinRow,
    x: Vec<f64>,
    y: Vec<f64>,
    /// How each cell ends, x fastest; null where its start is not legal.
    ends: Vec<Option<&'static str>>,
    /// For each cell whether it reaches a limit, whether its run is cut short, and whether its
    /// neighbours end alike.
    escapes: Vec<bool>,
    cut: Vec<bool>,
    decided: Vec<bool>,
}

#[derive(Serialize)]
struct Eroded {
    words: String,
    #[serde(flatten)]
    erosion: ErosionRow,
}

/// The answer, as JSON.
pub(crate) fn answer(request: Request, allowance: &Allowance) -> Result<Vec<u8>, Refusal> {
    let over = request.over.map(|over| {
        let read = over.read();
        read.map_err(|no| no.of_field("over"))
    });
    let over = over.transpose()?;
    let Map { base, x, y } = Map::of(request.values, request.x, request.y)?;
    let window = Window {
        base: Parameters::from_entries(base)?,
        keys: [x.key, y.key],
        values: [x.values, y.values],
    };
    let allowance = allowance.within(BUDGET);
    let on_progress = |progress: Progress| allowance.check(progress);
    let bytes = match over {
        None => {
            let basin = Basin::of(window, true, &on_progress);
            let basin = basin.map_err(|why| unfinished(why, BUDGET, "snapload basin"))?;
            serde_json::to_vec(&Picture::of(basin))
        }
        Some(over) => {
            // Neighbours of every cell would take ten times as long; the answer says that they were
            // not computed.
            let erosion = Erosion::of(&window, over.key, &over.values, false, &on_progress);
            let erosion = erosion.map_err(|why| unfinished(why, BUDGET, "snapload erosion"))?;
            serde_json::to_vec(&Eroded {
                words: erosion_summary(&erosion),
                erosion: ErosionRow::new(&erosion),
            })
        }
    };
    bytes.map_err(Refusal::failed)
}

impl Picture {
    fn of(basin: Basin) -> Self {
        let (words, row) = (basin_summary(&basin), BasinRow::new(&basin));
        let [x, y] = basin.window.values;
        // The engine's second key varies fastest; the page's first one does, as in a map.
        let (columns, rows) = (x.len(), y.len());
        let order = (0..columns * rows).map(|k| (k % columns) * rows + k / columns);
        let cells: Vec<Cell> = order.map(|k| basin.cells[k]).collect();
        Self {
            words,
            basin: row,
            ends: cells
                .iter()
                .map(|cell| cell.end.map(|(stop, _)| stop.name()))
                .collect(),
            escapes: cells.iter().map(Cell::escapes).collect(),
            cut: cells.iter().map(Cell::is_cut_short).collect(),
            decided: cells.iter().map(|cell| cell.decided).collect(),
            x,
            y,
        }
    }
}
