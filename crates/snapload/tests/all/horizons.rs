//! Where trust ends, and why, beside taut cables.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{
    Horizon, HorizonCause, TrustMonitor, Uncertainty, Unfinished, no_progress, record, trusted_run,
};
use snapload::{Case, CaseError, Rules, Simulation, State, Stop, Trajectory};

/// A mass that swings from the lowest point at v, with weight and cable length 1, where v may be
/// off by `doubt`: its horizon, and when it loses its tension T = v² − 2 + 3 cos φ.
fn swung(v: f64, doubt: f64, t_end: f64) -> (Option<Horizon>, Option<f64>) {
    let start = State {
        y: -1.0,
        vx: v,
        ..State::default()
    };
    let rules = Rules::until(t_end);
    let simulation = Simulation::new(string(1.0, 1.0, 0.5), rules, 0.0, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &[0.0, 0.0, 0.0, doubt, 0.0, 0.0], 1e3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })
    .unwrap();
    let lost = run.modes().get(1).map(|mode| mode.t_start);
    (monitor.verdict().horizon, lost)
}

fn is_of_tension(horizon: Option<Horizon>) -> bool {
    horizon.is_some_and(|horizon| horizon.cause == HorizonCause::Tension { cable: 0 })
}

/// From 2 < v² < 5 on the tension falls through zero in all neighbours, wherever the steps of the
/// series end. If the run ends before it loses the tension, but a neighbour loses it, trust ends.
#[test]
fn a_tension_that_all_neighbours_lose_does_not_end_trust() {
    let (doubt, mut between) = (0.02, 0);
    for k in 0..=60 {
        let v = (3.0 + 0.02 * f64::from(k)).sqrt();
        let (horizon, lost) = swung(v, doubt, 2.5);
        assert!(!is_of_tension(horizon), "{v}: {horizon:?}");
        let lost = lost.unwrap();
        let earliest = [v - doubt, v + doubt].map(|v| swung(v, 0.0, 2.5).1.unwrap());
        let earliest = earliest[0].min(earliest[1]);
        if earliest < lost - 1e-3 {
            let (horizon, _) = swung(v, doubt, 0.5 * (earliest + lost));
            assert!(is_of_tension(horizon), "{v}: {horizon:?}");
            between += 1;
        }
    }
    assert!(between > 20, "{between}");
}

/// Where v² > 5 the tension falls to v² − 5 and rises again. If a neighbour loses it, trust ends
/// before the run is back at the lowest point; if it is many times the deviations, it does not.
#[test]
fn a_tension_that_some_neighbours_lose_ends_trust() {
    for k in 1..=60 {
        let doubt = 5e-4 * f64::from(k);
        let (horizon, lost) = swung(5_f64.sqrt() + 0.9 * doubt, doubt, 3.5);
        assert_eq!(lost, None);
        assert!(is_of_tension(horizon), "{doubt}: {horizon:?}");
        let horizon = horizon.unwrap();
        assert!(horizon.impact == 1 && horizon.t < 3.0, "{horizon:?}");
        let (horizon, _) = swung(5_f64.sqrt() + 20.0 * doubt, doubt, 3.5);
        assert_eq!(horizon, None, "{doubt}");
    }
}

/// A mass that has left its circle flies along a parabola inside it, in all neighbours, and snaps
/// once more where that meets the circle again: until then nothing is in doubt.
#[test]
fn a_string_that_has_been_released_does_not_nearly_snap() {
    for k in 1..30 {
        let v = (2.0 + 0.1 * f64::from(k)).sqrt();
        let lost = swung(v, 0.0, 9.0).1.unwrap();
        // At the height h = (v² − 2)/3 above the anchor, on the circle, it leaves at the
        // speed √h, up at an angle whose cosine is h: on this parabola it meets the
        // circle again after 4 √(h (1 − h²)).
        let h = (v * v - 2.0) / 3.0;
        let flight = 4.0 * (h * (1.0 - h * h)).sqrt();
        for doubt in [0.0, 1e-9, 1e-5] {
            let (horizon, _) = swung(v, doubt, lost + 0.9 * flight);
            assert_eq!(horizon, None, "{v} {doubt:e}");
        }
        let (horizon, _) = swung(v, 0.0, lost + 1.01 * flight);
        assert!(horizon.is_none_or(|horizon| horizon.t > lost + flight - 1e-9));
    }
}

