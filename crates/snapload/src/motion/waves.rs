//! The sums over all sinusoids that act on a body, as polynomials of time if they are many.
//!
//! A sea has some hundred sinusoids, and a motion needs their sums many times within a small part
//! of the shortest period. So they are summed up once for each time interval of length 2h, with h
//! = 2/Ω and Ω the largest frequency, as a Taylor polynomial about its middle t_m in u = (t −
//! t_m)/h:
//!
//! ```text
//! c cos ωt + d sin ωt = Σ_k ± (ωh)^k/k! u^k times c' where k is even, d' where it is odd
//! ```
//!
//! with c' and d' the amplitudes relative to t_m. The truncation error is at most (Ωs)^36/36! of
//! the amplitudes a time s from the middle, 4e-19 at Ωs = 4.4: that is a step of a Taylor series
//! with Ωs = 2.4 beyond an end of the interval. A wave with a larger Ωs on a step causes a similar
//! truncation error in the series of the motion, (Ωs)^29/29! of its amplitude, and the step is so
//! long only if that is below rounding because the wave is small. The rounding error is that of Σ
//! (ωh)^k/k! ≤ e² amplitudes; it is the same in the series about another time, which is the same
//! polynomial. The intervals do not depend on the order of the calls, so that the same case gives
//! the same numbers, and up to eight frequencies are summed up directly each time, with the same
//! bits as without this file.

use crate::arithmetic::processor::dispatch_over;
use crate::arithmetic::real::Real;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::motion::waves::sinusoids::{Expanded, Sinusoids, Summing, TimeInterval};
use std::sync::Arc;

pub(crate) mod sinusoids;

/// The number of intervals kept: a step overlaps three at most.
const KEPT: usize = 4;

/// The sums over all sinusoids of a system.
#[derive(Clone, Debug)]
pub struct Waves<T: Real = f64> {
    /// None if the sinusoids are few, or the numbers are not doubles.
    intervals: Option<Box<Intervals<T>>>,
}

/// The latest time intervals.
#[derive(Clone, Debug)]
struct Intervals<T> {
    sinusoids: Arc<Sinusoids<T>>,
    kept: [TimeInterval<T>; KEPT],
    /// The index of the one that is replaced next.
    oldest: usize,
}

impl<T: Real> Waves<T> {
    /// The sums for a system.
    pub fn new(system: &System<T>) -> Self {
        let intervals = Sinusoids::of(system).map(|sinusoids| {
            Box::new(Intervals {
                sinusoids: Arc::new(sinusoids),
                kept: [TimeInterval::empty(); KEPT],
                oldest: 0,
            })
        });
        Self { intervals }
    }

    /// Prepares the sums for all times from one to another; if the span is long, for its last part.
    #[inline(always)]
    pub fn cover(&mut self, from: T, to: T) {
        if let Some(intervals) = &mut self.intervals {
            intervals.cover(from, to);
        }
    }

    /// The external forces at a time; if it is not covered, each sinusoid is evaluated.
    #[inline(always)]
    pub fn at(&self, system: &System<T>, t: T) -> Surroundings<T> {
        match self.interval(t) {
            Some((interval, half)) => interval.at(half, t),
            None => system.surroundings(t),
        }
    }

    /// Its series about a time.
    #[inline(always)]
    pub(crate) fn expanded(&self, system: &System<T>, t: T) -> Expanded<T> {
        match self.interval(t) {
            Some((interval, half)) => interval.expanded(half, t),
            None => Expanded::of(system, t),
        }
    }

    /// The interval in which a time lies, and h.
    #[inline(always)]
    fn interval(&self, t: T) -> Option<(&TimeInterval<T>, T)> {
        let intervals = self.intervals.as_ref()?;
        let half = intervals.sinusoids.half;
        let index = Some(index_of(half, t));
        let mut kept = intervals.kept.iter();
        kept.find(|interval| interval.index == index)
            .map(|interval| (interval, half))
    }
}

/// Which interval a time lies in.
#[inline(always)]
fn index_of<T: Real>(half: T, t: T) -> i64 {
    (t.to_f64() / (2.0 * half.to_f64())).floor() as i64
}

