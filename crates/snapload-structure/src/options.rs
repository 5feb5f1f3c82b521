//! The options of questions about a structure, defined once for the command and for Python.

use snapload::{CaseError, Key, Kind, Sampling, Value};
use snapload_hydro::MOST_PAIRS;

/// Neighbours of a run that is assessed.
pub const NEIGHBOURS: Key = Key::option("neighbours", Kind::Count(0, 100_000));
/// Records of a sea.
pub const SEEDS: Key = Key::option("seeds", Kind::Count(1, 10_000));
/// How many times as stiff as they are the lines are taken.
pub const STIFFER: Key = Key::option("stiffer", Kind::number(1e-6, 1e9));
/// Time between two states of a motion that are kept \[s\].
pub const EVERY: Key = Key::option("every", Kind::number(1e-6, 1e6));
/// Segments of a line in a file for MoorDyn.
pub const SEGMENTS: Key = Key::option("segments", Kind::Count(1, 10_000));
/// Pairs of poles of a memory.
pub const PAIRS: Key = Key::option("pairs", Kind::Count(1, MOST_PAIRS as u64));

/// Checks one of them under its own name.
pub(crate) fn check(option: &Key, value: impl Into<Value>) -> Result<(), CaseError> {
    option.check(option.name, &value.into())
}

/// The time between two states that are kept of a motion that lasts so long, if it is one.
///
/// # Errors
/// A [`CaseError`] that names `every`, if it is none or would give too many states.
pub fn checked_every(duration_s: f64, every_s: f64) -> Result<f64, CaseError> {
    check(&EVERY, every_s)?;
    sampling(duration_s, every_s)?;
    Ok(every_s)
}

/// The times at which the states of a motion are kept, every [`EVERY`] of the time that a run
/// takes; none for an infinite one.
///
/// # Errors
/// As for [`checked_every`].
pub(crate) fn sampling(duration_s: f64, every_s: f64) -> Result<Option<Sampling>, CaseError> {
    if every_s == f64::INFINITY {
        return Ok(None);
    }
    check(&EVERY, every_s)?;
    let every = Sampling::every(every_s, duration_s);
    let refuse = |allowed| CaseError::value(EVERY.name, Value::Number(every_s), allowed);
    every.map(Some).map_err(refuse)
}