/// Two cables that snap in turn, each half as fast as the one before, come to rest after five snaps
/// below `v_stick`. Where one snap is about as fast as that, neighbours need one more or less.
#[test]
fn a_row_of_slow_snaps_that_may_begin_later_ends_trust() -> Result<(), Unfinished> {
    let case = |v_stick: f64, more: f64| {
        let numbers = [
            ("r", 2.5),
            ("a", 0.2),
            ("b", 0.3),
            ("f_o", 0.05 + more),
            ("nu", 0.63),
            ("omega", 2.76),
            ("e", 0.0),
            ("x", -0.145),
            ("y", 0.338),
            ("theta", -0.13),
            ("t_end", 8.0),
            ("v_stick", v_stick),
        ];
        let entries = numbers.map(|(key, value)| (key, value.into()));
        Case::from_entries(
            entries
                .into_iter()
                .chain([("stop_when_settled", false.into())]),
        )
    };
    let run = case(1e-4, 0.0)?.run();
    let first = run.impacts().iter().find(|snap| snap.v_n < 1e-4).unwrap();
    let doubt = 1e-4;
    let mut uncertainty = Uncertainty {
        tolerance: 0.05,
        ..Uncertainty::default()
    };
    uncertainty.set("f_o", doubt)?;
    for (part, alike) in [(1.0 + 1e-6, false), (1.0 - 1e-6, false), (1.2, true)] {
        let v_stick = part * first.v_n;
        let (run, trust) = trusted_run(&case(v_stick, 0.0)?, &uncertainty, &no_progress)?;
        let mut same = true;
        for side in [-doubt, doubt] {
            same &= case(v_stick, side)?.run().impacts().len() == run.impacts().len();
        }
        assert_eq!(same, alike, "{part}");
        let cable = first.cable;
        let sticking = Some(HorizonCause::Sticking { cable }).filter(|_| !alike);
        let cause = trust.horizon.map(|horizon| horizon.cause);
        assert_eq!(cause, sticking, "{part}");
    }
    Ok(())
}

