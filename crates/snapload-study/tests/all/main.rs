//! All tests of studies from outside, as one program: it is linked once, and the tests of all files
//! run side by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod damage;
mod grid;
mod list;
mod plan;
mod store;
