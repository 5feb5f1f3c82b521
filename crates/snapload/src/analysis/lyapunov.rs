//! Lyapunov exponents: the rates at which deviations grow.

use crate::arithmetic::processor::{Aligned, Kernel, dispatch};
use crate::model::cable::Cable;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::bounce_map::BounceMap;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::step_map::{Block, StepMap};

/// Six directions that are carried along a run and made orthogonal again and again (Benettin,
/// Galgani, Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9); the logarithms of the factors by which
/// their lengths are reduced add up to the exponents.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The directions are columns; two columns are unused and zero.
    directions: Aligned<Block<8>>,
    /// The rows of the directions for the water's memory, if the body floats.
    memory: Vec<[f64; 8]>,
    logs: [f64; 6],
    /// Products of the factors removed since their logarithms were last added.
    lengths: [f64; 6],
    /// Bounces since the directions were last made orthogonal, and at most how many there may be.
    bounces: u32,
    most_bounces: u32,
    /// Steps along taut cables since the directions were last projected onto the constraints.
    taut_steps: u32,
    /// How many directions the body has: four of a point mass, which has no rotation.
    count: usize,
}

/// Directions to be made orthogonal, by the best instructions for it.
struct MakingOrthogonal<'a>(&'a mut Frame, f64);

impl Kernel for MakingOrthogonal<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.make_orthogonal_here(self.1);
    }
}

/// Logarithms are added when a product leaves the range from the inverse of this to this.
const RANGE: f64 = 1e100;
/// Directions are made orthogonal when a component has grown to this: the part of the slowest
/// growing direction that is orthogonal to the others has then lost about eight digits of sixteen.
const GROWTH_LIMIT: f64 = 1e4;
/// They are also made orthogonal after this many bounces, or fewer if the bounces together may
/// contract a volume to this part or less, each by e²: contraction loses digits, too.
const MOST_BOUNCES: u32 = 24;
const CONTRACTION_LIMIT: f64 = 1e-6;
/// Directions are projected onto the constraints of the same taut cables after this many steps; in
/// between only rounding takes them off the constraints.
const MOST_TAUT_STEPS: u32 = 16;
/// If less than this part of a direction is left, it is rounding, and the direction counts as
/// closed.
const ROUNDING: f64 = 1e-10;

impl Frame {
    /// The frame whose directions are the components of the state.
    pub fn new() -> Self {
        let mut directions = [[0.0; 8]; 7];
        for (i, row) in directions.iter_mut().enumerate().take(6) {
            row[i] = 1.0;
        }
        Self {
            directions: Aligned(directions),
            memory: Vec::new(),
            logs: [0.0; 6],
            lengths: [1.0; 6],
            bounces: 0,
            most_bounces: 1,
            taut_steps: 0,
            count: 6,
        }
    }

    /// The frame of a motion that begins with taut cables.
    pub fn along(system: &System, state: &State, taut: TautSet) -> Self {
        let mut frame = Self::new();
        if system.body.inverse_inertia() == 0.0 {
            for rotation in [2, 5] {
                frame.directions.0[rotation][rotation] = 0.0;
            }
            frame.count = 4;
        }
        frame.most_bounces = most_bounces(system.restitution);
        frame.keep_along(system, state, taut);
        frame.lengths = [1.0; 6];
        frame
    }

    /// Carries it through one step.
    pub fn follow(&mut self, map: &StepMap) {
        self.follow_here(map);
    }

    /// The same, inlined into code that is compiled for one kind of processor.
    #[inline(always)]
    pub(crate) fn follow_here(&mut self, map: &StepMap) {
        if self.bounces > 0 {
            self.make_orthogonal(0.0);
        }
        self.memory.resize(map.memory_rows(), [0.0; 8]);
        map.carry_at_one_time(&mut self.directions.0, &mut self.memory);
        self.make_orthogonal(0.0);
    }

    /// Carries it through a step that a run has made, and projects it onto the constraints of the
    /// cables that are taut then, and of those that its snap stops.
    #[inline(always)]
    pub(crate) fn follow_step(&mut self, map: &StepMap, simulation: &Simulation, step: &Step) {
        self.follow_here(map);
        let stopped = stopped(simulation.system(), step);
        if step.taut_after.union(stopped).is_empty() {
            return;
        }
        self.taut_steps += 1;
        let other = step.taut_after != step.taut || !stopped.is_empty();
        if other || self.taut_steps >= MOST_TAUT_STEPS {
            self.taut_steps = 0;
            self.project(simulation.system(), &step.after, [step.taut_after, stopped]);
        }
    }

