//! The proof of slack flight, impacts and stops.
pub(crate) mod flight;
pub(crate) mod impact;
pub(crate) mod search;
pub(crate) mod set;

#[cfg(test)]
mod tests;
