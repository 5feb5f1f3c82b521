//! Irregular seas: a spectrum, and the sinusoids that stand for it.

use crate::structure::{IrregularSea, SpectrumShape};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// The band of frequencies that is kept, in peak frequencies. Above it lie 0.2 % of a Pierson-Moskowitz spectrum's
/// m0 and less of a JONSWAP spectrum's; below it nothing.
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
    /// Of a sea, scaled so that its m0 over the band that is kept is Hs²/16.
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
    /// without the last factor for Pierson-Moskowitz. Sources: W. J. Pierson and L. Moskowitz, *J. Geophys. Res.* 69
    /// (1964) 5181; K. Hasselmann et al., *Dt. Hydrogr. Z.* A8 no. 12 (1973).
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
        let cumulative = self.cumulative(weight);
        cumulative[STEPS]
    }

    fn frequency(&self, step: usize) -> f64 {
        let [low, high] = self.band_rad_s();
        low + (high - low) * step as f64 / STEPS as f64
    }

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
/// The spectrum is cut into `components` bins of equal energy, so that every amplitude is sqrt(2 m0/N) and the energy
/// is where the frequencies are dense. The frequency of each is drawn within its bin in proportion to the energy
/// there, its phase evenly in \[0, 2π): then no frequencies are multiples of one another and the record does not
/// repeat, and every linear response keeps its variance on average over seeds, ∑ A²R(ω)/2 → ∫ S R dω, whatever its
/// transfer function R (stratified sampling). Frequencies evenly spaced by Δω, which a Fourier transform wants, would
/// repeat after 2π/Δω. The generator is ChaCha with 8 rounds: the same sea on every platform.
pub fn components(sea: &IrregularSea) -> Vec<Component> {
    let spectrum = Spectrum::new(sea);
    let cumulative = spectrum.cumulative(|_| 1.0);
    let energy = cumulative[STEPS];
    let mut generator = ChaCha8Rng::seed_from_u64(sea.seed);
    // 53 random bits: evenly in [0, 1).
    let mut uniform = || (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let count = sea.components as f64;
    let amplitude_m =
        (2.0 * sea.significant_height_m * sea.significant_height_m / 16.0 / count).sqrt();
    (0..sea.components)
        .map(|bin| {
            let part = (bin as f64 + uniform()) / count;
            let phase_rad = 2.0 * PI * uniform();
            let wanted = part * energy;
            let step = cumulative
                .partition_point(|sum| *sum <= wanted)
                .clamp(1, STEPS);
            let (low, high) = (cumulative[step - 1], cumulative[step]);
            let within = if high > low {
                (wanted - low) / (high - low)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn sea(shape: SpectrumShape, seed: u64) -> IrregularSea {
        IrregularSea {
            shape,
            significant_height_m: 3.0,
            peak_period_s: 9.0,
            seed,
            components: 200,
        }
    }

    /// The published normalisations of JONSWAP: 1 − 0.287 ln γ (DNV) and that of Goda (1988), which is good to 1 %.
    #[test]
    fn normalisation_is_the_published_one() {
        for gamma in [1.0, 2.0, 3.3, 5.0] {
            let spectrum = Spectrum::new(&sea(SpectrumShape::Jonswap(gamma), 1));
            // At the peak S = factor · (5/16) Hs² ω_p⁻¹ exp(−5/4) γ.
            let peak = spectrum.peak_rad_s;
            let plain = 5.0 / 16.0 * 9.0 / peak * (-1.25_f64).exp() * gamma;
            let factor = spectrum.density(peak) / plain;
            let dnv = 1.0 - 0.287 * f64::ln(gamma);
            assert!((factor / dnv - 1.0).abs() < 0.02, "{gamma}: {factor} {dnv}");
            let goda = 0.0624 / (0.230 + 0.0336 * gamma - 0.185 / (1.9 + gamma)) / (5.0 / 16.0);
            assert!(
                (factor / goda - 1.0).abs() < 0.025,
                "{gamma}: {factor} {goda}"
            );
        }
    }

    /// Of Pierson-Moskowitz the zero-crossing period is T_p (5π/4)^(−1/4) in closed form: m0 and m2 are gamma functions.
    #[test]
    fn zero_crossing_period_is_the_closed_form() {
        let spectrum = Spectrum::new(&sea(SpectrumShape::PiersonMoskowitz, 1));
        let period = 2.0 * PI * (spectrum.moment(0) / spectrum.moment(2)).sqrt();
        // In s-units m0 = 1/5 and m2 = sqrt(π/20), less the tails above s = 5: ∫ s⁻⁵ = 1/2500 and ∫ s⁻³ = 1/50.
        let exact = 9.0 * (1.25 * PI).powf(-0.25);
        let (m0, m2) = (0.2_f64, (PI / 20.0).sqrt());
        let cut = ((1.0 - 4e-4 / m0) / (1.0 - 0.02 / m2)).sqrt();
        assert!(
            (period / (exact * cut) - 1.0).abs() < 1e-4,
            "{period} {exact} {cut}"
        );
    }

    #[test]
    fn energy_is_exact_and_every_response_is_right_on_average() {
        let spectrum = Spectrum::new(&sea(SpectrumShape::Jonswap(3.3), 1));
        let weight = |omega: f64| omega.powi(4) * (-3.0 * omega * omega).exp();
        let exact = spectrum.integral(weight);
        let seeds = 400;
        let mut mean = 0.0;
        for seed in 0..seeds {
            let parts = components(&sea(SpectrumShape::Jonswap(3.3), seed));
            let m0: f64 = parts.iter().map(|c| 0.5 * c.amplitude_m.powi(2)).sum();
            assert!((4.0 * m0.sqrt() - 3.0).abs() < 1e-12);
            let one: f64 = parts
                .iter()
                .map(|c| 0.5 * c.amplitude_m.powi(2) * weight(c.omega_rad_s))
                .sum();
            assert!((one / exact - 1.0).abs() < 0.02, "{seed}");
            mean += one / f64::from(seeds as u32);
        }
        assert!((mean / exact - 1.0).abs() < 1e-3, "{mean} {exact}");
    }

    /// In three hours the autocorrelation of the record never comes back: ρ(τ) = ∑ A² cos ωτ / ∑ A² stays within
    /// what 200 random phases give.
    #[test]
    fn record_does_not_repeat() {
        for seed in 1..4 {
            let parts = components(&sea(SpectrumShape::Jonswap(3.3), seed));
            let largest = (0..21_000)
                .map(|k| 300.0 + 0.5 * f64::from(k))
                .map(|lag| {
                    parts
                        .iter()
                        .map(|c| (c.omega_rad_s * lag).cos())
                        .sum::<f64>()
                        / 200.0
                })
                .fold(0.0_f64, |largest, rho| largest.max(rho.abs()));
            assert!(largest < 0.35, "{largest}");
        }
    }

    /// A record's own statistics: m0 from the series and the period from its zero crossings.
    #[test]
    fn series_has_the_spectrums_statistics() {
        let sea = sea(SpectrumShape::Jonswap(3.3), 7);
        let spectrum = Spectrum::new(&sea);
        let parts = components(&sea);
        let step = 0.25;
        let series: Vec<f64> = (0..43_200 * 2)
            .map(|k| f64::from(k) * step)
            .map(|t| {
                parts
                    .iter()
                    .map(|c| c.amplitude_m * (c.omega_rad_s * t + c.phase_rad).sin())
                    .sum()
            })
            .collect();
        let m0 = series.iter().map(|eta| eta * eta).sum::<f64>() / series.len() as f64;
        assert!(
            (4.0 * m0.sqrt() / 3.0 - 1.0).abs() < 0.03,
            "{}",
            4.0 * m0.sqrt()
        );
        let crossings = series
            .windows(2)
            .filter(|pair| pair[0] < 0.0 && pair[1] >= 0.0)
            .count();
        let period = step * series.len() as f64 / crossings as f64;
        let expected = 2.0 * PI * (spectrum.moment(0) / spectrum.moment(2)).sqrt();
        assert!(
            (period / expected - 1.0).abs() < 0.03,
            "{period} {expected}"
        );
    }
}
