//! Orbits, branches, basins against reference values of independent programs and closed forms, all
//! in one program.
#![allow(clippy::unwrap_used, clippy::panic)]

mod accumulations;
mod attraction;
mod basins;
mod branch_points;
mod branches;
mod closed_forms;
mod common;
mod corners;
mod curves;
mod diagrams;
mod ends;
mod exponents;
mod held;
mod lengths;
mod orbits;
mod proofs;
mod refusals;
mod releases;
mod rule_of_volumes;
mod undecided;
mod wall;
