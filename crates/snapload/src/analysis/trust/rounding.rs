//! What rounding adds to the deviation of a run in one step.
//!
//! Every rounding is off by anything up to half of the last place: a standard deviation of 1/√12 of
//! the last place, which is between 0.14 ε and 0.29 ε of the number. It is taken as 0.25 ε of it,
//! above the average of 0.21 ε. It acts in three ways.
//!
//! - *The event is located a little too early or too late*, where the computed gap, instead of the
//!   true one, is zero; the error of the time is the gap's rounding over ġ. The state at the
//!   computed event has continued along its motion by that time, and the impact happens from there;
//!   see [`location`]. At a slow snap this is large, as it divides by v_n.
//! - *The law of impact* is computed from a rounded position and from rounded velocities.
//! - *What is stored* is rounded: positions, velocities, and the time, which also is the phase of
//!   the forcing.
//!
//! A closed cable is known to be closed, and its gap is taken as exactly zero: its rounded position
//! may be off along the cable's end and not across it.

use crate::analysis::trust::covariance::PARTS;
use crate::analysis::trust::parts::COLUMNS;
use crate::case::Case;
use crate::case::parameters::Parameters;
use crate::model::cable::Normal;
use crate::model::mass::{Mass, Matrix3, times};
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Block, Deviation, StepMap};

/// Standard deviation of a number that is rounded three times on its way, relative to it: √3 ε/4.
pub(super) const ROUNDING: f64 = 0.43 * f64::EPSILON;

/// The ratio of the standard deviation across the cable's end, times its length, to the bound on
/// the error of its gap: g = |d|² − r² changes by 2r times that deviation, and the bound is a sum
/// of about eight roundings at their worst.
pub(super) const BOUND_OF_GAP: f64 = 1.0 / 16.0;

/// The rounding errors of one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// Standard deviation of the time at which the event is located.
    pub(super) late: f64,
    /// The deviation that one standard deviation of delay leaves, before the event's law.
    pub(super) location: Deviation,
    /// The other errors after the law: independent parts as columns.
    pub(super) parts: Block<COLUMNS>,
}

impl Rounding {
    /// The rounding of the step that `simulation` has just made.
    #[inline(always)]
    pub(super) fn of_step(simulation: &Simulation, step: &Step, map: &StepMap, slant: f64) -> Self {
        // The position at the end: an event does not change it.
        let (system, metric) = (simulation.system(), Metric::of_step(simulation));
        let closed = Constraints::of(system, &step.before, step.event.closed, metric);
        let (late, location) = location(simulation, step, map, &closed, slant);
        Self {
            late,
            location,
            parts: stored(simulation, step, map, closed, slant),
        }
    }
}

/// The error of the cables' direction in a case, as a number of roundings: their anchors are at the
/// height h = √(r² − (1 − a)²), which loses digits where the cables are hardly longer than they
/// have to be.
pub(super) fn slant(case: &Case) -> f64 {
    let Parameters { r, a, .. } = *case.parameters();
    let squares = [r * r, (1.0 - a) * (1.0 - a)];
    let h = (squares[0] - squares[1]).sqrt();
    ((squares[0] + squares[1]) / (h * r)).max(1.0)
}

/// The rounding of a start: its numbers are doubles next to the numbers that were meant.
pub(super) fn of_start(system: &System, state: &State, t: f64, closed: TautSet) -> Block<COLUMNS> {
    let sizes = state.components().map(f64::abs);
    let mut parts = diagonal(sizes, t);
    Constraints::of(system, state, closed, Metric::of_masses(system)).keep_parts(&mut parts, 0);
    parts
}

