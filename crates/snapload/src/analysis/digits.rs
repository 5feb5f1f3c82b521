//! The number of correct decimal digits that an error leaves.

/// The decimal digits of a double.
const MOST: f64 = 15.95;

/// Decimal digits of a value of about 1 that are expected to be right if its error is `error`.
pub fn digits_within(error: f64) -> f64 {
    (-libm::log10(error)).clamp(0.0, MOST)
}
