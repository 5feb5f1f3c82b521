//! What is refused before it can do harm, and what is bounded where it can not be refused.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{
    Counter, Ensemble, TrustMonitor, Uncertainty, Unfinished, no_progress, on_all_threads_until,
    trusted_run,
};
use snapload::{
    Body, Cable, Case, Exponential, Floating, Outcome, Parameters, PrescribedTaut, Rules, Shape,
    Simulation, StartError, State, System, TautSet,
};
use std::convert::Infallible;
use std::sync::atomic::{AtomicUsize, Ordering};

const STILL: Rules = Rules {
    limits: snapload::LimitBounds::none(),
    settled_below: None,
    sliding_above: None,
    t_end: 3.0,
    max_impacts: u64::MAX,
    v_stick: 1e-6,
};

/// The key that a start is refused for.
fn refused(system: System, rules: Rules) -> Option<&'static str> {
    match Simulation::new(system, rules, 0.0, State::default()) {
        Err(StartError::NotAllowed { key, .. }) => Some(key),
        _ => None,
    }
}

#[test]
fn a_system_that_no_motion_can_be_computed_with_is_refused() {
    let hanging = string(1.0, 1.0, 0.5);
    assert_eq!(refused(hanging.clone(), STILL), None);
    let with = |body: Body| System {
        body,
        ..hanging.clone()
    };
    let disc = |radius: f64, inertia: f64| Body::rigid(Shape::Circle { radius }, inertia);
    let box_of = |half_width: f64, half_height: f64| Shape::Rectangle {
        half_width,
        half_height,
    };
    for (body, key) in [
        (disc(0.2, -0.02), "inertia"),
        (disc(-5.0, 0.02), "radius"),
        (Body::rigid(box_of(-1.0, 1.0), 1.0), "half_width"),
        (Body::rigid(box_of(1.0, -1.0), 1.0), "half_height"),
    ] {
        assert_eq!(refused(with(body), STILL), Some(key));
    }
    let backwards = Rules {
        v_stick: -1.0,
        ..STILL
    };
    assert_eq!(refused(hanging.clone(), backwards), Some("v_stick"));
    let mut other = hanging.clone();
    other.cables = vec![Cable::taut_at_rest([0.0, -2.0], [0.0, 0.0], 1.0)];
    assert_eq!(refused(other.clone(), STILL), Some("rest_span"));
    other.cables = vec![Cable::taut_at_rest([0.0, -1.0 - 1e-9], [0.0, 0.0], 1.0)];
    assert_eq!(refused(other, STILL), None);
    for (pole, key) in [(0.5, Some("pole")), (-0.5, None)] {
        let mut floating = hanging.clone();
        floating.floating = Some(Floating {
            memory: vec![Exponential {
                pole: [pole, 1.0],
                residue: [[[0.1, 0.0]; 3]; 3],
            }],
            ..Floating::default()
        });
        assert_eq!(refused(floating, STILL), key);
    }
    let message = Simulation::new(hanging, backwards, 0.0, State::default()).map(|_| ());
    let message = message.expect_err("it is refused").to_string();
    assert_eq!(message, "a speed of 0 or more; v_stick is -1");
}

