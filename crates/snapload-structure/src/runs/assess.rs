//! The assessment of one structure: do the lines go slack, how hard do they snap, do they break?

use super::design::{Check, checks};
use super::further::{FurtherOutcomes, FurtherRuns};
use super::neighbours::{spread, with_agreeing};
use super::outcome::{Outcome, OutcomeCounter};
use crate::options::{NEIGHBOURS, check};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::periods::NaturalPeriods;
use crate::physics::sea_records::short_run;
use crate::physics::snap::Snap;
use crate::physics::warning::Warning;
use crate::physics::warnings::{limits_afloat, phase_warning, turning_warning, warnings};
use crate::structure::{Structure, Wave};
use snapload::analysis::{
    Counter, OnProgress, Trust, TrustMonitor, Unfinished, in_parallel, record,
};
use snapload::{Playback, Trajectory};

/// A state counts as known while its standard deviation is below this, in the engine's units.
pub(crate) const TOLERANCE: f64 = 1e-3;
/// Times between the start and the end at which the position of the body is evaluated.
const POSITION_SAMPLES: u32 = 20_000;

/// A structure that was run.
#[derive(Clone, Debug)]
pub struct Assessment {
    /// Structure, position of rest, model.
    pub prepared: ModelAtRest,
    /// Rules of thumb that the case violates.
    pub warnings: Vec<Warning>,
    /// The natural periods of a submerged body; those of a floating one are in [`ModelAtRest`].
    pub periods: Option<NaturalPeriods>,
    /// The motion.
    pub run: Trajectory,
    /// How far the run can be trusted.
    pub trust: Trust,
    /// Every snap, the slow ones included.
    pub snaps: Vec<Snap>,
    /// Its outcome.
    pub outcome: Outcome,
    /// The same with less and with more restitution, each with its coefficient; empty without
    /// neighbours.
    pub restitutions: Vec<(f64, Outcome)>,
    /// The same in regular waves that are slightly lower, higher, shorter and longer; empty without
    /// neighbours, in a sea and in still water.
    pub waves: Vec<(Wave, Outcome)>,
    /// Neighbours of the run; empty in still water, where there are no waves to vary.
    pub neighbours: Vec<Outcome>,
}

/// The number of neighbours unless given.
pub const DEFAULT_NEIGHBOURS: u32 = 40;

/// Runs a structure with its neighbours.
///
/// # Errors
/// A [`snapload::CaseError`] if more neighbours than [`NEIGHBOURS`] are requested, the structure
/// rests nowhere or can not start, and [`Unfinished::Cancelled`].
pub fn assess(
    structure: Structure,
    neighbours: u32,
    on_progress: OnProgress,
) -> Result<Assessment, Unfinished> {
    check(&NEIGHBOURS, i64::from(neighbours))?;
    let prepared = ModelAtRest::new(structure)?;
    let further = FurtherRuns::new(&prepared, neighbours);
    let counter = Counter::new("runs", 0, 1 + further.len() as u64, on_progress);
    // The run of the case takes longest, and therefore begins first.
    let runs = in_parallel(1 + further.len(), |index| {
        counter.part(|within| match index.checked_sub(1) {
            None => RecordedRun::new(&prepared, within).map(|run| Run::Recorded(Box::new(run))),
            Some(index) => further.run(index, within).map(Run::Other),
        })
    })?;
    let (mut recorded, mut outcomes) = (None, Vec::new());
    for run in runs {
        match run {
            Run::Recorded(run) => recorded = Some(run),
            Run::Other(outcome) => outcomes.push(outcome),
        }
    }
    let further = further.sorted(outcomes);
    let recorded = recorded.expect("the first of the runs is followed");
    let alone = Assessment::of_run(prepared, *recorded);
    Ok(alone.with_further(further))
}

/// One of the runs of an assessment.
enum Run {
    Recorded(Box<RecordedRun>),
    Other(Outcome),
}

/// The run of the case, with everything that is recorded of it.
struct RecordedRun {
    run: Trajectory,
    trust: Trust,
    snaps: Vec<Snap>,
    outcome: Outcome,
}

impl RecordedRun {
    fn new(prepared: &ModelAtRest, on_progress: OnProgress) -> Result<Self, Unfinished> {
        let simulation = prepared.begin(1.0)?;
        let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], TOLERANCE);
        let mut outcome_counter = OutcomeCounter::new(prepared);
        let mut snaps = Vec::new();
        let run = record(simulation, on_progress, |simulation, step| {
            monitor.follow(simulation, step);
            snaps.extend(outcome_counter.add_step(simulation, step));
        })?;
        Ok(Self {
            trust: monitor.verdict(),
            outcome: outcome_counter.finish(run.end().t, run.end().reason),
            run,
            snaps,
        })
    }
}

impl Assessment {
    /// Runs a structure by itself: its verdict, without neighbours and without other restitutions.
    ///
    /// # Errors
    /// Those of [`assess`].
    pub fn single_run(structure: Structure, on_progress: OnProgress) -> Result<Self, Unfinished> {
        let prepared = ModelAtRest::new(structure)?;
        let recorded = RecordedRun::new(&prepared, on_progress)?;
        Ok(Self::of_run(prepared, recorded))
    }

