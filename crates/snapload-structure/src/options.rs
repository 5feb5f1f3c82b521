//! What may be asked of a structure beside its case: said here once for the command and for Python.

use snapload::{CaseError, Key, Kind, Value};

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
pub const PAIRS: Key = Key::option("pairs", Kind::Count(1, 20));

/// The most states of a motion that are kept, as they are kept in memory.
const MOST_STATES: f64 = 1e7;

/// Checks one of them under its own name.
pub(crate) fn check(option: &Key, value: impl Into<Value>) -> Result<(), CaseError> {
    option.check(option.name, &value.into())
}

/// The time between two states of a motion that are kept, if it is [`EVERY`] and not so short that
/// there would be too many in the time that the run takes.
///
/// # Errors
/// A [`CaseError`] that names `every`.
pub fn checked_every(duration_s: f64, every_s: f64) -> Result<f64, CaseError> {
    check(&EVERY, every_s)?;
    let shortest_s = duration_s / MOST_STATES;
    if every_s >= shortest_s {
        return Ok(every_s);
    }
    let allowed = format!(
        "{shortest_s:e} s or more, as at most {MOST_STATES:e} states of the {duration_s} s of a run are kept"
    );
    Err(CaseError::value(
        EVERY.name,
        Value::Number(every_s),
        allowed,
    ))
}
