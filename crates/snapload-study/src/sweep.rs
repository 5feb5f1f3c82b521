//! The loop of a study: the next cases, their rows, into the store.

use crate::whole::GROUP;
use crate::{Row, Store, Study, StudyError, rows};
use snapload::analysis::{Cancelled, Counter, Made, OnProgress, Progress};
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// For so long cases of a chunk are begun; a crash can cost two of them.
const BEGUN_FOR: Duration = Duration::from_secs(3);
/// The most cases of a chunk: what is held in memory at a time, and a group of rows of the file,
/// which takes such a chunk as it stands.
const MOST: u64 = GROUP as u64;

/// So often rows that come back from the disk damaged are computed again.
const TRIES: u32 = 3;

/// A chunk that is run and not yet safe.
type Chunk = (Range<u64>, Made<Row>);

/// Runs what is missing in the store, on the threads that there are, and completes the file. While
/// a chunk is run the one before it is written. Rows that come back damaged when the file is put
/// together are run again. If it is told to end, no more cases are begun, and the rows of those
/// that were are kept.
///
/// # Errors
/// [`StudyError::Failed`] if rows can not be written, or the list of cases not be read;
/// [`StudyError::Damaged`] if rows come back damaged again and again; [`StudyError::Cancelled`],
/// with the number of rows that are safe, if it is told to end.
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
    let told_to_end = AtomicBool::new(false);
    let within = |progress: Progress| {
        told_to_end.fetch_or(on_progress(progress).is_break(), Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let counter = Counter::new("sweep", store.safe(), store.asked(), &within);
    let mut written: Option<Chunk> = None;
    loop {
        counter.add(0)?;
        let go_on = !told_to_end.load(Ordering::Relaxed);
        let range = next_range(store, written.as_ref()).filter(|_| go_on);
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
                    chunk(study, range, &counter, &told_to_end)
                })
            },
        );
        saved?;
        written = run?;
    }
    if store.gap().is_some() {
        let done = store.safe() as f64;
        return Err(Cancelled { done }.into());
    }
    Ok(())
}

/// The first of some rows, as many as are begun within the time of a chunk; none if it is told to
/// end before.
fn chunk(
    study: &Study,
    range: Range<u64>,
    counter: &Counter,
    told_to_end: &AtomicBool,
) -> Result<Option<Chunk>, StudyError> {
    let drawn = study.draw(range.clone())?;
    let began = Instant::now();
    let no_more = || told_to_end.load(Ordering::Relaxed) || began.elapsed() >= BEGUN_FOR;
    let rows = rows(&drawn, counter, &no_more)?;
    let end = range.start + rows.iter().len() as u64;
    Ok((end > range.start).then_some((range.start..end, rows)))
}

/// The next rows that are missing, after those that are being written, up to the end of their group.
fn next_range(store: &Store, written: Option<&Chunk>) -> Option<Range<u64>> {
    let from = written.map_or(0, |(range, _)| range.end);
    let mut missing = store.gaps().filter(|gap| gap.end > from);
    let gap = missing.next()?;
    let start = gap.start.max(from);
    let first = store.rows().start;
    let group_end = first + ((start - first) / MOST + 1) * MOST;
    Some(start..gap.end.min(group_end))
}
