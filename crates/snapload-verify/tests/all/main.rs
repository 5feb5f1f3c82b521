//! All tests from outside, as one program: it is linked once, and the tests of all files run side
//! by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod arithmetics;
mod calibration;
mod common;
mod derivatives;
mod floating;
mod printed_decimals;
mod trust;
mod trust_causes;
