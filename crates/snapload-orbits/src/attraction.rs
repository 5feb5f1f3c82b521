//! Basins of attraction: the attractor that each start of a window leads to.

use crate::basin::Window;
use crate::hybrid::{Point, distance};
use crate::moored::Moored;
use crate::orbit::{Orbit, Wanted};
use crate::section::{Section, Stretch, start_of};
use snapload::analysis::{Counter, OnProgress, Unfinished, in_parallel, no_progress};
use snapload::{Case, Parameters, Stop};

/// The long-term behaviour of a start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// The start is not legal.
    Illegal,
    /// It reached a limit, at this time.
    Stopped(Stop, f64),
    /// It approaches an attractor, given by its number.
    Attracted(usize),
    /// No period was found.
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
    pub fates: Vec<Fate>,
    /// The attractors, ordered by their number of cells, the largest first.
    pub attractors: Vec<Attractor>,
}

/// Section points nearer than this belong to one attractor.
const SAME: f64 = 1e-4;
/// Periods that are examined after the transient: enough for eight laps of sixteen periods.
const LOOKED_AT: u64 = 136;

/// The result of a run, before the attractors are numbered.
enum Met {
    Fate(Fate),
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
        let stretch = Stretch {
            phase: 0.0,
            skip: transient,
            keep: LOOKED_AT,
            exponents: false,
            impacts: false,
        };
        let counter = Counter::new("cells", 0, window.count() as u64, on_progress);
        let met = in_parallel(window.count(), |k| {
            counter.add(1)?;
            met(&window.parameters(window.at(k)), &stretch)
        })?;
        let mut attractors: Vec<(Attractor, Vec<Point>)> = Vec::new();
        let mut fates: Vec<Fate> = Vec::with_capacity(met.len());
        for met in met {
            fates.push(match met {
                Met::Fate(fate) => fate,
                Met::Periodic(points) => Fate::Attracted(known(&mut attractors, points)),
            });
        }
        Ok(Self::sorted(window, fates, attractors))
    }

    /// Numbers the attractors by their number of cells, and closes their orbits.
    fn sorted(
        window: Window,
        mut fates: Vec<Fate>,
        attractors: Vec<(Attractor, Vec<Point>)>,
    ) -> Self {
        let mut order: Vec<usize> = (0..attractors.len()).collect();
        order.sort_by_key(|k| std::cmp::Reverse(attractors[*k].0.cells));
        let mut places = vec![0; order.len()];
        for (place, k) in order.iter().enumerate() {
            places[*k] = place;
        }
        for fate in &mut fates {
            if let Fate::Attracted(k) = fate {
                *k = places[*k];
            }
        }
        let family = Moored::case(window.base, [None; 2]);
        let are_starts = window.are_starts();
        let close = |k: &usize| {
            let mut attractor = attractors[*k].0.clone();
            let wanted = Wanted {
                periods: Some(attractor.period as u32),
                ..Wanted::default()
            };
            if are_starts {
                attractor.orbit = Orbit::come_to(&family, [0.0; 2], &attractor.z, &wanted).ok();
            }
            attractor
        };
        Self {
            attractors: order.iter().map(close).collect(),
            window,
            fates,
        }
    }
}

/// Follows one start.
fn met(parameters: &Parameters, stretch: &Stretch) -> Result<Met, Unfinished> {
    let free = Parameters {
        stop_when_settled: false,
        stop_when_sliding: false,
        ..*parameters
    };
    let Ok(case) = Case::new(free) else {
        return Ok(Met::Fate(Fate::Illegal));
    };
    let z = start_of(case.parameters());
    let section = Section::from(&free, (0.0, &z), stretch, &no_progress)?;
    Ok(match (section.stop, section.period()) {
        (Some(stop), _) => Met::Fate(Fate::Stopped(stop, section.end.1)),
        (None, Some(period)) => {
            let points = &section.points;
            Met::Periodic(points[points.len() - period..].to_vec())
        }
        (None, None) => Met::Fate(Fate::Aperiodic),
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
