//! The response of a body without lines to regular waves, and to a sea.

use super::body::Body;
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::Memory;
use crate::spline::Spline;
use nalgebra::{Complex, Matrix3, Vector3};

/// The spectrum of a sea is taken to end at this many times the last frequency of the file.
const SPECTRUM_ENDS: f64 = 4.0;
/// Panels of the integral over a sea, and the fewest of them between two frequencies of a response.
const PANELS: f64 = 40_000.0;
const FEWEST_PANELS: f64 = 4.0;

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
    /// |ξ_i| between the frequencies by cubic splines, the integral by Gauss's rule between each
    /// two of them: those of [`fine_responses`](super::fine_responses) are as dense as narrow peaks
    /// need.
    pub fn in_a_sea(&self, density: impl Fn(f64) -> f64) -> ([f64; 3], f64) {
        let moduli: [Spline; 3] = std::array::from_fn(|i| {
            let values: Vec<f64> = self.amplitude.iter().map(|xi| xi[i].norm()).collect();
            Spline::new(&self.omega_rad_s, &values)
        });
        let [first, last] = moduli[0].ends();
        let top = SPECTRUM_ENDS * last;
        let longest = top / PANELS;
        let (mut sums, mut covered) = ([0.0; 3], 0.0);
        for ends in self.omega_rad_s.windows(2) {
            for (omega, width) in gauss_points([ends[0], ends[1]], longest) {
                let s = density(omega) * width;
                covered += s;
                for (sum, modulus) in sums.iter_mut().zip(&moduli) {
                    *sum += modulus.clamped(omega).powi(2) * s;
                }
            }
        }
        let outside = [[0.0, first], [last, top]].into_iter();
        let outside = outside.flat_map(|ends| gauss_points(ends, longest));
        let outside: f64 = outside.map(|(omega, width)| density(omega) * width).sum();
        let all = covered + outside;
        let part = if all > 0.0 { covered / all } else { 0.0 };
        (sums.map(f64::sqrt), part)
    }
}

/// The points of Gauss's rule of two points in panels of at most a length, and their weights.
fn gauss_points([from, to]: [f64; 2], longest: f64) -> impl Iterator<Item = (f64, f64)> {
    let panels = ((to - from) / longest).ceil().max(FEWEST_PANELS);
    let half = 0.5 * (to - from) / panels;
    (0..panels as usize).flat_map(move |k| {
        let middle = from + half * (2 * k + 1) as f64;
        [-1.0, 1.0].map(|side| (middle + side * half / 3.0_f64.sqrt(), half))
    })
}

/// Twice the root mean square: the significant amplitude, the mean of the largest third of
/// amplitudes of a narrow-banded Gaussian motion.
pub fn significant(root_mean_square: f64) -> f64 {
    2.0 * root_mean_square
}
