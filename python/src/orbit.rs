//! Periodic orbits, and branches of them.

use crate::case::{Case, read_entries};
use crate::errors::{error_of_case, error_of_work};
use crate::interrupt::interruptible;
use crate::run::to_json;
use crate::study::side;
use crate::system::System;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use snapload::analysis::{START_KEYS, Unfinished};
use snapload::{CaseError, Rules, Value};
use snapload_certificate::ExactCase;
use snapload_orbits::{
    BranchEvent, BranchOptions, BranchRow, Family, Jet, Kind, Moored, OrbitRequest, OrbitRow,
    Point, Starts, branch_options, branch_summary, check_start, check_start_of_system,
    checked_phase, distance, followed_key, of_attractor, orbit_summary, period_of, prove_all,
    start_of,
};
use std::sync::Arc;

/// An orbit of a case, or of a system of one's own.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Orbit {
    /// None of a system of one's own.
    case: Option<Case>,
    family: Moored,
    orbit: snapload_orbits::Orbit,
}

/// The least number of pieces in which a leg of a lap is drawn.
const PIECES: usize = 8;

impl Orbit {
    pub(crate) fn of_case(case: Case, orbit: snapload_orbits::Orbit) -> Self {
        let family = Moored::case(*case.parameters(), [None; 2]);
        Self {
            case: Some(case),
            family,
            orbit: orbit.with_at([0.0; 2]),
        }
    }
}

#[pymethods]
impl Orbit {
    /// Its results, as JSON.
    fn json(&self) -> PyResult<String> {
        to_json(&OrbitRow::new(&self.orbit))
    }

    /// The words of the command.
    fn summary(&self) -> String {
        orbit_summary(&self.orbit)
    }

    /// Whether neighbours come back to it.
    fn attracts(&self) -> bool {
        snapload_orbits::attracts(&self.orbit)
    }

    /// The same with the attempt to prove that it exists.
    fn proved(&self, py: Python<'_>) -> PyResult<Self> {
        let Some(case) = &self.case else {
            let why = "only orbits of a case can be proved, as its numbers are decimals";
            return Err(PyValueError::new_err(why));
        };
        let exact = ExactCase::of(case.parameters(), |_| None).map_err(PyValueError::new_err)?;
        let mut orbit = self.orbit.clone();
        orbit.proof = Some(py.detach(|| self.orbit.prove(&exact)));
        Ok(Self::of_case(case.clone(), orbit))
    }

    /// The case that it is an orbit of.
    fn case(&self) -> Option<Case> {
        self.case.clone()
    }

    /// The largest difference of its state from another one.
    fn distance(&self, state: Point) -> f64 {
        distance(&self.orbit.z, &state)
    }

    /// Its state at t = 0, or at the first whole period after its section.
    fn begins(&self, py: Python<'_>) -> Point {
        let orbit = &self.orbit;
        if orbit.phase == 0.0 {
            return orbit.z;
        }
        let period = self.family.period(orbit.at);
        let from = orbit.phase * period;
        let carried = py.detach(|| self.family.simulate(orbit.at, from, &orbit.z, period));
        carried.map_or(orbit.z, |carried| carried.end)
    }

    /// One lap as the sequence of events has it, whether a body has it or not: rows of doubles with
    /// the number of the leg, how many cables it is held by, the time, and the state.
    fn curve<'py>(&self, py: Python<'py>, pieces: u32) -> Bound<'py, PyByteArray> {
        let orbit = &self.orbit;
        let mut bytes = Vec::new();
        for on in self.family.along_lap(orbit, pieces, PIECES) {
            let head = [on.leg as f64, on.taut_count as f64, on.t];
            let row = head.into_iter().chain(on.z);
            bytes.extend(row.flat_map(f64::to_ne_bytes));
        }
        PyByteArray::new(py, &bytes)
    }
}

/// The requested orbit; cables count from 1.
fn request(
    periods: Option<u32>,
    symbol: Option<Vec<usize>>,
    phase: f64,
) -> Result<OrbitRequest, CaseError> {
    Ok(OrbitRequest {
        periods,
        struck: symbol.map(|cables| cables.into_iter().map(|cable| cable - 1).collect()),
        phase: checked_phase(phase)?,
    })
}

/// The start of a case with some of its values given.
fn start_with(case: &Case, start: &Bound<'_, PyDict>) -> PyResult<Point> {
    let entries = read_entries(start)?;
    let other = entries.iter().find(|(key, _)| !START_KEYS.contains(key));
    if let Some((key, _)) = other {
        let allowed = format!("values of the state, {}", START_KEYS.join(", "));
        return Err(error_of_case(CaseError::value("start", key, allowed)));
    }
    let parameters = case.parameters_with(entries).map_err(error_of_case)?;
    let start = start_of(&parameters);
    check_start(case.parameters(), &start).map_err(error_of_case)?;
    Ok(start)
}

