//! The one loop: fly to the earliest event, apply its law, choose the next taut set.

use crate::arithmetic::plane::Rotation;
use crate::arithmetic::processor::{apart, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::floating::Complex;
use crate::model::rules::Rules;
use crate::model::rules::Stop;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::active_set::ActiveSet;
use crate::motion::bounce::FlightFacts;
use crate::motion::contact::{Contact, Contacts};
use crate::motion::events::{Crossing, Reached, first_crossing};
use crate::motion::extremes::Extremes;
use crate::motion::flight::Flight;
use crate::motion::impact::Impact;
use crate::motion::impact::ImpactResult;
use crate::motion::projection::{project_position, project_velocity};
use crate::motion::start;
use crate::motion::start::StartError;
use crate::motion::taut_series::Series;
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};
use crate::motion::waves::Waves;

mod bounces;
#[cfg(feature = "comparisons")]
pub(crate) mod comparisons;
mod event_laws;
mod kernels;
mod nearness;
mod series;
mod tensions;
pub(super) mod within;

pub(crate) use event_laws::zero_velocity;
use event_laws::{SlowRow, Standing};
pub use kernels::Steps;
use kernels::begin;
pub(crate) use nearness::{GapAt, SlackGap};
use within::StateAt;

/// After this many instants of impact in a row on the same cables, the impacts count as a
/// converging series.
const CONVERGING: u32 = 5;

/// A motion in progress.
///
/// It allocates memory only when it is made and at its first segment without a closed form; it uses
/// no random numbers and no clock: the same system, rules and start give the same bits.
#[derive(Clone, Debug)]
pub struct Simulation<T: Real = f64> {
    system: System<T>,
    rules: Rules<T>,
    t: T,
    state: State<T>,
    /// The state of the water's memory; empty if the body does not float.
    memory: Vec<Complex<T>>,
    /// The state before the latest event.
    before: State<T>,
    active: ActiveSet,
    contacts: Contacts<T>,
    /// The system in the form of [`crate::motion::bounce`]; none unless it has two cables and one
    /// harmonic.
    two_cables: Option<TwoCableSystem<T>>,
    /// The rotation of the state, if the latest step was a bounce, which has computed it.
    rotation: Option<Rotation<T>>,
    /// The start of the latest step if it was a bounce; `flight` is then not up to date.
    bounce_start: Option<AfterImpact<T>>,
    /// Facts about the latest step, if it was a bounce and nothing more.
    facts: Option<FlightFacts<T>>,
    flight: Flight<T>,
    /// The sums over all sinusoids.
    waves: Waves<T>,
    /// Made for the first segment without a closed form: it is large, and most runs have none.
    series: Option<Box<Series<T>>>,
    extremes: Extremes<T>,
    impacts: u64,
    standing: Standing,
    slow_row: SlowRow<T>,
    /// When the latest segment began.
    begun: T,
    last: LastImpacts<T>,
    stop: Option<Stop>,
    t_limit: Option<T>,
    /// Taut cables whose tension has just touched zero.
    touching: TautSet,
    /// Resting cables of which only rounding told whether they were taut at the start.
    undecided: TautSet,
}

/// The latest instants of impact, as needed for the limit of a converging series.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LastImpacts<T> {
    pub(crate) cables: TautSet,
    pub(crate) v_n: T,
    pub(crate) repeats: u32,
}

/// The impacts so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress<T> {
    pub(crate) impacts: u64,
    pub(crate) last: LastImpacts<T>,
}

/// One step: a segment of motion with one taut set, and the event at its end.
#[derive(Clone, Copy, Debug)]
pub struct Step<T: Real = f64> {
    /// When the segment began.
    pub t_start: T,
    /// The state at its start.
    pub start: State<T>,
    /// The cables that are taut along it.
    pub taut: TautSet,
    /// When it ended.
    pub t_end: T,
    /// The state at the end, after the event there.
    pub after: State<T>,
    /// The taut cables after it.
    pub taut_after: TautSet,
    /// Why the motion stops here, if it does.
    pub stop: Option<Stop>,
    /// The state at the end, before the event there.
    pub before: State<T>,
    /// The carrying cables among the taut ones.
    pub(crate) carrying: TautSet,
    pub(crate) event: Event,
    pub(crate) result: Option<ImpactResult<T>>,
}

/// The event at the end of a segment, before its law is applied.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Event {
    /// What was reached.
    pub(crate) reached: Reached,
    /// The cables whose gap is zero by definition, not by evaluation.
    pub(crate) closed: TautSet,
    /// Those of them without normal velocity.
    pub(crate) still: TautSet,
}

