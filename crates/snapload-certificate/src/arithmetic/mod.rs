//! Numbers that are enclosed: a midpoint of many digits and a bound on how far the true one is from
//! it. Each operation stands below the proof that its result encloses every true one.

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
