//! A branch in one direction, and its end.

use crate::branch_events::{BranchEvent, Kind};
use crate::continuation::{Continuation, Goal};
use crate::hybrid::Family;
use crate::orbit::Orbit;

/// Two events whose parameters and states differ by no more than these are one: where a branch
/// turns back the first is the square of the second.
pub(crate) const SAME_VALUE: f64 = 1e-6;
const ACCUMULATION: &str =
    "an accumulation of snaps changes here: beyond, they do not come to rest in this way";

/// A point of a branch.
#[derive(Clone, Debug)]
pub struct BranchPoint {
    /// The orbit, which may be inadmissible.
    pub orbit: Orbit,
    /// The length along the branch from the orbit with which it was started.
    pub arclength: f64,
}

/// Where a branch ends, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchEnd {
    /// The value of the parameter.
    pub at: f64,
    /// Why.
    pub because: String,
}

pub(crate) fn point(orbit: Orbit, arclength: f64) -> BranchPoint {
    BranchPoint { orbit, arclength }
}

/// The branch in one direction.
pub(crate) struct HalfBranch {
    pub(crate) points: Vec<BranchPoint>,
    pub(crate) events: Vec<BranchEvent>,
    pub(crate) end: BranchEnd,
    pub(crate) closed: bool,
    /// Its length.
    pub(crate) arclength: f64,
    /// Its last point.
    pub(crate) last: Option<Goal>,
}

impl HalfBranch {
    pub(crate) fn empty(at: f64, because: &str) -> Self {
        Self {
            points: Vec::new(),
            events: Vec::new(),
            end: BranchEnd {
                at,
                because: because.to_owned(),
            },
            closed: false,
            arclength: 0.0,
            last: None,
        }
    }

    /// Whether it has as many points as are allowed, at which it ends.
    pub(crate) fn is_full(&mut self, most: usize) -> bool {
        let full = self.points.len() >= most;
        if full {
            self.end.because = format!("the limit of {most} points is reached");
        }
        full
    }

    /// Ends it where an accumulation ends. There the multipliers are infinite, so that rounding
    /// decides whether it turns back just before.
    pub(crate) fn end_with_accumulation(&mut self) {
        self.end.because = ACCUMULATION.to_owned();
        let at = self.end.at;
        let is_at_end = |event: &BranchEvent| (event.value[0] - at).abs() < SAME_VALUE;
        self.events
            .retain(|event| event.kind != Kind::Fold || !is_at_end(event));
    }

    /// Closes it at a point of the branch itself, which becomes its last one.
    pub(crate) fn close<F: Family>(
        &mut self,
        goal: &Goal,
        sigma: f64,
        continuation: &Continuation<F>,
    ) {
        let orbit = Orbit::of(&continuation.lap(goal.at.at), &goal.at.closed());
        self.end.at = orbit.at[0];
        self.end.because = "the branch is closed".to_owned();
        self.closed = true;
        self.points.push(point(orbit, self.arclength + sigma));
    }
}