    /// Projects it onto the constraints of taut cables, which allow no deviation of their gaps and
    /// of the gaps' rates; directions of which nothing remains are closed from now on, and their
    /// exponents −∞. The linearised motion does not project: off the constraints a deviation that
    /// is only rounding would evolve by itself, and be reported as a small exponent.
    pub fn keep_along(&mut self, system: &System, state: &State, taut: TautSet) {
        self.project(system, state, [taut, TautSet::SLACK]);
    }

    /// The same, and onto the constraints of the gaps alone of cables that were just stopped.
    fn project(&mut self, system: &System, state: &State, [taut, stopped]: [TautSet; 2]) {
        let mut rows = [[0.0; 6]; 6];
        let mut count = 0;
        for cable in taut.union(stopped).iter() {
            let slopes = slopes_of_gap_and_rate(&system.cables[cable], state);
            for row in &slopes[..if taut.contains(cable) { 2 } else { 1 }] {
                count += usize::from(count < 6 && add_orthogonal(&mut rows, count, *row));
            }
        }
        for row in &rows[..count] {
            let mut along = [0.0; 8];
            for (slope, components) in row.iter().zip(&self.directions.0) {
                for (along, component) in along.iter_mut().zip(components) {
                    *along += slope * component;
                }
            }
            for (slope, components) in row.iter().zip(&mut self.directions.0) {
                for (component, along) in components.iter_mut().zip(along) {
                    *component -= slope * along;
                }
            }
        }
        self.make_orthogonal(ROUNDING);
    }

    /// Carries it through a bounce, which closes no direction: several bounces may pass before the
    /// directions are made orthogonal again, as long as they have not grown or contracted much.
    #[inline(always)]
    pub(crate) fn follow_bounce(&mut self, map: &BounceMap<f64>) {
        map.at_one_time(&mut self.directions.0);
        self.bounces += 1;
        if self.bounces >= self.most_bounces || self.exceeds_growth_limit() {
            self.make_orthogonal(0.0);
        }
    }

    /// Whether a component has grown so far that the directions have to be made orthogonal. The
    /// maximum is found column by column: a single maximum of all would have to wait for
    /// forty-eight comparisons, one after the other.
    #[inline(always)]
    fn exceeds_growth_limit(&self) -> bool {
        let mut largest = [0.0; 8];
        for row in &self.directions.0[..6] {
            for (largest, entry) in largest.iter_mut().zip(row) {
                let size = entry.abs();
                *largest = if size > *largest { size } else { *largest };
            }
        }
        largest
            .iter()
            .fold(false, |any, size| any | (*size >= GROWTH_LIMIT))
    }

    /// Gram and Schmidt's procedure: the component along each direction is removed from all that
    /// follow, and in the end all are scaled to length 1. A direction whose remaining length is at
    /// most `least` is closed.
    fn make_orthogonal(&mut self, least: f64) {
        dispatch(MakingOrthogonal(self, least));
    }

    #[inline(always)]
    fn make_orthogonal_here(&mut self, least: f64) {
        let least = least * least;
        self.bounces = 0;
        let mut squares = [0.0; 8];
        // Unrolled by hand, so that the index of each direction is a constant for the compiler.
        self.take_off::<0>(&mut squares, least);
        self.take_off::<1>(&mut squares, least);
        self.take_off::<2>(&mut squares, least);
        self.take_off::<3>(&mut squares, least);
        self.take_off::<4>(&mut squares, least);
        self.take_off::<5>(&mut squares, least);
        let mut scales = [0.0; 8];
        for (scale, square) in scales.iter_mut().zip(&mut squares) {
            *square = square.sqrt();
            // A direction that a taut cable has closed stays closed.
            *scale = if *square > 0.0 { 1.0 / *square } else { 0.0 };
        }
        for row in self.directions.0[..6].iter_mut().chain(&mut self.memory) {
            for (entry, scale) in row.iter_mut().zip(scales) {
                *entry *= scale;
            }
        }
        for (i, length) in squares.into_iter().enumerate().take(6) {
            self.lengths[i] *= length;
            if !(1.0 / RANGE..RANGE).contains(&self.lengths[i]) {
                self.logs[i] += libm::log(self.lengths[i]);
                self.lengths[i] = 1.0;
            }
        }
    }

