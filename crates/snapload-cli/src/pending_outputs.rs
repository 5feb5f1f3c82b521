//! Files that appear complete or not at all: they are written in a temporary directory on the same
//! file system, then renamed.
use crate::failure::Failure;
use crate::interrupt::temporary_paths;
use snapload_study::parent_of;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Temporary directories with the files in them, which are to be renamed to their places.
#[derive(Default)]
pub(crate) struct PendingOutputs {
    scratch: Vec<PathBuf>,
    files: Vec<(PathBuf, PathBuf)>,
    outdated: Vec<PathBuf>,
}

/// A directory in which output will be placed.
#[derive(Clone, Copy)]
pub(crate) struct TargetFolder(usize);

impl PendingOutputs {
    /// Opens an existing directory for output.
    pub(crate) fn open(&mut self, directory: &Path) -> Result<TargetFolder, Failure> {
        // Locked throughout, so that an interruption finds the directory in the list.
        let mut temporary_paths = temporary_paths();
        let scratch = tempfile::Builder::new()
            .prefix(".snapload-")
            .tempdir_in(directory)
            .map_err(|error| Failure::cannot_write_to(directory, &error))?
            .keep();
        temporary_paths.scratch.push(scratch.clone());
        self.scratch.push(scratch);
        Ok(TargetFolder(self.scratch.len() - 1))
    }

    /// Opens a directory for output and creates it, with its parents, if necessary.
    pub(crate) fn create_and_open(&mut self, directory: &Path) -> Result<TargetFolder, Failure> {
        for ancestor in missing(directory) {
            let mut temporary_paths = temporary_paths();
            match fs::create_dir(&ancestor) {
                Ok(()) => temporary_paths.new.push(ancestor),
                // `results/../other` creates the same directory twice.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Failure::cannot_write_to(directory, &error)),
            }
        }
        if !directory.is_dir() {
            let message = format!("can not write to {}: not a directory", directory.display());
            return Err(Failure::BadInput(message));
        }
        self.open(directory)
    }

    /// Writes one file for a directory, to be moved to `target` later.
    pub(crate) fn write(
        &mut self,
        folder: TargetFolder,
        target: PathBuf,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.refuse_duplicate(&target)?;
        let scratch = self.scratch[folder.0].join(self.files.len().to_string());
        let written = File::create_new(&scratch).and_then(|file| {
            let mut file = BufWriter::new(file);
            fill(&mut file)?;
            file.flush()
        });
        written.map_err(|error| Failure::write(target.display(), &error))?;
        self.files.push((scratch, target));
        Ok(())
    }

    /// Removes a file of an earlier answer, if there is one, when those of this one are placed: this
    /// answer has none of its kind, and beside it the earlier one would look like a part of it.
    pub(crate) fn remove(&mut self, target: PathBuf) {
        self.outdated.push(target);
    }

    /// An error if another output has the same path.
    fn refuse_duplicate(&self, target: &Path) -> Result<(), Failure> {
        if self
            .files
            .iter()
            .any(|(_, pending)| is_same(pending, target))
        {
            let shown = target.display();
            let message = format!("two outputs are named {shown}; allowed are two files");
            return Err(Failure::BadInput(message));
        }
        Ok(())
    }

    /// The same for a writer that needs the temporary file's name, and syncs it to the disk itself.
    pub(crate) fn place(
        &mut self,
        folder: TargetFolder,
        target: PathBuf,
        fill: impl FnOnce(&Path) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let scratch = self.scratch[folder.0].join(self.files.len().to_string());
        fill(&scratch)?;
        self.files.push((scratch, target));
        Ok(())
    }

    /// Moves every file to its place and returns their paths.
    pub(crate) fn commit(mut self) -> Result<Vec<PathBuf>, Failure> {
        let files = std::mem::take(&mut self.files);
        let failed = |target: &Path| {
            let shown = target.display().to_string();
            move |error| Failure::write(shown, &error)
        };
        let (streams, places): (Vec<_>, Vec<_>) =
            files.iter().partition(|(_, target)| is_stream(target));
        // Without the lock, so that a pipe to which nobody listens can be interrupted.
        for (scratch, target) in streams {
            copy_into(scratch, target).map_err(failed(target))?;
        }
        let mut temporary_paths = temporary_paths();
        for (scratch, target) in places {
            move_into_place(scratch, target).map_err(failed(target))?;
        }
        let is_placed = |target: &Path| files.iter().any(|(_, placed)| is_same(placed, target));
        for target in self.outdated.iter().filter(|target| !is_placed(target)) {
            match fs::remove_file(target) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(failed(target)(error));
                }
                _ => {}
            }
        }
        temporary_paths.new.clear();
        Ok(files.into_iter().map(|(_, target)| target).collect())
    }
}

impl Drop for PendingOutputs {
    /// Removes the temporary directories and, unless files were placed in them, the new
    /// directories.
    fn drop(&mut self) {
        temporary_paths().clear();
    }
}

/// Whether this is a device or a pipe, into which contents are copied.
fn is_stream(target: &Path) -> bool {
    target.exists() && !target.is_file()
}

/// Moves a file to its place. A link is followed, so that its target is replaced and not the link;
/// the contents are copied into a file on another disk, to which nothing can be renamed.
fn move_into_place(scratch: &Path, target: &Path) -> io::Result<()> {
    let target = match target.is_symlink() {
        // A link whose target does not exist yet.
        true => target.canonicalize().or_else(|_| {
            let folder = target.parent().unwrap_or(Path::new(""));
            target.read_link().map(|behind| folder.join(behind))
        })?,
        false => target.to_owned(),
    };
    match fs::rename(scratch, &target) {
        Err(error) if error.kind() == ErrorKind::CrossesDevices => copy_into(scratch, &target),
        renamed => renamed,
    }
}

fn copy_into(scratch: &Path, target: &Path) -> io::Result<()> {
    let mut to = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .open(target)?;
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

/// Whether two paths refer to the same file, which may not exist yet.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    let new = |path: &Path| Some(parent_of(path).canonicalize().ok()?.join(path.file_name()?));
    let place = |path: &Path| path.canonicalize().ok().or_else(|| new(path));
    place(one).is_some_and(|one| place(other) == Some(one))
}
