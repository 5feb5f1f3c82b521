//! 6.5.1.1: the equations of sliding, as printed, against Newton's law with a multiplier. The
//! equations of the right cable (6.45-6.56) differ from those of the left one (6.5-6.27) in the
//! argument `side`. The claims on the tension are in a file of their own.

mod tension;

use super::newton::{
    BOTH, Jet, LEFT, Moment, Numbers, RIGHT, Sizes, derivatives, differences, identity, jet,
    largest, over, sin_cos,
};
use super::numbers::{holds, min};
use super::verdict::{Checked, Checks, Claim, Finding, run_checks};
use crate::ReportError;
use crate::study::Study;
use snapload::{Real, State, TautSet, Trajectory};
use std::f64::consts::{FRAC_PI_2, PI};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let [left, right] = [LEFT, RIGHT].map(random_states);
    run_checks(&[CHECKS], &Material { study, left, right })
}

/// Random bodies on their left cable and on their right one.
struct Material<'a> {
    study: &'a Study,
    left: Vec<Sliding>,
    right: Vec<Sliding>,
}

const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5.1.1-01", |of| {
        identity(&of.left, |q| [q.moment.gap(q.side)])
    }),
    ("6.5.1.1-02", |of| identity(&of.left, |q| q.rates(q.side))),
    ("6.5.1.1-03", |of| identity(&of.left, Sliding::round_trip)),
    ("6.5.1.1-04", |of| identity(&of.left, |q| [q.kinetic()])),
    ("6.5.1.1-05", |of| {
        let printed = over(&of.left, |q| [q.potential()]);
        let with_b = over(&of.left, |q| [q.potential() + q.m.b]);
        Ok(Finding::of(holds(printed))
            .condition("b_left_out", holds(with_b))
            .values("printed with_b", [printed, with_b]))
    }),
    ("6.5.1.1-06", |of| identity(&of.left, Sliding::virtual_work)),
    ("6.5.1.1-07", |of| identity(&of.left, |q| [q.motion()[0]])),
    ("6.5.1.1-08", |of| {
        let printed = over(&of.left, |q| [q.motion()[1]]);
        let circles = of.left.iter().filter(|q| q.m.b == 0.0);
        let circles = largest(circles.map(|q| q.motion()[1]));
        let with_term = over(&of.left, |q| [q.mended()]);
        Ok(Finding::of(holds(printed))
            .condition("a_term_lacks", holds(with_term) && holds(circles))
            .values("printed with_term circles", [printed, with_term, circles]))
    }),
    ("6.5.1.1-09", |of| {
        identity(&of.left, |q| {
            differences(q.terms(), q.moment.gradient(q.side).map(|g| g * q.lambda))
        })
    }),
    ("6.5.1.1-10", tension::compression),
    ("6.5.1.1-11", |of| {
        identity(&of.left, |q| {
            [q.m.i * q.bdd - 2.0 * q.lambda * q.m.r * q.bracket()]
        })
    }),
    ("6.5.1.1-12", tension::loss),
    ("6.5.1.1-13", |of| {
        identity(&of.right, |q| {
            [&[q.moment.gap(q.side)][..], &q.rates(q.side)].concat()
        })
    }),
    ("6.5.1.1-14", |of| identity(&of.right, Sliding::round_trip)),
    ("6.5.1.1-15", |of| {
        identity(&of.right, Sliding::virtual_work)
    }),
    ("6.5.1.1-16", |of| {
        identity(&of.right, |q| [q.motion()[0], q.mended()])
    }),
    ("6.5.1.1-17", |of| {
        let lost = of
            .left
            .iter()
            .chain(&of.right)
            .filter(|q| q.has_lost_tension());
        let all = lost.clone().count();
        let pulling = lost.filter(|q| q.lambda < 0.0).count();
        Ok(Finding::of(all > 0 && pulling == all)
            .condition("never_pulling", all > 0 && pulling == 0)
            .values("pulling all", [pulling, all]))
    }),
    ("6.5.1.1-18", origin),
    ("6.5.1.1-19", |of| identity(&of.left, Sliding::pendulum)),
    ("6.5.1.1-20", |of| {
        let (least, solved) = (least_determinant(&of.left), over(&of.left, Sliding::solved));
        Ok(Finding::of(least > 0.0 && holds(solved))
            .values("least solved", [least, solved])
            .value("states", of.left.len()))
    }),
];

