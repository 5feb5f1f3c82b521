//! An uncertain parameter along a run.

use crate::analysis::trust::covariance::SIGMA_REACH;
use crate::arithmetic::dual::Dual;
use crate::arithmetic::plane::Vector2;
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::value::Value;
use crate::model::cable::Cable;
use crate::model::rules::Limit;
use crate::model::state::State;
use crate::model::taut_set::{MAX_CABLES, PerCable};
use crate::motion::active_set::normal_acceleration;
use crate::motion::limits::law::FlightChange;
use crate::motion::simulation::{Simulation, Step};
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
    /// The latest step.
    step: Option<Box<Step<Dual<f64, 1>>>>,
}

/// A quantity that depends on time alone within a step is evaluated at
/// the ends of so many equal parts.
const EVALUATIONS: usize = 32;

/// How far neighbours reach, given the standard deviation by each parameter.
#[inline(always)]
pub(super) fn reach_by(keys: &[UncertainKey], of: impl Fn(&UncertainKey) -> f64) -> f64 {
    let mut variance = 0.0;
    for key in keys {
        let deviation = of(key);
        variance += deviation * deviation;
    }
    SIGMA_REACH * variance.sqrt()
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
            step: None,
        })
    }

    /// The standard deviation of the normal acceleration of a closed cable that carries nothing, as
    /// far as it depends on the parameter.
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
        self.step = Some(Box::new(step));
        [along, met, self.deviation]
    }

    /// The standard deviation of the time of the latest event.
    pub(super) fn delay(&self) -> f64 {
        self.deviation[6]
    }

    /// That of the gap of a cable a time `s` into the latest step, by each neighbour's own time.
    /// This includes what the parameter changes of forces and cables, and is zero at the start
    /// if the cable was closed there.
    pub(super) fn of_gap(&self, cable: usize, s: f64) -> f64 {
        self.of_step(|step| self.simulation.gap_along(step, cable)(Dual::constant(s)))
    }

    /// A bound on it along the step.
    pub(super) fn of_gap_within(&self, cable: usize) -> f64 {
        self.step.as_deref().map_or(0.0, |step| {
            let most = self.largest(step, self.simulation.gap_along(step, cable));
            most + self.of_gap_between(cable, EVALUATIONS)
        })
    }

    /// By how much it may exceed those at the ends of equal parts of the step within them.
    pub(super) fn of_gap_between(&self, cable: usize, parts: usize) -> f64 {
        let tether = &self.simulation.system().cables[cable];
        self.step.as_deref().map_or(0.0, |step| {
            let change = FlightChange::along(&self.simulation, step);
            self.between(step, change.of_gap(tether), parts)
        })
    }

    /// That of the gap of a cable at the end of the latest step, each at its own event.
    pub(super) fn of_gap_at_end(&self, cable: usize) -> f64 {
        self.of_step(|_| self.simulation.contact(cable).gap)
    }

    /// That of the normal velocity of a cable just before the event at the end of the latest step.
    pub(super) fn of_normal_velocity(&self, cable: usize) -> f64 {
        let tether = &self.simulation.system().cables[cable];
        self.of_step(|step| tether.normal(&step.before).velocity(&step.before))
    }

    /// That of a limit's quantity over its bound at the end of the latest step.
    pub(super) fn of_limit_at_end(&self, limit: Limit) -> f64 {
        self.of_step(|step| self.over_limit(limit, &step.before))
    }

    /// A bound on it along the step, up to what it changes by within an equal part in which another
    /// corner becomes the highest.
    pub(super) fn of_limit_within(&self, limit: Limit) -> f64 {
        self.step.as_deref().map_or(0.0, |step| {
            let state = self.simulation.state_along(step);
            let change = FlightChange::along(&self.simulation, step);
            let most = self.largest(step, |s| self.over_limit(limit, &state(s)));
            let bound = limit.change_in_flight(&change, self.outline());
            most + self.between(step, bound, EVALUATIONS)
        })
    }

    /// The largest distance of a point of the outline from the centre, and by how much such a point
    /// moves in the body's frame with the parameter.
    fn outline(&self) -> [f64; 2] {
        let (outline, _) = self.simulation.system().body.outline();
        let points = outline.points().iter();
        let sizes = points.map(|&p| [p.length().value, length_of_slope(p)]);
        sizes.fold([0.0; 2], |[far, moved], [length, slope]| {
            [far.max(length), moved.max(slope)]
        })
    }

    fn over_limit(&self, limit: Limit, state: &State<Dual<f64, 1>>) -> Dual<f64, 1> {
        let bound = self.simulation.rules().limits.of(limit);
        let quantity = limit.quantity(self.simulation.system(), state);
        quantity - bound.unwrap_or(quantity)
    }

    /// The standard deviation of a quantity of the latest step.
    fn of_step(&self, quantity: impl Fn(&Step<Dual<f64, 1>>) -> Dual<f64, 1>) -> f64 {
        let step = self.step.as_deref();
        step.map_or(0.0, |step| quantity(step).slope[0] * self.size)
    }

    /// The largest standard deviation of a quantity at some times of a step.
    fn largest(
        &self,
        step: &Step<Dual<f64, 1>>,
        quantity: impl Fn(Dual<f64, 1>) -> Dual<f64, 1>,
    ) -> f64 {
        let width = (step.t_end - step.t_start).value / EVALUATIONS as f64;
        let seen = |k: usize| quantity(Dual::constant(width * k as f64)).slope[0].abs();
        (0..=EVALUATIONS).map(seen).fold(0.0, f64::max) * self.size
    }

    /// By how much a standard deviation may exceed those at the ends of equal parts of a step
    /// within them, given a bound on the second derivative of the quantity's derivative by the
    /// parameter. In a flight: the steps of a series are short.
    fn between(&self, step: &Step<Dual<f64, 1>>, second_derivative: f64, parts: usize) -> f64 {
        let width = (step.t_end - step.t_start).value / parts as f64;
        match self.simulation.system().has_closed_form(step.taut) {
            true => second_derivative * width * width * 0.125 * self.size,
            false => 0.0,
        }
    }
}

