//! A structure with its place of rest and its model, ready to run.

use super::equilibrium::{Equilibrium, equilibrium};
use super::model::Model;
use crate::structure::{IrregularSea, Structure, Water};
use snapload::{CaseError, Simulation, StartError, State, Stop};

/// A body that is turned by less than this at rest is upright: its gaps are then off by rounding
/// only \[rad\].
const UPRIGHT: f64 = 1e-12;

/// Structure, place of rest and model, ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The structure.
    pub structure: Structure,
    /// Where it rests.
    pub rest: Equilibrium,
    /// The same in the engine's units.
    pub model: Model,
    start: State,
}

impl Prepared {
    /// Finds where the structure rests and makes its model.
    ///
    /// # Errors
    /// A [`CaseError`] if it rests nowhere or can not start where it should.
    pub fn new(structure: Structure) -> Result<Self, CaseError> {
        let rest = equilibrium(&structure)?;
        let model = model_at_rest(&structure, &rest);
        let prepared = Self::starting(structure, rest, model);
        prepared.begin(1.0)?;
        Ok(prepared)
    }

    /// A structure with its place of rest and the model about it, at its start.
    pub(super) fn starting(structure: Structure, rest: Equilibrium, model: Model) -> Self {
        let start = match structure.start_m {
            Some(place) => model.at_rest(place, 0.0),
            None => model.at_rest(rest.place_m, rest.theta_rad),
        };
        Self {
            structure,
            rest,
            model,
            start,
        }
    }

    /// The same structure in another sea; where it rests stays.
    #[must_use]
    pub fn in_sea(&self, sea: IrregularSea) -> Self {
        let structure = Structure {
            water: Water::Sea(sea),
            ..self.structure.clone()
        };
        Self {
            model: model_at_rest(&structure, &self.rest),
            structure,
            ..self.clone()
        }
    }

    /// The motion at its start, in waves that are so many times as high.
    ///
    /// # Errors
    /// A [`CaseError`] on the start, which [`Prepared::new`] has excluded.
    pub fn begin(&self, height: f64) -> Result<Simulation, CaseError> {
        let mut system = self.model.system.clone();
        let water = system.drag.iter_mut().flat_map(|drag| &mut drag.water);
        for harmonic in system.forcing.harmonics.iter_mut().chain(water) {
            harmonic.cosine = harmonic.cosine.map(|force| force * height);
            harmonic.sine = harmonic.sine.map(|force| force * height);
        }
        Simulation::new(system, self.model.rules, 0.0, self.start)
            .map_err(|error| self.explain(error))
    }

    /// The state in which it begins, in the engine's units.
    pub fn start(&self) -> State {
        self.start
    }

    fn explain(&self, error: StartError) -> CaseError {
        let [x, z] = self.structure.start_m.unwrap_or(self.rest.place_m);
        let allowed = match error {
            StartError::CableTooShort { cable, .. } => format!(
                "a start within reach of every line; line {} is too short",
                cable + 1
            ),
            StartError::BeyondLimit {
                stop: Stop::UpperBound,
                ..
            } => "a body above the floor".to_owned(),
            _ => error.to_string(),
        };
        CaseError::value("run.start", format!("[{x}, {z}]"), allowed)
            .with_hint("leave start out to begin at rest in still water")
    }
}

/// The model about the place of rest. The lines of a turned body are as long as their gaps say;
/// those that hold an upright one are exactly taut there.
fn model_at_rest(structure: &Structure, rest: &Equilibrium) -> Model {
    let upright = rest.theta_rad.abs() < UPRIGHT;
    let taut: &[usize] = if upright { &rest.taut } else { &[] };
    Model::about(structure, rest.place_m, taut)
}
