//! Data that are probably mistakes: of units, of places.

use crate::afloat;
use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{Assessment, Lines, VerdictKind, Warning, assess, seas};
use std::sync::Arc;

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// A pontoon of 3 m x 1.6 m that displaces 33.21 t of water at rest, without a file, on two chains
/// of 7.916 m, which are taut there.
pub(crate) const PONTOON: &str = "[body]\nshape = \"rectangle\"\nwidth = 3\nheight = 1.6\ndisplaced_volume = 32.4\n\
    mass = 25000\nmoment_of_inertia = 24083\nposition = [0, -0.1]\n\
    [float]\ncentre_of_gravity = [0, -0.1]\ndamping = [0, 0, 8000]\n\
    [[line]]\nanchor = [5, -8]\nfairlead = [1.5, -0.9]\nlength = 7.916\nstiffness = 8.27e7\n\
    mass_per_length = 19.26\nbreaking_load = 911e3\n\
    [[line]]\nanchor = [-5, -8]\nfairlead = [-1.5, -0.9]\nlength = 7.916\nstiffness = 8.27e7\n\
    mass_per_length = 19.26\nbreaking_load = 911e3\n\
    [site]\ndepth = 8\n[wave]\nheight = 0.2\nperiod = 3.6\n[run]\nrestitution = 0.5\n";

fn assessed(text: &str) -> Assessment {
    assess(structure(text), 0, &no_progress).expect("an assessment")
}

fn warning(assessment: &Assessment, rule: &str) -> Option<Warning> {
    let mut warnings = assessment.warnings.iter();
    warnings.find(|w| w.rule == rule).cloned()
}

/// A mass in tonnes makes a cylinder lighter than air, 72.452 kg in 141.37 m³, and a moment of
/// inertia in t m² one that turns as if its mass were in its axis: r = sqrt(163.017/72452) = 0.047
/// m of 1.5 m.
#[test]
fn masses_and_inertias_in_other_units_leave_the_verdict_open() {
    let calm = EXAMPLE.replace("height = 2\n", "height = 0.5\n");
    let right = assessed(&calm);
    assert_eq!(right.verdict().standing, VerdictKind::Holds);
    for (from, to, rule, says) in [
        ("mass = 72452 ", "mass = 72.452 ", "density", "0.512 kg/m³"),
        ("= 163017", "= 163.017", "moment of inertia", "0.047 m"),
        ("= 163017", "= 163017e3", "moment of inertia", "47.434 m"),
    ] {
        assert_eq!(warning(&right, rule), None);
        let wrong = assessed(&calm.replace(from, to));
        let found = warning(&wrong, rule).expect(rule);
        assert!(found.message.contains(says), "{}", found.message);
        let verdict = wrong.verdict();
        assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
        assert!(
            verdict.words.contains(&format!("see {rule}")),
            "{}",
            verdict.words
        );
    }
    // Elastic lines do not decide what is a mistake.
    let sea = SEA
        .replace("[run]", "[run]\nduration = 300")
        .replace("hs = 1.2", "hs = 0.1");
    for (mass, is_open) in [("mass = 72452 ", false), ("mass = 72.452 ", true)] {
        for lines in [Lines::Inextensible, Lines::Elastic] {
            let text = sea.replace("mass = 72452 ", mass);
            let records = seas(structure(&text), 3, lines, &no_progress).expect("records");
            assert_eq!(records.is_open(), is_open, "{mass} {lines:?}");
        }
    }
}

#[test]
fn floating_bodies_in_other_units_leave_the_verdict_open() {
    let right = assessed(PONTOON);
    for (from, to, rule) in [
        ("mass = 25000", "mass = 25", "density"),
        ("= 24083", "= 24.083", "moment of inertia"),
    ] {
        assert_eq!(warning(&right, rule), None);
        let wrong = assessed(&PONTOON.replace(from, to));
        assert!(warning(&wrong, rule).is_some(), "{to}");
        assert_eq!(wrong.verdict().standing, VerdictKind::Open, "{to}");
    }
}

/// Rings, bodies with most of their mass in the middle, foam of 20 kg/m³ and platforms with a heavy
/// tower, whose radius of gyration is twice the half diagonal, are plausible.
#[test]
fn real_bodies_are_plausible() {
    let light = |mass: f64| format!("mass = {mass} ");
    for (mass, radius) in [
        (72452.0, 1.5),
        (72452.0, 0.3),
        (2827.0, 1.06),
        (72452.0, 3.0),
    ] {
        let inertia = mass * f64::powi(radius, 2);
        let text = EXAMPLE
            .replace("mass = 72452 ", &light(mass))
            .replace("= 163017", &format!("= {inertia}"))
            .replace("[run]", "[run]\nduration = 30");
        let assessment = assessed(&text);
        for rule in ["density", "moment of inertia"] {
            assert_eq!(warning(&assessment, rule), None, "{mass} {radius}");
        }
    }
}

