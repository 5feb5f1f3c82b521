//! Taylor series of the cables' geometry and of their forces, for two cables side by side.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::{Lane, Mask};
use crate::arithmetic::plane::Vector2;
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::arithmetic::vector_series::{VectorSeries, convolve};
use crate::model::cable::Normal;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::Factored;

/// The x and y of one cable, and the x and y of the next.
type Quad<T> = [T; 4];

/// Evaluates an expression at each of the four places. It is not a closure: a closure that the
/// compiler does not inline would have no fused multiply-add instruction, see
/// [`crate::arithmetic::processor`].
macro_rules! quad {
    (|$place:ident| $number:expr) => {{
        let mut quad = [Lane::ZERO; 4];
        for $place in 0..4 {
            quad[$place] = $number;
        }
        quad
    }};
}

/// Two cables; if their number is odd, the last is alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct CablePair<L> {
    /// The fairleads, and the fairleads turned by a quarter.
    fairleads: [Quad<L>; 2],
    /// 1/r.
    per_length: Quad<L>,
    /// n at the start, s = ρ × n and 1/2r; zero for a cable that does not carry.
    normal: Quad<L>,
    arm: [L; 2],
    half_per_length: [L; 2],
    /// ρ.
    lever: VectorSeries<L, 4>,
    /// d = P − A.
    span: VectorSeries<L, 4>,
    /// T twice, once for x and once for y.
    tension: VectorSeries<L, 4>,
    /// T n turned back by a quarter, (T n_y, −T n_x): ρ times this adds up to the moment ρ × T n.
    turned_pull: VectorSeries<L, 4>,
    /// The part of the gaps' latest coefficients that does not depend on the latest of d.
    known_gap: [L; 2],
}

impl<L: Lane> Default for CablePair<L> {
    fn default() -> Self {
        Self {
            fairleads: [[L::ZERO; 4]; 2],
            per_length: [L::ZERO; 4],
            normal: [L::ZERO; 4],
            arm: [L::ZERO; 2],
            half_per_length: [L::ZERO; 2],
            lever: VectorSeries::default(),
            span: VectorSeries::default(),
            tension: VectorSeries::default(),
            turned_pull: VectorSeries::default(),
            known_gap: [L::ZERO; 2],
        }
    }
}

/// All cables of a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct CableSeries<T: Real> {
    pairs: Vec<CablePair<T>>,
}

impl<T: Real> CableSeries<T> {
    /// Begins new series.
    #[inline(always)]
    pub(crate) fn begin(&mut self, system: &System<T>) {
        apart!(T, {
            let pairs = system.cables.len().div_ceil(2);
            self.pairs.resize_with(pairs, CablePair::default);
            for (pair, cables) in self.pairs.iter_mut().zip(system.cables.chunks(2)) {
                pair.clear();
                pair.known_gap = [T::ZERO; 2];
                for (place, cable) in cables.iter().enumerate() {
                    let fairlead = cable.fairlead();
                    put(&mut pair.fairleads[0], place, fairlead);
                    put(&mut pair.fairleads[1], place, fairlead.quarter_turn());
                    put(&mut pair.per_length, place, [cable.per_length(); 2].into());
                }
            }
        })
    }

    /// Extends ρ and d to order k; the constant of d is given separately.
    #[inline(always)]
    pub(crate) fn extend(&mut self, k: usize, centre: [T; 2], rotation: [T; 2]) {
        for pair in &mut self.pairs {
            pair.extend(k, centre, rotation);
        }
    }

    /// Sets d at the start.
    #[inline(always)]
    pub(crate) fn set_span(&mut self, cable: usize, span: Vector2<T>) {
        put(&mut self.pairs[cable / 2].span[0], cable % 2, span);
    }

    /// Sets which cables carry, once ρ and d at the start are known. Returns their normals.
    #[inline(always)]
    pub(crate) fn set_carrying(&mut self, carrying: TautSet) -> PerCable<Normal<T>> {
        let mut normals = [Normal::default(); MAX_CABLES];
        for (cables, pair) in self.pairs.iter_mut().enumerate() {
            for place in 0..2 {
                let cable = 2 * cables + place;
                let carries = carrying.contains(cable);
                let per_length = pair.per_length[2 * place];
                if carries {
                    let (span, lever) = (get(&pair.span[0], place), get(&pair.lever[0], place));
                    let n = span.scaled(per_length);
                    let arm = lever.cross(n);
                    normals[cable] = Normal { n, arm };
                }
                let half = if carries { 0.5 } else { 0.0 };
                pair.half_per_length[place] = per_length * half;
                put(&mut pair.normal, place, normals[cable].n);
                pair.arm[place] = normals[cable].arm;
            }
        }
        normals
    }

