//! The digits of a run with many digits that the growth of its own errors leaves.

use snapload::analysis::Trust;
use snapload::{Case, Impact, Precise, Real, Simulation};
use std::collections::VecDeque;

/// The last digits of coefficients in which the neighbour differs, in units of the spacing of
/// numbers next to 1.
const PERTURBATION: f64 = 4.0;

/// The same case with coefficients that differ in their last digits, followed beside the run: their
/// difference shows how errors grow, also past the horizon of the ordinary run. Restitution and
/// force are changed, as every start stays legal with them.
pub(crate) struct Neighbour<'a, const WORDS: usize> {
    trust: &'a Trust,
    /// None once it has ended, or a cable stays taut.
    simulation: Option<Simulation<Precise<WORDS>>>,
    /// Its impacts that have not been compared.
    impacts: VecDeque<Impact<Precise<WORDS>>>,
    compared: usize,
    left: f64,
}

impl<'a, const WORDS: usize> Neighbour<'a, WORDS> {
    pub(crate) fn new(case: &Case, trust: &'a Trust) -> Self {
        let one = Precise::<WORDS>::ONE;
        let change = Precise::EPSILON * PERTURBATION;
        let changed = |key: &str, number: f64| {
            let exact = Precise::from_decimal(number);
            match key {
                // At most 1.
                "e" => exact * (one - change),
                "f_o" | "nu" | "omega" => exact * (one + change),
                _ => exact,
            }
        };
        Self {
            trust,
            simulation: case.simulation_over(changed).ok(),
            impacts: VecDeque::new(),
            compared: 0,
            left: f64::from(Precise::<WORDS>::DIGITS),
        }
    }

    /// The digits that remain after the impacts compared so far.
    pub(crate) fn left(&self) -> f64 {
        self.left
    }

    /// The digits that remain at the next impact of the run. What the ordinary run has lost up to
    /// there, as far as that is known, is lost here, too.
    pub(crate) fn compare(&mut self, exact: &Impact<Precise<WORDS>>) -> f64 {
        while self.impacts.is_empty() {
            let Some(step) = self.simulation.as_mut().and_then(Simulation::step) else {
                break;
            };
            self.impacts.extend(step.impacts());
            if !step.taut_after.is_empty() {
                self.simulation = None;
            }
        }
        let other = self.impacts.pop_front();
        let other = other.filter(|other| other.cable == exact.cable);
        let agree = |other: &Impact<_>| -difference(numbers(other), numbers(exact)).log10();
        let error = self.trust.errors.get(self.compared).copied();
        let lost = error.map_or(f64::NEG_INFINITY, |error| (error / f64::EPSILON).log10());
        if lost.is_finite() {
            self.left = self.left.min(f64::from(Precise::<WORDS>::DIGITS) - lost);
        }
        self.left = self.left.min(other.as_ref().map_or(0.0, agree)).max(0.0);
        self.compared += 1;
        self.left
    }
}

/// The time of an impact, and the states before and after it.
pub(crate) fn numbers<T: Real>(impact: &Impact<T>) -> [T; 13] {
    let (before, after) = (impact.before.components(), impact.after.components());
    std::array::from_fn(|k| match k {
        0 => impact.t,
        1..7 => before[k - 1],
        _ => after[k - 7],
    })
}

/// The largest difference of two impacts, relative to values above 1.
pub(crate) fn difference<T: Real>(ours: [T; 13], exact: [T; 13]) -> f64 {
    let pairs = ours.into_iter().zip(exact);
    let relative = pairs.map(|(ours, exact)| relative(ours, exact));
    relative.fold(0.0, f64::max)
}

pub(crate) fn relative<T: Real>(ours: T, exact: T) -> f64 {
    let difference = (ours - exact).to_f64().abs();
    difference / exact.to_f64().abs().max(1.0)
}
