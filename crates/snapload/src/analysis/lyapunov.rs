//! Lyapunov exponents: the rates at which deviations grow.

use crate::arithmetic::processor::{Aligned, Kernel, dispatch};
use crate::motion::bounce_map::BounceMap;
use crate::motion::step_map::{Block, StepMap};

/// Six directions carried along a run and made orthogonal after each step (Benettin, Galgani,
/// Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9); the logarithms of what is taken off their
/// lengths add up to the exponents.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The directions are columns; two more are zero.
    directions: Aligned<Block<8>>,
    /// Their rows of the water's memory, if the body floats.
    memory: Vec<[f64; 8]>,
    logs: [f64; 6],
    /// Lengths taken off since the logarithms were last taken.
    lengths: [f64; 6],
    /// Bounces since the directions were last made orthogonal.
    bounces: u32,
}

/// Directions to be made orthogonal, by the best instructions for it.
struct MakingOrthogonal<'a>(&'a mut Frame);

impl Kernel for MakingOrthogonal<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.make_orthogonal_here();
    }
}

/// Logarithms are taken when a length leaves this range, and its inverse.
const RANGE: f64 = 1e100;
/// Directions are made orthogonal after so many bounces, or when a component has grown to this: what
/// then is left of the one that grows least has lost some eight digits of sixteen.
const MOST_BOUNCES: u32 = 8;
const GROWN: f64 = 1e4;

impl Frame {
    /// The frame of the components.
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
        }
    }

    /// Carries it through one step.
    pub fn follow(&mut self, map: &StepMap) {
        self.follow_here(map);
    }

    /// The same, for work that is compiled for a kind of processor.
    #[inline(always)]
    pub(crate) fn follow_here(&mut self, map: &StepMap) {
        if self.bounces > 0 {
            self.make_orthogonal();
        }
        self.memory.resize(map.memory_rows(), [0.0; 8]);
        map.carry_at_one_time(&mut self.directions.0, &mut self.memory);
        self.make_orthogonal();
    }

    /// Carries it through a bounce, which closes no direction: as long as the directions have not
    /// grown much, several times before they are made orthogonal again.
    #[inline(always)]
    pub(crate) fn follow_bounce(&mut self, map: &BounceMap<f64>) {
        map.at_one_time(&mut self.directions.0);
        self.bounces += 1;
        if self.bounces == MOST_BOUNCES || self.has_grown() {
            self.make_orthogonal();
        }
    }

    /// Whether a component has grown so far that the directions have to be made orthogonal. It is
    /// found column by column: one maximum of all would have to wait for forty-eight comparisons,
    /// one after the other.
    #[inline(always)]
    fn has_grown(&self) -> bool {
        let mut largest = [0.0; 8];
        for row in &self.directions.0[..6] {
            for (largest, entry) in largest.iter_mut().zip(row) {
                let size = entry.abs();
                *largest = if size > *largest { size } else { *largest };
            }
        }
        largest
            .iter()
            .fold(false, |any, size| any | (*size >= GROWN))
    }

    /// Gram and Schmidt's procedure: each direction is taken off all that follow, at once, and all
    /// are brought to length 1 in the end.
    fn make_orthogonal(&mut self) {
        dispatch(MakingOrthogonal(self));
    }

    #[inline(always)]
    fn make_orthogonal_here(&mut self) {
        self.bounces = 0;
        let mut squares = [0.0; 8];
        // One after the other by hand: which is which is then known when it is compiled.
        self.take_off::<0>(&mut squares);
        self.take_off::<1>(&mut squares);
        self.take_off::<2>(&mut squares);
        self.take_off::<3>(&mut squares);
        self.take_off::<4>(&mut squares);
        self.take_off::<5>(&mut squares);
        let mut scales = [0.0; 8];
        for (scale, square) in scales.iter_mut().zip(&mut squares) {
            *square = square.sqrt();
            // A direction that the law has closed stays closed.
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

    /// Takes the I-th direction off all that follow.
    #[inline(always)]
    fn take_off<const I: usize>(&mut self, squares: &mut [f64; 8]) {
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
        let square = along[I];
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

    /// ln of the factors by which the six directions have grown.
    pub fn logs(&self) -> [f64; 6] {
        let mut frame = self.clone();
        if frame.bounces > 0 {
            frame.make_orthogonal();
        }
        let mut logs = frame.logs;
        for (log, length) in logs.iter_mut().zip(frame.lengths) {
            *log += libm::log(length);
        }
        logs
    }

    /// The exponents over a time t, the largest first.
    pub fn exponents(&self, t: f64) -> [f64; 6] {
        let mut exponents = self.logs().map(|log| log / t);
        exponents.sort_by(|a, b| b.total_cmp(a));
        exponents
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::new()
    }
}