impl<T: Real> Intervals<T> {
    #[inline(always)]
    fn cover(&mut self, from: T, to: T) {
        let [first, last] = [from, to].map(|t| index_of(self.sinusoids.half, t));
        let first = first.max(last.saturating_sub(KEPT as i64 - 2));
        for index in first..=last {
            if self.kept.iter().all(|known| known.index != Some(index)) {
                let summing = Summing(&self.sinusoids, index);
                self.kept[self.oldest] = dispatch_over::<T, _>(summing);
                self.oldest = (self.oldest + 1) % KEPT;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Waves;
    use super::sinusoids::Expanded;
    use crate::arithmetic::polynomial::{ORDER, Polynomial};
    use crate::model::body::{Body, Shape};
    use crate::model::drag::Drag;
    use crate::model::floating::{Excitation, Floating};
    use crate::model::forcing::{Forcing, Harmonic};
    use crate::model::surroundings::Surroundings;
    use crate::model::system::System;

    /// A sea of 60 sinusoids on a floating body with drag.
    fn sea() -> System {
        let wave = |k: u32, size: f64| {
            let (k, part) = (f64::from(k), size / f64::from(k));
            Harmonic {
                omega: 0.07 * k,
                cosine: [part * (k * 1.3).cos(), part * (k * 0.7).sin()].into(),
                sine: [part * (k * 2.1).sin(), part * (k * 0.3).cos()].into(),
            }
        };
        let excitation = |k: u32| {
            let (x, y) = (wave(k, 0.2), wave(k + 3, 0.4));
            Excitation {
                omega: x.omega,
                cosine: [x.cosine.x, y.cosine.y, x.sine.x],
                sine: [y.sine.x, x.sine.y, y.cosine.x],
            }
        };
        System {
            body: Body::rigid(Shape::Circle { radius: 0.2 }, 0.1),
            cables: Vec::new(),
            forcing: Forcing {
                constant: [0.1, -1.0].into(),
                harmonics: (1..=60).map(|k| wave(k, 0.5)).collect(),
            },
            drag: Some(Drag {
                linear: 0.1,
                quadratic: 0.4,
                turning: 0.02,
                water: (1..=60).map(|k| wave(k, 0.3)).collect(),
            }),
            floating: Some(Floating {
                constant: [0.02, 0.3, -0.1],
                excitation: (1..=70).map(excitation).collect(),
                ..Floating::default()
            }),
            restitution: 0.5,
        }
    }

    /// The same sea on a floating body and on one below the surface, which needs half of the sums.
    fn bodies() -> [System; 2] {
        let submerged = System {
            floating: None,
            ..sea()
        };
        [sea(), submerged]
    }

    fn numbers(around: &Surroundings) -> [f64; 7] {
        let Surroundings {
            force,
            water,
            excitation: [a, b, c],
        } = *around;
        [force.x, force.y, water.x, water.y, a, b, c]
    }

    /// The sums agree with those computed one by one, at any time and in any order, at the ends of
    /// intervals and at times that are not covered.
    #[test]
    fn many_waves_are_what_they_are_one_by_one() {
        bodies().iter().for_each(sums_are_right);
    }

    fn sums_are_right(system: &System) {
        let mut waves = Waves::new(system);
        assert!(waves.intervals.is_some());
        let quickest = 0.07 * 70.0;
        for k in 0..4000_u32 {
            let t = match k % 3 {
                0 => f64::from(k * 7919 % 4000) * 0.2517,
                1 => f64::from(k) * (2.0 * super::sinusoids::RADIANS) / quickest,
                _ => f64::from(k) * -0.317,
            };
            if k % 5 > 0 {
                waves.cover(t - 0.3, t);
                assert!(waves.interval(t).is_some());
            }
            let known = numbers(&system.surroundings(t));
            let found = numbers(&waves.at(system, t));
            for (found, known) in found.into_iter().zip(known) {
                assert!((found - known).abs() < 2e-13, "{t}: {found} {known}");
            }
        }
    }

    fn all(expanded: &Expanded<f64>) -> Vec<Polynomial<f64>> {
        let Expanded {
            force,
            water,
            excitation,
        } = expanded;
        force
            .iter()
            .chain(water)
            .chain(excitation)
            .copied()
            .collect()
    }

    /// The series about a time have the coefficients of the sum of the sinusoids' series, and give
    /// the sums on the length of a step.
    #[test]
    fn series_are_those_of_the_sinusoids() {
        bodies().iter().for_each(series_are_right);
    }

    fn series_are_right(system: &System) {
        let mut waves = Waves::new(system);
        let quickest = 0.07 * 70.0_f64;
        for k in 0..400_u32 {
            let t = f64::from(k * 131 % 400) * 0.613 - 20.0;
            waves.cover(t, t);
            let found = all(&waves.expanded(system, t));
            let known = all(&Expanded::of(system, t));
            let s = 2.4 / quickest;
            let mut power = 1.0;
            for order in 0..=ORDER {
                for (found, known) in found.iter().zip(&known) {
                    let error = (found[order] - known[order]).abs();
                    assert!(error * power < 1e-13, "{t}, order {order}: {error:e}");
                }
                power *= s;
            }
            let later = numbers(&system.surroundings(t + s));
            for (series, later) in found.iter().zip(later) {
                let [value, ..] = series.jet(s, ORDER);
                assert!((value - later).abs() < 1e-13, "{t}: {value} {later}");
            }
        }
    }

    /// Up to eight frequencies are summed up directly each time, to the bit.
    #[test]
    fn few_waves_are_summed_up_each_time() {
        let mut system = sea();
        system.forcing.harmonics.truncate(8);
        if let (Some(drag), Some(water)) = (&mut system.drag, &mut system.floating) {
            drag.water.truncate(8);
            water.excitation.truncate(8);
        }
        let mut waves = Waves::new(&system);
        waves.cover(0.3, 0.9);
        assert!(waves.intervals.is_none());
        assert_eq!(waves.at(&system, 0.7), system.surroundings(0.7));
    }
}
