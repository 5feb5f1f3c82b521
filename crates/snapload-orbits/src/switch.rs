//! From a period doubling to the branch of orbits of twice the length.

use crate::branch_events::BranchEvent;
use crate::continuation::{Continuation, Unknowns};
use crate::hybrid::Family;
use nalgebra::DVector;

/// The repeated lap at a doubling, and the direction of the branch that begins there.
///
/// At the doubling the equations of the double lap have two null directions: that of the orbit
/// itself, and one along which the two laps differ. The second one does not change the parameter.
pub(crate) fn doubled<'a, F: Family>(
    family: &'a F,
    event: &BranchEvent,
) -> Option<(Continuation<'a, F>, Unknowns, DVector<f64>)> {
    let orbit = &event.orbit;
    let mut sequence = orbit.lap.sequence.clone();
    let once = sequence.events.clone();
    sequence.events.extend(once);
    let mut durations = orbit.lap.durations.clone();
    let rest = orbit.length - durations.iter().sum::<f64>();
    let again = durations.clone();
    durations.extend(again);
    let events = orbit.lap.durations.len();
    if let Some(first) = durations.get_mut(events) {
        *first += rest;
    }
    let continuation = Continuation {
        family,
        sequence,
        phase: orbit.phase,
        periods: 2 * orbit.periods,
    };
    let start = Unknowns {
        z: orbit.z,
        durations,
        at: orbit.at,
    };
    let (_, jacobian) = continuation.equations(&start, 1);
    let squares = jacobian.transpose() * &jacobian;
    let eigen = squares.symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let [first, second] = [*order.first()?, *order.get(1)?];
    let [a, b] = [first, second].map(|k| eigen.eigenvectors.column(k).into_owned());
    let last = a.len() - 1;
    let apart = &a * b[last] - &b * a[last];
    let length = apart.norm();
    (length > 0.0).then(|| (continuation, start, apart / length))
}