/// A body on one taut cable, in the symbols of the chapter.
struct Sliding {
    side: usize,
    m: Sizes,
    alpha: f64,
    beta: f64,
    /// α̇ and β̇.
    ad: f64,
    bd: f64,
    /// α̈ and β̈ by Newton's law, and the multiplier.
    add: f64,
    bdd: f64,
    lambda: f64,
    moment: Moment,
}

/// 6.5, 6.7, 6.9; 6.45, 6.47, 6.49: x, y, θ.
fn place(m: &Sizes, side: usize, [alpha, beta]: [Jet; 2]) -> [Jet; 3] {
    let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
    let across = sa * m.r + sb * m.a - cb * m.b;
    let y = -(ca * m.r - (m.h() + m.b)) - cb * m.a - sb * m.b;
    match side {
        LEFT => [across - 1.0, y, beta - FRAC_PI_2],
        _ => [-(across - 1.0), y, -beta + FRAC_PI_2],
    }
}

impl Sliding {
    fn new(m: Sizes, side: usize, [alpha, beta, ad, bd]: [f64; 4], force: [f64; 2]) -> Self {
        let moving = |a: [f64; 3], b: [f64; 3]| place(&m, side, [jet(a), jet(b)]).map(derivatives);
        let now = moving([alpha, ad, 0.0], [beta, bd, 0.0]);
        let moment = Moment {
            sizes: m,
            place: now.map(|z| z[0]),
            velocity: now.map(|z| z[1]),
            force,
        };
        let constrained = moment.with_taut(TautSet::only(side));
        let [ax, ay, atheta] = constrained.acceleration;
        // θ̈ gives β̈; the remaining part of ẍ and ÿ is α̈ times the derivative of the position by
        // α.
        let bdd = if side == LEFT { atheta } else { -atheta };
        let [x, y, _] = moving([alpha, ad, 0.0], [beta, bd, bdd]).map(|z| z[2]);
        let [dx, dy, _] = moving([alpha, 1.0, 0.0], [beta, 0.0, 0.0]).map(|z| z[1]);
        Self {
            side,
            m,
            alpha,
            beta,
            ad,
            bd,
            add: ((ax - x) * dx + (ay - y) * dy) / (m.r * m.r),
            bdd,
            lambda: constrained.lambda[side],
            moment,
        }
    }

    /// Sine and cosine of α, β and β − α.
    fn turns(&self) -> [(f64, f64); 3] {
        [self.alpha, self.beta, self.beta - self.alpha].map(sin_cos)
    }

    /// 6.6, 6.8, 6.10; 6.46, 6.48, 6.50: the rates minus the true ones.
    fn rates(&self, side: usize) -> [f64; 3] {
        let (Sizes { a, b, r, .. }, &Self { ad, bd, .. }) = (self.m, self);
        let [(sa, ca), (sb, cb), _] = self.turns();
        let across = r * ad * ca + a * bd * cb + b * bd * sb;
        let y = r * ad * sa + a * bd * sb - b * bd * cb;
        let sign = if side == LEFT { 1.0 } else { -1.0 };
        differences([sign * across, y, sign * bd], self.moment.velocity)
    }