    fn of_run(prepared: ModelAtRest, recorded: RecordedRun) -> Self {
        let RecordedRun {
            run,
            trust,
            snaps,
            outcome,
        } = recorded;
        let mut assessment = Self {
            warnings: warnings(&prepared),
            periods: NaturalPeriods::of(&prepared),
            run,
            trust,
            snaps,
            outcome,
            restitutions: Vec::new(),
            waves: Vec::new(),
            neighbours: Vec::new(),
            prepared,
        };
        let found = assessment.warnings_of_the_run();
        assessment.warnings.extend(found);
        assessment
    }

    /// The warnings that follow from the motion: its extent, its rotation, its extreme positions in
    /// the water.
    fn warnings_of_the_run(&self) -> Vec<Warning> {
        let structure = &self.prepared.structure;
        let ([x, z], [sides, _]) = (self.prepared.rest.place_m, self.reach_m());
        let excursion = (sides[1] - x).max(x - sides[0]);
        let turned = self.outcome.turned_rad;
        let phase = phase_warning(structure, z, excursion);
        let turning = turning_warning(structure, turned);
        let depends = self.outcome.depends_on_hydrostatics(structure);
        let limits = limits_afloat(structure, self.outcome.waterline.as_ref(), turned, depends);
        let short = short_run(structure, self.outcome.stop).into_iter();
        let emergence = self.outcome.emergence.warning(depends);
        let limits = limits.into_iter().chain(emergence);
        short.chain(phase).chain(turning).chain(limits).collect()
    }

    /// The same with `count` neighbours, with less and with more restitution, and in other waves.
    ///
    /// # Errors
    /// Those of [`assess`].
    pub fn with_neighbours(
        self,
        neighbours: u32,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let further = FurtherRuns::new(&self.prepared, neighbours);
        let counter = Counter::new("neighbours", 0, further.len() as u64, on_progress);
        let outcomes = in_parallel(further.len(), |index| {
            counter.part(|within| further.run(index, within))
        })?;
        let further = further.sorted(outcomes);
        Ok(self.with_further(further))
    }

    fn with_further(mut self, further: FurtherOutcomes) -> Self {
        self.restitutions = further.restitutions;
        self.waves = further.waves;
        self.neighbours = further.neighbours;
        self
    }

    /// Time up to which the run can be trusted \[s\]; none if all of it.
    pub fn horizon_s(&self) -> Option<f64> {
        let time = self.prepared.model.scales.time_s;
        self.trust.horizon.map(|horizon| horizon.t * time)
    }

    /// The largest tension of each line divided by its breaking load, if that is known: of the
    /// motion, and of rest where the lines stretch and share the load by that.
    pub fn utilisations(&self) -> Vec<Option<f64>> {
        let structure = &self.prepared.structure;
        let of_motion = self.outcome.utilisations(structure).into_iter();
        let with_rest = |(line, part): (usize, Option<f64>)| {
            let at_rest_n = self.prepared.rest.stretched_n(line).unwrap_or(0.0);
            let load_n = structure.lines[line].breaking_load_n?;
            Some(part?.max(at_rest_n / load_n))
        };
        of_motion.enumerate().map(with_rest).collect()
    }

    /// The checks by the rule of the case, and the neighbours that agree with each.
    pub fn checks(&self) -> Vec<(Check, usize)> {
        let open = self.warnings.iter().any(|warning| warning.leaves_open);
        let of = |outcome: &Outcome| checks(&self.prepared, outcome, open);
        let neighbours: Vec<Vec<Check>> = self.neighbours.iter().map(of).collect();
        with_agreeing(of(&self.outcome), &neighbours)
    }

    /// The judged snaps: those that count, after the transient.
    pub fn judged(&self) -> impl Iterator<Item = &Snap> {
        let transient_s = self.prepared.structure.transient_s;
        let snaps = self.snaps.iter();
        snaps.filter(move |snap| snap.is_judged(transient_s))
    }

    /// The extreme positions of the centre \[m\]: `[[x, x], [z, z]]`.
    pub fn reach_m(&self) -> [[f64; 2]; 2] {
        let mut playback = Playback::new(&self.run);
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for look in 0..=POSITION_SAMPLES {
            let t = self.run.end().t * f64::from(look) / f64::from(POSITION_SAMPLES);
            let state = playback.at(t).state;
            let place = self.prepared.model.scales.to_si([state.x, state.y]);
            for (range, value) in reach.iter_mut().zip(place) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        reach
    }

    /// 5 %, 50 % and 95 % quantiles of the neighbours' largest tension in a snap; none if there is
    /// none, or one of them ended before the judged time \[N\].
    pub fn spread(&self) -> Option<[f64; 3]> {
        let known = self.prepared.structure.tensions_known();
        let peak_n = |outcome: &Outcome| outcome.peak_n().unwrap_or(0.0);
        spread(&self.neighbours, peak_n).filter(|_| known)
    }
}
