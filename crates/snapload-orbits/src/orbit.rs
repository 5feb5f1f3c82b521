//! Periodic orbits: found, closed to rounding, checked.

use crate::hybrid::{Family, Hybrid, Point, distance};
use crate::lap::{Lap, Leg};
use crate::multipliers::{Multipliers, Stability, multipliers};
use crate::newton::Closed;
use crate::sequence::{Timed, words};
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
    /// After how many of them it first repeats itself; fewer where it is a shorter orbit several
    /// times.
    pub smallest_periods: u32,
    /// Its length in time.
    pub length: f64,
    /// The state at the section.
    pub z: Point,
    /// Its events.
    pub lap: Timed,
    /// When they are, and the impulses of what is struck.
    pub rows: Vec<EventRow>,
    /// Its multipliers.
    pub multipliers: Multipliers,
    /// What it is like between events.
    pub survey: Survey,
    /// The largest gap between events, where one comes nearest, as it is told.
    pub largest_gap: Option<f64>,
    /// How far the motion, simulated, is off after one lap; none where it stops before.
    pub return_error: Option<f64>,
    /// Why no body has it; empty if one does.
    pub why_not: Vec<String>,
    /// det M as the law of impact and the drag say, where one says so.
    pub rule: Option<f64>,
    /// What became of the attempt to prove it, where one was made.
    pub proof: Option<Proof>,
}

/// What became of the attempt to prove an orbit: it, or why it is not proved.
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
    /// The closing velocity; 0 where nothing is struck.
    pub speed: f64,
    /// The impulse.
    pub impulse: f64,
}

/// What is looked for.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// How many periods of the forcing; 1 where it is not said.
    pub periods: Option<u32>,
    /// The surfaces struck, one after the other, from 0; any where it is not said.
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

/// Largest return error of a motion that has the orbit, for |μ| of 1.
const RETURNS: f64 = 1e-9;

impl Orbit {
    /// Of a lap that is closed.
    pub fn of<F: Family>(lap: &Lap<F>, closed: &Closed) -> Self {
        let family = lap.family;
        let system = family.plain(lap.at);
        let legs = lap.legs(&system, &closed.z, &closed.durations);
        let multipliers = multipliers(lap, closed, &system, &legs);
        let survey = survey(lap, &system, &legs);
        let (_, length) = lap.times();
        let timed = Timed {
            sequence: lap.sequence.clone(),
            durations: closed.durations.clone(),
            speeds: speeds(lap, &system, &legs),
        };
        let mut why_not = survey.why_not(&closed.durations);
        let return_error = run_once(lap, closed, &timed, multipliers.largest(), &mut why_not);
        let slack = timed.sequence.held().iter().all(|held| held.is_empty());
        let snaps = timed.sequence.snaps() as i32;
        let rule = family
            .contraction(lap.at)
            .filter(|_| slack)
            .map(|shrinking| {
                family.snap_contraction(lap.at).powi(snaps) * (-shrinking * length).exp()
            });
        let gaps = [survey.largest_gap, survey.corner_gap]
            .into_iter()
            .flatten();
        let told = gaps.map(|gap| family.told_gap(&system, gap.surface, gap.value));
        let largest_gap = told.max_by(f64::total_cmp);
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

    /// The same orbit where its system is one of a family at these values of the parameters.
    pub fn with_at(self, at: [f64; 2]) -> Self {
        Self { at, ..self }
    }

    /// Its lap in a family of systems, one of which is its own, and the legs of that.
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

    /// Whether a body has it.
    pub fn is_admissible(&self) -> bool {
        self.why_not.is_empty()
    }

    /// The same orbit at a graze, where rounding decides whether a run has the snap without speed: what
    /// a body could have is told without the run.
    pub(crate) fn at_graze(mut self) -> Self {
        self.why_not = self.survey.why_not(&self.lap.durations);
        self
    }

    /// What its multipliers say.
    pub fn stability(&self) -> Stability {
        self.multipliers.stability()
    }
}

/// Runs the motion for one lap: how far it is off then, and why it is not the lap, where it is not.
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
            stop.meaning()
        ));
        return None;
    }
    let error = distance(&simulated.end, &closed.z);
    if !simulated.lap.same_events(timed) {
        let others = words(&simulated.lap.sequence);
        why_not.push(format!("the motion has other events: {others}"));
    } else if error > RETURNS * (1.0 + largest) {
        why_not.push(format!("the motion is off by {error:.1e} after one lap"));
    }
    Some(error)
}

/// The closing velocity of each event.
fn speeds<F: Family>(lap: &Lap<F>, system: &F::Plain, legs: &[Leg]) -> Vec<f64> {
    let events = lap.sequence.events.iter().zip(legs);
    let speed = |(event, leg): (&crate::sequence::Event, &Leg)| {
        let struck = event.struck().iter().next();
        struck.map_or(0.0, |surface| system.speed(surface, &leg.end))
    };
    events.map(speed).collect()
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
        for surface in leg.held.iter().filter(|&k| !event.after.contains(k)) {
            row("release", surface, 0.0, 0.0);
        }
        for surface in event.after.iter().filter(|&k| !leg.held.contains(k)) {
            row("stick", surface, 0.0, 0.0);
        }
    }
    rows
}
