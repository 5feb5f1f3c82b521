//! Safe basins: the starts, or the values of any two keys, for which a body stays below its limits.
//!
//! J. M. T. Thompson, *Proc. R. Soc. A* 421 (1989) 195; M. S. Soliman & J. M. T. Thompson, *J.
//! Sound Vib.* 135 (1989) 453; G. Rega & S. Lenci, *Nonlinear Anal.* 63 (2005) 902.

use crate::measures::{Measures, VELOCITIES};
use snapload::analysis::{
    Cancelled, Certainty, Counter, OnProgress, Progress, Unfinished, on_all_threads,
    outcomes_on_one_thread,
};
use snapload::{Case, CaseError, Lanes, Outcome, Parameters, Stop, Value};

/// Two keys and the values that they take: a grid of cells.
#[derive(Clone, Debug)]
pub struct Window {
    /// The values of the other keys.
    pub base: Parameters,
    /// The keys.
    pub keys: [&'static str; 2],
    /// Their values, evenly spaced.
    pub values: [Vec<f64>; 2],
}

/// The result of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// How and when its run ended; none if it is not legal.
    pub end: Option<(Stop, f64)>,
    /// Whether its neighbours end alike.
    pub decided: bool,
    /// Whether the run ends before its horizon of trust.
    pub trusted: bool,
}

/// A window with the results of its cells.
#[derive(Clone, Debug)]
pub struct Basin {
    /// The window.
    pub window: Window,
    /// The cells, the second key varying fastest.
    pub cells: Vec<Cell>,
    /// Whether neighbours and horizons were computed.
    pub neighbours_run: bool,
    /// Measures of its safe part.
    pub measures: Measures,
}

/// The distance of neighbours, along either key and along both.
const NEIGHBOUR_DISTANCE: f64 = 1e-8;
/// Where rounding may decide a run, neighbours at all of these distances are used.
const NEIGHBOUR_DISTANCES: [f64; 3] = [NEIGHBOUR_DISTANCE, 1e-10, 1e-12];
const NEIGHBOURS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.0, 1.0],
    [0.0, -1.0],
    [1.0, 1.0],
    [-1.0, -1.0],
    [1.0, -1.0],
    [-1.0, 1.0],
];
const STARTS: [&str; 6] = ["x", "y", "theta", "vx", "vy", "vtheta"];

/// A window with more cells than this is refused as a typing error.
const MOST_CELLS: usize = 100_000_000;
/// Values count as evenly spaced if each differs from even spacing by at most this part of a step.
const UNEVEN: f64 = 1e-6;

/// Whether values are evenly spaced, up to the rounding of their decimals.
fn are_even(values: &[f64]) -> bool {
    let [first, .., last] = values else {
        return true;
    };
    let step = (last - first) / (values.len() - 1) as f64;
    let is_even = |(k, value): (usize, &f64)| {
        (value - (first + step * k as f64)).abs() <= UNEVEN * step.abs()
    };
    step != 0.0 && values.iter().enumerate().all(is_even)
}

impl Window {
    /// The two values of a cell.
    pub fn at(&self, cell: usize) -> [f64; 2] {
        let columns = self.values[1].len();
        [
            self.values[0][cell / columns],
            self.values[1][cell % columns],
        ]
    }

    /// The number of cells.
    pub fn count(&self) -> usize {
        self.values[0].len() * self.values[1].len()
    }

    /// The size of a cell; 0 along a key of one value.
    pub fn cell(&self) -> [f64; 2] {
        [0, 1].map(|axis: usize| match &self.values[axis][..] {
            [first, .., last] => (last - first).abs() / (self.values[axis].len() - 1) as f64,
            _ => 0.0,
        })
    }

    /// The parameters at two values of the two keys; derived values are computed again.
    pub fn parameters(&self, at: [f64; 2]) -> Parameters {
        let [first, second] = self.keys;
        self.base.over(|name, value| match name {
            _ if name == first => at[0],
            _ if name == second => at[1],
            _ => value,
        })
    }

