//! Where trust ends because neighbours have, in flight, an event that the run nearly has.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{
    Horizon, HorizonCause, TrustMonitor, Uncertainty, Unfinished, no_progress, record, trusted_run,
};
use snapload::{
    Cable, Case, Harmonic, Limit, LimitBounds, Parameters, Rules, Simulation, State, Stop, System,
};

/// The horizon of a run whose start may be off by `doubts`.
fn horizon(system: &System, rules: Rules, start: State, doubts: [f64; 6]) -> Option<Horizon> {
    let simulation = Simulation::new(system.clone(), rules, 0.0, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &doubts, 1e3);
    record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })
    .unwrap();
    monitor.verdict().horizon
}

fn cause(horizon: Option<Horizon>) -> Option<HorizonCause> {
    horizon.map(|horizon| horizon.cause)
}

/// A mass on a string of length 1, thrown so that its highest point is at 1 − `short` when it is
/// below the anchor's vertical; then it falls, and the string snaps taut below.
fn thrown(short: f64) -> State {
    let vy = (2.0 * (1.0 - short)).sqrt();
    State {
        x: -0.3 * vy,
        vx: 0.3,
        vy,
        ..State::default()
    }
}

/// If y and ẏ are off by up to δ, the standard deviation of the height of the throw
/// is δ for ẏ = √2: within three of them the string snaps at the top if δ is more
/// than a third of what is missing.
#[test]
fn a_string_that_nearly_snaps_before_it_snaps_ends_trust() {
    for short in [1e-6, 1e-4, 1e-3] {
        for (part, near) in [(1.0, true), (0.4, true), (0.3, false), (0.0, false)] {
            let doubt = part * short;
            let (system, start) = (string(1.0, 1.0, 0.5), thrown(short));
            let doubts = [0.0, doubt, 0.0, 0.0, doubt, 0.0];
            let found = horizon(&system, Rules::until(5.0), start, doubts);
            if near {
                assert_eq!(cause(found), Some(HorizonCause::NearMiss { cable: 0 }));
                // Neighbours that snap do so where 2 short < 6 δ − 0.91 t², t from the top.
                let early = (4.0 * short / 0.91_f64).sqrt() + 1e-4;
                let from_top = found.map(|found| found.t - start.vy).unwrap();
                assert!(-early < from_top && from_top <= 1e-6, "{from_top}");
                assert_eq!(found.map(|found| found.impact), Some(1));
            } else {
                assert!(found.is_none_or(|found| found.impact > 1), "{found:?}");
            }
        }
    }
}

/// y = v t + (1 − cos 2t)/5 has its maxima at cos 2t < 0 and sin 2t = −5v/2. A bound a little above
/// one of them is reached half a turn of the wave later.
#[test]
fn a_limit_that_is_nearly_reached_before_it_is_reached_ends_trust() {
    let v: f64 = 0.0225;
    let above = 1e-6;
    for turn in [2.0, 5.0, 8.0] {
        let t = 0.5 * ((2.5 * v).asin() + std::f64::consts::PI * (1.0 + 2.0 * turn));
        let top = v * t + 0.2 * (1.0 - (2.0 * t).cos());
        let mut system = string(50.0, 0.0, 0.5);
        system.forcing.harmonics = vec![Harmonic::with_phases(2.0, [0.0, 0.8], [0.0, 0.0])];
        let rules = Rules {
            limits: LimitBounds::none().with(Limit::UpperBound, top + above),
            ..Rules::until(40.0)
        };
        let start = State {
            vy: v,
            ..State::default()
        };
        for (part, near) in [(3.0, true), (0.75, true), (0.4, false), (0.0, false)] {
            // The standard deviation of the height is t δ/√3.
            let doubt = part * above / t;
            let found = horizon(&system, rules, start, [0.0, 0.0, 0.0, 0.0, doubt, 0.0]);
            let expected = Some(HorizonCause::StopRule).filter(|_| near);
            assert_eq!(cause(found), expected, "{turn} {part}");
            assert!(found.is_none_or(|found| t - 0.1 < found.t && found.t <= t + 1e-6));
        }
    }
}

/// Thrown up at v from 1/2 below a bound a mass is v²/2 higher at t = v. What comes later, here two
/// cables that snap at one instant or the end of time, does not hide that neighbours reach the
/// bound.
#[test]
fn a_graze_of_a_limit_is_not_hidden_by_a_later_event() {
    let mut system = string(1.25, 1.0, 0.5);
    system.cables = [-1.0, 1.0]
        .map(|side| Cable::new([side, 0.75], [0.0, 0.0], 1.25))
        .into();
    for (v, doubt, t_end) in [(1.0 - 1e-5, 1e-4, 3.0), (1.0, 0.0, 3.0), (1.0, 0.0, 2.0)] {
        let rules = Rules {
            limits: LimitBounds::none().with(Limit::UpperBound, 0.75),
            ..Rules::until(t_end)
        };
        let start = State {
            y: 0.25,
            vy: v,
            ..State::default()
        };
        let found = horizon(&system, rules, start, [0.0, 0.0, 0.0, 0.0, doubt, 0.0]);
        let found = found.expect("neighbours that reach the bound");
        assert_eq!(found.cause, HorizonCause::StopRule, "{v} {t_end}");
        assert!(
            (0.9..1.0 + 1e-6).contains(&found.t),
            "{v} {t_end}: {}",
            found.t
        );
    }
}

