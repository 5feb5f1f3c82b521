//! The spread of deviations: independent ones, added up.

use crate::Deviation;

/// Where the deviations (w, τ) of a run's neighbours lie: the sum of independent parts, each one standard
/// deviation long.
///
/// The start and rounding have seven of them, whose squares make up a covariance. The covariance itself is not
/// carried: a slow impact divides by v_n, and the squares of what it leaves cancel to nothing, or to less, where
/// the parts still have their digits.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    /// For the start and for rounding.
    pub(super) parts: [Deviation; 7],
    /// For each uncertain parameter.
    pub(super) columns: Vec<Deviation>,
}

/// A spread beyond this is no longer followed: nothing is known, and squares would leave the range of doubles.
const LOST: f64 = 1e30;

impl Spread {
    /// One part along each component, so long.
    pub(super) fn along_components(sizes: &Deviation) -> Self {
        let mut parts = [[0.0; 7]; 7];
        for (i, (part, size)) in parts.iter_mut().zip(sizes).enumerate() {
            part[i] = *size;
        }
        Self {
            parts,
            columns: Vec::new(),
        }
    }

    /// The same after a linear map of deviations.
    pub(super) fn mapped(&self, map: impl Fn(&Deviation) -> Deviation) -> Self {
        Self {
            parts: self.parts.map(|part| map(&part)),
            columns: self.columns.iter().map(map).collect(),
        }
    }

    /// Adds independent noise to the components.
    pub(super) fn add_noise(&mut self, noise: &Deviation) {
        if self.is_lost() {
            return;
        }
        // Fourteen parts, made seven again by turning them into each other (Householder's reflections), which
        // leaves the covariance as it is: component by component, all but one are rid of it. Noise of a later
        // component can not have it.
        let mut all = [[0.0; 7]; 14];
        all[..7].copy_from_slice(&self.parts);
        for (i, size) in noise.iter().enumerate() {
            all[7 + i][i] = *size;
        }
        for i in 0..7 {
            let turned = &mut all[i..i + 8];
            let length = turned.iter().map(|part| part[i] * part[i]).sum::<f64>();
            let length = length.sqrt().copysign(-turned[0][i]);
            if length == 0.0 {
                continue;
            }
            let mut mirror = [0.0; 8];
            for (m, part) in mirror.iter_mut().zip(turned.iter()) {
                *m = part[i] / length;
            }
            mirror[0] -= 1.0;
            for j in i..7 {
                let along: f64 = mirror
                    .iter()
                    .zip(turned.iter())
                    .map(|(m, p)| m * p[j])
                    .sum();
                for (part, m) in turned.iter_mut().zip(mirror) {
                    part[j] += m * along / mirror[0];
                }
            }
        }
        self.parts.copy_from_slice(&all[..7]);
    }

    /// Whether nothing is known any more.
    pub(super) fn is_lost(&self) -> bool {
        let mut all = self.parts.iter().chain(&self.columns).flatten();
        !all.all(|component| component.abs() < LOST)
    }

    /// Standard deviation of component i.
    pub(super) fn of_component(&self, i: usize) -> f64 {
        self.over_parts(|part| part[i])
    }

    /// Standard deviation of a linear function of the state.
    pub(super) fn along(&self, direction: &[f64; 6]) -> f64 {
        self.over_parts(|part| direction.iter().zip(part).map(|(l, w)| l * w).sum())
    }

    /// A bound on the standard deviation of a linear function of the position with coefficients of these sizes.
    pub(super) fn at_most(&self, coefficients: [f64; 3]) -> f64 {
        (0..3).map(|i| coefficients[i] * self.of_component(i)).sum()
    }

    fn over_parts(&self, of: impl Fn(&Deviation) -> f64) -> f64 {
        let all = self.parts.iter().chain(&self.columns);
        all.map(|part| of(part).powi(2)).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covariance(parts: &[Deviation]) -> [[f64; 7]; 7] {
        let mut sum = [[0.0; 7]; 7];
        for part in parts {
            for (i, row) in sum.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += part[i] * part[j];
                }
            }
        }
        sum
    }

    #[test]
    fn noise_adds_its_squares_and_nothing_else() {
        let mut spread = Spread::along_components(&[1.0, 2.0, 0.0, 0.5, 3.0, 1e-9, 0.0]);
        let noise = [0.1, 0.0, 0.3, 1.0, 1e-12, 2.0, 0.7];
        spread = spread.mapped(|part| {
            let mut mixed = *part;
            for i in 0..6 {
                mixed[i + 1] += 0.7 * part[i];
                mixed[0] -= 0.3 * part[i + 1];
            }
            mixed
        });
        let before = covariance(&spread.parts);
        spread.add_noise(&noise);
        let after = covariance(&spread.parts);
        for (i, (before, after)) in before.iter().zip(&after).enumerate() {
            for (j, (before, after)) in before.iter().zip(after).enumerate() {
                let added = if i == j { noise[i] * noise[i] } else { 0.0 };
                assert!((after - before - added).abs() < 1e-13, "{i} {j}");
            }
        }
        spread.add_noise(&[0.0; 7]);
        assert!(!spread.is_lost());
        for size in [1e31, 1e200, f64::INFINITY, f64::NAN] {
            let mut lost = Spread::along_components(&[size; 7]);
            lost.add_noise(&noise);
            assert!(lost.is_lost());
        }
    }

    /// A direction that is known 1e12 times better than the others stays so, where a covariance has no digit left of it.
    #[test]
    fn what_is_known_well_is_not_lost_among_the_rest() {
        let mut spread = Spread::along_components(&[1e-9; 7]).mapped(|part| {
            let mut known = *part;
            known[1] = part[0] + 1e-12 * part[1];
            known
        });
        spread.add_noise(&[0.0; 7]);
        let apart = spread.along(&[1.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((apart / 1e-21 - 1.0).abs() < 1e-3, "{apart:e}");
    }
}
