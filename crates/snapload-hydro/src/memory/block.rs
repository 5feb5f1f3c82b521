//! The samples to which the memory of coupled degrees of freedom is fitted, and least squares for
//! given poles.

use super::curve::DampingCurve;
use super::poles::{Poles, Samples, basis, first_guess, relocate};
use super::quality::Kernel;
use crate::coefficients::Hydrodynamics;
use nalgebra::{Complex, DMatrix, DVector, Matrix3};

/// Points that are added beyond the last frequency, and their range as a multiple of it.
const BEYOND: usize = 30;
const FARTHEST: f64 = 8.0;
/// Relocations of the poles.
const RELOCATIONS: usize = 60;
/// Couplings below this part of the diagonal are taken as zero, as for a mirror-symmetric body, or
/// for surge and pitch about the point at which they do not couple.
const COUPLED: f64 = 1e-3;

/// The largest damping of an entry, and its frequency.
pub(super) fn largest_damping(hydro: &Hydrodynamics, i: usize, j: usize) -> (f64, f64) {
    let values = hydro.damping_entry(i, j).into_iter().enumerate();
    let (at, value) =
        values.map(|(k, b)| (k, b.abs())).fold(
            (0, 0.0),
            |most, next| if next.1 > most.1 { next } else { most },
        );
    (value, hydro.omega_rad_s[at])
}

/// Whether the waves that one motion makes act on another.
pub(super) fn coupled(hydro: &Hydrodynamics, i: usize, j: usize) -> bool {
    let largest = |i: usize, j: usize| largest_damping(hydro, i, j).0;
    largest(i, j) > COUPLED * (largest(i, i) * largest(j, j)).sqrt()
}

/// The samples to which one block is fitted.
pub(super) struct Block {
    pub freedoms: Vec<usize>,
    /// Entries i ≤ j that are not zero, by index in `freedoms`.
    pub entries: Vec<(usize, usize)>,
    pub samples: Samples,
    /// The number of samples from the file, without those beyond its last frequency.
    pub own: usize,
    pub kernels: Vec<Kernel>,
    pub unit: Vec<f64>,
}

impl Block {
    pub fn new(hydro: &Hydrodynamics, inf: &Matrix3<f64>, freedoms: Vec<usize>) -> Self {
        let own = hydro.omega_rad_s.len();
        let last = hydro.omega_rad_s[own - 1];
        let beyond = (0..BEYOND).map(|k| {
            let part = k as f64 / (BEYOND - 1) as f64;
            last * (1.05_f64.ln() + (FARTHEST / 1.05).ln() * part).exp()
        });
        let omega: Vec<f64> = hydro.omega_rad_s.iter().copied().chain(beyond).collect();
        let size = freedoms.len();
        // A zero entry can not be fitted relative to itself, and has no residues.
        let entries: Vec<(usize, usize)> = (0..size)
            .flat_map(|i| (i..size).map(move |j| (i, j)))
            .filter(|(i, j)| i == j || coupled(hydro, freedoms[*i], freedoms[*j]))
            .collect();
        let mut values = DMatrix::zeros(omega.len(), entries.len());
        let (mut kernels, mut scale) = (Vec::new(), Vec::new());
        for (e, (a, b)) in entries.iter().enumerate() {
            let (i, j) = (freedoms[*a], freedoms[*b]);
            let curve = DampingCurve::new(&hydro.omega_rad_s, &hydro.damping_entry(i, j));
            for (k, omega) in omega.iter().enumerate() {
                let difference = match hydro.added_mass.get(k) {
                    Some(added_mass) => added_mass[(i, j)] - inf[(i, j)],
                    None => curve.added_mass(*omega),
                };
                let damping = match hydro.damping.get(k) {
                    Some(damping) => damping[(i, j)],
                    None => curve.at(*omega),
                };
                values[(k, e)] = Complex::new(damping, omega * difference);
            }
            let own_values = values.column(e).rows(0, own).norm_squared();
            scale.push((own_values / own as f64).sqrt().recip());
            kernels.push(Kernel::new(&curve, last));
        }
        let unit = freedoms.iter().map(|i| {
            let values = hydro.damping_entry(*i, *i).into_iter();
            values
                .fold(0.0, |most: f64, b| most.max(b.abs()))
                .sqrt()
                .recip()
        });
        Self {
            unit: unit.collect(),
            samples: Samples {
                weight: weights(&omega, own),
                omega,
                values,
                scale,
            },
            freedoms,
            entries,
            own,
            kernels,
        }
    }

    pub fn omega_max(&self) -> f64 {
        self.samples.omega[self.own - 1]
    }
}

