//! Irregular seas: a spectrum, and the sinusoids that represent it.

use crate::structure::{IrregularSea, SpectrumShape};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// The band of frequencies that is kept, in units of the peak frequency. Above it lie 0.2 % of a
/// Pierson-Moskowitz spectrum's m0 and less of a JONSWAP spectrum's; below it nothing.
const BAND: [f64; 2] = [0.4, 5.0];
/// Equal steps of the band in which the spectrum is integrated.
const STEPS: usize = 4600;

/// The variance density of the surface S(ω) with m0 = Hs²/16.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    shape: SpectrumShape,
    peak_rad_s: f64,
    scale: f64,
}

/// One sinusoid of a sea: η(t) = A sin(ωt + ε) at the place of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// ω \[rad/s\].
    pub omega_rad_s: f64,
    /// A \[m\].
    pub amplitude_m: f64,
    /// ε \[rad\].
    pub phase_rad: f64,
}

impl Spectrum {
    /// The spectrum of a sea, scaled so that its m0 over the band that is kept is Hs²/16.
    pub fn new(sea: &IrregularSea) -> Self {
        let mut spectrum = Self {
            shape: sea.shape,
            peak_rad_s: 2.0 * PI / sea.peak_period_s,
            scale: 1.0,
        };
        let raw = spectrum.moment(0);
        spectrum.scale = sea.significant_height_m * sea.significant_height_m / 16.0 / raw;
        spectrum
    }

    /// S(ω) \[m² s/rad\], with s = ω/ω_p:
    ///
    /// ```text
    /// S ∝ s⁻⁵ exp(−5/4 s⁻⁴) γ^exp(−(s − 1)²/(2σ²)),    σ = 0.07 for s ≤ 1, else 0.09
    /// ```
    ///
    /// without the last factor for Pierson-Moskowitz. Sources: W. J. Pierson and L. Moskowitz, *J.
    /// Geophys. Res.* 69 (1964) 5181; K. Hasselmann et al., *Dt. Hydrogr. Z.* A8 no. 12 (1973).
    pub fn density(&self, omega_rad_s: f64) -> f64 {
        let s = omega_rad_s / self.peak_rad_s;
        let base = s.powi(-5) * (-1.25 * s.powi(-4)).exp();
        let peak = match self.shape {
            SpectrumShape::PiersonMoskowitz => 1.0,
            SpectrumShape::Jonswap(gamma) => {
                let width: f64 = if s <= 1.0 { 0.07 } else { 0.09 };
                gamma.powf((-(s - 1.0).powi(2) / (2.0 * width * width)).exp())
            }
        };
        self.scale * base * peak
    }

    /// The band of frequencies that is kept \[rad/s\].
    pub fn band_rad_s(&self) -> [f64; 2] {
        BAND.map(|s| s * self.peak_rad_s)
    }

    /// Spectral moment m_n = ∫ ωⁿ S dω over the band, by the trapezoidal rule.
    pub fn moment(&self, n: i32) -> f64 {
        self.integral(|omega| omega.powi(n))
    }

    /// ∫ weight(ω) S dω over the band.
    pub fn integral(&self, weight: impl Fn(f64) -> f64) -> f64 {
        self.cumulative(weight)[STEPS]
    }

    fn frequency(&self, step: usize) -> f64 {
        let [low, high] = self.band_rad_s();
        low + (high - low) * step as f64 / STEPS as f64
    }

    /// The integral from the lower end of the band to each step.
    fn cumulative(&self, weight: impl Fn(f64) -> f64) -> Vec<f64> {
        let width = self.frequency(1) - self.frequency(0);
        let value = |step: usize| {
            let omega = self.frequency(step);
            self.density(omega) * weight(omega)
        };
        let mut sums = Vec::with_capacity(STEPS + 1);
        sums.push(0.0);
        let (mut sum, mut before) = (0.0, value(0));
        for step in 1..=STEPS {
            let now = value(step);
            sum += 0.5 * width * (before + now);
            before = now;
            sums.push(sum);
        }
        sums
    }
}

/// The sinusoids of a sea.
///
/// The spectrum is divided into `components` bins of equal energy, so that every amplitude is
/// sqrt(2 m0/N) and frequencies are dense where the energy is. The frequency of each is drawn
/// within its bin with the energy as its density, its phase uniformly in \[0, 2π): then no
/// frequencies are multiples of one another and the record does not repeat, and every linear
/// response has its variance on average over seeds, ∑ A²R(ω)/2 → ∫ S R dω, for any transfer
/// function R (stratified sampling). Frequencies evenly spaced by Δω, which a Fourier transform
/// needs, would repeat after 2π/Δω. The generator is ChaCha with 8 rounds: the same sea on every
/// platform.
pub fn components(sea: &IrregularSea) -> Vec<Component> {
    let spectrum = Spectrum::new(sea);
    let cumulative = spectrum.cumulative(|_| 1.0);
    let energy = cumulative[STEPS];
    let mut generator = ChaCha8Rng::seed_from_u64(sea.seed);
    let count = sea.components as f64;
    let amplitude_m =
        (2.0 * sea.significant_height_m * sea.significant_height_m / 16.0 / count).sqrt();
    (0..sea.components)
        .map(|bin| {
            let part = (bin as f64 + uniform(&mut generator)) / count;
            let phase_rad = 2.0 * PI * uniform(&mut generator);
            let target = part * energy;
            let step = cumulative
                .partition_point(|sum| *sum <= target)
                .clamp(1, STEPS);
            let (low, high) = (cumulative[step - 1], cumulative[step]);
            let within = if high > low {
                (target - low) / (high - low)
            } else {
                0.5
            };
            let (from, to) = (spectrum.frequency(step - 1), spectrum.frequency(step));
            Component {
                omega_rad_s: from + (to - from) * within,
                amplitude_m,
                phase_rad,
            }
        })
        .collect()
}

/// A random number, uniform in \[0, 1): 53 random bits.
pub(crate) fn uniform(generator: &mut ChaCha8Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}
