//! One structure, from its case to what an engineer asks: do the lines go slack, how hard do they snap, do they break?

use crate::equilibrium::{Equilibrium, equilibrium};
use crate::model::Model;
use crate::plausible::{Warning, phase_warning, warnings};
use crate::snap::{Snap, SnapLaw};
use crate::structure::{IrregularSea, Structure, Water};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use snapload::analysis::{Trust, TrustMonitor};
use snapload::{
    CaseError, Impact, Playback, Simulation, StartError, State, Step, Stop, Trajectory,
};

/// A state is known while its standard deviation is below this, in the engine's units.
const TOLERANCE: f64 = 1e-3;
/// Neighbours are so far from the run, in parts of the waves' height.
pub const NEIGHBOUR: f64 = 1e-6;
/// Looks at the motion between the start and the end.
const LOOKS: u32 = 20_000;

/// Structure, place of rest and model, ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The structure.
    pub structure: Structure,
    /// Where it rests.
    pub rest: Equilibrium,
    /// The same in the engine's units.
    pub model: Model,
    start: State,
}

/// What one run comes to for one line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineOutcome {
    /// Snaps of [`crate::SLOWEST_M_S`] and above, after the transient as all that follows.
    pub snaps: u64,
    /// The fastest \[m/s\].
    pub speed_m_s: f64,
    /// Jolts that snaps of other lines passed on to it while it was taut, as far as they count.
    pub jolts: u64,
    /// The largest estimate of tension in a snap or a jolt \[N\].
    pub peak_n: Option<f64>,
    /// The largest tension while the line stays taut \[N\].
    pub held_n: f64,
    /// The part of the whole time without tension.
    pub slack_fraction: f64,
}

/// What one run comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// By line.
    pub lines: Vec<LineOutcome>,
    /// How it ended.
    pub stop: Stop,
    /// When it ended \[s\].
    pub end_s: f64,
    /// Peak tensions of all snaps that count \[N\].
    pub peaks_n: Vec<f64>,
    /// Their speeds \[m/s\].
    pub speeds_m_s: Vec<f64>,
}

/// A structure that was run.
#[derive(Clone, Debug)]
pub struct Assessment {
    /// Structure, place of rest, model.
    pub prepared: Prepared,
    /// Doubts about the case.
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

impl Prepared {
    /// Finds where the structure rests and makes its model.
    ///
    /// # Errors
    /// A [`CaseError`] if it rests nowhere or can not start where it should.
    pub fn new(structure: Structure) -> Result<Self, CaseError> {
        let rest = equilibrium(&structure)?;
        let model = Model::resting(&structure, &rest);
        let start = match structure.start_m {
            Some(place) => model.at_rest(place, 0.0),
            None => model.at_rest(rest.place_m, rest.theta_rad),
        };
        let prepared = Self {
            structure,
            rest,
            model,
            start,
        };
        prepared
            .begin(1.0)
            .map_err(|error| prepared.explain(error))?;
        Ok(prepared)
    }

    /// The same structure in another sea; where it rests stays.
    #[must_use]
    pub fn in_sea(&self, sea: IrregularSea) -> Self {
        let structure = Structure {
            water: Water::Sea(sea),
            ..self.structure.clone()
        };
        let model = Model::resting(&structure, &self.rest);
        Self {
            structure,
            model,
            ..self.clone()
        }
    }

    /// The motion at its start, in waves that are so many times as high.
    ///
    /// # Errors
    /// [`StartError`], which [`Prepared::new`] has excluded.
    pub fn begin(&self, height: f64) -> Result<Simulation, StartError> {
        let mut system = self.model.system.clone();
        let water = system.drag.iter_mut().flat_map(|drag| &mut drag.water);
        for harmonic in system.forcing.harmonics.iter_mut().chain(water) {
            harmonic.cosine = harmonic.cosine.map(|force| force * height);
            harmonic.sine = harmonic.sine.map(|force| force * height);
        }
        Simulation::new(system, self.model.rules, 0.0, self.start)
    }

    /// The state in which it begins, in the engine's units.
    pub fn start(&self) -> State {
        self.start
    }

