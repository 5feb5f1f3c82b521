//! The shortest solution of least squares, by singular values.

use nalgebra::{DMatrix, DVector, Dyn, SVD};

/// A decomposition counts as right if its product is the matrix to within this part of its size.
const ROUNDING: f64 = 1e-14;
/// Rounds over all pairs of columns; about ten are needed.
const MOST_ROUNDS: usize = 60;

/// min ‖A x − b‖, the shortest x if there are several; singular values up to `zero` count as zero.
///
/// In nalgebra 0.35 the decomposition of a matrix with a small singular value σ may be wrong by a
/// rounding over σ, in the left vectors and in the values: `compute_2x2_uptrig_svd` divides a
/// difference by σ. Where its product is not the matrix another method takes its place.
pub fn shortest_solution(a: &DMatrix<f64>, b: &DVector<f64>, zero: f64) -> Option<DVector<f64>> {
    shortest_within(5.0 * f64::EPSILON, a, b, zero)
}

/// The same by a decomposition that converges to within `precision`.
pub(crate) fn shortest_within(
    precision: f64,
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    zero: f64,
) -> Option<DVector<f64>> {
    if a.is_empty() || !a.iter().chain(b).all(|entry| entry.is_finite()) {
        return None;
    }
    let svd = a.clone().try_svd(true, true, precision, 10_000);
    match svd.filter(|svd| is_of(svd, a)) {
        Some(svd) => svd.solve(b, zero).ok(),
        None => by_rotations(a, b, zero),
    }
}

fn is_of(svd: &SVD<f64, Dyn, Dyn>, a: &DMatrix<f64>) -> bool {
    let product = svd.clone().recompose();
    product.is_ok_and(|product| (product - a).norm() <= ROUNDING * a.norm())
}

/// The same by rotations of pairs of columns, until all are orthogonal: A V = W, and with the
/// columns w of W, x = V Σ (w·b / w·w). Source: M. R. Hestenes, *J. SIAM* 6 (1958) 51.
fn by_rotations(a: &DMatrix<f64>, b: &DVector<f64>, zero: f64) -> Option<DVector<f64>> {
    let (rows, n) = a.shape();
    let rounding = f64::EPSILON * rows.max(n) as f64;
    // A column of this length is rounding, and has no direction.
    let nothing = rounding * a.norm();
    let (mut w, mut v) = (a.clone(), DMatrix::identity(n, n));
    for _ in 0..MOST_ROUNDS {
        let mut is_done = true;
        for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
            let [p, q] = [i, j].map(|k| w.column(k).norm());
            let product = w.column(i).dot(&w.column(j));
            if product.abs() <= rounding * p * q || p.min(q) <= nothing {
                continue;
            }
            is_done = false;
            let cotangent = (q - p) * (q + p) / (2.0 * product);
            let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            for columns in [&mut w, &mut v] {
                turn(columns, [i, j], cosine, tangent * cosine);
            }
        }
        if is_done {
            let mut x = DVector::zeros(n);
            for (w, v) in w.column_iter().zip(v.column_iter()) {
                if w.norm() > zero.max(nothing) {
                    x += v * (w.dot(b) / w.norm_squared());
                }
            }
            return Some(x);
        }
    }
    None
}

fn turn(columns: &mut DMatrix<f64>, [i, j]: [usize; 2], cosine: f64, sine: f64) {
    for row in 0..columns.nrows() {
        let (a, b) = (columns[(row, i)], columns[(row, j)]);
        columns[(row, i)] = cosine * a - sine * b;
        columns[(row, j)] = sine * a + cosine * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from −1 to 1 by a linear congruence (D. H. Lehmer, 1951).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0 * 48_271 % 2_147_483_647;
            self.0 as f64 / 1_073_741_823.5 - 1.0
        }

        fn orthogonal(&mut self, n: usize) -> DMatrix<f64> {
            DMatrix::from_fn(n, n, |_, _| self.next()).qr().q()
        }
    }

    /// A = U Σ Vᵀ has the shortest solution V Σ⁺ Uᵀ b, whichever method is taken.
    #[test]
    fn the_shortest_solution_is_that_of_the_singular_values() {
        let mut numbers = Numbers(1999);
        for (rows, n) in [(2, 2), (3, 3), (5, 5), (3, 2), (2, 3), (3, 5), (20, 6)] {
            for least in [0.5, 1e-12, 1e-14, 1e-16, 0.0] {
                for _ in 0..200 {
                    let [u, v] = [rows, n].map(|count| numbers.orthogonal(count));
                    let count = rows.min(n);
                    let mut values: Vec<f64> = (0..count).map(|_| numbers.next().exp()).collect();
                    values[count - 1] = least;
                    let b = DVector::from_fn(rows, |_, _| numbers.next());
                    let mut sigma = DMatrix::zeros(rows, n);
                    let mut x = DVector::zeros(n);
                    for (k, value) in values.iter().enumerate() {
                        sigma[(k, k)] = *value;
                        if *value > 1e-10 {
                            x += v.column(k) * (u.column(k).dot(&b) / value);
                        }
                    }
                    let a = u * sigma * v.transpose();
                    for method in [shortest_solution, by_rotations] {
                        let off = (method(&a, &b, 1e-10).expect("a solution") - &x).norm();
                        assert!(off < 1e-10, "{rows} x {n}, {least}: off by {off}");
                    }
                }
            }
        }
    }

    #[test]
    fn entries_that_are_no_numbers_have_no_solution() {
        let b = DVector::from_vec(vec![1.0, f64::NAN]);
        assert!(shortest_solution(&DMatrix::identity(2, 2), &b, 1e-10).is_none());
    }
}
