//! Basins of attraction: the attractor that each start of a window leads to.

use crate::hybrid::{Point, distance};
use crate::moored::Moored;
use crate::orbit::{Orbit, OrbitRequest};
use crate::section::{LAPS, Section, SectionOptions, start_of};
use crate::window::Window;
use snapload::analysis::{Counter, OnProgress, Unfinished, in_parallel, no_progress};
use snapload::{Case, Parameters, Stop};

/// The long-term behaviour of a start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellOutcome {
    /// The start is not legal.
    Illegal,
    /// It reached a limit, at this time.
    Stopped(Stop, f64),
    /// It approaches an attractor, given by its number.
    Attracted(usize),
    /// No period was found, up to the longest that is searched for.
    Aperiodic,
}

/// A periodic attractor as it was found.
#[derive(Clone, Debug)]
pub struct Attractor {
    /// Its period in periods of the forcing.
    pub period: usize,
    /// A section point.
    pub z: Point,
    /// The orbit, closed by Newton's method, if both keys are start values, which do not change it.
    pub orbit: Option<Orbit>,
    /// The number of cells that lead to it.
    pub cells: usize,
}

/// A window with the attractors of its cells.
#[derive(Clone, Debug)]
pub struct Attraction {
    /// The window.
    pub window: Window,
    /// The cells, the second key varying fastest.
    pub outcomes: Vec<CellOutcome>,
    /// The attractors, ordered by their number of cells, the largest first.
    pub attractors: Vec<Attractor>,
}

/// Section points nearer than this belong to one attractor.
const SAME: f64 = 1e-4;
/// Periods that are examined after the transient.
const SAMPLED_PERIODS: u64 = 136;
/// The longest period that as many show.
pub(crate) const LONGEST_SHOWN: usize = (SAMPLED_PERIODS as usize + 1) / (LAPS + 1);

/// The result of a run, before the attractors are numbered.
enum Followed {
    CellOutcome(CellOutcome),
    Periodic(Vec<Point>),
}

impl Attraction {
    /// Follows every cell over `transient` periods, and determines its behaviour after that.
    ///
    /// # Errors
    /// As for [`crate::Basin::of`].
    pub fn of(window: Window, transient: u64, on_progress: OnProgress) -> Result<Self, Unfinished> {
        window.check()?;
        crate::section::period_of(&window.base)?;
        let options = SectionOptions {
            phase: 0.0,
            skip: transient,
            keep: SAMPLED_PERIODS,
            exponents: false,
            impacts: false,
        };
        let counter = Counter::new("cells", 0, window.count() as u64, on_progress);
        let followed = in_parallel(window.count(), |k| {
            counter.add(1)?;
            follow_start(&window.parameters(window.at(k)), &options)
        })?;
        let mut attractors: Vec<(Attractor, Vec<Point>)> = Vec::new();
        let mut outcomes: Vec<CellOutcome> = Vec::with_capacity(followed.len());
        for followed in followed {
            outcomes.push(match followed {
                Followed::CellOutcome(outcome) => outcome,
                Followed::Periodic(points) => {
                    CellOutcome::Attracted(known(&mut attractors, points))
                }
            });
        }
        Ok(Self::sorted(window, outcomes, attractors))
    }

    /// Numbers the attractors by their number of cells, and closes their orbits.
    fn sorted(
        window: Window,
        mut outcomes: Vec<CellOutcome>,
        attractors: Vec<(Attractor, Vec<Point>)>,
    ) -> Self {
        let mut order: Vec<usize> = (0..attractors.len()).collect();
        order.sort_by_key(|k| std::cmp::Reverse(attractors[*k].0.cells));
        let mut places = vec![0; order.len()];
        for (place, k) in order.iter().enumerate() {
            places[*k] = place;
        }
        for outcome in &mut outcomes {
            if let CellOutcome::Attracted(k) = outcome {
                *k = places[*k];
            }
        }
        let family = Moored::case(window.base, [None; 2]);
        let are_starts = window.are_starts();
        let close = |k: &usize| {
            let mut attractor = attractors[*k].0.clone();
            let request = OrbitRequest {
                periods: Some(attractor.period as u32),
                ..OrbitRequest::default()
            };
            if are_starts {
                attractor.orbit =
                    Orbit::find_near_end_of_motion(&family, [0.0; 2], &attractor.z, &request).ok();
            }
            attractor
        };
        Self {
            attractors: order.iter().map(close).collect(),
            window,
            outcomes,
        }
    }
}

/// Follows one start.
fn follow_start(parameters: &Parameters, options: &SectionOptions) -> Result<Followed, Unfinished> {
    let free = Parameters {
        stop_when_settled: false,
        stop_when_sliding: false,
        ..*parameters
    };
    let Ok(case) = Case::new(free) else {
        return Ok(Followed::CellOutcome(CellOutcome::Illegal));
    };
    let z = start_of(case.parameters());
    let section = Section::from(&free, (0.0, &z), options, &no_progress)?;
    Ok(match (section.stop, section.period()) {
        (Some(stop), _) => Followed::CellOutcome(CellOutcome::Stopped(stop, section.end.1)),
        (None, Some(period)) => {
            let points = &section.points;
            Followed::Periodic(points[points.len() - period..].to_vec())
        }
        (None, None) => Followed::CellOutcome(CellOutcome::Aperiodic),
    })
}

/// The number of an attractor, which is added if it is new.
fn known(attractors: &mut Vec<(Attractor, Vec<Point>)>, points: Vec<Point>) -> usize {
    let first = points[0];
    let is_it = |(_, others): &(Attractor, Vec<Point>)| {
        others.len() == points.len() && others.iter().any(|z| distance(z, &first) < SAME)
    };
    let place = attractors.iter().position(is_it).unwrap_or_else(|| {
        let attractor = Attractor {
            period: points.len(),
            z: first,
            orbit: None,
            cells: 0,
        };
        attractors.push((attractor, points));
        attractors.len() - 1
    });
    attractors[place].0.cells += 1;
    place
}
