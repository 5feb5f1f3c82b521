//! Pseudo-arclength continuation of a closed lap in one parameter.
//!
//! H. B. Keller, in *Applications of Bifurcation Theory* (1977) 359. The unknowns are the state at
//! the section, the time from event to event, and the parameter. As the times are unknowns, too,
//! the closing velocity of a snap is a smooth function along a branch, through zero and beyond: a
//! graze of one of its snaps is an ordinary point of a branch, and only the negative velocity
//! beyond says that it is no longer admissible (compare the velocity as unknown in M. Ghosh & D. J.
//! W. Simpson, arXiv:2510.16218).

use crate::bordered::null_vectors;
use crate::hybrid::{Family, Hybrid, Point};
use crate::lap::Lap;
use crate::newton::{Closed, add, close};
use crate::sequence::{Sequence, Timed};
use nalgebra::{DMatrix, DVector};

/// The unknowns at a point of a branch.
#[derive(Clone, Debug)]
pub(crate) struct Unknowns {
    pub(crate) z: Point,
    pub(crate) durations: Vec<f64>,
    pub(crate) at: [f64; 2],
}

/// A sequence that is continued.
pub(crate) struct Continuation<'a, F: Family> {
    pub(crate) family: &'a F,
    pub(crate) sequence: Sequence,
    pub(crate) phase: f64,
    pub(crate) periods: u32,
}

impl<F: Family> Clone for Continuation<'_, F> {
    fn clone(&self) -> Self {
        Self {
            family: self.family,
            sequence: self.sequence.clone(),
            phase: self.phase,
            periods: self.periods,
        }
    }
}

/// Two corrected points of a branch that differ by less than this are one.
pub(crate) const SAME: f64 = 1e-8;
/// By no more than this does another number of snaps in an accumulation move the orbit.
const RECOUNTED: f64 = 1e-4;
/// The step of difference quotients of exact derivatives.
pub(crate) const DIFFERENCE: f64 = 3e-6;
/// The most steps of the corrector.
const MOST_STEPS: usize = 12;
/// A point is on the branch if its residual is below this.
const CLOSED: f64 = 1e-11;
/// A step below this is only rounding.
const DONE: f64 = 1e-14;
/// After a step below this the next one would be only rounding, and the derivatives are accurate
/// enough for the direction of the branch.
const LAST_STEP: f64 = 1e-8;

impl Unknowns {
    /// The largest difference of state and parameters from another point.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let [p, q] = [0, 1].map(|i| (self.at[i] - other.at[i]).abs());
        crate::distance(&self.z, &other.z).max(p).max(q)
    }

    pub(crate) fn closed(&self) -> Closed {
        Closed {
            z: self.z,
            durations: self.durations.clone(),
            residual: 0.0,
        }
    }

    /// How far along a unit vector another point of the same sequence lies, by all unknowns and as
    /// many parameters as the vector has.
    pub(crate) fn along(&self, tangent: &DVector<f64>, variables: &[usize], other: &Self) -> f64 {
        let state = variables.iter().map(|&i| other.z[i] - self.z[i]);
        let times = other.durations.iter().zip(&self.durations);
        let parameters = other.at.iter().zip(&self.at);
        let parts = state.chain(times.chain(parameters).map(|(a, b)| a - b));
        parts
            .zip(tangent.iter())
            .map(|(part, unit)| part * unit)
            .sum()
    }

    pub(crate) fn moved(&self, variables: &[usize], by: &DVector<f64>) -> Self {
        let mut moved = self.clone();
        add(&mut moved.z, &mut moved.durations, variables, by);
        let known = variables.len() + self.durations.len();
        for (value, part) in moved.at.iter_mut().zip(by.iter().skip(known)) {
            *value += part;
        }
        moved
    }
}

