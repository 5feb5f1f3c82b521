//! The keys in the front matter of a MoorDyn file, and which of them its tables overrule.

use super::sections::Sections;
use crate::schema::STRUCTURE;
use snapload::{CaseError, Entries, FromValue, Value};

/// Lines of a file's front matter that begin with this are keys of a case.
const KEY_LINE: &str = "snapload:";
/// The place of values that a file does not give, which the front matter may.
pub(super) const MOORDYN_DEFAULT: &str = "MoorDyn's default";
/// The largest difference of two values that agree, as a part of the larger one. `write` prints
/// every digit of the tables, so that only rounding is left; a difference that someone wrote is
/// larger.
const ROUNDING: f64 = 1e-9;

/// A row of LINES, in the order of the case's lines.
pub(super) struct LineRow {
    pub(super) id: String,
    pub(super) type_name: String,
    /// Its fairlead relative to the body, if the file has one \[m\].
    pub(super) fairlead_on_body_m: Option<[f64; 2]>,
}

/// What the tables of a file say.
pub(super) struct Tables {
    /// In the keys of a case.
    pub(super) entries: Entries,
    pub(super) lines: Vec<LineRow>,
    /// Whether the body starts where it is put, without relaxation, as `write` has it with a
    /// `run.start`.
    pub(super) starts_where_put: bool,
}

impl Tables {
    /// The tables with the keys of the front matter that agree with them, or of which they say
    /// nothing. Adds a note on each key that does not apply.
    pub(super) fn with_front(
        self,
        sections: &Sections<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Entries, CaseError> {
        let front = self.front(sections, notes)?;
        let mut case = self.split_by(&front)?;
        for (table, index, key, value) in given(&front) {
            let path = front.table(table, index).path(key);
            let place = front.place(&path).unwrap_or_default();
            let said = case.table(table, index).given(key);
            let said = said.filter(|_| case.place(&path) != Some(MOORDYN_DEFAULT));
            let against = match said {
                Some(said) if agree(value, said) => None,
                Some(said) => Some(format!("was overruled: the tables have {said}")),
                None if table == "line" => self.other_type(&front, index),
                None => None,
            };
            match against {
                Some(against) => {
                    let name = match table {
                        "line" => format!("line.{}.{key}", self.lines[index].id),
                        _ => path,
                    };
                    notes.push(note(&name, value, &against));
                }
                None => case.give(table, index, key, value.clone(), place)?,
            }
        }
        Ok(case)
    }

    /// The keys of the front matter. Those of a line belong to the row of LINES with its number as
    /// ID, as rows may have been removed.
    fn front(
        &self,
        sections: &Sections<'_>,
        notes: &mut Vec<String>,
    ) -> Result<Entries, CaseError> {
        let mut front = self.without_keys();
        let mut known: Vec<&str> = Vec::new();
        for (origin, line) in &sections.front {
            let line = line.trim_start_matches(['#', ' ', '\t']);
            let Some(set) = line.strip_prefix(KEY_LINE) else {
                continue;
            };
            let at_line = |error: CaseError| error.at(origin.as_str());
            let (key, value) = set.split_once('=').unwrap_or((set, ""));
            let (key, value) = (key.trim(), value.trim());
            if known.contains(&key) {
                let error = CaseError::value(key, value, "one value; the file has two");
                return Err(at_line(error));
            }
            known.push(key);
            let mut set = set.trim().to_owned();
            if let Some((id, of_line)) = of_numbered_line(key) {
                let Some(index) = self.lines.iter().position(|row| row.id == id) else {
                    let against = format!("was left out: the tables have no line {id}");
                    notes.push(note(key, value, &against));
                    continue;
                };
                set = format!("line.{}.{of_line} = {value}", index + 1);
            }
            let mut own = self.without_keys();
            own.set(&set).map_err(at_line)?;
            for (table, index, key, value) in given(&own) {
                front.give(table, index, key, value.clone(), origin)?;
            }
        }
        Ok(front)
    }

    /// As many lines as the file has, and no keys.
    fn without_keys(&self) -> Entries {
        let mut entries = Entries::new(&STRUCTURE);
        self.lines.iter().for_each(|_| {
            entries.add("line");
        });
        entries
    }

    /// What the tables say, in the parts in which the front matter has it: the tables have one
    /// place of the body, and one moment of inertia of the body with its added mass.
    fn split_by(&self, front: &Entries) -> Result<Entries, CaseError> {
        let mut case = self.entries.clone();
        self.split_place(front, &mut case)?;
        split_inertia(front, &mut case)?;
        Ok(case)
    }

    /// The place of the body is that of its start where it has one, and the fairleads are written
    /// relative to it.
    fn split_place(&self, front: &Entries, case: &mut Entries) -> Result<(), CaseError> {
        let put_m: Option<[f64; 2]> = value_of(case, "body", "position");
        // `write` puts a body without a start where it is at rest. Others put it where it starts.
        let by_others = given(front).next().is_none();
        let starts = by_others || value_of::<[f64; 2]>(front, "run", "start").is_some();
        let (Some(put_m), true) = (put_m, starts && self.starts_where_put) else {
            return Ok(());
        };
        let place = case.place("body.position").unwrap_or_default().to_owned();
        case.give("run", 0, "start", put_m.into(), &place)?;
        let position_m: Option<[f64; 2]> = value_of(front, "body", "position");
        let Some([x, z]) = position_m else {
            return Ok(());
        };
        case.give("body", 0, "position", [x, z].into(), &place)?;
        for (index, row) in self.lines.iter().enumerate() {
            let Some([right, up]) = row.fairlead_on_body_m else {
                continue;
            };
            let fairlead = [x + right, z + up].into();
            let path = case.table("line", index).path("fairlead");
            let place = case.place(&path).unwrap_or_default().to_owned();
            case.give("line", index, "fairlead", fairlead, &place)?;
        }
        Ok(())
    }

    /// Why a key for which a row of LINES has no column does not belong to it: `write` gives each
    /// line a type of its own, so that another type is that of another line or rope.
    fn other_type(&self, front: &Entries, index: usize) -> Option<String> {
        // `write` gives every line a fairlead; in a file by hand types have any name.
        front.table("line", index).given("fairlead")?;
        let LineRow { id, type_name, .. } = &self.lines[index];
        let own = format!("line{id}");
        (*type_name != own).then(|| {
            format!("was left out: in the tables line {id} is of type {type_name}, not {own}")
        })
    }
}

/// MoorDyn's moment of inertia is the sum of those of the body and of its added mass; its Ca says
/// nothing of the second one.
fn split_inertia(front: &Entries, case: &mut Entries) -> Result<(), CaseError> {
    let Some(total) = value_of::<f64>(case, "body", "moment_of_inertia") else {
        return Ok(());
    };
    let added = |entries: &Entries| {
        let value = entries.table("body", 0).given("added_mass")?;
        per_freedom(value)
    };
    let of_water = added(front).map_or(0.0, |[_, _, pitch]| pitch);
    let own = value_of(front, "body", "moment_of_inertia").unwrap_or(total);
    let place = case
        .place("body.moment_of_inertia")
        .unwrap_or_default()
        .to_owned();
    if of_water == 0.0 || !near([own + of_water], [total]) {
        return Ok(());
    }
    case.give("body", 0, "moment_of_inertia", own.into(), &place)?;
    match added(case) {
        Some([surge, heave, _]) => {
            let value = [surge, heave, of_water].into();
            case.give("body", 0, "added_mass", value, &place)
        }
        None => Ok(()),
    }
}

/// The number of the line to which a key belongs, and its name in that line.
fn of_numbered_line(key: &str) -> Option<(&str, &str)> {
    let (id, of_line) = key.strip_prefix("line.")?.split_once('.')?;
    id.parse::<usize>().ok()?;
    Some((id, of_line))
}

/// The keys that are given: table, its index, key and value.
fn given(entries: &Entries) -> impl Iterator<Item = (&'static str, usize, &'static str, &Value)> {
    STRUCTURE.tables.iter().flat_map(move |table| {
        let fields = (0..entries.count(table.name)).map(|index| entries.table(table.name, index));
        fields.enumerate().flat_map(move |(index, fields)| {
            let values = move |key: &'static snapload::Key| {
                let value = fields.given(key.name)?;
                Some((table.name, index, key.name, value))
            };
            table.keys.iter().filter_map(values)
        })
    })
}

