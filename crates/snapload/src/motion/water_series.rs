//! Taylor series of the forces of linear water on a floating body along its motion.
//!
//! With q, q̇ and the memory z known to some order, the force and ż follow to the same order
//! ([`crate::model::floating`]):
//!
//! ```text
//! F_k = f_k − C q_k − B q̇_k − Re Σ R z_k,    (k + 1) z_{k+1} = p z_k + q̇_k
//! ```
//!
//! While all cables are slack and no other force depends on the velocity, all of the motion is
//! linear with constant coefficients, y = (q, q̇, z), ẏ = L y + f(t), and the truncation error of
//! the series is bounded. The polynomials solve the equations up to a residual, which consists of
//! the orders n = [`ORDER`] − 1 and n + 1 of the forces, and of the terms of the sinusoids beyond
//! them; the error grows from it by no more than e^{‖L‖s}, so that with the norms ρ of those
//! coefficients
//! ```text
//! ‖error(s)‖ ≤ e^{‖L‖s} (ρ_n s^{n+1}/(n+1) + ρ_{n+1} s^{n+2}/(n+2) + Σ‖a_j‖ Ω_j^{n+2}/(n+2)! s^{n+3}/(n+3))
//! ```
//!
//! The norm is the largest of |q|, |q̇|/λ and ζ|z| with scales λ and ζ that make ‖L‖ small: a unit
//! of each then has about the same effect. Steps are so short that the error is below rounding, and
//! its bound is added to the rounding of the gaps.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::model::floating::{Complex, Floating};
use crate::model::mass::{Matrix3, times};
use crate::model::system::System;

/// e^x is bounded by (1 − x/n)^{−n}, 0 ≤ x < n, with n = 2^[`HALVINGS`].
const HALVINGS: usize = 4;
/// A bound larger than any motion; not infinite, as numbers of many digits have no infinity.
const UNBOUNDED: f64 = 1e300;

/// The norm in which the linear motion is bounded.
#[derive(Clone, Debug)]
struct Norm<T> {
    /// λ.
    pace: T,
    /// ζ |p| of each state of the memory, and ζ.
    poles: Vec<[T; 2]>,
    /// ‖L‖.
    growth: T,
    /// Σ ‖a_j‖ Ω_j^{n+2}/(n+2)!, a the acceleration by a sinusoid, over λ.
    sinusoids: T,
}

/// The series of the water along a motion.
#[derive(Clone, Debug)]
pub(crate) struct WaterSeries<T: Real> {
    /// The ends of the ranges of states that are driven by each component of the velocity.
    ends: [usize; 3],
    /// p, real and imaginary.
    poles: [Vec<T>; 2],
    /// The column of R, by component of the force.
    residues: [[Vec<T>; 2]; 3],
    /// z_k of all states, order by order.
    memory: [Vec<T>; 2],
    /// f_k, F_c included.
    excitation: [Polynomial<T>; 3],
    /// The coefficients of F_mem.
    pull: [Polynomial<T>; 3],
    norm: Norm<T>,
    /// ρ_n and ρ_{n+1}.
    residual: [T; 2],
}

/// A motion in the last two orders of its series.
pub(crate) struct SeriesEnd<T> {
    /// q in both orders, and q̇ in the first of them.
    pub(crate) places: [[T; 3]; 2],
    pub(crate) speed: [T; 3],
    /// The forces other than the water's.
    pub(crate) forces: [[T; 2]; 2],
}

impl<T: Real> WaterSeries<T> {
    /// Memory for the series of a body's water, and the numbers that are constant along a run.
    pub(crate) fn new(system: &System<T>, water: &Floating<T>) -> Self {
        let channels: Vec<_> = water.channels().collect();
        let up_to = |input| channels.iter().filter(|c| c.input <= input).count();
        let part = |part: usize| channels.iter().map(|c| c.pole[part]).collect();
        let column =
            |row: usize, part: usize| channels.iter().map(|c| c.residue[row][part]).collect();
        let room = vec![T::ZERO; channels.len() * (ORDER + 1)];
        Self {
            ends: [0, 1, 2].map(up_to),
            poles: [part(0), part(1)],
            residues: [0, 1, 2].map(|row| [column(row, 0), column(row, 1)]),
            memory: [room.clone(), room],
            excitation: [Polynomial::default(); 3],
            pull: [Polynomial::default(); 3],
            norm: Norm::of(system, water),
            residual: [T::ZERO; 2],
        }
    }

    /// Begins the series with this memory, and with the series of F_w + F_c.
    #[inline(always)]
    pub(crate) fn begin(&mut self, excitation: &[Polynomial<T>; 3], memory: &[Complex<T>]) {
        self.excitation = *excitation;
        self.pull = [Polynomial::default(); 3];
        let [real, imaginary] = &mut self.memory;
        for ((re, im), z) in real.iter_mut().zip(imaginary.iter_mut()).zip(memory) {
            [*re, *im] = *z;
        }
    }

