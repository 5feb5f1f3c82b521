//! The plane in which a body of a three-dimensional file moves.

use std::f64::consts::{FRAC_PI_2, PI};

/// The largest difference of a wave direction from 0 or π that is still in the plane \[rad\].
pub(super) const IN_PLANE: f64 = 1e-6;

/// The plane that the body moves in: x–z with surge, heave and pitch, or y–z with sway, heave and
/// −roll, which is taken for x–z.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Plane {
    X,
    Y,
}

impl Plane {
    pub fn freedoms(self) -> [&'static str; 3] {
        match self {
            Self::X => ["Surge", "Heave", "Pitch"],
            Self::Y => ["Sway", "Heave", "Roll"],
        }
    }

    /// The sign of each degree of freedom: roll turns y to z, where pitch turns z to x.
    pub fn signs(self) -> [f64; 3] {
        match self {
            Self::X => [1.0; 3],
            Self::Y => [1.0, 1.0, -1.0],
        }
    }

    pub fn axis(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
        }
    }

    /// +1 or −1 if a wave of direction β travels in the plane.
    pub fn direction(self, beta: f64) -> Option<f64> {
        let turn = match self {
            Self::X => beta,
            Self::Y => beta - FRAC_PI_2,
        };
        let from_zero = turn.rem_euclid(2.0 * PI);
        if from_zero.min(2.0 * PI - from_zero) < IN_PLANE {
            Some(1.0)
        } else if (from_zero - PI).abs() < IN_PLANE {
            Some(-1.0)
        } else {
            None
        }
    }
}
