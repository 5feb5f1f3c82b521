//! Starts on short cables, and starts at which a resting cable has no tension yet.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{HorizonCause, Trust, TrustMonitor, no_progress, record};
use snapload::{
    Body, Cable, Case, Forcing, Harmonic, Mode, Parameters, Precise, Real, Rules, Simulation,
    StartError, State, Stop, System, TautSet, Trajectory,
};

/// The period of a pendulum that swings by 90 degrees to either side, over √(r/g): 4 K(sin 45°).
const PERIOD: f64 = 7.416_298_709_205_487;

fn begun(system: System, t_end: f64, start: State) -> Result<Simulation, StartError> {
    let rules = Rules {
        v_stick: 1e-9,
        ..Rules::until(t_end)
    };
    Simulation::new(system, rules, 0.0, start)
}

fn followed(system: System, t_end: f64, start: State) -> (Trajectory, Trust) {
    let simulation = begun(system, t_end, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    });
    (run.unwrap(), monitor.verdict())
}

fn at(x: f64, y: f64) -> State {
    State {
        x,
        y,
        ..State::default()
    }
}

/// A mass that is let go at the anchor of a cable falls by its length r, snaps at √(2 g r) and
/// bounces with e, the next snap 2 e v/g later; in the end it hangs at rest.
#[test]
fn a_mass_falls_the_whole_length_of_a_short_cable() {
    for r in [1e-3, 1e-6, 1e-9, 1e-12] {
        let (run, _) = followed(string(r, 1.0, 0.5), 0.5, at(0.0, 0.0));
        let v = (2.0 * r).sqrt();
        let (mut t, mut speed) = (v, v);
        for snap in &run.impacts()[..3] {
            assert!((snap.t / t - 1.0).abs() < 1e-9, "{r:e}: {} {t}", snap.t);
            assert!((snap.v_n / speed - 1.0).abs() < 1e-9, "{r:e}");
            t += speed;
            speed *= 0.5;
        }
        assert!((run.end().state.y / -r - 1.0).abs() < 1e-9, "{r:e}");
        assert_eq!(run.end().state.x, 0.0);
    }
}

/// A start on a short cable that is not at its end is in flight, and is left where it is.
#[test]
fn a_start_inside_a_short_cable_is_not_moved() {
    let inside = at(0.0, -3e-7);
    let simulation = begun(string(3e-5, 1.0, 0.5), 1e-9, inside).unwrap();
    assert_eq!(*simulation.state(), inside);
    assert_eq!(simulation.taut(), TautSet::SLACK);
    // The breakwater's cables are parallel where a = 1: it falls by y until both snap.
    for y in [9.9999e-6, 5e-6] {
        let keys = [("a", 1.0), ("b", 0.3), ("r", 1e-5), ("f_o", 0.0), ("y", y)];
        let entries = keys.map(|(key, value)| (key, value.into()));
        let run = Case::from_entries(entries).unwrap().run();
        let fall = (2.0 * y).sqrt();
        assert!((run.impacts()[0].t / fall - 1.0).abs() < 1e-9, "{y}");
        assert!((run.impacts()[0].v_n / fall - 1.0).abs() < 1e-9, "{y}");
        assert_eq!(run.norms().y_max, y);
    }
}

/// From r = 0.1 on a gap within 1e-9 is closed, on shorter cables one within 1e-7 r².
#[test]
fn what_counts_as_closed_scales_with_short_cables() {
    for (r, tolerance) in [(2.0, 1e-9), (0.1, 1e-9), (0.01, 1e-11), (1e-5, 1e-17)] {
        let taut = |gap: f64| {
            let y = -(r * r + gap).sqrt();
            begun(string(r, 1.0, 0.5), 1.0, at(0.0, y))
        };
        for gap in [-0.9 * tolerance, 0.9 * tolerance] {
            let simulation = taut(gap).unwrap();
            assert_eq!(simulation.taut(), TautSet::only(0), "{r} {gap:e}");
            assert!((simulation.state().y / -r - 1.0).abs() < 1e-15, "{r}");
        }
        assert_eq!(
            taut(-1.1 * tolerance).unwrap().taut(),
            TautSet::SLACK,
            "{r}"
        );
        let refused = taut(1.1 * tolerance).unwrap_err();
        assert!(matches!(
            refused,
            StartError::CableTooShort { cable: 0, .. }
        ));
    }
}

