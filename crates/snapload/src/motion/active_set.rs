//! Which cables stay taut, and what they carry.

use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::{complementary, independent, solve};
use crate::motion::least_norm::{SHARED, least_norm};

/// The mode of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ActiveSet {
    /// The taut cables.
    pub(crate) taut: TautSet,
    /// Of these, as few as make up the motion, none of them depending on others. The rest, such as
    /// the twin of a taut cable, stays closed with them.
    pub(crate) carrying: TautSet,
}

/// The cables that are taut from now on, among closed ones without normal velocity, by the
/// complementarity problem on accelerations (docs/model.md section 6):
///
/// ```text
/// 0 ≤ T  ⟂  −g̈ ≥ 0,    g̈/(2r) = b − W T
/// ```
///
/// The problem is solved with as few cables as will do. Where others stay closed as well, g̈ = 0,
/// and all of them depend on each other, all are taut, and as many carry as there are directions to
/// hold.
#[inline(always)]
pub(crate) fn taut_next<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    candidates: TautSet,
) -> ActiveSet {
    apart!(T, {
        if candidates.is_empty() {
            return ActiveSet::default();
        }
        let (w, load) = problem(system, t, state, candidates);
        let (tension, pulling) = complementary(candidates, w, &load);
        let stays_closed = |&cable: &usize| {
            let pulls = |j: usize| w(cable, j) * tension[j];
            let left = pulling.iter().fold(load[cable], |sum, j| sum - pulls(j));
            let size = pulling
                .iter()
                .fold(load[cable].abs(), |sum, j| sum + pulls(j).abs());
            left.abs() <= size * T::from_decimal(SHARED)
        };
        let others: TautSet = candidates
            .iter()
            .filter(|&cable| !pulling.contains(cable))
            .filter(stays_closed)
            .collect();
        let taut = pulling.union(others);
        if pulling.is_empty() || others.is_empty() || independent(taut, w) {
            return ActiveSet {
                taut: pulling,
                carrying: pulling,
            };
        }
        let carrying = others.iter().fold(pulling, |carrying, cable| {
            let more = carrying.with(cable);
            if independent(more, w) { more } else { carrying }
        });
        ActiveSet { taut, carrying }
    })
}

/// The tensions of the taut cables: W T = b.
///
/// Where more cables are taut than the body has freedoms for, or one lies along another, these are
/// the tensions of the least norm: those of cables that are stretched by the same force per length.
#[inline(always)]
pub(crate) fn tensions<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    taut: TautSet,
) -> PerCable<T> {
    let (w, load) = problem(system, t, state, taut);
    if independent(taut, w) {
        return solve(taut, w, &load);
    }
    // At the instant at which a tension is lost rounding may have made it negative; it is none
    // then.
    let (_, pulling) = complementary(taut, w, &load);
    let tension = solve(pulling, w, &load);
    least_norm(taut, w, &load, tension)
}

/// Tensions that move the body as it moves: where taut cables depend on each other, one solution of
/// many.
#[inline(always)]
fn some_tensions<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    taut: TautSet,
) -> PerCable<T> {
    let (w, load) = problem(system, t, state, taut);
    solve(taut, w, &load)
}

/// (ẍ, ÿ, θ̈) while the cables of `taut` pull: f(t) − Σ T n and −Σ T s/I (docs/model.md section 6).
#[inline(always)]
pub(crate) fn acceleration<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    taut: TautSet,
) -> [T; 3] {
    let free = system.free_acceleration(t, state);
    if taut.is_empty() {
        return free;
    }
    let tension = some_tensions(system, t, state, taut);
    let inverse_inertia = system.body.inverse_inertia();
    taut.iter().fold(free, |[x, y, theta], cable| {
        let (normal, pull) = (system.cables[cable].normal(state), tension[cable]);
        [
            x - pull * normal.n.x,
            y - pull * normal.n.y,
            theta - pull * normal.arm * inverse_inertia,
        ]
    })
}

/// g̈/(2r) of a closed cable while the cables of `taut` pull.
#[inline(always)]
pub(crate) fn normal_acceleration<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    cable: usize,
    taut: TautSet,
) -> T {
    let tension = some_tensions(system, t, state, taut);
    let (w, load) = problem(system, t, state, taut.with(cable));
    taut.iter()
        .fold(load[cable], |sum, j| sum - w(cable, j) * tension[j])
}

/// W and b of g̈/(2r) = b − W T.
#[inline(always)]
fn problem<T: Real>(
    system: &System<T>,
    t: T,
    state: &State<T>,
    set: TautSet,
) -> (impl Fn(usize, usize) -> T + Copy, PerCable<T>) {
    let free = system.free_acceleration(t, state);
    let mut load = [T::ZERO; MAX_CABLES];
    for cable in set.iter() {
        load[cable] = system.free_normal_acceleration(cable, state, free);
    }
    let (normals, inverse_inertia) = (system.normals(state, set), system.body.inverse_inertia());
    let w = move |i: usize, j: usize| normals[i].coupling(&normals[j], inverse_inertia);
    (w, load)
}
