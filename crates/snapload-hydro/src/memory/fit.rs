//! Fits a memory to the coefficients of a file.

use super::block::{Block, coupled, largest_damping, residues};
use super::curve::{DampingCurve, added_mass_at_infinity};
use super::irregular::irregular;
use super::passivity::Nearest;
use super::poles::Poles;
use super::quality::{BlockQuality, EntryQuality, Kernel, entry};
use super::warnings::warnings;
use super::{Memory, Term, TermRow};
use crate::coefficients::{Hydrodynamics, UPPER};
use crate::error::{HydroError, Warning};
use nalgebra::{Complex, DVector, Matrix3};

/// Numbers of pole pairs that are tried in turn, and the error of the fit and of K at which the
/// first is accepted.
const PAIRS: [usize; 5] = [4, 6, 8, 10, 12];
const GOOD_FIT: f64 = 0.01;
/// A worse fit causes a warning.
pub(super) const POOR_FIT: f64 = 0.02;
/// The increase of the error that passivity may cause.
pub(super) const PASSIVITY_MISFIT: f64 = 0.02;

/// Options of the fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FitOptions {
    /// Pairs of poles for each block; if not given, as many as are needed for an error of 1 % in K.
    pub pairs: Option<usize>,
}

/// A memory with its quality.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The memory.
    pub memory: Memory,
    /// The A∞ that belongs to it, computed from the damping instead of the file's.
    pub added_mass_inf: Matrix3<f64>,
    /// The fit of each block.
    pub blocks: Vec<BlockQuality>,
    /// The fit of each entry that is not zero.
    pub entries: Vec<EntryQuality>,
    /// Warnings.
    pub warnings: Vec<Warning>,
}

/// The groups of coupled degrees of freedom that make waves.
fn blocks(hydro: &Hydrodynamics) -> Vec<Vec<usize>> {
    let largest = |i: usize, j: usize| largest_damping(hydro, i, j);
    let (force, omega) = [largest(0, 0), largest(1, 1)]
        .into_iter()
        .fold((0.0, 1.0), |a, b| if b.0 > a.0 { b } else { a });
    // A circle that turns about its centre makes no waves; what the file has for it is noise.
    let length = hydro.water.gravity_m_s2 / (omega * omega);
    let makes_waves = |i: usize| {
        let unit = if i == 2 { length * length } else { 1.0 };
        largest(i, i).0 > 1e-6 * force * unit
    };
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for i in [1, 0, 2].into_iter().filter(|i| makes_waves(*i)) {
        let joins = |block: &Vec<usize>| block.iter().any(|j| coupled(hydro, i, *j));
        let (joined, mut others): (Vec<_>, Vec<_>) = blocks.into_iter().partition(joins);
        let mut block = joined.concat();
        block.push(i);
        block.sort_unstable();
        others.push(block);
        blocks = others;
    }
    blocks
}

/// A fit of one block.
struct Candidate {
    poles: Poles,
    coefficients: Vec<DVector<f64>>,
    quality: BlockQuality,
    /// The worst root mean square of K over the entries.
    kernel_rms: f64,
    /// The largest eigenvalue times the violation, for which damping has to be added.
    violation: f64,
}

impl Block {
    fn candidate(&self, pairs: usize) -> Option<Candidate> {
        let poles = self.poles(pairs)?;
        let residues = residues(self, &poles)?;
        let free = self.coefficients(&residues, &residues.best);
        let rms_before = self.rms(&poles, &free);
        let scale: Vec<f64> = self.samples.scale.iter().map(|s| s.recip()).collect();
        let passive = Nearest {
            poles: &poles,
            omega_max: self.omega_max(),
            size: self.freedoms.len(),
            entries: &self.entries,
            basis: &residues.basis,
            scale: &scale,
            targets: &residues.best,
            unit: &self.unit,
        }
        .passive();
        let bound = self.coefficients(&residues, &passive.z);
        let rms = self.rms(&poles, &bound);
        let damped = rms > rms_before + PASSIVITY_MISFIT || passive.least < -1e-8;
        let (coefficients, rms, least) = match damped {
            true => (free, rms_before, passive.least_before),
            false => (bound, rms, passive.least),
        };
        let mut candidate = Candidate {
            poles,
            coefficients,
            quality: BlockQuality {
                freedoms: self.freedoms.clone(),
                pairs,
                rms_before,
                rms,
                least_before: passive.least_before,
                least,
                damped,
                left_out_rad_s: Vec::new(),
            },
            kernel_rms: 0.0,
            violation: (-least).max(0.0) * passive.largest,
        };
        candidate.kernel_rms = self.kernel_rms(&candidate.memory(self));
        Some(candidate)
    }

