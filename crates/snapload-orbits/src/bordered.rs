//! Singular matrices: their null vectors, by a border, and their range.
//!
//! Source: W. J. F. Govaerts, *Numerical Methods for Bifurcations of Dynamical Equilibria* (2000),
//! ch. 3. In
//!
//! ```text
//! [ A   b ] [ v ]   [ 0 ]
//! [ cᵀ  0 ] [ g ] = [ 1 ]
//! ```
//!
//! g is smooth and zero where A is singular, and v is then its null vector. The whole matrix is
//! regular although A is not, so that v is known to rounding. The vectors of nalgebra's singular
//! value decomposition are not: in version 0.35 the left ones are wrong by a rounding over the
//! least value, by which `compute_2x2_uptrig_svd` divides a difference. So the range is not taken
//! from it either.

use nalgebra::{DMatrix, DVector, RowDVector};

/// Solutions of the bordered systems of A and of Aᵀ in turn. Each one is nearer to a null vector by
/// a factor of the least singular value over the one above it.
const STEPS: usize = 4;

/// v and g of the bordered system.
pub(crate) fn solved(
    matrix: &DMatrix<f64>,
    left: &DVector<f64>,
    right: &DVector<f64>,
) -> Option<(DVector<f64>, f64)> {
    let n = matrix.nrows();
    if left.len() != n {
        return None;
    }
    let mut all = matrix.clone().resize(n + 1, n + 1, 0.0);
    all.view_mut((0, n), (n, 1)).copy_from(left);
    all.view_mut((n, 0), (1, n)).copy_from(&right.transpose());
    let mut unit = DVector::zeros(n + 1);
    unit[n] = 1.0;
    let solution = all.lu().solve(&unit)?;
    let whole = solution.iter().all(|part| part.is_finite());
    whole.then(|| (solution.rows(0, n).into_owned(), solution[n]))
}

/// The null vectors q of A and p of Aᵀ, of unit length, of a matrix with one singular value near
/// zero.
pub(crate) fn null_vectors(matrix: &DMatrix<f64>) -> Option<[DVector<f64>; 2]> {
    let transposed = matrix.transpose();
    let [mut p, mut q] = first_borders(matrix)?;
    for _ in 0..STEPS {
        q = solved(matrix, &p, &q)?.0.normalize();
        p = solved(&transposed, &q, &p)?.0.normalize();
    }
    Some([q, p])
}

/// The unit vectors b and c of the row and the column that elimination with complete pivoting
/// leaves to the last: what remains without them is regular, and so is the bordered matrix.
fn first_borders(matrix: &DMatrix<f64>) -> Option<[DVector<f64>; 2]> {
    let n = matrix.nrows();
    let last = n.checked_sub(1)?;
    let lu = matrix.clone().full_piv_lu();
    let mut rows = DVector::from_fn(n, |i, _| i);
    let mut columns = RowDVector::from_fn(n, |_, i| i);
    lu.p().permute_rows(&mut rows);
    lu.q().permute_columns(&mut columns);
    let unit = |place: usize| DVector::from_fn(n, |i, _| if i == place { 1.0 } else { 0.0 });
    Some([unit(rows[last]), unit(columns[last])])
}

