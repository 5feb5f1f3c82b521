//! How well a memory reproduces the data to which it was fitted.

use super::Memory;
use super::curve::DampingCurve;
use crate::coefficients::{FREEDOMS, Hydrodynamics};
use nalgebra::Matrix3;
use serde::Serialize;

/// The memory is compared over this many units of 1/ω_max, at the number of times that follows.
const COMPARED_TIME: f64 = 140.0;
const COMPARED_TIMES: usize = 400;

/// How well one entry is reproduced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EntryQuality {
    /// The force's freedom, 0 to 2.
    pub force: usize,
    /// The motion's.
    pub motion: usize,
    /// The root mean square of the difference in B + iω(A − A∞), relative to that of the quantity
    /// itself.
    pub rms: f64,
    /// The largest difference in B over the largest B.
    pub worst_damping: f64,
    /// Its frequency \[rad/s\].
    pub worst_damping_rad_s: f64,
    /// The largest difference in A over the largest |A − A∞|.
    pub worst_added_mass: f64,
    /// The root mean square of the difference in K(t), relative to that of K.
    pub kernel_rms: f64,
    /// The largest difference in K(t) over the largest K, most often at t = 0.
    pub worst_kernel: f64,
    /// Frequencies at which B is off by more than 5 % of the largest \[rad/s\], the worst first.
    pub outliers_rad_s: Vec<f64>,
}

impl EntryQuality {
    /// The freedom whose force follows from its own motion, or the two that are coupled.
    pub fn name(&self) -> String {
        let [force, motion] = [self.force, self.motion].map(|i| FREEDOMS[i]);
        match force == motion {
            true => force.to_owned(),
            false => format!("{force} by {motion}"),
        }
    }

    /// The one that is furthest off the file, of those that are.
    pub fn worst<'a>(entries: impl IntoIterator<Item = &'a Self>) -> Option<&'a Self> {
        entries.into_iter().max_by(|a, b| a.rms.total_cmp(&b.rms))
    }
}

/// How a block of coupled freedoms was fitted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockQuality {
    /// The freedoms, 0 to 2.
    pub freedoms: Vec<usize>,
    /// Pairs of poles; two real poles count as a pair.
    pub pairs: usize,
    /// The root mean square of the difference over all entries, before the memory was made passive.
    pub rms_before: f64,
    /// The same of the memory that is used.
    pub rms: f64,
    /// The least eigenvalue of Re K̂ over the largest, before the memory was made passive.
    pub least_before: f64,
    /// The same of the memory that is used.
    pub least: f64,
    /// Whether passivity would have increased the error too much: the memory is unchanged, and
    /// linear damping is added.
    pub damped: bool,
    /// Outlying frequencies that were left out \[rad/s\].
    pub left_out_rad_s: Vec<f64>,
}

/// K(t) from the damping, at the times at which memories are compared.
pub(super) struct Kernel {
    pub t: Vec<f64>,
    pub value: Vec<f64>,
}

impl Kernel {
    pub fn new(curve: &DampingCurve, omega_max: f64) -> Self {
        let time = |k: usize| COMPARED_TIME / omega_max * k as f64 / COMPARED_TIMES as f64;
        let t: Vec<f64> = (0..=COMPARED_TIMES).map(time).collect();
        let value = t.iter().map(|t| curve.kernel(*t)).collect();
        Self { t, value }
    }
}

/// The quality of one entry.
pub(super) fn entry(
    hydro: &Hydrodynamics,
    added_mass_inf: &Matrix3<f64>,
    memory: &Memory,
    kernel: &Kernel,
    (i, j): (usize, usize),
) -> EntryQuality {
    let (mut error, mut size, mut b_max, mut a_max) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    let (mut b_worst, mut b_at, mut a_worst) = (0.0_f64, 0.0, 0.0_f64);
    let mut off = Vec::new();
    for (k, omega) in hydro.omega_rad_s.iter().enumerate() {
        let fit = memory.transform(*omega)[(i, j)];
        let b = hydro.damping[k][(i, j)];
        let a = hydro.added_mass[k][(i, j)] - added_mass_inf[(i, j)];
        let (db, da) = ((fit.re - b).abs(), (fit.im / omega - a).abs());
        error += db * db + (da * omega) * (da * omega);
        size += b * b + (a * omega) * (a * omega);
        (b_max, a_max) = (b_max.max(b.abs()), a_max.max(a.abs()));
        a_worst = a_worst.max(da);
        if db > b_worst {
            (b_worst, b_at) = (db, *omega);
        }
        off.push((*omega, db));
    }
    let part = |value: f64, of: f64| if of > 0.0 { value / of } else { 0.0 };
    let (mut k_error, mut k_size, mut k_worst, mut k_max) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for (t, value) in kernel.t.iter().zip(&kernel.value) {
        let difference = memory.kernel(*t)[(i, j)] - value;
        k_error += difference * difference;
        k_size += value * value;
        k_worst = k_worst.max(difference.abs());
        k_max = k_max.max(value.abs());
    }
    off.retain(|(_, difference)| *difference > 0.05 * b_max);
    off.sort_by(|a, b| b.1.total_cmp(&a.1));
    EntryQuality {
        force: i,
        motion: j,
        rms: part(error, size).sqrt(),
        worst_damping: part(b_worst, b_max),
        worst_damping_rad_s: b_at,
        worst_added_mass: part(a_worst, a_max),
        kernel_rms: part(k_error, k_size).sqrt(),
        worst_kernel: part(k_worst, k_max),
        outliers_rad_s: off.into_iter().map(|(omega, _)| omega).collect(),
    }
}
