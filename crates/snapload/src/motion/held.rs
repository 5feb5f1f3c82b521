//! Motion and laws whose sets of cables are given, not found.
//!
//! A [`crate::Simulation`] finds out which cables carry. Whoever asks for a motion with a prescribed
//! sequence of events, whether or not a body would have it, gives the sets instead: cables are held
//! at their lengths whatever the signs of their tensions, impulses are what the law asks for whatever
//! their signs, and time may run backwards. So all of it is smooth in state, time and parameters,
//! which Newton's method on a sequence of events needs.

use crate::arithmetic::real::Real;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::{ActiveSet, tensions};
use crate::motion::attachment::Instant;
use crate::motion::complementarity::solve;
use crate::motion::contact::Contact;
use crate::motion::projection::{project_position, project_velocity};
use crate::motion::taut_series::Series;
use crate::motion::waves::Waves;

/// The motions of a system with given sets of taut cables; the water keeps no memory of them.
#[derive(Clone, Debug)]
pub struct Held<T: Real = f64> {
    system: System<T>,
}

impl<T: Real> Held<T> {
    /// Of a system.
    pub fn new(system: System<T>) -> Self {
        Self { system }
    }

    /// The system.
    pub fn system(&self) -> &System<T> {
        &self.system
    }

    /// The state a time `s`, of either sign, after `state` at time `t`, the cables of `taut` being
    /// held, none of which may depend on the others.
    pub fn carried(&self, taut: TautSet, t: T, state: &State<T>, s: T) -> State<T> {
        if self.system.flies_freely(taut) {
            self.flown(t, state, s)
        } else {
            self.driven(taut, t, state, s)
        }
    }

    /// Slack flight in closed form (docs/model.md section 4).
    fn flown(&self, t: T, state: &State<T>, s: T) -> State<T> {
        let forcing = &self.system.forcing;
        let mut flight = Instant::at(s, forcing.constant, state.vtheta);
        for harmonic in &forcing.harmonics {
            flight = flight.with(&harmonic.shifted(t), s);
        }
        flight.state(state, s)
    }

    /// Taylor series after Taylor series.
    fn driven(&self, taut: TautSet, mut t: T, state: &State<T>, mut s: T) -> State<T> {
        let mut series = Box::new(Series::new(&self.system, &Rules::until(T::ZERO)));
        let mut waves = Waves::new(&self.system);
        let mut state = *state;
        loop {
            let mut contacts = [Contact::RESTING; MAX_CABLES];
            for cable in self.system.all_cables().iter() {
                if !taut.contains(cable) {
                    contacts[cable] = Contact::evaluated(&self.system, cable, &state);
                }
            }
            let active = ActiveSet {
                taut,
                carrying: taut,
            };
            waves.cover(t, t);
            let around = waves.expanded(&self.system, t);
            series.begin(&self.system, &around, &state, &[], &contacts, active);
            let step = T::from_f64(series.step().to_f64());
            if step <= T::ZERO || !step.is_finite() || s.abs() <= step {
                return series.state(s);
            }
            let step = if s < T::ZERO { -step } else { step };
            state = series.state(step);
            (t, s) = (t + step, s - step);
        }
    }

    /// The tensions that hold the cables of `taut`, of either sign.
    pub fn tensions(&self, taut: TautSet, t: T, state: &State<T>) -> PerCable<T> {
        let around = self.system.surroundings(t);
        tensions(&self.system, &around, state, [T::ZERO; 3], taut)
    }

    /// The impact of `struck` cables, of which and of others `pulling` ones take up impulses of
    /// either sign (docs/model.md section 5): v⁺ = −e v⁻ for struck ones, 0 for the others.
    pub fn struck(
        &self,
        state: &State<T>,
        struck: TautSet,
        pulling: TautSet,
    ) -> (State<T>, PerCable<T>) {
        let mass = &self.system.body.mass;
        let normals = self.system.normals(state, pulling);
        let mut load = [T::ZERO; MAX_CABLES];
        for cable in pulling.iter() {
            let v_n = normals[cable].velocity(state);
            load[cable] = if struck.contains(cable) {
                v_n * (T::ONE + self.system.restitution)
            } else {
                v_n
            };
        }
        let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
        let impulse = solve(pulling, w, &load);
        let mut after = *state;
        for cable in pulling.iter() {
            mass.apply_impulse(&normals[cable], &mut after, impulse[cable]);
        }
        (after, impulse)
    }

    /// Moved by the least change in the mass metric so that the gaps of `closed` cables are zero,
    /// and the normal velocities of `still` ones.
    pub fn projected(&self, state: &State<T>, closed: TautSet, still: TautSet) -> State<T> {
        let mut state = *state;
        project_position(&self.system, &mut state, closed);
        project_velocity(&self.system, &mut state, still);
        state
    }
}
