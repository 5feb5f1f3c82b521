//! The search for a periodic orbit near a state.

use crate::hybrid::{Family, Hybrid, Point, distance};
use crate::lap::Lap;
use crate::newton::{close, step_of_map};
use crate::orbit::{NoOrbit, Orbit, OrbitRequest};
use crate::scan::scan;
use crate::sequence::{Sequence, Timed, symbol_text};
use snapload::{CaseError, TautSet, Value};

/// The most laps that are simulated on the way from a start to an orbit.
const MOST_LAPS: usize = 40;
/// A surface that is closer than the first number, with a velocity below the second, may be held on
/// the orbit.
pub(crate) const NEARLY_TAUT: f64 = 5e-3;
const NEARLY_STILL: f64 = 5e-2;
/// An orbit within this distance of the start of the search counts as the one that was meant.
const NEAR_START: f64 = 0.02;
/// The largest distance between the last state of a motion and the orbit that it has approached.
/// The motion repeats itself within 1e-8 there; if each lap reduces the distance by a part p, the
/// orbit is 1e-8/p away, which is less than this for every p above 1e-5.
const NEAR_END: f64 = 1e-3;

impl Orbit {
    /// The orbit near `start`: by Newton's method on the simulated map, from the start itself and
    /// from its projection onto surfaces that it nearly touches, and, if that gives none, on the
    /// map with these surfaces held.
    ///
    /// # Errors
    /// [`NoOrbit`] says how far the search came.
    pub fn find<F: Family>(
        family: &F,
        at: [f64; 2],
        start: &Point,
        request: &OrbitRequest,
    ) -> Result<Self, NoOrbit> {
        Self::find_near(family, at, start, request, NEAR_START)
    }

    /// The orbit that a motion has approached, whose last state is `last`.
    ///
    /// # Errors
    /// [`NoOrbit`] also if the orbit found is another one.
    pub(crate) fn find_near_end_of_motion<F: Family>(
        family: &F,
        at: [f64; 2],
        last: &Point,
        request: &OrbitRequest,
    ) -> Result<Self, NoOrbit> {
        let orbit = Self::find_near(family, at, last, request, NEAR_END)?;
        let far = distance(&orbit.z, last);
        if far < NEAR_END {
            return Ok(orbit);
        }
        Err(NoOrbit(format!(
            "the motion from this start repeats itself, but Newton's method converged to another orbit, which \
             differs by {far:.1e} in one coordinate; look at the motion with snapload section, or search for \
             orbits with --find N"
        )))
    }

    /// The distance of its section from the start of the search, if it is so large that another
    /// orbit may have been meant.
    pub fn far_from(&self, start: &Point) -> Option<f64> {
        Some(distance(&self.z, start)).filter(|far| *far >= NEAR_START)
    }

    fn find_near<F: Family>(
        family: &F,
        at: [f64; 2],
        start: &Point,
        request: &OrbitRequest,
        largest_distance: f64,
    ) -> Result<Self, NoOrbit> {
        let search = Search {
            family,
            at,
            request,
        };
        search.check(start)?;
        let is_far = |orbit: &Self| distance(&orbit.z, start) >= largest_distance;
        let system = family.plain(at);
        let near: TautSet = system
            .surfaces()
            .iter()
            .filter(|&k| {
                system.gap(k, start).abs() < NEARLY_TAUT
                    && system.speed(k, start).abs() < NEARLY_STILL
            })
            .collect();
        let mut sets: Vec<TautSet> = near.subsets().collect();
        sets.reverse();
        let (mut found, mut failures) = (Vec::new(), Vec::new());
        for closed in &sets {
            let z = system.placed(*closed, *closed, start);
            match search.by_simulation(&z) {
                Ok(orbit) if orbit.is_admissible() && !is_far(&orbit) => {
                    return Ok(orbit);
                }
                Ok(orbit) => found.push(orbit),
                Err(failure) => failures.push(failure),
            }
        }
        for closed in &sets {
            let z = system.placed(*closed, *closed, start);
            found.extend(search.with_taut(*closed, &z));
        }
        // Admissible orbits, and those close to the start, come first.
        let rank = |orbit: &Orbit| {
            let far = distance(&orbit.z, start);
            (is_far(orbit), !orbit.is_admissible(), far)
        };
        let best = found.into_iter().min_by(|a, b| {
            let ((far_a, bad_a, a), (far_b, bad_b, b)) = (rank(a), rank(b));
            far_a
                .cmp(&far_b)
                .then(bad_a.cmp(&bad_b))
                .then(a.total_cmp(&b))
        });
        let why = failures.into_iter().next();
        best.ok_or_else(|| why.unwrap_or_else(|| NoOrbit("no lap closes".to_owned())))
    }
}

/// The orbit to which Newton's method converges from a start that may be far away; only an
/// admissible one.
pub(crate) fn find_from_far_start<F: Family>(
    family: &F,
    start: &Point,
    request: &OrbitRequest,
) -> Option<Orbit> {
    let search = Search {
        family,
        at: [0.0; 2],
        request,
    };
    search.check(start).ok()?;
    search
        .by_simulation(start)
        .ok()
        .filter(Orbit::is_admissible)
}

