//! A motion's start and its steps, each compiled for the best instructions that a processor has.

use super::{Simulation, Step};
use crate::arithmetic::dual::Dual;
use crate::arithmetic::precise::Precise;
use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::start::StartError;

/// A start to be computed: a system, its rules, the time and the state.
struct Start<T>(System<T>, Rules<T>, T, State<T>);

impl<T: Real> Kernel for Start<T> {
    type Output = Result<Simulation<T>, StartError>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(system, rules, t, state) = self;
        Simulation::start_here(system, rules, t, state)
    }
}

/// [`Simulation::new`].
pub(super) fn begin<T: Real>(
    system: System<T>,
    rules: Rules<T>,
    t: T,
    state: State<T>,
) -> Result<Simulation<T>, StartError> {
    dispatch_over::<T, _>(Start(system, rules, t, state))
}

/// A step to be made, by the best instructions for it.
pub(super) struct NextStep<'a, T: Real>(pub(super) &'a mut Simulation<T>);

impl<T: Real> Kernel for NextStep<'_, T> {
    type Output = Option<Step<T>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.step_here()
    }
}

/// Numbers over which a motion can be stepped. The step over doubles is compiled once, here: it
/// contains the whole engine, which every crate that steps would otherwise compile again.
pub trait Steps: Real {
    /// [`Simulation::step`].
    fn step(simulation: &mut Simulation<Self>) -> Option<Step<Self>> {
        dispatch_over::<Self, _>(NextStep(simulation))
    }
}

impl Steps for f64 {
    #[inline(never)]
    fn step(simulation: &mut Simulation<Self>) -> Option<Step<Self>> {
        dispatch_over::<Self, _>(NextStep(simulation))
    }
}

impl<T: Real, const N: usize> Steps for Dual<T, N> {}

impl<const WORDS: usize> Steps for Precise<WORDS> {}
