//! Truncated power series of several quantities side by side, summed in one pass.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::polynomial::ORDER;
use crate::arithmetic::processor::Aligned;
use crate::arithmetic::real::Real;
use std::ops::{Index, IndexMut};

/// How many products are summed at a time.
const BLOCK: usize = 4;
/// Zeros on either side, so that sums can be extended to whole blocks.
const MARGIN: usize = BLOCK - 1;

/// `W` power series up to [`ORDER`], lowest power first, with zeros around them, aligned so that a
/// vector register is never loaded across two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct VectorSeries<T, const W: usize>([[T; W]; MARGIN + ORDER + 1 + MARGIN]);

impl<L: Lane, const W: usize> Default for VectorSeries<L, W> {
    fn default() -> Self {
        Self([[L::ZERO; W]; MARGIN + ORDER + 1 + MARGIN])
    }
}

impl<T, const W: usize> Index<usize> for VectorSeries<T, W> {
    type Output = [T; W];
    #[inline(always)]
    fn index(&self, power: usize) -> &[T; W] {
        &self.0[MARGIN + power]
    }
}

impl<T, const W: usize> IndexMut<usize> for VectorSeries<T, W> {
    #[inline(always)]
    fn index_mut(&mut self, power: usize) -> &mut [T; W] {
        &mut self.0[MARGIN + power]
    }
}

impl<L: Lane, const W: usize> VectorSeries<L, W> {
    /// Sets all coefficients to zero, in place.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        for coefficients in &mut self.0[MARGIN..] {
            *coefficients = [L::ZERO; W];
        }
    }

    /// Σ a_j b_{k−j}, 0 ≤ j ≤ k: the k-th coefficients of the products. A coefficient that is not
    /// known yet has to be zero, so that its products are left out; all have to be finite, as those
    /// beyond k are multiplied by zeros. If this holds one quantity, it is a factor of each of the
    /// others.
    #[inline(always)]
    pub(crate) fn convolve<const V: usize>(&self, other: &VectorSeries<L, V>, k: usize) -> [L; V] {
        let [sums] = convolve([(self, other)], k);
        sums
    }
}

impl<T: Real, const W: usize> VectorSeries<T, W> {
    /// Σ |a_i b_j| s^{i+j−p}, i + j ≥ p = [`ORDER`] + 1: a bound on the terms of the products
    /// beyond the last order at `s`, up to the factor s^p.
    #[inline(always)]
    pub(crate) fn beyond_product<const V: usize>(
        &self,
        other: &VectorSeries<T, V>,
        s: T,
    ) -> [T; V] {
        let (mut rest, mut sums) = ([T::ZERO; V], [T::ZERO; V]);
        for i in 1..=ORDER {
            let (a, b) = (&self[i], &other[ORDER + 1 - i]);
            for w in 0..V {
                rest[w] = rest[w].mul_add(s, b[w].abs());
                sums[w] = a[w % W].abs().mul_add(rest[w], sums[w]);
            }
        }
        sums
    }
}

/// The k-th coefficients of several products, in one pass.
#[inline(always)]
pub(crate) fn convolve<L: Lane, const V: usize, const W: usize, const N: usize>(
    factors: [(&VectorSeries<L, V>, &VectorSeries<L, W>); N],
    k: usize,
) -> [[L; W]; N] {
    let mut sums = [[[L::ZERO; W]; 2]; N];
    // The newest coefficients, at either end, are added last, so that the processor can add up the
    // others before they are known.
    let mut from = BLOCK;
    while from <= k {
        for (sums, factors) in sums.iter_mut().zip(&factors) {
            add_block(sums, *factors, k, from);
        }
        from += BLOCK;
    }
    let mut products = [[L::ZERO; W]; N];
    for n in 0..N {
        add_block(&mut sums[n], factors[n], k, 0);
        let [even, odd] = &sums[n];
        for w in 0..W {
            products[n][w] = even[w] + odd[w];
        }
    }
    // Without this barrier the compiler vectorises across the lanes, with more shuffling than
    // arithmetic.
    std::hint::black_box(Aligned(products)).0
}

/// Adds the block of products of the k-th coefficient that begins there, the other factor's
/// coefficients in reverse, to two sums that take turns: a processor can do several at once.
#[inline(always)]
fn add_block<L: Lane, const V: usize, const W: usize>(
    [even, odd]: &mut [[L; W]; 2],
    (a, b): (&VectorSeries<L, V>, &VectorSeries<L, W>),
    k: usize,
    from: usize,
) {
    let a = &a.0[MARGIN + from..][..BLOCK];
    let b = &b.0[MARGIN + k + 1 - from - BLOCK..][..BLOCK];
    add_products(even, &a[3], &b[0]);
    add_products(odd, &a[2], &b[1]);
    add_products(even, &a[1], &b[2]);
    add_products(odd, &a[0], &b[3]);
}

#[inline(always)]
fn add_products<L: Lane, const V: usize, const W: usize>(
    sums: &mut [L; W],
    a: &[L; V],
    b: &[L; W],
) {
    for w in 0..W {
        sums[w] = a[w % V].mul_add(b[w], sums[w]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all coefficients 1 and s = ½ the sum is Σ_n (2p − 1 − n) s^{n−p}, p ≤ n < 2p − 1: the
    /// number of pairs of orders below p that add up to n.
    #[test]
    fn what_a_product_has_beyond_the_last_order() {
        let mut ones = VectorSeries::<f64, 1>::default();
        for k in 0..=ORDER {
            ones[k] = [1.0];
        }
        let p = ORDER + 1;
        let known: f64 = (p..2 * p - 1)
            .map(|n| (2 * p - 1 - n) as f64 * 0.5_f64.powi((n - p) as i32))
            .sum();
        let [sum] = ones.beyond_product(&ones, 0.5);
        assert!((sum / known - 1.0).abs() < 1e-15, "{sum} {known}");
    }

    /// 1/(1 − s) times 1/(1 − 2s) is Σ (2^{k+1} − 1) s^k, its square Σ (k + 1) s^k. While the k-th
    /// coefficients are not known, the two products with them are missing: those with 2^k and 1,
    /// and with 1 and 1.
    #[test]
    fn products_of_geometric_series() {
        let (mut ones, mut powers) = (VectorSeries::<f64, 2>::default(), VectorSeries::default());
        for k in 0..=ORDER {
            let (n, power) = (k as f64, 2.0_f64.powi(k as i32));
            if k > 0 {
                let known = [power - 2.0, n - 1.0];
                assert_eq!(ones.convolve(&powers, k), known, "k = {k}");
            }
            (ones[k], powers[k]) = ([1.0, 1.0], [power, 1.0]);
            let product = [2.0 * power - 1.0, n + 1.0];
            assert_eq!(ones.convolve(&powers, k), product, "k = {k}");
            assert_eq!(powers.convolve(&ones, k), product, "k = {k}");
        }
    }
}
