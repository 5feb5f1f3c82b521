//! Basins of attraction: the attractor that each start of a window leads to.

use crate::basin::neighbours_of;
use crate::growth::Growth;
use crate::hybrid::{Point, distance};
use crate::moored::Moored;
use crate::orbit::{Orbit, OrbitRequest};
use crate::section::{LAPS, Section, SectionOptions, start_of};
use crate::window::Window;
use snapload::analysis::{Counter, OnProgress, Progress, Unfinished, in_parallel};
use snapload::{Case, CaseError, Parameters, Stop};
use std::ops::ControlFlow;

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

/// A cell of a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttractedCell {
    /// The long-term behaviour of its start.
    pub outcome: CellOutcome,
    /// Whether neighbours at a distance of 1e-8 behave alike, and nearer ones, too, if rounding may
    /// decide it ([`crate::Cell::decided`]). Without neighbours, whether it is not cut short.
    pub decided: bool,
    /// Whether deviations never grow so far that rounding may decide it.
    pub trusted: bool,
}

impl AttractedCell {
    fn is_legal(&self) -> bool {
        self.outcome != CellOutcome::Illegal
    }
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
    pub cells: Vec<AttractedCell>,
    /// Whether neighbours and the growth of deviations were computed.
    pub neighbours_run: bool,
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

impl Followed {
    /// Whether another run behaves as this one does.
    fn is_as(&self, other: &Self) -> bool {
        match [self, other] {
            [Self::Periodic(points), Self::Periodic(others)] => are_same(points, others),
            [Self::CellOutcome(one), Self::CellOutcome(other)] => match [one, other] {
                [CellOutcome::Stopped(one, _), CellOutcome::Stopped(other, _)] => one == other,
                [one, other] => one == other,
            },
            _ => false,
        }
    }

    fn is_illegal(&self) -> bool {
        matches!(self, Self::CellOutcome(CellOutcome::Illegal))
    }

    fn is_cut_short(&self) -> bool {
        matches!(self, Self::CellOutcome(CellOutcome::Stopped(stop, _)) if stop.cuts_short())
    }
}

/// A cell before the attractors are numbered, and what [`AttractedCell`] says of it.
struct FollowedCell {
    followed: Followed,
    decided: bool,
    trusted: bool,
}

impl Attraction {
    /// Follows every cell over `transient` periods, and determines its behaviour after that; with
    /// `trust` also that of its neighbours.
    ///
    /// # Errors
    /// As for [`crate::Basin::of`].
    pub fn of(
        window: Window,
        transient: u64,
        trust: bool,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        window.check()?;
        if window.keys.contains(&"t_end") {
            let allowed =
                "a key on which attractors depend: they are followed for as long as it takes";
            return Err(CaseError::value("vary", "t_end", allowed).into());
        }
        if !window.keys.contains(&"omega") {
            crate::moored::period_of(&window.base)?;
        }
        let options = SectionOptions {
            phase: 0.0,
            skip: transient,
            keep: SAMPLED_PERIODS,
            exponents: trust,
            impacts: false,
        };
        let counter = Counter::new("cells", 0, window.count() as u64, on_progress);
        let followed = in_parallel(window.count(), |k| {
            let cell = follow_cell(&window, window.at(k), &options, &counter)?;
            counter.add(1)?;
            Ok::<_, Unfinished>(cell)
        })?;
        let mut attractors: Vec<(Attractor, Vec<Point>)> = Vec::new();
        let cells = followed.into_iter().map(|cell| AttractedCell {
            outcome: match cell.followed {
                Followed::CellOutcome(outcome) => outcome,
                Followed::Periodic(points) => {
                    CellOutcome::Attracted(known(&mut attractors, points))
                }
            },
            decided: cell.decided,
            trusted: cell.trusted,
        });
        let cells = cells.collect();
        Ok(Self::sorted(window, trust, cells, attractors))
    }

    /// The number of legal cells that are not decided, if that was computed.
    pub fn undecided(&self) -> Option<usize> {
        let undecided = |cell: &&AttractedCell| cell.is_legal() && !cell.decided;
        self.neighbours_run
            .then(|| self.cells.iter().filter(undecided).count())
    }

