//! The answers as JSON.

use super::{Floating, Report};
use crate::coefficients::FREEDOMS;
use crate::error::Warning;
use crate::linear::{Mode, Natural, Response};
use crate::memory::{BlockQuality, EntryQuality, TermRow};
use nalgebra::{Complex, Matrix3, Vector3};
use serde::Serialize;
use std::f64::consts::PI;

type Rows = [[f64; 3]; 3];
type Pair = [f64; 2];

/// By rows.
pub(super) fn rows(matrix: &Matrix3<f64>) -> Rows {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

fn pairs(vector: &Vector3<Complex<f64>>) -> [Pair; 3] {
    std::array::from_fn(|i| [vector[i].re, vector[i].im])
}

/// The output of `--json`. Complex numbers are `[re, im]`, with e^{−iωt}.
#[derive(Serialize)]
pub struct Json<'a> {
    file: &'a str,
    format: String,
    freedoms: [&'static str; 3],
    water: WaterRow,
    reference_m: Pair,
    omega_rad_s: &'a [f64],
    added_mass: Vec<Rows>,
    radiation_damping: Vec<Rows>,
    excitation: Vec<ExcitationRow>,
    added_mass_inf: Rows,
    added_mass_inf_of_the_file: Option<Rows>,
    memory: Vec<TermRow>,
    added_damping: Rows,
    quality: Quality<'a>,
    floating: Option<FloatingRow>,
    warnings: &'a [Warning],
}

#[derive(Serialize)]
struct WaterRow {
    density_kg_m3: f64,
    gravity_m_s2: f64,
    /// None stands for deep water.
    depth_m: Option<f64>,
}

#[derive(Serialize)]
struct ExcitationRow {
    direction: f64,
    force: Vec<[Pair; 3]>,
}

#[derive(Serialize)]
struct Quality<'a> {
    blocks: &'a [BlockQuality],
    entries: &'a [EntryQuality],
    least_eigenvalue: f64,
    states: usize,
}

#[derive(Serialize)]
struct FloatingRow {
    mass_kg: f64,
    centre_of_gravity_m: Pair,
    /// About the centre of gravity.
    moment_of_inertia_kg_m2: f64,
    mass_matrix: Rows,
    stiffness: Rows,
    damping: Rows,
    constant_force: [f64; 3],
    natural: Vec<NaturalRow>,
    responses: Vec<ResponseRow>,
    rest: Option<RestRow>,
}

#[derive(Serialize)]
struct NaturalRow {
    freedom: &'static str,
    omega_rad_s: f64,
    period_s: f64,
    outside_the_file: bool,
    eigenvalue: Pair,
    damped_period_s: f64,
    damping_ratio: f64,
}

#[derive(Serialize)]
struct ResponseRow {
    direction: f64,
    of_the_file: Vec<[Pair; 3]>,
    of_the_memory: Vec<[Pair; 3]>,
    /// The largest response of each degree of freedom, also between the file's frequencies.
    largest: [PeakRow; 3],
}

#[derive(Serialize)]
struct PeakRow {
    freedom: &'static str,
    /// None if it is unbounded.
    amplitude: Option<f64>,
    omega_rad_s: f64,
    period_s: f64,
    /// The damping ratio of a resonance so narrow that its height depends on it.
    narrow_damping_ratio: Option<f64>,
}

#[derive(Serialize)]
struct RestRow {
    q: [f64; 3],
    taut: Vec<usize>,
    tension_n: Vec<f64>,
    slack_m: Vec<f64>,
    natural: Vec<NaturalRow>,
}

fn natural(natural: &[Natural], modes: &[Mode]) -> Vec<NaturalRow> {
    let row = |(natural, mode): (&Natural, &Mode)| NaturalRow {
        freedom: FREEDOMS[natural.freedom],
        omega_rad_s: natural.omega_rad_s,
        period_s: natural.period_s,
        outside_the_file: natural.outside,
        eigenvalue: [mode.eigenvalue.re, mode.eigenvalue.im],
        damped_period_s: mode.period_s,
        damping_ratio: mode.damping_ratio,
    };
    natural.iter().zip(modes).map(row).collect()
}

impl Floating {
    fn largest_rows(&self, response: usize) -> [PeakRow; 3] {
        let peaks = self.largest(response);
        std::array::from_fn(|freedom| {
            let (peak, narrow) = peaks[freedom];
            PeakRow {
                freedom: FREEDOMS[freedom],
                amplitude: Some(peak.amplitude).filter(|amplitude| amplitude.is_finite()),
                omega_rad_s: peak.omega_rad_s,
                period_s: 2.0 * PI / peak.omega_rad_s,
                narrow_damping_ratio: narrow,
            }
        })
    }

    fn row(&self) -> FloatingRow {
        let body = &self.body;
        let all = |response: &Response| response.amplitude.iter().map(pairs).collect();
        let responses = self.responses.iter().enumerate();
        let responses = responses.map(|(index, [file, memory])| ResponseRow {
            direction: file.direction,
            of_the_file: all(file),
            of_the_memory: all(memory),
            largest: self.largest_rows(index),
        });
        let rest = self.rest.as_ref().map(|(rest, held, modes)| RestRow {
            q: rest.q.into(),
            taut: rest.taut.iter().map(|line| line + 1).collect(),
            tension_n: rest.tension_n.clone(),
            slack_m: rest.slack_m.clone(),
            natural: natural(held, modes),
        });
        FloatingRow {
            mass_kg: body.mass_kg,
            centre_of_gravity_m: body.centre_m,
            moment_of_inertia_kg_m2: body.inertia_about_centre_kg_m2(),
            mass_matrix: rows(&body.mass),
            stiffness: rows(&body.stiffness),
            damping: rows(&body.damping),
            constant_force: body.constant_force.into(),
            natural: natural(&self.natural, &self.modes),
            responses: responses.collect(),
            rest,
        }
    }
}

impl Report {
    /// All answers, with the coefficients and the exponentials.
    pub fn to_json(&self) -> Json<'_> {
        let (hydro, fit) = (&self.reading.hydro, &self.fit);
        let excitation = hydro.excitation.iter().map(|x| ExcitationRow {
            direction: x.direction,
            force: x.force.iter().map(pairs).collect(),
        });
        Json {
            file: &self.name,
            format: self.reading.format.to_string(),
            freedoms: FREEDOMS,
            water: WaterRow {
                density_kg_m3: hydro.water.density_kg_m3,
                gravity_m_s2: hydro.water.gravity_m_s2,
                depth_m: Some(hydro.water.depth_m).filter(|depth| depth.is_finite()),
            },
            reference_m: hydro.reference_m,
            omega_rad_s: &hydro.omega_rad_s,
            added_mass: hydro.added_mass.iter().map(rows).collect(),
            radiation_damping: hydro.damping.iter().map(rows).collect(),
            excitation: excitation.collect(),
            added_mass_inf: rows(&fit.added_mass_inf),
            added_mass_inf_of_the_file: hydro.added_mass_inf.as_ref().map(rows),
            memory: fit.memory.rows(),
            added_damping: rows(&fit.memory.damping),
            quality: Quality {
                blocks: &fit.blocks,
                entries: &fit.entries,
                least_eigenvalue: fit.memory.least_eigenvalue(hydro.range_rad_s()[1]),
                states: fit.memory.states(),
            },
            floating: self.floating.as_ref().ok().map(Floating::row),
            warnings: &self.warnings,
        }
    }
}
