//! The thread pool of each process.
//!
//! A forked process has no threads of its parent, and would wait for them forever. So the pool is
//! stored with the process that made it, and another process makes a new one.

use crate::errors::internal_error;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

/// The pool, and the process that made it.
///
/// It is locked only while Python's lock is held. As Python forks while it holds its own lock, no
/// thread holds this one at a fork.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// The pool of this process.
pub(crate) fn pool(_py: Python<'_>) -> PyResult<Arc<ThreadPool>> {
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let here = process::id();
    match known.take() {
        Some((process, pool)) if process == here => {
            *known = Some((process, Arc::clone(&pool)));
            Ok(pool)
        }
        other => {
            // Dropping a pool waits for its threads, which do not exist in this process.
            std::mem::forget(other);
            // A panic closes the channel of the result, which tells the receiver; without a handler
            // rayon would abort the process.
            let pool = ThreadPoolBuilder::new().panic_handler(|_| {}).build();
            let pool = Arc::new(pool.map_err(internal_error)?);
            *known = Some((here, Arc::clone(&pool)));
            Ok(pool)
        }
    }
}

/// Leaves the pool to the work that still runs in it; the next work gets a new pool.
pub(crate) fn abandon_pool(_py: Python<'_>) {
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::forget(known.take());
}
