//! Branches: an orbit as a parameter changes, with the bifurcations and other events along it.

use crate::branch_events::{BranchEvent, Kind, Test, located, tests_of};
use crate::continuation::{BranchStep, Continuation, Unknowns};
use crate::hybrid::{Family, Point};
use crate::orbit::{NoOrbit, Orbit};
use crate::survey::root;
use crate::switch::doubled;
use nalgebra::DVector;
use snapload::analysis::{Cancelled, OnProgress, Progress};

/// How a branch is followed.
#[derive(Clone, Copy, Debug)]
pub struct BranchOptions {
    /// The least and the greatest value of the parameter.
    pub range: [f64; 2],
    /// The length of the first step, in the space of state, times and parameter.
    pub step: f64,
    /// The most points in either direction.
    pub most: usize,
}

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

/// The longest and the shortest step, in units of the first.
const LONGEST_STEP: f64 = 6.0;
const SHORTEST_STEP: f64 = 1e-7;
/// From the first number of the corrector's iterations on, the next step is made shorter; up to the
/// second, longer.
const SHORTEN_FROM: usize = 5;
const LENGTHEN_TO: usize = 3;
/// The time between two events does not change by more than this in one step.
const LONGEST_TIME_CHANGE: f64 = 0.3;
/// A gap of more than this, by which a cable would have to be longer, ends a branch.
const LARGEST_GAP: f64 = 0.02;
/// A branch that returns to its first point within this part of its step is closed.
const CLOSED_WITHIN: f64 = 0.5;
/// A closed branch is at least this many steps long.
const CLOSED_AFTER: f64 = 10.0;
/// A value this close to the border of the range is set to the border.
const ON_BORDER: f64 = 1e-13;

impl Branch {
    /// The branch of an orbit in the first parameter, in both directions.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    pub fn of<F: Family>(
        family: &F,
        orbit: &Orbit,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Self, Cancelled> {
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
            let end = BranchEnd {
                at: orbit.at[0],
                because: "the equations do not determine a direction here".to_owned(),
            };
            return Ok(Self {
                points: vec![point(orbit.clone(), 0.0)],
                events: Vec::new(),
                ends: [end.clone(), end],
            });
        };
        let mut follower = Follower {
            options,
            on_progress,
            done: 0,
        };
        let backward = follower.run(&continuation, &start, &(-&up), orbit)?;
        let forward = if backward.closed {
            HalfBranch::empty(orbit.at[0], "the branch is closed")
        } else {
            follower.run(&continuation, &start, &up, orbit)?
        };
        Ok(joined(orbit, backward, forward))
    }
}

