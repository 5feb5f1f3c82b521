//! Bodies on cables as hybrid systems.

use crate::hybrid::{Family, Hybrid, Jet, Limits, PARAMETER, Point, Simulated};
use crate::sequence::{Event, EventKind, Sequence, Timed};
use snapload::{
    CaseError, Limit, Parameters, PerCable, PrescribedTaut, Real, Rules, Simulation, State, System,
    TautSet, Value,
};
use std::sync::Arc;

/// Snaps slower than this stick: the error of the state after an accumulation is of its square.
const V_STICK: f64 = 1e-7;
/// The most events of a simulated motion.
const MOST_IMPACTS: u64 = 20_000;

/// The longest period of the forcing, which is the longest time of a run (the key `t_end`).
const LONGEST_FORCING: f64 = 1e6;

/// A body on cables over some numbers.
///
/// # Panics
/// All methods that are given a surface, or a set of them, if the system has no such cable.
pub struct Cables<T: Real> {
    prescribed: PrescribedTaut<T>,
    rules: Rules<T>,
}

impl<T: Real> Cables<T> {
    fn new((system, rules): (System<T>, Rules<T>)) -> Self {
        Self {
            prescribed: PrescribedTaut::new(system),
            rules,
        }
    }

    /// The system.
    pub fn system(&self) -> &System<T> {
        self.prescribed.system()
    }
}

impl<T: Real> Hybrid<T> for Cables<T> {
    fn surfaces(&self) -> TautSet {
        self.system().all_cables()
    }

    fn flow(&self, taut: TautSet, t: T, z: &Point<T>, s: T) -> Point<T> {
        let state = State::from_components(*z);
        self.prescribed.carried(taut, t, &state, s).components()
    }

    fn path(&self, taut: TautSet, t: T, z: &Point<T>, s: T) -> impl Fn(T) -> Point<T> {
        let path = self
            .prescribed
            .path(taut, t, &State::from_components(*z), s);
        move |s| path.state(s).components()
    }

    /// g/2r.
    fn gap(&self, surface: usize, z: &Point<T>) -> T {
        let cable = &self.system().cables[surface];
        cable.gap(&State::from_components(*z)) / (cable.length() * 2.0)
    }

    /// ġ/2r, which is v_n where the gap is closed.
    fn speed(&self, surface: usize, z: &Point<T>) -> T {
        let state = State::from_components(*z);
        self.system().cables[surface]
            .normal(&state)
            .velocity(&state)
    }

    fn tension(&self, surface: usize, taut: TautSet, t: T, z: &Point<T>) -> T {
        self.prescribed
            .tensions(taut, t, &State::from_components(*z))[surface]
    }

    fn law(&self, struck: TautSet, pulling: TautSet, z: &Point<T>) -> (Point<T>, PerCable<T>) {
        let (after, impulse) = self
            .prescribed
            .struck(&State::from_components(*z), struck, pulling);
        (after.components(), impulse)
    }

    fn placed(&self, closed: TautSet, still: TautSet, z: &Point<T>) -> Point<T> {
        let state = State::from_components(*z);
        self.prescribed
            .projected(&state, closed, still)
            .components()
    }
}

/// A system and its rules over doubles, at two values of its parameters.
type OfDoubles = dyn Fn([f64; 2]) -> (System, Rules) + Send + Sync;
/// The same over jets.
type OfJets = dyn Fn([Jet; 2]) -> (System<Jet>, Rules<Jet>) + Send + Sync;

/// Bodies on cables with two parameters, forced periodically.
#[derive(Clone)]
pub struct Moored {
    doubles: Arc<OfDoubles>,
    jets: Arc<OfJets>,
    turns: bool,
}

/// The parameters as jets.
fn jets_of(at: [f64; 2]) -> [Jet; 2] {
    [0, 1].map(|i| Jet::variable(at[i], PARAMETER + i))
}