    /// The part of Σ T n and Σ ρ × T n at order k, for cables with tensions, that follows from the
    /// lower orders; keeps each T n, to which [`CableSeries::find_tensions`] adds the rest.
    #[inline(always)]
    pub(crate) fn known_forces(&mut self, k: usize) -> [T; 3] {
        apart!(T, {
            let mut sums = [T::ZERO; 3];
            for pair in &mut self.pairs {
                let more = pair.known_forces(k);
                for (sum, more) in sums.iter_mut().zip(more) {
                    *sum += more;
                }
            }
            sums
        })
    }

    /// Finds the k-th coefficients of the tensions, from the condition that the lengths of the
    /// carrying cables are constant; returns their Σ T n and Σ s T. `accel` are the coefficients of
    /// (ẍ, ÿ, θ̈) without these tensions, and `turned` those of order k + 2 of sine and cosine
    /// without the part of θ.
    #[inline(always)]
    pub(crate) fn find_tensions(
        &mut self,
        k: usize,
        accel: [T; 3],
        turned: [T; 2],
        ready: &Factored<T, impl Fn(usize, usize) -> T>,
    ) -> [T; 3] {
        apart!(T, {
            // Usually there are two cables; then all numbers stay in registers.
            if let [pair] = &mut self.pairs[..] {
                let load = pair.load(k, accel, turned);
                return pair.take(k, ready.solve_two(load));
            }
            let mut loads = [T::ZERO; MAX_CABLES];
            for (pair, loads) in self.pairs.iter_mut().zip(loads.chunks_exact_mut(2)) {
                loads.copy_from_slice(&pair.load(k, accel, turned));
            }
            let tensions = ready.solve(&loads);
            let mut sums = [T::ZERO; 3];
            for (pair, tension) in self.pairs.iter_mut().zip(tensions.chunks_exact(2)) {
                let more = pair.take(k, [tension[0], tension[1]]);
                for (sum, more) in sums.iter_mut().zip(more) {
                    *sum += more;
                }
            }
            sums
        })
    }

    /// Coefficients of order k of the tensions of a pair.
    #[inline(always)]
    pub(crate) fn tensions(&self, pair: usize, k: usize) -> [T; 2] {
        self.pairs[pair].tensions(k)
    }

    /// Bounds on the terms of the gaps of a pair beyond the last order, up to the factor
    /// s^{[`ORDER`](crate::arithmetic::polynomial::ORDER) + 1}.
    #[inline(always)]
    pub(crate) fn beyond_gaps(&self, pair: usize, s: T) -> [T; 2] {
        let span = &self.pairs[pair].span;
        let [x, y, other_x, other_y] = span.beyond_product(span, s);
        [x + y, other_x + other_y]
    }

    /// Coefficients of order k of the gaps of a pair, |d|² − r², once d is known to that order.
    #[inline(always)]
    pub(crate) fn gaps(&self, pair: usize, k: usize) -> [T; 2] {
        let CablePair {
            span, known_gap, ..
        } = &self.pairs[pair];
        let (first, last) = (span[0], span[k]);
        let twice = quad!(|w| first[w] * last[w] * 2.0);
        [
            known_gap[0] + (twice[0] + twice[1]),
            known_gap[1] + (twice[2] + twice[3]),
        ]
    }
}

