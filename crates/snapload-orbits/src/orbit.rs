//! Periodic orbits: found, closed to rounding, checked.

use crate::hybrid::{Family, Hybrid, Point, distance};
use crate::lap::{Lap, Leg};
use crate::multipliers::{Multipliers, Stability, multipliers};
use crate::newton::{Closed, close, step_of_map};
use crate::scan::scan;
use crate::sequence::{Sequence, Timed, words};
use crate::survey::{Survey, survey};
use snapload::TautSet;
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

/// Laps that are simulated, at most, on the way from a start to an orbit.
const MOST_LAPS: usize = 40;
/// A surface nearer than this, closing or opening more slowly than that, may be one that the orbit
/// is held by.
pub(crate) const NEAR: f64 = 5e-3;
const SLOW: f64 = 5e-2;
/// An orbit within this of where it was looked for is the one that was meant.
const BESIDE: f64 = 0.02;
/// Largest return error of a motion that has the orbit, for |μ| of 1.
const RETURNS: f64 = 1e-9;

impl Orbit {
    /// The orbit near `start`: by Newton's method on the map as it is simulated, from the start
    /// itself and from where it is moved onto surfaces that it nearly touches, and, if that gives
    /// none, on the map with these surfaces held.
    ///
    /// # Errors
    /// [`NoOrbit`] says how far it came.
    pub fn find<F: Family>(
        family: &F,
        at: [f64; 2],
        start: &Point,
        wanted: &Wanted,
    ) -> Result<Self, NoOrbit> {
        let system = family.plain(at);
        let near: TautSet = system
            .surfaces()
            .iter()
            .filter(|&k| system.gap(k, start).abs() < NEAR && system.speed(k, start).abs() < SLOW)
            .collect();
        let mut sets: Vec<TautSet> = near.subsets().collect();
        sets.reverse();
        let search = Search { family, at, wanted };
        let (mut found, mut failures) = (Vec::new(), Vec::new());
        for closed in &sets {
            let z = system.placed(*closed, *closed, start);
            match search.by_simulation(&z) {
                Ok(orbit) if orbit.is_admissible() && orbit.far_from(start).is_none() => {
                    return Ok(orbit);
                }
                Ok(orbit) => found.push(orbit),
                Err(failure) => failures.push(failure),
            }
        }
        for closed in &sets {
            let z = system.placed(*closed, *closed, start);
            found.extend(search.by_holding(*closed, &z));
        }
        // What a body has, or what is beside the start, comes before the rest.
        let rank = |orbit: &Orbit| {
            let far = distance(&orbit.z, start);
            (orbit.far_from(start).is_some(), !orbit.is_admissible(), far)
        };
        let best = found.into_iter().min_by(|a, b| {
            let ((far_a, bad_a, a), (far_b, bad_b, b)) = (rank(a), rank(b));
            far_a
                .cmp(&far_b)
                .then(bad_a.cmp(&bad_b))
                .then(a.total_cmp(&b))
        });
        let why = failures.into_iter().next();
        best.ok_or_else(|| why.unwrap_or_else(|| NoOrbit("nothing was found".to_owned())))
    }

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

    /// How far its section is from a start near which it was looked for, where it is so far that
    /// another orbit may have been meant.
    pub fn far_from(&self, start: &Point) -> Option<f64> {
        Some(distance(&self.z, start)).filter(|far| *far >= BESIDE)
    }

    /// What its multipliers say.
    pub fn stability(&self) -> Stability {
        self.multipliers.stability()
    }
}

/// The orbit that Newton's method comes to from a start that may be far off; only one that a body has.
pub(crate) fn from_afar<F: Family>(family: &F, start: &Point, wanted: &Wanted) -> Option<Orbit> {
    let search = Search {
        family,
        at: [0.0; 2],
        wanted,
    };
    search
        .by_simulation(start)
        .ok()
        .filter(Orbit::is_admissible)
}

/// A search for one orbit.
struct Search<'a, F: Family> {
    family: &'a F,
    at: [f64; 2],
    wanted: &'a Wanted,
}

