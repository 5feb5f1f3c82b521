//! Reports on coefficients: in a few lines, as JSON, and as a page with pictures.

mod json;
mod page;
mod plots;
mod summary;

use json::rows;

pub use json::Json;
pub use page::page;
use summary::plain;
pub use summary::{held_summary, periods_summary};

use crate::coefficients::{Hydrodynamics, transport};
use crate::digits::kilo;
use crate::error::{HydroError, Warning};
use crate::linear::{
    Body, LARGE_PITCH, Line, Mode, Natural, Peak, Response, Rest, Weight, beyond_hydrostatics,
    far_from_the_file, fine_responses, natural_of_the_file, natural_of_the_memory,
    response_of_the_file, response_of_the_memory, rest,
};
use crate::memory::{Fit, FitOptions, TermRow, fit, given};
use crate::read::{Format, Reading};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// Below this part of critical damping a peak counts as narrow; then damping other than that of
/// waves in pitch may limit the resonance, too.
const WEAK_DAMPING: f64 = 0.02;
/// A natural motion with more than this part of its kinetic energy in pitch is one of pitch, too.
const NOTABLE_PITCH: f64 = 0.25;
/// A mass that differs from the displaced one by less than this part counts as that of the file's
/// body.
const SAME_MASS: f64 = 0.01;
/// A peak counts as a resonance if it is this close, relatively, to the frequency of a natural
/// motion.
const NEAR_RESONANCE: f64 = 0.02;
/// A peak of a freedom depends on the damping of a resonance that
/// makes up at least this part of it.
const RESONANT_PART: f64 = 0.1;
/// Damping below this part of critical bounds nothing.
const ZERO_DAMPING: f64 = 1e-6;

/// A memory that was computed before, in the form of this program's JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GivenMemory {
    /// A∞ by rows.
    pub added_mass_inf: [[f64; 3]; 3],
    /// The damping that was added where the exponentials could not be made passive, by rows.
    #[serde(default)]
    pub added_damping: [[f64; 3]; 3],
    /// The exponentials.
    pub memory: Vec<TermRow>,
    /// The reference point of all; that of the file if not given \[m\].
    pub reference_m: Option<[f64; 2]>,
}

impl GivenMemory {
    /// The same about another reference point: A∞, added damping and residues become Jᵀ(·)J.
    fn about(&self, reference_m: [f64; 2]) -> Self {
        let from = self.reference_m.unwrap_or(reference_m);
        let j = transport([0, 1].map(|axis| reference_m[axis] - from[axis]));
        let moved = |own: &[[f64; 3]; 3]| {
            let matrix = Matrix3::from_fn(|i, k| own[i][k]);
            rows(&(j.transpose() * matrix * j))
        };
        let term = |row: &TermRow| {
            let part = |at: usize| {
                let matrix = Matrix3::from_fn(|i, k| row.residue[i][k][at]);
                j.transpose() * matrix * j
            };
            let [re, im] = [part(0), part(1)];
            let entry = |i: usize| std::array::from_fn(|k| [re[(i, k)], im[(i, k)]]);
            TermRow {
                pole: row.pole,
                residue: std::array::from_fn(entry),
            }
        };
        Self {
            added_mass_inf: moved(&self.added_mass_inf),
            added_damping: moved(&self.added_damping),
            memory: self.memory.iter().map(term).collect(),
            reference_m: Some(reference_m),
        }
    }
}

/// The options of a report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// The body's weight; values that are not given are the file's.
    pub weight: Weight,
    /// Linear damping of each degree of freedom in addition to that of waves \[N s/m, N s/m, N m
    /// s\].
    pub damping: [f64; 3],
    /// A constant force in addition to weight and buoyancy \[N, N, N m\].
    pub force: [f64; 3],
    /// Lines.
    pub lines: Vec<Line>,
    /// How the memory is fitted.
    pub fit: FitOptions,
    /// The memory, if it is given and not fitted.
    pub memory: Option<GivenMemory>,
}

/// The answers that need the body's weight and stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct Floating {
    /// The body.
    pub body: Body,
    /// Natural motions without lines, by the file.
    pub natural: Vec<Natural>,
    /// The same by the exponentials.
    pub modes: Vec<Mode>,
    /// Response to waves for each direction, by the file and by the exponentials.
    pub responses: Vec<[Response; 2]>,
    /// The same also between the file's frequencies, with as many points as the peaks need.
    pub fine: Vec<[Response; 2]>,
    /// Rest on lines with the small motions about it, if there are lines.
    pub rest: Option<(Rest, Vec<Natural>, Vec<Mode>)>,
}

