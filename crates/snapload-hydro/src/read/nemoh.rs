//! Nemoh's text files, as its post-processor writes them. Those that Capytaine exports in "Nemoh's
//! format" have no zones and do not say which force is in which column; its netCDF says it.
//!
//! ```text
//! RadiationCoefficients.tec    a zone for each motion; its rows are ω, and A and B of each force
//! ExcitationForce.tec          a zone for each β in degrees; its rows are ω, and |F| and arg F of each force
//! ```
//!
//! The first line of a file says what stands for ω: `w (rad/s)`, or in Nemoh v3 by choice `f (Hz)`
//! or `T (s)`. arg F is in radians. The phase is that of e^{−iωt}: at low frequency arg F1 → −π/2
//! for β = 0, and arg F3 → 0. Source: Nemoh v2, `Solver/Main.f90`, and v3, `Common/Results.f90`,
//! which write these files, and the files that come with them.

use super::fortran::number;
use super::table::{Row, Table};
use super::{Format, Given, agreed_water};
use crate::coefficients::{Hydrodynamics, Hydrostatics};
use crate::error::HydroError;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

const RADIATION: &str = "RadiationCoefficients.tec";
const EXCITATION: &str = "ExcitationForce.tec";
/// Frequencies are the same if they differ by no more than this part, as the files have seven digits.
const SAME_FREQUENCY: f64 = 1e-5;
/// The degrees of freedom of one body, all six of which are in the files.
const SIX: usize = 6;
/// The indices of surge, heave and pitch.
const PLACES: [usize; 3] = [0, 2, 4];

/// ω from a first column.
type Omega = fn(f64) -> f64;

/// What the first column may hold, as the first line of a file names it.
const FIRST_COLUMNS: [(&str, Omega); 3] = [
    ("w (rad/s)", |omega| omega),
    ("f (Hz)", |frequency| TAU * frequency),
    ("T (s)", |period| TAU / period),
];

/// A part of a file: its heading, and its rows of numbers.
struct Zone<'a> {
    heading: &'a str,
    rows: Vec<Vec<f64>>,
}

/// The coefficients of Nemoh's files, which do not contain the water, the reference point or the
/// hydrostatics.
///
/// # Errors
/// A [`HydroError`] if they can not be read, something is missing, or a value was not given.
pub fn from_nemoh(
    radiation: &str,
    excitation: &str,
    given: &Given,
) -> Result<Hydrodynamics, HydroError> {
    given.refuse_those_of_wamit(Format::Nemoh)?;
    let water = agreed_water([None; 3], given)?;
    let reference_m = given.reference_m.ok_or_else(|| {
        let advice = "Nemoh's results do not say about which point pitch turns; give it as x,z";
        HydroError::missing("the reference point", advice)
    })?;
    let name = RADIATION;
    let motions = zones(name, radiation, 1 + 2 * SIX)?;
    if motions.len() != SIX {
        let found = format!("it has {} zones", motions.len());
        let expected = "one body with its six degrees of freedom is expected, one zone for each \
                        motion; of Capytaine use the .nc file";
        return Err(HydroError::layout(name, found, expected));
    }
    let waves = zones(EXCITATION, excitation, 1 + 2 * SIX)?;
    let (directions, headed) = along_x(EXCITATION, &waves)?;
    let (first, count) = (&motions[0], motions[0].rows.len());
    for zone in &motions {
        zone.has_frequencies_of(RADIATION, first)?;
    }
    for zone in &headed {
        zone.has_frequencies_of(EXCITATION, first)?;
    }
    headed.iter().try_for_each(|wave| in_radians(wave))?;
    let table = Table {
        rows: (0..count)
            .map(|step| row(&motions, &headed, step))
            .collect(),
        directions,
        water,
        reference_m,
        crest_m: 0.0,
        hydrostatics: Hydrostatics {
            displaced_mass_kg: given.displaced_mass_kg,
            centre_of_mass_m: given.centre_of_gravity_m,
            ..Hydrostatics::default()
        },
    };
    table.into_hydrodynamics()
}

impl Zone<'_> {
    /// Checks that its rows are at the frequencies of the first zone of the radiation coefficients.
    fn has_frequencies_of(&self, name: &str, first: &Zone) -> Result<(), HydroError> {
        let heading = self.heading.trim();
        if self.rows.len() != first.rows.len() {
            let found = format!("{heading} has {} rows", self.rows.len());
            let expected = format!(
                "{} are expected, as many as in the first zone of {RADIATION}",
                first.rows.len()
            );
            return Err(HydroError::layout(name, found, expected));
        }
        let mut pairs = self.rows.iter().zip(&first.rows);
        // What is no number is another frequency, too.
        let is_same = |own: f64, first: f64| (own - first).abs() <= SAME_FREQUENCY * first.abs();
        let other = pairs.find(|(own, first)| !is_same(own[0], first[0]));
        match other {
            Some((own, first)) => {
                let found = format!("{heading} has ω = {} rad/s", own[0]);
                let expected = format!(
                    "{} is expected in that row, as in the first zone of {RADIATION}; are the files of two runs?",
                    first[0]
                );
                Err(HydroError::layout(name, found, expected))
            }
            None => Ok(()),
        }
    }
}

