//! The added mass of a submerged body, along each axis and about its centre.
//!
//! ```text
//! circle       A11 = A33 = ρV (C_a = 1),    A55 = 0
//! rectangle    A11 = c₁ ρ T² ℓ,    A33 = c₃ ρ b² ℓ,    A55 = c₅ ρ b⁴ ℓ
//! ```
//!
//! b is half the width, T half the height, ℓ the length across the plane, volume divided by the
//! area of the outline. The coefficients are those of two-dimensional potential flow far from
//! surface and floor ([`snapload_hydro::added_mass_of_section`]); DNV-RP-C205, *Environmental
//! Conditions and Environmental Loads* (October 2010), appendix D, table D-1, prints them in two
//! digits: 1, and for b/T from 1 to 10 C_A = 1.51 to 1.14 of π ρ b². The flow round the ends
//! reduces all of it.

use super::Outline;
use snapload_hydro::{HydroError, Place, Shape, added_mass_of_section};

/// The added mass and moment of inertia of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedMass {
    /// A11 \[kg\].
    pub surge_kg: f64,
    /// A33 \[kg\].
    pub heave_kg: f64,
    /// A55 about the body's centre, if its moment of inertia does not include it \[kg m²\].
    pub pitch_kg_m2: f64,
    /// The part that the case leaves to the textbook.
    pub by_default: AddedMassDefaults,
}

/// The part of the added mass that a case leaves to the textbook.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddedMassDefaults {
    /// Nothing.
    Nothing,
    /// The rotation.
    Rotation,
    /// All of it.
    All,
}

impl AddedMass {
    /// The added mass that a case gives.
    pub(super) fn given([surge_kg, heave_kg, pitch_kg_m2]: [f64; 3]) -> Self {
        Self {
            surge_kg,
            heave_kg,
            pitch_kg_m2,
            by_default: AddedMassDefaults::Nothing,
        }
    }

    /// The added mass of an outline of these sizes, with ℓ = `length_m` and the displaced mass of
    /// water.
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
            by_default: AddedMassDefaults::All,
        })
    }

    /// The source of the numbers that the case does not give; none if it gives them all.
    pub fn source(&self, outline: Outline) -> Option<&'static str> {
        let flow = match outline {
            Outline::Circle => "two-dimensional flow about a circle, C_a = 1",
            Outline::Rectangle => {
                "two-dimensional flow about a rectangle (DNV-RP-C205, table D-1), without the \
                 reduction at the ends"
            }
        };
        match self.by_default {
            AddedMassDefaults::Nothing => None,
            // A turning circle does not move the water.
            AddedMassDefaults::Rotation if self.pitch_kg_m2 == 0.0 => None,
            AddedMassDefaults::Rotation | AddedMassDefaults::All => Some(flow),
        }
    }
}
