//! Runs that can not go on: time that stands still, and numbers that overflow.

use crate::agrees_with_closed_forms::string;
use snapload::{
    Body, Cable, Drag, Forcing, Harmonic, Rules, Shape, Simulation, State, Stop, System, Trajectory,
};

fn begun(system: System, rules: Rules, start: State) -> Simulation {
    Simulation::new(system, rules, 0.0, start).expect("a legal start")
}

fn at(y: f64) -> State {
    State {
        y,
        ..State::default()
    }
}

/// A mass that falls by half a unit snaps at t = 1 with v = 1; the bounces that follow take
/// 2 e/(1 − e) together. If no snap is slow enough to stick, it stands still then. On one cable, and
/// on two under a force of no amplitude, where every step before is a bounce.
#[test]
fn snaps_that_never_stick_end_where_time_stands_still() {
    let beside = Cable::new([3.0, 0.0], [0.0, 0.0], 9.0);
    for (e, two) in [(0.5, false), (0.5, true), (0.9, false), (0.9, true)] {
        let mut system = string(1.0, 1.0, e);
        if two {
            system.cables.push(beside);
            system
                .forcing
                .harmonics
                .push(Harmonic::ellipse(0.0, 0.5, 1.0));
        }
        let rules = Rules::until(50.0);
        let run = Trajectory::record(begun(system, rules, at(-0.5)));
        let end = run.end();
        let all = 1.0 + 2.0 * e / (1.0 - e);
        assert_eq!(end.reason, Stop::Standstill, "{e} {two}");
        assert!((end.t - all).abs() < 1e-12, "{e} {two}: {}", end.t);
        assert!((end.state.y + 1.0).abs() < 1e-15, "{e} {two}");
    }
}

/// A snap that is slow enough sticks, even where the time stood still before, here over 2500 snaps
/// from about t = 1 + 2 e/(1 − e) = 199 on.
#[test]
fn snaps_that_stick_after_time_stands_still_end_nothing() {
    let rules = Rules {
        v_stick: 1e-25,
        ..Rules::until(500.0)
    };
    let run = Trajectory::record(begun(string(1.0, 1.0, 0.99), rules, at(-0.5)));
    assert_eq!(run.end().reason, Stop::EndTime);
    assert!((run.end().state.y + 1.0).abs() < 1e-15);
}

/// Makes some steps, if there are so many, of which each ends, with finite numbers.
fn makes_steps(what: &str, mut simulation: Simulation) -> Option<Stop> {
    for _ in 0..3000 {
        if simulation.step().is_none() {
            break;
        }
        let numbers = simulation.state().components();
        assert!(numbers.into_iter().all(f64::is_finite), "{what}");
        assert!(simulation.y_max().is_finite(), "{what}");
    }
    simulation.stop()
}

/// A mass on a cable of 1e-13 that turns 1.6e12 times in a unit of time: the coefficients of its
/// series, of which the last is of the order of (v/r)^28, are beyond the doubles. So are those of
/// the same mass that is a million million times as fast, and of much stronger forces.
#[test]
fn no_step_hangs_where_coefficients_overflow() {
    let rules = |t_end: f64| Rules {
        v_stick: 1e-6,
        ..Rules::until(t_end)
    };
    let swinging = |vx: f64| State { vx, ..at(-1.0) };
    let short = State {
        vx: 1.0,
        ..at(-1e-13)
    };
    let simulation = begun(string(1e-13, 1.0, 0.5), Rules::until(1e-12), short);
    assert_eq!(makes_steps("short", simulation), Some(Stop::Standstill));
    let fast = begun(string(1.0, 1.0, 0.5), rules(5.0), swinging(1e15));
    assert_eq!(makes_steps("fast", fast), Some(Stop::Standstill));
    for weight in [1e10, 1e30, 1e200] {
        let pulled = begun(string(1.0, weight, 0.5), rules(5.0), swinging(1.0));
        let stop = makes_steps(&format!("weight {weight:e}"), pulled);
        let gets_on = weight < 1e30;
        assert!(
            gets_on || stop == Some(Stop::Standstill),
            "{weight}: {stop:?}"
        );
    }
    for [linear, quadratic] in [[1e300, 0.0], [-1e300, 0.0], [0.0, 1e300], [0.0, -1e300]] {
        let mut system = string(1.0, 1.0, 0.5);
        system.drag = Some(Drag {
            linear,
            quadratic,
            turning: 0.0,
            water: vec![],
        });
        for start in [swinging(1.0), State { vx: 1.0, ..at(0.0) }] {
            let dragged = begun(system.clone(), rules(5.0), start);
            let what = format!("drag {linear:e} {quadratic:e}");
            assert_eq!(
                makes_steps(&what, dragged),
                Some(Stop::Standstill),
                "{what}"
            );
        }
    }
}

/// Many sinusoids of frequencies or sizes, or at times, at which nothing is left of their phases.
#[test]
fn no_step_hangs_under_sinusoids_that_are_too_large() {
    let wave = |size: f64, omega: f64| Harmonic::ellipse(size, 0.3, omega);
    let eleven = |of: &dyn Fn(f64) -> Harmonic| (1..12).map(|k| of(f64::from(k))).collect();
    for (what, t, harmonics) in [
        ("frequency", 0.0, eleven(&|k| wave(0.04, 1e300 / k))),
        ("size", 0.0, eleven(&|k| wave(1e300, 0.3 * k))),
        ("one size", 0.0, vec![wave(1e300, 0.3)]),
        ("time", 1e20, eleven(&|k| wave(0.04, 0.3 * k))),
    ] {
        let cable = |side: f64| Cable::new([side, 1.2], [0.2 * side, 0.0], 1.6);
        let system = System {
            body: Body::rigid(Shape::Circle { radius: 0.2 }, 0.02),
            cables: vec![cable(-1.0), cable(1.0)],
            forcing: Forcing {
                constant: [0.0, -1.0].into(),
                harmonics,
            },
            drag: None,
            floating: None,
            restitution: 0.6,
        };
        let rules = Rules {
            v_stick: 1e-6,
            ..Rules::until(t + 1e6)
        };
        let begun = Simulation::new(system, rules, t, State::default()).expect("a legal start");
        let stop = makes_steps(what, begun);
        let gets_on = ["size", "one size"].contains(&what);
        assert!(
            gets_on || stop == Some(Stop::Standstill),
            "{what}: {stop:?}"
        );
    }
}
