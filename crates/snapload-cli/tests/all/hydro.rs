//! `snapload hydro` and `snapload decay`: what they print, write and refuse.

use crate::common::{directory, listing, snapload};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::Path;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/examples");

/// A directory with the pontoon in it.
fn room() -> tempfile::TempDir {
    let room = directory();
    fs::copy(
        Path::new(EXAMPLES).join("pontoon.nc"),
        room.path().join("pontoon.nc"),
    )
    .unwrap();
    room
}

fn json(room: &tempfile::TempDir, name: &str) -> Value {
    serde_json::from_slice(&fs::read(room.path().join(name)).unwrap()).unwrap()
}

/// The pontoon of 98.4 t: heave 3.254 s, pitch 3.793 s; on two taut lines at 80 t it rests where it
/// was computed with 99.14 kN in each and sways in 7.295 s (independent code, `linear.json` and
/// `rests.json` of the library's tests).
#[test]
fn hydro_answers_in_a_few_lines_a_page_and_json() {
    let room = room();
    let lines = [
        "6,-10,2,-1.2,9.666436778876",
        "-6,-10,-2,-1.2,9.666436778876",
    ];
    snapload(room.path())
        .args([
            "hydro",
            "pontoon.nc",
            "--pairs",
            "6",
            "--out",
            "page.html",
            "--json",
            "all.json",
        ])
        .args([
            "--line", lines[0], "--line", lines[1], "--mass", "80000", "--centre", "0,-0.2",
        ])
        .args(["--inertia", "133333.3333333", "--hs", "1", "--tp", "4"])
        .assert()
        .success()
        .stdout(
            contains("58 frequencies")
                .and(contains("99.14, 99.14 kN"))
                .and(contains("surge 7.295 s"))
                .and(contains("Hs 1 m"))
                .and(contains("page.html")),
        );
    let page = fs::read_to_string(room.path().join("page.html")).unwrap();
    assert!(page.matches("<svg").count() == 5 && page.contains("Natural motions"));
    assert!(page.contains("snapload hydro pontoon.nc") && !page.contains("<script"));
    let all = json(&room, "all.json");
    let rest = &all["floating"]["rest"];
    assert!((rest["tension_n"][0].as_f64().unwrap() - 99_138.096_837).abs() < 1e-3);
    assert!((rest["natural"][0]["period_s"].as_f64().unwrap() - 7.295_485_709).abs() < 1e-6);
    assert!(all["quality"]["least_eigenvalue"].as_f64().unwrap() > -2e-9);
    assert_eq!(all["sea"].as_array().unwrap().len(), 2);

    // The memory that was written is read back, also after a program that begins texts with a mark,
    // and gives the same answers.
    let memory = fs::read_to_string(room.path().join("all.json")).unwrap();
    fs::write(room.path().join("all.json"), format!("\u{feff}{memory}")).unwrap();
    snapload(room.path())
        .args([
            "hydro",
            "pontoon.nc",
            "--memory",
            "all.json",
            "--json",
            "again.json",
        ])
        .assert()
        .success()
        .stdout(contains("given"));
    let again = json(&room, "again.json");
    for (a, b) in [
        (&again["memory"][3]["pole"][0], &all["memory"][3]["pole"][0]),
        (&again["added_mass_inf"][1][1], &all["added_mass_inf"][1][1]),
    ] {
        let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
        assert!((a - b).abs() <= 1e-15 * b.abs());
    }
}

/// Heave oscillates with the period of the eigenvalue; the table has a row for each step.
#[test]
fn decay_lists_its_swings() {
    let room = room();
    let output = snapload(room.path())
        .args([
            "decay",
            "pontoon.nc",
            "--pairs",
            "6",
            "--from",
            "0,0,0.1",
            "--duration",
            "20",
        ])
        .args(["--out", "decay.csv", "--json", "decay.json"])
        .assert()
        .success();
    // A row for each swing below the names of its columns, with the values of the JSON.
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    let mut rows = text.lines().skip_while(|row| !row.contains("from s"));
    let names = rows.next().expect("the names of the columns");
    assert!(
        names.contains("amplitude rad") && names.ends_with("% of critical"),
        "{text}"
    );
    let row: Vec<f64> = rows
        .next()
        .expect("a swing")
        .split_whitespace()
        .map(|cell| cell.parse().unwrap())
        .collect();
    let first = json(&room, "decay.json")["swings"][0].clone();
    let of = |key: &str| first[key].as_f64().unwrap();
    assert_eq!((row[0], row[1]), (0.0, 0.1));
    assert!((row[2] - of("period_s")).abs() < 1e-3);
    assert!((row[3] - 100.0 * of("damping_ratio")).abs() < 1e-2);
    let table = fs::read_to_string(room.path().join("decay.csv")).unwrap();
    assert_eq!(table.lines().count(), 402);
    assert!(table.starts_with("t_s,surge_m,heave_m,pitch_rad\n0.0,0.0,0.0,0.1\n"));
    let swings = json(&room, "decay.json")["swings"].clone();
    let period = swings[2]["period_s"].as_f64().unwrap();
    // 2π/1.6526, the eigenvalue of surge and pitch of `linear.json`.
    assert!((period - 3.802).abs() < 0.02, "{period}");
}