impl Branch {
    /// Of the events of a kind, the one that is nearest along the branch to the orbit with which it
    /// was started, or the one with a given number, counted from 1 in their order.
    ///
    /// # Errors
    /// [`NoOrbit`] lists the events that there are.
    pub fn event(&self, kind: Kind, number: Option<usize>) -> Result<&BranchEvent, NoOrbit> {
        let all: Vec<&BranchEvent> = self.events.iter().filter(|e| e.kind == kind).collect();
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
                0 => format!("the branch has no {name} in its range; use a wider range"),
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
    /// [`Cancelled`] if the work is cancelled.
    pub fn of_doubling<F: Family>(
        family: &F,
        event: &BranchEvent,
        options: &BranchOptions,
        on_progress: OnProgress,
    ) -> Result<Option<Self>, Cancelled> {
        let Some((continuation, start, apart)) = doubled(family, event) else {
            return Ok(None);
        };
        let orbit = Orbit::of(&continuation.lap(start.at), &start.closed());
        let mut follower = Follower {
            options,
            on_progress,
            done: 0,
        };
        let doubled = HalfBranch::empty(orbit.at[0], "the period doubling");
        let forward = follower.run(&continuation, &start, &apart, &orbit)?;
        Ok(Some(joined(&orbit, doubled, forward)))
    }
}

fn point(orbit: Orbit, arclength: f64) -> BranchPoint {
    BranchPoint { orbit, arclength }
}

/// The branch in one direction.
struct HalfBranch {
    points: Vec<BranchPoint>,
    events: Vec<BranchEvent>,
    end: BranchEnd,
    closed: bool,
}

impl HalfBranch {
    fn empty(at: f64, because: &str) -> Self {
        Self {
            points: Vec::new(),
            events: Vec::new(),
            end: BranchEnd {
                at,
                because: because.to_owned(),
            },
            closed: false,
        }
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

/// The next point of a branch, its distance, and the number of the corrector's iterations.
struct Stepped {
    at: Unknowns,
    length: f64,
    steps: usize,
    direction: DVector<f64>,
    /// Whether it is on the border of the range.
    is_last: bool,
}

/// Follows branches.
struct Follower<'a> {
    options: &'a BranchOptions,
    on_progress: OnProgress<'a>,
    done: usize,
}

impl Follower<'_> {
    fn run<F: Family>(
        &mut self,
        continuation: &Continuation<F>,
        start: &Unknowns,
        tangent: &DVector<f64>,
        orbit: &Orbit,
    ) -> Result<HalfBranch, Cancelled> {
        let mut continuation = continuation.clone();
        let (mut here, mut tangent) = (start.clone(), tangent.clone());
        let mut tests = tests_of(orbit, &tangent);
        let mut half = HalfBranch::empty(orbit.at[0], "");
        let (mut step, mut arclength) = (self.options.step, 0.0);
        while half.end.because.is_empty() {
            if half.points.len() >= self.options.most {
                half.end.because = format!("the limit of {} points is reached", self.options.most);
                break;
            }
            let Some(there) = self.stepped(&continuation, &here, &tangent, step) else {
                step *= 0.5;
                if step < self.options.step * SHORTEST_STEP {
                    half.end.because = "Newton's method finds no further point".to_owned();
                }
                continue;
            };
            let found = Orbit::of(&continuation.lap(there.at.at), &there.at.closed());
            let reached = tests_of(&found, &there.direction);
            let branch_step = BranchStep {
                continuation: &continuation,
                from: &here,
                tangent: &tangent,
                length: there.length,
            };
            let ended = self.take_events(&branch_step, [&tests, &reached], arclength, &mut half);
            arclength += there.length;
            let ended = ended.or_else(|| {
                half.end.at = found.at[0];
                self.reason_to_end(&found, arclength, start, orbit)
            });
            if let Some(because) = ended {
                half.closed = because.contains("closed");
                half.end.because = because;
                break;
            }
            (here, tangent, tests) = (there.at, there.direction, reached);
            let renumbered = renumber_events(&mut continuation, &mut here, &mut tangent);
            if there.length > 0.0 {
                half.points
                    .push(point(renumbered.unwrap_or(found), arclength));
            }
            if there.is_last {
                half.end.because = "the end of the range".to_owned();
            }
            self.done += 1;
            let of = (2 * self.options.most) as f64;
            Progress::new("points", self.done as f64, of).report(self.on_progress)?;
            step = self.next_step(step, there.steps);
        }
        Ok(half)
    }

    /// The next point, if the corrector finds one near enough; it is on the border of the range if
    /// the step would pass that.
    fn stepped<F: Family>(
        &self,
        continuation: &Continuation<F>,
        here: &Unknowns,
        tangent: &DVector<f64>,
        step: f64,
    ) -> Option<Stepped> {
        let (at, steps, direction) = stepped(continuation, here, tangent, step)?;
        let [low, high] = self.options.range;
        let border = at.at[0].clamp(low, high);
        let beyond = |u: &Unknowns| u.at[0] - border;
        let mut there = Stepped {
            is_last: beyond(&at) != 0.0,
            at,
            length: step,
            steps,
            direction,
        };
        if there.is_last {
            let of = |sigma: f64| {
                let found = continuation.corrected(here, tangent, sigma);
                found.map_or(f64::NAN, |(u, ..)| beyond(&u))
            };
            there.length = match beyond(here) {
                0.0 => 0.0,
                before => root(&of, (0.0, before), (step, beyond(&there.at))),
            };
            (there.at, _, there.direction) = continuation.corrected(here, tangent, there.length)?;
            if beyond(&there.at).abs() > ON_BORDER * border.abs().max(1.0) {
                return None;
            }
            there.at.at[0] = border;
        }
        Some(there)
    }

