//! The same case on elastic and on inextensible lines.

use super::design::{Answer, Check, checks};
use super::neighbours::{
    FEWEST_NEIGHBOURS, count_of_neighbours, height_of_neighbour, spread, with_agreeing,
};
use super::outcome::{Outcome, add_slack};
use crate::options::{NEIGHBOURS, STIFFER, check};
use crate::physics::elastic::{
    ElasticLine, ElasticRun, Stepping, elastic_lines, run_elastic, run_in_steps,
};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::sea_records::short_run;
use crate::physics::snap::{Snap, snaps_of_step};
use crate::physics::warning::Warning;
use crate::physics::warnings::{limits_afloat, phase_warning, turning_warning, warnings};
use crate::runs::assess::TOLERANCE;
use snapload::analysis::{Counter, OnProgress, Unfinished, in_parallel};
use snapload::{CaseError, Stop};
use std::time::Instant;

/// The number of neighbours of a motion on elastic lines unless given: no more than are needed, as
/// each takes as long as the motion itself.
pub const DEFAULT_ELASTIC_NEIGHBOURS: u32 = FEWEST_NEIGHBOURS as u32;

/// What progress calls the runs, and how often the motion itself is integrated.
const DOING: &str = "elastic lines";
const INTEGRATIONS: u64 = 2;

/// The same case on both models of a line.
#[derive(Clone, Debug)]
pub struct ElasticComparison {
    /// Structure, position of rest, model.
    pub prepared: ModelAtRest,
    /// The factor by which the lines' stiffness was multiplied.
    pub stiffer: f64,
    /// The elastic lines.
    pub elastic_lines: Vec<ElasticLine>,
    /// The same about its position of rest on these lines.
    pub elastic_case: ModelAtRest,
    /// The motion on them.
    pub elastic: ElasticRun,
    /// Its outcome.
    pub outcome: Outcome,
    /// Time that its computation took, and that in shorter steps \[s\].
    pub elastic_took_s: f64,
    /// The same motion, integrated in shorter steps.
    pub repeated: Repeated,
    /// Neighbours of it; none unless [`Self::with_neighbours`] runs them.
    pub neighbours: Vec<Outcome>,
    /// The same on inextensible lines; none if the case starts beyond their reach.
    pub inextensible: Option<Inextensible>,
}

/// A motion on elastic lines integrated once more, in shorter steps. What differs is rounding and
/// the error of the steps, which a chaotic motion makes as large as itself.
#[derive(Clone, Debug)]
pub struct Repeated {
    /// Its outcome.
    pub outcome: Outcome,
    /// The time up to which both are within a thousandth of the unit of length of each other; none
    /// if to the end \[s\].
    pub horizon_s: Option<f64>,
}

/// A motion on inextensible lines.
#[derive(Clone, Debug)]
pub struct Inextensible {
    /// The snaps, without slow ones and impacts while taut.
    pub snaps: Vec<Snap>,
    /// The part of the time in which each line is slack.
    pub slack_fraction: Vec<f64>,
    /// How it ended.
    pub stop: Stop,
    /// When it ended \[s\].
    pub end_s: f64,
    /// Time that its computation took \[s\].
    pub took_s: f64,
}

/// Runs a structure on lines `stiffer` times as stiff as they are, from its position of rest on
/// them unless the case gives a start, and on inextensible lines; the motion on the former
/// is kept every `every_s` seconds.
///
/// # Errors
/// A [`CaseError`] unless `stiffer` is of [`STIFFER`], if a line has no stiffness, or the
/// integrator gives up, and [`Unfinished::Cancelled`].
pub fn compare_elastic(
    prepared: ModelAtRest,
    stiffer: f64,
    every_s: f64,
    on_progress: OnProgress,
) -> Result<ElasticComparison, Unfinished> {
    check(&STIFFER, stiffer)?;
    let elastic_lines = elastic_lines(&prepared, stiffer)?;
    let clock = Instant::now();
    let elastic_case = prepared.with_elastic_lines(&elastic_lines)?;
    let steps = [
        (Stepping::USUAL, every_s),
        (Stepping::SHORTER, f64::INFINITY),
    ];
    let counter = Counter::new(DOING, 0, INTEGRATIONS, on_progress);
    let runs = in_parallel(steps.len(), |index| {
        let (stepping, every_s) = steps[index];
        counter
            .part(|within| run_in_steps(&elastic_case, &elastic_lines, stepping, every_s, within))
    })?;
    let [elastic, shorter] = <[ElasticRun; 2]>::try_from(runs).expect("one run for each stepping");
    let repeated = Repeated::of(&elastic_case, &elastic, &shorter);
    let elastic_took_s = clock.elapsed().as_secs_f64();
    let inextensible = match prepared.starts_within_reach() {
        true => Some(Inextensible::of(&prepared, stiffer)?),
        false => None,
    };
    Ok(ElasticComparison {
        outcome: Outcome::of_pulls(&elastic_case, &elastic),
        prepared,
        stiffer,
        elastic_lines,
        elastic_case,
        elastic,
        elastic_took_s,
        repeated,
        neighbours: Vec::new(),
        inextensible,
    })
}