    /// The k-th coefficients of the force, from those of q and q̇; also finds those of order k + 1
    /// of the memory.
    #[inline(always)]
    pub(crate) fn extend(
        &mut self,
        water: &Floating<T>,
        k: usize,
        place: [T; 3],
        velocity: [T; 3],
    ) -> [T; 3] {
        let pull = self.pull_of(k);
        self.remember(k, velocity);
        let (stiff, damped) = (
            times(&water.stiffness, place),
            times(&water.damping, velocity),
        );
        let mut force = [T::ZERO; 3];
        for i in 0..3 {
            self.pull[i][k] = pull[i];
            force[i] = self.excitation[i][k] - (stiff[i] + damped[i] + pull[i]);
        }
        force
    }

    /// Re Σ R z_k.
    #[inline(always)]
    fn pull_of(&self, k: usize) -> [T; 3] {
        let count = self.poles[0].len();
        let [re, im] = [0, 1].map(|part| &self.memory[part][k * count..][..count]);
        let mut pull = [T::ZERO; 3];
        for (pull, [real, imaginary]) in pull.iter_mut().zip(&self.residues) {
            *pull = sum_of_products(real, re) - sum_of_products(imaginary, im);
        }
        pull
    }

    /// z_{k+1} = (p z_k + q̇_k)/(k + 1).
    #[inline(always)]
    fn remember(&mut self, k: usize, velocity: [T; 3]) {
        let count = self.poles[0].len();
        let share = T::ONE / (k + 1) as f64;
        let [real, imaginary] = &mut self.memory;
        let (re, next_re) = real[k * count..][..2 * count].split_at_mut(count);
        let (im, next_im) = imaginary[k * count..][..2 * count].split_at_mut(count);
        let [pole_re, pole_im] = &self.poles;
        let mut begin = 0;
        for (end, speed) in self.ends.into_iter().zip(velocity) {
            for c in begin..end {
                let (p, q) = (pole_re[c], pole_im[c]);
                next_re[c] = p.mul_add(re[c], speed - q * im[c]) * share;
                next_im[c] = p.mul_add(im[c], q * re[c]) * share;
            }
            begin = end;
        }
    }

    /// Completes the memory once the motion is known to [`ORDER`], and finds the residual; with
    /// taut cables, only that of the memory is known.
    #[inline(always)]
    pub(crate) fn close(
        &mut self,
        system: &System<T>,
        water: &Floating<T>,
        end: &SeriesEnd<T>,
        slack: bool,
    ) {
        let [before_last, last] = end.places;
        let forces = [
            self.extend(water, ORDER - 1, before_last, end.speed),
            self.force_at_end(water, last),
        ];
        self.residual = [T::ZERO; 2];
        if slack {
            for ((residual, force), [x, y]) in self.residual.iter_mut().zip(forces).zip(end.forces)
            {
                let moved = system.body.moved_by([force[0] + x, force[1] + y, force[2]]);
                *residual = largest(moved) / self.norm.pace;
            }
        }
        let count = self.poles[0].len();
        let mut memory = T::ZERO;
        for (c, [driven, _]) in self.norm.poles.iter().enumerate() {
            let [re, im] = [0, 1].map(|part| self.memory[part][ORDER * count + c].abs());
            memory = memory.max(*driven * (re + im));
        }
        self.residual[1] = self.residual[1].max(memory);
    }

    /// The force of order [`ORDER`], for which q̇ has no coefficient.
    #[inline(always)]
    fn force_at_end(&mut self, water: &Floating<T>, place: [T; 3]) -> [T; 3] {
        let (pull, stiff) = (self.pull_of(ORDER), times(&water.stiffness, place));
        let mut force = [T::ZERO; 3];
        for i in 0..3 {
            self.pull[i][ORDER] = pull[i];
            force[i] = self.excitation[i][ORDER] - (stiff[i] + pull[i]);
        }
        force
    }

    /// A bound on the truncation error of (q, q̇/λ, ζ z) up to `s`; [`UNBOUNDED`] where `s` is too
    /// long for a bound.
    #[inline(always)]
    pub(crate) fn remainder(&self, s: T) -> T {
        let Norm {
            growth, sinusoids, ..
        } = &self.norm;
        let mut left = T::ONE - *growth * s * 0.5_f64.powi(HALVINGS as i32);
        if left <= T::ZERO {
            return T::from_f64(UNBOUNDED);
        }
        for _ in 0..HALVINGS {
            left = left * left;
        }
        let mut power = s;
        for _ in 1..ORDER {
            power = power * s;
        }
        let [first, second] = self.residual;
        let order = ORDER as f64;
        let sum = first / order + (second / (order + 1.0) + *sinusoids * s / (order + 2.0)) * s;
        sum * power / left
    }

    /// F_mem a time `s` after the start.
    #[inline(always)]
    pub(crate) fn memory_force(&self, s: T) -> [T; 3] {
        let mut force = [T::ZERO; 3];
        for (force, pull) in force.iter_mut().zip(&self.pull) {
            [*force, ..] = pull.jet(s, ORDER);
        }
        force
    }

