//! The end of a step: the law that is applied, the next taut set, and the rules that stop a run.

use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::rules::{MOST_HALTED, SLOW_FLIGHT, SLOW_SNAPS};
use crate::model::rules::{Rules, Stop};
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::active_set::{ActiveSet, normal_acceleration, taut_next};
use crate::motion::bounce::UNMOVED;
use crate::motion::contact::Contact;
use crate::motion::events::{Crossing, Reached};
use crate::motion::impact::{ImpactResult, impact};
use crate::motion::projection::project_velocity;
use crate::motion::simulation::{CONVERGING, Event, LastImpacts, Simulation};
use crate::motion::ties::{Instant, first_clear};

/// A motion whose time does not increase in more steps than this, without a snap, stands still.
const MOST_IDLE: u32 = 1000;

/// The same with so many snaps, far above what a motion has that goes on. A corner between two
/// cables at an angle of β sends a body back after π/β snaps at most, all of them at one instant if
/// it is hit to a rounding: this many would take cables that are parallel to 3e-5. Of more cables
/// that hold a point mass only the outermost two make the corner. Snaps that accumulate, each e
/// times as fast as the one before, stick before: from where their time no longer increases to a
/// `v_stick` of 1e-30 times that speed they are fewer than this for every e up to 0.9993. Where
/// `v_stick` is zero nothing else ends them.
const MOST_AT_ONCE: u32 = 100_000;

/// Steps since the time last increased.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Standing {
    /// Those since a cable last snapped.
    idle: u32,
    /// Those with a snap.
    snapped: u32,
}

/// Snaps in a row that were slower than `v_stick`.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlowRow<T> {
    /// How many.
    snaps: u32,
    /// Their cables.
    cables: TautSet,
    /// When the latest of them was.
    latest: T,
}

impl<T> SlowRow<T> {
    /// No snaps in a row; the latest slow one was then, if there was one.
    pub(super) fn ended(latest: T) -> Self {
        Self {
            snaps: 0,
            cables: TautSet::SLACK,
            latest,
        }
    }
}

/// Up to what the normal velocity of a cable counts as zero at an impact, from the state after it
/// and before it.
#[inline(always)]
pub(crate) fn zero_velocity<T: Real>(
    system: &System<T>,
    cable: usize,
    [after, before]: [&State<T>; 2],
) -> T {
    let reach = system.cables[cable].fairlead().length();
    let speed = |s: &State<T>| s.velocity().length() + s.vtheta.abs() * reach;
    speed(after).max(speed(before)) * T::EPSILON * UNMOVED
}

impl<T: Real> Simulation<T> {
    /// The cables whose gap is zero by definition, not by evaluation.
    pub(crate) fn closed(&self) -> TautSet {
        let known = |&cable: &usize| {
            self.contacts[cable].gap == T::ZERO && self.contacts[cable].error == T::ZERO
        };
        (0..self.system.cables.len()).filter(known).collect()
    }

    /// The cables whose gap and normal velocity are zero, whether or not they have tension.
    pub fn resting(&self) -> TautSet {
        let still = |&cable: &usize| self.contacts[cable].resting;
        self.closed().iter().filter(still).collect()
    }

    /// Applies the law of the event.
    #[inline(always)]
    pub(super) fn apply_law(&mut self, event: &Event) -> Option<ImpactResult<T>> {
        let reached = event.reached;
        if let Some(limit) = reached.limits.iter().next() {
            self.stop = Some(limit.stop());
        } else if !reached.gaps.is_empty() {
            return Some(self.snap(event));
        } else if !reached.tensions.is_empty() {
            self.release(reached.tensions);
        } else if self.t >= self.rules.t_end {
            self.stop = Some(Stop::EndTime);
        }
        None
    }

    /// Cables snap taut: impact, then sticking, then the choice of the taut set.
    #[inline(always)]
    fn snap(&mut self, event: &Event) -> ImpactResult<T> {
        apart!(T, {
            let Event { closed, still, .. } = *event;
            let struck = event.reached.gaps;
            let result = impact(&self.system, &self.state, closed, still);
            self.state = result.after;
            let hit: TautSet = struck.intersection(result.pulling);
            self.count(&result, hit);

            let slow: TautSet = struck
                .iter()
                .filter(|&cable| result.v_before[cable] < self.rules.v_stick)
                .collect();
            let at_rest: TautSet = closed
                .iter()
                .filter(|&cable| self.unmoved(&result, cable, struck))
                .collect();
            self.count_slow(struck, slow);
            let others = slow.union(at_rest);
            let at_once = self.cables_at_rest_at_once(&result, closed, others);
            let cables_at_rest_at_once = at_once.unwrap_or_default();
            let candidates = others.union(cables_at_rest_at_once);
            let halted = self.halted(candidates);
            let memory_force = self.memory_force();
            self.active = self.taut_next(self.t, &halted, memory_force, candidates);
            let at_rest = if cables_at_rest_at_once.is_empty() {
                project_velocity(&self.system, &mut self.state, self.active.taut);
                self.remaining_at_rest(at_rest, slow)
            } else {
                self.state = halted;
                candidates
            };

            for cable in closed.iter() {
                let resting = self.active.taut.contains(cable) || at_rest.contains(cable);
                self.contacts[cable] = if resting {
                    Contact::RESTING
                } else {
                    Contact::CLOSED
                };
            }
            result
        })
    }

