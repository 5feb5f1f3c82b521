//! Structures on the page: in metres, kilonewtons and seconds, with the texts and numbers of
//! `snapload assess`.
//!
//! The page sends a case as on the command line: a file, and changes in the notation of `--set`. So
//! errors are those of the command, and the command for the same answer can be copied.

mod elastic;
mod export;
mod instant;
mod motion;
mod opened;
mod run;
mod schema;
mod snaps;
mod waves;

pub(crate) use elastic::{Request as ElasticRequest, answer as elastic};
pub(crate) use export::{File, Request as ExportRequest};
pub(crate) use instant::{Request as InstantRequest, answer as instant};
pub(crate) use opened::File as CaseFile;
pub use opened::Opened;
pub(crate) use run::{Request as RunRequest, answer as run};
pub(crate) use schema::{opened, schema};
pub(crate) use waves::{Request as WavesRequest, answer as waves};

use snapload_structure::{Assessment, ElasticComparison};
use std::sync::{Arc, Mutex, PoisonError};

/// The latest runs, which are not repeated when a page shows another part of their time.
#[derive(Default)]
pub(crate) struct Latest {
    assessment: Kept<Assessment>,
    comparison: Kept<ElasticComparison>,
}

/// The latest result, with the request for which it was computed.
struct Kept<T>(Mutex<Option<(String, Arc<T>)>>);

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<T> Kept<T> {
    /// The stored result for a request.
    fn get(&self, fingerprint: &str) -> Option<Arc<T>> {
        // A thread that panicked while it held the lock has stored nothing incomplete.
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = kept.as_ref().filter(|(of, _)| of == fingerprint);
        same.map(|(_, found)| Arc::clone(found))
    }

    /// The stored result for a request, or one that is computed now and stored.
    fn of<E>(
        &self,
        fingerprint: &str,
        compute: impl FnOnce() -> Result<T, E>,
    ) -> Result<Arc<T>, E> {
        if let Some(found) = self.get(fingerprint) {
            return Ok(found);
        }
        let found = Arc::new(compute()?);
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *kept = Some((fingerprint.to_owned(), Arc::clone(&found)));
        Ok(found)
    }
}