    /// z at the start.
    #[inline(always)]
    pub(crate) fn memory_at_start(&self, into: &mut [Complex<T>]) {
        let [real, imaginary] = &self.memory;
        for ((z, re), im) in into.iter_mut().zip(real).zip(imaginary) {
            *z = [*re, *im];
        }
    }

    /// z a time `s` after the start.
    #[inline(always)]
    pub(crate) fn memory(&self, s: T, into: &mut [Complex<T>]) {
        let count = self.poles[0].len();
        for (c, z) in into.iter_mut().enumerate() {
            for (part, value) in z.iter_mut().enumerate() {
                let coefficients = self.memory[part][c..].iter().step_by(count);
                *value = coefficients
                    .rev()
                    .fold(T::ZERO, |sum, coefficient| sum.mul_add(s, *coefficient));
            }
        }
    }
}

impl<T: Real> Norm<T> {
    fn of(system: &System<T>, water: &Floating<T>) -> Self {
        let by_mass = |column: [T; 3]| system.body.moved_by(column).map(T::abs);
        let rows = |matrix: &Matrix3<T>| {
            let mut sums = [T::ZERO; 3];
            for j in 0..3 {
                for (sum, entry) in sums.iter_mut().zip(by_mass(matrix.map(|row| row[j]))) {
                    *sum += entry;
                }
            }
            sums
        };
        let (stiff, damped) = (rows(&water.stiffness), rows(&water.damping));
        let pace = largest(stiff).sqrt().max(T::ONE);
        let mut norm: Option<Self> = None;
        for share in [0.25, 0.5, 1.0, 2.0, 4.0] {
            let (mut poles, mut accelerations, mut growth) = (Vec::new(), [T::ZERO; 3], pace);
            for i in 0..3 {
                accelerations[i] = stiff[i] / pace + damped[i];
            }
            for channel in water.channels() {
                let [re, im] = channel.pole;
                let size = re.abs() + im.abs();
                // The scale of a state that hardly decays is set by the pace.
                let scale = size.max(pace * 0.0625) * share / pace;
                poles.push([size * scale, scale]);
                growth = growth.max(size + scale * pace);
                let parts = [0, 1].map(|part| by_mass(channel.residue.map(|entry| entry[part])));
                for i in 0..3 {
                    accelerations[i] += (parts[0][i] + parts[1][i]) / (scale * pace);
                }
            }
            growth = growth.max(largest(accelerations));
            if norm.as_ref().is_none_or(|norm| growth < norm.growth) {
                norm = Some(Self {
                    pace,
                    poles,
                    growth,
                    sinusoids: T::ZERO,
                });
            }
        }
        let mut norm = norm.unwrap_or(Self {
            pace,
            poles: Vec::new(),
            growth: pace,
            sinusoids: T::ZERO,
        });
        norm.sinusoids = sinusoids(system, water, pace);
        norm
    }
}

/// The terms of all sinusoids beyond the order of the series, in units of the pace.
fn sinusoids<T: Real>(system: &System<T>, water: &Floating<T>, pace: T) -> T {
    let mut sum = T::ZERO;
    for wave in &water.excitation {
        sum += derivative_of_wave(system, wave.omega, [wave.cosine, wave.sine], ORDER + 1);
    }
    sum += derivatives_of_forcing(system, ORDER + 1);
    sum / pace
}

/// Σ ‖a_j‖ Ω_j^n/n! of the sinusoids of the forcing, with the accelerations a_j by them: a bound on
/// the n-th derivative of the acceleration, over n!.
pub(crate) fn derivatives_of_forcing<T: Real>(system: &System<T>, n: usize) -> T {
    let force = |force: Vector2<T>| [force.x, force.y, T::ZERO];
    let mut sum = T::ZERO;
    for wave in &system.forcing.harmonics {
        let parts = [force(wave.cosine), force(wave.sine)];
        sum += derivative_of_wave(system, wave.omega, parts, n);
    }
    sum
}

/// The same of one sinusoid of forces and moments.
fn derivative_of_wave<T: Real>(system: &System<T>, omega: T, parts: [[T; 3]; 2], n: usize) -> T {
    let [cosine, sine] = parts.map(|part| largest(system.body.moved_by(part)));
    let mut size = cosine + sine;
    for k in 1..=n {
        size = size * omega.abs() / k as f64;
    }
    size
}

fn largest<T: Real>([x, y, theta]: [T; 3]) -> T {
    x.abs().max(y.abs()).max(theta.abs())
}

/// Σ a_i b_i, as four sums that a processor can do at once.
#[inline(always)]
fn sum_of_products<T: Real>(a: &[T], b: &[T]) -> T {
    let mut sums = [T::ZERO; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = fours.remainder().iter().zip(others.remainder());
    for (a, b) in fours.zip(others) {
        for k in 0..4 {
            sums[k] = a[k].mul_add(b[k], sums[k]);
        }
    }
    for (sum, (a, b)) in sums.iter_mut().zip(rest) {
        *sum = a.mul_add(*b, *sum);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
