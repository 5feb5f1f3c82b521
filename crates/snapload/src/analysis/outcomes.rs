//! The outcomes of many runs, computed side by side and on all threads.

use crate::analysis::progress::{Cancelled, Counter, OnProgress};
use crate::analysis::threads::in_parallel;
use crate::batch::followers::{Follower, NoFollower};
use crate::batch::lanes::{LaneResults, Lanes};
use crate::case::Case;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::Simulation;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The result for each number below some count, in the lists of the threads that computed them.
#[derive(Debug)]
pub struct ThreadResults<R> {
    lists: Vec<Vec<R>>,
    /// For each number its list, and its place in the list.
    places: Vec<(u32, u32)>,
}

/// A thread has memory for this many numbers at once at most; for more it grows.
const MOST_AT_ONCE: usize = 1 << 16;

impl<R> ThreadResults<R> {
    /// In the order of the numbers.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &R> + Clone {
        let of = |(list, place): &(u32, u32)| &self.lists[*list as usize][*place as usize];
        self.places.iter().map(of)
    }

    /// In the order of the numbers.
    pub fn into_vec(self) -> Vec<R> {
        let mut lists: Vec<_> = self.lists.into_iter().map(Vec::into_iter).collect();
        // Each list is ordered by its own numbers.
        let next = |(list, _): &(u32, u32)| lists[*list as usize].next();
        self.places.iter().filter_map(next).collect()
    }
}

/// The numbers below a count that are handed to one of several threads.
struct Numbers<'a> {
    next: &'a AtomicUsize,
    count: usize,
    no_more: &'a (dyn Fn() -> bool + Sync),
    mine: Vec<usize>,
}

impl Iterator for Numbers<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        if (self.no_more)() {
            return None;
        }
        let number = self.next.fetch_add(1, Ordering::Relaxed);
        (number < self.count).then(|| {
            self.mine.push(number);
            number
        })
    }

    /// The upper bound is all numbers left, as the other threads may take none.
    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.count - self.mine.len()))
    }
}

/// The results of `work` for each number below `count`, on all available threads.
///
/// Each thread is handed numbers one by one, and makes one result for each, in that order. So its
/// lanes are full as long as numbers are left, and all threads end at about the same time.
///
/// # Errors
/// That of the work, which ends the rest of it.
///
/// # Panics
/// If the work returns another number of results than it took numbers.
pub fn on_all_threads<R: Send, E: Send>(
    count: usize,
    work: impl Fn(&mut dyn Iterator<Item = usize>) -> Result<Vec<R>, E> + Sync,
) -> Result<ThreadResults<R>, E> {
    on_all_threads_until(&|| false, count, work)
}

/// The same for numbers from 0 on until `no_more` says to stop; it is asked before each number by
/// the thread that is to take it.
///
/// # Errors
/// As for [`on_all_threads`].
///
/// # Panics
/// As for [`on_all_threads`].
pub fn on_all_threads_until<R: Send, E: Send>(
    no_more: &(dyn Fn() -> bool + Sync),
    count: usize,
    work: impl Fn(&mut dyn Iterator<Item = usize>) -> Result<Vec<R>, E> + Sync,
) -> Result<ThreadResults<R>, E> {
    let next = AtomicUsize::new(0);
    let threads = rayon::current_num_threads().min(count);
    let done = in_parallel(threads, |_| {
        let mut numbers = Numbers {
            next: &next,
            count,
            no_more,
            mine: Vec::with_capacity(count.div_ceil(threads).min(MOST_AT_ONCE)),
        };
        let made = work(&mut numbers).inspect_err(|_| next.store(count, Ordering::Relaxed))?;
        assert_eq!(
            made.len(),
            numbers.mine.len(),
            "every number has one result"
        );
        Ok((numbers.mine, made))
    })?;
    // A thread that took a number made its result, so that none below the last is missing.
    let handed_out = done.iter().map(|(numbers, _)| numbers.len()).sum();
    let mut places = vec![(0, 0); handed_out];
    for (list, (numbers, _)) in done.iter().enumerate() {
        for (place, number) in numbers.iter().enumerate() {
            places[*number] = (list as u32, place as u32);
        }
    }
    let lists = done.into_iter().map(|(_, made)| made).collect();
    Ok(ThreadResults { lists, places })
}

