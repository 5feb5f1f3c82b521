//! Whole numbers that options take. Those that the command has, too, are
//! imported from where it has them.

use crate::errors::{error_of_case, internal_error};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use snapload::analysis::{MEMBERS, NONZERO_MEMBERS, SEED};
use snapload::{Key, Kind, key_named};
use snapload_orbits::{BASIN_TRANSIENT, KEEP, ORBIT_PERIODS, PERIODS, POINTS, STARTS};
use snapload_structure::{NEIGHBOURS, PAIRS, SEEDS, SEGMENTS};
use snapload_study::{RANDOM, THREADS};

/// The row of an option. Where several functions have one of the same name, it is
/// distinguished by what stands before a dot.
fn row(option: &str) -> Option<Key> {
    Some(match option {
        "members" => MEMBERS,
        "ensemble.members" => NONZERO_MEMBERS,
        "seed" => SEED,
        "max_impacts" => return key_named(option).ok().copied(),
        "periods" => PERIODS,
        "keep" => KEEP,
        "orbit.periods" => ORBIT_PERIODS,
        "starts" => STARTS,
        "points" => POINTS,
        "transient" => BASIN_TRANSIENT,
        "random" => RANDOM,
        "threads" => THREADS,
        "neighbours" => NEIGHBOURS,
        "seeds" => SEEDS,
        "segments" => SEGMENTS,
        "pairs" => PAIRS,
        // The command has none of these. One section more is kept than there are periods.
        "spectrum.periods" => Key::option("periods", at_most_one_less(KEEP.kind)),
        "spectrum.transient" => Key::option("transient", Kind::Count(0, 100_000_000)),
        "laps" => Key::option("laps", Kind::Count(1, 1_000_000)),
        "pieces" => Key::option("pieces", Kind::Count(1, 10_000_000)),
        "number" => Key::option("number", Kind::Count(1, 1_000_000)),
        "count" => Key::option("count", Kind::Count(1, 1_000_000_000)),
        "fps" => Key::option("fps", Kind::Count(1, 120)),
        "symbol" => Key::option("symbol", Kind::Count(1, snapload::MAX_CABLES as u64)),
        _ => return None,
    })
}

/// Whole numbers up to one less.
fn at_most_one_less(kind: Kind) -> Kind {
    match kind {
        Kind::Count(low, high) => Kind::Count(low, high - 1),
        other => other,
    }
}

/// The value of an option, if it is a whole number that the option takes, and at most `most`.
#[pyfunction]
#[pyo3(signature = (option, value, most=None, /))]
pub(crate) fn whole(option: &str, value: &Bound<'_, PyAny>, most: Option<u64>) -> PyResult<u64> {
    let no_option = || internal_error(format!("there is no option {option:?}"));
    let mut key = row(option).ok_or_else(no_option)?;
    if let (Kind::Count(low, _), Some(most)) = (key.kind, most) {
        key.kind = Kind::Count(low, most);
    }
    // Python takes True for 1.
    let is_flag = value.is_instance_of::<PyBool>();
    let number = value.extract().ok().filter(|_| !is_flag);
    let number = number.filter(|number| key.takes_count(*number));
    match number {
        Some(number) => Ok(number),
        None => Err(error_of_case(key.refuse(key.name, value.repr()?))),
    }
}
