//! `snapload assess` and `snapload seas`: what they print, write and refuse.

use crate::common::{directory, listing, snapload};
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/examples");

/// A directory with the examples in it.
fn room() -> tempfile::TempDir {
    let room = directory();
    for name in ["cylinder.toml", "cylinder-sea.toml"] {
        fs::copy(Path::new(EXAMPLES).join(name), room.path().join(name)).unwrap();
    }
    room
}

#[test]
fn assess_answers_in_a_few_lines_a_page_and_json() {
    let room = room();
    let short = [
        "--set",
        "run.duration=120",
        "--neighbours",
        "4",
        "--no-scan",
    ];
    snapload(room.path())
        .args([
            "assess",
            "cylinder.toml",
            "--out",
            "note.html",
            "--json",
            "note.json",
        ])
        .args(short)
        .assert()
        .success()
        .stdout(
            contains("force 0.364 and 0.250 of net buoyancy")
                .and(contains("verdict"))
                .and(contains("note.html")),
        );
    let page = fs::read_to_string(room.path().join("note.html")).unwrap();
    assert!(
        page.contains("Assumptions")
            && page.contains("<svg")
            && page.contains("--set 'run.duration=120' --neighbours 4")
    );
    assert!(!page.contains("http://www.w3.org/1999/xlink") && !page.contains("<script"));
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(room.path().join("note.json")).unwrap()).unwrap();
    assert_eq!(json["verdict"]["standing"], "open");
    assert_eq!(json["lines"].as_array().unwrap().len(), 2);
    assert!((json["units"]["length_m"].as_f64().unwrap() - 3.593).abs() < 1e-12);
}

/// The words of which a shell makes the command in a note.
#[cfg(unix)]
fn words_of_note(room: &Path) -> Vec<String> {
    let page = fs::read_to_string(room.join("note.html")).unwrap();
    let (_, from) = page.split_once("with the command</p>\n<p><code>").unwrap();
    let line = from.split_once("</code>").unwrap().0;
    let line = line.replace("&quot;", "\"").replace("&#39;", "'");
    let line = line.replace("&lt;", "<");
    let line = line.replace("&gt;", ">").replace("&amp;", "&");
    let script = format!("snapload() {{ printf '%s\\0' \"$@\"; }}; {line}");
    let mut shell = std::process::Command::new("sh");
    let read = shell.current_dir(room).args(["-c", &script]).output();
    let read = String::from_utf8(read.unwrap().stdout).unwrap();
    read.split_terminator('\0').map(str::to_owned).collect()
}

#[cfg(unix)]
#[test]
fn the_command_of_a_note_is_read_by_a_shell_as_it_was_given() {
    let room = room();
    let file = |from: &str, to: &str| {
        fs::copy(Path::new(EXAMPLES).join(from), room.path().join(to)).unwrap();
    };
    let pier = "my pier's; $(touch bad).toml";
    file("cylinder.toml", pier);
    file("pontoon.nc", "my pontoon.nc");
    let project = "project.name=O'Brien & \"Sons\"";
    let assess = ["assess", pier, "--set", project, "--set", "run.duration=40"];
    let sea = ["seas", "cylinder-sea.toml", "--set", "project.name=O'Brien"];
    let to_note = ["--out", "note.html"];
    for (words, kept, left_out) in [
        (&assess[..], &["--neighbours", "0"][..], &["--no-scan"][..]),
        (&sea, &["--set", "run.duration=60", "--seeds", "1"], &[]),
        (&["hydro", "my pontoon.nc"], &to_note, &[]),
    ] {
        let mut command = snapload(room.path());
        command.args(words).args(kept).args(left_out);
        if words[0] != "hydro" {
            command.args(to_note);
        }
        command.assert().success();
        assert_eq!(words_of_note(room.path()), [words, kept].concat());
    }
    assert!(!listing(room.path()).contains(&"bad".to_owned()));
}

/// The inputs of a note state the direction of the waves; a headline does so if they travel to −x.
#[test]
fn the_direction_of_waves_is_reported() {
    let room = room();
    let headline_and_page = |verb: &str, file: &str, key: &str, direction: &str| {
        let heading = format!("{key}.direction={direction}");
        let mut command = snapload(room.path());
        command.args([verb, file, "--set", "run.duration=40", "--set", &heading]);
        command.args(["--out", "note.html"]);
        match verb {
            "assess" => command.args(["--neighbours", "0", "--no-scan"]),
            _ => command.args(["--seeds", "3"]),
        };
        let output = command.output().unwrap();
        assert!(output.status.success(), "{output:?}");
        let words = String::from_utf8(output.stdout).unwrap();
        let page = fs::read_to_string(room.path().join("note.html")).unwrap();
        (words.lines().next().unwrap().to_owned(), page)
    };
    for (verb, file, key) in [
        ("assess", "cylinder.toml", "wave"),
        ("assess", "cylinder-sea.toml", "sea"),
        ("seas", "cylinder-sea.toml", "sea"),
    ] {
        for (direction, headlined) in [("+x", false), ("-x", true)] {
            let (headline, page) = headline_and_page(verb, file, key, direction);
            assert_eq!(headline.contains(" to -x"), headlined, "{headline}");
            let listed = page.contains(&format!(", to {direction}</td>"));
            assert!(listed, "{verb} {file} {direction}");
        }
    }
}

