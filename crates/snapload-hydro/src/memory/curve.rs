//! The damping of one entry as a function of all frequencies, and the integrals over it that give
//! the memory and the added mass.

use crate::coefficients::{Hydrodynamics, UPPER};
use crate::spline::Spline;
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// Nodes and weights of the Gauss-Legendre rule with eight points on (−1, 1), for one side.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];
/// The exponents that the power law beyond the last frequency may have.
const EXPONENTS: [f64; 2] = [3.0, 12.0];
/// The number of last frequencies from which the power law beyond them is found.
const TREND: usize = 10;
/// The end of the memory's integral, in units of the last frequency.
const INTEGRAL_END: f64 = 40.0;
/// Panels of that integral beyond the last frequency.
const FAR_PANELS: usize = 240;
/// Panels of the integral of the added mass beyond the last frequency.
const TAIL_PANELS: usize = 8;

/// B(ω) of one entry over all frequencies: a cubic spline through zero and the file's values, then
/// the power law fitted to the last ten of them.
#[derive(Clone, Debug)]
pub struct DampingCurve {
    within: Spline,
    last: f64,
    at_last: f64,
    exponent: f64,
    /// ω, weight, B within the file's range.
    inner: Vec<[f64; 3]>,
    /// ω, weight, B beyond it, out to infinity by ω = ω_last/u.
    tail: Vec<[f64; 3]>,
    /// ω, weight, B beyond it, out to [`INTEGRAL_END`].
    far: Vec<[f64; 3]>,
}

/// The points of Gauss's rule on a panel, with their weights.
fn panel(from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    GAUSS.into_iter().flat_map(move |[node, weight]| {
        [-node, node].map(|node| [middle + half * node, half * weight])
    })
}

impl DampingCurve {
    /// The curve through values at rising frequencies above 0.
    pub fn new(omega: &[f64], damping: &[f64]) -> Self {
        let x: Vec<f64> = std::iter::once(0.0).chain(omega.iter().copied()).collect();
        let y: Vec<f64> = std::iter::once(0.0)
            .chain(damping.iter().copied())
            .collect();
        let last = x[x.len() - 1];
        let mut curve = Self {
            within: Spline::new(&x, &y),
            last,
            at_last: y[y.len() - 1],
            exponent: exponent(omega, damping),
            inner: Vec::new(),
            tail: Vec::new(),
            far: Vec::new(),
        };
        let with = |points: Vec<[f64; 2]>, curve: &Self| -> Vec<[f64; 3]> {
            let value = |[omega, weight]: [f64; 2]| [omega, weight, curve.at(omega)];
            points.into_iter().map(value).collect()
        };
        let inner = x.windows(2).flat_map(|ends| panel(ends[0], ends[1]));
        curve.inner = with(inner.collect(), &curve);
        let tail = (0..TAIL_PANELS).flat_map(|k| {
            let end = |k: usize| k as f64 / TAIL_PANELS as f64;
            panel(end(k), end(k + 1)).map(|[u, weight]| [last / u, weight * last / (u * u)])
        });
        curve.tail = with(tail.collect(), &curve);
        let far = (0..FAR_PANELS).flat_map(|k| {
            let end = |k: usize| last * (INTEGRAL_END.ln() * k as f64 / FAR_PANELS as f64).exp();
            panel(end(k), end(k + 1))
        });
        curve.far = with(far.collect(), &curve);
        curve
    }

    /// B(ω).
    pub fn at(&self, omega: f64) -> f64 {
        if omega <= self.last {
            return self.within.clamped(omega);
        }
        self.at_last * (self.last / omega).powf(self.exponent)
    }

    /// A(ω) − A∞ that belongs to this damping, by the Kramers-Kronig relation. Subtracting the
    /// value at ω removes the singularity of the principal value, as P∫ dν/(ν² − ω²) = 0:
    ///
    /// ```text
    /// A(ω) − A∞ = −(1/ω) ∫ K(t) sin ωt dt = (2/π) P∫ B(ν)/(ν² − ω²) dν = (2/π) ∫ (B(ν) − B(ω))/(ν² − ω²) dν
    /// ```
    ///
    /// Source: T. F. Ogilvie, *Proc. 5th Symp. Naval Hydrodynamics* (1964) 3.
    pub fn added_mass(&self, omega: f64) -> f64 {
        let here = self.at(omega);
        let points = self.inner.iter().chain(&self.tail);
        let sum: f64 = points
            .map(|[nu, weight, value]| {
                let apart = (nu - omega) * (nu + omega);
                // Where a point of the rule is exactly ω the quotient is 0/0, and its limit, the
                // slope there over 2ω, is left out. The points lie between the file's frequencies,
                // at which this is asked for, so that it does not happen with them.
                match apart == 0.0 {
                    true => 0.0,
                    false => weight * (value - here) / apart,
                }
            })
            .sum();
        2.0 / PI * sum
    }

