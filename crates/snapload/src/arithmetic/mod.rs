//! The number types of the physics, and power series of them.
//!
//! Doubles for the ordinary run ([`double`], [`elementary`]), several side by side ([`lane`]),
//! numbers with their derivatives ([`dual`]), numbers of many digits ([`precise`]), vectors of the
//! plane ([`plane`]), truncated power series ([`polynomial`], [`vector_series`]), and work compiled
//! for the processor at hand ([`processor`]).

pub(crate) mod double;
pub(crate) mod dual;
pub(crate) mod elementary;
pub(crate) mod lane;
pub(crate) mod plane;
pub(crate) mod polynomial;
pub(crate) mod precise;
pub(crate) mod processor;
pub(crate) mod real;
pub(crate) mod vector_series;
