//! The command line with pipes, devices, links and signals.
#![cfg(unix)]

use crate::common::{directory, listing, snapload};
use predicates::str::contains;
use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

#[test]
fn a_reader_that_leaves_is_no_error() {
    let d = directory();
    let args: [&[&str]; 3] = [
        &["cases"],
        &["keys"],
        &[
            "run",
            "--set",
            "t_end=0.3",
            "--sample",
            "1e-6",
            "--json",
            "-",
        ],
    ];
    for args in args {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("snapload"))
            .args(args)
            .current_dir(d.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Read a little of the long output, nothing of the others, and close the pipe.
        let mut stdout = child.stdout.take().unwrap();
        if args[0] == "run" {
            stdout.read_exact(&mut [0; 10]).unwrap();
        }
        drop(stdout);
        let done = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8(done.stderr).unwrap(), "");
        assert_eq!(done.status.code(), Some(0));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_fails() {
    let d = directory();
    let run = ["run", "--set", "t_end=0.1", "--json", "/dev/full"];
    snapload(d.path())
        .args(run)
        .assert()
        .code(1)
        .stderr(contains("can not write /dev/full: No space"));
    let full = fs::File::create("/dev/full").unwrap();
    let mut keys = Command::new(assert_cmd::cargo::cargo_bin!("snapload"));
    let done = keys.arg("keys").stdout(full).output().unwrap();
    assert_eq!(done.status.code(), Some(1));
    assert!(
        String::from_utf8(done.stderr)
            .unwrap()
            .contains("standard output: No space")
    );
}

#[test]
fn devices_are_written_into_and_links_followed() {
    let d = directory();
    let run = |target: &str| {
        let run = ["run", "--set", "t_end=0.1", "--json", target];
        snapload(d.path()).args(run).assert().success();
    };
    run("/dev/null");
    fs::write(d.path().join("target.json"), "old").unwrap();
    std::os::unix::fs::symlink("target.json", d.path().join("link.json")).unwrap();
    run("link.json");
    assert!(
        fs::symlink_metadata(d.path().join("link.json"))
            .unwrap()
            .is_symlink()
    );
    assert!(
        fs::read_to_string(d.path().join("target.json"))
            .unwrap()
            .starts_with("{\"case\"")
    );
    assert_eq!(listing(d.path()), ["link.json", "target.json"]);
}

/// Failure to write is an error, also if standard output was closed from the start.
#[test]
#[cfg(target_os = "linux")]
fn standard_output_that_takes_nothing_is_an_error() {
    let d = directory();
    let program = assert_cmd::cargo::cargo_bin!("snapload")
        .display()
        .to_string();
    let places = [
        (">&-", "it is closed"),
        ("> /dev/full", "No space left on device"),
    ];
    for (place, why) in places {
        let run = "run --set t_end=1";
        for verb in [
            &format!("{run} --json -"),
            run,
            "cases",
            "--help",
            "--version",
            "help run",
        ] {
            let line = format!("exec {program} {verb} {place}");
            let mut shell = Command::new("sh");
            let done = shell
                .args(["-c", &line])
                .current_dir(d.path())
                .output()
                .unwrap();
            assert_eq!(done.status.code(), Some(1), "{line}");
            let stderr = String::from_utf8(done.stderr).unwrap();
            assert_eq!(
                stderr,
                format!("error: can not write standard output: {why}\n")
            );
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_interruption_leaves_nothing_behind() {
    let d = directory();
    let run = [
        "run",
        "--set",
        "t_end=0.4",
        "--sample",
        "5e-8",
        "--out",
        "new/results",
    ];
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("snapload"))
        .args(run)
        .current_dir(d.path())
        .spawn()
        .unwrap();
    // Wait until it is writing.
    while !d.path().join("new/results").exists() {
        std::thread::yield_now();
    }
    interrupt(&mut child);
    assert!(listing(d.path()).is_empty());
}

fn interrupt(child: &mut std::process::Child) {
    let interrupt = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupt.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

/// A pipe to which nobody listens can not be opened, and the command waits for its reader.
#[test]
#[cfg(target_os = "linux")]
fn waiting_for_the_reader_of_a_pipe_can_be_interrupted() {
    let d = directory();
    let made = Command::new("mkfifo").arg(d.path().join("pipe")).status();
    assert!(made.unwrap().success());
    let scratch = d.path().join("scratch");
    std::fs::create_dir(&scratch).unwrap();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("snapload"))
        .args(["run", "--set", "t_end=1", "--json", "pipe"])
        .env("TMPDIR", &scratch)
        .current_dir(d.path())
        .spawn()
        .unwrap();
    // The answer is complete once it is in its temporary file, just before it is copied.
    let is_written = || {
        let answer = listing(&scratch)
            .pop()
            .map(|folder| scratch.join(folder).join("0"));
        let answer = answer.and_then(|answer| std::fs::metadata(answer).ok());
        answer.is_some_and(|file| file.len() > 0)
    };
    while !is_written() {
        assert_eq!(child.try_wait().unwrap(), None);
        std::thread::yield_now();
    }
    interrupt(&mut child);
    assert!(listing(&scratch).is_empty());
}
