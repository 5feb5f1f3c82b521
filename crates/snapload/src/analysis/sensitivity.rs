//! How the first impacts change with each parameter.

use crate::analysis::trust::{START_KEYS, UNCERTAIN_KEYS};
use crate::arithmetic::dual::Dual;
use crate::case::Case;

/// The quantities that an impact is told to depend on: the start and the parameters.
pub const SENSITIVE_KEYS: usize = START_KEYS.len() + UNCERTAIN_KEYS.len();

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
/// over dual numbers. Empty where the start, on the very edge of what is legal, has no neighbours.
pub fn sensitivity(case: &Case, count: usize) -> Vec<Sensitivity> {
    let keys = || START_KEYS.into_iter().chain(UNCERTAIN_KEYS);
    let lift = |key, number| {
        let place = keys().position(|name| name == key && case.parameters().moves_by(key));
        place.map_or(Dual::<f64, SENSITIVE_KEYS>::constant(number), |i| {
            Dual::variable(number, i)
        })
    };
    let Ok(mut simulation) = case.simulation_over(lift) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    while found.len() < count {
        let Some(step) = simulation.step() else { break };
        for impact in step.impacts().take(count - found.len()) {
            let slope = |(i, key)| Slope {
                key,
                t: impact.t.slope[i],
                v_n: impact.v_n.slope[i],
                impulse: impact.impulse.slope[i],
            };
            let slopes = keys()
                .enumerate()
                .filter(|(_, key)| case.parameters().moves_by(key));
            found.push(Sensitivity {
                impact: found.len() + 1,
                slopes: slopes.map(slope).collect(),
            });
        }
    }
    found
}
