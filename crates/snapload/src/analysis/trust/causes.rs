//! Where neighbours may have another event than the run.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::covariance::CovarianceFactor;
use crate::model::cable::Normal;
use crate::model::rules::Limit;
use crate::motion::active_set::normal_acceleration;
use crate::motion::events::Reached;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::start::START_TOLERANCE;
use crate::motion::step_map::StepMap;

/// Neighbours are held to reach this many standard deviations.
const REACH: f64 = 3.0;

/// Whether, and why, neighbours may leave the run's sequence of events at this step. `covariance` is
/// told just before the event, at the time of the one before.
#[inline(always)]
pub(super) fn cause(
    simulation: &Simulation,
    step: &Step,
    map: &StepMap,
    covariance: &CovarianceFactor,
    closing: Option<Closing>,
) -> Option<HorizonCause> {
    let struck = step.event.reached.gaps;
    if struck.len() > 1 {
        return Some(HorizonCause::Simultaneous);
    }
    if let Some(Closing { cable, .. }) =
        closing.filter(|closing| may_miss(map, covariance, closing))
    {
        return Some(HorizonCause::Graze { cable });
    }
    for cable in 0..simulation.system().cables.len() {
        let known = step.event.closed.contains(cable) || step.taut.contains(cable);
        if !known && may_snap(simulation, step, covariance, cable) {
            return Some(HorizonCause::NearMiss { cable });
        }
    }
    let may =
        may_stop(simulation, step, covariance) || may_fall_short(simulation, step, map, covariance);
    may.then_some(HorizonCause::StopRule)
}

/// A cable that is closed at the start of a run, and might be slack within what is in doubt, or
/// leave or snap where it rests.
pub(super) fn cause_at_start(
    simulation: &Simulation,
    covariance: &CovarianceFactor,
) -> Option<HorizonCause> {
    let system = simulation.system();
    let resting = simulation.resting();
    let open = |cable: &usize| {
        let tether = &system.cables[*cable];
        let normal = tether.normal(simulation.state());
        let Normal { n, arm } = normal;
        let gap = 2.0 * tether.length() * covariance.along(&[n.x, n.y, arm, 0.0, 0.0, 0.0]);
        let speed = REACH * covariance.along(&[0.0, 0.0, 0.0, n.x, n.y, arm]);
        let turns = if resting.contains(*cable) {
            speed > START_TOLERANCE
        } else {
            speed >= normal.velocity(simulation.state()).abs()
        };
        REACH * gap > START_TOLERANCE || turns
    };
    let cable = simulation.closed().iter().find(open)?;
    Some(HorizonCause::Start { cable })
}

/// Whether the event comes so late that a neighbour, `met` just before the same event, may run out of
/// time first.
pub(super) fn may_run_out_of_time(
    simulation: &Simulation,
    step: &Step,
    met: &CovarianceFactor,
) -> bool {
    let left = simulation.rules().t_end - step.t_end;
    step.event.reached != Reached::default() && REACH * met.of_component(6) >= left
}

/// How a gap closes, just before the one impact of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closing {
    pub(super) cable: usize,
    /// Normal velocity.
    pub(super) v_n: f64,
    /// Normal acceleration α = g̈/(2r).
    pub(super) alpha: f64,
}

impl Closing {
    /// Of a step that ends with one cable's impact.
    #[inline(always)]
    pub(super) fn of(simulation: &Simulation, step: &Step, map: &StepMap) -> Option<Self> {
        let mut struck = step.event.reached.gaps.iter();
        let (Some(cable), None) = (struck.next(), struck.next()) else {
            return None;
        };
        let system = simulation.system();
        let v_n = system.cables[cable]
            .normal(&step.before)
            .velocity(&step.before);
        let alpha = if step.taut.is_empty() {
            let [.., x, y, theta] = *map.rate();
            system.free_normal_acceleration(cable, &step.before, [x, y, theta])
        } else {
            normal_acceleration(system, step.t_end, &step.before, cable, step.taut)
        };
        Some(Self { cable, v_n, alpha })
    }
}

/// With the gap closing at v_n, slowing down at |α|, neighbours that lag by more than v_n/(2|α|) in
/// time, which is v_n²/(2|α|) along the normal, do not reach the end of the cable at all.
#[inline(always)]
fn may_miss(map: &StepMap, covariance: &CovarianceFactor, closing: &Closing) -> bool {
    let Closing { v_n, alpha, .. } = *closing;
    alpha < 0.0 && REACH * covariance.along(map.delay()) * 2.0 * -alpha >= v_n
}

/// Whether a cable that stays slack comes within reach of being taut, along the stretch or at its
/// end.
#[inline(always)]
fn may_snap(
    simulation: &Simulation,
    step: &Step,
    covariance: &CovarianceFactor,
    cable: usize,
) -> bool {
    let tether = &simulation.system().cables[cable];
    // A bound first: |n| = 1, and the arm is no longer than the lever.
    let [a, b] = tether.fairlead().components();
    let most = 2.0 * tether.length() * REACH * covariance.at_most([1.0, 1.0, a.abs() + b.abs()]);
    if simulation.gap(cable) <= -most && !simulation.comes_near(step, cable, most) {
        return false;
    }
    let Normal { n, arm } = tether.normal(&step.before);
    let direction = [n.x, n.y, arm, 0.0, 0.0, 0.0];
    let margin = 2.0 * tether.length() * REACH * covariance.along(&direction);
    simulation.gap(cable) > -margin || simulation.comes_near(step, cable, margin)
}

/// Whether neighbours may meet, or fail to meet, a stop rule where the run does not.
#[inline(always)]
fn may_stop(simulation: &Simulation, step: &Step, covariance: &CovarianceFactor) -> bool {
    let rules = simulation.rules();
    let (before, reached) = (&step.before, step.event.reached);
    let reach = |i: usize| REACH * covariance.of_component(i);
    let exceeds = Limit::ALL.into_iter().any(|limit| {
        limit.bound(rules).is_some_and(|bound| {
            let slopes = limit.slope_bounds(simulation.system());
            let margin: f64 = (0..6)
                .filter(|&i| slopes[i] > 0.0)
                .map(|i| slopes[i] * reach(i))
                .sum();
            !reached.limits.contains(limit)
                && simulation.largest_within(step, limit, bound - margin) + margin >= bound
        })
    });
    // One cable may stick as another leaves.
    let stuck = step.event.reached.gaps.intersection(step.taut_after);
    let sticks = step.taut_after.len() > step.taut.len() || !stuck.is_empty();
    let settles = [rules.settled_below, rules.sliding_above]
        .into_iter()
        .flatten()
        .any(|height| sticks && (before.y - height).abs() <= reach(1));
    exceeds || settles
}

/// Whether neighbours may turn round just before a limit that the run still reaches: as for a
/// graze, where they lag by more than the rate over twice the slowing-down.
#[inline(always)]
fn may_fall_short(
    simulation: &Simulation,
    step: &Step,
    map: &StepMap,
    covariance: &CovarianceFactor,
) -> bool {
    let (before, reached) = (&step.before, step.event.reached);
    let Some(limit) = reached.limits.iter().next() else {
        return false;
    };
    let delay = map.delay();
    let [.., x, y, theta] = *map.rate();
    let mut slowing = delay[0] * x + delay[1] * y + delay[2] * theta;
    slowing += delay[1] * limit.centripetal(simulation.system(), before);
    REACH * covariance.along(delay) * 2.0 * slowing >= 1.0
}
