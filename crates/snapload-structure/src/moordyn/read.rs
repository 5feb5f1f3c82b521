//! From a MoorDyn file to the keys of a case.

use super::front::{LineRow, MOORDYN_DEFAULT, Tables};
use super::planar::{
    Body, Point, PointOf, Points, body, points, refuse_off_plane, refuse_unsupported,
};
use super::sections::{Row, Section, Sections, number};
use crate::schema::STRUCTURE;
use snapload::{CaseError, Entries, Value};
use std::f64::consts::PI;

/// MoorDyn's own defaults \[m/s²\], \[kg/m³\].
const GRAVITY: f64 = 9.806_65;
const WATER_DENSITY: f64 = 1025.0;

/// The keys that a file gives, and notes on what they do not represent.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The keys.
    pub entries: Entries,
    /// What was left out or changed, one sentence each.
    pub notes: Vec<String>,
}

/// Reads a MoorDyn v2 input file as a planar structure; `name` is the file's name in errors.
///
/// The tables have no waves, no restitution and no width of the body: [`Entries::missing`] lists
/// what still has to be given. Keys in the front matter apply where the tables do not contradict
/// them; the others are noted.
///
/// # Errors
/// A [`CaseError`] that names line, object and column, what is allowed there and advice.
pub fn read(name: &str, text: &str) -> Result<Reading, CaseError> {
    let sections = Sections::parse(name, text)?;
    refuse_incomplete(name, &sections)?;
    refuse_unsupported(&sections)?;
    let mut reader = Reader {
        tables: Tables {
            entries: Entries::new(&STRUCTURE),
            lines: Vec::new(),
            starts_where_put: false,
        },
        notes: Vec::new(),
        water_density: WATER_DENSITY,
    };
    reader.options(&sections)?;
    let body = body(&sections)?;
    let points = points(&sections, body.as_ref())?;
    let mut used = Vec::new();
    for row in sections.rows(Section::Lines) {
        let ends = reader.line(row, &sections, &points)?;
        reader.keep_row(row, ends, body.is_some())?;
        used.extend(ends);
    }
    refuse_off_plane(body.as_ref(), used.into_iter())?;
    match &body {
        Some(body) => reader.body(body)?,
        None => reader.note(
            "The file has no section BODIES: its points are coupled to a body that is not in it.",
        ),
    }
    if sections.rows(Section::Other).next().is_some() {
        reader.note("Rows below a header that is not known were left out.");
    }
    let Reader {
        tables, mut notes, ..
    } = reader;
    let types: Vec<String> = tables
        .lines
        .iter()
        .map(|row| row.type_name.clone())
        .collect();
    let entries = tables.with_front(&sections, &mut notes)?;
    let by_restitution = entries.table("run", 0).given("restitution").is_some();
    let kinds = sections.rows(Section::LineTypes);
    let used = kinds.filter(|kind| types.iter().any(|name| kind.words[0] == name));
    notes.extend(used.flat_map(|kind| left_out_of_type(kind, by_restitution)));
    let added_mass = entries.table("body", 0).given("added_mass");
    let uneven = added_mass
        .and_then(Value::triple)
        .is_some_and(|[x, z, _]| x != z);
    // A file that `write` made says so itself.
    if uneven && !by_restitution {
        notes.push(
            "The added mass differs by axis: MoorDyn turns it with the body, and here it keeps the \
             axes at rest."
                .to_owned(),
        );
    }
    Ok(Reading { entries, notes })
}

/// Options, in small letters, that have no part in what snapload computes: steps, the contact of
/// lines with the floor, the search for a start, output.
const COMPUTATION: [&str; 32] = [
    "dtm",
    "dt",
    "tscheme",
    "kbot",
    "kb",
    "cbot",
    "cb",
    "dtic",
    "icdt",
    "cdscaleic",
    "icdfac",
    "threshic",
    "icthresh",
    "icgendynamic",
    "dtwave",
    "unifycurrentgrid",
    "writeunits",
    "writelog",
    "frictioncoefficient",
    "fricdamp",
    "statdynfricscale",
    "mu_kt",
    "mu_ka",
    "mc",
    "cv",
    "dtout",
    "disableoutput",
    "disableouttime",
    "outswitch",
    "inertialf",
    "inertialf_rampt",
    "writevtk",
];

