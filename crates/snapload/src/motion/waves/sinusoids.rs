//! The sinusoids about a system, each frequency once, and their sums over one stretch of time.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::processor::Kernel;
use crate::arithmetic::real::Real;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;

/// Coefficients of a polynomial.
const TERMS: usize = 36;
/// h Ω.
pub(super) const RADIANS: f64 = 2.0;
/// So many frequencies or fewer are summed up each time.
const FEW: usize = 8;
/// Force (2), velocity of the water (2), excitation (3), and nothing.
type Parts<T> = [T; 8];

/// All of one frequency.
#[derive(Clone, Debug)]
struct Sinusoid<T> {
    omega: T,
    cosine: Parts<T>,
    sine: Parts<T>,
}

/// All frequencies, and what does not change.
#[derive(Clone, Debug)]
pub(super) struct Sinusoids<T> {
    each: Vec<Sinusoid<T>>,
    constant: Parts<T>,
    /// h.
    pub(super) half: T,
}

/// One stretch: the polynomial in u.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<T> {
    /// Which of the stretches from time zero; none before it is made.
    pub(super) index: Option<i64>,
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

impl<T: Real> Sinusoids<T> {
    /// None where they are few, which in arithmetics that are slow anyway they always count as.
    pub(super) fn of(system: &System<T>) -> Option<Self> {
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
pub(super) struct Summing<'a, T>(pub(super) &'a Sinusoids<T>, pub(super) i64);

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
    /// None that has been made.
    pub(super) fn unmade() -> Self {
        Self {
            index: None,
            middle: T::ZERO,
            terms: [[T::ZERO; 8]; TERMS],
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, half: T, t: T) -> Surroundings<T> {
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
    pub(super) fn expanded(&self, half: T, t: T) -> Expanded<T> {
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
    pub(super) fn of(system: &System<T>, t: T) -> Self {
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