/// The delay of a step's event, and the deviation at the late event: the state has continued along
/// its motion, and is projected onto the cables that are closed there.
#[inline(always)]
fn location(
    simulation: &Simulation,
    step: &Step,
    map: &StepMap,
    closed: &Constraints,
    slant: f64,
) -> (f64, Deviation) {
    let struck = step.event.reached.gaps.iter().next();
    let s = step.t_end - step.t_start;
    let (first, last) = (&step.start, &step.before);
    // A gap is computed from its earlier value and from the displacement of its end since.
    let place = |start: f64, end: f64| match struck {
        Some(_) => 0.0,
        None => start.abs().max(end.abs()),
    };
    let size = |start: f64, end: f64, v: f64, v_end: f64| {
        ROUNDING * (place(start, end) + v.abs().max(v_end.abs()) * s)
    };
    let sizes = [
        size(first.x, last.x, first.vx, last.vx),
        size(first.y, last.y, first.vy, last.vy),
        size(first.theta, last.theta, first.vtheta, last.vtheta),
    ];
    let mut square = 0.0;
    for (size, delay) in sizes.iter().zip(map.delay()) {
        square += (size * delay) * (size * delay);
    }
    if let Some(cable) = struck {
        let tether = &simulation.system().cables[cable];
        let v_n = tether.normal(last).velocity(last);
        let contact = simulation.contact_at_start(step, cable);
        let known = across(contact.error, tether.length()) / v_n;
        // An error of the cable's direction displaces its end; but a cable that was closed at the
        // start has its end where the body is.
        let reach = tether.fairlead().length();
        let moved = if contact.gap == 0.0 {
            s * (last.velocity().length() + last.vtheta.abs() * reach)
        } else {
            last.x.abs() + last.y.abs() + last.theta.abs() * reach
        };
        let turned = ROUNDING * (slant - 1.0) * moved / v_n;
        square += known * known + turned * turned;
    }
    let late = square.sqrt();
    let [vx, vy, vtheta, ax, ay, atheta] = *map.rate();
    let mut place = [vx * late, vy * late, vtheta * late];
    closed.keep(&mut place);
    let [x, y, theta] = place;
    let location = [x, y, theta, ax * late, ay * late, atheta * late, late];
    (late, location)
}

/// The rounding of the law's result and of its inputs.
#[inline(always)]
fn stored(
    simulation: &Simulation,
    step: &Step,
    map: &StepMap,
    mut closed: Constraints,
    slant: f64,
) -> Block<COLUMNS> {
    let system = simulation.system();
    let (first, before, after) = (&step.start, &step.before, &step.after);
    let s = step.t_end - step.t_start;
    let speed = |state: &State| state.velocity().length();
    let speed = speed(before).max(speed(after));
    let spin = before.vtheta.abs().max(after.vtheta.abs());
    let place = |now: f64, v: f64, v_end: f64| now.abs() + v.abs().max(v_end.abs()) * s;
    let sizes = [
        place(after.x, first.vx, before.vx),
        place(after.y, first.vy, before.vy),
        place(after.theta, first.vtheta, before.vtheta),
        speed,
        speed,
        spin,
    ];
    let mut parts = diagonal(sizes, step.t_end);
    closed.keep_parts(&mut parts, 0);
    limit_to_known_gap(simulation, step, &mut closed, &mut parts);
    Constraints::of(system, after, step.taut_after, Metric::of_masses(system))
        .keep_parts(&mut parts, 3);
    add_residual(system, step, &mut parts);
    if let (Some(law), Some(cable)) = (map.slopes_of_law(), step.event.closed.iter().next()) {
        // The direction and the rotation that the law uses are rounded.
        let length = 0.5 * slant * system.cables[cable].length();
        for (row, slopes) in parts[3..6].iter_mut().zip(law) {
            for (j, size) in [length, length, 1.0].into_iter().enumerate() {
                row[j] += ROUNDING * size * slopes[j];
            }
        }
    }
    parts
}