impl<F: Family> Search<'_, F> {
    fn periods(&self) -> u32 {
        self.wanted.periods.unwrap_or(1)
    }

    fn lap<'b>(&'b self, sequence: &'b Sequence) -> Lap<'b, F> {
        Lap {
            family: self.family,
            at: self.at,
            sequence,
            phase: self.wanted.phase,
            periods: self.periods(),
        }
    }

    fn is_wanted(&self, sequence: &Sequence) -> bool {
        let wanted = self.wanted.struck.as_ref();
        wanted.is_none_or(|struck| *struck == sequence.struck())
    }

    /// Why a lap that closes is no answer: no body has it, or its snaps are not those asked for.
    fn why_refused(&self, orbit: &Orbit) -> String {
        let mut reasons = orbit.why_not.clone();
        let wanted = self.wanted.struck.as_ref();
        if let Some(struck) = wanted.filter(|_| !self.is_wanted(&orbit.lap.sequence)) {
            let cables: Vec<String> = struck.iter().map(|k| (k + 1).to_string()).collect();
            let asked = match cables.is_empty() {
                true => "none".to_owned(),
                false => cables.join(", "),
            };
            reasons.push(format!(
                "the snaps asked for are {asked}; leave the symbol out, or begin near another state"
            ));
        }
        let (found, but) = (words(&orbit.lap.sequence), reasons.join("; "));
        format!("a lap closes with the events {found}, but {but}")
    }

    /// Simulates a lap, closes it with its events, and simulates again, until the events stay.
    fn by_simulation(&self, start: &Point) -> Result<Orbit, NoOrbit> {
        let period = self.family.forcing_period(self.at).value;
        let t = self.wanted.phase * period;
        let t_end = t + f64::from(self.periods()) * period;
        let mut z = *start;
        let mut closing: Option<Orbit> = None;
        let mut why = String::new();
        for _ in 0..MOST_LAPS {
            let simulated = self.family.simulate(self.at, t, &z, t_end);
            let Some(simulated) = simulated else {
                return Err(NoOrbit("this system has no simulation".to_owned()));
            };
            if let Some(words) = simulated.illegal {
                why =
                    format!("the search came to a state beyond what is allowed; allowed: {words}");
                break;
            }
            if let Some((stop, t)) = simulated.stop {
                why = format!(
                    "a lap of the search stopped at t = {t:.4}: {}",
                    stop.meaning()
                );
                break;
            }
            let Timed {
                sequence,
                durations,
                ..
            } = &simulated.lap;
            let lap = self.lap(sequence);
            if let Some(closed) = close(&lap, &z, durations) {
                let orbit = Orbit::of(&lap, &closed);
                if orbit.is_admissible() && self.is_wanted(sequence) {
                    return Ok(orbit);
                }
                why = self.why_refused(&orbit);
                if closing.is_none() && self.is_wanted(sequence) {
                    closing = Some(orbit);
                }
            }
            let guess = (&z, &durations[..]);
            let phase = self.wanted.phase;
            let step = step_of_map(self.family, self.at, sequence, phase, self.periods(), guess);
            match step {
                Some((next, size)) if size > 1e-13 => z = next,
                _ => break,
            }
        }
        if why.is_empty() {
            why = format!("Newton's method has not ended after {MOST_LAPS} laps");
        }
        closing.ok_or(NoOrbit(why))
    }

    /// Closes a lap on which the closed surfaces are held throughout.
    fn by_holding(&self, held: TautSet, start: &Point) -> Option<Orbit> {
        let period = self.family.forcing_period(self.at).value;
        let t = self.wanted.phase * period;
        let length = f64::from(self.periods()) * period;
        let found = scan(self.family, self.at, held, (t, start), length)?;
        if !self.is_wanted(&found.sequence) {
            return None;
        }
        let lap = self.lap(&found.sequence);
        let closed = close(&lap, start, &found.durations)?;
        Some(Orbit::of(&lap, &closed))
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
