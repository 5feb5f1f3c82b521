//! Waves, seas and the statistics of extremes against textbooks and closed forms; the catalogue of
//! lines against manufacturers' tables.

use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use snapload_structure::{
    Gumbel, IrregularSea, LinearWave, Site, Spectrum, SpectrumShape, components, reduced_variate,
    section, wave_number,
};
use std::f64::consts::PI;

proptest! {
    /// The dispersion relation holds to rounding, from short to very long waves.
    #[test]
    fn dispersion_holds_to_rounding(period in 0.5..500.0f64, depth in 0.5..12_000.0f64) {
        let omega = 2.0 * PI / period;
        let k = wave_number(omega, depth, 9.80665);
        let back = 9.80665 * k * (k * depth).tanh();
        prop_assert!((back / (omega * omega) - 1.0).abs() < 8.0 * f64::EPSILON);
    }

    /// The exponentials against the hyperbolic functions of the textbook, where those do not
    /// overflow.
    #[test]
    fn accelerations_are_the_textbooks(period in 2.0..20.0f64, depth in 2.0..60.0f64, part in 0.0..1.0f64) {
        let site = Site { depth_m: depth, water_density_kg_m3: 1025.0, current_m_s: 0.0, gravity_m_s2: 9.80665 };
        let (omega, z) = (2.0 * PI / period, -part * depth);
        let wave = LinearWave::new(&site, 0.7, omega, z);
        let k = wave.wave_number_1_m;
        let scale = omega * omega * 0.7 / (k * depth).sinh();
        prop_assert!((wave.a_x_m_s2 - scale * (k * (z + depth)).cosh()).abs() < 1e-12 * scale * (k * depth).cosh());
        prop_assert!((wave.a_z_m_s2 - scale * (k * (z + depth)).sinh()).abs() < 1e-12 * scale * (k * depth).cosh());
    }
}

fn sea(shape: SpectrumShape, seed: u64) -> IrregularSea {
    IrregularSea {
        shape,
        significant_height_m: 3.0,
        peak_period_s: 9.0,
        seed,
        components: 200,
    }
}

