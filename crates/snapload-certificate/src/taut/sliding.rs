//! Motion with one taut cable in coordinates in which the cable's length is exact: the angle φ of
//! the cable and the rotation θ (docs/model.md, section 6).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::Scalar;
use crate::model::{Model, State};
use crate::taut::chart::{Chart, EventFunction, StateJets, Terms, arm, end, force, side};
use crate::taut::series::{Program, Term};
use crate::verdict::ProofFailure;

/// One taut cable, by index from 0. The coordinates are φ, θ, φ̇, θ̇.
pub(crate) struct Sliding(pub(crate) usize);

impl Chart<4> for Sliding {
    /// With n = (sin φ, −cos φ) along the cable from the anchor, e = (cos φ, sin φ) across it, ρ
    /// the arm, s = ρ × n and m = ρ·n,
    ///
    /// P = A + r n,   P̈ = r φ̈ e − r φ̇² n = f − T n + θ̈ ρ⟂ − θ̇² ρ,   θ̈ = −T s/I,
    ///
    /// which along n and e says, as ρ⟂·n = s, ρ⟂·e = m and ρ·e = −s,
    ///
    /// T = (f·n + r φ̇² − θ̇² m)/w,   r φ̈ = f·e + θ̈ m + θ̇² s,   w = 1 + s²/I.
    fn terms(&self, model: &Model) -> Terms {
        let mut p = Program::new();
        let [phi, theta, phi_rate, spin] = [0, 1, 2, 3].map(|which| p.coordinate(which));
        let (sine, cosine) = p.sin_cos(phi);
        let turn = p.sin_cos(theta).into();
        let f = force(&mut p, model);
        let minus_cosine = p.negate(cosine);
        let (n, across) = ([sine, minus_cosine], [cosine, sine]);

        let a = &model.a * &Ball::integer(side(self.0));
        let lever = arm(&mut p, [&a, &model.b], turn);
        let minus_s = p.dot(lever, across);
        let m = p.dot(lever, n);
        let s_over_i = p.scale(minus_s, -&model.inverse_inertia);
        let squared = p.multiply(minus_s, s_over_i);
        let one = p.constant(Ball::integer(1).with_limbs(model.limbs));
        // minus_s · (s/I) is −s²/I.
        let w = p.subtract(one, squared);
        let inverse_w = p.reciprocal(w);

        let [f_n, f_e] = [p.dot(f, n), p.dot(f, across)];
        let phi_squared = p.multiply(phi_rate, phi_rate);
        let phi_squared = p.scale(phi_squared, model.r.clone());
        let spin_squared = p.multiply(spin, spin);
        let pulled = p.multiply(spin_squared, m);
        let sum = p.add(f_n, phi_squared);
        let sum = p.subtract(sum, pulled);
        let tension = p.multiply(sum, inverse_w);
        let minus_tension = p.negate(tension);
        let spin_rate = p.multiply(minus_tension, s_over_i);
        let first = p.multiply(spin_rate, m);
        let second = p.multiply(spin_squared, minus_s);
        let sum = p.add(f_e, first);
        let sum = p.subtract(sum, second);
        let phi_second = p.scale(sum, model.inverse_r.clone());
        p.rates = vec![phi_rate, spin, phi_second, spin_rate];

        let mut terms = Terms {
            program: p,
            event_functions: Vec::new(),
        };
        terms.add_event_function(EventFunction::Tension(self.0), minus_tension);
        let position = PositionTerms { a, n, turn, lever };
        self.add_gap_and_top_events(&mut terms, model, &position);
        terms.add_rotation_events(model, theta);
        terms
    }

    /// The coordinates follow from D/|D| = (sin φ, −cos φ), where |D| is r up to rounding. For a
    /// number φ₀ next to φ, cos(φ − φ₀) > 0, z = sin(φ − φ₀) follows from the addition theorem, and
    /// |arcsin z − z| ≤ |z|³ for |z| ≤ 1/2. The rate is (D_x Ṗ_y − D_y Ṗ_x)/r².
    fn coordinates(&self, model: &Model, state: &State) -> Result<[Ball; 4], ProofFailure> {
        let end = model.end(self.0, state, &model.turn(&state[2]));
        let [dx, dy] = &end.reach;
        let length = (dx.squared() + dy.squared()).sqrt();
        let inverse = length.and_then(|length| length.reciprocal());
        let inverse = inverse.ok_or(ProofFailure::undecided("the angle of a taut cable"))?;
        let [sine, cosine] = [dx * &inverse, -(dy * &inverse)];
        let mut near = Ball::double(sine.to_f64().atan2(cosine.to_f64())).with_limbs(model.limbs);
        let off = |near: &Ball| {
            let (s, c) = model.functions.sin_cos(near);
            &sine * &c - &cosine * &s
        };
        for _ in 0..8 {
            near = (&near + &off(&near)).centre();
        }
        let z = off(&near);
        let size = z.upper();
        let (s, c) = model.functions.sin_cos(&near);
        let is_near = (&cosine * &c + &sine * &s).is_positive();
        if !is_near || size > Radius::power_of_two(-1) {
            return Err(ProofFailure::undecided("the angle of a taut cable"));
        }
        let phi = near + z.widened(size.times(size).times(size));
        let along = (dx * &end.velocity[1] - dy * &end.velocity[0]) * &model.inverse_r;
        Ok([
            phi,
            state[2].clone(),
            along * &model.inverse_r,
            state[5].clone(),
        ])
    }

