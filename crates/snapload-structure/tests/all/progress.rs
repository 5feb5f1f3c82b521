//! How long work on structures reports its progress, and ends when asked to.

use crate::verdicts::structure;
use snapload::analysis::{Cancelled, Progress, Unfinished};
use snapload_structure::note::scan;
use snapload_structure::{Lines, assess, seas};
use std::ops::ControlFlow;
use std::sync::Mutex;

const CYLINDER: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// Does some work until a tenth of its first part is done, and returns what it reported.
fn until_a_tenth<T: std::fmt::Debug>(
    work: impl Fn(&(dyn Fn(Progress<'_>) -> ControlFlow<()> + Sync)) -> Result<T, Unfinished>,
) -> Vec<f64> {
    let seen = Mutex::new(Vec::new());
    let stop_early = |progress: Progress| {
        seen.lock().expect("no panic").push(progress.done);
        match progress.done < 0.1 {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    match work(&stop_early) {
        Err(Unfinished::Cancelled(Cancelled { .. })) => (),
        other => panic!("{other:?}"),
    }
    seen.into_inner().expect("no panic")
}

/// One run may take minutes: whatever the command does with it, the run counts by the time that it
/// has reached, and ends there if it is to end.
#[test]
fn the_parts_of_long_work_count_while_they_run() {
    let sea = structure(SEA);
    let wave = structure(CYLINDER);
    let all = [
        until_a_tenth(|report| seas(sea.clone(), 2, Lines::Inextensible, report)),
        until_a_tenth(|report| seas(sea.clone(), 2, Lines::Elastic, report)),
        until_a_tenth(|report| assess(wave.clone(), 1, report)),
        until_a_tenth(|report| Ok(scan(&wave, report)?)),
    ];
    for seen in all {
        let within = seen.iter().filter(|done| **done > 0.0 && **done < 1.0);
        assert!(within.count() > 0, "{seen:?}");
        let most = seen.iter().fold(0.0, |most: f64, done| most.max(*done));
        assert!(most < 1.0, "goes on to {most} after a tenth of a part");
    }
}
