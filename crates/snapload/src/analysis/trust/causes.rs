//! Where neighbours may have another event than the run.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::covariance::CovarianceFactor;
use crate::model::cable::Normal;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::active_set::normal_acceleration;
use crate::motion::events::Reached;
use crate::motion::simulation::{Progress, Simulation, Step};
use crate::motion::step_map::Deviation;

/// Neighbours are assumed to be within this many standard deviations.
pub(super) const SIGMA_REACH: f64 = 3.0;

/// When a cable comes near is found by so many trials at most, each with the neighbours' reach at
/// the instant found by the one before, until it is within this part of the step.
const TRIALS: usize = 16;
const SAME_INSTANT: f64 = 1e-3;

/// The spread of the neighbours at some instant.
pub(super) struct Spread<'a> {
    pub(super) covariance: &'a CovarianceFactor,
    /// Standard deviation of each component.
    pub(super) sizes: Deviation,
}

impl<'a> Spread<'a> {
    #[inline(always)]
    pub(super) fn of(covariance: &'a CovarianceFactor) -> Self {
        Self {
            covariance,
            sizes: covariance.sizes(),
        }
    }

    /// The largest deviation of the neighbours along a linear function of the state.
    #[inline(always)]
    pub(super) fn reach(&self, direction: &[f64; 6]) -> f64 {
        SIGMA_REACH * self.covariance.along(direction)
    }

    /// A bound on the reach along every function whose derivatives are at most these.
    #[inline(always)]
    pub(super) fn at_most(&self, slopes: &[f64; 6]) -> f64 {
        let mut sum = 0.0;
        for (slope, size) in slopes.iter().zip(&self.sizes) {
            // Zero slopes are skipped, as 0 × ∞ would be NaN.
            sum += if *slope > 0.0 { slope * size } else { 0.0 };
        }
        SIGMA_REACH * sum
    }
}

/// The spread of the neighbours of a step. Between its ends they drift away from the run with
/// constant velocities if it is a free flight, so that each is furthest from it at one of them.
pub(super) struct Neighbours<'a> {
    /// Just after the previous event, each at the time of its own.
    pub(super) before: Spread<'a>,
    /// Just before its event, at the time of the previous event.
    pub(super) along: Spread<'a>,
    /// Each neighbour at the time of its own event.
    pub(super) met: Spread<'a>,
    /// Standard deviation of the error, by rounding, of the time at which the event is located.
    pub(super) late: f64,
    /// Cables that have been open since the start, in all of them.
    pub(super) opening: TautSet,
}

/// How the run approaches its event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// ż just before it.
    pub(super) rate: [f64; 6],
    /// −∇h/ḣ, the delay of the event per deviation.
    pub(super) delay: [f64; 6],
}

impl Neighbours<'_> {
    /// The largest time by which neighbours reach the event before or after the run.
    #[inline(always)]
    fn reach_in_time(&self, approach: &Approach) -> f64 {
        let (along, late) = (self.along.covariance.along(&approach.delay), self.late);
        SIGMA_REACH * (along * along + late * late).sqrt()
    }
}

