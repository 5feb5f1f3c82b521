//! A floating body of one section along its length, and the force of waves on it in closed form.
//!
//! The incident waves are not disturbed by it. Their force is that of long waves, about the middle
//! O of the waterplane with the displaced volume V at the depth z_B:
//!
//! ```text
//! F1 = (ρV + A11) u̇,    F3 = ρg S η + (ρV + A33) ẇ,    F5 = (ρV z_B + A15) u̇ − ρg I ∂η/∂x
//! ```
//!
//! with the water's acceleration (u̇, ẇ) at the centre of buoyancy, the waterplane S = 2bℓ and its
//! second moment I = (2b)³ℓ/12 (J. N. Newman, *Marine Hydrodynamics* (1977), sections 6.17 and
//! 6.18).

use crate::error::HydroError;
use crate::sections::{Place, Shape, added_mass_of_section};
use crate::water::Water;
use crate::waves::{water_acceleration, wave_number};
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::PI;

/// The force of waves of unit amplitude and one direction on such a body.
#[derive(Clone, Debug)]
pub(crate) struct SectionForce {
    body: SectionBody,
    water: Water,
    added: Matrix3<f64>,
    direction: f64,
}

impl SectionForce {
    /// X at ω, about the middle of the waterplane.
    pub(crate) fn at(&self, omega: f64) -> Vector3<Complex<f64>> {
        self.body
            .wave_force(&self.water, &self.added, omega, self.direction)
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
    pub(crate) fn fullness(&self) -> [f64; 2] {
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

    /// A at all frequencies, about the middle of its waterplane.
    pub(crate) fn added_mass(&self, water: &Water) -> Result<Matrix3<f64>, HydroError> {
        let (half_width_m, draft_m) = (self.half_width_m, self.draft_m);
        let place = Place::Floating;
        let per_metre = added_mass_of_section(self.shape, place, half_width_m, draft_m)?;
        Ok(per_metre * (water.density_kg_m3 * self.length_m))
    }

    /// The force of waves of a direction.
    ///
    /// # Errors
    /// [`HydroError::Value`] if there are no textbook values for its proportions.
    pub(crate) fn force(&self, water: &Water, direction: f64) -> Result<SectionForce, HydroError> {
        Ok(SectionForce {
            body: *self,
            water: *water,
            added: self.added_mass(water)?,
            direction,
        })
    }

    pub(crate) fn displaced_kg(&self, water: &Water) -> f64 {
        let [full, _] = self.fullness();
        water.density_kg_m3 * full * 2.0 * self.half_width_m * self.draft_m * self.length_m
    }

    /// The second moment of the waterplane I \[m⁴\].
    pub(crate) fn waterplane_m4(&self) -> f64 {
        (2.0 * self.half_width_m).powi(3) * self.length_m / 12.0
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
}
