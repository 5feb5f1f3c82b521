//! Resting cables that have neither a tension nor a normal acceleration, up to rounding.
//!
//! The problem on accelerations does not decide between taut and slack there: 0 ≤ T ⟂ −g̈ ≥ 0 holds
//! with both zero. A pendulum that is released at the height of its anchor is such a start, and so
//! is a body at rest on two cables at the force at which one of them loses its tension. The first
//! derivative that is not zero decides: with T growing the cable is taut from the start, with T
//! falling it is slack. A motion that treats a taut cable as slack has a gap that grows as t³ or
//! t⁴, and once that is more than rounding an impact, which does not exist.
//!
//! So the motion from such a start is expanded with the undecided cables taut. All motions that are
//! in question have the same acceleration at the start, so that the problem on accelerations a
//! little later, where the tensions are more than rounding, has the same solution along each of
//! them. In the same way a tension that reaches zero, and is positive again before it is negative
//! by more than rounding, has only touched zero: the pendulum at its next turning point.

use crate::arithmetic::real::Real;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::{ActiveSet, taut_next, tensions};
use crate::motion::complementarity::independent;
use crate::motion::contact::Contacts;
use crate::motion::sizes::{
    NEGLIGIBLE, size_of_free_acceleration, size_of_load, sizes_of_tensions,
};
use crate::motion::taut_series::{Series, SeriesStart};
use crate::motion::waves::Waves;

/// A normal acceleration counts as zero up to this many roundings of its summands \[F\].
const ZERO: f64 = 4.0;
/// A tension decides once it is this many times what counts as zero \[F\].
const CLEAR: f64 = 16.0;
/// Tensions are first evaluated 2^−LATER of a step later, then at each doubling of that, up to half
/// a step.
const LATER: i32 = 28;
/// A series is evaluated up to this multiple of its step: its error has grown by 1.125^28 there.
const BEYOND: f64 = 1.125;

/// The cables of a start that are tied between taut and slack.
pub(crate) struct Decided {
    pub(crate) active: ActiveSet,
    /// Taut cables whose tension is zero at the start, and rises.
    pub(crate) touching: TautSet,
    /// Those whose tension does not rise above rounding along a whole step.
    pub(crate) undecided: TautSet,
}

impl Decided {
    /// A start without ties.
    #[inline(always)]
    pub(crate) fn known(active: ActiveSet) -> Self {
        Self {
            active,
            touching: TautSet::SLACK,
            undecided: TautSet::SLACK,
        }
    }
}

impl ActiveSet {
    /// The same with cables that have no tension at any time. Beside a cable that carries they stay
    /// closed: there taut and slack are the same motion.
    fn beside(self, idle: TautSet) -> Self {
        if self.carrying.is_empty() {
            return self;
        }
        Self {
            taut: self.taut.union(idle),
            ..self
        }
    }
}

/// A state with all forces on the body but those of the cables.
pub(crate) struct Instant<'a, T: Real> {
    pub(crate) system: &'a System<T>,
    pub(crate) around: &'a Surroundings<T>,
    pub(crate) state: &'a State<T>,
    pub(crate) memory_force: [T; 3],
}

/// The start of a motion with its ties, which are resting and not in `active`.
pub(crate) struct Tie<'a, T: Real> {
    pub(crate) system: &'a System<T>,
    pub(crate) rules: &'a Rules<T>,
    pub(crate) t: T,
    pub(crate) state: &'a State<T>,
    pub(crate) contacts: &'a Contacts<T>,
    pub(crate) resting: TautSet,
    pub(crate) active: ActiveSet,
    pub(crate) cables: TautSet,
}

impl<T: Real> Instant<'_, T> {
    /// The cables of a set whose normal acceleration is zero, with the tensions of the carrying
    /// ones.
    #[inline(always)]
    pub(crate) fn unmoved(&self, set: TautSet, carrying: TautSet) -> TautSet {
        if set.is_empty() {
            return set;
        }
        let found = self.normal_accelerations(set, carrying);
        let zero = |&cable: &usize| {
            let (left, zero) = found[cable];
            left.abs() <= zero
        };
        set.iter().filter(zero).collect()
    }

    /// The normal accelerations of the cables of a set with the tensions of the carrying ones, and
    /// below what each counts as zero.
    fn normal_accelerations(&self, set: TautSet, carrying: TautSet) -> PerCable<(T, T)> {
        let &Self {
            system,
            around,
            state,
            memory_force,
        } = self;
        let free = system.free_acceleration(around, state, memory_force);
        let free_size = size_of_free_acceleration(system, state, memory_force);
        let tension = tensions(system, around, state, memory_force, carrying);
        let normals = system.normals(state, set.union(carrying));
        let mut found = [(T::ZERO, T::ZERO); MAX_CABLES];
        for cable in set.iter() {
            let mut left = system.free_normal_acceleration(cable, state, free);
            let mut size = size_of_load(system, cable, state, free_size);
            for other in carrying.iter() {
                let coupling = system.body.mass.coupling(&normals[cable], &normals[other]);
                left -= coupling * tension[other];
                size += (coupling * tension[other]).abs();
            }
            found[cable] = (left, size * T::EPSILON * ZERO);
        }
        found
    }

    /// Below what the tension of each of some independent cables counts as zero.
    pub(crate) fn zero_tensions(&self, carrying: TautSet) -> PerCable<T> {
        let rounding = T::EPSILON * ZERO;
        self.sizes_of_tensions(carrying).map(|size| size * rounding)
    }

    /// The sums of the absolute values of all summands of the tensions of some independent cables.
    fn sizes_of_tensions(&self, carrying: TautSet) -> PerCable<T> {
        let (system, state) = (self.system, self.state);
        let tension = tensions(system, self.around, state, self.memory_force, carrying);
        sizes_of_tensions(system, state, self.memory_force, carrying, &tension)
    }

    /// The first different set that is taut along the motion of `active` after a time `from`, at
    /// which released cables have lost their tension; none if there is none within half a step.
    ///
    /// Where other closed cables remain, one of them may take over the load of a carrying cable
    /// that has lost its tension. The instant itself does not decide which; so the problem on
    /// accelerations is solved a little later on the same motion, where the tension would be
    /// negative: by more than counts as zero, or, where it never is, by more than rounding.
    #[cold]
    #[inline(never)]
    pub(crate) fn taken_over(
        &self,
        series: &Series<T>,
        from: T,
        active: ActiveSet,
        released: TautSet,
        around: impl Fn(T) -> Surroundings<T>,
    ) -> Option<ActiveSet> {
        let sizes = self.sizes_of_tensions(active.carrying);
        let next = |s: T| {
            let (state, held) = (series.state(s), series.memory_force(s));
            taut_next(self.system, &around(s), &state, held, active.taut)
        };
        [T::from_decimal(NEGLIGIBLE), T::EPSILON * (ZERO * CLEAR)]
            .into_iter()
            .find_map(|part| {
                let pushes = |cable: usize, s: T| series.tension(cable, s) < -(sizes[cable] * part);
                instants_after(series, from)
                    .filter(|&s| released.iter().any(|cable| pushes(cable, s)))
                    .map(next)
                    .find(|next| *next != active)
            })
    }
}