impl<F: Family> Continuation<'_, F> {
    pub(crate) fn lap(&self, at: [f64; 2]) -> Lap<'_, F> {
        Lap {
            family: self.family,
            at,
            sequence: &self.sequence,
            phase: self.phase,
            periods: self.periods,
        }
    }

    /// The number of unknowns without the parameters.
    pub(crate) fn size(&self) -> usize {
        self.family.variables().len() + self.sequence.events.len()
    }

    /// F and its derivatives, including those by `parameters` of the parameters.
    pub(crate) fn equations(
        &self,
        u: &Unknowns,
        parameters: usize,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let linear = self.lap(u.at).linearise(&u.z, &u.durations);
        linear.equations(&u.z, self.family.variables(), parameters)
    }

    /// The direction of the branch at a point, with a positive component along the one before.
    pub(crate) fn tangent(&self, u: &Unknowns, before: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, jacobian) = self.equations(u, 1);
        Self::tangent_of(&jacobian, before)
    }

    /// The same from given derivatives.
    fn tangent_of(jacobian: &DMatrix<f64>, before: &DVector<f64>) -> Option<DVector<f64>> {
        let count = jacobian.ncols();
        let bordered = bordered(jacobian, before);
        let mut unit = DVector::zeros(count);
        unit[count - 1] = 1.0;
        let tangent = bordered.lu().solve(&unit)?;
        let length = tangent.norm();
        (length.is_finite() && length > 0.0).then(|| tangent / length)
    }

    /// The first direction: the one in which the parameter increases. Just at a fold, where it does
    /// not, it is one of the two.
    pub(crate) fn first_tangent(&self, u: &Unknowns) -> Option<DVector<f64>> {
        let (_, jacobian) = self.equations(u, 1);
        let count = jacobian.ncols();
        let mut along = DVector::zeros(count);
        along[count - 1] = 1.0;
        Self::tangent_of(&jacobian, &along).or_else(|| {
            let [direction, _] = null_vectors(&bordered(&jacobian, &DVector::zeros(count)))?;
            Some(direction)
        })
    }

    /// The point of the branch a length `sigma` along `tangent` from `from`, the number of steps,
    /// and the direction of the branch there.
    pub(crate) fn corrected(
        &self,
        from: &Unknowns,
        tangent: &DVector<f64>,
        sigma: f64,
    ) -> Option<(Unknowns, usize, DVector<f64>)> {
        let variables = self.family.variables();
        let mut offset = tangent * sigma;
        let mut before = f64::INFINITY;
        for steps in 1..=MOST_STEPS {
            let here = from.moved(variables, &offset);
            let (residual, jacobian) = self.equations(&here, 1);
            if !residual.iter().all(|part| part.is_finite()) {
                return None;
            }
            let count = jacobian.ncols();
            let mut right = DVector::zeros(count);
            right.rows_mut(0, count - 1).copy_from(&-&residual);
            right[count - 1] = sigma - tangent.dot(&offset);
            let step = bordered(&jacobian, tangent).lu().solve(&right)?;
            let moved = step.amax();
            let size = residual.amax();
            if size < CLOSED && (moved < DONE || moved >= 0.25 * before) {
                return Some((here, steps, Self::tangent_of(&jacobian, tangent)?));
            }
            if moved < LAST_STEP {
                let there = from.moved(variables, &(&offset + &step));
                return Some((there, steps, Self::tangent_of(&jacobian, tangent)?));
            }
            if !moved.is_finite() || moved > 1.0 {
                return None;
            }
            before = moved;
            offset += step;
        }
        None
    }

    /// The same orbit with its events renumbered, if the first event has passed the section, or the
    /// last one the next section; and the shift of the events' numbers.
    pub(crate) fn renumbered(&self, u: &Unknowns) -> Option<(Self, Unknowns, isize)> {
        let lap = self.lap(u.at);
        let (t_start, length) = lap.times();
        let count = u.durations.len();
        if *u.durations.first()? >= 0.0 && lap.last_leg(&u.durations) >= 0.0 {
            return None;
        }
        let system = self.family.plain(u.at);
        let legs = lap.legs(&system, &u.z, &u.durations);
        let (first, last) = (legs.first()?, legs.last()?);
        let taut_sets = self.sequence.taut_sets();
        let mut moved = self.clone();
        let mut durations = u.durations.clone();
        let (z, shift) = if first.s < 0.0 {
            // The first event is now the last one of the lap before.
            moved.sequence.events.rotate_left(1);
            moved.sequence.start = taut_sets[1];
            let leg = &legs[1];
            durations.rotate_left(1);
            let early = first.s;
            durations[count - 1] = last.s + early;
            if count > 1 {
                durations[0] += early;
            } else {
                durations[0] = length + early;
            }
            (
                system.flow(leg.taut, leg.t, &leg.start, t_start - leg.t),
                -1,
            )
        } else {
            // The last event is now the first one after the section.
            moved.sequence.events.rotate_right(1);
            moved.sequence.start = taut_sets[count - 1];
            let leg = &legs[count - 1];
            let late = -last.s;
            durations.rotate_right(1);
            durations[0] = late;
            if count > 1 {
                durations[1] -= late;
            }
            let z = system.flow(leg.taut, leg.t, &leg.start, t_start + length - leg.t);
            (z, 1)
        };
        let here = Unknowns {
            z,
            durations,
            at: u.at,
        };
        Some((moved, here, shift))
    }

    /// The same orbit with the snaps of its accumulations counted anew, as a simulated lap has
    /// them, and the direction there; none if their number is the same. How many there are before
    /// one is slow enough to stick changes along a branch, and means nothing.
    pub(crate) fn recounted(
        &self,
        u: &Unknowns,
        timed: &Timed,
        tangent: &DVector<f64>,
    ) -> Option<(Self, Unknowns, DVector<f64>)> {
        if !timed.accumulates() {
            return None;
        }
        let (t_start, length) = self.lap(u.at).times();
        let simulated = self
            .family
            .simulate(u.at, t_start, &u.z, t_start + length)?;
        let new = simulated.lap;
        if new.sequence == self.sequence || !new.same_events(timed) {
            return None;
        }
        let counted = Self {
            sequence: new.sequence,
            ..self.clone()
        };
        let Closed { z, durations, .. } = close(&counted.lap(u.at), &u.z, &new.durations)?;
        let at = u.at;
        let there = Unknowns { z, durations, at };
        let direction = counted.first_tangent(&there)?;
        // What both have in common are the state and the parameter.
        let m = self.family.variables().len();
        let state = direction.rows(0, m).dot(&tangent.rows(0, m));
        let agrees = state + direction[direction.len() - 1] * tangent[tangent.len() - 1];
        let direction = if agrees < 0.0 { -direction } else { direction };
        let near = u.distance(&there) < RECOUNTED;
        near.then_some((counted, there, direction))
    }

    /// The direction after a renumbering: the one that agrees with the old one in the parameter and
    /// in the times that both have in common.
    pub(crate) fn tangent_after(
        &self,
        u: &Unknowns,
        old: &DVector<f64>,
        shift: isize,
    ) -> Option<DVector<f64>> {
        let m = self.family.variables().len();
        let n = u.durations.len();
        let tangent = self.first_tangent(u)?;
        let mut agrees = tangent[m + n] * old[m + n];
        // The times between events that stay neighbours within the lap.
        for k in 1..n {
            let before = k as isize - shift;
            if before >= 1 && (before as usize) < n {
                agrees += tangent[m + k] * old[m + before as usize];
            }
        }
        Some(if agrees < 0.0 { -tangent } else { tangent })
    }
}

