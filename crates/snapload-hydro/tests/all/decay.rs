//! The swings of a decay: of a freedom that nothing holds they are those about where it stays.

use crate::common::{hydro, reference};
use crate::linear::{body, file, given, near};
use nalgebra::{Complex, Vector3};
use snapload_hydro::{Decay, Memory, Turn, decay, swings};
use std::f64::consts::PI;

/// Surge has no stiffness: from wherever the pontoon is let go its swings are the same, and damped
/// as the eigenvalue of surge and pitch says, that other code made.
#[test]
fn a_place_that_nothing_holds_does_not_change_the_swings() {
    let entry = &reference("linear.json")["pontoon"];
    let hydro = hydro(file("pontoon"));
    let body = body(&entry["case"], &hydro);
    let (memory, inf) = given("pontoon");
    let of = |x: f64, freedom: usize| {
        let start = Vector3::new(x, 0.0, 0.1);
        let motion = decay(&body, &memory, &inf, start, [60.0, 0.01], &|_| ()).expect("a decay");
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
        // Let go from rest it turns every half period, each time on the other side.
        let turn = |k: u32| {
            let t_s = f64::from(k) * PI / omega;
            let side = if k.is_multiple_of(2) { 0.2 } else { -0.2 };
            let height = about + side * (-decrement * t_s).exp();
            Turn { t_s, height }
        };
        let motion = Decay {
            t_s: Vec::new(),
            q: Vec::new(),
            turns: [(0..13).map(turn).collect(), Vec::new(), Vec::new()],
            comes_back: [about == 0.0, true, true],
        };
        let found = swings(&motion, 0);
        assert!(found.len() > 3);
        for (k, swing) in found.iter().enumerate() {
            let amplitude = 0.2 * (-decrement * PI / omega * k as f64).exp();
            near(swing.amplitude.abs(), amplitude, 1e-12, "the amplitude");
            assert_eq!(swing.amplitude > 0.0, k % 2 == 0);
            near(swing.damping_ratio, damping, 1e-9, "the damping ratio");
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
        let motion = decay(&body, &memory, &inf, start, [60.0, 0.05], &|_| ()).expect("a decay");
        assert_eq!(swings(&motion, 0), []);
    }
}

/// The swings are those of the motion, however far the rows of its table are apart. Heave without
/// memory is the oscillator of textbooks: ω0² = c/m, 2 ζ ω0 = b/m, and a half period of
/// π/(ω0 √(1 − ζ²)). With memory there is no closed form, but the swings are the same.
#[test]
fn rows_far_apart_leave_the_swings_as_they_are() {
    let entry = &reference("linear.json")["pontoon"];
    let mut body = body(&entry["case"], &hydro(file("pontoon")));
    let (memory, inf) = given("pontoon");
    let start = Vector3::new(0.0, 1.0, 0.0);
    let none = Memory::default();
    let mass = body.mass[(1, 1)] + inf[(1, 1)];
    let omega = (body.stiffness[(1, 1)] / mass).sqrt();
    for damping in [0.006, 0.1] {
        body.damping[(1, 1)] = 2.0 * damping * omega * mass;
        let period = 2.0 * PI / (omega * (1.0 - damping * damping).sqrt());
        for row_s in [0.05, 1.0, 1.4, 4.0, 50.0] {
            let motion = decay(&body, &none, &inf, start, [100.0, row_s], &|_| ());
            let found = swings(&motion.expect("a decay"), 1);
            assert!(found.len() > 12);
            for (k, swing) in found.iter().enumerate() {
                let (from_s, what) = (0.5 * period * k as f64, "a swing without memory");
                assert!((swing.from_s - from_s).abs() < 1e-5 * period, "{swing:?}");
                near(swing.period_s, period, 1e-5, what);
                near(swing.damping_ratio, damping, 1e-4, what);
            }
        }
    }
    body.damping[(1, 1)] = 0.0;
    let of = |row_s: f64| {
        let motion = decay(&body, &memory, &inf, start, [40.0, row_s], &|_| ());
        swings(&motion.expect("a decay"), 1)
    };
    let close = of(0.001);
    for row_s in [0.05, 0.5, 2.0, 4.0] {
        assert!(close.len() > 5 && of(row_s).len() == close.len());
        for (far, close) in of(row_s).iter().zip(&close) {
            near(far.period_s, close.period_s, 1e-5, "the period");
            near(far.damping_ratio, close.damping_ratio, 1e-4, "the damping");
        }
    }
}

/// The error is about the time that is not allowed, and not about another one.
#[test]
fn times_that_are_not_possible_are_named() {
    let entry = &reference("linear.json")["pontoon"];
    let body = body(&entry["case"], &hydro(file("pontoon")));
    let (memory, inf) = given("pontoon");
    let start = Vector3::new(0.0, 1.0, 0.0);
    for (times, says) in [
        ([-5.0, 0.05], "the duration in s = -5"),
        ([f64::NAN, 0.05], "the duration in s = NaN"),
        (
            [1e5, 0.05],
            "0 to 50000 is allowed, a million steps of 0.05 s",
        ),
        ([40.0, 1e-300], "the step in s = 1e-300"),
        ([40.0, 0.0], "the step in s = 0: the step must be above 0"),
        ([40.0, f64::INFINITY], "the step in s = inf"),
        // A million rows, but more steps than can be computed.
        ([1e9, 1e3], "followed for at most"),
    ] {
        let motion = decay(&body, &memory, &inf, start, times, &|_| ());
        let error = motion.expect_err("a refusal").to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// The end of the duration has a row of its own where no step ends there: the state is the same as
/// on other rows.
#[test]
fn the_end_has_a_row() {
    let entry = &reference("linear.json")["pontoon"];
    let body = body(&entry["case"], &hydro(file("pontoon")));
    let (memory, inf) = given("pontoon");
    let of = |row_s: f64| {
        let start = Vector3::new(0.0, 1.0, 0.1);
        decay(&body, &memory, &inf, start, [4.0, row_s], &|_| ()).expect("a decay")
    };
    let (uneven, even) = (of(0.3), of(0.5));
    assert_eq!((uneven.t_s.len(), even.t_s.len()), (15, 9));
    assert_eq!((uneven.t_s[14], even.t_s[8]), (4.0, 4.0));
    let ends = [uneven.q[14], even.q[8]];
    assert!((ends[0] - ends[1]).norm() < 1e-10, "{ends:?}");
}

/// However far the rows are apart, the turns are those up to the duration.
#[test]
fn turns_do_not_depend_on_the_rows() {
    let entry = &reference("linear.json")["pontoon"];
    let body = body(&entry["case"], &hydro(file("pontoon")));
    let (memory, inf) = given("pontoon");
    let of = |row_s: f64| {
        let start = Vector3::new(0.0, 1.0, 0.1);
        let motion = decay(&body, &memory, &inf, start, [40.0, row_s], &|_| ());
        motion.expect("a decay").turns
    };
    let known = of(0.05);
    assert!(known[1].len() > 20);
    for row_s in [50.0, 30.0] {
        for (turns, known) in of(row_s).iter().zip(&known) {
            assert_eq!(turns.len(), known.len(), "{row_s}");
            for (turn, known) in turns.iter().zip(known) {
                assert!((turn.t_s - known.t_s).abs() < 1e-4, "{turn:?} {known:?}");
            }
        }
    }
}
