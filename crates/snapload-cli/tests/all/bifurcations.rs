//! Branches and curves by the command, and pictures of them.

use crate::common::{directory, snapload};
use crate::orbits::{VOLLEY, json, number, refused};
use predicates::str::contains;
use serde_json::Value;

#[test]
fn a_branch_has_its_fold() {
    let branch = json(
        "branch",
        &[
            "--along",
            "f_o=1.3:1.45",
            "--step",
            "0.05",
            "--events",
            "fold",
        ],
    );
    let events = branch["events"].as_array().unwrap();
    assert_eq!(events.len(), 1);
    assert_eq!(events[0]["kind"], "fold");
    assert!((number(&events[0]["value"]) - 1.304034132999962).abs() < 1e-12);
    assert!(branch["points"].as_array().unwrap().len() > 5);
    assert_eq!(branch["ends"].as_array().unwrap().len(), 2);
}

#[test]
fn a_branch_goes_over_at_a_doubling() {
    let args = [
        "--along",
        "f_o=1.2:2",
        "--switch",
        "period_doubling",
        "--step",
        "0.002",
    ];
    let branch = json("branch", &args);
    let from = branch["from"].as_array().unwrap();
    assert_eq!(from.len(), 1);
    assert_eq!(from[0]["kind"], "period_doubling");
    // The value was computed with 50 digits by an independent program, and rounded.
    let doubling = 1.680507876014799;
    assert!((number(&from[0]["value"]) - doubling).abs() < 1e-9);
    assert_eq!(branch["ends"][0]["because"], "the period doubling");
    let points = branch["points"].as_array().unwrap();
    let first = number(&points[0]["multipliers"][0][0]);
    assert!(
        (first - 3.550_316_587_225_957_f64.powi(2)).abs() < 1e-6,
        "{first}"
    );
    let mut ratios = Vec::new();
    for point in &points[1..4] {
        assert_eq!(point["symbol"].as_array().unwrap().len(), 4);
        assert!(number(&point["return_error"]) < 1e-11);
        let pairs = point["section"].as_array().unwrap().iter();
        let pairs = pairs.zip(from[0]["state"].as_array().unwrap());
        let square: f64 = pairs.map(|(a, b)| (number(a) - number(b)).powi(2)).sum();
        ratios.push((number(&point["value"]) - doubling) / square);
    }
    assert!(ratios[0] > 0.0, "{ratios:?}");
    assert!((ratios[1] / ratios[0] - 1.0).abs() < 0.1, "{ratios:?}");
}

#[test]
fn a_branch_begins_with_the_period_of_the_attractor() {
    let keys = ["r=1.976", "e=0.71", "nu=0.87", "omega=4.847", "f_o=1.8"];
    let set = keys.iter().flat_map(|key| ["--set", key]);
    let args: Vec<&str> = set.chain(["--along", "f_o=1.75:1.85"]).collect();
    let branch = json("branch", &args);
    let points = branch["points"].as_array().unwrap();
    assert!(points.iter().all(|point| point["admissible"] == true));
    // One snap a period, as the reference's diagram has it.
    assert_eq!(points[0]["symbol"].as_array().unwrap().len(), 2);
    assert_eq!(points[0]["stable"], true);
}

#[test]
fn a_doubling_that_is_not_there_is_refused() {
    let one = "the branch has 1 in its range, at 1.680508";
    for (switches, code, why) in [
        (&["fold"][..], 2, "write period_doubling"),
        (&["period_doubling:0"], 2, "write period_doubling"),
        (&["period_doubling:2"], 1, one),
        (
            &["period_doubling:1"; 2],
            1,
            "the branch has no period doubling",
        ),
    ] {
        let d = directory();
        snapload(d.path())
            .arg("branch")
            .args(&VOLLEY[..VOLLEY.len() - 1])
            .args(["--along", "f_o=1.2:1.75"])
            .args(switches.iter().flat_map(|switch| ["--switch", switch]))
            .assert()
            .code(code)
            .stderr(contains(why));
    }
}