/// An orthonormal basis of a space of so many dimensions that contains the range of a matrix of at
/// most this rank: the columns are reflected onto axes one after the other, first that with the
/// largest entry that is left (after G. H. Golub and C. F. Van Loan, *Matrix Computations* (2013),
/// section 5.4.2, where it is the longest).
pub(crate) fn range(matrix: &DMatrix<f64>, rank: usize) -> DMatrix<f64> {
    let q = matrix.clone().col_piv_qr().q();
    q.columns(0, rank).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from −1 to 1 (G. Marsaglia, *J. Stat. Softw.* 8 (2003), no. 14).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            for shift in [13, -7, 17_i32] {
                let moved = match shift > 0 {
                    true => self.0 << shift,
                    false => self.0 >> -shift,
                };
                self.0 ^= moved;
            }
            (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }

        fn orthogonal(&mut self, n: usize) -> DMatrix<f64> {
            DMatrix::from_fn(n, n, |_, _| self.next()).qr().q()
        }
    }

    #[test]
    fn the_border_is_zero_where_the_matrix_is_singular() {
        let border = DVector::from_vec(vec![0.6, 0.8]);
        let of = |by: f64| {
            let matrix = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0 + by]);
            solved(&matrix, &border, &border).map(|(_, g)| g)
        };
        assert!(of(0.0).is_some_and(|g| g.abs() < 1e-15));
        assert!(of(0.1).is_some_and(|g| g.abs() > 1e-3));
    }

    /// U Σ Vᵀ with known singular values: the null vectors are the last columns of U and V, and the
    /// matrix and its transpose take them to zero.
    #[test]
    fn null_vectors_are_those_of_which_the_matrix_is_made() {
        let mut numbers = Numbers(88_172_645_463_325_252);
        for n in [1, 2, 3, 4, 6, 15] {
            for least in [0.0, 1e-17, 1e-16, 1e-15, 1e-14] {
                for _ in 0..200 {
                    let [left, right] = [numbers.orthogonal(n), numbers.orthogonal(n)];
                    let mut values = DVector::from_fn(n, |_, _| (3.0 * numbers.next()).exp());
                    values[n - 1] = least;
                    let matrix = &left * DMatrix::from_diagonal(&values) * right.transpose();
                    let [q, p] = null_vectors(&matrix).expect("null vectors");
                    let size = matrix.norm().max(least);
                    assert!((&matrix * &q).norm() <= 2.0 * least + 1e-14 * size);
                    assert!((matrix.tr_mul(&p)).norm() <= 2.0 * least + 1e-14 * size);
                    let along = |a: &DVector<f64>, b: &DMatrix<f64>| a.dot(&b.column(n - 1)).abs();
                    assert!(along(&q, &right) > 1.0 - 1e-10 && along(&p, &left) > 1.0 - 1e-10);
                }
            }
        }
    }

    /// A Bᵀ with r columns each leads to the range of A, in which its r eigenvalues that are not
    /// zero are those of BᵀA; entries that differ by rounding change them by rounding. A matrix of
    /// less than the rank that is given has zeros among them.
    #[test]
    fn the_range_has_the_eigenvalues_that_are_not_zero() {
        let mut numbers = Numbers(88_172_645_463_325_252);
        for (n, r) in [(2, 1), (3, 1), (3, 2), (4, 3), (6, 2), (6, 5)] {
            for least in [0.0, 1e-16, 3e-15, 1e-14, 1e-13] {
                for _ in 0..200 {
                    let [a, b] = [numbers.orthogonal(n), numbers.orthogonal(n)];
                    let [a, b] = [a, b].map(|all| all.columns(0, r).into_owned());
                    let rounding = DMatrix::from_fn(n, n, |_, _| least * numbers.next());
                    let matrix = &a * b.transpose() + rounding;
                    let basis = range(&matrix, r);
                    let within = basis.transpose() * &matrix * &basis;
                    let expected = b.transpose() * &a;
                    let off = (within.trace() - expected.trace()).abs();
                    assert!(off < 1e-11, "{n} {r} {least}: {off}");
                    let off = (within.determinant() - expected.determinant()).abs();
                    assert!(off < 1e-11, "{n} {r} {least}: {off}");
                }
            }
            let one = DMatrix::from_fn(n, n, |i, j| if i == 1 && j == 1 { 0.5 } else { 0.0 });
            let basis = range(&one, r);
            let off = (basis.transpose() * &one * &basis).trace() - 0.5;
            assert!(off.abs() < 1e-15 && (basis.transpose() * &basis).trace() > r as f64 - 1e-9);
        }
    }
}
