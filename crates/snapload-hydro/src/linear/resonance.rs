//! The response between the file's frequencies, with as many points as its peaks need.

use super::body::Body;
use super::response::{Response, of_the_memory, solved};
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::Memory;
use nalgebra::{Complex, Matrix3, Vector3};

/// Points per refinement of a peak.
const POINTS_PER_REFINEMENT: usize = 32;
/// The number of points on either side of the highest one that the next refinement includes.
const POINTS_ON_EITHER_SIDE: usize = 4;
/// A peak is resolved if its neighbours are as high, up to this part.
const RESOLVED_WITHIN: f64 = 1e-4;
/// Frequencies that differ by less than this part are the same.
const SAME: f64 = 1e-9;
/// The most refinements of one peak; an undamped one would never be resolved.
const CLOSEST: usize = 14;

/// The largest response of one freedom over all frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// |ξ| \[m/m, m/m, rad/m\].
    pub amplitude: f64,
    /// The frequency of the peak ω \[rad/s\].
    pub omega_rad_s: f64,
}

impl Response {
    /// The largest response of each degree of freedom at the available frequencies.
    pub fn peaks(&self) -> [Peak; 3] {
        std::array::from_fn(|freedom| {
            let sizes = self.amplitude.iter().map(|xi| xi[freedom].norm());
            let pairs = sizes.zip(&self.omega_rad_s);
            let none = Peak {
                amplitude: 0.0,
                omega_rad_s: self.omega_rad_s[0],
            };
            pairs.fold(none, |most, (amplitude, omega)| {
                if amplitude > most.amplitude {
                    Peak {
                        amplitude,
                        omega_rad_s: *omega,
                    }
                } else {
                    most
                }
            })
        })
    }
}

/// The response by the file's coefficients, with cubic splines between its frequencies, and by the
/// exponentials, each at the file's frequencies and so densely about every peak that its height is
/// accurate to a ten-thousandth. A peak may be much narrower than the spacing of the file's
/// frequencies: it is searched for about every local maximum, and about `natural`, the frequencies
/// of natural motions.
///
/// # Errors
/// A [`HydroError`] if the file does not have the direction.
pub fn fine_responses(
    hydro: &Hydrodynamics,
    body: &Body,
    (memory, added_mass_inf): (&Memory, &Matrix3<f64>),
    direction: f64,
    natural: &[f64],
) -> Result<[Response; 2], HydroError> {
    let force = hydro.excitation_curve(direction)?;
    let (added, damping) = (hydro.added_mass_curve(), hydro.damping_curve());
    let of_file = |omega: f64| {
        let coefficients = (added.at(omega), damping.at(omega));
        solved(body, omega, coefficients, &force.at(omega)?)
    };
    let of_memory = |omega: f64| {
        let coefficients = of_the_memory(memory, added_mass_inf, omega);
        solved(body, omega, coefficients, &force.at(omega)?)
    };
    let mut omega: Vec<f64> = hydro.omega_rad_s.clone();
    omega.extend(natural);
    let fine = |of: &dyn Fn(f64) -> Option<Vector3<Complex<f64>>>| {
        let (omega_rad_s, amplitude) = Points::new(&omega, of).refined();
        Response {
            direction,
            omega_rad_s,
            amplitude,
        }
    };
    Ok([fine(&of_file), fine(&of_memory)])
}

/// A frequency with its response.
type Point = (f64, Vector3<Complex<f64>>);

/// The response at rising frequencies.
struct Points<'a> {
    of: &'a dyn Fn(f64) -> Option<Vector3<Complex<f64>>>,
    all: Vec<Point>,
}

impl<'a> Points<'a> {
    fn new(omega: &[f64], of: &'a dyn Fn(f64) -> Option<Vector3<Complex<f64>>>) -> Self {
        let mut points = Self {
            of,
            all: Vec::new(),
        };
        points.add(omega.iter().copied());
        points
    }

    /// Adds the response at more frequencies; points without a response are left out.
    fn add(&mut self, omega: impl Iterator<Item = f64>) {
        let of = self.of;
        self.all
            .extend(omega.filter_map(|omega| Some((omega, of(omega)?))));
        self.all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Splines through the points need distinct frequencies.
        self.all.dedup_by(|a, b| a.0 - b.0 <= SAME * a.0);
    }

    /// Refines all local maxima of all degrees of freedom.
    fn refined(mut self) -> (Vec<f64>, Vec<Vector3<Complex<f64>>>) {
        let coarse = self.all.clone();
        for freedom in 0..3 {
            let size = |k: usize| coarse[k].1[freedom].norm();
            for k in 1..coarse.len().saturating_sub(1) {
                if size(k) > size(k - 1) && size(k) > size(k + 1) {
                    // The flanks of the peak, too, are steeper than the file's frequencies show.
                    let [low, high] = [k.saturating_sub(3), (k + 3).min(coarse.len() - 1)];
                    self.look_at(freedom, [coarse[low].0, coarse[high].0]);
                }
            }
        }
        self.all.into_iter().unzip()
    }

    /// Refines the peak of a degree of freedom between two frequencies.
    fn look_at(&mut self, freedom: usize, [mut low, mut high]: [f64; 2]) {
        for _ in 0..CLOSEST {
            let step = (high - low) / POINTS_PER_REFINEMENT as f64;
            self.add((1..POINTS_PER_REFINEMENT).map(|k| low + step * k as f64));
            let first = self.all.partition_point(|(omega, _)| *omega < low);
            let last = self.all.partition_point(|(omega, _)| *omega <= high);
            let size = |k: usize| self.all[k].1[freedom].norm();
            let highest = (first..last).max_by(|a, b| size(*a).total_cmp(&size(*b)));
            let Some(highest) = highest.filter(|k| (first + 1..last - 1).contains(k)) else {
                return;
            };
            let least = size(highest - 1).min(size(highest + 1));
            if least > (1.0 - RESOLVED_WITHIN) * size(highest) {
                return;
            }
            low = self.all[highest.saturating_sub(POINTS_ON_EITHER_SIDE).max(first)].0;
            high = self.all[(highest + POINTS_ON_EITHER_SIDE).min(last - 1)].0;
        }
    }
}