fn value_of<T: FromValue>(entries: &Entries, table: &str, key: &str) -> Option<T> {
    let value = entries.table(table, 0).given(key)?;
    T::from_value(value)
}

/// Added mass in x, in z and of the rotation.
fn per_freedom(value: &Value) -> Option<[f64; 3]> {
    let every = value.number().map(|every| [every, every, 0.0]);
    every.or_else(|| value.triple())
}

/// Whether two values of a key are the same up to rounding.
fn agree(a: &Value, b: &Value) -> bool {
    if let (Some(a), Some(b)) = (a.pair(), b.pair()) {
        return near(a, b);
    }
    match (per_freedom(a), per_freedom(b)) {
        (Some(a), Some(b)) => near(a, b),
        _ => a == b,
    }
}

/// Whether numbers differ by no more than rounding of the largest one.
fn near<const N: usize>(a: [f64; N], b: [f64; N]) -> bool {
    let largest = a
        .iter()
        .chain(&b)
        .fold(0.0, |most: f64, n| most.max(n.abs()));
    let mut pairs = a.iter().zip(&b);
    pairs.all(|(a, b)| (a - b).abs() <= ROUNDING * largest)
}

fn note(key: &str, value: impl std::fmt::Display, against: &str) -> String {
    format!("{key} = {value} of the front matter {against}.")
}
