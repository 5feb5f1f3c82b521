//! Checks of conditions between the keys of a structure, each of which is valid by itself.

use crate::structure::Structure;
use snapload::CaseError;

/// The part of its length by which a line may be too short for the drawn fairlead, as drawings are
/// rounded; the body then rests a little lower.
const SHORTER_BY: f64 = 0.02;
/// A larger ratio of the masses along the two axes is refused as a typing error.
const LARGEST_MASS_RATIO: f64 = 1e6;

/// Refuses a current that would have no effect.
fn check_current(structure: &Structure) -> Result<(), CaseError> {
    let (body, current) = (&structure.body, structure.site.current_m_s);
    if current == 0.0 || body.drag_area_m2 + body.linear_damping_n_s_m > 0.0 {
        return Ok(());
    }
    let allowed =
        "0 for a body without drag_area or linear_damping, on which a current does not act";
    Err(CaseError::value("site.current", current, allowed)
        .with_hint("give body.drag_area, C_d times the area across the current"))
}

/// Refuses impossible data of a floating body.
fn check_afloat(structure: &Structure) -> Result<(), CaseError> {
    let body = &structure.body;
    let ([x, z], half) = (body.position_m, body.height_m / 2.0);
    let refuse = |allowed: String| {
        let shown = format!("[{x}, {z}]");
        Err(CaseError::value("body.position", shown, allowed))
    };
    if z.abs() >= half {
        return refuse(format!(
            "a centre within {half} m of the still water, half the body's height; a submerged \
             body has no [float]"
        ));
    }
    if z - half <= -structure.site.depth_m {
        return refuse("a body above the floor".to_owned());
    }
    check_anchors(structure)
}

/// Refuses anchors below the floor.
fn check_anchors(structure: &Structure) -> Result<(), CaseError> {
    let depth = structure.site.depth_m;
    let mut numbered = (1..).zip(&structure.lines);
    match numbered.find(|(_, line)| line.anchor_m[1] < -depth) {
        None => Ok(()),
        Some((number, line)) => {
            let [x, z] = line.anchor_m;
            let allowed = format!("an anchor on the floor or above it, z >= {}", -depth);
            let key = format!("line.{number}.anchor");
            Err(CaseError::value(&key, format!("[{x}, {z}]"), allowed))
        }
    }
}

/// Refuses masses that contradict each other.
fn check_masses(structure: &Structure) -> Result<(), CaseError> {
    let body = &structure.body;
    let [surge, heave] = body.moving_mass_kg();
    if !(heave / LARGEST_MASS_RATIO..=heave * LARGEST_MASS_RATIO).contains(&surge) {
        let allowed = format!(
            "at most {LARGEST_MASS_RATIO:e} times as much moving mass along one axis as along the other"
        );
        let added = &body.added_mass;
        let shown = format!(
            "[{}, {}, {}]",
            added.surge_kg, added.heave_kg, added.pitch_kg_m2
        );
        return Err(CaseError::value("body.added_mass", shown, allowed));
    }
    Ok(())
}

/// Refuses impossible data.
pub(super) fn check(structure: &Structure) -> Result<(), CaseError> {
    check_current(structure)?;
    match structure.afloat {
        Some(_) => check_afloat(structure),
        None => check_submerged(structure),
    }
}

/// Refuses impossible data of a submerged body.
fn check_submerged(structure: &Structure) -> Result<(), CaseError> {
    let body = &structure.body;
    let depth = structure.site.depth_m;
    let place = |[x, z]: [f64; 2]| format!("[{x}, {z}]");
    if structure.net_buoyancy_n() <= 0.0 {
        let allowed = format!(
            "less than the {:.0} kg of water that the body displaces, so that its net buoyancy \
             pulls on the lines",
            structure.displaced_mass_kg()
        );
        return Err(CaseError::value("body.mass", body.mass_kg, allowed)
            .with_hint("a body that sinks needs no mooring; check mass and displaced_volume"));
    }
    let [_, upward] = body.constant_force_n;
    if structure.net_buoyancy_n() + upward <= 0.0 {
        let allowed = format!(
            "a load with which some of the net buoyancy of {:.0} N still pulls on the lines",
            structure.net_buoyancy_n()
        );
        let shown = place(body.constant_force_n);
        return Err(CaseError::value("body.constant_force", shown, allowed));
    }
    check_masses(structure)?;
    let [_, z] = body.position_m;
    let shown = place(body.position_m);
    let lowest = z - body.height_m / 2.0;
    if lowest <= -depth {
        let allowed = format!(
            "a body above the floor; its lowest point would be at z = {lowest:.3}, the floor is at \
             {:.3}",
            -depth
        );
        return Err(CaseError::value("body.position", shown, allowed));
    }
    if z >= 0.0 {
        let allowed = "a centre below the still water, z < 0";
        return Err(CaseError::value("body.position", shown, allowed)
            .with_hint("z is up from the still water, so depths are negative"));
    }
    check_anchors(structure)?;
    for (index, line) in structure.lines.iter().enumerate() {
        let path = |key: &str| format!("line.{}.{key}", index + 1);
        let (anchor, fairlead) = (line.anchor_m, line.fairlead_m);
        let reach = (fairlead[0] - anchor[0]).hypot(fairlead[1] - anchor[1]);
        if reach > line.length_m * (1.0 + SHORTER_BY) {
            let least = (reach / (1.0 + SHORTER_BY) * 1e3).ceil() / 1e3;
            let allowed = format!(
                "at least {least:.3} m, 2 % less than the {reach:.3} m from its anchor to its \
                 fairlead"
            );
            return Err(CaseError::value(&path("length"), line.length_m, allowed)
                .with_hint("make the line longer, or move the body or the anchor"));
        }
    }
    Ok(())
}