/// All results of a report.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The name of the file.
    pub name: String,
    /// The coefficients.
    pub reading: Reading,
    /// The memory.
    pub fit: Fit,
    /// The answers that need weight and stiffness, or why there are none.
    pub floating: Result<Floating, HydroError>,
    /// Warnings about the file, the fit and the answers.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// Fits the memory and computes the answers.
    ///
    /// # Errors
    /// A [`HydroError`] if no memory is found, or lines and weights are not possible. If a file
    /// lacks weight or stiffness, only the answers that do not need them are given.
    pub fn new(name: &str, reading: Reading, request: &Request) -> Result<Self, HydroError> {
        let hydro = &reading.hydro;
        let fit = match (&request.memory, reading.format) {
            (Some(memory), _) => {
                let memory = memory.about(hydro.reference_m);
                let [inf, damping] = [memory.added_mass_inf, memory.added_damping];
                given(hydro, inf, damping, &memory.memory)?
            }
            (None, Format::Section) => {
                let inf = rows(&hydro.added_mass[0]);
                let no_damping = [[0.0; 3]; 3];
                given(hydro, inf, no_damping, &[])?
            }
            (None, _) => fit(hydro, request.fit)?,
        };
        let floating = match Body::new(&reading.hydro, &request.weight) {
            Ok(body) => Ok(Floating::new(&reading, &fit, body, request)?),
            Err(error @ HydroError::Missing { .. }) if request.lines.is_empty() => Err(error),
            Err(error) => return Err(error),
        };
        let mut warnings = reading.warnings.clone();
        warnings.extend(fit.warnings.clone());
        if let Ok(floating) = &floating {
            warnings.extend(inertia_mismatch_warning(&reading, &floating.body, request));
            floating.warn(&reading, &mut warnings);
        }
        Ok(Self {
            name: name.to_owned(),
            reading,
            fit,
            floating,
            warnings,
        })
    }
}

/// A warning if the mass or the centre of gravity is the user's, but the moment of inertia is still
/// that of the file's body.
fn inertia_mismatch_warning(reading: &Reading, body: &Body, request: &Request) -> Option<Warning> {
    let statics = &reading.hydro.hydrostatics;
    if request.weight.inertia_kg_m2.is_some() {
        return None;
    }
    let displaced = statics.displaced_mass_kg;
    let heavier = displaced.filter(|file| (file / body.mass_kg - 1.0).abs() > SAME_MASS);
    let moved = statics
        .centre_of_mass_m
        .filter(|file| *file != body.centre_m);
    let what = match (heavier, moved) {
        (Some(displaced), _) => format!(
            "the mass is {} t, the file's body displaces {} t",
            kilo(&body.mass_kg, 1),
            kilo(&displaced, 1)
        ),
        (None, Some([x, z])) => format!("the centre of gravity is not the file's, ({x}, {z}) m"),
        (None, None) => return None,
    };
    let message = format!(
        "{what}, but the moment of inertia is still that of the file, {} t m² about the centre of \
         gravity: give the body's own (--inertia; body.moment_of_inertia in a case)",
        kilo(&body.inertia_about_centre_kg_m2(), 1)
    );
    Some(Warning::new("moment of inertia", message))
}

/// Refuses anchors below the floor.
fn check_anchors(hydro: &Hydrodynamics, lines: &[Line]) -> Result<(), HydroError> {
    let depth = hydro.water.depth_m;
    let mut numbered = (1..).zip(lines);
    match numbered.find(|(_, line)| line.anchor_m[1] < -depth) {
        None => Ok(()),
        Some((number, line)) => {
            let what = format!("z of the anchor of line {number}");
            let allowed = format!("an anchor is on the floor or above it, z >= {}", -depth);
            Err(HydroError::value(what, line.anchor_m[1], allowed))
        }
    }
}

impl Floating {
    fn new(
        reading: &Reading,
        fit: &Fit,
        body: Body,
        request: &Request,
    ) -> Result<Self, HydroError> {
        let hydro = &reading.hydro;
        let body = body.loaded(hydro, request.damping, request.force)?;
        let (memory, inf) = (&fit.memory, &fit.added_mass_inf);
        let free = body.afloat();
        let natural = natural_of_the_file(hydro, &free)?;
        let modes = natural_of_the_memory(&free, memory, inf, &natural)?;
        let own = natural.iter().map(|natural| natural.omega_rad_s);
        let damped = modes.iter().map(|mode| mode.eigenvalue.norm());
        let frequencies: Vec<f64> = own.chain(damped).collect();
        let (mut responses, mut fine) = (Vec::new(), Vec::new());
        for excitation in &hydro.excitation {
            let direction = excitation.direction;
            responses.push([
                response_of_the_file(hydro, &free, direction)?,
                response_of_the_memory(hydro, &free, memory, inf, direction)?,
            ]);
            let exponentials = (memory, inf);
            let close = fine_responses(hydro, &free, exponentials, direction, &frequencies)?;
            fine.push(close);
        }
        let rest = match request.lines.is_empty() {
            true => None,
            false => {
                check_anchors(hydro, &request.lines)?;
                let place = rest(hydro, &body, &request.lines)?;
                let (natural, modes) = place.natural(hydro, &body, memory, inf)?;
                Some((place, natural, modes))
            }
        };
        Ok(Self {
            body,
            natural,
            modes,
            responses,
            fine,
            rest,
        })
    }

