//! The solver of both complementarity problems.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask, select_each};
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};

/// Constraints are dependent if a pivot is below this part of the largest diagonal entry.
const DEPENDENT: f64 = 1e-12;
/// Degrees of freedom of a body in the plane: more cables than this are always dependent, whatever
/// rounding makes of their pivots.
const FREEDOMS: usize = 3;
/// Below this part of the product of the diagonal, the determinant is so small that Cramer's rule
/// loses digits.
const SLANTED: f64 = 0.1;
/// A determinant below this many roundings of the product of the diagonal is only rounding.
const NEARLY_ONE_LINE: f64 = 4.5;

/// W z = q over the cables of a set, W symmetric and positive semidefinite, prepared for several q.
/// A cable whose constraint depends on those before it gets z = 0.
///
/// Two cables are solved by Cramer's rule, which treats both alike: the motion of a
/// mirror-symmetric system stays symmetric to the last bit.
pub(crate) struct Factored<T, W> {
    w: W,
    found: Factors<T>,
}

/// The part of the solution that depends on the matrix only.
enum Factors<T> {
    None,
    /// A cable and 1/W.
    One(usize, T),
    /// Two cables and the data of their matrix.
    TwoByTwo([usize; 2], TwoByTwo<T>),
    /// Three or more are eliminated for each q.
    Many(TautSet),
}

impl<T: Real, W: Fn(usize, usize) -> T> Factored<T, W> {
    #[inline(always)]
    pub(crate) fn new(set: TautSet, w: W) -> Self {
        let mut cables = set.iter();
        let found = match (cables.next(), cables.next(), cables.next()) {
            (None, ..) => Factors::None,
            (Some(i), None, _) => Factors::One(i, T::ONE / w(i, i)),
            (Some(i), Some(j), None) => {
                Factors::TwoByTwo([i, j], TwoByTwo::new([w(i, i), w(i, j), w(j, j)]))
            }
            _ => Factors::Many(set),
        };
        Self { w, found }
    }

    /// The solution z for the first two cables, if there are no more.
    #[inline(always)]
    pub(crate) fn solve_two(&self, q: [T; 2]) -> [T; 2] {
        match self.found {
            Factors::One(0, inverse) => [q[0] * inverse, T::ZERO],
            Factors::One(_, inverse) => [T::ZERO, q[1] * inverse],
            Factors::TwoByTwo(_, ref matrix) => matrix.solve(q),
            _ => [T::ZERO; 2],
        }
    }

    /// The solution z.
    #[inline(always)]
    pub(crate) fn solve(&self, q: &PerCable<T>) -> PerCable<T> {
        let mut z = [T::ZERO; MAX_CABLES];
        match self.found {
            Factors::None => {}
            Factors::One(i, inverse) => z[i] = q[i] * inverse,
            Factors::TwoByTwo([i, j], ref matrix) => [z[i], z[j]] = matrix.solve([q[i], q[j]]),
            Factors::Many(set) => z = eliminate_and_refine(set, &self.w, q),
        }
        z
    }
}

/// Solves W z = q over the cables of a set ([`Factored`]).
#[inline(always)]
pub(crate) fn solve<T: Real>(
    set: TautSet,
    w: impl Fn(usize, usize) -> T,
    q: &PerCable<T>,
) -> PerCable<T> {
    Factored::new(set, w).solve(q)
}

/// Two equations with the matrix \[\[a, b\], \[b, c\]\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoByTwo<T> {
    matrix: [T; 3],
    /// 1/(ac − b²); none if the two constraints are identical up to rounding.
    inverse: Option<T>,
    /// Whether ac − b² is much smaller than ac.
    slanted: bool,
}

impl<T: Real> TwoByTwo<T> {
    #[inline(always)]
    fn new(matrix: [T; 3]) -> Self {
        let [a, b, c] = matrix;
        let determinant = a * c - b * b;
        Self {
            matrix,
            inverse: (!in_line(matrix)).then(|| T::ONE / determinant),
            slanted: determinant < a * c * SLANTED,
        }
    }

    /// The error of Cramer's rule is some roundings times ac over the determinant, which is small
    /// if the cables are almost in line; then the solution is refined twice with its residual.
    #[inline(always)]
    fn solve(&self, q: [T; 2]) -> [T; 2] {
        apart!(T, {
            let Some(inverse) = self.inverse else {
                return [q[0] / self.matrix[0], T::ZERO];
            };
            let z = cramer(self.matrix, inverse, q);
            if self.slanted {
                return refined_twice(self.matrix, inverse, q, z);
            }
            z
        })
    }
}

