//! Which starts are legal.

use crate::arithmetic::real::Real;
use crate::model::cable::Cable;
use crate::model::rules::{Rules, Stop};
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, TautSet};
use crate::motion::active_set::{ActiveSet, taut_next};
use crate::motion::contact::{Contact, Contacts};
use crate::motion::projection::{project_position, project_velocity};
use crate::motion::ties::{Decided, Instant, Tie};
use std::cell::Cell;
use std::fmt;

/// A gap at the start counts as closed within this distance of zero, and a normal velocity as zero
/// (docs/model.md section 5).
pub const START_TOLERANCE: f64 = 1e-9;
/// A gap counts as closed within this part of r², too: of a cable shorter than 0.1 the whole range
/// of gaps, from −r², may be smaller than [`START_TOLERANCE`].
const PART_OF_SQUARE: f64 = 1e-7;
/// Where some of several closed cables depend on others, not all of their gaps become zero: this
/// many times the tolerance may be left.
const LEFT_OVER: f64 = 100.0;
/// A projection moves no attachment by more than this part of its cable. It is 3e-4 at most for a
/// gap within the tolerance whose cables can only be closed together to second order.
const FARTHEST: f64 = 1e-3;
/// The least length of a cable, about a rounding of the unit of length \[L\]: the motion on shorter
/// ones takes too many steps per unit of time, and in the end squares that are rounded to zero.
const LEAST_LENGTH: f64 = 1e-16;

/// Why a start is not legal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartError {
    /// A cable would have to be longer than it is: its gap g = |P − A|² − r² is positive.
    CableTooShort {
        /// The cable, by index from 0.
        cable: usize,
        /// The gap \[L²\].
        gap: f64,
        /// The largest gap that is allowed.
        tolerance: f64,
    },
    /// A cable counts as closed, but no small displacement closes it together with the others.
    CanNotClose {
        /// The cable, by index from 0.
        cable: usize,
    },
    /// A cable is shorter than a motion can follow.
    TooShort {
        /// The cable, by index from 0.
        cable: usize,
        /// Its length.
        length: f64,
    },
    /// The quantity of a limit is beyond its bound.
    BeyondLimit {
        /// The stop rule of this limit.
        stop: Stop,
        /// The quantity that it bounds.
        value: f64,
        /// Its bound.
        bound: f64,
    },
    /// A number of the start, or of what decides the run, is not finite, or a length not positive.
    NotFinite,
    /// A number is finite, and yet one that no motion can be computed with.
    NotAllowed {
        /// What it is.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The coefficient of restitution is not between 0 and 1.
    Restitution,
    /// The system has more cables than [`MAX_CABLES`].
    TooManyCables,
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CableTooShort {
                cable,
                gap,
                tolerance,
            } => write!(
                f,
                "a start within reach of all cables; the gap of cable {} is {gap:.3e}, and at most \
                 {tolerance:.0e} is allowed",
                cable + 1
            ),
            Self::CanNotClose { cable } => write!(
                f,
                "a start on the ends of its closed cables; no displacement of less than a \
                 thousandth of its length closes cable {}",
                cable + 1
            ),
            Self::TooShort { cable, length } => write!(
                f,
                "cables of length {LEAST_LENGTH:e} or more; that of cable {} is {length:e}",
                cable + 1
            ),
            Self::BeyondLimit { stop, value, bound } => write!(
                f,
                "a start within the limits; {} is at {bound}, and the start is at {value}",
                stop.name()
            ),
            Self::NotFinite => f.write_str("finite numbers, and lengths above 0"),
            Self::NotAllowed {
                key,
                value,
                allowed,
            } => write!(f, "{allowed}; {key} is {value}"),
            Self::Restitution => f.write_str("a coefficient of restitution from 0 to 1"),
            Self::TooManyCables => write!(f, "at most {MAX_CABLES} cables"),
        }
    }
}

impl std::error::Error for StartError {}

/// A legal start.
pub(crate) struct Start<T> {
    pub(crate) state: State<T>,
    pub(crate) active: ActiveSet,
    pub(crate) contacts: Contacts<T>,
    /// Taut cables whose tension rises from zero.
    pub(crate) touching: TautSet,
    /// Resting cables of which only rounding tells whether they are taut.
    pub(crate) undecided: TautSet,
    pub(crate) stop: Option<Stop>,
}

/// The largest distance from zero at which the gap of a cable counts as closed at the start.
pub(crate) fn start_tolerance<T: Real>(cable: &Cable<T>) -> T {
    let part = cable.length().squared() * T::from_decimal(PART_OF_SQUARE);
    T::from_decimal(START_TOLERANCE).min(part)
}

