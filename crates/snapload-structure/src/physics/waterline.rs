//! The position of a floating body relative to the still water, and the limits of linear
//! hydrostatics.
//!
//! They take the buoyancy of a body as ρgV − C33 z, which grows without end. It is that of vertical
//! sides that pierce the surface: a body whose whole deck is under water lifts no more than its
//! whole volume, and one that is clear of the water weighs no more than its weight.

use super::afloat::loaded;
use super::equilibrium::Equilibrium;
use super::model_at_rest::ModelAtRest;
use crate::structure::{Afloat, Outline, Structure};
use crate::text_layout::{digits, kilo};
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
    /// How far the whole deck is under the surface of the waves, and the whole body above it, at
    /// most; below zero where its sides pierce the surface. Only those positions count at which a
    /// line pulls more than its largest reliable tension until then \[m\].
    #[serde(skip)]
    pub beyond_m: [f64; 2],
}

impl Waterline {
    /// The initial value for a floating body, before any position is included; none for a submerged
    /// one.
    pub(crate) fn before(structure: &Structure) -> Option<Self> {
        structure.afloat.as_ref().map(|_| Self {
            heave_m: [f64::INFINITY, f64::NEG_INFINITY],
            deck_m: f64::INFINITY,
            bilge_m: f64::NEG_INFINITY,
            beyond_m: [f64::NEG_INFINITY; 2],
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
            beyond_m: [0, 1].map(|side| self.beyond_m[side].max(other.beyond_m[side])),
        }
    }

    /// The position of a body whose centre is at a level, turned by θ: the deck's edges
    /// are at z + h/2 cos θ ± b/2 sin θ. Where the level of the waves at the body is
    /// given, it is compared with that, too.
    pub(crate) fn at(
        structure: &Structure,
        [z_m, theta_rad]: [f64; 2],
        surface_m: Option<f64>,
    ) -> Self {
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
            beyond_m: surface_m.map_or([f64::NEG_INFINITY; 2], |surface_m| {
                let highest = z_m + up + aside;
                let lowest = z_m - up - aside;
                [surface_m - highest, lowest - surface_m]
            }),
        }
    }

    /// The position in the waves of a floating body whose centre is at a level, turned by θ.
    pub(crate) fn in_waves(prepared: &ModelAtRest, place: [f64; 2], t_s: f64) -> Self {
        let surface_m = prepared.model.surface_m(t_s);
        Self::at(&prepared.structure, place, Some(surface_m))
    }

    /// Whether linear hydrostatics hold at a position in the waves: the sides pierce the surface.
    pub(crate) fn allows_hydrostatics(&self) -> bool {
        self.beyond_m.iter().all(|beyond| *beyond <= 0.0)
    }

    /// What the body did where they do not hold, in words; none where they do.
    pub(crate) fn beyond_in_words(&self) -> Option<String> {
        let [under, clear] = self.beyond_m;
        let part = |beyond: f64, what: &str, than: &str| {
            (beyond > 0.0).then(|| format!("{what} {} m {than} the waves", digits(&beyond, 2)))
        };
        let parts = [
            part(under, "the whole deck is up to", "under"),
            part(clear, "the whole body is up to", "above"),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| format!("where lines pull hard, {}", parts.join(", ")))
    }
}

/// The same of a body at rest in still water, with the vertical pull of its lines
/// beside the largest one that is possible: ρV g − mg wholly under water, mg clear
/// of it, and the constant loads.
pub(crate) fn rest_beyond_in_words(
    structure: &Structure,
    afloat: &Afloat,
    rest: &Equilibrium,
) -> Option<String> {
    let place = [rest.place_m[1], rest.theta_rad];
    let [under, clear] = Waterline::at(structure, place, Some(0.0)).beyond_m;
    let body = loaded(structure, afloat);
    let heave_m = rest.place_m[1] - structure.body.position_m[1];
    // Pitch is clockwise.
    let restoring = body.stiffness[(1, 1)] * heave_m - body.stiffness[(1, 2)] * rest.theta_rad;
    let lift_n = body.constant_force[1];
    let weight = structure.site.water_density_kg_m3 * structure.site.gravity_m_s2;
    let volume_m3 = structure.body.displaced_volume_m3;
    let whole_m3 = volume_m3 / structure.body.part_under_still_water();
    let (beyond, what, way, possible_n) = if under > 0.0 {
        let most_n = lift_n + weight * (whole_m3 - volume_m3);
        (under, "the whole deck", ["under", "down"], most_n)
    } else {
        let most_n = weight * volume_m3 - lift_n;
        (clear, "the whole body", ["above", "up"], most_n)
    };
    let held_n = (lift_n - restoring).abs();
    let impossible = match held_n > possible_n.max(0.0) {
        true => format!(
            ", and the lines would hold it {} with {} kN, where no more than {} kN are possible",
            way[1],
            kilo(&held_n, 0),
            kilo(&possible_n.max(0.0), 0)
        ),
        false => String::new(),
    };
    (beyond > 0.0).then(|| {
        let beyond = digits(&beyond, 2);
        format!(
            "at rest {what} is {beyond} m {} the still water{impossible}",
            way[0]
        )
    })
}