fn rocking(numbers: &[(&'static str, f64)], body: &str) -> Result<Case, CaseError> {
    let numbers = numbers.iter().map(|(key, value)| (*key, (*value).into()));
    let others = [
        ("e", 0.0.into()),
        ("stop_when_settled", false.into()),
        ("body", body.into()),
    ];
    Case::from_entries(numbers.chain(others))
}

/// About a force a cable snaps while the other is taut, and their coupling is zero: below it the
/// taut cable stays taut, above it leaves and snaps again.
#[test]
fn a_snap_that_hardly_loads_a_taut_cable_ends_trust() -> Result<(), Unfinished> {
    let case = |f_o: f64| {
        let start = [("y", 0.29), ("theta", -0.2), ("t_end", 3.0), ("omega", 1.1)];
        let body = [("r", 2.0), ("a", 0.2), ("f_o", f_o)];
        rocking(&[start.as_slice(), &body].concat(), "rigid")
    };
    let about = 0.529_345_795_285_010_8;
    for (f_o, doubt) in [
        (about, 0.0),
        (about + 1e-16, 0.0),
        (about, 1e-9),
        (0.5293, 1e-3),
    ] {
        let mut uncertainty = Uncertainty {
            tolerance: 0.05,
            ..Uncertainty::default()
        };
        uncertainty.set("f_o", doubt)?;
        let snaps = |f_o: f64| -> Result<usize, Unfinished> {
            let run = case(f_o)?.run();
            Ok(run.impacts().iter().filter(|snap| snap.v_n > 0.0).count())
        };
        let off = doubt.max(1e-15);
        assert_ne!(snaps(f_o - off)?, snaps(f_o + off)?);
        let (_, trust) = trusted_run(&case(f_o)?, &uncertainty, &no_progress)?;
        let cause = trust.horizon.map(|horizon| horizon.cause);
        let passed = matches!(cause, Some(HorizonCause::PassedImpulse { .. }));
        assert!(passed, "{f_o}, {doubt:e}: {cause:?}");
        let (_, trust) = trusted_run(&case(f_o - 4.0 * off - 1e-9)?, &uncertainty, &no_progress)?;
        assert_eq!(trust.horizon, None, "{f_o}, {doubt:e}");
    }
    Ok(())
}

/// Two cables snap in turn, each with 1/23 to 1/36 of the velocity of the one before. Whether a
/// snap loads or unloads the other cable does not depend on how hard it is, so that no doubt
/// grows as the snaps become weaker.
#[test]
fn a_row_of_snaps_in_turn_ends_no_trust() -> Result<(), Unfinished> {
    let case = |side: f64| {
        let place = [
            ("x", 0.0175 - side),
            ("y", 0.292 - side),
            ("theta", -0.0118),
        ];
        let speed = [("vx", -0.2126 + side), ("vy", 0.116), ("vtheta", -0.403)];
        let force = [("f_o", 0.8517), ("nu", 0.7718), ("omega", 0.4798)];
        let body = [("r", 1.2927), ("a", 0.3822), ("b", 0.0), ("t_end", 5.0)];
        rocking(&[place.as_slice(), &speed, &force, &body].concat(), "rigid")
    };
    let run = case(0.0)?.run();
    let cables = |run: &Trajectory| -> Vec<usize> {
        let snaps = run.impacts().iter().filter(|snap| snap.v_n > 0.0);
        snaps.map(|snap| snap.cable).collect()
    };
    let mut ratios = run
        .impacts()
        .windows(2)
        .map(|pair| pair[1].v_n / pair[0].v_n);
    assert_eq!(
        ratios.by_ref().filter(|q| (0.02..0.05).contains(q)).count(),
        7
    );
    for doubt in [1e-12, 1e-8, 1e-6, 1e-5] {
        for side in [-doubt, doubt] {
            assert_eq!(cables(&case(side)?.run()), cables(&run));
        }
        let uncertainty = Uncertainty::of_start(doubt);
        let (_, trust) = trusted_run(&case(0.0)?, &uncertainty, &no_progress)?;
        assert_eq!(trust.horizon, None, "{doubt:e}");
    }
    Ok(())
}

/// Two cables that hold a mass meet at one place, at right angles if r = √2: their coupling is zero
/// for all neighbours.
#[test]
fn a_coupling_that_is_always_zero_is_no_doubt() -> Result<(), Unfinished> {
    for y in [0.2, 0.3, 0.4, 0.5] {
        let numbers = [("r", 2_f64.sqrt()), ("x", 0.1), ("y", y), ("f_o", 0.1)];
        let case = rocking(&numbers, "point")?;
        let mut uncertainty = Uncertainty::default();
        uncertainty.set("f_o", 1e-4)?;
        let (run, trust) = trusted_run(&case, &uncertainty, &no_progress)?;
        let snaps = run.impacts().iter().filter(|snap| snap.v_n > 0.0).count();
        assert_eq!(snaps, 2, "one cable, and the other beside it");
        assert_eq!(trust.horizon, None, "{y}");
    }
    Ok(())
}

/// Two cables with h² = r² − 1 hold a mass in the corner under a unit weight and the force
/// (f cos Ωt, ν f sin Ωt): each tension, a constant ± r/2 (f cos Ωt ± ν/h f sin Ωt),
/// touches zero once in each turn of the force where f √(h² + ν²) = 1, at no particular
/// instant of the computation's steps.
#[test]
fn a_tension_that_nearly_touches_zero_at_any_instant_ends_trust() -> Result<(), Unfinished> {
    for k in 1..=12 {
        let part = f64::from(k) / 12.0;
        let (r, nu, omega) = (1.2 + part, 0.3 + part, 0.4 + 2.5 * part);
        let touch = 1.0 / (r * r - 1.0 + nu * nu).sqrt();
        let case = |f_o: f64| {
            let numbers = [("r", r), ("nu", nu), ("omega", omega), ("f_o", f_o)];
            let rest = [("y", 0.0), ("t_end", 20.0)];
            rocking(&[numbers.as_slice(), &rest].concat(), "point")
        };
        // Within three standard deviations, which are √3 times the uncertainty.
        for (below, size, near) in [
            (1e-10, 1e-10, true),
            (1e-7, 1e-7, true),
            (1e-5, 7e-6, true),
            (1e-5, 5e-6, false),
            (1e-10, 0.0, false),
        ] {
            let mut uncertainty = Uncertainty::default();
            uncertainty.set("f_o", size)?;
            let (run, trust) = trusted_run(&case(touch - below)?, &uncertainty, &no_progress)?;
            assert!(run.impacts().is_empty() && !case(touch + below)?.run().impacts().is_empty());
            let cause = trust.horizon.map(|horizon| horizon.cause);
            let tension = matches!(cause, Some(HorizonCause::Tension { .. }));
            assert!(
                tension == near && (near || cause.is_none()),
                "{k} {below:e}: {cause:?}"
            );
        }
    }
    Ok(())
}

/// Where e = 0 a cable that snaps beside a taut one stays taut if its tension is
/// positive then. About one force it is zero: on one side of it both cables are taut
/// for a moment, on the other never.
#[test]
fn a_snap_after_which_a_tension_is_about_zero_ends_trust() -> Result<(), Unfinished> {
    let case = |f_o: f64| {
        let start = [
            ("x", 0.0057098136921360995),
            ("y", 0.18184010012818216),
            ("vx", 0.2058369849666401),
            ("vy", -0.09270799956104736),
        ];
        let more = [
            ("r", 1.0722091071023863),
            ("nu", 1.325020903270321),
            ("omega", 1.159686941951143),
            ("t_end", 1.2),
            ("f_o", f_o),
        ];
        rocking(&[start.as_slice(), &more].concat(), "point")
    };
    let both_taut = |f_o: f64| -> Result<bool, Unfinished> {
        Ok(case(f_o)?.run().modes().iter().any(|m| m.taut.len() == 2))
    };
    let (mut below, mut above) = (0.79104, 0.79105);
    assert!(both_taut(below)? && !both_taut(above)?);
    for _ in 0..24 {
        let middle = 0.5 * (below + above);
        *(if both_taut(middle)? {
            &mut below
        } else {
            &mut above
        }) = middle;
    }
    for (off, size, near) in [
        (-1e-7, 2e-7, true),
        (1e-7, 2e-7, true),
        (-1e-9, 1e-9, true),
        (1e-9, 1e-9, true),
        (-1e-6, 1e-9, false),
        (1e-6, 1e-9, false),
    ] {
        let mut uncertainty = Uncertainty::default();
        uncertainty.set("f_o", size)?;
        let (_, trust) = trusted_run(&case(above + off)?, &uncertainty, &no_progress)?;
        let cause = trust.horizon.map(|horizon| horizon.cause);
        let tension = matches!(cause, Some(HorizonCause::Tension { .. }));
        assert!(
            tension == near && (near || cause.is_none()),
            "{off:e} {size:e}: {cause:?}"
        );
    }
    Ok(())
}

/// A run that stands still ends as such, however many impacts are allowed, and not certainly.
#[test]
fn a_standstill_is_told_and_is_not_certain() {
    for max_impacts in [3, u64::MAX] {
        let system = string(1.0, 1.0, 0.5);
        let rules = Rules {
            max_impacts,
            ..Rules::until(1.0)
        };
        let start = State::default();
        let mut simulation = Simulation::new(system, rules, 0.0, start).expect("slack");
        let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
        let mut moved = simulation.clone();
        let mut step = moved.step().expect("a flight");
        let idle = (0..10_000).take_while(|_| {
            simulation.idle();
            simulation.stop().is_none()
        });
        assert!(idle.count() >= 1000);
        assert_eq!(simulation.stop(), Some(Stop::Standstill));
        step.stop = simulation.stop();
        monitor.follow(&moved, &step);
        let horizon = monitor.verdict().horizon.expect("an end of trust");
        assert_eq!((horizon.t, horizon.impact), (step.t_end, 1));
    }
}
