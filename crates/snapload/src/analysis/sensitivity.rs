//! How the first impacts change with each parameter.

use crate::analysis::progress::{Cancelled, OnProgress, Progress};
use crate::analysis::trust::{START_KEYS, UNCERTAIN_KEYS};
use crate::arithmetic::dual::Dual;
use crate::case::Case;

/// Derivatives of one impact by one key, with all other keys fixed; the inertia follows the size if
/// it is the natural one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The key.
    pub key: &'static str,
    /// Of the time.
    pub t: f64,
    /// Of the normal velocity v_n⁻.
    pub v_n: f64,
    /// Of the impulse.
    pub impulse: f64,
}

/// An impact and its derivatives by every key that the motion depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The number of the impact, from 1.
    pub impact: usize,
    /// By key.
    pub slopes: Vec<Slope>,
}

/// The derivatives of the first `count` impacts of a case, exact to rounding: the motion is run
/// over dual numbers, once for each key. Empty if the start, at the very edge of what is
/// legal, is not legal over dual numbers.
///
/// # Errors
/// [`Cancelled`] if it is to end before.
pub fn sensitivity(
    case: &Case,
    count: usize,
    on_progress: OnProgress,
) -> Result<Vec<Sensitivity>, Cancelled> {
    let keys = START_KEYS.into_iter().chain(UNCERTAIN_KEYS);
    let keys: Vec<_> = keys.filter(|key| case.parameters().moves_by(key)).collect();
    let mut found = Vec::new();
    for (done, key) in keys.iter().enumerate() {
        let progress = Progress::new("derivatives", done as f64, keys.len() as f64);
        let Some(slopes) = slopes_by(case, key, count, &|| progress.report(on_progress))? else {
            return Ok(Vec::new());
        };
        found.resize_with(slopes.len(), Vec::new);
        for (impact, slope) in found.iter_mut().zip(slopes) {
            impact.push(slope);
        }
    }
    let numbered = found.into_iter().zip(1..);
    let numbered = numbered.map(|(slopes, impact)| Sensitivity { impact, slopes });
    Ok(numbered.collect())
}

/// The derivatives of the first impacts by one key; none where the start is not legal over dual
/// numbers. Asks after every step whether to continue.
fn slopes_by(
    case: &Case,
    key: &'static str,
    count: usize,
    should_continue: &dyn Fn() -> Result<(), Cancelled>,
) -> Result<Option<Vec<Slope>>, Cancelled> {
    let lift = |name, number| match name == key {
        true => Dual::<f64, 1>::variable(number, 0),
        false => Dual::constant(number),
    };
    let Ok(mut simulation) = case.simulation_over(lift) else {
        return Ok(None);
    };
    let mut slopes = Vec::new();
    while slopes.len() < count {
        should_continue()?;
        let Some(step) = simulation.step() else { break };
        slopes.extend(step.impacts().map(|impact| Slope {
            key,
            t: impact.t.slope[0],
            v_n: impact.v_n.slope[0],
            impulse: impact.impulse.slope[0],
        }));
    }
    slopes.truncate(count);
    Ok(Some(slopes))
}
