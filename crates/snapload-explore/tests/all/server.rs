//! The numbers in the server's answers are those of the library.

use crate::common::serve;
use serde_json::{Value, json};
use snapload::analysis::{Uncertainty, no_progress, trusted_run};
use snapload::{Case, KEYS, Outcome, Parameters, Playback, State, Trajectory, named_cases};
use std::io::{BufRead, BufReader, Write};
use std::time::{Duration, Instant};

/// A column of numbers.
fn numbers(column: &Value) -> Vec<f64> {
    let numbers = column.as_array().unwrap().iter();
    numbers.map(|number| number.as_f64().unwrap()).collect()
}

fn case(entries: &[(&str, snapload::Value)]) -> Case {
    Case::new(Parameters::from_entries(entries.iter().cloned()).unwrap()).unwrap()
}

#[test]
fn the_page_comes_with_headers_that_keep_it_to_itself() {
    let server = serve();
    let page = server.get("/");
    assert_eq!(page.status, 200);
    assert!(
        page.head.contains("content-type: text/html"),
        "{}",
        page.head
    );
    assert!(String::from_utf8(page.body).unwrap().contains("<html"));
    for path in ["/", "/nothing", "/api/schema", "/api/run"] {
        let head = server.get(path).head;
        for line in [
            "content-security-policy: default-src 'self'; img-src 'self' data: blob:;",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cache-control: no-store",
        ] {
            assert!(head.contains(line), "{path}: {head}");
        }
    }
    // A browser asks for the icon with each change of the address.
    // For a picture that is opened by itself it looks elsewhere.
    for path in ["/icon.svg", "/favicon.ico"] {
        let icon = server.get(path).head;
        assert!(icon.contains("content-type: image/svg+xml"), "{icon}");
        assert!(icon.contains("cache-control: max-age=3600"), "{icon}");
        assert!(
            !icon.contains("no-store") && icon.contains("nosniff"),
            "{icon}"
        );
    }
}

#[test]
fn files_outside_the_page_are_not_served() {
    let server = serve();
    for path in [
        "/../Cargo.toml",
        "/../src/lib.rs",
        "/%2e%2e/Cargo.toml",
        "/..%2fCargo.toml",
        "//etc/passwd",
        "/./../Cargo.toml",
        "/index.html/",
        "/\\..\\Cargo.toml",
    ] {
        assert_eq!(server.get(path).status, 404, "{path}");
    }
}

#[test]
fn the_schema_has_every_key_and_makes_every_case() {
    let schema = serve().get("/api/schema").json();
    let names: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
    let answer = schema["keys"].as_array().unwrap();
    assert!(
        answer
            .iter()
            .map(|key| key["name"].as_str().unwrap())
            .eq(names)
    );
    for (case, answer) in named_cases().zip(schema["cases"].as_array().unwrap()) {
        assert_eq!(answer["code"], case.code);
        let values = answer["values"].as_object().unwrap();
        let entries = values.iter().map(|(key, value)| {
            let number = value.as_f64().map(snapload::Value::Number);
            (
                key,
                number.unwrap_or(value.as_bool().unwrap_or_default().into()),
            )
        });
        assert_eq!(Parameters::from_entries(entries).unwrap(), case.parameters);
    }
    assert_eq!(
        schema["start"],
        json!({ "name": "the standard case", "values": {} })
    );
}

#[test]
fn a_run_has_the_numbers_of_the_library() {
    let server = serve();
    for (values, entries) in [
        (json!({}), vec![]),
        (json!({ "f_o": 0.5 }), vec![("f_o", 0.5.into())]),
        (
            json!({ "f_o": 0.1, "stop_when_settled": false, "t_end": 30 }),
            vec![
                ("f_o", 0.1.into()),
                ("stop_when_settled", false.into()),
                ("t_end", 30.into()),
            ],
        ),
        (
            json!({ "a": 0.2, "b": 0.1, "theta": 0.1 }),
            vec![("a", 0.2.into()), ("b", 0.1.into()), ("theta", 0.1.into())],
        ),
        (
            json!({ "body": "point", "y": 0.2 }),
            vec![("body", "point".into()), ("y", 0.2.into())],
        ),
    ] {
        let case = case(&entries);
        let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress).unwrap();
        let answer = server.run(values);
        let impacts = &answer["impacts"];
        assert!(run.impacts().iter().map(|i| i.t).eq(numbers(&impacts["t"])));
        assert!(
            run.impacts()
                .iter()
                .map(|i| i.v_n)
                .eq(numbers(&impacts["v_n"]))
        );
        let known = trust
            .horizon
            .map_or(run.impacts().len(), |horizon| horizon.impact - 1);
        let digits = impacts["digits"].as_array().unwrap();
        assert!(
            trust
                .digits()
                .take(known)
                .eq(digits[..known].iter().map(|n| n.as_f64().unwrap()))
        );
        assert!(
            digits.len() == run.impacts().len()
                && digits[known..].iter().skip(2).all(Value::is_null)
        );
        assert_eq!(
            answer["horizon"]["t"].as_f64(),
            trust.horizon.map(|horizon| horizon.t)
        );
        assert_eq!(answer["horizon"]["certain"], trust.decides_the_end());
        assert_eq!(answer["end"]["t"], run.end().t);
        assert_eq!(answer["norms"]["rho3"], run.norms().rho3);
        assert_eq!(answer["values"]["r"], case.parameters().r);
        let starts = run.modes().iter().map(|mode| mode.t_start);
        assert!(starts.eq(numbers(&answer["modes"]["t_start"])));
        motion_is_of(&run, &answer["motion"]);
    }
}

