//! The proof of a run, impact by impact, from nothing but its case.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::radius::Radius;
use crate::case::ExactCase;
use crate::model::{FIRST_TOP, Force, Model, State};
use crate::slack::flight::Flight;
use crate::slack::impact::Impact;
use crate::slack::search::{Crossing, first_crossing, name};
use crate::slack::set::Set;
use crate::verdict::Trouble;
use snapload::Stop;
use std::ops::ControlFlow;

/// A gap at the start within this of zero counts as closed, as a decimal.
const START_TOLERANCE: &str = "1e-9";
/// A cable that sticks below this height settles the run.
const SETTLING_HEIGHT: &str = "0.05";
/// So many slow snaps in a row may bring two cables to rest together.
const SLOW_IN_A_ROW: usize = 5;

/// An impact that exists, and comes next.
#[derive(Clone, Debug)]
pub(crate) struct ProvedImpact {
    /// By index from 0.
    pub(crate) cable: usize,
    pub(crate) t: Ball,
    pub(crate) v_n: Ball,
}

/// Why a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// A stop rule.
    Stop(Stop),
    /// A cable sticks, which is no stop: the motion goes on taut.
    Sticks,
}

impl Reason {
    /// Its name in certificates.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stop(stop) => stop.name(),
            Self::Sticks => "sticks",
        }
    }

    /// The reason of a name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let mut all = Stop::ALL.into_iter().map(Self::Stop).chain([Self::Sticks]);
        all.find(|reason| reason.name() == name)
    }
}

/// The proved end of a run.
#[derive(Clone, Debug)]
pub(crate) struct ProvedEnd {
    pub(crate) reason: Reason,
    pub(crate) t: Ball,
    pub(crate) state: State,
}

/// What a proof tells as it goes.
pub(crate) type OnImpact<'a> = dyn FnMut(&ProvedImpact) -> ControlFlow<Trouble> + 'a;

/// Proves a run with numbers of so many limbs; `on_impact` is shown every impact.
///
/// # Errors
/// What could not be decided, and when.
pub(crate) fn prove(
    case: &ExactCase,
    limbs: usize,
    on_impact: &mut OnImpact<'_>,
) -> Result<ProvedEnd, Trouble> {
    let fine = Model::new(case, limbs)?;
    let coarse = Model::new(case, limbs.div_ceil(3).max(2))?;
    let mut run = Run::begin(case, &fine, &coarse)?;
    loop {
        let t = run.t.to_f64();
        match run.fly().map_err(|trouble| trouble.at(t))? {
            Next::End(end) => return Ok(*end),
            Next::Impact(crossing) => {
                let (impact, end) = run.strike(&crossing).map_err(|trouble| trouble.at(t))?;
                if let ControlFlow::Break(trouble) = on_impact(&impact) {
                    return Err(trouble);
                }
                if let Some(end) = end {
                    return Ok(end);
                }
            }
        }
    }
}

/// A run in progress: the flight after an impact, continued to a number T next to its time.
struct Run<'a> {
    case: &'a ExactCase,
    fine: &'a Model,
    coarse: &'a Model,
    /// T.
    t: Ball,
    /// The states of the flight at T.
    set: Set<6>,
    /// The flight begins within ± this of T.
    slack: Radius,
    /// The cable that was struck.
    struck: Option<usize>,
    impacts: u64,
    /// The cables of the latest snaps, all of them slower than `v_stick` and without tension.
    slow: Vec<usize>,
}

/// What comes first along a flight.
enum Next {
    Impact(Root),
    End(Box<ProvedEnd>),
}

/// Where a watched value crosses zero.
struct Root {
    which: usize,
    /// Of the centre's flight, from T on.
    centre: Ball,
    /// Of the flights of all states.
    whole: Ball,
}

impl<'a> Run<'a> {
    fn begin(case: &'a ExactCase, fine: &'a Model, coarse: &'a Model) -> Result<Self, Trouble> {
        let mut start = case.start().iter().map(|number| number.ball(fine.limbs));
        let start: State = std::array::from_fn(|_| start.next().unwrap_or_else(Ball::zero));
        let tolerance = Decimal::parse(START_TOLERANCE).map(|d| d.ball(fine.limbs));
        let tolerance = tolerance.unwrap_or_else(Ball::zero);
        for (which, watched) in fine.watched(&start).iter().enumerate() {
            let clear = match which {
                0..FIRST_TOP => (&watched.value + &tolerance).is_negative(),
                _ => watched.value.is_negative(),
            };
            if (&watched.value - &tolerance).is_positive() {
                let what = format!("the start is past {}", name(which));
                return Err(Trouble::False(what));
            }
            if !clear {
                let what = format!(
                    "the start: {} is {:.2e} away, and what counts as there is put right by a \
                     projection that no theorem speaks of",
                    name(which),
                    watched.value.to_f64()
                );
                return Err(Trouble::undecided(what).at(0.0));
            }
        }
        if !start[2].abs().is_below(fine.functions.half_pi()) {
            return Err(
                Trouble::undecided("the start: whether it is at the rotation limit").at(0.0),
            );
        }
        Ok(Self {
            case,
            fine,
            coarse,
            t: Ball::zero(),
            set: Set::of_box(&start),
            slack: Radius::ZERO,
            struck: None,
            impacts: 0,
            slow: Vec::new(),
        })
    }

