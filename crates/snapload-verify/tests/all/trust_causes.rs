//! The causes that end trust: events that neighbours may not share, each in a case made for it.

use crate::calibration::{Digits, compared};
use snapload::analysis::{HorizonCause, TrustMonitor, Uncertainty, no_progress, trusted_run};
use snapload::{
    Body, Cable, Case, Forcing, Limit, LimitBounds, Parameters, Real, Rules, Simulation, State,
    Stop, System, Value, named_case,
};
use snapload_verify::verify;

fn case(entries: impl IntoIterator<Item = (&'static str, Value)>) -> Case {
    Parameters::from_entries(entries)
        .and_then(Case::new)
        .expect("a legal case")
}

fn case_of_numbers<const N: usize>(entries: [(&'static str, f64); N]) -> Case {
    case(entries.map(|(key, value)| (key, Value::Number(value))))
}

/// A neighbour has its impact later, and has turned further by then, although at any one time it
/// has turned as far.
#[test]
fn a_limit_may_be_met_on_the_way_to_a_later_impact() {
    let turning = |y| {
        case_of_numbers([
            ("theta", 1.0),
            ("vtheta", 0.86437),
            ("y", y),
            ("f_o", 0.0),
            ("e", 0.5),
        ])
    };
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("y", 1e-5).expect("a key in doubt");
    let (run, trust) = trusted_run(&turning(0.4), &uncertainty, &no_progress).expect("legal");
    assert_ne!(run.end().reason, turning(0.400009).run().end().reason);
    let cause = trust.horizon.map(|horizon| horizon.cause);
    assert_eq!(cause, Some(HorizonCause::StopRule));
    assert!(trust.end_error.is_infinite());
}

/// The bound on the rotation is set just above the largest rotation of a run with a taut cable.
#[test]
fn a_limit_that_taut_motion_all_but_reaches_ends_trust() {
    let named = named_case("sliding-example").expect("a name");
    let sliding = Case::new(named.parameters).expect("legal").simulation();
    let (mut simulation, mut farthest) = (sliding.clone(), None);
    while let Some(step) = simulation.step() {
        let ends = step.start.theta.abs().max(step.before.theta.abs());
        if !step.taut.is_empty() && simulation.theta_max() > ends + 1e-4 {
            farthest = Some((simulation.theta_max(), step.t_end));
            break;
        }
    }
    let (theta_max, t_end) = farthest.expect("a maximum within taut motion");
    let cause = |above: f64| {
        let rules = Rules {
            limits: LimitBounds::none().with(Limit::Rotation, theta_max + above),
            t_end: t_end + 1e-3,
            ..*sliding.rules()
        };
        let (system, start) = (sliding.system().clone(), *sliding.state());
        let mut simulation = Simulation::new(system, rules, 0.0, start).expect("legal");
        let mut monitor = TrustMonitor::new(&simulation, &[1e-13; 6], 1.0);
        while let Some(step) = simulation.step() {
            monitor.follow(&simulation, &step);
        }
        monitor.verdict().horizon.map(|horizon| horizon.cause)
    };
    assert_eq!(cause(1e-13), Some(HorizonCause::StopRule));
    assert_eq!(cause(1e-4), None);
}

#[test]
fn a_start_on_a_limit_is_not_certain() {
    let at = |theta| case_of_numbers([("theta", theta), ("y", 0.3)]);
    let cause = |theta| {
        let (_, trust) =
            trusted_run(&at(theta), &Uncertainty::default(), &no_progress).expect("legal");
        trust.horizon.map(|horizon| (horizon.impact, horizon.cause))
    };
    assert_eq!(
        cause(std::f64::consts::FRAC_PI_2),
        Some((1, HorizonCause::StopRule))
    );
}

#[test]
fn the_end_of_the_time_asked_for_has_no_error() {
    let end = |t_end| {
        let case = case_of_numbers([("t_end", t_end), ("f_o", 0.31)]);
        let (run, trust) =
            trusted_run(&case, &Uncertainty::default(), &no_progress).expect("legal");
        assert!(trust.horizon.is_none());
        (run.end().reason, trust.end_error)
    };
    assert_eq!(end(1.0), (Stop::EndTime, 0.0));
    let (reason, error) = end(100.0);
    assert!(reason == Stop::RotationLimit && error > 0.0 && error < 1e-9);
}

/// A slow snap that pulls, with v_stick at about its velocity.
#[test]
fn a_snap_about_as_slow_as_sticks_ends_trust() {
    let falling = |v_stick| {
        case_of_numbers([
            ("f_o", 0.0),
            ("e", 0.5),
            ("theta", 0.02),
            ("v_stick", v_stick),
        ])
    };
    let run = falling(1e-9).run();
    let slow = run
        .impacts()
        .iter()
        .position(|impact| impact.v_n < 1e-4)
        .expect("slow");
    let v_n = run.impacts()[slow].v_n;
    let cause = |v_stick| {
        let uncertainty = Uncertainty {
            tolerance: 1.0,
            ..Uncertainty::of_start(1e-9)
        };
        let trust = trusted_run(&falling(v_stick), &uncertainty, &no_progress)
            .expect("legal")
            .1;
        let here = trust.horizon.filter(|horizon| horizon.impact == slow + 1);
        here.map(|horizon| horizon.cause)
    };
    let cable = run.impacts()[slow].cable;
    assert_eq!(
        cause(v_n * (1.0 + 1e-9)),
        Some(HorizonCause::Sticking { cable })
    );
    assert_eq!(
        cause(v_n * (1.0 - 1e-9)),
        Some(HorizonCause::Sticking { cable })
    );
    assert_eq!(cause(v_n * 0.9), None);
}

/// A case that an earlier model of rounding, with half of the actual noise, wrongly reported as
/// certain.
#[test]
fn nothing_is_certain_that_is_wrong() {
    let case = case_of_numbers([
        ("r", 1.1404),
        ("e", 0.9492),
        ("a", 0.4623),
        ("b", 0.5549),
        ("f_o", -0.2629),
        ("nu", 0.4265),
        ("omega", 2.0485),
        ("x", 0.1868),
        ("y", 0.3585),
        ("theta", -0.1361),
        ("vx", -0.2463),
        ("vy", -0.0173),
        ("vtheta", -0.0864),
        ("t_end", 60.0),
    ]);
    let found = verify(&case, 60, 1e-3, &no_progress).expect("legal");
    let (wrong, predicted) = (
        found.first_wrong,
        found.trust.horizon.map(|horizon| horizon.impact),
    );
    assert!(
        predicted.is_some() && predicted <= wrong,
        "{predicted:?} {wrong:?}"
    );
}

/// A point on cables that are hardly longer than necessary: the height of the anchors above it has
/// lost digits.
#[test]
fn digits_that_short_cables_lose_are_not_claimed() {
    for e in [0.0, 0.3, 0.5] {
        let numbers = [
            ("r", 1.0000001),
            ("x", 1e-8),
            ("y", 2e-4),
            ("e", e),
            ("t_end", 0.03),
        ];
        let numbers = numbers.map(|(key, value)| (key, Value::Number(value)));
        let flags = [
            ("body", Value::from("point")),
            ("stop_when_settled", Value::Bool(false)),
        ];
        let case = case(numbers.into_iter().chain(flags));
        let (run, trust) =
            trusted_run(&case, &Uncertainty::default(), &no_progress).expect("legal");
        let exact = case.simulation_over(|_, number| Digits::from_decimal(number));
        let (differences, _) = compared(&run, exact.expect("legal"), 2000);
        let pairs: Vec<(f64, f64)> = differences.into_iter().zip(trust.errors).collect();
        println!("e = {e}: {pairs:?}");
        assert!(pairs.len() > 1 && pairs[0].1 < 1e-10);
        for (difference, error) in pairs {
            assert!(difference < 3.0 * error, "{difference:e} {error:e}");
        }
    }
}

/// A point mass at rest on two taut cables carries the tensions T = 3/4 (1/h ± f_o sin ωt) or so:
/// they are positive as long as |f_o| < 1/h = 0.894. Where the uncertainty of the force reaches
/// beyond, or comes back from there, some neighbours go slack and others do not.
#[test]
fn a_tension_that_neighbours_lose_ends_trust() {
    let cause = |f_o: f64, size: f64| {
        let entries = [
            ("body", Value::Text("point".to_owned())),
            ("x", Value::Number(0.0)),
            ("y", Value::Number(0.0)),
            ("f_o", Value::Number(f_o)),
            ("nu", Value::Number(0.0)),
            ("omega", Value::Number(1.0)),
            ("e", Value::Number(0.9)),
            ("t_end", Value::Number(10.0)),
            ("stop_when_settled", Value::Bool(false)),
        ];
        let mut uncertainty = Uncertainty::default();
        uncertainty.set("f_o", size).expect("a key in doubt");
        let (run, trust) = trusted_run(&case(entries), &uncertainty, &no_progress).expect("legal");
        let lost = !run.impacts().is_empty();
        (trust.horizon.map(|horizon| horizon.cause), lost)
    };
    for sign in [1.0, -1.0] {
        // Three standard deviations of ± 0.005 are 0.0087.
        assert_eq!(cause(sign * 0.88, 0.005), (None, false));
        let (found, lost) = cause(sign * 0.88, 0.05);
        assert!(
            !lost && matches!(found, Some(HorizonCause::Tension { .. })),
            "{found:?}"
        );
        let (found, lost) = cause(sign * 0.9, 0.05);
        let ends = |cause| {
            matches!(
                cause,
                HorizonCause::Tension { .. } | HorizonCause::Start { .. }
            )
        };
        assert!(lost && found.is_some_and(ends), "{found:?}");
    }
}

/// A pendulum that is thrown round has the tension v₀² − 5 at its top, for g = l = 1: it goes round
/// taut from v₀ = √5 on, and below that it falls from near the top.
#[test]
fn a_pendulum_that_all_but_goes_round_ends_trust() {
    let cause = |above: f64, size: f64| {
        let system = System {
            body: Body::point(),
            cables: vec![Cable::new([0.0, 0.0], [0.0, 0.0], 1.0)],
            forcing: Forcing {
                constant: [0.0, -1.0].into(),
                harmonics: Vec::new(),
            },
            drag: None,
            floating: None,
            restitution: 1.0,
        };
        let start = State {
            y: -1.0,
            vx: 5.0_f64.sqrt() + above,
            ..State::default()
        };
        let mut simulation = Simulation::new(system, Rules::until(4.0), 0.0, start).expect("legal");
        let doubt = [0.0, 0.0, 0.0, size, 0.0, 0.0];
        let mut monitor = TrustMonitor::new(&simulation, &doubt, 1.0);
        let mut impacts = 0;
        while let Some(step) = simulation.step() {
            monitor.follow(&simulation, &step);
            impacts += step.impacts().count();
            if impacts > 3 {
                break;
            }
        }
        let horizon = monitor.verdict().horizon;
        (horizon.map(|horizon| horizon.cause), impacts > 0)
    };
    let tension = Some(HorizonCause::Tension { cable: 0 });
    assert_eq!(cause(2e-5, 1e-4), (tension, false));
    assert_eq!(cause(2e-3, 1e-4), (None, false));
    assert_eq!(cause(-2e-5, 1e-4), (tension, true));
    assert_ne!(cause(-2e-2, 1e-4).0, tension);
}
