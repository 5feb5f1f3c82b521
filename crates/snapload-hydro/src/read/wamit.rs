//! WAMIT's text files: time goes as e^{+iωt}, so that X = conj(RE + i IM).
//!
//! ```text
//! .1    PER I J Ā [B̄]                    A = ρ L^k Ā, B = ρ L^k ω B̄, k = 3, 4, 5 for no, one, two rotations
//! .3 .2 PER BETA I MOD PHA RE IM         X = ρ g L^m conj(RE + i IM), m = 2 for I = 1-3, 3 for 4-6
//! ```
//!
//! BETA and PHA are degrees. PER < 0 stands for zero frequency, PER = 0 for infinite frequency,
//! where the first column holds periods. Source: WAMIT user manual, chapter "Output files".

use super::table::{Row, Table};
use super::wamit_hydrostatics::hydrostatics;
use super::wamit_text::{MODES, Units, differ, lines, mode, place, rotation, twice};
use super::{Given, agreed_water, within};
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::PI;

/// The text of the files.
#[derive(Clone, Debug, Default)]
pub struct WamitText {
    /// `.1`.
    pub radiation: String,
    /// `.3`, or `.2`.
    pub excitation: String,
    /// `.hst`, if there is one.
    pub hydrostatics: Option<String>,
}

/// The coefficients of WAMIT's files. ρ, g, the depth and the reference point are not in them.
///
/// # Errors
/// A [`HydroError`] if a line can not be read, something is missing, or a value was not given.
pub fn from_wamit(files: &WamitText, given: &Given) -> Result<Hydrodynamics, HydroError> {
    let water = agreed_water([None; 3], given)?;
    let length = given.unit_length_m.ok_or_else(|| {
        let advice = "WAMIT's files are in multiples of it; give it, 1 if the model is in metres";
        HydroError::missing("the unit of length (ULEN)", advice)
    })?;
    let units = Units {
        water,
        length: within("the unit of length", length, 1e-6..=1e6)?,
        first: given.first_column.unwrap_or_default(),
    };
    let reference_m = given.reference_m.ok_or_else(|| {
        let advice = "WAMIT's files do not say where the body's origin is; give it as x,z";
        HydroError::missing("the reference point", advice)
    })?;
    let mut rows = radiation(&files.radiation, &units)?;
    let directions = excitation(&files.excitation, &units, &mut rows)?;
    let table = Table {
        rows,
        directions,
        water,
        reference_m,
        crest_m: 0.0,
        hydrostatics: hydrostatics(files.hydrostatics.as_deref(), &units, given)?,
    };
    table.into_hydrodynamics()
}

/// The values at one value of PER, and which of them the file has.
struct Step {
    per: f64,
    has: Matrix3<bool>,
    row: Row,
}

fn radiation(text: &str, units: &Units) -> Result<Vec<Row>, HydroError> {
    let name = "the .1 file";
    let mut steps: Vec<Step> = Vec::new();
    for line in lines(name, text, 4..=5) {
        let (number, line) = line?;
        let (force, motion) = (mode(name, line[1])?, mode(name, line[2])?);
        let omega = units.omega(line[0]);
        let (Some(i), Some(j)) = (place(force), place(motion)) else {
            continue;
        };
        let Step { has, row, .. } = step_at(&mut steps, omega, line[0]);
        let scale = units.water.density_kg_m3 * units.power(3 + rotation(force) + rotation(motion));
        let before = [row.added_mass[(i, j)], row.damping[(i, j)]];
        row.added_mass[(i, j)] = scale * line[3];
        match line.get(4) {
            Some(damping) => row.damping[(i, j)] = scale * omega * damping,
            None if omega == 0.0 || omega.is_infinite() => {}
            None => {
                let found = format!("line {number} has no damping");
                let expected = "PER I J A B is expected, also where the first column holds no periods; \
                                is the file cut off?";
                return Err(HydroError::layout(name, found, expected));
            }
        }
        if has[(i, j)] && differ(&before, &[row.added_mass[(i, j)], row.damping[(i, j)]]) {
            return Err(twice(
                name,
                format!("{force},{motion} at PER = {}", line[0]),
            ));
        }
        has[(i, j)] = true;
    }
    complete(&mut steps)?;
    Ok(steps.into_iter().map(|step| step.row).collect())
}

