//! Periodic orbits: found, closed to rounding, checked.

use crate::hybrid::{Family, Hybrid, Point, distance};
use crate::lap::{Lap, Leg};
use crate::multipliers::{Multipliers, Stability, multipliers};
use crate::newton::Closed;
use crate::sequence::{Timed, symbol_text};
use crate::survey::{Survey, survey};
use snapload_certificate::ProvedOrbit;
use std::fmt;

/// A periodic orbit of a system.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// The values of the two parameters.
    pub at: [f64; 2],
    /// Time of the section, in periods of the forcing.
    pub phase: f64,
    /// Its length, in periods of the forcing.
    pub periods: u32,
    /// The number of periods after which it first repeats itself; smaller than `periods` if it is a
    /// repeated shorter orbit.
    pub smallest_periods: u32,
    /// Its length in time.
    pub length: f64,
    /// The state at the section.
    pub z: Point,
    /// Its events.
    pub lap: Timed,
    /// The times of the events, and the impulses of struck surfaces.
    pub rows: Vec<EventRow>,
    /// Its multipliers.
    pub multipliers: Multipliers,
    /// Its extremes between events.
    pub survey: Survey,
    /// The largest gap between events, at a closest approach, in the measure in which it is
    /// reported.
    pub largest_gap: Option<f64>,
    /// The error of the simulated motion after one lap; none if it stops before.
    pub return_error: Option<f64>,
    /// Why no body can have it; empty if it is admissible.
    pub why_not: Vec<String>,
    /// det M by the law of impact and the drag, if that is known in closed form.
    pub rule: Option<f64>,
    /// The result of the attempt to prove it, if one was made.
    pub proof: Option<Proof>,
}

/// The result of the attempt to prove an orbit: the proved orbit, or why it is not proved.
pub type Proof = Result<ProvedOrbit, String>;

/// One row of the events of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct EventRow {
    /// When.
    pub t: f64,
    /// `snap`, `stick` or `release`.
    pub kind: &'static str,
    /// The surface, from 0.
    pub surface: usize,
    /// The closing velocity; 0 if nothing is struck.
    pub speed: f64,
    /// The impulse.
    pub impulse: f64,
}

/// The orbit that is searched for.
#[derive(Clone, Debug, Default)]
pub struct OrbitRequest {
    /// Its number of periods of the forcing; 1 if not given.
    pub periods: Option<u32>,
    /// The surfaces struck, one after the other, from 0; any if not given.
    pub struck: Option<Vec<usize>>,
    /// Time of the section, in periods of the forcing.
    pub phase: f64,
}

/// Why no orbit was found.
#[derive(Clone, Debug, PartialEq)]
pub struct NoOrbit(pub String);

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NoOrbit {}

/// The largest return error of a simulated motion that counts as the orbit, if |μ| is 1.
const LARGEST_RETURN_ERROR: f64 = 1e-9;

impl Orbit {
    /// The orbit of a closed lap.
    pub fn of<F: Family>(lap: &Lap<F>, closed: &Closed) -> Self {
        let family = lap.family;
        let system = family.plain(lap.at);
        let legs = lap.legs(&system, &closed.z, &closed.durations);
        let multipliers = multipliers(lap, closed, &system, &legs);
        let survey = survey(lap, &system, &legs);
        let (_, length) = lap.times();
        let timed = lap.timed(&system, &legs);
        let mut why_not = survey.why_not(&closed.durations);
        if !timed.accumulates_in_order() {
            why_not.push("snaps that accumulate would come in another order".to_owned());
        }
        let return_error = run_once(lap, closed, &timed, multipliers.largest(), &mut why_not);
        let slack = timed
            .sequence
            .taut_sets()
            .iter()
            .all(|taut| taut.is_empty());
        let snaps = timed.sequence.snaps() as i32;
        let rule = family
            .contraction(lap.at)
            .filter(|_| slack && multipliers.zeros_from_contact == 0)
            .map(|shrinking| {
                family.snap_contraction(lap.at).powi(snaps) * (-shrinking * length).exp()
            });
        let reported = survey
            .gaps()
            .map(|gap| family.reported_gap(&system, gap.surface, gap.value));
        let largest_gap = reported.max_by(f64::total_cmp);
        Self {
            at: lap.at,
            phase: lap.phase,
            periods: lap.periods,
            smallest_periods: lap.smallest_periods(&system, &legs),
            length,
            z: closed.z,
            rows: rows(lap, &system, &legs),
            lap: timed,
            multipliers,
            survey,
            largest_gap,
            return_error,
            why_not,
            rule,
            proof: None,
        }
    }

