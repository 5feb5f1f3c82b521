//! The linearised motion: what becomes of a small deviation from a run.
//!
//! Two neighbours reach an event at different times, and between these times they differ by a
//! whole jump of velocity, however close they are. So a deviation is told here *at the events*, as
//! (w, τ): the neighbour is at z + w at the time t + τ, when it has had the same events as the run. A
//! deviation δz at one time is (δz, 0), and (w, τ) is δz = w − ż τ at one time.
//!
//! Along a stretch from t to t + s, with Φ = ∂z(t + s)/∂z(t) for the taut set that it has,
//!
//! ```text
//! w ← Φ w + (ż₋ − Φ ż₊) τ              ż₊ at the stretch's start, ż₋ at its end
//! δs = −∇h·w / (ḣ)                      the event function h(z, t) reaches zero that much later
//! w ← R' (w + ż₋ δs),   τ ← τ + δs      R the law of impact
//! ```
//!
//! which with δz = w − ż τ is the saltation matrix
//! S = R' + (ż₊ − R' ż₋) ∇h / ḣ (Aizerman & Gantmakher 1958; Müller, *Chaos, Solitons & Fractals* 5 (1995)
//! 1671). R' is the law of [`crate::motion::impact`] itself over [`Dual`] numbers, sticking and several cables
//! included; for one cable alone, which is nearly every impact, it is written out there.

use crate::arithmetic::dual::Dual;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::active_set::{acceleration, project_position, project_velocity};
use crate::motion::impact::{impact, slope_of_impact_alone};
use crate::motion::simulation::{Simulation, Step};

/// ∂z/∂z, rows by what changes: 6 × 6, order x, y, θ, ẋ, ẏ, θ̇.
pub type Matrix = [[f64; 6]; 6];

/// A deviation (w, τ): six of the state, and the time.
pub type Deviation = [f64; 7];

/// Deviations side by side: a row for each of their seven components, a column for each of them, so that
/// one operation does them all.
pub(crate) type Block<const M: usize> = [[f64; M]; 7];

type Number = Dual<f64, 6>;

/// Φ along taut motion is integrated in so many steps for each expansion of the motion, whose length
/// goes with the motion's own time scale; with the rule of Runge and Kutta this leaves about 1e-4 of Φ.
const SUBSTEPS: f64 = 3.0;

/// The linearised motion along a run.
#[derive(Clone, Debug)]
pub struct Tangent {
    system: System<Number>,
}

/// One step of the linearised motion.
#[derive(Clone, Copy, Debug)]
pub struct StepMap {
    flow: Flow,
    /// ż₋ − Φ ż₊.
    lag: [f64; 6],
    /// ż₋.
    rate: [f64; 6],
    /// −∇h/ḣ; zero without an event.
    delay: [f64; 6],
    /// Rows of R' that belong to the velocities; none without an impact.
    law: Option<[[f64; 6]; 3]>,
    /// ż after the event.
    rate_after: [f64; 6],
}

/// Φ along a stretch.
#[derive(Clone, Copy, Debug)]
struct Flow {
    /// How long it is.
    s: f64,
    /// Φ where velocities change by the state: with taut cables, or drag. Else positions drift with the velocities.
    driven: Option<Matrix>,
}

impl Flow {
    fn carry<const M: usize>(&self, block: &mut Block<M>) {
        match &self.driven {
            None => {
                for i in 0..3 {
                    add_row(block, i, &block[i + 3].clone(), self.s);
                }
            }
            Some(phi) => {
                let moved = phi.map(|row| combined(block, &row));
                block[..6].copy_from_slice(&moved);
            }
        }
    }
}