/// The remaining normal velocities where several impulses are solved for: W p = b holds up to the
/// rounding of its summands, and cables of nearly the same direction magnify it.
#[inline(always)]
fn add_residual(system: &System, step: &Step, parts: &mut Block<COLUMNS>) {
    let (mut count, mut summands) = (0, 0.0);
    for impact in step.impacts() {
        let normal = system.cables[impact.cable].normal(&step.before);
        summands += impact.impulse * system.body.inverse_effective_mass(&normal);
        count += 1;
    }
    if count < 2 {
        return;
    }
    let metric = Metric::of_masses(system);
    let closed = Constraints::of(system, &step.before, step.event.closed, metric);
    for (k, column) in [PARTS - 1, PARTS, PARTS - 2]
        .into_iter()
        .enumerate()
        .take(closed.count)
    {
        let size = ROUNDING * summands / closed.lengths[k];
        let yielding = metric.moved_by(&closed.normals[k]);
        for i in 0..3 {
            parts[3 + i][column] += yielding[i] * size;
        }
    }
}

/// One part for each component and one for the time, which is rounded both as a time and as the
/// forcing's phase.
#[inline(always)]
fn diagonal(sizes: [f64; 6], t: f64) -> Block<COLUMNS> {
    let mut parts = [[0.0; COLUMNS]; 7];
    for (i, size) in sizes.into_iter().enumerate() {
        parts[i][i] = ROUNDING * size;
    }
    parts[6][6] = ROUNDING * std::f64::consts::SQRT_2 * t;
    parts
}

/// Where the gap of a slack cable is known better than the positions are, because it has been
/// carried forward since the cable was closed, displacements are limited to those that change this
/// gap by no more than its error. Of several cables it is the one whose gap is known best.
#[inline(always)]
fn limit_to_known_gap(
    simulation: &Simulation,
    step: &Step,
    constraints: &mut Constraints,
    parts: &mut Block<COLUMNS>,
) {
    let (system, after) = (simulation.system(), &step.after);
    let slack = (0..system.cables.len()).filter(|cable| !step.event.closed.contains(*cable));
    let known = |cable: usize| {
        let error = simulation.contact(cable).error;
        (cable, across(error, system.cables[cable].length()))
    };
    let Some((cable, size)) = slack
        .map(known)
        .reduce(|a, b| if b.1 < a.1 { b } else { a })
    else {
        return;
    };
    let Normal { n, arm } = system.cables[cable].normal(after);
    let normal = [n.x, n.y, arm];
    let mut square = 0.0;
    for part in across_parts(parts, &normal) {
        square += part * part;
    }
    if size * size < square
        && let Some(left) = constraints.add(normal)
    {
        constraints.keep_parts(parts, 0);
        let newest = constraints.normals[constraints.count - 1];
        let yielding = constraints.metric.moved_by(&newest);
        for (i, yielding) in yielding.into_iter().enumerate() {
            parts[i][PARTS] = yielding * (size / left);
        }
    }
}

/// Standard deviation of a position across a cable's end, from a bound on the error of its gap.
#[inline(always)]
fn across(error: f64, length: f64) -> f64 {
    error / length * BOUND_OF_GAP
}

/// The metric in which a body is projected onto its cables.
#[derive(Clone, Copy)]
enum Metric {
    /// A factor for each of x, y and θ.
    Diagonal([f64; 3]),
    /// M⁻¹.
    Full(Matrix3),
}

impl Metric {
    /// The metric of the mass matrix.
    #[inline(always)]
    fn of_masses(system: &System) -> Self {
        match system.body.mass {
            Mass::Unit { inverse_inertia } => Self::Diagonal([1.0, 1.0, inverse_inertia]),
            Mass::Full { inverse, .. } => Self::Full(inverse),
        }
    }

    /// The metric of the projection in the step that `simulation` has just made: a bounce does not
    /// turn the body.
    #[inline(always)]
    fn of_step(simulation: &Simulation) -> Self {
        if simulation.has_bounced() {
            Self::Diagonal([1.0, 1.0, 0.0])
        } else {
            Self::of_masses(simulation.system())
        }
    }

    #[inline(always)]
    fn product(self, a: &[f64; 3], b: &[f64; 3]) -> f64 {
        let moved = self.moved_by(a);
        moved[0] * b[0] + moved[1] * b[1] + moved[2] * b[2]
    }

