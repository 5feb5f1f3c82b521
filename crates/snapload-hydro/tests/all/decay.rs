//! The swings of a decay: of a freedom that nothing holds they are those about where it stays.

use crate::common::{hydro, reference};
use crate::linear::{body, file, given, near};
use nalgebra::{Complex, Vector3};
use snapload_hydro::{Decay, decay, swings};
use std::f64::consts::PI;

/// Surge has no stiffness: from wherever the pontoon is let go its swings are the same, and damped as
/// the eigenvalue of surge and pitch says, that other code made.
#[test]
fn a_place_that_nothing_holds_does_not_change_the_swings() {
    let entry = &reference("linear.json")["pontoon"];
    let hydro = hydro(file("pontoon"));
    let body = body(&entry["case"], &hydro);
    let (memory, inf) = given("pontoon");
    let of = |x: f64, freedom: usize| {
        let start = Vector3::new(x, 0.0, 0.1);
        let motion = decay(&body, &memory, &inf, start, [60.0, 0.01]).expect("a decay");
        swings(&motion, freedom)
    };
    let values = entry["eigenvalues_of_the_exponentials"].as_array();
    let [re, im] = values
        .expect("a list")
        .iter()
        .map(|row| serde_json::from_value::<[f64; 2]>(row.clone()).expect("a pair"))
        .filter(|[_, im]| *im > 0.5)
        .max_by(|a, b| a[0].total_cmp(&b[0]))
        .expect("a swing");
    let value = Complex::new(re, im);
    let (damping, period) = (-re / value.norm(), 2.0 * PI / im);
    let first = of(0.1, 0);
    assert!(first.len() > 20, "{first:?}");
    for x in [0.1, -0.017, 0.5, -100.0] {
        for (swing, known) in of(x, 0).iter().zip(&first) {
            near(swing.amplitude, known.amplitude, 1e-8, "the amplitude");
            near(
                swing.damping_ratio,
                known.damping_ratio,
                1e-6,
                "the damping",
            );
        }
        // Later swings are those of the slowest decay alone.
        for freedom in [0, 2] {
            let late = &of(x, freedom)[8..];
            assert!(late.len() > 10);
            for swing in late {
                near(swing.damping_ratio, damping, 2e-2, "the damping ratio");
                near(swing.period_s, period, 1e-3, "the period");
            }
        }
    }
}

/// About any place, and with any damping, amplitudes are those of the swing that was made.
#[test]
fn amplitudes_are_measured_from_where_it_swings_about() {
    for (about, damping) in [(0.0, 0.01_f64), (0.4, 0.01), (-3.0, 0.1), (0.4, 0.3)] {
        let omega = 2.0;
        let decrement = damping / (1.0 - damping * damping).sqrt() * omega;
        let t_s: Vec<f64> = (0..4000).map(|k| f64::from(k) * 0.005).collect();
        // Let go from rest: x' = 0 at t = 0.
        let at = |t: &f64| {
            let (sine, cosine) = (omega * t).sin_cos();
            about + 0.2 * (-decrement * t).exp() * (cosine + decrement / omega * sine)
        };
        let motion = Decay {
            q: t_s.iter().map(|t| Vector3::new(at(t), 0.0, 0.0)).collect(),
            t_s,
            comes_back: [about == 0.0, true, true],
        };
        let found = swings(&motion, 0);
        assert!(found.len() > 3);
        for (k, swing) in found.iter().enumerate() {
            let amplitude = 0.2 * (-decrement * PI / omega * k as f64).exp();
            near(swing.amplitude.abs(), amplitude, 1e-4, "the amplitude");
            assert_eq!(swing.amplitude > 0.0, k % 2 == 0);
            near(swing.damping_ratio, damping, 1e-3, "the damping ratio");
        }
    }
}

/// What stays where it was let go does not swing, whatever rounding says.
#[test]
fn what_stays_does_not_swing() {
    let entry = &reference("linear.json")["pontoon"];
    let body = body(&entry["case"], &hydro(file("pontoon")));
    let (memory, inf) = given("pontoon");
    for x in [1e-3, 0.5, 700.0] {
        let start = Vector3::new(x, 0.0, 0.0);
        let motion = decay(&body, &memory, &inf, start, [60.0, 0.05]).expect("a decay");
        assert_eq!(swings(&motion, 0), []);
    }
}
