//! The loop of a study: the next cases, their rows, into the store.

use crate::whole::GROUP;
use crate::{Row, Store, Study, StudyError, rows};
use snapload::analysis::{Cancelled, Counter, Made, OnProgress, Progress};
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// So long a chunk is to take; a crash can cost two of them.
const AIM: Duration = Duration::from_secs(3);
/// Cases of the first chunk, before anything is known of their pace.
const FIRST: u64 = 256;
/// The least cases of a chunk: enough for many threads.
const LEAST: u64 = 64;
/// The most: what is held in memory at a time, and a group of rows of the file, which takes such a
/// chunk as it stands.
const MOST: u64 = GROUP as u64;

/// When a sweep ends that is told to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Once the chunk at work is done and safe.
    AfterChunk,
    /// Before the next case; what the chunk at work has come to is lost.
    AtNextCase,
}

/// So often rows that come back from the disk damaged are computed again.
const TRIES: u32 = 3;

/// A chunk that is run and not yet safe.
type Chunk = (Range<u64>, Made<Row>);

/// Runs what is missing in the store, on the threads that there are, and completes the file. While
/// a chunk is run the one before it is written. Rows that come back damaged when the file is put
/// together are run again.
///
/// # Errors
/// [`StudyError::Failed`] if rows can not be written, or the list of cases not be read;
/// [`StudyError::Damaged`] if rows come back damaged again and again; [`StudyError::Cancelled`],
/// with the number of rows that are safe, if it is told to end.
pub fn sweep(
    study: &Study,
    mut store: Store,
    ending: Ending,
    on_progress: OnProgress,
) -> Result<(), StudyError> {
    let mut tries = 1;
    loop {
        fill(study, &mut store, ending, on_progress)?;
        match store.finish() {
            Err(StudyError::Damaged { .. }) if tries < TRIES => tries += 1,
            finished => return finished,
        }
    }
}

/// Runs what is missing.
fn fill(
    study: &Study,
    store: &mut Store,
    ending: Ending,
    on_progress: OnProgress,
) -> Result<(), StudyError> {
    let told_to_end = AtomicBool::new(false);
    let within = |progress: Progress| {
        let answer = on_progress(progress);
        told_to_end.fetch_or(answer.is_break(), Ordering::Relaxed);
        match ending {
            Ending::AtNextCase => answer,
            Ending::AfterChunk => ControlFlow::Continue(()),
        }
    };
    let counter = Counter::new("sweep", store.safe(), store.asked(), &within);
    let mut size = FIRST;
    let mut written: Option<Chunk> = None;
    loop {
        let go_on = counter.add(0).is_ok() && !told_to_end.load(Ordering::Relaxed);
        let range = next_range(store, written.as_ref(), size).filter(|_| go_on);
        if range.is_none() && written.is_none() {
            break;
        }
        let began = Instant::now();
        let (saved, run) = rayon::join(
            || match written.take() {
                Some((range, rows)) => store.save(range, &rows),
                None => Ok(()),
            },
            || range.map(|range| chunk(study, range, &counter)).transpose(),
        );
        saved?;
        written = match run {
            Err(StudyError::Cancelled(_)) => None,
            run => run?,
        };
        size = next_size(size, began.elapsed());
    }
    if store.gap().is_some() {
        let done = store.safe() as f64;
        return Err(Cancelled { done }.into());
    }
    Ok(())
}

fn chunk(study: &Study, range: Range<u64>, counter: &Counter) -> Result<Chunk, StudyError> {
    let drawn = study.draw(range.clone())?;
    Ok((range, rows(&drawn, counter)?))
}

/// The next rows that are missing, after those that are being written.
fn next_range(store: &Store, written: Option<&Chunk>, size: u64) -> Option<Range<u64>> {
    let from = written.map_or(0, |(range, _)| range.end);
    let mut missing = store.gaps().filter(|gap| gap.end > from);
    let gap = missing.next()?;
    let start = gap.start.max(from);
    let first = store.rows().start;
    let group_end = first + ((start - first) / MOST + 1) * MOST;
    let end = start.saturating_add(size).min(group_end);
    Some(start..gap.end.min(end))
}

/// The size of a chunk that would take the time aimed at; a row does not depend on it.
fn next_size(size: u64, took: Duration) -> u64 {
    let factor = AIM.as_secs_f64() / took.as_secs_f64().max(1e-6);
    let wanted = size as f64 * factor.clamp(0.25, 4.0);
    (wanted as u64).clamp(LEAST, MOST)
}
