//! A case: parameters that were checked once, when they were read, and the system that they
//! describe.

pub(crate) mod entries;
pub(crate) mod error;
mod fields;
pub(crate) mod key;
pub(crate) mod keys;
pub(crate) mod named;
pub(crate) mod parameter_checks;
pub(crate) mod parameters;
#[cfg(feature = "toml")]
pub(crate) mod read;
pub(crate) mod schema;
pub(crate) mod value;

use crate::arithmetic::real::Real;
use crate::case::error::CaseError;
use crate::case::parameters::{LARGEST, Parameters, natural_inertia};
use crate::case::value::Value;
use crate::model::body::{Body, Shape};
use crate::model::forcing::Harmonic;
use crate::model::rules::{Limit, Stop};
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::Simulation;
use crate::motion::start::StartError;
use crate::motion::trajectory::Trajectory;
use std::ops::ControlFlow;

/// A case that was checked and can be run.
///
/// ```
/// use snapload::{Case, Parameters, Stop};
/// let case = Case::new(Parameters { f_o: 0.31, ..Parameters::STANDARD })?;
/// let run = case.run();
/// assert_eq!(run.end().reason, Stop::RotationLimit);
/// # Ok::<(), snapload::CaseError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Case {
    parameters: Parameters,
    /// Boxed, because it is large and is moved by code that runs many cases.
    simulation: Box<Simulation>,
}

impl Case {
    /// Checks the values and the start.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key, its value and what is allowed.
    pub fn new(parameters: Parameters) -> Result<Self, CaseError> {
        parameters.check()?;
        Self::of_checked(parameters)
    }

    /// Of keys and values, as [`Parameters::from_entries`] takes them.
    ///
    /// # Errors
    /// As for [`Case::new`].
    pub fn from_entries<K: AsRef<str>>(
        entries: impl IntoIterator<Item = (K, Value)>,
    ) -> Result<Self, CaseError> {
        Self::of_checked(Parameters::from_entries(entries)?)
    }

    fn of_checked(parameters: Parameters) -> Result<Self, CaseError> {
        match parameters.simulation() {
            Ok(simulation) => Ok(Self {
                parameters,
                simulation: Box::new(simulation),
            }),
            Err(error) => Err(explain(error, &parameters)),
        }
    }

    /// The values.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The motion at its start.
    pub fn simulation(&self) -> Simulation {
        Simulation::clone(&self.simulation)
    }

    /// The motion at its start, by reference.
    pub(crate) fn start(&self) -> &Simulation {
        &self.simulation
    }

    /// The motion at its start, for callers that no longer need the case.
    pub fn into_simulation(self) -> Simulation {
        *self.simulation
    }

    /// The same in its box.
    pub(crate) fn into_boxed(self) -> Box<Simulation> {
        self.simulation
    }

    /// The same motion in another arithmetic; `number` converts each number and receives its key.
    /// An inertia that is the natural one of the size stays so.
    ///
    /// # Errors
    /// [`StartError`] where the start is illegal in that arithmetic, as it may be at the very edge.
    pub fn simulation_over<T: Real>(
        &self,
        number: impl FnMut(&'static str, f64) -> T,
    ) -> Result<Simulation<T>, StartError> {
        self.parameters.over(number).simulation()
    }

    /// Runs it to its end and keeps all of it.
    pub fn run(&self) -> Trajectory {
        Trajectory::record(self.simulation())
    }
}

impl Parameters {
    /// The same values in another arithmetic; `number` converts each number and receives its key.
    /// An inertia that is the natural one of the size stays so.
    pub fn over<T: Real>(&self, number: impl FnMut(&'static str, f64) -> T) -> Parameters<T> {
        let mut numbers = self.map(number);
        if let (Some(inertia), Some(given)) = (self.inertia, numbers.inertia)
            && self.inertia_follows()
        {
            // The difference from the plain conversion, such as a derivative, is kept.
            let beyond = given - T::from_decimal(inertia);
            numbers.inertia = natural_inertia(numbers.a, numbers.b).map(|natural| natural + beyond);
        }
        numbers
    }
}

impl<T: Real> Parameters<T> {
    /// The system that they describe.
    pub fn system(&self) -> System<T> {
        system(self)
    }

    /// The motion at its start.
    ///
    /// # Errors
    /// [`StartError`] where the start is illegal.
    pub fn simulation(&self) -> Result<Simulation<T>, StartError> {
        Simulation::new(self.system(), self.rules(), T::ZERO, start(self))
    }
}

impl Outcome {
    /// Of a case.
    pub fn of(case: &Case) -> Self {
        Self::after(case.simulation())
    }

