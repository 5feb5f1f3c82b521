//! The spread of deviations: a covariance and some single columns.

use crate::Deviation;
use crate::tangent::Block;

/// ⟨(w, τ)(w, τ)ᵀ⟩, with a column of zeros that makes the rows eight long, as processors like them.
pub(super) type Covariance = Block<8>;

/// Where the deviations (w, τ) of a run's neighbours lie: the sum of independent parts, a covariance for the
/// start and for rounding, and one column, a standard deviation long, for each uncertain parameter.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    pub(super) covariance: Covariance,
    pub(super) columns: Vec<Deviation>,
}

impl Spread {
    /// Maps the covariance: F P Fᵀ. P being symmetric, that is F of its columns, transposed, and F once more.
    /// The columns of the parameters come from elsewhere.
    pub(super) fn map_covariance(&mut self, map: impl Fn(&mut Covariance)) {
        map(&mut self.covariance);
        transpose(&mut self.covariance);
        map(&mut self.covariance);
    }

    /// Adds independent noise to the components of the state.
    pub(super) fn add_noise(&mut self, deviation: &[f64; 6]) {
        for (i, noise) in deviation.iter().enumerate() {
            self.covariance[i][i] += noise * noise;
        }
    }

    /// Variance of component i.
    pub(super) fn variance(&self, i: usize) -> f64 {
        let columns = self.columns.iter().map(|column| column[i] * column[i]);
        self.covariance[i][i].max(0.0) + columns.sum::<f64>()
    }

    /// Standard deviation of component i.
    pub(super) fn of_component(&self, i: usize) -> f64 {
        self.variance(i).sqrt()
    }

    /// Standard deviation of a linear function of the state.
    pub(super) fn along(&self, direction: &[f64; 6]) -> f64 {
        let apply = |deviation: &[f64]| -> f64 {
            direction.iter().zip(deviation).map(|(l, w)| l * w).sum()
        };
        let rows = direction.iter().zip(&self.covariance);
        let covariance: f64 = rows.map(|(l, row)| l * apply(row)).sum();
        let columns = self.columns.iter().map(|column| apply(column).powi(2));
        (covariance.max(0.0) + columns.sum::<f64>()).sqrt()
    }

    /// A bound on the standard deviation of a linear function of the position with coefficients of these sizes.
    pub(super) fn at_most(&self, coefficients: [f64; 3]) -> f64 {
        (0..3).map(|i| coefficients[i] * self.of_component(i)).sum()
    }
}

fn transpose(p: &mut Covariance) {
    let given = *p;
    for (i, row) in p.iter_mut().enumerate() {
        for (entry, from) in row.iter_mut().zip(&given) {
            *entry = from[i];
        }
    }
}
