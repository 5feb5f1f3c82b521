//! The spread of deviations: independent ones, added up.

use crate::analysis::trust::parts::{COLUMNS, FactorParts, LAST, square, squares};
use crate::model::state::State;
use crate::motion::step_map::{Block, Deviation, join};

/// The number of parts that describe a deviation: as many as it has components.
pub(super) const PARTS: usize = 7;

/// The spread of the deviations (w, τ) of a run's neighbours: the sum of independent parts, each
/// one standard deviation long.
#[derive(Clone, Debug)]
pub(super) struct CovarianceFactor {
    /// For the start and for rounding.
    pub(super) parts: FactorParts<f64>,
    /// For each uncertain parameter.
    pub(super) columns: Vec<Deviation>,
    /// The rows of the parts for the water's memory, if the body floats: the real and the imaginary
    /// part of each state in turn.
    pub(super) memory: Vec<[f64; COLUMNS]>,
}

/// Neighbours are assumed to be within this many standard deviations.
pub(super) const SIGMA_REACH: f64 = 3.0;

/// A spread beyond this is not carried further: its directions no longer mean anything, and its
/// squares would leave the range of doubles.
pub(super) const LARGEST_SPREAD: f64 = 1e30;

impl CovarianceFactor {
    /// One part along each component, of the given size.
    pub(super) fn along_components(sizes: &Deviation) -> Self {
        let mut parts = FactorParts::none();
        for (i, (row, size)) in parts.rows.iter_mut().zip(sizes).enumerate() {
            row[i] = *size;
        }
        Self {
            parts,
            columns: Vec::new(),
            memory: Vec::new(),
        }
    }

    /// The same after a linear map of the parts; `columns` are the parameters' deviations, already
    /// mapped.
    #[inline(always)]
    pub(super) fn carried(
        &self,
        map: impl FnOnce(&mut Block<COLUMNS>, &mut [[f64; COLUMNS]]),
        columns: Vec<Deviation>,
    ) -> Self {
        let (mut rows, mut memory) = (self.parts.rows, self.memory.clone());
        map(&mut rows, &mut memory);
        Self {
            parts: self.parts.with(rows),
            columns,
            memory,
        }
    }

    /// The same with seven parts, so that the last column is free for one more. The parts of a
    /// floating body are kept as they are: with the water's memory they have more than seven rows.
    #[inline(always)]
    pub(super) fn with_seven(mut self) -> Self {
        self.leave_seven();
        self
    }

    /// [`CovarianceFactor::with_seven`], in place.
    #[inline(always)]
    pub(super) fn leave_seven(&mut self) {
        if self.memory.is_empty() && self.parts.rows.iter().any(|row| row[LAST] != 0.0) {
            self.parts.rows = seven(self.parts.rows);
        }
    }

    /// The same with one more part, in the column that is left free for it; of a floating body it
    /// is added to another with a sign that follows no rule ([`crate::analysis::trust::parts`]).
    /// `memory` are its rows of the water's memory, for a unit of `late`.
    #[inline(always)]
    pub(super) fn with_part(mut self, part: &Deviation, memory: &[f64], late: f64) -> Self {
        if !self.memory.is_empty() {
            let [sign, _] = self.parts.signs();
            for (row, entry) in self.parts.rows.iter_mut().zip(part) {
                row[LAST] += sign * entry;
            }
            for (row, rate) in self.memory.iter_mut().zip(memory) {
                row[LAST] += sign * rate * late;
            }
            return self;
        }
        for (row, entry) in self.parts.rows.iter_mut().zip(part) {
            row[LAST] = *entry;
        }
        self
    }

    /// Adds independent parts; seven remain.
    #[inline(always)]
    pub(super) fn add_parts(&mut self, more: &Block<COLUMNS>) {
        if self.exceeds_limit() {
            return;
        }
        if !self.memory.is_empty() {
            self.add_by_sign(more);
            return;
        }
        self.parts.rows = seven_of_both(&self.parts.rows, more);
    }