    /// The number of cells with such an outcome.
    pub fn count(&self, is_such: impl Fn(&CellOutcome) -> bool) -> usize {
        let such = |cell: &&AttractedCell| is_such(&cell.outcome);
        self.cells.iter().filter(such).count()
    }

    /// Numbers the attractors by their number of cells, and closes their orbits.
    fn sorted(
        window: Window,
        neighbours_run: bool,
        mut cells: Vec<AttractedCell>,
        attractors: Vec<(Attractor, Vec<Point>)>,
    ) -> Self {
        let mut order: Vec<usize> = (0..attractors.len()).collect();
        order.sort_by_key(|k| std::cmp::Reverse(attractors[*k].0.cells));
        let mut places = vec![0; order.len()];
        for (place, k) in order.iter().enumerate() {
            places[*k] = place;
        }
        for cell in &mut cells {
            if let CellOutcome::Attracted(k) = &mut cell.outcome {
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
            neighbours_run,
            cells,
        }
    }
}

/// Follows one cell, and its neighbours until one of them behaves otherwise, if the growth of
/// deviations is to be followed.
fn follow_cell(
    window: &Window,
    at: [f64; 2],
    options: &SectionOptions,
    counter: &Counter,
) -> Result<FollowedCell, Unfinished> {
    let goes_on = |_: Progress| match counter.add(0) {
        Ok(()) => ControlFlow::Continue(()),
        Err(_) => ControlFlow::Break(()),
    };
    let (followed, growth) = follow_start(&window.parameters(at), options, &goes_on)?;
    let mut cell = FollowedCell {
        decided: !followed.is_cut_short(),
        trusted: growth.is_none_or(Growth::whole_is_known),
        followed,
    };
    let with_neighbours = options.exponents && !cell.followed.is_illegal();
    let alone = SectionOptions {
        exponents: false,
        ..*options
    };
    for neighbour in neighbours_of(at, cell.trusted).filter(|_| with_neighbours) {
        if !cell.decided {
            break;
        }
        let (neighbour, _) = follow_start(&window.parameters(neighbour), &alone, &goes_on)?;
        cell.decided = neighbour.is_illegal() || neighbour.is_as(&cell.followed);
    }
    Ok(cell)
}

/// Follows one start; with the growth of deviations, if that is wanted.
fn follow_start(
    parameters: &Parameters,
    options: &SectionOptions,
    on_progress: OnProgress,
) -> Result<(Followed, Option<Growth>), Unfinished> {
    let free = Parameters {
        stop_when_settled: false,
        stop_when_sliding: false,
        ..*parameters
    };
    let Ok(case) = Case::new(free) else {
        return Ok((Followed::CellOutcome(CellOutcome::Illegal), None));
    };
    let z = start_of(case.parameters());
    let section = Section::from(&free, (0.0, &z), options, on_progress)?;
    let followed = match (section.stop, section.period()) {
        (Some(stop), _) => Followed::CellOutcome(CellOutcome::Stopped(stop, section.end.1)),
        (None, Some(period)) => {
            let points = &section.points;
            Followed::Periodic(points[points.len() - period..].to_vec())
        }
        (None, None) => Followed::CellOutcome(CellOutcome::Aperiodic),
    };
    Ok((followed, section.growth))
}

/// Whether the section points of two motions are those of one attractor.
fn are_same(points: &[Point], others: &[Point]) -> bool {
    let is_first = |z: &Point| distance(z, &points[0]) < SAME;
    others.len() == points.len() && others.iter().any(is_first)
}

/// The number of an attractor, which is added if it is new.
fn known(attractors: &mut Vec<(Attractor, Vec<Point>)>, points: Vec<Point>) -> usize {
    let is_it = |(_, others): &(Attractor, Vec<Point>)| are_same(&points, others);
    let place = attractors.iter().position(is_it).unwrap_or_else(|| {
        let attractor = Attractor {
            period: points.len(),
            z: points[0],
            orbit: None,
            cells: 0,
        };
        attractors.push((attractor, points));
        attractors.len() - 1
    });
    attractors[place].0.cells += 1;
    place
}
