//! Motion with one taut cable in coordinates in which the cable's length is exact: the angle φ of
//! the cable and the rotation θ (docs/model.md, section 6).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::{Model, State};
use crate::taut::series::{DIMENSION, Program, Term};
use crate::verdict::Trouble;

/// φ, θ, φ̇, θ̇.
pub(crate) type Coordinates = [Ball; DIMENSION];

/// What is watched: −T, the other cable's gap, θ and −θ over their limit, then the tops.
pub(crate) const TENSION: usize = 0;
pub(crate) const OTHER_GAP: usize = 1;
pub(crate) const ROTATIONS: [usize; 2] = [2, 3];

/// The equations of motion with cable `cable` taut. With n = (sin φ, −cos φ) along the cable from
/// the anchor, e = (cos φ, sin φ) across it, ρ the arm, s = ρ × n and m = ρ·n,
///
/// P = A + r n,   P̈ = r φ̈ e − r φ̇² n = f − T n + θ̈ ρ⟂ − θ̇² ρ,   θ̈ = −T s/I,
///
/// which along n and e says, as ρ⟂·n = s, ρ⟂·e = m and ρ·e = −s,
///
/// T = (f·n + r φ̇² − θ̇² m)/w,   r φ̈ = f·e + θ̈ m + θ̇² s,   w = 1 + s²/I.
pub(crate) fn equations(model: &Model, cable: usize) -> Program {
    let mut p = Program::new();
    let side = if cable == 0 { 1 } else { -1 };
    let [phi, theta, phi_rate, spin] = [0, 1, 2, 3].map(|which| p.coordinate(which));
    let (sine, cosine) = p.sin_cos(phi);
    let (turn_sine, turn_cosine) = p.sin_cos(theta);
    let (fx, fy) = force(&mut p, model);

    let a = &model.a * &Ball::integer(side);
    let [px, py] = arm(&mut p, [&a, &model.b], turn_sine, turn_cosine);
    let across = [p.multiply(px, cosine), p.multiply(py, sine)];
    let minus_s = p.add(across[0], across[1]);
    let along = [p.multiply(px, sine), p.multiply(py, cosine)];
    let m = p.subtract(along[0], along[1]);
    let s_over_i = p.scale(minus_s, -&model.inverse_inertia);
    let squared = p.multiply(minus_s, s_over_i);
    let one = p.constant(Ball::integer(1).with_limbs(model.limbs));
    // minus_s · (s/I) is −s²/I.
    let w = p.subtract(one, squared);
    let inverse_w = p.reciprocal(w);

    let f_n = [p.multiply(fx, sine), p.multiply(fy, cosine)];
    let f_n = p.subtract(f_n[0], f_n[1]);
    let f_e = [p.multiply(fx, cosine), p.multiply(fy, sine)];
    let f_e = p.add(f_e[0], f_e[1]);
    let phi_squared = p.multiply(phi_rate, phi_rate);
    let phi_squared = p.scale(phi_squared, model.r.clone());
    let spin_squared = p.multiply(spin, spin);
    let pulled = p.multiply(spin_squared, m);
    let sum = p.add(f_n, phi_squared);
    let sum = p.subtract(sum, pulled);
    let tension = p.multiply(sum, inverse_w);
    let minus_tension = p.scale(tension, Ball::integer(-1));
    let spin_rate = p.multiply(minus_tension, s_over_i);
    let first = p.multiply(spin_rate, m);
    let second = p.multiply(spin_squared, minus_s);
    let sum = p.add(f_e, first);
    let sum = p.subtract(sum, second);
    let phi_second = p.scale(sum, model.inverse_r.clone());
    p.rates = vec![phi_rate, spin, phi_second, spin_rate];

    let place = Place {
        side,
        a,
        theta,
        sine,
        cosine,
        turn: [turn_sine, turn_cosine],
        lever: [px, py],
    };
    p.outputs = vec![minus_tension];
    watch(&mut p, model, &place);
    p
}

/// Where the body is, as terms.
struct Place {
    side: i64,
    a: Ball,
    theta: Term,
    sine: Term,
    cosine: Term,
    /// sin θ and cos θ.
    turn: [Term; 2],
    /// ρ of the taut cable.
    lever: [Term; 2],
}

