//! A structure with its position of rest and its model, ready to run.

use super::afloat::{TautMode, model, rest_afloat};
use super::elastic::undamped;
use super::equilibrium::{
    DistributionByStiffness, Equilibrium, TOUCHING, equilibrium, steady_load_error,
};
use super::model::{CURRENT, Model};
use super::rates::check_rates;
use crate::structure::{LineSi, Structure, Water};
use snapload::{CaseError, Simulation, StartError, State, Stop, System};
use snapload_hydro::{held_summary, periods_summary};

/// A body turned by less than this at rest is upright: the resulting errors of its gaps are only
/// rounding \[rad\].
const UPRIGHT_RAD: f64 = 1e-12;

/// Tensions at rest count as differently distributed if they differ by more than this part of the
/// largest.
const DIFFERENT_BY: f64 = 0.05;

/// Structure, position of rest and model, ready to run.
#[derive(Clone, Debug)]
pub struct ModelAtRest {
    /// The structure.
    pub structure: Structure,
    /// Its position of rest.
    pub rest: Equilibrium,
    /// The same in the engine's units.
    pub model: Model,
    /// The small motions about the position of rest that the taut lines of a floating body allow.
    pub modes_on_taut_lines: Vec<TautMode>,
    start: State,
}

impl ModelAtRest {
    /// Finds the structure's position of rest and makes its model.
    ///
    /// # Errors
    /// A [`CaseError`] if it has no position of rest or the start is not possible.
    pub fn new(structure: Structure) -> Result<Self, CaseError> {
        let prepared = Self::at_rest(structure)?;
        prepared.begin(1.0)?;
        Ok(prepared)
    }

    /// The same for elastic lines, which may already be stretched at the start of the case.
    ///
    /// # Errors
    /// A [`CaseError`] if it has no position of rest or the start is not possible.
    pub fn for_elastic_lines(structure: Structure) -> Result<Self, CaseError> {
        let prepared = Self::at_rest(structure)?;
        match prepared.simulation(1.0) {
            Ok(_) | Err(StartError::CableTooShort { .. }) => Ok(prepared),
            Err(error) => Err(prepared.start_error(error)),
        }
    }

    /// Whether its start is within reach of inextensible lines.
    pub fn starts_within_reach(&self) -> bool {
        self.simulation(1.0).is_ok()
    }

    /// With its position of rest and its model, but its start unchecked.
    fn at_rest(structure: Structure) -> Result<Self, CaseError> {
        let (mut rest, modes_on_taut_lines) = match &structure.afloat {
            Some(afloat) => rest_afloat(&structure, afloat)?,
            None => (equilibrium(&structure)?, Vec::new()),
        };
        let model = model_about_rest(&structure, &rest)?;
        check_rates(&structure, &model)?;
        if structure.afloat.is_some() {
            rest.distribute_by_least_squares(&structure, &model);
        }
        let mut prepared = Self {
            modes_on_taut_lines,
            ..Self::starting(structure, rest, model)
        };
        if prepared.rest.rests {
            prepared.distribute_by_stiffness();
        }
        Ok(prepared)
    }

    /// Takes the tensions at rest from the stiffness of the lines if that is known and lines that
    /// do not stretch would distribute the load differently.
    fn distribute_by_stiffness(&mut self) {
        let Ok(elastic_lines) = undamped(self, 1.0) else {
            return;
        };
        let Ok(elastic_case) = self.with_elastic_lines(&elastic_lines) else {
            self.rest.not_on_elastic_lines = true;
            return;
        };
        let by_stiffness = elastic_case.rest.tension_n;
        let rigid = &self.rest.tension_n;
        if distributes_differently(&self.structure, [rigid, &by_stiffness]) {
            self.rest.by_stiffness = Some(DistributionByStiffness {
                inextensible_n: std::mem::replace(&mut self.rest.tension_n, by_stiffness),
                place_m: elastic_case.rest.place_m,
            });
        } else if differ(rigid, &by_stiffness, [1.0; 2]) {
            self.rest.elastic_tension_n = Some(by_stiffness);
        }
    }

