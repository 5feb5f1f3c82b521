//! How far a run can be trusted if its values are exact, without errors and exponents.

use crate::analysis::outcomes::side_by_side;
use crate::analysis::progress::{Cancelled, Counter};
use crate::analysis::trust::Horizon;
use crate::analysis::trust::bounces::Followed;
use crate::analysis::trust::parts::FactorParts;
use crate::analysis::trust::spread::SpreadMonitor;
use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::batch::followers::{Follower, LaneFollowers};
use crate::batch::lanes::Lanes;
use crate::case::Case;
use crate::motion::bounce_map::{BounceMap, Bounced};
use crate::motion::outcome::Outcome;
use crate::motion::simulation::{Simulation, Step};

/// A step to be followed, by the best instructions for it.
struct Following<'a>(&'a mut SpreadMonitor, &'a Simulation, &'a Step);

impl Kernel for Following<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.0.follow(self.1, self.2, &mut ());
    }
}

impl Follower for SpreadMonitor {
    type LaneFollowers<L: Doubles> = Followed<L>;
    type Verdict = Certainty;

    fn take(&mut self, simulation: &Simulation, step: &Step) {
        dispatch(Following(self, simulation, step));
    }

    fn is_active(&self) -> bool {
        self.horizon.is_none()
    }

    fn fits_a_lane(&self) -> bool {
        self.adds_by_signs()
    }

    fn verdict(self) -> Certainty {
        Certainty {
            horizon: self.horizon,
        }
    }
}

impl<L: Doubles> LaneFollowers<L> for Followed<L> {
    type RunFollower = SpreadMonitor;

    fn empty() -> Self {
        Self {
            parts: FactorParts::none(),
            slant: L::ONE,
            tolerance: L::ZERO,
        }
    }

    #[inline(always)]
    fn bounce(&self, next: &mut Self, plain: L::Mask, bounced: &Bounced<L>) -> L::Mask {
        let through = self.carry(next, bounced, &BounceMap::of(bounced));
        plain & through.within_tolerance
    }

    fn put(&mut self, lane: usize, follower: &SpreadMonitor) {
        self.pairwise(&follower.followed(), |all, one| all.set(lane, *one));
    }

    fn get(&self, lane: usize, follower: &mut SpreadMonitor, impacts: u64) {
        let mut one = follower.followed();
        one.pairwise(self, |one, all| *one = all.get(lane));
        follower.continue_from(one, impacts);
    }
}

/// The horizon of a run whose only uncertainty is rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty {
    /// Where trust ends; none if the whole run can be trusted.
    pub horizon: Option<Horizon>,
}

impl Certainty {
    /// The certainty of a case; the run is followed up to its horizon.
    pub fn of(case: &Case) -> Self {
        let mut simulation = case.simulation();
        let mut monitor = SpreadMonitor::of_exact_case(case, &simulation);
        while monitor.horizon.is_none()
            && let Some(step) = simulation.step()
        {
            dispatch(Following(&mut monitor, &simulation, &step));
        }
        Self {
            horizon: monitor.horizon,
        }
    }

    /// The certainties of many cases, and the outcomes of their runs, in their order: side by side,
    /// on one thread. Each has the same bits as when computed by itself.
    ///
    /// # Errors
    /// [`Cancelled`] if the work that is counted is to end before.
    pub fn with_outcomes(
        lanes: Lanes,
        mut cases: impl Iterator<Item = Case>,
        counter: &Counter,
    ) -> Result<Vec<(Outcome, Self)>, Cancelled> {
        Self::outcomes_and_certainties(lanes, &mut cases, counter)
    }

    /// Not generic, so that it is compiled once, here.
    fn outcomes_and_certainties(
        lanes: Lanes,
        cases: &mut dyn Iterator<Item = Case>,
        counter: &Counter,
    ) -> Result<Vec<(Outcome, Self)>, Cancelled> {
        let runs = cases.map(|case| {
            let monitor = SpreadMonitor::of_exact_case(&case, case.start());
            (case.into_boxed(), monitor)
        });
        let results = side_by_side(lanes, runs, counter)?;
        let mut all = Vec::with_capacity(results.len());
        all.extend(results.flatten());
        Ok(all)
    }

    /// Whether the way in which the run ends is certain.
    pub fn decides_the_end(&self) -> bool {
        self.horizon.is_none()
    }
}
