//! Natural motions with the damping of memory and body.

use super::body::Body;
use super::natural::{Natural, all, of_matrix, reduced, state_matrix};
use crate::error::HydroError;
use crate::memory::Memory;
use nalgebra::{Complex, DMatrix, DVector, Matrix3};
use std::f64::consts::PI;

/// The radius of the circle about an eigenvalue, in units of the undamped frequency, and the points
/// on it. Poles of the memory that are eigenvalues of the state matrix, too, lie within rounding of
/// each other, others much farther apart.
const RADIUS: f64 = 1e-6;
const POINTS: usize = 8;

/// A natural motion with the memory's damping. It oscillates, λ being the eigenvalue with Im λ > 0,
/// or is overdamped and has a real λ.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// λ \[1/s\].
    pub eigenvalue: Complex<f64>,
    /// 2π/Im λ \[s\], infinite if it is overdamped.
    pub period_s: f64,
    /// −Re λ/|λ|, 1 if it is overdamped.
    pub damping_ratio: f64,
}

impl Mode {
    fn new(eigenvalue: Complex<f64>) -> Self {
        let period_s = match eigenvalue.im > 0.0 {
            true => 2.0 * PI / eigenvalue.im,
            false => f64::INFINITY,
        };
        Self {
            eigenvalue,
            period_s,
            damping_ratio: -eigenvalue.re / eigenvalue.norm(),
        }
    }

    /// Whether it creeps back without oscillating.
    pub fn is_overdamped(&self) -> bool {
        self.period_s.is_infinite()
    }
}

/// The natural motions of the file with the damping of memory and body.
///
/// # Errors
/// [`HydroError::Impossible`] if the mass is not positive definite.
pub fn natural_of_the_memory(
    body: &Body,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    natural: &[Natural],
) -> Result<Vec<Mode>, HydroError> {
    let damped = Damped {
        body,
        stiffness: &body.stiffness,
        memory,
        added_mass_inf,
        basis: &all(),
    };
    damped.modes(natural)
}

/// The body with its memory, in the motions of an orthonormal basis.
pub(super) struct Damped<'a> {
    pub body: &'a Body,
    pub stiffness: &'a Matrix3<f64>,
    pub memory: &'a Memory,
    pub added_mass_inf: &'a Matrix3<f64>,
    pub basis: &'a DMatrix<f64>,
}

impl Damped<'_> {
    /// For each natural motion the eigenvalue that has the largest share in the motion after a
    /// release at rest from its shape. The nearest to iω may be one that hardly moves the body in
    /// this shape, as waves of other motions oscillate, too.
    pub fn modes(&self, natural: &[Natural]) -> Result<Vec<Mode>, HydroError> {
        let (stiffness, inf) = (self.stiffness, self.added_mass_inf);
        let matrix = state_matrix(self.body, stiffness, self.memory, inf, self.basis)?;
        let mut values = of_matrix(matrix)?;
        values.retain(|value| value.im >= 0.0);
        let shares = |natural| {
            let share = |value: &Complex<f64>| self.share(natural, *value);
            values.iter().map(share).collect()
        };
        let shares: Vec<Vec<f64>> = natural.iter().map(shares).collect();
        // Each eigenvalue belongs to one motion: the largest shares are assigned first.
        let mut taken = vec![None; natural.len()];
        for _ in natural {
            let free = |k: &usize| !taken.contains(&Some(*k));
            let pairs = (0..natural.len())
                .filter(|i| taken[*i].is_none())
                .flat_map(|i| (0..values.len()).filter(free).map(move |k| (i, k)));
            let largest = pairs.max_by(|a, b| shares[a.0][a.1].total_cmp(&shares[b.0][b.1]));
            let Some((i, k)) = largest else {
                break;
            };
            taken[i] = Some(k);
        }
        let undamped = |natural: &Natural| Complex::new(0.0, natural.omega_rad_s);
        let of = |(natural, taken): (&Natural, &Option<usize>)| {
            Mode::new(taken.map_or(undamped(natural), |k| values[k]))
        };
        Ok(natural.iter().zip(&taken).map(of).collect())
    }

    /// The size of the part with e^{λt}, or e^{λt} and its conjugate, in the motion after a release
    /// at rest from a shape u, measured by uᵀCq/uᵀCu: of the residue of its Laplace transform at λ,
    /// which is the integral over a circle about λ.
    fn share(&self, natural: &Natural, value: Complex<f64>) -> f64 {
        let shape = self.basis.transpose() * natural.shape;
        let pushed = reduced(self.stiffness, self.basis) * &shape;
        let radius = RADIUS * natural.omega_rad_s;
        let point = |k: usize| Complex::from_polar(radius, 2.0 * PI * k as f64 / POINTS as f64);
        let integral = (0..POINTS).map(|k| {
            let step = point(k);
            self.released(value + step, &shape, &pushed) * step
        });
        let residue = integral.sum::<Complex<f64>>() / POINTS as f64;
        let conjugates = if value.im > 0.0 { 2.0 } else { 1.0 };
        conjugates * residue.norm()
    }

    /// The Laplace transform of uᵀCq/uᵀCu after a release at rest from u, which follows from
    ///
    /// ```text
    /// D(s) q = (D(s) − C) u/s,    D = s²𝓜 + s(B + K̂(s)) + C
    /// ```
    fn released(
        &self,
        s: Complex<f64>,
        shape: &DVector<f64>,
        pushed: &DVector<f64>,
    ) -> Complex<f64> {
        let mass = (self.body.mass + self.added_mass_inf).map(Complex::from);
        let damping = self.memory.transform_at(s) + self.body.damping.map(Complex::from);
        let whole = mass * (s * s) + damping * s + self.stiffness.map(Complex::from);
        let [re, im] = [whole.map(|z| z.re), whole.map(|z| z.im)];
        let matrix = reduced(&re, self.basis).zip_map(&reduced(&im, self.basis), Complex::new);
        let pushed_complex = pushed.map(Complex::from);
        // D(s) is singular only at eigenvalues, and s is not one of them.
        let Some(answer) = matrix.lu().solve(&pushed_complex) else {
            return Complex::new(0.0, 0.0);
        };
        let left = pushed_complex.dot(&answer) / Complex::from(pushed.dot(shape));
        (Complex::new(1.0, 0.0) - left) / s
    }
}
