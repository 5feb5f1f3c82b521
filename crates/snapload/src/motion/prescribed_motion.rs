//! Motion and laws for given sets of cables.
//!
//! A [`crate::Simulation`] determines which cables carry. Where a motion with a prescribed sequence
//! of events is wanted, whether or not a body would have it, the sets are given instead: cables are
//! held at their lengths for either sign of their tensions, impulses are those of the law for
//! either sign, and time may run backwards. So all of it is smooth in state, time and parameters,
//! which Newton's method on a sequence of events needs.

use crate::arithmetic::polynomial::Polynomial;
use crate::arithmetic::processor::{Kernel, dispatch_over};
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
use crate::motion::taut_series::{Series, SeriesStart, state_at};
use crate::motion::waves::Waves;

/// The most series of one motion. A series is followed for a unit of time at most, and a motion on
/// cables takes a few of them for every change of its direction.
const MOST_SERIES: usize = 1 << 20;

/// The motions of a system with given sets of taut cables; the water's memory is not included.
///
/// # Panics
/// All methods that are given a set of cables, if one of them is not a cable of the system.
#[derive(Clone, Debug)]
pub struct PrescribedTaut<T: Real = f64> {
    system: System<T>,
}

impl<T: Real> PrescribedTaut<T> {
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
    ///
    /// With a taut cable, drag or water the work is in proportion to `s`: a unit of time takes one
    /// series or more, and where more than a million would be needed, or `s` is not finite, all
    /// components of the state are NaN.
    pub fn carried(&self, taut: TautSet, t: T, state: &State<T>, s: T) -> State<T> {
        dispatch_over::<T, _>(Carrying {
            prescribed: self,
            taut,
            from: (t, state),
            s,
            kept: None,
        })
    }

    /// The same motion at every time from 0 to `s`: equal to [`PrescribedTaut::carried`] up to
    /// rounding, without computing the motion again for each time.
    pub fn path(&self, taut: TautSet, t: T, state: &State<T>, s: T) -> Path<'_, T> {
        let mut pieces = Vec::new();
        if !self.system.has_closed_form(taut) {
            dispatch_over::<T, _>(Carrying {
                prescribed: self,
                taut,
                from: (t, state),
                s,
                kept: Some(&mut pieces),
            });
        }
        Path {
            prescribed: self,
            from: (t, *state),
            pieces,
        }
    }

    /// Slack flight in closed form (docs/model.md section 4).
    #[inline(always)]
    fn slack_flight(&self, t: T, state: &State<T>, s: T) -> State<T> {
        let forcing = &self.system.forcing;
        let mut flight = Instant::at(s, forcing.constant, state.vtheta);
        for harmonic in &forcing.harmonics {
            flight = flight.with(&harmonic.shifted(t), s);
        }
        flight.state(state, s)
    }

    /// A chain of Taylor series, which are kept if that is asked for.
    #[inline(always)]
    fn by_series(
        &self,
        taut: TautSet,
        (begun, state): (T, &State<T>),
        s: T,
        mut kept: Option<&mut Vec<Piece<T>>>,
    ) -> State<T> {
        let mut series = Box::new(Series::new(&self.system, &Rules::until(T::ZERO)));
        let mut waves = Waves::new(&self.system);
        let (mut t, mut left, mut state) = (begun, s, *state);
        let most = if s.is_finite() { MOST_SERIES } else { 1 };
        for _ in 0..most {
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
            let start = SeriesStart {
                around: &around,
                state: &state,
                memory: &[],
                contacts: &contacts,
                active,
            };
            series.expand(&self.system, &start);
            if let Some(kept) = &mut kept {
                kept.push(Piece {
                    from: t - begun,
                    motion: series.motion(),
                });
            }
            let step = T::from_f64(series.step().to_f64());
            if step <= T::ZERO || !step.is_finite() || left.abs() <= step {
                return series.state(left);
            }
            let step = if left < T::ZERO { -step } else { step };
            state = series.state(step);
            (t, left) = (t + step, left - step);
        }
        State::from_components([(-T::ONE).sqrt(); 6])
    }

    /// The tensions that hold the cables of `taut`, of either sign.
    pub fn tensions(&self, taut: TautSet, t: T, state: &State<T>) -> PerCable<T> {
        let around = self.system.surroundings(t);
        tensions(&self.system, &around, state, [T::ZERO; 3], taut)
    }

    /// The impact of `struck` cables; those of `pulling`, struck or not, take impulses of either
    /// sign (docs/model.md section 5): v⁺ = −e v⁻ for struck ones, 0 for the others.
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

    /// The state changed by the least amount in the mass metric so that the gaps of `closed` cables
    /// are zero, and the normal velocities of `still` ones.
    ///
    /// It is made for states that are almost there: the gaps are taken to zero by two steps of
    /// Newton's method (over [`crate::Precise`] by a few more), of which each squares the part of
    /// its length by which a cable is off. From 1e-4 of it rounding is left, from a tenth of it
    /// about 1e-5 of it, and from farther any amount; [`crate::Cable::gap`] says what.
    pub fn projected(&self, state: &State<T>, closed: TautSet, still: TautSet) -> State<T> {
        let mut state = *state;
        project_position(&self.system, &mut state, closed);
        project_velocity(&self.system, &mut state, still);
        state
    }
}

/// One motion to be carried on, by the best instructions for it.
struct Carrying<'a, T: Real> {
    prescribed: &'a PrescribedTaut<T>,
    taut: TautSet,
    from: (T, &'a State<T>),
    s: T,
    kept: Option<&'a mut Vec<Piece<T>>>,
}

impl<T: Real> Kernel for Carrying<'_, T> {
    type Output = State<T>;
    #[inline(always)]
    fn run(self) -> State<T> {
        let (t, state) = self.from;
        if self.prescribed.system.has_closed_form(self.taut) {
            self.prescribed.slack_flight(t, state, self.s)
        } else {
            self.prescribed
                .by_series(self.taut, (t, state), self.s, self.kept)
        }
    }
}

/// A part of a motion: x, y and θ as series about a time after the beginning.
#[derive(Clone, Copy, Debug)]
struct Piece<T> {
    from: T,
    motion: [Polynomial<T>; 3],
}

/// A motion with a given set of taut cables, which can be evaluated at many times.
#[derive(Clone, Debug)]
pub struct Path<'a, T: Real = f64> {
    prescribed: &'a PrescribedTaut<T>,
    from: (T, State<T>),
    /// In the order of the motion; empty where it has a closed form.
    pieces: Vec<Piece<T>>,
}

impl<T: Real> Path<'_, T> {
    /// The state a time `s` after the beginning.
    pub fn state(&self, s: T) -> State<T> {
        dispatch_over::<T, _>(StateOnPath(self, s))
    }
}

/// A state that is asked for, by the best instructions for it.
struct StateOnPath<'a, T: Real>(&'a Path<'a, T>, T);

impl<T: Real> Kernel for StateOnPath<'_, T> {
    type Output = State<T>;
    #[inline(always)]
    fn run(self) -> State<T> {
        let Self(path, s) = self;
        let (t, state) = &path.from;
        let later = path
            .pieces
            .partition_point(|piece| piece.from.abs() <= s.abs());
        match path.pieces.get(later.saturating_sub(1)) {
            Some(Piece { from, motion }) => {
                state_at([&motion[0], &motion[1], &motion[2]], s - *from)
            }
            None => path.prescribed.slack_flight(*t, state, s),
        }
    }
}
