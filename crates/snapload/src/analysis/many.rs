//! What many runs come to, side by side and on all threads.

use crate::{Case, Lanes, Outcome};
use rayon::prelude::*;

/// How many of `count` cases go to a thread at a time: enough for lanes to be full, and few enough to share.
pub fn share(count: usize) -> usize {
    const MOST: usize = 256;
    count.div_ceil(rayon::current_num_threads()).clamp(1, MOST)
}

/// The outcomes of many cases, in their order: side by side in the lanes of the processor, on all threads that
/// there are. Each has the bits that it has by itself.
pub fn outcomes(cases: &[Case]) -> Vec<Outcome> {
    cases
        .par_chunks(share(cases.len()))
        .flat_map_iter(|chunk| Lanes::best().outcomes(chunk).0)
        .collect()
}
