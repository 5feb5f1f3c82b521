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
    /// Whether it loses more than a tenth of its net buoyancy at some time.
    pub matters: bool,
}

impl Emergence {
    /// Takes in a position in z and θ.
    pub(crate) fn add(&mut self, prepared: &ModelAtRest, [z_m, theta_rad]: [f64; 2], t_s: f64) {
        let structure = &prepared.structure;
        if structure.afloat.is_some() {
            return;
        }
        let top_m = z_m + structure.body.half_height_m(theta_rad);
        // A body that is turned otherwise may lose more where it comes out less far.
        let matters = |out_m: f64| out_m > 0.0 && loses_much(structure, theta_rad, out_m);
        let may_matter = !self.matters && matters(top_m);
        if top_m <= self.out_m && !may_matter {
            return;
        }
        let out_m = top_m - prepared.model.surface_m(t_s).max(0.0);
        *self = Self {
            out_m: self.out_m.max(out_m),
            matters: self.matters || (may_matter && matters(out_m)),
        };
    }

    /// What either of two motions did.
    #[must_use]
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            out_m: self.out_m.max(other.out_m),
            matters: self.matters || other.matters,
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

/// Whether a body that is so far out of the water loses more than a tenth of its net buoyancy.
fn loses_much(structure: &Structure, theta_rad: f64, out_m: f64) -> bool {
    let lost_n = structure.weight_of_displaced_n() * part_above(structure, theta_rad, out_m);
    lost_n > LOST * structure.net_buoyancy_n()
}

/// The part of the area of the outline, turned by θ, above a level so far below its top.
fn part_above(structure: &Structure, theta_rad: f64, out_m: f64) -> f64 {
    let body = &structure.body;
    let height_m = 2.0 * body.half_height_m(theta_rad);
    let out_m = out_m.min(height_m);
    match body.outline {
        Outline::Rectangle => {
            // Its width rises evenly from the highest corner to the next, is constant down to the
            // third, and falls evenly to the lowest.
            let (sine, cosine) = theta_rad.sin_cos();
            let sides_m = [body.width_m * sine.abs(), body.height_m * cosine.abs()];
            let corner_m = sides_m[0].min(sides_m[1]);
            let longer_m = sides_m[0].max(sides_m[1]);
            let triangle = |m: f64| m * m / (2.0 * corner_m * longer_m);
            let below_m = height_m - out_m;
            if out_m < corner_m {
                triangle(out_m)
            } else if below_m < corner_m {
                1.0 - triangle(below_m)
            } else {
                (out_m - 0.5 * corner_m) / longer_m
            }
        }
        Outline::Circle => {
            let angle = 2.0 * (1.0 - 2.0 * out_m / height_m).acos();
            (angle - angle.sin()) / (2.0 * PI)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Emergence, part_above};
    use crate::physics::model_at_rest::ModelAtRest;
    use crate::structure::Structure;

    fn rectangle(width_m: f64, height_m: f64) -> Structure {
        let volume_m3 = width_m * height_m * 10.0;
        Structure::parse(
            "rectangle",
            &format!(
                "[body]\nshape = \"rectangle\"\nwidth = {width_m}\nheight = {height_m}\n\
                 displaced_volume = {volume_m3}\nmass = {}\nposition = [0, -20]\n\
                 [[line]]\nanchor = [0, -40]\nfairlead = [0, -20]\nlength = 20\n\
                 [site]\ndepth = 40\n[run]\nrestitution = 0.5\n",
                500.0 * volume_m3
            ),
        )
        .expect("a structure")
    }

    /// The area above a level of the polygon whose corners are those of the turned rectangle, cut
    /// there, by the formula of the trapezium for each of its sides.
    fn by_cutting([width, height]: [f64; 2], theta: f64, out: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[a, b]| {
            let [x, z] = [0.5 * a * width, 0.5 * b * height];
            [x * cosine - z * sine, x * sine + z * cosine]
        });
        let top = corners
            .iter()
            .fold(f64::MIN, |top, corner| top.max(corner[1]));
        let level = top - out;
        let mut cut: Vec<[f64; 2]> = Vec::new();
        for k in 0..4 {
            let (here, next) = (corners[k], corners[(k + 1) % 4]);
            if here[1] >= level {
                cut.push(here);
            }
            if (here[1] >= level) != (next[1] >= level) {
                let part = (level - here[1]) / (next[1] - here[1]);
                cut.push([here[0] + part * (next[0] - here[0]), level]);
            }
        }
        let sides = (0..cut.len()).map(|k| (cut[k], cut[(k + 1) % cut.len()]));
        let twice: f64 = sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        0.5 * twice.abs() / (width * height)
    }

    /// A corner that comes out of the water first has little of the area, and that of a narrow body
    /// on its side much.
    #[test]
    fn a_turned_rectangle_has_the_area_of_its_polygon_out_of_the_water() {
        for [width, height] in [[2.0, 2.0], [4.0, 2.0], [1.0, 10.0]] {
            let structure = rectangle(width, height);
            for degrees in [0.0, 1.0, -20.0, 45.0, 80.0, 90.0, -90.0] {
                let theta = f64::to_radians(degrees);
                let whole = 2.0 * structure.body.half_height_m(theta);
                for part in [0.05, 0.2, 0.5, 0.77, 0.99] {
                    let out = part * whole;
                    let found = part_above(&structure, theta, out);
                    let expected = by_cutting([width, height], theta, out);
                    let case = format!("{width} x {height}, {degrees} degrees, {out} m");
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{case}: {found} {expected}"
                    );
                }
                assert_eq!(part_above(&structure, theta, 2.0 * whole), 1.0);
            }
        }
        // A corner of a square is a right triangle whose height is half of its base.
        let corner = part_above(&rectangle(2.0, 2.0), f64::to_radians(45.0), 0.2);
        assert!((corner - 0.2 * 0.2 / 4.0).abs() < 1e-12);
    }

    /// The net buoyancy is 52.5/102.5 of the buoyancy, of which a tenth is 5.1 % of the area. An
    /// upright body that is 5 % out loses less, one that is turned by 80 degrees and less far out
    /// more, which a later position does not undo.
    #[test]
    fn what_matters_is_not_how_far_the_body_comes_out() {
        let prepared = ModelAtRest::new(rectangle(1.0, 10.0)).expect("a place of rest");
        let mut seen = Emergence::default();
        for (degrees, out, far, matters) in [
            (0.0, -1.0, 0.0, false),
            (0.0, 0.5, 0.5, false),
            (80.0, 0.45, 0.5, true),
            (0.0, 0.505, 0.505, true),
        ] {
            let theta = f64::to_radians(degrees);
            let z = out - prepared.structure.body.half_height_m(theta);
            seen.add(&prepared, [z, theta], 0.0);
            assert!((seen.out_m - far).abs() < 1e-12, "{seen:?}");
            assert_eq!(seen.matters, matters, "{degrees} degrees, {out} m");
        }
        assert!(Emergence::default().with(seen).matters);
    }
}
