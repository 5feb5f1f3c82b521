//! Motion with one taut cable, from where it begins to the first event, and what comes of that.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::{Model, State};
use crate::slack::impact::Impact;
use crate::slack::search::{Crossing, Path, Zero, first_crossing};
use crate::slack::set::Set;
use crate::taut::series::Program;
use crate::taut::sliding::{
    Coordinates, OTHER_GAP, ROTATIONS, TENSION, coordinates_of, equations, state_of,
};
use crate::taut::step::Step;
use crate::verdict::Trouble;
use snapload::Stop;

/// So many steps before a taut motion is given up.
const MOST_STEPS: usize = 100_000;

/// How a motion with one taut cable ends: when, and the state then.
pub(crate) struct TautEnd {
    pub(crate) t: Ball,
    pub(crate) state: State,
    pub(crate) event: Event,
}

/// What ends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// The tension is lost, falling.
    Released,
    /// The other cable closes.
    Struck,
    Stop(Stop),
}

/// Where a motion with one taut cable begins.
pub(crate) struct Begin<'a> {
    pub(crate) cable: usize,
    /// An instant within this ball.
    pub(crate) t: &'a Ball,
    pub(crate) state: &'a State,
    /// Whether the other cable is closed then, and opens.
    pub(crate) other_opens: bool,
}

/// The motion from an instant at which one cable is taut with a positive tension and without normal
/// velocity.
///
/// The state is carried back to a number T before that instant along the same equations: nothing of
/// what is proved of the time before it is used, and at most ± `slack` more of it.
pub(crate) fn slide(model: &Model, begin: &Begin<'_>) -> Result<TautEnd, Trouble> {
    let program = equations(model, begin.cable);
    let at = coordinates_of(model, begin.cable, begin.state)?;
    // T has a limb less than there is, so that T + H is a number, too.
    let last = Radius::power_of_two(64 - 64 * model.limbs as i64);
    let before = &begin.t.centre() - &Ball::bound(begin.t.radius().plus(last)).twice();
    let before = before.centre().with_limbs(model.limbs - 1).centre();
    let mut t = before.with_limbs(model.limbs);
    let slack = (begin.t - &t).upper();
    let mut set = Set::of_box(&widened(model, &program, begin.t, at, slack)?);
    // The motion begins within [0, slack] after T.
    let mut from = (
        Ball::within(slack.scaled(-1)) + Ball::bound(slack).half(),
        Ball::bound(slack),
    );
    let mut zeros = Vec::new();
    if begin.other_opens {
        zeros.push((OTHER_GAP, Zero::Opening));
    }
    for _ in 0..MOST_STEPS {
        let left = &model.t_end - &t;
        let step = Step::new(model, &program, &t, &set, 0.25)?;
        let limit = step.length.clone();
        let found = first_crossing(&step, &from, &zeros, &limit)?;
        let root = match &found {
            Some(crossing) => Some(root(&step, crossing)?),
            None => None,
        };
        let ends = left.is_below(root.as_ref().unwrap_or(&limit));
        if ends && from.1.is_below(&left) {
            return Ok(TautEnd {
                t: &t + &left,
                state: state_of(model, begin.cable, &step.at(&left)),
                event: Event::Stop(Stop::EndTime),
            });
        }
        if let (Some(crossing), Some(root)) = (&found, root) {
            if !(root.is_below(&left) && from.1.is_below(&root)) {
                return Err(Trouble::undecided(
                    "two events of a taut motion at one instant",
                ));
            }
            return event(model, begin.cable, &step, &t, crossing, &root);
        }
        if !limit.is_below(&left) {
            return Err(Trouble::undecided("the end of time at the end of a step"));
        }
        set = step.end(&set)?;
        let next = &t + &limit;
        if !next.radius().is_zero() {
            return Err(Trouble::undecided("the time of a step"));
        }
        (t, zeros) = (next, Vec::new());
        from = (Ball::zero(), Ball::zero());
    }
    Err(Trouble::undecided("a taut motion of very many steps"))
}

