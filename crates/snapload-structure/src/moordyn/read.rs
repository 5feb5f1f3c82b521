//! From a MoorDyn file to the keys of a case.

use super::KEY_LINE;
use super::planar::{Body, Holds, Point, body, one_plane, points, refuse_unsupported};
use super::sections::{Row, Section, Sections, number};
use crate::InputError;
use crate::entries::{Entries, Value};
use snapload::CaseError;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// MoorDyn's own defaults \[m/s²\], \[kg/m³\].
const GRAVITY: f64 = 9.81;
const WATER_DENSITY: f64 = 1025.0;

/// The keys that a file gives, and what of it they do not hold.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The keys.
    pub entries: Entries,
    /// What was left out or taken otherwise, a sentence each.
    pub notes: Vec<String>,
}

/// Reads a MoorDyn v2 input file as a planar structure; `name` is what errors call it.
///
/// The file has no waves, no restitution and no width of the body: [`Entries::missing`] says what is still to be given.
///
/// # Errors
/// An [`InputError`] that names line, object and column, what is allowed there and what to do.
pub fn read(name: &str, text: &str) -> Result<Reading, InputError> {
    let sections = Sections::parse(name, text)?;
    for (section, header) in [
        (Section::LineTypes, "LINE TYPES"),
        (Section::Points, "POINTS"),
        (Section::Lines, "LINES"),
    ] {
        if !sections.has(section) {
            let allowed = format!("a header line such as ---------- {header} ----------");
            let error = CaseError::value(&format!("section {header}"), "(missing)", allowed);
            return Err(InputError {
                origin: name.to_owned(),
                error: Box::new(error.with_hint("is this an input file of MoorDyn version 2?")),
            });
        }
    }
    refuse_unsupported(&sections)?;
    let mut reader = Reader {
        entries: Entries::default(),
        notes: Vec::new(),
        site: Site::default(),
    };
    reader.options(&sections)?;
    let body = body(&sections)?;
    let points = points(&sections, body.as_ref())?;
    let mut used = Vec::new();
    for row in sections.rows(Section::Lines) {
        used.extend(reader.line(row, &sections, &points)?);
    }
    one_plane(body.as_ref(), used.into_iter())?;
    match &body {
        Some(body) => reader.body(body)?,
        None => reader.notes.push(
            "The file has no section BODIES: its points are coupled to a body that is not in it."
                .to_owned(),
        ),
    }
    if sections.rows(Section::Other).next().is_some() {
        let note = "Rows below a header that is not known were left out.";
        reader.notes.push(note.to_owned());
    }
    for (origin, line) in &sections.front {
        if let Some(set) = line
            .trim_start_matches(['#', ' ', '\t'])
            .strip_prefix(KEY_LINE)
        {
            reader.entries.set(set.trim()).map_err(|error| InputError {
                origin: origin.clone(),
                ..error
            })?;
        }
    }
    Ok(Reading {
        entries: reader.entries,
        notes: reader.notes,
    })
}

#[derive(Default)]
struct Site {
    water_density: f64,
}

struct Reader {
    entries: Entries,
    notes: Vec<String>,
    site: Site,
}

/// The ends of a line: its anchor and its fairlead.
type Ends<'a> = [&'a (&'a Row<'a>, Point); 2];

impl Reader {
    fn give(
        &mut self,
        row: &Row<'_>,
        table: &'static str,
        index: usize,
        key: &'static str,
        value: Value,
    ) -> Result<(), InputError> {
        let given = self.entries.give(table, index, key, value, &row.origin);
        given.map_err(|error| row.fault(error))
    }