    /// The lines whose tension at rest breaks them whatever their stiffness, by number from 1, each
    /// with the ratio of the two: tensions that are reported for inextensible lines differ from
    /// those of elastic ones by a part of the largest at most.
    pub(crate) fn breaking_at_rest(&self) -> Vec<(usize, f64)> {
        let rest = &self.rest;
        let depends = rest.indeterminate
            || rest.by_stiffness.is_some()
            || rest.elastic_tension_n.is_some()
            || rest.not_on_elastic_lines;
        if depends || !rest.rests {
            return Vec::new();
        }
        let largest_n = rest.tension_n.iter().copied().fold(0.0, f64::max);
        let unsure_n = DIFFERENT_BY / (1.0 - DIFFERENT_BY) * largest_n;
        let breaks = |((number, pull_n), line): ((usize, &f64), &LineSi)| {
            let load_n = line.breaking_load_n?;
            (pull_n - unsure_n >= load_n).then_some((number, pull_n / load_n))
        };
        let lines = (1..).zip(&rest.tension_n).zip(&self.structure.lines);
        lines.filter_map(breaks).collect()
    }

    /// A structure with its position of rest and the model about it, at its start.
    pub(super) fn starting(structure: Structure, rest: Equilibrium, model: Model) -> Self {
        let start = match structure.start_m {
            Some(place) => model.at_rest(place, 0.0),
            None => model.at_rest(rest.place_m, rest.theta_rad),
        };
        Self {
            structure,
            rest,
            model,
            modes_on_taut_lines: Vec::new(),
            start,
        }
    }

    /// The same structure in other waves; its position of rest does not change.
    ///
    /// # Errors
    /// A [`CaseError`] if a floating body has no coefficients for them.
    pub fn in_water(&self, water: Water) -> Result<Self, CaseError> {
        let structure = Structure {
            water,
            ..self.structure.clone()
        };
        Ok(Self {
            model: model_about_rest(&structure, &self.rest)?,
            structure,
            ..self.clone()
        })
    }

    /// The same structure with another coefficient of restitution; its position of rest does not
    /// change.
    #[must_use]
    pub(crate) fn with_restitution(&self, restitution: f64) -> Self {
        let mut other = self.clone();
        other.structure.restitution = restitution;
        other.model.system.restitution = restitution;
        other
    }

    /// The motion at its start, in waves `height` times as high.
    ///
    /// # Errors
    /// A [`CaseError`] on the start, which [`ModelAtRest::new`] has excluded.
    pub fn begin(&self, height: f64) -> Result<Simulation, CaseError> {
        self.simulation(height)
            .map_err(|error| self.start_error(error))
    }

    fn simulation(&self, height: f64) -> Result<Simulation, StartError> {
        let system = self.system_in(height);
        Simulation::new(system, self.model.rules, 0.0, self.start)
    }

    /// The same in waves multiplied by `height`.
    pub(crate) fn in_waves_times(&self, height: f64) -> Self {
        let mut other = self.clone();
        other.model.system = self.system_in(height);
        other
    }

    /// Its equations in waves multiplied by `height`.
    fn system_in(&self, height: f64) -> System {
        let mut system = self.model.system.clone();
        let water = system.drag.iter_mut().flat_map(|drag| &mut drag.water);
        let water = water.filter(|water| water.omega != CURRENT);
        for harmonic in system.forcing.harmonics.iter_mut().chain(water) {
            harmonic.cosine = harmonic.cosine.map(|force| force * height);
            harmonic.sine = harmonic.sine.map(|force| force * height);
        }
        for wave in system
            .floating
            .iter_mut()
            .flat_map(|water| &mut water.excitation)
        {
            wave.cosine = wave.cosine.map(|force| force * height);
            wave.sine = wave.sine.map(|force| force * height);
        }
        system
    }

