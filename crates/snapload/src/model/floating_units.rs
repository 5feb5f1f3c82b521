//! Conversion of a floating body in SI units, as panel codes use them, to the engine's units and
//! axes, and back (docs/floating.md).
//!
//! In SI q = (surge, heave, pitch), z points up from the still water and pitch is positive from z
//! to x. The engine's y axis points down: (x, y, θ) = (surge, −heave, pitch), so that with D =
//! diag(1, −1, 1) matrices become D(·)D and forces D(·); θ is counter-clockwise in these axes and
//! needs no sign. Lengths are in units of L, times in sqrt(L/g), masses in M₀, forces in M₀ g, and
//! components that belong to a rotation have an additional factor L.

use crate::model::cable::Cable;
use crate::model::floating::{Excitation, Exponential, Floating};
use crate::model::mass::Matrix3;
use crate::model::state::State;

/// The signs of the engine's axes, D.
const MIRROR: [f64; 3] = [1.0, -1.0, 1.0];

/// The units of a floating body's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingUnits {
    /// L \[m\].
    pub length_m: f64,
    /// T = sqrt(L/g) \[s\].
    pub time_s: f64,
    /// M₀ \[kg\].
    pub mass_kg: f64,
    /// M₀ g \[N\].
    pub force_n: f64,
}

impl FloatingUnits {
    /// The units that follow from a length \[m\], gravity \[m/s²\] and a mass \[kg\].
    pub fn new(length_m: f64, gravity_m_s2: f64, mass_kg: f64) -> Self {
        Self {
            length_m,
            time_s: (length_m / gravity_m_s2).sqrt(),
            mass_kg,
            force_n: mass_kg * gravity_m_s2,
        }
    }

