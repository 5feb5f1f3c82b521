//! Follows the spread of a run's neighbours up to the end of trust.

mod bounces;

use crate::analysis::trust::bounces::Followed;
use crate::analysis::trust::causes::{Closing, cause};
use crate::analysis::trust::covariance::{CovarianceFactor, LARGEST_SPREAD, larger, relative};
use crate::analysis::trust::linear_map::{LinearMap, Observer, meet};
use crate::analysis::trust::neighbours::{Neighbours, Spread};
use crate::analysis::trust::parts::COLUMNS;
use crate::analysis::trust::passed_impulse;
use crate::analysis::trust::rounding::{self, Rounding};
use crate::analysis::trust::start::{self, Beginning, MaybeSlack};
use crate::analysis::trust::tension::{self, TautStep};
use crate::analysis::trust::uncertain_key::{UncertainKey, uniform};
use crate::analysis::trust::{Horizon, HorizonCause, Uncertainty};
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::model::rules::Stop;
use crate::model::state::State;
use crate::model::taut_set::TautSet;
use crate::motion::bounce_map::BounceMap;
use crate::motion::events::Reached;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Block, Deviation, StepMap, combined};
use crate::motion::tangent::Tangent;

/// An error is this many standard deviations: 95 % of a normal distribution lies within.
pub(super) const ERROR: f64 = 2.0;

/// The rounding of this many steps is added up exactly; later bounces add theirs as
/// [`crate::analysis::trust::parts`] describes. Where deviations grow, most of the error comes from
/// the first few roundings, which are too few for an average over signs: with three of them, one of
/// 6,000 random cases was called certain and was not, with four none.
const EXACT_STEPS: u32 = 4;

/// The spread of a run's neighbours, and where the knowledge of it ends.
#[derive(Clone, Debug)]
pub(super) struct SpreadMonitor {
    tolerance: f64,
    /// Made for the first step that needs it.
    tangent: Option<Box<Tangent>>,
    pub(super) covariance: CovarianceFactor,
    /// The error of the cables' direction, as a number of roundings.
    slant: f64,
    keys: Vec<UncertainKey>,
    /// The impacts so far.
    pub(super) impacts: usize,
    /// The steps so far, up to [`EXACT_STEPS`].
    steps: u32,
    pub(super) horizon: Option<Horizon>,
    /// The cables whose tension was near zero and fell at the end of the latest step, and since
    /// when it has been.
    falling: (TautSet, f64),
    /// Whether the latest step that was no mere bounce ended with a snap.
    after_snap: bool,
    /// Whether the spread is too large to be carried further.
    too_large: bool,
    /// Up to the first event.
    maybe_slack: Option<Box<MaybeSlack>>,
    pub(super) end_error: f64,
}

/// Any step to be carried through, by the best instructions for it.
struct Carrying<'a>(
    &'a mut SpreadMonitor,
    &'a Simulation,
    &'a Step,
    &'a mut dyn Observer,
);

impl Kernel for Carrying<'_> {
    type Output = f64;
    #[inline(always)]
    fn run(self) -> f64 {
        self.0.carry(self.1, self.2, self.3)
    }
}

impl SpreadMonitor {
    /// The spread of a motion about to begin, whose start may be off by `start`.
    pub(super) fn new(simulation: &Simulation, start: &[f64; 6], tolerance: f64) -> Self {
        let [x, y, theta, vx, vy, vtheta] = start.map(uniform);
        let mut covariance =
            CovarianceFactor::along_components(&[x, y, theta, vx, vy, vtheta, 0.0]);
        let Beginning {
            cause,
            maybe_slack,
            opening,
        } = Beginning::of(simulation, &covariance);
        let closed = simulation.closed();
        if !closed.is_empty() {
            let closed_for_all = maybe_slack.iter().fold(closed, TautSet::without);
            let projection =
                Tangent::new(simulation.system()).of_start_on(simulation, closed_for_all);
            let project = |block: &mut Block<COLUMNS>, _: &mut [[f64; COLUMNS]]| {
                let projected = projection.map(|row| combined(block, &row));
                block[..6].copy_from_slice(&projected);
            };
            covariance = covariance.carried(project, Vec::new());
        }
        covariance.add_parts(&rounding::of_start(
            simulation.system(),
            simulation.state(),
            simulation.time(),
            closed,
        ));
        // Water that has been at rest has no memory, so that there is nothing uncertain in it.
        covariance.memory = vec![[0.0; COLUMNS]; 2 * simulation.memory().len()];
        let cause = cause
            .or_else(|| tension::cause_at_start(simulation, &covariance, &[]))
            .or_else(|| {
                start::may_stop(simulation, &Spread::of(&covariance))
                    .then_some(HorizonCause::StopRule)
            });
        let maybe_slack =
            MaybeSlack::of(simulation, &Spread::of(&covariance), [maybe_slack, opening]);
        let horizon = cause.map(|cause| Horizon::at_start(simulation, cause));
        Self {
            too_large: covariance.exceeds_limit(),
            tolerance,
            tangent: None,
            covariance,
            slant: 1.0,
            keys: Vec::new(),
            impacts: 0,
            steps: 0,
            horizon,
            falling: (TautSet::SLACK, 0.0),
            after_snap: false,
            maybe_slack,
            end_error: 0.0,
        }
    }

