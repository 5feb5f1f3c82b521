//! The impact of a cable while the other one is taut, and which of them are taut afterwards
//! (docs/model.md, sections 5 and 6).

use crate::arithmetic::ball::Ball;
use crate::model::{Force, Model, State};
use crate::slack::impact::Impact;
use crate::slack::search::{Zero, Zeros};
use crate::taut::law::{Law, after};
use crate::verdict::ProofFailure;
use snapload::MOST_HALTED;

/// The motion after a snap while another cable is taut.
pub(crate) struct After {
    /// The law of impact, before remaining normal velocities are taken away.
    pub(crate) rebound: Vec<Law>,
    /// The laws after which the motion continues.
    pub(crate) continuing_laws: Vec<Law>,
    /// The taut cables from now on, by index from 0.
    pub(crate) taut: Vec<usize>,
    /// The cables that leave, and how.
    pub(crate) zeros: Zeros,
}

/// A cable that is struck while another one is taut and without normal velocity.
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
    ) -> Result<Self, ProofFailure> {
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

    /// The law of impact, and which cables are taut after it. `may_stick` says whether the struck
    /// cable is slower than `v_stick` or e = 0; `alternating` whether the snap is the last of a row
    /// of slow snaps of both cables.
    ///
    /// If the coupling W is positive, the impulse of the struck cable, p = (1 + e) v/w, opens the
    /// taut one: its normal velocity becomes −W p < 0. If W < 0 the impulse loads the taut cable,
    /// which keeps its zero normal velocity by an impulse of its own.
    pub(crate) fn after(&self, may_stick: bool, alternating: bool) -> Result<After, ProofFailure> {
        let all = Ball::integer(1) + &self.model.e;
        let unloads = sign(&self.coupling, "whether a snap unloads the taut cable")?;
        let rebound = if unloads {
            self.without_taut(all)
        } else {
            self.keeping_taut(all)
        };
        let both = alternating && self.leaves_slowly(unloads)?;
        let at_once = alternating && (!both || self.halts_slowly(unloads)?);
        if both && at_once {
            let halted = self.keeping_taut(Ball::integer(1));
            let carries = self.carrying(&self.velocity(&halted)?, true)?;
            return Ok(self.at_rest(rebound, halted, carries));
        }
        if unloads {
            return self.unloading(rebound, may_stick, at_once);
        }
        let halted = if may_stick {
            self.keeping_taut(Ball::integer(1))
        } else {
            rebound.clone()
        };
        let carries = self.carrying(&self.velocity(&halted)?, may_stick)?;
        Ok(self.loading(rebound, halted, carries))
    }

    /// Where both cables are closed and the body is at rest: which of them are taut, and how the
    /// others leave.
    pub(crate) fn resting(&self) -> Result<(Vec<usize>, Zeros), ProofFailure> {
        let [vx, vy, spin] = [3, 4, 5].map(|k: usize| self.state[k].clone());
        let carries = self.carrying(&[vx, vy, spin], true)?;
        Ok(self.carriers(carries))
    }

    /// The velocity after a law.
    fn velocity(&self, law: &Law) -> Result<[Ball; 3], ProofFailure> {
        let lost = || ProofFailure::undecided("the effective mass of both cables together");
        let state = after(std::slice::from_ref(law), self.model, self.state);
        let [.., vx, vy, spin] = state.ok_or_else(lost)?;
        Ok([vx, vy, spin])
    }

    /// Whether the taut cable leaves more slowly than `v_stick`: its speed is 0, or W (1 + e) v/w.
    fn leaves_slowly(&self, unloads: bool) -> Result<bool, ProofFailure> {
        let e = Ball::integer(1) + &self.model.e;
        let speed = &self.coupling * &e * &self.struck.v_n * &self.struck.inverse_w;
        let what = "whether the taut cable becomes slack more slowly than v_stick";
        Ok(!unloads || sign(&(&self.model.v_stick - &speed), what)?)
    }

    /// Whether rest of both cables takes no more from the velocity of their ends than slow snaps
    /// do, beside what rest of the struck one takes. The two ends are equally far from the centre.
    fn halts_slowly(&self, unloads: bool) -> Result<bool, ProofFailure> {
        if !unloads {
            // The taut cable is at rest after the impact, and nothing more is taken.
            return Ok(true);
        }
        let [moving, halted] = [
            self.velocity(&self.without_taut(Ball::integer(1)))?,
            self.velocity(&self.keeping_taut(Ball::integer(1)))?,
        ];
        let [x, y, spin] = [0, 1, 2].map(|k: usize| &moving[k] - &halted[k]);
        let model = self.model;
        let what = "how much rest of both cables takes from the body's velocity";
        let root = |square: Ball| square.sqrt().ok_or_else(|| ProofFailure::undecided(what));
        let arm = match model.a.is_zero() && model.b.is_zero() {
            true => Ball::zero(),
            false => root(model.a.squared() + model.b.squared())?,
        };
        let taken = root(x.squared() + y.squared())? + spin.abs() * arm;
        let most = &model.v_stick * &Ball::double(MOST_HALTED);
        sign(&(most - taken), what)
    }

    /// The case in which the impact opens the taut cable; the struck one may stick.
    fn unloading(
        &self,
        rebound: Law,
        may_stick: bool,
        at_once: bool,
    ) -> Result<After, ProofFailure> {
        let [struck, taut] = self.cables;
        let leaves = (taut, Zero::Opening);
        let sticks = may_stick && sign(&self.struck.pull(self.state, &self.force), "the tension")?;
        let halted = self.without_taut(Ball::integer(1));
        let (continuing_laws, set, zeros) = match (sticks, at_once) {
            (true, _) => (halted, vec![struck], vec![leaves]),
            (false, true) => (
                halted,
                Vec::new(),
                vec![leaves, (struck, Zero::LeavingByAcceleration)],
            ),
            (false, false) => {
                let zeros = vec![leaves, (struck, self.struck_leaves())];
                (rebound.clone(), Vec::new(), zeros)
            }
        };
        Ok(After {
            rebound: vec![rebound],
            continuing_laws: vec![continuing_laws],
            taut: set,
            zeros,
        })
    }

    fn without_taut(&self, share: Ball) -> Law {
        let [cable, _] = self.cables;
        Law::One { cable, share }
    }

    fn keeping_taut(&self, share: Ball) -> Law {
        let [struck, taut] = self.cables;
        Law::KeepingTaut {
            struck,
            taut,
            share,
        }
    }

    fn struck_leaves(&self) -> Zero {
        Zero::after_snap(&self.model.e)
    }

    /// Which of the two cables, struck and taut, carry tension at the velocity `halted`: 0 ≤ T ⟂
    /// −g̈ ≥ 0 with g̈/(2r) = b − W T, all signs strict. Where the struck cable leaves in any case,
    /// only the taut one is considered.
    fn carrying(&self, halted: &[Ball; 3], may_stick: bool) -> Result<[bool; 2], ProofFailure> {
        let (w, force) = (&self.coupling, &self.force);
        let b_taut = self.taut.load(halted, force);
        if !may_stick {
            return Ok([false, sign(&b_taut, "the tension of the taut cable")?]);
        }
        let b_struck = self.struck.load(halted, force);
        // r T of each if both carry, up to a positive factor.
        let struck = &b_struck - &(w * &b_taut * &self.taut.inverse_w);
        let taut = &b_taut - &(w * &b_struck * &self.struck.inverse_w);
        if struck.is_positive() && taut.is_positive() {
            return Ok([true, true]);
        }
        // The matrix of the problem is positive definite, so that the solution is unique.
        if b_taut.is_positive() && struck.is_negative() {
            return Ok([false, true]);
        }
        if b_struck.is_positive() && taut.is_negative() {
            return Ok([true, false]);
        }
        if b_taut.is_negative() && b_struck.is_negative() {
            return Ok([false, false]);
        }
        Err(ProofFailure::undecided(
            "which cables stay taut after a snap",
        ))
    }

    /// Both closed cables at rest; those that do not carry leave by their acceleration.
    fn at_rest(&self, rebound: Law, halted: Law, carries: [bool; 2]) -> After {
        let (taut, zeros) = self.carriers(carries);
        After {
            rebound: vec![rebound],
            continuing_laws: vec![halted],
            taut,
            zeros,
        }
    }

    /// The cables at rest that carry tension, and the others, which leave by their acceleration.
    fn carriers(&self, carries: [bool; 2]) -> (Vec<usize>, Zeros) {
        let pairs = || self.cables.into_iter().zip(carries);
        let mut taut: Vec<usize> = pairs().filter(|pair| pair.1).map(|pair| pair.0).collect();
        taut.sort_unstable();
        let others = pairs().filter(|pair| !pair.1);
        (
            taut,
            others
                .map(|pair| (pair.0, Zero::LeavingByAcceleration))
                .collect(),
        )
    }

    /// The case in which the impact loads the taut cable.
    fn loading(&self, rebound: Law, halted: Law, carries: [bool; 2]) -> After {
        let [struck, taut] = self.cables;
        let lifts = (taut, Zero::LeavingByAcceleration);
        let leaves = (struck, self.struck_leaves());
        let (continuing_laws, set, zeros) = match carries {
            [true, true] => (vec![halted], vec![0, 1], Vec::new()),
            [false, true] => (vec![rebound.clone()], vec![taut], vec![leaves]),
            [false, false] => (vec![rebound.clone()], Vec::new(), vec![lifts, leaves]),
            [true, false] => {
                // The struck cable's remaining normal velocity, −e v, is taken away, which opens
                // the other cable: its normal velocity becomes W e v/w < 0.
                let rest = Law::One {
                    cable: struck,
                    share: Ball::integer(1),
                };
                let zero = match self.struck_leaves() {
                    Zero::LeavingByAcceleration => lifts,
                    _ => (taut, Zero::Opening),
                };
                (vec![rebound.clone(), rest], vec![struck], vec![zero])
            }
        };
        After {
            rebound: vec![rebound],
            continuing_laws,
            taut: set,
            zeros,
        }
    }
}

/// Whether a ball is above zero.
fn sign(ball: &Ball, what: &str) -> Result<bool, ProofFailure> {
    match (ball.is_positive(), ball.is_negative()) {
        (true, _) => Ok(true),
        (_, true) => Ok(false),
        _ => Err(ProofFailure::undecided(what)),
    }
}
