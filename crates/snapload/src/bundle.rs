//! Truncated power series side by side: of several quantities that one pass of sums serves.

use crate::polynomial::ORDER;
use crate::real::Real;
use std::ops::{Index, IndexMut};

/// Products are summed so many at a time.
const BLOCK: usize = 4;
/// Zeros on either side, so that what is summed can be rounded up to whole blocks.
const MARGIN: usize = BLOCK - 1;

/// `W` power series up to [`ORDER`], lowest power first, with zeros around them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bundle<T, const W: usize>([[T; W]; MARGIN + ORDER + 1 + MARGIN]);

impl<T: Real, const W: usize> Default for Bundle<T, W> {
    fn default() -> Self {
        Self([[T::ZERO; W]; MARGIN + ORDER + 1 + MARGIN])
    }
}

impl<T, const W: usize> Index<usize> for Bundle<T, W> {
    type Output = [T; W];
    #[inline(always)]
    fn index(&self, power: usize) -> &[T; W] {
        &self.0[MARGIN + power]
    }
}

impl<T, const W: usize> IndexMut<usize> for Bundle<T, W> {
    #[inline(always)]
    fn index_mut(&mut self, power: usize) -> &mut [T; W] {
        &mut self.0[MARGIN + power]
    }
}

impl<T: Real, const W: usize> Bundle<T, W> {
    /// Σ a_j b_{k−j}, 0 ≤ j ≤ k: the k-th coefficients of the products. One that is not known yet is zero, so that
    /// its products are left out.
    #[inline(always)]
    pub(crate) fn convolve(&self, other: &Self, k: usize) -> [T; W] {
        let length = (k + 1).next_multiple_of(BLOCK);
        let a = &self.0[MARGIN..][..length];
        let b = &other.0[..MARGIN + k + 1][MARGIN + k + 1 - length..];
        let (mut sums, mut others) = ([T::ZERO; W], [T::ZERO; W]);
        for (x, y) in a.chunks_exact(BLOCK).zip(b.rchunks_exact(BLOCK)) {
            // Two sums that take turns, as a processor can do several at once.
            add_products(&mut sums, &x[0], &y[3]);
            add_products(&mut others, &x[1], &y[2]);
            add_products(&mut sums, &x[2], &y[1]);
            add_products(&mut others, &x[3], &y[0]);
        }
        std::hint::black_box(std::array::from_fn(|w| sums[w] + others[w]))
    }
}

#[inline(always)]
fn add_products<T: Real, const W: usize>(sums: &mut [T; W], a: &[T; W], b: &[T; W]) {
    for w in 0..W {
        sums[w] = a[w].mul_add(b[w], sums[w]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of (1 + s)^n and (1 − s)^n, of which products and squares are known.
    #[test]
    fn products_of_powers_of_binomials() {
        let mut plus = Bundle::<f64, 2>::default();
        for (k, c) in [1.0, 4.0, 6.0, 4.0, 1.0].into_iter().enumerate() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            plus[k] = [c, sign * c];
        }
        let eighth = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0, 0.0];
        for (k, c) in eighth.into_iter().enumerate() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let known = [c, sign * c];
            assert_eq!(plus.convolve(&plus, k), known);
        }
    }
}
