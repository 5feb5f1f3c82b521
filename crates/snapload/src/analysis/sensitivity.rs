//! How the first impacts change with each parameter.

use crate::analysis::trust::{START_KEYS, UNCERTAIN_KEYS};
use crate::arithmetic::dual::Dual;
use crate::case::Case;

/// Derivatives of one impact by one key, all else held; the inertia follows the size where it is
/// the natural one.
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
/// over dual numbers, once for each key. Empty where the start, on the very edge of what is legal,
/// has no neighbours.
pub fn sensitivity(case: &Case, count: usize) -> Vec<Sensitivity> {
    let keys = START_KEYS.into_iter().chain(UNCERTAIN_KEYS);
    let mut found = Vec::new();
    for key in keys.filter(|key| case.parameters().moves_by(key)) {
        let Some(slopes) = slopes_by(case, key, count) else {
            return Vec::new();
        };
        found.resize_with(slopes.len(), Vec::new);
        for (impact, slope) in found.iter_mut().zip(slopes) {
            impact.push(slope);
        }
    }
    let numbered = found.into_iter().zip(1..);
    numbered
        .map(|(slopes, impact)| Sensitivity { impact, slopes })
        .collect()
}

/// The derivatives of the first impacts by one key; none where the start has no neighbours.
fn slopes_by(case: &Case, key: &'static str, count: usize) -> Option<Vec<Slope>> {
    let lift = |name, number| match name == key {
        true => Dual::<f64, 1>::variable(number, 0),
        false => Dual::constant(number),
    };
    let mut simulation = case.simulation_over(lift).ok()?;
    let mut slopes = Vec::new();
    while slopes.len() < count {
        let Some(step) = simulation.step() else { break };
        slopes.extend(step.impacts().map(|impact| Slope {
            key,
            t: impact.t.slope[0],
            v_n: impact.v_n.slope[0],
            impulse: impact.impulse.slope[0],
        }));
    }
    slopes.truncate(count);
    Some(slopes)
}
