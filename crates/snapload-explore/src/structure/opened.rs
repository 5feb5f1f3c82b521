//! The case of a structure in a request of the page: a file with changes.
use crate::refusal::Refusal;
use serde::{Deserialize, Serialize};
use snapload::{CaseError, Entries, Value, parse_value};
use snapload_report::{python_text, shell_command};
use snapload_structure::{NO_FILES_HERE, STRUCTURE, Structure, files_beside};
use std::path::{Path, PathBuf};

/// The case of a structure with which the program was started, or that was opened on the page.
#[derive(Clone, Debug)]
pub struct Opened {
    /// Its name in errors and commands.
    pub name: String,
    /// Its keys, changed.
    pub entries: Entries,
    /// The changes of its file that were made before the page was opened, in the notation of
    /// `--set`.
    pub changes: Vec<String>,
    /// The folder of the files that it names; none for a case that was opened on the page.
    pub folder: Option<PathBuf>,
}

/// The kind of waves; the keys of other kinds are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum WaterKind {
    Still,
    Wave,
    Sea,
}

/// The tables of waves, with the kind of each.
const WATERS: [(&str, WaterKind); 2] = [("wave", WaterKind::Wave), ("sea", WaterKind::Sea)];

/// The keys of `[float]` that name files.
const FILES: [&str; 2] = ["file", "memory"];

/// A case file that was opened on the page.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct File {
    pub(crate) name: String,
    text: String,
}

/// A case, as a request names it.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CaseRequest {
    /// A file in place of the one with which the program was started.
    #[serde(default)]
    file: Option<File>,
    /// Otherwise the checksum of the case with which the program was started when the page was
    /// opened: a page can stay open while the program is started with another one, or while a file
    /// that the case names is changed.
    #[serde(default)]
    opened: Option<String>,
    /// Changes, each in the notation of `--set`.
    #[serde(default)]
    set: Vec<String>,
    /// The kind of waves, if it is another than in the file.
    #[serde(default)]
    water: Option<WaterKind>,
}

/// A case that was read and checked.
pub(crate) struct Case {
    pub(crate) opened: Opened,
    pub(crate) structure: Structure,
    set: Vec<String>,
    /// Whether the changes alone turn the file into this case.
    by_set: bool,
}

impl File {
    /// Reads it; no file on the disk is read for a page.
    pub(crate) fn read(&self) -> Result<Opened, CaseError> {
        Ok(Opened {
            name: self.name.clone(),
            entries: Entries::parse(&STRUCTURE, &self.name, &self.text)?,
            changes: Vec::new(),
            folder: None,
        })
    }
}

impl Opened {
    /// Its kind of waves.
    pub(crate) fn water(&self) -> WaterKind {
        let there = WATERS
            .iter()
            .find(|(table, _)| self.entries.count(table) > 0);
        there.map_or(WaterKind::Still, |(_, kind)| *kind)
    }

    /// A text that differs for different cases: FNV-1a of its name, its keys, and the files that it
    /// names as they are now.
    pub(crate) fn checksum(&self) -> String {
        let mut bytes = format!("{}\n{}", self.name, self.entries.to_toml()).into_bytes();
        for file in self.files() {
            // The parts can not be moved from one file to another; a missing file is one of its
            // own.
            let content = std::fs::read(file).ok();
            let length = content.as_ref().map(Vec::len);
            bytes.extend(format!("\n{length:?}\n").into_bytes());
            bytes.extend(content.unwrap_or_default());
        }
        let sum = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| {
            (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
        });
        format!("{sum:x}")
    }

    /// The files that it names, and those that belong to them.
    fn files(&self) -> Vec<PathBuf> {
        let folder = self.folder.as_ref();
        folder.map_or_else(Vec::new, |folder| files_beside(&self.entries, folder))
    }

    /// The structure. A case from a browser has no folder, and files in the folder in which the
    /// program was started may belong to another body: such a case may not name files.
    pub(crate) fn structure(&self) -> Result<Structure, CaseError> {
        let Some(folder) = &self.folder else {
            let structure = Structure::from_entries(&self.entries);
            return structure.map_err(|error| self.with_folder_hint(error));
        };
        Structure::from_entries_beside(&self.entries, folder)
    }

    /// The case as a file of its own, with a comment that names the files which it needs beside it.
    pub(crate) fn to_file(&self) -> String {
        let float = self.entries.table("float", 0);
        let named = FILES.into_iter().filter_map(|key| match float.given(key) {
            Some(Value::Text(path)) if Path::new(path).is_relative() => Some(path.as_str()),
            _ => None,
        });
        let named: Vec<&str> = named.collect();
        let comment = match named.is_empty() {
            true => String::new(),
            false => format!(
                "# This case needs {} beside it. Copy from the folder of {}.\n",
                named.join(" and "),
                self.name
            ),
        };
        comment + &self.entries.to_toml()
    }

