//! The forces of linear water on a floating body, besides its added mass (docs/floating.md).
//!
//! ```text
//! M q̈ = F_w(t) + F_c − C q − B q̇ − F_mem,    F_mem = ∫₀ᵗ K(t − τ) q̇(τ) dτ,    q = (x, y, θ)
//! ```
//!
//! The memory of the waves that the body has made is a sum of exponentials, K(t) = Re Σ R_k e^{p_k
//! t}, so that it is a linear system coupled to the motion: one complex state z for each pole and
//! each component of the velocity for which its residue is not zero,
//!
//! ```text
//! ż_k = p_k z_k + q̇,    z_k = 0 at the start,    F_mem = Re Σ R_k z_k
//! ```
//!
//! An impact changes q̇ at once, and neither q nor z. Sources: W. E. Cummins, *Schiffstechnik* 9
//! (1962) 101; a linear system in place of the convolution, E. Kristiansen, Å. Hjulstad and O.
//! Egeland, *Ocean Engineering* 32 (2005) 2195.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::model::mass::{Matrix3, dot, times};
use crate::model::state::State;

/// A complex number, as its real and its imaginary part.
pub type Complex<T = f64> = [T; 2];

/// One term of the memory, Re R e^{pt}; a term with a complex pole stands for itself and its
/// conjugate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential<T = f64> {
    /// p; its real part is negative \[1/T\].
    pub pole: Complex<T>,
    /// R, symmetric: force by row, motion by column \[m/T² and with a length for each rotation\].
    pub residue: Matrix3<Complex<T>>,
}

/// A generalised force of one frequency, f(t) = c cos Ωt + d sin Ωt over (x, y, θ), each component
/// with a phase of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excitation<T = f64> {
    /// Ω \[1/T\].
    pub omega: T,
    /// c \[F, F, F L\].
    pub cosine: [T; 3],
    /// d.
    pub sine: [T; 3],
}

/// All forces on a floating body except those of its cables, for a motion q = (x, y, θ) about the
/// position for which the water's forces were computed.
///
/// ```
/// use snapload::{Body, Excitation, Floating, FloatingUnits, Forcing, Rules, Shape, Simulation, State, System};
///
/// // A box of 238 t with its added mass, heave stiffness 804 kN/m, on one line; waves push with
/// // 400 kN. Where the line comes taut again, it snaps.
/// let units = FloatingUnits::new(10.0, 9.81, 238e3);
/// let mass = [[1.03e5, 0.0, -2.1e4], [0.0, 2.38e5, 0.0], [-2.1e4, 0.0, 2.1e5]];
/// let water = Floating {
///     stiffness: [[0.0; 3], [0.0, 8.04e5, 0.0], [0.0, 0.0, 6.5e5]],
///     constant: [0.0, 1.8e5, 0.0],
///     excitation: vec![Excitation::of_amplitudes(1.26, [[0.0, -6e4], [4e5, 0.0], [0.0, 0.0]])],
///     ..Floating::default()
/// };
/// let system = System {
///     body: Body::with_mass_matrix(Shape::Point, units.mass_matrix(&mass)).expect("positive definite"),
///     cables: vec![units.cable([0.0, -10.0], [0.0, -1.2], 8.8)],
///     forcing: Forcing::default(),
///     drag: None,
///     floating: Some(units.floating(&water)),
///     restitution: 0.2,
/// };
/// let rules = Rules { v_stick: 1e-6, ..Rules::until(20.0) };
/// let mut simulation = Simulation::new(system, rules, 0.0, State::default())?;
/// let mut snaps = 0;
/// while let Some(step) = simulation.step() {
///     for snap in step.impacts() {
///         println!("{:.3} s: {:.3} m/s", snap.t * units.time_s, snap.v_n * units.speed_m_s());
///         snaps += 1;
///     }
/// }
/// assert!(snaps > 0);
/// # Ok::<(), snapload::StartError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Floating<T = f64> {
    /// C, the hydrostatic stiffness, symmetric.
    pub stiffness: Matrix3<T>,
    /// B, linear damping in addition to that of the memory.
    pub damping: Matrix3<T>,
    /// F_c: weight and buoyancy at the mean position, current, mean drift.
    pub constant: [T; 3],
    /// The memory K; empty if the body makes no waves.
    pub memory: Vec<Exponential<T>>,
    /// F_w.
    pub excitation: Vec<Excitation<T>>,
}