/// Chains of 2 x 7.916 m with 19.26 kg/m weigh 3.0 kN: 3.7 % of the buoyancy that a mass of 25 t
/// leaves, and more than what one of 33.21 t leaves, where they would hang.
#[test]
fn the_weight_of_lines_is_compared_with_what_pulls_at_them() {
    let weight_kn = 2.0 * 7.916 * 19.26 * 9.80665e-3;
    // Without tension no line holds the body in surge.
    let text = format!("{PONTOON}start = [0, -0.1]\n");
    let with = |mass: &str| assessed(&text.replace("mass = 25000", mass));
    assert_eq!(warning(&with("mass = 25000"), "light lines"), None);
    for mass in ["mass = 33210", "mass = 33209.9999"] {
        let found = warning(&with(mass), "light lines").expect(mass);
        let says = format!("their weight in air {weight_kn:.1} kN, more than the net buoyancy");
        assert!(found.message.contains(&says), "{}", found.message);
        assert!(
            found.message.contains("of that of the body"),
            "{}",
            found.message
        );
        assert_eq!(found.message.matches('%').count(), 1, "{}", found.message);
    }
}

/// A line without a distance between its ends has no ratio to it.
#[test]
fn a_line_from_a_point_to_itself_is_not_infinitely_long() {
    let text = EXAMPLE.replacen("anchor = [3.593, -10]", "anchor = [1.061, -4.561]", 1);
    let found = warning(&assessed(&text), "long lines").expect("a warning");
    assert!(
        found.message.contains("line 1 although its anchor"),
        "{}",
        found.message
    );
    assert!(!found.message.contains("inf"), "{}", found.message);
}

/// Where much damping has to be added to a memory, the tensions are those of a body that the water
/// damps more than it does.
#[test]
fn a_memory_that_is_far_from_passive_leaves_the_verdict_open() {
    let wave = "[wave]\nheight = 0.2\nperiod = 5";
    let text = afloat::case(0.0, 2.4, 9.666, wave, "duration = 60\ntransient = 0");
    for (least, is_open) in [(-0.05, false), (-0.6, true)] {
        let mut structure = afloat::structure(&text);
        let coefficients = Arc::make_mut(structure.afloat.as_mut().expect("coefficients"));
        coefficients.report.fit.blocks[0].damped = true;
        coefficients.report.fit.blocks[0].least = least;
        coefficients.report.warnings.push(snapload_hydro::Warning {
            what: "passivity",
            message: String::new(),
        });
        let assessment = assess(structure, 0, &no_progress).expect("an assessment");
        let of_memory = warning(&assessment, "passivity").expect("a warning");
        assert_eq!(of_memory.leaves_open, is_open);
        assert!(of_memory.decided_by.is_none());
    }
}

/// So it is where a given memory feeds energy into the motion. In heave
/// Re K̂(iω) = A (1/(1 + ω²) − 0.1 c/(0.01 + ω²)), which at ω = 0 is A (1 − 10 c), while its largest
/// magnitude is between 0.7 A and A.
#[test]
fn a_given_memory_that_is_far_from_passive_leaves_the_verdict_open() {
    let wave = "[wave]\nheight = 0.2\nperiod = 5";
    let text = afloat::case(0.0, 2.4, 9.666, wave, "duration = 60\ntransient = 0");
    let path = std::env::temp_dir().join(format!("snapload-feeds-{}.json", std::process::id()));
    let text = text.replace("pairs = 6", &format!("memory = {path:?}"));
    for (c, is_open) in [(0.09, None), (0.105, Some(false)), (0.15, Some(true))] {
        let heave = |pole: f64, residue: f64| {
            let mut rows = [[[0.0; 2]; 3]; 3];
            rows[1][1][0] = residue;
            serde_json::json!({ "pole": [pole, 0.0], "residue": rows })
        };
        let memory = serde_json::json!({
            "added_mass_inf": [[1e4, 0.0, 0.0], [0.0, 3e4, 0.0], [0.0, 0.0, 2e4]],
            "memory": [heave(-1.0, 5e3), heave(-0.1, -5e3 * c)],
        });
        std::fs::write(&path, memory.to_string()).expect("a file");
        let assessment = assess(afloat::structure(&text), 0, &no_progress);
        let of_memory = warning(&assessment.expect("an assessment"), "passivity");
        assert_eq!(of_memory.map(|warning| warning.leaves_open), is_open);
    }
    std::fs::remove_file(path).expect("the file");
}
