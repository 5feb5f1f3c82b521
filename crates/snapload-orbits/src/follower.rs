//! Follows a branch in one direction, step by step.

use crate::arrived::Arrived;
use crate::branch_events::{BranchEvent, Kind, Test, Tested, located};
use crate::continuation::{BranchStep, Continuation, Goal, SAME, Unknowns};
use crate::half_branch::{HalfBranch, SAME_VALUE, point};
use crate::hybrid::Family;
use crate::newton::{Closed, close};
use crate::orbit::Orbit;
use crate::roots::root;
use nalgebra::DVector;
use snapload::CaseError;
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

/// Refuses ranges that hold no numbers, and a step that leads nowhere.
pub(crate) fn check_followed(ranges: &[[f64; 2]], step: f64) -> Result<(), CaseError> {
    for [low, high] in ranges {
        if !(low.is_finite() && high.is_finite() && low <= high) {
            let allowed = "two finite numbers, the first not above the second";
            return Err(CaseError::value("range", format!("{low}:{high}"), allowed));
        }
    }
    check_step(step)
}

/// Refuses the length of a step that leads nowhere, or is too large.
pub(crate) fn check_step(step: f64) -> Result<(), CaseError> {
    if step > 0.0 && step <= 1.0 {
        return Ok(());
    }
    let allowed = "a number above 0, at most 1";
    Err(CaseError::value("step", step, allowed))
}

/// The longest and the shortest step, in units of the first.
const LONGEST_STEP: f64 = 6.0;
const SHORTEST_STEP: f64 = 1e-7;
/// From the first number of the corrector's iterations on, the next step is made shorter; up to the
/// second, longer.
const SHORTEN_FROM: usize = 5;
const LENGTHEN_TO: usize = 3;
/// An event that is not located lies between two points of no more
/// than this part of the first step.
const RESOLVED: f64 = 1e-3;
/// The end of an accumulation is located up to this part of the first step.
const CLOSED_IN: f64 = 1e-5;
/// So do two states.
const SAME_STATE: f64 = 1e-2;
/// The time between two events does not change by more than this in one step.
const LONGEST_TIME_CHANGE: f64 = 0.3;
/// A gap of more than this, by which a cable would have to be longer, ends a branch or a curve.
const LARGEST_GAP: f64 = 0.02;
pub(crate) const TOO_LONG: &str = "a cable would have to be longer by 0.02";
pub(crate) const CORNER: &str = "corner: at a snap another cable is at its full length, too; \
                                 beyond it the sequence is another one";
pub(crate) const END_OF_RANGE: &str = "the end of the range";
/// A direction whose part along the parameter is larger than this certainly leads
/// beyond a border on which it begins.
const LEAVES: f64 = 1e-6;
/// A value this close to the border of the range is set to the border.
const ON_BORDER: f64 = 1e-13;
/// One this close is searched for there.
const NEAR_BORDER: f64 = 1e-9;

/// The next point of a branch, its distance, and the number of the corrector's iterations.
struct Stepped {
    at: Unknowns,
    length: f64,
    steps: usize,
    direction: DVector<f64>,
    /// Why the branch ends there, if it does.
    end: Option<&'static str>,
}

/// Follows branches.
pub(crate) struct Follower<'a> {
    options: &'a BranchOptions,
    on_progress: OnProgress<'a>,
    done: usize,
}

impl<'a> Follower<'a> {
    pub(crate) fn new(options: &'a BranchOptions, on_progress: OnProgress<'a>) -> Self {
        Self {
            options,
            on_progress,
            done: 0,
        }
    }

    pub(crate) fn run<F: Family>(
        &mut self,
        continuation: &Continuation<F>,
        start: &Unknowns,
        tangent: &DVector<f64>,
        (orbit, mut tested): (&Orbit, Tested),
        goal: &Goal,
    ) -> Result<HalfBranch, Cancelled> {
        if self.leaves_range(start, tangent) {
            return Ok(HalfBranch::empty(orbit.at[0], END_OF_RANGE));
        }
        let mut continuation = continuation.clone();
        let (mut here, mut tangent) = (start.clone(), tangent.clone());
        let mut half = HalfBranch::empty(orbit.at[0], "");
        let mut step = self.options.step;
        let mut closes_in = false;
        while half.end.because.is_empty() && !half.is_full(self.options.most) {
            let Some((there, found)) = self.next(&continuation, &here, &tangent, step) else {
                step = self.halved(step, &mut half);
                continue;
            };
            let at = (&there.at, &there.direction);
            let arrived = Arrived::at(&continuation, at, found, &tested);
            if !arrived.orbit.accumulates_in_order() {
                (step, closes_in) = (0.5 * there.length, true);
                if step < self.options.step * CLOSED_IN {
                    half.end_with_accumulation();
                }
                continue;
            }
            let branch_step = BranchStep {
                continuation: &continuation,
                from: &here,
                tangent: &tangent,
                length: there.length,
            };
            if !self.take(&branch_step, &tested, &arrived, goal, &mut half) {
                step = 0.5 * there.length;
                continue;
            }
            if !half.end.because.is_empty() {
                break;
            }
            (continuation, here) = (arrived.continuation, arrived.here);
            (tangent, tested) = (arrived.tangent, arrived.tested);
            if there.length > 0.0 {
                half.points.push(point(arrived.orbit, half.arclength));
            }
            half.end.because = there.end.unwrap_or_default().to_owned();
            self.report()?;
            closes_in &= step > self.options.step * CLOSED_IN;
            step = self.next_step(step, there.steps, closes_in);
        }
        half.last = Some(Goal {
            sequence: continuation.sequence,
            at: here,
        });
        Ok(half)
    }