    fn kernel_rms(&self, memory: &Memory) -> f64 {
        let mut sums = vec![[0.0; 2]; self.entries.len()];
        for k in 0..self.kernels[0].t.len() {
            let fit = memory.kernel(self.kernels[0].t[k]);
            for (e, (a, b)) in self.entries.iter().enumerate() {
                let value = self.kernels[e].value[k];
                let difference = fit[(self.freedoms[*a], self.freedoms[*b])] - value;
                sums[e][0] += difference * difference;
                sums[e][1] += value * value;
            }
        }
        let part = |[error, size]: [f64; 2]| {
            if size > 0.0 {
                (error / size).sqrt()
            } else {
                0.0
            }
        };
        sums.into_iter().map(part).fold(0.0, f64::max)
    }

    /// The first candidate that is good enough, or else the best. With more pairs of poles than
    /// frequencies what lies between the frequencies is arbitrary, and hard to make passive.
    fn chosen(&self, options: FitOptions) -> Option<Candidate> {
        let determined = PAIRS.into_iter().filter(|pairs| *pairs <= self.own);
        let numbers = match options.pairs {
            Some(pairs) => vec![pairs],
            None => std::iter::once(PAIRS[0])
                .chain(determined.skip(1))
                .collect(),
        };
        let mut best: Option<Candidate> = None;
        for pairs in numbers {
            let Some(candidate) = self.candidate(pairs) else {
                continue;
            };
            let error = |c: &Candidate| c.quality.rms.max(c.kernel_rms);
            let good = error(&candidate) <= GOOD_FIT && !candidate.quality.damped;
            // More poles are accepted only if they reduce the error by a tenth.
            let better = |best: &Candidate| error(&candidate) < 0.9 * error(best);
            if good || best.as_ref().is_none_or(better) {
                best = Some(candidate);
            }
            if good {
                break;
            }
        }
        best
    }
}

impl Candidate {
    /// The terms: the coefficients x, y of a pair stand for the residue 2(x + iy) of the pole with
    /// Im p > 0; taking the real part includes its conjugate.
    fn memory(&self, block: &Block) -> Memory {
        let mut terms = Vec::new();
        let mut at = 0;
        for pole in &self.poles {
            let mut residue = Matrix3::zeros();
            for (e, (a, b)) in block.entries.iter().enumerate() {
                let x = &self.coefficients[e];
                let value = match pole.im == 0.0 {
                    true => Complex::new(x[at], 0.0),
                    false => Complex::new(2.0 * x[at], 2.0 * x[at + 1]),
                };
                let (i, j) = (block.freedoms[*a], block.freedoms[*b]);
                residue[(i, j)] = value;
                residue[(j, i)] = value;
            }
            at += if pole.im == 0.0 { 1 } else { 2 };
            terms.push(Term {
                pole: *pole,
                residue,
            });
        }
        Memory {
            terms,
            damping: Matrix3::zeros(),
        }
    }
}

/// The fit of one block. If it is poor, outlying frequencies are left out, and A∞ and the fit are
/// made again.
fn chosen(
    hydro: &Hydrodynamics,
    inf: &mut Matrix3<f64>,
    freedoms: Vec<usize>,
    options: FitOptions,
) -> Result<(Hydrodynamics, Block, Candidate), HydroError> {
    let best = |block: &Block| {
        block.chosen(options).ok_or_else(|| {
            let message = "no exponentials were found that fit the damping; check it for jumps";
            HydroError::Impossible(message.to_owned())
        })
    };
    let block = Block::new(hydro, inf, freedoms.clone());
    let first = best(&block)?;
    let apart = match first.quality.rms > POOR_FIT {
        true => irregular(&block),
        false => Vec::new(),
    };
    if apart.is_empty() {
        return Ok((hydro.clone(), block, first));
    }
    let kept = hydro.without(&apart);
    let new = added_mass_at_infinity(&kept);
    for i in &freedoms {
        for j in &freedoms {
            inf[(*i, *j)] = new[(*i, *j)];
        }
    }
    let block = Block::new(&kept, inf, freedoms);
    let mut second = best(&block)?;
    let omega = apart.iter().map(|at| hydro.omega_rad_s[*at]);
    second.quality.left_out_rad_s = omega.collect();
    Ok((kept, block, second))
}

/// The largest number of pairs of poles that is allowed.
pub const MOST_PAIRS: usize = 20;

