//! Erosion of safe basins: how much of a window is safe as a third key changes.

use crate::basin::{Basin, Measures, Window};
use snapload::analysis::{OnProgress, Progress, Unfinished};
use snapload::{CaseError, Value};

/// Safe basins for values of a key.
#[derive(Clone, Debug)]
pub struct Erosion {
    /// The key.
    pub key: &'static str,
    /// Its values, each with its basin.
    pub points: Vec<(f64, Basin)>,
}

/// What of the first value's safe part is left at the knee.
pub const KNEE: f64 = 0.9;

impl Erosion {
    /// Runs the window at each value.
    ///
    /// # Errors
    /// As for [`Basin::of`].
    pub fn of(
        window: &Window,
        key: &'static str,
        values: &[f64],
        trust: bool,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        if window.keys.contains(&key) {
            let error = CaseError::value("over", Value::Text(key.to_owned()), "a key not varied");
            return Err(error.into());
        }
        let mut points = Vec::with_capacity(values.len());
        for (done, value) in values.iter().enumerate() {
            let base = window
                .base
                .over(|name, other| if name == key { *value } else { other });
            base.check()?;
            let here = Window {
                base,
                ..window.clone()
            };
            let share = |progress: Progress| {
                let part = progress.done / progress.of;
                on_progress(Progress::new(
                    "erosion",
                    done as f64 + part,
                    values.len() as f64,
                ))
            };
            points.push((*value, Basin::of(here, trust, &share)?));
        }
        Ok(Self { key, points })
    }

    /// The last value up to which the safe part of the decided cells never falls below nine tenths of
    /// what it is at the first value; none where it never does fall below.
    ///
    /// Cells that are not decided are left out, as how they end says nothing: where starts are
    /// symmetric they are many, and all at one value.
    pub fn knee(&self) -> Option<f64> {
        self.knee_of(|m| {
            let decided = (m.safe - m.undecided_safe) as f64 / (m.legal - m.undecided) as f64;
            [decided; 2]
        })
    }

    /// The least and the greatest value that the knee has, however the cells that are not decided
    /// end; none where there is none then.
    pub fn knee_between(&self) -> [Option<f64>; 2] {
        let part = |cells: usize, m: &Measures| cells as f64 / m.legal as f64;
        let low = |m: &Measures| part(m.safe - m.undecided_safe, m);
        let high = |m: &Measures| part(m.safe + m.undecided - m.undecided_safe, m);
        [
            self.knee_of(|m| [high(m), low(m)]),
            self.knee_of(|m| [low(m), high(m)]),
        ]
    }

    /// The knee, with the safe part of a window as the whole and as what is left of it.
    fn knee_of(&self, parts: impl Fn(&Measures) -> [f64; 2]) -> Option<f64> {
        let mut points = self.points.iter();
        let (first, basin) = points.next()?;
        let [whole, _] = parts(&basin.measures);
        let mut last = *first;
        for (value, basin) in points {
            let [_, left] = parts(&basin.measures);
            if left < KNEE * whole {
                return Some(last);
            }
            last = *value;
        }
        None
    }
}