    /// The flight of all states.
    fn flight(&self, model: &'a Model) -> Flight<'a> {
        let hull = self.set.hull().map(|ball| ball.with_limbs(model.limbs));
        Flight::new(model, self.t.clone(), hull)
    }

    /// What comes first.
    fn fly(&self) -> Result<Next, Trouble> {
        let flight = self.flight(self.coarse);
        let last = self.last()?;
        let limit = number_above(&last.0);
        let found = first_crossing(&flight, self.slack, self.struck, &limit)?;
        let Some(crossing) = found else {
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
                last.1.words()
            );
            return Err(Trouble::undecided(what));
        }
        if root.which < FIRST_TOP {
            return Ok(Next::Impact(root));
        }
        let end = (root.whole, Stop::UpperBound);
        self.end_at(&end).map(Box::new).map(Next::End)
    }

    /// The end of time, or the rotation limit if that is sooner, from T on.
    fn last(&self) -> Result<(Ball, Stop), Trouble> {
        let model = self.fine;
        let time = &model.t_end - &self.t;
        let hull = self.set.hull();
        let (theta, spin) = (&hull[2], &hull[5]);
        let half_pi = model.functions.half_pi();
        let far = spin * &time;
        if (theta + &far).abs().is_below(half_pi) && theta.abs().is_below(half_pi) {
            // θ is linear: it stays below the limit to the end of time.
            return Ok((time, Stop::EndTime));
        }
        let bound = if spin.is_negative() {
            -half_pi
        } else {
            half_pi.clone()
        };
        let turned = (bound - theta).over(spin);
        let turned = turned.ok_or(Trouble::undecided("which way the body turns"))?;
        if turned.is_below(&time) {
            return Ok((turned, Stop::RotationLimit));
        }
        Err(Trouble::undecided(
            "whether the rotation limit or the end of time comes first",
        ))
    }

    /// The end of the run along a flight, at a time from T on.
    fn end_at(&self, (tau, stop): &(Ball, Stop)) -> Result<ProvedEnd, Trouble> {
        if !Ball::bound(self.slack).is_below(tau) {
            return Err(Trouble::undecided("an end and an impact at one instant"));
        }
        let (state, _) = self.flight(self.fine).at(tau);
        Ok(ProvedEnd {
            reason: Reason::Stop(*stop),
            t: &self.t + tau,
            state,
        })
    }

    /// The crossing with all digits.
    ///
    /// Within the piece every state's value crosses zero once, at t*. For a number τ of the piece
    /// t* = τ − f(τ)/ḟ(ξ), with ξ between τ and t*, so that ḟ(ξ) is within the slope of the piece,
    /// and, once t* is known to be within a ball with τ, within the slope over that.
    fn root(&self, flight: &Flight<'_>, crossing: &Crossing) -> Result<Root, Trouble> {
        let which = crossing.which;
        let tau = self.newton(flight, crossing);
        let flat = || Trouble::undecided(format!("whether {} is only touched", name(which)));
        let inside = crossing.from.is_below(&tau) && tau.is_below(&crossing.to);
        if !inside {
            return Err(flat());
        }
        let centre = Flight::new(self.fine, self.t.clone(), self.set.centre().clone());
        let f_centre = self.fine.one_watched(which, &centre.at(&tau).0).value;
        let fine = self.flight(self.fine);
        let f_whole = self.fine.one_watched(which, &fine.at(&tau).0).value;
        let first = &tau - &f_whole.over(&crossing.slope).ok_or_else(flat)?;
        let around = tau.hull(&first);
        let slope = self.coarse.one_watched(which, &flight.at(&around).0).rate;
        if !slope.is_positive() {
            return Err(flat());
        }
        Ok(Root {
            which,
            centre: &tau - &f_centre.over(&slope).ok_or_else(flat)?,
            whole: &tau - &f_whole.over(&slope).ok_or_else(flat)?,
        })
    }

