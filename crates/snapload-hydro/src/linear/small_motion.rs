//! The limits of linear theory: motions that are small compared with the draft, in a position in
//! which the body's sides pierce the surface.

use super::body::Body;
use super::rest::Rest;
use crate::coefficients::Hydrodynamics;
use crate::digits::{decimals, digits, kilo};
use crate::error::Warning;

/// Linear hydrostatics hold for less pitch than this \[degrees\].
pub const LARGE_PITCH: f64 = 15.0;
/// The largest part of the draft that a small heave may be.
const LARGE_HEAVE: f64 = 0.5;
/// A place of rest further from the file's than this part of the draft, or in pitch \[rad\], needs
/// coefficients of its own.
const FAR: f64 = 0.1;
const FAR_PITCH: f64 = 0.05;

/// ρV over the waterplane, which is the draft of a body with vertical sides \[m\].
pub(crate) fn draft_m(hydro: &Hydrodynamics, body: &Body) -> Option<f64> {
    let weight = hydro.hydrostatics.displaced_mass_kg? * hydro.water.gravity_m_s2;
    let draft_m = weight / body.stiffness[(1, 1)];
    (draft_m > 0.0 && draft_m.is_finite()).then_some(draft_m)
}

/// The warnings about a motion that is not small, given its amplitudes of
/// heave and pitch and what it is.
pub fn large_motion(
    hydro: &Hydrodynamics,
    body: &Body,
    [heave_m, pitch_rad]: [f64; 2],
    motion: &str,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let draft_m = draft_m(hydro, body);
    let half = draft_m.map(|draft_m| LARGE_HEAVE * draft_m);
    if let Some(half) = half.filter(|half| heave_m.abs() > *half) {
        let message = format!(
            "{motion} has {} m of heave, more than {} m, half of the draft: the waterplane and the forces of the \
             water then differ from those computed",
            digits(&heave_m.abs(), 2),
            digits(&half, 2)
        );
        warnings.push(Warning::new("small heave", message));
    }
    let degrees = pitch_rad.abs().to_degrees();
    if degrees > LARGE_PITCH {
        let message = format!(
            "{motion} has {degrees:.0} degrees of pitch, more than {LARGE_PITCH}: hydrostatics are then no longer \
             linear"
        );
        warnings.push(Warning::new("small pitch", message));
    }
    warnings
}

/// The warning about a place at which a body rests or floats, in words, that is not that of the
/// file.
pub fn far_from_the_file(
    hydro: &Hydrodynamics,
    body: &Body,
    q: [f64; 3],
    rests: &str,
) -> Option<Warning> {
    let draft_m = draft_m(hydro, body);
    let far = draft_m.is_some_and(|draft_m| q[1].abs() > FAR * draft_m);
    if !far && q[2].abs() <= FAR_PITCH {
        return None;
    }
    let message = format!(
        "the body {rests} {:.3} m {} its position in the file and at {}° of pitch from it; \
         compute the file again at the place of rest",
        q[1].abs(),
        if q[1] < 0.0 { "below" } else { "above" },
        decimals(&q[2].to_degrees(), 1)
    );
    Some(Warning::new("place of rest", message))
}

/// The warning that a body rests clear of the water, where it no longer weighs more, or that its
/// sides have to be higher than a file says.
pub(crate) fn beyond_hydrostatics(
    hydro: &Hydrodynamics,
    body: &Body,
    rest: &Rest,
) -> Option<Warning> {
    let draft_m = draft_m(hydro, body)?;
    let (heave_m, tension) = (rest.q[1], rest.tension_n.iter().any(|pull| *pull > 0.0));
    if !tension || heave_m.abs() <= LARGE_HEAVE * draft_m {
        return None;
    }
    let water_n = body.constant_force[1] - (body.stiffness * rest.q)[1];
    let message = if heave_m > draft_m {
        let displaced_kg = hydro.hydrostatics.displaced_mass_kg?;
        let weight_n = displaced_kg * hydro.water.gravity_m_s2 - body.constant_force[1];
        format!(
            "the body rests {} m above its position in the file, more than its draft of {} m: its lines would hold \
             it up with {} kN, but clear of the water it weighs only {} kN; the tensions are not possible",
            digits(&heave_m, 2),
            digits(&draft_m, 2),
            kilo(&-water_n, 1),
            kilo(&weight_n, 1)
        )
    } else if heave_m < 0.0 {
        format!(
            "the body rests {} m below its position in the file: the tensions are those of vertical sides that are \
             at least as high above the water there; a body whose deck goes under water lifts less",
            digits(&-heave_m, 2)
        )
    } else {
        return None;
    };
    Some(Warning::new("hydrostatics", message))
}
