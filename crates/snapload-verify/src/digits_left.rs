//! The digits of a run with many digits that the growth of its own errors leaves.

use crate::decimals::Decimals;
use snapload::analysis::Trust;
use snapload::{Impact, Precise, Real, Simulation, Step};
use std::collections::VecDeque;

/// The last digits of numbers in which the neighbour differs, in units of the spacing of numbers
/// next to 1.
const PERTURBATION: f64 = 4.0;

/// Digits that are kept in reserve for the roundings on the way, which the neighbour does not show.
const RESERVE: f64 = 2.0;

/// An error of the ordinary run grows like one of the run with many digits while it is smaller than
/// this: both then are at the same place.
const SMALL: f64 = 1e-3;

/// The digits that are left of the numbers of an impact, each relative to values above 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DigitsLeft {
    /// Of its time and of the states before and after it.
    pub(crate) motion: f64,
    pub(crate) v_n: f64,
    pub(crate) impulse: f64,
}

/// A number with the decimals that are known if so many of its digits are left, two of them in
/// reserve; none if not even one decimal is known.
pub(crate) fn written<const WORDS: usize>(number: Precise<WORDS>, left: f64) -> Option<String> {
    // Digits in front of the point are no decimals.
    let decimals = left - RESERVE - number.to_f64().abs().max(1.0).log10();
    let known = number.is_finite() && decimals >= 1.0;
    known.then(|| number.to_decimals(decimals as usize))
}

/// Whether a motion goes on with a taut cable, where the comparison ends.
pub(crate) fn sticks<T: Real>(step: &Step<T>) -> bool {
    step.stop.is_none() && !step.taut_after.is_empty()
}

/// The same case with numbers that differ in their last digits, followed beside the run: their
/// difference shows how errors grow, also past the horizon of the ordinary run.
pub(crate) struct Neighbour<'a, const WORDS: usize> {
    trust: &'a Trust,
    /// None if it has no legal start.
    simulation: Option<Simulation<Precise<WORDS>>>,
    /// Whether a cable stays taut, so that it is not followed further.
    stuck: bool,
    /// Its impacts that have not been compared.
    impacts: VecDeque<Impact<Precise<WORDS>>>,
    compared: usize,
    /// Digits that the ordinary run has lost beyond those that this neighbour shows, at most:
    /// roundings on the way, which grow from there on as its difference does.
    behind: f64,
    left: DigitsLeft,
}

impl<'a, const WORDS: usize> Neighbour<'a, WORDS> {
    const DIGITS: f64 = Precise::<WORDS>::DIGITS as f64;

    pub(crate) fn new(decimals: Decimals, trust: &'a Trust) -> Self {
        let of = |start_too| decimals.simulation(|key| change(key, start_too));
        Self {
            trust,
            // At the very edge of what is legal the start can not be changed.
            simulation: of(true).or_else(|_| of(false)).ok(),
            stuck: false,
            impacts: VecDeque::new(),
            compared: 0,
            behind: 0.0,
            left: DigitsLeft {
                motion: Self::DIGITS,
                v_n: Self::DIGITS,
                impulse: Self::DIGITS,
            },
        }
    }

    /// The digits that remain at the next impact of the run.
    pub(crate) fn compare(&mut self, exact: &Impact<Precise<WORDS>>) -> DigitsLeft {
        while self.impacts.is_empty() && self.step() {}
        let other = self.impacts.pop_front();
        let error = self.trust.errors.get(self.compared).copied();
        self.compared += 1;
        let Some(other) = other.filter(|other| other.cable == exact.cable) else {
            return self.lose_all();
        };
        self.lower_motion(difference(numbers(&other), numbers(exact)), error);
        let least = |left: f64, ours, exact| {
            let own = Self::digits_within(relative(ours, exact)) - self.behind;
            left.min(own).min(self.left.motion).max(0.0)
        };
        self.left = DigitsLeft {
            motion: self.left.motion,
            v_n: least(self.left.v_n, other.v_n, exact.v_n),
            impulse: least(self.left.impulse, other.impulse, exact.impulse),
        };
        self.left
    }