    fn explain(&self, error: StartError) -> CaseError {
        let [x, z] = self.structure.start_m.unwrap_or(self.rest.place_m);
        let shown = format!("[{x}, {z}]");
        let allowed = match error {
            StartError::CableTooShort { cable, .. } => {
                format!(
                    "a start within reach of every line; line {} is too short",
                    cable + 1
                )
            }
            StartError::BeyondLimit {
                stop: Stop::UpperBound,
                ..
            } => "a body above the floor".to_owned(),
            _ => "a start that can be computed".to_owned(),
        };
        CaseError::value("run.start", shown, allowed)
            .with_hint("leave start out to begin at rest in still water")
    }

    /// Runs it in waves so many times as high and keeps what it comes to.
    ///
    /// # Errors
    /// A [`CaseError`] if it can not start.
    pub fn outcome(&self, height: f64) -> Result<Outcome, CaseError> {
        let begun = self.begin(height);
        let mut simulation = begun.map_err(|error| self.explain(error))?;
        let law = SnapLaw::new(&self.structure, &self.rest, &self.model);
        let mut tally = Tally::new(self, law);
        while let Some(step) = simulation.step() {
            tally.stretch(&simulation, &step);
            tally.snaps(&simulation, &step);
        }
        Ok(tally.finish(
            simulation.time(),
            simulation.stop().unwrap_or(Stop::EndTime),
        ))
    }
}

/// Sums up a run.
struct Tally<'a> {
    prepared: &'a Prepared,
    law: SnapLaw,
    lines: Vec<LineOutcome>,
    slack: Vec<f64>,
    peaks_n: Vec<f64>,
    speeds_m_s: Vec<f64>,
}

impl<'a> Tally<'a> {
    fn new(prepared: &'a Prepared, law: SnapLaw) -> Self {
        let count = prepared.structure.lines.len();
        Self {
            prepared,
            law,
            lines: vec![LineOutcome::default(); count],
            slack: vec![0.0; count],
            peaks_n: Vec::new(),
            speeds_m_s: Vec::new(),
        }
    }

    fn stretch(&mut self, simulation: &Simulation, step: &Step) {
        for (line, slack) in self.slack.iter_mut().enumerate() {
            if !step.taut.contains(line) {
                *slack += step.t_end - step.t_start;
            }
        }
        let scales = &self.prepared.model.scales;
        if step.t_end * scales.time_s >= self.prepared.structure.transient_s {
            let tensions = simulation.largest_tensions(step);
            for (line, tension) in self.lines.iter_mut().zip(tensions) {
                line.held_n = line.held_n.max(tension * scales.force_n);
            }
        }
    }

    fn snaps(&mut self, simulation: &Simulation, step: &Step) -> Vec<Snap> {
        let impacts: Vec<Impact> = step.impacts().collect();
        if impacts.is_empty() {
            return Vec::new();
        }
        let held = simulation.tensions_at_end(step);
        let held = |line: usize| step.taut.contains(line).then(|| held[line]);
        let snaps = self.law.snaps(simulation.system(), &impacts, held);
        let judged =
            |snap: &&Snap| snap.counts() && snap.t_s >= self.prepared.structure.transient_s;
        for snap in snaps.iter().filter(judged) {
            let line = &mut self.lines[snap.line];
            if snap.is_jolt {
                line.jolts += 1;
            } else {
                line.snaps += 1;
                line.speed_m_s = line.speed_m_s.max(snap.speed_m_s);
                self.speeds_m_s.push(snap.speed_m_s);
            }
            if let Some(peak) = snap.peak_n {
                line.peak_n = Some(line.peak_n.unwrap_or(0.0).max(peak));
                self.peaks_n.push(peak);
            }
        }
        snaps
    }

    fn finish(mut self, end: f64, stop: Stop) -> Outcome {
        for (line, slack) in self.lines.iter_mut().zip(&self.slack) {
            line.slack_fraction = if end > 0.0 { slack / end } else { 0.0 };
        }
        Outcome {
            lines: self.lines,
            stop,
            end_s: end * self.prepared.model.scales.time_s,
            peaks_n: self.peaks_n,
            speeds_m_s: self.speeds_m_s,
        }
    }
}

