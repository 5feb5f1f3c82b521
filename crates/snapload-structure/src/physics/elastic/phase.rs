//! A part of a motion on elastic lines, in which the same lines pull: integrated to its end.
//!
//! The changes that end it are looked for on the dense output of each step, at
//! [`SAMPLES_PER_STEP`] points, and the earliest is located by bisection there and then by Newton's
//! method on what is integrated: the dense output of the longest steps is off by 1e-7, and where a
//! damper takes hold, an error of its time is one of the velocity.

use super::body::BodyOnElasticLines;
use super::record::PullRecorder;
use differential_equations::ode::OrdinaryNumericalMethod;
use differential_equations::prelude::{Error, ExplicitRungeKutta, Interpolation, ODE, Status};
use snapload::{CaseError, Limit, Rules, State, Stop, System, TautSet};

/// Points in a step at which forces are evaluated.
const SAMPLES_PER_STEP: u32 = 16;
/// An elongation smaller than this, or the force of a smaller one, just after a line has started or
/// ceased to pull is rounding.
const NOISE: f64 = 1e-12;
/// The most corrections of the time of a change, and the time step of the difference by which the
/// rate of its event function is found.
const CORRECTIONS: u32 = 4;
const DIFFERENCE: f64 = 1e-6;
/// A shorter time counts as zero.
const INSTANT: f64 = 10.0 * f64::EPSILON;
/// The components of a state, followed by the water's memory if the body has one, each of its
/// complex states as two numbers.
pub(super) type Components<const N: usize> = [f64; N];

/// The number of components for a body without memory.
pub(super) const STATE_WITHOUT_MEMORY: usize = 6;

/// The motion with one set of pulling lines, from `begin` on.
pub(super) struct Phase<'a, const N: usize> {
    pub(super) body: &'a BodyOnElasticLines<'a>,
    pub(super) rules: &'a Rules,
    pub(super) begin: f64,
    pub(super) pulling: TautSet,
    /// Tolerance of a step, relative and absolute, in the engine's units.
    pub(super) tolerance: f64,
    pub(super) longest_step: f64,
}

/// What ends a phase.
#[derive(Clone, Copy)]
pub(super) enum Change {
    /// A line begins or ceases to pull.
    Line(usize),
    /// A limit of the motion is reached, at that bound.
    Limit(Limit, f64),
}

impl Change {
    /// How the run ends there, if it does.
    pub(super) fn stop(self) -> Option<Stop> {
        match self {
            Self::Line(_) => None,
            Self::Limit(limit, _) => Some(limit.stop()),
        }
    }
}

