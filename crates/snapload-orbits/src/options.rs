//! Checks of the options of the questions, shared by the command and Python.

use crate::curve::CurveOptions;
use crate::follower::{BranchOptions, check_step};
use crate::hybrid::{Family, Hybrid, Point};
use crate::moored::Moored;
use crate::orbit_search::NEARLY_TAUT;
use crate::section::SectionOptions;
use snapload::analysis::UNCERTAIN_KEYS;
use snapload::{
    Case, CaseError, Key, Kind, Parameters, Value, check_entry, key_named, natural_inertia,
};

/// Periods of the forcing for which a motion is followed.
pub const PERIODS: Key = Key::option("periods", Kind::Count(1, 100_000_000));
/// Those of them that are kept.
pub const KEEP: Key = Key::option("keep", Kind::Count(1, 1_000_000));
/// The length of an orbit in periods of the forcing.
pub const ORBIT_PERIODS: Key = Key::option("periods", Kind::Count(1, 1024));
/// Random starts from which orbits are searched for.
pub const STARTS: Key = Key::option("starts", Kind::Count(1, 10_000_000));
/// Points of a branch or of a curve in either direction, at most.
pub const POINTS: Key = Key::option("points", Kind::Count(1, 1_000_000));
/// Periods of the forcing before attractors are examined.
pub const BASIN_TRANSIENT: Key = Key::option("transient", Kind::Count(1, 10_000_000));

/// A time of the section, in periods of the forcing.
///
/// # Errors
/// A [`CaseError`] if it is not a part of a period.
pub fn checked_phase(phase: f64) -> Result<f64, CaseError> {
    if (0.0..1.0).contains(&phase) {
        return Ok(phase);
    }
    let allowed = "a part of the period, from 0 to below 1";
    Err(CaseError::value("phase", phase, allowed))
}

/// Refuses a start near which there can be no orbit: one that is not legal, unless it is so little
/// beyond a cable that it may have been meant to lie on it.
///
/// # Errors
/// The [`CaseError`] of a case that begins there.
pub fn check_start(parameters: &Parameters, start: &Point) -> Result<(), CaseError> {
    let [x, y, theta, vx, vy, vtheta] = *start;
    let there = Parameters {
        x,
        y,
        theta,
        vx,
        vy,
        vtheta,
        ..*parameters
    };
    let Err(error) = Case::new(there) else {
        return Ok(());
    };
    match is_within_reach(&Moored::case(*parameters, [None; 2]), start) {
        true => Ok(()),
        false => Err(error),
    }
}

/// The same for a system that is not a case.
///
/// # Errors
/// A [`CaseError`] that names the start.
pub fn check_start_of_system(family: &Moored, start: &Point) -> Result<(), CaseError> {
    if is_within_reach(family, start) {
        return Ok(());
    }
    let [x, y, theta, ..] = start;
    let allowed = "a start within reach of every cable and below the limits of the run";
    let start = format!("x, y, theta = {x}, {y}, {theta}");
    Err(CaseError::value("start", start, allowed))
}

/// Whether a start is beyond any cable by at most a little, and beyond no limit.
fn is_within_reach(family: &Moored, start: &Point) -> bool {
    let system = family.plain([0.0; 2]);
    let mut surfaces = system.surfaces().iter();
    let mut limits = family.limits(&system, start).into_iter();
    surfaces.all(|surface| system.gap(surface, start) < NEARLY_TAUT)
        && limits.all(|beyond| beyond <= 0.0)
}

