//! The proof of motion with taut cables.
pub(crate) mod chart;
mod enclosure;
pub(crate) mod free;
pub(crate) mod law;
pub(crate) mod rocking;
pub(crate) mod run;
pub(crate) mod series;
pub(crate) mod sliding;
pub(crate) mod snap;
pub(crate) mod start;
pub(crate) mod step;

#[cfg(test)]
mod tests;
