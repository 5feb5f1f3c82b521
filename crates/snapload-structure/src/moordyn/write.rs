//! From a structure to a file that MoorDyn v2 loads.

use crate::options::{SEGMENTS, check};
use crate::physics::elastic::elastic_lines;
use crate::physics::model_at_rest::ModelAtRest;
use crate::structure::{BodySi, Outline, Site, SpectrumShape, Structure, Water};
use askama::Template;
use snapload::{CaseError, Value};
use std::f64::consts::PI;

/// Internal damping of lines of several segments, as a part of the critical damping of a segment:
/// the value of MoorDyn's own examples.
const SEGMENT_DAMPING: f64 = 0.8;
/// The ratio of the time step to the time in which a wave travels along a segment.
const COURANT: f64 = 0.2;

#[derive(Template)]
#[template(path = "moordyn.txt")]
struct File<'a> {
    name: String,
    /// The keys of the project that are given, with their texts in quotes.
    project: Vec<(&'a str, String)>,
    structure: &'a Structure,
    body: &'a BodySi,
    site: &'a Site,
    start_m: [f64; 2],
    segments: u32,
    /// Ca, by axis where it differs.
    added_mass: String,
    /// Whether the added mass differs by axis.
    uneven_added_mass: bool,
    /// Whether the added mass has parts besides a Ca.
    own_added_mass: bool,
    /// The loads of which its tables have nothing.
    alone: String,
    /// Diameter, mass per length, stiffness and damping of each line.
    types: Vec<[f64; 4]>,
    step_s: f64,
}

/// The keys of the project with their texts, each on one line and in quotes. Three hyphens begin a
/// section of the file wherever they stand: of two that stand together the second is escaped.
fn project(structure: &Structure) -> Vec<(&str, String)> {
    let quoted = |text: &str| Value::from(text).to_string().replace("--", "-\\u002D");
    let rows = structure.project.rows().into_iter();
    rows.map(|[key, _, text]| (key, quoted(text))).collect()
}

/// The name of a case on one line, which begins no section.
fn title(name: &str) -> String {
    let mut title: String = name.chars().filter(|c| !c.is_control()).collect();
    while title.contains("---") {
        title = title.replace("---", "-");
    }
    title
}

/// A structure's case in MoorDyn's format, each line in `segments` segments.
///
/// Effects that a structure does not include are set to zero: lines displace as much as they weigh,
/// and have neither drag nor added mass. A line of one segment is then the spring of
/// `docs/elastic.md`, with the damper of the restitution as BA; in lines of several segments that
/// damper would be far too stiff for the masses between, and they get MoorDyn's customary 0.8 of
/// critical instead. Keys without an equivalent in MoorDyn, and those of which its tables have only
/// a sum, are written into the front matter, from which [`super::read()`] reads them.
///
/// # Errors
/// A [`CaseError`] unless the segments are of [`SEGMENTS`], if a line has no stiffness or mass, or
/// the structure rests nowhere.
pub fn write(name: &str, structure: &Structure, segments: u32) -> Result<String, CaseError> {
    check(&SEGMENTS, i64::from(segments))?;
    if structure.afloat.is_some() {
        let allowed = "nothing: MoorDyn has no floating body with hydrodynamic coefficients";
        return Err(CaseError::value("[float]", "(given)", allowed));
    }
    let prepared = ModelAtRest::new(structure.clone())?;
    let types = types(&prepared, segments)?;
    let length_s = |(line, [_, mass, stiffness, _]): (&crate::LineSi, &[f64; 4])| {
        COURANT * line.length_m / f64::from(segments) * (mass / stiffness).sqrt()
    };
    let steps_s = structure.lines.iter().zip(&types).map(length_s);
    let [along, up] = structure.added_mass_coefficients();
    let same = along == up;
    let file = File {
        added_mass: match same {
            true => along.to_string(),
            false => format!("{along}|{along}|{up}"),
        },
        uneven_added_mass: !same,
        own_added_mass: !same || structure.body.added_mass.pitch_kg_m2 > 0.0,
        alone: loads_without_a_table(structure).join(", "),
        name: title(name),
        project: project(structure),
        structure,
        body: &structure.body,
        site: &structure.site,
        start_m: structure.start_m.unwrap_or(structure.body.position_m),
        segments,
        step_s: steps_s.fold(f64::INFINITY, f64::min),
        types,
    };
    Ok(file.to_string() + "\n")
}

/// The loads that a file for MoorDyn has in its front matter only.
fn loads_without_a_table(structure: &Structure) -> Vec<&'static str> {
    let (body, site) = (&structure.body, &structure.site);
    let loads = [
        ("waves", structure.has_waves()),
        ("body.constant_force", body.constant_force_n != [0.0, 0.0]),
        ("site.current", site.current_m_s != 0.0),
        ("body.linear_damping", body.linear_damping_n_s_m != 0.0),
        ("body.turning_damping", body.turning_damping_n_m_s != 0.0),
    ];
    let acting = loads.into_iter().filter(|(_, acts)| *acts);
    acting.map(|(name, _)| name).collect()
}

/// One type for each line.
fn types(prepared: &ModelAtRest, segments: u32) -> Result<Vec<[f64; 4]>, CaseError> {
    let (structure, scales) = (&prepared.structure, &prepared.model.scales);
    let unit = scales.force_n / scales.length_m * scales.time_s;
    // The damper of the restitution, which lines of several segments do not have.
    let springs = match segments {
        1 => Some(elastic_lines(prepared, 1.0)?),
        _ => None,
    };
    let one = |(index, line): (usize, &crate::LineSi)| {
        let number = index + 1;
        let needed = |value: Option<f64>, key: &str, what: &str| {
            value.ok_or_else(|| {
                let allowed = format!("a {what}, which a line of MoorDyn needs");
                CaseError::value(&format!("line.{number}.{key}"), "(left out)", allowed)
                    .with_hint("or give a type and a diameter")
            })
        };
        let stiffness = needed(line.stiffness_n, "stiffness", "stiffness EA in N")?;
        let mass = needed(line.mass_per_length_kg_m, "mass_per_length", "mass in kg/m")?;
        let diameter = (4.0 * mass / (PI * structure.site.water_density_kg_m3)).sqrt();
        let damping = match &springs {
            Some(springs) => springs[index].damping * unit * line.length_m,
            None => -SEGMENT_DAMPING,
        };
        Ok([diameter, mass, stiffness, damping])
    };
    structure.lines.iter().enumerate().map(one).collect()
}