    /// Half of a step that is too long for Newton's method, and the end of the half where that is
    /// too short.
    fn halved(&self, step: f64, half: &mut HalfBranch) -> f64 {
        if 0.5 * step < self.options.step * SHORTEST_STEP {
            half.end.because = "Newton's method finds no further point".to_owned();
        }
        0.5 * step
    }

    /// The test functions at the start of a half; where one of them vanishes, the side behind it
    /// decides.
    pub(crate) fn tested<F: Family>(
        &self,
        continuation: &Continuation<F>,
        start: &Unknowns,
        tangent: &DVector<f64>,
        orbit: &Orbit,
    ) -> Tested {
        let tested = Tested::new(orbit, tangent);
        let back = -tangent;
        let step = |part: &f64| stepped(continuation, start, &back, self.options.step * part);
        match [1.0, 0.1, 0.01].iter().find_map(step) {
            Some((at, _, direction)) => {
                let found = Orbit::of(&continuation.lap(at.at), &at.closed());
                tested.reached_from(&Tested::new(&found, &(-direction)))
            }
            None => tested,
        }
    }

    fn report(&mut self) -> Result<(), Cancelled> {
        self.done += 1;
        let of = (2 * self.options.most) as f64;
        Progress::new("points", self.done as f64, of).report(self.on_progress)
    }

    /// Whether a half begins on a border of the range and leads beyond it.
    fn leaves_range(&self, start: &Unknowns, tangent: &DVector<f64>) -> bool {
        let ([low, high], along) = (self.options.range, tangent[tangent.len() - 1]);
        (start.at[0] <= low && along < -LEAVES) || (start.at[0] >= high && along > LEAVES)
    }