impl ElasticComparison {
    /// The same with neighbours of the motion on elastic lines.
    ///
    /// # Errors
    /// A [`CaseError`] if more than [`NEIGHBOURS`] are requested, or the integrator gives up, and
    /// [`Unfinished::Cancelled`].
    pub fn with_neighbours(
        mut self,
        neighbours: u32,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        check(&NEIGHBOURS, i64::from(neighbours))?;
        let (case, lines) = (&self.elastic_case, &self.elastic_lines);
        let count = count_of_neighbours(&case.structure, neighbours);
        let counter = Counter::new(
            DOING,
            INTEGRATIONS,
            INTEGRATIONS + count as u64,
            on_progress,
        );
        self.neighbours = in_parallel(count, |index| {
            counter.part(|within| {
                let other = case.in_waves_times(height_of_neighbour(index));
                let run = run_elastic(&other, lines, f64::INFINITY, within)?;
                Ok::<_, Unfinished>(Outcome::of_pulls(&other, &run))
            })
        })?;
        Ok(self)
    }

    /// 5 %, 50 % and 95 % quantiles of the neighbours' largest tension; none if there are none, or
    /// one of them ended before the judged time \[N\].
    pub fn spread(&self) -> Option<[f64; 3]> {
        spread(&self.neighbours, Outcome::largest_n)
    }

    /// The checks by the rule of the case, of the elastic lines, and the neighbours that have the
    /// answer of the motion. One is open where the motion in shorter steps has another answer, or
    /// where the motion passes it but a neighbour does not, or it is not known to its end and few
    /// neighbours were run.
    pub fn checks(&self) -> Vec<(Check, usize)> {
        let open = self.warnings().iter().any(|warning| warning.leaves_open);
        let of = |outcome: &Outcome| checks(&self.elastic_case, outcome, open);
        let neighbours: Vec<Vec<Check>> = self.neighbours.iter().map(of).collect();
        let own = of(&self.outcome);
        let shorter = of(&self.repeated.outcome).into_iter();
        let differs: Vec<bool> = (own.iter().zip(shorter))
            .map(|(own, other)| own.answer != other.answer)
            .collect();
        let mut all = with_agreeing(own, &neighbours);
        let half_known = self.known_in_part_s().is_some();
        for ((check, _), differs) in all.iter_mut().zip(differs) {
            if differs || half_known && check.answer == Answer::Passes {
                check.answer = Answer::Open;
            }
        }
        all
    }

    /// Up to when the motion is known, if that is not to its end, and too few neighbours show which
    /// other motions there are after that \[s\].
    pub(crate) fn known_in_part_s(&self) -> Option<f64> {
        let few = self.neighbours.len() < FEWEST_NEIGHBOURS;
        self.repeated.horizon_s.filter(|_| few)
    }

    /// Rules of thumb that the case violates, except those that are decided by elastic lines.
    pub fn warnings(&self) -> Vec<Warning> {
        let (structure, run) = (&self.elastic_case.structure, &self.elastic);
        let depends = self.outcome.depends_on_hydrostatics(structure);
        warnings(&self.elastic_case)
            .into_iter()
            .chain(short_run(structure, self.outcome.stop))
            .chain(phase_warning(
                structure,
                self.elastic_case.rest.place_m[1],
                run.excursion_m,
            ))
            .chain(turning_warning(structure, run.turned_rad))
            .chain(limits_afloat(
                structure,
                run.waterline.as_ref(),
                run.turned_rad,
                depends,
            ))
            .chain(self.outcome.emergence.warning(depends))
            .filter(Warning::is_of_all_lines)
            .collect()
    }
}

impl Repeated {
    /// Of the motion in shorter steps, compared with that in the usual ones.
    fn of(elastic_case: &ModelAtRest, usual: &ElasticRun, shorter: &ElasticRun) -> Self {
        let duration_s = elastic_case.structure.duration_s;
        Self {
            outcome: Outcome::of_pulls(elastic_case, shorter),
            horizon_s: usual.agrees_until(shorter, TOLERANCE, duration_s),
        }
    }
}

impl Inextensible {
    /// How it ended and when, if that was before the end of the time.
    pub fn ended_early(&self) -> Option<(Stop, f64)> {
        (self.stop != Stop::EndTime).then_some((self.stop, self.end_s))
    }

    /// The tensions of its snaps are those of lines `stiffer` times as stiff as given.
    fn of(prepared: &ModelAtRest, stiffer: f64) -> Result<Self, CaseError> {
        let clock = Instant::now();
        let mut prepared = prepared.clone();
        for line in &mut prepared.structure.lines {
            line.stiffness_n = line.stiffness_n.map(|stiffness| stiffness * stiffer);
        }
        let prepared = &prepared;
        let mut simulation = prepared.begin(1.0)?;
        let (mut snaps, mut slack) = (Vec::new(), vec![0.0; prepared.structure.lines.len()]);
        while let Some(step) = simulation.step() {
            add_slack(&mut slack, &step);
            let found = snaps_of_step(prepared, &simulation, &step).into_iter();
            snaps.extend(found.filter(|snap| snap.counts() && !snap.is_impact_while_taut));
        }
        let end = simulation.time().max(f64::MIN_POSITIVE);
        let stop = simulation.stop().unwrap_or(Stop::EndTime);
        Ok(Self {
            snaps,
            slack_fraction: slack.into_iter().map(|time| time / end).collect(),
            stop,
            end_s: match stop {
                // The duration as it was given, not converted back from the engine's units.
                Stop::EndTime => prepared.structure.duration_s,
                _ => simulation.time() * prepared.model.scales.time_s,
            },
            took_s: clock.elapsed().as_secs_f64(),
        })
    }
}
