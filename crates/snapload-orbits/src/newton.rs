//! Newton's method on the composed map.

use crate::hybrid::{Family, Point};
use crate::lap::Lap;
use crate::sequence::Sequence;
use nalgebra::DVector;

/// Steps of Newton's method at most.
const MOST_STEPS: usize = 25;
/// No component of the state moves by more than this in one step.
const LONGEST: f64 = 0.15;
/// No duration is longer than so many laps: Newton's method that asks for more is lost, and to follow a
/// taut motion so far would take for ever.
const LAPS: f64 = 2.0;
/// A step below this part of what it changes is rounding.
const DONE: f64 = 4e-15;
/// A residual below this closes the lap.
const CLOSED: f64 = 1e-11;

/// A point that closes the composed map.
#[derive(Clone, Debug)]
pub struct Closed {
    /// The state at the section.
    pub z: Point,
    /// The time from event to event.
    pub durations: Vec<f64>,
    /// The largest residual that is left.
    pub residual: f64,
}

/// Solves F(z, s) = 0 from a guess; none where the steps do not end.
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
        let scale = (LONGEST / moved).min(1.0);
        add(&mut z, &mut durations, variables, &(&step * scale));
        if durations.iter().any(|s| s.abs() > LAPS * length) {
            return best;
        }
        // Near the solution steps shrink until they are rounding.
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

/// One step z + (1 − M)⁻¹ (P z − z), no longer than [`LONGEST`], from a lap as it was simulated.
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
    let scale = (LONGEST / size).min(1.0);
    add(&mut next, &mut [], variables, &(&step * scale));
    Some((next, size))
}
