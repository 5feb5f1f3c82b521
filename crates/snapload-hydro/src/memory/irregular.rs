//! Outlying frequencies in the results of a panel code.

use super::block::{Block, residues};
use super::poles::{Poles, Samples, basis, first_guess, relocate};
use nalgebra::Complex;

/// Pairs of poles, relocations and rounds.
const PAIRS: usize = 6;
const RELOCATIONS: usize = 20;
const ROUNDS: usize = 6;
/// The number of rounds in which outliers have a reduced weight; in those after it their weight is
/// zero.
const SOFT: usize = 4;
/// A sample is an outlier if its error exceeds this part of the median size, and this many median
/// errors.
const OUTLIER: f64 = 0.05;
const ERRORS: f64 = 3.0;

/// The indices of outlying frequencies, by a fit in which a sample's weight decreases with its
/// error (Huber's weights), and is zero for outliers in the last rounds. At most a quarter of all.
pub(super) fn irregular(block: &Block) -> Vec<usize> {
    let mut block = Block {
        samples: robust(block),
        kernels: Vec::new(),
        unit: block.unit.clone(),
        freedoms: block.freedoms.clone(),
        entries: block.entries.clone(),
        own: block.own,
    };
    let beyond: Vec<f64> = block.samples.weight[block.own..].to_vec();
    let mut errors = vec![0.0; block.own];
    let mut limit = f64::INFINITY;
    for round in 0..ROUNDS {
        let Some(poles) = best(&block) else {
            return Vec::new();
        };
        let Some(new) = differences(&block, &poles) else {
            return Vec::new();
        };
        errors = new;
        limit = OUTLIER.max(ERRORS * median(&errors));
        for (weight, error) in block.samples.weight.iter_mut().zip(&errors) {
            *weight = match (round < SOFT, *error > limit, *error > 2.0 * limit) {
                (true, true, _) => limit / error,
                (false, _, true) => 0.0,
                _ => 1.0,
            };
        }
        // The extrapolation beyond the last frequency depends on the last ones.
        let trusted = block.samples.weight[block.own - 3..block.own].iter();
        let trusted = trusted.fold(1.0, |least: f64, weight| least.min(*weight)) > 0.5;
        for (weight, own) in block.samples.weight[block.own..].iter_mut().zip(&beyond) {
            *weight = if trusted { *own } else { 0.0 };
        }
    }
    let apart: Vec<usize> = (0..block.own)
        .filter(|k| errors[*k] > 2.0 * limit)
        .collect();
    match apart.len() > block.own / 4 {
        true => Vec::new(),
        false => apart,
    }
}

/// The samples with each function divided by its median.
fn robust(block: &Block) -> Samples {
    let samples = &block.samples;
    let scale = (0..samples.values.ncols()).map(|e| {
        let sizes = samples.values.column(e);
        let sizes: Vec<f64> = sizes
            .iter()
            .take(block.own)
            .map(|value| value.norm())
            .collect();
        median(&sizes).max(f64::MIN_POSITIVE).recip()
    });
    Samples {
        omega: samples.omega.clone(),
        values: samples.values.clone(),
        weight: samples.weight.clone(),
        scale: scale.collect(),
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// The poles whose weighted error is least.
fn best(block: &Block) -> Option<Poles> {
    let mut poles = first_guess(PAIRS, block.omega_max());
    let mut best: Option<(f64, Poles)> = None;
    for _ in 0..RELOCATIONS {
        poles = relocate(&block.samples, &poles)?;
        let Some(errors) = differences(block, &poles) else {
            continue;
        };
        let weighted = errors.iter().zip(&block.samples.weight);
        let error: f64 = weighted
            .map(|(error, weight)| (error * weight).powi(2))
            .sum();
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, poles.clone()));
        }
    }
    best.map(|(_, poles)| poles)
}

/// The largest difference over the functions at each of the file's frequencies, each relative to
/// its function.
fn differences(block: &Block, poles: &Poles) -> Option<Vec<f64>> {
    let residues = residues(block, poles)?;
    let coefficients = block.coefficients(&residues, &residues.best);
    let of = |k: usize| {
        let functions = basis(Complex::new(0.0, block.samples.omega[k]), poles);
        let each = coefficients.iter().enumerate().map(|(e, coefficients)| {
            let pairs = functions.iter().zip(coefficients.iter());
            let fit: Complex<f64> = pairs.map(|(f, x)| f * *x).sum();
            (fit - block.samples.values[(k, e)]).norm() * block.samples.scale[e]
        });
        each.fold(0.0, f64::max)
    };
    Some((0..block.own).map(of).collect())
}
