//! The loop of a study: the next cases, their rows, into the store.

use crate::{Store, Study, StudyError, rows};
use std::time::{Duration, Instant};

/// So long a chunk is to take: what a crash can cost.
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

/// Runs what is missing in the store, on the threads that there are, and completes the file.
///
/// # Errors
/// [`StudyError::Failed`] if rows can not be written, or the list of cases not be read.
pub fn sweep(study: &Study, mut store: Store, watch: &Watch) -> Result<Finished, StudyError> {
    let mut size = FIRST;
    while let Some(gap) = store.gap() {
        if (watch.stop)() {
            return Ok(Finished::Stopped(store.safe()));
        }
        let range = gap.start..gap.end.min(gap.start.saturating_add(size));
        let began = Instant::now();
        let rows = rows(&study.draw(range.clone())?, study.trust(), watch.done);
        store.save(range, &rows)?;
        size = next_size(size, began.elapsed());
    }
    store.finish()?;
    Ok(Finished::Complete)
}

/// The size of a chunk that would take the time aimed at; a row does not depend on it.
fn next_size(size: u64, took: Duration) -> u64 {
    let factor = AIM.as_secs_f64() / took.as_secs_f64().max(1e-6);
    let wanted = size as f64 * factor.clamp(0.25, 4.0);
    (wanted as u64).clamp(LEAST, MOST)
}
