//! The result of a run.

use crate::model::rules::Stop;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::impact::Impact;
use crate::motion::segments::{Segment, Segments};
use crate::motion::simulation::{Simulation, Step};
use std::ops::ControlFlow;

/// An interval of time with one set of taut cables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeInterval {
    /// The taut cables.
    pub taut: TautSet,
    /// From \[T\].
    pub t_start: f64,
    /// To \[T\].
    pub t_end: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Why.
    pub reason: Stop,
    /// When \[T\].
    pub t: f64,
    /// The time at which the series of impacts converges, if the run ends with one \[T\].
    pub t_limit: Option<f64>,
    /// The last state.
    pub state: State,
}

/// Norms of a run, after the chapter's eqs 6.2-6.4.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Norms {
    /// ρ1 = max v_n⁻.
    pub rho1: f64,
    /// ρ2 = Σ v_n⁻ over t ≤ 10.
    pub rho2: f64,
    /// ρ3 = Σ v_n⁻.
    pub rho3: f64,
    /// The highest y of the centre, over all that the simulation has moved, also before it was
    /// recorded.
    pub y_max: f64,
    /// The largest |θ|, likewise.
    pub theta_max: f64,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Trajectory {
    system: System,
    segments: Segments,
    impacts: Vec<Impact>,
    modes: Vec<ModeInterval>,
    end: End,
    norms: Norms,
}

/// ρ2 includes impacts up to this time (chapter eq. 6.3).
pub(crate) const RHO2_UNTIL: f64 = 10.0;

impl Trajectory {
    /// Runs a simulation to its end, and keeps the data from which the motion at any time is
    /// computed, from where the simulation is now.
    pub fn record(simulation: Simulation) -> Self {
        Self::record_until(simulation, |_, _| ControlFlow::Continue(())).0
    }

    /// The same, as long as `on_step`, which receives the simulation and the step after every step,
    /// lets it continue; none if `on_step` ended it early.
    pub fn record_while(
        simulation: Simulation,
        on_step: impl FnMut(&Simulation, &Step) -> ControlFlow<()>,
    ) -> Option<Self> {
        match Self::record_until(simulation, on_step) {
            (run, ControlFlow::Continue(())) => Some(run),
            (_, ControlFlow::Break(())) => None,
        }
    }

    fn record_until(
        mut simulation: Simulation,
        mut on_step: impl FnMut(&Simulation, &Step) -> ControlFlow<()>,
    ) -> (Self, ControlFlow<()>) {
        let mut run = Self {
            system: simulation.system().clone(),
            segments: Segments::new(),
            impacts: Vec::new(),
            modes: Vec::new(),
            end: End::of(&simulation),
            norms: Norms::default(),
        };
        // Borrowed, because a step is large.
        while let Some(step) = &simulation.step() {
            run.take(&simulation, step);
            if on_step(&simulation, step).is_break() {
                return (run, ControlFlow::Break(()));
            }
        }
        run.end = End::of(&simulation);
        run.segments.end(&simulation);
        run.norms.y_max = simulation.y_max();
        run.norms.theta_max = simulation.theta_max();
        (run, ControlFlow::Continue(()))
    }

    fn take(&mut self, simulation: &Simulation, step: &Step) {
        self.segments.take(simulation, step);
        if step.t_end > step.t_start {
            match self.modes.last_mut() {
                Some(mode) if mode.taut == step.taut => mode.t_end = step.t_end,
                _ => self.modes.push(ModeInterval {
                    taut: step.taut,
                    t_start: step.t_start,
                    t_end: step.t_end,
                }),
            }
        }
        for impact in step.impacts() {
            self.norms.take(&impact);
            self.impacts.push(impact);
        }
    }

    /// The system that moved.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The impacts in order of time; the rows of one instant in order of their cables.
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// Mode intervals, without gap or overlap from the start to the end.
    pub fn modes(&self) -> &[ModeInterval] {
        &self.modes
    }

    /// How it ended.
    pub fn end(&self) -> &End {
        &self.end
    }

    /// The norms.
    pub fn norms(&self) -> &Norms {
        &self.norms
    }

    pub(crate) fn segments(&self) -> &[Segment] {
        self.segments.kept()
    }

    /// Keeps at most this many of the Taylor series that continue others, as a long run does by
    /// itself; returns the start times of the parts of the motion that are kept.
    #[cfg(feature = "comparisons")]
    pub fn keep_links(&mut self, most: usize) -> Vec<f64> {
        self.segments.keep_links(most);
        self.segments().iter().map(|segment| segment.t).collect()
    }
}

impl End {
    /// The trajectory of a simulation that has stopped.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        Self {
            reason: simulation.stop().unwrap_or(Stop::EndTime),
            t: simulation.time(),
            t_limit: simulation.t_limit(),
            state: *simulation.state(),
        }
    }
}

impl Norms {
    pub(crate) fn take(&mut self, impact: &Impact) {
        self.rho1 = self.rho1.max(impact.v_n);
        self.rho3 += impact.v_n;
        if impact.t <= RHO2_UNTIL {
            self.rho2 += impact.v_n;
        }
    }
}
