//! Numbers with enclosures: a midpoint of many digits and a bound on its distance from the true
//! number. The proof that a result encloses every true value stands above each operation.

pub(crate) mod ball;
pub(crate) mod decimal;
pub(crate) mod elementary;
pub(crate) mod interval;
pub(crate) mod number;
pub(crate) mod radius;
pub(crate) mod scalar;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod wide_tests;
