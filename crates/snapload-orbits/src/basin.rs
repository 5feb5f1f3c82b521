//! Safe basins: the starts, or the values of any two keys, for which a body stays below its limits.
//!
//! J. M. T. Thompson, *Proc. R. Soc. A* 421 (1989) 195; M. S. Soliman & J. M. T. Thompson, *J.
//! Sound Vib.* 135 (1989) 453; G. Rega & S. Lenci, *Nonlinear Anal.* 63 (2005) 902.

use crate::measures::{Measures, VELOCITIES};
use crate::window::{Cell, Window};
use snapload::analysis::{
    Cancelled, Certainty, Counter, OnProgress, Progress, Unfinished, on_all_threads,
    outcomes_on_one_thread,
};
use snapload::{Case, Lanes, Outcome, Stop};

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

/// The values of the two keys of a cell's neighbours, which must end as the cell does if that is
/// decided: at a small distance, and at smaller ones, too, unless the cell is trusted.
pub(crate) fn neighbours_of(at: [f64; 2], trusted: bool) -> impl Iterator<Item = [f64; 2]> {
    let distances = match trusted {
        true => &NEIGHBOUR_DISTANCES[..1],
        false => &NEIGHBOUR_DISTANCES[..],
    };
    let about = move |distance: &f64| {
        let distance = *distance;
        NEIGHBOURS.map(|[a, b]| [at[0] + a * distance, at[1] + b * distance])
    };
    distances.iter().flat_map(about)
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
        let measures = Measures::of(&window, &cells, trust);
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
        self.only_velocity(self.measures.iim)
    }

    /// The same where undecided cells count as unsafe.
    pub fn iim_at_least(&self) -> Option<f64> {
        self.only_velocity(self.measures.at_least.iim)
    }

    fn only_velocity(&self, [first, second]: [Option<f64>; 2]) -> Option<f64> {
        let both = self.window.keys.iter().all(|key| VELOCITIES.contains(key));
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
        decided: !outcome.end.reason.cuts_short(),
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
    let mut neighbours: Vec<(usize, [f64; 2])> = Vec::new();
    for (k, cell) in cells
        .iter()
        .enumerate()
        .filter(|(_, cell)| cell.end.is_some())
    {
        neighbours.extend(neighbours_of(window.at(k), cell.trusted).map(|at| (k, at)));
    }
    let counter = Counter::new("their neighbours", 0, neighbours.len() as u64, on_progress);
    let made = on_all_threads(neighbours.len(), |numbers| {
        let case = |k: usize| window.case(neighbours[k].1);
        run(numbers, case, false, &counter)
    })?;
    for (neighbour, (centre, _)) in made.iter().zip(&neighbours) {
        let centre = &mut cells[*centre];
        let answer = |cell: &Cell| (cell.is_safe(), cell.is_cut_short());
        if neighbour.end.is_some() && answer(neighbour) != answer(centre) {
            centre.decided = false;
        }
    }
    Ok(())
}
