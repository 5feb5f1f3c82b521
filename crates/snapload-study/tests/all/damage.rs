//! A single flipped bit on the disk is detected wherever it is.
use crate::store::{chunk_name, complete, open, save, study, work};
use snapload::analysis::no_progress;
use snapload_study::{Identity, Opened, Shard, Store, StudyError, checked_identity, merge, sweep};
use std::fs;
use std::path::{Path, PathBuf};

/// The number of places in each file.
const PLACES: usize = 200;

/// The bytes with one bit flipped, at places spread over all of them.
fn damaged(bytes: &[u8]) -> impl Iterator<Item = Vec<u8>> + '_ {
    (0..PLACES).map(|k| {
        let place = k * (bytes.len() - 1) / (PLACES - 1);
        let mut copy = bytes.to_vec();
        copy[place] ^= 1 << (k % 8);
        copy
    })
}

/// A damaged chunk counts as missing when the study is resumed, and is made again with the same
/// bits; the chunk beside it stays.
#[test]
fn a_damaged_chunk_is_computed_again() {
    let directory = tempfile::tempdir().unwrap();
    let (study, target) = (study(9), directory.path().join("file"));
    let path = directory
        .path()
        .join("file.parts")
        .join(chunk_name(&(0..4)));
    let mut store = work(&target, &study);
    for range in [0..4, 4..9] {
        save(&mut store, &study, range);
    }
    drop(store);
    let bytes = fs::read(&path).unwrap();
    assert_eq!(work(&target, &study).saved(), 9);
    for damaged in damaged(&bytes) {
        fs::write(&path, damaged).unwrap();
        let mut store = work(&target, &study);
        assert_eq!((store.gap(), store.damaged()), (Some(0..4), 4));
        save(&mut store, &study, 0..4);
        assert!(fs::read(&path).unwrap() == bytes);
    }
}

/// The same if the damage occurs while the program runs: the joined file has the computed rows.
#[test]
fn a_chunk_that_is_damaged_meanwhile_is_computed_again() {
    let directory = tempfile::tempdir().unwrap();
    let (study, target) = (study(9), directory.path().join("file"));
    let expected = complete(&directory.path().join("whole"), &study);
    let path = directory
        .path()
        .join("file.parts")
        .join(chunk_name(&(0..9)));
    let mut store = work(&target, &study);
    save(&mut store, &study, 0..9);
    let bytes = fs::read(&path).unwrap();
    drop(store);
    // The file may also be missing.
    let damaged = damaged(&bytes).step_by(4).map(Some).chain([None]);
    for damaged in damaged {
        let mut store = work(&target, &study);
        if store.gap().is_some() {
            save(&mut store, &study, 0..9);
        }
        match damaged {
            Some(damaged) => fs::write(&path, damaged).unwrap(),
            None => fs::remove_file(&path).unwrap(),
        }
        sweep(&study, store, &no_progress).unwrap();
        assert!(fs::read(&target).unwrap() == expected);
        fs::remove_file(&target).unwrap();
    }
}

fn part(directory: &Path, text: &str) -> PathBuf {
    let (study, target) = (study(9), directory.join(text.replace('/', "-")));
    let identity = Identity::new(&study, Some(Shard::parse(text).unwrap()));
    let Opened::Work(store) = Store::open(&target, identity, false).unwrap() else {
        panic!("complete");
    };
    sweep(&study, store, &no_progress).unwrap();
    target
}

#[test]
fn a_damaged_part_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let parts = [part(directory.path(), "1/2"), part(directory.path(), "2/2")];
    let out = directory.path().join("whole");
    merge(&parts, &out).unwrap();
    assert!(fs::read(&out).unwrap() == complete(&directory.path().join("one"), &study(9)));
    let bytes = fs::read(&parts[1]).unwrap();
    for damaged in damaged(&bytes) {
        fs::write(&parts[1], damaged).unwrap();
        let Err(StudyError::Input(words)) = merge(&parts, &out) else {
            panic!("a damaged part was taken");
        };
        assert!(
            words.contains("2-2 can not be used") && words.contains("compute"),
            "{words}"
        );
    }
}

/// A complete file is read and kept only if it is as it was written.
#[test]
fn a_damaged_file_is_not_complete() {
    let directory = tempfile::tempdir().unwrap();
    let (study, target) = (study(9), directory.path().join("file"));
    let bytes = complete(&target, &study);
    for damaged in damaged(&bytes) {
        fs::write(&target, damaged).unwrap();
        let read = checked_identity(&target);
        assert!(matches!(read, Err(StudyError::Damaged { .. }) | Ok(None)));
        let opened = open(&target, &study, true);
        assert!(matches!(opened, Err(StudyError::Occupied(_))));
    }
    fs::write(&target, bytes).unwrap();
    assert!(matches!(open(&target, &study, true), Ok(Opened::Complete)));
}