/// No start gives numbers that are not finite: a cable that doubles can not follow is refused, and
/// so is one whose gap is only rounding where it is.
#[test]
fn cables_too_short_for_doubles_are_refused() {
    let refused = begun(string(1e-300, 1.0, 0.5), 0.5, at(0.0, 0.0)).unwrap_err();
    let length = 1e-300;
    assert_eq!(refused, StartError::TooShort { cable: 0, length });
    let (run, _) = followed(string(1e-16, 1.0, 0.5), 1e-7, at(0.0, 0.0));
    assert!((run.impacts()[0].t / 2e-16_f64.sqrt() - 1.0).abs() < 1e-9);
    // g = |P − A|² − r² is known to some 1e-16 about (1, 1), and r² is as small.
    let far = System {
        cables: vec![Cable::new([1.0, 1.0], [0.0, 0.0], 1e-8)],
        ..string(1.0, 1.0, 0.5)
    };
    let refused = begun(far, 0.5, at(1.0, 1.0)).unwrap_err();
    assert_eq!(refused, StartError::CanNotClose { cable: 0 });
}

/// A mass on a cable that leads from the origin in the direction α, pulled at right angles to it by
/// g.
fn released(alpha: f64, r: f64, g: f64) -> (System, State) {
    let (sine, cosine) = alpha.sin_cos();
    let system = System {
        forcing: Forcing {
            constant: [g * sine, -g * cosine].into(),
            harmonics: vec![],
        },
        ..string(r, 0.0, 0.5)
    };
    (system, at(r * cosine, r * sine))
}

/// A pendulum that is released at rest at the height of its anchor has the tension 3 g
/// sin φ once it has fallen by φ, and is taut at all times: also where it turns, at the
/// same height on the other side.
#[test]
fn a_pendulum_released_at_the_height_of_its_anchor_is_taut_throughout() {
    for (r, g) in [(1.0, 1.0), (1.0, 1e-6), (0.7, 2.0), (3.0, 0.4)] {
        for alpha in [0.0, 0.3, 2.0, -1.1] {
            let (system, start) = released(alpha, r, g);
            let pull = system.forcing.constant;
            let period = PERIOD * f64::sqrt(r / g);
            let (run, trust) = followed(system, 2.75 * period, start);
            let about = format!("r = {r}, g = {g:e}, {alpha}");
            assert_eq!(
                run.impacts().len(),
                0,
                "{about}: {:?}",
                run.impacts().first()
            );
            assert_eq!(run.modes().len(), 1, "{about}");
            assert_eq!(run.modes()[0].taut, TautSet::only(0), "{about}");
            assert!(trust.horizon.is_none(), "{about}: {:?}", trust.horizon);
            for k in 0..=55 {
                let motion = run.at(period * 0.05 * f64::from(k));
                let depth = pull.dot(motion.state.centre()) / g;
                let off = motion.tensions[0] - 3.0 * g * depth / r;
                assert!(off.abs() < 1e-9 * g, "{about}, {k}: {off:e}");
                assert!(depth > -1e-9 * r, "{about}, {k}: {depth:e}");
            }
            let back = run.at(2.0 * period).state;
            assert!(
                (back.x - start.x).hypot(back.y - start.y) < 1e-9 * r,
                "{about}"
            );
        }
    }
}

