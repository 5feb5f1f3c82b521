//! Work that ends when its time is up, or when nobody waits for its answer any more.
use crate::refusal::Refusal;
use axum::body::Bytes;
use serde_json::{Value as JsonValue, json};
use snapload::analysis::Progress;
use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tokio::sync::mpsc::{Sender, channel};
use tokio::sync::{Semaphore, watch};
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt};

/// How far work has come is told no more often than this.
const EVERY: Duration = Duration::from_millis(100);

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
    /// Whoever is told how far it has come.
    told: Option<watch::Sender<Come>>,
}

/// How far some work has come.
#[derive(Clone, Default, PartialEq)]
struct Come {
    /// What is being done.
    doing: String,
    percent: u8,
}

impl Allowance {
    /// Without a limit of time.
    pub(crate) fn new() -> (Waiting, Self) {
        let abandoned = Arc::new(AtomicBool::new(false));
        let allowance = Self {
            abandoned: Arc::clone(&abandoned),
            until: None,
            told: None,
        };
        (Waiting(abandoned), allowance)
    }

    /// The same, with somebody to tell how far it has come.
    fn telling(self, told: watch::Sender<Come>) -> Self {
        let told = Some(told);
        Self { told, ..self }
    }

    /// The same, for so long from now on.
    pub(crate) fn within(&self, time: Duration) -> Self {
        Self {
            abandoned: Arc::clone(&self.abandoned),
            until: Some(Instant::now() + time),
            told: self.told.clone(),
        }
    }

    /// Whether nobody waits any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.abandoned.load(Ordering::Relaxed)
    }

    /// What long work asks.
    pub(crate) fn go_on(&self, progress: Progress) -> ControlFlow<()> {
        if let Some(told) = &self.told {
            // A negative or missing number is cast to nought, and one too large to the most.
            let percent = (100.0 * progress.done / progress.of).min(100.0) as u8;
            told.send_if_modified(|come| {
                let more = come.percent != percent || come.doing != progress.doing;
                if more {
                    let doing = progress.doing.to_owned();
                    *come = Come { doing, percent };
                }
                more
            });
        }
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

/// The same, told line by line, each an object of JSON: how far it has come, and in the end the
/// text that comes of it, as `answer`, or why there is none, as `error`. Dropping the lines ends the
/// work.
pub(crate) fn told<W>(
    workers: &Arc<Semaphore>,
    work: W,
) -> impl Stream<Item = Result<Bytes, Infallible>> + use<W>
where
    W: FnOnce(&Allowance) -> Result<Vec<u8>, Refusal> + Send + 'static,
{
    let (waiting, allowance) = Allowance::new();
    let (tell, come) = watch::channel(Come::default());
    let allowance = allowance.telling(tell);
    let (send, receive) = channel(4);
    let turn = Arc::clone(workers).acquire_owned();
    tokio::spawn(async move {
        // A semaphore that is closed has nobody waiting.
        let turn = turn.await;
        let work = tokio::task::spawn_blocking(move || {
            let _turn = turn;
            work(&allowance)
        });
        // Where a line can not be sent nobody waits for the next.
        let _ = tell_of(work, come, send).await;
    });
    ReceiverStream::new(receive).map(move |line| {
        let _waiting = &waiting;
        Ok(line)
    })
}

/// Sends the lines of some work.
async fn tell_of(
    mut work: tokio::task::JoinHandle<Result<Vec<u8>, Refusal>>,
    mut come: watch::Receiver<Come>,
    send: Sender<Bytes>,
) -> Result<(), tokio::sync::mpsc::error::SendError<Bytes>> {
    let line = |told: JsonValue| Bytes::from(format!("{told}\n"));
    let done = loop {
        match tokio::time::timeout(EVERY, &mut work).await {
            Ok(done) => break done.map_err(Refusal::failed).and_then(|done| done),
            Err(_) if come.has_changed().unwrap_or(false) => {
                let told = come.borrow_and_update().clone();
                let told = json!({ "doing": told.doing, "percent": told.percent });
                send.send(line(told)).await?;
            }
            Err(_) => {}
        }
    };
    let text = done.and_then(|bytes| String::from_utf8(bytes).map_err(Refusal::failed));
    send.send(line(match text {
        Ok(text) => json!({ "answer": text }),
        Err(refusal) => json!({ "error": refusal.in_a_line() }),
    }))
    .await
}
