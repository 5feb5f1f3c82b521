//! The position of a floating body relative to the still water, and the limits of linear
//! hydrostatics.

use crate::structure::{Outline, Structure};
use serde::Serialize;

/// The extreme positions of a floating body relative to the still water, over the ends of the steps
/// of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Waterline {
    /// The lowest and the highest position of the centre, relative to the position for which its
    /// coefficients were computed \[m\].
    pub heave_m: [f64; 2],
    /// The lowest position of an edge of the deck \[m\].
    pub deck_m: f64,
    /// The highest position of a lower edge \[m\].
    pub bilge_m: f64,
}

impl Waterline {
    /// The initial value for a floating body, before any position is included; none for a submerged
    /// one.
    pub(crate) fn before(structure: &Structure) -> Option<Self> {
        structure.afloat.as_ref().map(|_| Self {
            heave_m: [f64::INFINITY, f64::NEG_INFINITY],
            deck_m: f64::INFINITY,
            bilge_m: f64::NEG_INFINITY,
        })
    }

    /// The extremes of both.
    #[must_use]
    pub(crate) fn with(self, other: &Self) -> Self {
        let ([low, high], [other_low, other_high]) = (self.heave_m, other.heave_m);
        Self {
            heave_m: [low.min(other_low), high.max(other_high)],
            deck_m: self.deck_m.min(other.deck_m),
            bilge_m: self.bilge_m.max(other.bilge_m),
        }
    }

    /// The position of a body whose centre is at a level, turned by θ: the deck's edges are at z +
    /// h/2 cos θ ± b/2 sin θ.
    pub(crate) fn at(structure: &Structure, z_m: f64, theta_rad: f64) -> Self {
        let body = &structure.body;
        let (sine, cosine) = theta_rad.sin_cos();
        let half = |length: f64, part: f64| 0.5 * length * part;
        let [up, aside] = match body.outline {
            Outline::Circle => [half(body.height_m, 1.0), 0.0],
            Outline::Rectangle => [half(body.height_m, cosine), half(body.width_m, sine.abs())],
        };
        let heave = z_m - body.position_m[1];
        Self {
            heave_m: [heave, heave],
            deck_m: z_m + up - aside,
            bilge_m: z_m - up + aside,
        }
    }
}