    /// The outcome of a case, as long as `on_step`, which receives the motion after every step,
    /// lets it continue; none if `on_step` ended it early.
    pub fn of_while(
        case: &Case,
        on_step: impl FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Option<Self> {
        Self::after_while(case.simulation(), on_step)
    }
}

fn system<T: Real>(p: &Parameters<T>) -> System<T> {
    let body = match p.inertia {
        Some(inertia) => Body::rigid(Shape::of_half_sizes(p.a, p.b), inertia),
        None => Body::point(),
    };
    let wave = Harmonic::ellipse(p.f_o, p.nu, p.omega);
    System::moored_breakwater(body, [p.a, p.b], p.r, p.e, wave)
}

fn start<T: Real>(p: &Parameters<T>) -> State<T> {
    State {
        x: p.x,
        y: p.y,
        theta: p.theta,
        vx: p.vx,
        vy: p.vy,
        vtheta: p.vtheta,
    }
}

/// How much longer a cable of this gap would have to be: √(r² + g) − r.
fn over_length(gap: f64, r: f64) -> f64 {
    gap / ((r * r + gap).sqrt() + r)
}

/// The error for an illegal start, in terms of the case's keys.
fn explain(error: StartError, p: &Parameters) -> CaseError {
    match error {
        StartError::CableTooShort {
            cable,
            gap,
            tolerance,
        } => {
            let over = over_length(gap, p.r);
            let over = match over >= 0.1 {
                true => format!("{over:.3}"),
                false => format!("{over:.3e}"),
            };
            let allowed = format!(
                "a start within reach of both cables; cable {} would have to be {over} longer \
                 (its gap is g = {gap:.3e}, and g <= {tolerance:.0e} is allowed)",
                cable + 1
            );
            let hint = "raise y, or move x and theta towards 0";
            CaseError::value("x, y, theta", place(p), allowed).with_hint(hint)
        }
        StartError::BeyondLimit {
            stop: Stop::RotationLimit,
            ..
        } => {
            let allowed = "-pi/2 <= theta <= pi/2, the rotation limit";
            CaseError::value("theta", Value::Number(p.theta), allowed)
        }
        StartError::BeyondLimit {
            stop: Stop::UpperBound,
            value,
            bound,
        } => {
            let allowed = format!(
                "a body below the upper bound y = {bound:.6}; its highest point is at y = {value:.6}"
            );
            CaseError::value("y", Value::Number(p.y), allowed).with_hint(hint_below_bound(p))
        }
        StartError::BeyondLimit { stop, value, bound } => {
            let (limit, bounded) = (stop.name(), stop.limit().map_or("place", Limit::bounded));
            let allowed = format!("a limit above the {bounded} of the start, {value:.6}");
            CaseError::value(limit, Value::Number(bound), allowed)
        }
        StartError::TooShort { .. } => {
            CaseError::value("r", Value::Number(p.r), error.to_string()).with_hint("raise r")
        }
        StartError::NotAllowed {
            key,
            value,
            allowed,
        } => CaseError::value(key, Value::Number(value), allowed),
        StartError::CanNotClose { .. }
        | StartError::NotFinite
        | StartError::Restitution
        | StartError::TooManyCables => CaseError::value("x, y, theta", place(p), error.to_string()),
    }
}

/// How a start above the upper bound is corrected. Lowering the body helps unless the cables are
/// too short to reach down to it there.
fn hint_below_bound(p: &Parameters) -> &'static str {
    let (x, theta) = (0.0, 0.0);
    let centred = Parameters { x, theta, ..*p };
    let on_longest = Parameters {
        r: LARGEST,
        ..centred
    };
    if is_in_reach_below_bound(p) {
        "lower y"
    } else if is_in_reach_below_bound(&centred) {
        "lower y, and move x and theta towards 0"
    } else if is_in_reach_below_bound(&on_longest) {
        "lower a or raise r: at no y is this body both below the bound and within reach of the cables"
    } else {
        "lower a: at no y is this body both below the bound and within reach of the cables"
    }
}

/// Whether the cables reach the body when it is lowered to just below the upper bound, which is
/// where they reach it if they do so at any y below the bound.
fn is_in_reach_below_bound(p: &Parameters) -> bool {
    let Err(StartError::BeyondLimit {
        stop: Stop::UpperBound,
        value,
        bound,
    }) = p.simulation()
    else {
        return true;
    };
    // A little lower still, as the difference is rounded.
    let lowered = Parameters {
        y: p.y - (value - bound) * (1.0 + 1e-9),
        ..*p
    };
    !matches!(lowered.simulation(), Err(StartError::CableTooShort { .. }))
}

fn place(p: &Parameters) -> String {
    format!("{}, {}, {}", p.x, p.y, p.theta)
}

#[cfg(test)]
mod tests {
    use super::{Case, Parameters, natural_inertia};

    fn ring(a: f64, r: f64, y: f64) -> Parameters {
        Parameters {
            a,
            r,
            y,
            inertia: natural_inertia(a, 0.0),
            ..Parameters::STANDARD
        }
    }

    fn hint(parameters: Parameters) -> String {
        let error = Case::new(parameters).expect_err("was accepted");
        assert!(error.allowed.contains("upper bound"), "{error}");
        String::from(error.hint.unwrap_or_default())
    }

    fn is_accepted(parameters: Parameters) -> bool {
        Case::new(parameters).is_ok()
    }

    /// Whether any height makes the case legal.
    fn is_accepted_somewhere(parameters: Parameters) -> bool {
        let heights = (-4000..4000).map(|k| 0.5 * f64::from(k));
        heights
            .chain((0..200).map(|k| 0.01 * f64::from(k)))
            .any(|y| is_accepted(Parameters { y, ..parameters }))
    }

    #[test]
    fn a_start_too_high_is_lowered_where_that_helps() {
        let high = ring(0.1, 1.5, 5.0);
        assert_eq!(hint(high), "lower y");
        assert!(is_accepted(Parameters { y: 0.1, ..high }));

        let aside = Parameters { x: 3.0, ..high };
        assert_eq!(hint(aside), "lower y, and move x and theta towards 0");
        assert!(!is_accepted_somewhere(aside));
        assert!(is_accepted_somewhere(Parameters { x: 0.0, ..aside }));
    }

    #[test]
    fn a_body_too_large_for_its_cables_is_said_to_be_so() {
        for (a, r, ways) in [
            (500.0, 501.0, "lower a or raise r: "),
            // There are no longer cables.
            (1000.0, 1000.0, "lower a: "),
        ] {
            let large = ring(a, r, 5.0);
            assert!(!is_accepted_somewhere(large));
            assert!(hint(large).starts_with(ways), "{}", hint(large));
            assert!(is_accepted_somewhere(ring(10.0, r, 5.0)));
        }
        assert!(is_accepted_somewhere(ring(500.0, 1000.0, 5.0)));
    }
}
