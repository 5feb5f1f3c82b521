//! When a run stops.

use crate::arithmetic::real::Real;

/// The stop rules, each on or off (docs/model.md section 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopRules<T = f64> {
    /// Stop when |θ| reaches this angle \[rad\].
    pub rotation_limit: Option<T>,
    /// Stop when the highest point of the body reaches this level \[L\].
    pub upper_bound: Option<T>,
    /// Stop when a cable sticks, or two are taut, while y is below this height \[L\].
    pub settled_below: Option<T>,
    /// Stop when a cable sticks at or above this height \[L\].
    pub sliding_above: Option<T>,
    /// Stop at this time \[T\].
    pub t_end: T,
    /// Stop after more impacts than this.
    pub max_impacts: u64,
}

impl<T: Real> StopRules<T> {
    /// Every rule off but the end of time.
    pub fn until(t_end: T) -> Self {
        Self {
            rotation_limit: None,
            upper_bound: None,
            settled_below: None,
            sliding_above: None,
            t_end,
            max_impacts: u64::MAX,
        }
    }
}
