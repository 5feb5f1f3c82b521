//! Structures: the server's answers are those of `snapload assess` and `snapload elastic`.

use crate::common::{Running, serve_changed_structure, serve_structure};
use serde_json::{Value, json};
use snapload::Entries;
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, STRUCTURE, Structure, Water, Wave, assess, compare_elastic};

/// A cylinder on two lines of chain, for a minute and a half of a wave.
const CYLINDER: &str = r#"
[body]
shape = "circle"
width = 3
displaced_volume = 141.37
mass = 72452
added_mass = 144904
moment_of_inertia = 163017
position = [0, -3.5]
[[line]]
anchor = [3.593, -10]
fairlead = [1.061, -4.561]
length = 6
type = "studless chain"
diameter = 0.038
[[line]]
anchor = [-3.593, -10]
fairlead = [-1.061, -4.561]
length = 6
type = "studless chain"
diameter = 0.038
[site]
depth = 10
[wave]
height = 2
period = 6
[run]
restitution = 0.5
duration = 90
[design]
least_share = 0.1
"#;

fn serve() -> Running {
    serve_structure("cylinder.toml", CYLINDER)
}

/// The structure, changed as `--set` does.
fn structure(set: &[&str]) -> Structure {
    let mut entries = Entries::parse(&STRUCTURE, "cylinder.toml", CYLINDER).unwrap();
    set.iter().for_each(|change| entries.set(change).unwrap());
    Structure::from_entries(&entries).unwrap()
}

fn ask(server: &Running, path: &str, body: Value) -> Value {
    let answer = server.post(path, &body);
    assert_eq!(answer.status, 200, "{}", answer.error());
    answer.json()
}

