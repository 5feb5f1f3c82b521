//! Whether coefficients follow the conventions of signs, phases and units, and how good they are.

use super::Format;
use super::table::length_of;
use crate::coefficients::{Excitation, FREEDOMS, Hydrodynamics, UPPER};
use crate::error::{HydroError, Warning};
use crate::waves::wave_number;

/// Asymmetry of A and of B above which the file is doubtful. That of B is larger on the same
/// mesh: 2 % where that of A is 0.6 %.
const DOUBTFUL: [f64; 2] = [0.01, 0.05];
/// Asymmetry above which rows and columns are mixed up.
const MIXED_UP: f64 = 0.2;
/// Added mass varies if it does by more than this part, and there is no damping if all of B/ω is
/// below that part of the added mass.
const VARYING: f64 = 1e-2;
const NO_DAMPING: f64 = 1e-6;
/// The wave number times the length of the waterplane below which a wave is long enough for the
/// limit of low frequency.
const LONG_WAVE: f64 = 0.5;

/// Refuses coefficients that violate a convention, and lists what is doubtful.
pub(super) fn check(format: Format, hydro: &Hydrodynamics) -> Result<Vec<Warning>, HydroError> {
    let mut warnings = Vec::new();
    symmetry(hydro, &mut warnings)?;
    damping(hydro, &mut warnings)?;
    no_damping(hydro, &mut warnings);
    size(format, hydro, &mut warnings);
    stiffness(hydro, &mut warnings)?;
    for excitation in &hydro.excitation {
        low_frequency(format, hydro, excitation, &mut warnings)?;
    }
    // That no frequency is low is said once, and not of each direction.
    warnings.dedup();
    coverage(hydro, &mut warnings);
    Ok(warnings)
}

fn symmetry(hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) -> Result<(), HydroError> {
    let both = [
        ("A", hydro.asymmetry, DOUBTFUL[0], "added mass"),
        ("B", hydro.damping_asymmetry, DOUBTFUL[1], "damping"),
    ];
    for (letter, part, doubtful, name) in both {
        let differ = format!(
            "{letter}_ij and {letter}_ji differ by {:.1} % of sqrt({letter}_ii {letter}_jj)",
            100.0 * part
        );
        if part > MIXED_UP {
            let message = format!(
                "{differ}; {name} is symmetric. Are the degrees of freedom mixed up, or do they refer to \
                 different points?"
            );
            return Err(HydroError::convention("symmetry", message));
        }
        if part > doubtful {
            let message =
                format!("{differ}; their mean is taken. A finer mesh makes them more alike");
            warnings.push(Warning::new("symmetry", message));
        }
    }
    Ok(())
}

fn damping(hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) -> Result<(), HydroError> {
    let mut high = Vec::new();
    for (i, freedom) in FREEDOMS.iter().enumerate() {
        let values = hydro.damping_entry(i, i);
        let largest = values.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
        let area: f64 = values.iter().sum();
        if area < 0.0 {
            let message = format!(
                "the damping of {freedom} is negative; waves carry energy away, so B_ii ≥ 0. Is it \
                 given with the other sign?"
            );
            return Err(HydroError::convention("positive damping", message));
        }
        let below = values.iter().zip(&hydro.omega_rad_s);
        let below: Vec<String> = below
            .filter(|(b, _)| **b < -0.01 * largest)
            .map(|(_, omega)| format!("{omega:.3}"))
            .collect();
        if !below.is_empty() {
            let message = format!(
                "the damping of {freedom} is below −1 % of its largest value at ω = {} rad/s: irregular \
                 frequencies, or a mesh that is too coarse",
                shortened(&below)
            );
            warnings.push(Warning::new("negative damping", message));
        }
        let last = values.last().copied().unwrap_or(0.0);
        if last.abs() > 0.05 * largest {
            high.push(format!("{:.0} % ({freedom})", 100.0 * last.abs() / largest));
        }
    }
    if !high.is_empty() {
        let message = format!(
            "at the last frequency the damping still is {} of its largest value; the start of the memory \
             depends on a power law beyond it. Compute higher frequencies",
            high.join(", ")
        );
        warnings.push(Warning::new("high frequencies", message));
    }
    Ok(())
}

/// Added mass of heave is not so many times the displaced mass, nor so small a part of it, unless
/// the two are of different units.
const SIZES: [f64; 2] = [1e-3, 100.0];

fn size(format: Format, hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) {
    let Some(displaced) = hydro.hydrostatics.displaced_mass_kg else {
        return;
    };
    let all = hydro.added_mass.iter().map(|a| a[(1, 1)].abs());
    let ratio = all.fold(0.0, f64::max) / displaced;
    if !(SIZES[0]..=SIZES[1]).contains(&ratio) {
        let unit = match format {
            Format::Wamit => ", or unit_length is not that of the files (ULEN)",
            _ => "",
        };
        let message = format!(
            "the added mass of heave is {ratio:.3e} times the displaced mass: one of the two is of another body or \
             unit{unit}"
        );
        warnings.push(Warning::new("size", message));
    }
}

