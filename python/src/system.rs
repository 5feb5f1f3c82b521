//! User-defined systems: body, cables and forces, from Python objects.

use crate::errors::{error_of_case, error_of_study, error_of_work, internal_error};
use crate::interrupt::{interruptible, on_this_thread};
use crate::run::{Run, checked_tolerance};
use crate::study::{Plain, on_threads};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use snapload::analysis::{
    Cancelled, Certainty, Counter, Progress, TrustMonitor, Uncertainty, in_parallel, record,
};
use snapload::{
    CaseError, Forcing, Harmonic, Limit, LimitBounds, Outcome, Rules, Shape, Simulation,
    StartError, State, Value,
};
use snapload_report::RunWithTrust;
use snapload_study::{Column, StudyError, Values, columns};
use std::collections::HashMap;
use std::sync::Arc;

/// `snapload.Body`.
#[derive(FromPyObject)]
struct Body {
    mass: f64,
    inertia: Option<f64>,
    radius: Option<f64>,
    half_size: Option<[f64; 2]>,
}

/// `snapload.Cable`.
#[derive(FromPyObject)]
struct Cable {
    anchor: [f64; 2],
    length: f64,
    fairlead: [f64; 2],
}

/// `snapload.Sinusoid`.
#[derive(FromPyObject)]
struct Sinusoid {
    amplitude: [f64; 2],
    omega: f64,
    phase: [f64; 2],
}

/// `snapload.Forcing`.
#[derive(FromPyObject)]
struct Forces {
    constant: [f64; 2],
    sinusoids: Vec<Sinusoid>,
}

/// What ends a run, from the keys of `snapload.System`.
#[derive(FromPyObject)]
struct Stops {
    t_end: f64,
    /// The bounds of the limits that are given, by their names.
    #[pyo3(attribute("_limits"))]
    limits: HashMap<String, f64>,
    settled_below: Option<f64>,
    sliding_above: Option<f64>,
    max_impacts: u64,
    v_stick: f64,
}

impl Body {
    fn shape(&self) -> Shape {
        match (self.half_size, self.radius) {
            (Some([half_width, half_height]), _) => Shape::Rectangle {
                half_width,
                half_height,
            },
            (None, Some(radius)) if radius > 0.0 => Shape::Circle { radius },
            _ => Shape::Point,
        }
    }

    /// A body of unit mass flies in closed form under up to eight sinusoids. What is given as the
    /// inertia of a point of another mass does nothing, as its cables have no lever arm.
    fn in_engine(&self) -> PyResult<snapload::Body> {
        match (self.mass == 1.0, self.inertia) {
            (true, Some(inertia)) => Ok(snapload::Body::rigid(self.shape(), inertia)),
            (true, None) => Ok(snapload::Body::point()),
            (false, inertia) => {
                let m = self.mass;
                let turning = inertia.unwrap_or(m);
                let matrix = [[m, 0.0, 0.0], [0.0, m, 0.0], [0.0, 0.0, turning]];
                let body = snapload::Body::with_mass_matrix(self.shape(), matrix);
                body.ok_or_else(|| internal_error("mass and inertia are above 0"))
            }
        }
    }
}

impl Forces {
    fn in_engine(&self) -> Forcing {
        let wave = |s: &Sinusoid| Harmonic::with_phases(s.omega, s.amplitude, s.phase);
        Forcing {
            constant: self.constant.into(),
            harmonics: self.sinusoids.iter().map(wave).collect(),
        }
    }
}

impl Stops {
    fn in_engine(&self) -> Rules {
        Rules {
            limits: Limit::ALL
                .into_iter()
                .fold(LimitBounds::none(), |bounds, limit| {
                    bounds.with(limit, self.limits.get(limit.stop().name()).copied())
                }),
            settled_below: self.settled_below,
            sliding_above: self.sliding_above,
            t_end: self.t_end,
            max_impacts: self.max_impacts,
            v_stick: self.v_stick,
        }
    }
}

/// A system at its start.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct System {
    simulation: Arc<Simulation>,
}

#[pymethods]
impl System {
    /// Of the parts of a `snapload.System`, which has checked their numbers, and its keys.
    #[new]
    fn new(
        body: Body,
        cables: Vec<Cable>,
        forces: Forces,
        restitution: f64,
        start: [f64; 6],
        stops: Stops,
    ) -> PyResult<Self> {
        let lengths: Vec<f64> = cables.iter().map(|cable| cable.length).collect();
        let cables = cables.into_iter();
        let system = snapload::System {
            body: body.in_engine()?,
            cables: cables
                .map(|cable| snapload::Cable::new(cable.anchor, cable.fairlead, cable.length))
                .collect(),
            forcing: forces.in_engine(),
            drag: None,
            floating: None,
            restitution,
        };
        let start = State::from_components(start);
        let simulation = Simulation::new(system, stops.in_engine(), 0.0, start);
        let simulation =
            simulation.map_err(|error| error_of_case(explain(error, &start, &lengths)))?;
        Ok(Self {
            simulation: Arc::new(simulation),
        })
    }
}

impl System {
    /// Its parts and what ends a run.
    pub(crate) fn parts(&self) -> (snapload::System, Rules) {
        (self.simulation.system().clone(), *self.simulation.rules())
    }
}

