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

use crate::bordered::null_vectors;
use crate::branch_events::Kind;
use crate::continuation::{Continuation, Unknowns};
use crate::hybrid::{Family, Point};
use nalgebra::{DMatrix, DVector};

/// The steps of the difference quotients, of first and of second order.
const FIRST: f64 = 5e-5;
const SECOND: f64 = 3e-4;
/// Steps of Newton's method towards the times of the events from a neighbour.
const MOST_STEPS: usize = 8;
/// The last step is shorter, so that its error, which is that squared, is below rounding.
const DONE: f64 = 1e-9;

/// A vector that a matrix takes to less than this part of the matrix's size is a null vector: on a
/// curve the eigenvalue is right to rounding, about 1e-12.
const VANISHING: f64 = 1e-11;

/// A coefficient with the eigenvector q to which it belongs. That of a fold changes its sign with
/// that of q.
pub(crate) struct Coefficient {
    pub(crate) value: f64,
    pub(crate) eigenvector: DVector<f64>,
}

impl Coefficient {
    /// With the eigenvector in the direction of that of a neighbour on a curve of folds; of the
    /// first one its largest component is positive.
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
    let middle = (&whole * &q) * 2.0;
    let cube = extrapolated(SECOND, |step| {
        Some((neighbour(step)? + neighbour(-step)? - &middle) / (step * step))
    })?;
    let value = p.dot(&cube) / 6.0 + 0.5 * p.dot(&map.second(&q, &back)?);
    value.is_finite().then_some(Coefficient {
        value,
        eigenvector: q,
    })
}

/// q and p of an eigenvalue, q of unit length and ⟨p, q⟩ = 1; none if
/// they are not known to rounding.
fn eigenvectors(whole: &DMatrix<f64>, eigenvalue: f64) -> Option<[DVector<f64>; 2]> {
    let n = whole.nrows();
    let less = whole - DMatrix::identity(n, n) * eigenvalue;
    let [q, p] = null_vectors(&less)?;
    let most = VANISHING * less.norm();
    let vanish = (&less * &q).norm() <= most && less.tr_mul(&p).norm() <= most;
    let along = p.dot(&q);
    (vanish && along.abs() > 1e-12).then(|| [q, p / along])
}

/// A central difference quotient without its error of second order in the step.
fn extrapolated(step: f64, quotient: impl Fn(f64) -> Option<DVector<f64>>) -> Option<DVector<f64>> {
    Some((quotient(step)? * 4.0 - quotient(2.0 * step)?) / 3.0)
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
            for (duration, part) in durations.iter_mut().zip(step.iter()) {
                *duration += part;
            }
            if step.amax() < DONE {
                let whole = lap.linearise(&z, &durations).monodromy(variables);
                return whole.iter().all(|part| part.is_finite()).then_some(whole);
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
        let there = |by: f64| self.monodromy(&(b * by)).map(|whole| whole * a);
        extrapolated(FIRST / size, |step| {
            Some((there(step)? - there(-step)?) / (2.0 * step))
        })
    }
}