    /// The spread of a case with all its uncertainties.
    ///
    /// # Errors
    /// A [`CaseError`] if a key that is in doubt has no value in this case.
    pub(super) fn of_case(case: &Case, uncertainty: &Uncertainty) -> Result<Self, CaseError> {
        let start = uncertainty.of_start_of(case.parameters());
        let mut monitor = Self {
            slant: rounding::slant(case),
            ..Self::new(case.start(), &start, uncertainty.tolerance)
        };
        for (name, size) in &uncertainty.keys {
            monitor.keys.push(UncertainKey::new(case, name, *size)?);
        }
        monitor.covariance.columns = monitor.keys.iter().map(|key| key.deviation).collect();
        if monitor.horizon.is_none() {
            let start = case.start();
            let cause = tension::cause_at_start(start, &monitor.covariance, &monitor.keys);
            monitor.horizon = cause.map(|cause| Horizon::at_start(start, cause));
        }
        Ok(monitor)
    }

    /// The spread of a case whose values are exact, so that rounding is the only uncertainty.
    pub(super) fn of_exact_case(case: &Case, simulation: &Simulation) -> Self {
        let tolerance = Uncertainty::default().tolerance;
        Self {
            slant: rounding::slant(case),
            ..Self::new(simulation, &[0.0; 6], tolerance)
        }
    }

    /// The error of the state in which the motion begins.
    pub(super) fn error_at_start(&self, state: &State) -> f64 {
        let squares = self.covariance.sizes().map(|size| size * size);
        ERROR * relative(&squares, state, 0.0).sqrt()
    }

