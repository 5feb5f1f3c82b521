//! The sums over all sinusoids that push at a body, as polynomials of time where they are many.
//!
//! A sea has some hundred sinusoids, and a motion asks for their sums many times within a small part
//! of the quickest period. So they are summed up once for each stretch of time of length 2h, with
//! h = 2/Ω and Ω the largest frequency, as a Taylor polynomial about its middle t_m in u = (t − t_m)/h:
//!
//! ```text
//! c cos ωt + d sin ωt = Σ_k ± (ωh)^k/k! u^k times c' where k is even, d' where it is odd
//! ```
//!
//! with c' and d' the amplitudes seen from t_m. What is left out is at most (Ωs)^36/36! of the
//! amplitudes a time s from the middle, 4e-19 at Ωs = 4.4: that is a step of a Taylor series, on
//! which Ωs < 2.4, beyond an end of the stretch. Rounding is that of Σ (ωh)^k/k! ≤ e² amplitudes; so it
//! is in the series about another time, which is the same polynomial. The stretches are the same
//! whatever is asked for first, so that the same case has the same numbers, and up to [`FEW`]
//! frequencies are summed up each time, to the bit as they always were.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use std::sync::Arc;

/// Coefficients of a polynomial.
const TERMS: usize = 36;
/// h Ω.
const RADIANS: f64 = 2.0;
/// So many frequencies or fewer are summed up each time.
const FEW: usize = 8;
/// How many stretches are kept: a step touches three at most.
const KEPT: usize = 4;

/// Force (2), velocity of the water (2), excitation (3), and nothing.
type Parts<T> = [T; 8];

/// The sums over all sinusoids about a system.
#[derive(Clone, Debug)]
pub struct Waves<T: Real = f64> {
    /// None where the sinusoids are few, or the numbers no doubles.
    stretches: Option<Box<Stretches<T>>>,
}

/// The latest stretches of time.
#[derive(Clone, Debug)]
struct Stretches<T> {
    sinusoids: Arc<Sinusoids<T>>,
    kept: [Stretch<T>; KEPT],
    /// The place of the one that goes next.
    oldest: usize,
}

/// All of one frequency.
#[derive(Clone, Debug)]
struct Sinusoid<T> {
    omega: T,
    cosine: Parts<T>,
    sine: Parts<T>,
}

/// All frequencies, and what does not change.
#[derive(Clone, Debug)]
struct Sinusoids<T> {
    each: Vec<Sinusoid<T>>,
    constant: Parts<T>,
    /// h.
    half: T,
}

/// One stretch: the polynomial in u.
#[derive(Clone, Copy, Debug)]
struct Stretch<T> {
    /// Which of the stretches from time zero; none before it is made.
    index: Option<i64>,
    /// t_m.
    middle: T,
    terms: [Parts<T>; TERMS],
}

/// The series of what acts from outside about a time.
pub(crate) struct Expanded<T: Real> {
    pub(crate) force: [Polynomial<T>; 2],
    pub(crate) water: [Polynomial<T>; 2],
    pub(crate) excitation: [Polynomial<T>; 3],
}

impl<T: Real> Waves<T> {
    /// About a system.
    pub fn new(system: &System<T>) -> Self {
        let stretches = Sinusoids::of(system).map(|sinusoids| {
            let none = Stretch {
                index: None,
                middle: T::ZERO,
                terms: [[T::ZERO; 8]; TERMS],
            };
            Box::new(Stretches {
                sinusoids: Arc::new(sinusoids),
                kept: [none; KEPT],
                oldest: 0,
            })
        });
        Self { stretches }
    }

    /// Makes all times from one to another quick to ask for, of a longer span the last of it.
    #[inline(always)]
    pub fn cover(&mut self, from: T, to: T) {
        if let Some(stretches) = &mut self.stretches {
            stretches.cover(from, to);
        }
    }

    /// What acts at a time; where that is not covered, each sinusoid is summed up.
    #[inline(always)]
    pub fn at(&self, system: &System<T>, t: T) -> Surroundings<T> {
        match self.stretch(t) {
            Some((stretch, half)) => stretch.at(half, t),
            None => system.surroundings(t),
        }
    }

    /// Its series about a time.
    #[inline(always)]
    pub(crate) fn expanded(&self, system: &System<T>, t: T) -> Expanded<T> {
        match self.stretch(t) {
            Some((stretch, half)) => stretch.expanded(half, t),
            None => Expanded::of(system, t),
        }
    }