/// Between impacts the motion is the run's; at an impact the position does not change, and the loss
/// of energy is the impact's.
fn motion_is_of(run: &Trajectory, answer: &Value) {
    let names = [
        "t", "x", "y", "theta", "vx", "vy", "vtheta", "T1", "T2", "energy",
    ];
    let columns = names.map(|name| numbers(&answer[name]));
    let row =
        |k: usize| names.map(|name| columns[names.iter().position(|n| *n == name).unwrap()][k]);
    let rows: Vec<[f64; 10]> = (0..columns[0].len()).map(row).collect();
    assert_eq!((rows[0][0], rows[rows.len() - 1][0]), (0.0, run.end().t));
    let mut playback = Playback::new(run);
    let mut jumps = 0;
    for pair in rows.windows(2) {
        let [before, after] = [pair[0], pair[1]];
        assert!(before[0] <= after[0]);
        let motion = playback.at(after[0]);
        let [_, _, _, _, _, _, _, t1, t2, energy] = after;
        if before[0] < after[0] && run.impacts().iter().any(|impact| impact.t == after[0]) {
            continue; // just before the impact
        }
        assert_eq!(after[1..7], motion.state.components());
        assert_eq!(
            [t1, t2, energy],
            [motion.tensions[0], motion.tensions[1], motion.energy]
        );
        if before[0] == after[0] {
            jumps += 1;
            assert_eq!(before[1..4], after[1..4]);
            let lost: Vec<f64> = run
                .impacts()
                .iter()
                .filter(|i| i.t == after[0])
                .map(|i| i.energy_lost)
                .collect();
            let lost: f64 = lost.iter().sum();
            assert!((before[9] - after[9] - lost).abs() < 1e-12);
        }
    }
    let mut instants: Vec<f64> = run.impacts().iter().map(|impact| impact.t).collect();
    instants.dedup();
    assert_eq!(jumps, instants.len());
}

#[test]
fn the_geometry_is_that_of_the_model() {
    let server = serve();
    let answer = server.run(json!({ "r": 2.0, "a": 0.2, "b": 0.1 }));
    // docs/model.md section 2: anchors at (±1, h + b), ends at (±a, b), h = sqrt(r^2 - (1 - a)^2).
    let h = (4.0_f64 - 0.64).sqrt();
    let cable = &answer["geometry"]["cables"][0];
    assert_eq!(numbers(&cable["arm"]), [0.2, 0.1]);
    let anchor = numbers(&cable["anchor"]);
    assert!((anchor[0] - 1.0).abs() < 1e-15 && (anchor[1] - h - 0.1).abs() < 1e-15);
    let body = json!({ "kind": "rigid", "shape": "rectangle", "a": 0.2, "b": 0.1 });
    assert_eq!(answer["geometry"]["body"], body);
}

#[test]
fn a_neighbour_starts_near_the_run_and_separates_at_the_reported_time() {
    let server = serve();
    let request = json!({ "values": { "f_o": 0.4 }, "ghost": 1e-6, "samples": 1000 });
    let answer = server.post("/api/run", &request).json();
    let ghost = &answer["ghost"];
    assert_eq!(
        (ghost["key"].as_str(), ghost["by"].as_f64()),
        (Some("x"), Some(1e-6))
    );
    let run = case(&[("f_o", 0.4.into())]).run();
    let other = case(&[("f_o", 0.4.into()), ("x", 1e-6.into())]).run();
    assert_eq!(numbers(&ghost["motion"]["x"])[0], 1e-6);
    motion_is_of(&other, &ghost["motion"]);
    let distance = |t: f64| {
        let [p, q]: [State; 2] = [run.at(t).state, other.at(t).state];
        let apart = [p.x - q.x, p.y - q.y, p.theta - q.theta].map(f64::abs);
        apart.into_iter().fold(0.0, f64::max)
    };
    let parts_at = ghost["parts_at"].as_f64().unwrap();
    assert!(distance(parts_at) > 1e-3 && distance(parts_at.next_down()) <= 1e-3);
    let earlier = (0..50_000).map(|k| parts_at * f64::from(k) / 5e4);
    assert!(earlier.into_iter().all(|t| distance(t) <= 1e-3));
    // The time does not depend on the times at which the motion is sent.
    for samples in [50, 20_000] {
        let request = json!({ "values": { "f_o": 0.4 }, "ghost": 1e-6, "samples": samples });
        let again = server.post("/api/run", &request).json();
        assert_eq!(again["ghost"]["parts_at"].as_f64(), Some(parts_at));
    }
}

