//! One point on a curve of special orbits, and the step from it to the next.

use crate::branch_events::BranchEvent;
use crate::condition::Condition;
use crate::continuation::{Continuation, SAME, Unknowns, bordered};
use crate::hybrid::Family;
use crate::orbit::Orbit;
use nalgebra::{DMatrix, DVector};

/// The most steps of the corrector.
const MOST_STEPS: usize = 12;
/// A point is on the curve if its residual is below this.
const CLOSED: f64 = 1e-11;
/// A step below this is only rounding.
const DONE: f64 = 1e-13;
/// The time between two events does not change by more than this in one step.
const LONGEST_TIME_CHANGE: f64 = 0.3;
/// The least cosine of the angle by which the direction may turn in one step.
const LEAST_COSINE: f64 = 0.95;

/// A point on a curve, and the direction in which it is followed.
pub(crate) struct OnCurve<'a, F: Family> {
    pub(crate) continuation: Continuation<'a, F>,
    pub(crate) condition: Condition,
    pub(crate) here: Unknowns,
    tangent: DVector<f64>,
}

impl<'a, F: Family> OnCurve<'a, F> {
    /// The point at an event of a branch, closed again at the same value of the second parameter,
    /// in the direction in which that increases; if it does not change, in that in which the first
    /// one increases.
    pub(crate) fn start_at(
        continuation: Continuation<'a, F>,
        start: Unknowns,
        event: &BranchEvent,
    ) -> Option<Self> {
        let condition = Condition::of(&continuation, &start, event)?;
        let count = continuation.size() + 2;
        let along = [count - 1, count - 2].map(|place| {
            let mut unit = DVector::zeros(count);
            unit[place] = 1.0;
            unit
        });
        let mut on_curve = Self {
            continuation,
            condition,
            here: start,
            tangent: along[0].clone(),
        };
        let (here, _) = on_curve.corrected(0.0)?;
        on_curve.condition = on_curve.condition.renewed(&on_curve.continuation, &here)?;
        on_curve.here = here;
        let directions = along.map(|along| on_curve.direction(&along));
        on_curve.tangent = directions.into_iter().flatten().next()?;
        Some(on_curve)
    }

    /// The same point with the opposite direction.
    pub(crate) fn turned(&self) -> Self {
        Self {
            tangent: -&self.tangent,
            ..self.copied()
        }
    }

    pub(crate) fn copied(&self) -> Self {
        Self {
            continuation: self.continuation.clone(),
            condition: self.condition.clone(),
            here: self.here.clone(),
            tangent: self.tangent.clone(),
        }
    }

    /// The orbit here.
    pub(crate) fn orbit(&self) -> Orbit {
        Orbit::of(&self.continuation.lap(self.here.at), &self.here.closed())
    }