    /// The stretch in which a time lies, and h.
    #[inline(always)]
    fn stretch(&self, t: T) -> Option<(&Stretch<T>, T)> {
        let stretches = self.stretches.as_ref()?;
        let half = stretches.sinusoids.half;
        let index = Some(index_of(half, t));
        let mut kept = stretches.kept.iter();
        kept.find(|stretch| stretch.index == index)
            .map(|stretch| (stretch, half))
    }
}

/// Which stretch a time lies in.
#[inline(always)]
fn index_of<T: Real>(half: T, t: T) -> i64 {
    (t.to_f64() / (2.0 * half.to_f64())).floor() as i64
}

impl<T: Real> Stretches<T> {
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

impl<T: Real> Sinusoids<T> {
    /// None where they are few, which in arithmetics that are slow anyway they always count as.
    fn of(system: &System<T>) -> Option<Self> {
        if !T::FUSES {
            return None;
        }
        let mut each = Vec::new();
        let mut add = |omega: T, place: usize, cosine: &[T], sine: &[T]| {
            let mut wave = Sinusoid {
                omega,
                cosine: [T::ZERO; 8],
                sine: [T::ZERO; 8],
            };
            wave.cosine[place..place + cosine.len()].copy_from_slice(cosine);
            wave.sine[place..place + sine.len()].copy_from_slice(sine);
            each.push(wave);
        };
        let water = system.drag.iter().flat_map(|drag| &drag.water);
        let forces = system.forcing.harmonics.iter().map(|wave| (0, wave));
        for (place, wave) in forces.chain(water.map(|wave| (2, wave))) {
            let [cosine, sine] = [wave.cosine, wave.sine].map(|part| part.components());
            add(wave.omega, place, &cosine, &sine);
        }
        for wave in system.floating.iter().flat_map(|water| &water.excitation) {
            add(wave.omega, 4, &wave.cosine, &wave.sine);
        }
        let quickest = |most: T, wave: &Sinusoid<T>| most.max(wave.omega.abs());
        let quickest = each.iter().fold(T::ZERO, quickest);
        let each = merged(each);
        let mut constant = [T::ZERO; 8];
        constant[..2].copy_from_slice(&system.forcing.constant.components());
        if let Some(water) = &system.floating {
            constant[4..7].copy_from_slice(&water.constant);
        }
        (each.len() > FEW && quickest > T::ZERO && quickest.is_finite()).then(|| Self {
            each,
            constant,
            half: T::from_f64(RADIANS) / quickest,
        })
    }
}

/// Those of one frequency as one, in order of their frequencies.
fn merged<T: Real>(mut each: Vec<Sinusoid<T>>) -> Vec<Sinusoid<T>> {
    each.sort_by(|a, b| a.omega.to_f64().total_cmp(&b.omega.to_f64()));
    each.dedup_by(|next, kept| {
        let same = next.omega == kept.omega;
        if same {
            for i in 0..8 {
                kept.cosine[i] += next.cosine[i];
                kept.sine[i] += next.sine[i];
            }
        }
        same
    });
    each
}

/// A stretch to be summed up, by the best instructions for it.
struct Summing<'a, T>(&'a Sinusoids<T>, i64);

impl<T: Real> Kernel for Summing<'_, T> {
    type Output = Stretch<T>;
    #[inline(always)]
    fn run(self) -> Stretch<T> {
        let Self(sinusoids, index) = self;
        let half = sinusoids.half;
        let middle = half * ((index as f64 + 0.5) * 2.0);
        let mut terms = [[T::ZERO; 8]; TERMS];
        terms[0] = sinusoids.constant;
        for wave in &sinusoids.each {
            let (s, c) = (wave.omega * middle).sin_cos();
            let mut parts = [[T::ZERO; 8]; 2];
            for (i, (cosine, sine)) in wave.cosine.iter().zip(&wave.sine).enumerate() {
                parts[0][i] = s.mul_add(*sine, c * *cosine);
                parts[1][i] = c.mul_add(*sine, -(s * *cosine));
            }
            let radians = wave.omega * half;
            let mut factor = T::ONE;
            for k in 0..TERMS {
                let sign = if k % 4 < 2 { factor } else { -factor };
                let part = &parts[k % 2];
                for (term, part) in terms[k].iter_mut().zip(part) {
                    *term = sign.mul_add(*part, *term);
                }
                factor = factor * radians * SHARES[k];
            }
        }
        Stretch {
            index: Some(index),
            middle,
            terms,
        }
    }
}

