//! How far a run can be trusted.
//!
//! An uncertainty of the start or of a key, and in any case the rounding of the arithmetic, is
//! carried along the run by the linearised motion ([`crate::motion::tangent::Tangent`]) as the
//! spread of (w, τ), the deviation of state and time at the events. An *error* is two standard
//! deviations of that: one neighbour in twenty is further off. The *horizon* is the first event
//! where the error passes a tolerance, or where neighbours within three standard deviations may
//! have another event than the run: there the linearisation ends, and with it the knowledge of what
//! follows.

mod bounce_reach;
mod bounce_rounding;
mod bounces;
mod causes;
mod certainty;
mod covariance;
mod linear_map;
mod monitor;
mod near_miss;
mod neighbours;
mod parts;
mod passed_impulse;
mod rounding;
mod spread;
mod start;
mod tension;
mod uncertain_key;

pub use certainty::Certainty;
pub use monitor::TrustMonitor;
#[cfg(feature = "comparisons")]
pub use uncertain_key::LimitDerivatives;

use crate::analysis::digits::digits_within;
use crate::analysis::progress::{OnProgress, Unfinished, record};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::key::Key;
use crate::case::keys::key_named;
use crate::case::parameters::Parameters;
use crate::case::value::Value;
use crate::motion::simulation::Simulation;
use crate::motion::trajectory::Trajectory;

/// The uncertainties of a run. The motion is computed from the values given; each may be off by up
/// to its uncertainty in either direction, all values in between being equally likely.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Of each component of the start: x, y, θ, ẋ, ẏ, θ̇.
    pub start: [f64; 6],
    /// Of parameters, by name of their key. Each entry counts as [`Uncertainty::set`] would set it:
    /// one of a key of the start instead of that component, and a later one of a key instead of an
    /// earlier one.
    pub keys: Vec<(&'static str, f64)>,
    /// A result whose error, which is two standard deviations, is larger than this counts as
    /// unknown; the error is relative to a value above 1, see [`Trust::errors`].
    pub tolerance: f64,
}

impl Default for Uncertainty {
    /// Rounding alone, and a tolerance that asks for three digits.
    fn default() -> Self {
        Self {
            start: [0.0; 6],
            keys: Vec::new(),
            tolerance: 1e-3,
        }
    }
}

/// The keys of the start, in the order of its components.
pub const START_KEYS: [&str; 6] = ["x", "y", "theta", "vx", "vy", "vtheta"];

impl Uncertainty {
    /// With an uncertainty of `size` in every component of the start.
    pub fn of_start(size: f64) -> Self {
        Self {
            start: [size; 6],
            ..Self::default()
        }
    }

    /// The same with each uncertainty set by [`Uncertainty::set`], which checks it.
    ///
    /// # Errors
    /// As for that, and if the tolerance is negative or no number.
    pub(crate) fn checked(&self) -> Result<Self, CaseError> {
        let mut checked = Self {
            tolerance: self.tolerance,
            ..Self::default()
        };
        for (key, size) in START_KEYS.into_iter().zip(self.start) {
            checked.set(key, size)?;
        }
        for (key, size) in &self.keys {
            checked.set(key, *size)?;
        }
        match self.tolerance >= 0.0 {
            true => Ok(checked),
            false => {
                let (given, allowed) = (Value::Number(self.tolerance), "a tolerance of 0 or more");
                Err(CaseError::value("tolerance", given, allowed))
            }
        }
    }

    /// The uncertainties of a case's start; a component that the case does not have has none.
    pub(crate) fn of_start_of(&self, parameters: &Parameters) -> [f64; 6] {
        let mut start = self.start;
        for (size, key) in start.iter_mut().zip(START_KEYS) {
            if !parameters.moves_by(key) {
                *size = 0.0;
            }
        }
        start
    }

    /// Sets the uncertainty of one key of a case, or of every start value where no key is named; 0
    /// removes it.
    ///
    /// # Errors
    /// As for [`Uncertainty::set`], and if the case has no such start value.
    pub fn set_for(
        &mut self,
        parameters: &Parameters,
        key: Option<&str>,
        size: f64,
    ) -> Result<(), CaseError> {
        let Some(key) = key else {
            return START_KEYS.iter().try_for_each(|key| self.set(key, size));
        };
        if key_named(key).is_ok() && !parameters.moves_by(key) {
            let allowed = "no uncertainty, as this case has no such quantity";
            return Err(CaseError::value(key, Value::Number(size), allowed));
        }
        self.set(key, size)
    }

    /// Sets the uncertainty of one key; 0 removes it.
    ///
    /// # Errors
    /// A [`CaseError`] if the key is unknown or holds no number of the motion, or if `size` is
    /// negative or not finite.
    pub fn set(&mut self, key: &str, size: f64) -> Result<(), CaseError> {
        let key: &'static Key = key_named(key)?;
        if !(size >= 0.0 && size.is_finite()) {
            let allowed = "an uncertainty of 0 or more";
            return Err(CaseError::value(key.name, Value::Number(size), allowed));
        }
        if let Some(component) = START_KEYS.iter().position(|name| *name == key.name) {
            self.start[component] = size;
        } else if UNCERTAIN_KEYS.contains(&key.name) {
            self.keys.retain(|(name, _)| *name != key.name);
            if size > 0.0 {
                self.keys.push((key.name, size));
            }
        } else {
            let allowed = format!("an uncertainty of one of the keys {}", {
                let mut all = START_KEYS.to_vec();
                all.extend(UNCERTAIN_KEYS);
                all.join(", ")
            });
            return Err(CaseError::value(key.name, Value::Number(size), allowed));
        }
        Ok(())
    }
}