/// Several of them side by side, none with two constraints that are identical.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoByTwoLanes<L> {
    matrix: [L; 3],
    inverse: L,
    /// Positive where ac − b² is much smaller than ac.
    slanted: L,
}

impl<L: Doubles> TwoByTwoLanes<L> {
    /// Equations with the unit matrix.
    pub(crate) fn unit() -> Self {
        Self {
            matrix: [L::ONE, L::ZERO, L::ONE],
            inverse: L::ONE,
            slanted: L::ZERO,
        }
    }

    /// Puts the equations of both cables into a lane; returns whether there are such.
    pub(crate) fn put<W>(&mut self, lane: usize, equations: &Factored<f64, W>) -> bool {
        let Factors::TwoByTwo([0, 1], two) = &equations.found else {
            return false;
        };
        let Some(inverse) = two.inverse else {
            return false;
        };
        for (all, one) in self.matrix.iter_mut().zip(two.matrix) {
            all.set(lane, one);
        }
        self.inverse.set(lane, inverse);
        self.slanted.set(lane, f64::from(u8::from(two.slanted)));
        true
    }

    /// [`TwoByTwo::solve`], lane by lane.
    #[inline(always)]
    pub(crate) fn solve(&self, q: [L; 2]) -> [L; 2] {
        let z = cramer(self.matrix, self.inverse, q);
        let slanted = L::ZERO.below(self.slanted);
        if slanted.any() {
            let refined = refined_twice(self.matrix, self.inverse, q, z);
            return select_each(slanted, refined, z);
        }
        z
    }
}

#[inline(always)]
fn cramer<L: Lane>([a, b, c]: [L; 3], inverse: L, q: [L; 2]) -> [L; 2] {
    [
        (c * q[0] - b * q[1]) * inverse,
        (a * q[1] - b * q[0]) * inverse,
    ]
}

#[inline(always)]
fn refined_twice<L: Lane>(matrix: [L; 3], inverse: L, q: [L; 2], mut z: [L; 2]) -> [L; 2] {
    let [a, b, c] = matrix;
    for _ in 0..2 {
        let left = [(q[0] - b * z[1]) - a * z[0], (q[1] - b * z[0]) - c * z[1]];
        let more = cramer(matrix, inverse, left);
        z = [z[0] + more[0], z[1] + more[1]];
    }
    z
}

/// Whether the two constraints of the matrix \[\[a, b\], \[b, c\]\] are identical up to rounding.
fn in_line<T: Real>([a, b, c]: [T; 3]) -> bool {
    a * c - b * b <= a * c * (T::EPSILON * NEARLY_ONE_LINE)
}

/// Three and more equations, refined twice with the residual: the tensions of three almost
/// dependent cables are large, and their sum must not move the body.
fn eliminate_and_refine<T: Real>(
    set: TautSet,
    w: impl Fn(usize, usize) -> T,
    q: &PerCable<T>,
) -> PerCable<T> {
    let table = tabulated(set, w);
    let w = |i: usize, j: usize| table[i][j];
    let mut z = eliminate(set, w, q).0;
    for _ in 0..2 {
        let mut left = [T::ZERO; MAX_CABLES];
        for i in set.iter() {
            left[i] = set.iter().fold(q[i], |sum, j| sum - w(i, j) * z[j]);
        }
        let more = eliminate(set, w, &left).0;
        for i in set.iter() {
            z[i] += more[i];
        }
    }
    z
}

/// Solves by elimination in the order of the cables; also returns those that do not depend on the
/// ones before them, to which the solution is restricted.
fn eliminate<T: Real>(
    set: TautSet,
    w: impl Fn(usize, usize) -> T,
    q: &PerCable<T>,
) -> (PerCable<T>, TautSet) {
    let mut rows = tabulated(set, w);
    let mut z = *q;
    let largest = set.iter().fold(T::ZERO, |most, i| most.max(rows[i][i]));
    let mut kept = TautSet::SLACK;
    for k in set.iter() {
        if rows[k][k] <= largest * DEPENDENT {
            continue;
        }
        kept = kept.with(k);
        for i in set.iter().filter(|&i| i > k) {
            let factor = rows[i][k] / rows[k][k];
            for j in set.iter().filter(|&j| j >= k) {
                rows[i][j] -= factor * rows[k][j];
            }
            z[i] -= factor * z[k];
        }
    }
    let mut solution = [T::ZERO; MAX_CABLES];
    for k in (0..MAX_CABLES).rev().filter(|&k| kept.contains(k)) {
        let mut sum = z[k];
        for j in kept.iter().filter(|&j| j > k) {
            sum -= rows[k][j] * solution[j];
        }
        solution[k] = sum / rows[k][k];
    }
    (solution, kept)
}

