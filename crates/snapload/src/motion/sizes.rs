//! The sizes of the summands of accelerations and tensions: where forces cancel each other, their
//! roundings do not.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::real::Real;
use crate::model::forcing::Harmonic;
use crate::model::mass::{Mass, Matrix3, times};
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::Factored;

/// A tension below this part of its summands counts as zero where taut cables depend on each other:
/// without a tension that much below zero its cable opens by more than
/// [`SHARED`](crate::motion::least_norm::SHARED).
pub(crate) const NEGLIGIBLE: f64 = 3e-8;

/// Below what the tension of each of some independent cables counts as zero where taut cables
/// depend on each other, given these tensions.
#[cold]
#[inline(never)]
pub(crate) fn negligible_tensions<T: Real>(
    system: &System<T>,
    state: &State<T>,
    memory_force: [T; 3],
    carrying: TautSet,
    tension: &PerCable<T>,
) -> PerCable<T> {
    let part = T::from_decimal(NEGLIGIBLE);
    sizes_of_tensions(system, state, memory_force, carrying, tension).map(|size| size * part)
}

/// The sums of the absolute values of all summands of the tensions of some
/// independent cables, given these tensions.
pub(crate) fn sizes_of_tensions<T: Real>(
    system: &System<T>,
    state: &State<T>,
    memory_force: [T; 3],
    carrying: TautSet,
    tension: &PerCable<T>,
) -> PerCable<T> {
    let free_size = size_of_free_acceleration(system, state, memory_force);
    let normals = system.normals(state, carrying);
    let w = |i: usize, j: usize| system.body.mass.coupling(&normals[i], &normals[j]);
    let ready = Factored::new(carrying, w);
    let mut sizes = [T::ZERO; MAX_CABLES];
    for source in carrying.iter() {
        let mut load = [T::ZERO; MAX_CABLES];
        load[source] = carrying
            .iter()
            .fold(size_of_load(system, source, state, free_size), |size, j| {
                size + (w(source, j) * tension[j]).abs()
            });
        let parts = ready.solve(&load);
        for cable in carrying.iter() {
            sizes[cable] += parts[cable].abs();
        }
    }
    sizes
}

/// The sums of the absolute values of all summands of [`System::free_acceleration`]: where forces
/// cancel each other, their roundings do not.
pub(crate) fn size_of_free_acceleration<T: Real>(
    system: &System<T>,
    state: &State<T>,
    memory_force: [T; 3],
) -> [T; 3] {
    let mass = &system.body.mass;
    let place = [state.x, state.y, state.theta].map(T::abs);
    let speed = [state.vx, state.vy, state.vtheta].map(T::abs);
    let forcing = &system.forcing;
    let [x, y] = sum_of_sizes(forcing.constant.map(T::abs), &forcing.harmonics).components();
    let mut load = [x, y, T::ZERO];
    if let Some(drag) = &system.drag {
        let water = sum_of_sizes([speed[0], speed[1]].into(), &drag.water);
        let factor = drag.linear + drag.quadratic * water.length();
        load[0] += factor * water.x;
        load[1] += factor * water.y;
        load[2] += mass.load_of_turning(drag.turning * speed[2]);
    }
    if let Some(water) = &system.floating {
        let sizes = |matrix: &Matrix3<T>| matrix.map(|row| row.map(T::abs));
        let stiff = times(&sizes(&water.stiffness), place);
        let damped = times(&sizes(&water.damping), speed);
        let wave = |i: usize| {
            let sizes = water.excitation.iter();
            sizes.fold(water.constant[i].abs(), |sum, wave| {
                sum + wave.cosine[i].abs() + wave.sine[i].abs()
            })
        };
        for (i, load) in load.iter_mut().enumerate().take(2) {
            *load += wave(i) + stiff[i] + damped[i] + memory_force[i].abs();
        }
        let moment = wave(2) + stiff[2] + damped[2] + memory_force[2].abs();
        load[2] += mass.load_of_moment(moment);
    }
    match mass {
        Mass::Unit { .. } => load,
        Mass::Full { inverse, .. } => times(&inverse.map(|row| row.map(T::abs)), load),
    }
}

/// The sum of some sizes and the largest possible ones of some sinusoids.
fn sum_of_sizes<T: Real>(of_others: Vector2<T>, sinusoids: &[Harmonic<T>]) -> Vector2<T> {
    sinusoids.iter().fold(of_others, |sum, wave| {
        sum + wave.cosine.map(T::abs) + wave.sine.map(T::abs)
    })
}

/// A bound on the summands of the normal acceleration without any cable force, times the factor by
/// which a rounding of the positions turns the cable.
pub(crate) fn size_of_load<T: Real>(
    system: &System<T>,
    cable: usize,
    state: &State<T>,
    [x, y, turning]: [T; 3],
) -> T {
    let tether = &system.cables[cable];
    let reach = tether.fairlead().length();
    let spin = state.vtheta.abs();
    let speed = state.velocity().length() + spin * reach;
    let size = Vector2 { x, y }.length()
        + turning.abs() * reach
        + speed.squared() / tether.length()
        + spin.squared() * reach;
    let place = state.centre().length() + reach + tether.anchor().length();
    size * (T::ONE + place / tether.length())
}
