//! Work that ends when its time is up, or when nobody waits for its answer any more.
use crate::refusal::Refusal;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tokio::sync::Semaphore;

/// Who waits for an answer holds this; dropping it, as a closed connection does, ends the work.
pub(crate) struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// What the work looks at from time to time.
#[derive(Clone)]
pub(crate) struct Leash {
    left: Arc<AtomicBool>,
    until: Option<Instant>,
}

impl Leash {
    /// Without a limit of time.
    pub(crate) fn new() -> (Waiting, Self) {
        let left = Arc::new(AtomicBool::new(false));
        let leash = Self {
            left: Arc::clone(&left),
            until: None,
        };
        (Waiting(left), leash)
    }

    /// The same, for so long from now on.
    pub(crate) fn within(&self, budget: Duration) -> Self {
        Self {
            left: Arc::clone(&self.left),
            until: Some(Instant::now() + budget),
        }
    }

    /// Whether nobody waits any more.
    pub(crate) fn is_left(&self) -> bool {
        self.left.load(Ordering::Relaxed)
    }

    /// Whether to go on.
    pub(crate) fn holds(&self) -> ControlFlow<()> {
        if self.is_left() || self.until.is_some_and(|until| Instant::now() >= until) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Does some work on a thread where it may take its time, once one of `workers` is free.
pub(crate) async fn compute<T: Send + 'static>(
    workers: &Arc<Semaphore>,
    work: impl FnOnce(&Leash) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let (_waiting, leash) = Leash::new();
    let worker = Arc::clone(workers).acquire_owned().await;
    let worker = worker.map_err(Refusal::failed)?;
    let work = move || {
        // Held until the work ends, which may be after it was told to.
        let _worker = worker;
        work(&leash)
    };
    tokio::task::spawn_blocking(work)
        .await
        .map_err(Refusal::failed)?
}
