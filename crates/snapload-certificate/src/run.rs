//! Slack flight from impact to impact, for a set of states that contains the true one.

mod slow_row;
mod start;

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::{FIRST_TOP, Force, Model, State};
use crate::proved::{ProvedEnd, ProvedImpact, Reason};
use crate::slack::flight::Flight;
use crate::slack::impact::{Impact, Matrix};
use crate::slack::search::{Crossing, Zero, Zeros, name};
use crate::slack::set::Set;
use crate::taut::free::Free;
use crate::taut::law::Law;
use crate::taut::start::{Instants, Started, start_motion};
use crate::taut::step::Equations;
use crate::verdict::ProofFailure;
use slow_row::SlowRow;
use snapload::Stop;

/// A cable that sticks below this height settles the run.
const SETTLING_HEIGHT: &str = "0.05";

/// A run in progress: the flight after an impact, continued to a number T next to the impact's
/// time.
pub(crate) struct Run<'a> {
    pub(crate) case: &'a ExactCase,
    pub(crate) fine: &'a Model,
    coarse: &'a Model,
    /// T.
    pub(crate) t: Ball,
    /// The states of the flight at T.
    set: Set<6>,
    /// The flight begins at some time within T ± this.
    slack: Radius,
    /// The cables that are closed where it begins, and leave.
    zeros: Zeros,
    /// The cable that is closed at the start and closes, so that it snaps at once.
    closing: Option<usize>,
    pub(crate) impacts: u64,
    pub(crate) slow_row: SlowRow,
}

/// A cable that sticks, and the states at that instant, just before the impact.
pub(crate) struct Stick {
    pub(crate) cable: usize,
    pub(crate) instants: Instants,
}

/// The result of an impact.
pub(crate) struct Struck {
    pub(crate) impact: ProvedImpact,
    /// The end of the run, if it ends at this impact or with the cable that sticks here.
    pub(crate) end: Option<ProvedEnd>,
    /// A cable that sticks where no rule stops the run.
    pub(crate) stick: Option<Stick>,
    /// The Jacobian of the state after the impact, at the new T, by the state before it, at the old
    /// T.
    pub(crate) jacobian: Matrix,
}

/// The first event along a flight.
pub(crate) enum Next {
    Impact(Root),
    End(Box<ProvedEnd>),
}

/// Where an event function crosses zero.
pub(crate) struct Root {
    pub(crate) which: usize,
    /// The time, since T, at which the centre's flight crosses.
    centre: Ball,
    /// An enclosure of the times, since T, at which the flights of all states cross.
    pub(crate) whole: Ball,
}

