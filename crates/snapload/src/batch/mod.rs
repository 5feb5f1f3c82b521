//! Many runs of two cables under one sinusoid, side by side in the lanes of the processor, with the bits of each by itself.

pub(crate) mod lanes;
pub(crate) mod vector;