/// An orbit, or why there is none.
type Found = (Option<Orbit>, String);

fn found(case: &Case, orbit: Result<snapload_orbits::Orbit, snapload_orbits::NoOrbit>) -> Found {
    match orbit {
        Ok(orbit) => (Some(Orbit::of_case(case.clone(), orbit)), String::new()),
        Err(why) => (None, why_not(&why)),
    }
}

/// The words of the command with what is called otherwise here.
fn why_not(why: &snapload_orbits::NoOrbit) -> String {
    let words = why.to_string();
    let words = words.replace("--start", "start={...}");
    let words = words.replace("--find N", "snapload.find_orbits");
    words.replace("at snapload section", "at snapload.section")
}

/// The orbit near a start, or the one that the motion of the case comes to.
#[pyfunction]
pub(crate) fn orbit(
    py: Python<'_>,
    case: &Case,
    start: Option<&Bound<'_, PyDict>>,
    periods: Option<u32>,
    symbol: Option<Vec<usize>>,
    phase: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Found> {
    let request = request(periods, symbol, phase).map_err(error_of_case)?;
    period_of(case.parameters()).map_err(error_of_case)?;
    let start = start.map(|start| start_with(case, start)).transpose()?;
    let parameters = *case.parameters();
    let orbit = interruptible(py, progress, move |shared| match start {
        Some(start) => {
            let family = Moored::case(parameters, [None; 2]);
            Ok(family.orbit([0.0; 2], &start, &request))
        }
        None => of_attractor(&parameters, &request, &|progress| shared.report(progress)),
    })?;
    Ok(found(case, orbit.map_err(error_of_work)?))
}

/// The orbit of a system of one's own near a start.
#[pyfunction]
pub(crate) fn orbit_of_system(
    py: Python<'_>,
    system: &System,
    start: Point,
    periods: Option<u32>,
    symbol: Option<Vec<usize>>,
    phase: f64,
) -> PyResult<Found> {
    let request = request(periods, symbol, phase).map_err(error_of_case)?;
    let (parts, rules) = system.parts();
    let rules = Rules {
        settled_below: None,
        sliding_above: None,
        ..rules
    };
    let turns = parts.body.inverse_inertia() > 0.0;
    let jets = parts.map(Jet::constant);
    let family = Moored::new(
        turns,
        move |_| (parts.clone(), rules),
        // The derivatives do not depend on the rules.
        move |_| (jets.clone(), Rules::until(Jet::constant(rules.t_end))),
    );
    check_start_of_system(&family, &start).map_err(error_of_case)?;
    let searched = family.clone();
    let orbit = interruptible(py, None, move |_| {
        searched.orbit([0.0; 2], &start, &request)
    })?;
    Ok(match orbit {
        Ok(orbit) => {
            let case = None;
            (
                Some(Orbit {
                    case,
                    family,
                    orbit,
                }),
                String::new(),
            )
        }
        Err(why) => (None, why_not(&why)),
    })
}

/// All orbits that random starts lead to.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "called by one function of Python, by position"
)]
pub(crate) fn find_orbits(
    py: Python<'_>,
    case: &Case,
    starts: usize,
    seed: u64,
    periods: Option<u32>,
    symbol: Option<Vec<usize>>,
    phase: f64,
    prove: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Orbit>> {
    let request = request(periods, symbol, phase).map_err(error_of_case)?;
    let parameters = *case.parameters();
    let exact = prove.then(|| ExactCase::of(&parameters, |_| None));
    let exact = exact.transpose().map_err(PyValueError::new_err)?;
    let orbits = interruptible(py, progress, move |shared| {
        let on_progress = |progress: snapload::analysis::Progress| shared.report(progress);
        let starts = Starts {
            count: starts,
            seed,
            near: &[],
        };
        let mut orbits =
            snapload_orbits::find_orbits(&parameters, &starts, &request, &on_progress)?;
        if let Some(exact) = &exact {
            prove_all(&mut orbits, exact, &on_progress)?;
        }
        Ok::<_, Unfinished>(orbits)
    })?;
    let orbits = orbits.map_err(error_of_work)?.into_iter();
    Ok(orbits
        .map(|orbit| Orbit::of_case(case.clone(), orbit))
        .collect())
}

/// A branch of orbits of a case along one key.
#[pyclass(frozen, module = "snapload._engine")]
pub(crate) struct Branch {
    case: Case,
    key: &'static str,
    branch: Arc<snapload_orbits::Branch>,
    /// The events of others by which it was come to.
    from: Vec<BranchEvent>,
}

impl Branch {
    /// The case with another value of the key. Where its own start is beyond reach then, that of
    /// the orbit stands in its place.
    fn case_of(&self, orbit: &snapload_orbits::Orbit) -> Result<Case, CaseError> {
        let case = &self.case;
        let moved = (self.key, Value::Number(orbit.at[0]));
        let state = START_KEYS.into_iter().zip(orbit.z.map(Value::Number));
        let given = case.given.iter().cloned().chain([moved]);
        Case::new(case.name.clone(), given.clone())
            .or_else(|_| Case::new(case.name.clone(), given.chain(state)))
    }

    fn orbit_of(&self, orbit: &snapload_orbits::Orbit) -> PyResult<Orbit> {
        let case = self.case_of(orbit).map_err(error_of_case)?;
        Ok(Orbit::of_case(case, orbit.clone()))
    }
}

#[pymethods]
impl Branch {
    /// Its results, as JSON.
    fn json(&self) -> PyResult<String> {
        to_json(&BranchRow::new(self.key, &self.branch, &self.from))
    }

    /// The words of the command.
    fn summary(&self) -> String {
        branch_summary(self.key, &self.branch)
    }

    /// The orbit at a point.
    fn point(&self, place: usize) -> PyResult<Orbit> {
        let point = self.branch.points.get(place);
        let point = point.ok_or_else(|| PyIndexError::new_err("there is no such point"))?;
        self.orbit_of(&point.orbit)
    }

    /// The orbit at an event.
    fn event(&self, place: usize) -> PyResult<Orbit> {
        let event = self.branch.events.get(place);
        let event = event.ok_or_else(|| PyIndexError::new_err("there is no such event"))?;
        self.orbit_of(&event.orbit)
    }

    /// The branch of twice the length that is born at a period doubling: the nearest one, or the
    /// one of a number from 1. Instead of it why there is none.
    fn doubled(
        &self,
        py: Python<'_>,
        number: Option<usize>,
        range: &Bound<'_, PyAny>,
        step: f64,
        points: usize,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(Option<Self>, String)> {
        let range = side(self.key, range)?.ends();
        let event = match self.branch.event(Kind::PeriodDoubling, number) {
            Ok(event) => event.clone(),
            Err(why) => return Ok((None, why.to_string())),
        };
        let value = Value::Number(event.value[0]);
        let here = self.case.parameters_with(vec![(self.key, value)]);
        let here = here.map_err(error_of_case)?;
        let (key, _, options) =
            branch_options(&here, self.key, range, step, points).map_err(error_of_case)?;
        let family = Moored::case(*self.case.parameters(), [Some(key), None]);
        let from = self.from.iter().cloned().chain([event.clone()]).collect();
        let doubled = interruptible(py, progress, move |shared| {
            let on_progress = |progress: snapload::analysis::Progress| shared.report(progress);
            family.branch_of_doubling(&event, &options, &on_progress)
        })?;
        let doubled = doubled.map_err(error_of_work)?;
        let none = "no direction of a branch of twice the length is found there";
        Ok(match doubled {
            Some(branch) => {
                let (case, branch) = (self.case.clone(), Arc::new(branch));
                (
                    Some(Self {
                        case,
                        key,
                        branch,
                        from,
                    }),
                    String::new(),
                )
            }
            None => (None, none.to_owned()),
        })
    }
}

/// The branch of an orbit along a key, in both directions.
#[pyfunction]
pub(crate) fn continuation(
    py: Python<'_>,
    orbit: &Orbit,
    key: &str,
    range: &Bound<'_, PyAny>,
    step: f64,
    points: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Branch> {
    let case = orbit.case.clone();
    let no_case = || crate::errors::internal_error("this orbit does not belong to a case");
    let case = case.ok_or_else(no_case)?;
    followed_key("key", case.parameters(), key).map_err(error_of_case)?;
    let range = side(key, range)?.ends();
    let (key, value, options): (_, _, BranchOptions) =
        branch_options(case.parameters(), key, range, step, points).map_err(error_of_case)?;
    let family = Moored::case(*case.parameters(), [Some(key), None]);
    let start = orbit.orbit.clone().with_at([value, 0.0]);
    let branch = interruptible(py, progress, move |shared| {
        let on_progress = |progress: snapload::analysis::Progress| shared.report(progress);
        family.branch(&start, &options, &on_progress)
    })?;
    let branch = branch.map_err(error_of_work)?;
    Ok(Branch {
        case,
        key,
        branch: Arc::new(branch),
        from: Vec::new(),
    })
}
