//! Where a submerged body comes out of the water during its motion.
//!
//! Its buoyancy and the forces of the waves are computed as if it stayed under water, so that it
//! rises too high, and the lines catch it in a fall that it would not have had: from there on the
//! whole motion is not reliable.

use super::model_at_rest::ModelAtRest;
use super::warning::{EMERGENCE, Warning, warning_if};
use crate::structure::{Outline, Structure};
use std::f64::consts::PI;

/// Buoyancy that is lost matters if it is more than this part of the net buoyancy.
const LOST: f64 = 0.1;

/// How far a submerged body comes out of the water.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Emergence {
    /// How far its top is above the still water and above the waves over its place of rest, at most
    /// \[m\].
    pub out_m: f64,
    /// Whether it loses more than a tenth of its net buoyancy there.
    pub matters: bool,
}

impl Emergence {
    /// Takes in a position in z and θ.
    pub(crate) fn add(&mut self, prepared: &ModelAtRest, [z_m, theta_rad]: [f64; 2], t_s: f64) {
        let structure = &prepared.structure;
        let top_m = z_m + structure.body.half_height_m(theta_rad);
        if top_m <= self.out_m || structure.afloat.is_some() {
            return;
        }
        let out_m = top_m - prepared.model.surface_m(t_s).max(0.0);
        if out_m > self.out_m {
            let lost_n = structure.weight_of_displaced_n() * part_above(structure, out_m);
            *self = Self {
                out_m,
                matters: lost_n > LOST * structure.net_buoyancy_n(),
            };
        }
    }

    /// The larger of both.
    #[must_use]
    pub(crate) fn with(self, other: Self) -> Self {
        match other.out_m > self.out_m {
            true => other,
            false => self,
        }
    }

    /// The warning of it; the verdict may depend on the motion after it.
    pub(crate) fn warning(&self, verdict_depends: bool) -> Option<Warning> {
        let numbers = [self.out_m, f64::from(u8::from(self.matters))];
        let found = warning_if(self.out_m > 0.0, EMERGENCE, numbers, "");
        found.map(|found| Warning {
            leaves_open: self.matters && verdict_depends,
            ..found
        })
    }
}

/// The part of the outline's area above a level so far below its top.
fn part_above(structure: &Structure, out_m: f64) -> f64 {
    let body = &structure.body;
    let part = (out_m / body.height_m).min(1.0);
    match body.outline {
        Outline::Rectangle => part,
        Outline::Circle => {
            let angle = 2.0 * (1.0 - 2.0 * part).acos();
            (angle - angle.sin()) / (2.0 * PI)
        }
    }
}