/// One for the file's own samples. Beyond them each represents a band of frequencies, so that the
/// sum of squares is ∫|ΔK̂|² dω = π ∫ ΔK² dt there (Parseval), and K(0) is right.
fn weights(omega: &[f64], own: usize) -> Vec<f64> {
    let spacing = (omega[own - 1] - omega[0]) / (own - 1) as f64;
    let weight = |k: usize| {
        if k < own {
            return 1.0;
        }
        let after = omega.get(k + 1).copied().unwrap_or(omega[k]);
        let before = omega[k - 1];
        let band = if after > omega[k] {
            0.5 * (after - before)
        } else {
            after - before
        };
        (band / spacing).sqrt()
    };
    (0..omega.len()).map(weight).collect()
}

/// Residues for given poles, in coordinates in which the error is a distance.
pub(super) struct Residues {
    /// From coordinates to coefficients.
    pub basis: DMatrix<f64>,
    /// Coordinates of the best fit of each entry, in units of the entry.
    pub best: Vec<DVector<f64>>,
}

/// Least squares of the coefficients x for each entry under K̂(0) = 0, as a body in steady motion
/// makes no waves:
///
/// ```text
/// min Σ w² |Σ x_j φ_j(iω) − f|²    with    Σ x_j φ_j(0) = 0
/// ```
///
/// x = N y, N a basis of the constraint's null space; with M N = Q R the error is |R y − Qᵀf| up to
/// a constant.
pub(super) fn residues(block: &Block, poles: &Poles) -> Option<Residues> {
    let samples = &block.samples;
    let m = samples.omega.len();
    let functions = |omega: f64| basis(Complex::new(0.0, omega), poles);
    let at_zero = DVector::from_vec(functions(0.0).iter().map(|f| f.re).collect());
    let n = at_zero.len();
    let mut matrix = DMatrix::zeros(2 * m, n);
    for (k, omega) in samples.omega.iter().enumerate() {
        for (j, function) in functions(*omega).iter().enumerate() {
            let function = function * samples.weight[k];
            (matrix[(k, j)], matrix[(m + k, j)]) = (function.re, function.im);
        }
    }
    let null = null_space(&at_zero)?;
    let (q, r) = (matrix * &null).qr().unpack();
    let smallest = r
        .diagonal()
        .iter()
        .fold(f64::INFINITY, |least, d| least.min(d.abs()));
    let independent = smallest > 1e-12 * r.diagonal().amax();
    if !independent {
        return None;
    }
    let inverse = r.try_inverse()?;
    let best = (0..block.entries.len()).map(|e| {
        let target = DVector::from_fn(2 * m, |k, _| {
            let value = samples.values[(k % m, e)] * samples.weight[k % m];
            samples.scale[e] * if k < m { value.re } else { value.im }
        });
        q.tr_mul(&target)
    });
    Some(Residues {
        best: best.collect(),
        basis: null * inverse,
    })
}

/// Columns that are orthogonal to a vector and to one another: the Householder reflection that
/// takes the vector to the first axis, without its first column.
fn null_space(vector: &DVector<f64>) -> Option<DMatrix<f64>> {
    let length = vector.norm();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let mut v = vector / length;
    v[0] += if v[0] < 0.0 { -1.0 } else { 1.0 };
    let n = v.len();
    let reflection = DMatrix::identity(n, n) - &v * v.transpose() * (2.0 / v.norm_squared());
    Some(reflection.columns(1, n - 1).into_owned())
}

impl Block {
    pub fn coefficients(&self, residues: &Residues, z: &[DVector<f64>]) -> Vec<DVector<f64>> {
        let scaled = z.iter().zip(&self.samples.scale);
        scaled
            .map(|(z, scale)| &residues.basis * z / *scale)
            .collect()
    }

    /// The root mean square of the difference over the file's own frequencies and all entries, each
    /// relative to itself.
    pub fn rms(&self, poles: &Poles, coefficients: &[DVector<f64>]) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.own {
            let functions = basis(Complex::new(0.0, self.samples.omega[k]), poles);
            for (e, coefficients) in coefficients.iter().enumerate() {
                let pairs = functions.iter().zip(coefficients.iter());
                let fit: Complex<f64> = pairs.map(|(f, x)| f * *x).sum();
                let difference = (fit - self.samples.values[(k, e)]) * self.samples.scale[e];
                sum += difference.norm_sqr();
            }
        }
        (sum / (self.own * coefficients.len()) as f64).sqrt()
    }

    /// The best poles among those of all relocations.
    pub fn poles(&self, pairs: usize) -> Option<Poles> {
        let mut poles = first_guess(pairs, self.omega_max());
        let mut best: Option<(f64, Poles)> = None;
        for _ in 0..RELOCATIONS {
            let Some(next) = relocate(&self.samples, &poles) else {
                break;
            };
            poles = next;
            let Some(residues) = residues(self, &poles) else {
                continue;
            };
            let error = self.rms(&poles, &self.coefficients(&residues, &residues.best));
            if best.as_ref().is_none_or(|(least, _)| error < *least) {
                best = Some((error, poles.clone()));
            }
        }
        best.map(|(_, poles)| poles)
    }
}
