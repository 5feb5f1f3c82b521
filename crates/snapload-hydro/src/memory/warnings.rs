//! Warnings about a memory.

use super::fit::{Fit, PASSIVITY_MISFIT, POOR_FIT};
use super::quality::{BlockQuality, EntryQuality};
use crate::coefficients::{FREEDOMS, Hydrodynamics};
use crate::error::Warning;
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// All warnings; A∞ is `consistent_value`, in words.
pub(super) fn warnings(hydro: &Hydrodynamics, fit: &Fit, consistent_value: &str) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if let Some(file) = hydro.added_mass_inf {
        for (i, freedom) in FREEDOMS.iter().enumerate() {
            let own = fit.added_mass_inf[(i, i)];
            let off = file[(i, i)] / own - 1.0;
            if own != 0.0 && off.abs() > 0.01 {
                let message = format!(
                    "the file's A(∞) of {freedom} differs by {:.1} % from {consistent_value}; the \
                     latter is used",
                    100.0 * off
                );
                warnings.push(Warning::new("added mass at infinity", message));
            }
        }
    }
    for block in &fit.blocks {
        of_block(block, &fit.entries, &mut warnings);
    }
    let apart = hydro
        .omega_rad_s
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(0.0, f64::max);
    let long = length(hydro, fit);
    if long > PI / apart {
        let message = format!(
            "frequencies are up to {apart:.3} rad/s apart, which resolves a memory of at most {:.1} s, but \
             this one lasts {long:.1} s; compute them at smaller steps",
            PI / apart
        );
        warnings.push(Warning::new("frequency steps", message));
    }
    let own = fit
        .entries
        .iter()
        .filter(|entry| entry.force == entry.motion);
    for entry in own.filter(|entry| !entry.outliers_rad_s.is_empty()) {
        let message = format!(
            "the damping of {} differs from the fit by more than 5 % of its largest value at ω = {} rad/s",
            FREEDOMS[entry.force],
            list(&entry.outliers_rad_s)
        );
        warnings.push(Warning::new("off the fit", message));
    }
    warnings
}

/// How long the memory of one of the degrees of freedom exceeds a fiftieth of its largest value
/// \[s\].
fn length(hydro: &Hydrodynamics, fit: &Fit) -> f64 {
    let step = 0.5 / hydro.range_rad_s()[1];
    let kernels: Vec<Matrix3<f64>> = (0..1000)
        .map(|k| fit.memory.kernel(step * f64::from(k)))
        .collect();
    let last = |i: usize| {
        let largest = kernels
            .iter()
            .fold(0.0, |most: f64, k| most.max(k[(i, i)].abs()));
        kernels
            .iter()
            .rposition(|k| k[(i, i)].abs() > 0.02 * largest)
            .unwrap_or(0)
    };
    step * (0..3).map(last).max().unwrap_or(0) as f64
}

fn of_block(block: &BlockQuality, entries: &[EntryQuality], warnings: &mut Vec<Warning>) {
    let names = block.freedoms.iter().map(|i| FREEDOMS[*i]);
    let names = names.collect::<Vec<_>>().join(" and ");
    if block.rms > POOR_FIT {
        let within = |entry: &&EntryQuality| block.freedoms.contains(&entry.force);
        let worst = EntryQuality::worst(entries.iter().filter(within));
        let worst = worst.filter(|entry| block.freedoms.len() > 1 && entry.rms > block.rms);
        let worst = worst.map_or(String::new(), |entry| {
            format!(", {} alone to {:.1} %", entry.name(), 100.0 * entry.rms)
        });
        let message = format!(
            "the memory of {names} fits the file only to {:.1} %{worst}; results are no more accurate",
            100.0 * block.rms
        );
        warnings.push(Warning::new("fit", message));
    }
    if !block.left_out_rad_s.is_empty() {
        let message = format!(
            "the coefficients of {names} at ω = {} rad/s deviate from the others and were left out \
             of the memory, as they probably are irregular frequencies. Undamped periods, responses by \
             the file and the forces of waves still contain them. Compute the file again with a lid",
            list(&block.left_out_rad_s)
        );
        warnings.push(Warning::new("irregular frequencies", message));
    }
    if block.damped {
        let message = format!(
            "the memory of {names} could not be made passive, or only with an error larger by more than \
             {:.0} percentage points; it is kept unchanged, and linear damping of {:.2} % of the largest value is added",
            100.0 * PASSIVITY_MISFIT,
            -100.0 * block.least
        );
        warnings.push(Warning::new("passivity", message));
    }
}

/// The first few frequencies.
fn list(omega: &[f64]) -> String {
    let shown: Vec<String> = omega
        .iter()
        .take(12)
        .map(|omega| format!("{omega:.3}"))
        .collect();
    shown.join(", ")
}
