//! Work that ends when its time is up, or when the client no longer waits for its answer.
use crate::refusal::Refusal;
use axum::body::Bytes;
use serde_json::{Value as JsonValue, json};
use snapload::analysis::Progress;
use std::convert::Infallible;
use std::ops::ControlFlow;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tokio::sync::mpsc::error::SendError;
use tokio::sync::mpsc::{Sender, channel};
use tokio::sync::{Semaphore, watch};
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt};

/// The least time between two progress reports.
const EVERY: Duration = Duration::from_millis(100);

/// Held by the handler that waits for an answer; dropping it, as a closed connection does, ends the
/// work.
pub(crate) struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// How long work may continue: as long as a client waits for it, and possibly up to some time.
#[derive(Clone)]
pub(crate) struct Allowance {
    abandoned: Arc<AtomicBool>,
    until: Option<Instant>,
    /// Where its progress is published.
    progress: Option<watch::Sender<ProgressReport>>,
}

/// The progress of some work.
#[derive(Clone, Default, PartialEq)]
struct ProgressReport {
    /// What is being done.
    doing: String,
    percent: u8,
}

impl Allowance {
    /// An allowance without a time limit.
    pub(crate) fn new() -> (Waiting, Self) {
        let abandoned = Arc::new(AtomicBool::new(false));
        let allowance = Self {
            abandoned: Arc::clone(&abandoned),
            until: None,
            progress: None,
        };
        (Waiting(abandoned), allowance)
    }

    /// The same, with a channel for the progress.
    fn with_progress(self, progress: watch::Sender<ProgressReport>) -> Self {
        let progress = Some(progress);
        Self { progress, ..self }
    }

    /// The same, limited to `time` from now on, and no longer than before.
    pub(crate) fn within(&self, time: Duration) -> Self {
        let until = Instant::now() + time;
        Self {
            until: Some(self.until.map_or(until, |before| before.min(until))),
            ..self.clone()
        }
    }