impl FlightChange {
    /// By each neighbour's own time, so that the force is also that at another time.
    fn along(simulation: &Simulation<Dual<f64, 1>>, step: &Step<Dual<f64, 1>>) -> Self {
        let (forcing, start) = (&simulation.system().forcing, &step.start);
        let s = (step.t_end - step.t_start).value;
        let t = step.t_end.value.abs().max(step.t_start.value.abs());
        let [bound, rate, _] = forcing.bounds().map(|bound| bound.value);
        let mut change = length_of_slope(forcing.constant) + rate * step.t_start.slope[0].abs();
        for wave in &forcing.harmonics {
            let slope = wave.map(|number| number.slope[0]).amplitude();
            change += slope + wave.omega.slope[0].abs() * t * wave.amplitude().value;
        }
        let speed = start.velocity().map(|v| v.value).length() + bound * s;
        let speed_slope = length_of_slope(start.velocity()) + change * s;
        let spin = [start.vtheta.value.abs(), start.vtheta.slope[0].abs()];
        Self {
            force: [bound, change],
            speed: [speed, speed_slope],
            spin,
            place: length_of_slope([start.x, start.y].into()) + speed_slope * s,
            turn: start.theta.slope[0].abs() + spin[1] * s,
        }
    }

    /// Of g̈ = 2 (Ṗ² + d·P̈), where |d| ≤ r.
    fn of_gap(&self, tether: &Cable<Dual<f64, 1>>) -> f64 {
        let fairlead = tether.fairlead();
        let (reach, reach_slope) = (fairlead.length().value, length_of_slope(fairlead));
        let [spin, spin_slope] = self.spin;
        let turning = spin_slope * reach + spin * (reach_slope + reach * self.turn);
        let velocity = [self.speed[0] + spin * reach, self.speed[1] + turning];
        let acceleration = self.force[0] + spin * spin * reach;
        let span = self.place + reach_slope + reach * self.turn + length_of_slope(tether.anchor());
        let by_span = span * acceleration;
        let by_acceleration = tether.length().value * self.of_acceleration([reach, reach_slope]);
        2.0 * (2.0 * velocity[0] * velocity[1] + by_span + by_acceleration)
    }
}

/// The length of the derivative of a vector.
fn length_of_slope(vector: Vector2<Dual<f64, 1>>) -> f64 {
    vector.map(|component| component.slope[0]).length()
}

/// For tests only: how the derivative of a limit's quantity by a key runs along the first flight.
#[cfg(feature = "comparisons")]
#[derive(Clone, Debug)]
pub struct LimitDerivatives {
    /// The angle and the derivative, at the ends of equal parts of the flight.
    pub at: Vec<[f64; 2]>,
    /// How long each part takes.
    pub part: f64,
    /// A bound on the second derivative of the derivative by time.
    pub bound: f64,
}

#[cfg(feature = "comparisons")]
impl LimitDerivatives {
    /// Along the first flight of a case, in so many parts.
    ///
    /// # Panics
    /// Where the case does not begin with a flight or has no such key.
    pub fn in_flight(case: &Case, key: &'static str, limit: Limit, parts: usize) -> Self {
        let mut key = UncertainKey::new(case, key, 1e-6).expect("an uncertain key");
        let step = key.simulation.step().expect("a flight");
        assert!(step.taut.is_empty(), "a flight");
        let change = FlightChange::along(&key.simulation, &step);
        let part = (step.t_end - step.t_start).value / parts as f64;
        let state = key.simulation.state_along(&step);
        let at = |k: usize| {
            let state = state(Dual::constant(part * k as f64));
            [state.theta.value, key.over_limit(limit, &state).slope[0]]
        };
        Self {
            at: (0..=parts).map(at).collect(),
            part,
            bound: limit.change_in_flight(&change, key.outline()),
        }
    }
}
