//! Branches: an orbit as a parameter changes, with the bifurcations and other events along it.

use crate::branch_events::{BranchEvent, Kind, Tested};
use crate::continuation::{Continuation, Goal, Unknowns};
use crate::curve::Curve;
use crate::follower::{BranchOptions, Follower, check_followed};
use crate::half_branch::{BranchEnd, BranchPoint, HalfBranch, point};
use crate::hybrid::Family;
use crate::orbit::{NoOrbit, Orbit};
use crate::switch::doubled;
use snapload::analysis::{OnProgress, Unfinished};

/// A branch of orbits.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Its points, from one end to the other.
    pub points: Vec<BranchPoint>,
    /// The events along it, in the same order.
    pub events: Vec<BranchEvent>,
    /// Its two ends.
    pub ends: [BranchEnd; 2],
}

impl Branch {
    /// The branch of an orbit in the first parameter, in both directions.
    ///
    /// # Errors
    /// A [`snapload::CaseError`] if the range or the step is not allowed;
    /// [`snapload::analysis::Cancelled`] if the work is cancelled.
    pub fn of<F: Family>(
        family: &F,
        orbit: &Orbit,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        check_followed(&[options.range], options.step)?;
        let continuation = Continuation {
            family,
            sequence: orbit.lap.sequence.clone(),
            phase: orbit.phase,
            periods: orbit.periods,
        };
        let start = Unknowns {
            z: orbit.z,
            durations: orbit.lap.durations.clone(),
            at: orbit.at,
        };
        let Some(up) = continuation.first_tangent(&start) else {
            let nowhere = || {
                HalfBranch::empty(
                    orbit.at[0],
                    "the equations do not determine a direction here",
                )
            };
            return Ok(joined(orbit, nowhere(), nowhere()));
        };
        let mut follower = Follower::new(options, on_progress);
        let first = Goal {
            sequence: continuation.sequence.clone(),
            at: start.clone(),
        };
        let down = -&up;
        let tested = follower.tested(&continuation, &start, &down, orbit);
        let mut backward = follower.run(&continuation, &start, &down, (orbit, tested), &first)?;
        let forward = if backward.closed {
            HalfBranch::empty(orbit.at[0], "the branch is closed")
        } else {
            // A limited number of points may end the first half before it is round.
            let last = backward.last.take().unwrap_or(first);
            // An event at the start itself belongs to the first half, if there is one.
            let tested = match backward.points.is_empty() {
                true => follower.tested(&continuation, &start, &up, orbit),
                false => Tested::new(orbit, &up),
            };
            follower.run(&continuation, &start, &up, (orbit, tested), &last)?
        };
        if forward.closed {
            backward.end.because.clone_from(&forward.end.because);
        }
        let mut branch = joined(orbit, backward, forward);
        if branch.points.len() == 1 && branch.events.is_empty() {
            // No step leads from here, as from a fold with its whole branch beyond the range.
            let kinds = Curve::KINDS.into_iter();
            branch.events = kinds
                .filter_map(|kind| BranchEvent::here(kind, orbit))
                .collect();
        }
        Ok(branch)
    }
}

impl Branch {
    /// Where it ends, and why.
    fn ends_in_words(&self) -> String {
        let [low, high] = &self.ends;
        let end = |end: &BranchEnd| format!("at {:.6}: {}", end.at, end.because);
        match low == high {
            true => end(low),
            false => format!("{}; and {}", end(low), end(high)),
        }
    }

    /// Of the events of a kind, the one that is nearest along the branch to the orbit with which it
    /// was started, or the one with a given number, counted from 1 in their order.
    ///
    /// # Errors
    /// [`NoOrbit`] lists the events that there are.
    pub fn event(&self, kind: Kind, number: Option<usize>) -> Result<&BranchEvent, NoOrbit> {
        let of_kind = |e: &&BranchEvent| e.kind == kind && e.between.is_none();
        let all: Vec<&BranchEvent> = self.events.iter().filter(of_kind).collect();
        let found = match number {
            Some(number) => number.checked_sub(1).and_then(|k| all.get(k).copied()),
            None => all
                .iter()
                .copied()
                .min_by(|a, b| a.arclength.abs().total_cmp(&b.arclength.abs())),
        };
        found.ok_or_else(|| {
            let name = match kind {
                Kind::NeimarkSacker => "Neimark-Sacker point".to_owned(),
                other => other.name().replace('_', " "),
            };
            let wanted = number.map_or(String::new(), |number| format!(" number {number}"));
            let values: Vec<String> = all.iter().map(|e| format!("{:.6}", e.value[0])).collect();
            NoOrbit(match values.len() {
                0 => format!("the branch has no {name}; it ends {}", self.ends_in_words()),
                count => format!(
                    "there is no {name}{wanted}: the branch has {count} in its range, at {}",
                    values.join(", ")
                ),
            })
        })
    }

    /// The branch of orbits of twice the length that begins at a period doubling; none if its
    /// direction is not found. Only one of its halves is followed, as the other is the same, one
    /// lap later.
    ///
    /// # Errors
    /// A [`snapload::CaseError`] if the range or the step is not allowed;
    /// [`snapload::analysis::Cancelled`] if the work is cancelled.
    pub fn of_doubling<F: Family>(
        family: &F,
        event: &BranchEvent,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Option<Self>, Unfinished> {
        check_followed(&[options.range], options.step)?;
        let Some((continuation, start, apart)) = doubled(family, event) else {
            return Ok(None);
        };
        let orbit = Orbit::of(&continuation.lap(start.at), &start.closed());
        let mut follower = Follower::new(options, on_progress);
        let doubled = HalfBranch::empty(orbit.at[0], "the period doubling");
        let first = Goal {
            sequence: continuation.sequence.clone(),
            at: start.clone(),
        };
        let tested = Tested::new(&orbit, &apart);
        let forward = follower.run(&continuation, &start, &apart, (&orbit, tested), &first)?;
        Ok(Some(joined(&orbit, doubled, forward)))
    }
}

fn joined(orbit: &Orbit, backward: HalfBranch, forward: HalfBranch) -> Branch {
    let turned = |mut p: BranchPoint| {
        p.arclength = -p.arclength;
        p
    };
    let mut points: Vec<_> = backward.points.into_iter().rev().map(turned).collect();
    points.push(point(orbit.clone(), 0.0));
    points.extend(forward.points);
    let turned = |mut event: BranchEvent| {
        event.arclength = -event.arclength;
        event
    };
    let mut events: Vec<_> = backward.events.into_iter().rev().map(turned).collect();
    events.extend(forward.events);
    Branch {
        points,
        events,
        ends: [backward.end, forward.end],
    }
}
