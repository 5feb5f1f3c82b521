//! Runs long work without Python's lock, so that Ctrl-C can end it.

use crate::errors::internal_error;
use crate::pool::{abandon_pool, pool};
use pyo3::prelude::*;
use snapload::analysis::{OnProgress, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The interval at which signals are checked and progress is reported.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// The time that cancelled work may take to end; after that it is left to end by itself.
const INTERRUPT_WAIT: Duration = Duration::from_millis(500);

/// The messages between the thread of some work and that of Python.
#[derive(Default)]
pub(crate) struct SharedProgress {
    done: AtomicU64,
    stop: AtomicBool,
}

impl SharedProgress {
    /// Long work calls this to report its progress, and to learn whether to continue.
    pub(crate) fn report(&self, progress: Progress) -> ControlFlow<()> {
        self.done.fetch_max(progress.done as u64, Ordering::Relaxed);
        match self.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// Runs some work in the pool of this process, without Python's lock, while this thread checks for
/// signals and reports the progress to `progress`.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&SharedProgress) -> T + Send + 'static,
) -> PyResult<T> {
    let shared = Arc::new(SharedProgress::default());
    let (theirs, (send, results)) = (Arc::clone(&shared), channel());
    pool(py)?.spawn(move || {
        // The receiver may be gone.
        let _ = send.send(work(&theirs));
    });
    let results = Mutex::new(results);
    let outcome = wait(py, progress, &shared, &results);
    if outcome.is_err() {
        shared.stop.store(true, Ordering::Relaxed);
        if receive(py, &results, INTERRUPT_WAIT).is_err() {
            abandon_pool(py);
        }
    }
    outcome
}

/// Runs work of a single thread on this one, without Python's lock. The work has to ask regularly
/// whether to continue; signals are checked then.
pub(crate) fn on_this_thread<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(OnProgress) -> T + Send,
) -> PyResult<T> {
    let signal = Mutex::new(None);
    let last_check = Mutex::new(Instant::now());
    let on_progress = |_: Progress| {
        let mut last_check = last_check.lock().unwrap_or_else(PoisonError::into_inner);
        if last_check.elapsed() < CHECK_INTERVAL {
            return ControlFlow::Continue(());
        }
        *last_check = Instant::now();
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                *signal.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                ControlFlow::Break(())
            }
        }
    };
    let result = py.detach(|| work(&on_progress));
    match signal.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(result),
    }
}

/// Waits for the result, up to a time limit, without Python's lock.
fn receive<T: Send>(
    py: Python<'_>,
    results: &Mutex<Receiver<T>>,
    time: Duration,
) -> Result<T, RecvTimeoutError> {
    py.detach(|| {
        let results = results.lock().unwrap_or_else(PoisonError::into_inner);
        results.recv_timeout(time)
    })
}

fn wait<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    shared: &SharedProgress,
    results: &Mutex<Receiver<T>>,
) -> PyResult<T> {
    let mut reported = 0;
    let mut report = || match progress {
        Some(progress) => {
            let done = shared.done.load(Ordering::Relaxed);
            if done > reported {
                progress.call1((done,))?;
            }
            reported = done;
            Ok(())
        }
        None => PyResult::Ok(()),
    };
    loop {
        match receive(py, results, CHECK_INTERVAL) {
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                report()?;
            }
            Ok(result) => {
                report()?;
                return Ok(result);
            }
            // The work panicked.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(internal_error(
                    "the engine failed; standard error says where",
                ));
            }
        }
    }
}
