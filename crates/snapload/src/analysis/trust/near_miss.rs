//! Where a cable that stays slack comes within the neighbours' reach of being taut.

use crate::analysis::trust::covariance::SIGMA_REACH;
use crate::analysis::trust::neighbours::{Approach, Neighbours, Spread};
use crate::analysis::trust::uncertain_key::reach_by;
use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::cable::{Cable, Normal};
use crate::model::state::State;
use crate::motion::events::Reached;
use crate::motion::simulation::{GapAt, Simulation, SlackGap, Step};
use crate::motion::step_map::join;

/// When a cable that was closed at the start comes near is found by so many trials at
/// most, each with the neighbours' reach at the instant found by the one before, until it
/// is within this part of the step.
const TRIALS: usize = 16;
const SAME_INSTANT: f64 = 1e-3;
/// A step in which another cable comes near is searched in so many parts. The neighbours' reach
/// within a part is what lies on the line between those at its ends: at most that much for
/// deviations that drift, as their reach along one direction is a convex function of time, and by
/// an uncertain parameter at most what `UncertainKey::of_gap_between` adds.
const PARTS_OF_STEP: usize = 64;

/// A slack cable in a step.
struct Slack<'a> {
    simulation: &'a Simulation,
    step: &'a Step,
    approach: &'a Approach,
    neighbours: &'a Neighbours<'a>,
    cable: usize,
    /// How much its gap changes per displacement of its end along the normal, at most.
    per_place: f64,
    /// Whether it was open at the start of the step.
    was_open: bool,
}

/// The gap of a slack cable a time into a step, by the best instructions for it.
struct At<'a>(&'a Slack<'a>, &'a SlackGap<'a, f64>, f64);

impl Kernel for At<'_> {
    type Output = GapAt<f64>;
    #[inline(always)]
    fn run(self) -> GapAt<f64> {
        let Self(slack, gap, s) = self;
        let (value, rate) = gap.gap_and_rate(s);
        GapAt {
            s,
            gap: value,
            rate,
            margin: slack.margin(gap, s),
        }
    }
}

/// When a slack cable first comes within the neighbours' reach of being taut, if it does: along the
/// stretch, unless it has been open since the start, or at the event at its end, which is at
/// another time for each neighbour, unless it closes there in all of them.
#[inline(always)]
pub(super) fn may_snap(
    simulation: &Simulation,
    step: &Step,
    approach: &Approach,
    neighbours: &Neighbours,
    cable: usize,
) -> Option<f64> {
    let Neighbours {
        before, along, met, ..
    } = neighbours;
    let tether = &simulation.system().cables[cable];
    let slack = Slack {
        simulation,
        step,
        approach,
        neighbours,
        cable,
        per_place: 2.0 * tether.length(),
        was_open: simulation.contact_at_start(step, cable).gap < 0.0,
    };
    let closes = step.event.closed.contains(cable);
    let near_at_end = |margin: f64| !closes && simulation.contact(cable).gap > -margin;
    // A bound first: |n| = 1, and the arm is no longer than the lever.
    let [a, b] = tether.fairlead().components();
    let slopes = [1.0, 1.0, a.abs() + b.abs(), 0.0, 0.0, 0.0];
    let at_start = slack.reach_from_start(before);
    let at_end = along.parts_at_most(&slopes).max(met.parts_at_most(&slopes));
    let by_keys = reach_by(neighbours.keys, |key| key.of_gap_within(cable));
    let most = slack.per_place * at_end.max(at_start) + by_keys;
    // So is what is known of a bounce.
    let bounced = simulation.bounced(step).filter(|_| closes);
    if bounced.is_some_and(|bounced| bounced.is_open_before_last_rise(most * most)) {
        return None;
    }
    let open = neighbours.opening.contains(cable);
    if open && step.event.reached == Reached::default() {
        return None;
    }
    let near = match open || simulation.stays_away(step, cable, most) {
        true => None,
        false => slack.near_within(most),
    };
    if near.is_none() && !near_at_end(most) {
        return None;
    }
    let near = near.flatten();
    let Normal { n, arm } = tether.normal(&step.before);
    let direction = [n.x, n.y, arm, 0.0, 0.0, 0.0, 0.0];
    let by_parts = along
        .reach_of_parts(&direction)
        .max(met.reach_of_parts(&direction));
    let by_keys = reach_by(neighbours.keys, |key| key.of_gap_at_end(cable));
    let at_end = (slack.per_place * by_parts).hypot(by_keys);
    let at_end = near_at_end(at_end).then_some(step.t_end);
    near.map(|s| (step.t_start + s).min(step.t_end)).or(at_end)
}