/// Refuses a file without one of the sections that describe lines.
fn refuse_incomplete(name: &str, sections: &Sections<'_>) -> Result<(), CaseError> {
    for (section, header) in [
        (Section::LineTypes, "LINE TYPES"),
        (Section::Points, "POINTS"),
        (Section::Lines, "LINES"),
    ] {
        if !sections.has(section) {
            let allowed = format!("a header line such as ---------- {header} ----------");
            let error = CaseError::value(&format!("section {header}"), "(missing)", allowed);
            let hint = "is this an input file of MoorDyn version 2?";
            return Err(error.with_hint(hint).at(name));
        }
    }
    Ok(())
}

/// Notes on the columns of a type that a case can not represent. A restitution in the front matter
/// is what `write` made the internal damping of.
fn left_out_of_type(kind: &Row<'_>, by_restitution: bool) -> Vec<String> {
    let given = |index: usize, column: &str| {
        let word = kind
            .words
            .get(index)
            .filter(|word| number(word) != Some(0.0))?;
        Some(format!("{column} = {word}"))
    };
    let columns = ["EI", "Cd", "Ca", "CdAx", "CaAx"];
    let water = (5..)
        .zip(columns)
        .filter_map(|(index, column)| given(index, column));
    let water = water.collect::<Vec<_>>().join(", ");
    // Without a lift coefficient MoorDyn computes no vibration.
    let lift = given(10, "Cl").filter(|_| number(kind.words[10]).is_some());
    let name = kind.words[0];
    let damping = given(4, "BA").filter(|_| !by_restitution);
    let damping = damping.map(|damping| {
        format!("Type {name}: {damping} was left out: run.restitution has its place.")
    });
    let water = (!water.is_empty()).then(|| {
        format!("Type {name}: {water} left out: lines have no bending, drag or added mass.")
    });
    let vibration = lift.map(|lift| {
        format!("Type {name}: {lift} was left out: lines have no vortex-induced vibration.")
    });
    damping.into_iter().chain(water).chain(vibration).collect()
}

struct Reader {
    tables: Tables,
    notes: Vec<String>,
    water_density: f64,
}

/// The ends of a line: its anchor and its fairlead.
type Ends<'a> = [&'a (&'a Row<'a>, Point); 2];

impl Reader {
    fn note(&mut self, words: impl Into<String>) {
        self.notes.push(words.into());
    }