#[test]
fn a_neighbour_beyond_the_cables_is_sought_on_the_other_side() {
    // With the right cable taut there is no free space to the left, and only rounding to the right.
    let server = serve();
    let request = json!({ "values": { "x": 0, "y": 0 }, "ghost": 1e-6 });
    let answer = server.post("/api/run", &request).json();
    assert_eq!(answer["ghost"]["key"], "y", "{}", answer["ghost_error"]);
}

#[test]
fn the_lines_that_make_the_same_run_do() {
    let answer = serve().run(json!({ "f_o": 0.31, "body": "rigid", "stop_when_sliding": true }));
    assert_eq!(
        answer["shell"],
        "snapload run --set f_o=0.31 --set stop_when_sliding=true"
    );
    let python = answer["python"].as_str().unwrap();
    assert!(python.contains("snapload.Case(f_o=0.31, stop_when_sliding=True).run()"));
}

/// A light body turns so quickly that rows a quarter of T apart do not show it.
#[test]
fn an_instant_between_the_rows_is_that_of_the_library() {
    let values = json!({ "inertia": 0.001, "stop_when_settled": false, "t_end": 30 });
    let keys = ["inertia", "stop_when_settled", "t_end"];
    let given = [0.001.into(), false.into(), 30.into()];
    let entries: Vec<_> = keys.into_iter().zip(given).collect();
    let run = case(&entries).run();
    let server = serve();
    for t in [0.3, 23.497, 28.811] {
        let answer = server.post("/api/instant", &json!({ "values": values, "t": t }));
        let exact = Playback::new(&run).at(t);
        let [one, two, ..] = exact.tensions;
        let expected = [exact.state.theta, one, two, exact.energy];
        let names = ["theta", "T1", "T2", "energy"];
        let answer = answer.json();
        assert_eq!(
            names.map(|name| answer["motion"][name][0].as_f64()),
            expected.map(Some)
        );
        let taut: Vec<usize> = exact.taut.iter().map(|cable| cable + 1).collect();
        assert_eq!(answer["taut"], json!(taut));
    }
}

#[test]
fn a_run_of_very_many_impacts_is_cut_and_reported_as_cut() {
    // Without loss and forcing the body bounces for ever.
    let answer = serve().run(json!({ "body": "point", "e": 1, "f_o": 0, "y": 1e-4, "t_end": 200 }));
    let (all, shown) = (&answer["cut"]["impacts"], &answer["cut"]["shown"]);
    assert!(all.as_u64().unwrap() > 10_000, "{all}");
    assert_eq!(
        (shown.as_u64(), numbers(&answer["impacts"]["t"]).len()),
        (Some(10_000), 10_000)
    );
    assert_eq!(numbers(&answer["motion"]["t"]).last(), Some(&200.0));
    let last = numbers(&answer["impacts"]["t"])[9_999];
    let until = answer["cut"]["until"].as_f64().unwrap();
    assert!(last < until && until < 200.0, "{last} {until}");
}

#[test]
fn an_impulse_passed_into_a_taut_cable_is_a_row_but_no_impact() {
    let sliding = json!({ "f_o": 0.27, "stop_when_settled": false, "t_end": 9 });
    let answer = serve().run(sliding);
    let speeds = numbers(&answer["impacts"]["v_n"]);
    let snaps = speeds.iter().filter(|v_n| **v_n > 0.0).count();
    assert!(snaps < speeds.len());
    assert_eq!(answer["snaps"].as_u64(), Some(snaps as u64));
}

#[test]
fn a_run_that_takes_too_long_is_refused_with_what_to_do() {
    let server = serve();
    let began = Instant::now();
    let endless = json!({ "values": { "f_o": 0, "stop_when_settled": false, "t_end": 1e6 } });
    let answer = server.post("/api/run", &endless);
    assert_eq!(answer.status, 422);
    let words = answer.error();
    for part in [
        "2 s of computing",
        "lower t_end",
        "snapload run --set f_o=0 --set t_end=1000000",
    ] {
        assert!(words.contains(part), "{words}");
    }
    assert!(began.elapsed() < Duration::from_secs(8));
}

