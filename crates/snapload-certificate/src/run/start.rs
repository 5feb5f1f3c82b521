//! How a run starts: which cables are closed then, and how they leave.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::{FIRST_TOP, Model, State};
use crate::run::Run;
use crate::run::slow_row::SlowRow;
use crate::slack::impact::Impact;
use crate::slack::search::{Zero, Zeros, name};
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
        // At x = y = θ = 0 both gaps are exactly zero for every size.
        let at_origin = case.start()[..3].iter().all(Decimal::is_zero);
        let [tolerance, part] = START_TOLERANCE.map(|number| {
            let number = Decimal::parse(number).map(|d| d.ball(fine.limbs));
            number.unwrap_or_else(Ball::zero)
        });
        is_clear(fine, &start, at_origin, [&tolerance, &part])?;
        if !start[2].abs().is_below(fine.functions.half_pi()) {
            return Err(
                ProofFailure::undecided("the start: whether it is at the rotation limit").at(0.0),
            );
        }
        let mut run = Self::of_states(case, [fine, coarse], &Ball::zero(), &start);
        if at_origin && !run.is_at_rest() {
            for cable in 0..2 {
                let speed = Impact::new(fine, cable, &start)?.v_n;
                if !(&speed + &tolerance).is_negative() {
                    let what = format!("how the run starts, with cable {} closed", cable + 1);
                    return Err(ProofFailure::not_covered(what).at(0.0));
                }
                run.zeros.push((cable, Zero::Opening));
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

    /// The states at the start, with the instant.
    pub(crate) fn start(&self) -> Instants {
        let [x, y, theta, vx, vy, spin] = self.set.hull();
        Set::of_box(&[x, y, theta, vx, vy, spin, Ball::zero()])
    }
}

/// That the start is beyond no surface, and so near to none that a run may project it there:
/// `tolerance` and `part` are those of [`START_TOLERANCE`].
fn is_clear(
    fine: &Model,
    start: &State,
    at_origin: bool,
    [tolerance, part]: [&Ball; 2],
) -> Result<(), ProofFailure> {
    let part = &fine.r.squared() * part;
    let of_gap = match part.is_below(tolerance) {
        true => &part,
        false => tolerance,
    };
    for (which, event_value) in fine.event_values(start).iter().enumerate() {
        let clear = match which {
            0..FIRST_TOP if at_origin => true,
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
