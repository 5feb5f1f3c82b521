//! The impact of a cable while the other one is taut, and which of them are taut afterwards
//! (docs/model.md, sections 5 and 6).

use crate::arithmetic::ball::Ball;
use crate::model::{Force, Model, State};
use crate::slack::impact::Impact;
use crate::slack::search::{Zero, Zeros};
use crate::taut::law::{Law, after};
use crate::verdict::Trouble;

/// What a snap beside a taut cable makes of the motion.
pub(crate) struct After {
    /// The law of impact, before any rest is taken away.
    pub(crate) rebound: Vec<Law>,
    /// The laws with which the motion goes on.
    pub(crate) goes_on: Vec<Law>,
    /// The taut cables from now on, by index from 0.
    pub(crate) taut: Vec<usize>,
    /// The cables that leave, and how.
    pub(crate) zeros: Zeros,
}

/// A cable that is struck, and one that is taut, without normal velocity, at the same instant.
pub(crate) struct Pair<'a> {
    model: &'a Model,
    state: &'a State,
    force: Force,
    /// By index from 0: the one that is struck, and the taut one.
    cables: [usize; 2],
    pub(crate) struck: Impact,
    taut: Impact,
    /// W of the two.
    coupling: Ball,
}

impl<'a> Pair<'a> {
    pub(crate) fn new(
        model: &'a Model,
        state: &'a State,
        t: &Ball,
        [struck, taut]: [usize; 2],
    ) -> Result<Self, Trouble> {
        let cables = [struck, taut];
        let [struck, taut] = [
            Impact::new(model, struck, state)?,
            Impact::new(model, taut, state)?,
        ];
        Ok(Self {
            model,
            state,
            force: model.force(t),
            cables,
            coupling: struck.coupling(&taut),
            struck,
            taut,
        })
    }

    /// The law of impact, and of what it leaves the taut set. `may_stick` is whether the struck cable
    /// is slower than `v_stick` or does not bounce.
    ///
    /// With W > 0 between them the impulse of the struck cable, (1 + e) v/w, opens the taut one:
    /// its normal velocity becomes −W p < 0. With W < 0 it pulls on the taut one, which stays
    /// without normal velocity by an impulse of its own.
    pub(crate) fn after(&self, may_stick: bool) -> Result<After, Trouble> {
        let all = Ball::integer(1) + &self.model.e;
        let [struck, taut] = self.cables;
        if sign(&self.coupling, "whether a snap unloads the taut cable")? {
            let one = |share: Ball| {
                vec![Law::One {
                    cable: struck,
                    share,
                }]
            };
            let leaves = (taut, Zero::Opening);
            let sticks =
                may_stick && sign(&self.struck.pull(self.state, &self.force), "the tension")?;
            return Ok(if sticks {
                After {
                    rebound: one(all),
                    goes_on: one(Ball::integer(1)),
                    taut: vec![struck],
                    zeros: vec![leaves],
                }
            } else {
                After {
                    rebound: one(all.clone()),
                    goes_on: one(all),
                    taut: Vec::new(),
                    zeros: vec![leaves, (struck, self.struck_leaves())],
                }
            });
        }
        let rebound = self.beside(all);
        let halted = if may_stick {
            self.beside(Ball::integer(1))
        } else {
            rebound.clone()
        };
        let lost = || Trouble::undecided("two cables of one effective mass");
        let [.., vx, vy, spin] =
            after(std::slice::from_ref(&halted), self.model, self.state).ok_or_else(lost)?;
        let carries = self.carrying(&[vx, vy, spin], may_stick)?;
        Ok(self.with(rebound, halted, carries))
    }

    fn beside(&self, share: Ball) -> Law {
        let [struck, taut] = self.cables;
        Law::Beside {
            struck,
            taut,
            share,
        }
    }

    /// How the struck cable leaves where it does not stick: at −e v, or with e = 0 by its acceleration.
    fn struck_leaves(&self) -> Zero {
        if self.model.e.is_zero() {
            Zero::Lifting
        } else {
            Zero::Opening
        }
    }

    /// Which carry tension, the struck one and the taut one, at the velocity `halted`, with W < 0:
    /// 0 ≤ T ⟂ −g̈ ≥ 0 with g̈/(2r) = b − W T, all signs strict. Where the struck one leaves anyway, the
    /// taut one alone is asked.
    fn carrying(&self, halted: &[Ball; 3], may_stick: bool) -> Result<[bool; 2], Trouble> {
        let (w, force) = (&self.coupling, &self.force);
        let b_taut = self.taut.load(halted, force);
        if !may_stick {
            return Ok([false, sign(&b_taut, "the tension of the taut cable")?]);
        }
        let b_struck = self.struck.load(halted, force);
        // r T of each if both carry, but for a factor above zero.
        let struck = &b_struck - &(w * &b_taut * &self.taut.inverse_w);
        let taut = &b_taut - &(w * &b_struck * &self.struck.inverse_w);
        if struck.is_positive() && taut.is_positive() {
            return Ok([true, true]);
        }
        // As W < 0, a cable that carries alone with the other's acceleration below zero leaves no
        // other solution.
        if b_taut.is_positive() && struck.is_negative() {
            return Ok([false, true]);
        }
        if b_struck.is_positive() && taut.is_negative() {
            return Ok([true, false]);
        }
        if b_taut.is_negative() && b_struck.is_negative() {
            return Ok([false, false]);
        }
        Err(Trouble::undecided("which cables stay taut after a snap"))
    }

    fn with(&self, rebound: Law, halted: Law, carries: [bool; 2]) -> After {
        let [struck, taut] = self.cables;
        let lifts = (taut, Zero::Lifting);
        let leaves = (struck, self.struck_leaves());
        let (goes_on, set, zeros) = match carries {
            [true, true] => (vec![halted], vec![0, 1], Vec::new()),
            [false, true] => (vec![rebound.clone()], vec![taut], vec![leaves]),
            [false, false] => (vec![rebound.clone()], Vec::new(), vec![lifts, leaves]),
            [true, false] => {
                // What is left of the struck cable's normal velocity, −e v, is taken away, which opens
                // the other: its normal velocity becomes W e v/w < 0.
                let rest = Law::One {
                    cable: struck,
                    share: Ball::integer(1),
                };
                let zero = match self.struck_leaves() {
                    Zero::Lifting => lifts,
                    _ => (taut, Zero::Opening),
                };
                (vec![rebound.clone(), rest], vec![struck], vec![zero])
            }
        };
        After {
            rebound: vec![rebound],
            goes_on,
            taut: set,
            zeros,
        }
    }
}

/// Whether a ball is above zero.
fn sign(ball: &Ball, what: &str) -> Result<bool, Trouble> {
    match (ball.is_positive(), ball.is_negative()) {
        (true, _) => Ok(true),
        (_, true) => Ok(false),
        _ => Err(Trouble::undecided(what)),
    }
}
