//! What many runs come to, side by side and on all threads.

use crate::analysis::progress::{Cancelled, Counter, OnProgress};
use crate::analysis::threads::in_parallel;
use crate::batch::followers::{Follower, Unfollowed};
use crate::batch::lanes::Lanes;
use crate::case::Case;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::Simulation;

/// Items that a thread takes at a time at most. Where it ends, lanes stand idle until the longest
/// of the last runs has ended: one part in twenty of the time with 512.
const MOST_AT_ONCE: usize = 2048;
/// Fewer than this do not fill the lanes; a list is cut finer only to give every thread something.
const FULL: usize = 64;
/// Times that each thread takes some, so that one that meets long runs is relieved by the others.
const TURNS: usize = 4;

/// What `work` makes of the items, a result for each, in their order, on all threads that there
/// are.
///
/// A thread takes items from all over the list, as neighbours in a study take alike long, and a few
/// very long.
///
/// # Errors
/// That of the work, which ends the rest of it.
pub fn on_all_threads<I: Sync, R: Send, E: Send>(
    items: &[I],
    work: impl Fn(&[&I]) -> Result<Vec<R>, E> + Sync,
) -> Result<Vec<R>, E> {
    let (count, threads) = (items.len(), rayon::current_num_threads());
    let fewest = count.div_ceil(MOST_AT_ONCE).max(count.min(threads));
    let parts = count.div_ceil(FULL).min(TURNS * threads).max(fewest);
    let done = in_parallel(parts, |part| {
        let mine: Vec<&I> = items.iter().skip(part).step_by(parts).collect();
        let made = work(&mine)?;
        assert_eq!(made.len(), mine.len(), "every item has one result");
        Ok(made)
    })?;
    let mut lists: Vec<_> = done.into_iter().map(Vec::into_iter).collect();
    let all = (0..count).filter_map(|k| lists[k % parts].next());
    Ok(all.collect())
}

/// The outcomes of many cases, in their order: side by side in the lanes of the processor, on all
/// threads that there are. Each has the bits that it has by itself.
///
/// # Errors
/// [`Cancelled`] if the work is to end before.
pub fn outcomes(cases: &[Case], on_progress: OnProgress) -> Result<Vec<Outcome>, Cancelled> {
    let counter = Counter::new("running", 0, cases.len() as u64, on_progress);
    on_all_threads(cases, |cases| {
        let outcomes = outcomes_on_one_thread(cases.iter().copied(), &counter)?;
        counter.add(outcomes.len() as u64)?;
        Ok(outcomes)
    })
}

/// The same on one thread, with a counter that is only asked whether to go on.
///
/// # Errors
/// As for [`outcomes`].
pub fn outcomes_on_one_thread<'a>(
    cases: impl Iterator<Item = &'a Case>,
    counter: &Counter,
) -> Result<Vec<Outcome>, Cancelled> {
    let runs = cases.map(|case| (case.simulation(), Unfollowed));
    let told = side_by_side(Lanes::best(), runs, counter)?;
    Ok(told.into_iter().map(|(outcome, _)| outcome).collect())
}

/// What runs come to, and their followers, in their order; before each begins the counter is asked
/// whether to go on.
///
/// # Errors
/// As for [`outcomes`].
pub(crate) fn side_by_side<F: Follower>(
    lanes: Lanes,
    runs: impl Iterator<Item = (Simulation, F)>,
    counter: &Counter,
) -> Result<Vec<(Outcome, F)>, Cancelled> {
    let mut cancelled = None;
    let runs = runs.map_while(|run| {
        cancelled = counter.add(0).err();
        cancelled.is_none().then_some(run)
    });
    let (told, _) = lanes.outcomes_beside(runs);
    cancelled.map_or(Ok(told), Err)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn results_come_in_the_order_of_the_items() {
        for count in [0, 1, 2, 255, 256, 257, 5000] {
            let items: Vec<usize> = (0..count).collect();
            let doubled = super::on_all_threads(&items, |part| {
                Ok::<_, Infallible>(part.iter().map(|k| **k * 2).collect())
            });
            let doubled = doubled.expect("it can not fail");
            assert!(doubled.iter().copied().eq(items.iter().map(|k| k * 2)));
        }
    }

    #[test]
    fn a_short_list_is_for_all_threads_too() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let calls = AtomicUsize::new(0);
        let done = pool.expect("threads").install(|| {
            super::on_all_threads(&[0; 6], |part| {
                calls.fetch_add(1, Ordering::Relaxed);
                Ok::<_, Infallible>(part.iter().map(|item| **item).collect())
            })
        });
        assert_eq!((done, calls.into_inner()), (Ok(vec![0; 6]), 3));
    }
}
