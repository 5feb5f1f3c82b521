//! Measures of the safe part of a window.

use crate::distances::squared_distances;
use crate::window::{Cell, Window};
use snapload::analysis::Share;

/// Measures of the safe part of a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Cells that are legal.
    pub legal: usize,
    /// Legal cells that reach no limit up to the end of time.
    pub safe: usize,
    /// Legal cells that are safe where a neighbour is not, or the other way round, and those whose
    /// run is cut short.
    pub undecided: usize,
    /// Undecided cells that count as safe.
    pub undecided_safe: usize,
    /// Legal cells whose run is cut short ([`snapload::Stop::cuts_short`]): they count neither as
    /// safe nor as unsafe.
    pub cut_short: usize,
    /// Legal cells whose run has its horizon of trust before its end. Those among them that count
    /// as decided were compared with more neighbours.
    pub past_horizon: usize,
    /// The part of the legal cells that is safe: the global integrity measure.
    pub gim: f64,
    /// Wilson's interval of 95 % about it, wherever the cells that are cut short belong.
    pub interval: [f64; 2],
    /// The least distance from the equilibrium to an unsafe cell: the local integrity measure. None
    /// in a plane that does not hold the equilibrium, and where legal starts that were not run to
    /// their end are nearer: those beyond the border of the window, and those cut short.
    pub lim: Option<f64>,
    /// The distance of the nearest unsafe cell, where such starts are nearer.
    pub lim_at_most: Option<f64>,
    /// The radius of the largest disc in the window without unsafe cells: the integrity factor.
    pub integrity_factor: Option<f64>,
    /// Whether starts that were not run to their end make it smaller than unsafe cells alone do.
    pub disc_meets_unknown: bool,
    /// The least unsafe velocity along either key in the row of the equilibrium: the impulsive
    /// integrity measure. None for other keys, and where there is no such row, or smaller
    /// velocities were not run to their end.
    pub iim: [Option<f64>; 2],
    /// The three distances where undecided cells count as unsafe; none if no neighbours were run.
    pub at_least: Distances,
}

/// The distances of a plane of starts; none where the measure is not known either.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distances {
    /// [`Measures::lim`].
    pub lim: Option<f64>,
    /// [`Measures::integrity_factor`].
    pub integrity_factor: Option<f64>,
    /// [`Measures::iim`].
    pub iim: [Option<f64>; 2],
}

pub(crate) const VELOCITIES: [&str; 3] = ["vx", "vy", "vtheta"];
/// A value counts as within half a cell up to this part of it, as decimals are rounded.
const ROUNDED: f64 = 1.0 + 1e-9;

impl Measures {
    /// Of the cells of a window, whose neighbours were run or not.
    pub(crate) fn of(window: &Window, cells: &[Cell], neighbours_run: bool) -> Self {
        let legal = cells.iter().filter(|cell| cell.end.is_some()).count();
        let safe = cells.iter().filter(|cell| cell.is_safe()).count();
        let cut_short = cells.iter().filter(|cell| cell.is_cut_short()).count();
        let undecided = cells.iter().filter(|cell| !cell.decided).count();
        let undecided_cells = cells.iter().filter(|cell| !cell.decided);
        let undecided_safe = undecided_cells.filter(|cell| cell.is_safe()).count();
        let past_horizon = cells.iter().filter(|cell| !cell.trusted).count();
        let share = |count| Share {
            count,
            of: legal,
            clear: false,
        };
        let measures = Self {
            legal,
            safe,
            undecided,
            undecided_safe,
            cut_short,
            past_horizon,
            gim: share(safe).part(),
            interval: [
                share(safe).interval()[0],
                share(safe + cut_short).interval()[1],
            ],
            lim: None,
            lim_at_most: None,
            integrity_factor: None,
            disc_meets_unknown: false,
            iim: [None; 2],
            at_least: Distances::default(),
        };
        if !window.are_starts() {
            return measures;
        }
        let measures = measures.with_distances(window, &Framed::new(window, cells, false));
        match neighbours_run {
            true => measures.with_least_distances(window, &Framed::new(window, cells, true)),
            false => measures,
        }
    }