impl<T: Real> Step<T> {
    /// The impacts at the end of the segment: one for each cable with an impulse.
    pub fn impacts(&self) -> impl Iterator<Item = Impact<T>> + '_ {
        self.result.iter().flat_map(|result| {
            result.pulling.iter().map(|cable| {
                let (v_before, v_after) = (result.v_before[cable], result.v_after[cable]);
                Impact {
                    t: self.t_end,
                    cable,
                    v_n: v_before.max(T::ZERO),
                    impulse: result.impulse[cable],
                    energy_lost: result.impulse[cable] * (v_before + v_after) * 0.5,
                    before: self.before,
                    after: result.after,
                }
            })
        })
    }
}

impl<T: Real> Simulation<T> {
    /// A motion of `system` from `state` at time `t`, projected onto the cables that count as
    /// closed.
    ///
    /// # Errors
    /// [`StartError`] if the start violates a cable, a stop rule or is not finite.
    #[inline(never)]
    pub fn new(
        system: System<T>,
        rules: Rules<T>,
        t: T,
        state: State<T>,
    ) -> Result<Self, StartError> {
        begin(system, rules, t, state)
    }

    #[inline(always)]
    fn start_here(
        system: System<T>,
        rules: Rules<T>,
        t: T,
        state: State<T>,
    ) -> Result<Self, StartError> {
        let start = apart!(T, { start::prepare(&system, &rules, t, &state) })?;
        let mut waves = Waves::new(&system);
        waves.cover(t, t);
        Ok(Self {
            flight: Flight::new(&system, &rules),
            waves,
            series: None,
            memory: system.memory_at_rest(),
            extremes: Extremes::at(&start.state),
            two_cables: TwoCableSystem::of(&system, &rules),
            rotation: None,
            bounce_start: None,
            facts: None,
            system,
            rules,
            t,
            state: start.state,
            before: start.state,
            active: start.active,
            contacts: start.contacts,
            impacts: 0,
            standing: Standing::default(),
            slow_row: SlowRow::ended(t),
            begun: t,
            last: LastImpacts {
                cables: TautSet::SLACK,
                v_n: T::ZERO,
                repeats: 0,
            },
            stop: start.stop,
            t_limit: None,
            touching: start.touching,
            undecided: start.undecided,
        })
    }

    /// The system.
    pub fn system(&self) -> &System<T> {
        &self.system
    }

    /// The stop rules.
    pub fn rules(&self) -> &Rules<T> {
        &self.rules
    }

    /// The time reached.
    pub fn time(&self) -> T {
        self.t
    }

    /// The state reached.
    pub fn state(&self) -> &State<T> {
        &self.state
    }

    /// The state of the water's memory: the states z for x first, then for y, then for θ, in the
    /// order of the exponentials; empty if the body does not float.
    pub fn memory(&self) -> &[Complex<T>] {
        &self.memory
    }

    /// The force of the water's memory on the body.
    #[inline(always)]
    pub fn memory_force(&self) -> [T; 3] {
        self.system.memory_force(&self.memory)
    }

    /// The taut cables.
    pub fn taut(&self) -> TautSet {
        self.active.taut
    }

    /// The taut cables whose tensions determine the motion.
    pub(crate) fn carrying(&self) -> TautSet {
        self.active.carrying
    }

    /// Why the motion has stopped, if it has.
    pub fn stop(&self) -> Option<Stop> {
        self.stop
    }

    /// The time at which the impacts that end the run converge (see
    /// [`crate::motion::trajectory::End::t_limit`]).
    pub fn t_limit(&self) -> Option<T> {
        self.t_limit
    }

    /// The highest y so far.
    pub fn y_max(&self) -> T {
        self.extremes.y_max
    }

    /// The largest |θ| so far.
    pub fn theta_max(&self) -> T {
        self.extremes.theta_max
    }

    /// Advances to the next event, or to the end of one Taylor series. `None` once the motion has
    /// stopped.
    pub fn step(&mut self) -> Option<Step<T>>
    where
        T: Steps,
    {
        T::step(self)
    }

