//! Reads and writes cases of MoorDyn, a lumped-mass code of mooring lines (M. Hall and A. Goupee,
//! *Ocean Engineering* 104 (2015) 590), in the input format of its version 2 (docs/structures.md).

mod front;
mod planar;
mod read;
mod sections;
mod write;

pub use read::{Reading, read};
pub use write::write;
