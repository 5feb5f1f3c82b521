//! A run with what rounding leaves of it: what is quick to know.
use crate::trusted::horizon_in_words;
use snapload::analysis::{Horizon, TrustMonitor, Uncertainty};
use snapload::{Case, Simulation, Trajectory};
use std::ops::ControlFlow;

/// A run whose values are exact, and how far it can be trusted.
pub struct Followed {
    /// The run.
    pub run: Trajectory,
    /// Where trust ends; none if nowhere.
    pub horizon: Option<Horizon>,
    /// Decimal digits that are expected to be right, impact by impact as far as the horizon.
    pub digits: Vec<f64>,
}

impl Followed {
    /// Runs a case; none where `running`, which is shown the motion after every step, did not let it come to its
    /// end.
    pub fn run(
        case: &Case,
        mut running: impl FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Option<Self> {
        let simulation = case.simulation();
        let mut monitor =
            TrustMonitor::new(&simulation, &[0.0; 6], Uncertainty::default().tolerance);
        let run = Trajectory::record_while(simulation, |simulation, step| {
            // Past it the run goes on by itself, three times as fast.
            if monitor.horizon().is_none() {
                monitor.follow(simulation, step);
            }
            running(simulation)
        })?;
        let trust = monitor.verdict();
        Some(Self {
            digits: trust.digits().collect(),
            horizon: trust.horizon,
            run,
        })
    }

    /// Where trust ends, and on a second line why.
    pub fn in_words(&self) -> String {
        let tolerance = Uncertainty::default().tolerance;
        horizon_in_words(self.horizon, tolerance, self.run.impacts().len())
    }
}
