//! The number of threads for a study, if a number is asked for.

use snapload::{Key, Kind};
use std::num::NonZero;

/// How many threads may be asked for.
pub const THREADS: Key = Key::option("threads", Kind::Count(1, 65_535));

/// Threads for each that the machine runs at a time: enough for whatever it says of itself.
const MOST: usize = 4;

/// As many threads as asked for, up to a few for each that the machine runs at a time; and why, if
/// these are fewer.
pub fn threads_for(asked: usize) -> (usize, Option<String>) {
    let at_a_time = std::thread::available_parallelism().map_or(1, NonZero::get);
    let threads = asked.min(at_a_time.saturating_mul(MOST));
    let fewer = (threads < asked).then(|| {
        format!("this machine runs {at_a_time} at a time, and more only wait; {threads} are used")
    });
    (threads, fewer)
}

#[cfg(test)]
mod tests {
    use super::threads_for;

    #[test]
    fn no_more_threads_than_help() {
        assert_eq!(threads_for(1), (1, None));
        let (threads, why) = threads_for(65_535);
        assert!((4..65_535).contains(&threads));
        assert!(why.is_some_and(|why| why.ends_with(&format!("; {threads} are used"))));
    }
}