    /// Adds each of the new parts to one of a floating body's parts, with a pseudorandom sign, and
    /// permutes those.
    fn add_by_sign(&mut self, more: &Block<COLUMNS>) {
        let [_, sign] = self.parts.signs();
        for (row, more) in self.parts.rows.iter_mut().zip(more) {
            for (entry, more) in row.iter_mut().zip(more) {
                *entry += sign * more;
            }
        }
        self.parts.rotate();
        for row in &mut self.memory {
            row.rotate_right(1);
        }
    }

    /// Whether the spread is too large to be carried further.
    #[inline(always)]
    pub(super) fn exceeds_limit(&self) -> bool {
        let small = |component: &f64| component.abs() < LARGEST_SPREAD;
        let parts = self
            .parts
            .rows
            .as_flattened()
            .iter()
            .fold(true, |all, part| all & small(part));
        !(parts && self.columns.iter().flatten().all(small))
    }

    /// Standard deviation of each component.
    #[inline(always)]
    pub(super) fn sizes(&self) -> Deviation {
        let mut squares = squares(&self.parts.rows);
        for column in &self.columns {
            for (square, part) in squares.iter_mut().zip(column) {
                *square += part * part;
            }
        }
        for square in &mut squares {
            *square = square.sqrt();
        }
        squares
    }

    /// The square of the part of the standard deviation of a linear function of state and time that
    /// the start and rounding cause.
    #[inline(always)]
    pub(super) fn variance_of_parts(&self, direction: &Deviation) -> f64 {
        let mut sum = [0.0; COLUMNS];
        for (row, factor) in self.parts.rows.iter().zip(direction) {
            for (sum, entry) in sum.iter_mut().zip(row) {
                *sum += factor * entry;
            }
        }
        square(&sum)
    }

    /// Standard deviation of a linear function of the state.
    #[inline(always)]
    pub(super) fn along(&self, direction: &[f64; 6]) -> f64 {
        self.along_with_time(&join(direction, 0.0))
    }

    /// Standard deviation of a linear function of the state and the time.
    #[inline(always)]
    pub(super) fn along_with_time(&self, direction: &Deviation) -> f64 {
        let mut variance = self.variance_of_parts(direction);
        for column in &self.columns {
            let along: f64 = direction.iter().zip(column).map(|(l, w)| l * w).sum();
            variance += along * along;
        }
        variance.sqrt()
    }
}

/// The largest of some variances, each relative to the square of its value where that is above 1.
#[inline(always)]
pub(super) fn relative(squares: &Deviation, state: &State, t: f64) -> f64 {
    let [x, y, theta, vx, vy, vtheta] = state.components();
    let mut ratios = [0.0; 8];
    for (ratio, value) in ratios.iter_mut().zip([x, y, theta, vx, vy, vtheta, t, 1.0]) {
        *ratio = larger(value * value, 1.0);
    }
    for (ratio, square) in ratios.iter_mut().zip(squares) {
        *ratio = square / *ratio;
    }
    ratios[7] = 0.0;
    ratios.into_iter().fold(0.0, larger)
}

/// The larger of two numbers, in one instruction.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Seven parts that stand for two sets of parts together.
#[inline(always)]
pub(super) fn seven_of_both(parts: &Block<COLUMNS>, more: &Block<COLUMNS>) -> Block<COLUMNS> {
    let mut all = [[0.0; 2 * COLUMNS]; 7];
    for (row, (parts, more)) in all.iter_mut().zip(parts.iter().zip(more)) {
        row[..COLUMNS].copy_from_slice(parts);
        row[COLUMNS..].copy_from_slice(more);
    }
    seven(all)
}

/// Reduces the parts to seven by Householder's reflections, which leave the covariance as it is:
/// component by component, that row becomes zero in all but one of the remaining parts.
#[inline(always)]
fn seven<const N: usize>(mut all: [[f64; N]; 7]) -> Block<COLUMNS> {
    // Unrolled by hand, so that the indices are constants for the compiler.
    reflect::<0, N>(&mut all);
    reflect::<1, N>(&mut all);
    reflect::<2, N>(&mut all);
    reflect::<3, N>(&mut all);
    reflect::<4, N>(&mut all);
    reflect::<5, N>(&mut all);
    reflect::<6, N>(&mut all);
    let mut parts = [[0.0; COLUMNS]; 7];
    for (parts, row) in parts.iter_mut().zip(&all) {
        parts[..PARTS].copy_from_slice(&row[..PARTS]);
    }
    parts
}

