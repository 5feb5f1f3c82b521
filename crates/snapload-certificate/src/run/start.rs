//! How a run starts: which cables are closed then, and how they leave.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::{FIRST_TOP, Model, State};
use crate::run::Run;
use crate::run::slow_row::SlowRow;
use crate::slack::flight::Flight;
use crate::slack::impact::Impact;
use crate::slack::search::{Crossing, Path, Zero, Zeros, first_crossing, name};
use crate::slack::set::Set;
use crate::taut::start::Instants;
use crate::verdict::ProofFailure;

/// A gap at the start within this distance of zero counts as closed, if it is also within this part
/// of r².
const START_TOLERANCE: [&str; 2] = ["1e-9", "1e-7"];

impl<'a> Run<'a> {
    /// All states of a box at an instant, with no cable closed.
    pub(crate) fn of_states(
        case: &'a ExactCase,
        [fine, coarse]: [&'a Model; 2],
        t: &Ball,
        states: &State,
    ) -> Self {
        Self {
            case,
            fine,
            coarse,
            t: t.clone(),
            set: Set::of_box(states),
            slack: Radius::ZERO,
            zeros: Zeros::new(),
            closing: None,
            impacts: 0,
            slow_row: SlowRow::empty(),
        }
    }

    pub(crate) fn from_start(
        case: &'a ExactCase,
        fine: &'a Model,
        coarse: &'a Model,
    ) -> Result<Self, ProofFailure> {
        let mut start = case.start().iter().map(|number| number.ball(fine.limbs));
        let start: State = std::array::from_fn(|_| start.next().unwrap_or_else(Ball::zero));
        let closed = [0, 1].map(|cable| case.starts_closed(cable));
        let [tolerance, part] = START_TOLERANCE.map(|number| {
            let number = Decimal::parse(number).map(|d| d.ball(fine.limbs));
            number.unwrap_or_else(Ball::zero)
        });
        let beyond = start[2].abs() - fine.functions.half_pi();
        if beyond.is_positive() {
            let what = "the start is beyond the rotation limit".to_owned();
            return Err(ProofFailure::Refuted(what));
        }
        if !beyond.is_negative() {
            let what = "the start: whether it is at the rotation limit";
            return Err(ProofFailure::undecided(what).at(0.0));
        }
        is_clear(fine, &start, closed, [&tolerance, &part])?;
        let mut run = Self::of_states(case, [fine, coarse], &Ball::zero(), &start);
        if run.is_at_rest() {
            return Ok(run);
        }
        for cable in (0..2).filter(|cable| closed[*cable]) {
            let speed = Impact::new(fine, cable, &start)?.v_n;
            let alone = !closed[1 - cable];
            if (&speed + &tolerance).is_negative() {
                run.zeros.push((cable, Zero::Opening));
            } else if alone && (&speed - &tolerance).is_positive() {
                run.closing = Some(cable);
            } else {
                let what = format!("how the run starts, with cable {} closed", cable + 1);
                return Err(ProofFailure::not_covered(what).at(0.0));
            }
        }
        Ok(run)
    }

    /// Whether, for all states, the flight has started by the time `tau` after T.
    pub(crate) fn is_under_way(&self, tau: &Ball) -> bool {
        Ball::bound(self.slack).is_below(tau)
    }

    /// Whether the run starts with both cables closed and with zero velocity.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.impacts == 0 && self.case.start().iter().all(Decimal::is_zero)
    }

    /// The first crossing of a flight from T, up to a time after T; none if there is none.
    ///
    /// A cable whose gap is exactly zero at the start and which closes there snaps at once: at
    /// t = 0 for the true state, and within a short time of that for each of the states that
    /// enclose the true one, whose gaps are zero only nearly.
    pub(super) fn first_crossing(
        &self,
        flight: &Flight<'_>,
        limit: &Ball,
    ) -> Result<Option<Crossing>, ProofFailure> {
        let Some(which) = self.closing else {
            let from = (Ball::within(self.slack), Ball::bound(self.slack));
            return first_crossing(flight, &from, &self.zeros, limit);
        };
        let near = Radius::power_of_two(-24 * flight.model.limbs as i64);
        let to = Ball::bound(near);
        let from = -&to;
        let [before, after] = [&from, &to].map(|tau| flight.event_value(which, tau).value);
        let slope = flight.event_value(which, &Ball::within(near)).rate;
        if !(before.is_negative() && slope.is_positive() && after.is_positive()) {
            let what = format!("whether cable {} snaps at the start", which + 1);
            return Err(ProofFailure::undecided(what));
        }
        Ok(Some(Crossing {
            which,
            from,
            to,
            slope,
        }))
    }

    /// The states at the start, with the instant.
    pub(crate) fn start(&self) -> Instants {
        let [x, y, theta, vx, vy, spin] = self.set.hull();
        Set::of_box(&[x, y, theta, vx, vy, spin, Ball::zero()])
    }
}

/// That the start is beyond no surface, and so near to none that a run may project it there:
/// `tolerance` and `part` are those of [`START_TOLERANCE`]. The gaps of `closed` cables are exactly
/// zero.
fn is_clear(
    fine: &Model,
    start: &State,
    closed: [bool; 2],
    [tolerance, part]: [&Ball; 2],
) -> Result<(), ProofFailure> {
    let part = &fine.r.squared() * part;
    let of_gap = match part.is_below(tolerance) {
        true => &part,
        false => tolerance,
    };
    for (which, event_value) in fine.event_values(start).iter().enumerate() {
        let clear = match which {
            0..FIRST_TOP if closed[which] => true,
            0..FIRST_TOP if (&event_value.value + of_gap).is_negative() => true,
            0..FIRST_TOP => {
                let speed = Impact::new(fine, which, start)?.v_n;
                let moves =
                    (&speed + tolerance).is_negative() || (&speed - tolerance).is_positive();
                moves && event_value.value.is_negative()
            }
            _ => event_value.value.is_negative(),
        };
        if clear {
            continue;
        }
        if (&event_value.value - of_gap).is_positive() {
            let what = format!("the start is beyond {}", name(which));
            return Err(ProofFailure::Refuted(what));
        }
        let what = format!(
            "the start: {} is {:.2e} away, where a run may move the state onto it by a projection \
             that the proof does not cover",
            name(which),
            event_value.value.to_f64()
        );
        return Err(ProofFailure::undecided(what).at(0.0));
    }
    Ok(())
}