    /// The length of the next step, from the number of the corrector's iterations.
    fn next_step(&self, step: f64, steps: usize) -> f64 {
        match steps {
            SHORTEN_FROM.. => step * 0.6,
            0..=LENGTHEN_TO => (step * 1.4).min(self.options.step * LONGEST_STEP),
            _ => step,
        }
    }

    /// Locates the events between two points; returns why the branch ends there, if it does.
    fn take_events<F: Family>(
        &self,
        branch_step: &BranchStep<F>,
        [before, after]: [&[(Test, f64)]; 2],
        arclength: f64,
        half: &mut HalfBranch,
    ) -> Option<String> {
        let mut found: Vec<BranchEvent> = Vec::new();
        for ((test, a), (_, b)) in before.iter().zip(after) {
            if a.is_finite() && b.is_finite() && (*a < 0.0) != (*b < 0.0) {
                found.extend(located(branch_step, *test, *a, *b));
            }
        }
        let [low, high] = self.options.range;
        found.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
        for mut event in found {
            event.arclength = arclength + event.sigma;
            let within = (low..=high).contains(&event.value[0]);
            let (kind, virtually) = (event.kind, event.is_own_snap);
            if within {
                half.events.push(event.clone());
            }
            if kind == Kind::Corner || (kind == Kind::Graze && virtually) {
                half.end.at = event.value[0];
                return Some(match kind {
                    Kind::Corner => "corner: two cables snap at once, and come in the other order beyond it",
                    _ => "graze: a snap of the sequence has zero velocity here, and a negative one beyond it",
                }
                .to_owned());
            }
        }
        None
    }

    /// Why a branch ends at a point that it has reached.
    fn reason_to_end(
        &self,
        found: &Orbit,
        arclength: f64,
        start: &Unknowns,
        first: &Orbit,
    ) -> Option<String> {
        let gap = found.survey.largest_gap.map_or(0.0, |gap| gap.value);
        if gap > LARGEST_GAP {
            return Some(format!("a cable would have to be longer by {LARGEST_GAP}"));
        }
        let near = |z: &Point| crate::distance(z, &start.z);
        let same = found.lap.sequence == first.lap.sequence;
        let back = near(&found.z).max((found.at[0] - start.at[0]).abs());
        (arclength > CLOSED_AFTER * self.options.step
            && same
            && back < CLOSED_WITHIN * self.options.step)
            .then(|| "the branch is closed".to_owned())
    }
}

/// Renumbers the events if one has passed the section; returns the orbit then.
fn renumber_events<F: Family>(
    continuation: &mut Continuation<F>,
    here: &mut Unknowns,
    tangent: &mut DVector<f64>,
) -> Option<Orbit> {
    let mut orbit = None;
    while let Some((moved, renumbered, shift)) = continuation.renumbered(here) {
        *tangent = moved.tangent_after(&renumbered, tangent, shift)?;
        (*continuation, *here) = (moved, renumbered);
        orbit = Some(Orbit::of(&continuation.lap(here.at), &here.closed()));
    }
    orbit
}

/// The next point, if the corrector finds one near enough, and the direction there.
fn stepped<F: Family>(
    continuation: &Continuation<F>,
    here: &Unknowns,
    tangent: &DVector<f64>,
    step: f64,
) -> Option<(Unknowns, usize, DVector<f64>)> {
    let (next, steps, direction) = continuation.corrected(here, tangent, step)?;
    let moved = here.durations.iter().zip(&next.durations);
    let most = moved.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let off = here.distance(&next);
    let turned = direction.dot(tangent);
    (most < LONGEST_TIME_CHANGE && off <= 2.0 * step && turned > 0.9)
        .then_some((next, steps, direction))
}
