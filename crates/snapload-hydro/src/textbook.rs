//! The coefficients of a floating body of one section along its length, without results of a panel
//! code.
//!
//! Its added mass is that of the section at high frequency
//! ([`added_mass_of_section`](crate::added_mass_of_section)) at all frequencies, it makes no waves,
//! and their force is that of long waves ([`crate::section_body`]). The reduction of the added mass
//! by the ends is not known.

use crate::coefficients::{Excitation, Hydrodynamics, Hydrostatics};
use crate::error::{HydroError, Warning};
use crate::read::{Format, Reading};
use crate::section_body::SectionBody;
use crate::water::Water;
use nalgebra::Matrix3;

/// The frequencies for which it is tabulated \[rad/s\], and their number: they cover all waves and
/// oscillations. The force of waves between them is not interpolated but has its closed form.
const RANGE_RAD_S: [f64; 2] = [0.02, 60.0];
const FREQUENCIES: u32 = 400;
/// The ends reduce the added mass by 5 % and more if the body is shorter than this many widths.
const SLENDER: f64 = 10.0;

impl SectionBody {
    /// Its coefficients, in the form in which a panel code's file is read.
    ///
    /// # Errors
    /// [`HydroError::Value`] if there are no textbook values for its proportions.
    pub fn reading(&self, water: Water) -> Result<Reading, HydroError> {
        let added = self.added_mass(&water)?;
        let [low, high] = RANGE_RAD_S;
        let part = |k: u32| f64::from(k) / f64::from(FREQUENCIES - 1);
        let omega_rad_s: Vec<f64> = (0..FREQUENCIES)
            .map(|k| low * (high / low).powf(part(k)))
            .collect();
        let excitation = |direction: f64| {
            let force = self.force(&water, direction)?;
            let force = omega_rad_s.iter().map(|omega| force.at(*omega)).collect();
            Ok(Excitation { direction, force })
        };
        let excitation = vec![excitation(1.0)?, excitation(-1.0)?];
        let hydro = Hydrodynamics {
            added_mass: vec![added; omega_rad_s.len()],
            damping: vec![Matrix3::zeros(); omega_rad_s.len()],
            added_mass_zero: None,
            added_mass_inf: Some(added),
            asymmetry: 0.0,
            damping_asymmetry: 0.0,
            excitation,
            water,
            reference_m: [self.x_m, 0.0],
            hydrostatics: self.hydrostatics(&water),
            section: Some(*self),
            omega_rad_s,
        };
        let mut reading = Reading::new(Format::Section, hydro)?;
        reading.warnings.extend(self.limits());
        Ok(reading)
    }

    /// C33 = ρg S, C55 = ρg I + ρgV z_B − m g z_G of a body whose mass is the displaced mass.
    fn hydrostatics(&self, water: &Water) -> Hydrostatics {
        let displaced = self.displaced_kg(water);
        let weight = water.density_kg_m3 * water.gravity_m_s2;
        let [x, z] = self.centre_of_gravity_m;
        let [_, deep] = self.fullness();
        let buoyancy = -deep * self.draft_m;
        let mut stiffness = Matrix3::zeros();
        stiffness[(1, 1)] = weight * 2.0 * self.half_width_m * self.length_m;
        stiffness[(2, 2)] =
            weight * self.waterplane_m4() + displaced * water.gravity_m_s2 * (buoyancy - z);
        Hydrostatics {
            stiffness: Some(stiffness),
            displaced_mass_kg: Some(displaced),
            centre_of_mass_m: Some([x, z]),
            centre_of_buoyancy_x_m: Some(self.x_m),
            inertia: None,
        }
    }

    /// The warnings about its limits.
    fn limits(&self) -> Vec<Warning> {
        let message = "textbook values of a section have no damping by the waves that the body makes: \
                     without [float] damping a resonance of heave or pitch is not reliable, and the \
                     force of waves is wrong unless they are long compared with the body. Compute a \
                     file with a panel code";
        let mut warnings = vec![Warning::new("textbook section", message.to_owned())];
        let ratio = self.length_m / (2.0 * self.half_width_m);
        if ratio < SLENDER {
            let message = format!(
                "the body is {ratio:.1} times as long across the plane as it is wide: flow round its \
                 ends reduces the added mass, by 5 % or more below a ratio of {SLENDER}"
            );
            warnings.push(Warning::new("ends", message));
        }
        warnings
    }
}
