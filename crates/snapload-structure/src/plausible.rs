//! What can not be (errors), and what is outside the range in which the theory holds (warnings).

use crate::equilibrium::Equilibrium;
use crate::structure::{Structure, Water};
use crate::wave::LinearWave;
use snapload::CaseError;
use std::f64::consts::PI;

/// A line may fall short of the drawn fairlead by this part of its length, as drawings are rounded; the body then
/// rests a little lower.
const ROUNDED: f64 = 0.02;
/// The highest wave of a three-hour sea is near this many significant heights: sqrt(ln 1000 / 2) for a thousand
/// Rayleigh-distributed waves (M. S. Longuet-Higgins, *J. Mar. Res.* 11 (1952) 245).
const HIGHEST: f64 = 1.86;

/// A phase of the wave that is off by this much is no longer small \[rad\].
const MOST_PHASE: f64 = 0.3;

/// A doubt about a case that can be computed all the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// The rule's name.
    pub rule: &'static str,
    /// What is the matter, with the numbers.
    pub message: String,
}

/// Refuses what can not be.
pub(crate) fn check(structure: &Structure) -> Result<(), CaseError> {
    let body = &structure.body;
    let depth = structure.site.depth_m;
    if structure.net_buoyancy_n() <= 0.0 {
        let displaced = structure.displaced_mass_kg();
        let allowed = format!(
            "less than the {displaced:.0} kg of water that the body displaces, so that its net buoyancy pulls on the lines"
        );
        return Err(CaseError::value("body.mass", body.mass_kg, allowed)
            .with_hint("a body that sinks needs no mooring; check mass and displaced_volume"));
    }
    let [_, z] = body.position_m;
    if z - body.height_m / 2.0 <= -depth {
        let allowed = format!(
            "a body above the floor; its lowest point would be at z = {:.3}, the floor is at {:.3}",
            z - body.height_m / 2.0,
            -depth
        );
        return Err(CaseError::value(
            "body.position",
            format!("[{}, {z}]", body.position_m[0]),
            allowed,
        ));
    }
    if z >= 0.0 {
        return Err(CaseError::value(
            "body.position",
            format!("[{}, {z}]", body.position_m[0]),
            "a centre below the still water, z < 0",
        )
        .with_hint("z is up from the still water, so depths are negative"));
    }
    for (index, line) in structure.lines.iter().enumerate() {
        let path = |key: &str| format!("line.{}.{key}", index + 1);
        if line.anchor_m[1] < -depth {
            let allowed = format!("an anchor on the floor or above it, z >= {}", -depth);
            let shown = format!("[{}, {}]", line.anchor_m[0], line.anchor_m[1]);
            return Err(CaseError::value(&path("anchor"), shown, allowed));
        }
        let reach =
            (line.fairlead_m[0] - line.anchor_m[0]).hypot(line.fairlead_m[1] - line.anchor_m[1]);
        if reach > line.length_m * (1.0 + ROUNDED) {
            let allowed = format!("at least the {reach:.3} m from its anchor to its fairlead");
            return Err(CaseError::value(&path("length"), line.length_m, allowed)
                .with_hint("make the line longer, or put the body or the anchor elsewhere"));
        }
    }
    Ok(())
}