#[test]
fn bad_input_is_reported_with_exit_status_2() {
    let room = room();
    for (set, expected) in [
        ("wave.hieght=2", "did you mean height?"),
        ("body.mass=200000", "sinks"),
        ("line.length=9", "shorten the lines"),
        ("run.start=[0, -2]", "within reach of every line"),
    ] {
        snapload(room.path())
            .args(["assess", "cylinder.toml", "--set", set])
            .assert()
            .code(2)
            .stderr(contains(expected));
    }
    snapload(room.path())
        .args(["assess"])
        .assert()
        .code(2)
        .stderr(contains("CASE.toml"));
    snapload(room.path())
        .args(["seas", "cylinder.toml"])
        .assert()
        .code(2)
        .stderr(contains("[sea]").and(contains("snapload assess")));
    snapload(room.path())
        .args(["seas", "cylinder-sea.toml", "--out", "seas.txt"])
        .assert()
        .code(2)
        .stderr(contains(".html or .csv"));
    snapload(room.path())
        .args(["assess", "cylinder.toml", "--out", "note.pdf"])
        .assert()
        .code(2)
        .stderr(contains("--out note.pdf").and(contains("ends in .html")));
    snapload(room.path())
        .args(["assess", "cylinder.toml", "--out", "a.html"])
        .args(["--json", "./a.html"])
        .assert()
        .code(2)
        .stderr(contains("both name").and(contains("a.html")));
    let text = fs::read_to_string(room.path().join("cylinder.toml")).unwrap();
    let text = text.replace("displaced_volume = 141.37", "");
    fs::write(room.path().join("cylinder.toml"), text).unwrap();
    snapload(room.path())
        .args(["assess", "cylinder.toml"])
        .assert()
        .code(2)
        .stderr(contains("cylinder.toml").and(contains("displaced_volume")));
    assert_eq!(listing(room.path()), ["cylinder-sea.toml", "cylinder.toml"]);
}

/// Writing to a link replaces its target and keeps the link; a device is written into.
#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_written_into() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let room = room();
    let at = |name: &str| room.path().join(name);
    fs::create_dir(at("far")).unwrap();
    fs::write(at("far/note.html"), "before").unwrap();
    symlink(at("far/note.html"), at("note.html")).unwrap();
    symlink("/dev/null", at("nowhere.html")).unwrap();
    for out in ["note.html", "nowhere.html"] {
        snapload(room.path())
            .args(["assess", "cylinder.toml", "--out", out])
            .args([
                "--set",
                "run.duration=120",
                "--neighbours",
                "0",
                "--no-scan",
            ])
            .assert()
            .success();
        assert!(at(out).is_symlink(), "{out}");
    }
    assert!(
        fs::read_to_string(at("far/note.html"))
            .unwrap()
            .contains("Assumptions")
    );
    let device = fs::metadata("/dev/null").unwrap();
    assert!(device.file_type().is_char_device());
}

/// `run` refuses a structure and names `assess`, and the other way round.
#[test]
fn run_and_assess_point_to_each_other() {
    let room = room();
    fs::write(room.path().join("mooring.toml"), "f_o = 0.31\n").unwrap();
    snapload(room.path())
        .args(["assess", "mooring.toml"])
        .assert()
        .code(2)
        .stderr(contains("hint: write snapload run mooring.toml"));
    snapload(room.path())
        .args(["run", "cylinder.toml"])
        .assert()
        .code(2)
        .stderr(contains("snapload assess cylinder.toml"));
}

/// The same records from the same seed, whatever their number.
#[test]
fn seas_are_reproducible() {
    let room = room();
    let run = |seeds: &str, name: &str| {
        snapload(room.path())
            .args([
                "seas",
                "cylinder-sea.toml",
                "--seeds",
                seeds,
                "--set",
                "run.duration=200",
                "--out",
                name,
            ])
            .assert()
            .success();
        fs::read_to_string(room.path().join(name)).unwrap()
    };
    let (three, five) = (run("3", "three.csv"), run("5", "five.csv"));
    assert!(five.starts_with(&three) && five.lines().count() == 6);
    let page = run("4", "seas.html");
    assert!(page.contains("Gumbel") && page.contains("<svg"));
}

