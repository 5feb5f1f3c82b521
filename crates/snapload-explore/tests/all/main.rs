//! All tests of the server of the page from outside, as one program: it is linked once, and the
//! tests of all files run side by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;
mod fuzz;
mod refusals;
mod server;
mod structure;
