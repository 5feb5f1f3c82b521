//! The cases of a study: the axes of a grid, the sides of a box, or a list.

use crate::{Grid, List, Sobol, StudyError};
use snapload::{KEYS, Key, Kind, Value, check_entry, key_named};
use std::fmt;

/// The most cases of a study; a larger number is probably a typing error.
pub const MOST_CASES: u64 = 1_000_000_000_000;
/// How many random points may be asked for.
pub const RANDOM: Key = Key::option("random", Kind::Count(1, MOST_CASES));

/// One key of a grid, with its values.
#[derive(Clone, Debug)]
pub struct Axis {
    key: &'static str,
    values: Values,
}

#[derive(Clone, Debug)]
enum Values {
    Even(Grid),
    Listed(Vec<Value>),
}

impl Axis {
    /// An axis with evenly spaced values.
    ///
    /// # Errors
    /// [`StudyError::Case`] if there is no such key, or it can not take one of the values.
    pub fn even(key: &str, grid: Grid) -> Result<Self, StudyError> {
        let last = grid.count() - 1;
        // All values are between the ends, and all are whole numbers if the first two and the last
        // are.
        for k in [0, last.min(1), last] {
            check_entry(key, &Value::Number(grid.value(k)))?;
        }
        let (key, values) = (key_named(key)?.name, Values::Even(grid));
        Ok(Self { key, values })
    }

    /// An axis in the notation `first:last:n`.
    ///
    /// # Errors
    /// [`StudyError::Input`] if the text is no range, and as for [`Axis::even`].
    pub fn written(key: &str, text: &str) -> Result<Self, StudyError> {
        key_named(key)?;
        Self::even(key, written_grid(key, text)?)
    }

    /// An axis with listed values.
    ///
    /// # Errors
    /// [`StudyError::Case`] if there is no such key, or it can not take one of the values.
    pub fn listed(key: &str, values: Vec<Value>) -> Result<Self, StudyError> {
        for value in &values {
            check_entry(key, value)?;
        }
        let key = key_named(key)?;
        if values.is_empty() {
            let error = key
                .refuse(key.name, "[]")
                .with_hint("give at least one value");
            return Err(error.into());
        }
        let (key, values) = (key.name, Values::Listed(values));
        Ok(Self { key, values })
    }

    /// The key that varies.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// How many values there are.
    pub fn count(&self) -> u64 {
        match &self.values {
            Values::Even(grid) => grid.count(),
            Values::Listed(values) => values.len() as u64,
        }
    }

    /// The k-th value, from 0.
    pub fn value(&self, k: u64) -> Value {
        match &self.values {
            Values::Even(grid) => Value::Number(grid.value(k)),
            Values::Listed(values) => values[k as usize].clone(),
        }
    }
}

impl fmt::Display for Axis {
    /// In the notation of a study file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.values {
            Values::Even(grid) => write!(f, "\"{grid}\""),
            Values::Listed(values) => {
                let all: Vec<String> = values.iter().map(Value::to_string).collect();
                write!(f, "[{}]", all.join(", "))
            }
        }
    }
}

/// The notation of a grid, and of a range of random values.
const GRID_FORM: &str = "first:last:n for n evenly spaced values, such as 0.01:0.6:60";
const RANGE_FORM: &str = "low:high for the side of a box, such as 0.05:0.6";

/// The values of a range in the notation `first:last:n`; the key, which need not be one of a case,
/// is only named in errors.
///
/// # Errors
/// [`StudyError::Input`] if the text is no range.
pub fn written_grid(key: &str, text: &str) -> Result<Grid, StudyError> {
    let wrong = |what: &str| wrong_range(key, text, what, GRID_FORM);
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [first, last, count] = parts[..] else {
        return Err(wrong("three numbers are needed"));
    };
    let count = count.parse().ok().filter(|n| *n >= 1);
    let count = count.ok_or_else(|| wrong("n must be a whole number, 1 or more"))?;
    Grid::new(first, last, count).ok_or_else(|| {
        let first_is_right = Grid::new(first, first, 1).is_some();
        let text = if first_is_right { last } else { first };
        wrong(&format!("{text:?} is not a number"))
    })
}

/// The error of a wrong range for a key, with the notation that is allowed.
fn wrong_range(key: &str, text: &str, what: &str, form: &str) -> StudyError {
    StudyError::Input(format!("{key} = {text:?}: {what}; write {form}"))
}

/// Whether a key takes every number of a range, so that it can be drawn at random.
fn is_drawn(key: &Key) -> bool {
    matches!(key.kind, Kind::Number(_))
}

/// How many keys can be drawn at random.
fn most_ranges() -> usize {
    KEYS.iter().filter(|key| is_drawn(key)).count()
}

/// The range of one key of random points, a side of their box.
#[derive(Clone, Debug)]
pub struct RandomRange {
    key: &'static str,
    low: f64,
    high: f64,
}

impl RandomRange {
    /// The half-open range [low, high).
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is no such key, if it does not accept every number of a
    /// range, or if it can not take one of the two.
    pub fn new(key: &str, low: f64, high: f64) -> Result<Self, StudyError> {
        Self::is_possible(key)?;
        check_entry(key, &Value::Number(low))?;
        let key = check_entry(key, &Value::Number(high))?.name;
        Ok(Self { key, low, high })
    }

