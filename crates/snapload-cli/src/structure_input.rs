//! The common options of the commands for structures: which case, and the places of the answers.
use crate::case_input::read_text;
use crate::failure::{Failure, print};
use crate::json::{Json, JsonArgs, is_same_file, room_of};
use crate::stage::{Room, Stage};
use serde::Serialize;
use sha2::{Digest, Sha256};
use snapload::{CaseError, Entries};
use snapload_structure::{STRUCTURE, Structure, told};
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

/// A structure that was read.
pub(crate) struct ReadStructure {
    /// The name of its case.
    pub(crate) name: String,
    /// The structure.
    pub(crate) structure: Structure,
    /// SHA-256 of the case's file, as `sha256sum` prints it.
    pub(crate) sha256: String,
}

/// Which structure.
#[derive(clap::Args)]
pub(crate) struct StructureArgs {
    /// Case file in TOML (snapload assess --keys lists the keys)
    #[arg(value_name = "CASE.toml")]
    file: Option<PathBuf>,
    /// Change one key of the file, such as wave.height=2 or line.1.length=6; may be repeated
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    set: Vec<String>,
}

impl StructureArgs {
    /// Reads and checks the case.
    pub(crate) fn read(&self) -> Result<ReadStructure, Failure> {
        let path: &Path = self.file.as_deref().ok_or_else(|| {
            Failure::bad_input(
                "no case file; write snapload assess CASE.toml (docs/examples/cylinder.toml is one \
                 to begin with)",
            )
        })?;
        let text = read_text(path)?;
        let (name, entries) = entries_of(path, &text, &self.set)?;
        let structure = structure_of(path, &name, &entries);
        let sum = Sha256::digest(&text);
        Ok(ReadStructure {
            structure: structure?,
            name,
            sha256: sum.iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }

    /// The command line that reads it again.
    pub(crate) fn command(&self, verb: &str) -> String {
        let file = self.file.as_deref().map(|path| path.display().to_string());
        let mut command = format!("snapload {verb} {}", file.unwrap_or_default());
        for set in &self.set {
            let _ = write!(command, " --set '{set}'");
        }
        command
    }
}

/// The keys of a file, changed by `--set`, with the name of its case.
pub(crate) fn entries_of(
    path: &Path,
    text: &str,
    set: &[String],
) -> Result<(String, Entries), CaseError> {
    let name = path.display().to_string();
    let mut entries = Entries::parse(&STRUCTURE, &name, text)?;
    set.iter().try_for_each(|change| entries.set(change))?;
    Ok((name, entries))
}

/// The structure from the keys of a file.
pub(crate) fn structure_of(
    path: &Path,
    name: &str,
    entries: &Entries,
) -> Result<Structure, CaseError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    Structure::from_entries_beside(entries, folder).map_err(|error| {
        let located = entries.locate(error);
        // A key that is left out has no line, but the file is known.
        match located.place {
            Some(_) => located,
            None => located.at(name),
        }
    })
}

/// The ending of an output file, which has to be one of those allowed.
pub(crate) fn ending(path: &Path, allowed: &[&'static str]) -> Result<&'static str, Failure> {
    let given = path.extension().and_then(|ending| ending.to_str());
    let known = allowed.iter().find(|ending| given == Some(**ending));
    known.copied().ok_or_else(|| {
        let names = allowed.join(" or .");
        let path = path.display();
        Failure::BadInput(format!(
            "--out {path}: allowed is a name that ends in .{names}"
        ))
    })
}

/// The places of a command's answers: a file, JSON, standard output.
pub(crate) struct Answers {
    stage: Stage,
    json: Json,
    file: Option<(Room, PathBuf)>,
}

impl Answers {
    /// Opens the places, so that an error is known before anything is computed.
    pub(crate) fn open(json: &JsonArgs, out: Option<&Path>) -> Result<Self, Failure> {
        let mut stage = Stage::default();
        let json = json.open(&mut stage)?;
        let file = match out {
            Some(path) => Some((room_of(&mut stage, path)?, path.to_owned())),
            None => None,
        };
        if let (Json::File(_, json), Some((_, file))) = (&json, &file)
            && is_same_file(json, file)
        {
            let path = file.display();
            let message = format!("--out and --json: both name {path}; allowed are two files");
            return Err(Failure::BadInput(message));
        }
        Ok(Self { stage, json, file })
    }

    /// Writes the file, if it was asked for.
    pub(crate) fn write(
        &mut self,
        fill: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        match self.file.take() {
            Some((room, path)) => self.stage.write(room, path, fill),
            None => Ok(()),
        }
    }

    /// Moves all files to their places, and prints a summary with their paths.
    pub(crate) fn finish(self, json: &impl Serialize, mut text: String) -> Result<(), Failure> {
        let Some(written) = self.json.write(self.stage, json)? else {
            return Ok(());
        };
        for path in written {
            text += &told("written", &path.display().to_string());
        }
        print(&text)
    }
}
