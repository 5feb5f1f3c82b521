//! The first of the event functions to reach zero along a flight, with the proof that none does so
//! earlier.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::EventValue;
use crate::verdict::ProofFailure;

/// The most pieces of one flight that are examined before the search gives up.
const MOST_PIECES: u32 = 4000;
/// How often the first piece may be halved where a value leaves zero with zero rate.
const MOST_HALVINGS: u32 = 60;

/// A stretch of time in which one value crosses zero once, rising, for every flight of the set,
/// while no other event function reaches zero before its end.
#[derive(Clone, Debug)]
pub(crate) struct Crossing {
    pub(crate) which: usize,
    pub(crate) from: Ball,
    pub(crate) to: Ball,
    /// The rate of the value throughout the piece, which is positive.
    pub(crate) slope: Ball,
}

/// A stretch of motion along which the event functions are followed, each of which has to stay
/// below zero.
pub(crate) trait Path {
    /// How many event functions there are.
    fn count(&self) -> usize;
    /// The value of one event function, at a ball of times.
    fn event_value(&self, which: usize, tau: &Ball) -> EventValue;
    /// The second derivatives of the values over all times that differ from `middle` by at most
    /// `half`.
    fn second_derivatives(&self, middle: &Ball, half: Radius) -> Vec<Ball>;
    /// The event that happens where a value reaches zero, in words.
    fn event_name(&self, which: usize) -> String;
    /// All of them.
    fn event_values(&self, tau: &Ball) -> Vec<EventValue> {
        (0..self.count())
            .map(|which| self.event_value(which, tau))
            .collect()
    }
    /// The third derivative of one of them; none if it is not known.
    fn third(&self, _which: usize, _middle: &Ball, _half: Radius) -> Option<Ball> {
        None
    }
}

/// How a value leaves zero where the motion begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Zero {
    /// Its rate is negative.
    Opening,
    /// Its rate is zero, too, and its second derivative is negative.
    LeavingByAcceleration,
    /// Its rate and second derivative are zero, too, and its third derivative is negative.
    Released,
}

impl Zero {
    /// How a cable leaves that has snapped and carries no tension.
    ///
    /// At the instant of the snap its gap is zero, as that is what defines the instant, and the law
    /// of impact makes its normal velocity −e v_n. With e = 0 that is zero, too. Of both only
    /// enclosures can be computed, which hold zero; that they are zero is known by the law, for
    /// each state at its own instant.
    pub(crate) fn after_snap(e: &Ball) -> Self {
        if e.is_zero() {
            Self::LeavingByAcceleration
        } else {
            Self::Opening
        }
    }
}

/// Values that are zero at the instant at which the motion begins.
pub(crate) type Zeros = Vec<(usize, Zero)>;

/// A time, which is a single number, and the event functions at it.
type Moment = (Ball, Vec<EventValue>);

/// What is known of a piece of a flight.
enum Piece {
    /// All values stay below zero, also at its end.
    Clear,
    /// One value crosses zero.
    Crossed(usize, Ball),
    /// Not decided yet.
    Open,
}

/// The first crossing in (lo, limit] of a motion that begins at some instant within the ball
/// `start`, no later than the number `lo`; none if there is none.
///
/// # Errors
/// [`ProofFailure`] where it can not be decided.
pub(crate) fn first_crossing(
    path: &impl Path,
    (start, lo): &(Ball, Ball),
    zeros: &Zeros,
    limit: &Ball,
) -> Result<Option<Crossing>, ProofFailure> {
    let first = beginning(path, start, zeros)?;
    let mut length = likely_length(path, lo, &first, zeros);
    let mut at: Moment = (lo.clone(), first);
    let mut closed: Vec<usize> = zeros.iter().map(|(which, _)| *which).collect();
    let mut ahead: Vec<Moment> = Vec::new();
    if zeros.iter().any(|(_, zero)| *zero != Zero::Opening) {
        at = without_rate(path, &at, (zeros, limit), &mut length)?;
        closed.clear();
    }
    for _ in 0..MOST_PIECES {
        let Some(next) = ahead.pop() else {
            if !at.0.is_below(limit) {
                return Ok(None);
            }
            let mut to = (&at.0 + &Ball::double(length)).centre();
            if !to.is_below(limit) {
                to = limit.clone();
            }
            length *= 2.0;
            ahead.push((to.clone(), path.event_values(&to)));
            continue;
        };
        match classify_piece(path, &at, &next, &closed) {
            Piece::Clear => {
                at = next;
                closed.clear();
            }
            Piece::Crossed(which, slope) => {
                return Ok(Some(Crossing {
                    which,
                    from: at.0,
                    to: next.0,
                    slope,
                }));
            }
            Piece::Open => {
                let middle = (&at.0 + &next.0).half().centre();
                if !(at.0.is_below(&middle) && middle.is_below(&next.0)) {
                    return Err(undecided(path, &next));
                }
                let values = path.event_values(&middle);
                ahead.push(next);
                ahead.push((middle, values));
            }
        }
    }
    Err(undecided(path, &at))
}

