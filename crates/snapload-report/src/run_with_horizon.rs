//! A run with its horizon and known digits, which are quick to compute.
use crate::NormsKnown;
use crate::run_with_trust::{certain_outcome, trust_of_impacts_in_words};
use crate::summary::{end_known, end_with_known};
use snapload::analysis::{
    Cancelled, Horizon, NormErrors, OnProgress, TrustMonitor, Uncertainty, record,
};
use snapload::{Case, Parameters, Trajectory};

/// A run with exact values, and how far it can be trusted.
pub struct RunWithHorizon {
    /// The run.
    pub run: Trajectory,
    /// Where trust ends; none if the whole run can be trusted.
    pub horizon: Option<Horizon>,
    /// Decimal digits that are expected to be right, for each impact up to the horizon.
    pub digits: Vec<f64>,
    /// The number of known digits of each norm.
    pub norms_known: NormsKnown,
    /// The same of the time of its end.
    end_known: String,
}

impl RunWithHorizon {
    /// Runs a case.
    ///
    /// # Errors
    /// [`Cancelled`] if it is cancelled.
    pub fn run(case: &Case, on_progress: OnProgress) -> Result<Self, Cancelled> {
        let simulation = case.simulation();
        let mut monitor = TrustMonitor::of_exact_case(case, &simulation);
        let run = record(simulation, on_progress, |simulation, step| {
            // Past the horizon the run continues alone, three times as fast.
            if monitor.horizon().is_none() {
                monitor.follow(simulation, step);
            }
        })?;
        let trust = monitor.verdict();
        Ok(Self {
            digits: trust.digits().collect(),
            norms_known: NormsKnown::of(run.norms(), &NormErrors::of(&run, &trust)),
            end_known: end_known(&run, &trust),
            horizon: trust.horizon,
            run,
        })
    }

    /// How it ended, and the accuracy of its time, as in the summary of a run.
    pub fn end_in_words(&self, parameters: &Parameters) -> String {
        end_with_known(&self.run, parameters, &self.end_known)
    }

    /// The outcome as in the summary of a run; none where neighbours have to show it.
    pub fn outcome_if_certain(&self) -> Option<String> {
        let is_certain = self.horizon.is_none();
        is_certain.then(|| certain_outcome(self.run.end().reason))
    }

    /// Where trust ends, and on a second line why.
    pub fn in_words(&self) -> String {
        let tolerance = Uncertainty::default().tolerance;
        trust_of_impacts_in_words(self.horizon, tolerance, self.run.impacts())
    }
}