/// A mass at rest on two cables is pulled to the right by f_o cos Ωt; the left cable carries it
/// alone at f_o = 1/h, where T_1 = (1/h − f_o cos Ωt)·r/2 and T_2 has the other sign of f_o. At a
/// force below that by a rounding both tensions are positive at all times.
fn pulled(omega: f64, stop_when_settled: bool) -> Parameters {
    Parameters {
        inertia: None,
        a: 0.0,
        y: 0.0,
        nu: 0.0,
        f_o: 0.894_427_190_999_915_8,
        omega,
        stop_when_settled,
        t_end: 20.0,
        ..Parameters::STANDARD
    }
}

#[test]
fn a_mass_on_two_cables_rocks_up_to_the_force_that_lifts_one() {
    for omega in [1e-6, 1e-3, 0.9, 3.0] {
        let case = Case::new(pulled(omega, false)).unwrap();
        let run = case.run();
        assert_eq!(run.impacts().len(), 0, "{omega:e}");
        assert_eq!(run.modes().len(), 1, "{omega:e}");
        assert_eq!(run.modes()[0].taut.mode(), Mode::Rocking, "{omega:e}");
        let settled = Case::new(pulled(omega, true)).unwrap().run();
        assert_eq!(
            (settled.end().reason, settled.end().t),
            (Stop::Settled, 0.0)
        );
    }
}

/// Where the tension does not rise above rounding for a long time, nothing is called known.
#[test]
fn a_start_that_stays_undecided_is_not_certain() {
    let case = Case::new(pulled(1e-9, false)).unwrap();
    let mut monitor = TrustMonitor::of_exact_case(&case, &case.simulation());
    record(case.simulation(), &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })
    .unwrap();
    let horizon = monitor.verdict().horizon.unwrap();
    assert!(matches!(horizon.cause, HorizonCause::Start { .. }));
    assert_eq!((horizon.t, horizon.impact), (0.0, 1));
}

/// With a tension that falls from zero a cable is slack at once: under the force −sin t along the
/// cable the mass leaves by t − sin t. Without any force it is neither taut nor slack, and rests.
#[test]
fn a_cable_whose_tension_falls_from_zero_is_slack() {
    let push = |size: f64| System {
        body: Body::point(),
        forcing: Forcing {
            constant: [0.0, 0.0].into(),
            harmonics: vec![Harmonic {
                omega: 1.0,
                cosine: [0.0, 0.0].into(),
                sine: [-size, 0.0].into(),
            }],
        },
        ..string(1.0, 0.0, 0.5)
    };
    let (run, trust) = followed(push(1.0), 1.5, at(1.0, 0.0));
    assert_eq!(run.modes()[0].taut, TautSet::SLACK);
    assert!((run.end().state.x - (1.0 - (1.5 - 1.5_f64.sin()))).abs() < 1e-14);
    assert!(trust.horizon.is_none());
    let (run, trust) = followed(push(0.0), 1.5, at(1.0, 0.0));
    assert_eq!(run.end().state, at(1.0, 0.0));
    assert!(run.impacts().is_empty() && trust.horizon.is_none());
    // With a tension that rises from zero it is taut, and the mass stays.
    let (run, trust) = followed(push(-1.0), 3.0, at(1.0, 0.0));
    assert_eq!(run.modes()[0].taut, TautSet::only(0));
    assert_eq!(run.end().state, at(1.0, 0.0));
    assert!(run.impacts().is_empty() && trust.horizon.is_none());
}

/// A mass is thrown so that it is at the height of its anchor, at the end of its cable and at its
/// highest point at t = 1/2, and does not bounce: it then has no tension yet, but is taut. An
/// impact after that exists only by rounding, and is not certain.
#[test]
fn an_impact_that_only_rounding_makes_is_not_certain() {
    let thrown = State {
        x: 0.5,
        y: -0.125,
        vx: 1.0,
        vy: 0.5,
        ..State::default()
    };
    let (run, trust) = followed(string(1.0, 1.0, 0.0), 1.0, thrown);
    assert!((run.impacts()[0].t - 0.5).abs() < 1e-14);
    assert!((run.impacts()[0].v_n - 1.0).abs() < 1e-14);
    if let Some(second) = run.impacts().get(1) {
        assert!(second.v_n < 1e-9, "{second:?}");
        let horizon = trust.horizon.expect("an end of what is known");
        assert_eq!(horizon.impact, 2);
    }
}