    /// An error unless a key can be drawn at random.
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is no such key, or if it does not accept every number of a
    /// range.
    pub fn is_possible(key: &str) -> Result<(), StudyError> {
        let key = key_named(key)?;
        if is_drawn(key) {
            return Ok(());
        }
        let key = key.name;
        Err(StudyError::Input(format!(
            "{key} can not be drawn at random, as it takes no fractions; vary it over a grid"
        )))
    }

    /// A range in the notation `low:high`. A number of values, as for a grid, may follow after
    /// another colon; it has no effect here.
    ///
    /// # Errors
    /// [`StudyError::Input`] if the text is no range, and as for [`RandomRange::new`].
    pub fn written(key: &str, text: &str) -> Result<Self, StudyError> {
        key_named(key)?;
        let ends: Vec<&str> = text.split(':').map(str::trim).collect();
        let number = |end: &str| {
            let number = end.parse().ok().filter(|n: &f64| n.is_finite());
            number.ok_or_else(|| wrong_range(key, end, "not a number", RANGE_FORM))
        };
        match ends[..] {
            [low, high] => Self::new(key, number(low)?, number(high)?),
            [low, high, count] if count.parse().is_ok_and(|n: u64| n >= 1) => {
                Self::new(key, number(low)?, number(high)?)
            }
            [_, _, count] => {
                let what = format!("{count:?} is not a number of values");
                Err(wrong_range(key, text, &what, RANGE_FORM))
            }
            _ => Err(wrong_range(key, text, "two numbers are needed", RANGE_FORM)),
        }
    }

    /// The key that varies.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Its two ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn at(&self, part: f64) -> Value {
        Value::Number(self.low + part * (self.high - self.low))
    }
}

impl fmt::Display for RandomRange {
    /// In the notation of a study file, without its quotes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}:{}",
            Value::Number(self.low),
            Value::Number(self.high)
        )
    }
}

/// The cases of a study.
#[derive(Debug)]
pub enum Plan {
    /// Every combination of the axes' values; the first axis is the slowest.
    Grid(Vec<Axis>),
    /// Sobol points in a box.
    Random {
        /// The ranges of the box.
        ranges: Vec<RandomRange>,
        /// The points.
        points: Sobol,
        /// The number of points.
        count: u64,
        /// The seed of the scrambling.
        seed: u64,
    },
    /// The rows of a file.
    List(List),
}

impl Plan {
    /// A grid.
    ///
    /// # Errors
    /// [`StudyError::Input`] for a key with two axes, and for too many cases.
    pub fn grid(axes: Vec<Axis>) -> Result<Self, StudyError> {
        check_distinct(axes.iter().map(Axis::key))?;
        let counts = axes.iter().map(Axis::count);
        let count = counts.fold(1_u64, u64::saturating_mul);
        check_count(count)?;
        Ok(Self::Grid(axes))
    }

    /// Random points.
    ///
    /// # Errors
    /// [`StudyError::NoRandomRange`] if there is no range, and [`StudyError::Input`] for a key with
    /// two ranges, and for no points or too many.
    pub fn random(ranges: Vec<RandomRange>, count: u64, seed: u64) -> Result<Self, StudyError> {
        check_distinct(ranges.iter().map(RandomRange::key))?;
        let points = Sobol::new(ranges.len(), seed)
            .ok_or_else(|| StudyError::NoRandomRange(most_ranges()))?;
        check_count(count)?;
        Ok(Self::Random {
            ranges,
            points,
            count,
            seed,
        })
    }

    /// How many cases.
    pub fn count(&self) -> u64 {
        match self {
            Self::Grid(axes) => axes.iter().map(Axis::count).product(),
            Self::Random { count, .. } => *count,
            Self::List(list) => list.count(),
        }
    }

    /// The varying keys of case `index` of a grid or box, with their values.
    pub(crate) fn entries(&self, index: u64) -> Vec<(&'static str, Value)> {
        match self {
            Self::Grid(axes) => {
                let mut rest = index;
                let mut entries: Vec<_> = axes
                    .iter()
                    .rev()
                    .map(|axis| {
                        let value = axis.value(rest % axis.count());
                        rest /= axis.count();
                        (axis.key, value)
                    })
                    .collect();
                entries.reverse();
                entries
            }
            Self::Random { ranges, points, .. } => ranges
                .iter()
                .enumerate()
                .map(|(d, range)| (range.key, range.at(points.coordinate(index, d))))
                .collect(),
            Self::List(_) => Vec::new(),
        }
    }
}

/// Checks that no key varies twice.
fn check_distinct(keys: impl Iterator<Item = &'static str>) -> Result<(), StudyError> {
    let mut seen: Vec<&str> = Vec::new();
    for key in keys {
        if seen.contains(&key) {
            let words = format!("{key} varies twice; give all its values at once");
            return Err(StudyError::Input(words));
        }
        seen.push(key);
    }
    Ok(())
}

/// Checks that a study has a case, and not too many.
fn check_count(count: u64) -> Result<(), StudyError> {
    if (1..=MOST_CASES).contains(&count) {
        return Ok(());
    }
    Err(StudyError::Input(format!(
        "{count} cases are not allowed; allowed: from 1 to {MOST_CASES:e}; vary fewer values of a key, or use \
         another number of points"
    )))
}

#[cfg(test)]
mod tests {
    use super::most_ranges;
    use crate::Sobol;

    /// So that no ranges at all is the only number that a box can not have.
    #[test]
    fn there_are_points_for_all_keys_that_can_be_drawn() {
        assert!((1..=Sobol::MOST).contains(&most_ranges()));
    }
}
