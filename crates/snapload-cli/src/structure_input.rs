//! The common options of the commands for structures: which case.
use crate::case_input::read_text;
use crate::failure::Failure;
use sha2::{Digest, Sha256};
use snapload::{CASE, CaseError, Entries};
use snapload_report::shell_command;
use snapload_structure::{STRUCTURE, Structure};
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
        let sets = self.set.iter().flat_map(|set| ["--set", set]);
        shell_command(
            ["snapload", verb]
                .into_iter()
                .chain(file.as_deref())
                .chain(sets),
        )
    }
}

/// The keys of a file, changed by `--set`, with the name of its case.
pub(crate) fn entries_of(
    path: &Path,
    text: &str,
    set: &[String],
) -> Result<(String, Entries), CaseError> {
    let name = path.display().to_string();
    let mut entries = Entries::parse(&STRUCTURE, &name, text).map_err(|error| {
        if Entries::parse(&CASE, &name, text).is_err() {
            return error;
        }
        let hint = format!("write {}", shell_command(["snapload", "run", &name]));
        CaseError::syntax("this is a nondimensional case, with the keys that snapload keys lists")
            .with_hint(hint)
            .at(name.clone())
    })?;
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
