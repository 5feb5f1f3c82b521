//! How long work counts its parts.

use snapload::analysis::{Cancelled, Counter, Progress};
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Two parts side by side, of which one has several stages: what is reported never falls, counts
/// each part by as much of it as is done, and ends with all of them.
#[test]
fn parts_under_way_count_as_fractions() {
    let seen = Mutex::new(Vec::new());
    let keep = |progress: Progress| {
        assert_eq!((progress.doing, progress.of), ("records", 4.0));
        seen.lock().expect("no panic").push(progress.done);
        ControlFlow::Continue(())
    };
    let counter = Counter::new("records", 1, 4, &keep);
    let done = counter.part(|outer| {
        Progress::new("rest", 1.0, 4.0).report(outer)?;
        let inner = counter.part(|inner| {
            Progress::new("running", 30.0, 60.0).report(inner)?;
            Ok::<_, Cancelled>("inner")
        })?;
        // A second stage begins, which is not further than the first until half of it is done.
        Progress::new("running", 0.0, 8.0).report(outer)?;
        Progress::new("running", 4.0, 8.0).report(outer)?;
        Ok::<_, Cancelled>(inner)
    });
    assert_eq!(done, Ok("inner"));
    counter.add(1).expect("goes on");
    let seen = seen.into_inner().expect("no panic");
    assert_eq!(seen, [1.0, 1.25, 1.75, 2.25, 2.25, 2.5, 3.0, 4.0]);
}

/// A part learns that the work is to end, and its error is that of the whole.
#[test]
fn a_part_is_cancelled_with_its_work() {
    let until_two = |progress: Progress| match progress.done < 2.0 {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    let counter = Counter::new("records", 0, 9, &until_two);
    let part = |reached: f64| counter.part(|within| Progress::new("", reached, 8.0).report(within));
    assert_eq!(part(1.0), Ok(()));
    assert_eq!(part(7.0), Err(Cancelled { done: 2.0 }));
    assert_eq!(counter.part(|_| Ok(())), Err(Cancelled { done: 3.0 }));
    let error = counter.part(|_| Err::<(), _>(Cancelled { done: 0.5 }));
    assert_eq!(error, Err(Cancelled { done: 0.5 }));
}
