//! Long work without Python's lock, which Ctrl-C ends.

use crate::errors::of_program;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// So often it is looked whether there was a signal, and the progress is told.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// So long work that was told to end may take to do so; it is left to end by itself after that.
const GRACE: Duration = Duration::from_millis(500);

/// The sign of life of some work: counts what is done, and ends the work where that was asked for.
#[derive(Default)]
pub(crate) struct Pulse {
    done: AtomicU64,
    stop: AtomicBool,
}

/// What unwinds the work that is to end; nobody sees it.
struct Stopped;

impl Pulse {
    /// One more is done. The work unwinds from here if it was told to end: what it computed is dropped, and
    /// what it holds, such as the lock on a study, is let go.
    pub(crate) fn beat(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
        if self.stop.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
    }
}

/// Does some work on a thread of its own, without Python's lock, while this thread looks for signals and tells
/// `progress` how many beats there were.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Pulse) -> T + Send + 'static,
) -> PyResult<T> {
    let pulse = Arc::new(Pulse::default());
    let (theirs, (send, results)) = (Arc::clone(&pulse), channel());
    std::thread::spawn(move || {
        // Nothing of it is looked at after it unwound.
        let result = catch_unwind(AssertUnwindSafe(|| work(&theirs)));
        // Nobody may be waiting any more.
        let _ = send.send(result.ok());
    });
    let results = Mutex::new(results);
    let outcome = wait(py, progress, &pulse, &results);
    if outcome.is_err() {
        pulse.stop.store(true, Ordering::Relaxed);
        let _ = receive(py, &results, GRACE);
    }
    outcome
}

/// Waits for the result, for so long, without Python's lock.
fn receive<T: Send>(
    py: Python<'_>,
    results: &Mutex<Receiver<Option<T>>>,
    time: Duration,
) -> Result<Option<T>, RecvTimeoutError> {
    py.detach(|| {
        let results = results.lock().unwrap_or_else(PoisonError::into_inner);
        results.recv_timeout(time)
    })
}

fn wait<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    pulse: &Pulse,
    results: &Mutex<Receiver<Option<T>>>,
) -> PyResult<T> {
    let mut told = 0;
    let mut tell = || match progress {
        Some(progress) => {
            let done = pulse.done.load(Ordering::Relaxed);
            if done > told {
                progress.call1((done - told,))?;
            }
            told = done;
            Ok(())
        }
        None => PyResult::Ok(()),
    };
    loop {
        match receive(py, results, LOOK_EVERY) {
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                tell()?;
            }
            Ok(Some(result)) => {
                tell()?;
                return Ok(result);
            }
            Ok(None) | Err(RecvTimeoutError::Disconnected) => {
                return Err(of_program("the engine failed; standard error says where"));
            }
        }
    }
}
