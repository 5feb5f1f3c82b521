//! Many records of one sea: how hard the lines snap in it, as a distribution.

use crate::assess::{Outcome, Prepared, quantile};
use crate::gumbel::Gumbel;
use crate::structure::{IrregularSea, Structure, THREE_HOURS_S, Water};
use rayon::prelude::*;
use snapload::analysis::Share;
use snapload::{CaseError, Stop};

/// What one record comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct SeaOutcome {
    /// Its seed.
    pub seed: u64,
    /// The rest.
    pub outcome: Outcome,
}

/// What many records come to.
#[derive(Clone, Debug)]
pub struct Seas {
    /// The structure, with the first seed.
    pub prepared: Prepared,
    /// By seed.
    pub records: Vec<SeaOutcome>,
}

/// Runs a structure in so many records of its sea, with the seed of the case and those that follow it; `watch` is told
/// of each that is done, from any thread.
///
/// # Errors
/// A [`CaseError`] if the case has no sea, or the structure rests nowhere.
pub fn seas(structure: Structure, count: u32, watch: impl Fn() + Sync) -> Result<Seas, CaseError> {
    let Water::Sea(sea) = structure.water else {
        return Err(CaseError::value("[sea]", "(left out)", "an irregular sea, to draw records from")
            .with_hint("write [sea] with hs and tp in place of [wave]; one regular wave is for snapload assess"));
    };
    let prepared = Prepared::new(structure)?;
    let records = (0..u64::from(count))
        .into_par_iter()
        .map(|index| {
            let seed = sea.seed + index;
            let record = prepared.in_sea(IrregularSea { seed, ..sea });
            let outcome = record.outcome(1.0)?;
            watch();
            Ok(SeaOutcome { seed, outcome })
        })
        .collect::<Result<_, CaseError>>()?;
    Ok(Seas { prepared, records })
}

impl Seas {
    /// The largest tension of each record in a snap, 0 where none snaps; none if tensions are not known \[N\].
    pub fn peaks_n(&self) -> Option<Vec<f64>> {
        let known = self
            .prepared
            .structure
            .lines
            .iter()
            .all(|line| line.stiffness_n.is_some());
        known.then(|| {
            self.records
                .iter()
                .map(|record| record.outcome.peak_n().unwrap_or(0.0))
                .collect()
        })
    }

    /// The fastest snap of each record \[m/s\].
    pub fn speeds_m_s(&self) -> Vec<f64> {
        self.records
            .iter()
            .map(|record| record.outcome.speed_m_s())
            .collect()
    }

    /// The distribution of the largest tension in three hours, if the records are long enough to have snaps in most of
    /// them \[N\].
    pub fn peak_in_three_hours(&self) -> Option<Gumbel> {
        let peaks = self.peaks_n()?;
        self.in_three_hours(&peaks)
    }

    /// The same of the fastest snap \[m/s\].
    pub fn speed_in_three_hours(&self) -> Option<Gumbel> {
        self.in_three_hours(&self.speeds_m_s())
    }

    /// Records that ended before their time, of whatever reason.
    fn cut_short(&self) -> usize {
        self.records
            .iter()
            .filter(|record| record.outcome.stop != Stop::EndTime)
            .count()
    }

    /// Records in which the body turned over or touched the floor.
    fn exceeding(&self) -> usize {
        self.records
            .iter()
            .filter(|record| record.outcome.stop.exceeds())
            .count()
    }

    /// A fit to records without snaps would be one to zeros, and one to records that ended early is of less time.
    fn in_three_hours(&self, largest: &[f64]) -> Option<Gumbel> {
        let snapping = largest.iter().filter(|value| **value > 0.0).count();
        let judged = self.prepared.structure.duration_s - self.prepared.structure.transient_s;
        if judged <= 0.0 || snapping < largest.len() || self.cut_short() > 0 {
            return None;
        }
        Gumbel::fit(largest).map(|fit| fit.over_times(THREE_HOURS_S / judged))
    }