#[test]
fn a_curve_of_folds_is_one_of_branches() {
    let d = directory();
    let args = ["--follow", "fold", "--along", "f_o=1:2,omega=2.9:3.3"];
    let files = ["--out", "c.csv", "--plot", "c.svg", "--json", "c.json"];
    snapload(d.path())
        .arg("curve")
        .args(&VOLLEY[..VOLLEY.len() - 1])
        .args(args)
        .args(files)
        .assert()
        .success()
        .stdout(contains("omega from 2.900000 to 3.300000"));
    let read = |name: &str| std::fs::read_to_string(d.path().join(name)).unwrap();
    let curve: Value = serde_json::from_str(&read("c.json")).unwrap();
    assert_eq!(curve["follow"], "fold");
    assert_eq!(curve["along"], serde_json::json!(["f_o", "omega"]));
    assert!((number(&curve["from"]["value"]) - 1.304034132999962).abs() < 1e-9);
    let points = curve["points"].as_array().unwrap();
    let (f_o, omega) = (&points[0]["values"][0], &points[0]["values"][1]);
    assert_eq!(points[0]["others"], true);
    assert!((number(omega) - 2.9).abs() < 1e-9 || (number(omega) - 3.3).abs() < 1e-9);
    let args = ["--set", &format!("omega={omega}"), "--along", "f_o=1:2"];
    let branch = json("branch", &[&args[..], &["--events", "fold"]].concat());
    let fold = number(&branch["events"][0]["value"]);
    assert!((fold - number(f_o)).abs() < 1e-9, "{fold} {f_o}");
    assert_eq!(read("c.csv").lines().count(), points.len() + 1);
    assert!(read("c.csv").starts_with("arclength,f_o,omega,x,y,"));
    assert!(read("c.svg").contains("of a stable orbit"));
    // The state of the event as it is reported.
    let state = &branch["events"][0]["state"];
    let start = format!(
        "x={},y={},vx={},vy={}",
        state[0], state[1], state[3], state[4]
    );
    let args = [
        "--set",
        &format!("omega={omega}"),
        "--set",
        &format!("f_o={fold}"),
    ];
    let rest = [
        "--start",
        &start,
        "--follow",
        "fold",
        "--along",
        "f_o,omega=2.8:3.4",
    ];
    let again = json("curve", &[&args[..], &rest].concat());
    assert!((number(&again["from"]["value"]) - fold).abs() < 1e-9);
}

#[test]
fn a_curve_that_can_not_be_is_refused() {
    let volley = &VOLLEY[..VOLLEY.len() - 1];
    for (args, code, why) in [
        (
            ["--follow", "torus", "--along", "f_o,e"],
            2,
            "write fold, pd, ns or graze",
        ),
        (
            ["--follow", "fold:0", "--along", "f_o,e"],
            2,
            "N = 1, 2, ...",
        ),
        (
            ["--follow", "fold", "--along", "f_o"],
            2,
            "two keys are needed",
        ),
        (
            ["--follow", "fold", "--along", "f_o,f_o"],
            2,
            "two different keys",
        ),
        (
            ["--follow", "fold", "--along", "f_o,x"],
            2,
            "a key on which orbits depend: one of r, e",
        ),
        (
            ["--follow", "fold", "--along", "f_o=1.5:2,e"],
            2,
            "a range that holds the value",
        ),
        (
            ["--follow", "fold:2", "--along", "f_o=1:2,e"],
            1,
            "there is no fold number",
        ),
        (
            ["--follow", "ns", "--along", "f_o=1:2,e"],
            1,
            "along f_o: the branch has no Neimark-Sacker point",
        ),
    ] {
        let d = directory();
        let mut command = snapload(d.path());
        command
            .arg("curve")
            .args(volley)
            .args(args)
            .assert()
            .code(code)
            .stderr(contains(why));
    }
    refused(
        &["branch", "--along", "t_end=1:50"],
        "a key on which orbits depend",
    );
}

