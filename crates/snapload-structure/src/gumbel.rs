//! The distribution of the largest of many: Gumbel's, fitted by L-moments.

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// P(x) = exp(−exp(−(x − ξ)/α)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gumbel {
    /// Location ξ.
    pub location: f64,
    /// Scale α.
    pub scale: f64,
    /// Size of the sample.
    pub count: usize,
    /// ln k, for the largest of k as many as the sample's: the location moves on by α ln k.
    pub log_times: f64,
}

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

impl Gumbel {
    /// The fit to a sample of at least three values that are not all equal:
    ///
    /// ```text
    /// α = λ₂/ln 2,    ξ = λ₁ − γ α,    λ₁ = b₀,    λ₂ = 2 b₁ − b₀
    /// ```
    ///
    /// with the unbiased sample moments b. Source: J. R. M. Hosking, *J. R. Statist. Soc.* B 52 (1990) 105.
    pub fn fit(sample: &[f64]) -> Option<Self> {
        let count = sample.len();
        if count < 3 {
            return None;
        }
        let mut sorted = sample.to_vec();
        sorted.sort_by(f64::total_cmp);
        let n = count as f64;
        let b0 = sorted.iter().sum::<f64>() / n;
        let weighted = |(k, x): (usize, &f64)| k as f64 / (n - 1.0) * x;
        let b1 = sorted.iter().enumerate().map(weighted).sum::<f64>() / n;
        let scale = (2.0 * b1 - b0) / std::f64::consts::LN_2;
        (scale > 0.0).then_some(Self {
            location: b0 - EULER * scale,
            scale,
            count,
            log_times: 0.0,
        })
    }

    /// The value that a part `p` of all stays below, with the asymptotic standard error of this fit:
    ///
    /// ```text
    /// x = ξ + α y,    var x = α²/n (1.1128 + 0.4574 y + 0.8046 y²),    y = −ln(−ln p) + ln k
    /// ```
    ///
    /// Source: J. R. M. Hosking, J. R. Wallis and E. F. Wood, *Technometrics* 27 (1985) 251, for shape 0.
    pub fn quantile(&self, p: f64) -> Estimate {
        self.at(reduced(p))
    }

    /// The value at a reduced variate of the sample's own distribution, beyond ln k.
    fn at(&self, y: f64) -> Estimate {
        let y = y + self.log_times;
        let variance = 1.1128 + 0.4574 * y + 0.8046 * y * y;
        Estimate {
            value: self.location + self.scale * y,
            error: self.scale * (variance / self.count as f64).sqrt(),
        }
    }

    /// The expected value, which is at y = γ + ln k.
    pub fn mean(&self) -> Estimate {
        self.at(EULER)
    }

    /// The distribution of the largest over so many times the time, taken as independent: ξ + α ln(times).
    #[must_use]
    pub fn over_times(&self, times: f64) -> Self {
        Self {
            log_times: self.log_times + times.ln(),
            ..*self
        }
    }
}

/// The reduced variate y = −ln(−ln p).
pub(crate) fn reduced(p: f64) -> f64 {
    -(-p.ln()).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    /// Samples drawn from a known Gumbel distribution: the fit is right on average, and scatters as it says it does.
    #[test]
    fn fit_of_synthetic_data_is_right_and_knows_its_error() {
        let (location, scale, count, samples) = (40.0, 7.0, 100, 4000);
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let mut draw = || {
            let uniform = ((generator.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
            location + scale * reduced(uniform)
        };
        let fits: Vec<Gumbel> = (0..samples)
            .map(|_| Gumbel::fit(&(0..count).map(|_| draw()).collect::<Vec<_>>()).unwrap())
            .collect();
        let known = Gumbel {
            location,
            scale,
            count,
            log_times: 0.0,
        };
        // As the sample is, and for the largest of six and of a quarter as many.
        for (p, times) in [0.1, 0.5, 0.9, 0.99]
            .into_iter()
            .flat_map(|p| [(p, 1.0), (p, 6.0), (p, 0.25)])
        {
            let over = |fit: &Gumbel| fit.over_times(times);
            let values: Vec<f64> = fits.iter().map(|fit| over(fit).quantile(p).value).collect();
            let mean = values.iter().sum::<f64>() / f64::from(samples);
            let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
                / f64::from(samples))
            .sqrt();
            let expected = over(&known).quantile(p);
            // The mean of 4000 fits is known to error/63, their spread to 1.2 %.
            assert!(
                (mean - expected.value).abs() < 5.0 * expected.error / 63.0,
                "{p}: {mean} {expected:?}"
            );
            assert!(
                (spread / expected.error - 1.0).abs() < 0.05,
                "{p}: {spread} {expected:?}"
            );
        }
    }

    #[test]
    fn largest_of_eight_samples_is_one_over_eight_times_the_time() {
        let one = Gumbel {
            location: 3.0,
            scale: 0.5,
            count: 10,
            log_times: 0.0,
        };
        let eight = one.over_times(8.0);
        // P_8(x) = P_1(x)^8.
        let x = one.quantile(0.9).value;
        assert!((eight.quantile(0.9_f64.powi(8)).value - x).abs() < 1e-12);
    }

    #[test]
    fn too_little_is_not_fitted() {
        assert_eq!(Gumbel::fit(&[1.0, 2.0]), None);
        assert_eq!(Gumbel::fit(&[2.0; 9]), None);
    }
}
