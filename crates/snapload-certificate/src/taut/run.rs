//! Motion with taut cables, from where it begins to the first event.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::Model;
use crate::slack::search::{Crossing, Path, Zeros, first_crossing};
use crate::slack::set::Set;
use crate::taut::chart::{Chart, EventFunction};
use crate::taut::law::Law;
use crate::taut::rocking::Rocking;
use crate::taut::sliding::Sliding;
use crate::taut::start::{Instants, Started, hull_of, start_motion};
use crate::taut::step::{Equations, Step, TwoPrecisions};
use crate::verdict::ProofFailure;
use snapload::Stop;

/// The most steps of a taut motion before the proof gives up.
const MOST_STEPS: usize = 100_000;
const LONGEST_STEP: f64 = 0.25;

/// How a motion with taut cables ends, and the states then, each at its own instant.
pub(crate) struct TautEnd {
    pub(crate) instants: Instants,
    pub(crate) event: Event,
}

/// The event that ends it. Cables are by index from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// The tension of a cable falls to zero.
    Released(usize),
    /// A slack cable closes.
    Struck(usize),
    Stop(Stop),
}

/// Where a motion with taut cables begins.
pub(crate) struct StartData<'a> {
    /// The taut cables, by index from 0.
    pub(crate) taut: &'a [usize],
    /// The states before the laws of the event that makes the cables taut.
    pub(crate) instants: &'a Instants,
    pub(crate) laws: &'a [Law],
    /// Other cables that are closed then, and leave.
    pub(crate) zeros: &'a Zeros,
}

/// The motion from an instant at which some cables are taut with positive tensions and without
/// normal velocities.
///
/// `on_step` receives the time of each step, and may end the work.
pub(crate) fn enclose_taut_motion(
    model: &Model,
    start: &StartData<'_>,
    on_step: &mut dyn FnMut(&Ball) -> Result<(), ProofFailure>,
) -> Result<TautEnd, ProofFailure> {
    match start.taut {
        [cable] => follow(model, &Sliding(*cable), start, on_step),
        _ => {
            let (state, _) = hull_of(start.instants);
            follow(model, &Rocking::at(model, &state)?, start, on_step)
        }
    }
}

fn follow<const N: usize>(
    model: &Model,
    chart: &impl Chart<N>,
    start: &StartData<'_>,
    on_step: &mut dyn FnMut(&Ball) -> Result<(), ProofFailure>,
) -> Result<TautEnd, ProofFailure> {
    let equations = Equations::of(chart, model);
    let place = TwoPrecisions::of(chart.place(model));
    let Started {
        mut t,
        mut set,
        slack,
    } = start_motion(&equations, chart, start.laws, start.instants)?;
    // The motion begins within [0, slack] after T.
    let mut from = (
        Ball::within(slack.scaled(-1)) + Ball::bound(slack).half(),
        Ball::bound(slack),
    );
    let output = |cable: usize| {
        let mut all = equations.event_functions.iter();
        all.position(|function| *function == EventFunction::Gap(cable))
    };
    let zeros = start.zeros.iter();
    let mut zeros: Zeros = zeros
        .filter_map(|(cable, zero)| Some((output(*cable)?, *zero)))
        .collect();
    let mut most = LONGEST_STEP;
    for _ in 0..MOST_STEPS {
        let left = &model.t_end - &t;
        let step = Step::new(&equations, &t, &set, most)?;
        // A little more than the last length that succeeded, as a length that is too large costs a
        // trial.
        most = LONGEST_STEP.min(1.06 * step.length.to_f64());
        let now = StepStart {
            t: &t,
            set: &set,
            left: &left,
            from: &from,
            zeros: &zeros,
        };
        if let Some(end) = ending(&step, &now, &place)? {
            return Ok(end);
        }
        on_step(&t)?;
        set = step.end(&set)?;
        let next = &t + &step.length;
        if !next.radius().is_zero() {
            return Err(ProofFailure::undecided("the time of a step"));
        }
        (t, zeros) = (next, Zeros::new());
        from = (Ball::zero(), Ball::zero());
    }
    Err(ProofFailure::undecided("a taut motion of too many steps"))
}

