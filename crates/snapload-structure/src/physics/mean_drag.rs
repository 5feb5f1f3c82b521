//! The quadratic drag as a damping of small motions in moving water.
//!
//! The drag on a body of velocity v in water of velocity w is D |w − v| (w − v). Its mean over a
//! normal distribution of w decreases with a small v by
//!
//! ```text
//! D E(|w| + w_x²/|w|) v_x,    D E(|w| + w_y²/|w|) v_y
//! ```
//!
//! which is also the linear drag that differs from it by the least mean square (T. S. Atalik and S.
//! Utku, *Earthq. Eng. Struct. Dyn.* 4 (1976) 411). The mean of w is the current U, along x. In a
//! current alone these are 2 D |U| along it and D |U| across.

use super::model::CURRENT;
use snapload::{Drag, Vector2};
use std::f64::consts::PI;

/// The distribution is summed over so many radii, up to this many standard deviations, and angles.
const RADII: usize = 160;
const FARTHEST: f64 = 8.0;
const ANGLES: usize = 64;

/// What the quadratic drag adds to the damping of a small motion along x and along y, in the
/// engine's units.
pub(super) fn damping_by_drag(drag: &Drag) -> [f64; 2] {
    let mut current = 0.0;
    let mut variance = [0.0; 2];
    for water in &drag.water {
        let Vector2 { x: cosine, y: up } = water.cosine;
        if water.omega == CURRENT {
            current += cosine;
        } else {
            variance[0] += 0.5 * (cosine.powi(2) + water.sine.x.powi(2));
            variance[1] += 0.5 * (up.powi(2) + water.sine.y.powi(2));
        }
    }
    mean_slopes(current, variance.map(f64::sqrt)).map(|slope| drag.quadratic * slope)
}

/// E(|w| + w_x²/|w|) and E(|w| + w_y²/|w|) for w = (U + σ_x r cos φ, σ_y r sin φ), with r
/// distributed as r exp(−r²/2) and φ evenly.
fn mean_slopes(current: f64, sigma: [f64; 2]) -> [f64; 2] {
    let (mut sums, mut weights) = ([0.0; 2], 0.0);
    for i in 0..RADII {
        let r = FARTHEST * (i as f64 + 0.5) / RADII as f64;
        let weight = r * (-0.5 * r * r).exp();
        for j in 0..ANGLES {
            // The other half circle has the same values.
            let (sine, cosine) = (PI * (j as f64 + 0.5) / ANGLES as f64).sin_cos();
            let w = [current + sigma[0] * r * cosine, sigma[1] * r * sine];
            let speed = w[0].hypot(w[1]);
            weights += weight;
            if speed > 0.0 {
                sums = [0, 1].map(|k| sums[k] + weight * (speed + w[k] * w[k] / speed));
            }
        }
    }
    sums.map(|sum| sum / weights)
}

#[cfg(test)]
mod tests {
    use super::mean_slopes;
    use std::f64::consts::PI;

    fn check(current: f64, sigma: [f64; 2], expected: [f64; 2]) {
        let found = mean_slopes(current, sigma);
        for (found, expected) in found.into_iter().zip(expected) {
            let error = (found - expected).abs();
            assert!(
                error <= 1e-3 * expected,
                "{current} {sigma:?}: {found} {expected}"
            );
        }
    }

    /// |U| U has the derivative 2 |U| along the current, and a small motion across it turns |U|.
    #[test]
    fn a_current_alone_damps_twice_as_much_along_as_across() {
        check(1.5, [0.0; 2], [3.0, 1.5]);
        check(-0.3, [1e-9; 2], [0.6, 0.3]);
        assert_eq!(mean_slopes(0.0, [0.0; 2]), [0.0; 2]);
    }

    /// Water that moves along x only, of mean U and standard deviation σ: E 2|w| along x and E |w|
    /// across, where E |w| = σ sqrt(2/π) exp(−U²/2σ²) + U erf(U/(σ sqrt 2)). The parts of a normal
    /// distribution within one and two standard deviations are erf(1/sqrt 2) and erf(sqrt 2).
    #[test]
    fn a_current_adds_to_waves_as_in_the_closed_form() {
        let sigma = 0.4;
        for (ratio, within) in [
            (0.0, 0.0),
            (1.0, 0.682_689_492_137),
            (2.0, 0.954_499_736_104),
        ] {
            let density = (2.0 / PI).sqrt() * f64::exp(-0.5 * ratio * ratio);
            let speed = sigma * (density + ratio * within);
            check(ratio * sigma, [sigma, 0.0], [2.0 * speed, speed]);
        }
    }

    /// In circular orbits E |w| = σ sqrt(π/2) and E w_x²/|w| = E w_y²/|w| is half of that. With a
    /// current of σ the length has Rice's distribution, E |w| = σ sqrt(π/2) exp(−1/4) (3 I₀ + I₁)/2
    /// with the Bessel functions at 1/4, and both slopes together are 3 E |w|.
    #[test]
    fn circular_orbits_damp_in_all_directions() {
        let mean = (PI / 2.0).sqrt();
        check(0.0, [1.0, 1.0], [1.5 * mean; 2]);
        let bessel = [1.015_686_141_2, 0.125_979_109_3];
        let mean = mean * f64::exp(-0.25) * (3.0 * bessel[0] + bessel[1]) / 2.0;
        let [along, across] = mean_slopes(1.0, [1.0, 1.0]);
        assert!(((along + across) / (3.0 * mean) - 1.0).abs() < 1e-3);
        assert!(along > across);
    }
}
