//! The first of the watched values to reach zero along a flight, with the proof that none does so
//! earlier.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::Watched;
use crate::slack::flight::Flight;
use crate::verdict::Trouble;

/// So many pieces of one flight are looked at before it is given up.
const MOST_PIECES: u32 = 4000;

/// A stretch of time in which one value crosses zero once, rising, for every flight of the set, and
/// before the end of which nothing else of what is watched reaches zero.
#[derive(Clone, Debug)]
pub(crate) struct Crossing {
    pub(crate) which: usize,
    pub(crate) from: Ball,
    pub(crate) to: Ball,
    /// The rate of the value throughout: above zero.
    pub(crate) slope: Ball,
}

/// A moment, which is a number, and what is watched then.
type Moment = (Ball, Vec<Watched>);

/// What is known of a piece of a flight.
enum Piece {
    /// All values stay below zero, at its end, too.
    Clear,
    /// One crosses.
    Crossed(usize, Ball),
    /// Nothing yet.
    Open,
}

/// The first crossing in (slack, limit], where the flight begins somewhere in ± `slack`; none if
/// there is none. `struck` is the value that is zero where the flight begins.
///
/// # Errors
/// [`Trouble`] where it can not be told.
pub(crate) fn first_crossing(
    flight: &Flight<'_>,
    slack: Radius,
    struck: Option<usize>,
    limit: &Ball,
) -> Result<Option<Crossing>, Trouble> {
    let first = beginning(flight, slack, struck)?;
    let mut length = likely_length(flight, &first, struck);
    let mut at: Moment = (Ball::bound(slack), first);
    let mut closed = struck;
    let mut ahead: Vec<Moment> = Vec::new();
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
            ahead.push((to.clone(), flight.watched(&to)));
            continue;
        };
        match judge(flight, &at, &next, closed) {
            Piece::Clear => (at, closed) = (next, None),
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
                    return Err(undecided(&next));
                }
                let watched = flight.watched(&middle);
                ahead.push(next);
                ahead.push((middle, watched));
            }
        }
    }
    Err(undecided(&at))
}

/// Which value is nearest to zero there.
fn undecided((_, watched): &Moment) -> Trouble {
    let size = |k: &usize| watched[*k].value.to_f64().abs();
    let nearest = (0..watched.len()).min_by(|a, b| size(a).total_cmp(&size(b)));
    let which = nearest.unwrap_or(0);
    let value = watched[which].value.to_f64();
    Trouble::undecided(format!(
        "whether {} is reached, {value:.2e} from it",
        name(which)
    ))
}

/// What a watched value is.
pub(crate) fn name(which: usize) -> &'static str {
    match which {
        0 => "the length of cable 1",
        1 => "the length of cable 2",
        _ => "the upper bound",
    }
}

/// What is watched on ± `slack`, in which the flight begins: the cable that was struck opens there,
/// so that its gap is below zero from the instant of the impact to the end of the slack; all else is
/// below zero.
fn beginning(
    flight: &Flight<'_>,
    slack: Radius,
    struck: Option<usize>,
) -> Result<Vec<Watched>, Trouble> {
    let first = flight.watched(&Ball::within(slack));
    for (which, watched) in first.iter().enumerate() {
        let (holds, what) = if struck == Some(which) {
            (watched.rate.is_negative(), "leaves")
        } else {
            (watched.value.is_negative(), "is clear")
        };
        if !holds {
            let what = format!("whether {} {what} after the impact", name(which));
            return Err(Trouble::undecided(what));
        }
    }
    Ok(first)
}

/// How long the flight may last: a guess from the parabolas through what is watched now.
fn likely_length(flight: &Flight<'_>, first: &[Watched], struck: Option<usize>) -> f64 {
    let bends = flight.bends(&Ball::zero(), Radius::ZERO);
    let mut least = 0.4;
    for (which, (watched, bend)) in first.iter().zip(bends).enumerate() {
        let (rate, bend) = (watched.rate.to_f64(), bend.to_f64());
        let value = if struck == Some(which) {
            0.0
        } else {
            watched.value.to_f64()
        };
        // value + rate t + bend t²/2 = 0, without cancellation.
        let root = (rate * rate - 2.0 * bend * value).max(0.0).sqrt();
        let t = if rate > 0.0 {
            -2.0 * value / (rate + root)
        } else {
            (root - rate) / bend
        };
        if t > 0.0 && t < least {
            least = t;
        }
    }
    1.25 * least
}

/// What is proved of the piece between two moments. `closed` is a value that is known to be at most
/// zero at the first, and not evaluated there.
fn judge(flight: &Flight<'_>, from: &Moment, to: &Moment, closed: Option<usize>) -> Piece {
    let length = &to.0 - &from.0;
    let middle = (&from.0 + &to.0).half();
    let half = length.upper().scaled(-1).plus(middle.radius());
    let bends = flight.bends(&middle.centre(), half);
    let sag = length.squared().half();
    let mut crossed = None;
    for (which, bend) in bends.iter().enumerate() {
        let (begin, end) = (&from.1[which], &to.1[which]);
        let known = closed == Some(which);
        if stays_below(begin, end, known, bend, &sag) {
            continue;
        }
        let slope = match (known, crossed) {
            (false, None) => rising(begin, end, bend, &length),
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

/// Whether a value stays below zero after the begin of a piece up to its end.
///
/// Let f̈ ≥ −K on the piece of length H, f ≤ 0 at both ends and t the time since its begin. The
/// difference of f and the chord plus K t (H − t)/2 has a second derivative that is not negative and
/// vanishes at both ends, so that f ≤ chord + K t (H − t)/2. With f < 0 at the end, f < 0 holds in
/// between, too,
///
/// - if K < 0: the chord is at most zero, and the rest below;
/// - if f < −KH²/8 at both ends and K ≥ 0, as t (H − t) ≤ H²/4;
/// - if f < −KH²/2 at one end and K ≥ 0: the chord is then below −KH²/2 times the share of the way
///   from the other end, −KHt/2 or −KH(H − t)/2, and K t (H − t)/2 is no larger in size.
///
/// `sag` is H²/2; the comparisons hold for every number of the balls.
pub(crate) fn stays_below(
    begin: &Watched,
    end: &Watched,
    known: bool,
    bend: &Ball,
    sag: &Ball,
) -> bool {
    if !end.value.is_negative() || !(known || begin.value.is_negative()) {
        return false;
    }
    if bend.is_positive() {
        return true;
    }
    let least = bend * sag;
    let beyond = |value: &Ball, share: i64| value.is_below(&least.scaled(-share));
    if known {
        return beyond(&end.value, 0);
    }
    beyond(&begin.value, 2) && beyond(&end.value, 2)
        || beyond(&begin.value, 0)
        || beyond(&end.value, 0)
}

/// The rate of a value all along a piece, if it rises there from below zero to above.
fn rising(begin: &Watched, end: &Watched, bend: &Ball, length: &Ball) -> Option<Ball> {
    if !(begin.value.is_negative() && end.value.is_positive()) {
        return None;
    }
    // [0, H], and the rate at either end with the largest change since.
    let within = length.half().widened(length.upper().scaled(-1));
    let change = bend * &within;
    [&begin.rate + &change, &end.rate - &change]
        .into_iter()
        .find(Ball::is_positive)
}