/// The step of a frequency, which is added without values if it is new.
fn step_at(steps: &mut Vec<Step>, omega: f64, per: f64) -> &mut Step {
    // Files are ordered by frequency, so that it is nearly always the last one.
    let at = steps.iter().rposition(|step| step.row.omega == omega);
    let at = at.unwrap_or_else(|| {
        let row = Row {
            omega,
            added_mass: Matrix3::zeros(),
            damping: Matrix3::zeros(),
            excitation: Vec::new(),
        };
        let has = Matrix3::from_element(false);
        steps.push(Step { per, has, row });
        steps.len() - 1
    });
    &mut steps[at]
}

/// Takes the transposed entry where the file has only that one, and zero where it has neither, as
/// for entries that vanish by symmetry. An entry that is missing at some of the frequencies is an
/// error: a zero there would be a wrong coefficient.
fn complete(steps: &mut [Step]) -> Result<(), HydroError> {
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let (force, motion) = (MODES[i], MODES[j]);
        let somewhere = steps.iter().any(|step| step.has[(i, j)]);
        if !somewhere && i == j {
            let what = format!("the mode {force},{motion}");
            let advice = "the .1 file must have 1,1, 3,3 and 5,5 (surge, heave, pitch)";
            return Err(HydroError::missing(what, advice));
        }
        if !somewhere {
            for Step { row, .. } in steps.iter_mut() {
                row.added_mass[(i, j)] = row.added_mass[(j, i)];
                row.damping[(i, j)] = row.damping[(j, i)];
            }
        } else if let Some(step) = steps.iter().find(|step| !step.has[(i, j)]) {
            let what = format!("{force},{motion} at PER = {} in the .1 file", step.per);
            let advice = "add the line, or remove this PER from the .1 and the .3 file; only an \
                          entry off the diagonal may be left out, at every PER";
            return Err(HydroError::missing(what, advice));
        }
    }
    Ok(())
}

/// Adds the forces to the rows, and returns the directions.
fn excitation(text: &str, units: &Units, rows: &mut [Row]) -> Result<Vec<f64>, HydroError> {
    let name = "the .3 file";
    let unknown = Vector3::from_element(Complex::new(f64::NAN, f64::NAN));
    let mut columns: Vec<(f64, f64)> = Vec::new();
    let mut headings: Vec<f64> = Vec::new();
    for line in lines(name, text, 7..=7) {
        let (_, line) = line?;
        let mode = mode(name, line[2])?;
        if !headings.contains(&line[1]) {
            headings.push(line[1]);
        }
        let (Some(i), Some(direction)) = (place(mode), direction(line[1])) else {
            continue;
        };
        let force = Complex::new(line[5], -line[6]);
        agree(&line)?;
        let known = columns.iter().position(|(heading, _)| *heading == line[1]);
        let at = known.unwrap_or_else(|| {
            columns.push((line[1], direction));
            columns.len() - 1
        });
        let omega = units.omega(line[0]);
        let Some(row) = rows.iter_mut().find(|row| row.omega == omega) else {
            let expected = "the frequencies of the .1 and the .3 file must be the same";
            let what = format!("the first column of {name}");
            return Err(HydroError::value(what, line[0], expected));
        };
        if row.excitation.len() <= at {
            row.excitation.resize(at + 1, unknown);
        }
        let water = units.water;
        let scale = water.density_kg_m3 * water.gravity_m_s2 * units.power(2 + rotation(mode));
        let before = std::mem::replace(&mut row.excitation[at][i], force * scale);
        let now = row.excitation[at][i];
        if !before.re.is_nan() && differ(&[before.re, before.im], &[now.re, now.im]) {
            return Err(twice(
                name,
                format!("{mode} at PER = {}, BETA = {}", line[0], line[1]),
            ));
        }
    }
    if columns.is_empty() {
        let advice = format!("the .3 file has the headings {headings:?}; 0 or 180 is required");
        let what = "the excitation of waves along x";
        return Err(HydroError::missing(what, advice));
    }
    for row in rows.iter_mut() {
        row.excitation.resize(columns.len(), unknown);
        all_are_there(row, &columns)?;
    }
    one_of_each(&columns, rows, units)
}

