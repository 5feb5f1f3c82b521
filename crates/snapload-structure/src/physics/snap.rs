//! The tension in a snap.
//!
//! An inextensible line stops the body at once: the law of impact gives an impulse and a loss of
//! energy, but no force. A force depends on the line's elasticity and mass, which the engine does
//! not include. It is estimated from the impulses of one instant, J_i = p_i/(1 + e), without the
//! part of the rebound, and has no effect on the motion:
//!
//! ```text
//! taken:   E_i = max( J_i v_i/2,  min( J_i² w_i/2M,  Σ J_j v_j/2 ) )
//! spring:  T = T_0 + sqrt(P² + 2 k E)   the line as a spring k = EA/length that takes up the energy E
//! front:   T = u sqrt(EA μ)             the first instant: the wave that runs into a line with mass, u = 2E/J
//! peak:    T = T_0 + u sqrt(EA μ) + sqrt(P² + u² k (m + μ length)),   m = J²/2E
//! ```
//!
//! with v_i the closing speed, M/w_i the effective mass of the body along the line (w = G M⁻¹ Gᵀ in
//! the engine's units, which is 1 + s²/I of docs/model.md section 5 if the masses in all directions
//! are equal), T_0 the tension at rest, or for a line that was taut its tension before the snap. P
//! = T_0 is the load that continues to act while a slack line stretches until it carries that load;
//! a line that was taut carries it already, P = 0. A line that closes by itself takes up all of the
//! closing energy, J v/2 = M v²/2w, and stops m = M/w at u = v. Lines that close together share it
//! as they share the impulse. A line that was taut, v_i = 0, and has an impact passed on to it
//! takes up the energy that J_i alone would give it, up to the energy available.
//!
//! The spring is that of docs/structures.md, "How hard a snap pulls", under the load P, exact for a
//! mass on a spring; the front is the momentum balance of an elastic bar struck at its end (K. F.
//! Graff, *Wave Motion in Elastic Solids* (1975), section 2.4). The peak is the sum of both, with
//! the line's own mass added to the mass that it stops. Compared with the exact elastic line, fixed
//! at one end and pulled at the other by a moving mass and by a load, its error is at most 6 % if
//! the mass is three times that of the line or more, and at most −19 % and +13 % down to a tenth of
//! it. This was found by following the waves along the line in ten thousand cases (a test), with
//! the method by which S. Timoshenko & J. N. Goodier, *Theory of Elasticity*, treat the
//! longitudinal impact of bars.

use super::model_at_rest::ModelAtRest;
use crate::structure::LineSi;
use serde::{Serialize, Serializer};
use snapload::{Impact, Simulation, Step};
use std::cmp::Ordering;

/// A slower snap is the settling of the line: it is neither counted nor listed, but its tension is
/// one of those by which the line is judged \[m/s\].
pub const SLOWEST_M_S: f64 = 0.01;

/// A line snapping taut, or the impact that another line's snap passes on to a taut line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Snap {
    /// When \[s\].
    pub t_s: f64,
    /// The line, by index from 0.
    #[serde(serialize_with = "number_of_line")]
    pub line: usize,
    /// Whether the line was taut, and the snap of another was passed on to it.
    #[serde(rename = "jolt")]
    pub is_impact_while_taut: bool,
    /// Closing speed v; 0 for a line that was taut \[m/s\].
    pub speed_m_s: f64,
    /// Impulse in the line \[N s\].
    pub impulse_n_s: f64,
    /// Energy lost \[J\].
    pub energy_lost_j: f64,
    /// The effective mass m that the line stops \[kg\].
    pub effective_mass_kg: f64,
    /// The speed u of that mass \[m/s\]; v if one line snaps by itself.
    pub effective_speed_m_s: f64,
    /// Peak tension of the spring; none without a stiffness \[N\].
    pub energy_peak_n: Option<f64>,
    /// v sqrt(k M), the formula of handbooks, which leaves out the tension before and uses all of
    /// the mass that moves in heave; none without a stiffness \[N\].
    #[serde(rename = "formula_n")]
    pub handbook_n: Option<f64>,
    /// Tension of the first instant; none without stiffness and mass per length \[N\].
    #[serde(rename = "front_n")]
    pub first_instant_n: Option<f64>,
    /// Peak tension of the line with its mass, if that is known, else of the spring \[N\].
    pub peak_n: Option<f64>,
    /// The peak divided by the breaking load.
    pub utilisation: Option<f64>,
}

impl Snap {
    /// Whether it is counted and listed, and not the settling of a line: its effective speed is 1
    /// cm/s or more.
    pub fn counts(&self) -> bool {
        self.effective_speed_m_s >= SLOWEST_M_S
    }

    /// Whether it is counted among those after the transient.
    pub fn is_judged(&self, transient_s: f64) -> bool {
        self.counts() && self.t_s >= transient_s
    }