    /// 6.11-6.14; 6.51-6.54: α, β and their rates by x, y and θ, minus the true ones.
    fn round_trip(&self) -> [f64; 4] {
        let (Sizes { a, b, r, .. }, h) = (self.m, self.m.h());
        let ([x, y, theta], [vx, _, vtheta]) = (self.moment.place, self.moment.velocity);
        let ((s, c), top) = (sin_cos(theta), h + b);
        let printed = match self.side {
            LEFT => [
                arcsin((1.0 + x - a * c - b * s) / r),
                FRAC_PI_2 + theta,
                (vx + a * vtheta * s - b * vtheta * c) / (top - y + a * s - b * c),
                vtheta,
            ],
            _ => [
                arcsin((1.0 - x - a * c + b * s) / r),
                FRAC_PI_2 - theta,
                (vx - a * vtheta * s - b * vtheta * c) / (y - top + a * s + b * c),
                -vtheta,
            ],
        };
        differences(printed, [self.alpha, self.beta, self.ad, self.bd])
    }

    /// 6.18, the kinetic energy in α and β, minus 6.17, that in x, y and θ.
    fn kinetic(&self) -> f64 {
        let (Sizes { a, b, r, i }, &Self { ad, bd, .. }) = (self.m, self);
        let ([.., (s, c)], [vx, vy, vtheta]) = (self.turns(), self.moment.velocity);
        let turning = (i + a * a + b * b) * bd * bd;
        let coupled = 2.0 * r * a * ad * bd * c + 2.0 * r * b * ad * bd * s;
        0.5 * (r * r * ad * ad + turning + coupled)
            - 0.5 * (vx * vx + vy * vy + i * vtheta * vtheta)
    }

    /// 6.20, the potential energy in α and β, minus the height y.
    fn potential(&self) -> f64 {
        let [(_, ca), (sb, cb), _] = self.turns();
        self.m.h() - self.m.r * ca - self.m.a * cb - self.m.b * sb - self.moment.place[1]
    }

    /// 6.26, 6.27; 6.55, 6.56: generalized forces.
    fn forces(&self) -> [f64; 2] {
        let Sizes { a, b, r, .. } = self.m;
        let ([(sa, ca), (sb, cb), _], [fx, fy]) = (self.turns(), self.moment.force);
        let fx = if self.side == LEFT { fx } else { -fx };
        [
            fx * r * ca + fy * r * sa,
            fx * (a * cb + b * sb) + fy * (a * sb - b * cb),
        ]
    }

    /// The same minus the virtual work of the force along the derivatives of 6.5 and 6.7 (6.45,
    /// 6.47).
    fn virtual_work(&self) -> [f64; 2] {
        let [fx, fy] = self.moment.force;
        let work = [[1.0, 0.0], [0.0, 1.0]].map(|[ad, bd]| {
            let path = [jet([self.alpha, ad, 0.0]), jet([self.beta, bd, 0.0])];
            let [x, y, _] = place(&self.m, self.side, path).map(derivatives);
            fx * x[1] + fy * y[1]
        });
        differences(self.forces(), work)
    }

    /// 6.30, 6.31 (and 6.32), 6.33: the matrix of the equations of motion of a body of this height;
    /// 6.34, 6.35: their right sides under these generalized forces.
    fn equations(&self, b: f64, forces: [f64; 2]) -> ([f64; 3], [f64; 2]) {
        let (Sizes { a, r, i, .. }, &Self { ad, bd, .. }) = (self.m, self);
        let [(sa, _), (sb, _), (s, c)] = self.turns();
        let matrix = [r * r, r * a * c + r * b * s, i + a * a + b * b];
        let right_sides = [
            r * a * bd * bd * s - r * b * bd * bd * c - r * sa + forces[0],
            -r * a * ad * ad * s + r * b * ad * ad * c - a * sb + forces[1],
        ];
        (matrix, right_sides)
    }

    /// The residuals of 6.28 and 6.29 as printed.
    fn motion(&self) -> [f64; 2] {
        let ([a11, a12, a22], [b1, b2]) = self.equations(self.m.b, self.forces());
        let &Self { add, bdd, .. } = self;
        [a11 * add + a12 * bdd - b1, a12 * add + a22 * bdd - b2]
    }