/// An uncertainty of all kinds that its fields can hold, and `set` would not accept.
#[test]
fn an_uncertainty_is_checked_where_it_is_used() {
    let case = Case::new(Parameters {
        f_o: 0.31,
        ..Parameters::STANDARD
    })
    .expect("a legal case");
    let of = |keys: &[(&'static str, f64)]| Uncertainty {
        keys: keys.to_vec(),
        ..Uncertainty::default()
    };
    let start = |size: f64| Uncertainty::of_start(size);
    let tolerance = |tolerance: f64| Uncertainty {
        tolerance,
        ..Uncertainty::default()
    };
    for (uncertainty, key) in [
        (of(&[("e", f64::NAN)]), "e"),
        (of(&[("e", -0.01)]), "e"),
        (of(&[("foo", 0.1)]), "foo"),
        (of(&[("t_end", 0.1)]), "t_end"),
        (start(f64::NAN), "x"),
        (start(f64::INFINITY), "x"),
        (start(-0.1), "x"),
        (tolerance(f64::NAN), "tolerance"),
        (tolerance(-1.0), "tolerance"),
    ] {
        let run = trusted_run(&case, &uncertainty, &no_progress).map(|_| ());
        let tally = Ensemble::about(&case, &uncertainty, 5, 1).tally(&no_progress);
        for refused in [run, tally.map(|_| ())] {
            match refused {
                Err(Unfinished::Case(error)) => assert_eq!(error.key, key),
                other => panic!("{uncertainty:?}: {other:?}"),
            }
        }
    }
    // A key of the start is that component, and of two entries the later one counts, in both.
    let one = of(&[("x", 1e-9), ("e", 1e-9)]);
    let mut same = of(&[("e", 0.1), ("e", 1e-9)]);
    same.start[0] = 1e-9;
    let trust = |u: &Uncertainty| trusted_run(&case, u, &no_progress).map(|(_, trust)| trust);
    assert_eq!(trust(&one).unwrap(), trust(&same).unwrap());
    let members = [&one, &same].map(|u| {
        *Ensemble::about(&case, u, 1, 1)
            .member(0)
            .unwrap()
            .parameters()
    });
    assert_eq!(members[0], members[1]);
    assert!((members[0].x - 0.0).abs() <= 1e-9 && members[0].x != 0.0);
}

/// A mass that begins at t = 100 falls for one unit of time and then hangs for two.
#[test]
fn the_time_without_a_taut_cable_begins_with_the_run() {
    let rules = Rules {
        t_end: 103.0,
        ..STILL
    };
    let start = State {
        y: -0.5,
        ..State::default()
    };
    let mut simulation = Simulation::new(string(1.0, 1.0, 0.0), rules, 100.0, start).unwrap();
    let outcome = Outcome::after(simulation.clone());
    assert!((outcome.slack() - 1.0).abs() < 1e-12, "{}", outcome.slack());
    assert!((outcome.sliding - 2.0).abs() < 1e-12);
    while simulation.step().is_some() {}
    assert_eq!(Outcome::after(simulation).slack(), 0.0);
}

#[test]
fn a_prescribed_motion_that_can_not_be_followed_ends() {
    let prescribed = PrescribedTaut::new(string(1.0, 1.0, 0.5));
    let start = State {
        x: 0.6,
        y: -0.8,
        ..State::default()
    };
    let only = TautSet::only(0);
    for s in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e17] {
        let there = prescribed.carried(only, 0.0, &start, s);
        assert!(there.x.is_nan(), "{s}: {there:?}");
    }
    let path = prescribed.path(only, 0.0, &start, f64::NAN);
    let near = prescribed.carried(only, 0.0, &start, 0.01);
    assert!((path.state(0.01).x - near.x).abs() < 1e-14);
}

/// A step of Newton's method leaves δ²/2 of a length 1 + δ.
#[test]
fn a_projection_is_made_for_states_that_are_almost_there() {
    let prescribed = PrescribedTaut::new(string(1.0, 1.0, 0.5));
    let only = TautSet::only(0);
    for (off, least, most) in [(1e-4, 0.0, 1e-15), (0.1, 1e-5, 3e-5)] {
        let start = State {
            y: -1.0 - off,
            ..State::default()
        };
        let left = prescribed.projected(&start, only, only).y.abs() - 1.0;
        assert!((least..=most).contains(&left.abs()), "{off}: {left:e}");
    }
}

#[test]
fn counts_as_large_as_there_are_do_no_harm() {
    let counter = Counter::new("counting", u64::MAX, u64::MAX, &no_progress);
    assert!(counter.add(u64::MAX).is_ok());
    let asked = AtomicUsize::new(0);
    let enough = || asked.fetch_add(1, Ordering::Relaxed) >= 100;
    let made = on_all_threads_until(&enough, usize::MAX, |numbers| {
        Ok::<_, Infallible>(numbers.collect())
    });
    let numbers: Vec<usize> = made.map_or_else(|never| match never {}, |made| made.into_vec());
    assert!(numbers.iter().copied().eq(0..100));
}

/// A monitor is given its sizes by a program, and not by a user.
#[test]
fn a_monitor_with_sizes_that_are_no_numbers_ends() {
    let mut simulation = Case::new(Parameters::STANDARD).unwrap().simulation();
    let mut monitor = TrustMonitor::new(&simulation, &[f64::NAN; 6], 1e-3);
    while let Some(step) = simulation.step() {
        monitor.follow(&simulation, &step);
    }
    monitor.verdict();
}
