//! Where a step along a branch has come to.

use crate::branch_events::Tested;
use crate::continuation::{Continuation, Unknowns};
use crate::hybrid::Family;
use crate::orbit::Orbit;
use nalgebra::DVector;

/// A point of a branch, with the events numbered from the section and the snaps of accumulations
/// counted anew.
pub(crate) struct Arrived<'a, F: Family> {
    pub(crate) continuation: Continuation<'a, F>,
    pub(crate) here: Unknowns,
    /// The direction of the branch.
    pub(crate) tangent: DVector<f64>,
    pub(crate) orbit: Orbit,
    pub(crate) tested: Tested,
}

impl<'a, F: Family> Arrived<'a, F> {
    /// From the point as the step found it, with its direction and orbit, and the point before.
    pub(crate) fn at(
        continuation: &Continuation<'a, F>,
        (here, tangent): (&Unknowns, &DVector<f64>),
        orbit: Orbit,
        before: &Tested,
    ) -> Self {
        let mut arrived = Self {
            continuation: continuation.clone(),
            here: here.clone(),
            tangent: tangent.clone(),
            tested: Tested::new(&orbit, tangent).reached_from(before),
            orbit,
        };
        arrived.renumber_events();
        arrived.recount_snaps(before);
        arrived
    }

    /// Renumbers the events if one has passed the section.
    fn renumber_events(&mut self) {
        while let Some((moved, here, shift)) = self.continuation.renumbered(&self.here) {
            let Some(tangent) = moved.tangent_after(&here, &self.tangent, shift) else {
                return;
            };
            self.moves_to((moved, here, tangent));
        }
    }

    /// Counts the snaps of accumulations anew, if their number is another one.
    fn recount_snaps(&mut self, before: &Tested) {
        let timed = &self.orbit.lap;
        let counted = self
            .continuation
            .recounted(&self.here, timed, &self.tangent);
        if let Some(counted) = counted {
            self.moves_to(counted);
            self.tested = Tested::new(&self.orbit, &self.tangent).reached_from(before);
        }
    }

    fn moves_to(&mut self, to: (Continuation<'a, F>, Unknowns, DVector<f64>)) {
        (self.continuation, self.here, self.tangent) = to;
        let lap = self.continuation.lap(self.here.at);
        self.orbit = Orbit::of(&lap, &self.here.closed());
    }
}