    /// Facts about a floating body besides its motion, each a label and its text; empty for a
    /// submerged one.
    pub fn rows_afloat(&self) -> Vec<(&'static str, String)> {
        let Some(afloat) = &self.structure.afloat else {
            return Vec::new();
        };
        let report = &afloat.report;
        let mut rows = vec![(
            "afloat",
            format!("{}; memory: {}", report.name, report.memory_summary()),
        )];
        if let Ok(floating) = &report.floating {
            let free = periods_summary(&floating.natural, &floating.modes);
            rows.push((
                "periods",
                format!("without lines, about the body's centre: {free}"),
            ));
        }
        if self.rest.tension_n.iter().any(|pull| *pull > 0.0) {
            let (natural, modes): (Vec<_>, Vec<_>) =
                self.modes_on_taut_lines.iter().cloned().unzip();
            let held = held_summary(&natural, &modes);
            rows.push(("taut", format!("while the lines stay taut: {held}")));
        }
        let stretched = self.modes_on_elastic_lines();
        if !stretched.is_empty() {
            let (natural, modes): (Vec<_>, Vec<_>) = stretched.into_iter().unzip();
            let text = periods_summary(&natural, &modes);
            rows.push(("elastic", format!("with elastic lines: {text}")));
        }
        rows
    }

    /// The state in which it begins, in the engine's units.
    pub fn start(&self) -> State {
        self.start
    }

    /// The largest part of its slack at rest that a line uses up in some states: 0 as at rest, 1
    /// where it is taut; none for a line with tension at rest.
    pub(crate) fn slack_used(
        &self,
        line: usize,
        states: impl IntoIterator<Item = State>,
    ) -> Option<f64> {
        if self.rest.inextensible_tensions_n()[line] > 0.0 {
            return None;
        }
        let cable = &self.model.system.cables[line];
        // The distance that it lacks to be taut.
        let lacks = |at: &State| {
            let lacks = -cable.stretch(at).elongation;
            (lacks > TOUCHING).then_some(lacks)
        };
        let rest = self.model.at_rest(self.rest.place_m, self.rest.theta_rad);
        let Some(at_rest) = lacks(&rest) else {
            return Some(1.0);
        };
        let used = |at: State| lacks(&at).map_or(1.0, |lacks| 1.0 - lacks / at_rest);
        states.into_iter().map(used).reduce(f64::max)
    }

    fn start_error(&self, error: StartError) -> CaseError {
        if self.structure.start_m.is_none() && matches!(error, StartError::BeyondLimit { .. }) {
            let allowed = "a load under which the body rests above the floor, turned by less than 90 \
                           degrees";
            if let Some(error) = steady_load_error(&self.structure, allowed) {
                return error;
            }
        }
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

/// Whether the distribution of the load at rest differs from that on inextensible lines,
/// whose tensions come first. For a floating body the water carries the load that elastic lines
/// lose, so that the parts of the lines' total load are compared.
fn distributes_differently(structure: &Structure, tensions_n: [&[f64]; 2]) -> bool {
    let units = match structure.afloat {
        Some(_) => tensions_n.map(|pulls| pulls.iter().sum::<f64>().max(f64::MIN_POSITIVE)),
        None => [1.0; 2],
    };
    differ(tensions_n[0], tensions_n[1], units)
}

/// Whether any of them, each in its unit, differ by more than a part of the largest of the latter.
fn differ(rigid: &[f64], by_stiffness: &[f64], [one, other]: [f64; 2]) -> bool {
    let largest = by_stiffness
        .iter()
        .fold(0.0_f64, |most, pull| most.max(*pull));
    let apart = |(a, b): (&f64, &f64)| (a / one - b / other).abs() > DIFFERENT_BY * largest / other;
    rigid.iter().zip(by_stiffness).any(apart)
}

/// The model about the position of rest. For a turned body the lengths of the lines give their
/// gaps; the lines that hold an upright one are exactly taut there.
fn model_about_rest(structure: &Structure, rest: &Equilibrium) -> Result<Model, CaseError> {
    if let Some(afloat) = &structure.afloat {
        return model(structure, afloat);
    }
    let upright = rest.theta_rad.abs() < UPRIGHT_RAD;
    let taut: &[usize] = if upright { &rest.taut } else { &[] };
    Ok(Model::about(structure, rest.place_m, taut))
}
