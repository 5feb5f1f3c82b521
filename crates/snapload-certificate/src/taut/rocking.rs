//! Motion with both cables taut, of one degree of freedom: the rotation θ (docs/model.md, section
//! 6).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::model::{Model, State};
use crate::taut::chart::{Chart, EventFunction, StateJets, Terms, force};
use crate::taut::series::{Program, Term};
use crate::verdict::ProofFailure;

/// Both cables taut. The coordinates are θ and θ̇.
///
/// Let m be the place of the middle between both fairleads, seen from the middle between both
/// anchors, and d = (a cos θ − 1, a sin θ). Then P₁ − A₁ = m + d and P₂ − A₂ = m − d, and both have
/// the length r exactly if m·d = 0 and |m|² = r² − |d|². With D = |d|² = 1 + a² − 2 a cos θ > 0 and
/// D < r² these are the two points m = ± S d⟂, S = √(r²/D − 1) > 0, d⟂ = (−a sin θ, a cos θ − 1). A
/// motion keeps its sign, as S is never zero.
///
/// Where D = 0, for a = 1 and θ = 0, d⟂ has no direction. The cables are parallel there, and as
/// long as both stay taut the body moves without turning. Such a motion is not proved.
pub(crate) struct Rocking {
    sign: i64,
}

/// The position of the body, as terms.
struct PositionTerms {
    theta: Term,
    spin: Term,
    /// sin θ and cos θ.
    turn: [Term; 2],
    d: [Term; 2],
    /// 1/D.
    inverse_d: Term,
    /// m, dc/dθ and d²c/dθ².
    path: [[Term; 2]; 3],
}

impl Rocking {
    /// The branch with the sign of a body that hangs below its anchors where a cos θ < 1.
    #[cfg(test)]
    pub(crate) fn hanging() -> Self {
        Self { sign: 1 }
    }

    /// The branch on which the state is.
    ///
    /// # Errors
    /// [`ProofFailure`] where that can not be decided.
    pub(crate) fn at(model: &Model, state: &State) -> Result<Self, ProofFailure> {
        let (sine, cosine) = model.turn(&state[2]);
        let middle = [
            &state[0] - &(&model.b * &sine),
            &state[1] + &(&model.b * &cosine) - &model.level,
        ];
        let along =
            -(&model.a * &sine * &middle[0]) + (&model.a * &cosine - Ball::integer(1)) * &middle[1];
        match (along.is_positive(), along.is_negative()) {
            (true, _) => Ok(Self { sign: 1 }),
            (_, true) => Ok(Self { sign: -1 }),
            _ if is_parallel(model, state) => Err(ProofFailure::not_covered(
                "motion on two parallel taut cables",
            )),
            _ => Err(ProofFailure::undecided(
                "which way both cables hold the body",
            )),
        }
    }

    /// S, S′ and S″ by θ as terms, and 1/D:
    ///
    /// S² = r²/D − 1,   S S′ = −Q,   Q = r² a sin θ/D²,   S S″ = −Q′ − S′²,
    /// Q′ = r² a (cos θ − 4 a sin² θ/D)/D².
    fn reach(p: &mut Program, model: &Model, [sine, cosine]: [Term; 2]) -> ([Term; 3], Term) {
        let one = p.constant(Ball::integer(1).with_limbs(model.limbs));
        let width = p.constant(Ball::integer(1) + model.a.squared());
        let twice = p.scale(cosine, model.a.twice());
        let d = p.subtract(width, twice);
        let inverse_d = p.reciprocal(d);
        let square = p.scale(inverse_d, model.r.squared());
        let square = p.subtract(square, one);
        let s = p.root(square);
        let inverse_s = p.reciprocal(s);
        let inverse_square = p.multiply(inverse_d, inverse_d);
        let per_angle = p.scale(inverse_square, &model.r.squared() * &model.a);
        let q = p.multiply(per_angle, sine);
        let s_rate = p.multiply(q, inverse_s);
        let s_rate = p.negate(s_rate);
        let bent = p.multiply(sine, sine);
        let bent = p.multiply(bent, inverse_d);
        let bent = p.scale(bent, model.a.scaled(2));
        let bent = p.subtract(cosine, bent);
        let q_rate = p.multiply(per_angle, bent);
        let squared = p.multiply(s_rate, s_rate);
        let sum = p.add(q_rate, squared);
        let s_second = p.multiply(sum, inverse_s);
        ([s, s_rate, p.negate(s_second)], inverse_d)
    }

    /// Where both cables hold the body.
    fn position_terms(&self, p: &mut Program, model: &Model) -> PositionTerms {
        let [theta, spin] = [0, 1].map(|which| p.coordinate(which));
        let turn: [Term; 2] = p.sin_cos(theta).into();
        let one = p.constant(Ball::integer(1).with_limbs(model.limbs));
        let [dy, along] = turn.map(|term| p.scale(term, model.a.clone()));
        let d = [p.subtract(along, one), dy];
        let across = [p.negate(d[1]), d[0]];
        let (reach, inverse_d) = Self::reach(p, model, turn);
        PositionTerms {
            theta,
            spin,
            turn,
            d,
            inverse_d,
            path: self.centre(p, model, across, turn, reach),
        }
    }

