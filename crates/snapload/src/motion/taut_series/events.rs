//! What may be reached within a step of taut motion: its event functions, as polynomials.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::real::Real;
use crate::motion::active_set::ActiveSet;
use crate::motion::events::{EventFunction, HasEvents, Jet, Jets};
use crate::motion::limits::TautMotion;
use crate::motion::taut_series::Series;

/// A tension below this along a whole step is none \[F\].
const NOTHING: f64 = 1e-7;
/// How many times as far as a resting cable a taut one that carries nothing may be off its length.
const HELD: f64 = 64.0;

impl<T: Real> Series<T> {
    /// Whether a taut cable stays taut within the step: it carries, or its gap is no more than
    /// rounding.
    #[inline(always)]
    pub(super) fn holds(&self, cable: usize) -> bool {
        let gap = &self.lines[cable].gap;
        self.active.carrying.contains(cable)
            || gap.derivative_bound(0, self.step, ORDER) <= self.touch[cable] * HELD
    }

    /// Chooses the event functions of the step; those that provably are not reached are left out.
    #[inline(always)]
    pub(super) fn choose_watched(&mut self) {
        let step = self.step;
        self.watched.clear();
        let ActiveSet { taut, carrying } = self.active;
        let idle = |cable: usize| taut.contains(cable) && !carrying.contains(cable);
        for cable in (0..self.lines.len()).filter(|&cable| !idle(cable)) {
            let line = &self.lines[cable];
            let (function, series, order, error) = if carrying.contains(cable) {
                let tension = line.tension.negated();
                (EventFunction::Tension(cable), tension, ORDER - 2, T::ZERO)
            } else {
                let error = self.contacts[cable].error + self.left_out[cable];
                (EventFunction::Gap(cable), line.gap, ORDER, error)
            };
            // Where not all taut cables carry, one whose tension is zero all along is no event.
            let nothing = taut != carrying
                && carrying.contains(cable)
                && series.derivative_bound(0, step, order) <= T::from_decimal(NOTHING);
            if !nothing && !series.stays_negative(step, order, error) {
                self.watched.push((function, series, order));
            }
        }
        let motion = TautMotion {
            place: [&self.x, &self.y, &self.theta],
            circle: &self.circle,
            step,
        };
        self.limits.watch_series(&motion, &mut self.watched);
    }

    #[inline(always)]
    fn jet(
        &self,
        function: EventFunction,
        polynomial: &Polynomial<T>,
        order: usize,
        s: T,
    ) -> Jet<T> {
        let ([value, rate, accel], noise) = polynomial.jet_and_noise(s, order);
        Jet {
            third: polynomial.derivative_bound(3, self.step, order),
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
            blur: self.touch[cable],
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

impl<T: Real> HasEvents<T> for Series<T> {
    #[inline(always)]
    fn jets_at(&self, s: T, jets: &mut Jets<T>) {
        for (function, polynomial, order) in &self.watched {
            jets.push(match *function {
                EventFunction::Gap(cable) => self.gap_jet(cable, s),
                other => self.jet(other, polynomial, *order, s),
            });
        }
    }
}
