//! Forces that depend on time alone: a constant one and a sum of sinusoids.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;

/// One frequency of the forcing: f(t) = c cos Ωt + d sin Ωt, with c and d vectors, so that any
/// amplitudes and phases in x and y are covered.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Harmonic<T = f64> {
    /// Angular frequency Ω \[1/T\]; of either sign, or 0.
    pub omega: T,
    /// c, the force in phase with cos Ωt \[F\].
    pub cosine: Vector2<T>,
    /// d, the force in phase with sin Ωt \[F\].
    pub sine: Vector2<T>,
}

impl<L: Lane> Harmonic<L> {
    /// The same force seen from t0: f(t0 + s) = c' cos Ωs + d' sin Ωs.
    #[inline(always)]
    pub fn shifted(&self, t0: L) -> Self {
        let (s, c) = (self.omega * t0).sin_cos();
        Self {
            omega: self.omega,
            cosine: Vector2::combined(c, self.cosine, s, self.sine),
            sine: Vector2::combined(c, self.sine, -s, self.cosine),
        }
    }
}

/// The forces on the body, except those of the cables.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Forcing<T = f64> {
    /// A constant force, which includes the weight (net buoyancy) \[F\].
    pub constant: Vector2<T>,
    /// The sinusoids.
    pub harmonics: Vec<Harmonic<T>>,
}

impl<L: Copy> Harmonic<L> {
    /// A function of each number and the other harmonic's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &Harmonic<M>,
        number: impl Fn(L, M) -> U + Copy,
    ) -> Harmonic<U> {
        Harmonic {
            omega: number(self.omega, other.omega),
            cosine: self.cosine.zip_with(other.cosine, number),
            sine: self.sine.zip_with(other.sine, number),
        }
    }
}

impl<T: Real> Harmonic<T> {
    /// The same in another arithmetic.
    pub(crate) fn map<U>(&self, number: impl Fn(T) -> U + Copy) -> Harmonic<U> {
        Harmonic {
            omega: number(self.omega),
            cosine: self.cosine.map(number),
            sine: self.sine.map(number),
        }
    }

    /// Adds its Taylor series about time `t`: the k-th derivative turns (c, d) into Ω (d, −c).
    #[inline(always)]
    pub(crate) fn expand(&self, t: T, into: &mut [Polynomial<T>; 2]) {
        let local = self.shifted(t);
        let (mut c, mut d) = (local.cosine, local.sine);
        let [x, y] = into;
        for k in 0..=ORDER {
            let factor = self.omega / (k + 1) as f64;
            (x[k], y[k]) = (x[k] + c.x, y[k] + c.y);
            (c, d) = (d.scaled(factor), c.map(|c| -c * factor));
        }
    }

    /// The elliptical forcing f_x = f_o cos Ωt, f_y = ν f_o sin Ωt (docs/model.md section 3).
    pub fn ellipse(f_o: T, nu: T, omega: T) -> Self {
        Self {
            omega,
            cosine: [f_o, T::ZERO].into(),
            sine: [T::ZERO, nu * f_o].into(),
        }
    }

    /// f_x = A_x cos(Ωt + φ_x), f_y = A_y cos(Ωt + φ_y).
    pub fn with_phases(omega: T, amplitude: [T; 2], phase: [T; 2]) -> Self {
        let (sx, cx) = phase[0].sin_cos();
        let (sy, cy) = phase[1].sin_cos();
        Self {
            omega,
            cosine: [amplitude[0] * cx, amplitude[1] * cy].into(),
            sine: [-amplitude[0] * sx, -amplitude[1] * sy].into(),
        }
    }

    /// The largest |f(t)|: the larger half-axis of the ellipse that the force describes, which is
    /// the sum of two circular motions in opposite directions.
    pub fn amplitude(&self) -> T {
        let (c, d) = (self.cosine, self.sine);
        let forward = Vector2::from([c.x + d.y, c.y - d.x]).length();
        let backward = Vector2::from([c.x - d.y, c.y + d.x]).length();
        (forward + backward) * 0.5
    }

    /// The largest |f_y(t)|.
    pub fn amplitude_y(&self) -> T {
        (self.cosine.y.squared() + self.sine.y.squared()).sqrt()
    }
}

/// The effect of a force on a free unit mass over a time s: the drift of position ∫₀ˢ (s − σ) f dσ,
/// the gain of velocity ∫₀ˢ f dσ, and the force and its rate at s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push<T> {
    pub(crate) drift: Vector2<T>,
    pub(crate) gain: Vector2<T>,
    pub(crate) force: Vector2<T>,
    /// ḟ.
    pub(crate) rate: Vector2<T>,
}

impl<L: Lane> Push<L> {
    /// The effect of a constant force.
    #[inline(always)]
    pub(crate) fn constant(force: Vector2<L>, s: L) -> Self {
        Self {
            drift: force.scaled(s * s * 0.5),
            gain: force.scaled(s),
            force,
            rate: Vector2::ZERO,
        }
    }

    /// Drift and gain a little later, to the third order, where `second` is f̈.
    #[inline(always)]
    pub(crate) fn later(&self, s: L, second: Vector2<L>) -> [Vector2<L>; 2] {
        let (force, rate) = (self.force, self.rate.scaled(s));
        let half = L::from_f64(0.5);
        let drift = force.scaled(half).plus_scaled(rate, L::sixth());
        let gain = force.plus_scaled(rate, half);
        let gain = gain.plus_scaled(second, s * s * L::sixth());
        [
            self.drift.plus_scaled(self.gain.plus_scaled(drift, s), s),
            self.gain.plus_scaled(gain, s),
        ]
    }

