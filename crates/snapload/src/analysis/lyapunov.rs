//! Lyapunov exponents: the rates at which deviations grow.

use crate::{Matrix, StepMap};

/// Six directions carried along a run and made orthogonal after each step (Benettin, Galgani, Giorgilli &
/// Strelcyn, *Meccanica* 15 (1980) 9); the logarithms of what is taken off their lengths add up to the
/// exponents.
#[derive(Clone, Debug)]
pub struct Frame {
    directions: Matrix,
    logs: [f64; 6],
}

impl Frame {
    /// The frame of the components.
    pub fn new() -> Self {
        let mut directions = [[0.0; 6]; 6];
        for (i, direction) in directions.iter_mut().enumerate() {
            direction[i] = 1.0;
        }
        Self {
            directions,
            logs: [0.0; 6],
        }
    }

    /// Carries it through one step.
    pub fn follow(&mut self, map: &StepMap) {
        for i in 0..6 {
            let mut direction = map.fundamental(&self.directions[i]);
            for earlier in &self.directions[..i] {
                let along = dot(earlier, &direction);
                for (component, other) in direction.iter_mut().zip(earlier) {
                    *component -= along * other;
                }
            }
            let length = dot(&direction, &direction).sqrt();
            // A direction that the law has closed stays closed.
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            self.directions[i] = direction.map(|component| component * scale);
            self.logs[i] += libm::log(length);
        }
    }

    /// ln of the factors by which the six directions have grown.
    pub fn logs(&self) -> &[f64; 6] {
        &self.logs
    }

    /// The exponents over a time t, the largest first.
    pub fn exponents(&self, t: f64) -> [f64; 6] {
        let mut exponents = self.logs.map(|log| log / t);
        exponents.sort_by(|a, b| b.total_cmp(a));
        exponents
    }
}

impl Default for Frame {
    fn default() -> Self {
        Self::new()
    }
}

fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