    #[inline(always)]
    pub(crate) fn step_here(&mut self) -> Option<Step<T>> {
        if self.stop.is_some() {
            return None;
        }
        let (t_start, start, mut active, impacts) = (self.t, self.state, self.active, self.impacts);
        let mut result = None;
        let event = match &self.next_bounce() {
            Some(bounce) => self.take(bounce, &mut result),
            None => {
                let crossing = self.next_crossing();
                active = self.active;
                let reached = self.advance(&crossing);
                self.before = self.state;
                self.event(reached)
            }
        };
        if result.is_none() {
            result = self.apply_law(&event);
        }
        if self.stop.is_none() && event.reached != Reached::default() {
            self.check_rules(event.reached.gaps.intersection(self.active.taut));
        }
        self.check_progress(t_start, impacts);
        Some(Step {
            t_start,
            start,
            taut: active.taut,
            carrying: active.carrying,
            t_end: self.t,
            after: self.state,
            taut_after: self.active.taut,
            stop: self.stop,
            before: self.before,
            event,
            result,
        })
    }

    fn event(&self, reached: Reached) -> Event {
        Event {
            reached,
            closed: self.closed(),
            still: self.resting(),
        }
    }

    /// The earliest event of the present mode; none is reached if the expansion or the time ends
    /// first.
    #[inline(always)]
    fn next_crossing(&mut self) -> Crossing<T> {
        apart!(T, {
            self.begun = self.t;
            let mut horizon = self.rules.t_end - self.t;
            let closed_form = self.system.has_closed_form(self.active.taut);
            if !closed_form {
                self.extend_series();
            }
            let crossing = match &mut self.series {
                Some(series) if !closed_form => {
                    series.close(&self.system, &self.state, &self.memory);
                    series.set_touching(std::mem::take(&mut self.touching));
                    self.active = series.active();
                    horizon = horizon.min(series.step());
                    first_crossing(&**series, self.t, horizon)
                }
                _ => {
                    self.flight.begin(
                        &self.system,
                        self.t,
                        &self.state,
                        &self.before,
                        &self.contacts,
                    );
                    first_crossing(&self.flight, self.t, horizon)
                }
            };
            let mut crossing = crossing.unwrap_or(Crossing {
                s: horizon,
                reached: Reached::default(),
            });
            if crossing.reached.is_of_tensions() && self.only_touches(&crossing) {
                self.touching = crossing.reached.tensions;
                crossing.reached = Reached::default();
            }
            self.hold_closed(&mut crossing.reached);
            crossing
        })
    }

    /// Moves state, time and contacts to the crossing. The positions are projected onto the closed
    /// cables and the velocities along the taut ones, so that errors do not accumulate from event
    /// to event. Returns what is reached. Where the numbers there are not finite, nothing is: the
    /// motion ends with its latest state that is.
    #[inline(always)]
    fn advance(&mut self, crossing: &Crossing<T>) -> Reached {
        apart!(T, {
            let s = crossing.s;
            let motion = self.motion(self.active.taut);
            let reached_end =
                crossing.reached == Reached::default() && s >= self.rules.t_end - self.t;
            let state = motion.state(s);
            if !state.is_finite() {
                self.stop = Some(Stop::Standstill);
                return Reached::default();
            }
            let from = (self.t, self.state, self.extremes);
            let mut extremes = self.extremes;
            let acceleration_bounds = motion.acceleration_bounds(&self.system);
            let within = |s| dispatch_over::<T, _>(StateAt(&motion, s));
            extremes.cover(within, s, [&self.state, &state], acceleration_bounds);
            let mut contacts = self.contacts;
            for (cable, contact) in contacts[..self.system.cables.len()].iter_mut().enumerate() {
                if self.active.taut.contains(cable) {
                    *contact = Contact::RESTING;
                } else if crossing.reached.gaps.contains(cable) {
                    *contact = Contact::CLOSED;
                } else if s > T::ZERO {
                    let carried = motion.contact(cable, s);
                    *contact = carried.carried(&self.system, cable, &state);
                }
            }
            if let (Some(series), false) = (&self.series, self.memory.is_empty()) {
                series.memory(s, &mut self.memory);
            }
            self.t = if reached_end {
                self.rules.t_end
            } else {
                self.t + s
            };
            (self.state, self.extremes, self.contacts) = (state, extremes, contacts);
            self.waves.cover(self.begun, self.t);
            let closed = self.closed();
            project_position(&self.system, &mut self.state, closed);
            project_velocity(&self.system, &mut self.state, self.active.taut);
            if !self.state.is_finite() {
                (self.t, self.state, self.extremes) = from;
                self.stop = Some(Stop::Standstill);
                return Reached::default();
            }
            crossing.reached
        })
    }

    /// Cables that rested at the start and of which only rounding told whether they were taut.
    pub(crate) fn undecided_at_start(&self) -> TautSet {
        self.undecided
    }
}