fn numbers(column: &Value) -> Vec<f64> {
    let numbers = column.as_array().unwrap().iter();
    numbers.map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn a_run_agrees_with_assess() {
    let server = serve();
    let set = ["wave.height=2.5", "line.2.length=6.01"];
    let request = json!({ "case": { "set": set }, "neighbours": true, "window": [60.0, 80.0] });
    let answer = ask(&server, "/api/structure/run", request);
    let direct = assess(structure(&set), 40, &no_progress).unwrap();
    let mut expected = direct.to_json("cylinder.toml");
    for list in ["snaps", "neighbour_peaks_n"] {
        expected.as_object_mut().unwrap().remove(list);
    }
    assert_eq!(answer["assessment"], expected);
    assert_eq!(answer["summary"], direct.summary("cylinder.toml"));
    assert_eq!(answer["standing"], direct.verdict().standing.words());
    assert_eq!(answer["rebound"], direct.rebound_text());
    assert_eq!(
        answer["nearby_waves"].as_str(),
        direct.waves_text().as_deref()
    );
    assert_eq!(
        answer["shell"],
        "snapload assess cylinder.toml --set 'wave.height=2.5' --set 'line.2.length=6.01'"
    );
    let counted = direct.snaps.iter().filter(|snap| snap.counts());
    let times: Vec<f64> = counted.map(|snap| snap.t_s).collect();
    assert_eq!(numbers(&answer["snaps"]["t"]), times);
    // The motion is drawn in single precision.
    let motion = &answer["motion"];
    let t = numbers(&motion["t"]);
    assert!((t[0], *t.last().unwrap()) == (60.0, 80.0) && t.is_sorted());
    let at: Vec<usize> = (0..t.len()).step_by(97).collect();
    let exact = direct.motion_at(&at.iter().map(|&row| t[row]).collect::<Vec<_>>());
    for (row, exact) in at.into_iter().zip(exact.unwrap()) {
        let drawn = ["x", "z", "theta"].map(|name| motion[name][row].as_f64().unwrap());
        let [x, z] = exact.place_m;
        for (drawn, exact) in drawn.into_iter().zip([x, z, exact.theta_rad]) {
            assert!(
                (drawn - exact).abs() < 1e-6 * exact.abs().max(1.0),
                "{drawn} {exact}"
            );
        }
    }
    // Between these rows an instant can be asked for.
    let request = json!({ "case": { "set": set }, "t": 70.123 });
    let answer = ask(&server, "/api/structure/instant", request);
    let exact = &direct.motion_at(&[70.123]).unwrap()[0];
    for (drawn, newtons) in answer["motion"]["tensions"]
        .as_array()
        .unwrap()
        .iter()
        .zip(&exact.tension_n)
    {
        let kilonewtons = drawn[0].as_f64().unwrap();
        assert!((kilonewtons - newtons / 1e3).abs() < 1e-6 * newtons.max(1.0) / 1e3);
    }
    let lines = 1..=exact.tension_n.len();
    let taut: Vec<usize> = lines
        .filter(|line| exact.tension_n[line - 1] > 0.0)
        .collect();
    assert_eq!(answer["taut"], json!(taut));
}

#[test]
fn without_neighbours_the_verdict_is_the_same() {
    let server = serve();
    let single = ask(&server, "/api/structure/run", json!({ "case": {} }));
    let with_neighbours = json!({ "case": {}, "neighbours": true });
    let with_neighbours = ask(&server, "/api/structure/run", with_neighbours);
    for part in ["verdict", "lines", "warnings"] {
        assert_eq!(
            single["assessment"][part],
            with_neighbours["assessment"][part]
        );
    }
    assert_eq!(single["rebound"], Value::Null);
    let window = numbers(&single["window"]);
    assert!(0.0 <= window[0] && window[0] < window[1] && window[1] <= 90.0);
}

#[test]
fn elastic_lines_agree_with_elastic() {
    let request = json!({ "case": { "set": ["wave.period=5"] }, "window": [30.0, 50.0] });
    let answer = ask(&serve(), "/api/structure/elastic", request);
    let prepared = ModelAtRest::for_elastic_lines(structure(&["wave.period=5"])).unwrap();
    let direct = compare_elastic(prepared, 1.0, 0.02, &no_progress).unwrap();
    let expected = direct.to_json("cylinder.toml");
    assert_eq!(answer["elastic"]["lines"], expected["lines"]);
    assert_eq!(answer["elastic"]["end"], expected["end"]);
    let t = numbers(&answer["motion"]["t"]);
    assert!(t[0] >= 30.0 && *t.last().unwrap() <= 50.0 && t.len() > 700);
    let tension = answer["motion"]["tensions"][0].as_array().unwrap();
    let sample = direct
        .elastic
        .samples
        .iter()
        .find(|sample| sample.t_s == t[0]);
    let exact = sample.unwrap().tension_n[0] / 1e3;
    assert!((tension[0].as_f64().unwrap() - exact).abs() < 1e-6 * exact.max(1.0));
}

/// Names and values are quoted, and changes that were made before the page was opened are included.
#[test]
fn the_lines_to_copy_are_those_of_the_whole_case() {
    let before = ["wave.height=2.5", "line.2.length=6.01"];
    let server = serve_changed_structure("my pier's; x.toml", CYLINDER, &before);
    let set = [
        "line.length=6.02",
        "line.2.length=6.03",
        "project.name=O'Brien",
    ];
    let answer = ask(
        &server,
        "/api/structure/run",
        json!({ "case": { "set": set } }),
    );
    assert_eq!(
        answer["shell"],
        "snapload assess \"my pier's; x.toml\" --set 'wave.height=2.5' --set 'line.2.length=6.01' \
         --set 'line.length=6.02' --set 'line.2.length=6.03' --set \"project.name=O'Brien\""
    );
    // Of a key that is given twice the last value counts, after that of all lines.
    assert_eq!(
        answer["python"],
        "import snapload\nsnapload.Structure.from_toml(\"my pier's; x.toml\", {\"wave.height\": 2.5, \
         \"line.length\": 6.02, \"line.2.length\": 6.03, \"project.name\": \"O'Brien\"}).assess()"
    );
    let changes = [&before[..], &set].concat();
    let direct = assess(structure(&changes), 0, &no_progress).unwrap();
    assert_eq!(answer["assessment"]["lines"], direct.to_json("")["lines"]);
}

/// A slider needs finite ends: those of every key that can be one number.
#[test]
fn every_key_of_numbers_has_a_finite_range() {
    let schema = serve().get("/api/structure").json();
    let tables = schema["tables"].as_array().unwrap().iter();
    let keys = tables.flat_map(|table| table["keys"].as_array().unwrap());
    let ranged = keys.filter(|key| {
        let kind = key["kind"]["type"].as_str().unwrap();
        ["number", "count", "per_freedom"].contains(&kind)
    });
    let names: Vec<&str> = ranged
        .map(|key| {
            let [low, high] = ["low", "high"].map(|end| key["kind"][end].as_f64().unwrap());
            assert!(low < high && high.is_finite(), "{key}");
            key["name"].as_str().unwrap()
        })
        .collect();
    assert!(names.contains(&"added_mass") && names.contains(&"height"));
}

#[test]
fn another_water_takes_the_place_of_that_of_the_file() {
    let server = serve();
    let sea = json!({ "water": "sea", "set": ["sea.hs=1", "sea.tp=6", "sea.seed=3", "run.duration=400"] });
    let first = ask(&server, "/api/structure/run", json!({ "case": sea }));
    assert_eq!(
        (&first["preview"], &first["lasts_s"]),
        (&json!(true), &json!(400.0))
    );
    assert_eq!(first["assessment"]["end"]["t_s"], 300.0);
    assert_eq!(
        first["shell"],
        "snapload assess case.toml  # save case.toml first, with Export"
    );
    let whole = ask(
        &server,
        "/api/structure/run",
        json!({ "case": sea, "whole": true }),
    );
    assert_eq!(
        (&whole["preview"], &whole["assessment"]["end"]["t_s"]),
        (&json!(false), &json!(400.0))
    );
    // Once it is known, another interval of it is not that of its beginning.
    let later = json!({ "case": sea, "window": [320.0, 390.0] });
    let later = ask(&server, "/api/structure/run", later);
    assert_eq!(later["preview"], false);
    assert_eq!(numbers(&later["window"]), [320.0, 390.0]);
    // The exported file is the case that is shown.
    let mut named = sea.clone();
    let set = named["set"].as_array_mut().unwrap();
    set.push(json!(r#"project.name='Pier "A" \ east'"#));
    let file = server.post("/api/structure/export/case.toml", &json!({ "case": named }));
    let saved = Structure::parse("case.toml", std::str::from_utf8(&file.body).unwrap()).unwrap();
    assert_eq!(saved.project.name, r#"Pier "A" \ east"#);
    let direct = assess(saved, 0, &no_progress).unwrap();
    assert_eq!(whole["assessment"]["verdict"], json!(direct.verdict()));
    let still = ask(
        &server,
        "/api/structure/run",
        json!({ "case": { "water": "still" } }),
    );
    assert_eq!(
        (&still["waves"], &still["snaps"]["all"]),
        (&json!([]), &json!(0))
    );
}

#[test]
fn a_file_that_is_opened_is_described_and_run() {
    let server = serve();
    let file =
        json!({ "name": "mine.toml", "text": CYLINDER.replace("height = 2", "height = 1.5") });
    let answer = ask(&server, "/api/structure", file.clone());
    assert_eq!(answer["given"]["wave.height"], 1.5);
    assert_eq!(
        (&answer["lines"], &answer["water"]),
        (&json!(2), &json!("wave"))
    );
    assert_eq!(numbers(&answer["given"]["line.2.anchor"]), [-3.593, -10.0]);
    let run = ask(
        &server,
        "/api/structure/run",
        json!({ "case": { "file": file } }),
    );
    let direct = assess(structure(&["wave.height=1.5"]), 0, &no_progress).unwrap();
    assert_eq!(run["assessment"]["verdict"], json!(direct.verdict()));
    let kind = ask(&server, "/api/case", file);
    assert_eq!(kind["structure"], true);
}

#[test]
fn refusals_are_those_of_the_command() {
    let server = serve();
    let refused = |case: Value| {
        let answer = server.post("/api/structure/run", &json!({ "case": case }));
        assert_eq!(answer.status, 422);
        (
            answer.json()["key"].as_str().unwrap_or("").to_owned(),
            answer.error(),
        )
    };
    let (key, message) = refused(json!({ "set": ["wave.height=60"] }));
    assert_eq!(key, "wave.height");
    assert!(
        message.contains("wave.height = 60: allowed is 0 <= height <= 50")
            || message.contains("0 <= height <= 50"),
        "{message}"
    );
    let (key, _) = refused(json!({ "set": ["line.1.length=3"] }));
    assert!(key.contains("line") || key.contains("body"), "{key}");
    for key in ["file", "memory"] {
        let float = format!("{CYLINDER}[float]\n{key} = \"/etc/passwd\"\n");
        let (named, message) = refused(json!({ "file": { "name": "f.toml", "text": float } }));
        assert_eq!(named, format!("float.{key}"));
        let begin = "start the program in the folder of its files: snapload explore f.toml";
        assert!(
            message.contains("/etc/passwd") && message.contains(begin),
            "{message}"
        );
    }
    let none = crate::common::serve();
    let answer = none.post("/api/structure/run", &json!({ "case": {} }));
    assert_eq!(answer.status, 422);
    assert!(answer.error().contains("no structure is open"));
    let window = server.post(
        "/api/structure/run",
        &json!({ "case": {}, "window": [5, 2] }),
    );
    assert_eq!(window.status, 422);
}

#[test]
fn the_page_of_a_structure_is_in_front_where_it_was_begun_with_one() {
    let title = |server: &Running, path: &str| String::from_utf8(server.get(path).body).unwrap();
    assert!(title(&serve(), "/").contains("a structure"));
    assert!(!title(&serve(), "/index.html").contains("<title>snapload explore: a structure"));
    assert!(!title(&crate::common::serve(), "/").contains("<title>snapload explore: a structure"));
}

#[test]
fn the_design_note_is_of_the_case_that_is_shown() {
    let server = serve();
    let case = json!({ "case": { "set": ["wave.height=2.2", "run.duration=60"] } });
    let page = server.post("/api/structure/export/note.html", &case);
    assert_eq!(page.status, 200);
    let direct = assess(
        structure(&["wave.height=2.2", "run.duration=60"]),
        0,
        &no_progress,
    )
    .unwrap();
    let page = String::from_utf8(page.body).unwrap();
    assert!(page.contains(&direct.verdict().words));
    assert!(
        page.contains("--set &#39;wave.height=2.2&#39;")
            || page.contains("--set 'wave.height=2.2'")
    );
    assert_eq!(
        server.post("/api/structure/export/x.html", &case).status,
        404
    );
}

#[test]
fn other_waves_are_those_of_the_note() {
    let answer = ask(&serve(), "/api/structure/waves", json!({ "case": {} }));
    let (heights, periods) = (numbers(&answer["heights_m"]), numbers(&answer["periods_s"]));
    let cells = answer["cells"].as_array().unwrap();
    assert_eq!(cells.len(), heights.len() * periods.len());
    assert_eq!(answer["utilisation"], true);
    // A cell is of the wave of its label, which has three digits.
    for value in heights.iter().chain(&periods) {
        assert_eq!(format!("{value:.2e}").parse(), Ok(*value));
    }
    // The wave of the case is among them, run for as many periods and judged after the usual ten.
    let own = |values: &[f64], value: f64| {
        let apart = |v: &f64| (v - value).abs() < 1e-9;
        values.iter().position(apart).unwrap()
    };
    let (i, j) = (own(&periods, 6.0), own(&heights, 2.0));
    let duration_s = answer["length"].as_f64().unwrap() * periods[i];
    let mut same = structure(&[&format!("run.duration={duration_s}")]);
    same.water = Water::Wave(Wave {
        height_m: heights[j],
        period_s: periods[i],
    });
    let direct = assess(same, 0, &no_progress).unwrap();
    let largest = direct.outcome.utilisations(&structure(&[]));
    let largest = largest.into_iter().flatten().fold(0.0, f64::max);
    let cell = &cells[i * heights.len() + j];
    assert_eq!(
        (cell["value"].as_f64(), &cell["kind"]),
        (Some(largest), &json!("known"))
    );
    let sea = json!({ "case": { "water": "still" } });
    assert_eq!(serve().post("/api/structure/waves", &sea).status, 422);
}

/// A body half under water that floats on textbook values of its section.
const BARGE: &str = include_str!("../data/barge.toml");

#[test]
fn a_body_that_floats_on_textbook_values_can_be_opened() {
    let server = crate::common::serve();
    let file = json!({ "name": "barge.toml", "text": BARGE });
    let answer = ask(&server, "/api/structure", file.clone());
    assert_eq!(answer["floats"], true);
    let run = ask(
        &server,
        "/api/structure/run",
        json!({ "case": { "file": file } }),
    );
    let direct = assess(
        Structure::parse("barge.toml", BARGE).unwrap(),
        0,
        &no_progress,
    );
    assert_eq!(
        run["assessment"]["verdict"],
        json!(direct.unwrap().verdict())
    );
}

#[test]
fn an_answer_that_comes_in_lines_is_the_same() {
    let lines = |server: &Running, path: &str, question: Value| -> Vec<Value> {
        let answer = server.post(path, &question);
        assert!(answer.head.contains("application/x-ndjson"));
        let text = String::from_utf8(answer.body).unwrap();
        let read = |line: &str| serde_json::from_str(line).unwrap();
        text.lines().map(read).collect()
    };
    let server = serve();
    let case = json!({ "set": ["wave.height=2.3", "run.duration=60"] });
    let path = "/api/structure/export/note.html";
    let answer = lines(&server, path, json!({ "case": case, "progress": true }));
    let last = answer.last().unwrap();
    let plain = server.post(path, &json!({ "case": case }));
    assert_eq!(
        last["answer"].as_str().unwrap(),
        std::str::from_utf8(&plain.body).unwrap()
    );
    let bad = json!({ "case": { "set": ["wave.height=60"] }, "progress": true });
    let refused = lines(&server, path, bad.clone());
    assert_eq!(refused[0]["error"]["key"], "wave.height");
    let refused = lines(&server, "/api/structure/run", bad);
    assert_eq!(refused[0]["error"]["key"], "wave.height");
}