    /// Whether no client waits any more.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.abandoned.load(Ordering::Relaxed)
    }

    /// The callback of long work.
    pub(crate) fn check(&self, progress: Progress) -> ControlFlow<()> {
        if let Some(report) = &self.progress {
            // NaN, as from 0/0, is cast to 0.
            let percent = ((100.0 * progress.done / progress.of) as u8).min(100);
            report.send_if_modified(|report| {
                let more = report.percent != percent || report.doing != progress.doing;
                if more {
                    let doing = progress.doing.to_owned();
                    *report = ProgressReport { doing, percent };
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

/// Does some work on a thread that may block, once one of `workers` is free.
pub(crate) async fn compute<T: Send + 'static>(
    workers: &Arc<Semaphore>,
    work: impl FnOnce(&Allowance) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let (_waiting, allowance) = Allowance::new();
    on_a_worker(Arc::clone(workers), allowance, work).await
}

/// The same for work that may already be abandoned when its turn comes; then it is not started.
pub(crate) async fn on_a_worker<T: Send + 'static>(
    workers: Arc<Semaphore>,
    allowance: Allowance,
    work: impl FnOnce(&Allowance) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let worker = workers.acquire_owned().await.map_err(Refusal::failed)?;
    if allowance.is_abandoned() {
        return Err(Refusal::failed("nobody waits for the answer"));
    }
    let work = move || {
        // Held until the work ends, which may be after it was cancelled.
        let _worker = worker;
        work(&allowance)
    };
    tokio::task::spawn_blocking(work)
        .await
        .map_err(Refusal::failed)?
}

/// The lines that a task sends. Dropping the stream ends the work of the task's allowance.
pub(crate) fn lines_of<T, F>(task: T) -> impl Stream<Item = Result<Bytes, Infallible>> + use<T, F>
where
    T: FnOnce(Allowance, Sender<Bytes>) -> F,
    F: Future<Output = ()> + Send + 'static,
{
    let (waiting, allowance) = Allowance::new();
    let (send, receive) = channel(4);
    tokio::spawn(task(allowance, send));
    ReceiverStream::new(receive).map(move |line| {
        let _waiting = &waiting;
        Ok(line)
    })
}

/// As `compute`, in lines, each an object of JSON: the progress, and at the end the resulting text
/// as `answer`, or why there is none as `error`.
pub(crate) fn compute_in_lines<W>(
    workers: &Arc<Semaphore>,
    work: W,
) -> impl Stream<Item = Result<Bytes, Infallible>> + use<W>
where
    W: FnOnce(&Allowance) -> Result<Vec<u8>, Refusal> + Send + 'static,
{
    let workers = Arc::clone(workers);
    lines_of(async move |allowance: Allowance, send| {
        let (progress, report) = watch::channel(ProgressReport::default());
        let work = on_a_worker(workers, allowance.with_progress(progress), work);
        // If a line can not be sent, the client is gone.
        let _ = send_progress(work, report, send).await;
    })
}

/// Sends the lines of some work.
async fn send_progress(
    work: impl Future<Output = Result<Vec<u8>, Refusal>>,
    mut report: watch::Receiver<ProgressReport>,
    send: Sender<Bytes>,
) -> Result<(), SendError<Bytes>> {
    let line = |object: JsonValue| Bytes::from(format!("{object}\n"));
    let mut work = pin!(work);
    let done = loop {
        match tokio::time::timeout(EVERY, work.as_mut()).await {
            Ok(done) => break done,
            Err(_) if report.has_changed().unwrap_or(false) => {
                let ProgressReport { doing, percent } = report.borrow_and_update().clone();
                let now = json!({ "doing": doing, "percent": percent });
                send.send(line(now)).await?;
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

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR: Duration = Duration::from_secs(3600);

    fn may_continue(allowance: &Allowance) -> bool {
        allowance
            .check(Progress::new("cells", 0.0, 1.0))
            .is_continue()
    }

    async fn next(
        lines: &mut (impl Stream<Item = Result<Bytes, Infallible>> + Unpin),
    ) -> JsonValue {
        let Ok(line) = lines.next().await.expect("a line");
        serde_json::from_slice(&line).expect("JSON")
    }

    #[test]
    fn a_later_time_limit_does_not_extend_an_earlier_one() {
        let (_waiting, allowance) = Allowance::new();
        assert!(may_continue(&allowance.within(HOUR)));
        assert!(!may_continue(
            &allowance.within(Duration::ZERO).within(HOUR)
        ));
        assert!(!may_continue(
            &allowance.within(HOUR).within(Duration::ZERO)
        ));
    }

    #[tokio::test]
    async fn each_step_is_a_line_and_the_answer_is_the_last() {
        let (go, seen) = std::sync::mpsc::channel();
        let workers = Arc::new(Semaphore::new(1));
        let mut lines = compute_in_lines(&workers, move |allowance| {
            for (done, of) in [(0.0, 0.0), (1.0, 4.0), (3.0, 4.0), (9.0, 4.0), (-1.0, 4.0)] {
                let _ = allowance.check(Progress::new("cells", done, of));
                seen.recv().map_err(Refusal::failed)?;
            }
            Ok(b"made".to_vec())
        });
        for percent in [0, 25, 75, 100, 0] {
            let line = next(&mut lines).await;
            assert_eq!(line, json!({ "doing": "cells", "percent": percent }));
            go.send(()).expect("work that goes on");
        }
        assert_eq!(next(&mut lines).await, json!({ "answer": "made" }));
        assert!(lines.next().await.is_none());
    }

    #[tokio::test]
    async fn work_without_a_worker_is_not_started() {
        let workers = Arc::new(Semaphore::new(1));
        workers.close();
        let mut lines = compute_in_lines(&workers, |_| panic!("it was begun"));
        let line = next(&mut lines).await;
        let message = line["error"]["message"].as_str();
        assert!(
            message.is_some_and(|message| message.contains("closed")),
            "{line}"
        );
    }

    #[tokio::test]
    async fn work_that_was_abandoned_before_its_turn_is_not_started() {
        let (waiting, allowance) = Allowance::new();
        drop(waiting);
        let started = Arc::new(AtomicBool::new(false));
        let here = Arc::clone(&started);
        let workers = Arc::new(Semaphore::new(1));
        let done = on_a_worker(workers, allowance, move |_| {
            here.store(true, Ordering::Relaxed);
            Ok(())
        });
        assert!(done.await.is_err() && !started.load(Ordering::Relaxed));
    }
}