/// A mass thrown up from y = −1 + d, on a string of length 1, is back at its end after v + √(v² + 2
/// d): a gap within the start's tolerance that opens is neither dropped nor closed.
#[test]
fn a_gap_that_opens_is_kept() {
    for d in [0.0, 1e-15, 1e-12, 1e-10, 4.9e-10] {
        for vy in [1e-4, 1e-3, 0.01, 0.5] {
            let about = format!("{d:e}, {vy}");
            let y = -1.0 + d;
            let (exact, start) = (
                vy + (vy * vy + 2.0 * (y + 1.0)).sqrt(),
                State { vy, ..at(0.0, y) },
            );
            let (run, trust) = followed(string(1.0, 1.0, 0.5), 1.2, start);
            let (first, error) = (run.impacts()[0], trust.errors[0]);
            let off = (first.t - exact).abs();
            assert!(
                off < 2.0 * error && error < 1e-11,
                "{about}: {off:e} {error:e}"
            );
            assert!((first.v_n - (exact - vy)).abs() < 1e-11, "{about}");
            assert_eq!(run.at(0.0).state, start, "{about}");
        }
    }
}

/// A mass thrown towards the end of its string, y = −1 − d, is beyond it by no
/// more than the tolerance if −1e-9 < 2 d < 1e-9: above it snaps when it arrives,
/// below at once, moved to the end.
#[test]
fn a_gap_that_closes_is_kept_and_one_beyond_the_end_closed() {
    let thrown = |y: f64| {
        let start = State {
            vy: -0.01,
            ..at(0.0, y)
        };
        followed(string(1.0, 0.0, 0.5), 1.2, start).0
    };
    for d in [1e-12, 4.9e-10] {
        let above = thrown(-1.0 + d);
        assert!((above.impacts()[0].t / (100.0 * d) - 1.0).abs() < 1e-3);
        let below = thrown(-1.0 - d);
        assert_eq!((below.impacts()[0].t, below.impacts()[0].v_n), (0.0, 0.01));
        assert_eq!(below.impacts()[0].before.y, -1.0);
    }
}

/// A point at (−0.1, h − √(r² − 1.1²) + 4e-10) is within the start's tolerance of the end of
/// the left cable, with a gap of −8.2e-10, and leaves it at 1e-4. By bisection of the closed
/// form, in fifty digits, the gap is zero again at 2.0392304843297331e-4; the run with many
/// digits begins with the same gap.
#[test]
fn a_run_and_its_run_with_many_digits_keep_the_same_gap() {
    let y = 1.25_f64.sqrt() - (2.25_f64 - 1.21).sqrt() + 4e-10;
    let numbers = [
        ("f_o", 0.0),
        ("x", -0.1),
        ("y", y),
        ("vy", 1e-4),
        ("t_end", 3e-4),
        ("e", 0.5),
    ];
    let numbers = numbers.map(|(key, value)| (key, value.into()));
    let others = [
        ("body", "point".into()),
        ("stop_when_settled", false.into()),
    ];
    let case = Case::from_entries(others.into_iter().chain(numbers)).unwrap();
    let expected = 2.039_230_484_329_733_1e-4;
    let first = case.run().impacts()[0];
    let mut monitor = TrustMonitor::of_exact_case(&case, &case.simulation());
    let mut simulation = case.simulation();
    let step = simulation.step().unwrap();
    monitor.follow(&simulation, &step);
    let error = monitor.verdict().errors[0];
    let off = (first.t - expected).abs();
    assert!(off < 2.0 * error && error < 1e-11, "{off:e} {error:e}");
    let exact = case.simulation_over(|_, number| Precise::<4>::from_decimal(number));
    let snap = exact.unwrap().step().unwrap().impacts().next().unwrap();
    assert!((snap.t.to_f64() - expected).abs() < 1e-18);
}