    /// Removes the component along the I-th direction from all that follow.
    #[inline(always)]
    fn take_off<const I: usize>(&mut self, squares: &mut [f64; 8], least: f64) {
        let [mut along, mut more] = [[0.0; 8]; 2];
        for pair in self.directions.0[..6].chunks_exact(2) {
            for k in 0..8 {
                along[k] += pair[0][I] * pair[0][k];
                more[k] += pair[1][I] * pair[1][k];
            }
        }
        for row in &self.memory {
            for (more, entry) in more.iter_mut().zip(row) {
                *more += row[I] * entry;
            }
        }
        for (along, more) in along.iter_mut().zip(more) {
            *along += more;
        }
        let square = if along[I] > least { along[I] } else { 0.0 };
        squares[I] = square;
        let scale = if square > 0.0 { 1.0 / square } else { 0.0 };
        for (k, part) in along.iter_mut().enumerate() {
            *part = if k > I { *part * scale } else { 0.0 };
        }
        for row in self.directions.0[..6].iter_mut().chain(&mut self.memory) {
            let direction = row[I];
            for (entry, part) in row.iter_mut().zip(along) {
                *entry -= direction * part;
            }
        }
    }

    /// The logarithms of the factors by which the six directions have grown.
    pub fn logs(&self) -> [f64; 6] {
        let mut frame = self.clone();
        if frame.bounces > 0 {
            frame.make_orthogonal(0.0);
        }
        let mut logs = frame.logs;
        for (log, length) in logs.iter_mut().zip(frame.lengths) {
            *log += libm::log(length);
        }
        logs
    }

    /// The exponents over a time t, the largest first, one for each direction that the body has.
    pub fn exponents(&self, t: f64) -> Vec<f64> {
        let mut exponents = self.logs().map(|log| log / t).to_vec();
        exponents.sort_by(|a, b| b.total_cmp(a));
        exponents.truncate(self.count);
        exponents
    }
}

/// How many bounces may pass before the directions are made orthogonal.
fn most_bounces(restitution: f64) -> u32 {
    let contraction = restitution * restitution;
    let mut left = contraction;
    (1..MOST_BOUNCES)
        .find(|_| {
            left *= contraction;
            left <= CONTRACTION_LIMIT
        })
        .unwrap_or(MOST_BOUNCES)
}

/// The cables that the snap of a step brings to rest and that open again at once: those that take
/// an impulse and neither rebound nor stay taut. No deviation of their gaps is left; their rates
/// differ, as each neighbour has opened for another time.
fn stopped(system: &System, step: &Step) -> TautSet {
    let Some(result) = &step.result else {
        return TautSet::SLACK;
    };
    let rebound = match system.restitution > 0.0 {
        true => step.event.reached.gaps,
        false => TautSet::SLACK,
    };
    let stopped = rebound.union(step.taut_after).iter();
    stopped.fold(result.pulling, TautSet::without)
}

/// ∂g and ∂ġ of a taut cable by x, y, θ, ẋ, ẏ, θ̇, where ġ = n·v + s θ̇; g itself up to a factor.
fn slopes_of_gap_and_rate(cable: &Cable, state: &State) -> [[f64; 6]; 2] {
    let (normal, by_place) = cable.normal_and_slopes(state);
    let normal = [normal.n.x, normal.n.y, normal.arm];
    let velocity = [state.vx, state.vy, state.vtheta];
    let [mut gap, mut rate] = [[0.0; 6]; 2];
    for j in 0..3 {
        gap[j] = normal[j];
        rate[j + 3] = normal[j];
        for i in 0..3 {
            rate[j] += by_place[i][j] * velocity[i];
        }
    }
    [gap, rate]
}

/// Adds the part of a row that is orthogonal to the orthonormal rows so far; returns whether it is
/// nonzero.
fn add_orthogonal(rows: &mut [[f64; 6]; 6], count: usize, mut row: [f64; 6]) -> bool {
    let product = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let whole = product(&row, &row);
    for _ in 0..2 {
        for other in &rows[..count] {
            let along = product(&row, other);
            for (entry, other) in row.iter_mut().zip(other) {
                *entry -= along * other;
            }
        }
    }
    let left = product(&row, &row);
    if left <= ROUNDING * ROUNDING * whole {
        return false;
    }
    rows[count] = row.map(|entry| entry / left.sqrt());
    true
}

impl Default for Frame {
    fn default() -> Self {
        Self::new()
    }
}
