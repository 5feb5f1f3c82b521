//! The resistance of water to a body that moves through it.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::arithmetic::vector_series::{VectorSeries, convolve};
use crate::model::forcing::Harmonic;
use crate::model::state::State;

/// Below about this relative speed \[L/T\] the quadratic law is rounded off, |u| = sqrt(u² + δ²):
/// |u|u has no Taylor series where u = 0, and this has one. The error of the force is at most δ²/2
/// times its coefficient.
const STANDSTILL: f64 = 1e-5;

/// A force D = c₁ u + c₂ |u| u with the velocity u = w − v of the water relative to the body's
/// centre, the second term being the drag of Morison, O'Brien, Johnson & Schaaf (*Petroleum
/// Transactions AIME* 189 (1950) 149), and a moment −c_θ I θ̇.
///
/// D is a force, and on a body of unit mass the acceleration, too, so that c₁ and c₂ are per unit
/// mass there. With a mass matrix M the acceleration is M⁻¹ D: where M = diag(m, m, I), c₁ is m
/// times the rate at which a velocity decays. The moment is for unit moment of inertia in either
/// case, I being M_θθ: where nothing else turns the body, c_θ is the rate at which its rotation
/// decays.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag<T = f64> {
    /// c₁, force per velocity: \[1/T\] for a unit mass, \[M/T\] with a mass matrix.
    pub linear: T,
    /// c₂, force per squared velocity: \[1/L\] for a unit mass, \[M/L\] with a mass matrix.
    pub quadratic: T,
    /// c_θ, for unit moment of inertia \[1/T\].
    pub turning: T,
    /// The velocity w of the water where the body is, as a sum of sinusoids \[L/T\].
    pub water: Vec<Harmonic<T>>,
}

impl<T: Real> Drag<T> {
    /// The same in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Drag<U> {
        Drag {
            linear: number(self.linear),
            quadratic: number(self.quadratic),
            turning: number(self.turning),
            water: self.water.iter().map(|wave| wave.map(number)).collect(),
        }
    }

    /// w at a time.
    #[inline(always)]
    pub fn velocity_of_water(&self, t: T) -> Vector2<T> {
        let mut velocity = Vector2::ZERO;
        for wave in &self.water {
            velocity = velocity + wave.shifted(t).cosine;
        }
        velocity
    }

    /// The force D and the moment over I in water of the velocity w: for a unit mass what it adds
    /// to (ẍ, ÿ, θ̈).
    #[inline(always)]
    pub fn at(&self, water: Vector2<T>, state: &State<T>) -> [T; 3] {
        let Vector2 { x: u, y: v } = water - state.velocity();
        let speed = (u * u + v * v + T::from_f64(STANDSTILL).squared()).sqrt();
        let factor = self.linear + self.quadratic * speed;
        [factor * u, factor * v, -(self.turning * state.vtheta)]
    }
}

/// The Taylor series of D along a motion, whose coefficients follow from those of the velocity.
#[derive(Clone, Debug, Default)]
pub(crate) struct DragSeries<T: Real> {
    /// The two components of u, its speed |u|, and an unused zero.
    relative: VectorSeries<T, 4>,
    /// |u| twice, once for each component of u.
    speed: VectorSeries<T, 4>,
    /// 1/2s₀.
    half_per_speed: T,
}

impl<T: Real> DragSeries<T> {
    /// The series for a body at rest in water of the velocity w; the body's velocity is subtracted
    /// later.
    #[inline(always)]
    pub(crate) fn begin(&mut self, [along, up]: &[Polynomial<T>; 2]) {
        for k in 0..=ORDER {
            self.relative[k] = [along[k], up[k], T::ZERO, T::ZERO];
            self.speed[k] = [T::ZERO; 4];
        }
    }

    /// The k-th coefficient of D, from that of the body's velocity; S = |u|² + δ² gives s = |u| by
    /// 2 s₀ s_k = S_k − Σ s_j s_{k−j}, 0 < j < k. As long as s_k is not known it is zero, so that
    /// the full product gives this sum, and the product of s and u lacks s_k u₀.
    #[inline(always)]
    pub(crate) fn extend(&mut self, drag: &Drag<T>, [vx, vy]: [T; 2], k: usize) -> [T; 2] {
        let [u, v, ..] = self.relative[k];
        let [u, v] = [u - vx, v - vy];
        self.relative[k] = [u, v, T::ZERO, T::ZERO];
        let relative = &self.relative;
        let [[uu, vv, known, _], [su, sv, ..]] =
            convolve([(relative, relative), (&self.speed, relative)], k);
        let speed = if k == 0 {
            let speed = (uu + vv + T::from_f64(STANDSTILL).squared()).sqrt();
            self.half_per_speed = T::from_f64(0.5) / speed;
            speed
        } else {
            (uu + vv - known) * self.half_per_speed
        };
        self.relative[k][2] = speed;
        self.speed[k] = [speed, speed, T::ZERO, T::ZERO];
        let [first, other, ..] = self.relative[0];
        [
            drag.linear * u + drag.quadratic * speed.mul_add(first, su),
            drag.linear * v + drag.quadratic * speed.mul_add(other, sv),
        ]
    }
}