impl Moored {
    /// Any system, whose first harmonic sets the period of the forcing; `turns` says whether the
    /// body is rigid.
    pub fn new(
        turns: bool,
        doubles: impl Fn([f64; 2]) -> (System, Rules) + Send + Sync + 'static,
        jets: impl Fn([Jet; 2]) -> (System<Jet>, Rules<Jet>) + Send + Sync + 'static,
    ) -> Self {
        Self {
            doubles: Arc::new(doubles),
            jets: Arc::new(jets),
            turns,
        }
    }

    /// The thesis's case, with the keys that may change; settling and sliding do not stop its
    /// motion.
    pub fn case(parameters: Parameters, keys: [Option<&'static str>; 2]) -> Self {
        let parameters = Parameters {
            stop_when_settled: false,
            stop_when_sliding: false,
            ..parameters
        };
        Self::new(
            !parameters.is_point(),
            move |at| of_case(&parameters, keys, at, |number| number),
            move |at| of_case(&parameters, keys, at, Jet::constant),
        )
    }

    /// The values of the keys that [`Moored::case`] was given.
    pub fn values(parameters: &Parameters, keys: [Option<&'static str>; 2]) -> [f64; 2] {
        keys.map(|key| {
            let value = key.and_then(|key| parameters.get(key));
            value.as_ref().and_then(Value::number).unwrap_or(0.0)
        })
    }

    /// The period of the forcing.
    pub fn period(&self, at: [f64; 2]) -> f64 {
        self.forcing_period(at).value
    }
}

fn of_case<T: Real>(
    parameters: &Parameters,
    keys: [Option<&'static str>; 2],
    at: [T; 2],
    lift: impl Fn(f64) -> T,
) -> (System<T>, Rules<T>) {
    let numbers = parameters.over(|name, value| {
        let place = keys.iter().position(|key| *key == Some(name));
        place.map_or_else(|| lift(value), |place| at[place])
    });
    (numbers.system(), numbers.rules())
}

impl Family for Moored {
    type Plain = Cables<f64>;
    type Jets = Cables<Jet>;

    fn variables(&self) -> &'static [usize] {
        if self.turns {
            &[0, 1, 2, 3, 4, 5]
        } else {
            &[0, 1, 3, 4]
        }
    }

    fn plain(&self, at: [f64; 2]) -> Cables<f64> {
        Cables::new((self.doubles)(at))
    }

    fn jets(&self, at: [f64; 2]) -> Cables<Jet> {
        Cables::new((self.jets)(jets_of(at)))
    }

    fn forcing_period(&self, at: [f64; 2]) -> Jet {
        let (system, _) = (self.jets)(jets_of(at));
        let omega = system.forcing.harmonics.first().map(|wave| wave.omega);
        let omega = omega.unwrap_or(Jet::constant(1.0)).abs();
        Jet::constant(std::f64::consts::TAU) / omega
    }

    fn contraction(&self, at: [f64; 2]) -> Option<f64> {
        let (system, _) = (self.doubles)(at);
        let damping = damping(&system)?;
        let moving = if self.turns { 3 } else { 2 };
        Some(
            (0..moving)
                .map(|i| {
                    let force = [0, 1, 2].map(|j| damping[j][i]);
                    system.body.moved_by(force)[i]
                })
                .sum(),
        )
    }

    fn snap_contraction(&self, at: [f64; 2]) -> f64 {
        let (system, _) = (self.doubles)(at);
        system.restitution * system.restitution
    }

    fn limits(&self, system: &Cables<f64>, z: &Point) -> Limits {
        let state = State::from_components(*z);
        Limit::ALL.map(|limit| {
            let bound = system.rules.limits.of(limit);
            bound.map_or(f64::NEG_INFINITY, |bound| {
                limit.quantity(system.system(), &state) - bound
            })
        })
    }

    /// g = |P − A|² − r².
    fn reported_gap(&self, system: &Cables<f64>, surface: usize, length: f64) -> f64 {
        2.0 * system.system().cables[surface].length() * length
    }

    fn simulate(&self, at: [f64; 2], t: f64, z: &Point, t_end: f64) -> Option<Simulated> {
        let (system, rules) = (self.doubles)(at);
        Some(simulate(system, &rules, t, z, t_end))
    }
}

/// The period of the forcing.
///
/// # Errors
/// A [`CaseError`] where there is no forcing, or its period is longer than a run can be.
pub fn period_of(parameters: &Parameters) -> Result<f64, CaseError> {
    let period = std::f64::consts::TAU / parameters.omega.abs();
    if period <= LONGEST_FORCING {
        return Ok(period);
    }
    // Its fourth digit is rounded up, so that what is shown is allowed.
    let least = std::f64::consts::TAU / LONGEST_FORCING * (1.0 + 5e-4);
    let allowed = format!(
        "a frequency of at least {least:.3e}, as sections are a period of the forcing apart, and a \
         period is at most {LONGEST_FORCING:e}"
    );
    Err(CaseError::value("omega", parameters.omega, allowed))
}

/// D, where the forces that depend on the velocity are −D q̇: those of linear drag, and the damping
/// of the water. None where they depend on it otherwise: by quadratic drag, or by the memory of the
/// water.
fn damping(system: &System) -> Option<[[f64; 3]; 3]> {
    let mut damping = [[0.0; 3]; 3];
    if let Some(water) = &system.floating {
        if !water.memory.is_empty() {
            return None;
        }
        damping = water.damping;
    }
    if let Some(drag) = &system.drag {
        if drag.quadratic != 0.0 {
            return None;
        }
        let turning = drag.turning * system.body.inertia();
        for (i, part) in [drag.linear, drag.linear, turning].into_iter().enumerate() {
            damping[i][i] += part;
        }
    }
    Some(damping)
}

/// Runs it, and records its events.
fn simulate(system: System, rules: &Rules, t: f64, z: &Point, t_end: f64) -> Simulated {
    let rules = Rules {
        t_end,
        max_impacts: MOST_IMPACTS,
        v_stick: V_STICK.min(rules.v_stick),
        ..*rules
    };
    let mut simulation = match Simulation::new(system, rules, t, State::from_components(*z)) {
        Ok(simulation) => simulation,
        Err(error) => {
            return Simulated {
                lap: Timed::default(),
                end: *z,
                stop: None,
                illegal: Some(error.to_string()),
            };
        }
    };
    let mut lap = Timed {
        sequence: Sequence {
            start: simulation.taut(),
            events: Vec::new(),
        },
        ..Timed::default()
    };
    let mut since = t;
    while let Some(step) = simulation.step() {
        let Some((event, speed)) = event_of(&step) else {
            continue;
        };
        lap.sequence.events.push(event);
        lap.durations.push(step.t_end - since);
        lap.speeds.push(speed);
        since = step.t_end;
    }
    let stop = simulation.stop().zip(Some(simulation.time()));
    Simulated {
        lap: lap.cut_off(rules.v_stick),
        end: simulation.state().components(),
        stop: stop.filter(|(_, t)| *t < t_end),
        illegal: None,
    }
}

/// The event at the end of a step, and its closing velocity.
pub(crate) fn event_of(step: &snapload::Step) -> Option<(Event, f64)> {
    let (mut struck, mut pulling, mut speed) = (TautSet::SLACK, TautSet::SLACK, 0.0_f64);
    for impact in step.impacts() {
        pulling = pulling.with(impact.cable);
        if impact.v_n > 0.0 {
            struck = struck.with(impact.cable);
            speed = speed.max(impact.v_n);
        }
    }
    let kind = if !struck.is_empty() {
        EventKind::Snap { struck, pulling }
    } else if step.taut != step.taut_after {
        let gone = step.taut.iter().filter(|&k| !step.taut_after.contains(k));
        EventKind::Release(gone.collect())
    } else {
        return None;
    };
    let after = step.taut_after;
    Some((Event { kind, after }, speed))
}
