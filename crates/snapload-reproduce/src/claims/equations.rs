//! The chapter's equations of sliding and rocking, as printed and by their numbers. Those of the right
//! cable (6.45-6.56) are told from those of the left one (6.5-6.27) by the side.

use super::newton::{Jet, Mooring, Side};
use snapload::Real;
use std::f64::consts::FRAC_PI_2;

/// The coordinates of sliding and their rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angles {
    pub(super) alpha: f64,
    pub(super) beta: f64,
    pub(super) alpha_rate: f64,
    pub(super) beta_rate: f64,
}

/// The sines and cosines of α, β and β − α.
struct Turns {
    alpha: (f64, f64),
    beta: (f64, f64),
    between: (f64, f64),
}

impl Angles {
    fn turns(&self) -> Turns {
        Turns {
            alpha: Real::sin_cos(self.alpha),
            beta: Real::sin_cos(self.beta),
            between: Real::sin_cos(self.beta - self.alpha),
        }
    }

    /// α and β in time, with these second derivatives.
    pub(super) fn path(&self, alpha_second: f64, beta_second: f64) -> [Jet; 2] {
        [
            Jet::new(self.alpha, self.alpha_rate, alpha_second),
            Jet::new(self.beta, self.beta_rate, beta_second),
        ]
    }
}

/// 6.5, 6.7, 6.9; 6.45, 6.47, 6.49: x, y, θ.
pub(super) fn eq_6_5_place(m: &Mooring, side: Side, [alpha, beta]: [Jet; 2]) -> [Jet; 3] {
    let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
    let across = sa * m.r + sb * m.a - cb * m.b;
    let y = Jet::constant(m.h() + m.b) - ca * m.r - cb * m.a - sb * m.b;
    match side {
        Side::Left => [across + -1.0, y, beta + -FRAC_PI_2],
        Side::Right => [Jet::constant(1.0) - across, y, beta * -1.0 + FRAC_PI_2],
    }
}

/// 6.6, 6.8, 6.10; 6.46, 6.48, 6.50: their rates.
pub(super) fn eq_6_6_rates(m: &Mooring, side: Side, q: &Angles) -> [f64; 3] {
    let t = q.turns();
    let ((sa, ca), (sb, cb)) = (t.alpha, t.beta);
    let (ad, bd) = (q.alpha_rate, q.beta_rate);
    let across = m.r * ad * ca + m.a * bd * cb + m.b * bd * sb;
    let y = m.r * ad * sa + m.a * bd * sb - m.b * bd * cb;
    match side {
        Side::Left => [across, y, bd],
        Side::Right => [-across, y, -bd],
    }
}

/// 6.11-6.14; 6.51-6.54: α, β and their rates.
pub(super) fn eq_6_11_angles(
    m: &Mooring,
    side: Side,
    [x, y, theta]: [f64; 3],
    [vx, _, vtheta]: [f64; 3],
) -> Angles {
    let (s, c) = Real::sin_cos(theta);
    let (a, b, top) = (m.a, m.b, m.h() + m.b);
    match side {
        Side::Left => Angles {
            alpha: arcsin((1.0 + x - a * c - b * s) / m.r),
            alpha_rate: (vx + a * vtheta * s - b * vtheta * c) / (top - y + a * s - b * c),
            beta: FRAC_PI_2 + theta,
            beta_rate: vtheta,
        },
        Side::Right => Angles {
            alpha: arcsin((1.0 - x - a * c + b * s) / m.r),
            alpha_rate: (vx - a * vtheta * s - b * vtheta * c) / (y - top + a * s + b * c),
            beta: FRAC_PI_2 - theta,
            beta_rate: -vtheta,
        },
    }
}

/// The angle below a quarter turn with this sine: Newton's method, which from the sine itself only
/// ever comes nearer.
fn arcsin(sine: f64) -> f64 {
    let mut angle = sine;
    for _ in 0..40 {
        let (s, c) = Real::sin_cos(angle);
        angle += (sine - s) / c;
    }
    angle
}

/// 6.17: kinetic energy.
pub(super) fn eq_6_17_kinetic(m: &Mooring, [vx, vy, vtheta]: [f64; 3]) -> f64 {
    0.5 * (vx * vx + vy * vy) + 0.5 * m.inertia * vtheta * vtheta
}

/// 6.18: the same in α and β.
pub(super) fn eq_6_18_kinetic(m: &Mooring, q: &Angles) -> f64 {
    let (s, c) = q.turns().between;
    let (ad, bd) = (q.alpha_rate, q.beta_rate);
    0.5 * (m.r * m.r * ad * ad
        + (m.inertia + m.a * m.a + m.b * m.b) * bd * bd
        + 2.0 * m.r * m.a * ad * bd * c
        + 2.0 * m.r * m.b * ad * bd * s)
}

/// 6.20: potential energy.
pub(super) fn eq_6_20_potential(m: &Mooring, q: &Angles) -> f64 {
    let t = q.turns();
    m.h() - m.r * t.alpha.1 - m.a * t.beta.1 - m.b * t.beta.0
}

/// 6.26, 6.27; 6.55, 6.56: generalized forces.
pub(super) fn eq_6_26_forces(m: &Mooring, side: Side, q: &Angles, force: [f64; 2]) -> [f64; 2] {
    let t = q.turns();
    let ((sa, ca), (sb, cb)) = (t.alpha, t.beta);
    let fx = match side {
        Side::Left => force[0],
        Side::Right => -force[0],
    };
    let fy = force[1];
    [
        fx * m.r * ca + fy * m.r * sa,
        fx * (m.a * cb + m.b * sb) + fy * (m.a * sb - m.b * cb),
    ]
}