    /// δφ = (D_x δD_y − D_y δD_x)/|D|².
    fn slopes(&self, model: &Model, state: &StateJets) -> Option<[[Interval; 7]; 4]> {
        let mut p = Program::new();
        let [x, y, theta, vx, vy, spin] = [0, 1, 2, 3, 4, 5].map(|which| p.coordinate(which));
        let turn = p.sin_cos(theta).into();
        let [[px, py], [dx, dy]] = end(&mut p, model, self.0, [x, y], turn);
        let turning = p.times([py, px], spin);
        let [ux, uy] = [p.subtract(vx, turning[0]), p.add(vy, turning[1])];
        let minus_dy = p.negate(dy);
        let swing = p.dot([minus_dy, dx], [ux, uy]);
        p.outputs = vec![dx, dy, swing];
        let few = p.map(Interval::of);
        let found = few.evaluate(state, &model.functions)?;
        let [dx, dy, swing] = [&found[0], &found[1], &found[2]];
        let [dx2, dy2] = [dx, dy].map(|d| d.value.times(&d.value));
        let inverse = dx2.plus(&dy2).reciprocal()?;
        let phi = std::array::from_fn(|j| {
            let first = dx.value.times(&dy.slopes[j]);
            first.minus(&dy.value.times(&dx.slopes[j])).times(&inverse)
        });
        let per = Interval::of(&model.inverse_r.squared());
        let rate = swing.slopes.map(|slope| slope.times(&per));
        Some([phi, state[2].slopes, rate, state[5].slopes])
    }

    /// The centre is A + r n − ρ, its rate r φ̇ e − θ̇ ρ⟂.
    fn place(&self, model: &Model) -> Program {
        let mut p = Program::new();
        let [phi, theta, phi_rate, spin] = [0, 1, 2, 3].map(|which| p.coordinate(which));
        let (sine, cosine) = p.sin_cos(phi);
        let turn = p.sin_cos(theta).into();
        let a = &model.a * &Ball::integer(side(self.0));
        let [px, py] = arm(&mut p, [&a, &model.b], turn);
        let anchor = p.constant(Ball::integer(side(self.0)));
        let level = p.constant(model.level.clone());
        let [out, down] = [sine, cosine].map(|term| p.scale(term, model.r.clone()));
        let [x, y] = [p.add(anchor, out), p.subtract(level, down)];
        let [x, y] = p.difference([x, y], [px, py]);
        let swing = p.scale(phi_rate, model.r.clone());
        let along = p.times([cosine, sine], swing);
        let turning = p.times([py, px], spin);
        let [vx, vy] = [
            p.add(along[0], turning[0]),
            p.subtract(along[1], turning[1]),
        ];
        p.outputs = vec![x, y, theta, vx, vy, spin];
        p
    }
}

/// The position of the body, as terms.
struct PositionTerms {
    /// The coordinates of the taut cable's end, in the body's frame.
    a: Ball,
    n: [Term; 2],
    /// sin θ and cos θ.
    turn: [Term; 2],
    /// ρ of the taut cable.
    lever: [Term; 2],
}

impl Sliding {
    /// Adds the other cable's gap and the tops.
    fn add_gap_and_top_events(&self, terms: &mut Terms, model: &Model, position: &PositionTerms) {
        let p = &mut terms.program;
        // The centre, with the anchors' level as zero and this anchor's x, is r n − ρ.
        let reach = position.n.map(|n| p.scale(n, model.r.clone()));
        let [x, y] = p.difference(reach, position.lever);
        let other = arm(p, [&-&position.a, &model.b], position.turn);
        // From the other cable's anchor to this one's is 2 or −2.
        let apart = p.constant(Ball::integer(2 * side(self.0)));
        let [dx, dy] = p.sum([x, y], other);
        let dx = p.add(dx, apart);
        let squared = p.dot([dx, dy], [dx, dy]);
        let r_squared = p.constant(model.r.squared());
        let gap = p.subtract(squared, r_squared);
        if model.has_corners() {
            terms.add_event_function(EventFunction::Top, reach[1]);
            terms.add_event_function(EventFunction::Top, dy);
        } else {
            let size = p.constant(model.a.clone());
            let top = p.add(y, size);
            terms.add_event_function(EventFunction::Top, top);
        }
        terms.add_event_function(EventFunction::Gap(1 - self.0), gap);
    }
}