impl StepMap {
    /// Along the stretch: (w, τ) just before the event, told at the previous event's time.
    pub fn along(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_along(block))
    }

    /// To the event's own time.
    pub fn meet(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_to_meet(block))
    }

    /// Through the law of the event.
    pub fn through(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_through(block))
    }

    /// [`StepMap::along`] of many.
    pub(crate) fn carry_along<const M: usize>(&self, block: &mut Block<M>) {
        self.flow.carry(block);
        let tau = block[6];
        for (i, lag) in self.lag.iter().enumerate() {
            add_row(block, i, &tau, *lag);
        }
    }

    /// [`StepMap::meet`] of many.
    pub(crate) fn carry_to_meet<const M: usize>(&self, block: &mut Block<M>) {
        let later = combined(block, &self.delay);
        for (i, rate) in self.rate.iter().enumerate() {
            add_row(block, i, &later, *rate);
        }
        add_row(block, 6, &later, 1.0);
    }

    /// [`StepMap::through`] of many.
    pub(crate) fn carry_through<const M: usize>(&self, block: &mut Block<M>) {
        if let Some(law) = &self.law {
            let velocities = law.map(|row| combined(block, &row));
            block[3..6].copy_from_slice(&velocities);
        }
    }

    /// All of the step for many deviations at one time, at its start and at its end.
    pub(crate) fn carry_at_one_time<const M: usize>(&self, block: &mut Block<M>) {
        block[6] = [0.0; M];
        self.carry_along(block);
        self.carry_to_meet(block);
        self.carry_through(block);
        let tau = block[6];
        for (i, rate) in self.rate_after.iter().enumerate() {
            add_row(block, i, &tau, -rate);
        }
    }

    /// What [`StepMap::meet`] undoes: the deviation told at the previous event's time, when τ was `tau`.
    pub(crate) fn before_meeting(&self, deviation: &Deviation, tau: f64) -> Deviation {
        let (w, now) = split(deviation);
        join(&add_scaled(&w, &self.rate, tau - now), tau)
    }

    /// The deviation at one time, of one that is told at the event at the end of the step.
    pub fn at_one_time(&self, deviation: &Deviation) -> [f64; 6] {
        let (w, tau) = split(deviation);
        add_scaled(&w, &self.rate_after, -tau)
    }

    /// All of the step for a deviation at one time, at its start and at its end.
    pub fn fundamental(&self, deviation: &[f64; 6]) -> [f64; 6] {
        let end = single(&join(deviation, 0.0), |block| self.carry_at_one_time(block));
        split(&end).0
    }

    /// −∇h/ḣ: how much later the event comes for a deviation just before it.
    pub fn delay(&self) -> &[f64; 6] {
        &self.delay
    }

    /// The length of (ż₊ − R' ż₋) ∇h/ḣ: by how much a deviation can grow because the event comes at
    /// another time.
    pub(crate) fn magnification(&self) -> f64 {
        let through = self.through(&join(&self.rate, 0.0));
        let jump = add_scaled(&self.rate_after, &split(&through).0, -1.0);
        (dot6(&jump, &jump) * dot6(&self.delay, &self.delay)).sqrt()
    }

    /// ż just before the event.
    pub fn rate(&self) -> &[f64; 6] {
        &self.rate
    }

    /// Whether the step ends with an impact.
    pub fn has_impact(&self) -> bool {
        self.law.is_some()
    }
}

impl Tangent {
    /// Of the motions of a system.
    pub fn new(system: &System) -> Self {
        Self {
            system: system.map(Number::constant),
        }
    }

    /// ∂(the state that a run begins with)/∂(the start given): the projection onto closed cables.
    pub fn of_start(&self, simulation: &Simulation) -> Matrix {
        let mut state = variables(simulation.state());
        project_position(&self.system, &mut state, simulation.closed());
        project_velocity(&self.system, &mut state, simulation.resting());
        state.components().map(|component| component.slope)
    }

    /// Of the step that `simulation` has just made.
    #[inline(always)]
    pub fn of_step(&self, simulation: &Simulation, step: &Step) -> StepMap {
        let system = simulation.system();
        let flow = Flow {
            s: step.t_end - step.t_start,
            driven: if system.flies_freely(step.taut) {
                None
            } else {
                Some(self.driven_flow(simulation, step))
            },
        };
        let first = rate(system, step.t_start, &step.start, step.taut);
        let last = rate(system, step.t_end, &step.before, step.taut);
        let rate_after = if step.taut == step.taut_after && system.flies_freely(step.taut) {
            // In flight the force alone accelerates, and it does not jump.
            let State { vx, vy, vtheta, .. } = step.after;
            [vx, vy, vtheta, last[3], last[4], last[5]]
        } else {
            rate(system, step.t_end, &step.after, step.taut_after)
        };
        StepMap {
            flow,
            lag: add_scaled(
                &last,
                &split(&single(&join(&first, 0.0), |block| flow.carry(block))).0,
                -1.0,
            ),
            rate: last,
            delay: self.delay(system, step, &last),
            law: if step.event.reached.gaps.is_empty() {
                None
            } else {
                Some(self.law(system, step))
            },
            rate_after,
        }
    }