/// A run that ends shortly before a snap is not certain if a neighbour has that snap before its
/// end. Neighbours reach it the earlier, the earlier they had the snap before.
#[test]
fn an_end_before_which_a_neighbour_snaps_once_more_is_not_certain() -> Result<(), Unfinished> {
    let case = |y: f64, t_end: f64| {
        Case::new(Parameters {
            y,
            t_end,
            ..Parameters::STANDARD
        })
    };
    let (y, doubt) = (Parameters::STANDARD.y, 1e-7);
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("y", doubt)?;
    let times = |y: f64| -> Result<Vec<f64>, Unfinished> {
        let run = case(y, 4.0)?.run();
        Ok(run.impacts().iter().map(|impact| impact.t).collect())
    };
    let (run, lower, upper) = (times(y)?, times(y - doubt)?, times(y + doubt)?);
    for k in 2..12 {
        let sooner = run[k] - lower[k].min(upper[k]);
        assert!(sooner > 1e-9 && run[k] - run[k - 1] > 100.0 * sooner, "{k}");
        for (part, certain) in [(0.5, false), (0.9, false), (2.5, true)] {
            let end = case(y, run[k] - part * sooner)?;
            let (_, trust) = trusted_run(&end, &uncertainty, &no_progress)?;
            assert_eq!(trust.decides_the_end(), certain, "{k} {part}");
        }
    }
    Ok(())
}

/// A pair of equal strings from one anchor does what one of them does: trust ends where it does for
/// one string, for the same reason. A ball that bounces on it, and its steps, one of which nearly
/// misses the end of the string.
#[test]
fn a_pair_of_equal_strings_is_trusted_like_one() {
    let bouncing = State {
        y: -0.7,
        x: 0.1,
        ..State::default()
    };
    let mut seen = Vec::new();
    for (start, doubt) in [
        (bouncing, 0.0),
        (bouncing, 1e-6),
        (thrown(-1e-4), 2e-4),
        (thrown(1e-4), 2e-4),
    ] {
        let doubts = [0.0, doubt, 0.0, 0.0, doubt, 0.0];
        let one = string(1.0, 1.0, 0.5);
        let mut pair = one.clone();
        pair.cables.push(one.cables[0]);
        let rules = Rules {
            v_stick: 1e-4,
            ..Rules::until(12.0)
        };
        let [one, pair] = [one, pair].map(|system| horizon(&system, rules, start, doubts));
        assert_eq!(cause(one), cause(pair), "{one:?} {pair:?}");
        if let (Some(one), Some(pair)) = (one, pair) {
            assert!((one.t - pair.t).abs() < 1e-3, "{one:?} {pair:?}");
            // Each snap of the pair is two rows of the table.
            assert_eq!(2 * (one.impact - 1), pair.impact - 1);
        }
        seen.push(cause(one));
    }
    let graze = Some(HorizonCause::Graze { cable: 0 });
    assert!(seen[0].is_none() && seen[2] == graze, "{seen:?}");
}

/// After its first snap the mass rises to just below the upper bound, and neighbours that started
/// apart come together until the end: what they reach there is not what they reached at the top.
#[test]
fn a_limit_that_neighbours_reach_before_they_come_together_is_not_certain() -> Result<(), Unfinished>
{
    let start = Parameters {
        r: 1.75784207804673,
        e: 0.8081804326314286,
        f_o: 0.0,
        x: -0.7567549475126879,
        y: 1.4281843818901718,
        vx: -0.552041535045452,
        vy: 0.1751418534888889,
        stop_when_settled: false,
        t_end: 1.3,
        a: 0.0,
        b: 0.0,
        inertia: None,
        ..Parameters::STANDARD
    };
    let doubt = 0.00077;
    let mut uncertainty = Uncertainty::default();
    uncertainty.set("y", doubt)?;
    let (run, trust) = trusted_run(&Case::new(start)?, &uncertainty, &no_progress)?;
    let higher = Case::new(Parameters {
        y: start.y + 0.9 * doubt,
        ..start
    })?;
    assert_eq!(run.end().reason, Stop::EndTime);
    assert_eq!(higher.run().end().reason, Stop::UpperBound);
    assert!(!trust.decides_the_end());
    Ok(())
}
