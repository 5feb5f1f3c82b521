//! Files that appear whole or not at all: written in a scratch directory on the same file system,
//! then renamed into their places.
use crate::failure::Failure;
use crate::interrupt::leftovers;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Scratch directories and the files in them that are to be put in their places.
#[derive(Default)]
pub(crate) struct Stage {
    scratch: Vec<PathBuf>,
    files: Vec<(PathBuf, PathBuf)>,
}

/// A directory in which output will be put.
#[derive(Clone, Copy)]
pub(crate) struct Room(usize);

impl Stage {
    /// Opens an existing directory for output.
    pub(crate) fn open(&mut self, directory: &Path) -> Result<Room, Failure> {
        // Held throughout, so that an interruption finds the directory on the list.
        let mut leftovers = leftovers();
        let scratch = tempfile::Builder::new()
            .prefix(".snapload-")
            .tempdir_in(directory)
            .map_err(|error| Failure::no_place(directory, &error))?
            .keep();
        leftovers.scratch.push(scratch.clone());
        self.scratch.push(scratch);
        Ok(Room(self.scratch.len() - 1))
    }

    /// Opens a directory for output and creates it, with those above it, where it is absent.
    pub(crate) fn create_and_open(&mut self, directory: &Path) -> Result<Room, Failure> {
        for ancestor in missing(directory) {
            let mut leftovers = leftovers();
            match fs::create_dir(&ancestor) {
                Ok(()) => leftovers.new.push(ancestor),
                // `results/../other` asks for the same directory twice.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Failure::no_place(directory, &error)),
            }
        }
        if !directory.is_dir() {
            let message = format!("can not write to {}: not a directory", directory.display());
            return Err(Failure::BadInput(message));
        }
        self.open(directory)
    }

    /// Writes one file of a room, to be put at `target` later.
    pub(crate) fn write(
        &mut self,
        room: Room,
        target: PathBuf,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let scratch = self.scratch[room.0].join(self.files.len().to_string());
        let written = File::create_new(&scratch).and_then(|file| {
            let mut file = BufWriter::new(file);
            fill(&mut file)?;
            file.flush()
        });
        written.map_err(|error| Failure::write(target.display(), &error))?;
        self.files.push((scratch, target));
        Ok(())
    }

    /// The same for a writer that wants to know the scratch file's name, and brings it to the disk
    /// itself.
    pub(crate) fn place(
        &mut self,
        room: Room,
        target: PathBuf,
        fill: impl FnOnce(&Path) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let scratch = self.scratch[room.0].join(self.files.len().to_string());
        fill(&scratch)?;
        self.files.push((scratch, target));
        Ok(())
    }

    /// Puts every file in its place and says where they are.
    pub(crate) fn commit(mut self) -> Result<Vec<PathBuf>, Failure> {
        let mut leftovers = leftovers();
        let mut placed = Vec::new();
        for (scratch, target) in std::mem::take(&mut self.files) {
            put(&scratch, &target).map_err(|error| Failure::write(target.display(), &error))?;
            placed.push(target);
        }
        leftovers.new.clear();
        Ok(placed)
    }
}

impl Drop for Stage {
    /// Takes away the scratch and, unless something was put into them, the new directories.
    fn drop(&mut self) {
        leftovers().clear();
    }
}

/// Puts a file in its place. A link is followed, so that what it points to is replaced and not the
/// link; into what is no plain file, such as a device or a pipe, it is written, and so it is into a
/// file on another disk, where nothing can be renamed to.
fn put(scratch: &Path, target: &Path) -> io::Result<()> {
    let target = match target.is_symlink() {
        // Where nothing stands behind a link yet.
        true => target.canonicalize().or_else(|_| {
            let folder = target.parent().unwrap_or(Path::new(""));
            target.read_link().map(|behind| folder.join(behind))
        })?,
        false => target.to_owned(),
    };
    if !target.exists() || target.is_file() {
        match fs::rename(scratch, &target) {
            Err(error) if error.kind() == ErrorKind::CrossesDevices => {}
            renamed => return renamed,
        }
    }
    let mut to = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .open(&target)?;
    io::copy(&mut File::open(scratch)?, &mut to).map(drop)
}

/// The directories that have to be created for this one, outermost first.
fn missing(directory: &Path) -> Vec<PathBuf> {
    let mut missing: Vec<PathBuf> = directory
        .ancestors()
        .take_while(|path| !path.as_os_str().is_empty() && !path.exists())
        .map(Path::to_owned)
        .collect();
    missing.reverse();
    missing
}
