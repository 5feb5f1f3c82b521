//! The steps of a motion that are bounces, made here or in a lane.

use super::{Event, Progress, Simulation};
use crate::bounce::{Bounce, bounce, highest_point};
use crate::contact::Contact;
use crate::event::Reached;
use crate::extremes::Extremes;
use crate::impact::Shock;
use crate::lane::Turn;
use crate::mooring::{Moment, Mooring};
use crate::real::Real;
use crate::{State, TautSet};

impl<T: Real> Simulation<T> {
    /// The bounce that the motion makes next, if it is one. The same number that comes here by itself comes to
    /// [`bounce`] in a lane, so it is one in both or in neither.
    #[inline(always)]
    pub(super) fn next_bounce(&mut self) -> Option<Bounce<T>> {
        self.departure = None;
        let from = self.moment()?;
        let bounce = bounce(self.mooring.as_ref()?, &from);
        if bounce.arrived {
            self.departure = Some(from);
        }
        bounce.arrived.then_some(bounce)
    }

    /// The motion as [`bounce`] takes it; none if a cable is taut or at rest.
    #[inline(always)]
    pub(crate) fn moment(&self) -> Option<Moment<T>> {
        let [first, second, ..] = &self.contacts;
        if !self.hold.taut.is_empty() || first.resting || second.resting {
            return None;
        }
        Some(Moment {
            t: self.t,
            state: self.state,
            turn: Turn::by(self.state.theta),
            before: [self.before.vx, self.before.vy, self.before.vtheta],
            gaps: [[first.gap, first.error], [second.gap, second.error]],
            y_max: self.extremes.y_max,
            theta_max: self.extremes.theta_max,
        })
    }

    /// What a lane needs to carry the motion on; none if it does not fly freely now.
    pub(crate) fn aboard(&self) -> Option<(Mooring<T>, Moment<T>)> {
        Some((self.mooring?, self.moment()?))
    }

    /// The impacts so far.
    pub(crate) fn progress(&self) -> Progress<T> {
        Progress {
            impacts: self.impacts,
            last: self.last,
        }
    }

    /// Goes on from where bounces made elsewhere have led.
    pub(crate) fn resume(&mut self, moment: &Moment<T>, progress: Progress<T>) {
        if moment.t > self.t {
            self.standstill = 0;
        }
        self.t = moment.t;
        self.state = moment.state;
        let [vx, vy, vtheta] = moment.before;
        self.before = State {
            vx,
            vy,
            vtheta,
            ..moment.state
        };
        self.know(&moment.gaps);
        self.extremes = Extremes {
            y_max: moment.y_max,
            theta_max: moment.theta_max,
        };
        if progress.impacts > self.impacts {
            self.end_slow_row();
        }
        self.impacts = progress.impacts;
        self.last = progress.last;
    }

    fn know(&mut self, gaps: &[[T; 2]; 2]) {
        for (contact, [gap, error]) in self.contacts.iter_mut().zip(*gaps) {
            *contact = Contact {
                gap,
                error,
                resting: false,
            };
        }
    }

    /// Makes a bounce: moves to its end, and applies the law there if that is not done yet.
    #[inline(always)]
    pub(super) fn take(&mut self, bounce: &Bounce<T>) -> (Event, Option<Shock<T>>) {
        let next = &bounce.next;
        self.cover(bounce);
        self.t = next.t;
        self.before = bounce.before;
        let struck = usize::from(bounce.second);
        self.know(&next.gaps);
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
            return (event, Some(self.snap(&event)));
        }
        self.state = next.state;
        self.end_slow_row();
        let e = self.system.restitution;
        let shock = Shock::of_one(
            struck,
            [bounce.v_n, -e * bounce.v_n],
            bounce.impulse,
            next.state,
        );
        self.count(&shock, closed);
        self.check_rules(TautSet::SLACK);
        (event, Some(shock))
    }

    /// Takes the flight of a bounce into the extremes.
    fn cover(&mut self, bounce: &Bounce<T>) {
        let next = &bounce.next;
        if let (false, Some(mooring), Some(from)) = (bounce.topped, &self.mooring, &self.departure)
        {
            let record = self.extremes.y_max;
            self.extremes.y_max = highest_point(mooring, from, bounce.s, record);
        }
        self.extremes.y_max = self.extremes.y_max.max(next.y_max);
        self.extremes.theta_max = self.extremes.theta_max.max(next.theta_max);
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Parameters};

    /// The general loop, which knows no bounces, finds the same impacts. It locates them by other steps,
    /// so they differ by roundings, which are compared until they have grown.
    #[test]
    fn bounces_are_what_the_general_search_finds() {
        let mut compared = 0;
        for k in 0..400 {
            let k = f64::from(k);
            let parameters = Parameters {
                f_o: 0.001 * k,
                e: 1.0 - 0.3 * (k * 0.1).sin().abs(),
                a: 0.3 * (k * 0.7).cos().abs(),
                b: 0.2 * (k * 0.3).sin().max(0.0),
                inertia: Some(0.01 + 0.02 * (k * 0.9).sin().abs()),
                omega: 0.01 * k,
                vx: 0.3 * k.sin(),
                vtheta: 0.5 * k.cos(),
                y: 0.4,
                ..Parameters::STANDARD
            };
            let Ok(case) = Case::new(parameters) else {
                continue;
            };
            let mut bounces = case.simulation();
            let mut general = case.simulation();
            general.mooring = None;
            let mut error = 1e-15;
            while let (Some(ours), Some(theirs)) = (bounces.step(), general.step()) {
                let (ours, theirs) = (ours.impacts().next(), theirs.impacts().next());
                let (Some(ours), Some(theirs)) = (ours, theirs) else {
                    break;
                };
                error *= 1.0 + 4.0 * (1.0 + ours.before.vtheta.abs()) / ours.v_n.min(1.0);
                if error > 1e-6 {
                    break;
                }
                assert_eq!(ours.cable, theirs.cable, "{parameters:?} at t = {}", ours.t);
                assert!((ours.t - theirs.t).abs() < error, "{parameters:?}");
                assert!((ours.v_n - theirs.v_n).abs() < error, "{parameters:?}");
                compared += 1;
            }
        }
        assert!(compared > 1000, "{compared}");
    }
}
