//! The behaviour of an orbit just beyond a fold or a period doubling: the coefficient of its normal
//! form.
//!
//! Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory* (2004), sections 5.4.1 to 5.4.3: with
//! q and p the eigenvectors of the monodromy matrix A and of Aᵀ, ⟨p, q⟩ = 1, and B, C the second
//! and third derivatives of the composed map,
//!
//! ```text
//! fold                ξ → ξ + a ξ²,    a = ½ ⟨p, B(q, q)⟩
//! period doubling     ξ → −ξ + c ξ³,   c = ⅙ ⟨p, C(q, q, q)⟩ + ½ ⟨p, B(q, (1 − A)⁻¹ B(q, q))⟩
//! ```
//!
//! B and C are differences of the exact monodromy matrix at neighbours.

use crate::branch_events::Kind;
use crate::continuation::{Continuation, Unknowns};
use crate::hybrid::{Family, Point};
use nalgebra::{DMatrix, DVector};

/// The steps of the difference quotients, of first and of second order.
const FIRST: f64 = 1e-5;
const SECOND: f64 = 2e-4;
/// Steps of Newton's method towards the times of the events from a neighbour.
const MOST_STEPS: usize = 8;
/// The accuracy to which the times are found.
const DONE: f64 = 1e-13;

/// A coefficient with the eigenvector q to which it belongs. That of a fold changes its sign with
/// that of q.
pub(crate) struct Coefficient {
    pub(crate) value: f64,
    pub(crate) eigenvector: DVector<f64>,
}

impl Coefficient {
    /// With the eigenvector in the direction of that of a neighbour on a curve of folds; of the first
    /// one its largest component is positive.
    pub(crate) fn oriented(&mut self, neighbour: Option<&DVector<f64>>) {
        let along = match neighbour {
            Some(neighbour) => neighbour.dot(&self.eigenvector),
            None => self.eigenvector[self.eigenvector.iamax()],
        };
        if along < 0.0 {
            self.value = -self.value;
            self.eigenvector.neg_mut();
        }
    }
}

/// The coefficient; none for other kinds, and if neighbours do not have the same events.
pub(crate) fn coefficient<F: Family>(
    continuation: &Continuation<F>,
    u: &Unknowns,
    kind: Kind,
) -> Option<Coefficient> {
    let eigenvalue = match kind {
        Kind::Fold => 1.0,
        Kind::PeriodDoubling => -1.0,
        _ => return None,
    };
    let map = Map { continuation, u };
    let whole = map.monodromy(&DVector::zeros(continuation.family.variables().len()))?;
    let [q, p] = eigenvectors(&whole, eigenvalue)?;
    let square = map.second(&q, &q)?;
    if kind == Kind::Fold {
        return Some(Coefficient {
            value: 0.5 * p.dot(&square),
            eigenvector: q,
        });
    }
    let n = whole.nrows();
    let back = (DMatrix::identity(n, n) - &whole).lu().solve(&square)?;
    let neighbour = |by: f64| map.monodromy(&(&q * by)).map(|there| there * &q);
    let cube = (neighbour(SECOND)? + neighbour(-SECOND)? - (&whole * &q) * 2.0) / (SECOND * SECOND);
    let value = p.dot(&cube) / 6.0 + 0.5 * p.dot(&map.second(&q, &back)?);
    value.is_finite().then_some(Coefficient {
        value,
        eigenvector: q,
    })
}

/// q and p of an eigenvalue, q of unit length and ⟨p, q⟩ = 1.
pub(crate) fn eigenvectors(whole: &DMatrix<f64>, eigenvalue: f64) -> Option<[DVector<f64>; 2]> {
    let n = whole.nrows();
    let less = whole - DMatrix::identity(n, n) * eigenvalue;
    let svd = less.try_svd(true, true, f64::EPSILON, 10_000)?;
    let last = svd.singular_values.imin();
    let q = svd.v_t?.row(last).transpose();
    let p = svd.u?.column(last).into_owned();
    let along = p.dot(&q);
    (along.abs() > 1e-12).then(|| [q, p / along])
}

/// The composed map near a closed lap.
struct Map<'a, 'b, F: Family> {
    continuation: &'a Continuation<'b, F>,
    u: &'a Unknowns,
}

impl<F: Family> Map<'_, '_, F> {
    /// The monodromy matrix from a state near that of the lap.
    fn monodromy(&self, by: &DVector<f64>) -> Option<DMatrix<f64>> {
        let variables = self.continuation.family.variables();
        let mut z: Point = self.u.z;
        for (part, &i) in by.iter().zip(variables) {
            z[i] += part;
        }
        let lap = self.continuation.lap(self.u.at);
        let (m, n) = (variables.len(), self.u.durations.len());
        let mut durations = self.u.durations.clone();
        for _ in 0..MOST_STEPS {
            let linear = lap.linearise(&z, &durations);
            let (residual, jacobian) = linear.equations(&z, variables, 0);
            let times = jacobian.view((m, m), (n, n)).into_owned();
            let step = match n {
                0 => return Some(linear.monodromy(variables)),
                _ => times.lu().solve(&-residual.rows(m, n))?,
            };
            if step.amax() < DONE {
                let whole = linear.monodromy(variables);
                return whole.iter().all(|part| part.is_finite()).then_some(whole);
            }
            for (duration, part) in durations.iter_mut().zip(step.iter()) {
                *duration += part;
            }
        }
        None
    }

    /// B(a, b).
    fn second(&self, a: &DVector<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
        let size = b.norm();
        if size == 0.0 {
            return Some(DVector::zeros(a.len()));
        }
        let step = FIRST / size;
        let there = |by: f64| self.monodromy(&(b * by)).map(|whole| whole * a);
        Some((there(step)? - there(-step)?) / (2.0 * step))
    }
}