    /// A number next to where the centre's flight crosses; by bisection where Newton's method leaves
    /// the piece. It has no part in the proof.
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
                let watched = model.one_watched(which, &flight.at(&at).0);
                let value = watched.value.centre();
                if value.is_negative() {
                    low = at.clone();
                } else {
                    high = at.clone();
                }
                let step = value.over(&watched.rate.centre());
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
    fn strike(&mut self, root: &Root) -> Result<(ProvedImpact, Option<ProvedEnd>), Trouble> {
        let cable = root.which;
        let (state, force) = self.flight(self.coarse).at(&root.whole);
        let impact = Impact::new(self.coarse, cable, &state)?;
        let t = &self.t + &root.whole;
        let next = self.carry(root, &state, &force, &impact)?;
        (self.set, self.t, self.slack) = next;
        self.struck = Some(cable);
        self.impacts += 1;
        let proved = ProvedImpact {
            cable,
            t: t.clone(),
            v_n: impact.v_n.clone(),
        };
        let reason = self.rules(cable, &state, &force, &impact)?;
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
        Ok((proved, end))
    }

    /// The set at a number next to the impact's time, of the flight after it.
    fn carry(
        &self,
        root: &Root,
        state: &State,
        force: &Force,
        impact: &Impact,
    ) -> Result<(Set<6>, Ball, Radius), Trouble> {
        let centre = Flight::new(self.fine, self.t.clone(), self.set.centre().clone());
        let (struck, _) = centre.at(&root.centre);
        let exact = Impact::new(self.fine, root.which, &struck)?;
        let share = Ball::integer(1) + &self.fine.e;
        let [vx, vy, spin] = exact.velocity(&struck, &share);
        let t = &self.t + &root.centre;
        let next = t.centre();
        let shift = &next - &t;
        // From the impact to T along the flight: q + v δ + a δ²/2 with some force of the flight.
        let any = |size: &Ball| Ball::within(size.upper());
        let push = [
            any(&self.fine.f_o),
            any(&(&self.fine.nu * &self.fine.f_o)) - Ball::integer(1),
        ];
        let [x, y, theta, ..] = struck;
        let moved = |q: Ball, v: &Ball, a: &Ball| q + v * &shift + (a * &shift.squared()).half();
        let image = [
            moved(x, &vx, &push[0]),
            moved(y, &vy, &push[1]),
            theta + &spin * &shift,
            vx + &push[0] * &shift,
            vy + &push[1] * &shift,
            spin,
        ];
        let slack = (&self.t + &root.whole - &next).upper();
        let after = Ball::within(slack);
        let before = root.whole.with_limbs(self.coarse.limbs);
        let jacobian = impact.jacobian(self.coarse, state, force, &before, &after)?;
        Ok((self.set.mapped(&image, &jacobian)?, next, slack))
    }

    /// What the rules make of an impact (docs/model.md, sections 6 and 7).
    fn rules(
        &mut self,
        cable: usize,
        state: &State,
        force: &Force,
        impact: &Impact,
    ) -> Result<Option<Reason>, Trouble> {
        let nth = self.impacts;
        let sign = |ball: &Ball, what: &str| match (ball.is_negative(), ball.is_positive()) {
            (true, _) => Ok(false),
            (_, true) => Ok(true),
            _ => Err(Trouble::undecided(format!(
                "{what} at impact {nth}, {:.2e} with a radius of {:.2e}",
                ball.to_f64(),
                ball.radius().to_f64()
            ))),
        };
        let fast = sign(&(&impact.v_n - &self.coarse.v_stick), "v_n against v_stick")?;
        if fast {
            self.slow.clear();
        } else {
            self.slow.push(cable);
        }
        let mut reason = None;
        if !fast || self.case.number("e").is_zero() {
            if sign(&impact.pull(state, force), "the tension")? {
                let height = Decimal::parse(SETTLING_HEIGHT).map(|d| d.ball(self.coarse.limbs));
                let above = &state[1] - &height.unwrap_or_else(Ball::zero);
                let high = sign(&above, "the height over that of settling")?;
                reason = Some(match high {
                    false if self.case.stop_when_settled => Reason::Stop(Stop::Settled),
                    true if self.case.stop_when_sliding => Reason::Stop(Stop::SlidingStart),
                    _ => Reason::Sticks,
                });
            } else if self.slow.len() >= SLOW_IN_A_ROW && self.slow.iter().any(|c| *c != cable) {
                return Err(Trouble::undecided(format!(
                    "whether two cables that snap slowly in turn come to rest at impact {nth}"
                )));
            }
        }
        if self.impacts > self.case.max_impacts && matches!(reason, None | Some(Reason::Sticks)) {
            reason = Some(Reason::Stop(Stop::ImpactLimit));
        }
        Ok(reason)
    }
}

/// A number a little above all of a ball.
fn number_above(ball: &Ball) -> Ball {
    let beyond = ball.radius().scaled(1).plus(ball.upper().scaled(-40));
    (&ball.centre() + &Ball::bound(beyond)).centre()
}
