//! Slack flight as a motion without taut cables, for the events that begin it.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::model::{Model, State};
use crate::taut::chart::{Chart, StateJets, Terms, force};
use crate::taut::series::Program;
use crate::verdict::ProofFailure;

/// No taut cable. The coordinates are x, y, θ and their rates.
pub(crate) struct Free;

impl Chart<6> for Free {
    fn terms(&self, model: &Model) -> Terms {
        let mut program = self.place(model);
        let [vx, vy, spin] = [3, 4, 5].map(|which: usize| program.outputs[which]);
        let [fx, fy] = force(&mut program, model);
        let nothing = program.constant(Ball::zero());
        program.rates = vec![vx, vy, spin, fx, fy, nothing];
        program.outputs.clear();
        Terms {
            program,
            event_functions: Vec::new(),
        }
    }

    fn coordinates(&self, _: &Model, state: &State) -> Result<State, ProofFailure> {
        Ok(state.clone())
    }

    fn slopes(&self, _: &Model, state: &StateJets) -> Option<[[Interval; 7]; 6]> {
        Some(std::array::from_fn(|i| state[i].slopes))
    }

    fn place(&self, _: &Model) -> Program {
        let mut p = Program::new();
        p.outputs = (0..6).map(|which| p.coordinate(which)).collect();
        p
    }
}
