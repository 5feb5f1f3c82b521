//! Diagrams by the command.

use crate::common::{directory, snapload};
use crate::orbits::number;
use serde_json::Value;

/// A chaotic motion that stops does so by rounding: the text, the JSON and the table of a diagram
/// say so at each value, in the table also where no point was reached.
#[test]
fn a_diagram_tells_where_rounding_decides_a_stop() {
    let d = directory();
    let keys = ["body=point", "e=0.71", "nu=0.87", "omega=4.847", "f_o=1.6"];
    let out = snapload(d.path())
        .args(["diagram", "--vary", "r=1.6:1.8:2", "--phase", "0.25"])
        .args(keys.map(|key| format!("--set={key}")))
        .args(["--out", "table.csv", "--json", "answer.json"])
        .assert()
        .success();
    let text = String::from_utf8(out.get_output().stdout.clone()).unwrap();
    assert!(text.contains("(not certain)\n") && text.contains("not certain: rounding decides"));
    let read = |name: &str| std::fs::read_to_string(d.path().join(name)).unwrap();
    let answer: Value = serde_json::from_str(&read("answer.json")).unwrap();
    assert_eq!(
        [number(&answer["phase"]), number(&answer["periods"])],
        [0.25, 400.0]
    );
    let stop = &answer["rows"][0]["stop"];
    assert_eq!(
        [&stop["reason"], &stop["certain"]],
        [&serde_json::json!("upper_bound"), &serde_json::json!(false)]
    );
    let table = read("table.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().unwrap().clone();
    let place = |name: &str| header.iter().position(|column| column == name).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 1 + 101);
    let stopped = &rows[0];
    assert_eq!(
        [
            &stopped[place("r")],
            &stopped[place("k")],
            &stopped[place("x")]
        ],
        ["1.6", "", ""]
    );
    assert_eq!(
        [&stopped[place("stop")], &stopped[place("stop_certain")]],
        ["upper_bound", "false"]
    );
    // The next value does not go on from there.
    assert!(rows.iter().all(|row| &row[place("restarted")] == "true"));
    assert!(
        text.contains("\n1.8*  ") && text.contains("\n*: from the start of the case"),
        "{text}"
    );
    assert_eq!(
        stopped[place("stop_t")].parse::<f64>().unwrap(),
        number(&stop["t"])
    );
    let period = std::f64::consts::TAU / 4.847;
    for (k, row) in (300..).zip(&rows[1..]) {
        assert_eq!(row[place("k")], format!("{k}"));
        let t: f64 = row[place("t")].parse().unwrap();
        assert!((t - (0.25 + f64::from(k)) * period).abs() < 1e-9);
        // A column of doubles, each with its fraction.
        assert_eq!(&row[place("theta")], "0.0");
    }
}

/// A state with a taut cable is not legal where the cable is another in length, and each value
/// begins anew; where the force varies, none but the first does.
#[test]
fn a_diagram_tells_where_nothing_is_followed() {
    for (vary, anew) in [("r=1.5:1.6:3", true), ("nu=1:1.02:3", false)] {
        let out = snapload(directory().path())
            .args(["diagram", "--set=f_o=0.1", "--vary", vary, "--json", "-"])
            .args(["--periods", "30", "--keep", "16"])
            .assert()
            .success();
        let answer: Value = serde_json::from_slice(&out.get_output().stdout).unwrap();
        let restarted = answer["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(|row| &row["restarted"]);
        assert_eq!(restarted.collect::<Vec<_>>(), [true, anew, anew], "{vary}");
    }
}

/// What follows chaos begins with a state that rounding decides: if the start of the diagram is
/// another one in its last bit, the next motion stops at another time, although deviations hardly
/// grow in it.
#[test]
fn a_stop_after_chaos_is_not_certain() {
    let keys = ["body=point", "e=0.71", "nu=0.87", "omega=4.847", "f_o=1.6"];
    let rows = |y: f64| {
        let out = snapload(directory().path())
            .args(["diagram", "--vary", "r=1.5:1.52:2", "--json", "-"])
            .args(keys.map(|key| format!("--set={key}")))
            .arg(format!("--set=y={y}"))
            .assert()
            .success();
        let answer: Value = serde_json::from_slice(&out.get_output().stdout).unwrap();
        answer["rows"].clone()
    };
    let (rows, others) = (rows(0.1), rows(0.1_f64.next_up()));
    let [stop, other] = [&rows, &others].map(|rows| &rows[1]["stop"]);
    assert_eq!(
        [&rows[0]["stop"], &rows[1]["restarted"]],
        [&Value::Null, &Value::Bool(false)]
    );
    assert!(
        (number(&stop["t"]) - number(&other["t"])).abs() > 1.0,
        "{stop} {other}"
    );
    assert_eq!(
        [&stop["certain"], &other["certain"]],
        [&Value::Bool(false); 2]
    );
}

/// Where a motion stops after its first points, these are of no attractor: the table has no
/// exponent of it, as the JSON has none.
#[test]
fn a_motion_that_stops_has_no_exponent() {
    let d = directory();
    let keys = ["body=point", "e=0.71", "nu=0.87", "omega=4.847", "f_o=1.6"];
    let draw = |vary: &str, more: &[&str]| {
        snapload(d.path())
            .args(["diagram", "--vary", vary, "--phase", "0.25"])
            .args(keys.map(|key| format!("--set={key}")))
            .args(more)
            .assert()
            .success();
    };
    let options = ["--periods", "200", "--keep", "10", "--out", "table.csv"];
    draw("r=1.7:1.8:2", &options);
    let mut table = csv::Reader::from_path(d.path().join("table.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let place = |name: &str| header.iter().position(|column| column == name).unwrap();
    let (mut stopped, mut going) = (0, 0);
    for row in table.records().map(Result::unwrap) {
        let stops = !row[place("stop")].is_empty();
        assert_eq!(row[place("exponent")].is_empty(), stops);
        assert_eq!(row[place("exponent_se")].is_empty(), stops);
        stopped += usize::from(stops && !row[place("k")].is_empty());
        going += usize::from(!stops);
    }
    assert!(stopped > 0 && going == 11, "{stopped} {going}");
    // Four points tell no error of an exponent: the cell is empty, as that of other missing numbers.
    let few = ["--periods", "60", "--keep", "4", "--out", "few.csv"];
    draw("r=1.8:1.9:2", &few);
    let table = std::fs::read_to_string(d.path().join("few.csv")).unwrap();
    assert!(
        table.lines().count() > 4 && !table.contains("NaN"),
        "{table}"
    );
    // Without any point there is nothing to draw.
    let plot = ["--plot", "none.svg", "--show", "x,y"];
    draw("r=1.6:1.6001:2", &plot);
    let picture = std::fs::read_to_string(d.path().join("none.svg")).unwrap();
    assert!(picture.contains("nothing to draw"));
    // Of values that are on no axis the title has the range.
    assert!(picture.contains("r from 1.6 to 1.6001"));
    // Grey where it stops, with what is not known of it.
    draw("r=1.6:1.8:2", &["--plot", "some.svg"]);
    let picture = std::fs::read_to_string(d.path().join("some.svg")).unwrap();
    assert!(picture.contains("not certain at some values"));
}
