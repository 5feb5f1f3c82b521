//! Studies: interruptions do not change the bytes of the file, and no row is lost.
#![cfg(unix)]

use crate::common::{directory, listing, snapload};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use snapload_study::identity_of;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A study of many short runs: three chunks, so that it can be killed between them.
pub(crate) const LONG: [&str; 8] = [
    "--set",
    "t_end=0.1",
    "--vary",
    "f_o=0.01:0.6:60",
    "--vary",
    "omega=0.4:2.4:1101",
    "--threads",
    "1",
];
pub(crate) const SHORT: [&str; 6] = [
    "--set",
    "t_end=1",
    "--vary",
    "f_o=0.1:0.5:5",
    "--vary",
    "e=0.5,0.9",
];

pub(crate) fn sweep(directory: &Path, args: &[&str], out: &str) -> assert_cmd::assert::Assert {
    let mut command = snapload(directory);
    command
        .arg("sweep")
        .args(args)
        .args(["--out", out])
        .assert()
}

pub(crate) fn merge(directory: &Path, parts: &[&str], out: &str) -> assert_cmd::assert::Assert {
    let mut command = snapload(directory);
    command
        .arg("merge")
        .args(parts)
        .args(["--out", out])
        .assert()
}

pub(crate) fn bytes(directory: &Path, name: &str) -> Vec<u8> {
    fs::read(directory.join(name)).unwrap()
}