    /// Φ along a stretch with taut cables or drag: Φ̇ = A Φ, A = ∂ż/∂z along the motion, by the rule of Runge and
    /// Kutta. The motion itself is known to rounding; its deviation need only be known to some digits.
    #[inline(always)]
    fn driven_flow(&self, simulation: &Simulation, step: &Step) -> Matrix {
        let s = step.t_end - step.t_start;
        let count = (SUBSTEPS * s / simulation.expansion()).ceil().max(1.0);
        let h = s / count;
        let jacobian = |s: f64| {
            let state = variables(&simulation.within(step, s));
            let t = Number::constant(step.t_start + s);
            acceleration(&self.system, t, &state, step.taut).map(|a| a.slope)
        };
        let mut phi = identity();
        let mut left = jacobian(0.0);
        for k in 0..count as u32 {
            let at = f64::from(k) * h;
            let (middle, right) = (jacobian(at + 0.5 * h), jacobian(at + h));
            for column in 0..6 {
                let w = phi.map(|row| row[column]);
                let k1 = change(&left, &w);
                let k2 = change(&middle, &add_scaled(&w, &k1, 0.5 * h));
                let k3 = change(&middle, &add_scaled(&w, &k2, 0.5 * h));
                let k4 = change(&right, &add_scaled(&w, &k3, h));
                for row in 0..6 {
                    phi[row][column] += h / 6.0 * (k1[row] + 2.0 * (k2[row] + k3[row]) + k4[row]);
                }
            }
            left = right;
        }
        phi
    }

    /// −∇h/ḣ of what was reached: a gap, or what a limit bounds. A tension that is lost changes
    /// no velocity and hardly an acceleration, so its time does not matter.
    #[inline(always)]
    fn delay(&self, system: &System, step: &Step, rate: &[f64; 6]) -> [f64; 6] {
        let (before, reached) = (&step.before, step.event.reached);
        if let Some(cable) = reached.gaps.iter().next() {
            let normal = system.cables[cable].normal(before);
            let v_n = normal.velocity(before);
            return [normal.n[0], normal.n[1], normal.arm, 0.0, 0.0, 0.0].map(|n| -n / v_n);
        }
        let Some(limit) = reached.limits.iter().next() else {
            return [0.0; 6];
        };
        let slope = limit.quantity(&self.system, &variables(before)).slope;
        let climb: f64 = slope
            .iter()
            .zip(rate)
            .map(|(slope, rate)| slope * rate)
            .sum();
        slope.map(|slope| -slope / climb)
    }

