//! The spread of a run's neighbours through its bounces.

use crate::analysis::trust::bounces::{Followed, Through};
use crate::analysis::trust::causes::{Closing, cause};
use crate::analysis::trust::covariance::CovarianceFactor;
use crate::analysis::trust::neighbours::{Approach, Neighbours, Spread};
use crate::analysis::trust::parts::{COLUMNS, squares};
use crate::analysis::trust::spread::SpreadMonitor;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::motion::bounce_map::{BounceMap, Bounced};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::Block;

/// One of the first bounces, by the best instructions for it: inlined beside the later ones it
/// would slow those down.
struct FirstBounce<'a>(
    &'a mut SpreadMonitor,
    &'a Simulation,
    &'a Step,
    &'a Bounced<'a, f64>,
    &'a BounceMap<f64>,
);

impl Kernel for FirstBounce<'_> {
    type Output = f64;
    #[inline(always)]
    fn run(self) -> f64 {
        let Self(monitor, simulation, step, bounced, map) = self;
        monitor.covariance.leave_seven();
        let before = monitor.followed();
        let mut followed = before;
        let through = before.carry_exactly(&mut followed, bounced, map);
        monitor.after_bounce(simulation, step, (bounced, map), (followed, through))
    }
}

/// A bounce that some neighbours may not have, and the parts of their spread just before it.
struct NeighbourCheck<'a> {
    monitor: &'a mut SpreadMonitor,
    simulation: &'a Simulation,
    step: &'a Step,
    before: [Block<COLUMNS>; 2],
    map: &'a BounceMap<f64>,
}

impl Kernel for NeighbourCheck<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.monitor
            .check_neighbours(self.simulation, self.step, self.before, self.map);
    }
}

impl SpreadMonitor {
    /// Carries the spread through a bounce, whose rounding is added with pseudorandom signs.
    #[inline(always)]
    pub(super) fn carry_later(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        bounced: &Bounced<f64>,
        map: &BounceMap<f64>,
    ) -> f64 {
        let mut followed = self.followed();
        let through = self.followed().carry(&mut followed, bounced, map);
        self.after_bounce(simulation, step, (bounced, map), (followed, through))
    }

    /// Carries the spread through one of the first bounces, whose rounding is added up exactly.
    pub(super) fn carry_first(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        bounced: &Bounced<f64>,
        map: &BounceMap<f64>,
    ) -> f64 {
        dispatch(FirstBounce(self, simulation, step, bounced, map))
    }

    /// Takes over what has been carried through a bounce; returns the error there.
    #[inline(always)]
    fn after_bounce(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        (bounced, map): (&Bounced<f64>, &BounceMap<f64>),
        (followed, through): (Followed<f64>, Through<f64>),
    ) -> f64 {
        if !through.within_tolerance && self.horizon.is_none() {
            let before = self.followed().before(bounced, map);
            dispatch(NeighbourCheck {
                monitor: self,
                simulation,
                step,
                before,
                map,
            });
        }
        self.covariance.parts = followed.parts;
        let after = squares(&followed.parts.rows);
        self.error_at_event(step, &[through.met, after])
    }

    /// Whether neighbours may have another event than a bounce, given the parts just before it.
    #[inline(always)]
    fn check_neighbours(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        before: [Block<COLUMNS>; 2],
        map: &BounceMap<f64>,
    ) {
        let [along, met] = before.map(|rows| CovarianceFactor {
            parts: self.covariance.parts.with(rows),
            columns: Vec::new(),
            memory: Vec::new(),
        });
        let at_start = self.covariance.clone();
        // One by one: a function given to `map` would not have the processor's own instructions.
        let spreads = [Spread::of(&at_start), Spread::of(&along), Spread::of(&met)];
        let neighbours = Neighbours::of_bounce(spreads);
        let approach = Approach {
            rate: map.rate(),
            delay: map.delay(),
        };
        let closing = Closing::of(simulation, step, &approach);
        if let Some((cause, t)) = cause(simulation, step, &approach, &neighbours, closing) {
            self.set_horizon(t, cause);
        }
    }
}