    /// The unit of velocity \[m/s\].
    pub fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }

    /// The unit of each component of a displacement: L, L and 1, with the signs of the axes.
    fn displacement(&self) -> [f64; 3] {
        [self.length_m, -self.length_m, 1.0]
    }

    /// The unit of each component of a generalised force: M₀ g, M₀ g and M₀ g L.
    fn force(&self) -> [f64; 3] {
        [self.force_n, -self.force_n, self.force_n * self.length_m]
    }

    /// D (·) D of a matrix whose entries are in units of `unit`, times a length for each rotation.
    fn matrix(&self, matrix: &Matrix3, unit: f64) -> Matrix3 {
        let lengths = [1.0, 1.0, self.length_m];
        let mut scaled = *matrix;
        for (i, row) in scaled.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry *= MIRROR[i] * MIRROR[j] / (unit * lengths[i] * lengths[j]);
            }
        }
        scaled
    }

    /// A mass matrix over (surge, heave, pitch) in kg, kg m and kg m², in the engine's units.
    pub fn mass_matrix(&self, matrix: &Matrix3) -> Matrix3 {
        self.matrix(matrix, self.mass_kg)
    }

    /// A stiffness in N/m, N and N m.
    pub fn stiffness(&self, matrix: &Matrix3) -> Matrix3 {
        self.matrix(matrix, self.mass_kg / (self.time_s * self.time_s))
    }

    /// A damping in N s/m, N s and N m s.
    pub fn damping(&self, matrix: &Matrix3) -> Matrix3 {
        self.matrix(matrix, self.mass_kg / self.time_s)
    }

    /// A generalised force in N, N and N m.
    pub fn generalised_force(&self, force: [f64; 3]) -> [f64; 3] {
        let units = self.force();
        [0, 1, 2].map(|i| force[i] / units[i])
    }

    /// The inverse of [`FloatingUnits::generalised_force`].
    pub fn generalised_force_si(&self, force: [f64; 3]) -> [f64; 3] {
        let units = self.force();
        [0, 1, 2].map(|i| force[i] * units[i])
    }

    /// The forces of the water on a body, from numbers in SI units.
    pub fn floating(&self, water: &Floating) -> Floating {
        let term = |term: &Exponential| {
            let [real, imaginary] = [0, 1]
                .map(|part| self.stiffness(&term.residue.map(|row| row.map(|entry| entry[part]))));
            Exponential {
                pole: term.pole.map(|part| part * self.time_s),
                residue: std::array::from_fn(|i| {
                    std::array::from_fn(|j| [real[i][j], imaginary[i][j]])
                }),
            }
        };
        let wave = |wave: &Excitation| Excitation {
            omega: wave.omega * self.time_s,
            cosine: self.generalised_force(wave.cosine),
            sine: self.generalised_force(wave.sine),
        };
        Floating {
            stiffness: self.stiffness(&water.stiffness),
            damping: self.damping(&water.damping),
            constant: self.generalised_force(water.constant),
            memory: water.memory.iter().map(term).collect(),
            excitation: water.excitation.iter().map(wave).collect(),
        }
    }

    /// A line from an anchor `[x, z]`, relative to the mean position of the reference point, to a
    /// fairlead in the body's frame, of a length; all in m.
    pub fn cable(&self, anchor_m: [f64; 2], fairlead_m: [f64; 2], length_m: f64) -> Cable {
        let point = |[x, z]: [f64; 2]| [x / self.length_m, -z / self.length_m];
        Cable::new(point(anchor_m), point(fairlead_m), length_m / self.length_m)
    }

    /// A displacement (m, m, rad) and its velocity (m/s, m/s, rad/s).
    pub fn state(&self, displacement: [f64; 3], velocity: [f64; 3]) -> State {
        let units = self.displacement();
        let [x, y, theta] = [0, 1, 2].map(|i| displacement[i] / units[i]);
        let [vx, vy, vtheta] = [0, 1, 2].map(|i| velocity[i] / units[i] * self.time_s);
        State {
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
        }
    }

    /// The inverse of [`FloatingUnits::state`].
    pub fn displacement_and_velocity(&self, state: &State) -> [[f64; 3]; 2] {
        let units = self.displacement();
        let (place, velocity) = (
            [state.x, state.y, state.theta],
            [state.vx, state.vy, state.vtheta],
        );
        [
            [0, 1, 2].map(|i| place[i] * units[i]),
            [0, 1, 2].map(|i| velocity[i] * units[i] / self.time_s),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mass::{dot, times};

    /// Power and energy do not depend on units and axes: v·F, v·Mv and q·Cq are unchanged.
    #[test]
    fn forces_do_the_same_work_in_either_picture() {
        let units = FloatingUnits::new(6.0, 9.81, 2.3e5);
        let (q, v) = ([0.3, -0.2, 0.1], [0.5, 0.4, -0.2]);
        let state = units.state(q, v);
        let force = [1.2e5, -3.0e4, 2.0e5];
        let matrix = [[2e5, 3e4, -5e4], [3e4, 3e5, 1e4], [-5e4, 1e4, 4e5]];
        let ours = [state.x, state.y, state.theta];
        let speed = [state.vx, state.vy, state.vtheta];
        let energy = units.force_n * units.length_m;
        let same = |ours: f64, si: f64| assert!((ours / si - 1.0).abs() < 1e-14, "{ours} {si}");
        let power = dot(speed, units.generalised_force(force));
        same(power * energy / units.time_s, dot(v, force));
        let kinetic = dot(speed, times(&units.mass_matrix(&matrix), speed));
        same(kinetic * energy, dot(v, times(&matrix, v)));
        let stiff = dot(ours, times(&units.stiffness(&matrix), ours));
        same(stiff * energy, dot(q, times(&matrix, q)));
        let lost = dot(speed, times(&units.damping(&matrix), speed));
        same(lost * energy / units.time_s, dot(v, times(&matrix, v)));
        let [back, speed_back] = units.displacement_and_velocity(&state);
        for i in 0..3 {
            assert!((back[i] - q[i]).abs() < 1e-15 && (speed_back[i] - v[i]).abs() < 1e-15);
        }
        let there = units.generalised_force_si(units.generalised_force(force));
        (0..3).for_each(|i| same(there[i], force[i]));
    }

    /// A point of the body is where pitch from z to x moves it, and at the same distance from its
    /// anchor.
    #[test]
    fn a_fairlead_goes_where_pitch_takes_it() {
        let units = FloatingUnits::new(6.0, 9.81, 2.3e5);
        let (anchor, fairlead, length) = ([6.0, -10.0], [2.0, -1.2], 9.7);
        let (q, pitch) = ([0.3, -0.2], 0.1_f64);
        let (sine, cosine) = pitch.sin_cos();
        let point = [
            q[0] + fairlead[0] * cosine + fairlead[1] * sine,
            q[1] - fairlead[0] * sine + fairlead[1] * cosine,
        ];
        let reach = (point[0] - anchor[0]).hypot(point[1] - anchor[1]);
        let cable = units.cable(anchor, fairlead, length);
        let state = units.state([q[0], q[1], pitch], [0.0; 3]);
        let gap = cable.gap(&state) * units.length_m * units.length_m;
        assert!((gap - (reach * reach - length * length)).abs() < 1e-12);
    }
}
