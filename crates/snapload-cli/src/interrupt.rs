//! Ctrl-C, or a termination signal: removes temporary files, exit status 130.
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Directories to remove if the program is interrupted: temporary ones with their contents, and new
/// output directories, which are removed only if empty.
#[derive(Default)]
pub(crate) struct TemporaryPaths {
    /// Temporary directories.
    pub(crate) scratch: Vec<PathBuf>,
    /// New directories, outermost first.
    pub(crate) new: Vec<PathBuf>,
}

static TEMPORARY_PATHS: Mutex<TemporaryPaths> = Mutex::new(TemporaryPaths {
    scratch: Vec::new(),
    new: Vec::new(),
});

/// The directories to remove. While this lock is held an interruption waits, so that files that
/// belong together can be renamed together.
pub(crate) fn temporary_paths() -> MutexGuard<'static, TemporaryPaths> {
    TEMPORARY_PATHS
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
}

impl TemporaryPaths {
    /// Removes all of them, as far as the system allows.
    pub(crate) fn clear(&mut self) {
        for directory in self.scratch.drain(..) {
            remove_with_contents(&directory);
        }
        for directory in self.new.drain(..).rev() {
            let _ = std::fs::remove_dir(directory);
        }
    }
}

/// Removes a directory with its contents. Another thread may still be writing: a file that it makes
/// while the directory is being emptied keeps the directory, which is emptied again then.
fn remove_with_contents(directory: &Path) {
    for _ in 0..MOST_REMOVALS {
        match std::fs::remove_dir_all(directory) {
            Err(error) if error.kind() == ErrorKind::DirectoryNotEmpty => {}
            _ => return,
        }
    }
}

/// How often a directory is emptied at most: far oftener than a command makes files in it.
const MOST_REMOVALS: usize = 1000;

/// Work that stops by itself soon after it is asked to.
pub(crate) struct Graceful {
    /// The action at the first interruption.
    pub(crate) on_first: Box<dyn Fn() + Send + Sync>,
    /// The message at the second one, which ends the program at once.
    pub(crate) after_second: &'static str,
}

static GRACEFUL: OnceLock<Graceful> = OnceLock::new();
/// Whether it was asked to stop.
static STOP_REQUESTED: AtomicBool = AtomicBool::new(false);

/// From now on the first interruption only asks the work to stop; the second ends the program at
/// once.
pub(crate) fn end_gracefully(graceful: Graceful) {
    // A program runs one command, and so only one such work.
    let _ = GRACEFUL.set(graceful);
}

/// Prints a message on standard error, which may be closed.
pub(crate) fn print_error_line(words: &str) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// Whether it is time to stop.
pub(crate) fn stop_requested() -> bool {
    STOP_REQUESTED.load(Ordering::Relaxed)
}

/// Installs the handler; if that is not possible the system's default for Ctrl-C remains.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        let graceful = GRACEFUL.get();
        if let Some(graceful) = graceful.filter(|_| !STOP_REQUESTED.swap(true, Ordering::Relaxed)) {
            (graceful.on_first)();
            return;
        }
        // Held until the program ends, so that no other thread adds to them meanwhile.
        let mut temporary_paths = temporary_paths();
        temporary_paths.clear();
        let left = graceful.map_or("nothing was written", |graceful| graceful.after_second);
        print_error_line(&format!("interrupted: {left}"));
        std::process::exit(130);
    });
}

#[cfg(test)]
mod tests {
    use super::TemporaryPaths;

    /// A thread that writes files, many but not for ever, until their directory is gone, as the
    /// command does while it is interrupted.
    #[test]
    fn a_directory_is_removed_while_files_are_made_in_it() {
        for _ in 0..20 {
            let place = tempfile::tempdir().unwrap();
            let scratch = place.path().join("scratch");
            std::fs::create_dir(&scratch).unwrap();
            let name = |k: u32| scratch.join(k.to_string());
            let (begun, has_begun) = std::sync::mpsc::channel();
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    let made = (0..20_000).take_while(|k| std::fs::write(name(*k), "").is_ok());
                    for _ in made {
                        let _ = begun.send(());
                    }
                });
                has_begun.recv().unwrap();
                let mut paths = TemporaryPaths::default();
                paths.scratch.push(scratch.clone());
                paths.clear();
            });
            assert!(!scratch.exists());
        }
    }
}