    /// Adds a hint if the error is that a file is named.
    fn with_folder_hint(&self, error: CaseError) -> CaseError {
        if &*error.allowed != NO_FILES_HERE {
            return error;
        }
        error.with_hint(format!(
            "start the program in the folder of its files: {}",
            shell_command(["snapload", "explore", &self.name])
        ))
    }

    /// The same with waves of this kind only.
    fn with_water(mut self, water: WaterKind) -> Self {
        for (table, _) in WATERS.iter().filter(|(_, kind)| *kind != water) {
            self.entries.remove(table);
        }
        self
    }
}

impl CaseRequest {
    /// Reads and checks it; `start` is the case with which the program was started.
    pub(crate) fn read(&self, start: Option<&Opened>) -> Result<Case, Refusal> {
        let mut opened = match &self.file {
            Some(file) => file.read()?,
            None => self.of_the_program(start)?.clone(),
        };
        let own = opened.water();
        let water = self.water.unwrap_or(own);
        if water != own {
            opened = opened.with_water(water);
        }
        for change in &self.set {
            opened.entries.set(change)?;
        }
        Ok(Case {
            structure: opened.structure()?,
            by_set: water == own && self.file.is_none(),
            set: self.set.clone(),
            opened,
        })
    }

    /// The case with which the program was started, if it is the one that the page was opened with.
    fn of_the_program<'a>(&self, start: Option<&'a Opened>) -> Result<&'a Opened, Refusal> {
        let there = start.map(Opened::checksum);
        if self.opened.is_some() && self.opened != there {
            let now = start.map_or("without a structure".to_owned(), |start| {
                let changed = match start.files().is_empty() {
                    true => "",
                    false => ", or a file that this case names was changed",
                };
                format!("with another case, {}{changed}", start.name)
            });
            return Err(Refusal::values(format!(
                "the program was started again, {now}; this page shows the case before\nhint: reload the page"
            )));
        }
        start.ok_or_else(|| {
            Refusal::values(
                "no structure is open; open a case file, such as docs/examples/cylinder.toml",
            )
        })
    }

    /// A text that differs for different cases.
    pub(crate) fn fingerprint(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

impl Case {
    /// The file and the changes that give this case: those of the file with which the program was
    /// started if these are all that is changed, and otherwise a file that has to be saved first.
    fn file_and_changes(&self) -> (&str, Vec<&str>) {
        if !self.by_set {
            return ("case.toml", Vec::new());
        }
        let changes = self.opened.changes.iter().chain(&self.set);
        (&self.opened.name, changes.map(String::as_str).collect())
    }

    /// What has to be said of that file, as a comment of a shell and of Python.
    fn comment(&self) -> &str {
        if self.by_set {
            ""
        } else {
            "  # save case.toml first, with Export"
        }
    }

    /// The command line that gives the same answer.
    pub(crate) fn command(&self, verb: &str) -> String {
        let (file, changes) = self.file_and_changes();
        let sets = changes.into_iter().flat_map(|change| ["--set", change]);
        shell_command(["snapload", verb, file].into_iter().chain(sets)) + self.comment()
    }

    /// The same in Python.
    pub(crate) fn python(&self) -> String {
        let (file, changes) = self.file_and_changes();
        let changes = changes.iter().filter_map(|change| change.split_once('='));
        let changes: Vec<(&str, &str)> = changes
            .map(|(key, value)| (key.trim(), value.trim()))
            .collect();
        // A key that is changed twice keeps its first place in a dictionary, where a change of all
        // lines in between would replace it; only the last change has an effect.
        let lasting = changes.iter().enumerate().filter(|(at, (key, _))| {
            let later = &changes[at + 1..];
            later.iter().all(|(other, _)| other != key)
        });
        let items: Vec<String> = lasting
            .map(|(_, (key, value))| format!("{}: {}", python_text(key), python_value(value)))
            .collect();
        let changes = match items.is_empty() {
            true => String::new(),
            false => format!(", {{{}}}", items.join(", ")),
        };
        format!(
            "import snapload\nsnapload.Structure.from_toml({}{changes}).assess(){}",
            python_text(file),
            self.comment()
        )
    }
}

/// A value in the notation of `--set`, in Python, which takes a text as it is.
fn python_value(value: &str) -> String {
    match parse_value(value) {
        Ok(Value::Bool(true)) => "True".to_owned(),
        Ok(Value::Bool(false)) => "False".to_owned(),
        Ok(Value::Number(_) | Value::Integer(_) | Value::List(_)) => value.to_owned(),
        Ok(Value::Text(text)) => python_text(&text),
        Err(_) => python_text(value),
    }
}
