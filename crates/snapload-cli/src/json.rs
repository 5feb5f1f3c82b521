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
        let path = behind_links(path);
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

/// The file that a path leads to: a link is followed, so that what it points to is replaced and not
/// the link. Any other path is left as it was typed, as it will be printed.
fn behind_links(path: &Path) -> PathBuf {
    let there = || path.canonicalize().ok();
    // Where nothing stands behind a link yet.
    let new = || Some(parent_of(path).join(path.read_link().ok()?));
    let followed = path.is_symlink().then(|| there().or_else(new)).flatten();
    followed.unwrap_or_else(|| path.to_owned())
}

/// Whether two paths lead to one file, which need not be there yet.
#[cfg(feature = "structure")]
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let folder = parent_of(path).canonicalize().ok()?;
        Some(folder.join(path.file_name()?))
    };
    place(one).is_some_and(|one| place(other) == Some(one))
}

/// Opens the directory in which a file is to be written, and creates it where it is absent. Returns
/// the path to be written; what is no plain file, such as a device, is written into.
#[cfg(feature = "structure")]
pub(crate) fn room_of(stage: &mut Stage, path: &Path) -> Result<(Room, PathBuf), Failure> {
    refuse_directory(path)?;
    let path = behind_links(path);
    let room = match path.exists() && !path.is_file() {
        true => stage.open(&std::env::temp_dir())?,
        false => stage.create_and_open(parent_of(&path))?,
    };
    Ok((room, path))
}

/// Says so where a file is to be written and a directory stands.
pub(crate) fn refuse_directory(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        let message = format!("can not write to {}: it is a directory", path.display());
        return Err(Failure::BadInput(message));
    }
    Ok(())
}
