//! Follows a run and keeps account of what is known of it.

use crate::analysis::lyapunov::Frame;
use crate::analysis::trust::causes::{
    Closing, Neighbours, Spread, cause, cause_at_start, may_stop_at_start,
};
use crate::analysis::trust::covariance::CovarianceFactor;
use crate::analysis::trust::rounding::{self, Rounding};
use crate::analysis::trust::{Graze, Horizon, HorizonCause, Trust, Uncertainty};
use crate::arithmetic::dual::Dual;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::value::Value;
use crate::model::rules::Stop;
use crate::model::state::State;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Block, Deviation, StepMap, combined};
use crate::motion::tangent::Tangent;

/// So many standard deviations make an error: 95 % of what is distributed normally lies within.
const ERROR: f64 = 2.0;

/// An impact that magnifies more than this is told.
const MAGNIFIES: f64 = 100.0;

/// Follows a run, step by step, and says in the end how far it can be trusted.
#[derive(Clone, Debug)]
pub struct TrustMonitor {
    tolerance: f64,
    tangent: Tangent,
    covariance: CovarianceFactor,
    /// How many roundings the cables are off by in their direction.
    slant: f64,
    keys: Vec<UncertainKey>,
    frame: Frame,
    errors: Vec<f64>,
    grazes: Vec<Graze>,
    horizon: Option<Horizon>,
    end_error: f64,
    begin: f64,
    end: f64,
}

/// A step to be followed, with the exponents or without, by the best instructions for it.
struct Following<'a, const EXPONENTS: bool>(&'a mut TrustMonitor, &'a Simulation, &'a Step);

impl<const EXPONENTS: bool> Kernel for Following<'_, EXPONENTS> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let map = self.0.follow_here(self.1, self.2);
        if EXPONENTS {
            self.0.frame.follow(&map);
        }
    }
}

/// The same run with its derivatives by an uncertain parameter.
#[derive(Clone, Debug)]
struct UncertainKey {
    simulation: Simulation<Dual<f64, 1>>,
    /// Standard deviation of the parameter.
    size: f64,
    /// That of (w, τ), at the latest event.
    deviation: Deviation,
}

/// The standard deviation of a value that lies anywhere within ± `size`.
fn uniform(size: f64) -> f64 {
    size / 3.0_f64.sqrt()
}

impl TrustMonitor {
    /// Of a motion about to begin, whose start may be off by `start`.
    pub fn new(simulation: &Simulation, start: &[f64; 6], tolerance: f64) -> Self {
        let tangent = Tangent::new(simulation.system());
        let projection = tangent.of_start(simulation);
        let [x, y, theta, vx, vy, vtheta] = start.map(uniform);
        let covariance = CovarianceFactor::along_components(&[x, y, theta, vx, vy, vtheta, 0.0]);
        let cause = cause_at_start(simulation, &covariance);
        let project = |block: &mut Block<_>| {
            let projected = projection.map(|row| combined(block, &row));
            block[..6].copy_from_slice(&projected);
        };
        let mut covariance = covariance.carried(project, Vec::new());
        covariance.add_parts(&rounding::of_start(
            simulation.system(),
            simulation.state(),
            simulation.time(),
            simulation.closed(),
        ));
        let cause = cause.or_else(|| {
            may_stop_at_start(simulation, &Spread::of(&covariance))
                .then_some(HorizonCause::StopRule)
        });
        let horizon = cause.map(|cause| Horizon {
            t: simulation.time(),
            impact: 1,
            cause,
        });
        Self {
            tolerance,
            tangent,
            covariance,
            slant: 1.0,
            keys: Vec::new(),
            frame: Frame::new(),
            errors: Vec::new(),
            grazes: Vec::new(),
            horizon,
            end_error: 0.0,
            begin: simulation.time(),
            end: simulation.time(),
        }
    }

    /// Of a case, with all that is in doubt.
    ///
    /// # Errors
    /// A [`CaseError`] if a key that is in doubt has no value in this case.
    pub fn of_case(case: &Case, uncertainty: &Uncertainty) -> Result<Self, CaseError> {
        let start = uncertainty.of_start_of(case.parameters());
        let mut monitor = Self {
            slant: rounding::slant(case),
            ..Self::new(&case.simulation(), &start, uncertainty.tolerance)
        };
        for (name, size) in &uncertainty.keys {
            monitor.keys.push(UncertainKey::new(case, name, *size)?);
        }
        monitor.covariance.columns = monitor.keys.iter().map(|key| key.deviation).collect();
        Ok(monitor)
    }

    /// Of the simulation of a case whose values are exact, so that rounding alone is in doubt.
    pub fn of_exact_case(case: &Case, simulation: &Simulation) -> Self {
        let tolerance = Uncertainty::default().tolerance;
        Self {
            slant: rounding::slant(case),
            ..Self::new(simulation, &[0.0; 6], tolerance)
        }
    }

    /// Takes in the step that `simulation` has just made.
    pub fn follow(&mut self, simulation: &Simulation, step: &Step) {
        dispatch(Following::<true>(self, simulation, step));
    }

    /// Takes in the step, but for the exponents, which the horizon does not depend on.
    pub(super) fn follow_spread(&mut self, simulation: &Simulation, step: &Step) {
        dispatch(Following::<false>(self, simulation, step));
    }

