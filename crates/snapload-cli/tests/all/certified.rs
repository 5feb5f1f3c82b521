//! The report on a run with its proof, compared with the run with many digits of `snapload verify`,
//! which proves by other code.

use crate::common::{directory, listing, snapload};
use serde_json::Value;
use std::fs;

fn output(args: &[&str]) -> String {
    let d = directory();
    let out = snapload(d.path()).args(args).assert().success();
    String::from_utf8(out.get_output().stdout.clone()).unwrap()
}

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&output(&[args, &["--json", "-"]].concat())).unwrap()
}

/// Five significant digits.
fn five(number: f64) -> String {
    format!("{number:.4e}")
}

#[test]
fn the_standard_case_is_proved_and_the_run_leaves_it_where_many_digits_do() {
    let args = ["run", "--certify", "--ensemble", "0"];
    let run = json(&args);
    let exact = json(&["verify"]);
    let impacts = |run: &Value, key: &str| run[key].as_array().unwrap().clone();
    let (ours, true_ones) = (impacts(&run, "impacts"), impacts(&exact, "exact"));
    let decimal = |impact: &Value, key: &str| -> f64 {
        let text = impact[key].as_str().unwrap();
        text.parse().unwrap()
    };
    let differs = ours.iter().zip(&true_ones).position(|(ours, exact)| {
        ours["cable"] != exact["cable"]
            || ["t", "v_n"]
                .iter()
                .any(|key| five(ours[*key].as_f64().unwrap()) != five(decimal(exact, key)))
    });
    let first = differs.expect("the standard case is chaotic") + 1;

    let certificate = &run["certificate"];
    assert_eq!(certificate["proved"], true);
    assert_eq!(certificate["reason"], "settled");
    assert!(certificate["undecided"].is_null());
    assert_eq!(
        certificate["impacts"].as_u64().unwrap(),
        true_ones.len() as u64
    );
    assert_eq!(
        certificate["departure"]["impact"].as_u64().unwrap(),
        first as u64
    );
    let end: f64 = certificate["t"].as_str().unwrap().parse().unwrap();
    assert_eq!(end, exact["t"].as_f64().unwrap());

    let text = output(&args);
    let (count, t) = (true_ones.len(), certificate["t"].as_str().unwrap());
    let proved = format!("\nProved    {count} impacts, settled at t = {t} (256 bits)\n");
    assert!(text.contains(&proved), "{text}");
    let left = format!("\n          the run departs from the proof at impact {first}, which ");
    assert!(text.contains(&left), "{text}");
}

#[test]
fn a_run_that_is_known_to_its_end_has_what_is_proved() {
    let args = ["run", "--set", "f_o=0.31", "--certify"];
    let text = output(&args);
    assert!(
        text.contains("\n          the run agrees in five digits\n"),
        "{text}"
    );
    let run = json(&args);
    assert!(run["certificate"]["departure"].is_null());
    let end: f64 = run["certificate"]["t"].as_str().unwrap().parse().unwrap();
    assert!((end - run["end"]["t"].as_f64().unwrap()).abs() < 1e-13);
}

/// An impact a billionth after the start is known to rounding, which is some of its digits.
#[test]
fn what_is_known_to_rounding_agrees() {
    let keys = "body=point r=1.5 x=-0.49137321483515284 y=0.9573917338114211 \
                vx=-0.04119960933161363 vy=0.3808622499964365 t_end=1.5";
    let mut args = vec!["run", "--certify"];
    for key in keys.split_whitespace() {
        args.extend(["--set", key]);
    }
    let run = json(&args);
    let t = run["impacts"][0]["t"].as_f64().unwrap();
    assert!((0.0..2e-9).contains(&t), "{t}");
    assert_eq!(run["certificate"]["proved"], true);
    assert!(run["certificate"]["departure"].is_null());
}

/// 0.30000000000000002 and 0.30000000000000004 are one double, and two cases.
#[test]
fn a_proof_names_the_numbers_that_were_written() {
    for f_o in ["0.30000000000000002", "0.30000000000000004"] {
        let set = format!("f_o={f_o}");
        let text = output(&["run", "--certify", "--set", &set, "--ensemble", "0"]);
        let caption = format!("Case      standard case with f_o = {f_o}\n");
        assert!(text.starts_with(&caption), "{text}");
    }
}