/// Checks a start and projects it onto closed cables: in position and velocity onto those whose
/// normal velocity counts as zero, and in position onto those beyond whose ends it is by more than
/// rounding. A cable that opens or closes keeps its gap. The problem on accelerations decides which
/// of those at rest are taut.
#[inline(always)]
pub(crate) fn prepare<T: Real>(
    system: &System<T>,
    rules: &Rules<T>,
    t: T,
    state: &State<T>,
) -> Result<Start<T>, StartError> {
    check_numbers(system, rules, t, state)?;
    let stop = stop_at_start(system, rules, t, state)?;
    let closed = closed_cables(system, state)?;
    let tolerance = T::from_decimal(START_TOLERANCE);
    let given = state;
    let mut state = *state;
    let velocity =
        |state: &State<T>, cable: usize| system.cables[cable].normal(state).velocity(state);
    let resting: TautSet = closed
        .iter()
        .filter(|&cable| velocity(given, cable).abs() <= tolerance)
        .collect();
    let beyond = closed.iter().filter(|&cable| {
        let (gap, error) = system.cables[cable].gap_and_error(given);
        gap > error
    });
    let moved = resting.union(beyond.collect());
    project_position(system, &mut state, moved);
    check_projection(system, given, &state, moved)?;
    project_velocity(system, &mut state, resting);

    let mut contacts = [Contact::RESTING; MAX_CABLES];
    for cable in system.all_cables().iter() {
        contacts[cable] = if resting.contains(cable) {
            Contact::RESTING
        } else if moved.contains(cable) {
            Contact::CLOSED
        } else {
            Contact::evaluated(system, cable, &state).without_rounding()
        };
    }
    let Decided {
        active,
        touching,
        undecided,
    } = taut_at_start((system, rules), t, &state, &contacts, resting);
    let snaps = closed
        .iter()
        .any(|cable| !resting.contains(cable) && velocity(&state, cable) > T::ZERO);
    let low = rules.settled_below.is_some_and(|height| state.y < height);
    let settled = (low && active.taut.len() >= 2 && !snaps).then_some(Stop::Settled);
    Ok(Start {
        state,
        active,
        contacts,
        touching,
        undecided,
        stop: stop.or(settled),
    })
}

/// Which of the cables at rest are taut. The water is taken as undisturbed, and its memory is zero.
#[inline(always)]
fn taut_at_start<T: Real>(
    (system, rules): (&System<T>, &Rules<T>),
    t: T,
    state: &State<T>,
    contacts: &Contacts<T>,
    resting: TautSet,
) -> Decided {
    let still = [T::ZERO; 3];
    let around = system.surroundings(t);
    let active = taut_next(system, &around, state, still, resting);
    let now = Instant {
        system,
        around: &around,
        state,
        memory_force: still,
    };
    let loose = resting.iter().filter(|&cable| !active.taut.contains(cable));
    let cables = now.unmoved(loose.collect(), active.carrying);
    if cables.is_empty() {
        return Decided::known(active);
    }
    let tie = Tie {
        system,
        rules,
        t,
        state,
        contacts,
        resting,
        active,
        cables,
    };
    tie.decided()
}

/// Checks that the system does not have too many cables, and that all numbers that determine the
/// run are finite.
fn check_numbers<T: Real>(
    system: &System<T>,
    rules: &Rules<T>,
    t: T,
    state: &State<T>,
) -> Result<(), StartError> {
    if system.cables.len() > MAX_CABLES {
        return Err(StartError::TooManyCables);
    }
    let Rules {
        limits,
        settled_below,
        sliding_above,
        t_end,
        max_impacts: _,
        v_stick,
    } = *rules;
    let heights = [settled_below, sliding_above].into_iter().flatten();
    let bounds = limits.iter().map(|(_, bound)| bound);
    let numbers = bounds
        .chain(heights)
        .chain([t, t_end, v_stick])
        .chain(state.components());
    let finite = Cell::new(numbers.into_iter().all(|number| number.is_finite()));
    system.map(|number| {
        finite.set(finite.get() && number.is_finite());
        number
    });
    let positive = |cable: &Cable<T>| cable.length() > T::ZERO;
    if !finite.get() || !system.cables.iter().all(positive) {
        return Err(StartError::NotFinite);
    }
    for (cable, tether) in system.cables.iter().enumerate() {
        let length = tether.length().to_f64();
        if length < LEAST_LENGTH {
            return Err(StartError::TooShort { cable, length });
        }
    }
    if !system.contact_law().is_passive() {
        return Err(StartError::Restitution);
    }
    check_signs(system, v_stick)?;
    check_parts(system)
}

