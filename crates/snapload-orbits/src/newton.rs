//! Newton's method on the composed map.

use crate::hybrid::{Family, Point};
use crate::lap::Lap;
use crate::sequence::Sequence;
use nalgebra::DVector;

/// The most steps of Newton's method.
const MOST_STEPS: usize = 25;
/// The largest change of a component of the state in one step.
const LONGEST_STEP: f64 = 0.15;
/// The longest duration in laps: a step of Newton's method that asks for more has diverged, and to
/// follow a taut motion that far would take too long.
const LAPS: f64 = 2.0;
/// A step below this part of what it changes is only rounding.
const DONE: f64 = 4e-15;
/// A lap counts as closed if its residual is below this.
const CLOSED: f64 = 1e-11;

/// A point that closes the composed map.
#[derive(Clone, Debug)]
pub struct Closed {
    /// The state at the section.
    pub z: Point,
    /// The time from event to event.
    pub durations: Vec<f64>,
    /// The largest remaining residual.
    pub residual: f64,
}

/// Solves F(z, s) = 0 from a guess; none if the iteration does not converge.
pub fn close<F: Family>(lap: &Lap<F>, z: &Point, durations: &[f64]) -> Option<Closed> {
    let variables = lap.family.variables();
    let (mut z, mut durations) = (*z, durations.to_vec());
    let mut best: Option<Closed> = None;
    let mut before = f64::INFINITY;
    let (_, length) = lap.times();
    for _ in 0..MOST_STEPS {
        let (size, step) = lap.linearise(&z, &durations).step(&z, variables);
        if !size.is_finite() {
            return best;
        }
        if size < best.as_ref().map_or(CLOSED, |best| best.residual) {
            best = Some(Closed {
                z,
                durations: durations.clone(),
                residual: size,
            });
        }
        let Some(step) = step else {
            return best;
        };
        let moved = step.rows(0, variables.len()).amax();
        if !step.iter().all(|part| part.is_finite()) {
            return best;
        }
        let scale = (LONGEST_STEP / moved).min(1.0);
        add(&mut z, &mut durations, variables, &(&step * scale));
        if durations.iter().any(|s| s.abs() > LAPS * length) {
            return best;
        }
        // Near the solution the steps decrease until they are only rounding.
        if best.is_some() && (moved < DONE || moved >= 0.5 * before) {
            break;
        }
        before = moved;
    }
    best
}

/// Adds a step of the unknowns.
pub(crate) fn add(z: &mut Point, durations: &mut [f64], variables: &[usize], step: &DVector<f64>) {
    for (part, &i) in step.iter().zip(variables) {
        z[i] += part;
    }
    for (duration, part) in durations.iter_mut().zip(step.iter().skip(variables.len())) {
        *duration += part;
    }
}

/// One step z + (1 − M)⁻¹ (P z − z), no longer than [`LONGEST_STEP`], from a simulated lap.
pub(crate) fn step_of_map<F: Family>(
    family: &F,
    at: [f64; 2],
    sequence: &Sequence,
    phase: f64,
    periods: u32,
    guess: (&Point, &[f64]),
) -> Option<(Point, f64)> {
    let lap = Lap {
        family,
        at,
        sequence,
        phase,
        periods,
    };
    let variables = family.variables();
    let (z, durations) = guess;
    let (_, step) = lap.linearise(z, durations).step(z, variables);
    let step = step?;
    let size = step.rows(0, variables.len()).amax();
    if !size.is_finite() {
        return None;
    }
    let mut next = *z;
    let scale = (LONGEST_STEP / size).min(1.0);
    add(&mut next, &mut [], variables, &(&step * scale));
    Some((next, size))
}
