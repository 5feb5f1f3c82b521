//! The segments of a run, from which its motion can be computed again, in limited memory.
//!
//! Motion without a closed form is a chain of Taylor series: where one ends without an event, the
//! next begins at its last state. So the first of a chain is enough to compute all that follow, to
//! the bit. Up to [`MOST_LINKS`] of those that follow are kept to reach any time quickly; a longer
//! run keeps every second, then every fourth, and so on, so that its memory grows with its events
//! alone.

use crate::model::floating::Complex;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, TautSet};
use crate::motion::active_set::ActiveSet;
use crate::motion::contact::Contact;
use crate::motion::events::Reached;
use crate::motion::projection::{project_position, project_velocity};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::taut_series::{Series, SeriesStart};
use crate::motion::waves::Waves;

/// A segment of motion with one taut set, from which the state at any time in it is computed.
#[derive(Clone, Debug)]
pub(crate) struct Segment {
    pub(crate) t: f64,
    pub(crate) start: State,
    /// The state of the water's memory at its start.
    memory: Box<[Complex]>,
    pub(crate) active: ActiveSet,
    /// The cables whose gap is zero where the first expansion ends.
    closed: TautSet,
    /// The number of expansions of its chain before it.
    link: u64,
}

/// The most expansions that are kept although they could be computed from an earlier one: 25 MB.
const MOST_LINKS: usize = 1 << 18;

/// The segments of a run.
#[derive(Clone, Debug)]
pub(crate) struct Segments {
    kept: Vec<Segment>,
    /// The interval between the links of a chain that are kept.
    stride: u64,
    /// The number of links kept.
    links: usize,
    /// The latest segment, if no event ended it.
    unbroken: Option<Segment>,
}

impl Segment {
    /// Its first expansion.
    #[inline(always)]
    pub(crate) fn expand(&self, system: &System, waves: &mut Waves<f64>, series: &mut Series<f64>) {
        // Gaps are not evaluated here, so that any contacts will do.
        let contacts = [Contact::RESTING; MAX_CABLES];
        waves.cover(self.t, self.t);
        let around = waves.expanded(system, self.t);
        let start = SeriesStart {
            around: &around,
            state: &self.start,
            memory: &self.memory,
            contacts: &contacts,
            active: self.active,
        };
        series.expand(system, &start);
    }

    /// The force of the water's memory at its start.
    #[inline(always)]
    pub(crate) fn memory_force(&self, system: &System) -> [f64; 3] {
        system.memory_force(&self.memory)
    }

    /// The next segment of the chain, computed by the same operations as in the run.
    #[inline(always)]
    pub(crate) fn following(&self, system: &System, series: &Series<f64>) -> Self {
        let mut start = series.state(series.step());
        project_position(system, &mut start, self.closed);
        project_velocity(system, &mut start, self.active.taut);
        let mut memory = self.memory.clone();
        series.memory(series.step(), &mut memory);
        Self {
            t: self.t + series.step(),
            start,
            memory,
            link: self.link + 1,
            ..*self
        }
    }
}

impl Segments {
    pub(crate) fn new() -> Self {
        Self {
            kept: Vec::new(),
            stride: 1,
            links: 0,
            unbroken: None,
        }
    }

    /// In order of time.
    pub(crate) fn kept(&self) -> &[Segment] {
        &self.kept
    }

    /// The segment of a step.
    pub(crate) fn take(&mut self, simulation: &Simulation, step: &Step) {
        let system = simulation.system();
        let mut segment = Segment {
            t: step.t_start,
            start: step.start,
            memory: simulation.memory_at_start(),
            active: ActiveSet {
                taut: step.taut,
                carrying: step.carrying,
            },
            closed: step.event.closed,
            link: 0,
        };
        if let Some(before) = &self.unbroken
            && (before.active, before.closed) == (segment.active, segment.closed)
            && !system.has_closed_form(step.taut)
        {
            segment.link = before.link + 1;
        }
        let eventless = step.event.reached == Reached::default();
        if step.t_end > step.t_start {
            self.keep(segment.clone());
        }
        self.unbroken = Some(segment).filter(|_| eventless);
    }

    /// The end of the run, which is a segment of no length.
    pub(crate) fn end(&mut self, simulation: &Simulation) {
        let taut = simulation.taut();
        self.keep(Segment {
            t: simulation.time(),
            start: *simulation.state(),
            memory: simulation.memory().into(),
            active: ActiveSet {
                taut,
                carrying: taut,
            },
            closed: taut,
            link: 0,
        });
    }

    fn keep(&mut self, segment: Segment) {
        if !segment.link.is_multiple_of(self.stride) {
            return;
        }
        self.links += usize::from(segment.link > 0);
        self.kept.push(segment);
        self.keep_links(MOST_LINKS);
    }

    /// Keeps at most this many links.
    pub(crate) fn keep_links(&mut self, most: usize) {
        while self.links > most {
            self.stride *= 2;
            let stride = self.stride;
            self.kept.retain(|s| s.link.is_multiple_of(stride));
            self.links = self.kept.iter().filter(|s| s.link > 0).count();
        }
    }
}
