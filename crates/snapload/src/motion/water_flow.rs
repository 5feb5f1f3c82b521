//! The flow of small deviations of a floating body's motion, including those of the water's memory.
//!
//! With w = (δq, δq̇) and ζ = δz of each state of the memory,
//!
//! ```text
//! δq̈ = A w − R Re Σ r ζ,    ζ̇ = p ζ + δq̇
//! ```
//!
//! where A is the derivative of the accelerations by the state, and R that by a force: M⁻¹ while
//! all cables are slack, reduced by the taut ones. In slack flight without drag both are constant,
//! and the flow is a power series in the time, as the motion itself is; with taut cables they
//! change, and the flow is integrated by the Runge-Kutta rule.

use crate::arithmetic::polynomial::ORDER;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::floating::{Channel, Floating};
use crate::model::mass::Matrix3;
use crate::model::state::State;

/// The derivatives of the accelerations at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes {
    /// A.
    pub(crate) by_state: [[f64; 6]; 3],
    /// R.
    pub(crate) by_force: Matrix3,
}

/// The flow along a stretch.
#[derive(Clone, Debug)]
pub(crate) struct WaterFlow {
    channels: Vec<Channel<f64>>,
    /// The step of the Runge-Kutta rule; the whole stretch where the slopes are constant.
    h: f64,
    /// At the start, middle and end of each step; a single entry where they are constant.
    slopes: Vec<Slopes>,
}

/// Deviations as columns: of the state, and of the memory, real and imaginary parts in turn.
#[derive(Clone)]
struct Deviations<const M: usize> {
    state: [[f64; M]; 6],
    memory: Vec<[f64; M]>,
}

/// Deviations to be carried, by the best instructions for it.
struct Carrying<'a, const M: usize>(&'a WaterFlow, &'a mut [[f64; M]; 7], &'a mut [[f64; M]]);

impl<const M: usize> Kernel for Carrying<'_, M> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.carry_here(self.1, self.2);
    }
}

impl WaterFlow {
    /// A flow with slopes that are constant over a time `s`.
    pub(crate) fn constant(water: &Floating, s: f64, slopes: Slopes) -> Self {
        Self {
            channels: water.channels().collect(),
            h: s,
            slopes: vec![slopes],
        }
    }

    /// A flow with slopes at the start, middle and end of each step of `h`.
    pub(crate) fn varying(water: &Floating, h: f64, slopes: Vec<Slopes>) -> Self {
        Self {
            channels: water.channels().collect(),
            h,
            slopes,
        }
    }

    /// Carries deviations along the stretch; the last row of `block`, the time, stays.
    pub(crate) fn carry<const M: usize>(&self, block: &mut [[f64; M]; 7], memory: &mut [[f64; M]]) {
        dispatch(Carrying(self, block, memory));
    }

    #[inline(always)]
    fn carry_here<const M: usize>(&self, block: &mut [[f64; M]; 7], memory: &mut [[f64; M]]) {
        let mut w = Deviations {
            state: [[0.0; M]; 6],
            memory: memory.to_vec(),
        };
        w.state.copy_from_slice(&block[..6]);
        if let [slopes] = &self.slopes[..] {
            w = self.carried_by_series(slopes, w);
        }
        let mut rest = &self.slopes[..];
        while let [left, middle, right, ..] = rest {
            w = self.carried_by_rule([left, middle, right], w);
            rest = &rest[2..];
        }
        block[..6].copy_from_slice(&w.state);
        memory.copy_from_slice(&w.memory);
    }

    /// Σ (L h)^k w/k!.
    #[inline(always)]
    fn carried_by_series<const M: usize>(
        &self,
        slopes: &Slopes,
        w: Deviations<M>,
    ) -> Deviations<M> {
        let mut term = w.clone();
        let mut sum = w;
        for k in 1..=ORDER {
            let mut next = self.change(slopes, &term);
            next.scale(self.h / k as f64);
            sum = sum.plus(&next, 1.0);
            term = next;
        }
        sum
    }

