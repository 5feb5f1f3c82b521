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
/// The ratio by which an interval is made smaller, and how often: to rounding in the function.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const HALVINGS: usize = 40;
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
    let omega = grid(poles, omega_max);
    let at = |omega: f64| memory.transform(omega).map(|entry| entry.re);
    let real: Vec<Matrix3<f64>> = omega.iter().map(|omega| at(*omega)).collect();
    let mut scale = [0.0; 3];
    for (i, scale) in scale.iter_mut().enumerate() {
        let largest = real
            .iter()
            .fold(0.0, |most: f64, b| most.max(b[(i, i)].abs()));
        if largest > 0.0 {
            *scale = largest.sqrt().recip();
        }
    }
    let eigenvalues = |b: &Matrix3<f64>| {
        let b = Matrix3::from_fn(|i, j| b[(i, j)] * scale[i] * scale[j]);
        b.symmetric_eigenvalues()
    };
    let (mut leasts, mut most) = (Vec::new(), 0.0);
    for b in &real {
        let eigenvalues = eigenvalues(b);
        leasts.push(eigenvalues.min());
        most = eigenvalues.amax().max(most);
    }
    let minima = minima(&omega, &leasts, |omega| eigenvalues(&at(omega)).min());
    let least = minima.into_iter().map(|[_, least]| least);
    let least = least.fold(f64::INFINITY, f64::min);
    if most > 0.0 { least / most } else { 0.0 }
}

