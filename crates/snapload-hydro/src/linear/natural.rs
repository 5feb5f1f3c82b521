//! Natural frequencies, without lines or with taut lines.

use super::body::Body;
use crate::coefficients::{Hydrodynamics, MatrixCurve};
use crate::error::HydroError;
use crate::memory::{Memory, Term};
use nalgebra::{Complex, DMatrix, DVector, Matrix3, Schur, Vector3};
use std::f64::consts::PI;

/// An eigenvalue of stiffness over mass below this part of the largest belongs to a degree of
/// freedom without stiffness, such as surge without lines.
const SOFT: f64 = 1e-9;
/// Points in the search for a frequency at which stiffness and inertia are in balance.
const SEARCH: usize = 400;

/// A natural motion without damping: det(C − ω²(M + A(ω))) = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Natural {
    /// ω \[rad/s\].
    pub omega_rad_s: f64,
    /// 2π/ω \[s\].
    pub period_s: f64,
    /// The degree of freedom that moves most, each weighted by its own mass.
    pub freedom: usize,
    /// Surge, heave and pitch of the motion, of any size.
    pub shape: Vector3<f64>,
    /// Whether ω lies outside the file's frequencies, where A is that at the nearest; not if A is
    /// the same at all of them, as it is in textbooks.
    pub outside: bool,
}

/// A basis of the possible motions: all three, or the null space of taut lines.
pub(super) fn all() -> DMatrix<f64> {
    DMatrix::identity(3, 3)
}

/// NᵀMN.
pub(super) fn reduced(matrix: &Matrix3<f64>, basis: &DMatrix<f64>) -> DMatrix<f64> {
    let matrix = DMatrix::from_fn(3, 3, |i, j| matrix[(i, j)]);
    basis.transpose() * matrix * basis
}

/// Natural motions with A(ω) of the file, the slowest first; freedoms without stiffness have none.
///
/// # Errors
/// [`HydroError::Impossible`] if M + A is not positive definite.
pub fn natural_of_the_file(hydro: &Hydrodynamics, body: &Body) -> Result<Vec<Natural>, HydroError> {
    natural(hydro, &body.mass, &body.stiffness, &all())
}

/// The same for the motions that taut lines allow, with their stiffness.
pub(super) fn natural(
    hydro: &Hydrodynamics,
    mass: &Matrix3<f64>,
    stiffness: &Matrix3<f64>,
    basis: &DMatrix<f64>,
) -> Result<Vec<Natural>, HydroError> {
    let curve = hydro.added_mass_curve();
    let problem = Problem {
        curve: &curve,
        mass,
        stiffness: reduced(stiffness, basis),
        basis,
    };
    let [low, high] = hydro.range_rad_s();
    let alike = hydro.added_mass.windows(2).all(|two| two[0] == two[1]);
    let middle = problem.at(0.5 * (low + high))?;
    let largest = middle
        .iter()
        .fold(0.0, |most: f64, (value, _)| most.max(*value));
    let mut found = Vec::new();
    for (k, (value, _)) in middle.iter().enumerate() {
        if *value <= SOFT * largest {
            continue;
        }
        let omega = problem.balanced(k, high)?;
        let shape = &problem.at(omega)?[k].1;
        let motion = basis * shape;
        let whole = mass + curve.at(omega);
        let weight = |i: usize| motion[i] * motion[i] * whole[(i, i)];
        let freedom = (0..3).fold(0, |most, i| if weight(i) > weight(most) { i } else { most });
        found.push(Natural {
            omega_rad_s: omega,
            period_s: 2.0 * PI / omega,
            freedom,
            shape: Vector3::new(motion[0], motion[1], motion[2]),
            outside: !alike && (omega < low || omega > high),
        });
    }
    found.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
    Ok(found)
}

struct Problem<'a> {
    curve: &'a MatrixCurve,
    mass: &'a Matrix3<f64>,
    stiffness: DMatrix<f64>,
    basis: &'a DMatrix<f64>,
}

