//! The linearised motion: the evolution of a small deviation from a run.
//!
//! Two neighbours reach an event at different times, and between these times they differ by a whole
//! jump of velocity, however close they are. So a deviation is given here *at the events*, as (w,
//! τ): the neighbour is at z + w at the time t + τ, after the same events as the run. A deviation
//! δz at one time is (δz, 0), and (w, τ) is δz = w − ż τ at one time.
//!
//! Along a stretch from t to t + s, with Φ = ∂z(t + s)/∂z(t) for its taut set,
//!
//! ```text
//! w ← Φ w + (ż₋ − Φ ż₊) τ              ż₊ at the stretch's start, ż₋ at its end
//! δs = −∇h·w / (ḣ)                      the event function h(z, t) reaches zero that much later
//! w ← R' (w + ż₋ δs),   τ ← τ + δs      R the law of impact
//! ```
//!
//! which with δz = w − ż τ is the saltation matrix S = R' + (ż₊ − R' ż₋) ∇h / ḣ (Aizerman &
//! Gantmakher 1958; Müller, *Chaos, Solitons & Fractals* 5 (1995) 1671). R' is the law of
//! [`crate::motion::impact`] itself over [`Dual`] numbers, sticking and several cables included;
//! for one cable alone, which is nearly every impact, it is written out there.

use crate::arithmetic::dual::Dual;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::floating::Floating;
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, TautSet};
use crate::motion::acceleration_slopes::{response_to_force, slopes_of_acceleration};
use crate::motion::active_set::{acceleration, normal_acceleration, tensions};
use crate::motion::deviations::{change, cubic, identity, pace_of_deviations, plus};
use crate::motion::impact::{ImpactResult, impact, slope_of_impact_alone};
use crate::motion::projection::{project_position, project_velocity};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Flow, Matrix, MemoryRates, StepMap, add_scaled, dot6, join, split};
use crate::motion::water_flow::{Slopes, WaterFlow, memory_rates, pace_of_memory};

pub(crate) type Number = Dual<f64, 6>;

/// Steps, for each expansion of the motion, in which Φ is integrated along taut motion; the length
/// of an expansion follows the motion's own time scale. The error of Φ is below 1e-4.
const SUBSTEPS: f64 = 3.0;
/// The weights of four equidistant values in the cubic through them, half-way between two of them.
const MIDDLES: [[f64; 4]; 3] = [
    [0.3125, 0.9375, -0.3125, 0.0625],
    [-0.0625, 0.5625, 0.5625, -0.0625],
    [0.0625, -0.3125, 0.9375, 0.3125],
];
/// Near rest the motion has no time scale, but its deviations oscillate all the same: a step is no
/// longer than this part of a radian of the fastest of them.
const RADIANS: f64 = 0.5;

/// The linearised motion along a run.
#[derive(Clone, Debug)]
pub struct Tangent {
    system: System<Number>,
}

/// The map of a step, by the best instructions for it.
struct Mapping<'a>(&'a Tangent, &'a Simulation, &'a Step);

