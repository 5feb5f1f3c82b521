//! Saved rows stay saved, and the file depends on the rows alone.
use snapload::analysis::{Cancelled, Counter, Progress, no_progress};
use snapload_study::{
    Axis, Grid, Identity, Opened, Plan, Shard, Store, Study, StudyError, chunk, merge, rows, sweep,
};
use std::fs;
use std::ops::{ControlFlow, Range};
use std::path::Path;

pub(crate) fn study(count: u64) -> Study {
    let grid = Grid::new("0.1", "0.6", count).unwrap();
    let plan = Plan::grid(vec![Axis::even("f_o", grid).unwrap()]).unwrap();
    Study::new([("t_end".to_owned(), 0.1.into())], plan, false).unwrap()
}

/// The name of a chunk in the directory of a study.
pub(crate) fn chunk_name(range: &Range<u64>) -> String {
    format!("rows-{:013}-{:013}.parquet", range.start, range.end)
}

pub(crate) fn open(target: &Path, study: &Study, resume: bool) -> Result<Opened, StudyError> {
    Store::open(target, Identity::new(study, None), resume)
}

pub(crate) fn work(target: &Path, study: &Study) -> Store {
    match open(target, study, true).unwrap() {
        Opened::Work(store) => store,
        Opened::Complete => panic!("complete"),
    }
}

/// Rows that were computed elsewhere make the same file; those of another study are refused.
#[test]
fn rows_come_from_elsewhere() {
    let (study, other) = (study(5), study(6));
    let directory = tempfile::tempdir().unwrap();
    let (here, there) = (directory.path().join("a"), directory.path().join("b"));
    let mut store = work(&here, &study);
    assert!(
        store
            .save_chunk(0..2, &chunk(&other, 0..2, &no_progress).unwrap())
            .is_err()
    );
    for range in [3..5, 0..3] {
        store
            .save_chunk(range.clone(), &chunk(&study, range, &no_progress).unwrap())
            .unwrap();
    }
    assert_eq!(store.gap(), None);
    store.finish().unwrap();
    sweep(&study, work(&there, &study), &no_progress).unwrap();
    assert_eq!(fs::read(here).unwrap(), fs::read(there).unwrap());
}

pub(crate) fn save(store: &mut Store, study: &Study, range: Range<u64>) {
    let cases = study.cases(range.clone()).unwrap();
    let counter = Counter::new("running", 0, 0, &no_progress);
    let rows = rows(&cases, &counter, &|| false).unwrap();
    store.save(range, &rows).unwrap();
}

pub(crate) fn complete(target: &Path, study: &Study) -> Vec<u8> {
    sweep(study, work(target, study), &no_progress).unwrap();
    fs::read(target).unwrap()
}

/// The file does not depend on how the rows were divided, nor on the remains of a crash.
#[test]
fn the_file_depends_on_the_rows_alone() {
    let directory = tempfile::tempdir().unwrap();
    let (study, whole) = (study(700), directory.path().join("whole"));
    let expected = complete(&whole, &study);
    let target = directory.path().join("torn");
    let parts = directory.path().join("torn.parts");
    let mut store = work(&target, &study);
    for range in [0..1, 1..130, 200..201, 600..700] {
        save(&mut store, &study, range);
    }
    assert_eq!((store.gap(), store.saved()), (Some(130..200), 231));
    drop(store);
    // A truncated chunk, an invalid one, one that overlaps another, and half of a complete file.
    let torn = parts.join(chunk_name(&(1..130)));
    let bytes = fs::read(&torn).unwrap();
    fs::write(&torn, &bytes[..bytes.len() / 2]).unwrap();
    fs::write(parts.join(chunk_name(&(300..400))), "nothing").unwrap();
    fs::copy(
        parts.join(chunk_name(&(0..1))),
        parts.join(chunk_name(&(0..2))),
    )
    .unwrap();
    fs::write(parts.join("scratch"), &expected[..100]).unwrap();
    assert!(work(&target, &study).gap() == Some(1..200));
    assert!(complete(&target, &study) == expected);
    assert!(!parts.exists());
}

/// Groups of rows that lie within a chunk are copied; if a group lies in several chunks, its rows
/// are written anew.
#[test]
fn groups_that_are_taken_have_the_bytes_of_those_written_anew() {
    let directory = tempfile::tempdir().unwrap();
    let study = study(70_000);
    let expected = complete(&directory.path().join("whole"), &study);
    let parts = ["1/3", "2/3", "3/3"].map(|text| {
        let shard = Shard::parse(text).unwrap();
        let target = directory.path().join(text.replace('/', "-"));
        let identity = Identity::new(&study, Some(shard));
        let Opened::Work(store) = Store::open(&target, identity, false).unwrap() else {
            panic!("complete");
        };
        sweep(&study, store, &no_progress).unwrap();
        target
    });
    let merged = directory.path().join("merged");
    merge(&parts, &merged).unwrap();
    assert!(fs::read(merged).unwrap() == expected);
}

/// Whenever a sweep is cancelled, the cases that were begun are saved, and the rest is done later.
#[test]
fn a_cancelled_sweep_is_resumed_later() {
    let directory = tempfile::tempdir().unwrap();
    let (study, whole) = (study(700), directory.path().join("whole"));
    let expected = complete(&whole, &study);
    for stop_at in [0.0, 1.0, 100.0] {
        let target = directory.path().join("ended");
        let until = |progress: Progress| match progress.done < stop_at {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        let ended = sweep(&study, work(&target, &study), &until);
        let Err(StudyError::Cancelled(Cancelled { done })) = ended else {
            panic!("{ended:?}");
        };
        assert_eq!(work(&target, &study).saved() as f64, done);
        // Each thread may have been about to begin one more.
        let more = done - stop_at;
        assert!((0.0..=rayon::current_num_threads() as f64).contains(&more));
        assert!(stop_at > 0.0 || done == 0.0);
        assert!(complete(&target, &study) == expected);
        fs::remove_file(&target).unwrap();
    }
}

#[test]
fn only_one_is_at_work() {
    let directory = tempfile::tempdir().unwrap();
    let target = directory.path().join("file");
    let store = work(&target, &study(3));
    let error = open(&target, &study(3), true).unwrap_err().to_string();
    assert!(
        error.contains("another snapload process is writing"),
        "{error}"
    );
    drop(store);
    let error = open(&target, &study(4), true).unwrap_err().to_string();
    assert!(error.contains("there: # snapload"), "{error}");
    complete(&target, &study(3));
    assert!(matches!(
        open(&target, &study(3), true),
        Ok(Opened::Complete)
    ));
    assert!(open(&target, &study(3), false).is_err());
}
