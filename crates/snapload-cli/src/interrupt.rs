//! Ctrl-C, or a request to end: leave no scratch files, exit status 130.
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

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

/// Work that ends by itself soon after it is asked to.
pub(crate) struct Graceful {
    /// What the first interruption does.
    pub(crate) on_first: Box<dyn Fn() + Send + Sync>,
    /// What the second one says, which ends the program at once.
    pub(crate) after_second: &'static str,
}

static GRACEFUL: OnceLock<Graceful> = OnceLock::new();
/// Whether it was asked to stop.
static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on the first interruption only asks to stop; the second ends the program at once.
pub(crate) fn end_gracefully(graceful: Graceful) {
    // There is one verb in a program, and one work that it does.
    let _ = GRACEFUL.set(graceful);
}

/// Says something on standard error, which may be closed.
pub(crate) fn say(words: &str) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// Whether it is time to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Installs the handler; where that is not possible the system's own answer to Ctrl-C remains.
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
