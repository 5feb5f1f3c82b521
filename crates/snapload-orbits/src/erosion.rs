//! Erosion of safe basins: how much of a window is safe as a third key changes.

use crate::basin::{Basin, Window};
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

/// The part of the first value's safe fraction that is left at the knee.
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

    /// The last value up to which the safe part never falls below nine tenths of what it is at the
    /// first value; none where it never does fall below.
    pub fn knee(&self) -> Option<f64> {
        let part = |basin: &Basin| basin.measures.gim;
        let whole = part(&self.points.first()?.1);
        let fallen = self
            .points
            .iter()
            .position(|(_, basin)| part(basin) < KNEE * whole)?;
        let before = self.points.get(fallen.checked_sub(1)?)?;
        Some(before.0)
    }
}
