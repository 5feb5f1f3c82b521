//! An uncertain parameter along a run.

use crate::arithmetic::dual::Dual;
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::value::Value;
use crate::model::state::State;
use crate::model::taut_set::{MAX_CABLES, PerCable};
use crate::motion::active_set::normal_acceleration;
use crate::motion::simulation::Simulation;
use crate::motion::step_map::{Deviation, StepMap};

/// The same run with its derivatives by an uncertain parameter.
#[derive(Clone, Debug)]
pub(super) struct UncertainKey {
    simulation: Simulation<Dual<f64, 1>>,
    /// Standard deviation of the parameter.
    size: f64,
    /// That of (w, τ), at the latest event.
    pub(super) deviation: Deviation,
    /// Those of the tensions at the start and at the end of the latest step, by cable.
    pub(super) tensions: [[f64; MAX_CABLES]; 2],
    /// Those of the reactions, per impulse, of the cables that were taut at the latest impact.
    pub(super) reactions: PerCable<f64>,
}

/// The standard deviation of a value that lies anywhere within ± `size`.
pub(super) fn uniform(size: f64) -> f64 {
    size / 3.0_f64.sqrt()
}

impl UncertainKey {
    pub(super) fn new(case: &Case, name: &'static str, size: f64) -> Result<Self, CaseError> {
        if !case.parameters().moves_by(name) {
            let allowed = "no uncertainty, as this case has no such quantity";
            return Err(CaseError::value(name, Value::Number(size), allowed));
        }
        let lift = |key, number| {
            if key == name {
                Dual::variable(number, 0)
            } else {
                Dual::constant(number)
            }
        };
        let simulation = case.simulation_over(lift).map_err(|_| {
            let allowed = "no uncertainty, as the start is exactly at the limit of what is legal";
            CaseError::value(name, Value::Number(size), allowed)
        })?;
        let size = uniform(size);
        let w = simulation.state().components().map(|c| c.slope[0] * size);
        Ok(Self {
            simulation,
            size,
            deviation: [w[0], w[1], w[2], w[3], w[4], w[5], 0.0],
            tensions: [[0.0; MAX_CABLES]; 2],
            reactions: [0.0; MAX_CABLES],
        })
    }

    /// The standard deviation of the normal acceleration of a closed cable that carries nothing, as far
    /// as it depends on the parameter.
    pub(super) fn of_normal_acceleration(&self, cable: usize) -> f64 {
        let simulation = &self.simulation;
        let (system, state) = (simulation.system(), simulation.state());
        let around = simulation.surroundings(simulation.time());
        let (held, taut) = (simulation.memory_force(), simulation.carrying());
        let found = normal_acceleration(system, &around, state, held, cable, taut);
        found.slope[0] * self.size
    }

    /// The deviation just before the event at the time of the previous one, just before it at its
    /// own time, and after it.
    pub(super) fn step(&mut self, map: &StepMap) -> [Deviation; 3] {
        let Some(step) = self.simulation.step() else {
            return [self.deviation; 3];
        };
        let tau = step.t_end.slope[0] * self.size;
        let at = |state: &State<Dual<f64, 1>>| -> Deviation {
            let w = state.components().map(|c| c.slope[0] * self.size);
            [w[0], w[1], w[2], w[3], w[4], w[5], tau]
        };
        let met = at(&step.before);
        let along = map.before_meeting(&met, self.deviation[6]);
        if !step.taut.is_empty() {
            let simulation = &self.simulation;
            let ends = [
                simulation.tensions_at_start(&step),
                simulation.tensions_at_end(&step),
            ];
            self.tensions = ends.map(|ends| ends.map(|tension| tension.slope[0] * self.size));
        }
        if let Some(result) = &step.result {
            let struck = step.event.reached.gaps;
            for cable in step.event.still.iter() {
                self.reactions[cable] = result.reaction(cable, struck).slope[0] * self.size;
            }
        }
        self.deviation = at(&step.after);
        [along, met, self.deviation]
    }
}
