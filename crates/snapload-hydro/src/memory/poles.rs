//! The poles of a memory, by vector fitting.
//!
//! Source: B. Gustavsen and A. Semlyen, *IEEE Trans. Power Delivery* 14 (1999) 1052.

use super::least_squares::solve;
use nalgebra::{Complex, DMatrix, DVector, Schur};

/// The least −Re p as a part of |p|. A narrower pole near the last frequency is an artefact of the
/// end of the data, and breaks passivity.
const NARROWEST: f64 = 0.06;

/// Poles, one of each conjugate pair: Im p ≥ 0.
pub(super) type Poles = Vec<Complex<f64>>;

/// Samples of several functions at the same frequencies, with weights, which are fitted.
pub(super) struct Samples {
    /// ω.
    pub omega: Vec<f64>,
    /// One function in each column.
    pub values: DMatrix<Complex<f64>>,
    /// A weight for each sample, and one for each function.
    pub weight: Vec<f64>,
    pub scale: Vec<f64>,
}

/// The number of real coefficients.
pub(super) fn order(poles: &Poles) -> usize {
    poles.iter().map(|p| if p.im == 0.0 { 1 } else { 2 }).sum()
}

/// The functions, at s, of which the fit is a real linear combination: 1/(s − p) for a real pole,
/// and
///
/// ```text
/// 1/(s − p) + 1/(s − p̄),    i/(s − p) − i/(s − p̄)
/// ```
pub(super) fn basis(s: Complex<f64>, poles: &Poles) -> Vec<Complex<f64>> {
    let i = Complex::new(0.0, 1.0);
    let mut functions = Vec::with_capacity(2 * poles.len());
    for p in poles {
        let one = (s - p).inv();
        if p.im == 0.0 {
            functions.push(one);
        } else {
            let other = (s - p.conj()).inv();
            functions.push(one + other);
            functions.push(i * (one - other));
        }
    }
    functions
}

/// The first poles \[rad/s\]: pairs −0.2 b − 0.05 ± ib, b evenly spaced from 0.5, or 0.4 ω_max if
/// that is less, to 0.8 ω_max.
pub(super) fn first_guess(pairs: usize, omega_max: f64) -> Poles {
    let b = |k: usize| {
        let part = k as f64 / (pairs.max(2) - 1) as f64;
        let low = 0.5_f64.min(0.4 * omega_max);
        low + (0.8 * omega_max - low) * part
    };
    (0..pairs)
        .map(b)
        .map(|b| Complex::new(-0.2 * b - 0.05, b))
        .collect()
}

/// One relocation: σ(s) = 1 + Σ c̃/(s − p) is fitted so that σ f has the same poles as σ for every
/// function f; the zeros of σ are the new poles,
///
/// ```text
/// Σ c/(s − p) − f Σ c̃/(s − p) ≈ f,    p_new = eig(P − b c̃ᵀ)
/// ```
///
/// with P and b the real state-space form of the basis. None if the eigenvalues can not be found.
pub(super) fn relocate(samples: &Samples, poles: &Poles) -> Option<Poles> {
    let n = order(poles);
    let m = samples.omega.len();
    let functions: Vec<Vec<Complex<f64>>> = samples
        .omega
        .iter()
        .map(|omega| basis(Complex::new(0.0, *omega), poles))
        .collect();
    let count = samples.values.ncols();
    let mut rows = DMatrix::zeros(count * n, n);
    let mut right = DVector::zeros(count * n);
    for f in 0..count {
        let mut a = DMatrix::zeros(2 * m, 2 * n + 1);
        for k in 0..m {
            let weight = samples.weight[k] * samples.scale[f];
            let value = samples.values[(k, f)];
            for (j, function) in functions[k].iter().enumerate() {
                let (plain, times) = (function * weight, -value * function * weight);
                (a[(k, j)], a[(m + k, j)]) = (plain.re, plain.im);
                (a[(k, n + j)], a[(m + k, n + j)]) = (times.re, times.im);
            }
            (a[(k, 2 * n)], a[(m + k, 2 * n)]) = (value.re * weight, value.im * weight);
        }
        // The functions share only c̃: their own c is eliminated by a QR decomposition for each.
        let r = a.qr().r();
        rows.rows_mut(f * n, n).copy_from(&r.view((n, n), (n, n)));
        right
            .rows_mut(f * n, n)
            .copy_from(&r.view((n, 2 * n), (n, 1)));
    }
    let c = solve(&rows, &right)?;
    zeros(poles, &c)
}

fn zeros(poles: &Poles, c: &DVector<f64>) -> Option<Poles> {
    let n = c.len();
    let mut state = DMatrix::zeros(n, n);
    let mut input = DVector::zeros(n);
    let mut at = 0;
    for p in poles {
        if p.im == 0.0 {
            state[(at, at)] = p.re;
            input[at] = 1.0;
            at += 1;
        } else {
            state[(at, at)] = p.re;
            state[(at + 1, at + 1)] = p.re;
            state[(at, at + 1)] = p.im;
            state[(at + 1, at)] = -p.im;
            input[at] = 2.0;
            at += 2;
        }
    }
    let closed = state - input * c.transpose();
    let eigenvalues = Schur::try_new(closed, f64::EPSILON, 10_000)?.complex_eigenvalues();
    let mut new = Poles::new();
    for value in eigenvalues.iter() {
        let size = value.norm();
        if !size.is_finite() || size == 0.0 {
            return None;
        }
        if value.im < -1e-13 * size {
            continue;
        }
        // A pole that would grow is reflected at the imaginary axis.
        let re = -value.re.abs();
        new.push(match value.im > 1e-13 * size {
            true => Complex::new(re.min(-NARROWEST * size), value.im),
            false => Complex::new(re.min(-1e-6 * size), 0.0),
        });
    }
    new.sort_by(|a, b| a.im.total_cmp(&b.im).then(b.re.total_cmp(&a.re)));
    (order(&new) == n).then_some(new)
}
