//! One structure, from its case to what an engineer asks: do the lines go slack, how hard do they
//! snap, do they break?

use super::design::{Check, checks};
use super::outcome::{Outcome, Tally};
use super::quantile::{quantile, sorted};
use crate::options::{NEIGHBOURS, check};
use crate::physics::periods::NaturalPeriods;
use crate::physics::prepared::Prepared;
use crate::physics::sea::uniform;
use crate::physics::snap::Snap;
use crate::physics::warnings::{Warning, limits_afloat, phase_warning, turning_warning, warnings};
use crate::structure::{Structure, Water};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;
use snapload::analysis::{
    Counter, OnProgress, Progress, Trust, TrustMonitor, Unfinished, in_parallel, record,
};
use snapload::{Playback, Trajectory};
use std::ops::ControlFlow;

/// A state is known while its standard deviation is below this, in the engine's units.
const TOLERANCE: f64 = 1e-3;
/// Neighbours are so far from the run, in parts of the waves' height.
pub const NEIGHBOUR: f64 = 1e-6;
/// The restitution of a line is hardly known better than this.
const RESTITUTION: f64 = 0.2;
/// Times between the start and the end at which the place of the body is looked at.
const LOOKS: u32 = 20_000;

/// A structure that was run.
#[derive(Clone, Debug)]
pub struct Assessment {
    /// Structure, place of rest, model.
    pub prepared: Prepared,
    /// Rules of thumb that the case breaks.
    pub warnings: Vec<Warning>,
    /// In which it swings by itself, submerged; of a floating body [`Prepared`] tells.
    pub periods: Option<NaturalPeriods>,
    /// The motion.
    pub run: Trajectory,
    /// How far it can be trusted.
    pub trust: Trust,
    /// Every snap, the slow ones included.
    pub snaps: Vec<Snap>,
    /// What it comes to.
    pub outcome: Outcome,
    /// The same with less and with more restitution, each with its coefficient; empty without
    /// neighbours.
    pub restitutions: Vec<(f64, Outcome)>,
    /// Neighbours of the run; empty in still water, where there are no waves to vary.
    pub neighbours: Vec<Outcome>,
}

/// What the verdict would rest on with some restitution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ByRestitution {
    /// e.
    pub restitution: f64,
    /// The largest utilisation of any line; none where that of one is not known.
    pub largest_utilisation: Option<f64>,
    /// The fastest snap of any line; none where nothing is judged \[m/s\].
    pub fastest_snap_m_s: Option<f64>,
}

/// As many neighbours as there are where nothing else is said.
pub const DEFAULT_NEIGHBOURS: u32 = 40;

/// Runs a structure with its neighbours.
///
/// # Errors
/// A [`snapload::CaseError`] if more neighbours than [`NEIGHBOURS`] are asked for, the structure rests
/// nowhere or can not start, and
/// [`Unfinished::Cancelled`].
pub fn assess(
    structure: Structure,
    neighbours: u32,
    on_progress: OnProgress,
) -> Result<Assessment, Unfinished> {
    check(&NEIGHBOURS, i64::from(neighbours))?;
    let prepared = Prepared::new(structure)?;
    let others = Others::new(&prepared, neighbours);
    let counter = Counter::new("runs", 0, 1 + others.len() as u64, on_progress);
    // Within a run nothing is counted, but it may be cancelled.
    let within = |_: Progress| match counter.add(0) {
        Ok(()) => ControlFlow::Continue(()),
        Err(_) => ControlFlow::Break(()),
    };
    // The run that is followed takes the longest, and is the first to begin.
    let runs = in_parallel(1 + others.len(), |index| {
        let run = match index.checked_sub(1) {
            None => Run::Followed(Box::new(Followed::new(&prepared, &within)?)),
            Some(index) => Run::Other(others.run(index)?),
        };
        counter.add(1)?;
        Ok::<_, Unfinished>(run)
    })?;
    let (mut followed, mut outcomes) = (None, Vec::new());
    for run in runs {
        match run {
            Run::Followed(run) => followed = Some(run),
            Run::Other(outcome) => outcomes.push(outcome),
        }
    }
    let (restitutions, neighbours) = others.part(outcomes);
    let followed = followed.expect("the first of the runs is followed");
    Ok(Assessment {
        restitutions,
        neighbours,
        ..Assessment::of_run(prepared, *followed)
    })
}