/// The other gap, both sides of the rotation limit, and the tops, as outputs.
fn watch(p: &mut Program, model: &Model, place: &Place) {
    let [px, py] = place.lever;
    let [turn_sine, turn_cosine] = place.turn;
    // The centre, with the anchors' level as zero, is A + r n − ρ.
    let r_sine = p.scale(place.sine, model.r.clone());
    let depth = p.scale(place.cosine, -&model.r);
    let [x, y] = [p.subtract(r_sine, px), p.subtract(depth, py)];
    let [qx, qy] = arm(p, [&-&place.a, &model.b], turn_sine, turn_cosine);
    // From this cable's anchor to the other's is −2 or 2.
    let apart = p.constant(Ball::integer(2 * place.side));
    let [dx, dy] = [p.add(x, qx), p.add(y, qy)];
    let dx = p.add(dx, apart);
    let [dx2, dy2] = [p.multiply(dx, dx), p.multiply(dy, dy)];
    let sum = p.add(dx2, dy2);
    let r_squared = p.constant(model.r.squared());
    let gap = p.subtract(sum, r_squared);
    let limit = p.constant(model.functions.half_pi().clone());
    let over = p.subtract(place.theta, limit);
    let minus_theta = p.scale(place.theta, Ball::integer(-1));
    let under = p.subtract(minus_theta, limit);
    p.outputs.extend([gap, over, under]);
    if model.has_corners() {
        p.outputs.extend([depth, dy]);
    } else {
        let size = p.constant(model.a.clone());
        let top = p.add(y, size);
        p.outputs.push(top);
    }
}

/// f_x and f_y − 1.
fn force(p: &mut Program, model: &Model) -> (Term, Term) {
    let weight = p.constant(Ball::integer(1));
    if model.is_steady {
        let nothing = p.constant(Ball::zero());
        let fx = p.constant(model.f_o.clone());
        return (fx, p.subtract(nothing, weight));
    }
    let phase = p.phase(model.omega.clone());
    let (sine, cosine) = p.sin_cos(phase);
    let fx = p.scale(cosine, model.f_o.clone());
    let fy = p.scale(sine, &model.nu * &model.f_o);
    (fx, p.subtract(fy, weight))
}

/// R(θ) of a vector of the body.
fn arm(p: &mut Program, [a, b]: [&Ball; 2], sine: Term, cosine: Term) -> [Term; 2] {
    let [a_cos, a_sin] = [p.scale(cosine, a.clone()), p.scale(sine, a.clone())];
    let [b_cos, b_sin] = [p.scale(cosine, b.clone()), p.scale(sine, b.clone())];
    [p.subtract(a_cos, b_sin), p.add(a_sin, b_cos)]
}

/// The coordinates of a state in which the cable is taut and its normal velocity zero.
///
/// D = r (sin φ, −cos φ). For a number φ₀ next to φ, cos(φ − φ₀) > 0, z = sin(φ − φ₀) follows from
/// the addition theorem, and |arcsin z − z| ≤ |z|³ for |z| ≤ 1/2. The rate is e·Ṗ/r.
pub(crate) fn coordinates_of(
    model: &Model,
    cable: usize,
    state: &State,
) -> Result<Coordinates, Trouble> {
    let end = model.end(cable, state, &model.turn(&state[2]));
    let sine = &end.reach[0] * &model.inverse_r;
    let cosine = -(&end.reach[1] * &model.inverse_r);
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
        return Err(Trouble::undecided("the angle of a taut cable"));
    }
    let phi = near + z.widened(size.times(size).times(size));
    let along = &cosine * &end.velocity[0] + &sine * &end.velocity[1];
    Ok([
        phi,
        state[2].clone(),
        along * &model.inverse_r,
        state[5].clone(),
    ])
}

/// The state of coordinates.
pub(crate) fn state_of(model: &Model, cable: usize, at: &Coordinates) -> State {
    let [phi, theta, phi_rate, spin] = at;
    let (sine, cosine) = model.functions.sin_cos(phi);
    let (turn_sine, turn_cosine) = model.turn(theta);
    let side = Ball::integer(if cable == 0 { 1 } else { -1 });
    let a = &model.a * &side;
    let px = &a * &turn_cosine - &model.b * &turn_sine;
    let py = &a * &turn_sine + &model.b * &turn_cosine;
    let swing = &model.r * phi_rate;
    [
        side + &model.r * &sine - &px,
        &model.level - &(&model.r * &cosine) - &py,
        theta.clone(),
        &swing * &cosine + spin * &py,
        &swing * &sine - spin * &px,
        spin.clone(),
    ]
}