impl Problem<'_> {
    /// Eigenvalues of stiffness over mass with the added mass at a frequency, in rising order, with
    /// their motions.
    fn at(&self, omega: f64) -> Result<Vec<(f64, DVector<f64>)>, HydroError> {
        let mass = reduced(&(self.mass + self.curve.at(omega)), self.basis);
        let Some(factor) = mass.cholesky() else {
            return Err(HydroError::Impossible(format!(
                "mass and added mass together are not positive definite at ω = {omega:.3} rad/s"
            )));
        };
        // With 𝓜 = L Lᵀ the eigenvalues are those of L⁻¹ C L⁻ᵀ.
        let singular = || HydroError::Impossible("the mass matrix is singular".to_owned());
        let inverse = factor.l().try_inverse().ok_or_else(singular)?;
        let symmetric = &inverse * &self.stiffness * inverse.transpose();
        let eigen = symmetric.symmetric_eigen();
        let columns = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter());
        let mut pairs: Vec<(f64, DVector<f64>)> = columns
            .map(|(value, vector)| (*value, inverse.transpose() * vector))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(pairs)
    }

    /// The lowest ω at which the k-th eigenvalue is ω², by bisection of the first change of sign.
    /// Far beyond the last frequency A and with it the eigenvalue no longer changes.
    fn balanced(&self, k: usize, high: f64) -> Result<f64, HydroError> {
        let excess =
            |omega: f64| -> Result<f64, HydroError> { Ok(self.at(omega)?[k].0 - omega * omega) };
        let top = 10.0 * high;
        let mut low = 0.0;
        for step in 1..=SEARCH {
            // The points are closer together at low frequencies.
            let next = top * (step as f64 / SEARCH as f64).powi(3);
            if excess(next)? <= 0.0 {
                let (mut below, mut above) = (low, next);
                for _ in 0..200 {
                    let middle = 0.5 * (below + above);
                    if middle <= below || middle >= above {
                        break;
                    }
                    match excess(middle)? > 0.0 {
                        true => below = middle,
                        false => above = middle,
                    }
                }
                return Ok(0.5 * (below + above));
            }
            low = next;
        }
        Ok(self.at(top)?[k].0.sqrt())
    }
}

/// All eigenvalues of the body with its memory, ẏ = L y for y = (q, q̇, z):
///
/// ```text
/// 𝓜 q̈ + B q̇ + C q + Re Σ R_k z_k = 0,    ż_k = p_k z_k + q̇
/// ```
///
/// with B the body's damping and that which was added to the memory.
pub fn eigenvalues(
    body: &Body,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
) -> Result<Vec<Complex<f64>>, HydroError> {
    let matrix = state_matrix(body, &body.stiffness, memory, added_mass_inf, &all())?;
    of_matrix(matrix)
}

pub(super) fn of_matrix(matrix: DMatrix<f64>) -> Result<Vec<Complex<f64>>, HydroError> {
    let schur = Schur::try_new(matrix, f64::EPSILON, 100_000).ok_or_else(|| {
        HydroError::Impossible(
            "the eigenvalues of the body with its memory were not found".to_owned(),
        )
    })?;
    let mut values: Vec<Complex<f64>> = schur.complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    Ok(values)
}

/// L for the motions of a basis, u with q = N u. A pole with a complex residue is represented by
/// the real and the imaginary part of its state.
pub(super) fn state_matrix(
    body: &Body,
    stiffness: &Matrix3<f64>,
    memory: &Memory,
    added_mass_inf: &Matrix3<f64>,
    basis: &DMatrix<f64>,
) -> Result<DMatrix<f64>, HydroError> {
    let n = basis.ncols();
    let mass = reduced(&body.with_added_mass(added_mass_inf)?, basis);
    let inverse = mass.try_inverse().ok_or_else(|| {
        HydroError::Impossible(
            "the mass matrix is singular in the motions that are possible".to_owned(),
        )
    })?;
    let real = |term: &Term| term.pole.im == 0.0;
    let size = memory
        .terms
        .iter()
        .map(|term| if real(term) { n } else { 2 * n });
    let size = 2 * n + size.sum::<usize>();
    let mut matrix = DMatrix::zeros(size, size);
    matrix.view_mut((0, n), (n, n)).fill_with_identity();
    let push = -&inverse * reduced(stiffness, basis);
    matrix.view_mut((n, 0), (n, n)).copy_from(&push);
    let push = -&inverse * reduced(&(body.damping + memory.damping), basis);
    matrix.view_mut((n, n), (n, n)).copy_from(&push);
    let mut at = 2 * n;
    for term in &memory.terms {
        let part = |of: fn(&Complex<f64>) -> f64| reduced(&term.residue.map(|r| of(&r)), basis);
        // Re R z = Re R Re z − Im R Im z.
        let (re, im) = (part(|r| r.re), part(|r| r.im));
        matrix
            .view_mut((n, at), (n, n))
            .copy_from(&(-&inverse * re));
        matrix.view_mut((at, n), (n, n)).fill_with_identity();
        matrix
            .view_mut((at, at), (n, n))
            .fill_diagonal(term.pole.re);
        if !real(term) {
            matrix
                .view_mut((n, at + n), (n, n))
                .copy_from(&(&inverse * im));
            matrix
                .view_mut((at, at + n), (n, n))
                .fill_diagonal(-term.pole.im);
            matrix
                .view_mut((at + n, at), (n, n))
                .fill_diagonal(term.pole.im);
            matrix
                .view_mut((at + n, at + n), (n, n))
                .fill_diagonal(term.pole.re);
            at += n;
        }
        at += n;
    }
    Ok(matrix)
}
