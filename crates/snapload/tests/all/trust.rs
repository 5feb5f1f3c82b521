//! The errors that runs report.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{
    Certainty, NormErrors, TrustMonitor, Uncertainty, Unfinished, no_progress, trusted_run,
};
use snapload::{Case, Mode, Parameters, Rules, Simulation, State, named_case};

/// The norms of neighbours at the largest possible distance differ by less than the reported error,
/// and by more than a thousandth of it.
#[test]
fn neighbours_have_norms_within_the_errors() -> Result<(), Unfinished> {
    let certain = Parameters {
        f_o: 0.31,
        ..Parameters::STANDARD
    };
    let doubt = 1e-9;
    let case = Case::new(certain)?;
    let (run, trust) = trusted_run(&case, &Uncertainty::of_start(doubt), &no_progress)?;
    assert!(trust.decides_the_end());
    let errors = NormErrors::of(&run, &trust);
    let errors = [
        errors.rho1,
        errors.rho2,
        errors.rho3,
        errors.y_max,
        errors.theta_max,
    ];
    let errors = errors.map(|error| error.unwrap_or(f64::NAN));
    let mut largest = [0.0_f64; 5];
    for (name, value) in [("x", certain.x), ("y", certain.y), ("vx", certain.vx)] {
        for side in [-doubt, doubt] {
            let moved = certain.map(|key, old| if key == name { value + side } else { old });
            let other = Case::new(moved)?.run();
            let (ours, theirs) = (run.norms(), other.norms());
            let off = [
                ours.rho1 - theirs.rho1,
                ours.rho2 - theirs.rho2,
                ours.rho3 - theirs.rho3,
                ours.y_max - theirs.y_max,
                ours.theta_max - theirs.theta_max,
            ];
            largest = std::array::from_fn(|k| largest[k].max(off[k].abs()));
        }
    }
    for (largest, error) in largest.into_iter().zip(errors) {
        assert!(
            largest <= error && error <= 1e3 * largest,
            "{largest:e} {error:e}"
        );
    }
    Ok(())
}

/// Impacts of one instant, and an impact that ends the run, do not make extremes uncertain: the
/// standard case settles at an impact, or rocks after impulses that were passed on.
#[test]
fn extremes_are_known_where_impacts_come_at_once() -> Result<(), Unfinished> {
    for stop_when_settled in [true, false] {
        let case = Case::new(Parameters {
            e: 0.3,
            t_end: 5.0,
            stop_when_settled,
            ..Parameters::STANDARD
        })?;
        let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
        let errors = NormErrors::of(&run, &trust);
        for error in [errors.y_max, errors.theta_max] {
            assert!(error.is_some_and(|error| error < 1e-10), "{error:?}");
        }
    }
    Ok(())
}

/// With taut cables no known digits are available: neighbours of a body that rocks on both cables
/// from its start stay within the errors.
#[test]
fn neighbours_of_taut_motion_are_within_the_errors() -> Result<(), Unfinished> {
    let rocking = Parameters {
        y: 0.0,
        f_o: 0.1,
        stop_when_settled: false,
        ..Parameters::STANDARD
    };
    for t_end in [3.0, 9.0, 30.0] {
        let certain = Parameters { t_end, ..rocking };
        let case = Case::new(certain)?;
        let doubt = 1e-9;
        let mut uncertainty = Uncertainty::default();
        uncertainty.set("f_o", doubt)?;
        let (run, trust) = trusted_run(&case, &uncertainty, &no_progress)?;
        let errors = NormErrors::of(&run, &trust);
        let errors = [errors.y_max, errors.theta_max].map(|error| error.unwrap_or(f64::NAN));
        for side in [-doubt, doubt] {
            let f_o = certain.f_o + side;
            let other = Case::new(Parameters { f_o, ..certain })?.run();
            let (ours, theirs) = (run.norms(), other.norms());
            let off = [
                (ours.y_max - theirs.y_max).abs(),
                (ours.theta_max - theirs.theta_max).abs(),
            ];
            for (off, error) in off.into_iter().zip(errors) {
                assert!(off <= error && error < 1e-5, "{t_end}: {off:e} {error:e}");
            }
        }
    }
    Ok(())
}

/// Past the horizon nothing is known, except the sum up to t = 10 if the horizon is later.
#[test]
fn what_counts_impacts_past_the_horizon_is_not_known() -> Result<(), Unfinished> {
    let errors = |parameters: Parameters| -> Result<_, Unfinished> {
        let case = Case::new(parameters)?;
        let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
        let NormErrors {
            rho1,
            rho2,
            rho3,
            y_max,
            theta_max,
        } = NormErrors::of(&run, &trust);
        Ok([rho1, rho2, rho3, y_max, theta_max].map(|error| error.is_some()))
    };
    assert_eq!(errors(Parameters::STANDARD)?, [false; 5]);
    // A long cable turns the body slowly: trust lasts far past t = 10, but not to the end.
    let slow = Parameters {
        f_o: 0.0,
        theta: 0.2,
        r: 100.0,
        e: 1.0,
        t_end: 1000.0,
        ..Parameters::STANDARD
    };
    assert_eq!(errors(slow)?, [false, true, false, false, false]);
    Ok(())
}

