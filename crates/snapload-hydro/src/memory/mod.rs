//! The memory of the waves that a body has made, as a sum of exponentials.

mod block;
mod curve;
mod fit;
mod irregular;
mod least_squares;
mod passivity;
mod poles;
mod quality;
mod warnings;

pub use curve::{DampingCurve, added_mass_at_infinity};
pub use fit::{Fit, FitOptions, MOST_PAIRS, fit, given};
pub use quality::{BlockQuality, EntryQuality};

use crate::error::HydroError;
use nalgebra::{Complex, Matrix3};
use serde::{Deserialize, Serialize};

/// A given memory counts as passive if its least eigenvalue is not further below zero.
const ROUNDING: f64 = 1e-6;

/// One exponential, R e^{pt}.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// p \[1/s\], Re p < 0.
    pub pole: Complex<f64>,
    /// R, symmetric; real where p is.
    pub residue: Matrix3<Complex<f64>>,
}

/// K(t) = Re Σ R_k e^{p_k t}, the retardation function of the waves that a body makes:
///
/// ```text
/// F_mem(t) = ∫ K(t−τ) q̇(τ) dτ = Re Σ R_k z_k,    ż_k = p_k z_k + q̇,    z_k(0) = 0
/// ```
///
/// Source: W. E. Cummins, *Schiffstechnik* 9 (1962) 101, for K; with the exponentials it becomes a
/// system of linear differential equations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// The exponentials.
    pub terms: Vec<Term>,
    /// Damping that was added, the same at all frequencies, where the exponentials could not
    /// be made passive; otherwise zero. In K it is an impulse at t = 0, which
    /// [`Memory::kernel`] leaves out.
    pub damping: Matrix3<f64>,
}

impl Memory {
    /// K(t) \[N/m …\].
    pub fn kernel(&self, t_s: f64) -> Matrix3<f64> {
        let terms = self.terms.iter();
        terms.fold(Matrix3::zeros(), |sum, term| {
            let factor = (term.pole * t_s).exp();
            sum + term.residue.map(|entry| (entry * factor).re)
        })
    }

    /// K̂(iω) = ∫ K e^{−iωt} dt = B(ω) + iω (A(ω) − A∞):
    ///
    /// ```text
    /// K̂(iω) = Σ ½ [R_k/(iω − p_k) + R̄_k/(iω − p̄_k)] + the damping that was added
    /// ```
    pub fn transform(&self, omega_rad_s: f64) -> Matrix3<Complex<f64>> {
        self.transform_at(Complex::new(0.0, omega_rad_s))
    }

    /// The same at any s in place of iω.
    pub(crate) fn transform_at(&self, s: Complex<f64>) -> Matrix3<Complex<f64>> {
        let terms = self.terms.iter();
        terms.fold(self.damping.map(Complex::from), |sum, term| {
            let one = Complex::new(0.5, 0.0) / (s - term.pole);
            let other = Complex::new(0.5, 0.0) / (s - term.pole.conj());
            sum + term.residue.map(|entry| entry * one + entry.conj() * other)
        })
    }

    /// The number of real states of the memory: for each pole and each motion that it responds to,
    /// one if the pole is real and two if it is not.
    pub fn states(&self) -> usize {
        let of = |term: &Term| {
            let columns = (0..3).filter(|j| term.residue.column(*j).iter().any(|r| r.norm() > 0.0));
            columns.count() * if term.pole.im == 0.0 { 1 } else { 2 }
        };
        self.terms.iter().map(of).sum()
    }

    /// The least eigenvalue of Re K̂(iω), as a part of the largest magnitude over ω, over
    /// frequencies from 1e-4 to 1000 times the given one, minima between them included. If it is
    /// not negative the memory is passive and can not feed energy into the motion. Each entry is
    /// relative to the damping of its own degrees of freedom.
    pub fn least_eigenvalue(&self, omega_max_rad_s: f64) -> f64 {
        passivity::least(self, omega_max_rad_s)
    }

    /// The least eigenvalue of a memory that can feed energy into the motion.
    pub(crate) fn not_passive(&self, omega_max_rad_s: f64) -> Option<f64> {
        let least = self.least_eigenvalue(omega_max_rad_s);
        (least < -ROUNDING).then_some(least)
    }

    /// Checks exponentials that are given instead of fitted.
    ///
    /// # Errors
    /// A [`HydroError`] if a pole does not decay, a residue is not symmetric, or a number is not
    /// finite.
    pub fn check(&self) -> Result<(), HydroError> {
        for (index, term) in self.terms.iter().enumerate() {
            let name = format!("memory[{index}]");
            let Complex { re, im } = term.pole;
            if !(re < 0.0 && re.is_finite() && im.is_finite()) {
                let expected =
                    "the real part of a pole must be below zero, so that the memory decays";
                return Err(HydroError::value(format!("{name}.pole[0]"), re, expected));
            }
            let size = term.residue.iter().map(|r| r.norm()).fold(0.0, f64::max);
            if !size.is_finite() || term.residue.iter().any(|r| !r.re.is_finite()) {
                let what = format!("{name}.residue");
                return Err(HydroError::value(what, size, "it must be a finite number"));
            }
            let asymmetric = (term.residue - term.residue.transpose())
                .iter()
                .any(|difference| difference.norm() > 1e-6 * size);
            if asymmetric {
                let message = format!("{name}.residue differs from its transpose");
                return Err(HydroError::convention("symmetry", message));
            }
            let complex = term.residue.iter().any(|r| r.im.abs() > 1e-12 * size);
            if im == 0.0 && complex {
                let message = format!("{name} has a real pole and a residue that is not real");
                return Err(HydroError::convention("real memory", message));
            }
        }
        Ok(())
    }
}

/// A memory as JSON: `[{"pole": [re, im], "residue": [[[re, im], …], …]}, …]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermRow {
    /// p.
    pub pole: [f64; 2],
    /// R by rows.
    pub residue: [[[f64; 2]; 3]; 3],
}

impl Memory {
    /// The memory as rows of numbers.
    pub fn rows(&self) -> Vec<TermRow> {
        let row = |term: &Term| TermRow {
            pole: [term.pole.re, term.pole.im],
            residue: std::array::from_fn(|i| {
                std::array::from_fn(|j| [term.residue[(i, j)].re, term.residue[(i, j)].im])
            }),
        };
        self.terms.iter().map(row).collect()
    }

    /// The memory from rows of numbers.
    ///
    /// # Errors
    /// A [`HydroError`] as [`Memory::check`] gives it.
    pub fn from_rows(rows: &[TermRow]) -> Result<Self, HydroError> {
        let complex = |[re, im]: [f64; 2]| Complex::new(re, im);
        let terms = rows.iter().map(|row| Term {
            pole: complex(row.pole),
            residue: Matrix3::from_fn(|i, j| complex(row.residue[i][j])),
        });
        let memory = Self {
            terms: terms.collect(),
            damping: Matrix3::zeros(),
        };
        memory.check()?;
        Ok(memory)
    }
}