/// The beginning of a step: its time, the states, the time that is left, when the motion begins,
/// and which values are zero then.
struct StepStart<'a, const N: usize> {
    t: &'a Ball,
    set: &'a Set<N>,
    left: &'a Ball,
    from: &'a (Ball, Ball),
    zeros: &'a Zeros,
}

/// The end of the motion within a step, if it ends there.
fn ending<const N: usize>(
    step: &Step<'_, N>,
    now: &StepStart<'_, N>,
    place: &TwoPrecisions,
) -> Result<Option<TautEnd>, ProofFailure> {
    let (limit, left) = (&step.length, now.left);
    let latest_start = &now.from.1;
    if !latest_start.is_below(limit) {
        return Err(ProofFailure::undecided(
            "a beginning that lasts longer than a step",
        ));
    }
    let found = first_crossing(step, now.from, now.zeros, limit)?;
    let roots = match &found {
        Some(crossing) => Some(roots(step, crossing)?),
        None => None,
    };
    let root = roots.as_ref().map(|[_, whole]| whole);
    if left.is_below(root.unwrap_or(limit)) && latest_start.is_below(left) {
        return Ok(Some(TautEnd {
            instants: step.at_time(now.t, left, place, now.set)?,
            event: Event::Stop(Stop::EndTime),
        }));
    }
    if let (Some(crossing), Some([centre, whole])) = (&found, &roots) {
        if !(whole.is_below(left) && latest_start.is_below(whole)) {
            return Err(ProofFailure::undecided(
                "two events of a taut motion at one instant",
            ));
        }
        let map = step.crossed(crossing.which, now.t, [centre, whole], place);
        let lost = || ProofFailure::undecided("the state at an event of a taut motion");
        let (image, jacobian) = map.ok_or_else(lost)?;
        return Ok(Some(TautEnd {
            instants: now.set.mapped(&image, &jacobian)?,
            event: event(step.event_function(crossing.which)),
        }));
    }
    if limit.is_below(left) {
        Ok(None)
    } else {
        Err(ProofFailure::undecided(
            "the end of time at the end of a step",
        ))
    }
}

fn event(function: EventFunction) -> Event {
    match function {
        EventFunction::Tension(cable) => Event::Released(cable),
        EventFunction::Gap(cable) => Event::Struck(cable),
        EventFunction::Rotation => Event::Stop(Stop::RotationLimit),
        EventFunction::Top => Event::Stop(Stop::UpperBound),
    }
}

/// The times at which an event function crosses zero, for the centre
/// and for every state of the set.
fn roots<const N: usize>(
    step: &Step<'_, N>,
    crossing: &Crossing,
) -> Result<[Ball; 2], ProofFailure> {
    let which = crossing.which;
    let (mut low, mut high) = (crossing.from.clone(), crossing.to.clone());
    let mut tau = (&low + &high).half().centre().with_limbs(step.limbs());
    let close = Radius::power_of_two(16 - 64 * step.limbs() as i64);
    for _ in 0..40 {
        let value = step.event_value(which, &tau).value.centre();
        if value.is_negative() {
            low = tau.clone();
        } else {
            high = tau.clone();
        }
        let next = value
            .over(&step.event_value(which, &tau).rate.centre())
            .map(|move_| (&tau - &move_).centre());
        let next = next.filter(|next| !(next.is_below(&low) || high.is_below(next)));
        let next = next.unwrap_or_else(|| (&low + &high).half().centre());
        let moved = (&next - &tau).upper();
        tau = next.with_limbs(step.limbs());
        if moved <= close {
            break;
        }
    }
    let flat =
        || ProofFailure::undecided("whether an event of a taut motion is crossed or only touched");
    if !(crossing.from.is_below(&tau) && tau.is_below(&crossing.to)) {
        return Err(flat());
    }
    // As for flights: τ − f(τ)/ḟ, first with the slope over the piece, then with the slope near the
    // root.
    let value = step.event_value(which, &tau).value;
    let first = &tau - &value.over(&crossing.slope).ok_or_else(flat)?;
    let slope = step.event_value(which, &tau.hull(&first)).rate;
    if !slope.is_positive() {
        return Err(flat());
    }
    let centre = step.centre_value(which, &tau);
    Ok([
        &tau - &centre.over(&slope).ok_or_else(flat)?,
        &tau - &value.over(&slope).ok_or_else(flat)?,
    ])
}
