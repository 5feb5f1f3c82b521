//! The output of `--json`.
use crate::failure::Failure;
use crate::pending_outputs::{PendingOutputs, TargetFolder};
use crate::standard_output::standard_output;
use serde::Serialize;
use snapload_report::write_json;
use snapload_study::parent_of;
use std::io::{BufWriter, StdoutLock, Write};
use std::path::{Path, PathBuf};

/// Where the answer goes as JSON.
#[derive(clap::Args)]
pub(crate) struct JsonArgs {
    /// Write the results as JSON to a file; - means standard output,
    /// which then has nothing but JSON
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

impl JsonArgs {
    /// Opens the place of the output.
    pub(crate) fn open(&self, pending: &mut PendingOutputs) -> Result<Json, Failure> {
        Json::open(pending, self.json.as_deref())
    }
}

/// The place that `--json` names.
pub(crate) enum Json {
    /// It was not given.
    None,
    /// `-`.
    Stdout,
    /// A file, a device or a pipe.
    File(TargetFolder, PathBuf),
}

impl Json {
    /// Opens the place, so that an error is known before anything is computed.
    pub(crate) fn open(pending: &mut PendingOutputs, path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else {
            return Ok(Self::None);
        };
        if path.as_os_str() == "-" {
            return Ok(Self::Stdout);
        }
        refuse_directory(path)?;
        let folder = pending.create_and_open(&folder_for(path))?;
        Ok(Self::File(folder, path.to_owned()))
    }

    /// Writes the value to its place, together with all other pending files. Returns the files
    /// written, or none if the value is printed to standard output.
    pub(crate) fn write(
        self,
        mut pending: PendingOutputs,
        value: &impl Serialize,
    ) -> Result<Option<Vec<PathBuf>>, Failure> {
        self.add_to(&mut pending, value)?;
        let written = pending.commit()?;
        Ok((!self.print(value)?).then_some(written))
    }

    /// Stages the value if it is to be a file.
    pub(crate) fn add_to(
        &self,
        pending: &mut PendingOutputs,
        value: &impl Serialize,
    ) -> Result<(), Failure> {
        match self {
            Self::File(folder, path) => {
                pending.write(*folder, path.clone(), |out| write_json(value, out))
            }
            _ => Ok(()),
        }
    }

    /// Prints the value if it goes to standard output, and returns whether it does.
    pub(crate) fn print(&self, value: &impl Serialize) -> Result<bool, Failure> {
        if !matches!(self, Self::Stdout) {
            return Ok(false);
        }
        let write = |out: StdoutLock| {
            let mut out = BufWriter::new(out);
            write_json(value, &mut out).and_then(|()| out.flush())
        };
        standard_output()
            .and_then(write)
            .map_err(|error| Failure::write("standard output", &error))?;
        Ok(true)
    }
}

/// The directory in which a file is written first: that of the file, so that it can be renamed;
/// another one for a device or a pipe, into which the contents are copied.
pub(crate) fn folder_for(path: &Path) -> PathBuf {
    match path.exists() && !path.is_file() {
        true => std::env::temp_dir(),
        false => parent_of(path).to_owned(),
    }
}

/// An error if a file is to be written where there is a directory.
pub(crate) fn refuse_directory(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        let message = format!("can not write to {}: it is a directory", path.display());
        return Err(Failure::BadInput(message));
    }
    Ok(())
}
