//! Work that ends when its time is up, or when nobody waits for its answer any more.
use crate::refusal::Refusal;
use snapload::analysis::Progress;
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

/// How long work may go on: as long as somebody waits for it, and perhaps no longer than some time.
#[derive(Clone)]
pub(crate) struct Allowance {
    abandoned: Arc<AtomicBool>,
    until: Option<Instant>,
}

impl Allowance {
    /// Without a limit of time.
    pub(crate) fn new() -> (Waiting, Self) {
        let abandoned = Arc::new(AtomicBool::new(false));
        let allowance = Self {
            abandoned: Arc::clone(&abandoned),
            until: None,
        };
        (Waiting(abandoned), allowance)
    }

    /// The same, for so long from now on.
    pub(crate) fn within(&self, time: Duration) -> Self {
        Self {
            abandoned: Arc::clone(&self.abandoned),
            until: Some(Instant::now() + time),
        }
    }

    /// Whether nobody waits any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.abandoned.load(Ordering::Relaxed)
    }

    /// What long work asks.
    pub(crate) fn go_on(&self, _: Progress) -> ControlFlow<()> {
        let late = self.until.is_some_and(|until| Instant::now() >= until);
        if late || self.is_abandoned() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Does some work on a thread where it may take its time, once one of `workers` is free.
pub(crate) async fn compute<T: Send + 'static>(
    workers: &Arc<Semaphore>,
    work: impl FnOnce(&Allowance) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let (_waiting, allowance) = Allowance::new();
    let worker = Arc::clone(workers).acquire_owned().await;
    let worker = worker.map_err(Refusal::failed)?;
    let work = move || {
        // Held until the work ends, which may be after it was told to.
        let _worker = worker;
        work(&allowance)
    };
    tokio::task::spawn_blocking(work)
        .await
        .map_err(Refusal::failed)?
}
