//! Followers: what is computed along with runs in their lanes, if anything is.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::Lane;
use crate::motion::bounce_map::Bounced;
use crate::motion::simulation::{Simulation, Step};

/// Something that is computed along with a run.
pub(crate) trait Follower: Sized {
    /// The followers of the runs in several lanes.
    type LaneFollowers<L: Doubles>: LaneFollowers<L, RunFollower = Self>;
    /// Its result at the end.
    type Verdict;

    /// Takes in a step that the run made outside the lanes.
    fn take(&mut self, simulation: &Simulation, step: &Step);
    /// Whether it follows the run any further.
    fn is_active(&self) -> bool;
    /// Whether it can follow the run in a lane now.
    fn fits_a_lane(&self) -> bool;
    /// Its result, as far as it has come.
    fn verdict(self) -> Self::Verdict;
}

/// The followers of the runs in all lanes.
pub(crate) trait LaneFollowers<L: Lane>: Copy {
    /// The follower of one run.
    type RunFollower;

    /// Followers of no runs yet.
    fn empty() -> Self;
    /// The followers after a bounce, and in which of the lanes where it is `plain` they can
    /// continue from there; in the other lanes the bounce is made outside the lanes.
    fn bounced(&self, plain: L::Mask, bounced: &Bounced<L>) -> (Self, L::Mask);
    /// One of two, lane by lane.
    fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self;
    /// Puts the follower of a run into a lane.
    fn put(&mut self, lane: usize, follower: &Self::RunFollower);
    /// Updates the follower of a run from its lane, `impacts` later.
    fn get(&self, lane: usize, follower: &mut Self::RunFollower, impacts: u64);
}

/// Runs without a follower.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoFollower;

impl Follower for NoFollower {
    type LaneFollowers<L: Doubles> = Self;
    type Verdict = ();

    #[inline(always)]
    fn take(&mut self, _: &Simulation, _: &Step) {}
    #[inline(always)]
    fn is_active(&self) -> bool {
        true
    }
    #[inline(always)]
    fn fits_a_lane(&self) -> bool {
        true
    }
    fn verdict(self) {}
}

impl<L: Lane> LaneFollowers<L> for NoFollower {
    type RunFollower = Self;

    #[inline(always)]
    fn empty() -> Self {
        Self
    }
    #[inline(always)]
    fn bounced(&self, plain: L::Mask, _: &Bounced<L>) -> (Self, L::Mask) {
        (Self, plain)
    }
    #[inline(always)]
    fn select(_: L::Mask, _: &Self, _: &Self) -> Self {
        Self
    }
    #[inline(always)]
    fn put(&mut self, _: usize, _: &Self) {}
    #[inline(always)]
    fn get(&self, _: usize, _: &mut Self, _: u64) {}
}