/// Instants after a time `from` of an expansion at which tensions are evaluated, from 2^−LATER of a
/// step later on.
fn instants_after<T: Real>(series: &Series<T>, from: T) -> impl Iterator<Item = T> {
    let (step, last) = (series.step(), series.step() * BEYOND);
    (1..=LATER)
        .map(move |k| from + step * 0.5_f64.powi(LATER + 1 - k))
        .take_while(move |&s| s <= last)
}

/// The first time after `from` at which the tensions of all of some cables are more than rounding;
/// none if there is none within half a step.
pub(crate) fn first_clear<T: Real>(
    series: &Series<T>,
    from: T,
    cables: TautSet,
    zero: &PerCable<T>,
) -> Option<T> {
    let clear = |&s: &T| {
        let known = |cable: usize| series.tension(cable, s).abs() > zero[cable] * CLEAR;
        cables.iter().all(known)
    };
    instants_after(series, from).find(clear)
}

impl<T: Real> Tie<'_, T> {
    /// Decides it. The water has no memory yet.
    #[cold]
    #[inline(never)]
    pub(crate) fn decided(&self) -> Decided {
        let &Self {
            system,
            state,
            t,
            resting,
            active,
            cables,
            ..
        } = self;
        let held = self.held();
        let carrying = held.carrying;
        let mut waves = Waves::new(system);
        waves.cover(t, t);
        let series = self.expanded(&waves, held);
        let tied = cables.intersection(carrying);
        let now = Instant {
            system,
            around: &waves.at(system, t),
            state,
            memory_force: [T::ZERO; 3],
        };
        let zero = now.zero_tensions(carrying);
        let clear = |cables| first_clear(&series, T::ZERO, cables, &zero);
        let half = series.step() * 0.5;
        let growth = |cable| series.tension(cable, half) - series.tension(cable, T::ZERO);
        let nothing = |&i: &usize| growth(i) == T::ZERO && clear(TautSet::only(i)).is_none();
        let idle: TautSet = tied.iter().filter(nothing).collect();
        let live = idle.iter().fold(tied, TautSet::without);
        if let (Some(s), false) = (clear(live), live.is_empty()) {
            let (later, memory_force) = (series.state(s), series.memory_force(s));
            let around = waves.at(system, t + s);
            let active = taut_next(system, &around, &later, memory_force, resting);
            return Decided {
                active: active.beside(idle),
                touching: cables.intersection(active.carrying),
                undecided: TautSet::SLACK,
            };
        }
        // All is within rounding. The growth of the tensions is still the best that is known.
        let rise = !live.is_empty() && live.iter().all(|cable| growth(cable) > T::ZERO);
        let held = ActiveSet {
            carrying: idle.iter().fold(carrying, TautSet::without),
            ..held
        };
        Decided {
            active: if rise { held } else { active.beside(idle) },
            touching: if rise { live } else { TautSet::SLACK },
            undecided: if live.is_empty() {
                TautSet::SLACK
            } else {
                cables
            },
        }
    }

    /// The active set if all of its cables are held.
    fn held(&self) -> ActiveSet {
        let (system, active) = (self.system, self.active);
        let normals = system.normals(self.state, self.resting);
        let w = |i: usize, j: usize| system.body.mass.coupling(&normals[i], &normals[j]);
        let carrying = self.cables.iter().fold(active.carrying, |set, cable| {
            let more = set.with(cable);
            if independent(more, w) { more } else { set }
        });
        ActiveSet {
            taut: active.taut.union(self.cables),
            carrying,
        }
    }

    /// The motion with these cables taut.
    fn expanded(&self, waves: &Waves<T>, held: ActiveSet) -> Box<Series<T>> {
        let Self {
            system,
            rules,
            t,
            state,
            contacts,
            ..
        } = self;
        let mut series = Box::new(Series::new(system, rules));
        let (around, memory) = (waves.expanded(system, *t), system.memory_at_rest());
        let start = SeriesStart {
            around: &around,
            state,
            memory: &memory,
            contacts,
            active: held,
        };
        series.expand(system, &start);
        series
    }
}
