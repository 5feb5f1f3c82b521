//! Ctrl-C, or a request to end: leave no scratch files, exit status 130.
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Directories to take away if the program is interrupted: scratch ones with all they hold, and
/// new output directories, which are taken away only if empty.
#[derive(Default)]
pub(crate) struct Leftovers {
    /// Scratch directories.
    pub(crate) scratch: Vec<PathBuf>,
    /// New directories, outermost first.
    pub(crate) new: Vec<PathBuf>,
}

static LEFTOVERS: Mutex<Leftovers> = Mutex::new(Leftovers {
    scratch: Vec::new(),
    new: Vec::new(),
});

/// What is to be taken away. While this is held an interruption waits, so files that belong
/// together can be put in their places together.
pub(crate) fn leftovers() -> MutexGuard<'static, Leftovers> {
    LEFTOVERS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Leftovers {
    /// Takes it all away, as far as the system lets us.
    pub(crate) fn clear(&mut self) {
        for directory in self.scratch.drain(..) {
            let _ = std::fs::remove_dir_all(directory);
        }
        for directory in self.new.drain(..).rev() {
            let _ = std::fs::remove_dir(directory);
        }
    }
}

/// Whether a first interruption only asks to stop, as what is at work comes to a good end by itself.
static GENTLE: AtomicBool = AtomicBool::new(false);
/// Whether that was asked.
static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on the first interruption is for [`asked`] to tell; the second ends the program at once.
pub(crate) fn be_gentle() {
    GENTLE.store(true, Ordering::Relaxed);
}

/// Whether it is time to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Installs the handler; where that is not possible the system's own answer to Ctrl-C remains.
pub(crate) fn install() {
    let _ = ctrlc::set_handler(|| {
        let gentle = GENTLE.load(Ordering::Relaxed);
        // Standard error may be closed; the status still tells.
        if gentle && !ASKED.swap(true, Ordering::Relaxed) {
            let words = "stopping after the cases at work; once more to stop at once";
            let _ = writeln!(std::io::stderr(), "{words}");
            return;
        }
        leftovers().clear();
        let left = if gentle {
            "what was saved is safe, and --resume goes on from there"
        } else {
            "nothing was written"
        };
        let _ = writeln!(std::io::stderr(), "interrupted: {left}");
        std::process::exit(130);
    });
}