/// Times are the decimals that one writes, as those of other tables are, and the last is the end.
#[test]
fn decay_is_written_at_decimals_up_to_its_end() {
    let room = room();
    let times = |duration: &str, step: &str| {
        let times = ["--duration", duration, "--step", step];
        snapload(room.path())
            .args(["decay", "pontoon.nc", "--pairs", "6", "--out", "d.csv"])
            .args(times)
            .assert()
            .success();
        let table = fs::read_to_string(room.path().join("d.csv")).unwrap();
        let times = table.lines().skip(1).map(|row| row.split(',').next());
        times.map(|t| t.unwrap().to_owned()).collect::<Vec<_>>()
    };
    let tenths = ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7"];
    assert_eq!(times("0.7", "0.1"), tenths);
    assert_eq!(times("1", "0.3"), ["0.0", "0.3", "0.6", "0.9", "1.0"]);
}

/// Heave takes 3.25 s for a swing: within 1 s there is none, which
/// does not say that it never swings.
#[test]
fn decay_names_the_time_in_which_there_is_no_swing() {
    let room = room();
    let output = |duration: &str| {
        let decay = [
            "decay",
            "pontoon.nc",
            "--pairs",
            "6",
            "--duration",
            duration,
        ];
        let done = snapload(room.path()).args(decay).assert().success();
        String::from_utf8(done.get_output().stdout.clone()).unwrap()
    };
    let none = "no whole swing within";
    let short = output("1");
    assert!(short.contains(&format!("heave     {none} 1 s")), "{short}");
    assert!(!output("8").contains(none));
}