    /// All equations except that of the arclength, and their derivatives.
    fn equations(&self, u: &Unknowns) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (residual, jacobian) = self.continuation.equations(u, 2);
        let value = self.condition.value(&self.continuation, u)?;
        let slopes = self.condition.slopes(&self.continuation, u)?;
        let count = residual.len();
        let residual = residual.insert_row(count, value);
        residual
            .iter()
            .all(|part| part.is_finite())
            .then(|| (residual, bordered(&jacobian, &slopes)))
    }

    /// The direction of the curve that has a positive component along `along`.
    fn direction(&self, along: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, jacobian) = self.equations(&self.here)?;
        let count = jacobian.ncols();
        let mut unit = DVector::zeros(count);
        unit[count - 1] = 1.0;
        let tangent = bordered(&jacobian, along).lu().solve(&unit)?;
        let length = tangent.norm();
        (length.is_finite() && length > 0.0).then(|| tangent / length)
    }

    /// The point of the curve a length `sigma` along the tangent, and the number of steps.
    fn corrected(&self, sigma: f64) -> Option<(Unknowns, usize)> {
        let variables = self.continuation.family.variables();
        let mut offset = &self.tangent * sigma;
        let mut before = f64::INFINITY;
        for steps in 1..=MOST_STEPS {
            let here = self.here.moved(variables, &offset);
            let (residual, jacobian) = self.equations(&here)?;
            let count = jacobian.ncols();
            let mut right = DVector::zeros(count);
            right.rows_mut(0, count - 1).copy_from(&-&residual);
            right[count - 1] = sigma - self.tangent.dot(&offset);
            let step = bordered(&jacobian, &self.tangent).lu().solve(&right)?;
            let moved = step.amax();
            if residual.amax() < CLOSED && (moved < DONE || moved >= 0.25 * before) {
                return Some((here, steps));
            }
            if !moved.is_finite() || moved > 1.0 {
                return None;
            }
            before = moved;
            offset += step;
        }
        None
    }

    /// How far along a step it comes to a given point of the curve, if it does.
    pub(crate) fn passes(&self, goal: &Self, length: f64) -> Option<f64> {
        if goal.continuation.sequence != self.continuation.sequence {
            return None;
        }
        let variables = self.continuation.family.variables();
        let sigma = self.here.along(&self.tangent, variables, &goal.here);
        let within = sigma > 0.0 && sigma <= length;
        let near = self.here.distance(&goal.here) <= 2.0 * length;
        let (there, _) = (within && near).then(|| self.corrected(sigma)).flatten()?;
        (there.distance(&goal.here) < SAME).then_some(sigma)
    }

    /// The point a length `sigma` further along.
    pub(crate) fn moved(&self, sigma: f64) -> Option<Self> {
        self.advanced(sigma).map(|(next, _)| next)
    }

    fn advanced(&self, sigma: f64) -> Option<(Self, usize)> {
        let (here, steps) = self.corrected(sigma)?;
        let mut next = Self {
            here,
            ..self.copied()
        };
        next.condition = self.condition.renewed(&self.continuation, &next.here)?;
        next.tangent = next.direction(&self.tangent)?;
        Some((next, steps))
    }

    /// The next point, if it is near enough, and the corrector's steps.
    pub(crate) fn stepped(&self, step: f64) -> Option<(Self, usize)> {
        let (next, steps) = self.advanced(step)?;
        let times = self.here.durations.iter().zip(&next.here.durations);
        let most = times.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let off = self.here.distance(&next.here);
        let turned = next.tangent.dot(&self.tangent);
        (most < LONGEST_TIME_CHANGE && off <= 2.0 * step && turned > LEAST_COSINE)
            .then_some((next, steps))
    }

    /// Renumbers the events if one has passed the section, and returns whether it has.
    pub(crate) fn renumber_events(&mut self) -> bool {
        let mut renumbered = false;
        while let Some((continuation, here, shift)) = self.continuation.renumbered(&self.here) {
            let Some(condition) = self.condition.renumbered(&continuation, &here, shift) else {
                return renumbered;
            };
            let along = self.along_after(shift);
            let next = Self {
                continuation,
                condition,
                here,
                tangent: along.clone(),
            };
            let Some(tangent) = next.direction(&along) else {
                return renumbered;
            };
            *self = Self { tangent, ..next };
            renumbered = true;
        }
        renumbered
    }

    /// The parts of the direction that keep their meaning when events are renumbered: those of the
    /// times between events that stay neighbours, and of the parameters.
    fn along_after(&self, shift: isize) -> DVector<f64> {
        let m = self.continuation.family.variables().len();
        let n = self.here.durations.len();
        let mut along = DVector::zeros(self.tangent.len());
        for k in 1..n {
            let before = k as isize - shift;
            if before >= 1 && (before as usize) < n {
                along[m + k] = self.tangent[m + before as usize];
            }
        }
        along
            .rows_mut(m + n, 2)
            .copy_from(&self.tangent.rows(m + n, 2));
        along
    }
}