/// An illegal start in the words of the keys.
fn explain(error: StartError, start: &State, lengths: &[f64]) -> CaseError {
    let place = format!("{}, {}, {}", start.x, start.y, start.theta);
    match error {
        StartError::CableTooShort { cable, gap, .. } => {
            let length = lengths[cable];
            let over = gap / ((length * length + gap).sqrt() + length);
            let cable = cable + 1;
            let allowed = format!(
                "a start within reach of all cables; cable {cable} would have to be {over:.3e} \
                 longer"
            );
            let hint = format!("move the start, or raise length_{cable}");
            CaseError::value("x, y, theta", place, allowed).with_hint(hint)
        }
        StartError::BeyondLimit { stop, value, bound } => {
            let (key, what) = (stop.name(), stop.limit().map_or("place", Limit::bounded));
            let allowed = format!("a bound beyond the start, whose {what} is {value}");
            CaseError::value(key, Value::Number(bound), allowed)
        }
        StartError::TooShort { cable, length } => {
            let key = format!("length_{}", cable + 1);
            CaseError::value(&key, Value::Number(length), error.to_string())
        }
        StartError::NotAllowed {
            key,
            value,
            allowed,
        } => CaseError::value(key, Value::Number(value), allowed),
        StartError::CanNotClose { .. }
        | StartError::NotFinite
        | StartError::Restitution
        | StartError::TooManyCables => CaseError::value("x, y, theta", place, error.to_string()),
    }
}

/// Runs a system; says how far the run can be trusted where it is given how far each value of the
/// start may be off.
#[pyfunction]
pub(crate) fn run_system(
    py: Python<'_>,
    system: &System,
    doubts: Option<[f64; 6]>,
    tolerance: f64,
) -> PyResult<Run> {
    let simulation = Simulation::clone(&system.simulation);
    let unfinished = |cancelled: Cancelled| error_of_work(cancelled.into());
    let Some(start) = doubts else {
        let run = on_this_thread(py, |on_progress| record(simulation, on_progress, |_, _| {}))?;
        return Ok(Run::without_trust(None, run.map_err(unfinished)?));
    };
    let tolerance = checked_tolerance(tolerance)?;
    let mut monitor = TrustMonitor::new(&simulation, &start, tolerance);
    let run = on_this_thread(py, |on_progress| {
        record(simulation, on_progress, |simulation, step| {
            monitor.follow(simulation, step);
        })
    })?;
    let trusted = RunWithTrust {
        run: run.map_err(unfinished)?,
        trust: monitor.verdict(),
        uncertainty: Uncertainty {
            start,
            keys: Vec::new(),
            tolerance,
        },
        seed: 0,
        tally: None,
        sensitivity: Vec::new(),
    };
    Ok(Run::from_trusted(None, trusted))
}

/// Name of a column, its type, its bytes, and its words.
type Filled<'py> = (String, &'static str, Bound<'py, PyByteArray>, Vec<String>);

/// What the runs of many systems with so many cables come to, column by column.
#[pyfunction]
pub(crate) fn sweep_systems<'py>(
    py: Python<'py>,
    systems: Vec<Bound<'py, System>>,
    cables: usize,
    trust: bool,
    threads: Option<usize>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<Filled<'py>>> {
    let simulations: Vec<Arc<Simulation>> = systems
        .iter()
        .map(|system| Arc::clone(&system.get().simulation))
        .collect();
    let runs = interruptible(py, progress, move |shared| {
        let on_progress = |progress: Progress| shared.report(progress);
        let counter = Counter::new("running", 0, simulations.len() as u64, &on_progress);
        on_threads(threads, || {
            let made = in_parallel(simulations.len(), |k| {
                counter.add(1)?;
                Ok(run_of(&simulations[k], trust))
            });
            made.map_err(StudyError::Cancelled)
        })
    })?;
    let runs = runs.map_err(error_of_study)?;
    let mut filled = Vec::new();
    let mut fill = |name: String, values: Values| {
        let plain = Plain::of(values);
        filled.push((
            name,
            plain.kind,
            PyByteArray::new(py, &plain.bytes),
            plain.words,
        ));
    };
    for column in shown(trust) {
        match column.name {
            // There may be more cables than columns of the schema.
            "impacts_1" => (0..cables).for_each(|cable| {
                let counts = runs
                    .iter()
                    .map(|run| Some(run.outcome.impacts[cable] as i64));
                fill(
                    format!("impacts_{}", cable + 1),
                    Values::Counts(counts.collect()),
                );
            }),
            "impacts_2" => {}
            name => fill(name.to_owned(), column.values(runs.iter().map(Some))),
        }
    }
    Ok(filled)
}

/// The columns of a study; those on trust only where that was asked for.
fn shown(trust: bool) -> impl Iterator<Item = &'static Column> {
    let of_trust = ["horizon_t", "horizon_impact", "certain"];
    let all = columns().iter();
    all.filter(move |column| trust || !of_trust.contains(&column.name))
}

/// What one run comes to, and, if that is asked for, how far rounding
/// alone leaves it to be trusted.
fn run_of(simulation: &Simulation, trust: bool) -> snapload_study::Run {
    let certainty = trust.then(|| {
        let mut simulation = simulation.clone();
        let tolerance = Uncertainty::default().tolerance;
        let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], tolerance);
        while monitor.horizon().is_none()
            && let Some(step) = simulation.step()
        {
            monitor.follow(&simulation, &step);
        }
        Certainty {
            horizon: monitor.horizon(),
        }
    });
    snapload_study::Run {
        outcome: Outcome::after(simulation.clone()),
        certainty,
    }
}
