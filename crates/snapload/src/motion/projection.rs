//! Projection onto the constraints: a state that rounding has moved off a closed cable is changed
//! by the least amount.

use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, TautSet};
use crate::motion::complementarity::solve;

/// Moves the body by the least distance in the mass metric so that the gaps of a set close.
///
/// As many Newton steps as a start's tolerance of 1e-9 may need.
#[inline(always)]
pub(crate) fn project_position<T: Real>(system: &System<T>, state: &mut State<T>, set: TautSet) {
    apart!(T, {
        let mass = &system.body.mass;
        for _ in 0..T::NEWTON_STEPS {
            let normals = system.normals(state, set);
            let mut distance = [T::ZERO; MAX_CABLES];
            for cable in set.iter() {
                let tether = &system.cables[cable];
                distance[cable] = tether.gap(state) / (tether.length() * 2.0);
            }
            let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
            let shift = solve(set, w, &distance);
            for cable in set.iter() {
                mass.displace(&normals[cable], state, shift[cable]);
            }
        }
    })
}

/// Takes the normal velocities of a set to zero by the least change in the mass metric.
#[inline(always)]
pub(crate) fn project_velocity<T: Real>(system: &System<T>, state: &mut State<T>, set: TautSet) {
    apart!(T, {
        let mass = &system.body.mass;
        let normals = system.normals(state, set);
        let mut velocity = [T::ZERO; MAX_CABLES];
        for cable in set.iter() {
            velocity[cable] = normals[cable].velocity(state);
        }
        let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
        let kick = solve(set, w, &velocity);
        for cable in set.iter() {
            mass.apply_impulse(&normals[cable], state, kick[cable]);
        }
    })
}
