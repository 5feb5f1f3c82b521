//! Hydrodynamic coefficients of one floating body in the vertical plane: the forces of the water on
//! it.

use crate::error::HydroError;
use crate::section_body::{SectionBody, SectionForce};
use crate::spline::Spline;
use crate::water::Water;
use crate::waves::wave_number;
use nalgebra::{Complex, Matrix3, Vector3};

/// The degrees of freedom in their order: x, z, and rotation from z to x about the reference point.
pub const FREEDOMS: [&str; 3] = ["surge", "heave", "pitch"];

/// The body's weight and buoyancy by the file. Positions are absolute, (x, z) with z = 0 in the
/// still water.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hydrostatics {
    /// C about the reference point; it includes m g z_G of a body whose mass is the displaced mass.
    pub stiffness: Option<Matrix3<f64>>,
    /// ρV \[kg\].
    pub displaced_mass_kg: Option<f64>,
    /// The centre of gravity that `stiffness` assumes \[m\].
    pub centre_of_mass_m: Option<[f64; 2]>,
    /// The centre of buoyancy \[m\].
    pub centre_of_buoyancy_x_m: Option<f64>,
    /// The file's own rigid-body mass matrix about the reference point.
    pub inertia: Option<Matrix3<f64>>,
}

/// The force of a regular wave of unit amplitude in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// +1 for a wave that travels to +x (β = 0), −1 to −x (β = π).
    pub direction: f64,
    /// X(ω) \[N/m, N/m, N m/m\], F = Re X e^{−iωt} for a wave with its crest over the reference
    /// point at t = 0. With a crest far from the body X would turn too fast to be interpolated.
    pub force: Vec<Vector3<Complex<f64>>>,
}

/// Coefficients at frequencies ω, in SI units, of surge, heave and pitch about the reference point.
/// Time goes as e^{−iωt} in the excitation; added mass and damping do not depend on that choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Hydrodynamics {
    /// The frequencies ω \[rad/s\], finite, above 0 and rising.
    pub omega_rad_s: Vec<f64>,
    /// A(ω) \[kg, kg m, kg m²\], symmetric.
    pub added_mass: Vec<Matrix3<f64>>,
    /// B(ω) \[N s/m, N s, N m s\], symmetric.
    pub damping: Vec<Matrix3<f64>>,
    /// A(0), if the file has it.
    pub added_mass_zero: Option<Matrix3<f64>>,
    /// A(∞), if the file has it.
    pub added_mass_inf: Option<Matrix3<f64>>,
    /// The largest Σ |A_ij − A_ji| as a part of sqrt(Σ A_ii Σ A_jj), summed over ω, before A was made
    /// symmetric.
    pub asymmetry: f64,
    /// The same of B.
    pub damping_asymmetry: f64,
    /// X(ω), one or two directions.
    pub excitation: Vec<Excitation>,
    /// The water.
    pub water: Water,
    /// The reference point O \[m\].
    pub reference_m: [f64; 2],
    /// Weight and buoyancy.
    pub hydrostatics: Hydrostatics,
    /// The section of textbook values, whose wave force has a closed form at all frequencies; none
    /// for a file.
    pub section: Option<SectionBody>,
}

impl Hydrodynamics {
    /// The excitation in a direction, +1 or −1.
    ///
    /// # Errors
    /// [`HydroError::Missing`] if the file does not have it.
    pub fn excitation_to(&self, direction: f64) -> Result<&Excitation, HydroError> {
        let found = self.excitation.iter().find(|x| x.direction == direction);
        found.ok_or_else(|| {
            let (sign, beta) = if direction > 0.0 {
                ("+x", "0")
            } else {
                ("-x", "π")
            };
            HydroError::missing(
                format!("the excitation of waves to {sign}"),
                format!("compute it with the panel code for the wave direction β = {beta}"),
            )
        })
    }

    /// One entry of A over ω.
    pub fn added_mass_entry(&self, i: usize, j: usize) -> Vec<f64> {
        self.added_mass.iter().map(|a| a[(i, j)]).collect()
    }

