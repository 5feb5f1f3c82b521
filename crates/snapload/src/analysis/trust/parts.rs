//! The independent parts whose squares make up a covariance, of one run or of several side by side.
//!
//! A part is a deviation (w, τ) one standard deviation long; the parts p_1 … p_8 of a run stand for
//! the covariance Σ p_k p_kᵀ. The covariance itself is not carried: a slow impact divides by v_n,
//! and the large squares that this makes cancel later, with a loss of digits, or even to negative
//! numbers, where the parts keep their digits.
//!
//! The rounding of every step adds as many new parts. To carry all of them separately is
//! impossible, and to combine them into eight again (Householder's reflections) takes several times
//! as long as the step itself. Instead *each new part is added to an old one, with a pseudorandom
//! sign*: of (p ± q)(p ± q)ᵀ = ppᵀ + qqᵀ ± (pqᵀ + qpᵀ) the last summand is zero on average over the
//! signs. As deviations are carried linearly, the average over the signs is the exact covariance at
//! every later time, too. The error of a single choice of signs is the sum of these last summands.
//! It is negligible where the rounding of one step outgrows what later steps add, as it does where
//! neighbours diverge exponentially; where the roundings of many steps count alike, it is as large
//! as the error of a standard deviation that is estimated from eight samples, which is a quarter.
//! The parts are permuted after each step, so that each of them receives the same kinds of
//! rounding.

use crate::arithmetic::elementary::rounded;
use crate::arithmetic::lane::Lane;
use crate::motion::bounce_map::Rows;

/// The number of columns: as many as a vector register of a processor holds.
pub(super) const COLUMNS: usize = 8;
/// The index of the part beside those of the seven components.
pub(super) const LAST: usize = COLUMNS - 1;

/// Deviations one standard deviation long, as columns. A row fills one line of a processor's cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct FactorParts<L> {
    pub(super) rows: Rows<L, COLUMNS>,
    signs: Signs<L>,
}

impl<L: Lane> FactorParts<L> {
    /// Parts that are all zero.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self {
            rows: [[L::ZERO; COLUMNS]; 7],
            signs: Signs(L::ZERO),
        }
    }

    /// The same with other rows.
    #[inline(always)]
    pub(super) fn with(&self, rows: Rows<L, COLUMNS>) -> Self {
        Self { rows, ..*self }
    }

    /// The signs of this step: two that are independent of each other.
    #[inline(always)]
    pub(super) fn signs(&self) -> [L; 2] {
        let Signs(u) = self.signs;
        let sign = |u: L| L::select(u.below(L::ZERO), L::from_f64(-1.0), L::ONE);
        [sign(u), sign(u.abs() - 0.25)]
    }

    /// Permutes the parts, and advances the signs, for the next step.
    #[inline(always)]
    pub(super) fn rotate(&mut self) {
        for row in &mut self.rows {
            let [a, b, c, d, e, f, g, last] = *row;
            *row = [last, a, b, c, d, e, f, g];
        }
        self.advance_signs();
    }

    /// Takes over the signs of others.
    #[inline(always)]
    pub(super) fn take_signs(&mut self, others: &Self) {
        self.signs = others.signs;
    }

    /// Advances the signs alone, where the parts are permuted already.
    #[inline(always)]
    pub(super) fn advance_signs(&mut self) {
        self.signs = self.signs.next();
    }

    /// Applies a function to each of its numbers and the other's.
    #[inline(always)]
    pub(super) fn pairwise<M>(&mut self, other: &FactorParts<M>, mut each: impl FnMut(&mut L, &M)) {
        for (row, others) in self.rows.iter_mut().zip(&other.rows) {
            for (one, other) in row.iter_mut().zip(others) {
                each(one, other);
            }
        }
        each(&mut self.signs.0, &other.signs.0);
    }
}

/// Σ p_k², row by row.
#[inline(always)]
pub(super) fn squares<L: Lane, const R: usize>(rows: &[[L; COLUMNS]; R]) -> [L; R] {
    let mut sums = [L::ZERO; R];
    for (sum, row) in sums.iter_mut().zip(rows) {
        *sum = square(row);
    }
    sums
}

