//! Orbits, branches, sections and basins by the command.

use crate::common::{directory, snapload};
use predicates::str::contains;
use serde_json::Value;

pub const VOLLEY: [&str; 13] = [
    "--set",
    "body=point",
    "--set",
    "r=1.7",
    "--set",
    "e=0.35",
    "--set",
    "f_o=1.4",
    "--set",
    "nu=0.8",
    "--set",
    "omega=3.1",
    "--json",
];

pub fn json(verb: &str, args: &[&str]) -> Value {
    let d = directory();
    let out = snapload(d.path())
        .arg(verb)
        .args(VOLLEY)
        .arg("-")
        .args(args)
        .assert()
        .success();
    serde_json::from_slice(&out.get_output().stdout).unwrap()
}

pub fn refused(args: &[&str], why: &str) {
    let d = directory();
    snapload(d.path())
        .args(args)
        .assert()
        .code(2)
        .stderr(contains(why));
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn the_orbit_of_the_attractor_and_near_a_start_are_one() {
    let near = json(
        "orbit",
        &["--start", "x=-0.2689,y=0.3829,vx=0.8083,vy=-0.4262"],
    );
    for orbit in [json("orbit", &[]), near] {
        // The values were computed with 50 digits by an independent program, and rounded.
        let state = &orbit["section"]["state"];
        assert!((number(&state[0]) + 0.2688102191814386).abs() < 1e-13);
        assert!((number(&state[3]) - 0.8083740914045439).abs() < 1e-13);
        assert_eq!(orbit["symbol"], serde_json::json!(["2", "1"]));
        assert_eq!(orbit["stable"], true);
        assert_eq!(orbit["admissible"]["yes"], true);
        assert_eq!(orbit["multipliers"].as_array().unwrap().len(), 4);
        assert!((number(&orbit["multipliers"][0][0]) - 0.4878061052050212).abs() < 1e-11);
        assert!((number(&orbit["product"]["value"]) - 0.35_f64.powi(4)).abs() < 1e-14);
        assert_eq!(orbit["proved"], false);
        assert!(orbit["error_bound"].is_null());
        assert_eq!(orbit["case"]["r"], 1.7);
    }
}

/// Two laps of an orbit of one period form a lap of two periods; the output says that they are one
/// orbit.
#[test]
fn a_lap_that_repeats_a_shorter_orbit_is_reported() {
    let d = directory();
    let start = "x=-0.2688,y=0.3830,vx=0.8084,vy=-0.4263";
    for (periods, expected) in [("1", false), ("2", true), ("3", true)] {
        let near = ["--start", start, "--periods", periods];
        let orbit = json("orbit", &near);
        assert_eq!(orbit["period"]["forcing_periods"].to_string(), periods);
        assert_eq!(orbit["period"]["smallest"], 1);
        let out = snapload(d.path())
            .arg("orbit")
            .args(&VOLLEY[..VOLLEY.len() - 1])
            .args(near)
            .assert()
            .success();
        let words = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
        let line = format!("after one period: this lap goes round that orbit {periods} times");
        assert_eq!(words.contains(&line), expected, "{words}");
    }
}

/// An orbit of two periods is reported with two; two laps of it are reported as such.
#[test]
fn an_orbit_of_two_periods_has_no_fewer() {
    let start = "x=0.069220795,y=0.067061903,vx=0.162448120,vy=0.407325943";
    for periods in ["2", "4"] {
        let orbit = json("orbit", &["--start", start, "--periods", periods]);
        assert_eq!(orbit["period"]["forcing_periods"].to_string(), periods);
        assert_eq!(orbit["period"]["smallest"], 2);
        assert!((number(&orbit["section"]["state"][0]) - 0.069220795).abs() < 1e-8);
    }
}

#[test]
fn an_orbit_far_from_its_start_is_reported() {
    for (start, is_far) in [("x=-0.26,y=0.38,vx=0.81,vy=-0.42", false), ("y=0.4", true)] {
        let orbit = json("orbit", &["--start", start]);
        let far = number(&orbit["start_distance"]);
        assert_eq!(far >= 0.02, is_far, "{start}: {far}");
        let d = directory();
        let out = snapload(d.path())
            .arg("orbit")
            .args(&VOLLEY[..VOLLEY.len() - 1])
            .args(["--start", start])
            .assert()
            .success();
        let words = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
        let reported = words.contains(&format!("{far:.3} from the start in one coordinate"));
        assert_eq!(reported, is_far, "{words}");
    }
    assert!(json("orbit", &[])["start_distance"].is_null());
}

/// The period, the snaps and the exponent of an attractor are those of its orbit.
#[test]
fn a_section_knows_its_period() {
    let section = json("section", &["--periods", "1000", "--keep", "500"]);
    assert_eq!(section["period"], 1);
    assert_eq!(section["points"].as_array().unwrap().len(), 501);
    assert_eq!(number(&section["snaps"]), 2.0);
    // The exponent of the orbit is ln|mu|/T.
    let largest = 0.487_806_105_205_021_2_f64.ln() / (std::f64::consts::TAU / 3.1);
    assert!((number(&section["exponents"][0]["value"]) - largest).abs() < 1e-9);
    let diagram = json(
        "diagram",
        &[
            "--vary",
            "f_o=1.4:1.42:2",
            "--periods",
            "60",
            "--keep",
            "20",
        ],
    );
    assert_eq!(diagram["rows"][0]["period"], 1);
    assert_eq!(diagram["rows"][1]["restarted"], false);
}

/// The impacts of a stable motion are the events of its orbit, which is closed by Newton's method.
#[test]
fn the_section_at_impacts_is_that_of_the_orbit() {
    let section = json("section", &["--at", "impacts", "--keep", "10"]);
    let impacts = section["impacts"].as_array().unwrap();
    assert_eq!(impacts.len(), 20);
    let orbit = json("orbit", &[]);
    let (events, period) = (
        orbit["events"].as_array().unwrap(),
        number(&orbit["period"]["t"]),
    );
    for (impact, event) in impacts.iter().zip(events.iter().cycle()) {
        assert_eq!(impact["cable"], event["cable"]);
        let off = ["v_n", "impulse"].map(|key| (number(&impact[key]) - number(&event[key])).abs());
        assert!(off[0] < 1e-9 && off[1] < 1e-9, "{off:?}");
        assert!((number(&impact["phase"]) - number(&event["t"]) / period).abs() < 1e-9);
        let [before, after] = ["before", "after"].map(|key| impact[key].as_array().unwrap());
        // For a unit mass the velocity jumps by the impulse.
        let jump = |i: usize| number(&after[i]) - number(&before[i]);
        assert_eq!([jump(0), jump(1), jump(2)], [0.0; 3]);
        assert!((jump(3).hypot(jump(4)) - number(&impact["impulse"])).abs() < 1e-12);
    }
    assert!(json("section", &[])["impacts"].is_null());
}

/// A torus has no period, however few its points: a period is reported only after eight laps of it.
#[test]
fn a_motion_without_a_period_is_reported() {
    let keys = [
        "r=1.976",
        "e=0.71",
        "nu=0.87",
        "omega=4.847",
        "f_o=1.6",
        "x=0",
        "y=0.4",
        "vx=0.1",
    ];
    let set: Vec<&str> = keys.iter().flat_map(|key| ["--set", key]).collect();
    for keep in ["1", "5", "100", "300"] {
        let section = json("section", &[&set[..], &["--keep", keep]].concat());
        assert!(section["period"].is_null(), "{keep}: {}", section["period"]);
    }
}

#[test]
fn a_basin_reports_its_cells() {
    let d = directory();
    let args = [
        "basin",
        "--set",
        "t_end=20",
        "--vary",
        "x=-1e-20:1e-20:3",
        "--vary",
        "y=0.1:0.2:2",
        "--out",
        "new/tables/cells.csv",
        "--json",
        "new/basin.json",
    ];
    // Folders that are missing are created.
    snapload(d.path()).args(args).assert().success();
    let answer = std::fs::read(d.path().join("new/basin.json")).unwrap();
    let basin: Value = serde_json::from_slice(&answer).unwrap();
    assert_eq!(number(&basin["legal"]), 6.0);
    let table = std::fs::read_to_string(d.path().join("new/tables/cells.csv")).unwrap();
    assert!(
        table.starts_with("x,y,outcome,t,decided,trusted\n"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 7);
    assert!(table.contains("\n-1e-20,0.1,"), "{table}");
    let safe = table.lines().filter(|line| !line.contains("limit")).count() - 1;
    assert_eq!(number(&basin["safe"]), safe as f64);
}

#[test]
fn what_can_not_be_is_refused() {
    refused(&["orbit", "--start", "z=1"], "one of the keys x, y");
    refused(&["orbit", "--start", "x=far"], "x must be a number");
    refused(&["orbit", "--start", "x"], "write KEY=VALUE");
    refused(
        &["orbit", "--start", "x=9"],
        "error: --start: x, y, theta = 9, 0.1, 0 is not allowed; allowed: a start within reach of both cables",
    );
    refused(
        &["branch", "--along", "f_o=0.2:0.4", "--start", "y=5"],
        "--start: y = 5 is not allowed",
    );
    let whole = "is not allowed; allowed: a whole number,";
    for (option, value, range) in [
        ("--find", "x", "1 <= find <= 1e7"),
        ("--find", "0", "1 <= find <= 1e7"),
        ("--find", "-3", "1 <= find <= 1e7"),
        ("--periods", "2.5", "1 <= periods <= 1024"),
    ] {
        refused(
            &["orbit", option, value],
            &format!("error: {option} = {value} {whole} {range}"),
        );
    }
    refused(
        &["verify", "--digits", "-3"],
        &format!("error: --digits = -3 {whole} 1 <= digits <= 307"),
    );
    refused(
        &["run", "--ensemble", "-1"],
        &format!("error: --ensemble = -1 {whole} 0 <= ensemble <= 1e9"),
    );
    let vast = "99999999999999999999";
    refused(
        &["orbit", "--find", "3", "--seed", vast],
        &format!("error: --seed = {vast} {whole} 0 <= seed < 2^64"),
    );
    refused(&["run", "--json"], "write --json - for standard output");
    refused(
        &["section", "--out", "a.csv", "--json", "./a.csv"],
        "--out and --json: both name a.csv; allowed are two files",
    );
    refused(
        &["run", "--out", "d", "--json", "d/run.json"],
        "two outputs are named d/run.json",
    );
    refused(
        &["section", "--out", "a.txt"],
        "--out a.txt: write a name that ends in .parquet or .csv",
    );
    refused(
        &["branch", "--along", "f_o=0.2:0.4", "--step", "far"],
        "error: --step = far is not allowed; allowed: a number",
    );
    refused(&["orbit", "--symbol", "3"], "1 or 2");
    refused(&["orbit", "--set", "omega=0"], "omega = 0");
    refused(&["orbit", "--phase", "1.5"], "from 0 to below 1");
    refused(
        &["branch", "--along", "f_o=0.5:1"],
        "a range that holds the value of the case, f_o = 0.3",
    );
    refused(&["branch", "--along", "f_o"], "no range");
    refused(
        &["section", "--periods", "5", "--keep", "9"],
        "at most periods = 5",
    );
    refused(&["basin", "--vary", "x=0:1:3"], "a window has two keys");
    refused(
        &["basin", "--vary", "x=0:1:3", "--vary", "x=0:1:3"],
        "two different keys",
    );
    refused(
        &["basin", "--vary", "x=0:1:3", "--vary", "e=0:2:3"],
        "e = 2",
    );
    refused(&["diagram", "--vary", "f_o=0:1"], "three numbers");
}

#[test]
fn where_there_is_no_orbit_it_is_said_why() {
    let d = directory();
    snapload(d.path())
        .args(["orbit", "--set", "f_o=0.5"])
        .assert()
        .code(1)
        .stderr(contains(
            "no orbit was found: the motion from this start stops at t = 10.02",
        ));
}

#[test]
fn an_orbit_is_proved_with_a_bound_on_the_error_of_what_is_printed() {
    let orbit = json("orbit", &["--prove"]);
    assert_eq!(orbit["proved"], true);
    let bound = number(&orbit["error_bound"]);
    assert!(bound > 0.0 && bound < 1e-14, "{bound:e}");
    // 30 digits of the values that an independent program computed with 50.
    let proof = &orbit["proof"];
    let exact = "-0.268810219181438605342115917801";
    assert_eq!(proof["state"][0], exact);
    assert_eq!(proof["state"][2], "0.000000000000000000000000000000");
    assert_eq!(proof["events"][0]["cable"], 2);
    assert_eq!(proof["prime"], true);
    let printed = number(&orbit["section"]["state"][0]);
    assert!((printed - exact.parse::<f64>().unwrap()).abs() <= bound);
    // The typed decimal is proved, although no double equals it.
    let d = directory();
    let typed = "r=1.70000000000000000000000000001";
    let out = snapload(d.path())
        .arg("orbit")
        .args(&VOLLEY[..VOLLEY.len() - 1])
        .args(["--set", typed, "--prove", "--json", "-"])
        .assert()
        .success();
    let other: Value = serde_json::from_slice(&out.get_output().stdout).unwrap();
    assert_eq!(other["section"]["state"], orbit["section"]["state"]);
    assert_ne!(other["proof"]["state"][0], proof["state"][0]);
}

#[test]
fn a_taut_lap_is_not_proved_and_the_reason_is_printed() {
    let d = directory();
    snapload(d.path())
        .args(
            "orbit --set body=point --set r=1.4 --set e=0.9 --set f_o=0.3 --set nu=0 --set omega=3"
                .split(' '),
        )
        .args(["--start", "x=0.1529,y=0.1855,vx=0.3589,vy=0.521", "--prove"])
        .assert()
        .code(1)
        .stdout(contains("Unproved  cable 2 is taut on a part of the lap"));
    refused(&["orbit", "--vary", "f_o=0.1:0.2:3"], "--find");
    refused(
        &["orbit", "--find", "5", "--vary", "t_end=1:2:3"],
        "a key on which orbits depend",
    );
}

#[test]
fn orbits_of_many_cases_are_found_from_those_before_and_proved() {
    let d = directory();
    snapload(d.path())
        .args("orbit --set a=0.3 --set b=0.3 --set omega=2.5".split(' '))
        .args(
            "--find 40 --seed 1 --vary f_o=0.48:0.5:3 --prove --out o.csv --json o.json".split(' '),
        )
        .assert()
        .success()
        .stdout(contains("certainly different orbits"));
    let read = |name: &str| std::fs::read_to_string(d.path().join(name)).unwrap();
    let found: Value = serde_json::from_str(&read("o.json")).unwrap();
    let orbits = found["orbits"].as_array().unwrap();
    assert_eq!(found["vary"], "f_o");
    assert_eq!(number(&found["proved"]) as usize, orbits.len());
    assert_eq!(found["distinct"], found["proved"]);
    let at = |value: f64| {
        orbits
            .iter()
            .filter(|o| number(&o["value"]) == value)
            .count()
    };
    assert!([0.48, 0.49, 0.5].iter().all(|value| at(*value) >= 2));
    let table = read("o.csv");
    assert!(table.starts_with("f_o,x,y,theta,vx,vy,vtheta,largest_multiplier"));
    assert_eq!(table.lines().count(), orbits.len() + 1);
    assert!(table.lines().nth(1).unwrap().contains(",true,true,"));
}
