//! A window of two keys, cell by cell.

use snapload::{Case, CaseError, KEYS, Key, Kind, Parameters, Stop, Value};

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
    /// Whether its neighbours end alike, and none of these runs is cut short.
    pub decided: bool,
    /// Whether the run ends before its horizon of trust.
    pub trusted: bool,
}

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
    ///
    /// # Panics
    /// If it is not below [`Window::count`].
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

    /// Refuses keys that are not numbers of a case, and values out of their ranges, or none.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key.
    pub fn check(&self) -> Result<(), CaseError> {
        for key in self.keys {
            check_varies("vary", &self.base, key)?;
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
            if values.is_empty() {
                return Err(CaseError::value(key, "no value", "one value or more"));
            }
            if !are_even(values) {
                let allowed = "evenly spaced values, as distances are measured in cells";
                return Err(CaseError::value(key, format!("{values:?}"), allowed));
            }
        }
        // Allowed values of two keys are a convex set: within it are all cells if its edges are.
        let ends = |axis: usize| {
            self.values[axis]
                .first()
                .into_iter()
                .chain(self.values[axis].last())
        };
        for second in ends(1) {
            let mut first = self.values[0].iter();
            first.try_for_each(|first| self.parameters([*first, *second]).check())?;
        }
        for first in ends(0) {
            let mut second = self.values[1].iter();
            second.try_for_each(|second| self.parameters([*first, *second]).check())?;
        }
        Ok(())
    }

    /// Whether both keys are values of the start.
    pub(crate) fn are_starts(&self) -> bool {
        self.keys.iter().all(|key| STARTS.contains(key))
    }

    /// What else than the two keys keeps every start of a plane of starts away from the
    /// equilibrium, where all start values are 0: keys that are not 0. Distances from it
    /// are not those of the plane then.
    pub(crate) fn keys_off_equilibrium(&self) -> Vec<(&'static str, f64)> {
        let others = STARTS.iter().filter(|key| !self.keys.contains(key));
        let values = others.filter_map(|key| Some((*key, self.base.get(key)?.number()?)));
        values.filter(|(_, value)| *value != 0.0).collect()
    }
}

/// Refuses a key that an option can not vary, as it holds no number of this body.
pub(crate) fn check_varies(
    option: &'static str,
    base: &Parameters,
    key: &str,
) -> Result<(), CaseError> {
    let is_number = matches!(base.get(key), Some(Value::Number(_)));
    // The height of a body may be varied from 0, where it has none to move.
    let is_of_body = !base.is_point() || base.moves_by(key);
    if is_number && is_of_body {
        return Ok(());
    }
    let varies = |key: &&Key| {
        let is_number = matches!(key.kind, Kind::Number(_));
        is_number && (!base.is_point() || base.moves_by(key.name))
    };
    let known: Vec<_> = KEYS.iter().filter(varies).map(|key| key.name).collect();
    let allowed = format!("one of {}", known.join(", "));
    let key = Value::Text(key.to_owned());
    Err(CaseError::value(option, key, allowed))
}

impl Cell {
    /// Whether it is legal and reaches a limit.
    pub fn escapes(&self) -> bool {
        self.end.is_some_and(|(stop, _)| stop.exceeds())
    }

    /// Whether it is legal and its run is cut short, so that it may yet reach a limit.
    pub fn is_cut_short(&self) -> bool {
        self.end.is_some_and(|(stop, _)| stop.cuts_short())
    }

    /// Whether it is legal and reaches no limit up to the end of time.
    pub fn is_safe(&self) -> bool {
        self.end.is_some() && !self.escapes() && !self.is_cut_short()
    }
}