    fn give(
        &mut self,
        row: &Row<'_>,
        (table, index): (&'static str, usize),
        key: &'static str,
        value: impl Into<Value>,
    ) -> Result<(), CaseError> {
        let value = value.into();
        self.tables
            .entries
            .give(table, index, key, value, &row.origin)
    }

    /// Depth, density and gravity; the options of [`COMPUTATION`] concern MoorDyn alone.
    fn options(&mut self, sections: &Sections<'_>) -> Result<(), CaseError> {
        let mut defaults = vec![("gravity", GRAVITY), ("water_density", WATER_DENSITY)];
        for row in sections.rows(Section::Options) {
            let [word, option, ..] = row.words[..] else {
                continue;
            };
            let key = match option.to_lowercase().as_str() {
                "wtrdpth" | "depth" | "waterdepth" => "depth",
                "rho" | "rhow" | "wtrdnsty" | "wtrdens" => "water_density",
                "g" | "gravity" => "gravity",
                "tmaxic" | "ictmax" => {
                    self.tables.starts_where_put = number(word) == Some(0.0);
                    continue;
                }
                computation if COMPUTATION.contains(&computation) => continue,
                left_out => {
                    if number(word) != Some(0.0) {
                        let instead = match left_out {
                            "currents" => "give a current as site.current",
                            "seafloorfile" => "the floor is flat",
                            "wavekin" | "waterkin" => "give waves as [wave] or [sea]",
                            "icfile" => "give a start as run.start",
                            _ => "it is not known here",
                        };
                        self.note(format!("{option} = {word} was left out: {instead}."));
                    }
                    continue;
                }
            };
            let value =
                number(word).ok_or_else(|| row.refuse(option, word, "a number before it", ""))?;
            if key == "water_density" {
                self.water_density = value;
            }
            defaults.retain(|(default, _)| *default != key);
            self.give(row, ("site", 0), key, value)?;
        }
        for (key, value) in defaults {
            let value = value.into();
            self.tables
                .entries
                .give("site", 0, key, value, MOORDYN_DEFAULT)?;
        }
        Ok(())
    }

    fn body(&mut self, body: &Body<'_>) -> Result<(), CaseError> {
        let row = body.row;
        let [x, _, z] = body.place_m;
        self.give(row, ("body", 0), "position", [x, z])?;
        let (mass, volume) = (row.number(8, "Mass")?, row.number(11, "Volume")?);
        let inertia = match row.numbers(10, "I")?[..] {
            [every] | [_, every, _] => every,
            _ => return Err(row.refuse("I", row.words[10], "one number or Ix|Iy|Iz", "")),
        };
        if mass == 0.0 && volume == 0.0 {
            self.note(
                "The body has neither mass nor volume in the file: another program moves it.",
            );
            return Ok(());
        }
        let [drag, turning] = drag(row)?;
        if turning != 0.0 {
            self.note(format!(
                "The body's rotational drag, CdA = {turning}, was left out: snapload's \
                 turning_damping is linear."
            ));
        }
        let displaced = volume * self.water_density;
        let added: Value = match row.numbers(13, "Ca")?[..] {
            [every] => (every * displaced).into(),
            [x, _, z] if x == z => (z * displaced).into(),
            // Then MoorDyn is given no added mass for the rotation.
            [x, _, z] => [x * displaced, z * displaced, 0.0].into(),
            _ => return Err(row.refuse("Ca", row.words[13], "one number or Cax|Cay|Caz", "")),
        };
        for (key, value) in [
            ("mass", mass),
            ("displaced_volume", volume),
            ("moment_of_inertia", inertia),
            ("drag_area", drag),
        ] {
            self.give(row, ("body", 0), key, value)?;
        }
        self.give(row, ("body", 0), "added_mass", added)
    }

    fn line<'a>(
        &mut self,
        row: &Row<'_>,
        sections: &Sections<'_>,
        points: &'a Points<'a>,
    ) -> Result<Ends<'a>, CaseError> {
        let ends = ends(row, points)?;
        let [anchor, fairlead] = ends.map(|(_, point)| {
            let [x, _, z] = point.place_m;
            [x, z]
        });
        let index = self.tables.entries.add("line");
        let table = ("line", index);
        self.give(row, table, "anchor", anchor)?;
        self.give(row, table, "fairlead", fairlead)?;
        let length = row.number(4, "UnstrLen")?;
        self.give(row, table, "length", length)?;
        let name = row.word(1, "LineType")?;
        let mut types = sections.rows(Section::LineTypes);
        let Some(kind) = types.find(|kind| kind.words[0] == name) else {
            let known = sections.rows(Section::LineTypes).map(|kind| kind.words[0]);
            let known = known.collect::<Vec<_>>().join(", ");
            let allowed = format!("a name from LINE TYPES: {known}");
            return Err(row.refuse("LineType", name, &allowed, ""));
        };
        if let Some(other) = types.find(|other| other.words[0] == name) {
            return Err(other.refuse("TypeName", name, "a name that no other type has", ""));
        }
        let mass = kind.number(2, "Mass/m")?;
        self.give(row, table, "mass_per_length", mass)?;
        if let Some(stiffness) = self.stiffness(kind, index + 1)? {
            self.give(row, table, "stiffness", stiffness)?;
        }
        let diameter = kind.number(1, "Diam")?;
        let displaced = self.water_density * PI * diameter * diameter / 4.0;
        if (mass - displaced).abs() > 1e-3 * mass {
            self.note(format!(
                "Line {} weighs {:.3} kg in the water, which was left out: lines are straight and \
                 weightless until they snap.",
                index + 1,
                (mass - displaced) * length
            ));
        }
        Ok(ends)
    }

    /// Keeps what the front matter is compared with, besides the keys.
    fn keep_row(
        &mut self,
        row: &Row<'_>,
        [_, (fairlead, _)]: Ends<'_>,
        on_body: bool,
    ) -> Result<(), CaseError> {
        let [x, _, z] = fairlead.place(2, ["X", "Y", "Z"])?;
        let id = row.word(0, "ID")?;
        if self.tables.lines.iter().any(|row| row.id == id) {
            return Err(row.refuse("ID", id, "a number that no other line has", ""));
        }
        self.tables.lines.push(LineRow {
            id: id.to_owned(),
            type_name: row.word(1, "LineType")?.to_owned(),
            fairlead_on_body_m: on_body.then_some([x, z]),
        });
        Ok(())
    }

    /// EA, for which MoorDyn has several notations; none if it is in a separate file.
    fn stiffness(&mut self, kind: &Row<'_>, line: usize) -> Result<Option<f64>, CaseError> {
        let word = kind.word(3, "EA")?;
        let parts: Option<Vec<f64>> = word.split('|').map(number).collect();
        let Some(parts) = parts else {
            self.note(format!(
                "Line {line}: EA = {word} is a table in a file, which was not read; give \
                 line.{line}.stiffness."
            ));
            return Ok(None);
        };
        match parts[..] {
            [stiffness] => Ok(Some(stiffness)),
            [_, dynamic] => {
                self.note(format!(
                    "Line {line}: of EA = {word} the second, dynamic one was taken, as a snap is \
                     quick."
                ));
                Ok(Some(dynamic))
            }
            [_, constant, per_load] => {
                self.note(format!(
                    "Line {line}: of EA = {word} the constant part of the dynamic stiffness was \
                     taken; {per_load} of the mean load is left out."
                ));
                Ok(Some(constant))
            }
            _ => {
                let allowed = "EA, EA_static|EA_dynamic or EA_static|EA_constant|slope";
                Err(kind.refuse("EA", word, allowed, ""))
            }
        }
    }
}

