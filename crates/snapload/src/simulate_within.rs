//! What the latest step of a motion was like within.

use super::{Simulation, Step};
use crate::State;
use crate::contact::Contact;
use crate::extremes::peak;
use crate::flight::Flight;
use crate::real::Real;
use std::borrow::Cow;

/// So many equal parts a stretch is looked at in, where a bound on its highest point has to be close.
const LOOKS: usize = 64;

impl<T: Real> Simulation<T> {
    /// The state a time `s` into the stretch that the latest step made.
    pub(crate) fn within(&self, step: &Step<T>, s: T) -> State<T> {
        if step.taut.is_empty() {
            self.flown().state(s)
        } else {
            self.series.state(s)
        }
    }

    /// The flight of the latest step.
    fn flown(&self) -> Cow<'_, Flight<T>> {
        let Some(from) = &self.departure else {
            return Cow::Borrowed(&self.flight);
        };
        let mut flight = self.flight.clone();
        let [vx, vy, vtheta] = from.before;
        let before = State {
            vx,
            vy,
            vtheta,
            ..from.state
        };
        let mut contacts = self.contacts;
        for (contact, [gap, error]) in contacts.iter_mut().zip(from.gaps) {
            *contact = Contact {
                gap,
                error,
                resting: false,
            };
        }
        flight.begin(&self.system, from.t, &from.state, &before, &contacts);
        Cow::Owned(flight)
    }

    /// The gap of a cable at the time reached.
    pub(crate) fn gap(&self, cable: usize) -> T {
        self.contacts[cable].gap
    }

    /// The closest that a slack cable came to being taut within the latest step without reaching it: the
    /// largest gap there, if it is above `floor` < 0.
    pub(crate) fn closest_approach(&self, step: &Step<T>, cable: usize, floor: T) -> Option<T> {
        let s = step.t_end - step.t_start;
        if step.taut.is_empty() {
            let flight = self.flown();
            let bend = flight.gap_bend(cable, s);
            let ends = flight.gap_at_start(cable).max(self.gap(cable));
            if ends + bend * s * s * 0.125 < floor {
                return None;
            }
            peak(&|s| flight.gap_and_rate(cable, s), s, bend, floor)
        } else {
            let bend = self.series.gap_bend(cable);
            peak(&|s| self.series.gap_and_rate(cable, s), s, bend, floor)
        }
    }

    /// A bound on the highest y of the body along the latest step, close where it is above `floor`.
    pub(crate) fn highest_within(&self, step: &Step<T>, floor: T) -> T {
        let s = step.t_end - step.t_start;
        let [y_bend, theta_bend] = if step.taut.is_empty() {
            [self.system.forcing.steepest(), T::ZERO]
        } else {
            self.series.steepest()
        };
        let reach = self.system.body.reach();
        let rough = step.start.y.max(step.before.y) + y_bend * s * s * 0.125 + reach;
        if rough < floor {
            return rough;
        }
        let width = s / LOOKS as f64;
        let spin = step.start.vtheta.abs() + theta_bend * s;
        let bend = y_bend + (spin * spin + theta_bend) * reach;
        let flight = self.flown();
        let state = |s: T| {
            if step.taut.is_empty() {
                flight.state(s)
            } else {
                self.series.state(s)
            }
        };
        (0..=LOOKS)
            .map(|k| self.system.top(&state(width * k as f64)))
            .fold(step.start.y, T::max)
            + bend * width * width * 0.125
    }

    /// How far the latest expansion of taut motion may be used.
    pub(crate) fn expansion(&self) -> T {
        self.series.step()
    }
}