#[test]
fn the_proof_continues_where_a_cable_sticks() {
    let keys = "e=0.5 omega=0 stop_when_settled=false t_end=0.88";
    let mut args = vec!["run", "--certify"];
    for key in keys.split(' ') {
        args.extend(["--set", key]);
    }
    let run = json(&args);
    // The motion slides at the end, as the ordinary run does.
    assert_eq!(run["modes"][1]["mode"], "sliding");
    let certificate = &run["certificate"];
    assert_eq!(certificate["proved"], true);
    assert_eq!(certificate["reason"], "end_time");
    assert!(certificate["departure"].is_null());
}

#[test]
fn missing_proofs_are_reported() {
    // The case is symmetric: both cables snap at one instant.
    let text = output(&["run", "--certify", "--set", "f_o=0", "--ensemble", "0"]);
    assert!(
        text.contains("\nProved    0 impacts, up to t = 0 "),
        "{text}"
    );
    assert!(
        text.contains("\n          then undecided: the length of cable "),
        "{text}"
    );
    let joined = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains("and the length of cable "), "{text}");
    assert!(joined.contains("all at one instant"), "{text}");
    assert!(!text.contains("the run agrees"), "{text}");
}

#[test]
fn the_certificate_of_a_run_can_be_checked() {
    let d = directory();
    let mut command = snapload(d.path());
    let args = ["run", "--case", "1510001000-359", "--certify", "--out", "r"];
    command.args(args).assert().success();
    let proof = fs::read_to_string(d.path().join("r/run.cert")).unwrap();
    // Some programs begin a text with a mark of its encoding.
    fs::write(d.path().join("marked.cert"), format!("\u{feff}{proof}")).unwrap();
    for file in ["r/run.cert", "marked.cert"] {
        let mut command = snapload(d.path());
        command
            .args(["certify", "--check", file])
            .assert()
            .success();
    }
    let inside: Value =
        serde_json::from_str(&fs::read_to_string(d.path().join("r/run.json")).unwrap()).unwrap();
    assert_eq!(inside["certificate"]["proved"], true);

    // The proof of the run before is not left beside a run that has none.
    let mut command = snapload(d.path());
    command.args(["run", "--out", "r"]).assert().success();
    let left = listing(&d.path().join("r"));
    assert!(left.contains(&"run.json".to_owned()) && !left.contains(&"run.cert".to_owned()));
    // What this run itself writes under that name stays.
    let mut command = snapload(d.path());
    let args = ["run", "--out", "r", "--json", "r/run.cert"];
    command.args(args).assert().success();
    assert!(listing(&d.path().join("r")).contains(&"run.cert".to_owned()));

    // Without `--certify` the output does not mention a proof.
    let d = directory();
    let mut command = snapload(d.path());
    command.args(["run", "--out", "r"]).assert().success();
    assert!(!listing(&d.path().join("r")).contains(&"run.cert".to_owned()));
    assert!(
        json(&["run", "--ensemble", "0"])
            .get("certificate")
            .is_none()
    );
}

/// Where a proof of slack flight ends although the motion continues, the command names the option
/// with which the proof continues.
#[test]
fn a_proof_that_ends_where_a_cable_sticks_names_the_option_to_continue() {
    let slack = output(&[
        "certify",
        "--set",
        "e=0.5",
        "--set",
        "stop_when_settled=false",
    ]);
    assert!(
        slack.starts_with("proved up to t = ") && slack.contains("--taut"),
        "{slack}"
    );
    let settled = output(&["certify", "--set", "e=0.5"]);
    assert!(settled.contains("settled at t = ") && !settled.contains("--taut"));
}

/// A certificate goes into a file that `--json` names, alone or beside that of `--out`.
#[test]
fn a_certificate_is_written_into_every_file_that_is_named() {
    let d = directory();
    let proved = |more: &[&str]| {
        let args = [&["certify", "--set", "e=0.5"], more].concat();
        let out = snapload(d.path()).args(args).assert().success();
        String::from_utf8(out.get_output().stdout.clone()).unwrap()
    };
    let output = proved(&["--json", "one.json"]);
    assert!(output.ends_with("Written   one.json\n"), "{output}");
    let output = proved(&["--json", "two.json", "--out", "run.cert"]);
    let both = "Written   run.cert\nWritten   two.json\n";
    assert!(output.ends_with(both), "{output}");
    let read = |name: &str| fs::read_to_string(d.path().join(name)).unwrap();
    assert_eq!(read("one.json"), read("two.json"));
    assert_eq!(read("one.json"), read("run.cert"));
    assert_eq!(listing(d.path()), ["one.json", "run.cert", "two.json"]);
}