    /// The case of a cell; none where its start is not legal.
    pub(crate) fn case(&self, at: [f64; 2]) -> Option<Case> {
        Case::new(self.parameters(at)).ok()
    }

    /// Refuses keys that are not numbers of a case, and values out of their ranges.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key.
    pub fn check(&self) -> Result<(), CaseError> {
        for key in self.keys {
            if !matches!(self.base.get(key), Some(Value::Number(_))) {
                let allowed = "a key that holds a number, of this body";
                return Err(CaseError::value(
                    "vary",
                    Value::Text(key.to_owned()),
                    allowed,
                ));
            }
        }
        if self.keys[0] == self.keys[1] {
            let twice = Value::Text(self.keys[0].to_owned());
            return Err(CaseError::value("vary", twice, "two different keys"));
        }
        if self.count() > MOST_CELLS {
            let cells = format!("a window of {} cells", self.count());
            let allowed = format!("at most {MOST_CELLS} cells");
            return Err(CaseError::value("vary", cells, allowed));
        }
        for (key, values) in self.keys.iter().zip(&self.values) {
            if !are_even(values) {
                let allowed = "evenly spaced values, as distances are measured in cells";
                return Err(CaseError::value(key, format!("{values:?}"), allowed));
            }
        }
        for value in &self.values[0] {
            self.parameters([*value, self.values[1][0]]).check()?;
        }
        for value in &self.values[1] {
            self.parameters([self.values[0][0], *value]).check()?;
        }
        Ok(())
    }

    /// Whether both keys are values of the start.
    pub(crate) fn are_starts(&self) -> bool {
        self.keys.iter().all(|key| STARTS.contains(key))
    }

    /// What else than the two keys keeps every start of a plane of starts away from the equilibrium,
    /// where all start values are 0: keys that are not 0. Distances from it are not those of the plane
    /// then.
    pub(crate) fn keys_off_equilibrium(&self) -> Vec<(&'static str, f64)> {
        let others = STARTS.iter().filter(|key| !self.keys.contains(key));
        let values = others.filter_map(|key| Some((*key, self.base.get(key)?.number()?)));
        values.filter(|(_, value)| *value != 0.0).collect()
    }
}

impl Basin {
    /// Runs every cell; with `trust` also its neighbours, and determines the horizons of trust.
    ///
    /// # Errors
    /// [`Unfinished`] if a key or a value is not allowed, or the work is cancelled.
    pub fn of(window: Window, trust: bool, on_progress: OnProgress) -> Result<Self, Unfinished> {
        window.check()?;
        // Progress is reported over both stages together, in runs, as far as their number is known.
        let count = window.count() as f64;
        let neighbours = if trust {
            count * NEIGHBOURS.len() as f64
        } else {
            0.0
        };
        let of = count + neighbours;
        let share =
            |progress: Progress| on_progress(Progress::new(progress.doing, progress.done, of));
        let mut cells = centres(&window, trust, &share)?;
        if trust {
            let share = |progress: Progress| {
                let done = count + neighbours * progress.done / progress.of;
                on_progress(Progress::new(progress.doing, done, of))
            };
            run_neighbours(&window, &mut cells, &share)?;
        }
        let measures = Measures::of(&window, &cells);
        Ok(Self {
            window,
            cells,
            neighbours_run: trust,
            measures,
        })
    }

    /// The impulsive integrity measure; none where both keys are velocities, each of which has its
    /// own ([`Measures::iim`]).
    pub fn iim(&self) -> Option<f64> {
        let both = self.window.keys.iter().all(|key| VELOCITIES.contains(key));
        let [first, second] = self.measures.iim;
        first.or(second).filter(|_| !both)
    }

