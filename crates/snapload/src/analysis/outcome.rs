//! What a run comes to, without keeping the run.

use crate::{Case, End, Norms, Simulation};

/// The end and the norms of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub end: End,
    /// The norms.
    pub norms: Norms,
    /// How many impacts, impulses passed into taut cables not among them.
    pub impacts: u64,
}

impl Outcome {
    /// Of a case.
    pub fn of(case: &Case) -> Self {
        Self::after(case.simulation())
    }

    /// Of a simulation that is run to its end.
    pub fn after(mut simulation: Simulation) -> Self {
        let mut norms = Norms::default();
        let mut impacts = 0;
        while let Some(step) = simulation.step() {
            for impact in step.impacts() {
                norms.take(&impact);
                impacts += u64::from(impact.v_n > 0.0);
            }
        }
        norms.y_max = simulation.y_max();
        norms.theta_max = simulation.theta_max();
        Self {
            end: End::of(&simulation),
            norms,
            impacts,
        }
    }

    /// Whether it stopped at the rotation limit or the upper bound.
    pub fn exceeds(&self) -> bool {
        self.end.reason.exceeds()
    }
}