    /// The safe part of the decided cells, if there are any.
    pub fn decided_part(&self) -> Option<f64> {
        let part = (self.safe - self.undecided_safe) as f64 / (self.legal - self.undecided) as f64;
        (self.legal > self.undecided).then_some(part)
    }

    /// The same with distances, in a plane of starts.
    fn with_distances(mut self, window: &Window, framed: &Framed) -> Self {
        let [disc, within_unsafe] = [true, false].map(|known| framed.largest_disc(known));
        self.integrity_factor = disc.filter(|radius| radius.is_finite());
        self.disc_meets_unknown = disc < within_unsafe;
        if window.keys_off_equilibrium().is_empty() {
            let nearest = framed.nearest_unsafe(|[a, b]| Some(a.hypot(b)));
            let is_plane = framed.cell.iter().all(|width| *width > 0.0);
            (self.lim, self.lim_at_most) = match nearest {
                Some((distance, true)) if is_plane => (Some(distance), None),
                nearest => (None, nearest.map(|(distance, _)| distance)),
            };
            self.iim = [0, 1].map(|axis| framed.nearest_along_velocity(window, axis));
        }
        self
    }

    /// The same with the distances of cells of which undecided ones are framed as unsafe.
    fn with_least_distances(mut self, window: &Window, cautious: &Framed) -> Self {
        let disc = cautious
            .largest_disc(true)
            .filter(|radius| radius.is_finite());
        let nearest = cautious.nearest_unsafe(|[a, b]| Some(a.hypot(b)));
        let along = |axis: usize| cautious.nearest_along_velocity(window, axis);
        self.at_least = Distances {
            lim: self.lim.and(nearest.map(|(distance, _)| distance)),
            // Where every safe cell is undecided there is no disc.
            integrity_factor: self.integrity_factor.and(disc.or(Some(0.0))),
            iim: [0, 1].map(|axis| self.iim[axis].and_then(|_| along(axis))),
        };
        self
    }
}

/// What is known of a start.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    Safe,
    Unsafe,
    /// Legal, but its run was cut short.
    CutShort,
    /// Legal, but beyond the border of the window, so that it was not run.
    Beyond,
    Illegal,
}

impl Start {
    /// Whether it is not known if it is safe.
    fn is_unknown(self) -> bool {
        matches!(self, Self::CutShort | Self::Beyond)
    }
}

/// The cells of a window with a frame of cells round them, which are unknown where they are legal.
///
/// Legal starts are a convex set, as far as the cables' lengths and the bounds are: whatever lies
/// beyond the frame is reached from within the window through a cell of it. So one row of cells
/// is enough.
struct Framed {
    values: [Vec<f64>; 2],
    cell: [f64; 2],
    starts: Vec<Start>,
}

impl Framed {
    /// Undecided cells count as unsafe if `cautious`.
    fn new(window: &Window, cells: &[Cell], cautious: bool) -> Self {
        let values = window.values.each_ref().map(|values| framed(values));
        let sizes = window.values.each_ref().map(Vec::len);
        // A cell of the frame is legal if its outer edge is: what is less than a cell wide beyond
        // the border, such as a row in which a cable is exactly taut, is below the accuracy.
        let outer = |axis: usize, k: usize| {
            let value = |k: usize| values[axis][k];
            match k {
                _ if values[axis].len() == sizes[axis] => value(k),
                0 => value(0) - 0.5 * (value(1) - value(0)),
                _ if k > sizes[axis] => value(k) + 0.5 * (value(k) - value(k - 1)),
                _ => value(k),
            }
        };
        let start = |i: usize, j: usize| {
            let place = |k: usize, axis: usize| match values[axis].len() == sizes[axis] {
                true => Some(k),
                false => k.checked_sub(1).filter(|k| *k < sizes[axis]),
            };
            let inner = place(i, 0).zip(place(j, 1));
            let run = inner.map(|(i, j)| &cells[i * sizes[1] + j]);
            match run {
                Some(cell) if cell.escapes() || cautious && !cell.decided => Start::Unsafe,
                Some(cell) if cell.is_safe() => Start::Safe,
                Some(cell) if cell.is_cut_short() => Start::CutShort,
                None if window.case([outer(0, i), outer(1, j)]).is_some() => Start::Beyond,
                _ => Start::Illegal,
            }
        };
        let columns = values[1].len();
        let all = 0..values[0].len() * columns;
        Self {
            starts: all.map(|k| start(k / columns, k % columns)).collect(),
            cell: window.cell(),
            values,
        }
    }

