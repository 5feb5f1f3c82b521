//! Lyapunov exponents of long motions, with those that are −∞ because of contact.
//!
//! Six directions, four of a point mass, are carried along a motion and made orthogonal after each
//! step (Benettin, Galgani, Giorgilli & Strelcyn, *Meccanica* 15 (1980) 9). A cable that stays taut
//! allows no deviation of its gap and of the gap's velocity, and one that a snap stops and lets go
//! none of its gap. The linearised motion itself does not include this: off the constraints a
//! deviation that is only rounding would grow with time, and be reported as a small exponent. So
//! the directions are projected onto the constraints after each step, and those of which nothing
//! remains are closed: their exponent is −∞.

use crate::Jet;
use crate::hybrid::Family;
use crate::moored::{Cables, Moored, event_of};
use crate::multipliers::{closed_after, orthogonal};
use nalgebra::DVector;
use snapload::{Parameters, Step, StepMap, TautSet};

/// Directions carried along a motion.
pub(crate) struct Directions {
    system: Cables<Jet>,
    variables: &'static [usize],
    /// Unit vectors; none in place of a direction that contact has closed.
    directions: Vec<Option<DVector<f64>>>,
    /// The logarithms of the factors by which they have grown; −∞ for a closed one.
    logs: Vec<f64>,
    /// The part of these logarithms that grew at the slowest snaps.
    slow_logs: Vec<f64>,
    /// The speed below which snaps are among the slowest.
    slow_below: f64,
    /// Whether directions that contact closes count as closed from now on.
    closes_for_good: bool,
}

/// The slowest snaps are those within a factor of ten of `v_stick`: without them the exponents would
/// be those of a case with ten times its value.
const SLOW: f64 = 10.0;

/// If less than this part of a direction is independent of the others, it is rounding, and the
/// direction is closed.
const ROUNDING: f64 = 1e-14;
/// How far the logarithm of a growth may be off after a step with taut cables, as the fundamental
/// matrix along taut motion ([`snapload::Tangent`]) has an error of up to this part.
const TAUT_ERROR: f64 = 1e-4;
/// Standard errors come from the first number of batches, and from at least the second.
const BATCHES: usize = 20;
const FEWEST: usize = 4;
/// A trend of this many times its standard error is not taken as chance.
const TREND: f64 = 3.0;
/// What grows in a period at the slowest snaps is negligible below the first number; above it and
/// beyond this part of the whole, or beyond its error, the whole depends on it.
const NEGLIGIBLE: f64 = 1e-2;
const PART: f64 = 0.1;

impl Directions {
    /// The unit vectors of the components, at the start of a motion of a case.
    pub(crate) fn new(parameters: &Parameters) -> Self {
        let family = Moored::case(*parameters, [None; 2]);
        let count = family.variables().len();
        Self {
            system: family.jets([0.0; 2]),
            variables: family.variables(),
            directions: (0..count).map(|i| Some(unit(count, i))).collect(),
            logs: vec![0.0; count],
            slow_logs: vec![0.0; count],
            slow_below: SLOW * parameters.v_stick,
            closes_for_good: false,
        }
    }

    /// From now on a direction that contact closes stays closed, and growth at the slowest snaps
    /// counts. A cable that was taut only in the beginning closes no direction of the long motion.
    pub(crate) fn close_from_now_on(&mut self) {
        if !self.closes_for_good {
            self.slow_logs.fill(0.0);
        }
        self.closes_for_good = true;
    }

    /// ln of the factors by which the directions have grown.
    pub(crate) fn logs(&self) -> Vec<f64> {
        self.logs.clone()
    }

    /// The part of that which grew at the slowest snaps.
    pub(crate) fn slow_logs(&self) -> &[f64] {
        &self.slow_logs
    }

