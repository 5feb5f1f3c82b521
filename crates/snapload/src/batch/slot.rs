//! A run among others, with its outcome so far and its follower.

use crate::batch::followers::Follower;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::Simulation;

/// A run that may have a lane.
pub(super) struct Slot<C> {
    /// Its index in the order of the runs.
    pub(super) index: usize,
    pub(super) simulation: Box<Simulation>,
    pub(super) outcome: Outcome,
    pub(super) follower: C,
}

impl<C: Follower> Slot<C> {
    /// A run about to begin.
    pub(super) fn new(index: usize, simulation: Box<Simulation>, follower: C) -> Box<Self> {
        Box::new(Self {
            index,
            outcome: Outcome::at_start(&simulation),
            simulation,
            follower,
        })
    }

    pub(super) fn step(&mut self) {
        if let Some(step) = self.simulation.step() {
            self.outcome.take(&step);
            self.follower.take(&self.simulation, &step);
        }
    }
}
