//! Distributes work over all threads.

use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The results of `work` for each number below `count`, in their order, on all available threads.
///
/// # Errors
/// That of the work, which ends the rest of it.
pub fn in_parallel<T: Send, E: Send>(
    count: usize,
    work: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let results: Vec<Mutex<Option<Result<T, E>>>> = (0..count).map(|_| Mutex::default()).collect();
    let failed = AtomicBool::new(false);
    for_each_in_parallel(count, &|k| {
        if failed.load(Ordering::Relaxed) {
            return;
        }
        let result = work(k);
        if result.is_err() {
            failed.store(true, Ordering::Relaxed);
        }
        if let Ok(mut place) = results[k].lock() {
            *place = Some(result);
        }
    });
    let results = results.into_iter();
    results
        .filter_map(|place| place.into_inner().ok().flatten())
        .collect()
}

/// The only place that starts threads; not generic, so that it is compiled once.
fn for_each_in_parallel(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::in_parallel;

    #[test]
    fn results_come_in_order_and_an_error_ends_the_rest() {
        let doubled = in_parallel(1000, |k| Ok::<_, usize>(2 * k)).expect("it can not fail");
        assert!(doubled.iter().enumerate().all(|(k, twice)| *twice == 2 * k));
        assert_eq!(in_parallel(0, Ok::<_, usize>), Ok(Vec::new()));
        let refused = |k: usize| if k == 700 { Err(k) } else { Ok(k) };
        assert_eq!(in_parallel(1000, refused), Err(700));
    }
}