/// The local minima of a function over ω, each with its ω: those of its values on the grid, refined
/// between their neighbours by golden section. No minimum is narrower than the poles are far from
/// the axis, and the grid has several points in that.
fn minima(omega: &[f64], values: &[f64], of: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let last = values.len().saturating_sub(1);
    let neighbours = |at: usize| [at.saturating_sub(1), (at + 1).min(last)];
    let lowest = |at: &usize| neighbours(*at).iter().all(|k| values[*at] <= values[*k]);
    let refined = |at: usize| {
        let [mut low, mut high] = neighbours(at).map(|k| omega[k]);
        let mut best = [omega[at], values[at]];
        let inner = |low: f64, high: f64| high - GOLDEN * (high - low);
        let mut left = inner(low, high);
        let mut right = low + high - left;
        let (mut at_left, mut at_right) = (of(left), of(right));
        for _ in 0..HALVINGS {
            for one in [[left, at_left], [right, at_right]] {
                if one[1] < best[1] {
                    best = one;
                }
            }
            if at_left < at_right {
                (high, right, at_right) = (right, left, at_left);
                left = inner(low, high);
                at_left = of(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = of(right);
            }
        }
        best
    };
    (0..values.len()).filter(lowest).map(refined).collect()
}

/// The places of a grid at which the least eigenvalue has a local minimum below zero.
fn negative_minima(eigenvalues: &[f64], largest: f64) -> impl Iterator<Item = usize> {
    let at = |k: Option<usize>| {
        let value = k.and_then(|k| eigenvalues.get(k));
        value.copied().unwrap_or(f64::INFINITY)
    };
    (0..eigenvalues.len()).filter(move |&k| {
        let here = eigenvalues[k];
        here < -0.2 * ZERO * largest && here <= at(k.checked_sub(1)) && here <= at(Some(k + 1))
    })
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
    /// The least eigenvalue over the largest, before the memory was made passive.
    pub least_before: f64,
    /// The same of the passive memory.
    pub least: f64,
    /// The largest eigenvalue.
    pub largest: f64,
}

impl Nearest<'_> {
    /// The nearest passive memory: least squares under vᵀ Re K̂(iω) v ≥ 0 at the frequencies with
    /// negative eigenvalues, with v the eigenvectors there, repeated until there are none: first on
    /// the grid, then at the minima between its points.
    pub fn passive(&self) -> Passive {
        let omega = grid(self.poles.iter().copied(), self.omega_max);
        let rows = self.rows(&omega);
        let mut z = self.targets.to_vec();
        let (mut eigenvalues, largest) = self.eigenvalues(&rows, &z);
        let part = |least: f64| if largest > 0.0 { least / largest } else { 0.0 };
        let refined = |z: &[DVector<f64>], eigenvalues: &[f64]| {
            let at = |omega: f64| {
                self.matrix(&self.row(omega), z)
                    .symmetric_eigenvalues()
                    .min()
            };
            minima(&omega, eigenvalues, at)
        };
        let lowest = |minima: &[[f64; 2]]| {
            let values = minima.iter().map(|[_, value]| *value);
            part(values.fold(f64::INFINITY, f64::min))
        };
        let mut minima = refined(&z, &eigenvalues);
        let least_before = lowest(&minima);
        let (mut left, mut right): (Vec<DVector<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            if lowest(&minima) >= -ZERO {
                break;
            }
            let on_grid = eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
            let below: Vec<DVector<f64>> = match part(on_grid) < -ZERO {
                true => negative_minima(&eigenvalues, largest)
                    .map(|at| rows[at].clone())
                    .collect(),
                false => minima
                    .iter()
                    .filter(|[_, value]| *value < -0.2 * ZERO * largest)
                    .map(|[omega, _]| self.row(*omega))
                    .collect(),
            };
            for row in &below {
                self.bound(row, &z, largest, &mut left, &mut right);
            }
            let Some(nearest) = self.above(&left, &right) else {
                break;
            };
            z = nearest;
            eigenvalues = self.eigenvalues(&rows, &z).0;
            minima = refined(&z, &eigenvalues);
        }
        Passive {
            least: lowest(&minima),
            z,
            least_before,
            largest,
        }
    }

    /// The real parts of the functions of z at frequencies.
    fn rows(&self, omega: &[f64]) -> Vec<DVector<f64>> {
        let real = |omega: &f64| {
            let functions = basis(Complex::new(0.0, *omega), self.poles).into_iter();
            functions.map(|function| function.re)
        };
        let real: Vec<f64> = omega.iter().flat_map(real).collect();
        let rows = DMatrix::from_row_slice(omega.len(), self.basis.nrows(), &real) * self.basis;
        rows.row_iter().map(|row| row.transpose()).collect()
    }

    fn row(&self, omega: f64) -> DVector<f64> {
        self.rows(&[omega]).swap_remove(0)
    }

    fn matrix(&self, row: &DVector<f64>, z: &[DVector<f64>]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.size, self.size);
        for (e, (i, j)) in self.entries.iter().copied().enumerate() {
            let value = row.dot(&z[e]) * self.scale[e];
            matrix[(i, j)] = value * self.unit[i] * self.unit[j];
            matrix[(j, i)] = matrix[(i, j)];
        }
        matrix
    }

    /// The least eigenvalue at each frequency, and the largest of all.
    fn eigenvalues(&self, rows: &[DVector<f64>], z: &[DVector<f64>]) -> (Vec<f64>, f64) {
        let mut largest: f64 = 0.0;
        let least = rows.iter().map(|row| {
            let eigenvalues = self.matrix(row, z).symmetric_eigenvalues();
            largest = largest.max(eigenvalues.max());
            eigenvalues.min()
        });
        let least = least.collect();
        (least, largest)
    }

    /// Adds an inequality g·(z − target) ≥ h for each negative eigenvalue at a frequency, scaled to
    /// ‖g‖ = 1.
    fn bound(
        &self,
        functions: &DVector<f64>,
        z: &[DVector<f64>],
        largest: f64,
        left: &mut Vec<DVector<f64>>,
        right: &mut Vec<f64>,
    ) {
        let n = self.basis.ncols();
        let eigen = self.matrix(functions, z).symmetric_eigen();
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
                let part = functions * (part * self.scale[e]);
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
