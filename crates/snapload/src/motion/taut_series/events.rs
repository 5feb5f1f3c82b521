//! The event functions of a step of taut motion, as polynomials.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::model::floating::Complex;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::MAX_CABLES;
use crate::motion::active_set::ActiveSet;
use crate::motion::events::{EventFunction, HasEvents, Jet, Jets};
use crate::motion::limits::law::{EventSeries, TautMotion};
use crate::motion::sizes::negligible_tensions;
use crate::motion::taut_series::Series;

/// The tolerance for the length of a taut cable without tension, as a multiple of that of a resting
/// one.
const TAUT_TOLERANCE: f64 = 64.0;

/// A tension that is known to be zero counts as zero up to this many roundings of its terms.
const ROUNDINGS: f64 = 8.0;

impl<T: Real> Series<T> {
    /// Whether a taut cable stays taut within the step: it carries, or the body can not move, or
    /// its gap is zero up to rounding.
    #[inline(always)]
    pub(super) fn holds(&self, system: &System<T>, cable: usize) -> bool {
        let gap = &self.lines[cable].gap;
        self.active.carrying.contains(cable)
            || system.is_held_by(self.active.carrying)
            || gap.derivative_bound(0, self.step, ORDER) <= self.touch[cable] * TAUT_TOLERANCE
    }

    /// Chooses the event functions of the step; those that provably are not reached are left out.
    #[inline(always)]
    pub(super) fn choose_event_series(
        &mut self,
        system: &System<T>,
        start: &State<T>,
        memory: &[Complex<T>],
    ) {
        let step = self.step;
        self.event_series.clear();
        let ActiveSet { taut, carrying } = self.active;
        let negligible = (taut != carrying).then(|| {
            let mut tension = [T::ZERO; MAX_CABLES];
            for cable in carrying.iter() {
                tension[cable] = self.lines[cable].tension[0];
            }
            negligible_tensions(
                system,
                start,
                system.memory_force(memory),
                carrying,
                &tension,
            )
        });
        let idle = |cable: usize| taut.contains(cable) && !carrying.contains(cable);
        for cable in (0..self.lines.len()).filter(|&cable| !idle(cable)) {
            let line = &self.lines[cable];
            let event = if carrying.contains(cable) {
                EventSeries {
                    function: EventFunction::Tension(cable),
                    series: line.tension.negated(),
                    order: ORDER - 2,
                    left_out: T::ZERO,
                }
            } else {
                EventSeries {
                    function: EventFunction::Gap(cable),
                    series: line.gap,
                    order: ORDER,
                    left_out: self.contacts[cable].error + self.left_out[cable],
                }
            };
            // If not all taut cables carry, one whose tension is zero throughout has no event.
            let nothing = negligible.is_some_and(|negligible| {
                carrying.contains(cable)
                    && event.series.derivative_bound(0, step, event.order) <= negligible[cable]
            });
            if !nothing && !event.stays_negative(step) {
                self.event_series.push(event);
            }
        }
        let motion = TautMotion {
            place: self.body.place(),
            circle: &self.body.circle,
            step,
            left_out: self.left_out_of_motion(step),
            circle_left_out: self.left_out_of_circle(system, step),
        };
        self.limits
            .add_event_series(&motion, &mut self.event_series);
    }

    #[inline(always)]
    fn jet(&self, function: EventFunction, series: &Polynomial<T>, order: usize, s: T) -> Jet<T> {
        let ([value, rate, accel], noise) = series.jet_and_noise(s, order);
        Jet {
            third: series.derivative_bound(3, self.step, order),
            noise,
            ..Jet::new(function, value, rate, accel)
        }
    }

    #[inline(always)]
    fn gap_jet(&self, cable: usize, s: T) -> Jet<T> {
        let gap = &self.lines[cable].gap;
        let contact = &self.contacts[cable];
        let jet = self.jet(EventFunction::Gap(cable), gap, ORDER, s);
        if s > T::ZERO {
            return Jet {
                noise: jet.noise + contact.error + self.left_out[cable],
                ..jet
            };
        }
        Jet {
            noise: contact.error,
            start_noise: self.touch[cable],
            resting: contact.resting,
            jerk: gap[3] * 6.0,
            fourth: if contact.resting {
                gap.derivative_bound(4, self.step, ORDER)
            } else {
                T::ZERO
            },
            ..jet
        }
    }
}

impl<T: Real> Series<T> {
    /// Minus a tension that is zero at the start and rises: value and rate are known to be zero, so
    /// that rounding does not make it cross zero there.
    fn touching_jet(&self, event: &EventSeries<T>) -> Jet<T> {
        let EventSeries { series, order, .. } = event;
        let size = series.derivative_bound(0, self.step, *order);
        Jet {
            start_noise: size * T::EPSILON * ROUNDINGS,
            resting: true,
            jerk: series[3] * 6.0,
            fourth: series.derivative_bound(4, self.step, *order),
            ..Jet::new(event.function, T::ZERO, T::ZERO, series[2] * 2.0)
        }
    }
}

impl<T: Real> HasEvents<T> for Series<T> {
    #[inline(always)]
    fn jets_at(&self, s: T, jets: &mut Jets<T>) {
        for event in &self.event_series {
            jets.push(match event.function {
                EventFunction::Gap(cable) => self.gap_jet(cable, s),
                EventFunction::Tension(cable) if s == T::ZERO && self.touching.contains(cable) => {
                    self.touching_jet(event)
                }
                other => {
                    let jet = self.jet(other, &event.series, event.order, s);
                    Jet {
                        noise: jet.noise + event.left_out,
                        ..jet
                    }
                }
            });
        }
    }
}