/// The published normalisations of JONSWAP: 1 − 0.287 ln γ (DNV) and that of Goda (1988), which is
/// good to 1 %.
#[test]
fn normalisation_is_the_published_one() {
    for gamma in [1.0, 2.0, 3.3, 5.0] {
        let spectrum = Spectrum::new(&sea(SpectrumShape::Jonswap(gamma), 1));
        // At the peak S = factor · (5/16) Hs² ω_p⁻¹ exp(−5/4) γ.
        let peak = 2.0 * PI / 9.0;
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

/// Of Pierson-Moskowitz the zero-crossing period is T_p (5π/4)^(−1/4) in closed form: m0 and m2 are
/// gamma functions.
#[test]
fn zero_crossing_period_is_the_closed_form() {
    let spectrum = Spectrum::new(&sea(SpectrumShape::PiersonMoskowitz, 1));
    let period = 2.0 * PI * (spectrum.moment(0) / spectrum.moment(2)).sqrt();
    // In s-units m0 = 1/5 and m2 = sqrt(π/20), less the tails above s = 5: ∫ s⁻⁵ = 1/2500 and ∫ s⁻³
    // = 1/50.
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

/// A record of three hours does not repeat: its autocorrelation ρ(τ) = ∑ A² cos ωτ / ∑ A² stays
/// within the range that 200 random phases give.
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

/// Samples drawn from a known Gumbel distribution: the fit is right on average, and its scatter is
/// the standard error that it reports.
#[test]
fn fit_of_synthetic_data_is_right_and_knows_its_error() {
    let (location, scale, count, samples) = (40.0, 7.0, 100, 4000);
    let mut generator = ChaCha8Rng::seed_from_u64(3);
    let mut draw = || {
        let uniform = ((generator.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
        location + scale * reduced_variate(uniform)
    };
    let fits: Vec<Gumbel> = (0..samples)
        .map(|_| Gumbel::fit(&(0..count).map(|_| draw()).collect::<Vec<_>>()).unwrap())
        .collect();
    let known = Gumbel {
        location,
        scale,
        count,
        log_times: 0.0,
    };
    // For as many values as are in a sample, for six times as many, and for a quarter.
    for (p, times) in [0.1, 0.5, 0.9, 0.99]
        .into_iter()
        .flat_map(|p| [(p, 1.0), (p, 6.0), (p, 0.25)])
    {
        let over = |fit: &Gumbel| fit.over_times(times);
        let values: Vec<f64> = fits.iter().map(|fit| over(fit).quantile(p).value).collect();
        let mean = values.iter().sum::<f64>() / f64::from(samples);
        let spread =
            (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(samples)).sqrt();
        let expected = over(&known).quantile(p);
        // The mean of 4000 fits is known to error/63, their spread to 1.2 %.
        assert!(
            (mean - expected.value).abs() < 5.0 * expected.error / 63.0,
            "{p}: {mean} {expected:?}"
        );
        assert!(
            (spread / expected.error - 1.0).abs() < 0.05,
            "{p}: {spread} {expected:?}"
        );
    }
}

#[test]
fn largest_of_eight_samples_is_one_over_eight_times_the_time() {
    let one = Gumbel {
        location: 3.0,
        scale: 0.5,
        count: 10,
        log_times: 0.0,
    };
    let eight = one.over_times(8.0);
    // P_8(x) = P_1(x)^8.
    let x = one.quantile(0.9).value;
    assert!((eight.quantile(0.9_f64.powi(8)).value - x).abs() < 1e-12);
}

#[test]
fn too_little_is_not_fitted() {
    assert_eq!(Gumbel::fit(&[1.0, 2.0]), None);
    assert_eq!(Gumbel::fit(&[2.0; 9]), None);
}

/// Breaking loads from a manufacturer's table of offshore mooring chain, in kN, rounded there to 1
/// kN.
#[test]
fn chains_break_at_their_makers_loads() {
    let table = [
        (0.038, [1319.0, 1473.0, 1621.0]),
        (0.050, [2230.0, 2490.0, 2740.0]),
        (0.066, [3762.0, 4200.0, 4622.0]),
    ];
    for (diameter, loads) in table {
        for (grade, load) in ["R3", "R3S", "R4"].into_iter().zip(loads) {
            let ours = section("studless chain", diameter, Some(grade))
                .unwrap()
                .breaking_load_n
                / 1e3;
            assert!(
                (ours - load).abs() < 1.0,
                "{grade} {diameter}: {ours} {load}"
            );
        }
    }
}

#[test]
fn every_type_has_a_section_and_nothing_else_has() {
    const TYPES: [&str; 6] = [
        "studless chain",
        "stud chain",
        "wire rope, fibre core",
        "wire rope, steel core",
        "polyester",
        "nylon",
    ];
    assert!(
        TYPES
            .into_iter()
            .all(|kind| section(kind, 0.05, None).is_some())
    );
    assert_eq!(section("spaghetti", 0.05, None), None);
}

/// A record of three hours has the moments of its spectrum, and its crests are Rayleigh
/// distributed, P(crest > c) = exp(−8 (c/Hs)²), which holds approximately for long waves of many
/// lengths.
#[test]
fn a_record_has_the_moments_and_crests_of_its_sea() {
    let (mut square, mut slope, mut crests) = (0.0, 0.0, Vec::new());
    let (step, count, seeds) = (0.25, 43_200, 8);
    let spectrum = Spectrum::new(&sea(SpectrumShape::Jonswap(3.3), 1));
    for seed in 1..=seeds {
        let parts = components(&sea(SpectrumShape::Jonswap(3.3), seed));
        // The phase of each component changes by the same angle in each step.
        let mut turning: Vec<[f64; 4]> = parts
            .iter()
            .map(|part| {
                let (sine, cosine) = part.phase_rad.sin_cos();
                let (s, c) = (part.omega_rad_s * step).sin_cos();
                [part.amplitude_m * sine, part.amplitude_m * cosine, s, c]
            })
            .collect();
        let (mut before, mut crest) = (0.0_f64, 0.0_f64);
        for _ in 0..count {
            let (mut height, mut rate) = (0.0, 0.0);
            for (wave, part) in turning.iter_mut().zip(&parts) {
                let [sine, cosine, s, c] = *wave;
                height += sine;
                rate += part.omega_rad_s * cosine;
                *wave = [sine * c + cosine * s, cosine * c - sine * s, s, c];
            }
            square += height * height;
            slope += rate * rate;
            if before > 0.0 && height <= 0.0 {
                crests.push(crest);
                crest = 0.0;
            }
            (before, crest) = (height, crest.max(height));
        }
    }
    let looks = (count * seeds as usize) as f64;
    let [m0, m2] = [square / looks, slope / looks];
    assert!((4.0 * m0.sqrt() / 3.0 - 1.0).abs() < 0.01, "{m0}");
    assert!((m2 / spectrum.moment(2) - 1.0).abs() < 0.03, "{m2}");
    for part in [0.3_f64, 0.5, 0.7] {
        let above = crests.iter().filter(|crest| **crest > part * 3.0).count();
        let found = above as f64 / crests.len() as f64;
        let known = (-8.0 * part * part).exp();
        assert!((found - known).abs() < 0.02, "{part}: {found} {known}");
    }
}