    /// The next point with its orbit. If a cable would have to be too long there, it is the point
    /// from which on that is so.
    fn next<F: Family>(
        &self,
        continuation: &Continuation<F>,
        here: &Unknowns,
        tangent: &DVector<f64>,
        step: f64,
    ) -> Option<(Stepped, Orbit)> {
        let mut there = self.stepped(continuation, here, tangent, step)?;
        let orbit = |u: &Unknowns| Orbit::of(&continuation.lap(u.at), &u.closed());
        let found = orbit(&there.at);
        let after = beyond_largest_gap(&found);
        if after <= 0.0 {
            return Some((there, found));
        }
        let of = |sigma: f64| {
            let at = continuation.corrected(here, tangent, sigma);
            at.map_or(f64::NAN, |(u, ..)| beyond_largest_gap(&orbit(&u)))
        };
        let before = beyond_largest_gap(&orbit(here));
        there.length = match before < 0.0 {
            true => root(&of, (0.0, before), (there.length, after)),
            false => 0.0,
        };
        (there.at, _, there.direction) = continuation.corrected(here, tangent, there.length)?;
        there.end = Some(TOO_LONG);
        let found = orbit(&there.at);
        Some((there, found))
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
            end: (beyond(&at) != 0.0).then_some(END_OF_RANGE),
            at,
            length: step,
            steps,
            direction,
        };
        if there.end.is_some() {
            let of = |sigma: f64| {
                let found = continuation.corrected(here, tangent, sigma);
                found.map_or(f64::NAN, |(u, ..)| beyond(&u))
            };
            there.length = match beyond(here) {
                0.0 => 0.0,
                before => root(&of, (0.0, before), (step, beyond(&there.at))),
            };
            (there.at, _, there.direction) = continuation.corrected(here, tangent, there.length)?;
            there.at = on_border(continuation, there.at, border)?;
        }
        Some(there)
    }

    /// The length of the next step, from the number of the corrector's iterations, or on the way to
    /// where an accumulation ends.
    fn next_step(&self, step: f64, steps: usize, closes_in: bool) -> f64 {
        match steps {
            _ if closes_in => 0.5 * step,
            SHORTEN_FROM.. => step * 0.6,
            0..=LENGTHEN_TO => (step * 1.4).min(self.options.step * LONGEST_STEP),
            _ => step,
        }
    }

    /// The events between two points in their order, up to one that ends the branch; none if a
    /// shorter step may show an event that this one passes over.
    fn events<F: Family>(
        &self,
        branch_step: &BranchStep<F>,
        [before, after]: [&Tested; 2],
        beyond: &Orbit,
    ) -> Option<Vec<BranchEvent>> {
        let changed = || before.changed(after);
        let located = changed().filter_map(|(test, a, b)| located(branch_step, test, a, b));
        let mut found: Vec<BranchEvent> = located.collect();
        found.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
        if let Some(last) = found.iter().position(BranchEvent::ends_branch) {
            found.truncate(last + 1);
        }
        let crosses = |event: &BranchEvent| event.kind == Kind::BranchPoint;
        if let Some(crossing) = found.iter().find(|event| crosses(event)).cloned() {
            // A branch that turns back where another crosses it has no fold there.
            found.retain(|event| event.kind != Kind::Fold || !is_same(event, &crossing));
        }
        let end = found.last().filter(|event| event.ends_branch());
        let resolved = branch_step.length <= self.options.step * RESOLVED;
        if end.is_some_and(|end| end.kind == Kind::Graze) {
            // The branch ends where the multipliers are infinite.
            return Some(found);
        }
        let multipliers = &end.map_or(beyond, |end| &end.orbit).multipliers;
        let passed_over = before
            .stability_changes(multipliers)
            .filter(|_| !found.iter().any(BranchEvent::is_bifurcation));
        let not_crossed = end.is_none()
            && !found.iter().any(crosses)
            && changed().any(|(test, ..)| test == Test::BranchPoint);
        if (passed_over.is_some() || not_crossed) && !resolved {
            return None;
        }
        if let Some(kind) = passed_over {
            let mut event = BranchEvent::plain(kind, beyond.clone(), branch_step.length);
            event.between = Some([branch_step.from.at[0], beyond.at[0]]);
            let place =
                found.len() - usize::from(found.last().is_some_and(BranchEvent::ends_branch));
            found.insert(place, event);
        }
        Some(found)
    }

    /// Takes the events of a step, and ends the branch where one of them or its goal does; false if
    /// the step has to be shorter.
    fn take<F: Family>(
        &self,
        step: &BranchStep<F>,
        before: &Tested,
        to: &Arrived<F>,
        goal: &Goal,
        half: &mut HalfBranch,
    ) -> bool {
        let Some(events) = self.events(step, [before, &to.tested], &to.orbit) else {
            return false;
        };
        let closes = step.passes(goal);
        let [low, high] = self.options.range;
        half.end.at = to.orbit.at[0];
        for mut event in events {
            if closes.is_some_and(|sigma| event.sigma >= sigma - SAME) {
                break;
            }
            event.arclength = half.arclength + event.sigma;
            if event.ends_branch() {
                half.end.at = event.value[0];
                half.end.because = match event.kind {
                    Kind::Corner => CORNER,
                    _ => "graze: a snap of the sequence has zero velocity here, and a negative one beyond it",
                }
                .to_owned();
            }
            // An event on a border is located up to rounding.
            let border = event.value[0].clamp(low, high);
            if (event.value[0] - border).abs() <= ON_BORDER * border.abs().max(1.0) {
                half.events.push(event);
            }
        }
        if let Some(sigma) = closes.filter(|_| half.end.because.is_empty()) {
            half.close(goal, sigma, step.continuation);
        }
        half.arclength += step.length;
        true
    }
}

/// A point that is on a border up to rounding, just there; none if it is not. Where the unknowns
/// are known worse, as those of an accumulation are, the orbit is found for the border's value.
fn on_border<F: Family>(
    continuation: &Continuation<F>,
    near: Unknowns,
    border: f64,
) -> Option<Unknowns> {
    let (off, size) = ((near.at[0] - border).abs(), border.abs().max(1.0));
    let at = [border, near.at[1]];
    if off <= ON_BORDER * size {
        return Some(Unknowns { at, ..near });
    }
    let found = close(&continuation.lap(at), &near.z, &near.durations);
    let Closed { z, durations, .. } = found.filter(|_| off <= NEAR_BORDER * size)?;
    Some(Unknowns { z, durations, at })
}

/// By how much the gap of a cable is larger than the largest one allowed.
pub(crate) fn beyond_largest_gap(orbit: &Orbit) -> f64 {
    orbit.survey.largest_gap.map_or(0.0, |gap| gap.value) - LARGEST_GAP
}

fn is_same(event: &BranchEvent, other: &BranchEvent) -> bool {
    (event.value[0] - other.value[0]).abs() < SAME_VALUE
        && crate::distance(&event.orbit.z, &other.orbit.z) < SAME_STATE
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
