//! Which cables stay taut, and their tensions.

use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::{complementary, independent, solve};
use crate::motion::least_norm::{SHARED, least_norm};

/// The mode of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ActiveSet {
    /// The taut cables.
    pub(crate) taut: TautSet,
    /// A largest independent subset of these, whose tensions determine the motion. The others, such
    /// as the twin of a taut cable, stay closed with them.
    pub(crate) carrying: TautSet,
}

/// The cables that are taut from now on, among closed ones without normal velocity, by the
/// complementarity problem on accelerations (docs/model.md section 6):
///
/// ```text
/// 0 ≤ T  ⟂  −g̈ ≥ 0,    g̈/(2r) = b − W T
/// ```
///
/// The problem is solved with as few cables as possible. If others stay closed as well, g̈ = 0, and
/// all of them are dependent, all are taut, and an independent subset carries.
#[inline(always)]
pub(crate) fn taut_next<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    candidates: TautSet,
) -> ActiveSet {
    apart!(T, {
        if candidates.is_empty() {
            return ActiveSet::default();
        }
        let (w, load) = problem(system, around, state, memory_force, candidates);
        let (tension, pulling) = complementary(candidates, w, &load);
        let stays_closed = |&cable: &usize| {
            let acceleration_by_tensions = |j: usize| w(cable, j) * tension[j];
            let left = pulling
                .iter()
                .fold(load[cable], |sum, j| sum - acceleration_by_tensions(j));
            let size = pulling.iter().fold(load[cable].abs(), |sum, j| {
                sum + acceleration_by_tensions(j).abs()
            });
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
/// Where more cables are taut than the body has degrees of freedom, or one lies along another,
/// these are the tensions of least norm, as in cables of equal stiffness per length.
#[inline(always)]
pub(crate) fn tensions<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    taut: TautSet,
) -> PerCable<T> {
    let (w, load) = problem(system, around, state, memory_force, taut);
    if independent(taut, w) {
        return solve(taut, w, &load);
    }
    // At the instant at which a tension is lost rounding may have made it negative; it counts as
    // zero then.
    let (_, pulling) = complementary(taut, w, &load);
    let tension = solve(pulling, w, &load);
    least_norm(taut, w, &load, tension)
}

/// Tensions that produce the motion: where taut cables are dependent, one solution of many.
#[inline(always)]
fn some_tensions<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    taut: TautSet,
) -> PerCable<T> {
    let (w, load) = problem(system, around, state, memory_force, taut);
    solve(taut, w, &load)
}

/// (ẍ, ÿ, θ̈) with the tensions of the cables of `taut`: M⁻¹ (f − Σ T Gᵀ), for a unit mass f(t) − Σ
/// T n and −Σ T s/I (docs/model.md section 6).
#[inline(always)]
pub(crate) fn acceleration<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    taut: TautSet,
) -> [T; 3] {
    let free = system.free_acceleration(around, state, memory_force);
    if taut.is_empty() {
        return free;
    }
    let (normals, mass) = (system.normals(state, taut), &system.body.mass);
    let load = free_normal_accelerations(system, state, free, taut);
    let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
    let tension = solve(taut, w, &load);
    let mut acceleration = free;
    for cable in taut.iter() {
        acceleration = mass.less(acceleration, &normals[cable], tension[cable]);
    }
    acceleration
}

/// g̈/(2r) of a closed cable with the tensions of the cables of `taut`.
#[inline(always)]
pub(crate) fn normal_acceleration<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    cable: usize,
    taut: TautSet,
) -> T {
    let tension = some_tensions(system, around, state, memory_force, taut);
    let (w, load) = problem(system, around, state, memory_force, taut.with(cable));
    taut.iter()
        .fold(load[cable], |sum, j| sum - w(cable, j) * tension[j])
}

/// W and b of g̈/(2r) = b − W T.
#[inline(always)]
fn problem<T: Real>(
    system: &System<T>,
    around: &Surroundings<T>,
    state: &State<T>,
    memory_force: [T; 3],
    set: TautSet,
) -> (impl Fn(usize, usize) -> T + Copy, PerCable<T>) {
    let free = system.free_acceleration(around, state, memory_force);
    let load = free_normal_accelerations(system, state, free, set);
    let (normals, mass) = (system.normals(state, set), &system.body.mass);
    let w = move |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
    (w, load)
}

/// b: the normal accelerations that cables have without tensions.
#[inline(always)]
fn free_normal_accelerations<T: Real>(
    system: &System<T>,
    state: &State<T>,
    free: [T; 3],
    set: TautSet,
) -> PerCable<T> {
    let mut load = [T::ZERO; MAX_CABLES];
    for cable in set.iter() {
        load[cable] = system.free_normal_acceleration(cable, state, free);
    }
    load
}