pub(crate) fn begin(directory: &Path, args: &[&str], out: &str) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin!("snapload"))
        .current_dir(directory)
        .arg("sweep")
        .args(args)
        .args(["--out", out, "--resume"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits until so many chunks are there; false if the program ended before.
pub(crate) fn chunks(directory: &Path, out: &str, expected: usize, child: &mut Child) -> bool {
    let parts = directory.join(format!("{out}.parts"));
    loop {
        let entries = fs::read_dir(&parts).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().into_string().unwrap());
        if names.filter(|name| name.starts_with("rows-")).count() >= expected {
            return true;
        }
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_killed_study_resumes_to_the_same_bytes() {
    let d = directory();
    sweep(d.path(), &LONG, "whole.parquet").success();
    // Killed at the first chunk, at the second, and so on: while computing, writing or joining.
    let mut killed = 0;
    for (round, wait) in [0_u64, 3, 11, 29, 70].into_iter().enumerate() {
        let mut child = begin(d.path(), &LONG, "killed.parquet");
        let there = chunks(d.path(), "killed.parquet", round.min(2), &mut child);
        std::thread::sleep(Duration::from_millis(wait));
        let _ = child.kill();
        let _ = child.wait();
        killed += usize::from(there);
        if d.path().join("killed.parquet").exists() {
            break;
        }
    }
    assert!(killed > 0);
    sweep(
        d.path(),
        &[&LONG[..], &["--resume"]].concat(),
        "killed.parquet",
    )
    .success();
    assert!(bytes(d.path(), "whole.parquet") == bytes(d.path(), "killed.parquet"));
    assert_eq!(listing(d.path()), ["killed.parquet", "whole.parquet"]);
}

#[test]
fn an_interruption_prints_how_to_resume() {
    let d = directory();
    // So long that it can not end by itself before it is told to end.
    let endless = ["--vary", "f_o=0.01:0.6:600", "--vary", "omega=0.4:2.4:500"];
    let mut child = begin(d.path(), &endless, "map.parquet");
    assert!(chunks(d.path(), "map.parquet", 1, &mut child));
    let interrupt = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupt.unwrap().success());
    let done = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(130), "{stderr}");
    let command = "snapload sweep --vary 'f_o=0.01:0.6:600' --vary 'omega=0.4:2.4:500' --out map.parquet --resume";
    assert!(
        stderr.contains("of 300000 rows are saved") && stderr.contains(command),
        "{stderr}"
    );
    assert_eq!(listing(d.path()), ["map.parquet.parts"]);
    // Without --resume nothing is continued or lost; nor by another study.
    sweep(d.path(), &endless, "map.parquet")
        .code(2)
        .stderr(contains("continue with --resume"));
    let other = [&endless[..], &["--set", "e=0.8", "--resume"]].concat();
    sweep(d.path(), &other, "map.parquet")
        .code(2)
        .stderr(contains("rows of another study").and(contains("here:  e = 0.8")));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_loses_nothing() {
    let d = directory();
    sweep(d.path(), &LONG, "whole.parquet").success();
    let size = bytes(d.path(), "whole.parquet").len();
    let program = assert_cmd::cargo::cargo_bin!("snapload");
    // A limit that a chunk satisfies and the whole does not, and one that not even a chunk
    // satisfies. The shell ignores the signal of the limit, so that writing fails as on a full
    // disk.
    for blocks in [size / 512 / 2, 8] {
        let script = format!(
            "trap '' XFSZ; ulimit -f {blocks}; exec {} sweep {} --out full.parquet --resume",
            program.display(),
            LONG.join(" ")
        );
        let run = Command::new("sh")
            .args(["-c", &script])
            .current_dir(d.path())
            .output();
        let done = run.unwrap();
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{stderr}");
        assert!(
            stderr.contains("can not write full.parquet.parts"),
            "{stderr}"
        );
        assert!(
            stderr.contains("File too large") && stderr.contains("--resume"),
            "{stderr}"
        );
        assert!(!d.path().join("full.parquet").exists());
        assert!(!d.path().join("full.parquet.parts/scratch").exists());
    }
    sweep(
        d.path(),
        &[&LONG[..], &["--resume"]].concat(),
        "full.parquet",
    )
    .success();
    assert!(bytes(d.path(), "whole.parquet") == bytes(d.path(), "full.parquet"));
}

#[test]
fn threads_and_parts_change_no_byte() {
    let d = directory();
    sweep(d.path(), &SHORT, "one.parquet").success();
    sweep(
        d.path(),
        &[&SHORT[..], &["--threads", "2"]].concat(),
        "two.parquet",
    )
    .success();
    assert!(bytes(d.path(), "one.parquet") == bytes(d.path(), "two.parquet"));
    for i in 1..=3 {
        let shard = format!("{i}/3");
        let out = format!("part-{i}.parquet");
        sweep(d.path(), &[&SHORT[..], &["--shard", &shard]].concat(), &out).success();
    }
    let identity = identity_of(&d.path().join("one.parquet")).unwrap();
    assert_eq!(identity.version, env!("CARGO_PKG_VERSION"));
    assert_eq!(
        identity.study,
        "t_end = 1\ntrust = true\n\n[vary]\nf_o = \"0.1:0.5:5\"\ne = [0.5, 0.9]\n"
    );
    assert_eq!((identity.cases, identity.rows), (10, 0..10));
    let merge = |parts: &[&str], out: &str| merge(d.path(), parts, out);
    let parts = ["part-3.parquet", "part-1.parquet", "part-2.parquet"];
    merge(&parts, "joined.parquet").success();
    assert!(bytes(d.path(), "one.parquet") == bytes(d.path(), "joined.parquet"));
    merge(&parts, "joined.parquet")
        .code(2)
        .stderr(contains("exists already"));
    merge(&parts[..2], "x").code(2).stderr(contains(
        "rows 3 to 5 are in none of the files; missing: --shard 2/3",
    ));
    let twice = ["part-1.parquet", "part-1.parquet"];
    merge(&twice, "x")
        .code(2)
        .stderr(contains("its rows are in another file, too"));
    sweep(d.path(), &["--vary", "e=0.5,0.6"], "other.parquet").success();
    let mixed = ["part-1.parquet", "other.parquet"];
    merge(&mixed, "x")
        .code(2)
        .stderr(contains("parts of different studies"));
    merge(&["no.parquet"], "x")
        .code(2)
        .stderr(contains("there is no such file"));
    fs::write(d.path().join("text"), "text").unwrap();
    merge(&["text"], "x")
        .code(2)
        .stderr(contains("not a Parquet file of snapload sweep"));
    assert!(!listing(d.path()).contains(&"x".to_owned()));
}

#[test]
fn a_study_file_is_the_same_study() {
    let d = directory();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/sweeps.md");
    let page = fs::read_to_string(page).unwrap();
    let example = page
        .split("```toml\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    fs::write(d.path().join("study.toml"), example).unwrap();
    sweep(d.path(), &["study.toml"], "file.parquet")
        .success()
        .stdout(contains("Cases     15\n"));
    let flags = [
        "--case",
        "1920001000-359",
        "--set",
        "t_end=5",
        "--vary",
        "f_o=0.1:0.5:5",
        "--vary",
        "e=0.5,0.7,0.9",
    ];
    sweep(d.path(), &flags, "flags.parquet").success();
    assert!(bytes(d.path(), "file.parquet") == bytes(d.path(), "flags.parquet"));
    // The command line takes precedence over the file.
    sweep(d.path(), &["study.toml", "--vary", "e=0.8"], "one.parquet")
        .success()
        .stdout(contains("Cases     5\n"));
}

#[test]
fn a_bad_row_is_a_row_with_its_error() {
    let d = directory();
    let list = "f_o,e,body\n0.1,0.9,rigid\n0.2,1.5,\n0.3,x,\n0.4,0.9\n0.5,0.9,\n";
    fs::write(d.path().join("cases.csv"), list).unwrap();
    sweep(d.path(), &["--list", "cases.csv"], "list.parquet")
        .success()
        .stdout(contains("Cases     5\n"))
        .stdout(contains(
            "Errors    3; the first, in row 1, line 3 of cases.csv: e = 1.5 is not allowed",
        ));
    // Cases illegal only by combination are errors of their row, too, and the others run.
    sweep(d.path(), &["--vary", "r=0.5:1.5:3"], "r.parquet")
        .success()
        .stdout(contains(
            "Errors    1; the first, in row 0: r = 0.5 is not allowed",
        ));
}

/// With e = 0.5 errors hardly grow; the standard case ends past its horizon of trust.
#[test]
fn the_summary_counts_certain_ends() {
    let d = directory();
    let output = sweep(d.path(), &["--vary", "e=0.5,0.55,0.9"], "e.parquet").success();
    output.stdout(contains(
        "Trust     2 of 3 ends are certain (see the column certain)",
    ));
    let output = sweep(
        d.path(),
        &["--vary", "e=0.5,0.9", "--no-trust"],
        "plain.parquet",
    );
    output.success().stdout(contains("Trust").not());
}

#[test]
fn random_points_depend_on_their_seed() {
    let d = directory();
    let random = |seed: &str, out: &str| {
        let boxed = [
            "--vary",
            "f_o=0.1:0.6",
            "--vary",
            "x=-0.05:0.05",
            "--random",
            "20",
            "--no-trust",
        ];
        sweep(d.path(), &[&boxed[..], &["--seed", seed]].concat(), out).success();
        bytes(d.path(), out)
    };
    assert!(random("1", "a.parquet") == random("1", "b.parquet"));
    assert!(random("2", "c.parquet") != random("1", "d.parquet"));
}

#[test]
fn pictures_are_lines_and_maps() {
    let d = directory();
    let plot = |args: &[&str], picture: &str| {
        let out = format!("{picture}.parquet");
        sweep(
            d.path(),
            &[args, &["--set", "t_end=2", "--plot", picture]].concat(),
            &out,
        )
        .success()
        .stdout(contains(picture));
        bytes(d.path(), picture)
    };
    let map = plot(
        &[
            "--vary",
            "f_o=0.1:0.5:5",
            "--vary",
            "r=0.5:1.5:5",
            "--show",
            "rho1",
        ],
        "map.svg",
    );
    let map = String::from_utf8(map).unwrap();
    for expected in ["ρ₁", "f_o", "no legal case", "url(#hatch)"] {
        assert!(map.contains(expected), "{expected}");
    }
    let ends = plot(
        &["--vary", "f_o=0.1:0.5:5", "--vary", "e=0.5:0.9:5"],
        "ends.svg",
    );
    assert!(String::from_utf8(ends).unwrap().contains("end time"));
    let line = plot(&["--vary", "r=0.5:1.5:21"], "line.png");
    assert!(line.starts_with(b"\x89PNG"));
}

#[test]
fn invalid_axes_and_lists_are_refused_before_anything_is_run() {
    let d = directory();
    fs::write(d.path().join("c.csv"), "f_o,omgea\n1,2\n").unwrap();
    for (args, expected) in [
        (
            &["--vary", "f_o"][..],
            "no values; write --vary KEY=first:last:n",
        ),
        (&["--vary", "omgea=1:2:3"], "did you mean omega?"),
        (
            &["--vary", "e=0.5:1.5:3"],
            "e = 1.5 is not allowed; allowed: a number, 0 <= e <= 1",
        ),
        (&["--vary", "e=0:1"], "three numbers are needed"),
        (
            &["--vary", "e=0:1:0"],
            "n must be a whole number, 1 or more",
        ),
        (
            &["--vary", "e=0:1:2", "--vary", "e=0:1:3"],
            "e varies twice",
        ),
        (
            &["--vary", "e=0.5,0.6", "--random", "9"],
            "write e=low:high",
        ),
        (&["--list", "c.csv"], "did you mean omega?"),
        (&["--list", "no.csv"], "No such file"),
        (&["--list", "c.csv", "--vary", "e=1"], "cannot be used with"),
        (&["--shard", "3/2"], "write i/n with 1 <= i <= n"),
        (
            &["--vary", "e=0:1:3", "--plot", "x.pdf"],
            "ends neither in .svg nor in .png",
        ),
        (&["--plot", "x.svg"], "a grid over one or two keys"),
        (
            &["--vary", "e=0:1:3", "--plot", "none/x.svg"],
            "there is no folder none; make it first",
        ),
        (&["--seed", "3"], "add --random N"),
        (
            &["--vary", "e=0:1:3", "--plot", "x.svg", "--show", "rho"],
            "there is no column \"rho\"",
        ),
        (
            &["--vary", "e=0:1:3", "--plot", "x.svg", "--show", "end"],
            "its values are not numbers",
        ),
        (&["--threads", "0"], "--threads"),
    ] {
        sweep(d.path(), args, "out.parquet")
            .code(2)
            .stderr(contains(expected));
    }
    sweep(d.path(), &[], "no/such/out.parquet")
        .code(2)
        .stderr(contains(
            "can not write no/such/out.parquet: there is no folder no/such; make it first",
        ));
    fs::write(d.path().join("mine"), "mine").unwrap();
    sweep(d.path(), &[], "mine")
        .code(2)
        .stderr(contains("holds something else"));
    assert_eq!(listing(d.path()), ["c.csv", "mine"]);
}

#[test]
fn a_finished_study_is_left_as_it_is() {
    let d = directory();
    sweep(d.path(), &SHORT, "a.parquet").success();
    let before = fs::metadata(d.path().join("a.parquet"))
        .unwrap()
        .modified()
        .unwrap();
    sweep(d.path(), &SHORT, "a.parquet")
        .code(2)
        .stderr(contains("exists already and holds this complete study"));
    sweep(d.path(), &[&SHORT[..], &["--resume"]].concat(), "a.parquet").success();
    assert_eq!(
        fs::metadata(d.path().join("a.parquet"))
            .unwrap()
            .modified()
            .unwrap(),
        before
    );
}