/// The first piece where a value leaves zero with zero rate. If its second derivative is negative
/// up to some time, or is zero at the beginning and the third derivative is negative up to that
/// time, the value is below zero from just after the beginning to that time.
fn without_rate(
    path: &impl Path,
    at: &Moment,
    (zeros, limit): (&Zeros, &Ball),
    length: &mut f64,
) -> Result<Moment, ProofFailure> {
    let mut step = *length;
    let known: Vec<usize> = zeros.iter().map(|(which, _)| *which).collect();
    let slow = zeros.iter().filter(|(_, zero)| *zero != Zero::Opening);
    let slow: Vec<(usize, Zero)> = slow.copied().collect();
    let skipped: Vec<usize> = slow.iter().map(|(which, _)| *which).collect();
    for _ in 0..MOST_HALVINGS {
        let mut to = (&at.0 + &Ball::double(step)).centre();
        if !to.is_below(limit) {
            to = limit.clone();
        }
        // The motion begins no earlier than at time −lo.
        let half = Ball::double(step)
            .half()
            .upper()
            .plus(at.0.upper().scaled(1));
        let middle = (&at.0 + &Ball::double(step / 2.0)).centre();
        let second_derivatives = path.second_derivatives(&middle, half);
        let falls = slow.iter().all(|(which, zero)| match zero {
            Zero::Released => path
                .third(*which, &middle, half)
                .is_some_and(|third| third.is_negative()),
            _ => second_derivatives[*which].is_negative(),
        });
        let next: Moment = (to.clone(), path.event_values(&to));
        let mut ends = skipped.iter().map(|which| &next.1[*which].value);
        let below = ends.all(Ball::is_negative);
        if falls && below && others_clear(path, at, &next, &known, &skipped) {
            *length = step;
            return Ok(next);
        }
        step /= 2.0;
    }
    Err(undecided(path, at))
}

/// Whether all values except the skipped ones stay below zero over a piece.
fn others_clear(
    path: &impl Path,
    from: &Moment,
    to: &Moment,
    known: &[usize],
    skipped: &[usize],
) -> bool {
    let length = &to.0 - &from.0;
    let middle = (&from.0 + &to.0).half();
    let half = length.upper().scaled(-1).plus(middle.radius());
    let second_derivatives = path.second_derivatives(&middle.centre(), half);
    let half_square = length.squared().half();
    second_derivatives
        .iter()
        .enumerate()
        .all(|(which, second_derivative)| {
            skipped.contains(&which)
                || stays_below(
                    &from.1[which],
                    &to.1[which],
                    known.contains(&which),
                    second_derivative,
                    &half_square,
                )
        })
}

/// An error that names the value nearest to zero there, or the two that are equally near.
fn undecided(path: &impl Path, (_, values): &Moment) -> ProofFailure {
    let size = |k: &usize| values[*k].value.to_f64().abs();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let near = |k: &&usize| size(k) <= 2.0 * size(&order[0]);
    let names: Vec<String> = order
        .iter()
        .take_while(near)
        .map(|k| path.event_name(*k))
        .collect();
    let value = order.first().map_or(0.0, size);
    let which = match names.len() {
        1 => "whether it is reached",
        _ => "which of them is reached first, or all at one instant",
    };
    ProofFailure::undecided(format!(
        "{}: {which}, at a distance of {value:.2e}",
        names.join(" and ")
    ))
}

/// The name of an event function.
pub(crate) fn name(which: usize) -> &'static str {
    match which {
        0 => "the length of cable 1",
        1 => "the length of cable 2",
        _ => "the upper bound",
    }
}

/// The event functions on the ball of times in which the motion begins. A value that is zero at the
/// first instant is below zero from there to the end of the ball, as its rate is negative on it (or
/// by a higher derivative, which the first piece examines); all others are below zero.
fn beginning(
    path: &impl Path,
    start: &Ball,
    zeros: &Zeros,
) -> Result<Vec<EventValue>, ProofFailure> {
    let first = path.event_values(start);
    for (which, event_value) in first.iter().enumerate() {
        let zero = zeros.iter().find(|(zero, _)| *zero == which);
        let (holds, what) = match zero {
            Some((_, Zero::Opening)) => (event_value.rate.is_negative(), "the motion leaves"),
            Some((_, Zero::LeavingByAcceleration | Zero::Released)) => (true, "the motion leaves"),
            None => (
                event_value.value.is_negative(),
                "the motion is still short of",
            ),
        };
        if !holds {
            let what = format!(
                "whether {what} {} at the beginning of a stretch",
                path.event_name(which)
            );
            return Err(ProofFailure::undecided(what));
        }
    }
    Ok(first)
}