/// A number of periods in all, of which the last `keep` are kept.
///
/// # Errors
/// A [`CaseError`] if more are to be kept than there are, or if the phase is not allowed.
pub fn section_options(periods: u64, keep: u64, phase: f64) -> Result<SectionOptions, CaseError> {
    let Some(skip) = periods.checked_sub(keep) else {
        let allowed = format!("at most periods = {periods}");
        return Err(CaseError::value("keep", keep, allowed));
    };
    Ok(SectionOptions {
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
/// A [`CaseError`] if the key is no number of the body, if the value of the case is outside the
/// range, or if the step is not allowed.
pub fn branch_options(
    parameters: &Parameters,
    key: &str,
    [low, high]: [f64; 2],
    step: f64,
    most: usize,
) -> Result<(&'static str, f64, BranchOptions), CaseError> {
    let (key, value) = followed_key("along", parameters, key)?;
    check_range(key, value, [low, high])?;
    check_inertia(parameters, key, [low, high])?;
    check_step(step)?;
    let range = [low, high];
    Ok((key, value, BranchOptions { range, step, most }))
}

/// Two keys along which a curve is followed, each with its range, and how it is followed. A key
/// without a range goes from half to twice its value, or from -1 to 1 around 0, within the values
/// allowed.
///
/// # Errors
/// As for [`branch_options`], and if both keys are the same.
pub fn curve_options(
    parameters: &Parameters,
    keys: [(&str, Option<[f64; 2]>); 2],
    step: f64,
    most: usize,
) -> Result<([&'static str; 2], CurveOptions), CaseError> {
    let of = |(key, range): (&str, Option<[f64; 2]>)| {
        let (key, value) = followed_key("along", parameters, key)?;
        let range = match range {
            Some(range) => range,
            None => usual_range(key, value)?,
        };
        check_range(key, value, range)?;
        check_inertia(parameters, key, range)?;
        Ok::<_, CaseError>((key, range))
    };
    let [(first, a), (second, b)] = [of(keys[0])?, of(keys[1])?];
    if first == second {
        return Err(CaseError::value("along", first, "two different keys"));
    }
    check_step(step)?;
    let options = CurveOptions {
        ranges: [a, b],
        step,
        most,
    };
    Ok(([first, second], options))
}

fn usual_range(key: &str, value: f64) -> Result<[f64; 2], CaseError> {
    let [a, b] = match value {
        0.0 => [-1.0, 1.0],
        value => [0.5 * value, 2.0 * value],
    };
    let (low, high) = (a.min(b), a.max(b));
    Ok(match key_named(key)?.kind {
        Kind::Number(bounds) => [low.max(bounds.low), high.min(bounds.high)],
        _ => [low, high],
    })
}

/// A key on which orbits depend, and its value; `option` is the option in which it was given.
///
/// # Errors
/// A [`CaseError`] if it is no such key.
pub fn followed_key(
    option: &'static str,
    parameters: &Parameters,
    key: &str,
) -> Result<(&'static str, f64), CaseError> {
    let key = key_named(key)?.name;
    if !UNCERTAIN_KEYS.contains(&key) {
        let allowed = format!(
            "a key on which orbits depend: one of {}",
            UNCERTAIN_KEYS.join(", ")
        );
        return Err(CaseError::value(option, key, allowed));
    }
    // A point mass has no size.
    let is_of_body = parameters.inertia.is_some() || !matches!(key, "a" | "b");
    let value = parameters.get(key).as_ref().and_then(Value::number);
    let value = value.filter(|_| is_of_body);
    let allowed = "a key that holds a number, of this body";
    let value = value.ok_or_else(|| CaseError::value(option, key, allowed))?;
    Ok((key, value))
}

fn check_range(key: &str, value: f64, [low, high]: [f64; 2]) -> Result<(), CaseError> {
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
    Ok(())
}

/// Refuses to follow an orbit to b = 0 where the inertia is the natural one of the size, which
/// jumps there: an orbit on one side is none on the other.
fn check_inertia(
    parameters: &Parameters,
    key: &str,
    [low, high]: [f64; 2],
) -> Result<(), CaseError> {
    let follows = parameters.inertia == natural_inertia(parameters.a, parameters.b);
    match parameters
        .inertia
        .filter(|_| key == "b" && low == 0.0 && follows)
    {
        None => Ok(()),
        Some(inertia) => Err(CaseError::value(
            key,
            format!("{low}:{high}"),
            format!(
                "a range that begins above 0, as the default inertia jumps from a^2 at b = 0 to (a^2 + b^2)/3 \
                 above it; or another inertia than the default one, such as inertia = {:.9}",
                inertia * (1.0 + 1e-6)
            ),
        )),
    }
}