    /// Counts the snaps of an instant to the row of slow ones, if all of them are.
    #[inline(always)]
    fn count_slow(&mut self, struck: TautSet, slow: TautSet) {
        // Snaps that accumulate follow each other at once: a bounce at v takes 2 v/α. One that
        // comes later begins another row.
        let force = self.system.forcing.bounds()[0];
        let late = (self.t - self.slow_row.latest) * force > self.rules.v_stick * SLOW_FLIGHT;
        if slow != struck || late {
            self.end_slow_row();
        }
        if slow == struck {
            self.slow_row.snaps += 1;
            self.slow_row.cables = self.slow_row.cables.union(struck);
            self.slow_row.latest = self.t;
        }
    }

    /// The state without the velocity that cables at rest do not permit.
    #[inline(always)]
    fn halted(&self, at_rest: TautSet) -> State<T> {
        let mut halted = self.state;
        project_velocity(&self.system, &mut halted, at_rest);
        halted
    }

    /// If several cables have snapped slowly in turn, each opening the others more slowly than
    /// `v_stick`, the closed cables that open more slowly than that: those snaps accumulate, and
    /// all of them come to rest at once. Where the cables are nearly parallel, a body that moves
    /// fast past the corner between them snaps them slowly, too; it moves on, and none is at rest
    /// unless what that takes away, beside the `others`, is as slow as the snaps.
    #[inline(always)]
    fn cables_at_rest_at_once(
        &self,
        result: &ImpactResult<T>,
        closed: TautSet,
        others: TautSet,
    ) -> Option<TautSet> {
        if self.slow_row.snaps < SLOW_SNAPS || self.slow_row.cables.len() < 2 {
            return None;
        }
        let slow = |&cable: &usize| result.v_after[cable].abs() < self.rules.v_stick;
        let slow: TautSet = closed.iter().filter(slow).collect();
        let (moving, halted) = (self.halted(others), self.halted(others.union(slow)));
        let spin = (moving.vtheta - halted.vtheta).abs();
        let taken = slow.iter().map(|cable| {
            let reach = self.system.cables[cable].fairlead().length();
            (moving.velocity() - halted.velocity()).length() + spin * reach
        });
        let most = taken.fold(T::ZERO, T::max);
        (most <= self.rules.v_stick * MOST_HALTED).then_some(slow)
    }

    /// Resets the row of slow snaps, because another event has come between.
    pub(super) fn end_slow_row(&mut self) {
        self.slow_row = SlowRow::ended(self.slow_row.latest);
    }

    /// Whether a closed cable has no normal velocity after the result. A struck one was closing; if
    /// its normal velocity is nevertheless not positive, it is zero up to rounding.
    #[inline(always)]
    fn unmoved(&self, result: &ImpactResult<T>, cable: usize, struck: TautSet) -> bool {
        if struck.contains(cable) && result.v_before[cable] <= T::ZERO {
            return true;
        }
        let zero = zero_velocity(&self.system, cable, [&self.state, &self.before]);
        result.v_after[cable].abs() <= zero
    }

    /// Of the cables at rest after an impact, those that still are after the slow ones have stuck:
    /// a cable whose load a sticking cable takes over opens with the velocity that this takes away.
    #[inline(always)]
    fn remaining_at_rest(&self, at_rest: TautSet, slow: TautSet) -> TautSet {
        if slow.intersection(self.active.taut).is_empty() {
            return at_rest;
        }
        let still = |&cable: &usize| {
            let tether = &self.system.cables[cable];
            let reach = tether.fairlead().length();
            let speed = self.before.velocity().length() + self.before.vtheta.abs() * reach;
            let v = tether.normal(&self.state).velocity(&self.state);
            v.abs() <= speed * T::EPSILON * UNMOVED
        };
        at_rest.iter().filter(still).collect()
    }

    /// Counts an instant of impact.
    pub(super) fn count(&mut self, result: &ImpactResult<T>, hit: TautSet) {
        self.impacts += hit.len() as u64;
        if hit.is_empty() {
            return;
        }
        let repeats = if hit == self.last.cables {
            self.last.repeats + 1
        } else {
            1
        };
        self.last = LastImpacts {
            cables: hit,
            v_n: hit
                .iter()
                .fold(T::ZERO, |v, cable| v.max(result.v_before[cable])),
            repeats,
        };
    }

    /// Counts steps of zero length, so that every run ends. Where bounces accumulate the time may
    /// not change from one to the next for a while.
    pub(super) fn check_progress(&mut self, t_start: T, impacts: u64) {
        if self.t > t_start {
            self.standing = Standing::default();
            return;
        }
        let Standing { idle, snapped } = self.standing;
        self.standing = match self.impacts > impacts {
            true => Standing {
                idle: 0,
                snapped: snapped + 1,
            },
            false => Standing {
                idle: idle + 1,
                snapped,
            },
        };
        let stands = self.standing.idle > MOST_IDLE || self.standing.snapped > MOST_AT_ONCE;
        if self.stop.is_none() && stands {
            self.stop = Some(Stop::Standstill);
        }
    }

