//! Eigenvalues of a matrix, and of a lap where some are far smaller than others.
//!
//! An eigenvalue of the multiplied-out monodromy matrix M has an error of about ε|M|, in which
//! multipliers below that are lost. Here a lap carries an orthonormal frame Q from leg to leg, and
//! after each leg it is made orthonormal again, M Q = Q' R: R is the product of the legs' triangular
//! factors, on whose diagonal nothing cancels. Lap after lap the frame turns into one in which M is
//! block triangular, one block for each group of multipliers that is far smaller than the group
//! before (simultaneous iteration; Golub & Van Loan, *Matrix Computations*, section 7.3). The blocks
//! of Qᵀ Q' R on the diagonal then have the groups' multipliers as eigenvalues, with errors of about
//! ε times the block.

use crate::lap::Linearised;
use nalgebra::{Complex, DMatrix};

/// Multipliers below this part of the matrix's entries have lost ten of sixteen digits in it.
const SMALL: f64 = 1e-6;
/// A group is apart from the next if it is larger by this factor at least.
const GAP: f64 = 1e-2;
/// So many laps make a frame settle to `GAP` to their power, which is below rounding.
const LAPS: usize = 12;
/// What is left then of the directions of larger multipliers in those of smaller ones, at most.
const SETTLED: f64 = 1e-12;

/// The eigenvalues of a matrix, the largest first.
pub(crate) fn eigenvalues(matrix: DMatrix<f64>) -> Vec<[f64; 2]> {
    if matrix.nrows() == 0 || !matrix.iter().all(|entry| entry.is_finite()) {
        return vec![[f64::NAN; 2]; matrix.nrows()];
    }
    let found = matrix.complex_eigenvalues();
    let mut values: Vec<Complex<f64>> = found.iter().copied().collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(a.im.total_cmp(&b.im)));
    values
        .into_iter()
        .map(|value| [value.re, value.im])
        .collect()
}

/// The eigenvalues of M in the directions `left`, the largest first, and their product; none where
/// the `values` of M itself, which is `reduced` there, have enough digits, or are one group.
pub(crate) fn far_apart(
    (reduced, values): (&DMatrix<f64>, &[[f64; 2]]),
    lap: &Linearised,
    variables: &[usize],
    left: &DMatrix<f64>,
) -> Option<(Vec<[f64; 2]>, f64)> {
    let size = |[re, im]: &[f64; 2]| re.hypot(*im);
    let smallest = values.last().map_or(0.0, size);
    if !reduced.iter().all(|entry| entry.is_finite()) || smallest >= SMALL * reduced.amax() {
        return None;
    }
    let count = reduced.nrows();
    // The range that was found of M itself is known to ε|M| only; a lap leads into the exact one.
    let start = lap.start(variables, variables.len()) * left;
    let (left, _) = carried(lap, variables, start);
    let mut frame = DMatrix::identity(count, count);
    let (mut turned, mut factor) = (frame.clone(), frame.clone());
    for _ in 0..LAPS {
        let start = lap.start(variables, variables.len()) * &left * &frame;
        let (end, along) = carried(lap, variables, start);
        let (orthonormal, triangle) = (left.transpose() * end).qr().unpack();
        factor = triangle * along;
        turned = frame.transpose() * &orthonormal;
        frame = orthonormal;
    }
    if !factor.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let is_apart = |k: &usize| {
        let smaller = factor[(*k, *k)].abs() < GAP * factor[(k - 1, k - 1)].abs();
        smaller && turned.view((*k, 0), (count - k, *k)).amax() < SETTLED
    };
    let mut ends: Vec<usize> = (1..count).filter(is_apart).collect();
    if ends.is_empty() {
        return None;
    }
    ends.push(count);
    let (mut values, mut product, mut first) = (Vec::new(), 1.0, 0);
    for end in ends {
        let place = ((first, first), (end - first, end - first));
        let block = turned.view(place.0, place.1) * factor.view(place.0, place.1);
        product *= block.determinant();
        values.extend(eigenvalues(block));
        first = end;
    }
    values.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a[1].total_cmp(&b[1])));
    Some((values, product))
}

/// Deviations after one lap, made orthonormal after each of its legs, and R: the lap leads from the
/// start to them times R.
fn carried(
    lap: &Linearised,
    variables: &[usize],
    start: DMatrix<f64>,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let count = start.ncols();
    let mut factor = DMatrix::identity(count, count);
    let end = lap.carried(start, |state, time| {
        let states = state.nrows();
        let mut both = state.clone().insert_rows(states, 1, 0.0);
        both.row_mut(states).copy_from(time);
        let (orthonormal, triangle) = both.qr().unpack();
        factor = triangle * &factor;
        state.copy_from(&orthonormal.rows(0, states));
        time.copy_from(&orthonormal.row(states));
    });
    let end = DMatrix::from_fn(variables.len(), count, |i, j| end[(variables[i], j)]);
    let (orthonormal, triangle) = end.qr().unpack();
    (orthonormal, triangle * factor)
}