impl<'a> Run<'a> {
    /// The flight that starts from the enclosure of all states.
    pub(crate) fn flight(&self, model: &'a Model) -> Flight<'a> {
        let hull = self.set.hull().map(|ball| ball.with_limbs(model.limbs));
        Flight::new(model, self.t.clone(), hull)
    }

    /// Finds the first event.
    pub(crate) fn next_event(&self) -> Result<Next, ProofFailure> {
        let flight = self.flight(self.coarse);
        let last = self.last()?;
        let limit = number_above(&last.0);
        let Some(crossing) = self.first_crossing(&flight, &limit)? else {
            return self.end_at(&last).map(Box::new).map(Next::End);
        };
        let root = self.root(&flight, &crossing)?;
        if last.0.is_below(&root.whole) {
            return self.end_at(&last).map(Box::new).map(Next::End);
        }
        if !root.whole.is_below(&last.0) {
            let what = format!(
                "whether {} or {} comes first",
                name(root.which),
                last.1.label()
            );
            return Err(ProofFailure::undecided(what));
        }
        if root.which < FIRST_TOP {
            return Ok(Next::Impact(root));
        }
        let end = (root.whole, Stop::UpperBound);
        self.end_at(&end).map(Box::new).map(Next::End)
    }

    /// The time from T to the end of time, or to the rotation limit if that is sooner.
    fn last(&self) -> Result<(Ball, Stop), ProofFailure> {
        let model = self.fine;
        let time = &model.t_end - &self.t;
        let hull = self.set.hull();
        let (theta, spin) = (&hull[2], &hull[5]);
        let half_pi = model.functions.half_pi();
        let far = spin * &time;
        if (theta + &far).abs().is_below(half_pi) && theta.abs().is_below(half_pi) {
            // θ is linear in time and below the limit at both ends, so that it is below in between.
            return Ok((time, Stop::EndTime));
        }
        let bound = if spin.is_negative() {
            -half_pi
        } else {
            half_pi.clone()
        };
        let turned = (bound - theta).over(spin);
        let turned = turned.ok_or(ProofFailure::undecided("which way the body turns"))?;
        if turned.is_below(&time) {
            return Ok((turned, Stop::RotationLimit));
        }
        Err(ProofFailure::undecided(
            "whether the rotation limit or the end of time comes first",
        ))
    }

    /// The end of the run along a flight, at a time since T.
    fn end_at(&self, (tau, stop): &(Ball, Stop)) -> Result<ProvedEnd, ProofFailure> {
        if !self.is_under_way(tau) {
            return Err(ProofFailure::undecided(
                "an end and an impact at one instant",
            ));
        }
        let (state, _) = self.flight(self.fine).at(tau);
        Ok(ProvedEnd {
            reason: Reason::Stop(*stop),
            t: &self.t + tau,
            state,
        })
    }

    /// The time of the crossing with all digits.
    ///
    /// Within the piece every state's value crosses zero once, at t*. For a number τ of the piece
    /// t* = τ − f(τ)/ḟ(ξ), with ξ between τ and t*, so that ḟ(ξ) is within the slope of the piece;
    /// once a ball is known that contains τ and t*, ḟ(ξ) is within the slope over that ball.
    fn root(&self, flight: &Flight<'_>, crossing: &Crossing) -> Result<Root, ProofFailure> {
        let which = crossing.which;
        let tau = self.newton(flight, crossing);
        let flat = || {
            ProofFailure::undecided(format!(
                "whether {} is crossed or only touched",
                name(which)
            ))
        };
        let inside = crossing.from.is_below(&tau) && tau.is_below(&crossing.to);
        if !inside {
            return Err(flat());
        }
        let centre = Flight::new(self.fine, self.t.clone(), self.set.centre().clone());
        let f_centre = self.fine.event_value(which, &centre.at(&tau).0).value;
        let fine = self.flight(self.fine);
        let f_whole = self.fine.event_value(which, &fine.at(&tau).0).value;
        let first = &tau - &f_whole.over(&crossing.slope).ok_or_else(flat)?;
        let around = tau.hull(&first);
        let slope = self.coarse.event_value(which, &flight.at(&around).0).rate;
        if !slope.is_positive() {
            return Err(flat());
        }
        Ok(Root {
            which,
            centre: &tau - &f_centre.over(&slope).ok_or_else(flat)?,
            whole: &tau - &f_whole.over(&slope).ok_or_else(flat)?,
        })
    }

    /// A number next to the crossing of the centre's flight; by bisection where Newton's method
    /// leaves the piece. The proof does not depend on its accuracy.
    fn newton(&self, flight: &Flight<'_>, crossing: &Crossing) -> Ball {
        let which = crossing.which;
        let (mut low, mut high) = (crossing.from.clone(), crossing.to.clone());
        let mut tau = (&low + &high).half().centre();
        for (flight, most) in [
            (flight, 20),
            (
                &Flight::new(self.fine, self.t.clone(), self.set.centre().clone()),
                12,
            ),
        ] {
            let model = flight.model;
            let close = Radius::power_of_two(10 - 64 * model.limbs as i64);
            for _ in 0..most {
                let at = tau.with_limbs(model.limbs);
                let event_value = model.event_value(which, &flight.at(&at).0);
                let value = event_value.value.centre();
                if value.is_negative() {
                    low = at.clone();
                } else {
                    high = at.clone();
                }
                let step = value.over(&event_value.rate.centre());
                let next = step.map(|step| (&at - &step).centre());
                let next = next.filter(|next| !(next.is_below(&low) || high.is_below(next)));
                tau = next.unwrap_or_else(|| (&low + &high).half().centre());
                if (&tau - &at).upper() <= close {
                    break;
                }
            }
        }
        tau.with_limbs(self.fine.limbs).centre()
    }

    /// The impact at a root, and the end of the run if it ends there.
    pub(crate) fn apply_impact(&mut self, root: &Root) -> Result<Struck, ProofFailure> {
        let cable = root.which;
        let (state, force) = self.flight(self.coarse).at(&root.whole);
        let impact = Impact::new(self.coarse, cable, &state)?;
        let t = &self.t + &root.whole;
        let (next, jacobian) = self.carry(root, &state, &force, &impact)?;
        self.impacts += 1;
        let reason = self.rules((cable, &t), &state, &force, &impact)?;
        let stick = match reason {
            Some(Reason::Sticks) => Some(Stick {
                cable,
                instants: self.instants(root, &impact)?,
            }),
            _ => None,
        };
        (self.set, self.t, self.slack) = next;
        self.zeros = vec![(cable, Zero::after_snap(&self.fine.e))];
        self.closing = None;
        let proved = ProvedImpact {
            cable,
            t: t.clone(),
            v_n: impact.v_n.clone(),
        };
        let end = reason.map(|reason| {
            let share = Ball::integer(1) + &self.coarse.e;
            let [vx, vy, spin] = impact.velocity(&state, &share);
            let [x, y, theta, ..] = state;
            ProvedEnd {
                reason,
                t,
                state: [x, y, theta, vx, vy, spin],
            }
        });
        Ok(Struck {
            impact: proved,
            end,
            stick,
            jacobian,
        })
    }

    /// The states at an impact, each at its own instant: at a fixed time τ, δq(τ) = δq + τ δv; the
    /// instant moves by δt = −G·δq(τ)/v_n, and the state by its rate times δt.
    fn instants(&self, root: &Root, impact: &Impact) -> Result<Instants, ProofFailure> {
        let centre = Flight::new(self.fine, self.t.clone(), self.set.centre().clone());
        let (struck, _) = centre.at(&root.centre);
        let [x, y, theta, vx, vy, spin] = struck;
        let image = [x, y, theta, vx, vy, spin, &self.t + &root.centre];
        let (state, force) = self.flight(self.coarse).at(&root.whole);
        let none = || ProofFailure::undecided("whether the cable closes");
        let inverse = impact.v_n.reciprocal().ok_or_else(none)?;
        let tau = root.whole.with_limbs(self.coarse.limbs);
        let [_, _, _, vx, vy, spin] = state;
        let rates = [vx, vy, spin, force.x, force.y, Ball::zero()];
        let instant: [Ball; 6] = std::array::from_fn(|j| {
            let along = -(&impact.g[j % 3] * &inverse);
            if j < 3 { along } else { along * &tau }
        });
        let jacobian = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let Some(rate) = rates.get(i) else {
                    return instant[j].clone();
                };
                let moved = rate * &instant[j];
                match (i == j, i + 3 == j) {
                    (true, _) => moved + Ball::integer(1),
                    (_, true) => moved + &tau,
                    _ => moved,
                }
            })
        });
        self.set.mapped(&image, &jacobian)
    }

    /// Continues with the flight from where all cables have become slack; `zeros` are closed then.
    pub(crate) fn continue_slack(
        &mut self,
        instants: &Instants,
        laws: &[Law],
        zeros: Zeros,
    ) -> Result<(), ProofFailure> {
        let equations = Equations::of(&Free, self.fine);
        let Started { t, set, slack } = start_motion(&equations, &Free, laws, instants)?;
        (self.t, self.set, self.slack, self.zeros) = (t, set, slack, zeros);
        Ok(())
    }

    /// The state after a short time δ along its flight: q + v δ + a δ²/2, with a an enclosure of
    /// the force.
    fn shifted(&self, state: State, shift: &Ball) -> State {
        let any = |size: &Ball| Ball::within(size.upper());
        let push = [
            any(&self.fine.f_o),
            any(&(&self.fine.nu * &self.fine.f_o)) - Ball::integer(1),
        ];
        let [x, y, theta, vx, vy, spin] = state;
        let moved = |q: Ball, v: &Ball, a: &Ball| q + v * shift + (a * &shift.squared()).half();
        [
            moved(x, &vx, &push[0]),
            moved(y, &vy, &push[1]),
            theta + &spin * shift,
            vx + &push[0] * shift,
            vy + &push[1] * shift,
            spin,
        ]
    }

    /// The set of states of the flight after the impact, at a number next to the impact's time, and
    /// the Jacobian of the map to there.
    fn carry(
        &self,
        root: &Root,
        state: &State,
        force: &Force,
        impact: &Impact,
    ) -> Result<((Set<6>, Ball, Radius), Matrix), ProofFailure> {
        let centre = Flight::new(self.fine, self.t.clone(), self.set.centre().clone());
        let (struck, _) = centre.at(&root.centre);
        let exact = Impact::new(self.fine, root.which, &struck)?;
        let share = Ball::integer(1) + &self.fine.e;
        let [vx, vy, spin] = exact.velocity(&struck, &share);
        let t = &self.t + &root.centre;
        let next = t.centre();
        let shift = &next - &t;
        let [x, y, theta, ..] = struck;
        let image = self.shifted([x, y, theta, vx, vy, spin], &shift);
        let slack = (&self.t + &root.whole - &next).upper();
        let after = Ball::within(slack);
        let before = root.whole.with_limbs(self.coarse.limbs);
        let jacobian = impact.jacobian(self.coarse, state, force, &before, &after)?;
        Ok(((self.set.mapped(&image, &jacobian)?, next, slack), jacobian))
    }

    /// The reason for which an impact ends the flight, if any (docs/model.md, sections 6 and 7).
    fn rules(
        &mut self,
        (cable, t): (usize, &Ball),
        state: &State,
        force: &Force,
        impact: &Impact,
    ) -> Result<Option<Reason>, ProofFailure> {
        let slow = self.is_slow(&impact.v_n, cable, t)?;
        let sticks = (slow || self.case.number("e").is_zero())
            && self.sign(&impact.pull(state, force), "the tension")?;
        if !sticks && self.slow_row.alternates() {
            // The model takes the remaining normal velocity away although the cable has no tension,
            // which is not proved here.
            return Err(ProofFailure::not_covered(format!(
                "how the cable becomes slack after slow snaps of both cables in turn, at impact {}",
                self.impacts
            )));
        }
        let stop = self.stop_at_impact(&state[1], sticks, usize::from(sticks))?;
        let stop = stop.map(Reason::Stop);
        Ok(stop.or(sticks.then_some(Reason::Sticks)))
    }

    /// Whether a ball is positive; an undecided sign is reported for the latest impact.
    fn sign(&self, ball: &Ball, what: &str) -> Result<bool, ProofFailure> {
        match (ball.is_negative(), ball.is_positive()) {
            (true, _) => Ok(false),
            (_, true) => Ok(true),
            _ => Err(ProofFailure::undecided(format!(
                "the sign of {what} at impact {}, {:.2e} with an error bound of {:.2e}",
                self.impacts,
                ball.to_f64(),
                ball.radius().to_f64()
            ))),
        }
    }

    /// Whether a snap is slower than `v_stick`; it then extends the row of slow snaps, and else
    /// ends it.
    pub(crate) fn is_slow(
        &mut self,
        v_n: &Ball,
        cable: usize,
        t: &Ball,
    ) -> Result<bool, ProofFailure> {
        let fast = self.sign(&(v_n - &self.coarse.v_stick), "v_n - v_stick")?;
        if fast {
            self.slow_row.end();
        } else {
            self.slow_row.add(cable, t, self.case, self.coarse)?;
        }
        Ok(!fast)
    }

    /// The stop rules that apply at impacts, at the height `y`, with `taut` cables taut from now
    /// on.
    pub(crate) fn stop_at_impact(
        &self,
        y: &Ball,
        sticks: bool,
        taut: usize,
    ) -> Result<Option<Stop>, ProofFailure> {
        if (sticks || taut >= 2) && (self.case.stop_when_settled || self.case.stop_when_sliding) {
            let height = Decimal::parse(SETTLING_HEIGHT).map(|d| d.ball(self.coarse.limbs));
            let above = y - &height.unwrap_or_else(Ball::zero);
            let high = self.sign(&above, "the height above that of settling")?;
            if !high && self.case.stop_when_settled {
                return Ok(Some(Stop::Settled));
            }
            if high && sticks && self.case.stop_when_sliding {
                return Ok(Some(Stop::SlidingStart));
            }
        }
        let over = self.impacts > self.case.max_impacts;
        Ok(over.then_some(Stop::ImpactLimit))
    }
}

/// A number a little above all numbers of a ball.
fn number_above(ball: &Ball) -> Ball {
    let beyond = ball.radius().scaled(1).plus(ball.upper().scaled(-40));
    (&ball.centre() + &Ball::bound(beyond)).centre()
}