    /// The share of records in which a line's breaking load is reached, or the body turns over or touches the floor; none if tensions or breaking loads are not known.
    pub fn failing(&self) -> Option<Share> {
        let fails = |outcome: &Outcome| -> Option<bool> {
            let all: Option<Vec<f64>> = outcome
                .utilisations(&self.prepared.structure)
                .into_iter()
                .collect();
            Some(outcome.stop.exceeds() || all?.into_iter().any(|u| u >= 1.0))
        };
        let failed: Option<Vec<bool>> = self
            .records
            .iter()
            .map(|record| fails(&record.outcome))
            .collect();
        failed.map(|failed| Share {
            count: failed.iter().filter(|failed| **failed).count(),
            of: self.records.len(),
        })
    }

    /// Part of the time that a line is slack, the mean over records.
    pub fn slack_fraction(&self, line: usize) -> f64 {
        let all = self
            .records
            .iter()
            .map(|record| record.outcome.lines[line].slack_fraction);
        all.sum::<f64>() / self.records.len().max(1) as f64
    }

    /// Snaps of all lines in three hours, the mean over records.
    pub fn snaps_in_three_hours(&self) -> f64 {
        let snaps: u64 = self
            .records
            .iter()
            .flat_map(|record| record.outcome.lines.iter().map(|line| line.snaps))
            .sum();
        snaps as f64 * THREE_HOURS_S / self.judged_s().max(f64::MIN_POSITIVE)
    }

    /// The time of all records together that is judged \[s\].
    pub fn judged_s(&self) -> f64 {
        let transient = self.prepared.structure.transient_s;
        self.records
            .iter()
            .map(|record| (record.outcome.end_s - transient).max(0.0))
            .sum()
    }

    /// Speeds of all snaps, sorted \[m/s\].
    pub fn all_speeds_m_s(&self) -> Vec<f64> {
        sorted(
            self.records
                .iter()
                .flat_map(|record| record.outcome.speeds_m_s.iter().copied()),
        )
    }

    /// Tensions of all snaps, sorted \[N\].
    pub fn all_peaks_n(&self) -> Vec<f64> {
        sorted(
            self.records
                .iter()
                .flat_map(|record| record.outcome.peaks_n.iter().copied()),
        )
    }

    /// The answer in a sentence or two.
    pub fn words(&self) -> String {
        let fit = self.peak_in_three_hours();
        let expected = match fit {
            Some(fit) => {
                let (mean, high) = (fit.mean(), fit.quantile(0.9));
                format!(
                    "The largest tension in a snap in three hours is expected at {:.0} ± {:.0} kN, and below {:.0} ± {:.0} kN in 90 % of such seas.",
                    mean.value / 1e3, mean.error / 1e3, high.value / 1e3, high.error / 1e3
                )
            }
            None if self.exceeding() > 0 => format!(
                "In {} of {} records the body turns over or touches the floor; a distribution of the largest tension is therefore not given.",
                self.exceeding(),
                self.records.len()
            ),
            None if self.cut_short() > 0 => format!(
                "{} of {} records ended after more than run.max_snaps = {} snaps, before their time; a distribution of the largest tension is therefore not given.",
                self.cut_short(),
                self.records.len(),
                self.prepared.structure.max_snaps
            ),
            None if self.speeds_m_s().iter().all(|speed| *speed == 0.0) => {
                "No line snaps in any of the records.".to_owned()
            }
            None if self.peaks_n().is_none() => {
                let speeds = sorted(self.speeds_m_s().into_iter());
                format!("The fastest snap of a record is at {:.2} m/s in the median; tensions are not known.", quantile(&speeds, 0.5).unwrap_or(0.0))
            }
            None => "Too few of the records have snaps for a distribution of the largest; take more or longer ones.".to_owned(),
        };
        match self.failing() {
            Some(share) => {
                let [low, high] = share.interval();
                format!(
                    "{expected} In {} of {} records a line would break or the mooring fail: a probability of {:.0} %, between {:.0} and {:.0} % with 95 % confidence.",
                    share.count,
                    share.of,
                    100.0 * share.part(),
                    100.0 * low,
                    100.0 * high
                )
            }
            None => expected,
        }
    }
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}
