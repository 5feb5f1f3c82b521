//! Taylor series of the cables' geometry and of what they pull, two cables side by side.

use crate::System;
use crate::bundle::Bundle;
use crate::real::{Real, cross};

/// x and y of one cable, x and y of the next.
type Quad<T> = [T; 4];

/// Two cables; where their number is odd, the last is alone.
#[derive(Clone, Copy, Debug, Default)]
struct Pair<T: Real> {
    /// The fairleads, and they turned by a quarter.
    fairleads: [Quad<T>; 2],
    /// 1/r.
    per_length: Quad<T>,
    /// ρ.
    lever: Bundle<T, 4>,
    /// d = P − A.
    span: Bundle<T, 4>,
    /// T, once for x and once for y.
    tension: Bundle<T, 4>,
    /// T n turned back by a quarter, (T n_y, −T n_x): ρ times this adds up to the moment ρ × T n.
    turned_pull: Bundle<T, 4>,
}

/// All cables of a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines<T: Real> {
    pairs: Vec<Pair<T>>,
}

impl<T: Real> Lines<T> {
    /// Begins new series.
    #[inline(always)]
    pub(crate) fn begin(&mut self, system: &System<T>) {
        self.pairs
            .resize(system.cables.len().div_ceil(2), Pair::default());
        for (pair, cables) in self.pairs.iter_mut().zip(system.cables.chunks(2)) {
            for series in [
                &mut pair.lever,
                &mut pair.span,
                &mut pair.tension,
                &mut pair.turned_pull,
            ] {
                *series = Bundle::default();
            }
            for (lane, cable) in cables.iter().enumerate() {
                let [x, y] = cable.fairlead();
                put(&mut pair.fairleads[0], lane, [x, y]);
                put(&mut pair.fairleads[1], lane, [-y, x]);
                put(&mut pair.per_length, lane, [cable.per_length(); 2]);
            }
        }
    }

    /// ρ and d to order k; d but for its constant.
    #[inline(always)]
    pub(crate) fn extend(&mut self, k: usize, centre: [T; 2], sine: T, cosine: T) {
        let centre = [centre[0], centre[1], centre[0], centre[1]];
        for pair in &mut self.pairs {
            let [along, across] = pair.fairleads;
            for w in 0..4 {
                let lever = along[w].mul_add(cosine, across[w] * sine);
                pair.lever[k][w] = lever;
                pair.span[k][w] = centre[w] + lever;
            }
        }
    }

    /// Gives d at the start.
    #[inline(always)]
    pub(crate) fn set_span(&mut self, cable: usize, span: [T; 2]) {
        put(&mut self.pairs[cable / 2].span[0], cable % 2, span);
    }

    /// n and s = ρ × n at the start.
    #[inline(always)]
    pub(crate) fn normal_and_arm(&self, cable: usize) -> ([T; 2], T) {
        let pair = &self.pairs[cable / 2];
        let at = |quad: &Quad<T>| get(quad, cable % 2);
        let (span, per_length) = (at(&pair.span[0]), at(&pair.per_length));
        let normal = [span[0] * per_length[0], span[1] * per_length[1]];
        (normal, cross(at(&pair.lever[0]), normal))
    }

    /// Σ T n and Σ ρ × T n to order k of the cables with tensions, as far as those of lower orders give them; keeps each T n,
    /// to which [`Lines::pull`] adds the rest.
    #[inline(always)]
    pub(crate) fn pulls(&mut self, k: usize) -> [T; 3] {
        let mut sums = [T::ZERO; 3];
        for pair in &mut self.pairs {
            let stretched = pair.span.convolve(&pair.tension, k);
            let known = pair.lever.convolve(&pair.turned_pull, k);
            let pull: Quad<T> = std::array::from_fn(|w| stretched[w] * pair.per_length[w]);
            let turned = [pull[1], -pull[0], pull[3], -pull[2]];
            let lever = pair.lever[0];
            let moment: Quad<T> = std::array::from_fn(|w| lever[w].mul_add(turned[w], known[w]));
            pair.turned_pull[k] = turned;
            sums[0] += pull[0] + pull[2];
            sums[1] += pull[1] + pull[3];
            sums[2] += (moment[0] + moment[1]) + (moment[2] + moment[3]);
        }
        sums
    }

    /// Adds what the k-th coefficient of a tension gives.
    #[inline(always)]
    pub(crate) fn pull(&mut self, cable: usize, k: usize, tension: T, normal: [T; 2]) {
        let (pair, lane) = (&mut self.pairs[cable / 2], cable % 2);
        put(&mut pair.tension[k], lane, [tension; 2]);
        let known = get(&pair.turned_pull[k], lane);
        let turned = [
            normal[1].mul_add(tension, known[0]),
            (-normal[0]).mul_add(tension, known[1]),
        ];
        put(&mut pair.turned_pull[k], lane, turned);
    }

    /// Σ d_j·d_{k−j} of both cables of a pair, d_k not being known yet.
    #[inline(always)]
    pub(crate) fn bends(&self, pair: usize, k: usize) -> [T; 2] {
        let span = &self.pairs[pair].span;
        let square = span.convolve(span, k);
        [square[0] + square[1], square[2] + square[3]]
    }

    /// 2 d_0·d_k of a cable.
    #[inline(always)]
    pub(crate) fn ends(&self, cable: usize, k: usize) -> T {
        let span = &self.pairs[cable / 2].span;
        let ([a, b], [c, d]) = (get(&span[0], cable % 2), get(&span[k], cable % 2));
        a.mul_add(c, b * d) * 2.0
    }
}

#[inline(always)]
fn put<T>(quad: &mut Quad<T>, lane: usize, [x, y]: [T; 2]) {
    (quad[2 * lane], quad[2 * lane + 1]) = (x, y);
}

#[inline(always)]
fn get<T: Copy>(quad: &Quad<T>, lane: usize) -> [T; 2] {
    [quad[2 * lane], quad[2 * lane + 1]]
}