/// Why, and when, neighbours may leave the run's sequence of events at this step, if they may.
#[inline(always)]
pub(super) fn cause(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
    closing: Option<Closing>,
) -> Option<(HorizonCause, f64)> {
    if let Some(cause) = tie(simulation.system(), step) {
        return Some((cause, step.t_end));
    }
    if let Some(Closing { cable, .. }) = closing.filter(|closing| {
        may_miss(approach, neighbours, closing) || may_not_have_opened(simulation, step, closing)
    }) {
        return Some((HorizonCause::Graze { cable }, step.t_end));
    }
    if let Some(Closing { cable, .. }) =
        closing.filter(|closing| may_or_may_not_stick(simulation, step, neighbours, closing))
    {
        return Some((HorizonCause::Sticking { cable }, step.t_end));
    }
    for cable in 0..simulation.system().cables.len() {
        if !step.taut.contains(cable)
            && let Some(t) = may_snap(simulation, step, approach, neighbours, cable)
        {
            return Some((HorizonCause::NearMiss { cable }, t));
        }
    }
    let stop = may_stop(simulation, step, neighbours).or_else(|| {
        let may = may_fall_short(simulation, step, approach, neighbours)
            || may_run_out_of_time(simulation, step, &neighbours.met);
        may.then_some(step.t_end)
    });
    stop.map(|t| (HorizonCause::StopRule, t))
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
    if off > neighbours.met.at_most(&slopes) {
        return false;
    }
    let (Normal { n, arm }, slopes) = tether.normal_and_slopes(before);
    let [x, y, theta] = slopes
        .map(|slopes| slopes[0] * before.vx + slopes[1] * before.vy + slopes[2] * before.vtheta);
    off <= neighbours.met.reach(&[x, y, theta, n.x, n.y, arm])
}

/// When a slack cable first comes within the neighbours' reach of being taut, if it does: along the
/// stretch, unless it has been open since the start, or at the event at its end, which is at another
/// time for each neighbour, unless it closes there in all of them.
#[inline(always)]
fn may_snap(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
    cable: usize,
) -> Option<f64> {
    let Neighbours {
        before, along, met, ..
    } = neighbours;
    let tether = &simulation.system().cables[cable];
    let per_place = 2.0 * tether.length();
    let closes = step.event.closed.contains(cable);
    let near_at_end = |margin: f64| !closes && simulation.contact(cable).gap > -margin;
    // A bound first: |n| = 1, and the arm is no longer than the lever.
    let [a, b] = tether.fairlead().components();
    let slopes = [1.0, 1.0, a.abs() + b.abs(), 0.0, 0.0, 0.0];
    let at_start = reach_from_start(simulation, step, before, cable);
    let at_end = along.at_most(&slopes).max(met.at_most(&slopes));
    let most = per_place * at_end.max(at_start);
    // So is what is known of a bounce.
    let bounced = simulation.bounced(step).filter(|_| closes);
    if bounced.is_some_and(|bounced| bounced.is_open_before_last_rise(most * most)) {
        return None;
    }
    let open = neighbours.opening.contains(cable);
    if open && step.event.reached == Reached::default() {
        return None;
    }
    let first = match open {
        true => None,
        false => simulation.comes_near(step, cable, most),
    };
    if first.is_none() && !near_at_end(most) {
        return None;
    }
    let mut near = first;
    for _ in 0..TRIALS {
        let Some(s) = near else {
            break;
        };
        let reach = reach_within(simulation, step, approach, neighbours, (cable, s));
        near = simulation.comes_near(step, cable, per_place * reach);
        let moved = near.map_or(0.0, |next| (next - s).abs());
        if moved <= SAME_INSTANT * (step.t_end - step.t_start) {
            break;
        }
    }
    let Normal { n, arm } = tether.normal(&step.before);
    let direction = [n.x, n.y, arm, 0.0, 0.0, 0.0];
    let at_end = along.reach(&direction).max(met.reach(&direction));
    let at_end = near_at_end(per_place * at_end).then_some(step.t_end);
    near.map(|s| (step.t_start + s).min(step.t_end)).or(at_end)
}

/// A bound on how far neighbours that drift from `before` to the run reach along the normal of a
/// cable within a step: each just after its own event, along the normal there. The normal turns by
/// at most the way over the cable's length, and the lever by the body's rotation, both from zero
/// on, while neighbours come nearer in proportion to time: a quarter of that counts at most. If the
/// cable is closed at the start it is so for all, and their gaps spread from zero.
fn reach_from_start(simulation: &Simulation, step: &Step, before: &Spread, cable: usize) -> f64 {
    if simulation.contact_at_start(step, cable).gap >= 0.0 {
        return 0.0;
    }
    let tether = &simulation.system().cables[cable];
    let Normal { n, arm } = tether.normal(&step.start);
    let lever = tether.fairlead().length();
    let (first, last, s) = (&step.start, &step.before, step.t_end - step.t_start);
    let speed = |at: &State| at.velocity().length() + at.vtheta.abs() * lever;
    let turned = 0.25 * s * (speed(first) + speed(last)) / tether.length();
    let swung = turned + 0.25 * s * (first.vtheta.abs() + last.vtheta.abs());
    before.reach(&[n.x, n.y, arm, 0.0, 0.0, 0.0])
        + before.at_most(&[turned, turned, swung * lever, 0.0, 0.0, 0.0])
}

