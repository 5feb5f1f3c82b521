//! Many runs of two cables under one sinusoid, side by side in the lanes of the processor, each
//! with the bits that it has by itself.
//!
//! The entry point is [`crate::motion::two_cables::TwoCableSystem::of`], which says whether a
//! system and its rules fit; runs that do not fit are made one by one.

pub(crate) mod followers;
pub(crate) mod lanes;
mod rocking;
mod scheduler;
mod slot;
pub(crate) mod vector;
