//! The effect of a step on deviations, and who is told of it.

use crate::analysis::trust::causes::Closing;
use crate::analysis::trust::neighbours::Approach;
use crate::analysis::trust::parts::COLUMNS;
use crate::model::rules::Stop;
use crate::motion::bounce_map::BounceMap;
use crate::motion::events::Reached;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Block, StepMap};

/// The effect of a step on deviations.
pub(super) enum LinearMap<'a> {
    /// That of a bounce.
    Bounce(&'a BounceMap<f64>),
    /// That of any step.
    Step(&'a StepMap),
}

impl LinearMap<'_> {
    /// See [`StepMap::magnification_squared`].
    #[inline(always)]
    pub(super) fn magnification_squared(&self) -> f64 {
        match self {
            Self::Bounce(map) => map.magnification_squared(),
            Self::Step(map) => map.magnification_squared(),
        }
    }

    /// Whether it is certain, from these numbers alone, that the closing of the gap does not slow
    /// down.
    #[inline(always)]
    pub(super) fn certainly_accelerates(&self) -> bool {
        match self {
            Self::Bounce(map) => map.certainly_accelerates(),
            Self::Step(_) => false,
        }
    }

    #[inline(always)]
    pub(super) fn approach(&self) -> Approach {
        match self {
            Self::Bounce(map) => Approach {
                rate: map.rate(),
                delay: map.delay(),
            },
            Self::Step(map) => Approach {
                rate: *map.rate(),
                delay: *map.delay(),
            },
        }
    }

    /// How the gap of the cable that snaps closes, if exactly one does.
    #[inline(always)]
    pub(super) fn closing(&self, simulation: &Simulation, step: &Step) -> Option<Closing> {
        Closing::of(simulation, step, &self.approach())
    }
}

/// Carries deviations just before the end of a step to each neighbour's own event; to one time for
/// all where the run ends without one.
#[inline(always)]
pub(super) fn meet(
    step: &Step,
    map: &StepMap,
    w: &mut Block<COLUMNS>,
    memory: &mut [[f64; COLUMNS]],
) {
    if step.stop != Some(Stop::EndTime) || step.event.reached != Reached::default() {
        return map.carry_to_meet(w, memory);
    }
    let (state, [tau]) = w.split_at_mut(6) else {
        return;
    };
    let rows = state.iter_mut().chain(memory);
    for (row, rate) in rows.zip(map.rate().iter().chain(map.memory_rate())) {
        for (entry, tau) in row.iter_mut().zip(*tau) {
            *entry -= rate * tau;
        }
    }
    *tau = [0.0; COLUMNS];
}

/// Receives the effect of each step on deviations. It is no closure, because a closure would be
/// compiled without the processor's own instructions.
pub(super) trait Observer {
    /// Receives the effect of a bounce.
    fn observe_bounce(&mut self, map: &BounceMap<f64>)
    where
        Self: Sized;
    /// Receives the effect of any step. The observer is called through a pointer, so that the
    /// following of a step is compiled once for all observers.
    fn observe_step(&mut self, map: &StepMap);
}

impl Observer for () {
    #[inline(always)]
    fn observe_bounce(&mut self, _: &BounceMap<f64>) {}
    fn observe_step(&mut self, _: &StepMap) {}
}
