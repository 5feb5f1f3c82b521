//! From a structure to a file that MoorDyn v2 loads.

use super::KEY_LINE;
use crate::assess::Prepared;
use crate::elastic::springs;
use crate::structure::{Outline, SpectrumShape, Structure, Water};
use snapload::CaseError;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Internal damping of lines of several segments, as a part of the critical damping of a segment: the value of
/// MoorDyn's own examples.
const SEGMENT_DAMPING: f64 = 0.8;
/// The time step over the time in which a wave runs along a segment.
const COURANT: f64 = 0.2;

/// A structure's case for MoorDyn, each line in so many segments.
///
/// What a structure leaves out is made to vanish: lines displace as much as they weigh, and have neither drag nor added
/// mass. A line of one segment is then the spring of `docs/elastic.md`, with the damper of the restitution as BA; in
/// lines of several segments that damper would be far too stiff for the masses between, and they get MoorDyn's customary 0.8
/// of critical instead. The keys that MoorDyn has no place for stand in the front matter, from which
/// [`super::read()`] takes them.
///
/// # Errors
/// A [`CaseError`] if a line has no stiffness or mass, or the structure rests nowhere.
pub fn write(name: &str, structure: &Structure, segments: u32) -> Result<String, CaseError> {
    let prepared = Prepared::new(structure.clone())?;
    let mut text = String::from("--------------------- MoorDyn Input File ---------------------\n");
    let name: String = name.chars().filter(|c| !c.is_control()).collect();
    let _ = writeln!(text, "{}, written by snapload", name.replace("---", "-"));
    for (key, value) in kept(structure) {
        let _ = writeln!(text, "{KEY_LINE} {key} = {value}");
    }
    let step = types(&mut text, &prepared, segments)?;
    body(&mut text, structure);
    points_and_lines(&mut text, structure, segments);
    options(&mut text, structure, step);
    Ok(text)
}

/// The keys that MoorDyn has no place for.
fn kept(structure: &Structure) -> Vec<(String, String)> {
    let mut kept = Vec::new();
    let mut keep = |key: &str, value: String| kept.push((key.to_owned(), value));
    let pair = |[x, z]: [f64; 2]| format!("[{x}, {z}]");
    let body = &structure.body;
    match body.outline {
        Outline::Circle => keep("body.shape", "circle".to_owned()),
        Outline::Rectangle => {
            keep("body.shape", "rectangle".to_owned());
            keep("body.height", body.height_m.to_string());
        }
    }
    keep("body.width", body.width_m.to_string());
    keep("body.linear_damping", body.linear_damping_n_s_m.to_string());
    keep(
        "body.turning_damping",
        body.turning_damping_n_m_s.to_string(),
    );
    keep("body.position", pair(body.position_m));
    for (index, line) in structure.lines.iter().enumerate() {
        let number = index + 1;
        // Where the body starts elsewhere its points move with it, but these are drawn with the body at position.
        keep(&format!("line.{number}.fairlead"), pair(line.fairlead_m));
        if let Some(load) = line.breaking_load_n {
            keep(&format!("line.{number}.breaking_load"), load.to_string());
        }
    }
    let direction = if structure.heading < 0.0 { "-x" } else { "+x" };
    match structure.water {
        Water::Still => {}
        Water::Wave(wave) => {
            keep("wave.height", wave.height_m.to_string());
            keep("wave.period", wave.period_s.to_string());
            keep("wave.direction", direction.to_owned());
        }
        Water::Sea(sea) => {
            match sea.shape {
                SpectrumShape::Jonswap(gamma) => {
                    keep("sea.spectrum", "jonswap".to_owned());
                    keep("sea.gamma", gamma.to_string());
                }
                SpectrumShape::PiersonMoskowitz => {
                    keep("sea.spectrum", "pierson-moskowitz".to_owned());
                }
            }
            keep("sea.hs", sea.significant_height_m.to_string());
            keep("sea.tp", sea.peak_period_s.to_string());
            keep("sea.seed", sea.seed.to_string());
            keep("sea.components", sea.components.to_string());
            keep("sea.direction", direction.to_owned());
        }
    }
    keep("run.restitution", structure.restitution.to_string());
    keep("run.duration", structure.duration_s.to_string());
    keep("run.transient", structure.transient_s.to_string());
    if let Some(start) = structure.start_m {
        keep("run.start", pair(start));
    }
    keep("run.max_snaps", structure.max_snaps.to_string());
    kept
}

