//! How fast the body can move and be damped, and whether a run can follow that to its end.

use super::model::Model;
use crate::structure::Structure;
use crate::text_layout::{in_full, rounded_down};
use snapload::{Body, CaseError, Harmonic, System, Value};

/// The longest run takes so many times 1/ω of the fastest oscillation, or times in which the
/// strongest damping would stop the body. A longer one takes hours, as its steps are parts of them.
const MOST: f64 = 3e6;
/// On elastic lines, of which a step is cheaper.
const MOST_ON_ELASTIC_LINES: f64 = 3e7;

/// A rate of the motion.
struct Rate {
    /// In the engine's units.
    per_time: f64,
    /// What the body does at that rate.
    does: &'static str,
    /// The keys on which it depends.
    keys: &'static str,
    /// The key of a damping that is proportional to it, with its value.
    damping: Option<(&'static str, f64)>,
}

impl Rate {
    fn new(per_time: f64, does: &'static str, keys: &'static str) -> Self {
        Self {
            per_time,
            does,
            keys,
            damping: None,
        }
    }

    /// Refuses it if it is too fast for the run.
    fn check(&self, structure: &Structure, model: &Model, most: f64) -> Result<(), CaseError> {
        let excess = self.per_time * model.rules.t_end / most;
        if excess <= 1.0 {
            return Ok(());
        }
        let duration_s = structure.duration_s;
        let hint = format!(
            "check the units of {}, or make run.duration shorter",
            self.keys
        );
        let error = match self.damping {
            Some((key, damping)) => {
                let allowed = format!(
                    "at most {} for this body: more stops it within so short a time that a run of \
                     {duration_s} s takes very long",
                    in_full(&rounded_down(damping / excess))
                );
                CaseError::value(key, Value::Number(damping), allowed)
            }
            None => {
                let allowed = format!(
                    "at most {} s for this body, which {} at a rate of up to {:.1e} 1/s: a longer run takes very long",
                    in_full(&rounded_down(duration_s / excess)),
                    self.does,
                    self.per_time / model.scales.time_s
                );
                CaseError::value("run.duration", Value::Number(duration_s), allowed)
            }
        };
        Err(error.with_hint(hint))
    }
}

/// Refuses a structure whose motion a run would follow for hours.
pub(super) fn check_rates(structure: &Structure, model: &Model) -> Result<(), CaseError> {
    let mut rates = Vec::from(forced(model));
    rates.extend(damped(structure, model));
    rates.extend(afloat(model));
    let mut rates = rates.iter();
    rates.try_for_each(|rate| rate.check(structure, model, MOST))
}

/// The same of its motion on elastic lines, given a bound on the rates of its oscillations on
/// them and of their damping.
pub(super) fn check_rate_on_elastic_lines(
    structure: &Structure,
    model: &Model,
    per_time: f64,
) -> Result<(), CaseError> {
    let keys = "body.mass, body.moment_of_inertia and line.stiffness";
    let rate = Rate::new(per_time, "oscillates on its elastic lines", keys);
    rate.check(structure, model, MOST_ON_ELASTIC_LINES)
}

/// Swinging and turning under the loads at the fairleads.
fn forced(model: &Model) -> [Rate; 2] {
    let system = &model.system;
    let load = load(system);
    let shortest = system.cables.iter().map(|cable| cable.length());
    let arms = system.cables.iter().map(|cable| cable.fairlead().length());
    let (shortest, arm) = (
        shortest.fold(f64::INFINITY, f64::min),
        arms.fold(0.0, f64::max),
    );
    let (mobility, turning) = mobilities(&system.body);
    [
        Rate::new(
            (load * mobility / shortest).sqrt(),
            "swings on its lines",
            "body.mass, body.added_mass, body.displaced_volume and line.length",
        ),
        Rate::new(
            (load * turning * arm).sqrt(),
            "turns on its lines",
            "body.moment_of_inertia, body.added_mass and body.displaced_volume",
        ),
    ]
}

/// Damping and drag, these at the speed of the water past the body.
fn damped(structure: &Structure, model: &Model) -> Vec<Rate> {
    let Some(drag) = &model.system.drag else {
        return Vec::new();
    };
    let body = &structure.body;
    let (mobility, _) = mobilities(&model.system.body);
    // By its loads a body moves no faster past still water, where its drag is as large as they; the
    // sum with the water's own velocity is an estimate.
    let own = (load(&model.system) / drag.quadratic.max(f64::MIN_POSITIVE)).sqrt();
    let speed = own + together(&drag.water);
    let of = |per_time: f64, keys: &'static str, damping: (&'static str, f64)| Rate {
        damping: Some(damping),
        ..Rate::new(per_time, "is slowed down by its damping", keys)
    };
    vec![
        of(
            drag.linear * mobility,
            "body.mass and body.linear_damping",
            ("body.linear_damping", body.linear_damping_n_s_m),
        ),
        of(
            drag.turning,
            "body.moment_of_inertia and body.turning_damping",
            ("body.turning_damping", body.turning_damping_n_m_s),
        ),
        Rate::new(
            drag.quadratic * speed * mobility,
            "is slowed down by its drag",
            "body.mass and body.drag_area",
        ),
    ]
}

/// The stiffness and the damping of the water about a floating body.
fn afloat(model: &Model) -> Vec<Rate> {
    let Some(water) = &model.system.floating else {
        return Vec::new();
    };
    let (mobility, turning) = mobilities(&model.system.body);
    let mass = ["body.mass", "body.mass and float.damping"];
    let inertia = [
        "body.moment_of_inertia",
        "body.moment_of_inertia and float.damping",
    ];
    let freedoms = [(mobility, mass), (mobility, mass), (turning, inertia)];
    let rates = freedoms.into_iter().enumerate();
    let rates = rates.flat_map(|(i, (inverse_mass, [keys, keys_of_damping]))| {
        let stiffness = water.stiffness[i][i].abs() * inverse_mass;
        [
            Rate::new(stiffness.sqrt(), "oscillates in the water", keys),
            Rate::new(
                water.damping[i][i] * inverse_mass,
                "is slowed down by its damping",
                keys_of_damping,
            ),
        ]
    });
    rates.collect()
}

/// The most that a force moves the body, and a moment turns it.
fn mobilities(body: &Body) -> (f64, f64) {
    let mobility = body.largest_inverse_effective_mass(0.0);
    (
        mobility,
        body.largest_inverse_effective_mass(1.0) - mobility,
    )
}

/// The size of all loads but those of lines and drag: weight, buoyancy, constant forces and waves.
fn load(system: &System) -> f64 {
    let weight = if system.floating.is_some() { 1.0 } else { 0.0 };
    weight + system.forcing.constant.length() + together(&system.forcing.harmonics)
}

/// The size of sinusoids of different frequencies together.
fn together(harmonics: &[Harmonic]) -> f64 {
    let squares = harmonics.iter().map(|one| one.amplitude().powi(2));
    squares.sum::<f64>().sqrt()
}