/// One state of the memory, ż = p z + q̇_i, and its force, Re r z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel<T> {
    pub(crate) pole: Complex<T>,
    /// i: the component of the velocity that drives it.
    pub(crate) input: usize,
    /// r: the corresponding column of the residue.
    pub(crate) residue: [Complex<T>; 3],
}

impl<T: Real> Channel<T> {
    /// ż.
    #[inline(always)]
    pub(crate) fn rate(&self, state: &State<T>, [re, im]: Complex<T>) -> Complex<T> {
        let [pole_re, pole_im] = self.pole;
        let velocity = [state.vx, state.vy, state.vtheta][self.input];
        [
            pole_re * re - pole_im * im + velocity,
            pole_re * im + pole_im * re,
        ]
    }

    /// Adds Re r z to a force.
    #[inline(always)]
    pub(crate) fn add_force(&self, [re, im]: Complex<T>, force: &mut [T; 3]) {
        for (force, [real, imaginary]) in force.iter_mut().zip(self.residue) {
            *force += real * re - imaginary * im;
        }
    }
}

impl<T: Real> Excitation<T> {
    /// Re(X e^{−iΩt}), as panel codes give it: c = Re X and d = Im X.
    pub fn of_amplitudes(omega: T, amplitudes: [Complex<T>; 3]) -> Self {
        Self {
            omega,
            cosine: amplitudes.map(|[re, _]| re),
            sine: amplitudes.map(|[_, im]| im),
        }
    }

    /// The same force seen from t0: f(t0 + s) = c' cos Ωs + d' sin Ωs.
    #[inline(always)]
    pub(crate) fn shifted(&self, t0: T) -> Self {
        let (s, c) = (self.omega * t0).sin_cos();
        let mut local = *self;
        for i in 0..3 {
            local.cosine[i] = s.mul_add(self.sine[i], c * self.cosine[i]);
            local.sine[i] = c.mul_add(self.sine[i], -(s * self.cosine[i]));
        }
        local
    }

    /// Adds its Taylor series about time `t`: even orders are the cosine's, odd ones the sine's.
    #[inline(always)]
    pub(crate) fn expand(&self, t: T, into: &mut [Polynomial<T>; 3]) {
        let mut powers = [T::ONE; ORDER + 1];
        let mut power = T::ONE;
        for (k, entry) in powers.iter_mut().enumerate() {
            *entry = if k % 4 < 2 { power } else { -power };
            power = power * self.omega / (k + 1) as f64;
        }
        let local = self.shifted(t);
        for (i, series) in into.iter_mut().enumerate() {
            series.add_alternating(&powers, local.cosine[i], local.sine[i]);
        }
    }

    fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Excitation<U> {
        Excitation {
            omega: number(self.omega),
            cosine: self.cosine.map(number),
            sine: self.sine.map(number),
        }
    }
}

