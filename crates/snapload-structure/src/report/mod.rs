//! Reports on a run: the verdict, a few lines of text, JSON.

mod json;
mod other_runs;
mod seas_verdict;
mod summary;
mod verdict;

pub use verdict::{Verdict, VerdictKind, end_text};