/// The zones of the waves to +x and −x.
fn along_x<'a, 'b>(
    name: &str,
    waves: &'b [Zone<'a>],
) -> Result<(Vec<f64>, Vec<&'b Zone<'a>>), HydroError> {
    let (mut directions, mut headed) = (Vec::new(), Vec::new());
    for wave in waves {
        if let Some(direction) = direction(wave.heading)
            && !directions.contains(&direction)
        {
            directions.push(direction);
            headed.push(wave);
        }
    }
    if directions.is_empty() {
        let headings: Vec<&str> = waves.iter().map(|wave| wave.heading).collect();
        let advice = format!("{name} has {headings:?}; beta = 0 or 180 is required");
        let what = "the excitation of waves along x";
        return Err(HydroError::missing(what, advice));
    }
    Ok((directions, headed))
}

/// Refuses phases that are no angles in radians.
fn in_radians(wave: &Zone) -> Result<(), HydroError> {
    for row in &wave.rows {
        // Fortran writes seven digits of ±2π, which may be rounded up.
        let phases = row.iter().skip(2).step_by(2);
        if let Some(phase) = phases
            .into_iter()
            .find(|phase| phase.abs() > 1.000_01 * TAU)
        {
            let what = format!("a phase in {EXCITATION} at ω = {} rad/s", row[0]);
            let expected = "−2π to 2π, in radians, is allowed; convert degrees to radians, and \
                            subtract whole turns";
            return Err(HydroError::value(what, *phase, expected));
        }
    }
    Ok(())
}

/// The values of the zones at one frequency.
fn row(motions: &[Zone], waves: &[&Zone], step: usize) -> Row {
    let entry =
        |i: usize, j: usize, part: usize| motions[PLACES[j]].rows[step][1 + 2 * PLACES[i] + part];
    let force = |wave: &&Zone| {
        let row = &wave.rows[step];
        Vector3::from_fn(|i, _| {
            let at = 1 + 2 * PLACES[i];
            Complex::from_polar(row[at], row[at + 1])
        })
    };
    Row {
        omega: motions[0].rows[step][0],
        added_mass: Matrix3::from_fn(|i, j| entry(i, j, 0)),
        damping: Matrix3::from_fn(|i, j| entry(i, j, 1)),
        excitation: waves.iter().map(force).collect(),
    }
}

/// The zones of a file, with ω in the first column. Lines before the first zone name the columns.
fn zones<'a>(name: &'static str, text: &'a str, width: usize) -> Result<Vec<Zone<'a>>, HydroError> {
    let omega = first_column(name, text)?;
    let mut zones: Vec<Zone<'a>> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        if line.trim_start().to_ascii_lowercase().starts_with("zone") {
            zones.push(Zone {
                heading: line,
                rows: Vec::new(),
            });
            continue;
        }
        let Some(zone) = zones.last_mut() else {
            continue;
        };
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(number).collect();
        match numbers {
            Some(mut numbers) if numbers.len() == width => {
                numbers[0] = omega(numbers[0]);
                zone.rows.push(numbers);
            }
            _ => {
                let found = format!("line {} is {:?}", index + 1, start_of(line));
                let expected =
                    format!("{width} numbers are expected, for one body's six degrees of freedom");
                return Err(HydroError::layout(name, found, expected));
            }
        }
    }
    Ok(zones)
}

/// What a file says of its first column.
fn first_column(name: &'static str, text: &str) -> Result<Omega, HydroError> {
    let line = text.lines().find(|line| !line.trim().is_empty());
    let line = line.unwrap_or_default();
    // VARIABLES="w (rad/s)"
    let mut quoted = line.split('"');
    let is_list = |before: &str| {
        let words: String = before.split_whitespace().collect();
        words.eq_ignore_ascii_case("variables=")
    };
    let named = match quoted.next() {
        Some(before) if is_list(before) => quoted.next(),
        _ => None,
    };
    let known = FIRST_COLUMNS
        .iter()
        .find(|(words, _)| Some(*words) == named);
    known.map(|(_, omega)| *omega).ok_or_else(|| {
        let found = format!("it begins with {:?}", start_of(line));
        let words = FIRST_COLUMNS.map(|(words, _)| format!("VARIABLES=\"{words}\""));
        let expected = format!(
            "one of {} is expected, which says what the first column holds; of Capytaine use the \
             .nc file",
            words.join(", ")
        );
        HydroError::layout(name, found, expected)
    })
}

/// As much of a line as a message shows.
fn start_of(line: &str) -> String {
    line.trim().chars().take(60).collect()
}

/// +1 or −1, if the zone's heading says `beta = 0` or 180 degrees.
fn direction(heading: &str) -> Option<f64> {
    let (_, rest) = heading.split_once("beta")?;
    let number = rest.trim_start_matches([' ', '=']);
    let end = number.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
    let degrees: f64 = number[..end.unwrap_or(number.len())].parse().ok()?;
    let turn = degrees.rem_euclid(360.0);
    if turn.min(360.0 - turn) < 1e-3 {
        Some(1.0)
    } else if (turn - 180.0).abs() < 1e-3 {
        Some(-1.0)
    } else {
        None
    }
}