/// 1/(k + 1).
const SHARES: [f64; TERMS] = {
    let mut shares = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        shares[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    shares
};

impl<T: Real> Stretch<T> {
    #[inline(always)]
    fn at(&self, half: T, t: T) -> Surroundings<T> {
        let u = (t - self.middle) / half;
        let mut sum = [T::ZERO; 8];
        for k in (0..TERMS).rev() {
            for (sum, term) in sum.iter_mut().zip(&self.terms[k]) {
                *sum = sum.mul_add(u, *term);
            }
        }
        Surroundings {
            force: [sum[0], sum[1]].into(),
            water: [sum[2], sum[3]].into(),
            excitation: [sum[4], sum[5], sum[6]],
        }
    }

    /// The same polynomial about another time, by repeated division, as far as a series goes.
    #[inline(always)]
    fn expanded(&self, half: T, t: T) -> Expanded<T> {
        let u = (t - self.middle) / half;
        let mut terms = self.terms;
        let mut expanded = Expanded {
            force: [Polynomial::default(); 2],
            water: [Polynomial::default(); 2],
            excitation: [Polynomial::default(); 3],
        };
        let (mut scale, share) = (T::ONE, T::ONE / half);
        for order in 0..=ORDER {
            for k in (order..TERMS - 1).rev() {
                let (known, next) = terms.split_at_mut(k + 1);
                for (term, next) in known[k].iter_mut().zip(&next[0]) {
                    *term = next.mul_add(u, *term);
                }
            }
            let found = terms[order];
            for i in 0..2 {
                expanded.force[i][order] = found[i] * scale;
                expanded.water[i][order] = found[2 + i] * scale;
            }
            for i in 0..3 {
                expanded.excitation[i][order] = found[4 + i] * scale;
            }
            scale = scale * share;
        }
        expanded
    }
}

impl<T: Real> Expanded<T> {
    /// Each sinusoid by itself.
    #[inline(always)]
    fn of(system: &System<T>, t: T) -> Self {
        let mut force = [Polynomial::default(); 2];
        let constant = system.forcing.constant;
        (force[0][0], force[1][0]) = (constant.x, constant.y);
        for harmonic in &system.forcing.harmonics {
            harmonic.expand(t, &mut force);
        }
        let mut water = [Polynomial::default(); 2];
        for wave in system.drag.iter().flat_map(|drag| &drag.water) {
            wave.expand(t, &mut water);
        }
        let mut excitation = [Polynomial::default(); 3];
        if let Some(floating) = &system.floating {
            for (series, constant) in excitation.iter_mut().zip(floating.constant) {
                series[0] = constant;
            }
            for wave in &floating.excitation {
                wave.expand(t, &mut excitation);
            }
        }
        Self {
            force,
            water,
            excitation,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Expanded, Waves};
    use crate::arithmetic::polynomial::{ORDER, Polynomial};
    use crate::model::body::{Body, Shape};
    use crate::model::drag::Drag;
    use crate::model::floating::{Excitation, Floating};
    use crate::model::forcing::{Forcing, Harmonic};
    use crate::model::surroundings::Surroundings;
    use crate::model::system::System;

    /// A sea of 60 sinusoids on a body that floats and is held back.
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

    fn numbers(around: &Surroundings) -> [f64; 7] {
        let Surroundings {
            force,
            water,
            excitation: [a, b, c],
        } = *around;
        [force.x, force.y, water.x, water.y, a, b, c]
    }

    /// The same as summed up one by one, at any time and in any order, at the ends of stretches and
    /// where nothing is covered.
    #[test]
    fn many_waves_are_what_they_are_one_by_one() {
        let system = sea();
        let mut waves = Waves::new(&system);
        assert!(waves.stretches.is_some());
        let quickest = 0.07 * 70.0;
        for k in 0..4000_u32 {
            let t = match k % 3 {
                0 => f64::from(k * 7919 % 4000) * 0.2517,
                1 => f64::from(k) * (2.0 * super::RADIANS) / quickest,
                _ => f64::from(k) * -0.317,
            };
            if k % 5 > 0 {
                waves.cover(t - 0.3, t);
                assert!(waves.stretch(t).is_some());
            }
            let known = numbers(&system.surroundings(t));
            let found = numbers(&waves.at(&system, t));
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

    /// The series about a time have the coefficients that each sinusoid's series add up to, and give
    /// the sums, as far as a step reaches.
    #[test]
    fn series_are_those_of_the_sinusoids() {
        let system = sea();
        let mut waves = Waves::new(&system);
        let quickest = 0.07 * 70.0_f64;
        for k in 0..400_u32 {
            let t = f64::from(k * 131 % 400) * 0.613 - 20.0;
            waves.cover(t, t);
            let found = all(&waves.expanded(&system, t));
            let known = all(&Expanded::of(&system, t));
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

    /// Up to eight frequencies are summed up each time, to the bit.
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
        assert!(waves.stretches.is_none());
        assert_eq!(waves.at(&system, 0.7), system.surroundings(0.7));
    }
}
