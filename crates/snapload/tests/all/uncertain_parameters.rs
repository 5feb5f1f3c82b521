//! Trust where a parameter is uncertain that changes forces, cables or limits, besides the start.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::analysis::{
    HorizonCause, LimitDerivatives, Uncertainty, Unfinished, no_progress, trusted_run,
};
use snapload::{Case, Limit, Parameters, Stop, Value};
use std::f64::consts::TAU;

/// A mass that the wave carries to and fro once, near the second cable in the middle of the flight.
fn carried() -> Parameters {
    Parameters {
        a: 0.0,
        b: 0.0,
        inertia: None,
        r: 1.5,
        nu: 0.0,
        omega: TAU,
        f_o: 3.0,
        x: 0.2954,
        y: 0.6,
        vy: 0.5,
        t_end: 1.0,
        stop_when_settled: false,
        ..Parameters::STANDARD
    }
}

/// The times are those of the linearised motion.
const FIRST_ORDER: f64 = 1e-4;
/// A tolerance that ends trust nowhere, where only other events matter.
const ANY_ERROR: f64 = 1.0;

fn with(parameters: &Parameters, key: &str, number: f64) -> Parameters {
    parameters.over(|name, value| if name == key { number } else { value })
}

fn number(parameters: &Parameters, key: &str) -> f64 {
    match parameters.get(key) {
        Some(Value::Number(number)) => number,
        _ => panic!("{key} is a number"),
    }
}

fn uncertain(key: &'static str, size: f64, tolerance: f64) -> Uncertainty {
    let mut uncertainty = Uncertainty {
        tolerance,
        ..Uncertainty::default()
    };
    uncertainty.set(key, size).unwrap();
    uncertainty
}

/// The number of impacts and the end of a run.
fn outcome(parameters: &Parameters) -> Option<(usize, Stop)> {
    let run = Case::new(*parameters).ok()?.run();
    Some((run.impacts().len(), run.end().reason))
}

/// The value nearest to a case's own at which it ends otherwise, up
/// to another one at which it does.
fn turning_point(parameters: &Parameters, key: &str, other: f64) -> f64 {
    let own = outcome(parameters);
    let ends_alike = |value: f64| outcome(&with(parameters, key, value)) == own;
    let (mut alike, mut unlike) = (number(parameters, key), other);
    assert!(!ends_alike(unlike));
    for _ in 0..60 {
        let middle = 0.5 * (alike + unlike);
        let end = if ends_alike(middle) {
            &mut alike
        } else {
            &mut unlike
        };
        *end = middle;
    }
    unlike
}

/// Neighbours are taken into account up to three standard deviations of a parameter, of which its
/// uncertainty is √3: a run is certain if they end like it, and the end of trust lies before the
/// first event that one of them does not share. A wave whose force is off by a part shifts the body
/// in the middle of a flight, not at its ends; the length of the cables changes where they end.
#[test]
fn neighbours_differ_within_a_flight_by_forces_and_cables() -> Result<(), Unfinished> {
    for (key, other) in [("f_o", 3.03), ("r", 1.495), ("omega", 6.2)] {
        let own = carried();
        let case = Case::new(own)?;
        let value = number(&own, key);
        let away = (turning_point(&own, key, other) - value).abs();
        for (part, certain) in [(1.03, false), (3.0, false), (0.9, true), (0.1, true)] {
            let size = part * away / 3.0_f64.sqrt();
            let (_, trust) = trusted_run(&case, &uncertain(key, size, ANY_ERROR), &no_progress)?;
            assert_eq!(trust.decides_the_end(), certain, "{key} {part} {away}");
            if let Some(horizon) = trust.horizon {
                assert_eq!(
                    horizon.cause,
                    HorizonCause::NearMiss { cable: 1 },
                    "{key} {part}"
                );
                let farthest = value + (other - value).signum() * part * away;
                let run = Case::new(with(&own, key, farthest))?.run();
                let first = run.impacts().first().map(|impact| impact.t);
                let latest = first.unwrap() + FIRST_ORDER;
                assert!(horizon.t <= latest, "{key} {part}");
            }
        }
    }
    Ok(())
}

