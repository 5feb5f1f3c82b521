//! What follows runs in their lanes, if anything does.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::Lane;
use crate::motion::bounce_map::Bounced;
use crate::motion::simulation::{Simulation, Step};

/// What follows a run.
pub(crate) trait Follower: Sized {
    /// The same beside the runs of several lanes.
    type LaneFollowers<L: Doubles>: LaneFollowers<L, Alone = Self>;
    /// What it has to say in the end.
    type Verdict;

    /// Takes in a step that the run made out of the lanes.
    fn take(&mut self, simulation: &Simulation, step: &Step);
    /// Whether it follows the run any further.
    fn goes_on(&self) -> bool;
    /// Whether it can follow the run in a lane now.
    fn fits_a_lane(&self) -> bool;
    /// What it has to say, wherever it has come to.
    fn verdict(self) -> Self::Verdict;
}

/// The followers of the runs in all lanes.
pub(crate) trait LaneFollowers<L: Lane>: Copy {
    /// That of one run.
    type Alone;

    /// None yet.
    fn empty() -> Self;
    /// What they are after a bounce, and in which of the lanes where it is `plain` they can go on
    /// from there; in the others it is made out of the lanes.
    fn bounced(&self, plain: L::Mask, bounced: &Bounced<L>) -> (Self, L::Mask);
    /// One of two, lane by lane.
    fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self;
    /// Puts that of a run into a lane.
    fn put(&mut self, lane: usize, alone: &Self::Alone);
    /// Brings that of a run up to what it is in its lane, `impacts` later.
    fn get(&self, lane: usize, alone: &mut Self::Alone, impacts: u64);
}

/// Nothing does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unfollowed;

impl Follower for Unfollowed {
    type LaneFollowers<L: Doubles> = Self;
    type Verdict = ();

    #[inline(always)]
    fn take(&mut self, _: &Simulation, _: &Step) {}
    #[inline(always)]
    fn goes_on(&self) -> bool {
        true
    }
    #[inline(always)]
    fn fits_a_lane(&self) -> bool {
        true
    }
    fn verdict(self) {}
}

impl<L: Lane> LaneFollowers<L> for Unfollowed {
    type Alone = Self;

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