/// A search for one orbit.
struct Search<'a, F: Family> {
    family: &'a F,
    at: [f64; 2],
    request: &'a OrbitRequest,
}

impl<F: Family> Search<'_, F> {
    /// Refuses what no lap has: no period, one that does not end, and numbers that are none.
    fn check(&self, start: &Point) -> Result<(), NoOrbit> {
        let refuse = |key: &str, value: Value, allowed: &str| {
            let error = CaseError::value(key, value, allowed);
            Err(NoOrbit(error.to_string()))
        };
        let (phase, period) = (
            self.request.phase,
            self.family.forcing_period(self.at).value,
        );
        if self.periods() == 0 {
            return refuse("periods", Value::Integer(0), "1 or more");
        }
        if !phase.is_finite() {
            return refuse("phase", Value::Number(phase), "a finite number of periods");
        }
        if !(period > 0.0 && period.is_finite()) {
            let allowed = "a forcing of a finite period, above 0";
            return refuse("period", Value::Number(period), allowed);
        }
        match start.iter().find(|number| !number.is_finite()) {
            Some(number) => refuse("start", Value::Number(*number), "finite numbers"),
            None => Ok(()),
        }
    }

    fn periods(&self) -> u32 {
        self.request.periods.unwrap_or(1)
    }

    fn lap<'b>(&'b self, sequence: &'b Sequence) -> Lap<'b, F> {
        Lap {
            family: self.family,
            at: self.at,
            sequence,
            phase: self.request.phase,
            periods: self.periods(),
        }
    }

    fn matches_request(&self, sequence: &Sequence) -> bool {
        let request = self.request.struck.as_ref();
        request.is_none_or(|struck| *struck == sequence.struck())
    }

    /// Why a closed lap is not accepted: it is inadmissible, or its snaps are not the requested
    /// ones.
    fn why_refused(&self, orbit: &Orbit) -> String {
        let mut reasons = orbit.why_not.clone();
        let request = self.request.struck.as_ref();
        if let Some(struck) = request.filter(|_| !self.matches_request(&orbit.lap.sequence)) {
            let cables: Vec<String> = struck.iter().map(|k| (k + 1).to_string()).collect();
            let requested = match cables.is_empty() {
                true => "none".to_owned(),
                false => cables.join(", "),
            };
            reasons.push(format!(
                "the requested snaps are {requested}; leave the symbol out, or begin near another state"
            ));
        }
        let (found, but) = (symbol_text(&orbit.lap.sequence), reasons.join("; "));
        format!("a lap closes with the events {found}, but {but}")
    }

    /// Simulates a lap, closes it with its events, and simulates again, until the events no longer
    /// change.
    fn by_simulation(&self, start: &Point) -> Result<Orbit, NoOrbit> {
        let period = self.family.forcing_period(self.at).value;
        let t = self.request.phase * period;
        let t_end = t + f64::from(self.periods()) * period;
        let mut z = *start;
        let mut closing: Option<Orbit> = None;
        let mut why = String::new();
        for _ in 0..MOST_LAPS {
            let simulated = self.family.simulate(self.at, t, &z, t_end);
            let Some(simulated) = simulated else {
                return Err(NoOrbit("this system can not be simulated".to_owned()));
            };
            if let Some(words) = simulated.illegal {
                why = format!("the search reached a state that is not allowed; allowed: {words}");
                break;
            }
            if let Some((stop, t)) = simulated.stop {
                why = format!(
                    "a lap of the search stopped at t = {t:.4}: {}",
                    stop.reason_text()
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
                if orbit.is_admissible() && self.matches_request(sequence) {
                    return Ok(orbit);
                }
                why = self.why_refused(&orbit);
                if closing.is_none() && self.matches_request(sequence) {
                    closing = Some(orbit);
                }
            }
            let guess = (&z, &durations[..]);
            let phase = self.request.phase;
            let step = step_of_map(self.family, self.at, sequence, phase, self.periods(), guess);
            match step {
                Some((next, size)) if size > 1e-13 => z = next,
                _ => break,
            }
        }
        if why.is_empty() {
            why = format!("Newton's method has not converged after {MOST_LAPS} laps");
        }
        closing.ok_or(NoOrbit(why))
    }

    /// Closes a lap on which the closed surfaces are held throughout.
    fn with_taut(&self, taut: TautSet, start: &Point) -> Option<Orbit> {
        let period = self.family.forcing_period(self.at).value;
        let t = self.request.phase * period;
        let length = f64::from(self.periods()) * period;
        let found = scan(self.family, self.at, taut, (t, start), length)?;
        if !self.matches_request(&found.sequence) {
            return None;
        }
        let lap = self.lap(&found.sequence);
        let closed = close(&lap, start, &found.durations)?;
        Some(Orbit::of(&lap, &closed))
    }
}
