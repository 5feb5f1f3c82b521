//! The sinusoids of a system, each frequency once, and their sums over one time interval.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::processor::Kernel;
use crate::arithmetic::real::Real;
use crate::model::surroundings::Surroundings;
use crate::model::system::{FEW_SINUSOIDS, System};

/// Coefficients of a polynomial.
const TERMS: usize = 36;
/// h Ω.
pub(super) const RADIANS: f64 = 2.0;
/// The numbers of one vector register.
type Quad<T> = [T; 4];
/// Force (2) and velocity of the water (2); excitation (3), and an unused zero.
type Parts<T> = [Quad<T>; 2];
/// The number of sinusoids that are summed up at once.
const TOGETHER: usize = 32;
/// The number of orders that are summed up at once, which is even: as many sums as fit into the
/// registers.
const BLOCK: usize = 12;
/// The number of coefficients about another time that are found at once.
const CHAINS: usize = 6;

/// All sinusoids of one frequency.
#[derive(Clone, Debug)]
struct Sinusoid<T> {
    omega: T,
    cosine: Parts<T>,
    sine: Parts<T>,
    /// ± (ωh)^k/k!.
    factors: [T; TERMS],
}

/// All frequencies, and the numbers that do not change.
#[derive(Clone, Debug)]
pub(super) struct Sinusoids<T> {
    each: Vec<Sinusoid<T>>,
    constant: Parts<T>,
    /// The number of quads that are not zero: the second is needed for a floating body only.
    quads: usize,
    /// h.
    pub(super) half: T,
}

/// One interval: the polynomial in u.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeInterval<T> {
    /// The number of the interval, counted from time zero; none before it is summed up.
    pub(super) index: Option<i64>,
    /// t_m.
    middle: T,
    quads: usize,
    terms: [[Quad<T>; TERMS]; 2],
}

/// The series of the external forces about a time.
pub(crate) struct Expanded<T: Real> {
    pub(crate) force: [Polynomial<T>; 2],
    pub(crate) water: [Polynomial<T>; 2],
    pub(crate) excitation: [Polynomial<T>; 3],
}

impl<T: Real> Sinusoids<T> {
    /// None if they are few; over number types other than doubles, which are slow anyway, always
    /// none.
    pub(super) fn of(system: &System<T>) -> Option<Self> {
        if !T::FUSES {
            return None;
        }
        let mut each = Vec::new();
        let mut add = |omega: T, place: usize, cosine: &[T], sine: &[T]| {
            let nothing = [[T::ZERO; 4]; 2];
            let mut wave = Sinusoid {
                omega,
                cosine: nothing,
                sine: nothing,
                factors: [T::ZERO; TERMS],
            };
            let places = place..place + cosine.len();
            wave.cosine.as_flattened_mut()[places.clone()].copy_from_slice(cosine);
            wave.sine.as_flattened_mut()[places].copy_from_slice(sine);
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
        let mut each = merged(each);
        let mut constant = [[T::ZERO; 4]; 2];
        constant[0][..2].copy_from_slice(&system.forcing.constant.components());
        if let Some(water) = &system.floating {
            constant[1][..3].copy_from_slice(&water.constant);
        }
        if each.len() <= FEW_SINUSOIDS || quickest <= T::ZERO || !quickest.is_finite() {
            return None;
        }
        let half = T::from_f64(RADIANS) / quickest;
        for wave in &mut each {
            wave.factors = factors(wave.omega * half);
        }
        Some(Self {
            each,
            constant,
            quads: if system.floating.is_some() { 2 } else { 1 },
            half,
        })
    }
}

/// ± (ωh)^k/k!.
fn factors<T: Real>(radians: T) -> [T; TERMS] {
    let (mut factors, mut factor) = ([T::ZERO; TERMS], T::ONE);
    for (k, signed) in factors.iter_mut().enumerate() {
        *signed = if k % 4 < 2 { factor } else { -factor };
        factor = factor * radians * SHARES[k];
    }
    factors
}

/// Merges sinusoids of equal frequency, and sorts them by frequency.
fn merged<T: Real>(mut each: Vec<Sinusoid<T>>) -> Vec<Sinusoid<T>> {
    each.sort_by(|a, b| a.omega.to_f64().total_cmp(&b.omega.to_f64()));
    each.dedup_by(|next, kept| {
        let same = next.omega == kept.omega;
        if same {
            let cosines = kept.cosine.as_flattened_mut().iter_mut();
            for (sum, more) in cosines.zip(next.cosine.as_flattened()) {
                *sum += *more;
            }
            let sines = kept.sine.as_flattened_mut().iter_mut();
            for (sum, more) in sines.zip(next.sine.as_flattened()) {
                *sum += *more;
            }
        }
        same
    });
    each
}

/// An interval to be summed up, by the best instructions for it.
pub(super) struct Summing<'a, T>(pub(super) &'a Sinusoids<T>, pub(super) i64);

impl<T: Real> Kernel for Summing<'_, T> {
    type Output = TimeInterval<T>;
    #[inline(always)]
    fn run(self) -> TimeInterval<T> {
        let Self(sinusoids, index) = self;
        let middle = sinusoids.half * ((index as f64 + 0.5) * 2.0);
        let mut terms = [[[T::ZERO; 4]; TERMS]; 2];
        for (terms, constant) in terms.iter_mut().zip(&sinusoids.constant) {
            terms[0] = *constant;
        }
        for waves in sinusoids.each.chunks(TOGETHER) {
            let mut turned = [[T::ZERO; 2]; TOGETHER];
            for (turned, wave) in turned.iter_mut().zip(waves) {
                let (s, c) = (wave.omega * middle).sin_cos();
                *turned = [s, c];
            }
            for (quad, terms) in terms.iter_mut().enumerate().take(sinusoids.quads) {
                add(waves, quad, &turned, terms);
            }
        }
        TimeInterval {
            index: Some(index),
            middle,
            quads: sinusoids.quads,
            terms,
        }
    }
}

