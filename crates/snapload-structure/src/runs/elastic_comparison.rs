//! The same case on elastic and on inextensible lines.

use super::design::{Answer, Check, checks};
use super::outcome::{Outcome, add_slack};
use crate::options::{STIFFER, check};
use crate::physics::elastic::{
    ElasticLine, ElasticRun, Stepping, elastic_lines, run_elastic, run_in_steps,
};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::sea_records::short_run;
use crate::physics::snap::{Snap, snaps_of_step};
use crate::physics::warning::Warning;
use crate::physics::warnings::{limits_afloat, phase_warning, turning_warning, warnings};
use crate::runs::assess::TOLERANCE;
use snapload::analysis::{OnProgress, Unfinished};
use snapload::{CaseError, Stop};
use std::time::Instant;

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
    let elastic = run_elastic(&elastic_case, &elastic_lines, every_s, on_progress)?;
    let repeated = Repeated::of(&elastic_case, &elastic_lines, &elastic, on_progress)?;
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
        inextensible,
    })
}

impl ElasticComparison {
    /// The checks by the rule of the case, of the elastic lines; open where the motion in shorter
    /// steps has another answer.
    pub fn checks(&self) -> Vec<Check> {
        let open = self.warnings().iter().any(|warning| warning.leaves_open);
        let [mut all, other] =
            [&self.outcome, &self.repeated.outcome].map(|of| checks(&self.elastic_case, of, open));
        for (check, other) in all.iter_mut().zip(other) {
            if check.answer != other.answer {
                check.answer = Answer::Open;
            }
        }
        all
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
    fn of(
        elastic_case: &ModelAtRest,
        elastic_lines: &[ElasticLine],
        first: &ElasticRun,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let shorter = Stepping::SHORTER;
        let run = run_in_steps(
            elastic_case,
            elastic_lines,
            shorter,
            f64::INFINITY,
            on_progress,
        )?;
        let duration_s = elastic_case.structure.duration_s;
        Ok(Self {
            outcome: Outcome::of_pulls(elastic_case, &run),
            horizon_s: first.agrees_until(&run, TOLERANCE, duration_s),
        })
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
