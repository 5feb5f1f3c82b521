//! The outcome of a run, without its trajectory.

use crate::model::taut_set::{MAX_CABLES, Mode, PerCable};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::trajectory::{End, Norms};
use std::ops::ControlFlow;

/// A run summarised in a few numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// When it began \[T\].
    pub t_start: f64,
    /// How it ended.
    pub end: End,
    /// The norms.
    pub norms: Norms,
    /// The number of impacts of each cable, by index from 0; impulses that a taut cable takes with
    /// another are not counted.
    pub impacts: PerCable<u64>,
    /// The first of them.
    pub first: Option<FirstImpact>,
    /// Time with one taut cable \[T\].
    pub sliding: f64,
    /// Time with two or more \[T\].
    pub rocking: f64,
}

/// The first snap of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstImpact {
    /// When \[T\].
    pub t: f64,
    /// The cable, by index from 0.
    pub cable: usize,
    /// Normal velocity just before \[L/T\].
    pub v_n: f64,
}

impl Outcome {
    /// The outcome of a simulation, which is run to its end. Where it has made steps before, its
    /// impacts, times and norms are those of the rest of its motion; but see [`Norms::y_max`].
    pub fn after(mut simulation: Simulation) -> Self {
        let mut outcome = Self::at_start(&simulation);
        while let Some(step) = simulation.step() {
            outcome.take(&step);
        }
        outcome.ended(&simulation)
    }

    /// The same as long as `on_step`, which receives the motion after every step, lets it continue;
    /// none if `on_step` ended it early.
    pub(crate) fn after_while(
        mut simulation: Simulation,
        mut on_step: impl FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Option<Self> {
        let mut outcome = Self::at_start(&simulation);
        while let Some(step) = simulation.step() {
            outcome.take(&step);
            if on_step(&simulation).is_break() {
                return None;
            }
        }
        Some(outcome.ended(&simulation))
    }

    /// The outcome of a motion that has just begun.
    pub(crate) fn at_start(simulation: &Simulation) -> Self {
        Self {
            t_start: simulation.time(),
            end: End::of(simulation),
            norms: Norms::default(),
            impacts: [0; MAX_CABLES],
            first: None,
            sliding: 0.0,
            rocking: 0.0,
        }
    }

    pub(crate) fn take(&mut self, step: &Step) {
        match step.taut.mode() {
            Mode::Slack => {}
            Mode::Sliding => self.sliding += step.t_end - step.t_start,
            Mode::Rocking => self.rocking += step.t_end - step.t_start,
        }
        for impact in step.impacts() {
            self.norms.take(&impact);
            if impact.v_n > 0.0 {
                self.impacts[impact.cable] += 1;
                self.first.get_or_insert(FirstImpact {
                    t: impact.t,
                    cable: impact.cable,
                    v_n: impact.v_n,
                });
            }
        }
    }

    /// The outcome once the motion has stopped.
    pub(crate) fn ended(mut self, simulation: &Simulation) -> Self {
        self.end = End::of(simulation);
        self.norms.y_max = simulation.y_max();
        self.norms.theta_max = simulation.theta_max();
        self
    }

    /// How many impacts there were, of all cables.
    pub fn snaps(&self) -> u64 {
        self.impacts.iter().sum()
    }

    /// Time without a taut cable \[T\].
    pub fn slack(&self) -> f64 {
        self.end.t - self.t_start - self.sliding - self.rocking
    }

    /// Whether it stopped at the rotation limit or the upper bound.
    pub fn exceeds(&self) -> bool {
        self.end.reason.exceeds()
    }
}
