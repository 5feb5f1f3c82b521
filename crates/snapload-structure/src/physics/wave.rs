//! A single wave at the position of the body.

use crate::structure::Site;
use snapload_hydro::{water_acceleration, wave_number};

/// One sinusoidal wave at the position of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearWave {
    /// Angular frequency ω \[rad/s\].
    pub omega_rad_s: f64,
    /// Wave number k \[1/m\].
    pub wave_number_1_m: f64,
    /// Amplitude of the surface A \[m\].
    pub amplitude_m: f64,
    /// Phase ε at the position of the body, where the surface is A sin(ωt + ε) \[rad\].
    pub phase_rad: f64,
    /// Amplitude of the water's horizontal acceleration at the depth of the body \[m/s²\].
    pub a_x_m_s2: f64,
    /// Amplitude of its vertical acceleration \[m/s²\].
    pub a_z_m_s2: f64,
}

impl LinearWave {
    /// The wave of phase 0, an amplitude and a frequency ω > 0, at the level `z_m` < 0:
    /// the formulas of docs/structures.md, "From SI to the units of the computation", with A = H/2.
    pub fn new(site: &Site, amplitude_m: f64, omega_rad_s: f64, z_m: f64) -> Self {
        let k = wave_number(omega_rad_s, site.depth_m, site.gravity_m_s2);
        let wave = [amplitude_m, omega_rad_s];
        let [a_x_m_s2, a_z_m_s2] = water_acceleration(wave, k, site.depth_m, z_m);
        Self {
            omega_rad_s,
            wave_number_1_m: k,
            amplitude_m,
            phase_rad: 0.0,
            a_x_m_s2,
            a_z_m_s2,
        }
    }

    /// Wave length λ = 2π/k \[m\].
    pub fn length_m(&self) -> f64 {
        2.0 * std::f64::consts::PI / self.wave_number_1_m
    }
}
