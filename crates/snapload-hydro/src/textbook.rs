//! A floating body of one section along its length, without results of a panel code.
//!
//! Its added mass is that of the section at high frequency ([`added_mass_of_section`]) at all
//! frequencies, it makes no waves, and the incident waves are not disturbed by it. Their force is
//! that of long waves, about the middle O of the waterplane with the displaced volume V at the
//! depth z_B:
//!
//! ```text
//! F1 = (ρV + A11) u̇,    F3 = ρg S η + (ρV + A33) ẇ,    F5 = (ρV z_B + A15) u̇ − ρg I ∂η/∂x
//! ```
//!
//! with the water's acceleration (u̇, ẇ) at the centre of buoyancy, the waterplane S = 2bℓ and its
//! second moment I = (2b)³ℓ/12 (J. N. Newman, *Marine Hydrodynamics* (1977), sections 6.17 and
//! 6.18). The reduction of the added mass by the ends is not known.

use crate::coefficients::{Excitation, Hydrodynamics, Hydrostatics, Water, transport};
use crate::error::{HydroError, Warning};
use crate::read::{Format, Reading};
use crate::sections::{Place, Shape, added_mass_of_section};
use crate::waves::{water_acceleration, wave_number};
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::PI;

/// The frequencies for which it is tabulated \[rad/s\], and their number: they cover all waves and
/// oscillations. The force of waves between them is not interpolated but has its closed form.
const RANGE_RAD_S: [f64; 2] = [0.02, 60.0];
const FREQUENCIES: u32 = 400;
/// The ends reduce the added mass by 5 % and more if the body is shorter than this many widths.
const SLENDER: f64 = 10.0;

/// The force of waves of unit amplitude and one direction on such a body.
#[derive(Clone, Debug)]
pub(crate) struct SectionForce {
    body: SectionBody,
    water: Water,
    added: Matrix3<f64>,
    direction: f64,
    /// From the middle of the waterplane to the reference point.
    transport: Matrix3<f64>,
}

impl SectionForce {
    /// X at ω.
    pub(crate) fn at(&self, omega: f64) -> Vector3<Complex<f64>> {
        let own = self
            .body
            .wave_force(&self.water, &self.added, omega, self.direction);
        self.transport.map(|entry| Complex::new(entry, 0.0)) * own
    }
}

/// A floating body of one section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionBody {
    /// Its section; of an ellipse the lower half is in the water.
    pub shape: Shape,
    /// Half of the width of its waterplane b \[m\].
    pub half_width_m: f64,
    /// Draft T \[m\].
    pub draft_m: f64,
    /// Length across the plane ℓ \[m\].
    pub length_m: f64,
    /// The x of the middle of its waterplane \[m\].
    pub x_m: f64,
    /// Its centre of gravity \[m\].
    pub centre_of_gravity_m: [f64; 2],
}

impl SectionBody {
    /// The area under water divided by width times draft, and the depth of its centroid divided by
    /// the draft.
    fn fullness(&self) -> [f64; 2] {
        match self.shape {
            Shape::Rectangle => [1.0, 0.5],
            Shape::Ellipse => [PI / 4.0, 4.0 / (3.0 * PI)],
        }
    }

    /// The length of a body of this section that displaces a volume \[m\].
    #[must_use]
    pub fn displacing(self, volume_m3: f64) -> Self {
        let [full, _] = self.fullness();
        Self {
            length_m: volume_m3 / (full * 2.0 * self.half_width_m * self.draft_m),
            ..self
        }
    }

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
        let reference_m = [self.x_m, 0.0];
        let excitation = |direction: f64| {
            let force = self.force(&water, direction, reference_m)?;
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
            reference_m,
            hydrostatics: self.hydrostatics(&water),
            section: Some(*self),
            omega_rad_s,
        };
        let mut reading = Reading::new(Format::Section, hydro)?;
        reading.warnings.extend(self.limits());
        Ok(reading)
    }

    /// A at all frequencies, about the middle of its waterplane.
    fn added_mass(&self, water: &Water) -> Result<Matrix3<f64>, HydroError> {
        let (half_width_m, draft_m) = (self.half_width_m, self.draft_m);
        let place = Place::Floating;
        let per_metre = added_mass_of_section(self.shape, place, half_width_m, draft_m)?;
        Ok(per_metre * (water.density_kg_m3 * self.length_m))
    }

    /// The force of waves of a direction, about a reference point.
    ///
    /// # Errors
    /// [`HydroError::Value`] if there are no textbook values for its proportions.
    pub(crate) fn force(
        &self,
        water: &Water,
        direction: f64,
        reference_m: [f64; 2],
    ) -> Result<SectionForce, HydroError> {
        let shift = [reference_m[0] - self.x_m, reference_m[1]];
        Ok(SectionForce {
            body: *self,
            water: *water,
            added: self.added_mass(water)?,
            direction,
            transport: transport(shift).transpose(),
        })
    }

    fn displaced_kg(&self, water: &Water) -> f64 {
        let [full, _] = self.fullness();
        water.density_kg_m3 * full * 2.0 * self.half_width_m * self.draft_m * self.length_m
    }

    /// The second moment of the waterplane I \[m⁴\].
    fn waterplane_m4(&self) -> f64 {
        (2.0 * self.half_width_m).powi(3) * self.length_m / 12.0
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
            centre_of_buoyancy_m: Some([self.x_m, buoyancy]),
            inertia: None,
        }
    }

    /// X of a wave of unit amplitude: with e^{−iωt} and its crest over the body at t = 0 the
    /// water's acceleration there is (−i a_x, −a_z), its slope i k; for a wave to −x both i change
    /// their signs.
    fn wave_force(
        &self,
        water: &Water,
        added: &Matrix3<f64>,
        omega: f64,
        direction: f64,
    ) -> Vector3<Complex<f64>> {
        let weight = water.density_kg_m3 * water.gravity_m_s2;
        let [_, deep] = self.fullness();
        let (displaced, z) = (self.displaced_kg(water), -deep * self.draft_m);
        let k = wave_number(omega, water.depth_m, water.gravity_m_s2);
        let [a_x, a_z] = water_acceleration([1.0, omega], k, water.depth_m, z);
        let along = |per: f64| Complex::new(0.0, -direction * a_x * per);
        let slope = Complex::new(0.0, direction * k);
        let plane = weight * 2.0 * self.half_width_m * self.length_m;
        Vector3::new(
            along(displaced + added[(0, 0)]),
            Complex::new(plane - (displaced + added[(1, 1)]) * a_z, 0.0),
            along(displaced * z + added[(0, 2)]) - slope * (weight * self.waterplane_m4()),
        )
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