/// How far neighbours reach along the normal of a cable a time `s` into a step. In a free flight, in
/// which deviations only drift, with the normal there; if the cable was closed at the start, what
/// they reach at the end if it grows in proportion to time. Otherwise with the normal at the end.
fn reach_within(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    Neighbours { before, along, .. }: &Neighbours,
    (cable, s): (usize, f64),
) -> f64 {
    let (tether, end) = (&simulation.system().cables[cable], &step.before);
    let was_open = simulation.contact_at_start(step, cable).gap < 0.0;
    if !simulation.system().flies_freely(step.taut) || s == 0.0 && !was_open {
        let Normal { n, arm } = tether.normal(end);
        let at_end = along.reach(&[n.x, n.y, arm, 0.0, 0.0, 0.0]);
        return at_end.max(reach_from_start(simulation, step, before, cable));
    }
    let now = simulation.within(step, s);
    let (Normal { n, arm }, left) = (tether.normal(&now), step.t_end - step.t_start - s);
    let [.., x, y, _] = approach.rate;
    let later = n.x * (now.vx - end.vx + left * x) + n.y * (now.vy - end.vy + left * y);
    let place = [n.x, n.y, arm];
    let [by_vx, by_vy, by_spin] = place.map(|slope| -left * slope);
    let direction = [n.x, n.y, arm, by_vx, by_vy, by_spin, later];
    let reach = SIGMA_REACH * along.covariance.along_with_time(&direction);
    if was_open {
        reach
    } else {
        reach * (s + left) / s
    }
}

/// When neighbours may meet a stop rule that the run does not meet, or the other way round.
#[inline(always)]
fn may_stop(simulation: &Simulation, step: &Step, neighbours: &Neighbours) -> Option<f64> {
    let (system, rules) = (simulation.system(), simulation.rules());
    let (before, reached) = (&step.before, step.event.reached);
    let exceeds = rules.limits.iter().filter_map(|(limit, bound)| {
        let slopes = limit.slope_bounds(system, bound);
        let [first, last] = [&neighbours.before, &neighbours.along];
        let margin = first.at_most(&slopes).max(last.at_most(&slopes));
        let at_end = neighbours.met.at_most(&slopes);
        let within =
            |margin: f64| simulation.largest_within(step, limit, bound - margin) + margin >= bound;
        let near = || simulation.comes_near_limit(step, limit, margin);
        if reached.limits.contains(limit) {
            return near();
        }
        let may = within(margin.max(at_end))
            && (limit.quantity(system, before) + at_end >= bound || within(margin));
        may.then(|| near().unwrap_or(step.t_end - step.t_start))
    });
    if let Some(s) = exceeds.reduce(f64::min) {
        return Some((step.t_start + s).min(step.t_end));
    }
    // One cable may stick as another leaves.
    let stuck = step.event.reached.gaps.intersection(step.taut_after);
    let sticks = step.taut_after.len() > step.taut.len() || !stuck.is_empty();
    let settles = [rules.settled_below, rules.sliding_above]
        .into_iter()
        .flatten()
        .any(|height| {
            let spread = neighbours.along.sizes[1].max(neighbours.met.sizes[1]);
            sticks && (before.y - height).abs() <= SIGMA_REACH * spread
        });
    settles.then_some(step.t_end)
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
