//! Where `--json` writes to, and how.
use crate::failure::Failure;
use crate::stage::{Room, Stage};
use crate::standard_output::standard_output;
use serde::Serialize;
use snapload_report::write_json;
use snapload_study::parent_of;
use std::fs::OpenOptions;
use std::io::{BufWriter, StdoutLock, Write};
use std::path::{Path, PathBuf};

/// The place that `--json` names.
pub(crate) enum Json {
    /// It was not given.
    None,
    /// `-`.
    Stdout,
    /// A plain file, new or to be replaced.
    File(Room, PathBuf),
    /// Something that is no plain file, such as /dev/stdout or a pipe: written straight into.
    Device(PathBuf),
}

impl Json {
    /// Opens the place, so that a bad one is known before anything is computed.
    pub(crate) fn open(stage: &mut Stage, path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else {
            return Ok(Self::None);
        };
        if path.as_os_str() == "-" {
            return Ok(Self::Stdout);
        }
        refuse_directory(path)?;
        // A link is followed, so that what it points to is replaced and not the link.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if path.exists() && !path.is_file() {
            return Ok(Self::Device(path));
        }
        let room = stage.open(parent_of(&path))?;
        Ok(Self::File(room, path))
    }

    /// Puts the value where it was asked for, together with all else that is staged. Returns the
    /// files written, or none where standard output belongs to the value.
    pub(crate) fn write(
        self,
        mut stage: Stage,
        value: &impl Serialize,
    ) -> Result<Option<Vec<PathBuf>>, Failure> {
        if let Self::File(room, path) = &self {
            stage.write(*room, path.clone(), |out| write_json(value, out))?;
        }
        let mut written = stage.commit()?;
        match self {
            Self::Stdout => {
                let write = |out: StdoutLock| {
                    let mut out = BufWriter::new(out);
                    write_json(value, &mut out).and_then(|()| out.flush())
                };
                standard_output()
                    .and_then(write)
                    .map_err(|error| Failure::write("standard output", &error))?;
                return Ok(None);
            }
            Self::Device(path) => {
                let file = OpenOptions::new().write(true).open(&path);
                let file = file.map_err(|error| Failure::no_place(&path, &error))?;
                let mut out = BufWriter::new(file);
                write_json(value, &mut out)
                    .and_then(|()| out.flush())
                    .map_err(|error| Failure::write(path.display(), &error))?;
                written.push(path);
            }
            Self::None | Self::File(..) => {}
        }
        Ok(Some(written))
    }
}

/// Opens the directory in which a file is to be written, and creates it where it is absent.
#[cfg(feature = "structure")]
pub(crate) fn room_of(stage: &mut Stage, path: &Path) -> Result<Room, Failure> {
    refuse_directory(path)?;
    stage.create_and_open(parent_of(path))
}

/// Says so where a file is to be written and a directory stands.
pub(crate) fn refuse_directory(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        let message = format!("can not write to {}: it is a directory", path.display());
        return Err(Failure::BadInput(message));
    }
    Ok(())
}
