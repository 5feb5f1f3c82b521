//! The probability of exceeding the limits, against the force amplitude.

use crate::analysis::critical::{CriticalForce, DecidedEnd, ForceScan};
use crate::analysis::ensemble::{Ensemble, Share};
use crate::analysis::progress::{OnProgress, Progress, Unfinished};
use crate::analysis::trust::{Uncertainty, trusted_run};
use crate::case::Case;
use crate::case::parameters::Parameters;
use crate::motion::trajectory::End;

/// The share of neighbours that exceed the limits, at every amplitude of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct ExceedanceCurve {
    /// The shares by rising amplitude.
    pub points: Vec<Exceeding>,
}

/// The share at one amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeding {
    /// The force amplitude.
    pub f_o: f64,
    /// How the run itself ends.
    pub end: End,
    /// The part of the neighbours that exceed, from 0 to 1.
    pub part: f64,
    /// How many of those that were run exceed; none where the run ends before its horizon of trust,
    /// as its end then holds for all neighbours and none is run.
    pub share: Option<Share>,
    /// How many of those that were run are cut short, so that they might exceed, too.
    pub members_cut_short: usize,
}

impl Exceeding {
    /// Whether the run or some of its neighbours are cut short ([`crate::Stop::cuts_short`]).
    pub fn is_cut_short(self) -> bool {
        self.end.reason.cuts_short() || self.members_cut_short > 0
    }

    /// The interval that contains the probability with 95 % confidence, whether or not neighbours
    /// that are cut short would have exceeded: `part` itself where no neighbour is run, and all from
    /// 0 to 1 where the run is cut short, which tells nothing.
    pub fn interval(self) -> [f64; 2] {
        let Some(share) = self.share.filter(|_| !self.end.reason.cuts_short()) else {
            return match self.is_cut_short() {
                true => [0.0, 1.0],
                false => [self.part; 2],
            };
        };
        let at_most = Share {
            count: share.count + self.members_cut_short,
            ..share
        };
        [share.interval()[0], at_most.interval()[1]]
    }
}

impl ExceedanceCurve {
    /// Runs `count` neighbours of the case at every amplitude; where the end of the run itself is
    /// certain, it is taken for all of them.
    ///
    /// # Errors
    /// A [`crate::CaseError`] if the case is not legal, or what is uncertain can not vary, and
    /// [`Unfinished::Cancelled`].
    pub fn scan(
        parameters: &Parameters,
        scan: ForceScan,
        uncertainty: &Uncertainty,
        count: u32,
        seed: u64,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let all = scan.amplitudes().count() as f64;
        let mut points = Vec::new();
        for f_o in scan.amplitudes() {
            let progress = Progress::new("force amplitudes", points.len() as f64, all);
            progress.report(on_progress)?;
            // Cancelling is checked also within one amplitude.
            let within = |_: Progress| on_progress(progress);
            let case = Case::new(Parameters { f_o, ..*parameters })?;
            let ensemble = Ensemble::about(&case, uncertainty, count, seed);
            points.push(exceeding(&case, &ensemble, &within)?);
        }
        Progress::new("force amplitudes", all, all).report(on_progress)?;
        Ok(Self { points })
    }

    /// The critical force, with what these neighbours say of each amplitude.
    pub fn critical_force(&self) -> CriticalForce {
        let ends = self.points.iter().map(|point| DecidedEnd {
            f_o: point.f_o,
            end: point.end,
            certain: point.share.is_none(),
            decided: point.members_cut_short == 0 && point.part == share_of_all(point.end),
        });
        CriticalForce::of(&ends.collect::<Vec<_>>())
    }

    /// The smallest amplitude at which the share of those that exceed reaches `part`.
    pub fn passes(&self, part: f64) -> Option<f64> {
        let reached = self.points.iter().find(|point| point.part >= part);
        reached.map(|point| point.f_o)
    }
}

fn exceeding(
    case: &Case,
    ensemble: &Ensemble,
    on_progress: OnProgress,
) -> Result<Exceeding, Unfinished> {
    let (run, trust) = trusted_run(case, ensemble.uncertainty(), on_progress)?;
    let (share, members_cut_short) = match trust.decides_the_end() {
        true => (None, 0),
        false => {
            let ends = ensemble.tally(on_progress)?;
            (Some(ends.exceeding()), ends.cut_short().count)
        }
    };
    let end = *run.end();
    Ok(Exceeding {
        f_o: case.parameters().f_o,
        end,
        part: share.map_or(share_of_all(end), Share::part),
        share,
        members_cut_short,
    })
}

/// The share of neighbours that exceed if all end in this way.
fn share_of_all(end: End) -> f64 {
    f64::from(u8::from(end.reason.exceeds()))
}
