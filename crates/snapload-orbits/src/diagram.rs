//! Diagrams: the attractor followed along a key, where each value starts from the last state of the
//! one before.

use crate::hybrid::Point;
use crate::moored::period_of;
use crate::options::followed_key;
use crate::section::{Section, SectionOptions, start_of};
use snapload::analysis::{OnProgress, Progress, Unfinished};
use snapload::{Parameters, Stop};

/// The attractor at one value.
#[derive(Clone, Debug)]
pub struct DiagramPoint {
    /// The value of the key.
    pub value: f64,
    /// The state from which the motion started.
    pub seed: Point,
    /// Whether that was the case's own start, and not the last state of the value before.
    pub restarted: bool,
    /// Whether rounding does not decide that state: no motion was chaotic between this value and
    /// the last start of the case.
    pub seed_is_certain: bool,
    /// The section points, with facts about them.
    pub section: Section,
    /// The period in periods of the forcing, if the motion repeats itself.
    pub period: Option<usize>,
}

impl DiagramPoint {
    /// Why the motion stopped, if it did.
    pub fn stop(&self) -> Option<Stop> {
        self.section.stop
    }

    /// Whether the time at which it stopped is known in spite of rounding, in this motion and in
    /// those before, of which it began with the last state; none if it did not stop.
    pub fn stop_is_certain(&self) -> Option<bool> {
        let certain = self.section.stop_is_certain()?;
        Some(certain && self.seed_is_certain)
    }

    /// Snaps per period.
    pub fn snaps(&self) -> Option<f64> {
        self.section.snaps_per_period(self.period)
    }
}

/// Follows the attractor of a case along values of a key, in their order. If a motion stops at a
/// limit the next value starts from the case's own start again.
///
/// # Errors
/// That of [`followed_key`], as a key of the start would hold at the first value only; those of
/// [`Section::of`], at the first value; if a start is not legal at a later one, the case's
/// own start is used.
pub fn diagram(
    base: &Parameters,
    key: &str,
    values: &[f64],
    options: &SectionOptions,
    on_progress: OnProgress,
) -> Result<Vec<DiagramPoint>, Unfinished> {
    followed_key("vary", base, key)?;
    let mut found: Vec<DiagramPoint> = Vec::with_capacity(values.len());
    for (done, value) in values.iter().enumerate() {
        let here = base.over(|name, other| if name == key { *value } else { other });
        here.check()?;
        let t_start = options.phase * period_of(&here)?;
        let share = |progress: Progress| {
            let part = done as f64 + progress.done / progress.of;
            on_progress(Progress::new(
                "following the attractor",
                part,
                values.len() as f64,
            ))
        };
        let last = found.last().filter(|at| at.stop().is_none());
        let before = last.map(|at| at.section.end.0);
        let passed_on =
            last.is_none_or(|at| at.seed_is_certain && at.section.end_is_certain() == Some(true));
        let continued = before.map(|seed| {
            Section::from(&here, (t_start, &seed), options, &share).map(|section| (section, seed))
        });
        let (section, seed, restarted) = match continued {
            Some(Ok((section, seed))) => (section, seed, false),
            Some(Err(Unfinished::Cancelled(cancelled))) => return Err(cancelled.into()),
            Some(Err(Unfinished::Case(_))) | None => {
                let seed = start_of(&here);
                let section = Section::from(&here, (t_start, &seed), options, &share)?;
                (section, seed, true)
            }
        };
        let period = section.stop.is_none().then(|| section.period()).flatten();
        found.push(DiagramPoint {
            value: *value,
            seed,
            restarted,
            seed_is_certain: restarted || passed_on,
            section,
            period,
        });
    }
    Ok(found)
}
