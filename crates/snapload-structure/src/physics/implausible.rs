//! Warnings of data that can be computed but are probably wrong, most often as they are in other
//! units. No bound is one that a real body comes near to.

use super::warning::{DENSITY, INERTIA, Warning, warning_if};
use crate::structure::{BodySi, LineSi, Outline, Structure};

/// The largest plausible ratio of the body's length across the plane and its width, or the reverse.
const PROPORTION: f64 = 100.0;
/// The largest plausible ratio of a line's length to the distance of its ends with the body at the
/// case's position.
const LONGEST_RATIO: f64 = 3.0;
/// The largest plausible length of a line within the body's outline, as a part of its smaller size:
/// a fairlead may stand for one at the surface, up to one at the centre.
const LONGEST_WITHIN: f64 = 0.55;
/// The least plausible mass over displaced volume: air alone has 1.2, and every body that floats has
/// less than 1.3 if its mass is in tonnes \[kg/m³\].
const LEAST_DENSITY: f64 = 2.0;
/// The plausible ratios of a radius of gyration to the half diagonal of the outline. A ring has 1
/// and a uniform rectangle 0.58. A mass in tonnes makes the radius 32 times too large, a moment of
/// inertia in t m² 32 times too small.
const GYRATION: [f64; 2] = [0.05, 5.0];

/// The warnings of a structure.
pub(super) fn implausible(structure: &Structure) -> [Option<Warning>; 6] {
    let body = &structure.body;
    let (length, size) = (body.length_m(), body.width_m.max(body.height_m));
    let odd = !(size / PROPORTION..=size * PROPORTION).contains(&length);
    let numbered = || structure.lines.iter().zip(1..);
    let listed = |numbers: Vec<String>| numbers.join(", ");
    let outside = numbered().filter(|(line, _)| !body.reaches(line.fairlead_m));
    let outside = listed(outside.map(|(_, number)| number.to_string()).collect());
    let long = numbered().filter_map(|(line, number)| Some((number, too_long(line)?)));
    let long = listed(long.map(|(n, by)| format!("line {n} {by}")).collect());
    let most_m = LONGEST_WITHIN * body.width_m.min(body.height_m);
    let through = numbered().filter(|(line, _)| length_within_m(body, line) > most_m);
    let through = listed(through.map(|(_, number)| number.to_string()).collect());
    [
        warning_if(odd, "proportions", [length, size], ""),
        density(body),
        gyration(structure),
        warning_if(!outside.is_empty(), "fairleads", [0.0; 2], &outside),
        warning_if(!long.is_empty(), "long lines", [0.0; 2], &long),
        warning_if(!through.is_empty(), "lines in the body", [0.0; 2], &through),
    ]
}

/// The length of a straight line within the body's outline, with the body at the case's position
/// \[m\].
fn length_within_m(body: &BodySi, line: &LineSi) -> f64 {
    let from = [0, 1].map(|k| line.fairlead_m[k] - body.position_m[k]);
    let along = [0, 1].map(|k| line.anchor_m[k] - line.fairlead_m[k]);
    let length = along[0].hypot(along[1]);
    // The parts t of the line, from 0 at the fairlead to 1 at the anchor, that are within.
    let [first, last] = match body.outline {
        Outline::Circle => {
            // |from + t along|² = (width/2)², t = middle ± half.
            let middle = -(from[0] * along[0] + from[1] * along[1]) / (length * length);
            let apart = (from[0] * along[1] - from[1] * along[0]) / length;
            let half = ((0.5 * body.width_m).powi(2) - apart * apart)
                .max(0.0)
                .sqrt()
                / length;
            [middle - half, middle + half]
        }
        Outline::Rectangle => {
            let sides = [body.width_m, body.height_m].map(|size| 0.5 * size);
            let mut part = [0.0, 1.0];
            for k in 0..2 {
                let mut ends = [-sides[k], sides[k]].map(|side| (side - from[k]) / along[k]);
                if along[k] == 0.0 {
                    let inside = from[k].abs() < sides[k];
                    ends = if inside { [0.0, 1.0] } else { [1.0, 0.0] };
                } else if ends[0] > ends[1] {
                    ends.swap(0, 1);
                }
                part = [f64::max(part[0], ends[0]), f64::min(part[1], ends[1])];
            }
            part
        }
    };
    let part = last.clamp(0.0, 1.0) - first.clamp(0.0, 1.0);
    length * part.max(0.0)
}

/// By how much a line is longer than the distance of its ends, in words, if that is too much.
fn too_long(line: &LineSi) -> Option<String> {
    let [x, z] = [0, 1].map(|k| line.fairlead_m[k] - line.anchor_m[k]);
    match x.hypot(z) {
        0.0 => Some("although its anchor and its fairlead are one point".to_owned()),
        apart => {
            let ratio = line.length_m / apart;
            (ratio > LONGEST_RATIO).then(|| format!("{ratio:.1} times"))
        }
    }
}

/// The warning that a body is hardly heavier than air.
fn density(body: &BodySi) -> Option<Warning> {
    let density = body.mass_kg / body.displaced_volume_m3;
    let numbers = [density, LEAST_DENSITY];
    warning_if(density < LEAST_DENSITY, DENSITY, numbers, "")
}

/// The warning that mass and moment of inertia do not fit the size of the body.
fn gyration(structure: &Structure) -> Option<Warning> {
    let body = &structure.body;
    let half = match body.outline {
        Outline::Circle => 0.5 * body.width_m,
        Outline::Rectangle => 0.5 * body.width_m.hypot(body.height_m),
    };
    // That of a floating body is about the centre of its outline.
    let offset = structure.afloat.as_ref().map_or(0.0, |afloat| {
        let mass = &afloat.body.mass;
        (mass[(0, 2)].powi(2) + mass[(1, 2)].powi(2)) / body.mass_kg
    });
    let inertia = body.moment_of_inertia_kg_m2 - offset;
    let radius = |mass: f64| (inertia.max(0.0) / mass).sqrt();
    // Without an added inertia of its own, it may include that of the water.
    let added = &body.added_mass;
    let water = match added.pitch_kg_m2 {
        0.0 => added.surge_kg.max(added.heave_kg),
        _ => 0.0,
    };
    let own = radius(body.mass_kg);
    let [least, most] = GYRATION.map(|part| part * half);
    let odd = own < least || radius(body.mass_kg + water) > most;
    warning_if(odd, INERTIA, [own, half], "")
}