/// The rules of thumb that a structure breaks, as it rests.
pub fn warnings(structure: &Structure, rest: &Equilibrium) -> Vec<Warning> {
    let mut found = Vec::new();
    let mut warn = |rule: &'static str, message: String| found.push(Warning { rule, message });
    let body = &structure.body;
    let z_m = rest.place_m[1];
    let half = body.half_height_m(rest.theta_rad);
    let (top, bottom) = (z_m + half, z_m - half);
    if rest.indeterminate {
        warn(
            "shared loads",
            "more lines are taut at rest than hold the body: which of them carries how much depends on their stiffness, which the \
             inextensible line does not know. They share as lines of equal stiffness that lie side by side do, with the least sum \
             of squares"
                .to_owned(),
        );
    }
    let depth = structure.site.depth_m;
    let size = body.width_m.max(body.height_m);
    if top > 0.0 {
        warn(
            "submergence",
            format!(
                "the body stands {top:.2} m out of the still water; its buoyancy and the forces of the waves are taken as those of a submerged one"
            ),
        );
    } else if -top < body.height_m / 2.0 {
        warn(
            "free surface",
            format!(
                "the body's top is {:.2} m below the still water, less than half its height; its added mass then depends on the frequency and it makes waves of its own, which is left out",
                -top
            ),
        );
    }
    if bottom + depth < body.height_m / 2.0 {
        warn(
            "floor",
            format!(
                "the body's bottom is {:.2} m above the floor, less than half its height; its added mass there is larger than far from walls",
                bottom + depth
            ),
        );
    }
    let Some((highest, wave)) = governing_wave(structure, z_m) else {
        lines_mass(structure, &mut warn);
        return found;
    };
    let kd = wave.wave_number_1_m * depth;
    let length = wave.length_m();
    let words = match structure.water {
        Water::Sea(_) => {
            format!("the highest wave of three hours, about {HIGHEST} Hs = {highest:.2} m")
        }
        _ => format!("the wave, {highest:.2} m"),
    };
    let limit = 0.142 * kd.tanh();
    let steepness = highest / length;
    if steepness > limit {
        warn(
            "breaking (Miche)",
            format!(
                "{words}, has the steepness H/λ = {steepness:.3}, above 0.142 tanh kd = {limit:.3}: it breaks before it gets so high"
            ),
        );
    }
    let ursell = highest * length * length / depth.powi(3);
    if ursell > 26.0 {
        warn(
            "linear theory (Ursell)",
            format!(
                "H λ²/d³ = {ursell:.0} is above 26, so {words}, is not sinusoidal any more: crests are higher and sharper than computed"
            ),
        );
    }
    if top > -highest / 2.0 && top <= 0.0 {
        warn(
            "submergence",
            format!(
                "the troughs of {words}, reach z = {:.2} m, below the body's top at {top:.2} m",
                -highest / 2.0
            ),
        );
    }
    let stroke = wave.a_x_m_s2 / (wave.omega_rad_s * wave.omega_rad_s);
    let keulegan = 2.0 * PI * stroke / size;
    if keulegan > 5.0 && structure.body.drag_area_m2 == 0.0 {
        warn(
            "inertia (Keulegan-Carpenter)",
            format!(
                "KC = {keulegan:.1} is above 5: drag is no longer small beside the inertia force, and drag_area is not given"
            ),
        );
    }
    let across = size / length;
    if across > 0.2 {
        warn(
            "diffraction",
            format!(
                "the body's size is {across:.2} of the wave length, above 0.2: it changes the waves, and Froude-Krylov with added mass is not enough"
            ),
        );
    }
    contact_time(structure, wave.omega_rad_s, &mut warn);
    lines_mass(structure, &mut warn);
    found
}

/// The doubt about a body that moves so far that the wave's phase where it is differs from that where it rests.
pub(crate) fn phase_warning(structure: &Structure, z_m: f64, excursion_m: f64) -> Option<Warning> {
    let (_, wave) = governing_wave(structure, z_m)?;
    let phase = wave.wave_number_1_m * excursion_m;
    (phase > MOST_PHASE).then(|| Warning {
        rule: "phase",
        message: format!("the body moves {excursion_m:.2} m to the side, where the wave's phase differs by {:.0} degrees from that of the place of rest, at which its force is taken", phase.to_degrees()),
    })
}

/// The wave by which a structure is judged: the regular one, or the highest of a sea at its peak period.
fn governing_wave(structure: &Structure, z_m: f64) -> Option<(f64, LinearWave)> {
    let (height, omega) = match structure.water {
        Water::Still => return None,
        Water::Wave(wave) => (wave.height_m, wave.omega_rad_s()),
        Water::Sea(sea) => (
            HIGHEST * sea.significant_height_m,
            2.0 * PI / sea.peak_period_s,
        ),
    };
    Some((
        height,
        LinearWave::new(&structure.site, height / 2.0, omega, z_m),
    ))
}

/// The engine's snap takes no time; a line of spring rate k takes half a period, π sqrt(M/k).
fn contact_time(
    structure: &Structure,
    omega_rad_s: f64,
    warn: &mut impl FnMut(&'static str, String),
) {
    let period = 2.0 * PI / omega_rad_s;
    let soft: Vec<String> = structure
        .lines
        .iter()
        .enumerate()
        .filter_map(|(line, properties)| {
            let rate = properties.spring_rate_n_m()?;
            let lasts = PI * (structure.moving_mass_kg() / rate).sqrt();
            (lasts > 0.1 * period).then(|| format!("{lasts:.2} s in line {}", line + 1))
        })
        .collect();
    if !soft.is_empty() {
        warn(
            "instant snap",
            format!(
                "a snap lasts about π sqrt(M/k) = {}, more than a tenth of the period of {period:.1} s: such a line is too soft to be taken as inextensible, and its tensions are not to be believed",
                soft.join(", ")
            ),
        );
    }
}

fn lines_mass(structure: &Structure, warn: &mut impl FnMut(&'static str, String)) {
    let mass: f64 = structure
        .lines
        .iter()
        .filter_map(|line| line.mass_per_length_kg_m.map(|mass| mass * line.length_m))
        .sum();
    let part = mass / structure.moving_mass_kg();
    if part > 0.1 {
        warn(
            "light lines",
            format!(
                "the lines have {:.0} % of the mass that moves; they are taken as massless while they do not snap",
                100.0 * part
            ),
        );
    }
}
