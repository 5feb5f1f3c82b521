//! What the questions may be asked with, checked once for the command and for Python.

use crate::branch::Along;
use crate::section::Stretch;
use snapload::{CaseError, Parameters, Value, check_entry, key_named};

/// A time of the section, in periods of the forcing.
///
/// # Errors
/// A [`CaseError`] if it is no part of a period.
pub fn checked_phase(phase: f64) -> Result<f64, CaseError> {
    if (0.0..1.0).contains(&phase) {
        return Ok(phase);
    }
    let allowed = "a part of the period, from 0 to below 1";
    Err(CaseError::value("phase", phase, allowed))
}

/// So many periods in all, of which the last ones are kept.
///
/// # Errors
/// A [`CaseError`] if more are to be kept than there are, or for the phase.
pub fn stretch(periods: u64, keep: u64, phase: f64) -> Result<Stretch, CaseError> {
    let Some(skip) = periods.checked_sub(keep) else {
        let allowed = format!("at most as many as there are in all, which is periods = {periods}");
        return Err(CaseError::value("keep", keep, allowed));
    };
    Ok(Stretch {
        phase: checked_phase(phase)?,
        skip,
        keep,
        exponents: true,
        impacts: false,
    })
}

/// The key along which a branch is followed, its value in the case, and how it is followed.
///
/// # Errors
/// A [`CaseError`] if it is no number of the body, the value of the case lies outside the range, or
/// the step can not be.
pub fn along(
    parameters: &Parameters,
    key: &str,
    [low, high]: [f64; 2],
    step: f64,
    most: usize,
) -> Result<(&'static str, f64, Along), CaseError> {
    let key = key_named(key)?.name;
    let value = parameters.get(key).as_ref().and_then(Value::number);
    let Some(value) = value else {
        let allowed = "a key that holds a number, of this body";
        return Err(CaseError::value("along", key, allowed));
    };
    let range = format!("{low}:{high}");
    for end in [low, high] {
        check_entry(key, &Value::Number(end))?;
    }
    if low >= high {
        let allowed = "a range whose first value is below the last";
        return Err(CaseError::value(key, range, allowed));
    }
    if !(low..=high).contains(&value) {
        let allowed = format!("a range that holds the value of the case, {key} = {value}");
        return Err(CaseError::value(key, range, allowed));
    }
    if !(step > 0.0 && step <= 1.0) {
        return Err(CaseError::value(
            "step",
            step,
            "a number above 0, at most 1",
        ));
    }
    let range = [low, high];
    Ok((key, value, Along { range, step, most }))
}