/// A type a line; returns the time step that their stiffness asks for \[s\].
fn types(text: &mut String, prepared: &Prepared, segments: u32) -> Result<f64, CaseError> {
    let structure = &prepared.structure;
    let springs = springs(prepared, 1.0)?;
    let scales = &prepared.model.scales;
    let unit = scales.force_n / scales.length_m * scales.time_s;
    *text += "---------------------- LINE TYPES ----------------------\n\
        TypeName  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx\n\
        (name)  (m)  (kg/m)  (N)  (N-s/-)  (N-m^2)  (-)  (-)  (-)  (-)\n";
    let mut step = f64::INFINITY;
    for (index, (line, spring)) in structure.lines.iter().zip(&springs).enumerate() {
        let missing = |key: &str, needs: &str| {
            let key = format!("line.{}.{key}", index + 1);
            CaseError::value(&key, "(left out)", needs).with_hint("or give a type and a diameter")
        };
        let stiffness = line.stiffness_n.ok_or_else(|| {
            missing(
                "stiffness",
                "a stiffness EA in N, without which MoorDyn has no line",
            )
        })?;
        let mass = line.mass_per_length_kg_m.ok_or_else(|| {
            missing(
                "mass_per_length",
                "a mass in kg/m, without which MoorDyn has no line",
            )
        })?;
        let diameter = (4.0 * mass / (PI * structure.site.water_density_kg_m3)).sqrt();
        let damping = if segments == 1 {
            spring.damping * unit * line.length_m
        } else {
            -SEGMENT_DAMPING
        };
        step = step.min(COURANT * line.length_m / f64::from(segments) * (mass / stiffness).sqrt());
        let _ = writeln!(
            text,
            "line{}  {diameter}  {mass}  {stiffness}  {damping}  0  0  0  0  0",
            index + 1
        );
    }
    Ok(step)
}

fn body(text: &mut String, structure: &Structure) {
    let body = &structure.body;
    let [x, z] = structure.start_m.unwrap_or(body.position_m);
    let _ = write!(
        text,
        "---------------------- BODIES ----------------------\n\
        ID  Attachment  X0  Y0  Z0  r0  p0  y0  Mass  CG  I  Volume  CdA  Ca\n\
        (#)  (word)  (m)  (m)  (m)  (deg)  (deg)  (deg)  (kg)  (m)  (kg-m^2)  (m^3)  (m^2)  (-)\n\
        1  Free  {x}  0  {z}  0  0  0  {}  0  {}  {}  {}|0  {}\n",
        body.mass_kg,
        body.moment_of_inertia_kg_m2,
        body.displaced_volume_m3,
        body.drag_area_m2,
        structure.added_mass_coefficient(),
    );
}

fn points_and_lines(text: &mut String, structure: &Structure, segments: u32) {
    let position = structure.body.position_m;
    *text += "---------------------- POINTS ----------------------\n\
        ID  Attachment  X  Y  Z  Mass  Volume  CdA  Ca\n\
        (#)  (word/ID)  (m)  (m)  (m)  (kg)  (m^3)  (m^2)  (-)\n";
    for (index, line) in structure.lines.iter().enumerate() {
        let [x, z] = line.anchor_m;
        let arm = [0, 1].map(|i| line.fairlead_m[i] - position[i]);
        let _ = writeln!(text, "{}  Fixed  {x}  0  {z}  0  0  0  0", 2 * index + 1);
        let _ = writeln!(
            text,
            "{}  Body1  {}  0  {}  0  0  0  0",
            2 * index + 2,
            arm[0],
            arm[1]
        );
    }
    *text += "---------------------- LINES ----------------------\n\
        ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  LineOutputs\n\
        (#)  (name)  (ID)  (ID)  (m)  (-)  (-)\n";
    for (index, line) in structure.lines.iter().enumerate() {
        let number = index + 1;
        let _ = writeln!(
            text,
            "{number}  line{number}  {}  {}  {}  {segments}  -",
            2 * index + 1,
            2 * index + 2,
            line.length_m
        );
    }
}

fn options(text: &mut String, structure: &Structure, step_s: f64) {
    let site = &structure.site;
    *text += "---------------------- OPTIONS ----------------------\n";
    let mut option = |value: String, key: &str, words: &str| {
        let _ = writeln!(text, "{value}  {key}  {words}");
    };
    option(format!("{step_s:.1e}"), "dtM", "time step of the lines (s)");
    option(site.depth_m.to_string(), "WtrDpth", "depth (m)");
    option(
        site.water_density_kg_m3.to_string(),
        "rho",
        "density of the water (kg/m^3)",
    );
    option(site.gravity_m_s2.to_string(), "g", "gravity (m/s^2)");
    if structure.start_m.is_some() {
        option(
            "0".to_owned(),
            "TmaxIC",
            "no relaxation: the body starts where it is put",
        );
    }
    *text += "---------------------- need this line ----------------------\n";
}