/// One of the runs of an assessment.
enum Run {
    Followed(Box<Followed>),
    Other(Outcome),
}

/// The run of the case, with all that is kept of it.
struct Followed {
    run: Trajectory,
    trust: Trust,
    snaps: Vec<Snap>,
    outcome: Outcome,
}

impl Followed {
    fn new(prepared: &Prepared, on_progress: OnProgress) -> Result<Self, Unfinished> {
        let simulation = prepared.begin(1.0)?;
        let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], TOLERANCE);
        let mut tally = Tally::new(prepared);
        let mut snaps = Vec::new();
        let run = record(simulation, on_progress, |simulation, step| {
            monitor.follow(simulation, step);
            snaps.extend(tally.follow(simulation, step));
        })?;
        Ok(Self {
            trust: monitor.verdict(),
            outcome: tally.finish(run.end().t, run.end().reason),
            run,
            snaps,
        })
    }
}

/// The runs beside that of the case: with less and with more restitution, and then its neighbours.
struct Others<'a> {
    prepared: &'a Prepared,
    restitutions: Vec<f64>,
    /// None in still water, where there are no waves to vary.
    neighbours: usize,
}

impl<'a> Others<'a> {
    fn new(prepared: &'a Prepared, neighbours: u32) -> Self {
        let still = matches!(prepared.structure.water, Water::Still);
        Self {
            prepared,
            restitutions: restitutions_about(prepared.structure.restitution),
            neighbours: if still { 0 } else { neighbours as usize },
        }
    }

    fn len(&self) -> usize {
        self.restitutions.len() + self.neighbours
    }

    fn run(&self, index: usize) -> Result<Outcome, Unfinished> {
        let Self {
            prepared,
            restitutions,
            ..
        } = self;
        let outcome = match index.checked_sub(restitutions.len()) {
            None => Outcome::of(&prepared.with_restitution(restitutions[index]), 1.0)?,
            Some(index) => Outcome::of(prepared, 1.0 + NEIGHBOUR * side(index as u32))?,
        };
        Ok(outcome)
    }

    /// Those with another restitution, each with its own, and the neighbours.
    fn part(&self, mut outcomes: Vec<Outcome>) -> (Vec<(f64, Outcome)>, Vec<Outcome>) {
        let neighbours = outcomes.split_off(self.restitutions.len());
        let restitutions = self.restitutions.iter().copied().zip(outcomes);
        (restitutions.collect(), neighbours)
    }
}

/// Less and more restitution than that of the case, as far as there is.
fn restitutions_about(restitution: f64) -> Vec<f64> {
    let others = [-RESTITUTION, RESTITUTION].map(|more| (restitution + more).clamp(0.0, 1.0));
    others
        .into_iter()
        .filter(|other| *other != restitution)
        .collect()
}

/// Evenly in [−1, 1), for each neighbour its own.
fn side(index: u32) -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    generator.set_stream(u64::from(index));
    2.0 * uniform(&mut generator) - 1.0
}

impl Assessment {
    /// Runs a structure by itself: its verdict, without neighbours and without other restitutions.
    ///
    /// # Errors
    /// Those of [`assess`].
    pub fn alone(structure: Structure, on_progress: OnProgress) -> Result<Self, Unfinished> {
        let prepared = Prepared::new(structure)?;
        let followed = Followed::new(&prepared, on_progress)?;
        Ok(Self::of_run(prepared, followed))
    }

