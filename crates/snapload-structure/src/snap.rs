//! How hard a snap pulls.
//!
//! An inextensible line stops the body at once: the law of impact gives an impulse and a loss of energy, never a force.
//! A force needs what the engine leaves out, the line's elasticity or its mass. Two estimates are made, and neither
//! enters the motion:
//!
//! ```text
//! energy:  T = T_0 + v sqrt(k M/w)     the line as a spring k that takes up the energy of the closing motion
//! front:   T = v sqrt(EA μ)            the first instant: the wave that runs into a line with mass
//! ```
//!
//! with v the closing speed, M/w the effective mass of the body along the line (w = 1 + s²/I of docs/model.md section
//! 5, in the engine's units), T_0 the tension at rest. The first is docs/model.md section 10; the second is the momentum
//! balance of an elastic bar struck at its end (K. F. Graff, *Wave Motion in Elastic Solids* (1975), section 2.4), whose
//! front is lower than the spring's peak as long as the line weighs less than the body.

use crate::equilibrium::Equilibrium;
use crate::model::{Model, Scales};
use crate::structure::Structure;
use snapload::{Impact, System};

/// A slower snap is the line settling down, not a load: it is neither counted nor listed \[m/s\].
pub const SLOWEST_M_S: f64 = 0.01;

/// A line snapping taut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// When \[s\].
    pub t_s: f64,
    /// The line, by index from 0.
    pub line: usize,
    /// Closing speed v \[m/s\].
    pub speed_m_s: f64,
    /// Impulse in the line \[N s\].
    pub impulse_n_s: f64,
    /// Energy lost \[J\].
    pub energy_lost_j: f64,
    /// What the line has to stop, M/w \[kg\].
    pub effective_mass_kg: f64,
    /// Peak tension by energy; none without a stiffness \[N\].
    pub energy_peak_n: Option<f64>,
    /// Tension of the first instant; none without stiffness and mass per length \[N\].
    pub front_n: Option<f64>,
    /// The larger of the two over the breaking load.
    pub utilisation: Option<f64>,
}

/// Turns impacts of the engine into snaps.
#[derive(Clone, Debug)]
pub struct SnapLaw {
    scales: Scales,
    lines: Vec<LineLaw>,
}

#[derive(Clone, Debug)]
struct LineLaw {
    spring_rate_n_m: Option<f64>,
    /// sqrt(EA μ) \[N s/m\].
    impedance_n_s_m: Option<f64>,
    breaking_load_n: Option<f64>,
    rest_tension_n: f64,
}

impl SnapLaw {
    /// For a structure, its place of rest and its model.
    pub fn new(structure: &Structure, rest: &Equilibrium, model: &Model) -> Self {
        let lines = structure.lines.iter().zip(&rest.tension_n);
        Self {
            scales: model.scales,
            lines: lines
                .map(|(line, tension)| LineLaw {
                    spring_rate_n_m: line.spring_rate_n_m(),
                    impedance_n_s_m: line
                        .stiffness_n
                        .zip(line.mass_per_length_kg_m)
                        .map(|(stiffness, mass)| (stiffness * mass).sqrt()),
                    breaking_load_n: line.breaking_load_n,
                    rest_tension_n: *tension,
                })
                .collect(),
        }
    }

    /// The snap that an impact is.
    pub fn snap(&self, system: &System, impact: &Impact) -> Snap {
        let normal = system.cables[impact.cable].normal(&impact.before);
        let inverse_mass = normal.coupling(&normal, system.body.inverse_inertia());
        let speed_m_s = impact.v_n * self.scales.speed_m_s();
        let effective_mass_kg = self.scales.mass_kg / inverse_mass;
        let law = &self.lines[impact.cable];
        let energy_peak_n = law
            .spring_rate_n_m
            .map(|rate| law.rest_tension_n + speed_m_s * (rate * effective_mass_kg).sqrt());
        let front_n = law.impedance_n_s_m.map(|impedance| speed_m_s * impedance);
        let peak = match (energy_peak_n, front_n) {
            (Some(energy), Some(front)) => Some(f64::max(energy, front)),
            (energy, front) => energy.or(front),
        };
        Snap {
            t_s: impact.t * self.scales.time_s,
            line: impact.cable,
            speed_m_s,
            impulse_n_s: impact.impulse * self.scales.impulse_n_s(),
            energy_lost_j: impact.energy_lost * self.scales.energy_j(),
            effective_mass_kg,
            energy_peak_n,
            front_n,
            utilisation: peak
                .zip(law.breaking_load_n)
                .map(|(peak, load)| peak / load),
        }
    }
}

impl Snap {
    /// The larger of the two estimates \[N\].
    pub fn peak_n(&self) -> Option<f64> {
        match (self.energy_peak_n, self.front_n) {
            (Some(energy), Some(front)) => Some(energy.max(front)),
            (energy, front) => energy.or(front),
        }
    }

    /// Whether it is a load, and not a line that settles down.
    pub fn counts(&self) -> bool {
        self.speed_m_s >= SLOWEST_M_S
    }
}