/// A fast wave moves neighbours to and fro 64 times within one flight, and in each of 64 equal
/// parts of it as far as in all others.
#[test]
fn neighbours_differ_between_equal_parts_of_a_flight() -> Result<(), Unfinished> {
    let own = Parameters {
        omega: 400.0,
        f_o: 900.0,
        x: 0.396849164,
        t_end: 1.00531,
        ..carried()
    };
    let away = turning_point(&own, "f_o", 909.0) - own.f_o;
    for part in [1.03, 3.0] {
        let uncertainty = uncertain("f_o", part * away / 3.0_f64.sqrt(), ANY_ERROR);
        let (_, trust) = trusted_run(&Case::new(own)?, &uncertainty, &no_progress)?;
        assert!(!trust.decides_the_end(), "{part} {away}");
    }
    Ok(())
}

/// A cable that closes slowly, after a wave has brought it near once before: all neighbours close
/// it in the same rise of its gap.
#[test]
fn a_slow_last_rise_is_no_near_miss() -> Result<(), Unfinished> {
    let own = Parameters {
        omega: 8.865,
        f_o: 3.835,
        x: 0.315539821,
        y: 0.694,
        vx: 0.0175,
        vy: 0.525,
        e: 0.5,
        t_end: 1.4496,
        ..carried()
    };
    let size = 1e-5;
    for part in [-1.0, -0.5, 0.5, 1.0] {
        let neighbour = with(&own, "y", own.y + part * size * 3.0_f64.sqrt());
        assert_eq!(outcome(&neighbour), outcome(&own), "{part}");
    }
    let uncertainty = uncertain("y", size, ANY_ERROR);
    let (_, trust) = trusted_run(&Case::new(own)?, &uncertainty, &no_progress)?;
    assert_eq!(trust.horizon, None);
    Ok(())
}

/// Neighbours differ likewise at the upper bound, which the highest point of a flight nearly
/// reaches; it is at the
/// height of the anchors, which the length of the cables changes. The largest effect along the
/// flight counts wherever the run comes near.
#[test]
fn neighbours_reach_a_limit_within_a_flight() -> Result<(), Unfinished> {
    let start = Parameters {
        x: 0.0,
        f_o: 0.01,
        nu: 80.0,
        omega: 6.0,
        y: 0.0,
        vy: TAU / 6.0,
        t_end: TAU / 4.0,
        ..carried()
    };
    let (bound, below) = (1.25_f64.sqrt(), 1.5e-4);
    let top = Case::new(start)?.run().norms().y_max;
    let own = Parameters {
        y: bound - below - top,
        ..start
    };
    let case = Case::new(own)?;
    for (key, other) in [("omega", 5.98), ("nu", 81.0), ("r", 1.499)] {
        let value = number(&own, key);
        let away = (turning_point(&own, key, other) - value).abs();
        for (part, certain) in [(1.03, false), (3.0, false), (0.1, true)] {
            let size = part * away / 3.0_f64.sqrt();
            let (_, trust) = trusted_run(&case, &uncertain(key, size, ANY_ERROR), &no_progress)?;
            assert_eq!(trust.decides_the_end(), certain, "{key} {part} {away}");
            if let Some(horizon) = trust.horizon {
                assert_eq!(horizon.cause, HorizonCause::StopRule, "{key} {part}");
                let end = Case::new(with(&own, key, value + (other - value).signum() * away))?;
                assert!(horizon.t <= end.run().end().t + FIRST_ORDER, "{key} {part}");
            }
        }
    }
    Ok(())
}

