//! One structure, from its case to what an engineer asks: do the lines go slack, how hard do they
//! snap, do they break?

use super::outcome::{Outcome, Tally};
use crate::physics::prepared::Prepared;
use crate::physics::sea::uniform;
use crate::physics::snap::Snap;
use crate::physics::warnings::{Warning, limits_afloat, phase_warning, turning_warning, warnings};
use crate::structure::{Structure, Water};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use snapload::analysis::{
    Counter, OnProgress, Trust, TrustMonitor, Unfinished, in_parallel, record,
};
use snapload::{Playback, Trajectory};

/// A state is known while its standard deviation is below this, in the engine's units.
const TOLERANCE: f64 = 1e-3;
/// Neighbours are so far from the run, in parts of the waves' height.
pub const NEIGHBOUR: f64 = 1e-6;
/// Times between the start and the end at which the place of the body is looked at.
const LOOKS: u32 = 20_000;

/// A structure that was run.
#[derive(Clone, Debug)]
pub struct Assessment {
    /// Structure, place of rest, model.
    pub prepared: Prepared,
    /// Rules of thumb that the case breaks.
    pub warnings: Vec<Warning>,
    /// The motion.
    pub run: Trajectory,
    /// How far it can be trusted.
    pub trust: Trust,
    /// Every snap, the slow ones included.
    pub snaps: Vec<Snap>,
    /// What it comes to.
    pub outcome: Outcome,
    /// Neighbours of the run; empty in still water, where there are no waves to vary.
    pub neighbours: Vec<Outcome>,
}

/// Runs a structure with its neighbours.
///
/// # Errors
/// A [`snapload::CaseError`] if the structure rests nowhere or can not start, and
/// [`Unfinished::Cancelled`].
pub fn assess(
    structure: Structure,
    neighbours: u32,
    on_progress: OnProgress,
) -> Result<Assessment, Unfinished> {
    let prepared = Prepared::new(structure)?;
    let simulation = prepared.begin(1.0)?;
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], TOLERANCE);
    let mut tally = Tally::new(&prepared);
    let mut snaps = Vec::new();
    let run = record(simulation, on_progress, |simulation, step| {
        monitor.follow(simulation, step);
        snaps.extend(tally.follow(simulation, step));
    })?;
    let outcome = tally.finish(run.end().t, run.end().reason);
    let still = matches!(prepared.structure.water, Water::Still);
    let count = if still { 0 } else { neighbours };
    let counter = Counter::new("neighbours", 0, count.into(), on_progress);
    let neighbours = in_parallel(count as usize, |index| {
        let outcome = Outcome::of(&prepared, 1.0 + NEIGHBOUR * side(index as u32))?;
        counter.add(1)?;
        Ok::<_, Unfinished>(outcome)
    })?;
    let mut assessment = Assessment {
        warnings: warnings(&prepared.structure, &prepared.rest),
        run,
        trust: monitor.verdict(),
        snaps,
        outcome,
        neighbours,
        prepared,
    };
    let ([x, z], [sides, _]) = (assessment.prepared.rest.place_m, assessment.reach_m());
    let excursion = (sides[1] - x).max(x - sides[0]);
    let phase = phase_warning(&assessment.prepared.structure, z, excursion);
    let turned = assessment.outcome.turned_rad;
    let turning = turning_warning(&assessment.prepared.structure, turned);
    let seen = assessment.outcome.waterline.as_ref();
    let limits = limits_afloat(&assessment.prepared.structure, seen, turned);
    let found = phase.into_iter().chain(turning).chain(limits);
    assessment.warnings.extend(found);
    Ok(assessment)
}

/// Evenly in [−1, 1), for each neighbour its own.
fn side(index: u32) -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    generator.set_stream(u64::from(index));
    2.0 * uniform(&mut generator) - 1.0
}

impl Assessment {
    /// Time up to which the run can be trusted \[s\]; none if all of it.
    pub fn horizon_s(&self) -> Option<f64> {
        let time = self.prepared.model.scales.time_s;
        self.trust.horizon.map(|horizon| horizon.t * time)
    }

    /// The snaps that are judged: those that count, after the transient.
    pub fn judged(&self) -> impl Iterator<Item = &Snap> {
        let transient_s = self.prepared.structure.transient_s;
        let snaps = self.snaps.iter();
        snaps.filter(move |snap| snap.is_judged(transient_s))
    }

    /// The extremes of the place of the centre \[m\]: `[[x, x], [z, z]]`.
    pub fn reach_m(&self) -> [[f64; 2]; 2] {
        let mut playback = Playback::new(&self.run);
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for look in 0..=LOOKS {
            let t = self.run.end().t * f64::from(look) / f64::from(LOOKS);
            let state = playback.at(t).state;
            let place = self.prepared.model.scales.to_si([state.x, state.y]);
            for (range, value) in reach.iter_mut().zip(place) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        reach
    }

    /// 5 %, 50 % and 95 % of the neighbours' largest tension in a snap; none where there is none
    /// \[N\].
    pub fn spread(&self) -> Option<[f64; 3]> {
        if !self.prepared.structure.tensions_known() {
            return None;
        }
        let peaks = self
            .neighbours
            .iter()
            .map(|outcome| outcome.peak_n().unwrap_or(0.0));
        let peaks = sorted(peaks);
        let [low, middle, high] = [0.05, 0.5, 0.95].map(|part| quantile(&peaks, part));
        Some([low?, middle?, high?])
    }
}

/// The values in order.
pub(crate) fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The value below which this part of the sorted values lies.
pub fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let at = part.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(last);
    Some(sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64))
}