/// Checks that no size is negative.
fn check_signs<T: Real>(system: &System<T>, v_stick: T) -> Result<(), StartError> {
    let body = &system.body;
    let inertia = T::ONE / body.inverse_inertia();
    let speed = ("v_stick", v_stick, "a speed of 0 or more");
    let others = [speed, ("inertia", inertia, "a moment of inertia above 0")];
    let sizes = body.sizes();
    let sizes = sizes.map(|(key, size)| (key, size, "a size of 0 or more"));
    let mut negative = others.into_iter().chain(sizes);
    let negative = negative.find(|(_, value, _)| *value < T::ZERO);
    negative.map_or(Ok(()), |(key, value, allowed)| {
        Err(StartError::NotAllowed {
            key,
            value: value.to_f64(),
            allowed,
        })
    })
}

/// Checks what the parts of a system promise: that a cable which is taut at rest by construction
/// has its length there, and that the memory of the water fades.
fn check_parts<T: Real>(system: &System<T>) -> Result<(), StartError> {
    for tether in &system.cables {
        if let Some(span) = tether.span_taut_at_rest() {
            let square = tether.length().squared();
            let part = square * T::from_decimal(PART_OF_SQUARE);
            let tolerance = T::from_decimal(START_TOLERANCE).max(part) * LEFT_OVER;
            if (span.dot(span) - square).abs() > tolerance {
                return Err(StartError::NotAllowed {
                    key: "rest_span",
                    value: span.length().to_f64(),
                    allowed: "a span as long as its cable, which is taut at rest",
                });
            }
        }
    }
    let memory = system.floating.iter().flat_map(|water| &water.memory);
    let mut growing = memory.filter(|term| term.pole[0] > T::ZERO);
    growing.next().map_or(Ok(()), |term| {
        Err(StartError::NotAllowed {
            key: "pole",
            value: term.pole[0].to_f64(),
            allowed: "a memory that fades: poles whose real parts are not above 0",
        })
    })
}

/// The cables that count as closed: those whose gap is within the tolerance of zero or, if the
/// cable is so short and so far from the origin that this is less, within its rounding error.
#[inline(always)]
fn closed_cables<T: Real>(system: &System<T>, state: &State<T>) -> Result<TautSet, StartError> {
    let mut closed = TautSet::SLACK;
    for (cable, tether) in system.cables.iter().enumerate() {
        let (gap, error) = tether.gap_and_error(state);
        let rounding = error.min(T::from_decimal(START_TOLERANCE));
        let tolerance = start_tolerance(tether).max(rounding);
        if gap > tolerance {
            return Err(StartError::CableTooShort {
                cable,
                gap: gap.to_f64(),
                tolerance: tolerance.to_f64(),
            });
        }
        if gap >= -tolerance {
            closed = closed.with(cable);
        }
    }
    Ok(closed)
}

/// Checks that a projection has closed the cables, and has only moved the body a little.
#[inline(always)]
fn check_projection<T: Real>(
    system: &System<T>,
    given: &State<T>,
    projected: &State<T>,
    closed: TautSet,
) -> Result<(), StartError> {
    for cable in closed.iter() {
        let tether = &system.cables[cable];
        let (gap, error) = tether.gap_and_error(projected);
        let moved = tether.span(projected) - tether.span(given);
        let is_near = moved.length() <= tether.length() * FARTHEST;
        let is_closed = gap.abs() <= start_tolerance(tether).max(error) * LEFT_OVER;
        // Numbers that are not finite are neither.
        if !(is_near && is_closed) {
            return Err(StartError::CanNotClose { cable });
        }
    }
    Ok(())
}

/// A start at a limit stops at once; one beyond it is an error.
#[inline(always)]
fn stop_at_start<T: Real>(
    system: &System<T>,
    rules: &Rules<T>,
    t: T,
    state: &State<T>,
) -> Result<Option<Stop>, StartError> {
    for (limit, bound) in rules.limits.iter() {
        let value = limit.quantity(system, state);
        if value > bound {
            return Err(StartError::BeyondLimit {
                stop: limit.stop(),
                value: value.to_f64(),
                bound: bound.to_f64(),
            });
        }
        if value == bound {
            return Ok(Some(limit.stop()));
        }
    }
    Ok((rules.t_end <= t).then_some(Stop::EndTime))
}
