//! The effect of impacts on a state, as terms, so that values with all digits and derivatives come
//! from the same formula (docs/model.md, section 5).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::model::{Model, State};
use crate::taut::chart::{StateJets, end};
use crate::taut::series::{Program, Term};

/// A change of velocities at one instant. Cables are by index from 0.
#[derive(Clone, Debug)]
pub(crate) enum Law {
    /// Takes `share` of the normal velocity v of a cable away: v → v − share v u/w.
    One { cable: usize, share: Ball },
    /// Does the same for a struck cable, and takes all of the normal velocity v_t of another cable
    /// away: with q the impulse of that one, w p + W q = share v, W p + w_t q = v_t,
    ///
    /// p = (share v − W v_t/w_t)/(w − W²/w_t),   q = (v_t − W p)/w_t.
    KeepingTaut {
        struck: usize,
        taut: usize,
        share: Ball,
    },
}

/// Of a cable at a state: G = (n_x, n_y, s), u = M⁻¹ G, and 1/w.
struct Normal {
    g: [Term; 3],
    u: [Term; 3],
    inverse_w: Term,
}

impl Law {
    /// Its inputs and outputs are x, y, θ and their rates.
    pub(crate) fn program(&self, model: &Model) -> Program {
        let mut p = Program::new();
        let state = [0, 1, 2, 3, 4, 5].map(|which| p.coordinate(which));
        let [x, y, theta, vx, vy, spin] = state;
        let turn = p.sin_cos(theta).into();
        let velocity = [vx, vy, spin];
        let change = match self {
            Self::One { cable, share } => {
                let normal = Normal::of(&mut p, model, *cable, [x, y], turn);
                let v = scalar(&mut p, normal.g, velocity);
                let impulse = p.multiply(v, normal.inverse_w);
                let impulse = p.scale(impulse, share.clone());
                normal.u.map(|u| p.multiply(u, impulse))
            }
            Self::KeepingTaut {
                struck,
                taut,
                share,
            } => {
                let [one, other] =
                    [*struck, *taut].map(|cable| Normal::of(&mut p, model, cable, [x, y], turn));
                let v = scalar(&mut p, one.g, velocity);
                let v = p.scale(v, share.clone());
                let v_taut = scalar(&mut p, other.g, velocity);
                let coupling = scalar(&mut p, one.u, other.g);
                let pulled = p.multiply(coupling, other.inverse_w);
                let shared = p.multiply(coupling, pulled);
                let shared = p.multiply(shared, one.inverse_w);
                let unit = p.constant(Ball::integer(1).with_limbs(model.limbs));
                let left = p.subtract(unit, shared);
                let inverse = p.reciprocal(left);
                let passed = p.multiply(pulled, v_taut);
                let net = p.subtract(v, passed);
                let net = p.multiply(net, one.inverse_w);
                let impulse = p.multiply(net, inverse);
                let lost = p.multiply(coupling, impulse);
                let other_impulse = p.subtract(v_taut, lost);
                let other_impulse = p.multiply(other_impulse, other.inverse_w);
                [0, 1, 2].map(|i: usize| {
                    let first = p.multiply(one.u[i], impulse);
                    let second = p.multiply(other.u[i], other_impulse);
                    p.add(first, second)
                })
            }
        };
        let mut outputs = vec![x, y, theta];
        for (before, change) in velocity.into_iter().zip(change) {
            outputs.push(p.subtract(before, change));
        }
        p.outputs = outputs;
        p
    }
}

/// The state after laws applied one after the other; none where a divisor may be zero.
pub(crate) fn after(laws: &[Law], model: &Model, state: &State) -> Option<State> {
    laws.iter().try_fold(state.clone(), |state, law| {
        let found = law.program(model).evaluate(&state, &model.functions)?;
        found.try_into().ok()
    })
}

/// The same for a state with its derivatives.
pub(crate) fn jets_after(laws: &[Law], model: &Model, state: StateJets) -> Option<StateJets> {
    laws.iter().try_fold(state, |state, law| {
        let few = law.program(model).map(Interval::of);
        let found = few.evaluate(&state, &model.functions)?;
        found.try_into().ok()
    })
}

impl Normal {
    fn of(p: &mut Program, model: &Model, cable: usize, at: [Term; 2], turn: [Term; 2]) -> Self {
        let [[px, py], reach] = end(p, model, cable, at, turn);
        let [nx, ny] = reach.map(|term| p.scale(term, model.inverse_r.clone()));
        let [first, second] = [p.multiply(px, ny), p.multiply(py, nx)];
        let s = p.subtract(first, second);
        let spun = p.scale(s, model.inverse_inertia.clone());
        let one = p.constant(Ball::integer(1).with_limbs(model.limbs));
        let turned = p.multiply(s, spun);
        let w = p.add(one, turned);
        Self {
            g: [nx, ny, s],
            u: [nx, ny, spun],
            inverse_w: p.reciprocal(w),
        }
    }
}

/// Σ a_i b_i.
fn scalar(p: &mut Program, a: [Term; 3], b: [Term; 3]) -> Term {
    let plane = p.dot([a[0], a[1]], [b[0], b[1]]);
    let turn = p.multiply(a[2], b[2]);
    p.add(plane, turn)
}