    /// The largest response of each degree of freedom in waves of a direction, by the file's
    /// coefficients, with the damping ratio if the peak is a narrow resonance.
    pub fn largest(&self, response: usize) -> [(Peak, Option<f64>); 3] {
        let response = &self.fine[response][0];
        let peaks = response.peaks();
        std::array::from_fn(|i| {
            let peak = peaks[i];
            let mut points = response.omega_rad_s.iter().zip(&response.amplitude);
            let there = points.find(|(omega, _)| **omega == peak.omega_rad_s);
            let there = there.map(|(_, xi)| xi);
            let resonates = |(natural, mode): &(&Natural, &Mode)| {
                let omega = mode.eigenvalue.norm();
                let near = (peak.omega_rad_s / omega - 1.0).abs() < NEAR_RESONANCE;
                // The body resonates in the shape of its natural motion, in whose main freedom all
                // of the response may be resonance.
                let own = natural.shape[i] / natural.shape[natural.freedom];
                let part = there.map_or(0.0, |xi| own.abs() * xi[natural.freedom].norm());
                mode.damping_ratio < WEAK_DAMPING && near && part > RESONANT_PART * peak.amplitude
            };
            let mut both = self.natural.iter().zip(&self.modes);
            let narrow = both.find(resonates).map(|(_, mode)| mode.damping_ratio);
            let bounded = narrow.is_none_or(|ratio| ratio > ZERO_DAMPING);
            let amplitude = if bounded {
                peak.amplitude
            } else {
                f64::INFINITY
            };
            (Peak { amplitude, ..peak }, narrow)
        })
    }

    /// The part of pitch in the kinetic energy of a natural motion of the dry body about its centre
    /// of gravity.
    fn pitch_part(&self, natural: &Natural) -> f64 {
        let [surge, heave, pitch] = natural.shape.into();
        let turning = self.body.inertia_about_centre_kg_m2() * pitch * pitch;
        let moving = self.body.mass_kg * (surge * surge + heave * heave);
        if natural.freedom == 2 {
            1.0
        } else {
            turning / (turning + moving)
        }
    }

    /// The warning that the body does not float upright without lines, if none are given.
    fn balance_warning(&self) -> Option<Warning> {
        let pitch = self.body.unbalanced_pitch();
        let pitch = pitch.filter(|_| self.rest.is_none())?;
        let degrees = pitch.to_degrees();
        let floats = match degrees.abs() > LARGE_PITCH {
            true => format!("turns by more than {LARGE_PITCH}°, if not over"),
            false => format!("floats at {degrees:.1}° of pitch"),
        };
        let message = format!(
            "without lines the body {floats}, but its periods and response without lines are those of the upright \
             body: check its centre of gravity and its constant loads"
        );
        Some(Warning::new("balance", message))
    }

    fn warn(&self, reading: &Reading, warnings: &mut Vec<Warning>) {
        let [low, high] = reading.hydro.range_rad_s();
        let held = self.rest.iter().flat_map(|(_, natural, _)| natural);
        for natural in self
            .natural
            .iter()
            .chain(held)
            .filter(|natural| natural.outside)
        {
            let message = format!(
                "a natural period of {:.2} s lies outside the file's frequencies, {low:.3} to \
                 {high:.3} rad/s; compute frequencies around it",
                natural.period_s
            );
            warnings.push(Warning::new("natural periods", message));
        }
        let righting = self.body.righting_n_m();
        if righting <= 0.0 {
            let message = format!(
                "the stiffness in pitch with heave free is {} kN m: without lines the body turns over, and its response \
                 in pitch has no meaning; lower its centre of gravity, or hold it by lines",
                kilo(&righting, 1)
            );
            warnings.push(Warning::new("stability", message));
        }
        warnings.extend(self.balance_warning());
        for (natural, mode) in self.natural.iter().zip(&self.modes) {
            let weak = mode.damping_ratio < WEAK_DAMPING && self.body.damping[(2, 2)] == 0.0;
            if weak && self.pitch_part(natural) > NOTABLE_PITCH {
                let what = match natural.freedom {
                    2 => "pitch".to_owned(),
                    _ => format!(
                        "the motion of {:.2} s, in which it pitches,",
                        natural.period_s
                    ),
                };
                let message = format!(
                    "waves damp {what} only by {:.1} % of critical, and no other damping was given: \
                     without more damping its resonance is not reliable",
                    plain(100.0 * mode.damping_ratio, 0.1)
                );
                warnings.push(Warning::new("pitch", message));
            }
        }
        if let Some((rest, ..)) = &self.rest {
            warnings.extend(far_from_the_file(
                &reading.hydro,
                &self.body,
                rest.q.into(),
                "rests",
            ));
            warnings.extend(beyond_hydrostatics(&reading.hydro, &self.body, rest));
        }
    }
}
