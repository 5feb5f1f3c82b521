//! Orbits, branches and curves of bodies on cables, compiled here.
//!
//! What is generic over a [`crate::Family`] is compiled in the crate that asks for it, as that
//! crate is: a program that leaves its own code unoptimised would have these computations
//! unoptimised, too, down to each sum.

use crate::branch::{Along, Branch};
use crate::branch_events::BranchEvent;
use crate::curve::{Across, Curve};
use crate::hybrid::{Family, Hybrid, Point};
use crate::lap::Lap;
use crate::moored::Moored;
use crate::orbit::{NoOrbit, Orbit, Wanted};
use snapload::analysis::{Cancelled, OnProgress};

/// One of many states of a lap.
#[derive(Clone, Copy, Debug)]
pub struct OnLap {
    /// The number of its leg.
    pub leg: usize,
    /// How many surfaces are held there.
    pub held: usize,
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
    pub fn orbit(&self, at: [f64; 2], start: &Point, wanted: &Wanted) -> Result<Orbit, NoOrbit> {
        Orbit::find(self, at, start, wanted)
    }

    /// [`Branch::of`] an orbit of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn branch(
        &self,
        orbit: &Orbit,
        along: &Along,
        on_progress: OnProgress,
    ) -> Result<Branch, Cancelled> {
        Branch::of(self, orbit, along, on_progress)
    }

    /// [`Branch::of_doubling`] of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn branch_of_doubling(
        &self,
        event: &BranchEvent,
        along: &Along,
        on_progress: OnProgress,
    ) -> Result<Option<Branch>, Cancelled> {
        Branch::of_doubling(self, event, along, on_progress)
    }

    /// [`Curve::of`] special orbits of these systems.
    ///
    /// # Errors
    /// As there.
    #[inline(never)]
    pub fn curve(
        &self,
        event: &BranchEvent,
        across: &Across,
        on_progress: OnProgress,
    ) -> Result<Result<Curve, NoOrbit>, Cancelled> {
        Curve::of(self, event, across, on_progress)
    }

    /// States along an orbit as its sequence of events has it, whether a body has it or not: about
    /// `pieces` of the lap from one to the next, and at least `fewest` of each leg.
    pub fn along_lap(&self, orbit: &Orbit, pieces: f64, fewest: f64) -> Vec<OnLap> {
        let lap = Lap {
            family: self,
            at: orbit.at,
            sequence: &orbit.lap.sequence,
            phase: orbit.phase,
            periods: orbit.periods,
        };
        let system = self.plain(orbit.at);
        let legs = lap.legs(&system, &orbit.z, &orbit.lap.durations);
        let mut states = Vec::new();
        for (number, leg) in legs.iter().enumerate() {
            let count = (pieces * leg.s.abs() / orbit.length).ceil().max(fewest) as usize;
            let path = system.path(leg.held, leg.t, &leg.start, leg.s);
            states.extend((0..=count).map(|k| {
                let s = leg.s * k as f64 / count as f64;
                OnLap {
                    leg: number,
                    held: leg.held.len(),
                    t: leg.t + s,
                    z: path(s),
                }
            }));
        }
        states
    }
}
