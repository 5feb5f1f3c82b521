//! The response of a body without lines to regular waves, and to a sea.

use super::body::Body;
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::Memory;
use crate::spline::Spline;
use nalgebra::{Complex, Matrix3, Vector3};

/// ξ(ω) per metre of wave amplitude, q = Re ξ e^{−iωt}: the phase by which the motion leads
/// the crest over the reference point is −arg ξ.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// +1 for waves to +x, −1 to −x.
    pub direction: f64,
    /// ω \[rad/s\].
    pub omega_rad_s: Vec<f64>,
    /// ξ \[m/m, m/m, rad/m\].
    pub amplitude: Vec<Vector3<Complex<f64>>>,
}

/// ξ = (−ω²(M + A) − iω(B_rad + B) + C)⁻¹ X, by the file's added mass and damping.
///
/// # Errors
/// A [`HydroError`] if the file does not have the direction, or the matrix is singular.
pub fn response_of_the_file(
    hydro: &Hydrodynamics,
    body: &Body,
    direction: f64,
) -> Result<Response, HydroError> {
    let of = |k: usize, _: f64| (hydro.added_mass[k], hydro.damping[k]);
    response(hydro, body, direction, of)
}

/// The same with the exponentials: K̂(iω) = B + iω(A − A∞).
///
/// # Errors
/// A [`HydroError`] if the file does not have the direction, or the matrix is singular.
pub fn response_of_the_memory(
    hydro: &Hydrodynamics,
    body: &Body,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    direction: f64,
) -> Result<Response, HydroError> {
    let of = |_: usize, omega: f64| of_the_memory(memory, added_mass_inf, omega);
    response(hydro, body, direction, of)
}

fn response(
    hydro: &Hydrodynamics,
    body: &Body,
    direction: f64,
    coefficients: impl Fn(usize, f64) -> (Matrix3<f64>, Matrix3<f64>),
) -> Result<Response, HydroError> {
    let force = &hydro.excitation_to(direction)?.force;
    let mut amplitude = Vec::with_capacity(force.len());
    for (k, omega) in hydro.omega_rad_s.iter().enumerate() {
        let solution = solved(body, *omega, coefficients(k, *omega), &force[k]);
        amplitude.push(solution.ok_or_else(|| {
            HydroError::Impossible(format!(
                "the motion in waves of ω = {omega} rad/s is unbounded: there is no damping"
            ))
        })?);
    }
    Ok(Response {
        direction,
        omega_rad_s: hydro.omega_rad_s.clone(),
        amplitude,
    })
}

/// ξ at one frequency from A and B there; none if the matrix is singular.
pub(super) fn solved(
    body: &Body,
    omega: f64,
    (added, damping): (Matrix3<f64>, Matrix3<f64>),
    force: &Vector3<Complex<f64>>,
) -> Option<Vector3<Complex<f64>>> {
    let real = body.stiffness - (body.mass + added) * (omega * omega);
    let imaginary = -(damping + body.damping) * omega;
    let matrix = real.zip_map(&imaginary, Complex::new);
    matrix.lu().solve(force)
}

/// A and B of the exponentials at ω.
pub(super) fn of_the_memory(
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    omega: f64,
) -> (Matrix3<f64>, Matrix3<f64>) {
    let transform = memory.transform(omega);
    let added = added_mass_inf + transform.map(|k| k.im / omega);
    (added, transform.map(|k| k.re))
}

impl Response {
    /// The root mean square of each freedom in a sea of variance density S(ω) \[m² s\], and the
    /// part of the sea's variance that the file's frequencies cover:
    ///
    /// ```text
    /// σ_i² = ∫ |ξ_i|² S dω
    /// ```
    ///
    /// |ξ_i| between the frequencies by cubic splines, the integral by the trapezoidal rule.
    pub fn in_a_sea(&self, density: impl Fn(f64) -> f64) -> ([f64; 3], f64) {
        let moduli: [Spline; 3] = std::array::from_fn(|i| {
            let values: Vec<f64> = self.amplitude.iter().map(|xi| xi[i].norm()).collect();
            Spline::new(&self.omega_rad_s, &values)
        });
        let [first, last] = moduli[0].ends();
        let steps = 40_000;
        // The spectrum extends beyond the file's range.
        let top = 4.0 * last;
        let width = top / f64::from(steps);
        let (mut sums, mut covered, mut all) = ([0.0; 3], 0.0, 0.0);
        for step in 1..=steps {
            let omega = width * f64::from(step);
            let s = density(omega) * width;
            all += s;
            if (first..=last).contains(&omega) {
                covered += s;
                for (sum, modulus) in sums.iter_mut().zip(&moduli) {
                    *sum += modulus.clamped(omega).powi(2) * s;
                }
            }
        }
        let part = if all > 0.0 { covered / all } else { 0.0 };
        (sums.map(f64::sqrt), part)
    }
}

/// Twice the root mean square: the significant amplitude, the mean of the largest third of
/// amplitudes of a narrow-banded Gaussian motion.
pub fn significant(root_mean_square: f64) -> f64 {
    2.0 * root_mean_square
}