    /// One entry of B over ω.
    pub fn damping_entry(&self, i: usize, j: usize) -> Vec<f64> {
        self.damping.iter().map(|b| b[(i, j)]).collect()
    }

    /// A(ω) interpolated between the frequencies by cubic splines (not-a-knot), entry by entry;
    /// beyond them the value at the nearest.
    pub fn added_mass_curve(&self) -> MatrixCurve {
        MatrixCurve::new(&self.omega_rad_s, |i, j| self.added_mass_entry(i, j))
    }

    /// The same of B(ω).
    pub fn damping_curve(&self) -> MatrixCurve {
        MatrixCurve::new(&self.omega_rad_s, |i, j| self.damping_entry(i, j))
    }

    /// The wave force X(ω) of a direction between the frequencies: of a section its closed form, of
    /// a file real and imaginary part by cubic splines; none outside them.
    ///
    /// # Errors
    /// [`HydroError::Missing`] if the file does not have the direction.
    pub fn excitation_curve(&self, direction: f64) -> Result<ExcitationCurve, HydroError> {
        let x = &self.excitation_to(direction)?.force;
        let range_rad_s = self.range_rad_s();
        if let Some(section) = &self.section {
            let from_section = [self.reference_m[0] - section.x_m, self.reference_m[1]];
            let moved = Moved {
                shift_m: from_section,
                direction,
                water: self.water,
            };
            let force = Box::new(section.force(&self.water, direction)?);
            let force = XOverOmega::Section(force, moved);
            return Ok(ExcitationCurve { range_rad_s, force });
        }
        let part = |of: fn(Complex<f64>) -> f64, i: usize| {
            let values: Vec<f64> = x.iter().map(|force| of(force[i])).collect();
            Spline::new(&self.omega_rad_s, &values)
        };
        let parts = std::array::from_fn(|i| [part(|z| z.re, i), part(|z| z.im, i)]);
        let force = XOverOmega::Splines(Box::new(parts));
        Ok(ExcitationCurve { range_rad_s, force })
    }

    /// The same without some of the frequencies, given by index. A(0), A(∞) and the rest are kept.
    pub fn without(&self, places: &[usize]) -> Self {
        let mut kept = self.clone();
        for at in places
            .iter()
            .rev()
            .filter(|at| **at < self.omega_rad_s.len())
        {
            kept.omega_rad_s.remove(*at);
            kept.added_mass.remove(*at);
            kept.damping.remove(*at);
            for excitation in &mut kept.excitation {
                excitation.force.remove(*at);
            }
        }
        kept
    }

    /// The lowest and the highest frequency \[rad/s\].
    pub fn range_rad_s(&self) -> [f64; 2] {
        let ends = [self.omega_rad_s.first(), self.omega_rad_s.last()];
        ends.map(|end| end.copied().unwrap_or(0.0))
    }
}

/// A symmetric matrix as a function of ω.
#[derive(Clone, Debug)]
pub struct MatrixCurve {
    /// The upper triangle, by row.
    entries: Vec<Spline>,
}

impl MatrixCurve {
    fn new(omega: &[f64], entry: impl Fn(usize, usize) -> Vec<f64>) -> Self {
        let entries = UPPER.map(|(i, j)| Spline::new(omega, &entry(i, j)));
        Self {
            entries: entries.to_vec(),
        }
    }

    /// The matrix at ω.
    pub fn at(&self, omega_rad_s: f64) -> Matrix3<f64> {
        let mut matrix = Matrix3::zeros();
        for ((i, j), entry) in UPPER.into_iter().zip(&self.entries) {
            matrix[(i, j)] = entry.clamped(omega_rad_s);
            matrix[(j, i)] = matrix[(i, j)];
        }
        matrix
    }
}

/// The upper triangle of a symmetric matrix, by row.
pub(crate) const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// X as a function of ω.
#[derive(Clone, Debug)]
pub struct ExcitationCurve {
    range_rad_s: [f64; 2],
    force: XOverOmega,
}

#[derive(Clone, Debug)]
enum XOverOmega {
    /// Real and imaginary part of each degree of freedom.
    Splines(Box<[[Spline; 2]; 3]>),
    /// The force about the section's own point, and the way from there to the reference point.
    Section(Box<SectionForce>, Moved),
}

