//! Follows a run and keeps account of its errors.

use crate::analysis::lyapunov::Frame;
use crate::analysis::trust::linear_map::{LinearMap, Observer};
use crate::analysis::trust::spread::SpreadMonitor;
use crate::analysis::trust::{Graze, Horizon, Trust, Uncertainty};
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::motion::bounce_map::BounceMap;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::StepMap;

/// An impact that magnifies deviations by more than this is reported as a graze.
const GRAZE_MAGNIFICATION: f64 = 100.0;

/// Follows a run, step by step, and says in the end how far it can be trusted.
#[derive(Clone, Debug)]
pub struct TrustMonitor {
    spread: SpreadMonitor,
    frame: Frame,
    errors: Vec<f64>,
    grazes: Vec<Graze>,
    begin: f64,
    end: f64,
    /// Errors of the state in which the run begins and of the latest state.
    edge_errors: [f64; 2],
}

/// A step to be followed, by the best instructions for it.
struct Following<'a>(&'a mut TrustMonitor, &'a Simulation, &'a Step);

impl Kernel for Following<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.follow_here(self.1, self.2);
    }
}

impl TrustMonitor {
    /// A monitor of a motion about to begin, whose start may be off by `start`.
    pub fn new(simulation: &Simulation, start: &[f64; 6], tolerance: f64) -> Self {
        Self::of(SpreadMonitor::new(simulation, start, tolerance), simulation)
    }

    /// A monitor of a case with all its uncertainties.
    ///
    /// # Errors
    /// A [`CaseError`] if an uncertainty is none that [`Uncertainty::set`] accepts, or its key has
    /// no value in this case.
    pub fn of_case(case: &Case, uncertainty: &Uncertainty) -> Result<Self, CaseError> {
        let spread = SpreadMonitor::of_case(case, &uncertainty.checked()?)?;
        Ok(Self::of(spread, case.start()))
    }

    /// A monitor of a case whose values are exact, so that rounding is the only uncertainty.
    pub fn of_exact_case(case: &Case, simulation: &Simulation) -> Self {
        Self::of(SpreadMonitor::of_exact_case(case, simulation), simulation)
    }

    fn of(spread: SpreadMonitor, simulation: &Simulation) -> Self {
        let edge_errors = [spread.error_at_start(simulation.state()); 2];
        Self {
            spread,
            frame: Frame::along(simulation.system(), simulation.state(), simulation.taut()),
            errors: Vec::new(),
            grazes: Vec::new(),
            edge_errors,
            begin: simulation.time(),
            end: simulation.time(),
        }
    }

    /// Takes in the step that `simulation` has just made.
    pub fn follow(&mut self, simulation: &Simulation, step: &Step) {
        dispatch(Following(self, simulation, step));
    }

    #[inline(always)]
    fn follow_here(&mut self, simulation: &Simulation, step: &Step) {
        self.end = step.t_end;
        let before = self.spread.impacts;
        let mut records = Records {
            frame: &mut self.frame,
            grazes: &mut self.grazes,
            impact: before + 1,
            latest: (simulation, step),
        };
        let error = self.spread.follow(simulation, step, &mut records);
        self.edge_errors[1] = error;
        let rows = self.spread.impacts - before;
        self.errors.extend(std::iter::repeat_n(error, rows));
    }

    /// Where trust has ended, if it has.
    pub fn horizon(&self) -> Option<Horizon> {
        self.spread.horizon
    }

    /// The trust in the run, at its end or as far as it has come.
    pub fn verdict(self) -> Trust {
        let [first_error, last_error] = self.edge_errors;
        let [end_error, last_error] = match self.spread.horizon {
            Some(_) => [f64::INFINITY; 2],
            None => [self.spread.end_error, last_error],
        };
        Trust {
            errors: self.errors,
            horizon: self.spread.horizon,
            end_error,
            edge_errors: [first_error, last_error],
            grazes: self.grazes,
            exponents: self.frame.exponents(self.end - self.begin),
        }
    }
}

/// The records to which the effect of the latest step on deviations is added.
struct Records<'a> {
    frame: &'a mut Frame,
    grazes: &'a mut Vec<Graze>,
    /// The number of its impact.
    impact: usize,
    latest: (&'a Simulation, &'a Step),
}

impl Observer for Records<'_> {
    #[inline(always)]
    fn observe_bounce(&mut self, map: &BounceMap<f64>) {
        self.note(&LinearMap::Bounce(map));
        self.frame.follow_bounce(map);
    }

    fn observe_step(&mut self, map: &StepMap) {
        dispatch(ObservingStep(self, map));
    }
}

/// What a step does, to be taken in by the best instructions for it.
struct ObservingStep<'a, 'r>(&'a mut Records<'r>, &'a StepMap);

impl Kernel for ObservingStep<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Self(records, map) = self;
        records.note(&LinearMap::Step(map));
        let (simulation, step) = records.latest;
        records.frame.follow_step(map, simulation, step);
    }
}

impl Records<'_> {
    /// An impact that magnifies deviations is a graze if the closing of its gap slows down.
    #[inline(always)]
    fn note(&mut self, map: &LinearMap) {
        let square = map.magnification_squared();
        let (simulation, step) = self.latest;
        if square > GRAZE_MAGNIFICATION * GRAZE_MAGNIFICATION
            && !map.certainly_accelerates()
            && let Some(closing) = map.closing(simulation, step)
            && closing.alpha < 0.0
        {
            self.grazes.push(Graze {
                impact: self.impact,
                v_n: closing.v_n,
                factor: square.sqrt(),
            });
        }
    }
}
