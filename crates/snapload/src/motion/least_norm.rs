//! The distribution of impulses where more cables hold than the body has degrees of freedom: the
//! impulses of least norm.

use crate::arithmetic::real::Real;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::{independent, solve, tabulated};

/// Every subset is tried if at most this many cables are involved.
const MOST_TRIED: usize = 6;
/// Normal velocities that differ by less than this part of the largest load count as equal.
pub(crate) const SHARED: f64 = 1e-9;

/// Of all impulses z ≥ 0 with the same effect on the body as `z`, those of least norm.
///
/// Where more cables close at once than the body has degrees of freedom, W is singular: the motion
/// after the impact is unique, the distribution of the impulses is not.
/// [`crate::motion::complementarity`] finds a solution with as few cables as possible; here the
/// load is spread over all `held` cables that have no normal velocity in that solution. For each
/// set S of them the least norm is z = W y with W W y = W z over S, since the admissible z are
/// combinations of the rows of G, which span W's range; of the sets without a negative impulse the
/// one of least norm is taken.
///
/// Sets without dependent cables are returned as they are. If one of more than [`MOST_TRIED`]
/// cables would have a negative impulse, not every set is tried, and the norm may be more than the
/// least.
pub(crate) fn least_norm<T: Real>(
    held: TautSet,
    w: impl Fn(usize, usize) -> T,
    q: &PerCable<T>,
    z: PerCable<T>,
) -> PerCable<T> {
    if held.len() < 2 {
        return z;
    }
    let table = tabulated(held, w);
    let w = |i: usize, j: usize| table[i][j];
    let product =
        |i: usize, z: &PerCable<T>| held.iter().fold(T::ZERO, |sum, j| sum + w(i, j) * z[j]);
    let size = held
        .iter()
        .fold(T::ZERO, |size, i| size.max(z[i] * w(i, i)));
    let close = size * T::from_decimal(SHARED);
    let tight: TautSet = held
        .iter()
        .filter(|&i| (product(i, &z) - q[i]).abs() <= close)
        .collect();
    if independent(tight, w) {
        return z;
    }
    let does_the_same = |shared: &PerCable<T>| {
        held.iter()
            .all(|i| (product(i, shared) - product(i, &z)).abs() <= close)
    };
    let share = |set: TautSet| {
        let shared = spread(set, &w, &z, &product);
        let pulls = set.iter().all(|i| shared[i] >= T::ZERO);
        (pulls && does_the_same(&shared)).then_some(shared)
    };
    // If none of them would have a negative impulse, no subset has a smaller norm than all.
    if let Some(shared) = share(tight) {
        return shared;
    }
    let norm = |z: &PerCable<T>| tight.iter().fold(T::ZERO, |sum, i| sum + z[i] * z[i]);
    let shorter = |best: PerCable<T>, shared: PerCable<T>| {
        if norm(&shared) < norm(&best) {
            shared
        } else {
            best
        }
    };
    if tight.len() <= MOST_TRIED {
        let sets = tight.subsets().filter(|set| !set.is_empty());
        return sets.filter_map(share).fold(z, shorter);
    }
    match without_pushing(tight, |set| spread(set, &w, &z, &product)) {
        Some(shared) if does_the_same(&shared) => shorter(z, shared),
        _ => z,
    }
}

/// The impulses that remain when the cable with the most negative impulse is removed until none is
/// negative; none if fewer than two cables remain.
fn without_pushing<T: Real>(
    mut set: TautSet,
    share: impl Fn(TautSet) -> PerCable<T>,
) -> Option<PerCable<T>> {
    while set.len() > 1 {
        let shared = share(set);
        let hardest = set
            .iter()
            .reduce(|a, b| if shared[b] < shared[a] { b } else { a })?;
        if shared[hardest] < T::ZERO {
            set = set.without(hardest);
        } else {
            return Some(shared);
        }
    }
    None
}

/// The z = W y over a set with the same effect on it as `z`, with one step of refinement.
fn spread<T: Real>(
    set: TautSet,
    w: &impl Fn(usize, usize) -> T,
    z: &PerCable<T>,
    product: &impl Fn(usize, &PerCable<T>) -> T,
) -> PerCable<T> {
    let square = |i: usize, j: usize| set.iter().fold(T::ZERO, |sum, k| sum + w(i, k) * w(k, j));
    let table = tabulated(set, square);
    let square = |i: usize, j: usize| table[i][j];
    let mut shared = [T::ZERO; MAX_CABLES];
    for _ in 0..2 {
        let mut left = [T::ZERO; MAX_CABLES];
        for i in set.iter() {
            left[i] = product(i, z) - product(i, &shared);
        }
        let y = solve(set, square, &left);
        for i in set.iter() {
            shared[i] += set.iter().fold(T::ZERO, |sum, k| sum + w(i, k) * y[k]);
        }
    }
    shared
}