    /// One step of Runge and Kutta.
    #[inline(always)]
    fn carried_by_rule<const M: usize>(
        &self,
        [left, middle, right]: [&Slopes; 3],
        w: Deviations<M>,
    ) -> Deviations<M> {
        let h = self.h;
        let k1 = self.change(left, &w);
        let k2 = self.change(middle, &w.clone().plus(&k1, 0.5 * h));
        let k3 = self.change(middle, &w.clone().plus(&k2, 0.5 * h));
        let k4 = self.change(right, &w.clone().plus(&k3, h));
        let outer = w.plus(&k1, h / 6.0).plus(&k4, h / 6.0);
        outer.plus(&k2, h / 3.0).plus(&k3, h / 3.0)
    }

    /// ẇ and ζ̇.
    #[inline(always)]
    fn change<const M: usize>(&self, slopes: &Slopes, w: &Deviations<M>) -> Deviations<M> {
        let mut changed = Deviations {
            state: [[0.0; M]; 6],
            memory: vec![[0.0; M]; w.memory.len()],
        };
        let mut pulls = [[0.0; M]; 3];
        let pairs = w
            .memory
            .chunks_exact(2)
            .zip(changed.memory.chunks_exact_mut(2));
        for (channel, (parts, changed)) in self.channels.iter().zip(pairs) {
            let ([p, q], driven) = (channel.pole, &w.state[3 + channel.input]);
            for k in 0..M {
                let (re, im) = (parts[0][k], parts[1][k]);
                changed[0][k] = p * re - q * im + driven[k];
                changed[1][k] = p * im + q * re;
                for (pull, [real, imaginary]) in pulls.iter_mut().zip(channel.residue) {
                    pull[k] += real * re - imaginary * im;
                }
            }
        }
        for i in 0..3 {
            changed.state[i] = w.state[3 + i];
            for (slope, row) in slopes.by_state[i].iter().zip(&w.state) {
                add(&mut changed.state[3 + i], row, *slope);
            }
            for (response, pull) in slopes.by_force[i].iter().zip(&pulls) {
                add(&mut changed.state[3 + i], pull, -response);
            }
        }
        changed
    }
}

impl<const M: usize> Deviations<M> {
    #[inline(always)]
    fn plus(mut self, other: &Self, factor: f64) -> Self {
        let rows = self.state.iter_mut().zip(&other.state);
        for (row, more) in rows.chain(self.memory.iter_mut().zip(&other.memory)) {
            add(row, more, factor);
        }
        self
    }

    #[inline(always)]
    fn scale(&mut self, factor: f64) {
        for row in self.state.iter_mut().chain(&mut self.memory) {
            for entry in row {
                *entry *= factor;
            }
        }
    }
}

#[inline(always)]
fn add<const M: usize>(to: &mut [f64; M], row: &[f64; M], factor: f64) {
    for (sum, entry) in to.iter_mut().zip(row) {
        *sum += factor * entry;
    }
}

/// ż of each state of the memory, real and imaginary part in turn.
pub(crate) fn memory_rates(water: &Floating, memory: &[[f64; 2]], state: &State) -> Vec<f64> {
    let velocity = [state.vx, state.vy, state.vtheta];
    let rate = |(channel, [re, im]): (Channel<f64>, &[f64; 2])| {
        let ([p, q], driven) = (channel.pole, velocity[channel.input]);
        [p * re - q * im + driven, p * im + q * re]
    };
    water.channels().zip(memory).flat_map(rate).collect()
}

/// A bound on the rate at which the memory oscillates or decays \[1/T\].
pub(crate) fn pace_of_memory(water: &Floating) -> f64 {
    let size = |[re, im]: [f64; 2]| (re * re + im * im).sqrt();
    let poles = water.memory.iter().map(|term| size(term.pole));
    poles.fold(0.0, f64::max)
}