    /// M⁻¹ n.
    #[inline(always)]
    fn moved_by(self, n: &[f64; 3]) -> [f64; 3] {
        match self {
            Self::Diagonal([x, y, theta]) => [x * n[0], y * n[1], theta * n[2]],
            Self::Full(inverse) => times(&inverse, *n),
        }
    }

    /// Subtracts from a displacement the multiple `across` of M⁻¹ n.
    #[inline(always)]
    fn take_off(self, displacement: [&mut f64; 3], n: &[f64; 3], across: f64) {
        match self {
            Self::Diagonal(yielding) => {
                for ((component, n), yielding) in displacement.into_iter().zip(n).zip(yielding) {
                    *component -= across * yielding * n;
                }
            }
            Self::Full(_) => {
                for (component, yielding) in displacement.into_iter().zip(self.moved_by(n)) {
                    *component -= across * yielding;
                }
            }
        }
    }
}

/// The normals of some cables in (x, y, θ), orthonormal in a metric; three at most are independent.
struct Constraints {
    normals: [[f64; 3]; 3],
    /// The length of the part of each normal that is independent of those before it.
    lengths: [f64; 3],
    count: usize,
    metric: Metric,
}

impl Constraints {
    #[inline(always)]
    fn of(system: &System, state: &State, set: TautSet, metric: Metric) -> Self {
        let mut all = Self {
            normals: [[0.0; 3]; 3],
            lengths: [1.0; 3],
            count: 0,
            metric,
        };
        for cable in set.iter() {
            let Normal { n, arm } = system.cables[cable].normal(state);
            all.add([n.x, n.y, arm]);
        }
        all
    }

    /// Adds a normal, if it is independent of the others; returns the length of its part that is.
    #[inline(always)]
    fn add(&mut self, mut normal: [f64; 3]) -> Option<f64> {
        let whole = self.metric.product(&normal, &normal);
        for earlier in &self.normals[..self.count] {
            let along = self.metric.product(&normal, earlier);
            subtract(&mut normal, earlier, along);
        }
        let left = self.metric.product(&normal, &normal);
        if self.count == 3 || left <= f64::EPSILON * whole {
            return None;
        }
        let left = left.sqrt();
        for component in &mut normal {
            *component /= left;
        }
        self.normals[self.count] = normal;
        self.lengths[self.count] = left;
        self.count += 1;
        Some(left)
    }

    /// Projects a displacement so that it stretches no cable of the set.
    #[inline(always)]
    fn keep(&self, displacement: &mut [f64; 3]) {
        for normal in &self.normals[..self.count] {
            let mut across = 0.0;
            for (component, n) in displacement.iter().zip(normal) {
                across += component * n;
            }
            self.metric
                .take_off(displacement.each_mut(), normal, across);
        }
    }

    /// The same for each part of the rounding, for the displacement or velocity in the three rows
    /// from `row`.
    #[inline(always)]
    fn keep_parts(&self, parts: &mut Block<COLUMNS>, row: usize) {
        let rows = &mut parts[row..row + 3];
        for normal in &self.normals[..self.count] {
            let across = across_parts(rows, normal);
            let [x, y, theta] = rows else { continue };
            for (k, across) in across.into_iter().enumerate() {
                let part = [&mut x[k], &mut y[k], &mut theta[k]];
                self.metric.take_off(part, normal, across);
            }
        }
    }
}

/// The displacement of each part along a normal, from its three rows.
#[inline(always)]
fn across_parts(rows: &[[f64; COLUMNS]], normal: &[f64; 3]) -> [f64; COLUMNS] {
    let mut across = [0.0; COLUMNS];
    for (row, n) in rows.iter().zip(normal) {
        for (sum, entry) in across.iter_mut().zip(row) {
            *sum += n * entry;
        }
    }
    across
}

#[inline(always)]
fn subtract(vector: &mut [f64; 3], direction: &[f64; 3], length: f64) {
    for (component, along) in vector.iter_mut().zip(direction) {
        *component -= length * along;
    }
}
