//! Where a snap loads a taut cable for some neighbours and unloads it for others.
//!
//! ```text
//! W_12 < 0: an impulse is passed into the taut cable, which stays taut
//! W_12 > 0: it leaves, with the velocity −W_12 p
//! ```
//!
//! Which of the two it is does not depend on how hard the cable snaps. So impulse and velocity are
//! taken per impulse p of the snap, and compared with what that varies by among the neighbours:
//! with the place alone. In the run a velocity that is zero up to rounding keeps the cable taut.
//! All neighbours have the closed cables closed, each at its own impact: where those determine the
//! place, as for a point mass, the coupling does not vary, and zero is no doubt.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::covariance::{CovarianceFactor, SIGMA_REACH};
use crate::analysis::trust::uncertain_key::UncertainKey;
use crate::model::system::System;
use crate::motion::simulation::{Step, zero_velocity};
use crate::motion::step_map::join;
use crate::motion::tangent::Tangent;

/// An impulse that varies by less than this part of that of the snap does so by rounding of the
/// derivatives alone: a rounding of the place makes more.
const CONSTANT: f64 = f64::EPSILON / 256.0;

/// The first taut cable that stays taut for some neighbours and leaves for others, if there is one;
/// `met` are the neighbours just before the impact.
pub(super) fn cause(
    system: &System,
    tangent: &Tangent,
    step: &Step,
    met: &CovarianceFactor,
    keys: &[UncertainKey],
) -> Option<HorizonCause> {
    let (still, struck) = (step.event.still, step.event.reached.gaps);
    if struck.is_empty() || still.is_empty() {
        return None;
    }
    let result = tangent.impact(step);
    let snap = struck.iter().map(|i| result.impulse[i].value);
    let snap = snap.fold(0.0, f64::max);
    let after = step.result.as_ref()?.after;
    let cable = still.iter().find(|&cable| {
        let reaction = result.reaction(cable, struck);
        let mut variance = met.variance_of_parts(&join(&reaction.slope, 0.0));
        for key in keys {
            variance += key.reactions[cable] * key.reactions[cable];
        }
        let reach = SIGMA_REACH * variance.sqrt();
        let zero = zero_velocity(system, cable, [&after, &step.before]) / snap;
        reach > CONSTANT && reaction.value.abs() <= reach + zero
    })?;
    Some(HorizonCause::PassedImpulse { cable })
}