#[test]
fn the_keys_are_listed() {
    snapload(directory().path())
        .args(["assess", "--keys"])
        .assert()
        .success()
        .stdout(
            contains("[[line]]")
                .and(contains("breaking_load"))
                .and(contains("kg/m^3")),
        );
}

/// Both models of a line are compared: the first snap comes before any line has pulled, and is the
/// same in both.
#[test]
fn elastic_runs_both_ways() {
    let room = room();
    let short = [
        "--set",
        "run.duration=3",
        "--set",
        "run.start=[0.3, -4.2]",
        "--set",
        "wave.height=1.5",
    ];
    snapload(room.path())
        .args(["elastic", "cylinder.toml", "--out", "motion.csv"])
        .args(["--every", "0.1", "--json", "both.json"])
        .args(short)
        .assert()
        .success()
        .stdout(contains("pulls of elastic lines").and(contains("motion.csv")));
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(room.path().join("both.json")).unwrap()).unwrap();
    let (pull, snap) = (&json["pulls"][0], &json["inextensible"]["snaps"][0]);
    assert_eq!(pull["line"], snap["line"]);
    let near = |a: &serde_json::Value, b: &serde_json::Value| {
        (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-6
    };
    assert!(near(&pull["from_s"], &snap["t_s"]) && near(&pull["speed_m_s"], &snap["speed_m_s"]));
    assert_eq!(json["end_s"], 3.0);
    let motion = fs::read_to_string(room.path().join("motion.csv")).unwrap();
    assert!(motion.starts_with("t_s,x_m,z_m,theta_rad,tension_1_n,tension_2_n\n"));
    let times = motion
        .lines()
        .skip(1)
        .map(|row| row.split(',').next().unwrap());
    let known: Vec<String> = (0..=30)
        .map(|k| format!("{:?}", f64::from(k) / 10.0))
        .collect();
    assert_eq!(times.collect::<Vec<_>>(), known);
    for (options, words) in [
        (
            &["--stiffer", "0"][..],
            "error: --stiffer = 0 is not allowed; allowed: a number, 1e-6 <= stiffer <= 1e9",
        ),
        (
            &["--every", "1e-6", "--out", "motion.csv"],
            "error: --every = 1e-6 is not allowed; allowed: a number above 0 that gives no more than 1e7 rows",
        ),
    ] {
        snapload(room.path())
            .args(["elastic", "cylinder.toml"])
            .args(options)
            .assert()
            .code(2)
            .stderr(contains(words));
    }
}

#[test]
fn moordyn_files_are_written_and_read() {
    let room = room();
    snapload(room.path())
        .args(["moordyn", "write", "cylinder.toml", "--out", "lines.txt"])
        .assert()
        .success()
        .stdout(contains("lines.txt"));
    snapload(room.path())
        .args(["moordyn", "read", "lines.txt", "--out", "again.toml"])
        .assert()
        .success();
    let verdict = |file: &str| {
        let assert = snapload(room.path())
            .args(["assess", file, "--json", "-", "--neighbours", "0"])
            .args(["--set", "run.duration=60", "--set", "run.transient=10"])
            .assert()
            .success();
        let json: serde_json::Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
        json["verdict"].clone()
    };
    assert_eq!(verdict("cylinder.toml"), verdict("again.toml"));
    let text = fs::read_to_string(room.path().join("lines.txt")).unwrap();
    // A fairlead that is moved in the tables is moved, and what it was before is named.
    fs::write(
        room.path().join("moved.txt"),
        text.replace("4  Body1  -1.061  0", "4  Body1  -1.3  0"),
    )
    .unwrap();
    snapload(room.path())
        .args(["moordyn", "read", "moved.txt", "--out", "moved.toml"])
        .assert()
        .success()
        .stdout(contains("note").and(contains("line.2.fairlead = [-1.061, -4.561]")));
    let moved = fs::read_to_string(room.path().join("moved.toml")).unwrap();
    assert!(moved.contains("fairlead = [-1.3, -4.561]"), "{moved}");
    let bare: String = text
        .lines()
        .filter(|line| !line.starts_with("snapload:"))
        .map(|line| format!("{line}\n"))
        .collect();
    fs::write(room.path().join("bare.txt"), &bare).unwrap();
    snapload(room.path())
        .args(["moordyn", "read", "bare.txt"])
        .assert()
        .success()
        .stdout(contains("# Still missing: body.width, run.restitution."));
    fs::write(
        room.path().join("off.txt"),
        bare.replace("3  Fixed  -3.593  0", "3  Fixed  -3.593  8"),
    )
    .unwrap();
    snapload(room.path())
        .args(["moordyn", "read", "off.txt"])
        .assert()
        .code(2)
        .stderr(contains("point 3, Y = 8").and(contains("one vertical plane")));
}