/// C_d A in x and z, and about y.
fn drag(row: &Row<'_>) -> Result<[f64; 2], CaseError> {
    match row.numbers(12, "CdA")?[..] {
        [every] => Ok([every, every]),
        [moving, turning] => Ok([moving, turning]),
        [x, y, z] if x == z => Ok([x, y]),
        [x, _, z, _, turning, _] if x == z => Ok([x, turning]),
        _ => Err(row.refuse(
            "CdA",
            row.words[12],
            "the same in x and z: one number, two (moving and turning), three or six",
            "",
        )),
    }
}

/// The number of a point, without the word that MoorDyn allows before it, as in `Point2`.
fn number_of_point(id: &str) -> &str {
    let (word, number) = id.split_at(id.find(|c: char| c.is_ascii_digit()).unwrap_or(0));
    match word.to_lowercase().as_str() {
        "p" | "point" | "c" | "con" => number,
        _ => id,
    }
}

/// The anchor and the fairlead of a line, in whichever order they are written.
fn ends<'a>(row: &Row<'_>, points: &'a Points<'a>) -> Result<Ends<'a>, CaseError> {
    let find = |index: usize, column: &str| {
        let id = row.word(index, column)?;
        points.get(number_of_point(id)).ok_or_else(|| {
            let known = points.keys().copied().collect::<Vec<_>>().join(", ");
            let allowed = format!("the number of a point: {known}");
            let hint = match id.starts_with(['R', 'r']) {
                true => {
                    "an end of a rod, such as R1A, is not supported; make it a point of the body"
                }
                false => "",
            };
            row.refuse(column, id, &allowed, hint)
        })
    };
    let (a, b) = (find(2, "AttachA")?, find(3, "AttachB")?);
    let (place, hint) = match (a.1.attached_to, b.1.attached_to) {
        (PointOf::Ground, PointOf::Body) => return Ok([a, b]),
        (PointOf::Body, PointOf::Ground) => return Ok([b, a]),
        (PointOf::Ground, PointOf::Ground) => {
            ("ground", "remove the line, as it does not hold the body")
        }
        (PointOf::Body, PointOf::Body) => ("body", "snapload moors one body to the ground"),
    };
    let shown = format!("{} and {}", row.words[2], row.words[3]);
    let allowed = format!("one end on the ground and one on the body; both are on the {place}");
    Err(row.refuse("AttachA and AttachB", shown, &allowed, hint))
}
