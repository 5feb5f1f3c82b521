//! Rest on lines against results of independent code (`rests.json`): position, tensions, small
//! motions.

use crate::common::{hydro, reference};
use crate::linear::{body, file, given, near};
use nalgebra::{Complex, Matrix3, Vector3};
use serde_json::Value;
use snapload_hydro::{Body, Hydrodynamics, Line, Rest, Weight, rest};

fn lines(case: &Value) -> Vec<Line> {
    let pair =
        |value: &Value| -> [f64; 2] { serde_json::from_value(value.clone()).expect("a place") };
    let line = |line: &Value| Line {
        anchor_m: pair(&line["anchor"]),
        fairlead_m: pair(&line["fairlead_body"]),
        length_m: line["length"].as_f64().expect("a length"),
    };
    case["lines"]
        .as_array()
        .expect("lines")
        .iter()
        .map(line)
        .collect()
}

/// The position of rest on lines, tensions, slack lines, and small motions about it.
#[test]
fn rests_agree() {
    for (name, entry) in reference("rests.json").as_object().expect("rests") {
        let of = entry["body"].as_str().expect("a name");
        let hydro = hydro(file(of));
        let body = body(&entry["case"], &hydro);
        let lines = lines(&entry["case"]);
        let result = &entry["result"];
        let found = rest(&hydro, &body, &lines).expect(name);
        let q: [f64; 3] = serde_json::from_value(result["q"].clone()).expect("a place");
        for i in 0..3 {
            assert!(
                (found.q[i] - q[i]).abs() < 1e-11,
                "{name}: {} {q:?}",
                found.q
            );
        }
        let taut: Vec<usize> = serde_json::from_value(result["taut"].clone()).expect("lines");
        assert_eq!(
            found.taut.iter().map(|line| line + 1).collect::<Vec<_>>(),
            taut,
            "{name}"
        );
        let tensions: Vec<f64> =
            serde_json::from_value(result["tension"].clone()).expect("tensions");
        for (found, expected) in found.tension_n.iter().zip(&tensions) {
            near(*found, *expected, 1e-10, name);
        }
        small_motion(name, &found, result, &hydro, &body, of);
    }
}

fn small_motion(
    name: &str,
    found: &Rest,
    result: &Value,
    hydro: &Hydrodynamics,
    body: &Body,
    of: &str,
) {
    let (memory, inf) = given(of);
    let natural = &result["natural"];
    let (undamped, modes) = found.natural(hydro, body, &memory, &inf).expect("motions");
    let expected = natural["undamped"].as_array().expect("a list");
    assert_eq!(undamped.len(), expected.len(), "{name}");
    for row in expected {
        let omega = row["omega"].as_f64().expect("a number");
        let found = undamped
            .iter()
            .map(|motion| (motion.omega_rad_s - omega).abs());
        let off = found.fold(9.0, f64::min);
        assert!(
            off < 1e-9 * omega,
            "{name}: ω = {omega} is off by {off}, {undamped:?}"
        );
    }
    for row in natural["of_the_exponentials"].as_array().expect("a list") {
        let [re, im]: [f64; 2] = serde_json::from_value(row["eigenvalue"].clone()).expect("λ");
        let aim = Complex::new(re, im);
        let nearest = modes.iter().min_by(|a, b| {
            (a.eigenvalue - aim)
                .norm()
                .total_cmp(&(b.eigenvalue - aim).norm())
        });
        let mode = nearest.expect("a mode");
        assert!(
            (mode.eigenvalue - aim).norm() < 1e-9 * aim.norm(),
            "{name}: {aim} {mode:?}"
        );
        let ratio = row["damping_ratio"].as_f64().expect("a number");
        near(mode.damping_ratio, ratio, 1e-7, name);
    }
}

