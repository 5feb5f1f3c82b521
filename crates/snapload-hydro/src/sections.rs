//! Added mass of sections from textbook values, for bodies without a file.
//!
//! ```text
//! ellipse     submerged          A11 = π T², A33 = π b², A55 = π (b² − T²)²/8, exact
//!             floating, ω → ∞    A11 = (2/π) T², A33 = π b²/2, A55 = π (b² − T²)²/16,
//!                                A15 = T (b² − T²)/3
//! rectangle   numbers of a conformal mapping (Schwarz and Christoffel), with a spline between them
//! ```
//!
//! b is half the width, T half the height of a submerged section and the draft of a floating one;
//! all per metre of length and for density 1. The square and the plate agree with J. N. Newman,
//! *Marine Hydrodynamics* (1977), table 4.3, the ratios with DNV-RP-C205, appendix D. At ω → ∞ the
//! pressure on the water surface is zero: heave and pitch have half of the double body's added
//! mass, surge has not. The ends of a body reduce all of it, by 5 % and more if the body is shorter
//! than ten widths.

use crate::error::HydroError;
use crate::spline::Spline;
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// The shape of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// An ellipse, or the lower half of one that floats.
    Ellipse,
    /// A rectangle.
    Rectangle,
}

/// The position of the section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Far below the surface, about its centre.
    Submerged,
    /// In the surface at high frequency, about the middle of its waterline.
    Floating,
}

/// Rectangles that are wider than high: b/T, then A11/T², A33/b² and A55/b⁴ of the submerged one
/// about its centre. For one that is higher than wide, the axes are exchanged.
const SUBMERGED: [[f64; 4]; 8] = [
    [1.0, 4.7537585, 4.7537585, 0.72457574],
    [1.25, 4.9273055, 4.5909944, 0.52899271],
    [5.0 / 3.0, 5.1664599, 4.3973548, 0.46586463],
    [2.0, 5.3266464, 4.2841289, 0.46098104],
    [2.5, 5.5313252, 4.1555138, 0.46363418],
    [3.0, 5.7052338, 4.0584487, 0.46629828],
    [5.0, 6.2213642, 3.823399, 0.46549415],
    [10.0, 6.978148, 3.5834358, 0.45098661],
];

/// Rectangles: b/T, A11/T² and A15/max(b, T)³ of the floating one.
const FLOATING: [[f64; 3]; 11] = [
    [0.1, 0.6942299, -0.3742738],
    [0.2, 0.7170214, -0.3872158],
    [0.5, 0.7502719, -0.3856331],
    [1.0, 0.7738824, -0.3108376],
    [1.25, 0.7806541, -0.1270483],
    [5.0 / 3.0, 0.7886139, -0.024069013],
    [2.0, 0.7931786, 0.003071634],
    [2.5, 0.7982434, 0.017244518],
    [3.0, 0.8019577, 0.020740137],
    [5.0, 0.810437, 0.017012],
    [10.0, 0.8180648, 0.008353467],
];

/// The added mass of one metre of a section over the density of the water \[m², m³, m⁴\], with
/// half-width b and half-height or draft T \[m\].
///
/// # Errors
/// [`HydroError::Value`] if a length is not above zero, or b/T of a rectangle outside 0.1 to 10.
pub fn added_mass_of_section(
    shape: Shape,
    place: Place,
    half_width_m: f64,
    height_m: f64,
) -> Result<Matrix3<f64>, HydroError> {
    let (b, t) = (half_width_m, height_m);
    for (what, length) in [("half the width in m", b), ("the height in m", t)] {
        if !(length > 0.0 && length.is_finite()) {
            return Err(HydroError::value(what, length, "it must be above 0"));
        }
    }
    let (surge, double, coupling) = match shape {
        Shape::Ellipse => {
            let difference = b * b - t * t;
            let double = [PI * t * t, PI * b * b, PI * difference * difference / 8.0];
            (2.0 / PI * t * t, double, t * difference / 3.0)
        }
        Shape::Rectangle => rectangle(b, t)?,
    };
    Ok(match place {
        Place::Submerged => Matrix3::from_diagonal(&double.into()),
        Place::Floating => Matrix3::new(
            surge,
            0.0,
            coupling,
            0.0,
            0.5 * double[1],
            0.0,
            coupling,
            0.0,
            0.5 * double[2],
        ),
    })
}

/// A11 of the floating rectangle, the submerged one's A11, A33 and A55, and A15 of the floating
/// one. Splines are over ln b/T, moments in powers of the diagonal, which is smooth at the square.
fn rectangle(b: f64, t: f64) -> Result<(f64, [f64; 3], f64), HydroError> {
    let (ratio, widest) = (b / t, SUBMERGED[SUBMERGED.len() - 1][0]);
    if !(0.999_999 / widest..=1.000_001 * widest).contains(&ratio) {
        let expected = format!("{} to {widest} are tabulated for rectangles", 1.0 / widest);
        return Err(HydroError::value(
            "half the width over the height",
            ratio,
            expected,
        ));
    }
    // The ratio of the diagonal to the longer side.
    let diagonal = |ratio: f64| {
        let slender = ratio.min(1.0 / ratio);
        (1.0 + slender * slender).sqrt()
    };
    let deep = |column: usize, power: i32| {
        let x = SUBMERGED.map(|row| row[0].ln());
        let y = SUBMERGED.map(|row| row[column] / diagonal(row[0]).powi(power));
        Spline::new(&x, &y).clamped(ratio.ln().abs())
    };
    let high = |column: usize, power: i32| {
        let x = FLOATING.map(|row| row[0].ln());
        let y = FLOATING.map(|row| row[column] / diagonal(row[0]).powi(power));
        Spline::new(&x, &y).clamped(ratio.ln())
    };
    let (short, long) = (b.min(t), b.max(t));
    let (along, across) = (deep(1, 0) * short * short, deep(2, 0) * long * long);
    let turn = deep(3, 4) * b.hypot(t).powi(4);
    let double = match b >= t {
        true => [along, across, turn],
        false => [across, along, turn],
    };
    Ok((high(1, 0) * t * t, double, high(2, 3) * b.hypot(t).powi(3)))
}
