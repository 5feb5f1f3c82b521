//! Newton's second law for a body on taut cables, M q̈ = Q + Σ λ grad g with g̈ = 0 for each of
//! them. The chapter's equations are compared with it, and so are the engine's tensions, with −2 λ
//! r.
//!
//! It is an independent check because it has only the position P of a cable's end in common with
//! either, by which its gap is g = |P − A|² − r². The derivatives of g come from dual numbers, not
//! from a formula of normals and lever arms.

use super::numbers::holds;
use super::verdict::{Checked, Finding};
use snapload::{Cable, Dual, Motion, Playback, Real, State, TautSet, Trajectory, anchor_height};

/// Cable 1, of the gap g1, and cable 2, of the gap g2, as in the chapter's figures.
pub(super) const RIGHT: usize = 0;
pub(super) const LEFT: usize = 1;
pub(super) const BOTH: [usize; 2] = [RIGHT, LEFT];

/// A function of time with its first and second derivative at one time.
pub(super) type Jet = Dual<Dual<f64, 1>, 1>;

pub(super) fn jet([value, rate, second]: [f64; 3]) -> Jet {
    let first = |value, rate| Dual {
        value,
        slope: [rate],
    };
    Dual {
        value: first(value, rate),
        slope: [first(rate, second)],
    }
}

/// Value, first and second derivative.
pub(super) fn derivatives(jet: Jet) -> [f64; 3] {
    let [rate] = jet.slope;
    [jet.value.value, rate.value, rate.slope[0]]
}

/// Half-sizes a and b of a body, the length r of its cables, and its moment of inertia I.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) r: f64,
    pub(super) i: f64,
}

impl Sizes {
    /// Height h of the anchors over the fairleads at rest.
    pub(super) fn h(&self) -> f64 {
        anchor_height(self.r, self.a)
    }

    /// A cable from the positions of its ends.
    pub(super) fn cable<T: Real>(&self, side: usize) -> Cable<T> {
        let x = if side == RIGHT { 1.0 } else { -1.0 };
        let ends = [[x, self.h() + self.b], [x * self.a, self.b]];
        let [anchor, fairlead] = ends.map(|end| end.map(T::from_f64));
        Cable::new(anchor, fairlead, T::from_f64(self.r))
    }
}

/// A body on its two cables at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub(super) sizes: Sizes,
    /// x, y, θ and their rates.
    pub(super) place: [f64; 3],
    pub(super) velocity: [f64; 3],
    /// The wave's force, without the weight.
    pub(super) force: [f64; 2],
}

/// The solution for a held body: the multiplier of each gap, 0 if the cable is slack, and the
/// acceleration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constrained {
    pub(super) lambda: [f64; 2],
    pub(super) acceleration: [f64; 3],
}

impl Moment {
    /// The state of a run at a time.
    fn of(run: &Trajectory, now: &Motion) -> Self {
        let (system, [x, y, theta, vx, vy, vtheta]) = (run.system(), now.state.components());
        let ([a, b], r) = (
            system.cables[0].fairlead().components(),
            system.cables[0].length(),
        );
        let (i, [fx, fy]) = (system.body.inertia(), system.forcing.at(now.t).components());
        Self {
            sizes: Sizes { a, b, r, i },
            place: [x, y, theta],
            velocity: [vx, vy, vtheta],
            force: [fx, fy - system.forcing.constant.y],
        }
    }

    /// Gap, gap rate and g̈ of the body if it continues from its position at this velocity.
    fn gap_along(&self, side: usize, velocity: [f64; 3]) -> [f64; 3] {
        let [x, y, theta] = [0, 1, 2].map(|k| jet([self.place[k], velocity[k], 0.0]));
        let zero = Jet::default();
        let state = State::from_components([x, y, theta, zero, zero, zero]);
        let [x, y] = self.sizes.cable(side).span(&state).components();
        derivatives(x * x + y * y - self.sizes.r * self.sizes.r)
    }

    pub(super) fn gap(&self, side: usize) -> f64 {
        self.gap_along(side, self.velocity)[0]
    }