    /// K(t) = (2/π) ∫ B cos ωt dω.
    pub fn kernel(&self, t: f64) -> f64 {
        let points = self.inner.iter().chain(&self.far);
        let sum: f64 = points
            .map(|[nu, weight, value]| weight * value * (nu * t).cos())
            .sum();
        2.0 / PI * sum
    }
}

/// The exponent n of B ∝ ω⁻ⁿ through the last values, by least squares of logarithms.
fn exponent(omega: &[f64], damping: &[f64]) -> f64 {
    let from = omega.len().saturating_sub(TREND);
    let points = omega[from..].iter().zip(&damping[from..]);
    let logs = points
        .filter(|(_, b)| b.abs() > 0.0)
        .map(|(omega, b)| [omega.ln(), b.abs().ln()]);
    let logs: Vec<[f64; 2]> = logs.collect();
    let count = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|p| p[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let across: f64 = logs.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let along: f64 = logs.iter().map(|p| (p[0] - x) * (p[0] - x)).sum();
    let [least, most] = EXPONENTS;
    if along > 0.0 {
        (-across / along).clamp(least, most)
    } else {
        most
    }
}

/// A∞ by [`DampingCurve::added_mass`]: the median of A(ω) minus it over the middle half of the
/// frequencies, entry by entry. It is consistent with the file's damping, as the memory is; the
/// panel code's own A(∞) differs from it by the errors of both.
pub fn added_mass_at_infinity(hydro: &Hydrodynamics) -> Matrix3<f64> {
    let mut matrix = Matrix3::zeros();
    let count = hydro.omega_rad_s.len();
    for (i, j) in UPPER {
        let curve = DampingCurve::new(&hydro.omega_rad_s, &hydro.damping_entry(i, j));
        let middle = count / 4..(3 * count / 4).max(count / 4 + 1);
        let mut values: Vec<f64> = middle
            .map(|k| hydro.added_mass[k][(i, j)] - curve.added_mass(hydro.omega_rad_s[k]))
            .collect();
        values.sort_by(f64::total_cmp);
        let half = values.len() / 2;
        let median = match values.len() % 2 {
            1 => values[half],
            _ => 0.5 * (values[half - 1] + values[half]),
        };
        matrix[(i, j)] = median;
        matrix[(j, i)] = median;
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The memory K = a e^{−ct} cos bt, for which both integrals have closed forms.
    #[test]
    fn integrals_agree_with_an_exponential() {
        let (a, c, b) = (3.0, 0.6, 1.3);
        let transform = |omega: f64| {
            let s = nalgebra::Complex::new(0.0, omega);
            let p = nalgebra::Complex::new(-c, b);
            (1.0 / (s - p) + 1.0 / (s - p.conj())) * (0.5 * a)
        };
        let omega: Vec<f64> = (1..=400).map(|k| 0.05 * f64::from(k)).collect();
        let damping: Vec<f64> = omega.iter().map(|w| transform(*w).re).collect();
        let mut curve = DampingCurve::new(&omega, &damping);
        // Unlike that of a body, this memory's damping is not zero at ω = 0.
        let x: Vec<f64> = std::iter::once(0.0).chain(omega.iter().copied()).collect();
        let y: Vec<f64> = x.iter().map(|w| transform(*w).re).collect();
        curve.within = Spline::new(&x, &y);
        for point in &mut curve.inner {
            point[2] = curve.within.clamped(point[0]);
        }
        // Its damping falls as ω⁻², which the power law does not allow: the error of the tail is 1
        // % of the sum at the last frequency.
        for omega in [0.4, 1.3, 2.7] {
            let (found, exact) = (curve.added_mass(omega), transform(omega).im / omega);
            assert!((found - exact).abs() < 2e-4, "{omega}: {found} {exact}");
        }
        for t in [0.5, 1.0, 3.0] {
            let (found, exact) = (curve.kernel(t), a * (-c * t).exp() * (b * t).cos());
            assert!((found - exact).abs() < 2e-2, "{t}: {found} {exact}");
        }
    }
}
