//! The threads that work is shared out to: one pool for each process.
//!
//! A process that was forked has none of the threads of the one that it came from, and would wait
//! for them for ever. So a pool is known by the process that it was made in, and a new one is made
//! where that is another.

use crate::errors::of_program;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

/// The pool, and the process that it was made in.
///
/// It is locked by those alone who hold Python's lock, and for no longer. Python forks holding its
/// own lock, so nobody holds this one then.
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
            // To end a pool means to wait for its threads, which are none here.
            std::mem::forget(other);
            // Work that panics lets go of what its answer was to come by, and is told of so.
            let pool = ThreadPoolBuilder::new().panic_handler(|_| {}).build();
            let pool = Arc::new(pool.map_err(of_program)?);
            *known = Some((here, Arc::clone(&pool)));
            Ok(pool)
        }
    }
}

/// Leaves the pool to the work that goes on in it; whoever comes next has a new one.
pub(crate) fn leave(_py: Python<'_>) {
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::forget(known.take());
}
