//! Linear (Airy) waves over a flat floor: dispersion, and how the water accelerates.
//!
//! Source: R. G. Dean and R. A. Dalrymple, *Water Wave Mechanics for Engineers and Scientists*
//! (1991), chapter 3.

use crate::structure::Site;

/// One sinusoidal wave at the place of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearWave {
    /// Angular frequency ω \[rad/s\].
    pub omega_rad_s: f64,
    /// Wave number k \[1/m\].
    pub wave_number_1_m: f64,
    /// Amplitude of the surface A \[m\].
    pub amplitude_m: f64,
    /// Phase ε at the place of the body, where the surface is A sin(ωt + ε) \[rad\].
    pub phase_rad: f64,
    /// Amplitude of the water's horizontal acceleration at the depth of the body \[m/s²\].
    pub a_x_m_s2: f64,
    /// Amplitude of its vertical acceleration \[m/s²\].
    pub a_z_m_s2: f64,
}

impl LinearWave {
    /// Of phase 0, an amplitude and a frequency ω > 0, at the level `z_m` < 0:
    ///
    /// ```text
    /// a_x = ω² A cosh k(z + d)/sinh kd,    a_z = ω² A sinh k(z + d)/sinh kd
    /// ```
    ///
    /// which is docs/model.md section 10 with A = H/2. Written with decaying exponentials, so that
    /// neither short waves nor deep water overflow.
    pub fn new(site: &Site, amplitude_m: f64, omega_rad_s: f64, z_m: f64) -> Self {
        let k = wave_number(omega_rad_s, site.depth_m, site.gravity_m_s2);
        let depth = site.depth_m;
        let floor = 1.0 - (-2.0 * k * depth).exp();
        let mirrored = (-2.0 * k * (z_m + depth)).exp();
        let scale = omega_rad_s * omega_rad_s * amplitude_m * (k * z_m).exp() / floor;
        Self {
            omega_rad_s,
            wave_number_1_m: k,
            amplitude_m,
            phase_rad: 0.0,
            a_x_m_s2: scale * (1.0 + mirrored),
            a_z_m_s2: scale * (1.0 - mirrored),
        }
    }

    /// Wave length λ = 2π/k \[m\].
    pub fn length_m(&self) -> f64 {
        2.0 * std::f64::consts::PI / self.wave_number_1_m
    }
}

/// The wave number k > 0 \[1/m\] with ω² = g k tanh kd, to rounding.
///
/// Newton's method on q tanh q = ω²d/g =: c for q = kd, from the larger of the limits of shallow
/// water, q = sqrt(c), and of deep water, q = c; a dozen steps reach the rounding from any depth.
pub fn wave_number(omega_rad_s: f64, depth_m: f64, gravity_m_s2: f64) -> f64 {
    let c = omega_rad_s * omega_rad_s * depth_m / gravity_m_s2;
    let mut q = c.sqrt().max(c);
    for _ in 0..40 {
        let tanh = q.tanh();
        let residual = q * tanh - c;
        let slope = tanh + q * (1.0 - tanh * tanh);
        let before = q;
        q -= residual / slope;
        if (q - before).abs() <= f64::EPSILON * before {
            break;
        }
    }
    q / depth_m
}