#[test]
fn certainty_is_that_of_the_trusted_run() -> Result<(), Unfinished> {
    for code in ["sliding-example", "rocking-example", "1910001000-359"] {
        let case = Case::new(named_case(code)?.parameters)?;
        let (_, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
        assert_eq!(Certainty::of(&case).horizon, trust.horizon);
    }
    Ok(())
}

/// Without forcing nothing depends on the start time of a motion, including its exponents.
#[test]
fn exponents_are_over_the_time_that_the_run_takes() {
    let case = Case::new(Parameters {
        f_o: 0.0,
        theta: 0.1,
        ..Parameters::STANDARD
    });
    let usual = case.expect("legal").simulation();
    let exponents = |t: f64| {
        let mut rules = *usual.rules();
        rules.t_end = t + 1.0;
        let (system, start) = (usual.system().clone(), *usual.state());
        let mut simulation = Simulation::new(system, rules, t, start).expect("legal");
        let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
        while let Some(step) = simulation.step() {
            monitor.follow(&simulation, &step);
        }
        monitor.verdict().exponents
    };
    for (at_once, later) in exponents(0.0).into_iter().zip(exponents(8.0)) {
        assert!((at_once - later).abs() < 1e-9, "{at_once} {later}");
    }
}

/// A point mass has no rotation, and so four exponents; as those of a rigid body they sum to 2 ln e
/// an impact over the time, as an impact shrinks volumes by e² and flight keeps them.
#[test]
fn a_point_mass_has_four_exponents() {
    for (body, count) in [("point", 4), ("rigid", 6)] {
        let mut parameters = Parameters {
            r: 1.7,
            e: 0.8,
            f_o: 0.4,
            t_end: 2.5,
            ..Parameters::STANDARD
        };
        if body == "point" {
            (parameters.a, parameters.b, parameters.inertia) = (0.0, 0.0, None);
        }
        let case = Case::new(parameters).expect("legal");
        let (run, trust) =
            trusted_run(&case, &Uncertainty::default(), &no_progress).expect("a run");
        let slack = run.modes().iter().all(|interval| interval.taut.is_empty());
        assert!(slack && run.impacts().len() > 3, "{body}");
        assert_eq!(trust.exponents.len(), count);
        let sum: f64 = trust.exponents.iter().sum();
        let known = 2.0 * parameters.e.ln() * run.impacts().len() as f64 / run.end().t;
        assert!((sum - known).abs() < 1e-9, "{body}: {sum} {known}");
    }
}

/// The same where restitution is small and snaps accumulate: one direction shrinks by e² with each
/// of them, to 1e-12 and less in all, and must not be lost among the others. Eight digits are lost
/// in any case, as a snap at 1e-7 magnifies deviations by about 1e7.
#[test]
fn exponents_keep_their_digits_in_accumulations() {
    let mut compared = [0; 4];
    for k in 1..=48 {
        // Points of a low-discrepancy sequence.
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let (kind, e) = [(0, 0.9), (1, 0.5), (2, 0.2), (3, 0.1)][k as usize % 4];
        let parameters = Parameters {
            e,
            b: 0.2,
            f_o: 0.2 + 0.4 * at(2.0),
            omega: 0.5 + 2.5 * at(3.0),
            vx: 2.0 * at(5.0) - 1.0,
            vy: at(7.0),
            vtheta: 2.0 * at(11.0) - 1.0,
            inertia: snapload::natural_inertia(0.1, 0.2),
            t_end: 300.0,
            v_stick: 1e-9,
            max_impacts: if e > 0.15 { 9 } else { 7 },
            stop_when_settled: false,
            ..Parameters::STANDARD
        };
        let case = Case::new(parameters).expect("legal");
        let (run, trust) =
            trusted_run(&case, &Uncertainty::default(), &no_progress).expect("a run");
        let slack = run.modes().iter().all(|interval| interval.taut.is_empty());
        if !slack || run.impacts().len() < 7 {
            continue;
        }
        let sum: f64 = trust.exponents.iter().sum();
        let known = 2.0 * e.ln() * run.impacts().len() as f64;
        let off = sum * run.end().t - known;
        assert!(off.abs() < 1e-7 * known.abs(), "{e}: {off:e} of {known}");
        compared[kind] += 1;
    }
    assert!(compared.iter().all(|count| *count >= 3), "{compared:?}");
}

/// An inertia that equals the one of the size is in doubt by itself all the same: its doubt
/// does what it does to a case whose inertia is another.
#[test]
fn an_inertia_can_be_in_doubt() {
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("inertia", 1e-6).expect("a key that moves");
    let error = |inertia: f64| {
        let parameters = Parameters {
            theta: 0.1,
            inertia: Some(inertia),
            ..Parameters::STANDARD
        };
        let case = Case::new(parameters).expect("legal");
        trusted_run(&case, &uncertainty, &no_progress)
            .expect("legal")
            .1
            .errors[1]
    };
    let natural = Parameters::STANDARD.inertia.expect("rigid");
    let (natural, other) = (error(natural), error(natural * (1.0 + 1e-9)));
    assert!(
        (natural / other - 1.0).abs() < 1e-3,
        "{natural:e} {other:e}"
    );
}

/// The exponents of a motion, and whether it is slack in the end.
fn exponents_of(mut simulation: Simulation) -> (Vec<f64>, bool) {
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
    while let Some(step) = simulation.step() {
        monitor.follow(&simulation, &step);
    }
    let slack = simulation.taut().mode() == Mode::Slack;
    (monitor.verdict().exponents, slack)
}

/// A cable that stays taut leaves no deviation of its gap or of the gap's rate: each such cable
/// closes two directions for good, and no more.
#[test]
fn a_cable_that_stays_taut_closes_two_directions() {
    let until = |name: &str, t_end: f64| {
        let named = named_case(name).expect("a built-in case");
        let case = Case::new(Parameters {
            t_end,
            ..named.parameters
        });
        exponents_of(case.expect("legal").simulation())
    };
    let closed = |exponents: &[f64]| {
        exponents
            .iter()
            .filter(|e| **e == f64::NEG_INFINITY)
            .count()
    };
    // The body slides along a cable from 7.91 to 8.01 and from 8.16 on; both are taut from 8.88 on.
    for (name, t_end, slack, expected) in [
        ("sliding-example", 7.9, true, 0),
        ("sliding-example", 8.0, false, 2),
        ("sliding-example", 8.5, true, 2),
        ("sliding-example", 100.0, false, 4),
        ("rocking-example", 100.0, false, 4),
    ] {
        let (exponents, is_slack) = until(name, t_end);
        assert_eq!(is_slack, slack, "{name} at {t_end}");
        assert_eq!(closed(&exponents), expected, "{name}: {exponents:?}");
        assert!(exponents.iter().all(|e| !e.is_nan()));
    }
    // A body on two taut cables has one oscillation, which preserves areas (Liouville): the sum of
    // its two exponents is the contribution of the beginning divided by the time.
    let [area, later] = [50.0, 100.0].map(|t| {
        let (exponents, _) = until("rocking-example", t);
        (exponents[0] + exponents[1]) * t
    });
    assert!((later - area).abs() < 0.1, "{area} {later}");
}

/// A pendulum that begins with a taut cable has no deviation along it from the start, and its swing
/// preserves areas, so that its two exponents cancel.
#[test]
fn a_pendulum_has_two_exponents_that_cancel() {
    let system = string(1.0, 1.0, 0.5);
    let start = State {
        y: -1.0,
        vx: 1.2,
        ..State::default()
    };
    let t = 60.0;
    let simulation = Simulation::new(system, Rules::until(t), 0.0, start).expect("legal");
    let (exponents, _) = exponents_of(simulation);
    assert_eq!(exponents[2..], [f64::NEG_INFINITY; 2], "{exponents:?}");
    let sum = (exponents[0] + exponents[1]) * t;
    assert!(sum.abs() < 0.1, "{exponents:?}: {sum}");
    // Deviations of a swing grow like time.
    assert!(exponents[0] < 2.0 * t.hypot(1.0).ln() / t, "{exponents:?}");
}

/// A snap without rebound after which the cable opens again closes the direction of its gap: the
/// rate of the gap afterwards differs, as each neighbour has opened for another time. Where both
/// cables pull at once a point mass is at rest in the corner, whatever came before, and only when
/// it was there makes a difference.
#[test]
fn a_snap_without_rebound_closes_directions() {
    let closed = |t_end: f64| {
        let case = Case::new(Parameters {
            r: 1.341,
            e: 0.0,
            a: 0.0,
            inertia: None,
            f_o: 1.83,
            nu: 1.13,
            omega: 3.18,
            x: 0.085,
            y: 0.37,
            t_end,
            stop_when_settled: false,
            stop_when_sliding: false,
            ..Parameters::STANDARD
        });
        let (exponents, is_slack) = exponents_of(case.expect("legal").simulation());
        let count = exponents.iter().filter(|e| **e == f64::NEG_INFINITY);
        (count.count(), is_slack)
    };
    // Up to the snap of cable 2 at 2.07, which stops cable 1, one cable was taut at a time.
    assert_eq!(closed(2.0), (2, false));
    assert_eq!(closed(2.1), (3, false));
    assert_eq!(closed(50.0).0, 3);
}