/// The outcomes of many cases, in their order: side by side in the lanes of the processor, on all
/// available threads. Each outcome has the same bits as that of the case run by itself.
///
/// # Errors
/// [`Cancelled`] if the work is to end before.
pub fn outcomes(cases: &[Case], on_progress: OnProgress) -> Result<Vec<Outcome>, Cancelled> {
    let counter = Counter::new("running", 0, cases.len() as u64, on_progress);
    let made = on_all_threads(cases.len(), |numbers| {
        outcomes_on_one_thread(numbers.map(|k| cases[k].clone()), &counter)
    });
    made.map(ThreadResults::into_vec)
}

/// The same on one thread; each case is counted when it begins.
///
/// # Errors
/// As for [`outcomes`].
pub fn outcomes_on_one_thread(
    mut cases: impl Iterator<Item = Case>,
    counter: &Counter,
) -> Result<Vec<Outcome>, Cancelled> {
    outcomes_of(&mut cases, counter)
}

/// Not generic, so that it is compiled once, here: it contains the whole engine, which every crate
/// that calls it would otherwise compile again.
fn outcomes_of(
    cases: &mut dyn Iterator<Item = Case>,
    counter: &Counter,
) -> Result<Vec<Outcome>, Cancelled> {
    let runs = cases.map(|case| (case.into_boxed(), NoFollower));
    let results = side_by_side(Lanes::best(), runs, counter)?;
    Ok(results.filter_map(|result| Some(result?.0)).collect())
}

/// The outcomes of runs and the verdicts of their followers, in their order. Each run is counted
/// when it begins, when the counter also says whether to continue.
///
/// # Errors
/// As for [`outcomes`].
pub(crate) fn side_by_side<F: Follower>(
    lanes: Lanes,
    runs: impl Iterator<Item = (Box<Simulation>, F)>,
    counter: &Counter,
) -> Result<LaneResults<F>, Cancelled> {
    let mut cancelled = None;
    let runs = runs.map_while(|run| {
        cancelled = counter.add(1).err();
        cancelled.is_none().then_some(run)
    });
    let (results, _) = lanes.outcomes_with_followers(runs);
    cancelled.map_or(Ok(results), Err)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn results_come_in_the_order_of_the_numbers() {
        for count in [0, 1, 2, 255, 256, 257, 5000] {
            let doubled = super::on_all_threads(count, |numbers| {
                Ok::<_, Infallible>(numbers.map(|k| k * 2).collect())
            });
            let doubled = doubled.expect("it can not fail");
            let known = || (0..count).map(|k| k * 2);
            assert!(doubled.iter().copied().eq(known()));
            assert!(doubled.into_vec().into_iter().eq(known()));
        }
    }

    #[test]
    fn an_error_ends_the_work() {
        let refused = super::on_all_threads(5000, |numbers| {
            let made: Result<Vec<usize>, usize> = numbers
                .map(|k| if k == 700 { Err(k) } else { Ok(k) })
                .collect();
            made
        });
        assert_eq!(refused.map(super::ThreadResults::into_vec), Err(700));
    }

    #[test]
    fn the_first_numbers_are_done_where_there_are_to_be_no_more() {
        for limit in [0, 1, 2, 300] {
            let calls = AtomicUsize::new(0);
            let no_more = || calls.fetch_add(1, Ordering::Relaxed) >= limit;
            let done = super::on_all_threads_until(&no_more, 5000, |numbers| {
                Ok::<_, Infallible>(numbers.collect())
            });
            assert_eq!(
                done.map(super::ThreadResults::into_vec),
                Ok((0..limit).collect())
            );
        }
    }

    #[test]
    fn a_short_list_is_for_all_threads_too() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        // Each thread waits with its first number until all have one.
        let all_there = std::sync::Barrier::new(3);
        let done = pool.expect("threads").install(|| {
            super::on_all_threads(6, |numbers| {
                let first: Vec<usize> = numbers.take(1).collect();
                all_there.wait();
                Ok::<_, Infallible>(first.into_iter().chain(numbers).collect())
            })
        });
        assert_eq!(
            done.map(super::ThreadResults::into_vec),
            Ok((0..6).collect())
        );
    }
}
