//! Whether a memory is passive, and the nearest one that is.
//!
//! ∫ q̇ᵀ F_mem dt ≥ 0 for every motion from rest if Re K̂(iω) is positive semidefinite for all ω.

use super::Memory;
use super::least_squares::shortest_above;
use super::poles::{Poles, basis};
use nalgebra::{Complex, DMatrix, DVector, Matrix3};

/// A negative eigenvalue whose magnitude is below this part of the largest counts as zero.
const ZERO: f64 = 1e-9;
/// The range of the search, in units of the last frequency, and the points in it.
const RANGE: [f64; 2] = [1e-4, 1e3];
const POINTS: usize = 3000;
/// The most rounds of least squares, each with more inequalities.
const ROUNDS: usize = 60;

/// Frequencies from far below to far above the last one, more densely where poles are near the
/// axis.
fn grid(poles: impl Iterator<Item = Complex<f64>>, omega_max: f64) -> Vec<f64> {
    let [low, high] = RANGE.map(f64::ln);
    let point = |k: usize| omega_max * (low + (high - low) * k as f64 / (POINTS - 1) as f64).exp();
    let near = |p: Complex<f64>| (-15..=15).map(move |k| p.im.abs() + 0.2 * f64::from(k) * p.re);
    let mut grid: Vec<f64> = (0..POINTS).map(point).chain(poles.flat_map(near)).collect();
    grid.retain(|omega| *omega > 0.0);
    grid.sort_by(f64::total_cmp);
    grid
}

/// The least eigenvalue of Re K̂ over the largest magnitude of one, each degree of freedom in units
/// of the root of its own largest damping.
pub(super) fn least(memory: &Memory, omega_max: f64) -> f64 {
    let poles = memory.terms.iter().map(|term| term.pole);
    let real: Vec<Matrix3<f64>> = grid(poles, omega_max)
        .into_iter()
        .map(|omega| memory.transform(omega).map(|entry| entry.re))
        .collect();
    let mut scale = [0.0; 3];
    for (i, scale) in scale.iter_mut().enumerate() {
        let largest = real
            .iter()
            .fold(0.0, |most: f64, b| most.max(b[(i, i)].abs()));
        if largest > 0.0 {
            *scale = largest.sqrt().recip();
        }
    }
    let (mut least, mut most) = (f64::INFINITY, 0.0);
    for b in real {
        let b = Matrix3::from_fn(|i, j| b[(i, j)] * scale[i] * scale[j]);
        let eigenvalues = b.symmetric_eigenvalues();
        least = eigenvalues.min().min(least);
        most = eigenvalues.amax().max(most);
    }
    if most > 0.0 { least / most } else { 0.0 }
}

/// Least squares in coordinates in which the error is the distance from a point: for entry e of the
/// matrix the coefficients are `basis · z_e · scale_e`, and the sum over e of |z_e − target_e|² is
/// minimised.
pub(super) struct Nearest<'a> {
    pub poles: &'a Poles,
    pub omega_max: f64,
    /// The matrix's size, and its entries i ≤ j.
    pub size: usize,
    pub entries: &'a [(usize, usize)],
    /// From z to coefficients, the same for all entries.
    pub basis: &'a DMatrix<f64>,
    pub scale: &'a [f64],
    pub targets: &'a [DVector<f64>],
    /// 1/sqrt of the largest damping of each freedom.
    pub unit: &'a [f64],
}

/// A passive memory, or the least eigenvalue that remains.
pub(super) struct Passive {
    /// The z of each entry.
    pub z: Vec<DVector<f64>>,
    /// The least eigenvalue over the largest, before and after.
    pub least_before: f64,
    pub least: f64,
    /// The largest eigenvalue.
    pub largest: f64,
}