/// Adds one quad of some sinusoids, given the sine and the cosine at the middle. A block of orders
/// is added at a time, so that its sums stay in registers while one sinusoid after the other is
/// added.
#[inline(always)]
fn add<T: Real>(
    waves: &[Sinusoid<T>],
    quad: usize,
    turned: &[[T; 2]; TOGETHER],
    terms: &mut [Quad<T>; TERMS],
) {
    let mut parts = [[[T::ZERO; 4]; 2]; TOGETHER];
    for ((parts, wave), [s, c]) in parts.iter_mut().zip(waves).zip(turned) {
        let (cosine, sine) = (&wave.cosine[quad], &wave.sine[quad]);
        for w in 0..4 {
            parts[0][w] = s.mul_add(sine[w], *c * cosine[w]);
            parts[1][w] = c.mul_add(sine[w], -(*s * cosine[w]));
        }
    }
    let (blocks, _) = terms.as_chunks_mut::<BLOCK>();
    for (block, sums) in blocks.iter_mut().enumerate() {
        let mut kept = *sums;
        for (wave, parts) in waves.iter().zip(&parts) {
            let (factors, _) = wave.factors.as_chunks::<BLOCK>();
            let factors = &factors[block];
            for k in 0..BLOCK {
                for w in 0..4 {
                    kept[k][w] = factors[k].mul_add(parts[k % 2][w], kept[k][w]);
                }
            }
        }
        *sums = kept;
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

impl<T: Real> TimeInterval<T> {
    /// An interval that is not summed up yet.
    pub(super) fn empty() -> Self {
        Self {
            index: None,
            middle: T::ZERO,
            quads: 0,
            terms: [[[T::ZERO; 4]; TERMS]; 2],
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, half: T, t: T) -> Surroundings<T> {
        let u = (t - self.middle) / half;
        let mut sums = [[T::ZERO; 4]; 2];
        for (sum, terms) in sums.iter_mut().zip(&self.terms).take(self.quads) {
            for term in terms.iter().rev() {
                horner(sum, u, term);
            }
        }
        let [[x, y, u, v], [surge, heave, pitch, _]] = sums;
        Surroundings {
            force: [x, y].into(),
            water: [u, v].into(),
            excitation: [surge, heave, pitch],
        }
    }

    /// The same polynomial about another time, up to the order of a series.
    #[inline(always)]
    pub(super) fn expanded(&self, half: T, t: T) -> Expanded<T> {
        let u = (t - self.middle) / half;
        let mut about = [[[T::ZERO; 4]; ORDER + 1]; 2];
        for (about, terms) in about.iter_mut().zip(&self.terms).take(self.quads) {
            *about = shifted(terms, u);
        }
        let mut expanded = Expanded {
            force: [Polynomial::default(); 2],
            water: [Polynomial::default(); 2],
            excitation: [Polynomial::default(); 3],
        };
        let (mut scale, share) = (T::ONE, T::ONE / half);
        let [of_all, afloat] = &about;
        for (order, (of_all, afloat)) in of_all.iter().zip(afloat).enumerate() {
            for i in 0..2 {
                expanded.force[i][order] = of_all[i] * scale;
                expanded.water[i][order] = of_all[2 + i] * scale;
            }
            for (series, term) in expanded.excitation.iter_mut().zip(afloat) {
                series[order] = *term * scale;
            }
            scale = scale * share;
        }
        expanded
    }
}

/// The first coefficients about `u`, by repeated division by a linear factor: each is the last
/// number of a chain of sums from the highest power down, and the next chain runs over the numbers
/// of the one before. Some chains run at once, each one number behind the one before it, as the
/// sums of a single chain would have to wait for each other.
#[inline(always)]
fn shifted<T: Real>(terms: &[Quad<T>; TERMS], u: T) -> [Quad<T>; ORDER + 1] {
    let mut terms = *terms;
    let mut found = [[T::ZERO; 4]; ORDER + 1];
    for (chunk, found) in found.chunks_mut(CHAINS).enumerate() {
        let first = chunk * CHAINS;
        let mut chains = [[T::ZERO; 4]; CHAINS];
        for k in (first..TERMS).rev() {
            for chain in (1..CHAINS).rev() {
                let ahead = chains[chain - 1];
                horner(&mut chains[chain], u, &ahead);
            }
            horner(&mut chains[0], u, &terms[k]);
            if let Some(passed) = terms.get_mut(k + CHAINS - 1) {
                *passed = chains[CHAINS - 1];
            }
        }
        found.copy_from_slice(&chains[..found.len()]);
    }
    found
}

/// One step of Horner's rule: the sum times `u`, plus the next term.
#[inline(always)]
fn horner<T: Real>(sum: &mut Quad<T>, u: T, term: &Quad<T>) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum = sum.mul_add(u, *term);
    }
}

impl<T: Real> Expanded<T> {
    /// The sums with each sinusoid evaluated by itself.
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
