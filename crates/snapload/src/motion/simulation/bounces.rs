//! The steps of a motion that are bounces, computed here or in a lane.

use crate::arithmetic::plane::Rotation;
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::taut_set::TautSet;
use crate::motion::bounce::{Bounce, bounce, highest_point};
use crate::motion::bounce_map::Bounced;
use crate::motion::contact::Contact;
use crate::motion::events::Reached;
use crate::motion::extremes::Extremes;
use crate::motion::impact::ImpactResult;
use crate::motion::simulation::event_laws::Standing;
use crate::motion::simulation::{Event, Progress, Simulation, Step};
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

impl<T: Real> Simulation<T> {
    /// The bounce that the motion makes next, if it is one. [`bounce`] receives the same numbers
    /// here and in a lane, so that a step is a bounce in both or in neither.
    #[inline(always)]
    pub(super) fn next_bounce(&mut self) -> Option<Bounce<T>> {
        (self.bounce_start, self.facts) = (None, None);
        let rotation = self.rotation.take();
        let from = self.after_impact(rotation)?;
        let bounce = bounce(self.two_cables.as_ref()?, &from);
        if bounce.arrived {
            self.bounce_start = Some(from);
        }
        bounce.arrived.then_some(bounce)
    }

    /// The motion in the form of [`bounce`], given its rotation if that is known; none if a cable
    /// is taut or at rest.
    #[inline(always)]
    fn after_impact(&self, rotation: Option<Rotation<T>>) -> Option<AfterImpact<T>> {
        let [first, second, ..] = &self.contacts;
        if !self.active.taut.is_empty() || first.resting || second.resting {
            return None;
        }
        Some(AfterImpact {
            t: self.t,
            state: self.state,
            rotation: rotation.unwrap_or_else(|| Rotation::by(self.state.theta)),
            before: [self.before.vx, self.before.vy, self.before.vtheta],
            gaps: [[first.gap, first.error], [second.gap, second.error]],
            y_max: self.extremes.y_max,
            theta_max: self.extremes.theta_max,
        })
    }

    /// The data that a lane needs to continue the motion; none if it does not fly freely now.
    pub(crate) fn lane_start(&self) -> Option<(&TwoCableSystem<T>, AfterImpact<T>)> {
        Some((self.two_cables.as_ref()?, self.after_impact(self.rotation)?))
    }

    /// The impacts so far.
    pub(crate) fn progress(&self) -> Progress<T> {
        Progress {
            impacts: self.impacts,
            last: self.last,
        }
    }

    /// Continues after bounces that were made in a lane.
    pub(crate) fn resume(&mut self, after_impact: &AfterImpact<T>, progress: Progress<T>) {
        if after_impact.t > self.t {
            self.standing = Standing::default();
        }
        self.t = after_impact.t;
        self.state = after_impact.state;
        self.rotation = Some(after_impact.rotation);
        let [vx, vy, vtheta] = after_impact.before;
        self.before = State {
            vx,
            vy,
            vtheta,
            ..after_impact.state
        };
        self.set_known_gaps(&after_impact.gaps);
        self.extremes = Extremes {
            y_max: after_impact.y_max,
            theta_max: after_impact.theta_max,
        };
        if progress.impacts > self.impacts {
            self.end_slow_row();
        }
        self.impacts = progress.impacts;
        self.last = progress.last;
    }

    /// The latest step, if it was a bounce and nothing more.
    #[inline(always)]
    pub(crate) fn bounced<'a>(&'a self, step: &'a Step<T>) -> Option<Bounced<'a, T>> {
        let (two_cables, from) = (self.two_cables.as_ref()?, self.bounce_start.as_ref()?);
        let (facts, result) = (self.facts.as_ref()?, step.result.as_ref()?);
        let struck = step.event.closed.iter().next()?;
        let Contact { gap, error, .. } = self.contacts[1 - struck];
        Some(Bounced {
            two_cables,
            from,
            t: step.t_end,
            second: struck == 1,
            before: &step.before,
            after: &step.after,
            v_n: result.v_before[struck],
            impulse: result.impulse[struck],
            other_gap: [gap, error],
            facts,
        })
    }

    fn set_known_gaps(&mut self, gaps: &[[T; 2]; 2]) {
        for (contact, [gap, error]) in self.contacts.iter_mut().zip(*gaps) {
            *contact = Contact {
                gap,
                error,
                resting: false,
            };
        }
    }

    /// Makes a bounce: moves to its end. The result is none if the law is still to be applied,
    /// because more than one cable's impulse follows. The step is written in place, as it is large.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        bounce: &Bounce<T>,
        result: &mut Option<ImpactResult<T>>,
    ) -> Event {
        apart!(T, {
            let next = &bounce.next;
            self.cover(bounce);
            self.t = next.t;
            self.before = bounce.before;
            let struck = usize::from(bounce.second);
            self.set_known_gaps(&next.gaps);
            let closed = TautSet::only(struck);
            let reached = Reached {
                gaps: closed,
                ..Reached::default()
            };
            let event = Event {
                reached,
                closed,
                still: TautSet::SLACK,
            };
            if !bounce.plain {
                self.state = bounce.before;
                return event;
            }
            self.state = next.state;
            self.rotation = Some(next.rotation);
            self.facts = Some(bounce.facts);
            self.end_slow_row();
            let found = result.insert(ImpactResult::of_one(
                struck,
                [bounce.v_n, bounce.v_after],
                bounce.impulse,
                next.state,
            ));
            self.count(found, closed);
            event
        })
    }

    /// Includes the flight of a bounce in the extremes.
    #[inline(always)]
    fn cover(&mut self, bounce: &Bounce<T>) {
        if !bounce.top_known {
            self.cover_top(bounce.s);
        }
        self.extremes.y_max = self.extremes.y_max.max(bounce.next.y_max);
        self.extremes.theta_max = self.extremes.theta_max.max(bounce.next.theta_max);
    }

    /// Searches the flight of a bounce, of length `s`, for a highest point. Rare, and apart from
    /// the bounce, the numbers of which would otherwise have to be in memory.
    #[cold]
    #[inline(never)]
    fn cover_top(&mut self, s: T) {
        if let (Some(two_cables), Some(from)) = (&self.two_cables, &self.bounce_start) {
            let record = self.extremes.y_max;
            self.extremes.y_max = highest_point(two_cables, from, s, record);
        }
    }
}