    /// m, dc/dθ and d²c/dθ² of the centre c = m − b (−sin θ, cos θ).
    fn centre(
        &self,
        p: &mut Program,
        model: &Model,
        across: [Term; 2],
        turn: [Term; 2],
        [s, s_rate, s_second]: [Term; 3],
    ) -> [[Term; 2]; 3] {
        let [sine, cosine] = turn;
        let minus_sine = p.negate(sine);
        // d⟂′ = −a (cos θ, sin θ), d⟂″ = a (sin θ, −cos θ).
        let along = [cosine, sine];
        let normal = [minus_sine, cosine];
        let rate = along.map(|term| p.scale(term, -&model.a));
        let across_second = normal.map(|term| p.scale(term, -&model.a));
        let sign = Ball::integer(self.sign);
        let signed = |terms: [Term; 2], p: &mut Program| terms.map(|t| p.scale(t, sign.clone()));
        let m = p.times(across, s);
        let m = signed(m, p);
        let first = [p.times(across, s_rate), p.times(rate, s)];
        let m_rate = p.sum(first[0], first[1]);
        let m_rate = signed(m_rate, p);
        let double = p.scale(s_rate, Ball::integer(2));
        let second = [
            p.times(across, s_second),
            p.times(rate, double),
            p.times(across_second, s),
        ];
        let m_second = p.sum(second[0], second[1]);
        let m_second = p.sum(m_second, second[2]);
        let m_second = signed(m_second, p);
        let more = along.map(|term| p.scale(term, model.b.clone()));
        let c_rate = p.sum(m_rate, more);
        let more = normal.map(|term| p.scale(term, model.b.clone()));
        [m, c_rate, p.sum(m_second, more)]
    }
}

/// Whether two taut cables are parallel, D = 0: more bits would not tell θ from zero.
fn is_parallel(model: &Model, state: &State) -> bool {
    let theta = &state[2];
    (&model.a - &Ball::integer(1)).is_zero() && !theta.is_positive() && !theta.is_negative()
}

impl Chart<2> for Rocking {
    /// Lagrange's equation of ½ (|c′|² + I) θ̇² under the force f, with the centre c(θ),
    ///
    /// (|c′|² + I) θ̈ = f·c′ − c′·c″ θ̇²,
    ///
    /// and the tensions from R = f − c′ θ̈ − c″ θ̇² = T₁ n₁ + T₂ n₂,
    /// with r n₁ = m + d, r n₂ = m − d:
    ///
    /// T₁ + T₂ = r R·m/|m|²,   T₁ − T₂ = r R·d/D.
    fn terms(&self, model: &Model) -> Terms {
        let mut p = Program::new();
        let PositionTerms {
            theta,
            spin,
            d,
            inverse_d,
            path: [m, c_rate, c_second],
            ..
        } = self.position_terms(&mut p, model);
        let f = force(&mut p, model);
        let one = p.constant(Ball::integer(1).with_limbs(model.limbs));

        let spin_squared = p.multiply(spin, spin);
        let [push, velocity_term] = [p.dot(f, c_rate), p.dot(c_rate, c_second)];
        let velocity_term = p.multiply(velocity_term, spin_squared);
        let along = p.subtract(push, velocity_term);
        let along = p.scale(along, model.inverse_inertia.clone());
        let size = p.dot(c_rate, c_rate);
        let size = p.scale(size, model.inverse_inertia.clone());
        let size = p.add(one, size);
        let inverse = p.reciprocal(size);
        let spin_rate = p.multiply(along, inverse);
        p.rates = vec![spin, spin_rate];

        let turning = p.times(c_rate, spin_rate);
        let by_velocity = p.times(c_second, spin_squared);
        let rest = p.difference(f, turning);
        let rest = p.difference(rest, by_velocity);
        let m_squared = p.dot(m, m);
        let inverse_m = p.reciprocal(m_squared);
        let both = p.dot(rest, m);
        let both = p.multiply(both, inverse_m);
        let apart = p.dot(rest, d);
        let apart = p.multiply(apart, inverse_d);
        // −T₁ and −T₂.
        let tensions = [p.add(both, apart), p.subtract(both, apart)];
        let tensions = tensions.map(|sum| p.scale(sum, -&model.r.half()));
        let tops = if model.has_corners() {
            vec![p.add(m[1], d[1]), p.subtract(m[1], d[1])]
        } else {
            let radius = p.constant(model.a.clone());
            vec![p.add(m[1], radius)]
        };
        let mut terms = Terms {
            program: p,
            event_functions: Vec::new(),
        };
        for (cable, tension) in tensions.into_iter().enumerate() {
            terms.add_event_function(EventFunction::Tension(cable), tension);
        }
        for top in tops {
            terms.add_event_function(EventFunction::Top, top);
        }
        terms.add_rotation_events(model, theta);
        terms
    }

    fn coordinates(&self, _: &Model, state: &State) -> Result<[Ball; 2], ProofFailure> {
        Ok([state[2].clone(), state[5].clone()])
    }

    fn slopes(&self, _: &Model, state: &StateJets) -> Option<[[Interval; 7]; 2]> {
        Some([state[2].slopes, state[5].slopes])
    }

    fn place(&self, model: &Model) -> Program {
        let mut p = Program::new();
        let PositionTerms {
            theta,
            spin,
            turn,
            path: [m, c_rate, _],
            ..
        } = self.position_terms(&mut p, model);
        let lever = turn.map(|term| p.scale(term, model.b.clone()));
        let level = p.constant(model.level.clone());
        let [x, y] = [p.add(m[0], lever[0]), p.subtract(m[1], lever[1])];
        let y = p.add(y, level);
        let [vx, vy] = p.times(c_rate, spin);
        p.outputs = vec![x, y, theta, vx, vy, spin];
        p
    }
}
