//! Lyapunov exponents: the rates at which deviations grow.

use crate::motion::bounce_map::BounceMap;
use crate::motion::step_map::{Block, StepMap, dot6};

/// Six directions carried along a run and made orthogonal after each step (Benettin, Galgani,
/// Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9); the logarithms of what is taken off their
/// lengths add up to the exponents.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The directions are columns; two more are zero.
    directions: Block<8>,
    logs: [f64; 6],
    /// Lengths taken off since the logarithms were last taken.
    lengths: [f64; 6],
    /// Bounces since the directions were last made orthogonal.
    bounces: u32,
}

/// Logarithms are taken when a length leaves this range, and its inverse.
const RANGE: f64 = 1e100;
/// Directions are made orthogonal after so many bounces, or when a component has grown to this: what
/// then is left of the one that grows least has lost some four digits of sixteen.
const MOST_BOUNCES: u32 = 8;
const GROWN: f64 = 100.0;

impl Frame {
    /// The frame of the components.
    pub fn new() -> Self {
        let mut directions = [[0.0; 8]; 7];
        for (i, row) in directions.iter_mut().enumerate().take(6) {
            row[i] = 1.0;
        }
        Self {
            directions,
            logs: [0.0; 6],
            lengths: [1.0; 6],
            bounces: 0,
        }
    }

    /// Carries it through one step.
    #[inline(always)]
    pub fn follow(&mut self, map: &StepMap) {
        if self.bounces > 0 {
            self.make_orthogonal();
        }
        map.carry_at_one_time(&mut self.directions);
        self.make_orthogonal();
    }

    /// Carries it through a bounce, which closes no direction: as long as the directions have not
    /// grown much, several times before they are made orthogonal again.
    #[inline(always)]
    pub(crate) fn follow_bounce(&mut self, map: &BounceMap<f64>) {
        map.at_one_time(&mut self.directions);
        self.bounces += 1;
        let mut largest = 0.0_f64;
        for entry in self.directions[..6].as_flattened() {
            largest = largest.max(entry.abs());
        }
        if self.bounces == MOST_BOUNCES || !(largest < GROWN) {
            self.make_orthogonal();
        }
    }

    /// Gram and Schmidt's procedure.
    #[inline(always)]
    fn make_orthogonal(&mut self) {
        self.bounces = 0;
        let mut columns = [[0.0; 6]; 6];
        for (i, column) in columns.iter_mut().enumerate() {
            for (entry, row) in column.iter_mut().zip(&self.directions) {
                *entry = row[i];
            }
        }
        for i in 0..6 {
            let (done, rest) = columns.split_at_mut(i);
            let direction = &mut rest[0];
            for earlier in done {
                let along = dot6(earlier, direction);
                for (component, other) in direction.iter_mut().zip(earlier) {
                    *component -= along * *other;
                }
            }
            let length = dot6(direction, direction).sqrt();
            // A direction that the law has closed stays closed.
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            *direction = direction.map(|component| component * scale);
            self.lengths[i] *= length;
            if !(1.0 / RANGE..RANGE).contains(&self.lengths[i]) {
                self.logs[i] += libm::log(self.lengths[i]);
                self.lengths[i] = 1.0;
            }
        }
        for (i, column) in columns.iter().enumerate() {
            for (row, entry) in self.directions.iter_mut().zip(column) {
                row[i] = *entry;
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