impl Outcome {
    /// The largest estimate of tension in a snap of any line \[N\].
    pub fn peak_n(&self) -> Option<f64> {
        self.lines
            .iter()
            .filter_map(|line| line.peak_n)
            .reduce(f64::max)
    }

    /// The fastest snap of any line \[m/s\].
    pub fn speed_m_s(&self) -> f64 {
        self.lines
            .iter()
            .fold(0.0, |speed, line| speed.max(line.speed_m_s))
    }

    /// The largest tension of each line over its breaking load, where that is known.
    pub fn utilisations(&self, structure: &Structure) -> Vec<Option<f64>> {
        let lines = self.lines.iter().zip(&structure.lines);
        lines
            .map(|(outcome, line)| {
                let snap = outcome
                    .peak_n
                    .or((outcome.snaps + outcome.jolts == 0).then_some(0.0));
                snap.zip(line.breaking_load_n)
                    .map(|(peak, load)| peak.max(outcome.held_n) / load)
            })
            .collect()
    }
}

/// Runs a structure with so many neighbours; `watch` is told of each run that is done, from any thread.
///
/// # Errors
/// A [`CaseError`] if the structure rests nowhere or can not start.
pub fn assess(
    structure: Structure,
    neighbours: u32,
    watch: impl Fn() + Sync,
) -> Result<Assessment, CaseError> {
    let prepared = Prepared::new(structure)?;
    let warnings = warnings(&prepared.structure, &prepared.rest);
    let simulation = prepared
        .begin(1.0)
        .map_err(|error| prepared.explain(error))?;
    let law = SnapLaw::new(&prepared.structure, &prepared.rest, &prepared.model);
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], TOLERANCE);
    let mut tally = Tally::new(&prepared, law);
    let mut snaps = Vec::new();
    let run = Trajectory::record_watched(simulation, |simulation, step| {
        monitor.follow(simulation, step);
        tally.stretch(simulation, step);
        snaps.extend(tally.snaps(simulation, step));
    });
    watch();
    let outcome = tally.finish(run.end().t, run.end().reason);
    let count = if matches!(prepared.structure.water, Water::Still) {
        0
    } else {
        neighbours
    };
    let neighbours = (0..count)
        .into_par_iter()
        .map(|index| {
            let outcome = prepared.outcome(1.0 + NEIGHBOUR * side(index));
            watch();
            outcome
        })
        .collect::<Result<_, _>>()?;
    let mut assessment = Assessment {
        warnings,
        run,
        trust: monitor.verdict(),
        snaps,
        outcome,
        neighbours,
        prepared,
    };
    let ([x, z], [sides, _]) = (assessment.prepared.rest.place_m, assessment.reach_m());
    let excursion = (sides[1] - x).max(x - sides[0]);
    let doubt = phase_warning(&assessment.prepared.structure, z, excursion);
    assessment.warnings.extend(doubt);
    Ok(assessment)
}

/// Evenly in [−1, 1), for each neighbour its own.
fn side(index: u32) -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    generator.set_stream(u64::from(index));
    (generator.next_u64() >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0
}

impl Assessment {
    /// Time up to which the run can be trusted \[s\]; none if all of it.
    pub fn horizon_s(&self) -> Option<f64> {
        let time = self.prepared.model.scales.time_s;
        self.trust.horizon.map(|horizon| horizon.t * time)
    }

    /// The highest and lowest place of the centre, z, and its extremes in x \[m\]: `[[x, x], [z, z]]`.
    pub fn reach_m(&self) -> [[f64; 2]; 2] {
        let mut playback = Playback::new(&self.run);
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for look in 0..=LOOKS {
            let motion = playback.at(self.run.end().t * f64::from(look) / f64::from(LOOKS));
            let place = self
                .prepared
                .model
                .scales
                .to_si([motion.state.x, motion.state.y]);
            for (range, value) in reach.iter_mut().zip(place) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        reach
    }
}

/// The value below which this part of the sorted values lies.
pub fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let at = part.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(last);
    Some(sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64))
}
