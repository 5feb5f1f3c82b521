//! WAMIT's file of hydrostatics.
//!
//! ```text
//! .hst  I J C̄       C = ρ g L^k C̄, k = 2 for (3,3), 3 for one rotation, 4 for two
//! C(4,6) = m g x_G − ρ g V x_B
//! ```
//!
//! Source: WAMIT user manual, chapter "Output files".

use super::Given;
use super::wamit_text::{MODES, Units, differ, lines, mode, place, rotation, twice};
use crate::coefficients::{Hydrostatics, UPPER};
use crate::error::HydroError;
use nalgebra::Matrix3;

const NAME: &str = "the .hst file";
/// Roll and yaw, whose entry has the centres of gravity and of buoyancy in it.
const ROLL_YAW: [usize; 2] = [4, 6];

/// What the file and the given values say of weight and buoyancy. The stiffness is that of a body
/// whose mass is the displaced one, so that
///
/// ```text
/// x_B = x_G − C(4,6)/(ρ g V)
/// ```
///
/// A file without that entry is of a body that floats in balance.
pub(super) fn hydrostatics(
    text: Option<&str>,
    units: &Units,
    given: &Given,
) -> Result<Hydrostatics, HydroError> {
    let (stiffness, moment_n_m) = match text {
        Some(text) => {
            let (stiffness, moment_n_m) = entries(text, units)?;
            (Some(stiffness), moment_n_m)
        }
        None => (None, None),
    };
    let known = (
        moment_n_m,
        given.displaced_mass_kg,
        given.centre_of_gravity_m,
    );
    let centre_of_buoyancy_x_m = match known {
        (Some(moment), Some(mass), Some([x, _])) if mass > 0.0 => {
            Some(x - moment / (mass * units.water.gravity_m_s2))
        }
        _ => None,
    };
    Ok(Hydrostatics {
        stiffness,
        displaced_mass_kg: given.displaced_mass_kg,
        centre_of_mass_m: given.centre_of_gravity_m,
        centre_of_buoyancy_x_m,
        inertia: None,
    })
}

/// C of surge, heave and pitch, and C(4,6) if the file has it.
fn entries(text: &str, units: &Units) -> Result<(Matrix3<f64>, Option<f64>), HydroError> {
    let mut stiffness = Matrix3::zeros();
    let mut has = Matrix3::from_element(false);
    let mut roll_yaw = None;
    let rho_g = units.water.density_kg_m3 * units.water.gravity_m_s2;
    for line in lines(NAME, text, 3..=3) {
        let (number, line) = line?;
        let (force, motion) = (mode(NAME, line[0])?, mode(NAME, line[1])?);
        if !line[2].is_finite() {
            let found = format!("line {number} has the stiffness {}", line[2]);
            return Err(HydroError::layout(NAME, found, "a number is expected"));
        }
        let value = rho_g * units.power(2 + rotation(force) + rotation(motion)) * line[2];
        let before = match (place(force), place(motion)) {
            (Some(i), Some(j)) => {
                let before = std::mem::replace(&mut stiffness[(i, j)], value);
                let known = std::mem::replace(&mut has[(i, j)], true);
                known.then_some(before)
            }
            _ if [force, motion] == ROLL_YAW => roll_yaw.replace(value),
            _ => continue,
        };
        if before.is_some_and(|before| differ(&[before], &[value])) {
            return Err(twice(NAME, format!("{force},{motion}")));
        }
    }
    for i in [1, 2] {
        let mode = MODES[i];
        if !has[(i, i)] {
            let advice = "the .hst file must have the lines 3 3 C and 5 5 C (heave, pitch)";
            return Err(HydroError::missing(
                format!("the mode {mode},{mode}"),
                advice,
            ));
        }
    }
    // Some files have only one of the two triangles.
    for (i, j) in UPPER.into_iter().filter(|(i, j)| i != j) {
        for (i, j) in [(i, j), (j, i)] {
            if stiffness[(i, j)] == 0.0 {
                stiffness[(i, j)] = stiffness[(j, i)];
            }
        }
    }
    Ok((stiffness, roll_yaw))
}