/// The keys, besides those of the start, that the motion depends on smoothly.
pub const UNCERTAIN_KEYS: [&str; 8] = ["r", "e", "a", "b", "inertia", "f_o", "nu", "omega"];

/// Why a run can not be trusted any further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HorizonCause {
    /// The deviation has grown past the tolerance.
    Tolerance,
    /// An impact so slow that a neighbour may miss it.
    Graze {
        /// The cable.
        cable: usize,
    },
    /// A cable comes so close to being taut that it may snap there for a neighbour.
    NearMiss {
        /// The cable.
        cable: usize,
    },
    /// A cable snaps at about the speed below which it sticks: a neighbour may bounce once more, or
    /// once less.
    Sticking {
        /// The cable.
        cable: usize,
    },
    /// A taut cable has so little tension that a neighbour may go slack, or loses it so barely that
    /// a neighbour may stay taut.
    Tension {
        /// The cable.
        cable: usize,
    },
    /// A snap hardly loads or unloads a taut cable, so that a neighbour may go slack, or stay taut.
    PassedImpulse {
        /// The taut cable.
        cable: usize,
    },
    /// Several cables snap at one instant: their order, which may differ for neighbours, decides
    /// what follows.
    Simultaneous,
    /// The start is at the end of a cable, and a neighbour may begin slack.
    Start {
        /// The cable.
        cable: usize,
    },
    /// A stop rule that a neighbour may meet where the run does not, or the other way round.
    StopRule,
}

impl HorizonCause {
    /// Its name in files and in programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tolerance => "tolerance",
            Self::Graze { .. } => "graze",
            Self::NearMiss { .. } => "near_miss",
            Self::Sticking { .. } => "sticking",
            Self::Tension { .. } => "tension",
            Self::PassedImpulse { .. } => "passed_impulse",
            Self::Simultaneous => "simultaneous",
            Self::Start { .. } => "start",
            Self::StopRule => "stop_rule",
        }
    }
}

/// Where trust ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon {
    /// When \[T\].
    pub t: f64,
    /// The number of the impact, from 1; where trust ends between impacts, of the next one.
    pub impact: usize,
    /// Why.
    pub cause: HorizonCause,
}

impl Horizon {
    /// Where trust ends at the start of a motion.
    fn at_start(simulation: &Simulation, cause: HorizonCause) -> Self {
        Self {
            t: simulation.time(),
            impact: 1,
            cause,
        }
    }

    /// Whether the impact of this number, from 1, is before the horizon.
    pub fn is_after(&self, impact: usize) -> bool {
        impact < self.impact
    }
}

/// An impact so slow, compared with the acceleration of its gap, that it magnifies deviations by
/// more than a hundred: the linearisation diverges there like 1/v_n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Graze {
    /// The number of the impact, from 1.
    pub impact: usize,
    /// Normal velocity v_n⁻ \[L/T\].
    pub v_n: f64,
    /// The largest factor by which a deviation of the state can grow at it.
    pub factor: f64,
}

/// How far a run can be trusted.
#[derive(Clone, Debug, PartialEq)]
pub struct Trust {
    /// Error at each impact, which is two standard deviations: the largest of its time and of its
    /// states' components, each relative to its value where that is above 1; infinite once
    /// neighbours may have other events.
    pub errors: Vec<f64>,
    /// Where trust ends; none if the whole run can be trusted, its end included.
    pub horizon: Option<Horizon>,
    /// Error of the time at which the run ends \[T\]: nothing where that is the end of the time
    /// asked for, infinite past the horizon.
    pub end_error: f64,
    /// Errors of the states in which the run begins and ends, in the same measure as at impacts;
    /// that of the end is infinite past the horizon.
    pub edge_errors: [f64; 2],
    /// Impacts that magnify deviations.
    pub grazes: Vec<Graze>,
    /// Estimates of the Lyapunov exponents from this run alone, the largest first \[1/T\]: mean
    /// rates of growth of deviations that begin along the coordinates and are kept orthogonal; −∞
    /// in directions that cables close which have stayed taut. Six, or four of a point mass.
    pub exponents: Vec<f64>,
}

impl Trust {
    /// Decimal digits that are expected to be right, impact by impact.
    pub fn digits(&self) -> impl Iterator<Item = f64> + '_ {
        self.errors.iter().map(|error| digits_within(*error))
    }

    /// Whether the way in which the run ends is certain: neighbours within the uncertainty end
    /// alike.
    pub fn decides_the_end(&self) -> bool {
        self.horizon.is_none()
    }
}

/// Runs a case and says how far it can be trusted.
///
/// ```
/// use snapload::analysis::{Uncertainty, trusted_run, no_progress};
/// use snapload::{Case, Parameters};
/// let case = Case::new(Parameters { f_o: 0.31, ..Parameters::STANDARD })?;
/// let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
/// assert_eq!(run.impacts().len(), 12);
/// assert!(trust.decides_the_end() && trust.errors[11] < 1e-12);
/// # Ok::<(), snapload::analysis::Unfinished>(())
/// ```
///
/// # Errors
/// A [`CaseError`] if an uncertainty is none that [`Uncertainty::set`] accepts, or its key can not
/// be varied about this start, and [`Unfinished::Cancelled`].
pub fn trusted_run(
    case: &Case,
    uncertainty: &Uncertainty,
    on_progress: OnProgress,
) -> Result<(Trajectory, Trust), Unfinished> {
    let mut monitor = TrustMonitor::of_case(case, uncertainty)?;
    let run = record(case.simulation(), on_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })?;
    Ok((run, monitor.verdict()))
}