#[test]
fn a_map_has_the_outcomes_of_its_cases() {
    let server = serve();
    let request = json!({
        "values": { "t_end": 20 },
        "x": { "key": "f_o", "low": 0.01, "high": 0.6, "count": 11 },
        "y": { "key": "r", "low": 0.8, "high": 2.0, "count": 5 },
    });
    let answer = server.post("/api/map", &request);
    assert_eq!(answer.status, 200);
    let text = String::from_utf8(answer.body).unwrap();
    let lines: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let [axes, chunks @ .., done] = lines.as_slice() else {
        panic!("{text}")
    };
    assert_eq!(*done, json!({ "done": true }));
    let (x, y) = (numbers(&axes["x"]), numbers(&axes["y"]));
    // The expected decimals: 0.01 + 2 (0.59 / 10).
    assert_eq!((x[0], x[2], x[10]), (0.01, 0.128, 0.6));
    let mut seen = vec![0; 55];
    for chunk in chunks {
        for (k, cell) in numbers(&chunk["cells"]).into_iter().enumerate() {
            let cell = cell as usize;
            seen[cell] += 1;
            let values = [("t_end", 20.0), ("f_o", x[cell % 11]), ("r", y[cell / 11])];
            let entries = values.map(|(key, value)| (key, value.into()));
            match Parameters::from_entries(entries).and_then(Case::new) {
                Ok(case) => {
                    let outcome = Outcome::of(&case);
                    assert_eq!(chunk["t"][k], outcome.end.t);
                    assert_eq!(chunk["rho3"][k], outcome.norms.rho3);
                    assert_eq!(chunk["impacts"][k], outcome.snaps());
                    assert_eq!(chunk["error"][k], Value::Null);
                }
                Err(error) => {
                    assert_eq!(chunk["error"][k], error.to_string());
                    assert_eq!(chunk["t"][k], Value::Null);
                }
            }
        }
    }
    assert!(seen.iter().all(|count| *count == 1), "{seen:?}");
}

/// Cases whose runs are cut short in lanes are run to their ends nevertheless.
#[test]
fn a_map_runs_long_cases_to_their_ends() {
    let server = serve();
    let request = json!({
        "values": { "body": "point", "e": 1, "f_o": 0 },
        "x": { "key": "y", "low": 1e-5, "high": 2e-5, "count": 2 },
        "y": { "key": "t_end", "low": 90, "high": 1200, "count": 2 },
    });
    let text = String::from_utf8(server.post("/api/map", &request).body).unwrap();
    let chunk: Value = serde_json::from_str(text.lines().nth(1).unwrap()).unwrap();
    let one = case(&[
        ("e", 1.into()),
        ("f_o", 0.into()),
        ("y", 1e-5.into()),
        ("t_end", 90.into()),
    ]);
    let outcome = Outcome::of(&one);
    assert!(outcome.snaps() > 20_000);
    assert_eq!(chunk["impacts"][0], outcome.snaps());
    assert_eq!(chunk["reason"][0], "end_time");
}

/// Two maps at one time are the maximum, so that a third would wait forever if closing a connection
/// did not end one.
#[test]
fn closing_the_connection_ends_a_map() {
    let server = serve();
    let axis =
        |key, low: f64, high: f64| json!({ "key": key, "low": low, "high": high, "count": 200 });
    let endless = json!({
        "values": { "body": "point", "e": 1, "y": 1e-4, "t_end": 1000 },
        "x": axis("f_o", 0.0, 1e-3),
        "y": axis("omega", 0.5, 2.0),
    });
    for _ in 0..2 {
        let kind = "Content-Type: application/json\r\n";
        let request = server.request("POST", "/api/map", kind, &endless.to_string());
        let mut stream = server.connect();
        stream.write_all(request.as_bytes()).unwrap();
        let mut lines = BufReader::new(stream).lines();
        assert!(lines.any(|line| line.unwrap().contains("\"x\":[")));
    }
    let began = Instant::now();
    let quick = json!({
        "x": { "key": "f_o", "low": 0.3, "high": 0.3, "count": 1 },
        "y": { "key": "omega", "low": 0.9, "high": 0.9, "count": 1 },
    });
    let answer = server.post("/api/map", &quick);
    assert!(
        String::from_utf8(answer.body)
            .unwrap()
            .ends_with("{\"done\":true}\n")
    );
    assert!(
        began.elapsed() < Duration::from_secs(10),
        "{:?}",
        began.elapsed()
    );
}
