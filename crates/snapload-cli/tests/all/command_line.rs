//! The command line: what it prints, what it writes, and which errors it reports.

use crate::common::{directory, listing, snapload};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use std::fs;
use std::path::Path;

fn json(directory: &Path, args: &[&str]) -> serde_json::Value {
    let out = snapload(directory)
        .arg("run")
        .args(args)
        .args(["--json", "-"])
        .assert()
        .success();
    serde_json::from_slice(&out.get_output().stdout).unwrap()
}

/// Asserts that the texts occur in this order.
fn in_order(text: &str, parts: &[&str]) {
    let mut from = 0;
    for part in parts {
        match text[from..].find(part) {
            Some(at) => from += at + part.len(),
            None => panic!("{part} is missing, or too early, in {text}"),
        }
    }
}

#[test]
fn a_run_is_summed_up_for_a_person() {
    let d = directory();
    let out = snapload(d.path())
        .arg("run")
        .assert()
        .success()
        .stderr(is_empty());
    let text = String::from_utf8(out.get_output().stdout.clone()).unwrap();
    in_order(
        &text,
        &[
            "Case",
            "the standard case (1910001000-359)",
            "End",
            "Impacts",
            "cable 1",
        ],
    );
    in_order(
        &text,
        &["Hardest", "v_n", "Norms", "rho1", "y_max", "Modes", "slack"],
    );
    assert!(text.lines().count() <= 25, "{text}");
    assert!(text.lines().all(|line| line.len() <= 100), "{text}");
    assert!(listing(d.path()).is_empty());
}

#[test]
fn a_word_in_the_place_of_a_file_has_a_hint() {
    let d = directory();
    for (word, hint) in [
        (
            "f_o=0.31",
            Some("hint: each key has an option of its own: --set f_o=0.31"),
        ),
        (
            "rocking-example",
            Some("hint: for the built-in case write --case rocking-example"),
        ),
        ("./f_o=0.31", None),
        ("f_o", None),
    ] {
        let assert = snapload(d.path())
            .args(["run", "--set", "a=0.2", word])
            .assert()
            .code(2)
            .stderr(contains(format!("{word}: there is no such file")));
        let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        let found = stderr.lines().find(|line| line.starts_with("hint"));
        assert_eq!(found, hint, "{stderr}");
    }
}

#[test]
fn the_summary_names_what_differs_from_the_standard_case() {
    let d = directory();
    let run = |args: &[&str], expected: &'static str| {
        snapload(d.path())
            .arg("run")
            .args(args)
            .assert()
            .success()
            .stdout(contains(expected));
    };
    run(&["--set", "f_o=0.4"], "standard case with f_o = 0.4\n");
    run(
        &["--case", "1920001000-359"],
        "1920001000-359: a = 0.2, inertia = 0.04\n",
    );
    run(
        &["--set", "t_end=0.2"],
        "end of the requested time, t = 0.2\n",
    );
}

#[test]
fn json_has_its_keys_in_their_order_and_nothing_else_is_printed() {
    let d = directory();
    let out = snapload(d.path())
        .args(["run", "--set", "t_end=1", "--json", "-"])
        .assert()
        .success()
        .stderr(is_empty());
    let text = String::from_utf8(out.get_output().stdout.clone()).unwrap();
    assert_eq!(text.lines().count(), 1);
    serde_json::from_str::<serde_json::Value>(&text).unwrap();
    in_order(
        &text,
        &[
            "{\"case\":{\"r\":1.5,\"e\":0.9,\"a\":0.1,\"b\":0.0,\"inertia\":0.010000000000000002,",
            "\"f_o\":0.3,\"nu\":0.5,\"omega\":0.9,\"x\":0.0,\"y\":0.1,\"theta\":0.0,\"vx\":0.0,",
            "\"vy\":0.0,\"vtheta\":0.0,\"t_end\":1.0,\"v_stick\":1e-6,\"stop_when_settled\":true,",
            "\"stop_when_sliding\":false,\"max_impacts\":1000000,",
            "\"body\":\"rigid\"},",
            "\"end\":{\"reason\":\"end_time\",\"t\":1.0,\"t_limit\":null},",
            "\"outcome\":{\"certain\":true,\"ensemble\":null},",
            "\"trust\":{\"t\":null,\"impact\":null,\"because\":null,\"tolerance\":0.001,",
            "\"uncertainty\":{},\"end_error\":",
            "\"exponents\":[",
            "\"grazes\":[],\"sensitivity\":[{\"impact\":1,\"t\":{",
            "\"impacts\":[{\"t\":",
            "\"cable\":",
            "\"v_n\":",
            "\"impulse\":",
            "\"energy_lost\":",
            "\"before\":[",
            "\"after\":[",
            "\"digits\":",
            "\"modes\":[{\"mode\":\"slack\",\"taut\":[],\"t_start\":0.0",
            "\"t_end\":",
            "\"norms\":{\"rho1\":",
            "\"rho2\":",
            "\"rho3\":",
            "\"y_max\":",
            "\"theta_max\":",
        ],
    );
    assert!(!text.contains("motion"));
}