impl ExcitationCurve {
    /// X at ω, or none outside the file's range.
    pub fn at(&self, omega_rad_s: f64) -> Option<Vector3<Complex<f64>>> {
        let [first, last] = self.range_rad_s;
        if !(first..=last).contains(&omega_rad_s) {
            return None;
        }
        Some(match &self.force {
            XOverOmega::Section(force, moved) => moved.force(omega_rad_s, &force.at(omega_rad_s)),
            XOverOmega::Splines(parts) => Vector3::from_fn(|i, _| {
                let [re, im] = &parts[i];
                Complex::new(re.clamped(omega_rad_s), im.clamped(omega_rad_s))
            }),
        })
    }
}

/// J with q̇_O = J q̇_O' for another reference point O' = O + (dx, dz): matrices M, A, B, K become
/// Jᵀ(·)J and forces JᵀX. A wave force also gets another phase, as the crest is over O' at t = 0.
///
/// ```text
/// J = [[1, 0, −dz], [0, 1, dx], [0, 0, 1]]
/// ```
pub fn transport([dx, dz]: [f64; 2]) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, -dz, 0.0, 1.0, dx, 0.0, 0.0, 1.0)
}

/// The way of the reference point to another place, in waves of one direction.
#[derive(Clone, Copy, Debug)]
struct Moved {
    shift_m: [f64; 2],
    direction: f64,
    water: Water,
}

impl Moved {
    /// X about the new place, with the crest over it at t = 0.
    fn force(&self, omega_rad_s: f64, x: &Vector3<Complex<f64>>) -> Vector3<Complex<f64>> {
        let j = transport(self.shift_m).map(|entry| Complex::new(entry, 0.0));
        let ahead_m = self.shift_m[0];
        crest_ahead(
            j.transpose() * x,
            ahead_m,
            self.direction,
            omega_rad_s,
            &self.water,
        )
    }
}

/// A wave force if the crest at t = 0 is further along x by `ahead_m`: X e^{−ik Δx} of waves to +x,
/// X e^{ik Δx} of waves to −x.
pub(crate) fn crest_ahead(
    force: Vector3<Complex<f64>>,
    ahead_m: f64,
    direction: f64,
    omega_rad_s: f64,
    water: &Water,
) -> Vector3<Complex<f64>> {
    if ahead_m == 0.0 {
        return force;
    }
    let k = wave_number(omega_rad_s, water.depth_m, water.gravity_m_s2);
    force * Complex::from_polar(1.0, -direction * k * ahead_m)
}

impl Hydrodynamics {
    /// The same body about another reference point \[m\]. The hydrostatic stiffness is transported
    /// too, which is right for the file's, where weight and buoyancy are in balance.
    pub fn about(&self, reference_m: [f64; 2]) -> Self {
        let shift = [0, 1].map(|axis| reference_m[axis] - self.reference_m[axis]);
        let j = transport(shift);
        let matrix = |m: &Matrix3<f64>| j.transpose() * m * j;
        let excitation = |x: &Excitation| {
            let moved = Moved {
                shift_m: shift,
                direction: x.direction,
                water: self.water,
            };
            let both = self.omega_rad_s.iter().zip(&x.force);
            Excitation {
                direction: x.direction,
                force: both
                    .map(|(omega, force)| moved.force(*omega, force))
                    .collect(),
            }
        };
        let statics = &self.hydrostatics;
        Self {
            added_mass: self.added_mass.iter().map(matrix).collect(),
            damping: self.damping.iter().map(matrix).collect(),
            added_mass_zero: self.added_mass_zero.as_ref().map(matrix),
            added_mass_inf: self.added_mass_inf.as_ref().map(matrix),
            excitation: self.excitation.iter().map(excitation).collect(),
            reference_m,
            hydrostatics: Hydrostatics {
                stiffness: statics.stiffness.as_ref().map(matrix),
                inertia: statics.inertia.as_ref().map(matrix),
                ..statics.clone()
            },
            omega_rad_s: self.omega_rad_s.clone(),
            ..*self
        }
    }
}