    /// Depth, density and gravity; the other options are about MoorDyn's computation.
    fn options(&mut self, sections: &Sections<'_>) -> Result<(), InputError> {
        self.site.water_density = WATER_DENSITY;
        let origin = "MoorDyn's default";
        let mut defaults = vec![("gravity", GRAVITY), ("water_density", WATER_DENSITY)];
        for row in sections.rows(Section::Options) {
            let (Some(value), Some(option)) = (row.words.first(), row.words.get(1)) else {
                continue;
            };
            let lower = option.to_lowercase();
            let key = match lower.as_str() {
                "wtrdpth" | "depth" | "waterdepth" => "depth",
                "rho" | "rhow" | "wtrdnsty" | "wtrdens" => "water_density",
                "g" | "gravity" => "gravity",
                "wavekin" | "currents" | "seafloorfile" | "waterkin" => {
                    if number(value) != Some(0.0) {
                        self.notes.push(format!(
                            "{option} = {value} was left out: give [wave] or [sea]; the floor is flat and there is no current."
                        ));
                    }
                    continue;
                }
                _ => continue,
            };
            let value =
                number(value).ok_or_else(|| row.refuse(option, value, "a number before it"))?;
            if key == "water_density" {
                self.site.water_density = value;
            }
            defaults.retain(|(default, _)| *default != key);
            self.give(row, "site", 0, key, Value::Number(value))?;
        }
        for (key, value) in defaults {
            self.entries
                .give("site", 0, key, Value::Number(value), origin)?;
        }
        Ok(())
    }

    fn body(&mut self, body: &Body<'_>) -> Result<(), InputError> {
        let row = body.row;
        let [x, _, z] = body.place_m;
        self.give(row, "body", 0, "position", Value::Pair([x, z]))?;
        let (mass, volume) = (row.number(8, "Mass")?, row.number(11, "Volume")?);
        let inertia = row.numbers(10, "I")?;
        let inertia = match inertia[..] {
            [every] | [_, every, _] => every,
            _ => return Err(row.refuse("I", row.word(10, "I")?, "one number or Ix|Iy|Iz")),
        };
        if mass == 0.0 && volume == 0.0 {
            self.notes.push(
                "The body has neither mass nor volume in the file: another program moves it."
                    .to_owned(),
            );
            return Ok(());
        }
        self.give(row, "body", 0, "mass", Value::Number(mass))?;
        self.give(row, "body", 0, "displaced_volume", Value::Number(volume))?;
        self.give(row, "body", 0, "moment_of_inertia", Value::Number(inertia))?;
        let [drag, turning] = self.drag(row)?;
        self.give(row, "body", 0, "drag_area", Value::Number(drag))?;
        if turning != 0.0 {
            self.notes.push(format!(
                "The body's rotational drag, CdA = {turning}, was left out: here turning_damping is linear."
            ));
        }
        let added = row.numbers(13, "Ca")?;
        let added = match added[..] {
            [every] => every,
            [x, _, z] if x == z => z,
            _ => {
                let allowed = "one number, or three of which those for x and z are equal";
                return Err(row.refuse("Ca", row.word(13, "Ca")?, allowed));
            }
        };
        let added = added * volume * self.site.water_density;
        self.give(row, "body", 0, "added_mass", Value::Number(added))
    }

    /// C_d A in x and z, and about y.
    fn drag(&self, row: &Row<'_>) -> Result<[f64; 2], InputError> {
        let given = row.numbers(12, "CdA")?;
        match given[..] {
            [every] => Ok([every, every]),
            [moving, turning] => Ok([moving, turning]),
            [x, y, z] if x == z => Ok([x, y]),
            [x, _, z, _, turning, _] if x == z => Ok([x, turning]),
            _ => Err(row.refuse(
                "CdA",
                row.word(12, "CdA")?,
                "the same in x and z: one number, two (moving and turning), three or six",
            )),
        }
    }

