//! Ctrl-C, or a termination signal: removes temporary files, exit status 130.
use std::io::Write;
use std::path::PathBuf;
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
            let _ = std::fs::remove_dir_all(directory);
        }
        for directory in self.new.drain(..).rev() {
            let _ = std::fs::remove_dir(directory);
        }
    }
}

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
        temporary_paths().clear();
        let left = graceful.map_or("nothing was written", |graceful| graceful.after_second);
        print_error_line(&format!("interrupted: {left}"));
        std::process::exit(130);
    });
}
