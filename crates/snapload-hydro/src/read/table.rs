//! Coefficients that are read in any order, sorted by their frequencies.

use crate::coefficients::{Excitation, FREEDOMS, Hydrodynamics, Hydrostatics, crest_ahead};
use crate::error::HydroError;
use crate::water::Water;
use nalgebra::{Complex, Matrix3, Vector3};

/// The values at one frequency.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// ω \[rad/s\], 0 and infinity included.
    pub omega: f64,
    /// A, not symmetric yet: row force, column motion.
    pub added_mass: Matrix3<f64>,
    /// B; it has no meaning at 0 and at infinity.
    pub damping: Matrix3<f64>,
    /// X of each direction, in the order of [`Table::directions`], with the crest at
    /// [`Table::crest_m`] at t = 0.
    pub excitation: Vec<Vector3<Complex<f64>>>,
}

/// All values of a file.
pub(super) struct Table {
    pub rows: Vec<Row>,
    /// +1 for waves to +x, −1 to −x.
    pub directions: Vec<f64>,
    pub water: Water,
    pub reference_m: [f64; 2],
    /// 0 in the files of all panel codes \[m\].
    pub crest_m: f64,
    pub hydrostatics: Hydrostatics,
}

impl Table {
    /// Sorts the rows by frequency; each may occur only once.
    fn sort(&mut self) -> Result<(), HydroError> {
        if let Some(row) = self
            .rows
            .iter()
            .find(|row| row.omega.is_nan() || row.omega < 0.0)
        {
            let expected = "a frequency must be 0 or above";
            return Err(HydroError::value("ω", row.omega, expected));
        }
        self.rows.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        if let Some(pair) = self
            .rows
            .windows(2)
            .find(|pair| pair[0].omega == pair[1].omega)
        {
            let expected = "each frequency may occur only once";
            return Err(HydroError::value("ω", pair[0].omega, expected));
        }
        Ok(())
    }

    /// The coefficients sorted by frequency, with symmetric matrices.
    pub fn into_hydrodynamics(mut self) -> Result<Hydrodynamics, HydroError> {
        self.sort()?;
        let (mut zero, mut inf) = (None, None);
        let mut finite: Vec<Row> = Vec::new();
        let mut added_mass = Vec::new();
        for mut row in self.rows {
            added_mass.push(row.added_mass);
            row.added_mass = symmetric(&row.added_mass);
            let whole = row.added_mass.iter().all(|value| value.is_finite());
            match row.omega {
                0.0 => zero = whole.then_some(row.added_mass),
                f64::INFINITY => inf = whole.then_some(row.added_mass),
                _ => finite.push(row),
            }
        }
        if finite.len() < 4 {
            let found = format!("{} frequencies above 0 and below infinity", finite.len());
            let expected = "at least four are required, and twenty or more are recommended";
            return Err(HydroError::layout("the file", found, expected));
        }
        finite.iter().try_for_each(Row::check)?;
        let damping: Vec<Matrix3<f64>> = finite.iter().map(|row| row.damping).collect();
        let length_m = length_of(&added_mass, self.water.density_kg_m3);
        let asymmetry = asymmetric_part(&added_mass, length_m);
        let damping_asymmetry = asymmetric_part(&damping, length_m);
        let excitation = self.directions.iter().enumerate();
        let (ahead_m, water) = (self.reference_m[0] - self.crest_m, self.water);
        let excitation = excitation.map(|(index, direction)| {
            let here = |row: &Row| {
                let force = row.excitation[index];
                crest_ahead(force, ahead_m, *direction, row.omega, &water)
            };
            Excitation {
                direction: *direction,
                force: finite.iter().map(here).collect(),
            }
        });
        Ok(Hydrodynamics {
            excitation: excitation.collect(),
            omega_rad_s: finite.iter().map(|row| row.omega).collect(),
            added_mass: finite.iter().map(|row| row.added_mass).collect(),
            damping: finite.iter().map(|row| symmetric(&row.damping)).collect(),
            added_mass_zero: zero,
            added_mass_inf: inf,
            asymmetry,
            damping_asymmetry,
            water: self.water,
            reference_m: self.reference_m,
            hydrostatics: self.hydrostatics,
            section: None,
        })
    }
}

impl Row {
    /// Checks that no number is missing.
    fn check(&self) -> Result<(), HydroError> {
        let matrices = [("added mass", &self.added_mass), ("damping", &self.damping)];
        for (name, matrix) in matrices {
            for i in 0..3 {
                for j in 0..3 {
                    let what = format!("{name} of {} by {}", FREEDOMS[i], FREEDOMS[j]);
                    self.finite(&what, matrix[(i, j)])?;
                }
            }
        }
        for force in &self.excitation {
            for (i, value) in force.iter().enumerate() {
                let what = format!("wave force on {}", FREEDOMS[i]);
                self.finite(&what, value.re)?;
                self.finite(&what, value.im)?;
            }
        }
        Ok(())
    }

    fn finite(&self, what: &str, value: f64) -> Result<(), HydroError> {
        if value.is_finite() && value.abs() < 1e30 {
            return Ok(());
        }
        let what = format!("the {what} at ω = {} rad/s", self.omega);
        let expected =
            "a number is expected; remove this frequency from the file, or compute it again";
        Err(HydroError::value(what, value, expected))
    }
}

fn symmetric(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// A motion whose added mass or damping is this part of the largest, in terms of a length of the
/// body's size, makes no waves, as a circle that turns about its centre: what the file has for it is
/// noise.
const NOISE: f64 = 1e-6;

/// Σ |M|, without matrices that are not whole.
fn sum_of_sizes(matrices: impl Iterator<Item = Matrix3<f64>>) -> Matrix3<f64> {
    let whole = matrices.filter(|matrix| matrix.iter().all(|value| value.is_finite()));
    whole.map(|matrix| matrix.abs()).sum()
}

/// A length of the body's size, the side of a cube of water with the mass that it moves \[m\].
pub(super) fn length_of(added_mass: &[Matrix3<f64>], density_kg_m3: f64) -> f64 {
    let whole = added_mass.iter().map(|a| a[(0, 0)].max(a[(1, 1)]));
    let largest = whole.filter(|mass| mass.is_finite()).fold(0.0, f64::max);
    (largest / density_kg_m3).cbrt()
}

/// The largest Σ |M_ij − M_ji| over sqrt(Σ |M_ii| Σ |M_jj|). At single frequencies a value may be
/// nearly zero, or irregular, and a part of it says nothing.
fn asymmetric_part(matrices: &[Matrix3<f64>], length_m: f64) -> f64 {
    let apart = sum_of_sizes(matrices.iter().map(|m| m - m.transpose()));
    let sizes = sum_of_sizes(matrices.iter().copied());
    let largest = sizes[(0, 0)].max(sizes[(1, 1)]);
    let size = |i: usize| {
        let unit = if i == 2 { length_m * length_m } else { 1.0 };
        sizes[(i, i)].max(NOISE * largest * unit)
    };
    let part = |(i, j): (usize, usize)| apart[(i, j)] / (size(i) * size(j)).sqrt();
    let parts = [(0, 1), (0, 2), (1, 2)].map(part);
    let known = parts.into_iter().filter(|part| part.is_finite());
    known.fold(0.0, f64::max)
}
