//! What the tests of the command line share.
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The program, in an empty directory of its own.
pub(crate) fn snapload(directory: &Path) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    command.current_dir(directory);
    command
}

/// An empty directory.
pub(crate) fn directory() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The names in a directory, hidden ones too.
pub(crate) fn listing(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
