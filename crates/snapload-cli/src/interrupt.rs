//! Ctrl-C, or a termination signal: removes temporary files, exit status 130.
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Directories to remove if the program is interrupted: temporary ones with their contents, and new
/// output directories, which are removed only if empty.
#[derive(Default)]
pub(crate) struct Leftovers {
    /// Temporary directories.
    pub(crate) scratch: Vec<PathBuf>,
    /// New directories, outermost first.
    pub(crate) new: Vec<PathBuf>,
}

static LEFTOVERS: Mutex<Leftovers> = Mutex::new(Leftovers {
    scratch: Vec::new(),
    new: Vec::new(),
});

/// The directories to remove. While this lock is held an interruption waits, so that files that
/// belong together can be renamed together.
pub(crate) fn leftovers() -> MutexGuard<'static, Leftovers> {
    LEFTOVERS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Leftovers {
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
static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on the first interruption only asks the work to stop; the second ends the program at
/// once.
pub(crate) fn end_gracefully(graceful: Graceful) {
    // A program runs one command, and so only one such work.
    let _ = GRACEFUL.set(graceful);
}

/// Prints a message on standard error, which may be closed.
pub(crate) fn say(words: &str) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// Whether it is time to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Installs the handler; if that is not possible the system's default for Ctrl-C remains.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        let graceful = GRACEFUL.get();
        if let Some(graceful) = graceful.filter(|_| !ASKED.swap(true, Ordering::Relaxed)) {
            (graceful.on_first)();
            return;
        }
        leftovers().clear();
        let left = graceful.map_or("nothing was written", |graceful| graceful.after_second);
        say(&format!("interrupted: {left}"));
        std::process::exit(130);
    });
}
