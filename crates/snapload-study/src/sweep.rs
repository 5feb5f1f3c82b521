//! The loop of a study: the next cases, their rows, into the store.

use crate::{Row, Store, Study, StudyError, rows};
use std::ops::Range;
use std::time::{Duration, Instant};

/// So long a chunk is to take; a crash can cost two of them.
const AIM: Duration = Duration::from_secs(3);
/// Cases of the first chunk, before anything is known of their pace.
const FIRST: u64 = 256;
/// The least cases of a chunk: enough for many threads.
const LEAST: u64 = 64;
/// The most: what is held in memory at a time.
const MOST: u64 = 1 << 14;

/// Who looks on.
pub struct Watch<'a> {
    /// Called for each case, on any thread.
    pub done: &'a (dyn Fn() + Sync),
    /// Asked between chunks whether to end here.
    pub stop: &'a dyn Fn() -> bool,
}

/// How far it went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finished {
    /// The file is complete and in its place.
    Complete,
    /// It was told to stop; so many rows are safe.
    Stopped(u64),
}

/// A chunk that is run and not yet safe.
type Chunk = (Range<u64>, Vec<Row>);

/// Runs what is missing in the store, on the threads that there are, and completes the file. While a chunk is run the one
/// before it is written.
///
/// # Errors
/// [`StudyError::Failed`] if rows can not be written, or the list of cases not be read.
pub fn sweep(study: &Study, mut store: Store, watch: &Watch) -> Result<Finished, StudyError> {
    let (done, mut size) = (watch.done, FIRST);
    let mut written: Option<Chunk> = None;
    loop {
        let stopped = (watch.stop)();
        let range = next_range(&store, written.as_ref(), size).filter(|_| !stopped);
        if range.is_none() && written.is_none() {
            break;
        }
        let began = Instant::now();
        let (saved, run) = rayon::join(
            || match written.take() {
                Some((range, rows)) => store.save(range, &rows),
                None => Ok(()),
            },
            || range.map(|range| chunk(study, range, done)).transpose(),
        );
        saved?;
        written = run?;
        size = next_size(size, began.elapsed());
    }
    if store.gap().is_some() {
        return Ok(Finished::Stopped(store.safe()));
    }
    store.finish()?;
    Ok(Finished::Complete)
}

fn chunk(study: &Study, range: Range<u64>, done: &(dyn Fn() + Sync)) -> Result<Chunk, StudyError> {
    let drawn = study.draw(range.clone())?;
    Ok((range, rows(&drawn, study.trust(), done)))
}

/// The next rows that are missing, after those that are being written.
fn next_range(store: &Store, written: Option<&Chunk>, size: u64) -> Option<Range<u64>> {
    let from = written.map_or(0, |(range, _)| range.end);
    let mut missing = store.gaps().filter(|gap| gap.end > from);
    let gap = missing.next()?;
    let start = gap.start.max(from);
    Some(start..gap.end.min(start.saturating_add(size)))
}

/// The size of a chunk that would take the time aimed at; a row does not depend on it.
fn next_size(size: u64, took: Duration) -> u64 {
    let factor = AIM.as_secs_f64() / took.as_secs_f64().max(1e-6);
    let wanted = size as f64 * factor.clamp(0.25, 4.0);
    (wanted as u64).clamp(LEAST, MOST)
}
