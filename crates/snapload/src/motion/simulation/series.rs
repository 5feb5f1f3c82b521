//! The series of the next segment, extended alone or, where the motion rocks, side by side with
//! those of others.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::arithmetic::real::Real;
use crate::model::taut_set::TautSet;
use crate::motion::simulation::Simulation;
use crate::motion::taut_series::{RockingSeries, Series, SeriesStart};

/// A series to be begun, by the best instructions for it.
struct Begin<'a>(&'a mut Simulation);

impl Kernel for Begin<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.begin_series();
    }
}

impl<T: Real> Simulation<T> {
    /// Begins the series of the next segment.
    #[inline(always)]
    fn begin_series(&mut self) {
        let series = self
            .series
            .get_or_insert_with(|| Box::new(Series::new(&self.system, &self.rules)));
        let around = self.waves.expanded(&self.system, self.t);
        let start = SeriesStart {
            around: &around,
            state: &self.state,
            memory: &self.memory,
            contacts: &self.contacts,
            active: self.active,
        };
        series.begin(&self.system, &start);
    }

    /// Finds the coefficients of the series of the next segment, unless they are known.
    #[inline(always)]
    pub(super) fn extend_series(&mut self) {
        if self
            .series
            .as_mut()
            .is_some_and(|series| series.take_extended())
        {
            return;
        }
        self.begin_series();
        if let Some(series) = &mut self.series {
            series.extend(&self.system);
        }
    }
}

impl Simulation {
    /// Whether the next step may be one of rocking: on two taut cables, of a system as the lanes
    /// have it.
    pub(crate) fn rocks(&self) -> bool {
        self.two_cables.is_some() && self.active.carrying == TautSet::only(0).with(1)
    }

    /// Begins the series of the next step and puts it into a lane; returns whether it fits there.
    /// If it does, [`Simulation::take_rocking`] has to follow.
    pub(crate) fn begin_rocking<L: Doubles>(
        &mut self,
        all: &mut RockingSeries<L>,
        lane: usize,
    ) -> bool {
        dispatch(Begin(self));
        let (Some(series), Some(two_cables)) = (&mut self.series, &self.two_cables) else {
            return false;
        };
        all.put(lane, series, two_cables.inverse_inertia)
    }

    /// Takes over the series that has been extended in a lane, for the next step.
    pub(crate) fn take_rocking<L: Doubles>(&mut self, all: &RockingSeries<L>, lane: usize) {
        if let Some(series) = &mut self.series {
            all.get(lane, series);
        }
    }
}