impl<L: Lane> CablePair<L> {
    /// Removes all coefficients.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.lever.clear();
        self.span.clear();
        self.tension.clear();
        self.turned_pull.clear();
    }

    /// Extends ρ and d to order k, given the coefficients of the centre and of (cos θ, sin θ).
    #[inline(always)]
    pub(super) fn extend(&mut self, k: usize, centre: [L; 2], [cosine, sine]: [L; 2]) {
        let lever = self.turned(sine, cosine);
        self.lever[k] = lever;
        self.span[k] = quad!(|w| centre[w % 2] + lever[w]);
    }

    /// See [`CableSeries::known_forces`].
    #[inline(always)]
    pub(super) fn known_forces(&mut self, k: usize) -> [L; 3] {
        let stretched = (&self.span, &self.tension);
        let moments = (&self.lever, &self.turned_pull);
        // One run waits less with both in one pass; of several, the sums fill the registers.
        let [stretched, known] = match L::Mask::WIDTH {
            1 => convolve([stretched, moments], k),
            _ => [convolve([stretched], k)[0], convolve([moments], k)[0]],
        };
        let pull = quad!(|w| stretched[w] * self.per_length[w]);
        let turned = turned_back(&pull);
        let lever = self.lever[0];
        let moment = quad!(|w| lever[w].mul_add(turned[w], known[w]));
        self.turned_pull[k] = turned;
        [
            pull[0] + pull[2],
            pull[1] + pull[3],
            (moment[0] + moment[1]) + (moment[2] + moment[3]),
        ]
    }

    /// The load of each carrying cable: (k+1)(k+2) times the coefficient of order k + 2 of its
    /// constraint, without the tensions of order k.
    #[inline(always)]
    pub(super) fn load(&mut self, k: usize, accel: [L; 3], [sine, cosine]: [L; 2]) -> [L; 2] {
        apart!(L, {
            let orders = L::from_f64(((k + 1) * (k + 2)) as f64);
            let square = self.span.convolve(&self.span, k + 2);
            self.known_gap = [square[0] + square[1], square[2] + square[3]];
            let lever = self.turned(sine, cosine);
            let centre = [accel[0], accel[1], accel[0], accel[1]];
            let along = quad!(|w| self.normal[w] * lever[w].mul_add(orders, centre[w]));
            let mut load = [along[0] + along[1], along[2] + along[3]];
            for (place, load) in load.iter_mut().enumerate() {
                let known = self.known_gap[place] * self.half_per_length[place];
                let turning = self.arm[place] * accel[2];
                *load = known.mul_add(orders, *load + turning);
            }
            load
        })
    }

    /// Stores the k-th coefficients of the tensions; returns their Σ T n and Σ s T.
    #[inline(always)]
    pub(super) fn take(&mut self, k: usize, tension: [L; 2]) -> [L; 3] {
        let quad = [tension[0], tension[0], tension[1], tension[1]];
        let pull = quad!(|w| quad[w] * self.normal[w]);
        let (known, turned) = (self.turned_pull[k], turned_back(&pull));
        self.tension[k] = quad;
        self.turned_pull[k] = quad!(|w| known[w] + turned[w]);
        let moment = self.arm[0] * tension[0] + self.arm[1] * tension[1];
        [pull[0] + pull[2], pull[1] + pull[3], moment]
    }

    /// Coefficients of order k of the tensions.
    #[inline(always)]
    pub(super) fn tensions(&self, k: usize) -> [L; 2] {
        let tension = &self.tension[k];
        [tension[0], tension[2]]
    }

    /// The fairleads, turned.
    #[inline(always)]
    fn turned(&self, sine: L, cosine: L) -> Quad<L> {
        let [along, across] = &self.fairleads;
        quad!(|w| along[w].mul_add(cosine, across[w] * sine))
    }
}

impl<L: Doubles> CablePair<L> {
    /// Puts the beginning of a run's series, all up to the first order, into a lane; returns whether
    /// it has one pair of cables.
    pub(super) fn put(&mut self, lane: usize, one: &CableSeries<f64>) -> bool {
        let [one] = &one.pairs[..] else {
            return false;
        };
        for k in 0..2 {
            put_lane(&mut self.fairleads[k], lane, &one.fairleads[k]);
            put_lane(&mut self.lever[k], lane, &one.lever[k]);
            put_lane(&mut self.span[k], lane, &one.span[k]);
        }
        put_lane(&mut self.per_length, lane, &one.per_length);
        put_lane(&mut self.normal, lane, &one.normal);
        for place in 0..2 {
            self.arm[place].set(lane, one.arm[place]);
            self.half_per_length[place].set(lane, one.half_per_length[place]);
        }
        true
    }
}

/// Turned by a quarter, clockwise.
#[inline(always)]
fn turned_back<L: Lane>(quad: &Quad<L>) -> Quad<L> {
    [quad[1], -quad[0], quad[3], -quad[2]]
}

fn put_lane<L: Doubles>(all: &mut Quad<L>, lane: usize, one: &Quad<f64>) {
    for (all, one) in all.iter_mut().zip(one) {
        all.set(lane, *one);
    }
}

#[inline(always)]
fn put<T>(quad: &mut Quad<T>, place: usize, vector: Vector2<T>) {
    (quad[2 * place], quad[2 * place + 1]) = (vector.x, vector.y);
}

#[inline(always)]
fn get<T: Copy>(quad: &Quad<T>, place: usize) -> Vector2<T> {
    [quad[2 * place], quad[2 * place + 1]].into()
}
