//! The probability of exceeding the limits, against the force amplitude.

use crate::analysis::critical::ForceScan;
use crate::analysis::ensemble::{Ensemble, Share};
use crate::analysis::trust::{Uncertainty, trusted_run};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::parameters::Parameters;

/// The share of neighbours that exceed the limits, at every amplitude of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct ExceedanceCurve {
    /// By amplitude, rising.
    pub points: Vec<Exceeding>,
}

/// At one amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeding {
    /// The force amplitude.
    pub f_o: f64,
    /// How many of the neighbours exceed.
    pub share: Share,
    /// Whether the run decided it before its horizon, for all neighbours at once.
    pub certain: bool,
}

impl ExceedanceCurve {
    /// Runs `count` neighbours of the case at every amplitude; where the run itself is certain, it stands for
    /// them all. `watch` is told how many amplitudes are done.
    ///
    /// # Errors
    /// A [`CaseError`] if the case is not legal, or what is in doubt can not vary.
    pub fn scan(
        parameters: &Parameters,
        scan: ForceScan,
        uncertainty: &Uncertainty,
        count: u32,
        seed: u64,
        mut watch: impl FnMut(usize),
    ) -> Result<Self, CaseError> {
        let mut points = Vec::new();
        for f_o in scan.amplitudes() {
            points.push(exceeding(parameters, f_o, uncertainty, count, seed)?);
            watch(points.len());
        }
        Ok(Self { points })
    }

    /// The smallest amplitude at which the share of those that exceed reaches `part`.
    pub fn passes(&self, part: f64) -> Option<f64> {
        let reached = self.points.iter().find(|point| point.share.part() >= part);
        reached.map(|point| point.f_o)
    }
}

fn exceeding(
    parameters: &Parameters,
    f_o: f64,
    uncertainty: &Uncertainty,
    count: u32,
    seed: u64,
) -> Result<Exceeding, CaseError> {
    let case = Case::new(Parameters { f_o, ..*parameters })?;
    let ensemble = Ensemble::about(&case, uncertainty, count, seed);
    let (run, trust) = trusted_run(&case, ensemble.uncertainty())?;
    let certain = trust.decides_the_end();
    let share = if certain {
        let all = ensemble.count as usize;
        Share {
            count: if run.end().reason.exceeds() { all } else { 0 },
            of: all,
        }
    } else {
        ensemble.tally(|| {})?.exceeding()
    };
    Ok(Exceeding {
        f_o,
        share,
        certain,
    })
}