/// A guess of how long no value reaches zero, from the parabolas through the values, rates and
/// second derivatives now.
fn likely_length(path: &impl Path, lo: &Ball, first: &[EventValue], zeros: &Zeros) -> f64 {
    let second_derivatives = path.second_derivatives(lo, Radius::ZERO);
    let mut least = 0.4;
    for (which, (event_value, second_derivative)) in
        first.iter().zip(second_derivatives).enumerate()
    {
        let (rate, second_derivative) = (event_value.rate.to_f64(), second_derivative.to_f64());
        let value = if zeros.iter().any(|(zero, _)| *zero == which) {
            0.0
        } else {
            event_value.value.to_f64()
        };
        // value + rate t + second_derivative t²/2 = 0, without cancellation.
        let root = (rate * rate - 2.0 * second_derivative * value)
            .max(0.0)
            .sqrt();
        let t = if rate > 0.0 {
            -2.0 * value / (rate + root)
        } else {
            (root - rate) / second_derivative
        };
        // A value that leaves zero with zero rate and second derivative has no such parabola.
        if t > 1e-15 && t < least {
            least = t;
        }
    }
    1.25 * least
}

/// Decides what happens on the piece between two times. The values in `closed` are known to be at
/// most zero at the first time, and not evaluated there.
fn classify_piece(path: &impl Path, from: &Moment, to: &Moment, closed: &[usize]) -> Piece {
    let length = &to.0 - &from.0;
    let middle = (&from.0 + &to.0).half();
    let half = length.upper().scaled(-1).plus(middle.radius());
    let second_derivatives = path.second_derivatives(&middle.centre(), half);
    let half_square = length.squared().half();
    let mut crossed = None;
    for (which, second_derivative) in second_derivatives.iter().enumerate() {
        let (start, end) = (&from.1[which], &to.1[which]);
        let known = closed.contains(&which);
        if stays_below(start, end, known, second_derivative, &half_square) {
            continue;
        }
        let slope = match (known, crossed) {
            (false, None) => rising(start, end, second_derivative, &length),
            _ => None,
        };
        let Some(slope) = slope else {
            return Piece::Open;
        };
        crossed = Some((which, slope));
    }
    match crossed {
        None => Piece::Clear,
        Some((which, slope)) => Piece::Crossed(which, slope),
    }
}

/// Whether a value stays below zero from just after the beginning of a piece up to its end.
///
/// Let f̈ ≥ −K on the piece of length H, f ≤ 0 at both ends and t the time since its start. The
/// difference of f and the chord plus K t (H − t)/2 has a second derivative that is not negative
/// and vanishes at both ends, so that f ≤ chord + K t (H − t)/2. With f < 0 at the end, f < 0 holds
/// in between, too,
///
/// - if K < 0: the chord is at most zero, and the rest below;
/// - if f < −KH²/8 at both ends and K ≥ 0, as t (H − t) ≤ H²/4;
/// - if f < −KH²/2 at one end and K ≥ 0: the chord is then below −KH²/2 times the share of the way
///   from the other end, −KHt/2 or −KH(H − t)/2, and K t (H − t)/2 is no larger in size.
///
/// `half_square` is H²/2; the comparisons hold for every number of the balls.
pub(crate) fn stays_below(
    start: &EventValue,
    end: &EventValue,
    known: bool,
    second_derivative: &Ball,
    half_square: &Ball,
) -> bool {
    if !end.value.is_negative() || !(known || start.value.is_negative()) {
        return false;
    }
    if second_derivative.is_positive() {
        return true;
    }
    let least = second_derivative * half_square;
    let beyond = |value: &Ball, share: i64| value.is_below(&least.scaled(-share));
    if known {
        return beyond(&end.value, 0);
    }
    beyond(&start.value, 2) && beyond(&end.value, 2)
        || beyond(&start.value, 0)
        || beyond(&end.value, 0)
}

/// The rate of a value throughout a piece, if the value rises there from below zero to above.
fn rising(
    start: &EventValue,
    end: &EventValue,
    second_derivative: &Ball,
    length: &Ball,
) -> Option<Ball> {
    if !(start.value.is_negative() && end.value.is_positive()) {
        return None;
    }
    // The rate is enclosed by the rate at either end and its largest change over [0, H].
    let within = length.half().widened(length.upper().scaled(-1));
    let change = second_derivative * &within;
    [&start.rate + &change, &end.rate - &change]
        .into_iter()
        .find(Ball::is_positive)
}