/// The largest second derivative, by divided differences, of the derivative by a key of a limit's
/// quantity along a first flight, and the bound on it. Where the highest corner or the sign of the
/// rotation changes, the quantity is not smooth, and nothing is compared.
fn second_derivative(case: &Parameters, key: &'static str, limit: Limit) -> [f64; 2] {
    let case = Case::new(*case).expect("a legal case");
    let found = LimitDerivatives::in_flight(&case, key, limit, 1000);
    let branch = |theta: f64| [theta.sin() > 0.0, theta.cos() > 0.0];
    let smooth = |at: &&[[f64; 2]]| branch(at[0][0]) == branch(at[2][0]);
    let second =
        |at: &[[f64; 2]]| (at[0][1] - 2.0 * at[1][1] + at[2][1]).abs() / found.part.powi(2);
    let largest = found.at.windows(3).filter(smooth).map(second);
    [largest.fold(0.0, f64::max), found.bound]
}

/// Each term of the bound counts alone in one of the first cases, which come close to it: the
/// force, the spin, the rotation and the size.
#[test]
fn the_derivative_of_a_quantity_by_a_key_changes_within_its_bound() {
    let p = Parameters {
        a: 0.3,
        b: 0.3,
        nu: 1.0,
        omega: 1.5,
        y: 0.8,
        ..Parameters::STANDARD
    };
    let spinning = Parameters {
        y: 0.6,
        theta: 0.2,
        vtheta: 9.0,
        t_end: 0.05,
        ..p
    };
    let short = Parameters {
        t_end: 0.005,
        ..spinning
    };
    for (case, key) in [
        (p, "f_o"),
        (short, "vtheta"),
        (spinning, "theta"),
        (spinning, "a"),
    ] {
        let [largest, bound] = second_derivative(&case, key, Limit::UpperBound);
        assert!(largest > 0.5 * bound, "{key}: {largest} {bound}");
    }
    for limit in Limit::ALL {
        for case in [p, spinning] {
            for key in [
                "r", "a", "b", "inertia", "f_o", "nu", "omega", "x", "y", "theta", "vx", "vy",
                "vtheta",
            ] {
                let [largest, bound] = second_derivative(&case, key, limit);
                assert!(
                    largest <= bound * (1.0 + 1e-5) + 1e-5,
                    "{limit:?}, {key}: {largest} {bound}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(1999),
        ..ProptestConfig::default()
    })]

    /// No neighbour of a certain run has another number of impacts or another end.
    #[test]
    fn neighbours_of_certain_runs_end_like_them(
        key in prop::sample::select(vec!["f_o", "nu", "omega", "r", "e", "a"]),
        (size, f_o, nu, omega) in (-4.0..-2.0, 0.1..3.0, 0.0..1.5, 0.5..8.0),
        (r, x, y) in (1.1..2.5, -0.3..0.3, 0.1..0.6),
        (vx, vy, t_end) in (-0.5..0.5, -0.5..0.5, 0.5..3.0),
        at in prop::collection::vec(-1.0..1.0, 10),
    ) {
        let own = Parameters {
            a: if key == "a" { 0.3 } else { 0.0 },
            inertia: (key == "a").then_some(0.05),
            f_o, nu, omega, r, x, y, vx, vy, t_end,
            ..carried()
        };
        let Ok(case) = Case::new(own) else { return Ok(()) };
        let value = number(&own, key);
        let size = 10.0_f64.powf(size) * value;
        let Ok((run, trust)) = trusted_run(&case, &uncertain(key, size, 1e-3), &no_progress) else {
            return Ok(());
        };
        if !trust.decides_the_end() { return Ok(()) }
        let own_outcome = (run.impacts().len(), run.end().reason);
        for part in at.into_iter().chain([-1.0, 1.0]) {
            if let Some(found) = outcome(&with(&own, key, value + part * size)) {
                prop_assert_eq!(found, own_outcome, "{} {}", key, part);
            }
        }
    }
}