/// All states of the motion within `slack` of an instant: a box W with y₀ + [−slack, slack] F(W)
/// within W holds every solution that passes through y₀ (Picard).
fn widened(
    model: &Model,
    program: &Program,
    time: &Ball,
    at: Coordinates,
    slack: Radius,
) -> Result<Coordinates, Trouble> {
    let times = time.clone().widened(slack);
    let speeds = |state: &Coordinates| -> Option<[Radius; 4]> {
        let expansion = program.expand(state, &times, 1, &model.functions)?;
        Some(std::array::from_fn(|i| expansion.state[i][1].upper()))
    };
    let lost = || Trouble::undecided("the forces of a taut motion");
    let guess = speeds(&at).ok_or_else(lost)?;
    let wide: Coordinates = std::array::from_fn(|i| {
        let reach = guess[i].scaled(1).plus(Radius::power_of_two(-32));
        at[i].clone().widened(reach.times(slack))
    });
    let true_speeds = speeds(&wide).ok_or_else(lost)?;
    let holds = (0..4).all(|i| {
        let reach = guess[i].scaled(1).plus(Radius::power_of_two(-32));
        true_speeds[i] < reach
    });
    if holds {
        Ok(wide)
    } else {
        Err(Trouble::undecided("the begin of a taut motion"))
    }
}

/// When a watched value crosses zero, for every state of the set.
fn root(step: &Step<'_>, crossing: &Crossing) -> Result<Ball, Trouble> {
    let which = crossing.which;
    let (mut low, mut high) = (crossing.from.clone(), crossing.to.clone());
    let mut tau = (&low + &high).half().centre().with_limbs(step.limbs());
    let close = Radius::power_of_two(16 - 64 * step.limbs() as i64);
    for _ in 0..40 {
        let watched = step.one_watched(which, &tau);
        let value = watched.value.centre();
        if value.is_negative() {
            low = tau.clone();
        } else {
            high = tau.clone();
        }
        let next = value
            .over(&watched.rate.centre())
            .map(|move_| (&tau - &move_).centre());
        let next = next.filter(|next| !(next.is_below(&low) || high.is_below(next)));
        let next = next.unwrap_or_else(|| (&low + &high).half().centre());
        let moved = (&next - &tau).upper();
        tau = next.with_limbs(step.limbs());
        if moved <= close {
            break;
        }
    }
    let flat = || Trouble::undecided("an event of a taut motion that is only touched");
    if !(crossing.from.is_below(&tau) && tau.is_below(&crossing.to)) {
        return Err(flat());
    }
    // As for flights: τ − f(τ)/ḟ, first with the slope of the piece, then with that about the root.
    let value = step.one_watched(which, &tau).value;
    let first = &tau - &value.over(&crossing.slope).ok_or_else(flat)?;
    let slope = step.one_watched(which, &tau.hull(&first)).rate;
    if !slope.is_positive() {
        return Err(flat());
    }
    Ok(&tau - &value.over(&slope).ok_or_else(flat)?)
}

fn event(
    model: &Model,
    cable: usize,
    step: &Step<'_>,
    t: &Ball,
    crossing: &Crossing,
    root: &Ball,
) -> Result<TautEnd, Trouble> {
    let state = state_of(model, cable, &step.at(root));
    let event = match crossing.which {
        TENSION => Event::Released,
        OTHER_GAP => Event::Struck,
        which if ROTATIONS.contains(&which) => Event::Stop(Stop::RotationLimit),
        _ => Event::Stop(Stop::UpperBound),
    };
    Ok(TautEnd {
        t: t + root,
        state,
        event,
    })
}

/// What an impact of the other cable makes of a cable that is taut: the velocities after it, and
/// whether the taut cable stays so.
///
/// With one impulse p_k = (1 + e) v_k/w_k the taut cable's normal velocity becomes −W_ck p_k. If that
/// opens it, W_ck > 0, it leaves. If W_ck < 0 it receives p_c = −W_ck p_k/w_c > 0 and stays, and
/// p_k = (1 + e) v_k/(w_k − W_ck²/w_c).
pub(crate) fn beside_a_taut_cable(
    model: &Model,
    struck: &Impact,
    taut: &Impact,
    state: &State,
) -> Result<([Ball; 3], bool), Trouble> {
    let share = Ball::integer(1) + &model.e;
    let coupling = struck.coupling(taut);
    if coupling.is_positive() {
        return Ok((struck.velocity(state, &share), false));
    }
    if !coupling.is_negative() {
        return Err(Trouble::undecided(
            "whether an impact unloads the taut cable",
        ));
    }
    let shared = coupling.squared() * &taut.inverse_w * &struck.inverse_w;
    let left = Ball::integer(1) - shared;
    let inverse = left.reciprocal().filter(|_| left.is_positive());
    let left = inverse.ok_or(Trouble::undecided("two cables of one effective mass"))?;
    let p = share * &struck.v_n * &struck.inverse_w * left;
    let q = -(&coupling * &p * &taut.inverse_w);
    let velocity = std::array::from_fn(|i| &state[3 + i] - &(&p * &struck.u[i]) - &q * &taut.u[i]);
    Ok((velocity, true))
}
