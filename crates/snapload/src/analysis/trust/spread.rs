//! The spread of deviations: a covariance and some single columns.

use crate::Deviation;

/// Where the deviations (w, τ) of a run's neighbours lie: the sum of independent parts, a covariance for the
/// start and for rounding, and one column, a standard deviation long, for each uncertain parameter.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    pub(super) covariance: [Deviation; 7],
    pub(super) columns: Vec<Deviation>,
}

impl Spread {
    /// The same after a linear map of deviations.
    pub(super) fn mapped(&self, map: impl Fn(&Deviation) -> Deviation) -> Self {
        Self {
            covariance: transform(&self.covariance, &map),
            columns: self.columns.iter().map(map).collect(),
        }
    }

    /// Maps the covariance alone; the columns come from elsewhere.
    pub(super) fn map_covariance(&mut self, map: impl Fn(&Deviation) -> Deviation) {
        self.covariance = transform(&self.covariance, &map);
    }

    /// Adds independent noise to the components of the state.
    pub(super) fn add_noise(&mut self, deviation: &[f64; 6]) {
        for (i, noise) in deviation.iter().enumerate() {
            self.covariance[i][i] += noise * noise;
        }
    }

    /// Standard deviation of component i.
    pub(super) fn of_component(&self, i: usize) -> f64 {
        let columns = self.columns.iter().map(|column| column[i] * column[i]);
        (self.covariance[i][i].max(0.0) + columns.sum::<f64>()).sqrt()
    }

    /// Standard deviation of a linear function of the state.
    pub(super) fn along(&self, direction: &[f64; 6]) -> f64 {
        let apply = |deviation: &Deviation| -> f64 {
            direction.iter().zip(deviation).map(|(l, w)| l * w).sum()
        };
        let mut product = [0.0; 6];
        for (sum, row) in product.iter_mut().zip(&self.covariance) {
            *sum = apply(row);
        }
        let covariance: f64 = direction.iter().zip(product).map(|(l, p)| l * p).sum();
        let columns = self.columns.iter().map(|column| apply(column).powi(2));
        (covariance.max(0.0) + columns.sum::<f64>()).sqrt()
    }
}

/// F P Fᵀ. P being symmetric, its rows are its columns: F of each, transposed, and once more.
fn transform(p: &[Deviation; 7], map: &impl Fn(&Deviation) -> Deviation) -> [Deviation; 7] {
    transposed(&transposed(&p.map(|row| map(&row))).map(|row| map(&row)))
}

fn transposed(p: &[Deviation; 7]) -> [Deviation; 7] {
    let mut turned = [[0.0; 7]; 7];
    for (i, row) in p.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            turned[j][i] = *entry;
        }
    }
    turned
}