    fn line<'a>(
        &mut self,
        row: &Row<'_>,
        sections: &Sections<'_>,
        points: &'a BTreeMap<&'a str, (&'a Row<'a>, Point)>,
    ) -> Result<Ends<'a>, InputError> {
        let ends = ends(row, points)?;
        let [anchor, fairlead] = ends.map(|(_, point)| {
            let [x, _, z] = point.place_m;
            Value::Pair([x, z])
        });
        let index = self.entries.add_line();
        self.give(row, "line", index, "anchor", anchor)?;
        self.give(row, "line", index, "fairlead", fairlead)?;
        let length = row.number(4, "UnstrLen")?;
        self.give(row, "line", index, "length", Value::Number(length))?;
        let name = row.word(1, "LineType")?;
        let mut types = sections.rows(Section::LineTypes);
        let Some(kind) = types.find(|kind| kind.words.first() == Some(&name)) else {
            let known: Vec<&str> = sections
                .rows(Section::LineTypes)
                .filter_map(|kind| kind.words.first().copied())
                .collect();
            let allowed = format!("a name from LINE TYPES: {}", known.join(", "));
            return Err(row.refuse("LineType", name, &allowed));
        };
        let mass = kind.number(2, "Mass/m")?;
        self.give(row, "line", index, "mass_per_length", Value::Number(mass))?;
        self.stiffness(row, kind, index)?;
        let diameter = kind.number(1, "Diam")?;
        let displaced = self.site.water_density * PI * diameter * diameter / 4.0;
        if (mass - displaced).abs() > 1e-3 * mass {
            self.notes.push(format!(
                "Line {} weighs {:.3} kg in the water, which was left out: lines are straight and weightless until they snap.",
                index + 1,
                (mass - displaced) * length
            ));
        }
        Ok(ends)
    }

    /// EA, of which MoorDyn has several forms.
    fn stiffness(&mut self, row: &Row<'_>, kind: &Row<'_>, index: usize) -> Result<(), InputError> {
        let word = kind.word(3, "EA")?;
        let parts: Option<Vec<f64>> = word.split('|').map(number).collect();
        let stiffness = match parts.as_deref() {
            Some([stiffness]) => *stiffness,
            Some([_, dynamic]) => {
                self.notes.push(format!(
                    "Line {}: of EA = {word} the second, dynamic one was taken, as a snap is quick.",
                    index + 1
                ));
                *dynamic
            }
            Some([_, constant, per_load]) => {
                self.notes.push(format!(
                    "Line {}: of EA = {word} the constant part of the dynamic stiffness was taken; {per_load} of the mean load is left out.",
                    index + 1
                ));
                *constant
            }
            Some(_) => {
                return Err(kind.refuse(
                    "EA",
                    word,
                    "EA, EA_static|EA_dynamic or EA_static|EA_constant|slope",
                ));
            }
            None => {
                self.notes.push(format!(
                    "Line {0}: EA = {word} is a table in a file, which was not read; give line.{0}.stiffness.",
                    index + 1
                ));
                return Ok(());
            }
        };
        self.give(row, "line", index, "stiffness", Value::Number(stiffness))
    }
}

/// The anchor and the fairlead of a line, whichever way round it is written.
fn ends<'a>(
    row: &Row<'_>,
    points: &'a BTreeMap<&'a str, (&'a Row<'a>, Point)>,
) -> Result<Ends<'a>, InputError> {
    let find = |index: usize, column: &str| {
        let id = row.word(index, column)?;
        let known = || points.keys().copied().collect::<Vec<_>>().join(", ");
        points.get(id).ok_or_else(|| {
            let allowed = format!("the number of a point: {}", known());
            let hint =
                "an end of a rod, such as R1A, is not supported; make it a point of the body";
            row.refuse_with(column, id, &allowed, hint)
        })
    };
    let (a, b) = (find(2, "AttachA")?, find(3, "AttachB")?);
    match (a.1.holds, b.1.holds) {
        (Holds::Ground, Holds::Body) => Ok([a, b]),
        (Holds::Body, Holds::Ground) => Ok([b, a]),
        (both, _) => {
            let shown = format!("{} and {}", row.words[2], row.words[3]);
            let (allowed, hint) = match both {
                Holds::Ground => (
                    "one end on the ground and one on the body; both are on the ground",
                    "take the line out, as it does not hold the body",
                ),
                Holds::Body => (
                    "one end on the ground and one on the body; both are on the body",
                    "snapload moors one body to the ground",
                ),
            };
            Err(row.refuse_with("AttachA and AttachB", &shown, allowed, hint))
        }
    }
}