/// Σ p_k², as four sums that a processor can do at once.
#[inline(always)]
pub(super) fn square<L: Lane>(row: &[L; COLUMNS]) -> L {
    let mut sums = [L::ZERO; 4];
    for k in 0..4 {
        sums[k] = row[k].mul_add(row[k], row[k + 4] * row[k + 4]);
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// A pseudorandom sequence of signs, the same for every run: the first bits of the numbers of a
/// linear congruential generator of 26 bits, as fractions of one around zero, which doubles hold
/// exactly.
#[derive(Clone, Copy, Debug)]
struct Signs<L>(L);

impl<L: Lane> Signs<L> {
    #[inline(always)]
    fn next(self) -> Self {
        const FACTOR: f64 = 1_664_525.0;
        const SUMMAND: f64 = 13_904_223.0 / (1u64 << 26) as f64;
        let next = self.0.mul_add(L::from_f64(FACTOR), L::from_f64(SUMMAND));
        Self(next - rounded(next))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: usize = 12;
    const DRAWS: usize = 20_000;

    /// A map of some step, without a symmetry, that neither shrinks nor stretches by much.
    fn entry(step: usize, i: usize, j: usize) -> f64 {
        let mixed = (step * 7 + i * 3 + j * 5) as f64;
        0.3 * mixed.sin() + if i == j { 0.8 } else { 0.0 }
    }

    /// The rounding of a component in some step.
    fn size(step: usize, i: usize) -> f64 {
        1.0 + 0.9 * ((step * 5 + i * 11) as f64).cos()
    }

    fn carried(columns: &Rows<f64, COLUMNS>, step: usize) -> Rows<f64, COLUMNS> {
        let mut next = [[0.0; COLUMNS]; 7];
        for (i, row) in next.iter_mut().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                for (sum, part) in row.iter_mut().zip(column) {
                    *sum += entry(step, i, j) * part;
                }
            }
        }
        next
    }

    /// Σ over steps of what the later maps make of a step's roundings, squared: the covariance.
    fn exact() -> [f64; 7] {
        let mut sums = [0.0; 7];
        for first in 0..STEPS {
            let mut rows = [[0.0; COLUMNS]; 7];
            for (i, row) in rows.iter_mut().enumerate() {
                row[i] = size(first, i);
            }
            for step in first + 1..STEPS {
                rows = carried(&rows, step);
            }
            for (sum, square) in sums.iter_mut().zip(squares(&rows)) {
                *sum += square;
            }
        }
        sums
    }

    /// On average over the signs the parts make up the covariance, and a single choice of signs is
    /// rarely far from it.
    #[test]
    fn parts_stand_for_the_covariance() {
        let mut signs = Signs(0.0);
        let (mut means, mut far) = ([0.0; 7], 0);
        for _ in 0..DRAWS {
            for _ in 0..STEPS {
                signs = signs.next();
            }
            let mut parts = FactorParts {
                signs,
                ..FactorParts::none()
            };
            for step in 0..STEPS {
                parts.rows = carried(&parts.rows, step);
                let [sign, _] = parts.signs();
                for i in 0..7 {
                    parts.rows[i][i] += sign * size(step, i);
                }
                parts.rotate();
            }
            let squares = squares(&parts.rows);
            for (mean, square) in means.iter_mut().zip(squares) {
                *mean += square / DRAWS as f64;
            }
            let far_off = |(square, exact): (f64, f64)| !(0.25..4.0).contains(&(square / exact));
            far += usize::from(squares.into_iter().zip(exact()).any(far_off));
        }
        for (mean, exact) in means.into_iter().zip(exact()) {
            assert!((mean / exact - 1.0).abs() < 0.02, "{mean} {exact}");
        }
        let share = far as f64 / DRAWS as f64;
        println!("off by more than a factor of two: {share}");
        assert!(share < 0.1, "{share}");
    }

    /// Signs are not correlated with those before: they neither come in runs nor alternate.
    #[test]
    fn signs_have_no_order() {
        let mut parts = FactorParts::<f64>::none();
        let (count, mut before) = (1 << 16, [1.0; 2]);
        let mut sums = [0.0; 5];
        for _ in 0..count {
            let [one, two] = parts.signs();
            let pairs = [one, two, one * two, one * before[0], two * before[1]];
            for (sum, sign) in sums.iter_mut().zip(pairs) {
                *sum += sign;
            }
            before = [one, two];
            parts.rotate();
        }
        // Four standard deviations of as many independent signs.
        let most = 4.0 * f64::from(count).sqrt();
        assert!(sums.iter().all(|sum| sum.abs() < most), "{sums:?}");
    }
}