impl Slack<'_> {
    #[inline(always)]
    fn duration(&self) -> f64 {
        self.step.t_end - self.step.t_start
    }

    /// Whether the cable comes near by a bound on the neighbours' reach, and if so, when it first
    /// comes within their reach itself, if it does.
    #[inline(always)]
    fn near_within(&self, most: f64) -> Option<Option<f64>> {
        let gap = self.simulation.slack_gap(self.step, self.cable);
        let first = gap.comes_near(most)?;
        Some(match self.was_open {
            true => self.first_near(&gap),
            false => self.first_near_since_closed(&gap, first),
        })
    }

    /// When the gap of a cable that was open at the start is first within the neighbours' reach:
    /// part by part, up to the last rise of the gap if the cable closes at the end.
    #[inline(always)]
    fn first_near(&self, gap: &SlackGap<f64>) -> Option<f64> {
        let at = |s: f64| dispatch(At(self, gap, s));
        let (start, last) = (at(0.0), gap.last_rise(at));
        let raised = |at: &GapAt<f64>, more: f64| GapAt {
            margin: at.margin + more,
            ..*at
        };
        if self.neighbours.keys.is_empty() {
            // A bound first: the whole step as one part, in which the normal turns.
            let turning = self.per_place * self.turning(&self.neighbours.before);
            gap.comes_near_between([&raised(&start, turning), &raised(&last, turning)])?;
        }
        let between = self.between();
        let mut before = raised(&start, between);
        // A loop, as a closure of an iterator would not have the processor's own instructions.
        for k in 1..=PARTS_OF_STEP {
            let part = k as f64 / PARTS_OF_STEP as f64;
            let next = raised(&at(last.s * part), between);
            if let Some(near) = gap.comes_near_between([&before, &next]) {
                return Some(near);
            }
            before = next;
        }
        None
    }

    /// The same for a cable that was closed at the start, for all neighbours, whose gaps spread
    /// from zero in proportion to time.
    #[inline(always)]
    fn first_near_since_closed(&self, gap: &SlackGap<f64>, first: f64) -> Option<f64> {
        let duration = self.duration();
        let in_proportion = |k: usize| {
            let part = k as f64 / PARTS_OF_STEP as f64;
            let keys = self.neighbours.keys;
            reach_by(keys, |key| key.of_gap(self.cable, part * duration)) / part
        };
        let by_keys = match self.neighbours.keys {
            [] => 0.0,
            // By the bound M w²/8 on what a part of length w adds, most is added per time in the
            // first part, where it begins from zero: M w/2.
            _ => {
                let largest = (1..=PARTS_OF_STEP).map(in_proportion).fold(0.0, f64::max);
                largest + 4.0 * PARTS_OF_STEP as f64 * self.between()
            }
        };
        let mut near = Some(first);
        for _ in 0..TRIALS {
            let Some(s) = near else {
                break;
            };
            let by_parts = self.per_place * self.reach_of_parts(gap, s);
            near = gap.comes_near(by_parts.hypot(by_keys));
            let moved = near.map_or(0.0, |next| (next - s).abs());
            if moved <= SAME_INSTANT * duration {
                break;
            }
        }
        near
    }

    /// By how much the uncertain parameters may move a gap further within a part of the step than
    /// at its ends.
    fn between(&self) -> f64 {
        let keys = self.neighbours.keys;
        reach_by(keys, |key| key.of_gap_between(self.cable, PARTS_OF_STEP))
    }

    /// How far the gaps of neighbours exceed that of the run a time `s` into the step.
    #[inline(always)]
    fn margin(&self, gap: &SlackGap<f64>, s: f64) -> f64 {
        let by_keys = reach_by(self.neighbours.keys, |key| key.of_gap(self.cable, s));
        (self.per_place * self.reach_of_parts(gap, s)).hypot(by_keys)
    }

    /// A bound on how far neighbours that drift from `before` to the run reach along the
    /// normal of a cable within a step, by their start and by rounding: each just after its
    /// own event, along the normal there. If the cable is closed at the start it is so for
    /// all, and their gaps spread from zero.
    #[inline(always)]
    fn reach_from_start(&self, before: &Spread) -> f64 {
        if !self.was_open {
            return 0.0;
        }
        let Normal { n, arm } = self.tether().normal(&self.step.start);
        before.reach_of_parts(&[n.x, n.y, arm, 0.0, 0.0, 0.0, 0.0]) + self.turning(before)
    }

    /// What the turning of the normal adds to that: it turns by at most the way over the cable's
    /// length, and the lever by the body's rotation, both from zero on, while neighbours come
    /// nearer in proportion to time. A quarter of that counts at most.
    #[inline(always)]
    fn turning(&self, before: &Spread) -> f64 {
        let lever = self.tether().fairlead().length();
        let (first, last, s) = (&self.step.start, &self.step.before, self.duration());
        let speed = |at: &State| at.velocity().length() + at.vtheta.abs() * lever;
        let turned = 0.25 * s * (speed(first) + speed(last)) / self.tether().length();
        let swung = turned + 0.25 * s * (first.vtheta.abs() + last.vtheta.abs());
        before.parts_at_most(&[turned, turned, swung * lever, 0.0, 0.0, 0.0])
    }

    #[inline(always)]
    fn tether(&self) -> &Cable {
        &self.simulation.system().cables[self.cable]
    }

    /// How far neighbours reach along the normal of the cable a time `s` into the step, by their
    /// start and by rounding. In a free flight, in which these deviations only drift, with the
    /// normal there; if the cable was closed at the start, what they reach at the end if it grows
    /// in proportion to time. Otherwise at the start and at the end, each with the normal there.
    #[inline(always)]
    fn reach_of_parts(&self, gap: &SlackGap<f64>, s: f64) -> f64 {
        let Neighbours { before, along, .. } = self.neighbours;
        let (tether, end) = (self.tether(), &self.step.before);
        let reach = |spread: &Spread, at: &State| {
            let Normal { n, arm } = tether.normal(at);
            spread.reach_of_parts(&[n.x, n.y, arm, 0.0, 0.0, 0.0, 0.0])
        };
        let is_flight = self.simulation.system().flies_freely(self.step.taut);
        if !is_flight || s == 0.0 && !self.was_open {
            let at_end = reach(along, end);
            return match self.was_open {
                true => at_end.max(reach(before, &self.step.start)),
                false => at_end,
            };
        }
        let now = gap.state(s);
        let (Normal { n, arm }, left) = (tether.normal(&now), self.duration() - s);
        let [.., x, y, _] = self.approach.rate;
        let later = n.x * (now.vx - end.vx + left * x) + n.y * (now.vy - end.vy + left * y);
        let place = [n.x, n.y, arm];
        let [by_vx, by_vy, by_spin] = place.map(|slope| -left * slope);
        let direction = join(&[n.x, n.y, arm, by_vx, by_vy, by_spin], later);
        let reach = SIGMA_REACH * along.covariance.variance_of_parts(&direction).sqrt();
        match self.was_open {
            true => reach,
            false => reach * (s + left) / s,
        }
    }
}
