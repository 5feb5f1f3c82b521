//! Tensions within the latest step.

use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::taut_set::MAX_CABLES;
use crate::motion::active_set::tensions;
use crate::motion::simulation::{Simulation, Step};

/// The number of evenly spaced instants along a step, or a part of one,
/// at which tensions are evaluated.
const INSTANTS: usize = 17;
/// The least tension is found in so many rounds of three evaluations about the least parabola
/// through those before, at distances shorter by `CLOSER` each time.
const ROUNDS: usize = 3;
const CLOSER: f64 = 1.0 / 16.0;

/// Tensions to be evaluated, by the best instructions for them.
struct TensionsWithin<'a, T: Real>(&'a Simulation<T>, &'a Step<T>, T);

impl<T: Real> Kernel for TensionsWithin<'_, T> {
    type Output = [T; MAX_CABLES];
    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.tensions_here(self.1, self.2)
    }
}

/// The ranges of tensions to be found between two instants, likewise.
struct TensionRanges<'a, T: Real>(&'a Simulation<T>, &'a Step<T>, [T; 2]);

impl<T: Real> Kernel for TensionRanges<'_, T> {
    type Output = [[T; 2]; MAX_CABLES];
    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.tension_ranges_here(self.1, self.2)
    }
}

/// The least tension of a cable to be found, likewise.
struct LeastTension<'a, T: Real>(&'a Simulation<T>, &'a Step<T>, usize);

impl<T: Real> Kernel for LeastTension<'_, T> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        self.0.least_tension_here(self.1, self.2)
    }
}

impl<T: Real> Simulation<T> {
    /// The least and the largest tension of each cable along the latest step, by parabolas through
    /// its values at evenly spaced instants; 0 for a cable that is slack \[F\].
    pub fn tension_ranges(&self, step: &Step<T>) -> [[T; 2]; MAX_CABLES] {
        self.tension_ranges_between(step, [T::ZERO, step.t_end - step.t_start])
    }

    /// The same of the part of the latest step between two times after its start.
    pub fn tension_ranges_between(&self, step: &Step<T>, part: [T; 2]) -> [[T; 2]; MAX_CABLES] {
        if step.taut.is_empty() {
            return [[T::ZERO; 2]; MAX_CABLES];
        }
        dispatch_over::<T, _>(TensionRanges(self, step, part))
    }

    #[inline(always)]
    fn tension_ranges_here(&self, step: &Step<T>, part: [T; 2]) -> [[T; 2]; MAX_CABLES] {
        let instants = instants(part);
        let mut ranges = [[T::ZERO; 2]; MAX_CABLES];
        if let (Some(series), true) = (self.expanded(step.taut), step.taut == step.carrying) {
            for cable in step.taut.iter() {
                ranges[cable] = range(series.tensions(cable, &instants));
            }
            return ranges;
        }
        let mut seen = [[T::ZERO; INSTANTS]; MAX_CABLES];
        for (k, instant) in instants.into_iter().enumerate() {
            for (values, tension) in seen.iter_mut().zip(self.tensions_here(step, instant)) {
                values[k] = tension;
            }
        }
        for cable in step.taut.iter() {
            ranges[cable] = range(seen[cable]);
        }
        ranges
    }

    /// The least tension of a carrying cable along the latest step, to rounding \[F\].
    pub(crate) fn least_tension(&self, step: &Step<T>, cable: usize) -> T {
        dispatch_over::<T, _>(LeastTension(self, step, cable))
    }

    #[inline(always)]
    fn least_tension_here(&self, step: &Step<T>, cable: usize) -> T {
        let instants = instants([T::ZERO, step.t_end - step.t_start]);
        let values = instants.map(|s| self.tensions_here(step, s)[cable]);
        let (s, spacing) = (instants[INSTANTS - 1], instants[1]);
        let mut least = values.into_iter().fold(values[0], T::min);
        for k in 1..INSTANTS - 1 {
            let mut around = [values[k - 1], values[k], values[k + 1]];
            let (mut centre, mut apart) = (instants[k], spacing);
            for round in 0..=ROUNDS {
                let Some((offset, value)) = vertex(around) else {
                    break;
                };
                let place = centre + offset * apart;
                if offset.abs() > T::ONE || place < T::ZERO || s < place {
                    break;
                }
                if round == ROUNDS {
                    least = least.min(value);
                    break;
                }
                apart = apart * CLOSER;
                centre = place.max(apart).min(s - apart);
                around = [centre - apart, centre, centre + apart]
                    .map(|s| self.tensions_here(step, s)[cable]);
                least = around.into_iter().fold(least, T::min);
            }
        }
        least
    }

    /// The tension of each cable at the end of the latest step, before the event there \[F\].
    pub fn tensions_at_end(&self, step: &Step<T>) -> [T; MAX_CABLES] {
        let s = step.t_end - step.t_start;
        dispatch_over::<T, _>(TensionsWithin(self, step, s))
    }

    /// The tension of each cable at the start of the latest step \[F\].
    pub(crate) fn tensions_at_start(&self, step: &Step<T>) -> [T; MAX_CABLES] {
        dispatch_over::<T, _>(TensionsWithin(self, step, T::ZERO))
    }

    #[inline(always)]
    fn tensions_here(&self, step: &Step<T>, s: T) -> [T; MAX_CABLES] {
        let mut now = [T::ZERO; MAX_CABLES];
        let Some(series) = self.expanded(step.taut) else {
            return now;
        };
        if step.taut != step.carrying {
            let around = self.surroundings(step.t_start + s);
            let memory_force = series.memory_force(s);
            let state = series.state(s);
            return tensions(&self.system, &around, &state, memory_force, step.taut);
        }
        for cable in step.taut.iter() {
            now[cable] = series.tension(cable, s);
        }
        now
    }
}

/// Evenly spaced instants from one to another, both included.
#[inline(always)]
fn instants<T: Real>([first, last]: [T; 2]) -> [T; INSTANTS] {
    let mut instants = [T::ZERO; INSTANTS];
    for (k, instant) in instants.iter_mut().enumerate() {
        *instant = first + (last - first) * (k as f64 / (INSTANTS - 1) as f64);
    }
    instants
}

/// Where the parabola through three evenly spaced values is least, from the middle one and in
/// spacings, and its value there; none if it has no minimum.
#[inline(always)]
fn vertex<T: Real>([before, middle, after]: [T; 3]) -> Option<(T, T)> {
    let bend = (before - middle) + (after - middle);
    let slope = (after - before) * 0.5;
    (bend > T::ZERO).then(|| {
        let offset = -slope / bend;
        (offset, middle + slope * offset * 0.5)
    })
}

/// The least of evenly spaced values, or of the parabola through it and its neighbours.
#[inline(always)]
fn lowest<T: Real>(values: &[T; INSTANTS]) -> T {
    let mut at = 0;
    for k in 1..INSTANTS {
        at = if values[k] < values[at] { k } else { at };
    }
    let middle = at.clamp(1, INSTANTS - 2);
    let around = [values[middle - 1], values[middle], values[middle + 1]];
    match vertex(around) {
        Some((offset, value)) if offset.abs() <= T::ONE => values[at].min(value),
        _ => values[at],
    }
}

/// The least and the largest of evenly spaced values, likewise.
#[inline(always)]
fn range<T: Real>(mut values: [T; INSTANTS]) -> [T; 2] {
    let least = lowest(&values);
    for value in &mut values {
        *value = -*value;
    }
    [least, -lowest(&values)]
}
