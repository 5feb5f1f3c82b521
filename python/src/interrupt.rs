//! Runs long work without Python's lock, so that Ctrl-C can end it.

use crate::errors::of_program;
use crate::pool::{leave, pool};
use pyo3::prelude::*;
use snapload::analysis::{OnProgress, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The interval at which signals are checked and progress is reported.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// The time that cancelled work may take to end; after that it is left to end by itself.
const GRACE: Duration = Duration::from_millis(500);

/// The messages between the thread of some work and that of Python.
#[derive(Default)]
pub(crate) struct Watch {
    done: AtomicU64,
    stop: AtomicBool,
}

impl Watch {
    /// Long work calls this to report its progress, and to learn whether to continue.
    pub(crate) fn go_on(&self, progress: Progress) -> ControlFlow<()> {
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
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (theirs, (send, results)) = (Arc::clone(&watch), channel());
    pool(py)?.spawn(move || {
        // The receiver may be gone.
        let _ = send.send(work(&theirs));
    });
    let results = Mutex::new(results);
    let outcome = wait(py, progress, &watch, &results);
    if outcome.is_err() {
        watch.stop.store(true, Ordering::Relaxed);
        if receive(py, &results, GRACE).is_err() {
            leave(py);
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
    let looked = Mutex::new(Instant::now());
    let go_on = |_: Progress| {
        let mut looked = looked.lock().unwrap_or_else(PoisonError::into_inner);
        if looked.elapsed() < LOOK_EVERY {
            return ControlFlow::Continue(());
        }
        *looked = Instant::now();
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                *signal.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                ControlFlow::Break(())
            }
        }
    };
    let result = py.detach(|| work(&go_on));
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
    watch: &Watch,
    results: &Mutex<Receiver<T>>,
) -> PyResult<T> {
    let mut told = 0;
    let mut tell = || match progress {
        Some(progress) => {
            let done = watch.done.load(Ordering::Relaxed);
            if done > told {
                progress.call1((done,))?;
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
            Ok(result) => {
                tell()?;
                return Ok(result);
            }
            // The work panicked.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(of_program("the engine failed; standard error says where"));
            }
        }
    }
}