    /// The number of cells that ended in each way.
    pub fn by_outcome(&self) -> Vec<(Stop, usize)> {
        let count = |stop: Stop| {
            let of = |cell: &&Cell| cell.end.is_some_and(|(end, _)| end == stop);
            (stop, self.cells.iter().filter(of).count())
        };
        Stop::ALL.into_iter().map(count).collect()
    }
}

impl Cell {
    /// Whether it is legal and reaches a limit.
    pub fn escapes(&self) -> bool {
        self.end.is_some_and(|(stop, _)| stop.exceeds())
    }
}

/// The runs of the cells themselves.
fn centres(window: &Window, trust: bool, on_progress: OnProgress) -> Result<Vec<Cell>, Cancelled> {
    let counter = Counter::new("cells", 0, window.count() as u64, on_progress);
    let made = on_all_threads(window.count(), |numbers| {
        run(numbers, |k| window.case(window.at(k)), trust, &counter)
    })?;
    Ok(made.into_vec())
}

/// Runs the legal cases among some numbered ones side by side.
fn run(
    numbers: &mut dyn Iterator<Item = usize>,
    case: impl Fn(usize) -> Option<Case>,
    trust: bool,
    counter: &Counter,
) -> Result<Vec<Cell>, Cancelled> {
    let mut legal = Vec::new();
    let cases = numbers.filter_map(|k| {
        let case = case(k);
        legal.push(case.is_some());
        if case.is_none() {
            // Cancellation is noticed at the next legal start.
            let _ = counter.add(1);
        }
        case
    });
    let ended = |outcome: Outcome, trusted| Cell {
        end: Some((outcome.end.reason, outcome.end.t)),
        decided: true,
        trusted,
    };
    let ended_cells: Vec<Cell> = if trust {
        let ended_cells = Certainty::with_outcomes(Lanes::best(), cases, counter)?;
        let cell = |(outcome, certainty): (Outcome, Certainty)| {
            ended(outcome, certainty.decides_the_end())
        };
        ended_cells.into_iter().map(cell).collect()
    } else {
        let ended_cells = outcomes_on_one_thread(cases, counter)?;
        ended_cells
            .into_iter()
            .map(|outcome| ended(outcome, true))
            .collect()
    };
    let mut ended_cells = ended_cells.into_iter();
    let illegal = Cell {
        end: None,
        decided: true,
        trusted: true,
    };
    let cell = |legal| {
        if legal {
            ended_cells.next()
        } else {
            Some(illegal)
        }
    };
    Ok(legal.into_iter().filter_map(cell).collect())
}

/// Runs the neighbours of the legal cells.
fn run_neighbours(
    window: &Window,
    cells: &mut [Cell],
    on_progress: OnProgress,
) -> Result<(), Cancelled> {
    let mut neighbours = Vec::new();
    for (k, cell) in cells
        .iter()
        .enumerate()
        .filter(|(_, cell)| cell.end.is_some())
    {
        let distances = if cell.trusted {
            &NEIGHBOUR_DISTANCES[..1]
        } else {
            &NEIGHBOUR_DISTANCES[..]
        };
        for distance in distances {
            neighbours.extend(NEIGHBOURS.map(|[a, b]| (k, [a * distance, b * distance])));
        }
    }
    let counter = Counter::new("their neighbours", 0, neighbours.len() as u64, on_progress);
    let made = on_all_threads(neighbours.len(), |numbers| {
        let case = |k: usize| {
            let (centre, [a, b]) = neighbours[k];
            let at = window.at(centre);
            window.case([at[0] + a, at[1] + b])
        };
        run(numbers, case, false, &counter)
    })?;
    let reason = |cell: &Cell| cell.end.map(|(stop, _)| stop);
    for (neighbour, (centre, _)) in made.iter().zip(&neighbours) {
        let centre = &mut cells[*centre];
        if neighbour.end.is_some() && reason(neighbour) != reason(centre) {
            centre.decided = false;
        }
    }
    Ok(())
}