/// The state among the components.
pub(super) fn state_of<const N: usize>(y: &Components<N>) -> State {
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
        let method = ExplicitRungeKutta::dop853();
        let method = method.rtol(self.tolerance).atol(self.tolerance);
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

    /// The changes that a state is beyond. `fresh` are lines that have just started or ceased to
    /// pull, and whose force is zero up to rounding.
    fn beyond(&self, state: &State, fresh: &mut TautSet) -> Vec<Change> {
        let mut changes: Vec<Change> = exceeded(self.body.system, self.rules, state).collect();
        for (line, elastic_line) in self.body.elastic_lines.iter().enumerate() {
            let left = self.until_change(line, state);
            if left > 0.0 {
                *fresh = fresh.without(line);
            } else if !fresh.contains(line) || left < -NOISE * elastic_line.rate {
                changes.push(Change::Line(line));
            }
        }
        changes
    }

    /// The event function of a change, which is positive before it.
    fn until(&self, change: Change, state: &State) -> f64 {
        match change {
            Change::Line(line) => self.until_change(line, state),
            Change::Limit(limit, bound) => bound - limit.quantity(self.body.system, state),
        }
    }

    /// The same as a smooth function near the change.
    fn crossing(&self, change: Change, state: &State) -> f64 {
        match change {
            Change::Line(line) => self.body.crossing(line, state, self.pulling.contains(line)),
            Change::Limit(..) => self.until(change, state),
        }
    }

    /// Follows the phase until a line changes or a limit is reached, or for a time; returns the
    /// time, the components there, and the change.
    pub(super) fn follow(
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
                let changes = self.beyond(&state, fresh).into_iter();
                let located = changes.map(|change| (steps.locate(change, last, s), change));
                if let Some((s, change)) = located.min_by(|a, b| a.0.total_cmp(&b.0)) {
                    let start = (before, steps.method.y_prev());
                    let (s, reached) = self.reach(change, s, start, now - before)?;
                    steps.keep_samples(s, record)?;
                    return Ok((s, reached, Some(change)));
                }
                steps.keep_samples(s, record)?;
                record.add(self.begin + s, &state, self.pulling);
                last = s;
            }
        }
        Ok((time, *steps.method.y(), None))
    }

    /// The time of a change and the components there, integrated from the start of the step: the
    /// dense output, by which the change is near `s`, is less exact than the steps. Newton's method
    /// makes the event function of what is integrated zero; where it does not, as at a graze, the
    /// time of the dense output stays.
    fn reach(
        &self,
        change: Change,
        s: f64,
        (before, y): (f64, &Components<N>),
        step: f64,
    ) -> Result<(f64, Components<N>), CaseError> {
        let (mut best, mut left) = ((s, self.at(s, before, y)?), f64::INFINITY);
        let mut next = best;
        for _ in 0..CORRECTIONS {
            let now = self.crossing(change, &state_of(&next.1));
            if now.abs() >= left {
                break;
            }
            (best, left) = (next, now.abs());
            let later = (best.0 - now / self.rate(change, best.0, &best.1)).max(before);
            let near = (later - s).abs() < step / f64::from(SAMPLES_PER_STEP);
            if !near || later == best.0 {
                break;
            }
            next = (later, self.at(later, before, y)?);
        }
        Ok(best)
    }

    /// The rate of an event function, by a difference along the motion.
    fn rate(&self, change: Change, s: f64, y: &Components<N>) -> f64 {
        let mut rates = [0.0; N];
        self.diff(s, y, &mut rates);
        let [before, after] = [-DIFFERENCE, DIFFERENCE].map(|time| {
            let moved: Components<N> = std::array::from_fn(|i| y[i] + time * rates[i]);
            self.crossing(change, &state_of(&moved))
        });
        (after - before) / (2.0 * DIFFERENCE)
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

    /// Keeps what is asked for up to a time of the phase: states of samples, positions to be
    /// compared, and the instant at which judging begins.
    fn keep_samples(&mut self, s: f64, record: &mut PullRecorder<'_>) -> Result<(), CaseError> {
        let Phase { begin, pulling, .. } = *self.phase;
        while let Some((t_s, t)) = record.next_sample(begin + s) {
            record.keep(t_s, &self.state(t - begin)?, pulling);
        }
        while let Some(t) = record.next_mark(begin + s) {
            record.mark(&self.state(t - begin)?);
        }
        if let Some(t) = record.next_beginning(begin + s) {
            record.add(t, &self.state(t - begin)?, pulling);
        }
        Ok(())
    }

    /// The state at a time within the step.
    fn state(&mut self, s: f64) -> Result<State, CaseError> {
        let within = s.clamp(self.method.t_prev(), self.method.t());
        let y = self.method.interpolate(within).map_err(integration_error)?;
        Ok(state_of(&y))
    }

    /// When a change occurs, by bisection on the dense output.
    fn locate(&mut self, change: Change, mut low: f64, mut high: f64) -> f64 {
        while high - low > f64::EPSILON * high.abs().max(1.0) {
            let middle = 0.5 * (low + high);
            let state = self.method.interpolate(middle).map(|y| state_of(&y));
            if state.is_ok_and(|state| self.phase.until(change, &state) > 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}
/// The limits that a state reaches, as for inextensible lines.
pub(super) fn exceeded(
    system: &System,
    rules: &Rules,
    state: &State,
) -> impl Iterator<Item = Change> {
    let limits = rules.limits.iter();
    let beyond = limits.filter(|(limit, bound)| limit.quantity(system, state) >= *bound);
    beyond.map(|(limit, bound)| Change::Limit(limit, bound))
}

fn integration_error<const N: usize>(error: Error<f64, Components<N>>) -> CaseError {
    let shown: String = format!("({error:?})").chars().take(80).collect();
    let allowed = "a stiffness with which the motion can be integrated";
    CaseError::value("line.stiffness", shown, allowed)
        .with_hint("lower the stiffness or run.duration")
}
