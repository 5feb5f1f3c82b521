//! The motion on elastic lines.
//!
//! Between the instants at which a line begins or ceases to pull the forces are smooth. So the
//! motion is integrated from one such instant to the next with the set of pulling lines fixed, by
//! the Dormand-Prince pair of order 8, and the instants are found on its dense output, at
//! [`SAMPLES_PER_STEP`] points of each step and then by bisection.
//!
//! Library: `differential-equations` (DOP853 with dense output, few dependencies). Its own event
//! detection misses events in the first step and two crossings within one step, so only its
//! integrator is used.

use super::body::BodyOnElasticLines;
use super::law::ElasticLine;
use super::record::{ElasticRun, PullRecorder};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::rates::check_rate_on_elastic_lines;
use differential_equations::ode::OrdinaryNumericalMethod;
use differential_equations::prelude::{Error, ExplicitRungeKutta, Interpolation, ODE, Status};
use snapload::analysis::{OnProgress, Progress, Unfinished};
use snapload::{CaseError, Rules, State, Stop, System, TautSet};

/// Tolerance of a step, relative and absolute, in the engine's units.
const TOLERANCE: f64 = 1e-11;
/// Steps are no longer than this part of 1/ω, ω = sqrt(k w) of the stiffest pulling line: the dense
/// output, on which releases are located, is of order 7 and would otherwise be less accurate than
/// the steps.
const STEP: f64 = 0.25;
/// The number of such steps between two checks whether to stop.
const STEPS_PER_CHECK: f64 = 4000.0;
/// The longest integration in one call while no line pulls.
const LONGEST_SLACK_CALL: f64 = 1.0;
/// Points in a step at which forces are evaluated.
const SAMPLES_PER_STEP: u32 = 16;
/// A negative force smaller than this just after a line has started or ceased to pull is rounding.
const NOISE: f64 = 1e-12;
/// A shorter time counts as zero.
const INSTANT: f64 = 10.0 * f64::EPSILON;

/// The components of a state, followed by the water's memory if the body has one, each of its
/// complex states as two numbers.
type Components<const N: usize> = [f64; N];

/// The number of components for a body without memory, with a usual memory, and with the longest
/// memory supported.
const STATE_WITHOUT_MEMORY: usize = 6;
const STATE_WITH_MEMORY: usize = STATE_WITHOUT_MEMORY + 2 * USUAL_MEMORY;
const LARGEST_STATE: usize = STATE_WITHOUT_MEMORY + 2 * MOST_MEMORY;
/// The usual number of memory states of a mirror-symmetric body.
const USUAL_MEMORY: usize = 32;
const LONG_MEMORY: usize = USUAL_MEMORY + 1;
/// The largest number: that of twelve pairs of poles for each degree of freedom, and some more for
/// memories that are given.
const MOST_MEMORY: usize = 64;

/// The motion with one set of pulling lines, from `begin` on.
struct Phase<'a, const N: usize> {
    body: &'a BodyOnElasticLines<'a>,
    rules: &'a Rules,
    begin: f64,
    pulling: TautSet,
    longest_step: f64,
}

/// What ends a phase.
#[derive(Clone, Copy)]
enum Change {
    /// A line begins or ceases to pull.
    Line(usize),
    /// A limit of the motion is reached.
    Limit(Stop),
}

/// The state among the components.
fn state_of<const N: usize>(y: &Components<N>) -> State {
    State::from_components(std::array::from_fn(|i| y[i]))
}

/// The water's memory among the components.
fn memory_of<const N: usize>(y: &Components<N>) -> &[[f64; 2]] {
    y[STATE_WITHOUT_MEMORY..].as_chunks().0
}

impl<const N: usize> ODE<f64, Components<N>> for Phase<'_, N> {
    fn diff(&self, s: f64, y: &Components<N>, dydt: &mut Components<N>) {
        let (state, memory) = (state_of(y), memory_of(y));
        let (motion, rates) = dydt.split_at_mut(STATE_WITHOUT_MEMORY);
        let rates = rates.as_chunks_mut().0;
        let t = self.begin + s;
        let [ax, ay, atheta] = self.body.rates(t, &state, memory, rates, self.pulling);
        motion.copy_from_slice(&[state.vx, state.vy, state.vtheta, ax, ay, atheta]);
    }
}