    /// Carries them through a step, to its end. Returns ln of the factor by which the first one has
    /// grown, which turns to where deviations grow most.
    pub(crate) fn follow(&mut self, map: &StepMap, step: &Step) -> f64 {
        let before = self.logs.clone();
        let event = event_of(step).map(|(event, _)| event);
        let rebounds = self.system.system().restitution.value > 0.0;
        let stops = event.map_or(TautSet::SLACK, |event| event.stops(rebounds));
        let after = (step.t_end, &step.after.components());
        let closed = [step.taut_after, stops];
        let mut taken = closed_after(&self.system, self.variables, closed, after);
        let constraints = taken.len();
        for (direction, log) in self.directions.iter_mut().zip(&mut self.logs) {
            let Some(before) = direction else { continue };
            let mut deviation = [0.0; 6];
            for (place, part) in self.variables.iter().zip(before.iter()) {
                deviation[*place] = *part;
            }
            let carried = map.fundamental(&deviation);
            let carried = DVector::from_iterator(
                self.variables.len(),
                self.variables.iter().map(|place| carried[*place]),
            );
            *direction = orthogonal(carried, &taken, ROUNDING).map(|(left, length)| {
                *log += length.ln();
                taken.push(left.clone());
                left
            });
            if direction.is_none() && self.closes_for_good {
                *log = f64::NEG_INFINITY;
            }
        }
        if !self.closes_for_good {
            self.fill(taken.split_off(constraints));
        }
        // Where a cable sticks, deviations lose what they have across it, whatever `v_stick` is.
        let sticks = step.taut_after.len() > step.taut.len();
        let slow = |v_n: f64| v_n > 0.0 && v_n < self.slow_below;
        if !sticks && step.impacts().any(|impact| slow(impact.v_n)) {
            let grown = self.logs.iter().zip(&before);
            for (slow, (after, before)) in self.slow_logs.iter_mut().zip(grown) {
                *slow += after - before;
            }
        }
        self.logs[0] - before[0]
    }

    /// Replaces the closed directions by others, so that all remain independent.
    fn fill(&mut self, mut taken: Vec<DVector<f64>>) {
        let count = self.variables.len();
        for direction in self.directions.iter_mut().filter(|d| d.is_none()) {
            // The unit vector with the smallest component along the others is far enough from them.
            let left = |i: usize| 1.0 - taken.iter().map(|other| other[i] * other[i]).sum::<f64>();
            let least = (0..count).max_by(|i, j| left(*i).total_cmp(&left(*j)));
            let found = least.and_then(|i| orthogonal(unit(count, i), &taken, ROUNDING));
            *direction = found.map(|(vector, _)| vector);
            taken.extend(direction.clone());
        }
    }
}

fn unit(count: usize, place: usize) -> DVector<f64> {
    let mut unit = DVector::zeros(count);
    unit[place] = 1.0;
    unit
}

/// The exponents, the largest first, each with its standard error, from the logarithms at sections
/// a period apart, the first of which is `first` periods after the motion's start. The error of
/// taut motion, which had `taut_steps` steps in a period, is the same in all of them, so that no
/// scatter shows it.
///
/// `slow` is the part of the growth over all periods that comes from the slowest snaps. Where snaps
/// of one cable accumulate it tends to zero, and the exponent does not depend on `v_stick`. Where
/// those of two cables accumulate in turn deviations may grow by a factor with every tenth of the
/// speed, without end: the motion then has no derivative there, and the exponent no limit. Its error
/// is infinite.
pub(crate) fn exponents(
    (logs, slow): (&[Vec<f64>], &[f64]),
    first: u64,
    period: f64,
    taut_steps: f64,
) -> Vec<[f64; 2]> {
    let count = match logs {
        [_, _, ..] => logs[0].len(),
        _ => 0,
    };
    let mut found: Vec<[f64; 2]> = (0..count)
        .map(|i| {
            let of_one: Vec<f64> = logs.iter().map(|logs| logs[i]).collect();
            let [mean, error] = estimate(&of_one, first as f64);
            let of_slow = (slow[i] / (logs.len() - 1) as f64).abs();
            let error = match mean.is_finite() {
                true if of_slow > error.min(PART * mean.abs()).max(NEGLIGIBLE) => f64::INFINITY,
                true => error.hypot(TAUT_ERROR * taut_steps).hypot(of_slow),
                false => error,
            };
            [mean, error].map(|number| number / period)
        })
        .collect();
    found.sort_by(|a, b| b[0].total_cmp(&a[0]));
    found
}