    fn of_run(prepared: Prepared, followed: Followed) -> Self {
        let Followed {
            run,
            trust,
            snaps,
            outcome,
        } = followed;
        let mut assessment = Self {
            warnings: warnings(&prepared),
            periods: NaturalPeriods::of(&prepared),
            run,
            trust,
            snaps,
            outcome,
            restitutions: Vec::new(),
            neighbours: Vec::new(),
            prepared,
        };
        let found = assessment.warnings_of_the_run();
        assessment.warnings.extend(found);
        assessment
    }

    /// What is seen once it has moved: how far it went, how far it turned, how it lay in the water.
    fn warnings_of_the_run(&self) -> Vec<Warning> {
        let structure = &self.prepared.structure;
        let ([x, z], [sides, _]) = (self.prepared.rest.place_m, self.reach_m());
        let excursion = (sides[1] - x).max(x - sides[0]);
        let turned = self.outcome.turned_rad;
        let phase = phase_warning(structure, z, excursion);
        let turning = turning_warning(structure, turned);
        let limits = limits_afloat(structure, self.outcome.waterline.as_ref(), turned);
        phase.into_iter().chain(turning).chain(limits).collect()
    }

    /// The same with so many neighbours, and with less and with more restitution.
    ///
    /// # Errors
    /// Those of [`assess`].
    pub fn with_neighbours(
        mut self,
        neighbours: u32,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let others = Others::new(&self.prepared, neighbours);
        let counter = Counter::new("neighbours", 0, others.len() as u64, on_progress);
        let outcomes = in_parallel(others.len(), |index| {
            let outcome = others.run(index)?;
            counter.add(1)?;
            Ok::<_, Unfinished>(outcome)
        })?;
        (self.restitutions, self.neighbours) = others.part(outcomes);
        Ok(self)
    }

    /// Time up to which the run can be trusted \[s\]; none if all of it.
    pub fn horizon_s(&self) -> Option<f64> {
        let time = self.prepared.model.scales.time_s;
        self.trust.horizon.map(|horizon| horizon.t * time)
    }

    /// What the verdict would rest on with less and with more restitution, the least first.
    pub fn by_restitution(&self) -> Vec<ByRestitution> {
        let structure = &self.prepared.structure;
        let of = |restitution: f64, outcome: &Outcome| {
            let all: Option<Vec<f64>> = outcome.utilisations(structure).into_iter().collect();
            ByRestitution {
                restitution,
                largest_utilisation: all.map(|all| all.into_iter().fold(0.0, f64::max)),
                fastest_snap_m_s: (!outcome.is_unjudged()).then(|| outcome.speed_m_s()),
            }
        };
        let mut rows = vec![of(structure.restitution, &self.outcome)];
        rows.extend(self.restitutions.iter().map(|(e, outcome)| of(*e, outcome)));
        rows.sort_by(|a, b| a.restitution.total_cmp(&b.restitution));
        rows
    }

    /// The checks by the rule of the case, and the neighbours that agree with each.
    pub fn checks(&self) -> Vec<(Check, usize)> {
        let open = self
            .warnings
            .iter()
            .any(|warning| warning.decided_by.is_some());
        let of = |outcome: &Outcome| checks(&self.prepared, outcome, open);
        let neighbours: Vec<Vec<Check>> = self.neighbours.iter().map(of).collect();
        let own = of(&self.outcome).into_iter().enumerate();
        let with_count = |(index, check): (usize, Check)| {
            let same = |other: &&Vec<Check>| other[index].answer == check.answer;
            let count = neighbours.iter().filter(same).count();
            (check, count)
        };
        own.map(with_count).collect()
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

    /// 5 %, 50 % and 95 % of the neighbours' largest tension in a snap; none where there is none,
    /// or one of them ended before anything is judged \[N\].
    pub fn spread(&self) -> Option<[f64; 3]> {
        let unjudged = self.neighbours.iter().any(Outcome::is_unjudged);
        if unjudged || !self.prepared.structure.tensions_known() {
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