    /// Where taut cables leave the body no freedom, a gap closes by rounding only: its cable is at
    /// rest with the body. The instant at which it closes means nothing, so that nothing else is
    /// reached at it either; the next step finds what really is.
    #[inline(always)]
    pub(super) fn hold_closed(&mut self, reached: &mut Reached) {
        if !reached.gaps.is_empty() && self.system.is_held_by(self.active.carrying) {
            self.active.taut = self.active.taut.union(reached.gaps);
            *reached = Reached::default();
        }
    }

    /// The cables that are taut from a time on, among candidates.
    #[inline(always)]
    fn taut_next(
        &self,
        t: T,
        state: &State<T>,
        memory_force: [T; 3],
        candidates: TautSet,
    ) -> ActiveSet {
        if candidates.is_empty() {
            return ActiveSet::default();
        }
        let around = self.surroundings(t);
        taut_next(&self.system, &around, state, memory_force, candidates)
    }

    /// Whether tensions that reach zero at a crossing are positive again before they are
    /// negative by more than rounding.
    #[cold]
    #[inline(never)]
    pub(super) fn only_touches(&self, crossing: &Crossing<T>) -> bool {
        let Some(series) = &self.series else {
            return false;
        };
        let (s, tensions) = (crossing.s, crossing.reached.tensions);
        let now = Instant {
            system: &self.system,
            around: &self.surroundings(self.t + s),
            state: &series.state(s),
            memory_force: series.memory_force(s),
        };
        let zero = now.zero_tensions(self.active.carrying);
        let clear = first_clear(series, s, tensions, &zero);
        let rises = |s: T| tensions.iter().all(|i| series.tension(i, s) > T::ZERO);
        clear.is_some_and(rises)
    }

    /// Cables lose their tension: they open, whatever sign rounding gives to a tension of zero,
    /// unless others take over.
    fn release(&mut self, released: TautSet) {
        self.end_slow_row();
        self.active = self.taken_over(released).unwrap_or_else(|| {
            let kept = released.iter().fold(self.active.taut, TautSet::without);
            self.taut_next(self.t, &self.state, self.memory_force(), kept)
        });
    }

    /// The taut cables after some have lost their tension, if cables depend on each other.
    fn taken_over(&self, released: TautSet) -> Option<ActiveSet> {
        let series = self.series.as_ref()?;
        if self.active.taut == self.active.carrying {
            return None;
        }
        let now = Instant {
            system: &self.system,
            around: &self.surroundings(self.t),
            state: &self.state,
            memory_force: self.memory_force(),
        };
        let around = |s: T| self.surroundings(self.begun + s);
        now.taken_over(series, self.t - self.begun, self.active, released, around)
    }

    /// Checks the rules that apply at events; `stuck` are the cables that just stuck.
    #[inline(always)]
    pub(super) fn check_rules(&mut self, stuck: TautSet) {
        let y = self.state.y;
        let Rules {
            limits: _,
            settled_below,
            sliding_above,
            t_end: _,
            max_impacts,
            v_stick: _,
        } = self.rules;
        let low = settled_below.is_some_and(|height| y < height);
        let high = sliding_above.is_some_and(|height| y >= height);
        if low && (!stuck.is_empty() || self.active.taut.len() >= 2) {
            self.stop = Some(Stop::Settled);
        } else if high && !stuck.is_empty() {
            self.stop = Some(Stop::SlidingStart);
        } else if self.impacts > max_impacts {
            self.stop = Some(Stop::ImpactLimit);
        }
        if matches!(self.stop, Some(Stop::Settled | Stop::SlidingStart)) {
            self.t_limit = self.limit_of_impacts(stuck);
        }
    }

    /// The instant t + 2 e v_n / ((1 − e) α) at which the geometric series of bounces that began
    /// with the last impact converges, α = g̈/(2r) of the struck cable in the flights between.
    #[inline(always)]
    fn limit_of_impacts(&self, stuck: TautSet) -> Option<T> {
        let LastImpacts {
            cables,
            v_n,
            repeats,
        } = self.last;
        let converging = repeats >= CONVERGING
            && !stuck.is_empty()
            && (cables.len() == 1 || cables == self.system.all_cables());
        if !converging {
            return None;
        }
        let mut others = self.active.taut;
        for cable in cables.iter() {
            others = others.without(cable);
        }
        let mut limit = None;
        for cable in cables.iter() {
            let (system, memory_force) = (&self.system, self.memory_force());
            let around = self.surroundings(self.t);
            let alpha =
                normal_acceleration(system, &around, &self.state, memory_force, cable, others);
            if alpha > T::ZERO {
                let at = self.t + self.system.contact_law().time_of_bounces(v_n, alpha)?;
                limit = Some(limit.map_or(at, |limit: T| limit.max(at)));
            }
        }
        limit
    }
}