impl<F: Family> BranchStep<'_, F> {
    /// How far along the step it comes to a given point of the branch, if it does.
    pub(crate) fn passes(&self, goal: &Goal) -> Option<f64> {
        let continuation = self.continuation;
        if goal.sequence != continuation.sequence {
            return None;
        }
        let variables = continuation.family.variables();
        let sigma = self.from.along(self.tangent, variables, &goal.at);
        let within = sigma > 0.0 && sigma <= self.length;
        let near = self.from.distance(&goal.at) <= 2.0 * self.length;
        let (there, ..) = (within && near)
            .then(|| continuation.corrected(self.from, self.tangent, sigma))
            .flatten()?;
        (there.distance(&goal.at) < SAME).then_some(sigma)
    }
}

/// A point to which a closed branch or curve returns.
#[derive(Clone)]
pub(crate) struct Goal {
    pub(crate) sequence: Sequence,
    pub(crate) at: Unknowns,
}

/// The step from one point of a branch to the next.
pub(crate) struct BranchStep<'a, F: Family> {
    pub(crate) continuation: &'a Continuation<'a, F>,
    pub(crate) from: &'a Unknowns,
    pub(crate) tangent: &'a DVector<f64>,
    pub(crate) length: f64,
}

/// A matrix with a row below it.
pub(crate) fn bordered(matrix: &DMatrix<f64>, row: &DVector<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let mut all = matrix.clone().resize(rows + 1, columns, 0.0);
    all.row_mut(rows).copy_from(&row.transpose());
    all
}