#[test]
fn sections_and_branches_are_drawn() {
    let d = directory();
    let run = |args: &[&str]| {
        let mut command = snapload(d.path());
        command.arg(args[0]).args(&VOLLEY[..VOLLEY.len() - 1]);
        command.args(&args[1..]).assert()
    };
    let branch = [
        "branch",
        "--along",
        "f_o=1.2:4",
        "--plot",
        "b.svg",
        "--show",
        "y_max",
    ];
    run(&branch).success().stdout(contains("b.svg"));
    let picture = std::fs::read_to_string(d.path().join("b.svg")).unwrap();
    for word in [
        "stable",
        "unstable",
        "not admissible",
        "fold",
        "corner",
        "upper bound",
        "ₘₐₓ (L)",
    ] {
        assert!(picture.contains(&format!(">{word}<")), "{word}");
    }
    let impacts = [
        "section", "--at", "impacts", "--plot", "i.svg", "--out", "i.csv",
    ];
    run(&impacts).success();
    let picture = std::fs::read_to_string(d.path().join("i.svg")).unwrap();
    assert!(picture.contains("cable 1") && picture.contains("cable 2"));
    let table = std::fs::read_to_string(d.path().join("i.csv")).unwrap();
    assert!(
        table.starts_with("t,phase,cable,v_n,impulse,x,y,theta,vx_before,"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 201);
    run(&["section", "--plot", "s.png", "--show", "vy"]).success();
    let picture = std::fs::read(d.path().join("s.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    let refused = ["section", "--plot", "s.svg", "--show", "v_n"];
    run(&refused)
        .code(2)
        .stderr(contains("one or two of the columns x, y"));
    run(&["section", "--plot", "s.pdf"])
        .code(2)
        .stderr(contains(".svg or .png"));
}

/// Between two special points there may be no point of the branch; the picture has the sorts of
/// orbits that a branch in short steps has, which all can be motions.
#[test]
fn what_is_between_two_special_points_is_drawn_as_it_is() {
    for (range, step) in [("e=0.1:0.6", "0.01"), ("f_o=0.9:1.9", "0.05")] {
        let d = directory();
        let run = |step: &str| {
            let files = format!("--step {step} --plot {step}.svg --out {step}.csv");
            let mut command = snapload(d.path());
            command.arg("branch").args(&VOLLEY[..VOLLEY.len() - 1]);
            let args = command.args(["--along", range]).args(files.split(' '));
            args.assert().success();
            let read = |name| std::fs::read_to_string(d.path().join(name)).unwrap();
            (read(format!("{step}.svg")), read(format!("{step}.csv")))
        };
        let (picture, _) = run(step);
        let (_, table) = run("0.002");
        assert!(!table.contains(",false"));
        for (sort, rows) in [("stable", ",stable,"), ("unstable", ",unstable,")] {
            let drawn = picture.contains(&format!(">{sort}<"));
            assert_eq!(drawn, table.contains(rows), "{range} {sort}");
        }
        assert!(!picture.contains(">not admissible<"), "{range}");
    }
}

/// The legend of a basin's map names the ends that its table has, and no others; cells whose runs
/// are cut short are hatched, and cells beyond the length of a cable are no legal cases.
#[test]
fn basins_erosion_and_diagrams_are_drawn() {
    let d = directory();
    let run = |args: &str| {
        let args = args.split_whitespace();
        snapload(d.path()).args(args).assert().success();
    };
    let read = |name: &str| std::fs::read_to_string(d.path().join(name)).unwrap();
    let window = "--set t_end=60 --vary x=-0.4:0.4:9 --vary y=0.02:0.72:8 --plot b.svg --out b.csv";
    run(&format!("basin {window}"));
    let (picture, table) = (read("b.svg"), read("b.csv"));
    for [word, end] in [
        ["settled", ",settled,"],
        ["rotation limit", ",rotation_limit,"],
        ["upper bound", ",upper_bound,"],
        ["end time", ",end_time,"],
        ["no legal case", ",,,,"],
        ["undecided whether safe", ",false,"],
    ] {
        let drawn = picture.contains(&format!(">{word}<"));
        assert_eq!(drawn, table.contains(end), "{word}");
    }
    assert!(picture.contains(">settled<") && picture.contains(">no legal case<"));
    run("basin --set max_impacts=3 --no-trust --vary x=-0.1:0.1:3 --vary y=0.3:0.5:3 --plot c.svg");
    let picture = read("c.svg");
    assert!(picture.contains(">impact limit<") && picture.contains(">undecided whether safe<"));

    let over = "erosion --set t_end=60 --vary x=-0.4:0.4:9 --vary y=0.02:0.72:8 --over f_o=0:0.6:5";
    run(&format!("{over} --plot e.svg"));
    let picture = read("e.svg");
    for words in ["safe part (GIM)", "its 95 % interval", "knee", "0.6"] {
        assert!(picture.contains(&format!(">{words}<")), "{words}");
    }
    run(&format!("{over} --plot l.svg --show lim"));
    assert!(read("l.svg").contains("distance of the nearest unsafe start (L)"));
    run("diagram --vary f_o=0.1:0.9:5 --periods 20 --keep 5 --plot d.svg");
    assert!(read("d.svg").contains(">the motion stops, not certain at some values<"));
}

/// The points of the first example of a section fill its two closed curves: seen from the middle of
/// a curve no two neighbours are far apart.
#[test]
fn the_example_of_a_torus_shows_curves() {
    let d = directory();
    let help = snapload(d.path()).args(["section", "--help"]).assert();
    let help = String::from_utf8_lossy(&help.get_output().stdout).into_owned();
    let examples = help.split("Examples:").nth(1).unwrap();
    let example = examples.split("snapload section ").nth(1).unwrap();
    let example = example.split("--plot").next().unwrap().replace('\\', " ");
    let output = snapload(d.path())
        .arg("section")
        .args(example.split_whitespace())
        .args(["--json", "-"])
        .assert()
        .success();
    let diagram: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let points: Vec<[f64; 2]> = diagram["points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|point| [0, 1].map(|i| number(&point["state"][i])))
        .collect();
    for first in [0, 1] {
        let curve: Vec<&[f64; 2]> = points.iter().skip(first).step_by(2).collect();
        let ends = |i: usize| {
            let values = || curve.iter().map(|point| point[i]);
            let [low, high] = [values().fold(9.0, f64::min), values().fold(-9.0, f64::max)];
            ((low + high) / 2.0, (high - low) / 2.0)
        };
        let [(x, wide), (y, high)] = [ends(0), ends(1)];
        let mut angles: Vec<f64> = curve
            .iter()
            .map(|point| ((point[1] - y) / high).atan2((point[0] - x) / wide))
            .collect();
        angles.sort_by(f64::total_cmp);
        let widest = angles
            .windows(2)
            .map(|two| two[1] - two[0])
            .fold(0.0, f64::max);
        assert!(widest < 0.1, "{widest}");
    }
}

/// A motion that stops before the first point has no section: a message says so, and no file is
/// written.
#[test]
fn a_section_without_points_is_none() {
    let d = directory();
    snapload(d.path())
        .args("section --set f_o=0.5 --plot x.svg --out x.csv".split(' '))
        .assert()
        .code(1)
        .stderr(contains(
            "the motion from this start stops at t = 10.0247: the rotation reached its limit. That is before the \
             first point of the section, which comes after 300 periods of the forcing; use fewer --periods",
        ));
    assert_eq!(std::fs::read_dir(d.path()).unwrap().count(), 0);
    snapload(d.path())
        .args("section --set f_o=0.5 --periods 3 --keep 2 --out x.csv".split(' '))
        .assert()
        .success()
        .stdout(contains("Stopped   at t = 10.0247"));
}

/// Where no orbit is near the start, branches and curves tell how far the one is that they
/// follow, as the orbit by itself does.
#[test]
fn what_is_followed_from_far_is_told_of() {
    for (start, is_far) in [("x=-0.26,y=0.38,vx=0.81,vy=-0.42", false), ("y=0.4", true)] {
        let far = number(&json("orbit", &["--start", start])["start_distance"]);
        let branch = ["--along", "f_o=1.35:1.41"];
        let curve = ["--follow", "fold", "--along", "f_o=1.2:1.6,omega=3.05:3.15"];
        for (verb, options) in [("branch", &branch[..]), ("curve", &curve)] {
            let d = directory();
            let out = snapload(d.path())
                .arg(verb)
                .args(&VOLLEY[..VOLLEY.len() - 1])
                .args(["--start", start, "--json", "answer.json"])
                .args(options)
                .output()
                .unwrap();
            let words = String::from_utf8_lossy(&out.stdout).into_owned();
            if !out.status.success() {
                assert!(is_far && verb == "curve", "{out:?}");
                continue;
            }
            let told = words.contains(&format!("{far:.3} from the start in one coordinate"));
            assert_eq!(told, is_far, "{verb} {words}");
            let text = std::fs::read_to_string(d.path().join("answer.json")).unwrap();
            let answer: Value = serde_json::from_str(&text).unwrap();
            assert_eq!(number(&answer["start_distance"]), far);
        }
    }
}