impl<T: Real> Floating<T> {
    /// The same in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Floating<U> {
        let complex = |z: Complex<T>| z.map(number);
        let term = |term: &Exponential<T>| Exponential {
            pole: complex(term.pole),
            residue: term.residue.map(|row| row.map(complex)),
        };
        let matrix = |matrix: &Matrix3<T>| matrix.map(|row| row.map(number));
        Floating {
            stiffness: matrix(&self.stiffness),
            damping: matrix(&self.damping),
            constant: self.constant.map(number),
            memory: self.memory.iter().map(term).collect(),
            excitation: self
                .excitation
                .iter()
                .map(|wave| wave.map(number))
                .collect(),
        }
    }

    /// The states of the memory, ordered by the component of the velocity. Columns that are zero
    /// have none.
    #[inline(always)]
    pub(crate) fn channels(&self) -> impl Iterator<Item = Channel<T>> + '_ {
        (0..3).flat_map(move |input| {
            self.memory.iter().filter_map(move |term| {
                let residue = term.residue.map(|row| row[input]);
                let answers = residue.as_flattened().iter().any(|part| *part != T::ZERO);
                answers.then_some(Channel {
                    pole: term.pole,
                    input,
                    residue,
                })
            })
        })
    }

    /// The memory of water that has been at rest: a zero for each of its states.
    pub(crate) fn at_rest(&self) -> Vec<Complex<T>> {
        self.channels().map(|_| [T::ZERO; 2]).collect()
    }

    /// F_mem = Re Σ R z.
    #[inline(always)]
    pub(crate) fn memory_force(&self, memory: &[Complex<T>]) -> [T; 3] {
        let mut force = [T::ZERO; 3];
        for (channel, z) in self.channels().zip(memory) {
            channel.add_force(*z, &mut force);
        }
        force
    }

    /// F_w + F_c at a time.
    #[inline(always)]
    pub(crate) fn excitation_at(&self, t: T) -> [T; 3] {
        let mut force = self.constant;
        for wave in &self.excitation {
            let now = wave.shifted(t).cosine;
            for i in 0..3 {
                force[i] += now[i];
            }
        }
        force
    }

    /// Its total force, given the force of waves and constant force together, and the force of the
    /// memory.
    #[inline(always)]
    pub(crate) fn force(
        &self,
        excitation: [T; 3],
        state: &State<T>,
        memory_force: [T; 3],
    ) -> [T; 3] {
        let place = [state.x, state.y, state.theta];
        let (stiff, damped) = (
            times(&self.stiffness, place),
            times(&self.damping, [state.vx, state.vy, state.vtheta]),
        );
        let mut force = excitation;
        for (i, force) in force.iter_mut().enumerate() {
            *force -= stiff[i] + damped[i] + memory_force[i];
        }
        force
    }

    /// qᵀ C q/2 − F_cᵀ q.
    pub(crate) fn potential_energy(&self, state: &State<T>) -> T {
        let place = [state.x, state.y, state.theta];
        dot(place, times(&self.stiffness, place)) * 0.5 - dot(self.constant, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_is_the_sum_of_its_parts() {
        let mut residue = [[[0.0; 2]; 3]; 3];
        (residue[1][1], residue[0][2], residue[2][0]) = ([2.0, 1.0], [0.5, 0.0], [0.5, 0.0]);
        let term = Exponential {
            pole: [-0.3, 1.1],
            residue,
        };
        let (omega, t) = (0.9_f64, 1.7_f64);
        let water = Floating {
            stiffness: [[0.0; 3], [0.0, 3.0, 0.2], [0.0, 0.2, 0.7]],
            damping: [[0.1, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            constant: [0.0, -0.4, 0.05],
            memory: vec![term],
            excitation: vec![Excitation::of_amplitudes(
                omega,
                [[0.3, -0.2], [0.1, 0.4], [0.0, 0.05]],
            )],
        };
        let channels: Vec<_> = water.channels().map(|channel| channel.input).collect();
        assert_eq!(channels, [0, 1, 2]);
        let memory = [[1.0, 9.0], [0.2, 0.3], [4.0, 9.0]];
        let pull = water.memory_force(&memory);
        assert!((pull[0] - 0.5 * 4.0).abs() < 1e-15);
        assert!((pull[1] - (2.0 * 0.2 - 0.3)).abs() < 1e-15);
        let state = State {
            y: 0.3,
            theta: -0.1,
            vx: 2.0,
            ..State::default()
        };
        let force = water.force(water.excitation_at(t), &state, pull);
        let (s, c) = (omega * t).sin_cos();
        let known = [
            0.3 * c - 0.2 * s - 0.2 - 2.0,
            -0.4 + 0.1 * c + 0.4 * s - (0.9 - 0.02) - pull[1],
            0.05 + 0.05 * s - (0.06 - 0.07) - 0.5,
        ];
        for (ours, known) in force.into_iter().zip(known) {
            assert!((ours - known).abs() < 1e-14, "{ours} {known}");
        }
        let energy = water.potential_energy(&state);
        let quadratic = 0.5 * (3.0 * 0.09 - 2.0 * 0.2 * 0.03 + 0.7 * 0.01);
        assert!((energy - (quadratic + 0.4 * 0.3 + 0.005)).abs() < 1e-15);
    }
}