#[test]
fn json_shapes() {
    let d = directory();
    let run = json(d.path(), &["--set", "t_end=1", "--sample", "0.3"]);
    let impact = &run["impacts"][0];
    assert_eq!(impact["before"].as_array().unwrap().len(), 6);
    assert!([1, 2].contains(&impact["cable"].as_u64().unwrap()));
    let times: Vec<f64> = run["motion"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row["t"].as_f64().unwrap())
        .collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 0.9, 1.0]);
    let row = run["motion"][1].as_object().unwrap();
    assert_eq!(row.len(), 10);
    assert!(
        ["T1", "T2", "energy", "vtheta"]
            .iter()
            .all(|key| row.contains_key(*key))
    );
}

#[test]
fn the_end_is_sampled_once() {
    let d = directory();
    for (dt, rows) in [("0.05", 5), ("0.2", 2), ("7", 2), ("0.15", 3)] {
        let run = json(d.path(), &["--set", "t_end=0.2", "--sample", dt]);
        let motion = run["motion"].as_array().unwrap();
        assert_eq!(motion.len(), rows, "{dt}");
        assert_eq!(motion.last().unwrap()["t"], 0.2);
    }
}

#[test]
fn the_echoed_case_can_be_fed_back() {
    let d = directory();
    for args in [
        &["--set", "body=point", "--set", "t_end=0.2"][..],
        &["--set", "t_end=0.1"],
    ] {
        let first = json(d.path(), args);
        let case = first["case"].as_object().unwrap();
        let lines = case.iter().filter(|(_, value)| !value.is_null());
        let toml: String = lines
            .map(|(key, value)| format!("{key} = {value}\n"))
            .collect();
        fs::write(d.path().join("echo.toml"), toml).unwrap();
        assert_eq!(json(d.path(), &["echo.toml"]), first);
    }
    assert!(json(d.path(), &["--set", "body=point"])["case"]["inertia"].is_null());
}

#[test]
fn set_comes_after_file_and_case_from_left_to_right() {
    let d = directory();
    fs::write(d.path().join("a.toml"), "f_o = 0.2\nt_end = 0.1 # short\n").unwrap();
    let f_o = |args: &[&str]| json(d.path(), args)["case"]["f_o"].as_f64().unwrap();
    assert_eq!(f_o(&["a.toml"]), 0.2);
    assert_eq!(f_o(&["--set", "f_o=0.4", "a.toml"]), 0.4);
    assert_eq!(
        f_o(&["a.toml", "--set", "f_o=0.4", "--set", "f_o=0.1"]),
        0.1
    );
    assert_eq!(
        f_o(&["--case", "1910001000-559", "--set", "t_end=0.1"]),
        0.5
    );
    assert_eq!(
        f_o(&["--case", "1910001000-559", "--set", "f_o = 0.1"]),
        0.1
    );
    let changed = json(d.path(), &["--case", "1920001000-359", "--set", "a=0.3"]);
    assert_eq!(changed["case"]["inertia"].as_f64(), Some(0.3 * 0.3));
}

#[test]
fn a_directory_of_results_is_complete() {
    let d = directory();
    let run = [
        "run",
        "--set",
        "t_end=1",
        "--out",
        "deep/results",
        "--json",
        "run.json",
    ];
    snapload(d.path())
        .args(run)
        .assert()
        .success()
        .stdout(contains("deep/results/motion.csv"));
    let results = d.path().join("deep/results");
    let names = listing(&results);
    for name in ["impacts.csv", "modes.csv", "motion.csv", "run.json"] {
        assert!(names.contains(&name.to_owned()), "{names:?}");
    }
    assert!(!names.iter().any(|name| name.starts_with('.')), "{names:?}");
    let read = |name: &str| fs::read_to_string(results.join(name)).unwrap();
    assert_eq!(
        read("run.json"),
        fs::read_to_string(d.path().join("run.json")).unwrap()
    );
    assert!(read("impacts.csv").starts_with("t,cable,v_n,impulse,energy_lost,before_x,before_y,"));
    assert!(read("modes.csv").starts_with("mode,taut,t_start,t_end\nslack,,0.0,"));
    let motion = read("motion.csv");
    assert!(motion.starts_with("t,x,y,theta,vx,vy,vtheta,T1,T2,energy\n0.0,0.0,0.1,"));
    assert_eq!(motion.lines().count(), 1 + 1001);
    // Once more, over existing files.
    let run = [
        "run",
        "--set",
        "t_end=1",
        "--out",
        "deep/results",
        "--sample",
        "0.5",
    ];
    snapload(d.path()).args(run).assert().success();
    assert_eq!(listing(&results), names);
    assert_eq!(read("motion.csv").lines().count(), 1 + 3);
    assert!(read("run.json").contains("\"motion\":[{"));
}

#[test]
fn a_table_without_rows_has_its_header() {
    let d = directory();
    let run = ["run", "--set", "t_end=0.1", "--out", "results"];
    snapload(d.path()).args(run).assert().success();
    let impacts = fs::read_to_string(d.path().join("results/impacts.csv")).unwrap();
    assert_eq!(impacts.lines().count(), 1);
}

