//! All tests of the command from outside, as one program: it is linked once, and the tests of all
//! files run side by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bad_files;
mod bifurcations;
mod certified;
mod command_line;
mod common;
mod diagrams;
mod documents;
mod explore;
mod hydro;
mod orbits;
mod physics;
mod report;
mod structure;
mod sweep;
mod sweep_csv;
mod sweep_errors;
mod system;
mod trust;
mod windows;