    /// The digits that remain of time and state where the run ends, after all of its impacts.
    pub(crate) fn compare_end(&mut self, exact: &Simulation<Precise<WORDS>>) -> f64 {
        // Nothing was computed if it ends where it starts.
        if exact.time() == Precise::ZERO {
            return self.left.motion;
        }
        while self.impacts.is_empty() && self.step() {}
        let other = self.simulation.as_ref();
        let Some(other) =
            other.filter(|other| self.impacts.is_empty() && other.stop() == exact.stop())
        else {
            return self.lose_all().motion;
        };
        let difference = difference(place(other), place(exact));
        let t = exact.time().to_f64();
        // The ordinary run also follows taut motion, so that only its stop is the same end.
        let alike = exact.stop().is_some() && self.compared == self.trust.errors.len();
        let error =
            alike.then(|| (self.trust.end_error / t.max(1.0)).max(self.trust.edge_errors[1]));
        self.lower_motion(difference, error);
        self.left.motion
    }

    /// One step further; false at its end.
    fn step(&mut self) -> bool {
        let simulation = self.simulation.as_mut().filter(|_| !self.stuck);
        let Some(step) = simulation.and_then(Simulation::step) else {
            return false;
        };
        self.impacts.extend(step.impacts());
        self.stuck = sticks(&step);
        true
    }

    /// Takes account of a difference of the neighbour, and of the error of the ordinary run at the
    /// same place, as far as that is known: what that has lost, is lost here, too.
    fn lower_motion(&mut self, difference: f64, error: Option<f64>) {
        let shown = Self::digits_within(difference);
        if let Some(error) = error.filter(|error| *error < SMALL) {
            let lost = (error / f64::EPSILON).log10();
            self.behind = self.behind.max(shown - (Self::DIGITS - lost));
        }
        self.left.motion = self.left.motion.min(shown - self.behind).max(0.0);
    }

    /// Where the neighbour has other events, nothing is known.
    fn lose_all(&mut self) -> DigitsLeft {
        self.left = DigitsLeft {
            motion: 0.0,
            v_n: 0.0,
            impulse: 0.0,
        };
        self.left
    }

    fn digits_within(difference: f64) -> f64 {
        (-difference.log10()).min(Self::DIGITS)
    }
}

/// The factor of a number of the neighbour, without leaving what is legal: restitution is at most
/// 1, and a start that is nearer to the place of rest, on longer cables, is within their reach. A
/// zero stays zero, as both cables of a symmetric motion snap at one instant, which any change of
/// these would end.
fn change<const WORDS: usize>(key: &str, start_too: bool) -> Precise<WORDS> {
    let change = Precise::<WORDS>::EPSILON * PERTURBATION;
    let (smaller, larger) = (Precise::ONE - change, Precise::ONE + change);
    match key {
        "e" => smaller,
        "f_o" | "nu" | "omega" => larger,
        "x" | "y" | "theta" | "vx" | "vy" | "vtheta" if start_too => smaller,
        "r" if start_too => larger,
        _ => Precise::ONE,
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

/// The time at which a motion is, and its state there.
fn place<T: Real>(simulation: &Simulation<T>) -> [T; 7] {
    let state = simulation.state().components();
    std::array::from_fn(|k| match k {
        0 => simulation.time(),
        _ => state[k - 1],
    })
}

/// The largest difference of two impacts or places, relative to values above 1.
pub(crate) fn difference<T: Real, const N: usize>(ours: [T; N], exact: [T; N]) -> f64 {
    let pairs = ours.into_iter().zip(exact);
    let relative = pairs.map(|(ours, exact)| relative(ours, exact));
    relative.fold(0.0, f64::max)
}

pub(crate) fn relative<T: Real>(ours: T, exact: T) -> f64 {
    let difference = (ours - exact).to_f64().abs();
    difference / exact.to_f64().abs().max(1.0)
}
