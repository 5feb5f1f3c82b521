//! Long work without Python's lock, which Ctrl-C ends.

use crate::errors::of_program;
use crate::pool::{leave, pool};
use pyo3::prelude::*;
use snapload::analysis::{OnProgress, Progress};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// So often it is looked whether there was a signal, and the progress is told.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// So long work that was told to end may take to do so; it is left to end by itself after that.
const GRACE: Duration = Duration::from_millis(500);

/// What the thread of some work and that of Python tell each other.
#[derive(Default)]
pub(crate) struct Watch {
    done: AtomicU64,
    stop: AtomicBool,
}

impl Watch {
    /// What long work calls.
    pub(crate) fn go_on(&self, progress: Progress) -> ControlFlow<()> {
        self.done.fetch_max(progress.done as u64, Ordering::Relaxed);
        match self.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// Does some work in the pool of this process, without Python's lock, while this thread looks for
/// signals and tells `progress` how much is done.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (theirs, (send, results)) = (Arc::clone(&watch), channel());
    pool(py)?.spawn(move || {
        // Nobody may be waiting any more.
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

/// Does work that takes one thread on this one, without Python's lock. The work has to ask now and
/// then whether to go on; it is looked for signals then.
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

/// Waits for the result, for so long, without Python's lock.
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