/// Finds z ≥ 0 with W z − q ≥ 0 and z · (W z − q) = 0 over the cables of a set, by trying all sets
/// of cables with z > 0. Returns z and that set.
///
/// With W positive definite the solution exists and is unique (Cottle, Pang & Stone, The Linear
/// Complementarity Problem, theorem 3.1.6), so exactly one trial passes in exact arithmetic;
/// rounding can make all of them fail by a last bit, so the one with the least violation is taken.
pub(crate) fn complementary<T: Real>(
    set: TautSet,
    w: impl Fn(usize, usize) -> T,
    q: &PerCable<T>,
) -> (PerCable<T>, TautSet) {
    let table = tabulated(set, w);
    let w = |i: usize, j: usize| table[i][j];
    let mut best = ([T::ZERO; MAX_CABLES], TautSet::SLACK);
    let mut least = None;
    // Any impulse of more cables can be produced by three independent ones (Carathéodory).
    for pulling in set.subsets().filter(|set| set.len() <= FREEDOMS) {
        let z = solve(pulling, w, q);
        let mut violation = T::ZERO;
        for i in set.iter() {
            let short = if pulling.contains(i) {
                -z[i] * w(i, i)
            } else {
                pulling.iter().fold(q[i], |sum, j| sum - w(i, j) * z[j])
            };
            violation = violation.max(short);
        }
        if least.is_none_or(|least| violation < least) {
            best = (z, pulling);
            least = Some(violation);
            if violation == T::ZERO {
                break;
            }
        }
    }
    let (mut z, pulling) = best;
    for value in &mut z {
        *value = value.max(T::ZERO);
    }
    (z, pulling.iter().filter(|&i| z[i] > T::ZERO).collect())
}

/// The entries of a matrix over a set of cables, where each is needed many times.
pub(crate) fn tabulated<T: Real>(
    set: TautSet,
    w: impl Fn(usize, usize) -> T,
) -> PerCable<PerCable<T>> {
    let mut table = [[T::ZERO; MAX_CABLES]; MAX_CABLES];
    for i in set.iter() {
        for j in set.iter() {
            table[i][j] = w(i, j);
        }
    }
    table
}

