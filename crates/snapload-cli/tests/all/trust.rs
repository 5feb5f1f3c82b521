//! What the command line reports about the trust in its results.

use crate::common::{directory, listing, snapload};
use predicates::str::contains;
use serde_json::Value;

fn output(args: &[&str]) -> String {
    let d = directory();
    let out = snapload(d.path()).args(args).assert().success();
    String::from_utf8(out.get_output().stdout.clone()).unwrap()
}

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&output(&[args, &["--json", "-"]].concat())).unwrap()
}

fn refused(args: &[&str], why: &str) {
    let d = directory();
    snapload(d.path())
        .args(args)
        .assert()
        .code(2)
        .stderr(contains(why));
}

#[test]
fn an_end_before_the_horizon_is_certain() {
    let text = output(&["run", "--set", "f_o=0.31"]);
    assert!(
        text.contains("Outcome   rotation limit: certain\n"),
        "{text}"
    );
    assert!(
        text.contains("Trust     known to 1e-3 to the end\n"),
        "{text}"
    );
    let run = json(&["run", "--set", "f_o=0.31"]);
    assert_eq!(run["outcome"]["certain"], true);
    assert!(run["outcome"]["ensemble"].is_null() && run["trust"]["t"].is_null());
    let digits: Vec<f64> = run["impacts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row["digits"].as_f64().unwrap())
        .collect();
    assert!(
        digits[0] > 15.0 && digits.iter().all(|d| *d > 12.0),
        "{digits:?}"
    );
}

#[test]
fn past_the_horizon_there_are_probabilities() {
    let args = [
        "run",
        "--set",
        "f_o=0.5",
        "--uncertainty",
        "1e-3",
        "--ensemble",
        "300",
    ];
    let run = json(&args);
    let ends = run["outcome"]["ensemble"]["ends"].as_array().unwrap();
    let parts: f64 = ends.iter().map(|end| end["part"].as_f64().unwrap()).sum();
    assert!((parts - 1.0).abs() < 1e-12 && ends.len() >= 2);
    for end in ends {
        let [low, part, high] = ["low", "part", "high"].map(|key| end[key].as_f64().unwrap());
        assert!(low < part && part < high && high - low < 0.12);
    }
    assert_eq!(run["trust"]["because"], "tolerance");
    assert_eq!(run["trust"]["uncertainty"]["vtheta"], 1e-3);
    let horizon = run["trust"]["impact"].as_u64().unwrap();
    assert!((1..5).contains(&horizon));
    let text = output(&args);
    assert!(text.contains(" % of 300 neighbours (95 %: "), "{text}");
}

#[test]
fn a_seed_draws_the_same_neighbours_again() {
    let args = [
        "run",
        "--set",
        "f_o=0.5",
        "--uncertainty",
        "1e-2",
        "--ensemble",
        "100",
        "--seed",
    ];
    let of = |seed: &str| json(&[&args[..], &[seed]].concat())["outcome"].to_string();
    assert_eq!(of("7"), of("7"));
    assert_ne!(of("7"), of("8"));
}

#[test]
fn sensitivities_are_those_of_two_runs_side_by_side() {
    let first = |change: &str| {
        json(&["run", "--set", change])["impacts"][0]["t"]
            .as_f64()
            .unwrap()
    };
    let slopes = &json(&["run"])["trust"]["sensitivity"][0]["t"];
    for (key, value) in [("f_o", 0.3), ("r", 1.5), ("inertia", 0.01), ("x", 0.0)] {
        let step = 1e-4;
        let ahead = first(&format!("{key}={}", value + step));
        let slope = (ahead - first(&format!("{key}={}", value - step))) / (2.0 * step);
        assert!(
            (slopes[key].as_f64().unwrap() - slope).abs() < 1e-6,
            "{key}"
        );
    }
}

#[test]
fn many_digits_show_where_the_ordinary_run_goes_wrong() {
    let square = ["verify", "--case", "1933001000-359", "--tolerance", "1e-6"];
    let found = json(&square);
    let (first_wrong, predicted) = (
        found["first_wrong"].as_u64().unwrap(),
        found["predicted"].as_u64().unwrap(),
    );
    assert!((35..60).contains(&first_wrong) && (35..60).contains(&predicted));
    assert_eq!(found["digits"], 76);
    let differences = found["differences"].as_array().unwrap();
    assert!(differences[(first_wrong - 1) as usize].as_f64().unwrap() > 1e-6);
    assert!(differences[0].as_f64().unwrap() < 1e-14);
    let text = output(&["verify", "--set", "f_o=0.31"]);
    assert!(
        text.contains("Compared  correct to 1e-3 at all 12 impacts"),
        "{text}"
    );
}

#[test]
fn the_probability_of_exceeding_has_a_band() {
    let found = json(&["critical", "--ensemble", "20", "--max", "0.33"]);
    let points = found["probability"].as_array().unwrap();
    assert_eq!(points.len(), 33);
    assert_eq!(found["passes"]["p50"], 0.31);
    assert_eq!(points[30]["certain"], true);
    assert_eq!(
        (&points[29]["part"], &points[30]["part"]),
        (&0.0.into(), &1.0.into())
    );
    // Where one run decides, no neighbour is run, and none is counted.
    for point in points {
        let (certain, part) = (point["certain"] == true, &point["part"]);
        assert_eq!(point["count"].is_null(), certain, "{point}");
        assert_eq!(
            &point["low"] == part && &point["high"] == part,
            certain,
            "{point}"
        );
    }
    let certain = points.iter().filter(|point| point["certain"] == true);
    let open = points.len() - certain.count();
    let text = output(&["critical", "--ensemble", "20", "--max", "0.33"]);
    let run = format!("20 neighbours at each f_o that one run does not decide ({open} of 33); ");
    assert!(text.contains(&run), "{text}");
}

#[test]
fn what_can_not_be_in_doubt_is_refused_in_words() {
    refused(
        &["run", "--uncertainty", "e=-1"],
        "uncertainty of 0 or more",
    );
    refused(
        &["run", "--uncertainty", "t_end=1"],
        "an uncertainty of one of the keys",
    );
    refused(
        &["run", "--uncertainty", "wide"],
        "write a number such as 1e-3",
    );
    refused(&["run", "--uncertainty", "weight=1"], "weight");
    refused(&["run", "--uncertainty", "b=0.1"], "no such quantity");
    let point = ["run", "--set", "body=point", "--uncertainty"];
    refused(&[&point[..], &["theta=1e-3"]].concat(), "no such quantity");
    refused(&["run", "--tolerance", "0"], "above 0");
    for wide in ["1e9", "y=900"] {
        let named = format!("error: --uncertainty = {wide} is not allowed; allowed: a smaller one");
        refused(&["run", "--uncertainty", wide], &named);
        let scan = [
            "critical",
            "--max",
            "0.3",
            "--step",
            "0.3",
            "--ensemble",
            "9",
        ];
        refused(&[&scan[..], &["--uncertainty", wide]].concat(), &named);
    }
    // What only neighbours have is refused where none are run, instead of having no effect.
    for option in ["--uncertainty", "--tolerance", "--seed"] {
        refused(
            &["critical", option, "13"],
            "needs neighbours, but none are run",
        );
    }
    refused(&["verify", "--digits", "400"], "307");
    refused(&["verify", "--tolerance", "nan"], "above 0");
}

#[test]
fn the_table_of_impacts_has_their_digits() {
    let d = directory();
    snapload(d.path())
        .args(["run", "--set", "t_end=1", "--out", "."])
        .assert()
        .success();
    assert!(listing(d.path()).contains(&"impacts.csv".to_owned()));
    let table = std::fs::read_to_string(d.path().join("impacts.csv")).unwrap();
    let mut lines = table.lines();
    assert!(lines.next().unwrap().ends_with(",after_vtheta,digits"));
    let digits: f64 = lines
        .next()
        .unwrap()
        .rsplit(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((15.0..16.0).contains(&digits));
}

#[test]
fn texts_for_few_neighbours_and_few_impacts_are_grammatical() {
    let text = output(&[
        "run",
        "--uncertainty",
        "f_o=0.01",
        "--ensemble",
        "1",
        "--set",
        "t_end=1",
    ]);
    assert!(text.contains(" % of 1 neighbour (95 %"), "{text}");
    let unsure = ["run", "--set", "t_end=0.3", "--uncertainty", "0.1"];
    let text = output(&[&unsure[..], &["--ensemble", "2"]].concat());
    assert!(text.contains("known to 1e-3 up to t = 0."), "{text}");
}

#[test]
fn no_uncertainty_is_the_same_as_none_given() {
    let of = |more: &[&str]| {
        let args = ["run", "--ensemble", "20"];
        json(&[&args[..], more].concat())["outcome"].to_string()
    };
    assert_eq!(of(&["--uncertainty", "f_o=0"]), of(&[]));
    assert_eq!(of(&["--uncertainty", "0"]), of(&[]));
}

#[test]
fn an_uncertainty_beyond_all_bounds_is_not_certain() {
    refused(&["run", "--uncertainty", "1e200"], "is not allowed");
    let run = json(&["run", "--uncertainty", "1e200", "--ensemble", "0"]);
    assert_eq!(run["outcome"]["certain"], false);
    assert_eq!(run["trust"]["because"], "tolerance");
    assert_eq!(run["impacts"][0]["digits"], 0.0);
}

/// A map says what its colours mean: of what `true` is, which cable snaps first, and that a run
/// without a horizon is trusted to its end. At f_o = 0 both cables snap at once, so that trust ends.
#[test]
fn a_map_of_trust_says_what_it_shows() {
    let d = directory();
    let map = |name: &str, options: &[&str]| {
        let [picture, out] = [format!("{name}.svg"), format!("{name}.parquet")];
        let grid = "--set t_end=2 --vary f_o=0:0.3:3 --vary e=0.5:0.9:3";
        let mut command = snapload(d.path());
        command.arg("sweep").args(grid.split(' ')).args(options);
        command.args(["--out", &out, "--plot", &picture]);
        command.assert().success();
        std::fs::read_to_string(d.path().join(picture)).unwrap()
    };
    let of = |column| ["--show", column];
    let certain = map("certain", &of("certain"));
    assert!(certain.contains(">end certain: true<") && certain.contains(">end certain: false<"));
    let horizon = map("horizon", &of("horizon_t"));
    assert!(horizon.contains(">trusted to the end<") && !horizon.contains(">no value<"));
    let unknown = map("unknown", &["--show", "horizon_t", "--no-trust"]);
    assert!(unknown.contains(">no value<") && !unknown.contains(">trusted to the end<"));
    let cable = map("cable", &of("first_cable"));
    assert!(
        cable.contains(">cable 1 first<") && !cable.contains(">1.8<"),
        "{cable}"
    );
}