    /// Takes in the step that `simulation` has just made, and passes its effect on deviations to
    /// the observer; returns the error at its event.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        observer: &mut impl Observer,
    ) -> f64 {
        let bounced = simulation.bounced(step);
        let unknown = self.error_is_unknown();
        if unknown {
            self.set_horizon(step.t_end, HorizonCause::Tolerance);
        }
        let error = match bounced {
            Some(bounced) if unknown || self.follows_bounces() => {
                let map = BounceMap::of(&bounced);
                observer.observe_bounce(&map);
                match (unknown, self.adds_by_signs()) {
                    (true, _) => f64::INFINITY,
                    (false, true) => self.carry_later(simulation, step, &bounced, &map),
                    (false, false) => self.carry_first(simulation, step, &bounced, &map),
                }
            }
            _ => dispatch(Carrying(self, simulation, step, observer)),
        };
        self.impacts += step.impacts().count();
        self.steps = (self.steps + 1).min(EXACT_STEPS);
        error
    }

    #[inline(always)]
    fn tangent(&mut self, simulation: &Simulation) -> &Tangent {
        self.tangent
            .get_or_insert_with(|| Box::new(Tangent::new(simulation.system())))
    }

    /// Whether a bounce may be followed as [`crate::analysis::trust::bounces`] does.
    #[inline(always)]
    fn follows_bounces(&self) -> bool {
        self.keys.is_empty() && self.maybe_slack.is_none()
    }

    /// Whether the rounding of bounces may be added as [`crate::analysis::trust::parts`] describes.
    pub(super) fn adds_by_signs(&self) -> bool {
        self.steps == EXACT_STEPS && self.keys.is_empty()
    }

    /// Past the horizon, and where the spread is too large, the error is unknown.
    #[inline(always)]
    fn error_is_unknown(&self) -> bool {
        let other_events = self
            .horizon
            .is_some_and(|h| h.cause != HorizonCause::Tolerance);
        other_events || self.too_large
    }

    /// The data that are carried through bounces.
    #[inline(always)]
    pub(super) fn followed(&self) -> Followed<f64> {
        Followed {
            parts: self.covariance.parts,
            slant: self.slant,
            tolerance: self.tolerance,
        }
    }

    /// Continues from the result of bounces that were followed in a lane, `impacts` impacts later.
    pub(super) fn continue_from(&mut self, followed: Followed<f64>, impacts: u64) {
        self.covariance.parts = followed.parts;
        self.impacts += impacts as usize;
    }

    /// Carries the spread through any step, unless it has become unknown.
    #[inline(always)]
    fn carry(&mut self, simulation: &Simulation, step: &Step, observer: &mut dyn Observer) -> f64 {
        let map = self.tangent(simulation).of_step(simulation, step);
        observer.observe_step(&map);
        if self.error_is_unknown() {
            return f64::INFINITY;
        }
        let columns: Vec<[Deviation; 3]> = self.keys.iter_mut().map(|key| key.step(&map)).collect();
        let column = |stage: usize| columns.iter().map(|stages| stages[stage]).collect();
        let rounding = Rounding::of_step(simulation, step, &map, self.slant);
        let before = self.covariance.clone().with_seven();
        let along = before.carried(|w, memory| map.carry_along(w, memory), column(0));
        let met = along
            .carried(|w, memory| meet(step, &map, w, memory), column(1))
            .with_part(&rounding.location, map.memory_rate(), rounding.late);
        let by_tension = match self.horizon {
            None => self.horizon_of_tension(simulation, step, &map, [&before, &along]),
            Some(_) => None,
        };
        let neighbours = Neighbours {
            before: Spread::of(&before),
            along: Spread::of(&along),
            met: Spread::of(&met),
            late: rounding.late,
            opening: self
                .maybe_slack
                .as_ref()
                .map_or(TautSet::SLACK, |maybe_slack| maybe_slack.opening),
            keys: &self.keys,
        };
        let approach = LinearMap::Step(&map).approach();
        let closing = Closing::of(simulation, step, &approach);
        let mut after = met.carried(|w, _| map.carry_through(w), column(2));
        if self.horizon.is_none() {
            let other = cause(simulation, step, &approach, &neighbours, closing).or_else(|| {
                let (tangent, keys) = (self.tangent.as_deref()?, &self.keys);
                passed_impulse::cause(simulation.system(), tangent, step, &met, keys)
                    .or_else(|| tension::cause_after_snap(simulation, step, tangent, &after, keys))
                    .map(|cause| (cause, step.t_end))
            });
            let maybe_slack = self.maybe_slack.as_mut();
            let by_start = maybe_slack.and_then(|maybe_slack| {
                maybe_slack.cause(simulation, step, &neighbours.along, closing)
            });
            let others = by_start.into_iter().chain(other);
            let others = others.map(|(cause, t)| self.horizon_at(t, cause));
            let earlier = |a: Horizon, b: Horizon| if b.t < a.t { b } else { a };
            self.horizon = others.chain(by_tension).reduce(earlier);
        }
        if step.event.reached != Reached::default() {
            self.maybe_slack = None;
        }
        after.add_parts(&rounding.parts);
        self.after_snap = !step.event.reached.gaps.is_empty();
        let squared = |sizes: Deviation| sizes.map(|size| size * size);
        let squares = [squared(neighbours.met.sizes), squared(after.sizes())];
        self.covariance = after;
        self.too_large = self.covariance.exceeds_limit();
        self.error_at_event(step, &squares)
    }

    /// Where trust ends because neighbours may lose a tension that the run keeps, or keep one that
    /// it loses, if it does.
    #[inline(never)]
    fn horizon_of_tension(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        map: &StepMap,
        [before, along]: [&CovarianceFactor; 2],
    ) -> Option<Horizon> {
        if step.taut.is_empty() {
            return None;
        }
        self.tangent(simulation);
        let taut = TautStep {
            simulation,
            step,
            tangent: self.tangent.as_deref()?,
            map,
            before,
            along,
            keys: &self.keys,
            is_first: self.steps == 0,
            after_snap: self.after_snap,
        };
        let (falling, since) = self.falling;
        let near = taut.near_zero(falling);
        let before = near.differ.intersection(falling).iter().next();
        let cable = before.or_else(|| near.differ.iter().next());
        let mut horizon =
            cable.map(|cable| self.horizon_at(step.t_end, HorizonCause::Tension { cable }));
        if let (Some(_), Some(horizon)) = (before, &mut horizon) {
            horizon.t = since;
        }
        let still = !near.fall.intersection(falling).is_empty();
        self.falling = (near.fall, if still { since } else { step.t_end });
        horizon
    }

    /// The error at an event, from the variances just before and just after it.
    #[inline(always)]
    fn error_at_event(&mut self, step: &Step, [before, after]: &[Deviation; 2]) -> f64 {
        let largest = larger(
            relative(before, &step.before, step.t_end),
            relative(after, &step.after, step.t_end),
        );
        let error = ERROR * largest.sqrt();
        self.end_error = if step.stop == Some(Stop::EndTime) {
            0.0
        } else {
            ERROR * after[6].sqrt()
        };
        let all: f64 = before.iter().chain(after).sum();
        self.too_large |= !all.is_finite() || all >= LARGEST_SPREAD * LARGEST_SPREAD;
        if step.stop == Some(Stop::Standstill) {
            self.set_horizon(step.t_end, HorizonCause::StopRule);
        }
        if error > self.tolerance || self.too_large {
            self.set_horizon(step.t_end, HorizonCause::Tolerance);
        }
        if self.error_is_unknown() {
            f64::INFINITY
        } else {
            error
        }
    }

    /// Records where trust ends; only the first call has an effect.
    #[inline(always)]
    fn set_horizon(&mut self, t: f64, cause: HorizonCause) {
        self.horizon = self.horizon.or(Some(self.horizon_at(t, cause)));
    }

    #[inline(always)]
    fn horizon_at(&self, t: f64, cause: HorizonCause) -> Horizon {
        Horizon {
            t,
            impact: self.impacts + 1,
            cause,
        }
    }
}