    /// Gradient of a gap.
    pub(super) fn gradient(&self, side: usize) -> [f64; 3] {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|along| self.gap_along(side, along)[1])
    }

    /// Force and weight divided by the mass, in x, y and θ.
    fn free(&self) -> [f64; 3] {
        [self.force[0], self.force[1] - 1.0, 0.0]
    }

    /// g̈ of a gap without any tension.
    pub(super) fn opening(&self, side: usize) -> f64 {
        let [g, free] = [self.gradient(side), self.free()];
        g[0] * free[0] + g[1] * free[1] + self.gap_along(side, self.velocity)[2]
    }

    /// The effect of one cable's tension on the gap of another: grad g M⁻¹ grad g.
    pub(super) fn coupling(&self, p: usize, q: usize) -> f64 {
        let [p, q] = [self.gradient(p), self.gradient(q)];
        p[0] * q[0] + p[1] * q[1] + p[2] * q[2] / self.sizes.i
    }

    /// The solution with these cables taut.
    pub(super) fn with_taut(&self, taut: TautSet) -> Constrained {
        let mut lambda = [0.0; 2];
        let c = BOTH.map(|side| self.opening(side));
        let w = |p, q| self.coupling(p, q);
        if taut.len() == 1 {
            for side in taut.iter() {
                lambda[side] = -c[side] / w(side, side);
            }
        } else if taut.len() == 2 {
            let [a, b, d] = [w(RIGHT, RIGHT), w(RIGHT, LEFT), w(LEFT, LEFT)];
            let determinant = a * d - b * b;
            lambda = [
                -(d * c[0] - b * c[1]) / determinant,
                -(a * c[1] - b * c[0]) / determinant,
            ];
        }
        let mut acceleration = self.free();
        for side in taut.iter() {
            let (g, lambda) = (self.gradient(side), lambda[side]);
            acceleration[0] += lambda * g[0];
            acceleration[1] += lambda * g[1];
            acceleration[2] += lambda * g[2] / self.sizes.i;
        }
        Constrained {
            lambda,
            acceleration,
        }
    }

    pub(super) fn with_both_taut(&self) -> Constrained {
        self.with_taut(BOTH.into_iter().collect())
    }
}

/// The largest difference of a run's tensions, while 1 or 2 cables are taut, from −2 λ r at the
/// same states; and the number of times compared.
pub(super) fn tension_residual(run: &Trajectory, taut: usize) -> (f64, usize) {
    /// The number of intervals of the run that are compared, and of times in each.
    const INTERVALS: usize = 40;
    const TIMES: usize = 20;
    let mut playback = Playback::new(run);
    let mut residuals = Vec::new();
    let intervals = run.modes().iter().filter(|mode| mode.taut.len() == taut);
    for mode in intervals.take(INTERVALS) {
        for k in 0..TIMES {
            let part = (k as f64 + 0.5) / TIMES as f64;
            let now = playback.at(mode.t_start + part * (mode.t_end - mode.t_start));
            let moment = Moment::of(run, &now);
            let lambda = moment.with_taut(now.taut).lambda;
            let residual = |cable| now.tensions[cable] + 2.0 * lambda[cable] * moment.sizes.r;
            residuals.extend(now.taut.iter().map(residual));
        }
    }
    let times = residuals.len() / taut.max(1);
    (largest(residuals), times)
}

/// Pseudorandom numbers that are the same everywhere (SplitMix64).
#[derive(Clone, Debug)]
pub(super) struct Numbers(u64);

impl Numbers {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number, uniform in an interval.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let bits = (z ^ (z >> 31)) >> 11;
        low + (high - low) * (bits as f64 / (1_u64 << 53) as f64)
    }

    /// Random sizes of a body with this half-height.
    pub(super) fn sizes(&mut self, b: f64) -> Sizes {
        Sizes {
            a: self.between(0.05, 0.4),
            b,
            r: self.between(1.2, 3.0),
            i: self.between(0.005, 0.2),
        }
    }

    /// An approximately normal number with this deviation: a sum of twelve uniform ones.
    pub(super) fn normal(&mut self, deviation: f64) -> f64 {
        (0..12).map(|_| self.between(-0.5, 0.5)).sum::<f64>() * deviation
    }
}

/// The largest magnitude of residuals; infinite if one is NaN.
pub(super) fn largest(residuals: impl IntoIterator<Item = f64>) -> f64 {
    residuals.into_iter().fold(0.0, |most: f64, r| {
        if r.is_nan() {
            f64::INFINITY
        } else {
            most.max(r.abs())
        }
    })
}

/// The largest residual of an equation over some states.
pub(super) fn over<S, I: IntoIterator<Item = f64>>(
    states: &[S],
    residual: impl Fn(&S) -> I,
) -> f64 {
    largest(states.iter().flat_map(residual))
}

/// Checks an equation by its residuals over some states.
pub(super) fn identity<S, I: IntoIterator<Item = f64>>(
    states: &[S],
    residual: impl Fn(&S) -> I,
) -> Checked {
    let most = over(states, residual);
    Ok(Finding::of(holds(most) && !states.is_empty())
        .value("residual", most)
        .value("states", states.len()))
}

/// The differences of the two sides of an equation.
pub(super) fn differences<const N: usize>(p: [f64; N], q: [f64; N]) -> [f64; N] {
    std::array::from_fn(|k| p[k] - q[k])
}

pub(super) fn length(vector: impl IntoIterator<Item = f64>) -> f64 {
    vector.into_iter().map(|z| z * z).sum::<f64>().sqrt()
}

/// Sine and cosine by the engine's functions.
pub(super) fn sin_cos(angle: f64) -> (f64, f64) {
    Real::sin_cos(angle)
}