impl Kernel for Mapping<'_> {
    type Output = StepMap;
    #[inline(always)]
    fn run(self) -> StepMap {
        let Self(tangent, simulation, step) = self;
        let system = simulation.system();
        let flow = tangent.flow(simulation, step);
        let pull = simulation.memory_force_within(step, 0.0);
        let around = simulation.surroundings(step.t_start);
        let first = rate(system, &around, &step.start, pull, step.taut);
        // An event does not change the water's memory.
        let pull = simulation.memory_force();
        let around = simulation.surroundings(step.t_end);
        let last = rate(system, &around, &step.before, pull, step.taut);
        let continues = step.taut == step.taut_after;
        let rate_after =
            if continues && (step.after == step.before || system.flies_freely(step.taut)) {
                // In flight the acceleration is the force alone, which does not jump.
                let State { vx, vy, vtheta, .. } = step.after;
                [vx, vy, vtheta, last[3], last[4], last[5]]
            } else {
                rate(system, &around, &step.after, pull, step.taut_after)
            };
        let mut begun = join(&first, 0.0).map(|component| [component]);
        let memory = if let Some(water) = &system.floating {
            let start = simulation.memory_at_start();
            let carried = memory_rates(water, &start, &step.start).into_iter();
            let mut carried: Vec<[f64; 1]> = carried.map(|rate| [rate]).collect();
            flow.carry(&mut begun, &mut carried);
            let at = |state: &State| memory_rates(water, simulation.memory(), state);
            let rate = at(&step.before);
            let lag = rate
                .iter()
                .zip(&carried)
                .map(|(rate, [begun])| rate - begun);
            Some(Box::new(MemoryRates {
                lag: lag.collect(),
                rate_after: at(&step.after),
                rate,
            }))
        } else {
            flow.carry(&mut begun, &mut []);
            None
        };
        StepMap {
            flow,
            lag: add_scaled(&last, &split(&begun.map(|[component]| component)).0, -1.0),
            memory,
            rate: last,
            delay: tangent.delay(system, step, &last),
            law: if step.event.reached.gaps.is_empty() {
                None
            } else {
                Some(tangent.law(system, step))
            },
            rate_after,
        }
    }
}

/// The derivatives of (ẍ, ÿ, θ̈) a time into a step, by the best instructions for them.
struct Differentiating<'a>(&'a Tangent, &'a Simulation, &'a Step, f64);

impl Kernel for Differentiating<'_> {
    type Output = [[f64; 6]; 3];
    #[inline(always)]
    fn run(self) -> [[f64; 6]; 3] {
        let Self(tangent, simulation, step, s) = self;
        let around = simulation.surroundings(step.t_start + s);
        let state = simulation.within(step, s);
        match slopes_of_acceleration(simulation.system(), &around, &state, step.taut) {
            Some(slopes) => slopes,
            None => {
                let around = around.map(Number::constant);
                let held = simulation.memory_force_within(step, s);
                let (held, state) = (held.map(Number::constant), variables(&state));
                acceleration(&tangent.system, &around, &state, held, step.taut).map(|a| a.slope)
            }
        }
    }
}

/// The derivatives of the tensions at both ends of a step, likewise.
struct DifferentiatingTensions<'a>(&'a Tangent, &'a Simulation, &'a Step);

impl Kernel for DifferentiatingTensions<'_> {
    type Output = [[[f64; 6]; MAX_CABLES]; 2];
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(tangent, simulation, step) = self;
        let mut ends = [[[0.0; 6]; MAX_CABLES]; 2];
        let states = [&step.start, &step.before];
        let times = [0.0, step.t_end - step.t_start];
        for (slopes, (state, s)) in ends.iter_mut().zip(states.into_iter().zip(times)) {
            let around = simulation
                .surroundings(step.t_start + s)
                .map(Number::constant);
            let held = simulation.memory_force_within(step, s);
            let (held, state) = (held.map(Number::constant), variables(state));
            *slopes = tensions(&tangent.system, &around, &state, held, step.taut).map(|t| t.slope);
        }
        ends
    }
}

impl Tangent {
    /// The linearised motions of a system.
    pub fn new(system: &System) -> Self {
        Self {
            system: system.map(Number::constant),
        }
    }

    /// ∂(the state that a run begins with)/∂(the start given): the projection onto closed cables.
    pub fn of_start(&self, simulation: &Simulation) -> Matrix {
        self.of_start_on(simulation, simulation.closed())
    }

    /// The same where only some of the cables are closed whatever the start.
    pub(crate) fn of_start_on(&self, simulation: &Simulation, closed: TautSet) -> Matrix {
        let mut state = variables(simulation.state());
        project_position(&self.system, &mut state, closed);
        project_velocity(&self.system, &mut state, simulation.resting());
        state.components().map(|component| component.slope)
    }

    /// The normal acceleration of a closed cable that carries nothing, at the time reached, and its
    /// derivatives by (x, y, θ, ẋ, ẏ, θ̇).
    pub(crate) fn normal_acceleration(
        &self,
        simulation: &Simulation,
        cable: usize,
    ) -> (f64, [f64; 6]) {
        let around = simulation.surroundings(simulation.time());
        let (around, state) = (around.map(Number::constant), variables(simulation.state()));
        let held = simulation.memory_force().map(Number::constant);
        let taut = simulation.carrying();
        let found = normal_acceleration(&self.system, &around, &state, held, cable, taut);
        (found.value, found.slope)
    }