/// Runs it, expects exit status 2, the texts in the message, and nothing written.
#[track_caller]
fn refused(args: &[&str], texts: &[&str]) {
    let d = directory();
    fs::write(d.path().join("good.toml"), "t_end = 0.1\n").unwrap();
    fs::create_dir(d.path().join("folder")).unwrap();
    let out = snapload(d.path())
        .arg("run")
        .args(args)
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(predicate::str::starts_with("error: "));
    let message = String::from_utf8(out.get_output().stderr.clone()).unwrap();
    assert!(texts.iter().all(|text| message.contains(text)), "{message}");
    assert_eq!(listing(d.path()), ["folder", "good.toml"], "{args:?}");
    assert!(listing(&d.path().join("folder")).is_empty());
}

#[test]
fn bad_values_are_refused() {
    let with_output = [
        "--out", "results", "--json", "run.json", "--sample", "0.1", "--set",
    ];
    for (set, texts) in [
        ("e=1.5", &["--set: e = 1.5", "0 <= e <= 1"][..]),
        ("e=nan", &["e = NaN", "a number"]),
        ("e=0,9", &["e = \"0,9\"", "write e = 0.9"]),
        ("e=", &["e (nothing)", "0 <= e <= 1"]),
        ("e", &["\"e\"", "KEY=VALUE"]),
        ("", &["KEY=VALUE"]),
        ("=", &["there is no key \"\""]),
        ("e=[1, 2]", &["e (a list)"]),
        ("e={x = 1}", &["e (a table)"]),
        ("e=1999-01-01", &["e (a date or time)"]),
        (
            "omgea=1",
            &["\"omgea\"", "did you mean omega?", "stop_when_settled"],
        ),
        ("h=1.2", &["h = 1.2", "derived"]),
        ("r=0.5", &["r = 0.5", "|1 - a| = 0.9"]),
        ("a=0", &["inertia (left out)", "a = 0"]),
        ("body=ball", &["body = \"ball\"", "\"rigid\" or \"point\""]),
        ("max_impacts=1.5", &["max_impacts = 1.5", "whole number"]),
    ] {
        refused(
            &[set].into_iter().fold(with_output.to_vec(), |mut a, s| {
                a.push(s);
                a
            }),
            texts,
        );
    }
    refused(
        &["--set", "body=point", "--set", "theta=1"],
        &["theta = 1", "point mass"],
    );
    refused(
        &["--case", "1910001000-360"],
        &["1910001000-360", "1910001000-359", "snapload cases"],
    );
    refused(
        &["--case", "1910001000-359", "good.toml"],
        &["cannot be used with"],
    );
    refused(
        &["1910001000-359"],
        &["no such file", "--case 1910001000-359"],
    );
}

#[test]
fn bad_samples_and_places_are_refused() {
    refused(&["--sample", "0.1"], &["--sample", "--json", "--out"]);
    for dt in ["0", "-1", "nan", "inf", "x", ""] {
        refused(&["--json", "-", "--sample", dt], &["--sample"]);
    }
    let tiny = [
        "--set",
        "t_end=1",
        "--out",
        "new/results",
        "--sample",
        "1e-12",
    ];
    refused(&tiny, &["--sample 1e-12", "1e7 rows"]);
    refused(&["--json", "folder"], &["folder", "directory"]);
    refused(&["--json", "good.toml/run.json"], &["good.toml"]);
    refused(&["--json", ""], &["--json"]);
    refused(&["--out", "good.toml"], &["good.toml", "not a directory"]);
    refused(&["--out", "good.toml/results"], &["good.toml/results"]);
    refused(&["folder"], &["folder", "directory, not a file"]);
    refused(&["absent.toml"], &["absent.toml", "no such file"]);
}

#[test]
fn lists_help_and_completions() {
    let d = directory();
    let run = |args: &[&str]| {
        let out = snapload(d.path())
            .args(args)
            .assert()
            .success()
            .stderr(is_empty());
        String::from_utf8(out.get_output().stdout.clone()).unwrap()
    };
    let cases = run(&["cases"]);
    in_order(
        &cases,
        &[
            "1910001000-359",
            "1910001000-3575",
            "0.75",
            "1933001000-559",
            "sliding-example",
        ],
    );
    let keys = run(&["keys"]);
    in_order(
        &keys,
        &[
            "length of the cables",
            "default 1.5",
            "r > |1 - a|",
            "\"rigid\" or \"point\"",
        ],
    );
    in_order(
        &run(&["--help"]),
        &["Usage", "run", "cases", "keys", "Examples", "Exit status"],
    );
    in_order(
        &run(&["run", "--help"]),
        &["--set", "--sample", "Examples", "snapload run --case"],
    );
    in_order(
        &run(&["--version"]),
        &[concat!("snapload ", env!("CARGO_PKG_VERSION"))],
    );
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(run(&["completions", shell]).contains("snapload"), "{shell}");
    }
    for words in [&[][..], &["completions", "tcsh"]] {
        snapload(d.path()).args(words).assert().code(2);
    }
}
