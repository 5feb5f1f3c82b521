//! The same structure in other waves.

use super::outcome::Outcome;
use crate::physics::model_at_rest::ModelAtRest;
use crate::structure::{Structure, Water, Wave};
use snapload::analysis::{Cancelled, Counter, OnProgress, Unfinished, in_parallel};

/// The range of heights and periods, as parts of the case's.
const HEIGHTS: [f64; 2] = [0.5, 1.25];
const PERIODS: [f64; 2] = [2.0 / 3.0, 7.0 / 6.0];
/// The number of heights, and of periods.
const STEPS: u32 = 10;
/// The number of periods of each wave that are computed.
pub const LENGTH: f64 = 60.0;

/// The results of the structure in waves about those of its case.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Periods \[s\].
    pub periods_s: Vec<f64>,
    /// Heights \[m\].
    pub heights_m: Vec<f64>,
    /// All heights for the first period, then for the next.
    pub cells: Vec<ScanCell>,
}

/// The result in one wave: the largest utilisation, or the fastest snap \[m/s\] where a line of the
/// case has no stiffness or no breaking load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanCell {
    /// It is known.
    Known(f64),
    /// It is at least that: the run is cut short.
    AtLeast(f64),
    /// Nothing is judged: the run ended before the judged time, or the wave can not be run.
    NotJudged,
    /// The body turned over or touched the floor.
    Fails,
}

/// Scans heights and periods; none unless the case has a regular wave, of some height.
///
/// # Errors
/// [`Cancelled`] if the work is cancelled.
pub fn scan(structure: &Structure, on_progress: OnProgress) -> Result<Option<Scan>, Cancelled> {
    let wave = match structure.water {
        Water::Wave(wave) if structure.has_waves() => wave,
        _ => return Ok(None),
    };
    let spaced = |[low, high]: [f64; 2], value: f64| -> Vec<f64> {
        let part = |k: u32| low + (high - low) * f64::from(k) / f64::from(STEPS - 1);
        (0..STEPS).map(|k| shown(value * part(k))).collect()
    };
    let (periods_s, heights_m) = (
        spaced(PERIODS, wave.period_s),
        spaced(HEIGHTS, wave.height_m),
    );
    let of_period = |&period_s: &f64| {
        let heights = heights_m.iter();
        heights.map(move |&height_m| Wave { height_m, period_s })
    };
    let waves: Vec<Wave> = periods_s.iter().flat_map(of_period).collect();
    let counter = Counter::new("scanning", 0, waves.len() as u64, on_progress);
    let cells = in_parallel(waves.len(), |index| {
        counter.part(|within| one(structure, waves[index], within))
    })?;
    Ok(Some(Scan {
        cells,
        periods_s,
        heights_m,
    }))
}

/// A height or a period in three digits, as a table shows it: the cell is of that very wave.
fn shown(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn one(structure: &Structure, wave: Wave, on_progress: OnProgress) -> Result<ScanCell, Cancelled> {
    let (water, duration_s) = (Water::Wave(wave), LENGTH * wave.period_s);
    // The usual transient goes with the period, as in a case of that wave.
    let transient_s = match structure.transient_is_given {
        true => structure.transient_s.min(duration_s / 2.0),
        false => water.usual_transient_s(duration_s),
    };
    let changed = Structure {
        water,
        duration_s,
        transient_s,
        ..structure.clone()
    };
    let Ok(prepared) = ModelAtRest::new(changed) else {
        return Ok(ScanCell::NotJudged);
    };
    let outcome = match Outcome::of(&prepared, 1.0, on_progress) {
        Ok(outcome) => outcome,
        Err(Unfinished::Case(_)) => return Ok(ScanCell::NotJudged),
        Err(Unfinished::Cancelled(cancelled)) => return Err(cancelled),
    };
    if outcome.stop.exceeds() {
        return Ok(ScanCell::Fails);
    }
    if outcome.is_unjudged() {
        return Ok(ScanCell::NotJudged);
    }
    // All cells show the same quantity: without a stiffness the tensions of a run without snaps are
    // known, too, but not those of the next one.
    let parts = outcome.utilisations(structure).into_iter().flatten();
    let found = match structure.utilisations_known() {
        true => parts.fold(0.0, f64::max),
        false => outcome.speed_m_s(),
    };
    Ok(match outcome.stop.cuts_short() {
        true => ScanCell::AtLeast(found),
        false => ScanCell::Known(found),
    })
}
