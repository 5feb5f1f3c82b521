//! What the verdict would be based on with another restitution or in a slightly other wave.

use super::assess::Assessment;
use super::outcome::Outcome;
use crate::structure::{Structure, Water, Wave};
use serde::Serialize;

/// The numbers behind a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VerdictNumbers {
    /// The largest utilisation of any line; none if that of one is not known.
    pub largest_utilisation: Option<f64>,
    /// The fastest snap of any line; none without judged time \[m/s\].
    pub fastest_snap_m_s: Option<f64>,
    /// Whether the run is cut short, so that both may be larger in full.
    pub cut_short: bool,
}

/// The numbers behind the verdict for one coefficient of restitution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ByRestitution {
    /// e.
    pub restitution: f64,
    /// The numbers.
    #[serde(flatten)]
    pub numbers: VerdictNumbers,
}

/// The numbers behind the verdict in one regular wave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ByWave {
    /// Its height \[m\].
    pub height_m: f64,
    /// Its period \[s\].
    pub period_s: f64,
    /// The numbers.
    #[serde(flatten)]
    pub numbers: VerdictNumbers,
}

impl VerdictNumbers {
    fn of(structure: &Structure, outcome: &Outcome) -> Self {
        let all: Option<Vec<f64>> = outcome.utilisations(structure).into_iter().collect();
        Self {
            largest_utilisation: all.map(|all| all.into_iter().fold(0.0, f64::max)),
            fastest_snap_m_s: (!outcome.is_unjudged()).then(|| outcome.speed_m_s()),
            cut_short: outcome.stop.cuts_short(),
        }
    }
}

impl Assessment {
    /// The numbers behind the verdict with less and with more restitution, the least first.
    pub fn by_restitution(&self) -> Vec<ByRestitution> {
        let structure = &self.prepared.structure;
        let of = |restitution: f64, outcome: &Outcome| ByRestitution {
            restitution,
            numbers: VerdictNumbers::of(structure, outcome),
        };
        let mut rows = vec![of(structure.restitution, &self.outcome)];
        rows.extend(self.restitutions.iter().map(|(e, outcome)| of(*e, outcome)));
        rows.sort_by(|a, b| a.restitution.total_cmp(&b.restitution));
        rows
    }

    /// The numbers behind the verdict in the regular wave of the case, which comes first, and in
    /// those next to it; empty where these are not run.
    pub fn by_wave(&self) -> Vec<ByWave> {
        let structure = &self.prepared.structure;
        let of = |(wave, outcome): (Wave, &Outcome)| ByWave {
            height_m: wave.height_m,
            period_s: wave.period_s,
            numbers: VerdictNumbers::of(structure, outcome),
        };
        match structure.water {
            Water::Wave(wave) if !self.waves.is_empty() => {
                let others = self.waves.iter().map(|(wave, outcome)| (*wave, outcome));
                let all = [(wave, &self.outcome)].into_iter().chain(others);
                all.map(of).collect()
            }
            _ => Vec::new(),
        }
    }
}