/// Displacements are from where the body floats: a weight of 98.4 t at an arm of 0.3 m turns it by
/// 98.4 · 9.81 · 0.3/682.7556 rad. Where a swing is larger than the one before,
/// the output gives the reason.
#[test]
fn decay_reports_where_displacements_are_measured_from() {
    let room = room();
    let output = |options: &[&str]| {
        let done = snapload(room.path())
            .args(["decay", "pontoon.nc", "--pairs", "6", "--duration", "30"])
            .args(options)
            .assert()
            .success();
        let text = String::from_utf8(done.get_output().stdout.clone()).unwrap();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let turned = (98.4 * 9.81 * 0.3_f64 / 682.7556).to_degrees();
    let aside = output(&["--centre", "0.3,-0.2", "--from", "0,0.3,0.05"]);
    assert!(aside.contains(&format!("{turned:.2}° of pitch")), "{aside}");
    assert!(aside.contains("a damping below zero"), "{aside}");
    let upright = output(&["--from", "0,0.3,0"]);
    assert!(
        !upright.contains("measured") && !upright.contains("below zero"),
        "{upright}"
    );
    // More than a tenth of the draft of 1.2 m from the file's position, or 0.05 rad of pitch, the
    // coefficients are those of another position.
    let far = format!("at {turned:.1}° of pitch from it; compute the file again");
    assert!(aside.contains(&far), "{aside}");
    let lower = (110.0 - 98.4) * 9.81 / 804.42;
    let heavy = output(&["--mass", "110000", "--from", "0,0.3,0"]);
    let far = format!("place of rest: the body floats without lines {lower:.3} m below");
    assert!(heavy.contains(&far), "{heavy}");
    assert!(!upright.contains("place of rest"), "{upright}");
}

/// A motion of more than half the draft of 1.2 m or more than 15 degrees is warned of, the highest
/// of a sea, too, and a smaller one is not; a body that is turned over is refused.
#[test]
fn motions_that_are_not_small_are_warned_of() {
    let room = room();
    let words = |options: &[&str]| {
        let done = snapload(room.path()).args(options).assert().success();
        let text = String::from_utf8(done.get_output().stdout.clone()).unwrap();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let decay = |from: &str| words(&["decay", "pontoon.nc", "--pairs", "6", "--from", from]);
    let far = decay("0,3,0.5");
    assert!(far.contains("3.00 m of heave, more than 0.60 m"), "{far}");
    assert!(far.contains("29 degrees of pitch, more than 15"), "{far}");
    assert!(!decay("0,0.5,0.2").contains("small"));
    let far = ["decay", "pontoon.nc", "--pairs", "6", "--from", "0,3,0"];
    let answer = words(&[&far[..], &["--json", "-"]].concat());
    let answer: serde_json::Value = serde_json::from_str(&answer).expect("JSON");
    let warnings = answer["warnings"].as_array().expect("warnings");
    let large = warnings.iter().filter(|row| row["what"] == "small heave");
    assert_eq!(large.count(), 1, "{warnings:?}");
    let sea = |hs: &str| {
        words(&[
            "hydro",
            "pontoon.nc",
            "--pairs",
            "6",
            "--hs",
            hs,
            "--tp",
            "4",
        ])
    };
    let rough = sea("1");
    assert!(
        rough.contains("small pitch: the highest motion of three hours"),
        "{rough}"
    );
    assert!(!sea("0.01").contains("small pitch"));
    let over = ["decay", "pontoon.nc", "--from", "0,0,5"];
    let refused = snapload(room.path()).args(over).assert().code(2);
    let error = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert!(error.contains("less than π/2 rad of pitch"), "{error}");
}

/// Errors name their cause and end with status 2, and no file is left behind.
#[test]
fn hydro_refuses_with_reasons() {
    let room = room();
    fs::write(
        room.path().join("cut.nc"),
        &fs::read(room.path().join("pontoon.nc")).unwrap()[..9000],
    )
    .unwrap();
    fs::write(room.path().join("no.json"), "{}").unwrap();
    for (words, reason) in [
        (
            &["hydro", "cut.nc"][..],
            "cut.nc: can not be read: as netCDF4",
        ),
        (&["hydro", "none.nc"], "none.nc"),
        (&["hydro", "pontoon.toml"], "Capytaine's .nc"),
        (&["hydro", "pontoon.nc", "--density", "1000"], "1025"),
        (
            &["hydro", "pontoon.nc", "--pairs", "99"],
            "--pairs = 99 is not allowed; allowed: a whole number, 1 <= pairs <= 20",
        ),
        (&["hydro", "pontoon.nc", "--mass=-1"], "above 0"),
        (
            &["hydro", "pontoon.nc", "--memory", "no.json"],
            "added_mass_inf",
        ),
        (&["hydro", "pontoon.nc", "--reference", "1"], "2 numbers"),
        (
            &["hydro", "pontoon.nc", "--reference", "0,-1"],
            "reference point's z is 0 in the file and -1 on the command line; they must agree",
        ),
        (
            &["decay", "pontoon.nc", "--depth", "10"],
            "inf in the file and 10 on the command line",
        ),
        (&["hydro", "pontoon.nc", "--hs", "1"], "--tp"),
        (
            &["decay", "pontoon.nc", "--from", "0,0,0"],
            "three finite numbers, not all of them 0",
        ),
        (
            &["decay", "pontoon.nc", "--step", "0"],
            "the step must be above 0",
        ),
    ] {
        snapload(room.path())
            .args(words)
            .args(["--json", "x.json"])
            .assert()
            .code(2)
            .stderr(contains(reason));
    }
    assert_eq!(listing(room.path()), ["cut.nc", "no.json", "pontoon.nc"]);
}

/// Seas and releases beyond all measure are refused in few digits, and so is a sea of which the
/// file's frequencies hold nothing.
#[test]
fn seas_and_releases_are_of_the_size_of_the_file() {
    let room = room();
    for (words, reason) in [
        (
            &["hydro", "pontoon.nc", "--hs", "1", "--tp", "0.1"][..],
            "a sea with some of its energy at the file's periods, 1.35 to 78.54 s",
        ),
        (
            &["hydro", "pontoon.nc", "--hs", "1e300", "--tp", "5"],
            "--hs = 1e300 is not allowed; allowed: a number, 0 < hs <= 100",
        ),
        (
            &["decay", "pontoon.nc", "--from", "1e300,0,0"],
            "--from = 1e300,0,0 is not allowed",
        ),
    ] {
        let refused = snapload(room.path()).args(words).assert().code(2);
        let error = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
        assert!(error.contains(reason) && error.len() < 250, "{error}");
    }
}