/// Checks that the forces of every heading are given at a frequency that is neither 0 nor infinite.
fn all_are_there(row: &Row, columns: &[(f64, f64)]) -> Result<(), HydroError> {
    if row.omega == 0.0 || row.omega.is_infinite() {
        return Ok(());
    }
    for ((heading, _), forces) in columns.iter().zip(&row.excitation) {
        if let Some(i) = forces.iter().position(|force| force.re.is_nan()) {
            let what = format!(
                "the force {} at ω = {} rad/s, BETA = {heading} in the .3 file",
                MODES[i], row.omega
            );
            let advice =
                "add the line, with numbers, or remove this PER from the .1 and the .3 file";
            return Err(HydroError::missing(what, advice));
        }
    }
    Ok(())
}

/// What rounding leaves of a force that is zero, as a part of the largest number of the file.
const ROUNDING: f64 = 1e-4;

/// Keeps one heading of each direction, as 0 and 360 degrees are the same: their forces must agree
/// to a hundredth of the largest of each freedom, or where a freedom has no force to rounding.
fn one_of_each(
    columns: &[(f64, f64)],
    rows: &mut [Row],
    units: &Units,
) -> Result<Vec<f64>, HydroError> {
    let mut kept: Vec<usize> = Vec::new();
    for (at, (heading, direction)) in columns.iter().enumerate() {
        let Some(same) = kept.iter().copied().find(|k| columns[*k].1 == *direction) else {
            kept.push(at);
            continue;
        };
        // As numbers of the file, in which moments are beside forces.
        let scales = MODES.map(|mode| units.power(rotation(mode)));
        let largest = [0, 1, 2].map(|i| {
            let sizes = rows.iter().map(|row| row.excitation[same][i].norm());
            sizes.fold(0.0, f64::max) / scales[i]
        });
        let rounding = ROUNDING * largest.into_iter().fold(0.0, f64::max);
        for (i, mode) in MODES.iter().enumerate() {
            let allowed = scales[i] * rounding.max(0.01 * largest[i]);
            let apart = |row: &&Row| (row.excitation[at][i] - row.excitation[same][i]).norm();
            if let Some(row) = rows.iter().find(|row| apart(row) > allowed) {
                let what = format!(
                    "{mode} at ω = {} rad/s, BETA = {} and {heading},",
                    row.omega, columns[same].0
                );
                return Err(twice("the .3 file", what));
            }
        }
    }
    for row in rows.iter_mut() {
        row.excitation = kept.iter().map(|at| row.excitation[*at]).collect();
    }
    Ok(kept.iter().map(|at| columns[*at].1).collect())
}

/// Whether MOD and PHA agree with RE and IM, to the digits that are printed.
fn agree(line: &[f64]) -> Result<(), HydroError> {
    let (modulus, phase) = (line[3], line[4] * PI / 180.0);
    let polar = Complex::from_polar(modulus, phase);
    let plain = Complex::new(line[5], line[6]);
    // NaN is found by the check of all numbers.
    if (polar - plain).norm() > 1e-2 * modulus.abs() + 1e-12 {
        let found = format!(
            "MOD {modulus}, PHA {} beside RE {}, IM {}",
            line[4], line[5], line[6]
        );
        let expected = "columns PER BETA I MOD PHA RE IM are expected, PHA in degrees";
        return Err(HydroError::layout("the .3 file", found, expected));
    }
    Ok(())
}

fn direction(degrees: f64) -> Option<f64> {
    let turn = degrees.rem_euclid(360.0);
    if turn.min(360.0 - turn) < 1e-4 {
        Some(1.0)
    } else if (turn - 180.0).abs() < 1e-4 {
        Some(-1.0)
    } else {
        None
    }
}
