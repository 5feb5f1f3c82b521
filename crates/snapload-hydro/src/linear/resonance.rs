//! The response between the file's frequencies, as close as its peaks want it.

use super::body::Body;
use super::response::{Response, of_the_memory, solved};
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::Memory;
use nalgebra::{Complex, Matrix3, Vector3};

/// Points that a peak is looked at in, each time from closer by.
const LOOKS: usize = 32;
/// So many points beside the highest the next look reaches.
const BESIDE: usize = 4;
/// A peak is found where its neighbours are as high, but for this part.
const ALIKE: f64 = 1e-4;
/// Frequencies that differ by less than this part are one.
const SAME: f64 = 1e-9;
/// Looks at one peak at most: one that nothing damps has no end.
const CLOSEST: usize = 14;

/// The largest response of one freedom over all frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// |ξ| \[m/m, m/m, rad/m\].
    pub amplitude: f64,
    /// Where, ω \[rad/s\].
    pub omega_rad_s: f64,
}

impl Response {
    /// The largest response of each freedom at the frequencies that there are.
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
/// exponentials, each at the file's frequencies and so close about every peak that its height is
/// known to a ten-thousandth. A peak may be much narrower than the file's frequencies are apart: it
/// is looked for about every local maximum, and about `natural`, the frequencies of natural
/// motions.
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

    /// The response at more frequencies; where there is none, that point is left out.
    fn add(&mut self, omega: impl Iterator<Item = f64>) {
        let of = self.of;
        self.all
            .extend(omega.filter_map(|omega| Some((omega, of(omega)?))));
        self.all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Splines through them want no two at one place.
        self.all.dedup_by(|a, b| a.0 - b.0 <= SAME * a.0);
    }

    /// With all local maxima of all freedoms looked at from close by.
    fn refined(mut self) -> (Vec<f64>, Vec<Vector3<Complex<f64>>>) {
        let coarse = self.all.clone();
        for freedom in 0..3 {
            let size = |k: usize| coarse[k].1[freedom].norm();
            for k in 1..coarse.len().saturating_sub(1) {
                if size(k) > size(k - 1) && size(k) > size(k + 1) {
                    // Its flanks, too, are steeper than the file's frequencies show.
                    let [low, high] = [k.saturating_sub(3), (k + 3).min(coarse.len() - 1)];
                    self.look_at(freedom, [coarse[low].0, coarse[high].0]);
                }
            }
        }
        self.all.into_iter().unzip()
    }

    /// Looks at the peak of a freedom between two frequencies, ever closer.
    fn look_at(&mut self, freedom: usize, [mut low, mut high]: [f64; 2]) {
        for _ in 0..CLOSEST {
            let step = (high - low) / LOOKS as f64;
            self.add((1..LOOKS).map(|k| low + step * k as f64));
            let first = self.all.partition_point(|(omega, _)| *omega < low);
            let last = self.all.partition_point(|(omega, _)| *omega <= high);
            let size = |k: usize| self.all[k].1[freedom].norm();
            let highest = (first..last).max_by(|a, b| size(*a).total_cmp(&size(*b)));
            let Some(highest) = highest.filter(|k| (first + 1..last - 1).contains(k)) else {
                return;
            };
            let least = size(highest - 1).min(size(highest + 1));
            if least > (1.0 - ALIKE) * size(highest) {
                return;
            }
            low = self.all[highest.saturating_sub(BESIDE).max(first)].0;
            high = self.all[(highest + BESIDE).min(last - 1)].0;
        }
    }
}