    /// The order from the softest to the hardest: by the part of the line's breaking load if that
    /// is known, else by the peak, else by the speed.
    pub fn by_hardness(&self, other: &Self) -> Ordering {
        let known = |one: Option<f64>, other: Option<f64>| match (one, other) {
            (Some(one), Some(other)) => one.total_cmp(&other),
            _ => one.is_some().cmp(&other.is_some()),
        };
        let speed = self
            .effective_speed_m_s
            .total_cmp(&other.effective_speed_m_s);
        known(self.utilisation, other.utilisation)
            .then(known(self.peak_n, other.peak_n))
            .then(speed)
    }
}

/// Lines are counted from 1 for readers, as in a case.
pub(crate) fn number_of_line<S: Serializer>(index: &usize, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_u64(*index as u64 + 1)
}

/// The snaps at the end of a step.
pub(crate) fn snaps_of_step(
    prepared: &ModelAtRest,
    simulation: &Simulation,
    step: &Step,
) -> Vec<Snap> {
    let impacts: Vec<Impact> = step.impacts().collect();
    if impacts.is_empty() {
        return Vec::new();
    }
    let held = simulation.tensions_at_end(step);
    snaps(prepared, &impacts, |line| {
        step.taut.contains(line).then(|| held[line])
    })
}

/// The snaps in the impacts of one instant. `held` are the tensions there of the cables that were
/// taut before it, in the engine's units; none for the others.
pub fn snaps(
    prepared: &ModelAtRest,
    impacts: &[Impact],
    held: impl Fn(usize) -> Option<f64>,
) -> Vec<Snap> {
    let stopping = |impact: &Impact| prepared.model.system.without_rebound(impact.impulse);
    let closing = impacts.iter().map(|i| 0.5 * stopping(i) * i.v_n).sum();
    let one = |impact: &Impact| {
        snap(
            prepared,
            impact,
            held(impact.cable),
            stopping(impact),
            closing,
        )
    };
    impacts.iter().map(one).collect()
}

/// One of them, with its J and the closing energy of all, in the engine's units.
fn snap(
    prepared: &ModelAtRest,
    impact: &Impact,
    held: Option<f64>,
    stopping: f64,
    closing: f64,
) -> Snap {
    let (system, scales) = (&prepared.model.system, &prepared.model.scales);
    let normal = system.cables[impact.cable].normal(&impact.before);
    let inverse_mass = system.body.inverse_effective_mass(&normal);
    let passed_on = (0.5 * stopping * stopping * inverse_mass).min(closing);
    let taken = (0.5 * stopping * impact.v_n).max(passed_on);
    let energy_j = taken * scales.energy_j();
    let effective_mass_kg = 0.5 * stopping * stopping / taken * scales.mass_kg;
    let effective_speed_m_s = (2.0 * energy_j / effective_mass_kg).sqrt();
    let line = &prepared.structure.lines[impact.cable];
    let [_, moving_kg] = prepared.structure.body.moving_mass_kg();
    let rest_n = prepared.rest.tension_n[impact.cable];
    let before_n = held.map_or(rest_n, |force| force * scales.force_n);
    let load_n = if held.is_some() { 0.0 } else { rest_n };
    let [energy_peak_n, first_instant_n, peak_n] = peaks(
        line,
        [before_n, load_n],
        effective_mass_kg,
        effective_speed_m_s,
    );
    Snap {
        t_s: impact.t * scales.time_s,
        line: impact.cable,
        is_impact_while_taut: held.is_some(),
        speed_m_s: impact.v_n * scales.speed_m_s(),
        impulse_n_s: impact.impulse * scales.impulse_n_s(),
        energy_lost_j: impact.energy_lost * scales.energy_j(),
        effective_mass_kg,
        effective_speed_m_s,
        energy_peak_n,
        handbook_n: line
            .spring_rate_n_m()
            .map(|rate| impact.v_n * scales.speed_m_s() * (rate * moving_kg).sqrt()),
        first_instant_n,
        peak_n,
        utilisation: peak_n
            .zip(line.breaking_load_n)
            .map(|(peak, load)| peak / load),
    }
}

/// Spring, front and peak of a line that stops a mass at a speed, with the tension before and the
/// load that continues to act. EA μ is the product of k = EA/length and the line's mass.
fn peaks(
    line: &LineSi,
    [before_n, load_n]: [f64; 2],
    stopped_kg: f64,
    speed_m_s: f64,
) -> [Option<f64>; 3] {
    let pull = |rate: f64, mass_kg: f64| speed_m_s * (rate * mass_kg).sqrt();
    let stretched = |rate: f64, mass_kg: f64| before_n + load_n.hypot(pull(rate, mass_kg));
    let rate = line.spring_rate_n_m();
    let spring = rate.map(|rate| stretched(rate, stopped_kg));
    let with_mass = rate.zip(line.mass_per_length_kg_m.map(|mass| mass * line.length_m));
    let front = with_mass.map(|(rate, mass)| pull(rate, mass));
    let bar = with_mass.map(|(rate, mass)| pull(rate, mass) + stretched(rate, stopped_kg + mass));
    [spring, front, bar.or(spring)]
}
