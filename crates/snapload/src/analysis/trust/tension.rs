//! Where neighbours may lose a tension that the run keeps, or keep one that it loses.
//!
//! ```text
//! δT = ∇T · w(t)    at one common time,    w(t) = w − ż τ
//! ```
//!
//! with ∇T = ∂T/∂(x, y, θ, ẋ, ẏ, θ̇) while the same cables are taut, at the start and at the end of a
//! step; a step is about half a radian of the motion, within which this hardly changes. An uncertain
//! parameter also changes T itself, which its own run with derivatives contains. Deviations of a
//! floating body's memory are left out.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::causes::SIGMA_REACH;
use crate::analysis::trust::covariance::CovarianceFactor;
use crate::analysis::trust::uncertain_key::UncertainKey;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{StepMap, dot6, join};
use crate::motion::tangent::Tangent;

/// A tension may change by so much without any uncertainty but rounding \[F\].
const OF_ROUNDING: f64 = 1e-12;

/// A step with taut cables and the spread of its neighbours.
pub(super) struct TautStep<'a> {
    pub(super) simulation: &'a Simulation,
    pub(super) step: &'a Step,
    pub(super) tangent: &'a Tangent,
    pub(super) map: &'a StepMap,
    /// At the event before the step.
    pub(super) before: &'a CovarianceFactor,
    /// At its end, at the time of the event before.
    pub(super) along: &'a CovarianceFactor,
    pub(super) keys: &'a [UncertainKey],
    /// Whether the run begins with it.
    pub(super) is_first: bool,
}

impl TautStep<'_> {
    /// The first cable whose tension some neighbours lose and others do not, if there is one.
    pub(super) fn cause(&self) -> Option<HorizonCause> {
        let (simulation, step) = (self.simulation, self.step);
        let ranges = simulation.tension_ranges(step);
        let [first, last] = self.tangent.slopes_of_tensions(simulation, step);
        let differs = |&cable: &usize| {
            let lag = -dot6(&last[cable], self.map.rate());
            let at_start = self.before.variance_of_parts(&join(&first[cable], 0.0));
            let at_end = self.along.variance_of_parts(&join(&last[cable], lag));
            let mut variances = [at_start, at_end];
            for key in self.keys {
                for (variance, tensions) in variances.iter_mut().zip(&key.tensions) {
                    *variance += tensions[cable] * tensions[cable];
                }
            }
            let reach = SIGMA_REACH * variances[0].max(variances[1]).sqrt();
            if step.event.reached.tensions.contains(cable) {
                return may_stay(simulation, step, cable, reach);
            }
            // Its growth decides that a tension of zero rises, whatever rounding makes of the zero.
            let rises = self.is_first && simulation.tensions_at_end(step)[cable] > reach;
            let known = reach <= OF_ROUNDING && (rises || simulation.touches_zero(step, cable));
            ranges[cable][0] <= reach && !known
        };
        // A cable that lies along others carries nothing.
        let cable = step.carrying.iter().find(differs)?;
        Some(HorizonCause::Tension { cable })
    }
}

/// The first cable that is closed and at rest at the start, and slack although it is taut for some
/// neighbours, if there is one.
pub(super) fn cause_at_start(
    simulation: &Simulation,
    covariance: &CovarianceFactor,
    keys: &[UncertainKey],
) -> Option<HorizonCause> {
    let slack = |cable: &usize| !simulation.taut().contains(*cable);
    let mut resting = simulation.resting().iter().filter(slack).peekable();
    resting.peek()?;
    let tangent = Tangent::new(simulation.system());
    let cable = resting.find(|&cable| {
        let (acceleration, slopes) = tangent.normal_acceleration(simulation, cable);
        let mut variance = covariance.variance_of_parts(&join(&slopes, 0.0));
        for key in keys {
            variance += key.of_normal_acceleration(cable).powi(2);
        }
        // If it is zero to rounding the start has decided by the growth of the tension, or not.
        let reach = SIGMA_REACH * variance.sqrt();
        reach > OF_ROUNDING && acceleration.abs() <= reach
    })?;
    Some(HorizonCause::Start { cable })
}

/// Whether a tension is lost so barely that it stays positive for a neighbour in which it is larger
/// by `reach`: falling at the rate Ṫ and slowing down at T̈, it goes no deeper than Ṫ²/(2 T̈).
fn may_stay(simulation: &Simulation, step: &Step, cable: usize, reach: f64) -> bool {
    let Some(lost) = simulation.tension_lost(step, cable) else {
        return false;
    };
    // The event function is −T.
    let slowing = -lost.accel;
    slowing > 0.0 && lost.rate * lost.rate <= 2.0 * slowing * reach
}