    /// The map of the step that `simulation` has just made.
    pub fn of_step(&self, simulation: &Simulation, step: &Step) -> StepMap {
        dispatch(Mapping(self, simulation, step))
    }

    /// The derivatives of the tensions by (x, y, θ, ẋ, ẏ, θ̇) at the start and
    /// at the end of a step, by cable.
    pub(crate) fn slopes_of_tensions(
        &self,
        simulation: &Simulation,
        step: &Step,
    ) -> [[[f64; 6]; MAX_CABLES]; 2] {
        dispatch(DifferentiatingTensions(self, simulation, step))
    }

    /// The impact at the end of a step, with its derivatives by (x, y, θ, ẋ, ẏ, θ̇) along which the
    /// closed cables stay closed.
    pub(crate) fn impact(&self, step: &Step) -> ImpactResult<Number> {
        let (mut before, event) = (variables(&step.before), &step.event);
        project_position(&self.system, &mut before, event.closed);
        impact(&self.system, &before, event.closed, event.still)
    }

    /// Φ along the segment of a step.
    #[inline(always)]
    fn flow(&self, simulation: &Simulation, step: &Step) -> Flow {
        let system = simulation.system();
        let afloat = system.floating.as_ref();
        #[expect(
            clippy::manual_map,
            reason = "a closure would be compiled for every processor"
        )]
        let water = match afloat {
            Some(water) => Some(Box::new(self.water_flow(simulation, step, water))),
            None => None,
        };
        Flow {
            s: step.t_end - step.t_start,
            driven: if system.flies_freely(step.taut) || afloat.is_some() {
                None
            } else {
                Some(self.driven_flow(simulation, step))
            },
            water,
        }
    }

    /// Φ along a stretch with taut cables or drag: Φ̇ = A Φ, A = ∂ż/∂z along the motion, by the
    /// Runge-Kutta rule. The motion itself is accurate to rounding; for its deviation a few digits
    /// are enough. So A is evaluated between substeps only, and in their middles it is the cubic
    /// through the four nearest values.
    #[inline(always)]
    fn driven_flow(&self, simulation: &Simulation, step: &Step) -> Matrix {
        let s = step.t_end - step.t_start;
        let system = simulation.system();
        let mut phi = identity();
        let first = self.slopes_within(simulation, step, 0.0);
        let pace = pace_of_deviations(&first, system.body.inertia());
        let pace = (SUBSTEPS / simulation.expansion()).max(pace / RADIANS);
        let count = (pace * s).ceil().max(1.0);
        let h = s / count;
        let count = count as u32;
        let slopes = |k: f64| self.slopes_within(simulation, step, k * h);
        let mut nodes = [first; 4];
        for (node, k) in nodes.iter_mut().zip(0..=count).skip(1) {
            *node = slopes(f64::from(k));
        }
        for k in 0..count {
            if k > 1 && k + 2 <= count {
                nodes.rotate_left(1);
                nodes[3] = slopes(f64::from(k + 2));
            }
            // The substep is between the inner two nodes, but for the first and the last one.
            let place = if k > 0 && k + 1 == count {
                count.min(3) - 1
            } else {
                k.min(1)
            } as usize;
            let (left, right) = (nodes[place], nodes[place + 1]);
            let middle = if count < 3 {
                slopes(f64::from(k) + 0.5)
            } else {
                cubic(&nodes, MIDDLES[place])
            };
            let k1 = change(&left, &phi);
            let k2 = change(&middle, &plus(&phi, &k1, 0.5 * h));
            let k3 = change(&middle, &plus(&phi, &k2, 0.5 * h));
            let k4 = change(&right, &plus(&phi, &k3, h));
            let outer = plus(&plus(&phi, &k1, h / 6.0), &k4, h / 6.0);
            phi = plus(&plus(&outer, &k2, h / 3.0), &k3, h / 3.0);
        }
        phi.map(|[x, y, theta, vx, vy, vtheta, ..]| [x, y, theta, vx, vy, vtheta])
    }

    /// Φ of a floating body: a power series where its motion is linear, otherwise by the
    /// Runge-Kutta rule.
    #[inline(always)]
    fn water_flow(&self, simulation: &Simulation, step: &Step, water: &Floating) -> WaterFlow {
        let s = step.t_end - step.t_start;
        let system = simulation.system();
        let first = self.water_slopes(simulation, step, 0.0);
        if step.taut.is_empty() && system.drag.is_none() {
            return WaterFlow::constant(water, s, first);
        }
        let pace = pace_of_deviations(&first.by_state, system.body.inertia());
        let pace = pace.max(pace_of_memory(water)) / RADIANS;
        let pace = (SUBSTEPS / simulation.expansion()).max(pace);
        let count = (pace * s).ceil().max(1.0);
        let h = s / count;
        let mut nodes = vec![first];
        for k in 1..=2 * count as u32 {
            nodes.push(self.water_slopes(simulation, step, 0.5 * h * f64::from(k)));
        }
        WaterFlow::varying(water, h, nodes)
    }

    /// The derivatives of the accelerations of a floating body a time `s` into a step.
    #[inline(always)]
    fn water_slopes(&self, simulation: &Simulation, step: &Step, s: f64) -> Slopes {
        let (system, state) = (simulation.system(), simulation.within(step, s));
        Slopes {
            by_state: self.slopes_within(simulation, step, s),
            by_force: response_to_force(system, &state, step.taut),
        }
    }

    /// The derivatives of (ẍ, ÿ, θ̈) a time `s` into a step.
    fn slopes_within(&self, simulation: &Simulation, step: &Step, s: f64) -> [[f64; 6]; 3] {
        dispatch(Differentiating(self, simulation, step, s))
    }

    /// −∇h/ḣ of the event function: of a gap, or of the quantity of a limit. The loss of a tension
    /// does not change velocities and hardly accelerations, so that its time does not matter.
    #[inline(always)]
    fn delay(&self, system: &System, step: &Step, rate: &[f64; 6]) -> [f64; 6] {
        let (before, reached) = (&step.before, step.event.reached);
        if let Some(cable) = reached.gaps.iter().next() {
            let normal = system.cables[cable].normal(before);
            let v_n = normal.velocity(before);
            return [normal.n.x, normal.n.y, normal.arm, 0.0, 0.0, 0.0].map(|n| -n / v_n);
        }
        let Some(limit) = reached.limits.iter().next() else {
            return [0.0; 6];
        };
        let slope = limit.quantity(&self.system, &variables(before)).slope;
        let climb = dot6(&slope, rate);
        slope.map(|slope| -slope / climb)
    }

    /// R' of an impact, and of the sticking that may follow it.
    #[inline(always)]
    fn law(&self, system: &System, step: &Step) -> [[f64; 6]; 3] {
        let event = &step.event;
        let mut closed = event.closed.iter();
        if let (Some(cable), None) = (closed.next(), closed.next())
            && event.still.is_empty()
            && step.taut_after.is_empty()
        {
            return slope_of_impact_alone(system, &step.before, cable);
        }
        let before = variables(&step.before);
        let mut after = impact(&self.system, &before, event.closed, event.still).after;
        project_velocity(&self.system, &mut after, step.taut_after);
        [after.vx, after.vy, after.vtheta].map(|v| v.slope)
    }
}

/// A state whose components are the six variables of the derivatives.
#[inline(always)]
fn variables(state: &State) -> State<Number> {
    let mut i = 0;
    State::from_components(state.components().map(|component| {
        i += 1;
        Number::variable(component, i - 1)
    }))
}

/// ż.
#[inline(always)]
fn rate(
    system: &System,
    around: &Surroundings,
    state: &State,
    memory_force: [f64; 3],
    taut: TautSet,
) -> [f64; 6] {
    let [x, y, theta] = acceleration(system, around, state, memory_force, taut);
    [state.vx, state.vy, state.vtheta, x, y, theta]
}
