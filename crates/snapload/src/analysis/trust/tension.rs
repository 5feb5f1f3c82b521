//! Where neighbours may lose a tension that the run keeps, or keep one that it loses.
//!
//! ```text
//! δT = ∇T · w(t)    at one common time,    w(t) = w − ż τ
//! ```
//!
//! with ∇T = ∂T/∂(x, y, θ, ẋ, ẏ, θ̇) while the same cables are taut, at the start and at the end of
//! a step; a step is about half a radian of the motion, within which this hardly changes. An
//! uncertain parameter also changes T itself, which its own run with derivatives contains.
//! Deviations of a floating body's memory are left out, and so is, at the start of a step, what the
//! forcing changes between the neighbours' own times there, (∂T/∂t) τ, except after a snap, where
//! it decides whether a cable leaves at once.
//!
//! A step may end, as its series does, shortly before a tension is lost that all neighbours lose.
//! So a tension that is near zero and still falls is decided by a later step: it is lost there, or
//! it rises again, and then trust has ended where it was first near zero.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::covariance::{CovarianceFactor, SIGMA_REACH};
use crate::analysis::trust::uncertain_key::UncertainKey;
use crate::model::taut_set::TautSet;
use crate::motion::active_set::{normal_acceleration, tensions};
use crate::motion::complementarity::independent;
use crate::motion::events::Reached;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{StepMap, dot6, join};
use crate::motion::tangent::Tangent;

/// A tension may change by so much without any uncertainty but rounding \[F\].
const OF_ROUNDING: f64 = 1e-12;

/// The least tension of a step is known to this part of what the tension varies by within it.
const CLOSE: f64 = 1e-2;

/// A short time against any forcing \[T\].
const INSTANT: f64 = 1e-6;

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
    /// Whether it begins with a snap.
    pub(super) after_snap: bool,
}

/// The cables whose tension comes within reach of zero.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NearZero {
    /// Those that some neighbours lose and others do not.
    pub(super) differ: TautSet,
    /// Those that still fall at the end of the step, so that the next step decides.
    pub(super) fall: TautSet,
}