    /// The residual of 6.29 with the term that is missing in 6.35: the part of the weight's moment
    /// that is due to the height of a box.
    fn mended(&self) -> f64 {
        self.motion()[1] - self.m.b * sin_cos(self.beta).1
    }

    /// α̈ and β̈ by Cramer's rule, with the term that is missing in 6.35, minus the true ones.
    fn solved(&self) -> [f64; 2] {
        let (matrix, [b1, b2]) = self.equations(self.m.b, self.forces());
        let mended = b2 + self.m.b * sin_cos(self.beta).1;
        differences(cramer(matrix, [b1, mended]), [self.add, self.bdd])
    }

    /// The multiplier's terms of 6.40, 6.41, 6.42.
    fn terms(&self) -> [f64; 3] {
        let (Sizes { a, b, .. }, h) = (self.m, self.m.h());
        let [x, y, theta] = self.moment.place;
        let ((s, c), top) = (sin_cos(theta), h + b);
        [
            1.0 + x - a * c - b * s,
            y - top - a * s + b * c,
            (1.0 + x) * (a * s - b * c) + (top - y) * (a * c + b * s),
        ]
        .map(|factor| 2.0 * self.lambda * factor)
    }

    /// The bracket of 6.43 and 6.44.
    fn bracket(&self) -> f64 {
        let [.., (s, c)] = self.turns();
        self.m.a * s - self.m.b * c
    }

    /// Whether tension is lost according to 6.44.
    fn has_lost_tension(&self) -> bool {
        self.bdd * self.bracket() > 0.0
    }

    /// The virtual work of all forces on a double pendulum that moves by 6.28 and 6.29 without
    /// height and forcing: a massless leg r at the angle α, a leg a at β, at its end a mass 1 with
    /// a moment of inertia (d'Alembert's principle).
    fn pendulum(&self) -> [f64; 2] {
        let (matrix, right_sides) = self.equations(0.0, [0.0; 2]);
        let [add, bdd] = cramer(matrix, right_sides);
        let legs = [
            (self.m.r, [self.alpha, self.ad, add]),
            (self.m.a, [self.beta, self.bd, bdd]),
        ];
        let ends = legs.map(|(leg, angle)| {
            let (s, c) = jet(angle).sin_cos();
            [s * leg, -(c * leg)].map(|z| derivatives(z)[2])
        });
        let [x, y] = [0, 1].map(|k| ends[0][k] + ends[1][k]);
        let [work_alpha, work_beta] = legs.map(|(leg, [angle, ..])| {
            let (s, c) = sin_cos(angle);
            leg * (x * c + (y + 1.0) * s)
        });
        [work_alpha, work_beta + self.m.i * bdd]
    }
}

/// The solution of 6.28 and 6.29 by Cramer's rule.
fn cramer([a11, a12, a22]: [f64; 3], [b1, b2]: [f64; 2]) -> [f64; 2] {
    let determinant = a11 * a22 - a12 * a12;
    [a22 * b1 - a12 * b2, a11 * b2 - a12 * b1].map(|numerator| numerator / determinant)
}

/// The least determinant of 6.28 and 6.29, relative to the product of its diagonal.
fn least_determinant(states: &[Sliding]) -> f64 {
    min(states.iter().map(|q| {
        let ([a11, a12, a22], _) = q.equations(q.m.b, [0.0; 2]);
        1.0 - a12 * a12 / (a11 * a22)
    }))
}

/// The angle below 90° with this sine: Newton's method, which converges monotonically if it starts
/// from the sine itself.
fn arcsin(sine: f64) -> f64 {
    (0..40).fold(sine, |angle, _| {
        let (s, c) = sin_cos(angle);
        angle + (sine - s) / c
    })
}

/// The number of random bodies.
const BODIES: usize = 300;
/// Deviation of the forces: as large as the weight, so that some cables lose their tension.
const FORCE: f64 = 1.0;
/// The seed of the random states.
const SEED: u64 = 6_511;