/// Three independent lines hold a body fast where their ends are as far apart as they are long and
/// their pulls balance weight and water; then it has no small motion.
#[test]
fn three_lines_hold_a_body_fast() {
    let hydro = hydro("pontoon-deep.nc");
    let weight = Weight {
        mass_kg: Some(80_000.0),
        inertia_kg_m2: Some(133_000.0),
        ..Weight::default()
    };
    let body = Body::new(&hydro, &weight).expect("a body");
    let line = |anchor: f64, fairlead: f64, length_m: f64| Line {
        anchor_m: [anchor, -10.0],
        fairlead_m: [fairlead, -1.2],
        length_m,
    };
    let lines = [
        line(6.0, 2.0, 9.666),
        line(-6.0, -2.0, 9.666),
        line(-6.0, 2.0, 11.8),
    ];
    let found = rest(&hydro, &body, &lines).expect("a place of rest");
    let mut left = body.constant_force - body.stiffness * found.q;
    let (sine, cosine) = found.q[2].sin_cos();
    for (line, pull) in lines.iter().zip(&found.tension_n) {
        let [x, z] = line.fairlead_m;
        let arm = [x * cosine + z * sine, z * cosine - x * sine];
        let [dx, dz] = [0, 1].map(|k| found.q[k] + arm[k] - line.anchor_m[k]);
        let apart = dx.hypot(dz);
        assert!(
            (apart - line.length_m).abs() < 1e-9 && *pull > 0.0,
            "{found:?}"
        );
        let n = [dx / apart, dz / apart];
        left -= Vector3::new(n[0], n[1], n[0] * arm[1] - n[1] * arm[0]) * *pull;
    }
    assert!(left.amax() < 1e-3, "{left}");
    assert_eq!((found.taut, found.motions.ncols()), (vec![0, 1, 2], 0));
}

/// If no line holds the body in surge, or its weight is more than the lines from below can balance,
/// a message says so.
#[test]
fn a_missing_place_of_rest_is_reported() {
    let hydro = hydro("sphere.nc");
    let mut body = Body::new(&hydro, &Weight::default()).expect("a body");
    let message = rest(&hydro, &body, &[]).expect_err("a refusal").to_string();
    assert!(message.contains("surge"), "{message}");
    // The body is half as heavy again as it can carry, on a line from below.
    body.constant_force[1] = -5.0 * body.stiffness[(1, 1)];
    let line = Line {
        anchor_m: [0.0, -40.0],
        fairlead_m: [0.0, -3.0],
        length_m: 35.0,
    };
    assert!(rest(&hydro, &body, &[line]).is_err());
    let short = Line {
        length_m: 0.0,
        ..line
    };
    let message = rest(&hydro, &body, &[short])
        .expect_err("a refusal")
        .to_string();
    assert!(message.contains("length of line 1"), "{message}");
}

/// A line from the side, of a kilometre, holds a push of half a newton, whatever constant moment
/// the body resists by its own stiffness: that is no force beside which the push would be rounding.
#[test]
fn a_moment_does_not_hide_the_pull_of_a_line() {
    let hydro = hydro("pontoon-deep.nc");
    let mut body = Body::new(&hydro, &Weight::default()).expect("a body");
    (body.mass_kg, body.stiffness) = (1e3, Matrix3::zeros());
    (body.stiffness[(1, 1)], body.stiffness[(2, 2)]) = (1e6, 1e12);
    body.constant_force = Vector3::new(0.5, 0.0, 1e9);
    let [x, z] = hydro.reference_m;
    let line = Line {
        anchor_m: [x - 1000.0, z],
        fairlead_m: [0.0, 0.0],
        length_m: 1000.0,
    };
    let found = rest(&hydro, &body, &[line]).expect("a place of rest");
    near(found.tension_n[0], 0.5, 1e-6, "the tension");
    near(found.q[2], 1e-3, 1e-6, "the pitch");
}

/// The moment of inertia of the file is that about the body's centre of gravity: it stays the same
/// wherever a given weight moves that centre, and for any weight.
#[test]
fn the_inertia_of_the_file_goes_with_the_centre_of_gravity() {
    let hydro = hydro("pontoon-deep.nc");
    let about_centre = |weight: Weight| {
        let body = Body::new(&hydro, &weight).expect("a body");
        body.inertia_about_centre_kg_m2()
    };
    let own = about_centre(Weight::default());
    assert!(own > 0.0);
    for centre in [[0.0, 1.5], [0.0, -1.0], [0.7, -0.3], [0.0, -400.0]] {
        for mass_kg in [None, Some(5e6), Some(8e4)] {
            let found = about_centre(Weight {
                mass_kg,
                centre_m: Some(centre),
                inertia_kg_m2: None,
            });
            // The term that is subtracted again is as large as m |G|².
            let square = centre[0] * centre[0] + centre[1] * centre[1];
            let rounding = 1e-14 * mass_kg.unwrap_or(1e5) * square;
            assert!(
                (found - own).abs() <= 1e-12 * own + rounding,
                "{centre:?}: {found} {own}"
            );
        }
    }
}
