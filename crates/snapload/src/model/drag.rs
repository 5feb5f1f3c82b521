//! The resistance of water to a body that moves through it.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{Polynomial, convolve};
use crate::arithmetic::real::Real;
use crate::model::forcing::Harmonic;
use crate::model::state::State;

/// Below this relative speed the quadratic law is rounded off, |u| = sqrt(u² + δ²): |u|u has no
/// Taylor series where u = 0, and this has one. The force is off by at most δ²/2 of its coefficient
/// \[L/T\].
const STANDSTILL: f64 = 1e-5;

/// A force D = c₁ u + c₂ |u| u with the velocity u = w − v of the water relative to the body's
/// centre, the second term being the drag of Morison, O'Brien, Johnson & Schaaf (*Petroleum
/// Transactions AIME* 189 (1950) 149), and a moment −c_θ θ̇. All are per unit mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag<T = f64> {
    /// c₁ \[1/T\].
    pub linear: T,
    /// c₂ \[1/L\].
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

    /// What it adds to (ẍ, ÿ, θ̈) in water of the velocity w.
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
    /// u.
    relative: [Polynomial<T>; 2],
    /// |u|² + δ².
    square: Polynomial<T>,
    /// |u|.
    speed: Polynomial<T>,
}

impl<T: Real> DragSeries<T> {
    /// Of a body that does not move, in water of the velocity w.
    #[inline(always)]
    pub(crate) fn begin(&mut self, water: &[Polynomial<T>; 2]) {
        self.relative = *water;
    }

    /// The k-th coefficient of D, from that of the body's velocity; S = |u|² gives |u| by
    /// 2 s₀ s_k = S_k − Σ s_j s_{k−j}, 0 < j < k.
    #[inline(always)]
    pub(crate) fn extend(&mut self, drag: &Drag<T>, velocity: [T; 2], k: usize) -> [T; 2] {
        for (relative, velocity) in self.relative.iter_mut().zip(velocity) {
            relative[k] -= velocity;
        }
        let [u, v] = &self.relative;
        self.square[k] = convolve(u, u, k) + convolve(v, v, k);
        if k == 0 {
            self.square[0] += T::from_f64(STANDSTILL).squared();
            self.speed[0] = self.square[0].sqrt();
        } else {
            let known = (1..k).fold(self.square[k], |sum, j| {
                sum - self.speed[j] * self.speed[k - j]
            });
            self.speed[k] = known / (self.speed[0] * 2.0);
        }
        [u, v].map(|component| {
            drag.linear * component[k] + drag.quadratic * convolve(&self.speed, component, k)
        })
    }
}
