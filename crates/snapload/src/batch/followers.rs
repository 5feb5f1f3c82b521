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
    /// Computes the followers after a bounce; returns in which of the lanes where it is `plain`
    /// they can continue from there. In the other lanes the bounce is made outside the lanes.
    fn bounce(&self, next: &mut Self, plain: L::Mask, bounced: &Bounced<L>) -> L::Mask;
    /// Puts the follower of a run into a lane.
    fn put(&mut self, lane: usize, follower: &Self::RunFollower);
    /// Updates the follower of a run from its lane, `impacts` later.
    fn get(&self, lane: usize, follower: &mut Self::RunFollower, impacts: u64);
}

/// The followers after the latest bounce and those before it. The two take turns: the followers are
/// large, so that those of lanes which have not made the bounce are not copied, but read from before
/// it.
#[derive(Clone, Copy, Debug)]
pub(super) struct InTurn<F> {
    both: [F; 2],
    turned: bool,
}

impl<F: Copy> InTurn<F> {
    pub(super) fn new(now: F) -> Self {
        Self {
            both: [now; 2],
            turned: false,
        }
    }

    /// Those now, and memory for the next.
    #[inline(always)]
    pub(super) fn now_and_next(&mut self) -> (&mut F, &mut F) {
        let [first, second] = &mut self.both;
        if self.turned {
            (second, first)
        } else {
            (first, second)
        }
    }

    /// Those now.
    pub(super) fn now(&mut self) -> &mut F {
        self.now_and_next().0
    }

    /// Those before the latest bounce.
    pub(super) fn before(&mut self) -> &mut F {
        self.now_and_next().1
    }

    /// Lets the next be those now.
    #[inline(always)]
    pub(super) fn turn(&mut self) {
        self.turned = !self.turned;
    }
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
    fn bounce(&self, _: &mut Self, plain: L::Mask, _: &Bounced<L>) -> L::Mask {
        plain
    }
    #[inline(always)]
    fn put(&mut self, _: usize, _: &Self) {}
    #[inline(always)]
    fn get(&self, _: usize, _: &mut Self, _: u64) {}
}
