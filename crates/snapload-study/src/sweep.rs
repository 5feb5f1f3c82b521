//! The loop of a study: runs the next cases, and saves their rows in the store.

use crate::study_file::GROUP;
use crate::{Row, Store, Study, StudyError, rows};
use snapload::analysis::{Cancelled, Counter, OnProgress, Progress, ThreadResults};
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Cases of a chunk are begun for this long; a crash can cost two chunks.
const CHUNK_TIME: Duration = Duration::from_secs(3);
/// The most cases of a chunk: what is held in memory at a time, and a row group of the file, into
/// which such a chunk is copied unchanged.
const MOST: u64 = GROUP as u64;

/// How often rows that are damaged on the disk are computed again.
const TRIES: u32 = 3;

/// A chunk that is computed but not saved yet.
type Chunk = (Range<u64>, ThreadResults<Row>);

/// Runs the cases that are missing in the store, on all threads, and completes the file. While a
/// chunk is run the one before it is written. Rows that are found damaged when the file is joined
/// are run again. If the work is cancelled, no more cases are begun, and the rows of those that
/// were begun are kept.
///
/// # Errors
/// [`StudyError::Failed`] if rows can not be written, or the list of cases can not be read;
/// [`StudyError::Damaged`] if rows are damaged repeatedly; [`StudyError::Cancelled`], with the
/// number of saved rows, if the work is cancelled.
pub fn sweep(study: &Study, mut store: Store, on_progress: OnProgress) -> Result<(), StudyError> {
    let mut tries = 1;
    loop {
        fill(study, &mut store, on_progress)?;
        match store.finish() {
            Err(StudyError::Damaged { .. }) if tries < TRIES => tries += 1,
            finished => return finished,
        }
    }
}

/// Runs what is missing.
fn fill(study: &Study, store: &mut Store, on_progress: OnProgress) -> Result<(), StudyError> {
    let stop_requested = AtomicBool::new(false);
    let within = |progress: Progress| {
        stop_requested.fetch_or(on_progress(progress).is_break(), Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let counter = Counter::new("sweep", store.saved(), store.total(), &within);
    let mut written: Option<Chunk> = None;
    loop {
        counter.add(0)?;
        let should_continue = !stop_requested.load(Ordering::Relaxed);
        let range = next_range(store, written.as_ref()).filter(|_| should_continue);
        if range.is_none() && written.is_none() {
            break;
        }
        let (saved, run) = rayon::join(
            || match written.take() {
                Some((range, rows)) => store.save(range, &rows),
                None => Ok(()),
            },
            || {
                range.map_or(Ok(None), |range| {
                    chunk(study, range, &counter, &stop_requested)
                })
            },
        );
        saved?;
        written = run?;
    }
    if store.gap().is_some() {
        let done = store.saved() as f64;
        return Err(Cancelled { done }.into());
    }
    Ok(())
}

/// The first of some rows, as many as are begun within the time of a chunk; none if the work is
/// cancelled before.
fn chunk(
    study: &Study,
    range: Range<u64>,
    counter: &Counter,
    stop_requested: &AtomicBool,
) -> Result<Option<Chunk>, StudyError> {
    let cases = study.cases(range.clone())?;
    let began = Instant::now();
    let no_more = || stop_requested.load(Ordering::Relaxed) || began.elapsed() >= CHUNK_TIME;
    let rows = rows(&cases, counter, &no_more)?;
    let end = range.start + rows.iter().len() as u64;
    Ok((end > range.start).then_some((range.start..end, rows)))
}

/// The next missing rows, after those that are being written, up to the end of their row group.
fn next_range(store: &Store, written: Option<&Chunk>) -> Option<Range<u64>> {
    let from = written.map_or(0, |(range, _)| range.end);
    let mut missing = store.gaps().filter(|gap| gap.end > from);
    let gap = missing.next()?;
    let start = gap.start.max(from);
    let first = store.rows().start;
    let group_end = first + ((start - first) / MOST + 1) * MOST;
    Some(start..gap.end.min(group_end))
}
