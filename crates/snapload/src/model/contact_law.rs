//! The law of contact: the normal velocity of a cable after it snaps taut.
//!
//! The general loop, the flights of two cables side by side, and the derivatives of an impact all
//! use it. The law is a struct that its users destructure: if a number is added to it, the compiler
//! reports every place that has to pass it on.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::real::Real;

/// Newton's law of restitution, v⁺ = −e v⁻ of the normal velocity (docs/model.md section 5).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactLaw<L> {
    /// Coefficient of restitution e, 0 ≤ e ≤ 1.
    pub(crate) restitution: L,
}

/// The result of a snap of a single closing cable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Snap<L> {
    /// Impulse p \[m L/T\].
    pub(crate) impulse: L,
    /// Normal velocity after, v⁺ ≤ 0 \[L/T\].
    pub(crate) v_after: L,
}

impl<L: Lane> ContactLaw<L> {
    /// p = (1 + e) v⁻/w and v⁺ = −e v⁻ of a cable that closes at `v_before` > 0, with the inverse
    /// effective mass w = G M⁻¹ Gᵀ.
    #[inline(always)]
    pub(crate) fn snap(self, v_before: L, w: L) -> Snap<L> {
        let e = self.restitution;
        Snap {
            impulse: e.mul_add(v_before, v_before) / w,
            v_after: -e * v_before,
        }
    }

    /// The derivative of the impulse of [`ContactLaw::snap`], δp = (1 + e) (δv⁻/w − v⁻ δw/w²).
    #[inline(always)]
    pub(crate) fn snap_slope(self, [v_before, w]: [L; 2], [dv, dw]: [L; 2]) -> L {
        self.impulse_per_velocity(w) * (dv - v_before * dw / w)
    }

    /// ∂p/∂v⁻ = (1 + e)/w.
    #[inline(always)]
    pub(crate) fn impulse_per_velocity(self, w: L) -> L {
        (self.restitution + 1.0) / w
    }
}

impl<L: Copy> ContactLaw<L> {
    /// A function of each number and the other law's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        self,
        other: ContactLaw<M>,
        number: impl Fn(L, M) -> U,
    ) -> ContactLaw<U> {
        ContactLaw {
            restitution: number(self.restitution, other.restitution),
        }
    }
}

impl<T: Real> ContactLaw<T> {
    /// The part of an impulse that stops the closing velocity, p/(1 + e); the rest is the rebound.
    pub(crate) fn without_rebound(self, impulse: T) -> T {
        impulse / (T::ONE + self.restitution)
    }

    /// The law for any normal velocity, as one of several cables: v⁺ = −e max(v⁻, 0).
    #[inline(always)]
    pub(crate) fn velocity_after(self, v_before: T) -> T {
        -self.restitution * v_before.max(T::ZERO)
    }

    /// v⁻ − v⁺, the change of the normal velocity that the impulses have to produce: the load of
    /// the complementarity problem. It is rounded as a sum of its two terms, so that a symmetry of
    /// several cables is kept.
    #[inline(always)]
    pub(crate) fn load(self, v_before: T) -> T {
        v_before + self.restitution * v_before.max(T::ZERO)
    }

    /// The duration of a series of bounces that begins with a snap at `v_before`, if the cable is
    /// pressed closed with the normal acceleration α > 0 in between: Σ 2 eᵏ v⁻/α, k ≥ 1. None if it
    /// does not converge.
    #[inline(always)]
    pub(crate) fn time_of_bounces(self, v_before: T, alpha: T) -> Option<T> {
        let e = self.restitution;
        (e < T::ONE).then(|| e * v_before * 2.0 / ((T::ONE - e) * alpha))
    }

    /// Whether no impact under this law can gain energy.
    pub(crate) fn is_passive(self) -> bool {
        T::ZERO <= self.restitution && self.restitution <= T::ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The law for one cable agrees with the law for several, and with its derivative.
    #[test]
    fn one_cable_is_one_of_several() {
        for restitution in [0.0, 0.3, 1.0] {
            let law = ContactLaw { restitution };
            let (v, w, h) = (0.7, 1.9, 1e-6);
            let Snap { impulse, v_after } = law.snap(v, w);
            assert!((impulse - law.load(v) / w).abs() < 1e-15);
            assert_eq!(v_after, law.velocity_after(v));
            assert!((v - w * impulse - v_after).abs() < 1e-15);
            // The energy lost, p (v⁻ + v⁺)/2.
            assert!(impulse * (v + v_after) >= 0.0);
            assert_eq!((law.velocity_after(-v), law.load(-v)), (0.0, -v));
            let p = |dv: f64, dw: f64| law.snap(v + dv, w + dw).impulse;
            let difference = (p(0.4 * h, -0.9 * h) - p(-0.4 * h, 0.9 * h)) / (2.0 * h);
            assert!((law.snap_slope([v, w], [0.4, -0.9]) - difference).abs() < 1e-9);
        }
        assert_eq!(
            ContactLaw { restitution: 1.0 }.time_of_bounces(1.0, 1.0),
            None
        );
        let half = ContactLaw { restitution: 0.5 };
        let series: f64 = (1..60).map(|k| 2.0 * 0.5_f64.powi(k) * 0.3 / 0.8).sum();
        let closed = half.time_of_bounces(0.3, 0.8).expect("it converges");
        assert!((closed - series).abs() < 1e-15);
    }
}
