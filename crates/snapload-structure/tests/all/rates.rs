//! Motions that are too fast to be followed for the duration of a run.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, Structure, compare_elastic};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// The example with keys of its body and its run in place of its own.
fn changed(body: &[(&str, f64)], run: &str) -> Structure {
    let is_own = |line: &&str| {
        !body
            .iter()
            .any(|(key, _)| line.starts_with(&format!("{key} =")))
    };
    let text: Vec<&str> = EXAMPLE.lines().filter(is_own).collect();
    let keys = body
        .iter()
        .map(|(key, value)| format!("{key} = {value:e}\n"));
    let keys = format!("[body]\n{}", keys.collect::<String>());
    let text = text.join("\n").replace("[body]", &keys);
    structure(&text.replace("[run]", &format!("[run]\n{run}")))
}

/// The refusal of a structure that is at rest.
fn refused(structure: Structure) -> String {
    let error = ModelAtRest::new(structure).expect_err("a refusal");
    error.to_string()
}

/// Damping that stops the body within the duration over three millions or less is refused, with the
/// most that is allowed: that many times inertia, or mass with added mass, over 600 s.
#[test]
fn damping_is_bounded_by_mass_and_duration() {
    let most = |inertia: f64| 3e6 / 600.0 * inertia;
    for (key, most) in [
        ("turning_damping", most(163_017.0)),
        ("linear_damping", most(72_452.0 + 144_904.0)),
    ] {
        let with = |damping: f64| changed(&[(key, damping)], "");
        assert!(ModelAtRest::new(with(0.99 * most)).is_ok(), "{key}");
        let error = refused(with(1.01 * most));
        assert!(error.starts_with(&format!("body.{key} = ")), "{error}");
        let shown = error.split("is not allowed; allowed: at most ").nth(1);
        let shown = shown.and_then(|rest| rest.split(' ').next());
        let shown: f64 = shown
            .and_then(|number| number.parse().ok())
            .expect("a bound");
        assert!(shown <= most && shown > 0.999 * most, "{error}");
        assert!(ModelAtRest::new(with(shown)).is_ok(), "{error}");
        // Half the duration allows twice as much.
        let half = changed(&[(key, 1.01 * most)], "duration = 300");
        assert!(ModelAtRest::new(half).is_ok(), "{key}");
    }
}

/// A body so light for its loads that it would swing or turn millions of times is refused with the
/// time for which it could be followed, and with the keys to be checked.
#[test]
fn a_body_too_light_for_its_loads_is_refused() {
    let light = [
        ("mass", 1e-6),
        ("added_mass", 0.0),
        ("moment_of_inertia", 1e-6),
    ];
    for (body, checks) in [
        (&light[..], "body.mass"),
        (&[("displaced_volume", 1e9)], "body.displaced_volume"),
        (&[("added_mass", 1e13)], "body.added_mass"),
        (&[("moment_of_inertia", 1e-6)], "body.moment_of_inertia"),
    ] {
        let error = refused(changed(body, ""));
        let has = |words: &str| assert!(error.contains(words), "{words}: {error}");
        has("run.duration = 600 is not allowed; allowed: at most ");
        has("check the units of ");
        has(checks);
    }
}

/// Lines that are a hundred million times as stiff oscillate ten thousand times as fast, which can
/// be followed for a moment and not for ten minutes.
#[test]
fn elastic_lines_too_stiff_for_the_duration_are_refused() {
    let of = |duration: &str, stiffer: f64| {
        let prepared = ModelAtRest::for_elastic_lines(changed(&[], duration)).expect("a case");
        compare_elastic(prepared, stiffer, f64::INFINITY, &no_progress)
    };
    let error = of("duration = 600", 1e8)
        .expect_err("a refusal")
        .to_string();
    assert!(error.contains("oscillates on its elastic lines"), "{error}");
    assert!(of("duration = 0.001", 1e8).is_ok());
}

/// A body moves past still water by at most the speed sqrt(P/D) at which its drag D u² is as large
/// as the load P: its buoyancy, and a constant force of nine times that. Its drag then slows it
/// down at the rate D u/m.
#[test]
fn drag_is_bounded_by_all_loads() {
    let buoyancy_n: f64 = 9.80665 * (1025.0 * 141.37 - 72_452.0);
    let text = EXAMPLE
        .replace("height = 2\n", "height = 0\n")
        .replace(
            "[body]",
            &format!(
                "[body]\ndrag_area = 1e6\nconstant_force = [0, {}]",
                9.0 * buoyancy_n
            ),
        )
        .replace("[run]", "[run]\nduration = 20000");
    let error = refused(structure(&text));
    assert!(error.contains("slowed down by its drag"), "{error}");
    let shown = error.split("allowed: at most ").nth(1);
    let shown = shown.and_then(|rest| rest.split(' ').next());
    let shown: f64 = shown
        .and_then(|number| number.parse().ok())
        .expect("a time");
    let rate = f64::sqrt(0.5 * 1025.0 * 1e6 * 10.0 * buoyancy_n) / (72_452.0 + 144_904.0);
    let most = 3e6 / rate;
    assert!(shown <= most && shown > 0.99 * most, "{error} {most}");
}