/// An integrator of N components with dense output.
trait Method<const N: usize>:
    OrdinaryNumericalMethod<f64, Components<N>> + Interpolation<f64, Components<N>>
{
}

impl<M, const N: usize> Method<N> for M where
    M: OrdinaryNumericalMethod<f64, Components<N>> + Interpolation<f64, Components<N>>
{
}

/// The integrator, from one time of a phase to another, step by step.
struct Steps<'a, M, const N: usize> {
    phase: &'a Phase<'a, N>,
    method: M,
    end: f64,
}

impl<'a, const N: usize> Phase<'a, N> {
    fn steps(
        &'a self,
        [start, end]: [f64; 2],
        y: Components<N>,
    ) -> Result<Steps<'a, impl Method<N>, N>, CaseError> {
        let method = ExplicitRungeKutta::dop853().rtol(TOLERANCE).atol(TOLERANCE);
        let mut method = method.h_max(self.longest_step);
        method
            .init(self, start, end, &y)
            .map_err(integration_error)?;
        Ok(Steps {
            phase: self,
            method,
            end,
        })
    }

    /// The event function of a line, which is positive as long as the line behaves as the phase
    /// assumes.
    fn until_change(&self, line: usize, state: &State) -> f64 {
        self.body
            .until_change(line, state, self.pulling.contains(line))
    }

    /// A line that no longer behaves as the phase assumes. `fresh` are lines that have just started
    /// or ceased to pull, and whose force is zero up to rounding.
    fn changed(&self, state: &State, fresh: &mut TautSet) -> Option<usize> {
        for line in 0..self.body.elastic_lines.len() {
            let left = self.until_change(line, state);
            if left > 0.0 {
                *fresh = fresh.without(line);
            } else if !fresh.contains(line) || left < -NOISE {
                return Some(line);
            }
        }
        None
    }

    /// The change that a state is beyond, if any.
    fn beyond(&self, state: &State, fresh: &mut TautSet) -> Option<Change> {
        let line = self.changed(state, fresh).map(Change::Line);
        line.or_else(|| exceeded(self.body.system, self.rules, state).map(Change::Limit))
    }

    /// Whether a state is not yet beyond a change.
    fn is_before(&self, change: Change, state: &State) -> bool {
        match change {
            Change::Line(line) => self.until_change(line, state) > 0.0,
            Change::Limit(_) => exceeded(self.body.system, self.rules, state).is_none(),
        }
    }

    /// Follows the phase until a line changes or a limit is reached, or for a time; returns the
    /// time, the components there, and the change.
    fn follow(
        &self,
        time: f64,
        start: Components<N>,
        fresh: &mut TautSet,
        record: &mut PullRecorder<'_>,
    ) -> Result<(f64, Components<N>, Option<Change>), CaseError> {
        let mut steps = self.steps([0.0, time], start)?;
        while steps.advance()? {
            let (before, now) = (steps.method.t_prev(), steps.method.t());
            let mut last = before;
            for k in 1..=SAMPLES_PER_STEP {
                let s = before + (now - before) * f64::from(k) / f64::from(SAMPLES_PER_STEP);
                let Ok(y) = steps.method.interpolate(s) else {
                    continue;
                };
                let state = state_of(&y);
                if let Some(change) = self.beyond(&state, fresh) {
                    let s = steps.locate(change, last, s);
                    steps.keep_samples(s, record)?;
                    // The dense output is less exact than the steps.
                    let reached = self.at(s, before, steps.method.y_prev())?;
                    return Ok((s, reached, Some(change)));
                }
                steps.keep_samples(s, record)?;
                record.add(self.begin + s, &state, self.pulling);
                last = s;
            }
        }
        Ok((time, *steps.method.y(), None))
    }

    /// The components at a time, integrated from one before.
    fn at(&self, s: f64, before: f64, y: &Components<N>) -> Result<Components<N>, CaseError> {
        if s <= before {
            return Ok(*y);
        }
        let mut steps = self.steps([before, s], *y)?;
        while steps.advance()? {}
        Ok(*steps.method.y())
    }
}

