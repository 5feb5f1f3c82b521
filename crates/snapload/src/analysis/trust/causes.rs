//! Where neighbours may have another event than the run.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::covariance::SIGMA_REACH;
use crate::analysis::trust::near_miss::may_snap;
use crate::analysis::trust::neighbours::{Approach, Neighbours, Spread};
use crate::analysis::trust::uncertain_key::reach_by;
use crate::model::cable::Normal;
use crate::model::rules::{Limit, Rules};
use crate::model::system::System;
use crate::motion::active_set::normal_acceleration;
use crate::motion::events::Reached;
use crate::motion::simulation::{Progress, Simulation, Step};

/// Why, and when first, neighbours may leave the run's events at this step, if they may.
#[inline(always)]
pub(super) fn cause(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
    closing: Option<Closing>,
) -> Option<(HorizonCause, f64)> {
    let mut first = cause_at_event(simulation, step, approach, neighbours, closing)
        .map(|cause| (cause, step.t_end));
    for cable in 0..simulation.system().cables.len() {
        if !step.taut.contains(cable)
            && let Some(t) = may_snap(simulation, step, approach, neighbours, cable)
        {
            first = earlier(first, (HorizonCause::NearMiss { cable }, t));
        }
    }
    let stop = may_stop(simulation, step, neighbours).or_else(|| {
        let may = may_fall_short(simulation, step, approach, neighbours)
            || may_run_out_of_time(simulation, step, &neighbours.met);
        may.then_some(step.t_end)
    });
    match stop {
        Some(t) => earlier(first, (HorizonCause::StopRule, t)),
        None => first,
    }
}

/// The earlier of two causes; at one instant the first.
fn earlier(
    first: Option<(HorizonCause, f64)>,
    other: (HorizonCause, f64),
) -> Option<(HorizonCause, f64)> {
    match first {
        Some(first) if first.1 <= other.1 => Some(first),
        _ => Some(other),
    }
}

/// Why the event at the end of the step may be another one for neighbours, if it may.
#[inline(always)]
fn cause_at_event(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
    closing: Option<Closing>,
) -> Option<HorizonCause> {
    if let Some(cause) = tie(simulation.system(), step) {
        return Some(cause);
    }
    let closing = closing.as_ref()?;
    let cable = closing.cable;
    if may_miss(approach, neighbours, closing) || may_not_have_opened(simulation, step, closing) {
        return Some(HorizonCause::Graze { cable });
    }
    may_or_may_not_stick(simulation, step, neighbours, closing)
        .then_some(HorizonCause::Sticking { cable })
}

/// Whether several events come at one instant whose order may differ for neighbours and decides
/// what they do. Where a limit comes first the run ends; where a snap does, it moves on from there.
/// A cable that a snap loads is struck, too, if its tension was lost before. But one that the snap
/// unloads opens in either order, and so does one that loses its tension at a limit, where the run
/// ends, or together with others.
fn tie(system: &System, step: &Step) -> Option<HorizonCause> {
    let Reached {
        gaps,
        tensions,
        limits,
    } = step.event.reached;
    let limits = limits.iter().count();
    if limits > 1 || limits == 1 && !gaps.is_empty() {
        return Some(HorizonCause::StopRule);
    }
    if !gaps.is_empty() && struck_alone(system, step).is_none() {
        return Some(HorizonCause::Simultaneous);
    }
    let pulling = step.result.as_ref()?.pulling;
    let cable = tensions.intersection(pulling).iter().next()?;
    Some(HorizonCause::Tension { cable })
}

/// The cable that snaps at the end of a step, if one does and no other. Cables with the same ends
/// and the same length count as one: their gaps and normals are the same to the bit, so that
/// whichever snaps first turns all of them round, and the motion is the same in any order.
#[inline(always)]
fn struck_alone(system: &System, step: &Step) -> Option<usize> {
    let struck = step.event.reached.gaps;
    let cable = struck.iter().next()?;
    let same = |twin: usize| system.cables[twin] == system.cables[cable];
    struck.iter().all(same).then_some(cable)
}

/// Whether the event is so close to the end of time that a neighbour may reach the end of time
/// first.
#[inline(always)]
fn may_run_out_of_time(simulation: &Simulation, step: &Step, met: &Spread) -> bool {
    let left = simulation.rules().t_end - step.t_end;
    step.event.reached != Reached::default() && SIGMA_REACH * met.sizes[6] >= left
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
    /// The closing of a step that ends with one cable's impact, or that of its twins with it.
    #[inline(always)]
    pub(super) fn of(simulation: &Simulation, step: &Step, approach: &Approach) -> Option<Self> {
        let system = simulation.system();
        let cable = struck_alone(system, step)?;
        let v_n = system.cables[cable]
            .normal(&step.before)
            .velocity(&step.before);
        let alpha = if step.taut.is_empty() {
            let [.., x, y, theta] = approach.rate;
            system.free_normal_acceleration(cable, &step.before, [x, y, theta])
        } else {
            let memory_force = simulation.memory_force();
            normal_acceleration(
                system,
                &simulation.surroundings(step.t_end),
                &step.before,
                memory_force,
                cable,
                step.taut,
            )
        };
        Some(Self { cable, v_n, alpha })
    }
}

/// Whether a neighbour may miss the impact: with the gap closing at v_n and slowing down at |α|,
/// neighbours that lag by more than v_n/(2|α|) in time, which is v_n²/(2|α|) along the normal, do
/// not reach the end of the cable at all.
#[inline(always)]
fn may_miss(approach: &Approach, neighbours: &Neighbours, closing: &Closing) -> bool {
    let Closing { v_n, alpha, .. } = *closing;
    alpha < 0.0 && neighbours.reach_in_time(approach) * 2.0 * -alpha >= v_n
}

