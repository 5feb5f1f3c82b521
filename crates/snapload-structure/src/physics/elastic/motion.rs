//! The motion on elastic lines.
//!
//! Between the instants at which a line begins or ceases to pull the forces are smooth. So the
//! motion is integrated from one such instant to the next with the set of pulling lines fixed, by
//! the Dormand-Prince pair of order 8.
//!
//! Library: `differential-equations` (DOP853 with dense output, few dependencies). Its own event
//! detection misses events in the first step and two crossings within one step, so only its
//! integrator is used.

use super::body::BodyOnElasticLines;
use super::law::ElasticLine;
use super::phase::{Change, Components, Phase, STATE_WITHOUT_MEMORY, exceeded, state_of};
use super::record::{ElasticRun, PullRecorder};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::rates::check_rate_on_elastic_lines;
use snapload::analysis::{OnProgress, Progress, Unfinished};
use snapload::{CaseError, TautSet};

/// How finely a motion is integrated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepping {
    /// Tolerance of a step, relative and absolute, in the engine's units.
    tolerance: f64,
    /// Steps are no longer than this part of 1/ω, ω = sqrt(k w) of the stiffest pulling line, so
    /// that what is looked for in a step, and in how many places, does not depend on the stiffness.
    longest: f64,
}

impl Stepping {
    /// That of every answer.
    pub(crate) const USUAL: Self = Self {
        tolerance: 1e-11,
        longest: 0.25,
    };
    /// A finer one, to be compared with it. Its error has to be much smaller even where the forces
    /// have a kink, as quadratic drag has in still water: then it falls as a low power of the step.
    pub(crate) const SHORTER: Self = Self {
        tolerance: 1e-13,
        longest: 0.125,
    };
}

/// The number of such steps between two checks whether to stop.
const STEPS_PER_CHECK: f64 = 4000.0;
/// The longest integration in one call while no line pulls.
const LONGEST_SLACK_CALL: f64 = 1.0;
/// The number of components for a body with a usual memory, and with the longest one supported.
const STATE_WITH_MEMORY: usize = STATE_WITHOUT_MEMORY + 2 * USUAL_MEMORY;
const LARGEST_STATE: usize = STATE_WITHOUT_MEMORY + 2 * MOST_MEMORY;
/// The usual number of memory states of a mirror-symmetric body.
const USUAL_MEMORY: usize = 32;
const LONG_MEMORY: usize = USUAL_MEMORY + 1;
/// The largest number: that of twelve pairs of poles for each degree of freedom, and some more for
/// memories that are given.
const MOST_MEMORY: usize = 64;

/// Runs a structure on elastic lines, to the end of its duration or until it is turned by a
/// quarter or touches the floor. The state is kept at every multiple of `every_s` and at the end,
/// or nowhere if that is infinite.
///
/// # Errors
/// A [`CaseError`] if there are not as many springs as lines, or the integrator fails, and
/// [`Unfinished::Cancelled`].
pub fn run_elastic(
    prepared: &ModelAtRest,
    elastic_lines: &[ElasticLine],
    every_s: f64,
    on_progress: OnProgress,
) -> Result<ElasticRun, Unfinished> {
    run_in_steps(
        prepared,
        elastic_lines,
        Stepping::USUAL,
        every_s,
        on_progress,
    )
}

/// The same, integrated as finely as that.
pub(crate) fn run_in_steps(
    prepared: &ModelAtRest,
    elastic_lines: &[ElasticLine],
    stepping: Stepping,
    every_s: f64,
    on_progress: OnProgress,
) -> Result<ElasticRun, Unfinished> {
    let model = &prepared.model;
    if elastic_lines.len() != model.system.cables.len() {
        let shown = elastic_lines.len().to_string();
        return Err(CaseError::value("springs", shown, "one for each line").into());
    }
    let body = BodyOnElasticLines::new(&model.system, elastic_lines);
    check_rate_on_elastic_lines(&prepared.structure, model, body.quickest_of_all())?;
    let record = PullRecorder::new(prepared, &body, every_s)?;
    match model.system.memory_at_rest().len() {
        0 => run::<STATE_WITHOUT_MEMORY>(&body, stepping, record, on_progress),
        1..=USUAL_MEMORY => run::<STATE_WITH_MEMORY>(&body, stepping, record, on_progress),
        LONG_MEMORY..=MOST_MEMORY => run::<LARGEST_STATE>(&body, stepping, record, on_progress),
        states => {
            let allowed = format!("a memory of at most {MOST_MEMORY} states with elastic lines");
            Err(CaseError::value("float.pairs", format!("({states} states)"), allowed).into())
        }
    }
}

fn run<const N: usize>(
    body: &BodyOnElasticLines<'_>,
    stepping: Stepping,
    mut record: PullRecorder<'_>,
    on_progress: OnProgress,
) -> Result<ElasticRun, Unfinished> {
    let prepared = record.prepared();
    let (mut t, mut state, mut fresh) = (0.0, prepared.start(), TautSet::SLACK);
    let mut components: Components<N> = [0.0; N];
    components[..STATE_WITHOUT_MEMORY].copy_from_slice(&state.components());
    let mut pulling = body.pulling(&state);
    record.change(t, &state, TautSet::SLACK, pulling);
    let (rules, system) = (&prepared.model.rules, &prepared.model.system);
    let mut stop = exceeded(system, rules, &state).find_map(Change::stop);
    while t < rules.t_end && stop.is_none() {
        Progress::new("elastic lines", t, rules.t_end).report(on_progress)?;
        let longest_step = stepping.longest / body.quickest(&state, pulling);
        let until = rules
            .t_end
            .min(t + LONGEST_SLACK_CALL.min(STEPS_PER_CHECK * longest_step));
        let phase = Phase {
            body,
            rules,
            begin: t,
            pulling,
            tolerance: stepping.tolerance,
            longest_step,
        };
        let (s, reached, changed) = phase.follow(until - t, components, &mut fresh, &mut record)?;
        (components, state) = (reached, state_of(&reached));
        t = if changed.is_some() { t + s } else { until };
        match changed {
            None => {}
            Some(change @ Change::Limit(..)) => {
                stop = change.stop();
                record.add(t, &state, pulling);
            }
            Some(Change::Line(line)) => {
                let before = pulling;
                pulling = match pulling.contains(line) {
                    true => pulling.without(line),
                    false => pulling.with(line),
                };
                fresh = fresh.with(line);
                record.add(t, &state, before);
                record.change(t, &state, before, pulling);
            }
        }
    }
    Ok(record.finish(t, state, pulling, stop))
}