/// The random bodies on one of their cables.
fn random_states(side: usize) -> Vec<Sliding> {
    let mut numbers = Numbers::new(SEED);
    let mut state = || {
        let circle = numbers.between(0.0, 1.0) < 0.3;
        let height = numbers.between(0.0, 0.4);
        let b = if circle { 0.0 } else { height };
        let sizes = numbers.sizes(b);
        let angles = [numbers.between(-1.2, 1.2), numbers.between(0.2, PI - 0.2)];
        let [ad, bd] = [1.0; 2].map(|deviation| numbers.normal(deviation));
        let force = [FORCE; 2].map(|deviation| numbers.normal(deviation));
        Sliding::new(sizes, side, [angles[0], angles[1], ad, bd], force)
    };
    (0..BODIES).map(|_| state()).collect()
}

/// The state at which the sliding example first reaches its other cable's boundary while it slides.
fn first_hit(run: &Trajectory) -> Option<State> {
    let mut hits = run.impacts().iter().filter(|hit| hit.v_n > 0.0);
    let hit = hits.find(|hit| {
        let mut slides = run.modes().iter().filter(|mode| mode.taut.len() == 1);
        slides.any(|mode| {
            !mode.taut.contains(hit.cable) && mode.t_start < hit.t && hit.t <= mode.t_end
        })
    })?;
    Some(hit.before)
}

fn origin(of: &Material) -> Checked {
    const CLOSED: f64 = 1e-12;
    let shapes = &of.study.critical;
    let gaps = shapes.iter().flat_map(|row| {
        let ([a, b], r, i) = (row.size, row.r, 1.0);
        let sizes = Sizes { a, b, r, i };
        BOTH.map(|side| sizes.cable(side).gap(&State::default()))
    });
    let most = largest(gaps);
    let elsewhere = first_hit(&of.study.sliding.run).map(|State { x, y, theta, .. }| {
        format!("; the sliding example meets both at x = {x:.3}, y = {y:.3}, θ = {theta:.2}")
    });
    Ok(Finding::of(!shapes.is_empty() && most < CLOSED)
        .value("gaps", most)
        .value("shapes", shapes.len())
        .value("elsewhere", elsewhere.unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::Verdict;

    #[test]
    fn an_equation_with_another_sign_or_size_is_not_reproduced() -> Result<(), ReportError> {
        let left = random_states(LEFT);
        let verdict = |states: &[_], residual: &dyn Fn(&Sliding) -> Vec<f64>| {
            identity(states, residual).map(|finding| finding.verdict)
        };
        let rates = |q: &Sliding| q.rates(LEFT).to_vec();
        let work = |q: &Sliding| q.virtual_work().to_vec();
        assert_eq!(verdict(&left, &rates)?, Verdict::Reproduced);
        assert_eq!(verdict(&left, &work)?, Verdict::Reproduced);
        // 6.6 with the signs of 6.46, and forces that are slightly too large.
        let other = |q: &Sliding| q.rates(RIGHT).to_vec();
        let larger = |q: &Sliding| [work(q), q.forces().map(|f| 1e-6 * f).to_vec()].concat();
        assert_eq!(verdict(&left, &other)?, Verdict::NotReproduced);
        assert_eq!(verdict(&left, &larger)?, Verdict::NotReproduced);
        assert_eq!(verdict(&[], &rates)?, Verdict::NotReproduced);
        // Cramer's rule with the right side of the equation of another angle.
        let solved = |q: &Sliding| q.solved().to_vec();
        let swapped = |q: &Sliding| {
            let (matrix, [b1, b2]) = q.equations(q.m.b, q.forces());
            differences(cramer(matrix, [b2, b1]), [q.add, q.bdd]).to_vec()
        };
        assert_eq!(verdict(&left, &solved)?, Verdict::Reproduced);
        assert_eq!(verdict(&left, &swapped)?, Verdict::NotReproduced);
        Ok(())
    }
}
