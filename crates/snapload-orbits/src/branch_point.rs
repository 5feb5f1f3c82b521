//! Branch points: where another branch crosses the one that is followed, such as that of the orbits
//! without the mirror symmetry of the case.
//!
//! The derivatives J of the closed lap's equations F, by all unknowns and the parameter, have two
//! null directions there instead of one. With the left null vector p the system
//!
//! ```text
//! F(u) + β p = 0,    Jᵀ p = 0,    pᵀ p = 1
//! ```
//!
//! is regular (G. Moore, *Numer. Funct. Anal. Optim.* 2 (1980) 441). β is zero where the branches
//! meet; where a small asymmetry keeps them apart it is not.

use crate::bordered::null_vectors;
use crate::continuation::{BranchStep, DIFFERENCE, Unknowns};
use crate::hybrid::Family;
use nalgebra::{DMatrix, DVector};

/// The most steps of Newton's method.
const MOST_STEPS: usize = 12;
/// The last step is below this.
const DONE: f64 = 1e-9;
/// Residuals, and β of branches that meet, are below this.
const CLOSED: f64 = 1e-10;
/// The point lies between the two of the step, up to this part of it.
const BEYOND: f64 = 1e-3;

/// The branch point between the two points of a step and its position between them, given a first
/// guess of that; none if the branches do not meet, or Newton's method finds no such point.
pub(crate) fn branch_point<F: Family>(step: &BranchStep<F>, guess: f64) -> Option<(Unknowns, f64)> {
    let continuation = step.continuation;
    let variables = continuation.family.variables();
    let at = |offset: &DVector<f64>| step.from.moved(variables, offset);
    let mut offset = step.tangent * guess;
    let (_, jacobian) = continuation.equations(&at(&offset), 1);
    let n = jacobian.nrows();
    let [_, mut p] = null_vectors(&jacobian.columns(0, n).into_owned())?;
    let mut beta = 0.0;
    for _ in 0..MOST_STEPS {
        let (residual, jacobian) = continuation.equations(&at(&offset), 1);
        let mut right = DVector::zeros(2 * n + 2);
        right.rows_mut(0, n).copy_from(&(&residual + &p * beta));
        right.rows_mut(n, n + 1).copy_from(&jacobian.tr_mul(&p));
        right[2 * n + 1] = p.dot(&p) - 1.0;
        let mut all = DMatrix::zeros(2 * n + 2, 2 * n + 2);
        all.view_mut((0, 0), (n, n + 1)).copy_from(&jacobian);
        all.view_mut((0, n + 1), (n, 1)).copy_from(&p);
        for i in 0..n {
            all[(i, n + 2 + i)] = beta;
            all[(2 * n + 1, n + 2 + i)] = 2.0 * p[i];
        }
        for i in 0..=n {
            let row = |by: f64| {
                let mut moved = offset.clone();
                moved[i] += by;
                continuation.equations(&at(&moved), 1).1.tr_mul(&p)
            };
            let slope = (row(DIFFERENCE) - row(-DIFFERENCE)) / (2.0 * DIFFERENCE);
            all.view_mut((n, i), (n + 1, 1)).copy_from(&slope);
        }
        all.view_mut((n, n + 2), (n + 1, n))
            .copy_from(&jacobian.transpose());
        let by = all.lu().solve(&right)?;
        let moved = by.amax();
        if !moved.is_finite() || moved > 1.0 {
            return None;
        }
        offset -= by.rows(0, n + 1);
        beta -= by[n + 1];
        p -= by.rows(n + 2, n);
        if moved < DONE {
            let (residual, _) = continuation.equations(&at(&offset), 1);
            let sigma = step.tangent.dot(&offset);
            let within = (-BEYOND..1.0 + BEYOND).contains(&(sigma / step.length));
            let meets = beta.abs() < CLOSED && residual.amax() < CLOSED;
            let near = offset.norm() < 2.0 * step.length;
            return (within && meets && near).then(|| (at(&offset), sigma));
        }
    }
    None
}
