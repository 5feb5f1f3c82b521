//! How many digits an error leaves.

/// What a double can hold.
const MOST: f64 = 15.95;

/// Decimal digits that are expected to be right within an error of a value of about 1.
pub fn digits_within(error: f64) -> f64 {
    (-libm::log10(error)).clamp(0.0, MOST)
}
