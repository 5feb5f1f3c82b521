//! Orbits, branches and curves of bodies on cables, compiled here.
//!
//! Generic code is compiled with the settings of the crate that calls it. These functions are not
//! generic and are compiled with the settings of this crate, so that they are fast in a program
//! that leaves its own code unoptimised.

use crate::branch::Branch;
use crate::branch_events::BranchEvent;
use crate::curve::{Curve, CurveOptions};
use crate::follower::BranchOptions;
use crate::hybrid::{Family, Hybrid, Point};
use crate::moored::Moored;
use crate::orbit::{NoOrbit, Orbit, OrbitRequest};
use snapload::analysis::{Cancelled, OnProgress, Unfinished};

/// One of many states of a lap.
#[derive(Clone, Copy, Debug)]
pub struct OnLap {
    /// The index of its leg.
    pub leg: usize,
    /// The number of surfaces held there.
    pub taut_count: usize,
    /// When.
    pub t: f64,
    /// The state.
    pub z: Point,
}

impl Moored {
    /// [`Orbit::find`] among these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn orbit(
        &self,
        at: [f64; 2],
        start: &Point,
        request: &OrbitRequest,
    ) -> Result<Orbit, NoOrbit> {
        Orbit::find(self, at, start, request)
    }

    /// [`Branch::of`] an orbit of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn branch(
        &self,
        orbit: &Orbit,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Branch, Unfinished> {
        Branch::of(self, orbit, options, on_progress)
    }

    /// [`Branch::of_doubling`] of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn branch_of_doubling(
        &self,
        event: &BranchEvent,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Option<Branch>, Unfinished> {
        Branch::of_doubling(self, event, options, on_progress)
    }

    /// [`Curve::of`] special orbits of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn curve(
        &self,
        event: &BranchEvent,
        options: &CurveOptions,
        on_progress: OnProgress,
    ) -> Result<Result<Curve, NoOrbit>, Cancelled> {
        Curve::of(self, event, options, on_progress)
    }

    /// States along an orbit by its sequence of events, admissible or not: the lap in about
    /// `pieces` pieces, and each leg in at least `fewest`.
    pub fn along_lap(&self, orbit: &Orbit, pieces: u32, fewest: usize) -> Vec<OnLap> {
        let system = self.plain(orbit.at);
        let (_, legs) = orbit.lap_of(self, &system);
        let mut states = Vec::new();
        for (number, leg) in legs.iter().enumerate() {
            let share = (f64::from(pieces) * leg.s.abs() / orbit.length).ceil() as usize;
            let count = share.max(fewest).max(1);
            let path = system.path(leg.taut, leg.t, &leg.start, leg.s);
            states.extend((0..=count).map(|k| {
                let s = leg.s * k as f64 / count as f64;
                OnLap {
                    leg: number,
                    taut_count: leg.taut.len(),
                    t: leg.t + s,
                    z: path(s),
                }
            }));
        }
        states
    }
}
