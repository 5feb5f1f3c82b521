//! The proof of motion with one taut cable.
pub(crate) mod run;
pub(crate) mod series;
pub(crate) mod sliding;
pub(crate) mod step;

#[cfg(test)]
mod tests;