/// The memory of a file's coefficients, by vector fitting of B + iω(A − A∞) with common poles for
/// coupled degrees of freedom, zero damping at constant speed, and passivity.
///
/// # Errors
/// A [`HydroError`] if there is nothing to fit, or no fit is found.
pub fn fit(hydro: &Hydrodynamics, options: FitOptions) -> Result<Fit, HydroError> {
    if let Some(pairs) = options.pairs
        && !(1..=MOST_PAIRS).contains(&pairs)
    {
        let expected = format!("1 to {MOST_PAIRS} pairs of poles are allowed");
        return Err(HydroError::value("pairs", pairs as f64, expected));
    }
    let mut added_mass_inf = added_mass_at_infinity(hydro);
    let mut memory = Memory::default();
    let (mut qualities, mut entries) = (Vec::new(), Vec::new());
    for freedoms in blocks(hydro) {
        let (fitted, block, chosen) = chosen(hydro, &mut added_mass_inf, freedoms, options)?;
        let part = chosen.memory(&block);
        for (a, i) in block.freedoms.iter().enumerate() {
            if chosen.quality.damped {
                memory.damping[(*i, *i)] += chosen.violation / (block.unit[a] * block.unit[a]);
            }
        }
        for (e, (a, b)) in block.entries.iter().enumerate() {
            let place = (block.freedoms[*a], block.freedoms[*b]);
            entries.push(entry(
                &fitted,
                &added_mass_inf,
                &part,
                &block.kernels[e],
                place,
            ));
        }
        memory.terms.extend(part.terms);
        qualities.push(chosen.quality);
    }
    let mut fit = Fit {
        memory,
        added_mass_inf,
        blocks: qualities,
        entries,
        warnings: Vec::new(),
    };
    fit.warnings = warnings(hydro, &fit, "the value consistent with its damping");
    Ok(fit)
}

/// A symmetric matrix of finite numbers from its rows.
fn symmetric(name: &str, rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, HydroError> {
    let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
    let apart = (matrix - matrix.transpose()).amax();
    match apart <= 1e-6 * matrix.amax() {
        true => Ok(matrix),
        false => {
            let message = format!("{name} differs from its transpose, or is not a number");
            Err(HydroError::convention("symmetry", message))
        }
    }
}

/// A given memory with the A∞ and the added damping that belong to it, and its quality
/// relative to a file's coefficients.
///
/// # Errors
/// A [`HydroError`] as [`Memory::check`] gives it, or if one of the matrices is not possible.
pub fn given(
    hydro: &Hydrodynamics,
    added_mass_inf: [[f64; 3]; 3],
    added_damping: [[f64; 3]; 3],
    rows: &[TermRow],
) -> Result<Fit, HydroError> {
    let mut memory = Memory::from_rows(rows)?;
    let added_mass_inf = symmetric("added_mass_inf", added_mass_inf)?;
    let added_damping = symmetric("added_damping", added_damping)?;
    let omega_max = hydro.range_rad_s()[1];
    let mut entries = Vec::new();
    let blocks = blocks(hydro);
    for (i, j) in UPPER {
        let mut terms = memory.terms.iter();
        let acts = terms.any(|term| term.residue[(i, j)].norm() > 0.0);
        // Where the body makes waves a memory that leaves them out differs from the file, too.
        let mut joined = blocks.iter();
        let joined = joined.any(|block| block.contains(&i) && block.contains(&j));
        if acts || joined && coupled(hydro, i, j) {
            let curve = DampingCurve::new(&hydro.omega_rad_s, &hydro.damping_entry(i, j));
            let kernel = Kernel::new(&curve, omega_max);
            entries.push(entry(hydro, &added_mass_inf, &memory, &kernel, (i, j)));
        }
    }
    // As of a fit, the quality is that of the exponentials alone.
    memory.damping = added_damping;
    let mut fit = Fit {
        blocks: Vec::new(),
        entries,
        warnings: Vec::new(),
        memory,
        added_mass_inf,
    };
    fit.warnings = warnings(hydro, &fit, "that of the given memory");
    let own = fit.entries.iter().filter(|e| e.force == e.motion);
    let worst = own.fold(0.0_f64, |worst, entry| worst.max(entry.rms));
    if worst > POOR_FIT {
        let message = format!(
            "the given memory differs from the file by {:.1} %: it is a poor fit of it, was fitted without \
             irregular frequencies of it, or belongs to another file",
            100.0 * worst
        );
        fit.warnings.push(Warning::new("fit", message));
    }
    if let Some(least) = fit.memory.not_passive(omega_max) {
        let message = format!(
            "the given memory is not passive: its damping falls to {:.2} % of its largest size, and \
             it can feed energy into the motion",
            100.0 * least
        );
        fit.warnings.push(Warning::new("passivity", message));
    }
    Ok(fit)
}
