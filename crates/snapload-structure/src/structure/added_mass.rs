//! The water that moves with a submerged body, along each axis and about its centre.
//!
//! ```text
//! circle       A11 = A33 = ρV (C_a = 1),    A55 = 0
//! rectangle    A11 = c₁ ρ T² ℓ,    A33 = c₃ ρ b² ℓ,    A55 = c₅ ρ b⁴ ℓ
//! ```
//!
//! b is half the width, T half the height, ℓ the length across the plane, volume over outline. The
//! coefficients are those of two-dimensional potential flow far from surface and floor
//! ([`snapload_hydro::added_mass_of_section`]); DNV-RP-C205, *Environmental Conditions and
//! Environmental Loads* (October 2010), appendix D, table D-1, prints them in two digits: 1, and
//! for b/T from 1 to 10 C_A = 1.51 to 1.14 of π ρ b². What flows round the ends makes all of it
//! smaller.

use super::Outline;
use snapload_hydro::{HydroError, Place, Shape, added_mass_of_section};

/// Mass and moment of inertia of the water that moves with a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedMass {
    /// A11 \[kg\].
    pub surge_kg: f64,
    /// A33 \[kg\].
    pub heave_kg: f64,
    /// A55 about the body's centre, as far as its moment of inertia does not hold it \[kg m²\].
    pub pitch_kg_m2: f64,
    /// Which of it the case leaves to the textbook.
    pub by_default: ByDefault,
}

/// What of the added mass a case leaves to the textbook.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByDefault {
    /// Nothing.
    Nothing,
    /// The rotation.
    Rotation,
    /// All of it.
    All,
}

impl AddedMass {
    /// As a case gives it.
    pub(super) fn given([surge_kg, heave_kg, pitch_kg_m2]: [f64; 3]) -> Self {
        Self {
            surge_kg,
            heave_kg,
            pitch_kg_m2,
            by_default: ByDefault::Nothing,
        }
    }

    /// Of an outline of so many metres across, ℓ = `length_m` and so much water displaced.
    ///
    /// # Errors
    /// A [`HydroError`] if a rectangle is more than ten times as long as it is wide, or the
    /// reverse, for which there are no coefficients.
    pub(super) fn of_textbook(
        outline: Outline,
        [width_m, height_m]: [f64; 2],
        length_m: f64,
        [density_kg_m3, displaced_kg]: [f64; 2],
    ) -> Result<Self, HydroError> {
        let [surge_kg, heave_kg, pitch_kg_m2] = match outline {
            Outline::Circle => [displaced_kg, displaced_kg, 0.0],
            Outline::Rectangle => {
                let (half_width, half_height) = (0.5 * width_m, 0.5 * height_m);
                let (shape, place) = (Shape::Rectangle, Place::Submerged);
                let section = added_mass_of_section(shape, place, half_width, half_height)?;
                [0, 1, 2].map(|i| density_kg_m3 * length_m * section[(i, i)])
            }
        };
        Ok(Self {
            surge_kg,
            heave_kg,
            pitch_kg_m2,
            by_default: ByDefault::All,
        })
    }

    /// Where the numbers are from that the case does not give; none where it gives them all.
    pub fn source(&self, outline: Outline) -> Option<&'static str> {
        let flow = match outline {
            Outline::Circle => "two-dimensional flow about a circle, C_a = 1",
            Outline::Rectangle => {
                "two-dimensional flow about a rectangle (DNV-RP-C205, table D-1), without what ends \
                 take off"
            }
        };
        match self.by_default {
            ByDefault::Nothing => None,
            // A circle turns in the water without moving it.
            ByDefault::Rotation if self.pitch_kg_m2 == 0.0 => None,
            ByDefault::Rotation | ByDefault::All => Some(flow),
        }
    }
}