/// Whether no cable's constraint depends on those of the others.
pub(crate) fn independent<T: Real>(set: TautSet, w: impl Fn(usize, usize) -> T) -> bool {
    let mut cables = set.iter();
    match (cables.next(), cables.next(), set.len()) {
        (_, None, _) => return true,
        (Some(i), Some(j), 2) => return !in_line([w(i, i), w(i, j), w(j, j)]),
        (.., count) if count > FREEDOMS => return false,
        _ => {}
    }
    eliminate(set, w, &[T::ZERO; MAX_CABLES]).1 == set
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::least_norm::least_norm;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// A unit normal and a lever arm.
    fn row() -> impl Strategy<Value = [f64; 3]> {
        (0.0..std::f64::consts::TAU, -1.0..1.0)
            .prop_map(|(angle, arm): (f64, f64)| [angle.cos(), angle.sin(), arm])
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: RngSeed::Fixed(1999),
            ..ProptestConfig::default()
        })]

        /// The defining conditions hold for random Gram matrices of rank 1 to 3, up to 6 cables,
        /// and normal velocities that a body can have.
        #[test]
        fn conditions_hold(rows in proptest::collection::vec(row(), 1..7),
                           v in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]) {
            let set: TautSet = (0..rows.len()).collect();
            let w = |i: usize, j: usize| -> f64 { (0..3).map(|k| rows[i][k] * rows[j][k]).sum() };
            let mut load = [0.0; MAX_CABLES];
            for (load, row) in load.iter_mut().zip(&rows) {
                *load = (0..3).map(|k| row[k] * v[k]).sum();
            }
            let (z, pulling) = complementary(set, w, &load);
            for i in set.iter() {
                let slackness: f64 = set.iter().map(|j| w(i, j) * z[j]).sum::<f64>() - load[i];
                prop_assert!(z[i] >= 0.0 && slackness >= -1e-9);
                prop_assert!((z[i] * slackness).abs() < 1e-6);
                prop_assert_eq!(pulling.contains(i), z[i] > 0.0);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: RngSeed::Fixed(1999),
            ..ProptestConfig::default()
        })]

        /// Three to six cables of a body with three degrees of freedom: where W⁺q, the least-norm
        /// solution by an eigenvalue decomposition of another library, has no negative entry, our
        /// solution equals it; and its norm never exceeds that of another set of impulses with the
        /// same effect.
        #[test]
        fn dependent_cables_share_with_the_least_norm(
            rows in prop::collection::vec(row(), 3..7),
            pulls in prop::collection::vec(0.0..1.0f64, 6),
        ) {
            let n = rows.len();
            let set: TautSet = (0..n).collect();
            let w = |i: usize, j: usize| -> f64 { (0..3).map(|k| rows[i][k] * rows[j][k]).sum() };
            let mut q = [0.0; MAX_CABLES];
            for (i, load) in q.iter_mut().enumerate().take(n) {
                *load = (0..n).map(|j| w(i, j) * pulls[j]).sum();
            }
            let matrix = nalgebra::DMatrix::from_fn(n, n, w);
            let eigen = matrix.symmetric_eigen();
            // nalgebra's pseudo-inverse is wrong for some singular matrices.
            let inverse = eigen.eigenvalues.map(|value| if value > 1e-9 { 1.0 / value } else { 0.0 });
            let inverse = &eigen.eigenvectors * nalgebra::DMatrix::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
            let mut values: Vec<f64> = eigen.eigenvalues.iter().copied().collect();
            values.sort_by(|a, b| b.total_cmp(a));
            // For nearly dependent cables the solution is not well determined.
            prop_assume!(values[2] > 1e-2 * values[0]);
            let pseudo = inverse * nalgebra::DVector::from_fn(n, |i, _| q[i]);
            let (z, _) = complementary(set, w, &q);
            let ours = least_norm(set, w, &q, z);
            let norm = |z: &[f64]| z.iter().map(|z| z * z).sum::<f64>().sqrt();
            for i in set.iter() {
                let acts: f64 = (0..n).map(|j| w(i, j) * ours[j]).sum();
                prop_assert!(ours[i] >= 0.0 && (acts - q[i]).abs() < 1e-8, "{acts} {}", q[i]);
            }
            prop_assert!(norm(&ours) <= norm(&pulls[..n]) * (1.0 + 1e-8));
            if pseudo.iter().all(|z| *z >= 0.0) {
                for i in set.iter() {
                    prop_assert!((ours[i] - pseudo[i]).abs() < 1e-7, "{ours:?} {pseudo:?}");
                }
            }
        }

        /// The impulses of independent cables keep every bit.
        #[test]
        fn independent_cables_keep_their_impulses(
            rows in prop::collection::vec(row(), 1..4),
            q in prop::collection::vec(-1.0..1.0f64, 3),
        ) {
            let set: TautSet = (0..rows.len()).collect();
            let w = |i: usize, j: usize| -> f64 { (0..3).map(|k| rows[i][k] * rows[j][k]).sum() };
            let mut load = [0.0; MAX_CABLES];
            load[..3].copy_from_slice(&q);
            let (z, _) = complementary(set, w, &load);
            if independent(set, w) {
                prop_assert_eq!(least_norm(set, w, &load, z), z);
            }
        }
    }

    /// Two equal constraints: together they hold what one of them can hold, each of them half.
    #[test]
    fn twins_share_evenly_and_no_load_twice() {
        let pair = TautSet::only(0).with(1);
        let mut q = [0.0; MAX_CABLES];
        (q[0], q[1]) = (3.0, 3.0);
        let (z, _) = complementary(pair, |_, _| 2.0, &q);
        assert_eq!(z[0] + z[1], 1.5);
        let shared = least_norm(pair, |_, _| 2.0, &q, z);
        assert!((shared[0] - 0.75).abs() < 1e-15 && (shared[1] - 0.75).abs() < 1e-15);
    }
}