/// Added mass varies with ω only as far as the body makes waves, which carry energy away (the
/// Kramers-Kronig relations): where it does and the damping is zero, the damping is missing.
fn no_damping(hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) {
    let length_m = length_of(&hydro.added_mass, hydro.water.density_kg_m3);
    let force = hydro.water.density_kg_m3 * length_m.powi(3);
    for (i, freedom) in FREEDOMS.iter().enumerate() {
        let values = || hydro.added_mass.iter().map(|a| a[(i, i)]);
        let [least, most] = [
            values().fold(f64::INFINITY, f64::min),
            values().fold(0.0, f64::max),
        ];
        let unit = if i == 2 { length_m * length_m } else { 1.0 };
        let rates = hydro.damping.iter().zip(&hydro.omega_rad_s);
        let rates = rates.map(|(b, omega)| b[(i, i)].abs() / omega);
        let varies = most - least > VARYING * most && most > VARYING * force * unit;
        if varies && rates.fold(0.0, f64::max) < NO_DAMPING * most {
            let message = format!(
                "the added mass of {freedom} varies by {:.0} % over the file's frequencies, but its damping is \
                 zero: a body whose added mass varies makes waves. Is the damping missing?",
                100.0 * (most - least) / most
            );
            warnings.push(Warning::new("no damping", message));
        }
    }
}

fn shortened(list: &[String]) -> String {
    match list.len() {
        0..=8 => list.join(", "),
        more => format!("{}, … ({more} in all)", list[..8].join(", ")),
    }
}

fn stiffness(hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) -> Result<(), HydroError> {
    let Some(c) = hydro.hydrostatics.stiffness else {
        return Ok(());
    };
    let scale = |i: usize, j: usize| (c[(i, i)] * c[(j, j)]).abs().sqrt();
    for (i, j) in UPPER {
        let difference = (c[(i, j)] - c[(j, i)]).abs();
        let wrong = difference > 0.01 * scale(i, j) && i != j && scale(i, j) > 0.0;
        if wrong {
            let message = format!(
                "C of {} by {} is {}, but the transposed entry is {}; hydrostatic stiffness is symmetric",
                FREEDOMS[i],
                FREEDOMS[j],
                c[(i, j)],
                c[(j, i)]
            );
            return Err(HydroError::convention("symmetry", message));
        }
    }
    for i in [1, 2] {
        if c[(i, i)] <= 0.0 {
            let message = format!(
                "C of {} is {:.3e}: the body is unstable without lines, which must hold it",
                FREEDOMS[i],
                c[(i, i)]
            );
            warnings.push(Warning::new("stiffness", message));
        }
    }
    Ok(())
}

/// Frequencies that are read as periods, or the other way round, are all too high.
fn column_in_doubt(format: Format) -> &'static str {
    match format {
        Format::Wamit => {
            ". Does the first column of the files hold what first_column says, by default periods?"
        }
        _ => "",
    }
}

/// The limits of low frequency verify units and the sign of time:
///
/// ```text
/// X3 → +C33,    X1 → −i |X1| for a wave to +x, +i |X1| for one to −x       (e^{−iωt})
/// ```
///
/// as the pressure decreases towards +x a quarter of a period before a crest arrives.
fn low_frequency(
    format: Format,
    hydro: &Hydrodynamics,
    excitation: &Excitation,
    warnings: &mut Vec<Warning>,
) -> Result<(), HydroError> {
    let water = &hydro.water;
    let omega = hydro.omega_rad_s[0];
    let force = excitation.force[0];
    let c33 = hydro.hydrostatics.stiffness.map(|c| c[(1, 1)]);
    let c33 = c33.filter(|c| *c > 0.0);
    let waterplane = c33.unwrap_or(force[1].norm()) / (water.density_kg_m3 * water.gravity_m_s2);
    let k = wave_number(omega, water.depth_m, water.gravity_m_s2);
    let long = k * waterplane.sqrt() < LONG_WAVE;
    if !long {
        let message = format!(
            "the lowest frequency, {omega:.3} rad/s, is too high to check phases and units in \
             the limit of long waves; compute lower ones{}",
            column_in_doubt(format)
        );
        warnings.push(Warning::new("low frequencies", message));
        return Ok(());
    }
    if let Some(c33) = c33 {
        let ratio = force[1].norm() / c33;
        if !(0.5..=2.0).contains(&ratio) {
            let message = format!(
                "at ω = {omega:.3} rad/s the wave force on heave is {ratio:.3e} times the hydrostatic \
                 stiffness of heave; for long waves the ratio must tend to 1. Are they in different units, \
                 or was the stiffness given for another body?"
            );
            return Err(HydroError::convention("low-frequency limit of X3", message));
        }
    }
    if force[1].re < 0.5 * force[1].norm() {
        let message = format!(
            "at ω = {omega:.3} rad/s the wave force on heave has the phase {:.0}°; for long waves it must \
             tend to 0, an upward force under a crest",
            force[1].arg().to_degrees()
        );
        return Err(HydroError::convention("phase of X3", message));
    }
    let expected = -excitation.direction;
    if force[0].im * expected < 0.5 * force[0].norm() && force[0].norm() > 0.0 {
        let (beta, to, expected) = match excitation.direction > 0.0 {
            true => ("0", "+x", "−"),
            false => ("π", "−x", "+"),
        };
        let message = format!(
            "for β = {beta}, a wave to {to}, the wave force on surge at ω = {omega:.3} rad/s has the phase \
             {:.0}°; with e^{{−iωt}} it must tend to {expected}90°. Either the file is conjugate \
             (e^{{+iωt}}), or its β is the direction that waves come from",
            force[0].arg().to_degrees()
        );
        return Err(HydroError::convention("phase of X1", message));
    }
    Ok(())
}

fn coverage(hydro: &Hydrodynamics, warnings: &mut Vec<Warning>) {
    let count = hydro.omega_rad_s.len();
    if count < 20 {
        let message = format!("{count} frequencies; a memory needs twenty or more");
        warnings.push(Warning::new("few frequencies", message));
    }
}