    /// The same orbit as a member of a family at these values of the parameters.
    pub fn with_at(self, at: [f64; 2]) -> Self {
        Self { at, ..self }
    }

    /// Its lap in a family that contains its system, and the legs of that.
    pub fn lap_of<'a, F: Family>(
        &'a self,
        family: &'a F,
        system: &F::Plain,
    ) -> (Lap<'a, F>, Vec<Leg>) {
        let lap = Lap {
            family,
            at: self.at,
            sequence: &self.lap.sequence,
            phase: self.phase,
            periods: self.periods,
        };
        let legs = lap.legs(system, &self.z, &self.lap.durations);
        (lap, legs)
    }

    /// Whether a body can have it.
    pub fn is_admissible(&self) -> bool {
        self.why_not.is_empty()
    }

    /// The same orbit where rounding decides what a simulation does, as at a graze whether it has
    /// the snap of zero velocity: its admissibility is decided without the simulation.
    pub(crate) fn by_survey(mut self) -> Self {
        self.why_not = self.survey.why_not(&self.lap.durations);
        self
    }

    /// Whether its snaps that accumulate do so one after the other, and none opens a surface.
    pub(crate) fn accumulates_in_order(&self) -> bool {
        self.lap.accumulates_in_order() && self.survey.accumulates_in_order()
    }

    /// The stability by its multipliers.
    pub fn stability(&self) -> Stability {
        self.multipliers.stability()
    }
}

/// Simulates one lap: returns its error at the end, and why it differs from the lap, if it does.
fn run_once<F: Family>(
    lap: &Lap<F>,
    closed: &Closed,
    timed: &Timed,
    largest: f64,
    why_not: &mut Vec<String>,
) -> Option<f64> {
    let (t, length) = lap.times();
    let simulated = lap.family.simulate(lap.at, t, &closed.z, t + length)?;
    if let Some(words) = &simulated.illegal {
        why_not.push(format!("the start is not legal: {words}"));
        return None;
    }
    if let Some((stop, t)) = simulated.stop {
        why_not.push(format!(
            "the motion stops at t = {t:.6}: {}",
            stop.reason_text()
        ));
        return None;
    }
    let error = distance(&simulated.end, &closed.z);
    if !simulated.lap.same_events(timed) {
        let others = symbol_text(&simulated.lap.sequence);
        why_not.push(format!("the motion has other events: {others}"));
    } else if error > LARGEST_RETURN_ERROR * (1.0 + largest) {
        why_not.push(format!(
            "after one lap the motion differs from its start by {error:.1e}"
        ));
    }
    Some(error)
}

/// The events as rows.
fn rows<F: Family>(lap: &Lap<F>, system: &F::Plain, legs: &[Leg]) -> Vec<EventRow> {
    let mut rows = Vec::new();
    for (event, leg) in lap.sequence.events.iter().zip(legs) {
        let t = leg.t + leg.s;
        let (_, impulse) = system.law(event.struck(), event.pulling(), &leg.end);
        let mut row = |kind, surface, speed, impulse| {
            rows.push(EventRow {
                t,
                kind,
                surface,
                speed,
                impulse,
            });
        };
        for surface in event.struck().iter() {
            row(
                "snap",
                surface,
                system.speed(surface, &leg.end),
                impulse[surface],
            );
        }
        for surface in leg.taut.iter().filter(|&k| !event.after.contains(k)) {
            row("release", surface, 0.0, 0.0);
        }
        for surface in event.after.iter().filter(|&k| !leg.taut.contains(k)) {
            row("stick", surface, 0.0, 0.0);
        }
    }
    rows
}