    #[inline(always)]
    fn follow_here(&mut self, simulation: &Simulation, step: &Step) -> StepMap {
        let map = self.tangent.of_step(simulation, step);
        self.end = step.t_end;
        let rows = step.impacts().count();
        let closing = Closing::of(simulation, step, &map);
        self.note_graze(closing, &map);
        let error = if self.is_lost() {
            self.lose(step, HorizonCause::Tolerance);
            f64::INFINITY
        } else {
            self.carry(simulation, step, &map, closing)
        };
        self.errors.extend(std::iter::repeat_n(error, rows));
        map
    }

    /// Past an event that neighbours may not share, or with no digit left, nothing is known.
    #[inline(always)]
    fn is_lost(&self) -> bool {
        let other_events = self
            .horizon
            .is_some_and(|h| h.cause != HorizonCause::Tolerance);
        other_events || self.covariance.is_lost()
    }

    /// Carries the spread through the step; returns the error at its event.
    #[inline(always)]
    fn carry(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        map: &StepMap,
        closing: Option<Closing>,
    ) -> f64 {
        let columns: Vec<[Deviation; 3]> = self.keys.iter_mut().map(|key| key.step(map)).collect();
        let column = |stage: usize| columns.iter().map(|stages| stages[stage]).collect();
        let rounding = Rounding::of_step(simulation, step, map, self.slant);
        let along = self.covariance.carried(|w| map.carry_along(w), column(0));
        let met = along
            .carried(|w| map.carry_to_meet(w), column(1))
            .with_part(&rounding.location);
        let neighbours = Neighbours {
            along: Spread::of(&along),
            met: Spread::of(&met),
            late: rounding.late,
        };
        if let Some(cause) = cause(simulation, step, map, &neighbours, closing) {
            self.lose(step, cause);
        }
        let mut after = met.carried(|w| map.carry_through(w), column(2));
        after.add_parts(&rounding.parts);
        let sizes = after.sizes();
        let error = relative(&neighbours.met.sizes, &step.before, step.t_end).max(relative(
            &sizes,
            &step.after,
            step.t_end,
        ));
        self.covariance = after;
        self.end_error = if step.stop == Some(Stop::EndTime) {
            0.0
        } else {
            ERROR * sizes[6]
        };
        if error > self.tolerance || self.covariance.is_lost() {
            self.lose(step, HorizonCause::Tolerance);
        }
        if self.is_lost() { f64::INFINITY } else { error }
    }

    /// Trust ends once.
    #[inline(always)]
    fn lose(&mut self, step: &Step, cause: HorizonCause) {
        self.horizon.get_or_insert(Horizon {
            t: step.t_end,
            impact: self.errors.len() + 1,
            cause,
        });
    }

    #[inline(always)]
    fn note_graze(&mut self, closing: Option<Closing>, map: &StepMap) {
        let Some(Closing { v_n, alpha, .. }) = closing else {
            return;
        };
        let factor = map.magnification();
        if alpha < 0.0 && factor > MAGNIFIES {
            self.grazes.push(Graze {
                impact: self.errors.len() + 1,
                v_n,
                factor,
            });
        }
    }

    /// Where trust has ended, if it has.
    pub fn horizon(&self) -> Option<Horizon> {
        self.horizon
    }

    /// What there is to say, at the end of the run or wherever it has come to.
    pub fn verdict(self) -> Trust {
        let end_error = match self.horizon {
            Some(_) => f64::INFINITY,
            None => self.end_error,
        };
        Trust {
            errors: self.errors,
            horizon: self.horizon,
            end_error,
            grazes: self.grazes,
            exponents: self.frame.exponents(self.end - self.begin),
        }
    }
}

impl UncertainKey {
    fn new(case: &Case, name: &'static str, size: f64) -> Result<Self, CaseError> {
        if !case.parameters().moves_by(name) {
            let allowed = "no uncertainty, as this case has no such quantity";
            return Err(CaseError::value(name, Value::Number(size), allowed));
        }
        let lift = |key, number| {
            if key == name {
                Dual::variable(number, 0)
            } else {
                Dual::constant(number)
            }
        };
        let simulation = case.simulation_over(lift).map_err(|_| {
            let allowed = "an uncertainty about a start that is not on the very edge";
            CaseError::value(name, Value::Number(size), allowed)
        })?;
        let size = uniform(size);
        let w = simulation.state().components().map(|c| c.slope[0] * size);
        Ok(Self {
            simulation,
            size,
            deviation: [w[0], w[1], w[2], w[3], w[4], w[5], 0.0],
        })
    }

    /// The deviation just before the event told at the time of the last one, just before it at its
    /// own time, and after it.
    fn step(&mut self, map: &StepMap) -> [Deviation; 3] {
        let Some(step) = self.simulation.step() else {
            return [self.deviation; 3];
        };
        let tau = step.t_end.slope[0] * self.size;
        let at = |state: &State<Dual<f64, 1>>| -> Deviation {
            let w = state.components().map(|c| c.slope[0] * self.size);
            [w[0], w[1], w[2], w[3], w[4], w[5], tau]
        };
        let met = at(&step.before);
        let along = map.before_meeting(&met, self.deviation[6]);
        self.deviation = at(&step.after);
        [along, met, self.deviation]
    }
}

/// The largest error of time and state, of each relative to its value where that is above 1.
#[inline(always)]
fn relative(sizes: &Deviation, state: &State, t: f64) -> f64 {
    let [x, y, theta, vx, vy, vtheta] = state.components();
    let mut largest = 0.0_f64;
    for (size, value) in sizes.iter().zip([x, y, theta, vx, vy, vtheta, t]) {
        largest = largest.max(size / value.abs().max(1.0));
    }
    ERROR * largest
}
