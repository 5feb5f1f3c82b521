//! The model of a case in balls: cables, gaps, tops and the force (docs/model.md, sections 2, 3).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::arithmetic::elementary::Elementary;
use crate::case::ExactCase;
use crate::verdict::ProofFailure;

/// x, y, θ and their velocities.
pub(crate) type State = [Ball; 6];

/// The force at an instant: f_x, f_y − 1, and the sine and cosine of its phase Ωt.
#[derive(Clone, Debug)]
pub(crate) struct Force {
    pub(crate) x: Ball,
    pub(crate) y: Ball,
    pub(crate) sine: Ball,
    pub(crate) cosine: Ball,
}

/// The sine and cosine of a rotation.
pub(crate) type Turn = (Ball, Ball);

/// The end of a cable at the body.
#[derive(Clone, Debug)]
pub(crate) struct CableEnd {
    /// D = P − A.
    pub(crate) reach: [Ball; 2],
    /// ρ = P − (x, y).
    pub(crate) arm: [Ball; 2],
    /// Ṗ.
    pub(crate) velocity: [Ball; 2],
}

/// A value that has to stay below zero, and its rate.
#[derive(Clone, Debug)]
pub(crate) struct EventValue {
    pub(crate) value: Ball,
    pub(crate) rate: Ball,
}

/// The index of the first top in the list of event functions, after the two gaps.
pub(crate) const FIRST_TOP: usize = 2;

/// The numbers of a case at one precision.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) limbs: usize,
    pub(crate) functions: Elementary,
    pub(crate) r: Ball,
    pub(crate) e: Ball,
    pub(crate) a: Ball,
    pub(crate) b: Ball,
    pub(crate) f_o: Ball,
    pub(crate) nu: Ball,
    pub(crate) omega: Ball,
    /// f_o/Ω; zero for a steady force.
    pub(crate) f_over_omega: Ball,
    pub(crate) inverse_omega: Ball,
    /// The force does not change: f_o = 0 or Ω = 0.
    pub(crate) is_steady: bool,
    /// 1/I; zero for a point mass.
    pub(crate) inverse_inertia: Ball,
    pub(crate) inverse_r: Ball,
    /// The anchors' level h + b, h = √(r² − (1 − a)²).
    pub(crate) level: Ball,
    pub(crate) v_stick: Ball,
    pub(crate) t_end: Ball,
    /// Whether the highest point is a corner, which is one of the cables' ends; otherwise it is at
    /// y plus the next field.
    has_corners: bool,
}

impl Model {
    /// The numbers of a case with `limbs` limbs.
    pub(crate) fn new(case: &ExactCase, limbs: usize) -> Result<Self, ProofFailure> {
        let number = |key: &str| case.number(key).ball(limbs);
        let (r, a) = (case.number("r"), case.number("a"));
        let width = Decimal::integer(1).minus(&a);
        let square = r.times(&r).minus(&width.times(&width));
        let invert = |ball: &Ball| {
            ball.reciprocal()
                .ok_or(ProofFailure::undecided("a division"))
        };
        let height = square.ball(limbs).sqrt();
        let height = height.ok_or(ProofFailure::undecided("the anchors' level"))?;
        let is_steady = case.number("f_o").is_zero() || case.number("omega").is_zero();
        let f_o = number("f_o");
        let inverse_omega = if is_steady {
            Ball::zero()
        } else {
            invert(&number("omega"))?
        };
        let inverse_inertia = match case.inertia_times_three() {
            Some(inertia) => Ball::integer(3) * invert(&inertia.ball(limbs))?,
            None => Ball::zero(),
        };
        Ok(Self {
            limbs,
            functions: Elementary::new(limbs),
            inverse_r: invert(&number("r"))?,
            r: number("r"),
            e: number("e"),
            a: number("a"),
            b: number("b"),
            f_over_omega: &f_o * &inverse_omega,
            f_o,
            nu: number("nu"),
            omega: number("omega"),
            inverse_omega,
            is_steady,
            inverse_inertia,
            level: height + number("b"),
            v_stick: number("v_stick"),
            t_end: number("t_end"),
            has_corners: !case.number("b").is_zero(),
        })
    }

    /// f_x = f_o cos Ωt, f_y = ν f_o sin Ωt, and the weight 1.
    pub(crate) fn force(&self, t: &Ball) -> Force {
        if self.is_steady {
            // The phase is not needed: Ωt is zero, or f_o is.
            return Force {
                x: self.f_o.clone(),
                y: Ball::integer(-1),
                sine: Ball::zero(),
                cosine: Ball::integer(1),
            };
        }
        let (sine, cosine) = self.functions.sin_cos(&(&self.omega * t));
        Force {
            x: &self.f_o * &cosine,
            y: &self.nu * &self.f_o * &sine - Ball::integer(1),
            sine,
            cosine,
        }
    }

    pub(crate) fn turn(&self, theta: &Ball) -> Turn {
        self.functions.sin_cos(theta)
    }

    /// The end of cable 0 (right, anchor (1, level), at (a, b) of the body) or 1 (left, mirrored).
    pub(crate) fn end(&self, cable: usize, state: &State, (sine, cosine): &Turn) -> CableEnd {
        let [x, y, _, vx, vy, spin] = state;
        let (a, anchor) = if cable == 0 {
            (self.a.clone(), Ball::integer(1))
        } else {
            (-&self.a, Ball::integer(-1))
        };
        let arm = [&a * cosine - &self.b * sine, &a * sine + &self.b * cosine];
        CableEnd {
            reach: [x + &arm[0] - anchor, y + &arm[1] - &self.level],
            velocity: [vx - &(spin * &arm[1]), vy + &(spin * &arm[0])],
            arm,
        }
    }

    /// g = |D|² − r² and ġ = 2 D·Ṗ.
    pub(crate) fn gap(&self, end: &CableEnd) -> EventValue {
        let ([dx, dy], [ux, uy]) = (&end.reach, &end.velocity);
        EventValue {
            value: dx.squared() + dy.squared() - self.r.squared(),
            rate: (dx * ux + dy * uy).twice(),
        }
    }

    /// The two gaps, then the heights of the tops over the anchors' level: of both upper corners of
    /// a rectangle, of a circle's top, of a point.
    pub(crate) fn event_values(&self, state: &State) -> Vec<EventValue> {
        let turn = self.turn(&state[2]);
        let ends = [self.end(0, state, &turn), self.end(1, state, &turn)];
        let mut list = vec![self.gap(&ends[0]), self.gap(&ends[1])];
        if self.has_corners {
            list.extend(ends.map(|end| {
                let ([_, value], [_, rate]) = (end.reach, end.velocity);
                EventValue { value, rate }
            }));
        } else {
            list.push(EventValue {
                value: &state[1] + &self.a - &self.level,
                rate: state[4].clone(),
            });
        }
        list
    }

    /// One of the event functions.
    pub(crate) fn event_value(&self, which: usize, state: &State) -> EventValue {
        if which >= FIRST_TOP && !self.has_corners {
            return EventValue {
                value: &state[1] + &self.a - &self.level,
                rate: state[4].clone(),
            };
        }
        let end = self.end(which % FIRST_TOP, state, &self.turn(&state[2]));
        if which < FIRST_TOP {
            return self.gap(&end);
        }
        let ([_, value], [_, rate]) = (end.reach, end.velocity);
        EventValue { value, rate }
    }

    pub(crate) fn has_corners(&self) -> bool {
        self.has_corners
    }
}