/// 6.30, 6.31 (and 6.32), 6.33: the matrix of the equations of motion.
pub(super) fn eq_6_30_matrix(m: &Mooring, q: &Angles) -> [f64; 3] {
    let (s, c) = q.turns().between;
    [
        m.r * m.r,
        m.r * m.a * c + m.r * m.b * s,
        m.inertia + m.a * m.a + m.b * m.b,
    ]
}

/// 6.34, 6.35: the right sides, with these generalized forces.
pub(super) fn eq_6_34_right_sides(m: &Mooring, q: &Angles, forces: [f64; 2]) -> [f64; 2] {
    let t = q.turns();
    let (s, c) = t.between;
    let (ad, bd) = (q.alpha_rate * q.alpha_rate, q.beta_rate * q.beta_rate);
    [
        m.r * m.a * bd * s - m.r * m.b * bd * c - m.r * t.alpha.0 + forces[0],
        -m.r * m.a * ad * s + m.r * m.b * ad * c - m.a * t.beta.0 + forces[1],
    ]
}

/// What 6.35 lacks: the part of the weight's moment that a box has for its height.
pub(super) fn missing_in_6_35(m: &Mooring, q: &Angles) -> f64 {
    m.b * q.turns().beta.1
}

/// 6.28, 6.29 solved for the second derivatives by Cramer's rule.
pub(super) fn eq_6_28_solved([a11, a12, a22]: [f64; 3], [b1, b2]: [f64; 2]) -> [f64; 2] {
    let determinant = a11 * a22 - a12 * a12;
    [
        (a22 * b1 - a12 * b2) / determinant,
        (a11 * b2 - a12 * b1) / determinant,
    ]
}

/// The multiplier's terms of 6.40, 6.41, 6.42.
pub(super) fn eq_6_40_terms(m: &Mooring, lambda: f64, [x, y, theta]: [f64; 3]) -> [f64; 3] {
    let (s, c) = Real::sin_cos(theta);
    let (a, b, top) = (m.a, m.b, m.h() + m.b);
    [
        2.0 * lambda * (1.0 + x - a * c - b * s),
        2.0 * lambda * (y - top - a * s + b * c),
        2.0 * lambda * ((1.0 + x) * (a * s - b * c) + (top - y) * (a * c + b * s)),
    ]
}

/// The bracket of 6.43 and 6.44.
pub(super) fn eq_6_43_bracket(m: &Mooring, q: &Angles) -> f64 {
    let (s, c) = q.turns().between;
    m.a * s - m.b * c
}

/// 6.44: whether tension is lost.
pub(super) fn eq_6_44_lost(m: &Mooring, q: &Angles, beta_second: f64) -> bool {
    beta_second * eq_6_43_bracket(m, q) > 0.0
}

/// 6.59, 6.60: the gaps of a circle.
pub(super) fn eq_6_59_gaps(m: &Mooring, [x, y, theta]: [f64; 3]) -> [f64; 2] {
    let (s, c) = Real::sin_cos(theta);
    let (a, h) = (m.a, m.h());
    let square = |z: f64| z * z;
    [
        square(1.0 - x - a * c) + square(h - y - a * s) - m.r * m.r,
        square(1.0 + x - a * c) + square(h - y + a * s) - m.r * m.r,
    ]
}

/// 6.61, 6.62: x and y of a rocking circle.
pub(super) fn eq_6_61_place(m: &Mooring, theta: Jet) -> [Jet; 2] {
    let (s, c) = theta.sin_cos();
    let (a, h) = (m.a, m.h());
    let above = c * (2.0 * a) + (m.r * m.r - 1.0 - a * a);
    let below = c * (-2.0 * a) + (1.0 + a * a);
    let y = (c * a + -1.0) * above.sqrt() / below.sqrt() + h;
    let x = (y + -h) * s * a / (c * -a + 1.0);
    [x, y]
}

/// 6.63 with 6.65: θ̈ of a rocking circle.
pub(super) fn eq_6_63_second(m: &Mooring, theta: f64, rate: f64, force: [f64; 2]) -> f64 {
    let [x, y] = eq_6_61_place(m, Jet::new(theta, 1.0, 0.0));
    let generalized = force[0] * x.rate + force[1] * y.rate;
    let bend = rate * rate * (x.rate * x.second + y.rate * y.second);
    (generalized - y.rate - bend) / (m.inertia + x.rate * x.rate + y.rate * y.rate)
}

/// What multiplies λ1 and λ2 in 6.66, 6.67, 6.68.
pub(super) fn eq_6_66_factors(m: &Mooring, [x, y, theta]: [f64; 3]) -> [[f64; 3]; 2] {
    let (s, c) = Real::sin_cos(theta);
    let (a, h) = (m.a, m.h());
    [
        [
            2.0 * (-1.0 + x + a * c),
            2.0 * (y - h + a * s),
            2.0 * a * ((1.0 - x) * s - (h - y) * c),
        ],
        [
            2.0 * (1.0 + x - a * c),
            2.0 * (y - h - a * s),
            2.0 * a * ((1.0 + x) * s + (h - y) * c),
        ],
    ]
}
