//! What many runs come to, side by side and on all threads.

use crate::{Case, Lanes, Outcome};
use rayon::prelude::*;

/// Items that a thread takes at a time at most, and at least where they are to go round: enough for lanes to be full.
const SHARE: [usize; 2] = [512, 64];
/// Times that a thread takes some, if there are enough.
const TURNS: usize = 4;

/// What `work` makes of the items, in their order, on all threads that there are.
///
/// A thread takes items from all over the list, as neighbours in a study take alike long, and a few very long.
pub fn shared<I: Sync, R: Send>(items: &[I], work: impl Fn(&[&I]) -> Vec<R> + Sync) -> Vec<R> {
    let [most, least] = SHARE.map(|share| items.len().div_ceil(share));
    let parts = least.min(TURNS * rayon::current_num_threads()).max(most);
    let done: Vec<Vec<R>> = (0..parts)
        .into_par_iter()
        .map(|part| work(&items.iter().skip(part).step_by(parts).collect::<Vec<_>>()))
        .collect();
    let mut lists: Vec<_> = done.into_iter().map(Vec::into_iter).collect();
    (0..items.len())
        .filter_map(|k| lists[k % parts].next())
        .collect()
}

/// The outcomes of many cases, in their order: side by side in the lanes of the processor, on all threads that
/// there are. Each has the bits that it has by itself.
pub fn outcomes(cases: &[Case]) -> Vec<Outcome> {
    shared(cases, |cases| {
        let runs = cases.iter().map(|case| case.simulation());
        Lanes::best().outcomes_of(runs).0
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn results_come_in_the_order_of_the_items() {
        for count in [0, 1, 2, 255, 256, 257, 1000] {
            let items: Vec<usize> = (0..count).collect();
            let doubled = super::shared(&items, |part| part.iter().map(|k| **k * 2).collect());
            assert!(doubled.iter().copied().eq(items.iter().map(|k| k * 2)));
            assert_eq!(doubled.len(), count);
        }
    }
}