impl<M: Method<N>, const N: usize> Steps<'_, M, N> {
    /// Makes one step within the tolerance; `false` at the end.
    fn advance(&mut self) -> Result<bool, CaseError> {
        if (self.end - self.method.t()).abs() <= INSTANT {
            return Ok(false);
        }
        loop {
            if self.method.t() + self.method.h() > self.end {
                self.method.set_h(self.end - self.method.t());
            }
            self.method.step(self.phase).map_err(integration_error)?;
            if !matches!(self.method.status(), Status::RejectedStep) {
                return Ok(true);
            }
        }
    }

    /// Keeps the states of all samples up to a time of the phase, by the dense output of the step.
    fn keep_samples(&mut self, s: f64, record: &mut PullRecorder<'_>) -> Result<(), CaseError> {
        let Phase { begin, pulling, .. } = *self.phase;
        while let Some((t_s, t)) = record.next_sample(begin + s) {
            let within = (t - begin).clamp(self.method.t_prev(), self.method.t());
            let y = self.method.interpolate(within).map_err(integration_error)?;
            record.keep(t_s, &state_of(&y), pulling);
        }
        Ok(())
    }

    /// When a change occurs, by bisection on the dense output.
    fn locate(&mut self, change: Change, mut low: f64, mut high: f64) -> f64 {
        while high - low > f64::EPSILON * high.abs().max(1.0) {
            let middle = 0.5 * (low + high);
            let state = self.method.interpolate(middle).map(|y| state_of(&y));
            if state.is_ok_and(|state| self.phase.is_before(change, &state)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

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
    let model = &prepared.model;
    if elastic_lines.len() != model.system.cables.len() {
        let shown = elastic_lines.len().to_string();
        return Err(CaseError::value("springs", shown, "one for each line").into());
    }
    let body = BodyOnElasticLines::new(&model.system, elastic_lines);
    check_rate_on_elastic_lines(&prepared.structure, model, body.quickest_of_all())?;
    match model.system.memory_at_rest().len() {
        0 => run::<STATE_WITHOUT_MEMORY>(prepared, &body, every_s, on_progress),
        1..=USUAL_MEMORY => run::<STATE_WITH_MEMORY>(prepared, &body, every_s, on_progress),
        LONG_MEMORY..=MOST_MEMORY => run::<LARGEST_STATE>(prepared, &body, every_s, on_progress),
        states => {
            let allowed = format!("a memory of at most {MOST_MEMORY} states with elastic lines");
            Err(CaseError::value("float.pairs", format!("({states} states)"), allowed).into())
        }
    }
}

fn run<const N: usize>(
    prepared: &ModelAtRest,
    body: &BodyOnElasticLines<'_>,
    every_s: f64,
    on_progress: OnProgress,
) -> Result<ElasticRun, Unfinished> {
    let mut record = PullRecorder::new(prepared, body, every_s)?;
    let (mut t, mut state, mut fresh) = (0.0, prepared.start(), TautSet::SLACK);
    let mut components: Components<N> = [0.0; N];
    components[..STATE_WITHOUT_MEMORY].copy_from_slice(&state.components());
    let mut pulling = body.pulling(&state);
    record.change(t, &state, TautSet::SLACK, pulling);
    let (rules, system) = (&prepared.model.rules, &prepared.model.system);
    let mut stop = exceeded(system, rules, &state);
    while t < rules.t_end && stop.is_none() {
        Progress::new("elastic lines", t, rules.t_end).report(on_progress)?;
        let longest_step = STEP / body.quickest(&state, pulling);
        let until = rules
            .t_end
            .min(t + LONGEST_SLACK_CALL.min(STEPS_PER_CHECK * longest_step));
        let phase = Phase {
            body,
            rules,
            begin: t,
            pulling,
            longest_step,
        };
        let (s, reached, changed) = phase.follow(until - t, components, &mut fresh, &mut record)?;
        (components, state) = (reached, state_of(&reached));
        t = if changed.is_some() { t + s } else { until };
        match changed {
            None => {}
            Some(Change::Limit(limit)) => {
                stop = Some(limit);
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

/// The limit that a state reaches, as for inextensible lines.
fn exceeded(system: &System, rules: &Rules, state: &State) -> Option<Stop> {
    let mut limits = rules.limits.iter();
    let beyond = limits.find(|(limit, bound)| limit.quantity(system, state) >= *bound);
    beyond.map(|(limit, _)| limit.stop())
}

fn integration_error<const N: usize>(error: Error<f64, Components<N>>) -> CaseError {
    let shown: String = format!("({error:?})").chars().take(80).collect();
    let allowed = "a stiffness with which the motion can be integrated";
    CaseError::value("line.stiffness", shown, allowed)
        .with_hint("lower the stiffness or run.duration")
}