/// The mean growth in a period, and its standard error from batches of periods, which is NaN if
/// there are too few.
///
/// Deviations that grow by a power of time instead of a factor per period, such as those between
/// motions of different pace, have an exponent of 0, but over n periods a mean that falls as 1/n:
/// batches agree with each other, and not with the limit. So if the growth rises or falls as 1/t by
/// more than the scatter of the batches, the effect of this on the mean is included in the error.
fn estimate(logs: &[f64], first: f64) -> [f64; 2] {
    let periods = logs.len() - 1;
    let rate = |from: usize, to: usize| (logs[to] - logs[from]) / (to - from) as f64;
    let mean = rate(0, periods);
    if !mean.is_finite() {
        return [f64::NEG_INFINITY, 0.0];
    }
    let batches = BATCHES.min(periods);
    if batches < FEWEST {
        return [mean, f64::NAN];
    }
    let ends = |k: usize| k * periods / batches;
    let of_batches: Vec<[f64; 2]> = (0..batches)
        .map(|k| {
            let middle = first + (ends(k) + ends(k + 1)) as f64 / 2.0;
            [1.0 / middle, rate(ends(k), ends(k + 1)) - mean]
        })
        .collect();
    let n = batches as f64;
    let usual = of_batches.iter().map(|[inverse, _]| inverse).sum::<f64>() / n;
    let sum = |of: &dyn Fn(f64, f64) -> f64| {
        let terms = of_batches
            .iter()
            .map(|[inverse, off]| of(inverse - usual, *off));
        terms.sum::<f64>()
    };
    let (spread, squares) = (sum(&|u, _| u * u), sum(&|_, off| off * off));
    let slope = sum(&|u, off| u * off) / spread;
    let scatter = sum(&|u, off| (off - slope * u).powi(2)) / (n - 2.0);
    let trend = match slope.abs() > TREND * (scatter / spread).sqrt() {
        true => slope * usual,
        false => 0.0,
    };
    [mean, (squares / (n * (n - 1.0))).sqrt().hypot(trend)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The estimate for a given growth, over 100 periods after 300.
    fn of(growth: impl Fn(f64) -> f64) -> [f64; 2] {
        let logs: Vec<f64> = (300..=400).map(|t| growth(f64::from(t))).collect();
        estimate(&logs, 300.0)
    }

    #[test]
    fn growth_by_a_power_of_time_is_reported_as_not_settled() {
        let [mean, error] = of(|t| 2.0 * t.ln());
        assert!(mean > 0.0 && error > 0.8 * mean, "{mean} +- {error}");
    }

    #[test]
    fn growth_by_a_factor_is_known_to_rounding() {
        let [mean, error] = of(|t| -0.25 * t);
        assert!(
            (mean + 0.25).abs() < 1e-12 && error < 1e-9,
            "{mean} +- {error}"
        );
    }

    #[test]
    fn scatter_is_the_error_where_there_is_no_trend() {
        // Equidistributed numbers, whose sums over five periods vary.
        let [mean, error] = of(|t| 0.1 * t + (t * 2_f64.sqrt()).fract());
        assert!(
            (mean - 0.1).abs() < 3.0 * error && error < 0.05,
            "{mean} +- {error}"
        );
    }

    #[test]
    fn three_periods_give_no_error() {
        let [mean, error] = estimate(&[0.0, 0.5, 1.0, 1.5], 10.0);
        assert!(mean == 0.5 && error.is_nan());
    }
}