    /// R' of an impact, and of the sticking that may follow.
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

/// A state as the six variables that derivatives are taken by.
fn variables(state: &State) -> State<Number> {
    let mut i = 0;
    State::from_components(state.components().map(|component| {
        i += 1;
        Number::variable(component, i - 1)
    }))
}

/// ż.
#[inline(always)]
fn rate(system: &System, t: f64, state: &State, taut: TautSet) -> [f64; 6] {
    let [x, y, theta] = acceleration(system, t, state, taut);
    [state.vx, state.vy, state.vtheta, x, y, theta]
}

/// A w, where A's upper rows say that positions change by velocities.
fn change(lower: &[[f64; 6]; 3], w: &[f64; 6]) -> [f64; 6] {
    let [x, y, theta] = lower.map(|row| dot6(&row, w));
    [w[3], w[4], w[5], x, y, theta]
}

fn identity() -> Matrix {
    let mut matrix = [[0.0; 6]; 6];
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    matrix
}

fn dot6(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds to a row of a block.
fn add_row<const M: usize>(block: &mut Block<M>, to: usize, row: &[f64; M], factor: f64) {
    for (sum, entry) in block[to].iter_mut().zip(row) {
        *sum += factor * entry;
    }
}

/// A linear function of the state, of every deviation.
pub(crate) fn combined<const M: usize>(block: &Block<M>, factors: &[f64; 6]) -> [f64; M] {
    let mut sum = [0.0; M];
    for (row, factor) in block.iter().zip(factors) {
        for (sum, entry) in sum.iter_mut().zip(row) {
            *sum += factor * entry;
        }
    }
    sum
}

/// An operation on blocks, on one deviation.
fn single(deviation: &Deviation, carry: impl Fn(&mut Block<1>)) -> Deviation {
    let mut block = deviation.map(|component| [component]);
    carry(&mut block);
    block.map(|[component]| component)
}

fn add_scaled(a: &[f64; 6], b: &[f64; 6], scale: f64) -> [f64; 6] {
    let mut sum = *a;
    for (sum, b) in sum.iter_mut().zip(b) {
        *sum += b * scale;
    }
    sum
}

fn split(deviation: &Deviation) -> ([f64; 6], f64) {
    let [x, y, theta, vx, vy, vtheta, tau] = *deviation;
    ([x, y, theta, vx, vy, vtheta], tau)
}

fn join(w: &[f64; 6], tau: f64) -> Deviation {
    [w[0], w[1], w[2], w[3], w[4], w[5], tau]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::case::parameters::Parameters;
    use crate::case::value::Value;

    fn case(entries: &[(&str, f64)], settles: bool) -> Case {
        let numbers = entries
            .iter()
            .map(|(key, value)| (*key, Value::Number(*value)));
        let stop = ("stop_when_settled", Value::Bool(settles));
        Parameters::from_entries(numbers.chain([stop]))
            .and_then(Case::new)
            .expect("a legal case")
    }

    /// The whole motion over dual numbers, in which no saltation matrix is written down, against this
    /// file's, at the end of each step; relative to the largest deviation there.
    fn worst_difference(case: &Case) -> (f64, usize, usize) {
        let mut simulation = case.simulation();
        let keys = ["x", "y", "theta", "vx", "vy", "vtheta"];
        let mut dual = case
            .simulation_over(|key, number| {
                let place = keys.iter().position(|k| *k == key);
                place.map_or(Number::constant(number), |i| Number::variable(number, i))
            })
            .expect("a legal start");
        let tangent = Tangent::new(simulation.system());
        let start = tangent.of_start(&simulation);
        let mut columns: Vec<[f64; 6]> = (0..6).map(|j| start.map(|row| row[j])).collect();
        let (mut worst, mut steps, mut taut) = (0.0_f64, 0, 0);
        while let (Some(step), Some(over)) = (simulation.step(), dual.step()) {
            let map = tangent.of_step(&simulation, &step);
            for column in &mut columns {
                *column = map.fundamental(column);
            }
            let rates = rate(
                simulation.system(),
                step.t_end,
                &step.after,
                step.taut_after,
            );
            let largest = columns
                .iter()
                .flatten()
                .fold(0.0, |m: f64, c| m.max(c.abs()));
            for (i, w) in over.after.components().iter().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    let there = w.slope[j] - rates[i] * over.t_end.slope[j];
                    worst = worst.max((there - column[i]).abs() / largest);
                }
            }
            steps += 1;
            taut += usize::from(!step.taut.is_empty());
            if largest > 1e10 {
                break;
            }
        }
        (worst, steps, taut)
    }

    #[test]
    fn agrees_with_the_motion_over_dual_numbers() {
        let cases = [
            (case(&[], true), 1e-8),
            (case(&[("a", 0.2), ("b", 0.2), ("e", 0.6)], true), 1e-9),
            (case(&[("f_o", 0.27), ("t_end", 12.0)], false), 1e-4),
            (
                case(&[("f_o", 0.1), ("t_end", 12.0), ("e", 0.5)], false),
                1e-4,
            ),
            // Both cables stick in turn, down to v_n = 1e-12, where n·δP/v_n keeps four digits.
            (case(&[("b", 0.1), ("e", 0.0), ("t_end", 9.0)], false), 1e-3),
        ];
        for (case, allowed) in cases {
            let (worst, steps, taut) = worst_difference(&case);
            println!("{steps} steps, {taut} of them taut: {worst:e}");
            assert!(worst < allowed, "{worst:e}");
            assert!(steps > 20 && (taut > 0) == (allowed > 1e-8));
        }
    }
}