impl Nearest<'_> {
    /// The nearest passive memory: least squares under vᵀ Re K̂(iω) v ≥ 0 at the frequencies with
    /// negative eigenvalues, with v the eigenvectors there, repeated until there are none.
    pub fn passive(&self) -> Passive {
        let omega = grid(self.poles.iter().copied(), self.omega_max);
        let row = |omega: &f64| -> Vec<f64> {
            let functions = basis(Complex::new(0.0, *omega), self.poles);
            functions.iter().map(|function| function.re).collect()
        };
        let rows: Vec<f64> = omega.iter().flat_map(row).collect();
        let real = DMatrix::from_row_slice(omega.len(), self.basis.nrows(), &rows) * self.basis;
        let mut z = self.targets.to_vec();
        let (mut eigenvalues, largest) = self.eigenvalues(&real, &z);
        let least = |eigenvalues: &[f64]| {
            let least = eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
            if largest > 0.0 { least / largest } else { 0.0 }
        };
        let least_before = least(&eigenvalues);
        let (mut left, mut right): (Vec<DVector<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            if least(&eigenvalues) >= -ZERO {
                break;
            }
            self.bounds(&real, &z, &eigenvalues, largest, &mut left, &mut right);
            let Some(nearest) = self.above(&left, &right) else {
                break;
            };
            z = nearest;
            eigenvalues = self.eigenvalues(&real, &z).0;
        }
        Passive {
            least: least(&eigenvalues),
            z,
            least_before,
            largest,
        }
    }

    fn matrix(&self, real: &DMatrix<f64>, at: usize, z: &[DVector<f64>]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.size, self.size);
        for (e, (i, j)) in self.entries.iter().copied().enumerate() {
            let value = real.row(at).transpose().dot(&z[e]) * self.scale[e];
            matrix[(i, j)] = value * self.unit[i] * self.unit[j];
            matrix[(j, i)] = matrix[(i, j)];
        }
        matrix
    }

    /// The least eigenvalue at each frequency, and the largest of all.
    fn eigenvalues(&self, real: &DMatrix<f64>, z: &[DVector<f64>]) -> (Vec<f64>, f64) {
        let mut largest: f64 = 0.0;
        let least = (0..real.nrows()).map(|at| {
            let eigenvalues = self.matrix(real, at, z).symmetric_eigenvalues();
            largest = largest.max(eigenvalues.max());
            eigenvalues.min()
        });
        let least = least.collect();
        (least, largest)
    }

    /// Adds an inequality g·(z − target) ≥ h at each frequency where the least eigenvalue has a
    /// local minimum below zero, scaled to ‖g‖ = 1.
    fn bounds(
        &self,
        real: &DMatrix<f64>,
        z: &[DVector<f64>],
        eigenvalues: &[f64],
        largest: f64,
        left: &mut Vec<DVector<f64>>,
        right: &mut Vec<f64>,
    ) {
        let n = self.basis.ncols();
        for at in 0..eigenvalues.len() {
            let here = eigenvalues[at];
            let before = at
                .checked_sub(1)
                .map_or(f64::INFINITY, |at| eigenvalues[at]);
            let after = eigenvalues.get(at + 1).copied().unwrap_or(f64::INFINITY);
            if !(here < -0.2 * ZERO * largest && here <= before && here <= after) {
                continue;
            }
            let eigen = self.matrix(real, at, z).symmetric_eigen();
            for (value, vector) in eigen
                .eigenvalues
                .iter()
                .zip(eigen.eigenvectors.column_iter())
            {
                if *value >= 0.0 {
                    continue;
                }
                let mut row = DVector::zeros(n * self.entries.len());
                let mut at_target = 0.0;
                for (e, (i, j)) in self.entries.iter().copied().enumerate() {
                    let twice = if i == j { 1.0 } else { 2.0 };
                    let part = vector[i] * self.unit[i] * vector[j] * self.unit[j] * twice;
                    let part = real.row(at).transpose() * (part * self.scale[e]);
                    at_target += part.dot(&self.targets[e]);
                    row.rows_mut(e * n, n).copy_from(&part);
                }
                let length = row.norm();
                if length > 0.0 {
                    left.push(row / length);
                    right.push((0.1 * ZERO * largest - at_target) / length);
                }
            }
        }
    }

    fn above(&self, left: &[DVector<f64>], right: &[f64]) -> Option<Vec<DVector<f64>>> {
        let columns = DMatrix::from_columns(left);
        let step = shortest_above(&columns.transpose(), &DVector::from_row_slice(right))?;
        let n = self.basis.ncols();
        let targets = self.targets.iter().enumerate();
        Some(
            targets
                .map(|(e, target)| target + step.rows(e * n, n))
                .collect(),
        )
    }
}