    fn at(&self, k: usize) -> [f64; 2] {
        let columns = self.values[1].len();
        [self.values[0][k / columns], self.values[1][k % columns]]
    }

    /// Whether a value is that of the equilibrium, 0, to half a cell.
    fn is_at_equilibrium(&self, axis: usize, value: f64) -> bool {
        value.abs() <= 0.5 * self.cell[axis] * ROUNDED
    }

    /// The least distance from the equilibrium to an unsafe start, and whether no unknown start is
    /// nearer. Starts without a distance are left out. The cell of the equilibrium itself may be
    /// one beyond the border, as distances are good to one cell.
    fn nearest_unsafe(&self, distance: impl Fn([f64; 2]) -> Option<f64>) -> Option<(f64, bool)> {
        let own = |at: [f64; 2]| [0, 1].iter().all(|i| self.is_at_equilibrium(*i, at[*i]));
        let least = |is_such: &dyn Fn(Start) -> bool| {
            let starts = self.starts.iter().enumerate();
            let such = starts.filter(|(_, start)| is_such(**start));
            let at = such.map(|(k, start)| (self.at(k), *start));
            at.filter(|(at, start)| *start != Start::Beyond || !own(*at))
                .filter_map(|(at, _)| distance(at))
                .min_by(f64::total_cmp)
        };
        let nearest = least(&|start| start == Start::Unsafe)?;
        let holds = |axis: usize| {
            let values = &self.values[axis];
            values
                .iter()
                .any(|value| self.is_at_equilibrium(axis, *value))
        };
        let known = least(&Start::is_unknown).is_none_or(|unknown| nearest <= unknown);
        Some((nearest, known && holds(0) && holds(1)))
    }

    /// The largest distance of a safe start from the nearest unsafe one, or unknown one if the disc
    /// must hold only starts that were run; none without a safe start or in a single row of cells.
    fn largest_disc(&self, known: bool) -> Option<f64> {
        if self.cell.contains(&0.0) {
            return None;
        }
        let limits = |start: &Start| *start == Start::Unsafe || known && start.is_unknown();
        let marked: Vec<bool> = self.starts.iter().map(limits).collect();
        let squares = squared_distances(&marked, self.values.each_ref().map(Vec::len), self.cell);
        let safe = self.starts.iter().zip(&squares);
        safe.filter(|(start, _)| **start == Start::Safe)
            .map(|(_, square)| square.sqrt())
            .max_by(f64::total_cmp)
    }

    /// The least unsafe velocity in the row of cells of the equilibrium; none if the key is no
    /// velocity, there is no such row, or a smaller one is unknown.
    fn nearest_along_velocity(&self, window: &Window, axis: usize) -> Option<f64> {
        let other = 1 - axis;
        let magnitudes = window.values[other].iter().map(|value| value.abs());
        let row = magnitudes.min_by(f64::total_cmp)?;
        if !VELOCITIES.contains(&window.keys[axis]) || !self.is_at_equilibrium(other, row) {
            return None;
        }
        let in_row = |at: [f64; 2]| (at[other].abs() == row).then(|| at[axis].abs());
        let (nearest, known) = self.nearest_unsafe(in_row)?;
        known.then_some(nearest)
    }
}

/// Evenly spaced values, with one more at either end; a single one stays alone.
fn framed(values: &[f64]) -> Vec<f64> {
    let [first, .., last] = values else {
        return values.to_vec();
    };
    let step = (last - first) / (values.len() - 1) as f64;
    let mut all = vec![first - step];
    all.extend(values);
    all.push(last + step);
    all
}