impl TautStep<'_> {
    /// The cables near zero, among which those of `falling` were at the end of the step before.
    pub(super) fn near_zero(&self, falling: TautSet) -> NearZero {
        let (simulation, step) = (self.simulation, self.step);
        let ranges = simulation.tension_ranges(step);
        let at_end = simulation.tensions_at_end(step);
        let goes_on = step.event.reached == Reached::default() && step.stop.is_none();
        let [first, last] = self.tangent.slopes_of_tensions(simulation, step);
        let moves = |&cable: &usize| self.reach(cable, [&first[cable], &last[cable]]) > OF_ROUNDING;
        let mut near = NearZero {
            differ: self.idle().iter().filter(moves).collect(),
            fall: TautSet::SLACK,
        };
        // A cable that lies along others carries nothing.
        for cable in step.carrying.iter() {
            let reach = self.reach(cable, [&first[cable], &last[cable]]);
            if self.after_snap && self.may_leave_at_once(cable, &first[cable]) {
                near.differ = near.differ.with(cable);
                continue;
            }
            if step.event.reached.tensions.contains(cable) {
                if may_stay(simulation, step, cable, reach) {
                    near.differ = near.differ.with(cable);
                }
                continue;
            }
            let ([least, largest], end) = (ranges[cable], at_end[cable]);
            let is_near = |least: f64| least <= reach || falling.contains(cable);
            if !is_near(least - CLOSE * (largest - least)) {
                continue;
            }
            // Its growth decides that a tension of zero rises, whatever rounding makes of the zero;
            // and one that only rounding tells from zero within the step touches it.
            let at_start = simulation.tensions_at_start(step)[cable];
            let rises = end > reach && (self.is_first || at_start > reach);
            if reach <= OF_ROUNDING && (rises || simulation.touches_zero(step, cable)) {
                continue;
            }
            let least = simulation.least_tension(step, cable);
            if !is_near(least) {
                continue;
            }
            if goes_on && end <= least + OF_ROUNDING && end + OF_ROUNDING < largest {
                near.fall = near.fall.with(cable);
            } else {
                near.differ = near.differ.with(cable);
            }
        }
        near
    }

    /// Whether a cable that is taut after a snap leaves at once in some
    /// neighbours, each after its own snap.
    fn may_leave_at_once(&self, cable: usize, slopes: &[f64; 6]) -> bool {
        let (simulation, step) = (self.simulation, self.step);
        let pull = simulation.memory_force_within(step, 0.0);
        let at = |t: f64| {
            let around = simulation.surroundings(t);
            tensions(simulation.system(), &around, &step.start, pull, step.taut)[cable]
        };
        let by_time = slope(at, step.t_start);
        let mut variance = self.before.variance_of_parts(&join(slopes, by_time));
        for key in self.keys {
            variance += key.tensions[0][cable].powi(2);
        }
        let reach = SIGMA_REACH * variance.sqrt();
        reach > OF_ROUNDING && at(step.t_start) <= reach
    }

    /// Taut cables that could carry, and have no tension along the step.
    fn idle(&self) -> TautSet {
        let step = self.step;
        if step.taut == step.carrying {
            return TautSet::SLACK;
        }
        let system = self.simulation.system();
        let normals = system.normals(&step.start, step.taut);
        let w = |i: usize, j: usize| system.body.mass.coupling(&normals[i], &normals[j]);
        if !independent(step.taut, w) {
            return TautSet::SLACK;
        }
        step.carrying.iter().fold(step.taut, TautSet::without)
    }

    /// How far the tension of a cable of neighbours is from the run's, given its derivatives at the
    /// start and at the end.
    fn reach(&self, cable: usize, [first, last]: [&[f64; 6]; 2]) -> f64 {
        let lag = -dot6(last, self.map.rate());
        let at_start = self.before.variance_of_parts(&join(first, 0.0));
        let at_end = self.along.variance_of_parts(&join(last, lag));
        let mut variances = [at_start, at_end];
        for key in self.keys {
            for (variance, tensions) in variances.iter_mut().zip(&key.tensions) {
                *variance += tensions[cable] * tensions[cable];
            }
        }
        SIGMA_REACH * variances[0].max(variances[1]).sqrt()
    }
}

/// The first cable that is closed and at rest at the start, and slack although it is taut for some
/// neighbours, if there is one.
pub(super) fn cause_at_start(
    simulation: &Simulation,
    covariance: &CovarianceFactor,
    keys: &[UncertainKey],
) -> Option<HorizonCause> {
    let slack = |cable: &usize| !simulation.carrying().contains(*cable);
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

/// The first cable that is at rest and slack after a snap although it is taut for some neighbours,
/// each after its own snap, if there is one; `after` are the neighbours there.
pub(super) fn cause_after_snap(
    simulation: &Simulation,
    step: &Step,
    tangent: &Tangent,
    after: &CovarianceFactor,
    keys: &[UncertainKey],
) -> Option<HorizonCause> {
    if step.event.reached.gaps.is_empty() || step.stop.is_some() {
        return None;
    }
    let (system, state) = (simulation.system(), simulation.state());
    let (held, taut) = (simulation.memory_force(), simulation.carrying());
    let slack = |cable: &usize| !simulation.taut().contains(*cable);
    let cable = simulation.resting().iter().filter(slack).find(|&cable| {
        let (acceleration, slopes) = tangent.normal_acceleration(simulation, cable);
        let at = |t: f64| {
            let around = simulation.surroundings(t);
            normal_acceleration(system, &around, state, held, cable, taut)
        };
        let mut variance = after.variance_of_parts(&join(&slopes, slope(at, simulation.time())));
        for key in keys {
            variance += key.of_normal_acceleration(cable).powi(2);
        }
        let reach = SIGMA_REACH * variance.sqrt();
        reach > OF_ROUNDING && acceleration.abs() <= reach
    })?;
    Some(HorizonCause::Tension { cable })
}

/// The derivative of a function of time.
fn slope(at: impl Fn(f64) -> f64, t: f64) -> f64 {
    (at(t + INSTANT) - at(t - INSTANT)) / (2.0 * INSTANT)
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