/// Whether a cable that rested at the start of the step, g = ġ = 0, closes within what counts as
/// zero there: it may have been taut all the time, or be taut in a neighbour.
#[inline(always)]
fn may_not_have_opened(simulation: &Simulation, step: &Step, closing: &Closing) -> bool {
    let Closing { cable, v_n, .. } = *closing;
    let length = simulation.system().cables[cable].length();
    let s = step.t_end - step.t_start;
    v_n * s <= 8.0 * f64::EPSILON * length && s > 0.0 && simulation.rested(step, cable)
}

/// Whether some neighbours snap slowly enough to stick and others do not, after which the numbers
/// of their impacts differ. Where the cable would have no tension, none sticks; where e = 0, all
/// do. But where cables snap in turn, all stick after a row of slow snaps, in which this one counts
/// for some neighbours and for others not.
#[inline(always)]
fn may_or_may_not_stick(
    simulation: &Simulation,
    step: &Step,
    neighbours: &Neighbours,
    closing: &Closing,
) -> bool {
    let (system, before) = (simulation.system(), &step.before);
    let Closing { cable, v_n, alpha } = *closing;
    let Progress { impacts, last } = simulation.progress();
    let in_turn = impacts > 1 && last.repeats == 1;
    if !in_turn && (alpha <= 0.0 || system.restitution == 0.0) {
        return false;
    }
    let off = (v_n - simulation.rules().v_stick).abs();
    // A bound first: n has length 1 and turns by at most 1/r, and by the lever over r.
    let tether = &system.cables[cable];
    let reach = tether.fairlead().length();
    let speed = before.velocity().length() + before.vtheta.abs() * reach;
    let turns = speed * (1.0 + reach) * (1.0 + reach) / tether.length();
    let slopes = [turns, turns, turns, 1.0, 1.0, reach];
    let by_keys = reach_by(neighbours.keys, |key| key.of_normal_velocity(cable));
    if off > neighbours.met.parts_at_most(&slopes) + by_keys {
        return false;
    }
    let (Normal { n, arm }, slopes) = tether.normal_and_slopes(before);
    let [x, y, theta] = slopes
        .map(|slopes| slopes[0] * before.vx + slopes[1] * before.vy + slopes[2] * before.vtheta);
    let by_parts = neighbours
        .met
        .reach_of_parts(&[x, y, theta, n.x, n.y, arm, 0.0]);
    off <= by_parts.hypot(by_keys)
}

/// When neighbours may meet a stop rule that the run does not meet, or the other way round.
#[inline(always)]
fn may_stop(simulation: &Simulation, step: &Step, neighbours: &Neighbours) -> Option<f64> {
    let before = &step.before;
    let Rules {
        limits,
        settled_below,
        sliding_above,
        t_end: _,
        max_impacts: _,
        v_stick: _,
    } = simulation.rules();
    let mut first: Option<f64> = None;
    for (limit, bound) in limits.iter() {
        if let Some(s) = may_exceed(simulation, step, neighbours, (limit, bound)) {
            first = Some(first.map_or(s, |first| first.min(s)));
        }
    }
    if let Some(s) = first {
        return Some((step.t_start + s).min(step.t_end));
    }
    // One cable may stick as another leaves.
    let stuck = step.event.reached.gaps.intersection(step.taut_after);
    let sticks = step.taut_after.len() > step.taut.len() || !stuck.is_empty();
    let settles = [*settled_below, *sliding_above]
        .into_iter()
        .flatten()
        .any(|height| {
            let spread = neighbours.along.sizes[1].max(neighbours.met.sizes[1]);
            sticks && (before.y - height).abs() <= SIGMA_REACH * spread
        });
    settles.then_some(step.t_end)
}

/// How long after the start of the step neighbours may exceed a limit that the run does not, or the
/// other way round.
#[inline(always)]
fn may_exceed(
    simulation: &Simulation,
    step: &Step,
    neighbours: &Neighbours,
    (limit, bound): (Limit, f64),
) -> Option<f64> {
    let system = simulation.system();
    let slopes = limit.slope_bounds(system, bound);
    let [first, last] = [&neighbours.before, &neighbours.along];
    let within = reach_by(neighbours.keys, |key| key.of_limit_within(limit));
    let margin = first
        .parts_at_most(&slopes)
        .max(last.parts_at_most(&slopes))
        + within;
    let near = || simulation.comes_near_limit(step, limit, margin);
    if step.event.reached.limits.contains(limit) {
        return near();
    }
    let met = reach_by(neighbours.keys, |key| key.of_limit_at_end(limit));
    let at_end = neighbours.met.parts_at_most(&slopes) + met;
    let largest = margin.max(at_end);
    if simulation.largest_within(step, limit, bound - largest) + largest < bound {
        return None;
    }
    let may = limit.quantity(system, &step.before) + at_end >= bound
        || simulation.largest_within(step, limit, bound - margin) + margin >= bound;
    may.then(|| near().unwrap_or(step.t_end - step.t_start))
}

/// Whether neighbours may turn round just before a limit that the run still reaches, as in a graze:
/// those do that lag by more than the rate over twice the deceleration.
#[inline(always)]
fn may_fall_short(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
) -> bool {
    let Some(limit) = step.event.reached.limits.iter().next() else {
        return false;
    };
    let reached = simulation.limit_reached(step, limit);
    let slowing = reached.map_or(0.0, |function| -function.accel / function.rate);
    neighbours.reach_in_time(approach) * 2.0 * slowing >= 1.0
}
