//! How `snapload sweep` handles damage, mistakes, and files that exist already.
#![cfg(unix)]

use crate::common::{directory, listing, snapload};
use crate::sweep::{LONG, SHORT, begin, bytes, chunks, sweep};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::fs;
use std::path::Path;

/// Flips one bit in the middle of a file.
fn flip(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_damaged_chunk_is_reported_and_computed_again() {
    let d = directory();
    sweep(d.path(), &LONG, "whole.parquet").success();
    let mut child = begin(d.path(), &LONG, "file.parquet");
    assert!(chunks(d.path(), "file.parquet", 1, &mut child));
    child.kill().unwrap();
    child.wait().unwrap();
    let parts = d.path().join("file.parquet.parts");
    let mut entries = fs::read_dir(parts)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let rows_of = |path: &Path| {
        let name = path.file_stem()?.to_str()?;
        let end = name.strip_prefix("rows-0000000000000-")?;
        end.parse::<u64>().ok()
    };
    // A chunk ends with its rows or, on a slow machine, with its time.
    let (rows, chunk) = entries
        .find_map(|path| Some((rows_of(&path)?, path)))
        .unwrap();
    flip(&chunk);
    sweep(
        d.path(),
        &[&LONG[..], &["--resume"]].concat(),
        "file.parquet",
    )
    .success()
    .stderr(contains(format!(
        "{rows} rows in file.parquet.parts were damaged, and are computed again"
    )));
    assert!(bytes(d.path(), "whole.parquet") == bytes(d.path(), "file.parquet"));
}

#[test]
fn a_damaged_part_or_file_is_refused() {
    let d = directory();
    for part in ["1/2", "2/2"] {
        let out = format!("{}.parquet", &part[..1]);
        sweep(d.path(), &[&SHORT[..], &["--shard", part]].concat(), &out).success();
    }
    flip(&d.path().join("2.parquet"));
    snapload(d.path())
        .args(["merge", "1.parquet", "2.parquet", "--out", "whole.parquet"])
        .assert()
        .code(2)
        .stderr(
            contains("2.parquet can not be used: it is damaged").and(contains("copy it again")),
        );
    assert!(!d.path().join("whole.parquet").exists());
    sweep(d.path(), &SHORT, "whole.parquet").success();
    flip(&d.path().join("whole.parquet"));
    sweep(
        d.path(),
        &[&SHORT[..], &["--resume"]].concat(),
        "whole.parquet",
    )
    .code(2)
    .stderr(contains("it is damaged").and(contains("remove it to compute it again")));
}

/// A study whose cases are all illegal is an error; its file has the reason in each row.
#[test]
fn a_list_of_bad_rows_is_bad_input() {
    let d = directory();
    fs::write(d.path().join("bad.csv"), "e,f_o\n\n2,0.1\n0.5\n").unwrap();
    for resume in [&[][..], &["--resume"]] {
        sweep(
            d.path(),
            &[&["--list", "bad.csv"], resume].concat(),
            "bad.parquet",
        )
        .code(2)
        .stdout(contains("Varied    e, f_o (columns of bad.csv)\n"))
        .stdout(contains("in row 0, line 3 of bad.csv: e = 2"))
        .stderr(contains(
            "none of the 2 cases could be run; the column error of bad.parquet",
        ));
    }
    // In one part all cases may be illegal if they are not in the others.
    sweep(
        d.path(),
        &["--list", "bad.csv", "--shard", "1/2"],
        "part.parquet",
    )
    .success();
}

#[test]
#[cfg(target_os = "linux")]
fn an_endless_file_is_no_list() {
    let d = directory();
    sweep(d.path(), &["--list", "/dev/zero"], "a.parquet")
        .code(2)
        .stderr(contains("can not read /dev/zero: a list must be a file"));
}

#[test]
fn an_existing_file_is_not_overwritten() {
    let d = directory();
    let plot = [&SHORT[..], &["--plot", "map.svg"]].concat();
    fs::write(d.path().join("map.svg"), "mine").unwrap();
    sweep(d.path(), &plot, "a.parquet")
        .code(2)
        .stderr(contains("--plot: map.svg exists already"));
    assert!(!d.path().join("a.parquet").exists());
    fs::remove_file(d.path().join("map.svg")).unwrap();
    sweep(d.path(), &plot, "a.parquet").success();
    // The same picture may be written again.
    let again = [&plot[..], &["--resume"]].concat();
    sweep(d.path(), &again, "a.parquet")
        .success()
        .stdout(contains("map.svg"));
    let picture = bytes(d.path(), "map.svg");
    let other = [&again[..], &["--show", "rho1"]].concat();
    sweep(d.path(), &other, "a.parquet")
        .code(2)
        .stderr(contains("--plot: map.svg exists already"));
    assert!(bytes(d.path(), "map.svg") == picture);
    snapload(d.path())
        .args([
            "merge",
            "a.parquet",
            "--out",
            "b.parquet",
            "--plot",
            "map.svg",
        ])
        .assert()
        .code(2)
        .stderr(contains("--plot: map.svg exists already"));
}

#[test]
fn a_name_keeps_its_promise() {
    let d = directory();
    let expected = || {
        contains("can not write x.xlsx: rows are written as Parquet")
            .and(contains("choose a name that ends in .parquet"))
    };
    sweep(d.path(), &SHORT, "x.xlsx").code(2).stderr(expected());
    snapload(d.path())
        .args(["merge", "a.parquet", "--out", "x.xlsx"])
        .assert()
        .code(2)
        .stderr(expected());
    // Elsewhere this is the standard output, which a file would silently not be.
    let expected = || contains("can not write rows to the standard output");
    sweep(d.path(), &SHORT, "-").code(2).stderr(expected());
    snapload(d.path())
        .args(["merge", "a.parquet", "--out", "-"])
        .assert()
        .code(2)
        .stderr(expected());
    assert!(listing(d.path()).is_empty());
}

#[test]
fn the_summary_lists_what_varies() {
    let d = directory();
    let point = ["--set", "t_end=0.1", "--no-trust", "--vary"];
    let vary =
        |value: &str, out: &str| sweep(d.path(), &[&point[..], &[value]].concat(), out).success();
    vary("f_o=0,3", "a.parquet")
        .stdout(contains("Varied    f_o (2 values)\n"))
        .stderr(contains(
            "is two values, 0 and 3; if one was meant, write a point: f_o=0.3",
        ));
    for (value, out) in [
        ("max_impacts=10,30", "b.parquet"),
        ("f_o=0.1,3", "c.parquet"),
    ] {
        vary(value, out).stderr(contains("two values").not());
    }
    let box_of = |range| [&point[..], &[range, "--random", "4"]].concat();
    sweep(d.path(), &box_of("f_o=0.1:0.5:x"), "d.parquet")
        .code(2)
        .stderr(contains("\"x\" is not a number of values; write low:high"));
    let random = box_of("f_o=0.1:0.5:7");
    sweep(d.path(), &random, "d.parquet")
        .success()
        .stdout(contains(
            "Cases     4\nVaried    f_o (random points, seed 0)\n",
        ));
    // An empty line is the empty cell of a list of one column, or what an editor leaves.
    fs::write(d.path().join("one.csv"), "f_o\n0.1\n\n0.2\n\n\n").unwrap();
    let listed = ["--set", "t_end=0.1", "--no-trust", "--list", "one.csv"];
    sweep(d.path(), &listed, "e.parquet")
        .success()
        .stdout(contains(
            "Cases     3\nVaried    f_o (columns of one.csv; the 2 empty lines at its end are no rows)\n",
        ));
}

#[test]
fn a_refused_value_is_shown_as_it_was_written() {
    let d = directory();
    for (asked, words) in [
        (
            &["--random", "9"][..],
            " keys, and none varies; vary one with --vary KEY=low:high, such as --vary e=0.5:0.9",
        ),
        (
            &["--vary", "e=0.5:0.9", "--random", "0"],
            "--random = 0 is not allowed; allowed: a whole number, 1 <= random <= 1e12",
        ),
        (&["--vary", "f_o=1e400"], "f_o = 1e400 is not allowed"),
        (&["--set", "f_o=-1e400"], "f_o = -1e400 is not allowed"),
        (
            &["--set", "max_impacts=99999999999999999999"],
            "max_impacts = 99999999999999999999 is not allowed",
        ),
    ] {
        sweep(d.path(), asked, "a.parquet")
            .code(2)
            .stderr(contains(words));
    }
}

#[test]
fn more_threads_than_help_are_not_started() {
    let d = directory();
    let few = ["--set", "t_end=0.1", "--threads", "65535"];
    sweep(d.path(), &few, "a.parquet")
        .success()
        .stderr(contains("--threads 65535: this machine runs").and(contains("are used")));
}
