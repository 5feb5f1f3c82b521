//! The runs besides that of the case: with less and with more restitution, in slightly other waves,
//! and neighbours.

use super::neighbours::{count_of_neighbours, height_of_neighbour};
use super::outcome::Outcome;
use crate::physics::model_at_rest::ModelAtRest;
use crate::structure::{Structure, Water, Wave};
use snapload::analysis::{OnProgress, Unfinished};

/// By this the restitution is varied, as it is rarely known more accurately.
const RESTITUTION: f64 = 0.2;
/// By this part height and period of a regular wave are varied, as neither is known more
/// accurately.
const WAVE: f64 = 0.01;

/// The runs that are to be made.
pub(super) struct FurtherRuns<'a> {
    prepared: &'a ModelAtRest,
    restitutions: Vec<f64>,
    /// Each with the case in it.
    waves: Vec<(Wave, ModelAtRest)>,
    neighbours: usize,
}

/// Their outcomes.
pub(super) struct FurtherOutcomes {
    /// With another restitution, each with its coefficient.
    pub(super) restitutions: Vec<(f64, Outcome)>,
    /// In another regular wave.
    pub(super) waves: Vec<(Wave, Outcome)>,
    /// Of neighbours.
    pub(super) neighbours: Vec<Outcome>,
}

impl<'a> FurtherRuns<'a> {
    pub(super) fn new(prepared: &'a ModelAtRest, neighbours: u32) -> Self {
        // The file of a floating body may end between the period of the case and another.
        let within = |wave: Wave| Some((wave, prepared.in_water(Water::Wave(wave)).ok()?));
        Self {
            prepared,
            restitutions: restitutions_about(prepared.structure.restitution),
            waves: waves_about(&prepared.structure)
                .into_iter()
                .filter_map(within)
                .collect(),
            neighbours: count_of_neighbours(&prepared.structure, neighbours),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.restitutions.len() + self.waves.len() + self.neighbours
    }

    pub(super) fn run(&self, index: usize, on_progress: OnProgress) -> Result<Outcome, Unfinished> {
        if let Some(restitution) = self.restitutions.get(index) {
            let other = self.prepared.with_restitution(*restitution);
            return Outcome::of(&other, 1.0, on_progress);
        }
        let index = index - self.restitutions.len();
        if let Some((_, other)) = self.waves.get(index) {
            return Outcome::of(other, 1.0, on_progress);
        }
        let index = index - self.waves.len();
        Outcome::of(self.prepared, height_of_neighbour(index), on_progress)
    }

    /// Sorts the outcomes of all these runs by what differs.
    pub(super) fn sorted(&self, mut outcomes: Vec<Outcome>) -> FurtherOutcomes {
        let mut others = outcomes.split_off(self.restitutions.len());
        let neighbours = others.split_off(self.waves.len());
        let waves = self.waves.iter().map(|(wave, _)| *wave);
        FurtherOutcomes {
            restitutions: self.restitutions.iter().copied().zip(outcomes).collect(),
            waves: waves.zip(others).collect(),
            neighbours,
        }
    }
}

/// A smaller and a larger restitution than that of the case, within the values allowed.
fn restitutions_about(restitution: f64) -> Vec<f64> {
    let further = [-RESTITUTION, RESTITUTION].map(|more| (restitution + more).clamp(0.0, 1.0));
    further
        .into_iter()
        .filter(|other| *other != restitution)
        .collect()
}

/// A lower, a higher, a shorter and a longer wave than a regular one; none in a sea, whose records
/// vary by themselves, and in still water.
fn waves_about(structure: &Structure) -> Vec<Wave> {
    let Water::Wave(wave) = structure.water else {
        return Vec::new();
    };
    if !structure.has_waves() {
        return Vec::new();
    }
    let heights = [1.0 - WAVE, 1.0 + WAVE].map(|times| Wave {
        height_m: shown(times * wave.height_m),
        ..wave
    });
    let periods = [1.0 - WAVE, 1.0 + WAVE].map(|times| Wave {
        period_s: shown(times * wave.period_s),
        ..wave
    });
    heights.into_iter().chain(periods).collect()
}

/// A height or a period in four digits, so that the run is that of the wave that a row shows.
fn shown(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