/// Reflects the parts from the I-th on, so that only the first of them has a nonzero entry in row
/// I.
#[inline(always)]
fn reflect<const I: usize, const N: usize>(all: &mut [[f64; N]; 7]) {
    let [.., pivot] = &mut all[..=I] else {
        return;
    };
    let mut mirror = *pivot;
    for component in &mut mirror[..I] {
        *component = 0.0;
    }
    let first = mirror[I];
    let length = dot(&mirror, &mirror).sqrt().copysign(-first);
    if length == 0.0 {
        return;
    }
    // With the length subtracted from its first component, the squared length of the mirror vector
    // is 2 length (length − first), where neither difference cancels.
    mirror[I] = first - length;
    let scale = 1.0 / (length * mirror[I]);
    for component in &mut pivot[I..] {
        *component = 0.0;
    }
    pivot[I] = length;
    for row in &mut all[I + 1..] {
        let along = dot(&mirror, row) * scale;
        for (entry, m) in row.iter_mut().zip(mirror) {
            *entry += m * along;
        }
    }
}

/// Σ a_k b_k, as eight sums that a processor can do at once.
#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sums = [0.0; 8];
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    for k in 0..4 {
        sums[k] += sums[k + 4];
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(parts: &Block<COLUMNS>) -> [[f64; 7]; 7] {
        parts.map(|row| parts.map(|other| dot(&row, &other)))
    }

    /// A map of deviations, of a block of them.
    fn each(
        map: impl Fn(&Deviation) -> Deviation,
    ) -> impl Fn(&mut Block<COLUMNS>, &mut [[f64; COLUMNS]]) {
        move |block, _| {
            for column in 0..COLUMNS {
                let mapped = map(&block.map(|row| row[column]));
                for (row, entry) in block.iter_mut().zip(mapped) {
                    row[column] = entry;
                }
            }
        }
    }

    fn diagonal(sizes: &Deviation) -> Block<COLUMNS> {
        CovarianceFactor::along_components(sizes).parts.rows
    }

    #[test]
    fn noise_adds_its_squares_and_nothing_else() {
        let mut covariance =
            CovarianceFactor::along_components(&[1.0, 2.0, 0.0, 0.5, 3.0, 1e-9, 0.0]);
        let noise = [0.1, 0.0, 0.3, 1.0, 1e-12, 2.0, 0.7];
        let mix = each(|part| {
            let mut mixed = *part;
            for i in 0..6 {
                mixed[i + 1] += 0.7 * part[i];
                mixed[0] -= 0.3 * part[i + 1];
            }
            mixed
        });
        covariance = covariance.carried(mix, Vec::new());
        let before = squares(&covariance.parts.rows);
        covariance.add_parts(&diagonal(&noise));
        let after = squares(&covariance.parts.rows);
        for (i, (before, after)) in before.iter().zip(&after).enumerate() {
            for (j, (before, after)) in before.iter().zip(after).enumerate() {
                let added = if i == j { noise[i] * noise[i] } else { 0.0 };
                assert!((after - before - added).abs() < 1e-13, "{i} {j}");
            }
        }
        covariance.add_parts(&diagonal(&[0.0; 7]));
        assert!(!covariance.exceeds_limit());
        for size in [1e31, 1e200, f64::INFINITY, f64::NAN] {
            let mut lost = CovarianceFactor::along_components(&[size; 7]);
            lost.add_parts(&diagonal(&noise));
            assert!(lost.exceeds_limit());
        }
    }

    /// A direction that is known 1e12 times better than the others stays so, where a covariance has
    /// no digit left of it.
    #[test]
    fn what_is_known_well_is_not_lost_among_the_rest() {
        let nearly_one = each(|part| {
            let mut known = *part;
            known[1] = part[0] + 1e-12 * part[1];
            known
        });
        let mut covariance =
            CovarianceFactor::along_components(&[1e-9; 7]).carried(nearly_one, Vec::new());
        covariance.add_parts(&diagonal(&[0.0; 7]));
        let apart = covariance.along(&[1.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((apart / 1e-21 - 1.0).abs() < 1e-3, "{apart:e}");
    }
}