    /// The same with the effect of a harmonic added, which must be given relative to s = 0
    /// ([`Harmonic::shifted`]).
    ///
    /// It is the slack flight of docs/model.md section 4 in a form that does not cancel at Ω = 0 or
    /// small |Ω|s: with z = Ωs, C = (1 − cos z)/z² and S = (z − sin z)/z², the drift is s² (c C + d
    /// S),
    /// the gain s (c (1 − z S) + d z C), the force c cos z + d sin z with cos z = 1 − z² C, sin z =
    /// z − z² S, and its rate Ω (d cos z − c sin z).
    #[inline(always)]
    pub(crate) fn with_harmonic(self, harmonic: &Harmonic<L>, s: L) -> Self {
        apart!(L, {
            let z = harmonic.omega * s;
            let (even, odd) = z.versines();
            let (c, d) = (harmonic.cosine, harmonic.sine);
            let drift = Vector2::combined(even, c, odd, d);
            let gain = Vector2::combined((-z).mul_add(odd, L::ONE), c, z * even, d);
            let square = -(z * z);
            let (sine, cosine) = (square.mul_add(odd, z), square.mul_add(even, L::ONE));
            let force = Vector2::combined(cosine, c, sine, d);
            let rate = Vector2::combined(cosine, d, -sine, c);
            Self {
                drift: self.drift.plus_scaled(drift, s * s),
                gain: self.gain.plus_scaled(gain, s),
                force: self.force + force,
                rate: self.rate.plus_scaled(rate, harmonic.omega),
            }
        })
    }
}

impl<T: Real> Forcing<T> {
    /// The same forces in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Forcing<U> {
        Forcing {
            constant: self.constant.map(number),
            harmonics: self.harmonics.iter().map(|wave| wave.map(number)).collect(),
        }
    }

    /// The force at time t.
    #[inline(always)]
    pub fn at(&self, t: T) -> Vector2<T> {
        let mut force = self.constant;
        for harmonic in &self.harmonics {
            force = force + harmonic.shifted(t).cosine;
        }
        force
    }

    /// Bounds on |dⁿf/dtⁿ| over all time, for n = 0, 1, 2.
    pub fn bounds(&self) -> [T; 3] {
        let mut bounds = [self.constant.length(), T::ZERO, T::ZERO];
        for harmonic in &self.harmonics {
            let mut amplitude = harmonic.amplitude();
            for bound in &mut bounds {
                *bound += amplitude;
                amplitude = amplitude * harmonic.omega.abs();
            }
        }
        bounds
    }

    /// Bound on ÿ of the free body of unit mass: the largest upward force.
    pub fn upward_acceleration_bound(&self) -> T {
        self.harmonics
            .iter()
            .fold(self.constant.y, |sum, h| sum + h.amplitude_y())
    }

    /// Bound on |ÿ| of the free body of unit mass: the largest |f_y|.
    pub fn vertical_acceleration_bound(&self) -> T {
        let upward = self.upward_acceleration_bound();
        let downward = self.constant.y - (upward - self.constant.y);
        upward.abs().max(downward.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slack flight as docs/model.md section 4 prints it, where it does not cancel.
    #[test]
    fn push_is_the_printed_closed_form() {
        let (f_o, nu, omega, t0): (f64, f64, f64, f64) = (0.3, 0.5, 0.9, 1.7);
        let harmonic = Harmonic::ellipse(f_o, nu, omega).shifted(t0);
        for tau in [0.01, 0.5, 2.0, 9.0] {
            let t = t0 + tau;
            let x = -(f_o / omega) * (omega * t0).sin() * tau
                + f_o / omega.powi(2) * ((omega * t0).cos() - (omega * t).cos());
            let y = (nu * f_o / omega) * (omega * t0).cos() * tau
                + nu * f_o / omega.powi(2) * ((omega * t0).sin() - (omega * t).sin());
            let push = Push::constant(Vector2::ZERO, tau).with_harmonic(&harmonic, tau);
            assert!((push.drift.x - x).abs() < 2e-15, "{tau}");
            assert!((push.drift.y - y).abs() < 2e-15, "{tau}");
            let vx = f_o / omega * ((omega * t).sin() - (omega * t0).sin());
            assert!((push.gain.x - vx).abs() < 1e-15);
            assert!((push.force.y - nu * f_o * (omega * t).sin()).abs() < 1e-15);
        }
    }

    #[test]
    fn slow_forcing_tends_to_a_constant_force() {
        let slow = Harmonic::ellipse(0.3, 0.5, 1e-6);
        let push = Push::constant(Vector2::ZERO, 2.0).with_harmonic(&slow, 2.0);
        // f_x ≈ 0.3 and f_y ≈ 0.15 Ωt: 0.6 and 0.15 Ω s³/6, up to (Ωs)² relative.
        assert!((push.drift.x - 0.6).abs() < 1e-12);
        assert!((push.drift.y / (0.15e-6 * 8.0 / 6.0) - 1.0).abs() < 1e-11);
        let still = Harmonic::ellipse(0.3, 0.5, 0.0);
        let push = Push::constant(Vector2::ZERO, 2.0).with_harmonic(&still, 2.0);
        assert_eq!(push.drift, [0.6, 0.0].into());
    }

    #[test]
    fn bounds_are_reached_and_never_passed() {
        let forcing = Forcing {
            constant: Vector2::ZERO,
            harmonics: vec![Harmonic::with_phases(1.3, [0.4, 0.7], [0.3, 1.1])],
        };
        let bound = forcing.bounds()[0];
        let largest = (0..100_000)
            .map(|k| forcing.at(k as f64 * 1e-4).length())
            .fold(0.0, f64::max);
        assert!(largest <= bound && largest > bound - 1e-8);
    }
}
