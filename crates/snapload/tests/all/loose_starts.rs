//! Trust in runs that begin at the end of a cable, where neighbours may begin slack.

use crate::agrees_with_closed_forms::string;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::analysis::{Horizon, HorizonCause, Trust, TrustMonitor, no_progress, record};
use snapload::{
    Body, Cable, Forcing, Harmonic, Rules, Shape, Simulation, State, System, Trajectory,
};

/// Cables stick below 1e-6, and no run goes on for long.
fn rules(t_end: f64) -> Rules {
    Rules {
        v_stick: 1e-6,
        max_impacts: 60,
        ..Rules::until(t_end)
    }
}

fn followed(system: &System, start: State, doubts: [f64; 6], t_end: f64) -> (Trajectory, Trust) {
    let simulation = Simulation::new(system.clone(), rules(t_end), 0.0, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &doubts, 1e3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })
    .unwrap();
    (run, monitor.verdict())
}

fn begins_doubtful(trust: &Trust) -> bool {
    let start = HorizonCause::Start { cable: 0 };
    trust
        .horizon
        .is_some_and(|h| h.cause == start && h.t == 0.0)
}

/// A mass at the lower end of a string of length 1 with weight 1.
fn at_end(vx: f64, vy: f64) -> State {
    State {
        y: -1.0,
        vx,
        vy,
        ..State::default()
    }
}

/// Thrown up at v it is back after v + √(v² + 2u) if it begins u above the end, all of u ≥ 0 being
/// legal: to first order u/v later, and faster by u/v.
#[test]
fn neighbours_that_are_thrown_up_slack_come_back_a_little_later() {
    let system = string(1.0, 1.0, 0.5);
    for (v, doubt) in [(0.5, 1e-8), (0.5, 1e-4), (1.0, 1e-3), (0.01, 1e-6)] {
        let doubts = [0.0, doubt, 0.0, 0.0, 0.0, 0.0];
        // It comes back at v, and is thrown up at v/2.
        let (run, trust) = followed(&system, at_end(0.0, v), doubts, 2.5 * v);
        assert_eq!((run.impacts().len(), trust.horizon), (1, None), "{v}");
        let later = v + (v * v + 2.0 * doubt).sqrt() - 2.0 * v;
        let error = trust.errors[0] / later;
        assert!((1.0..1.2).contains(&error), "{v} {doubt}: {error}");
        let (_, trust) = followed(&system, at_end(0.0, v), doubts, 1.5 * v);
        assert_eq!(trust.horizon, None);
    }
}

/// Thrown down at v it snaps at once, and u above the end after √(v² + 2u) − v.
#[test]
fn neighbours_that_are_thrown_down_slack_snap_a_little_later() {
    let system = string(1.0, 1.0, 0.5);
    for (v, doubt) in [(0.5, 1e-8), (0.5, 1e-4), (2.0, 1e-3), (0.01, 1e-6)] {
        let doubts = [0.0, doubt, 0.0, 0.0, 0.0, 0.0];
        let (run, trust) = followed(&system, at_end(0.0, -v), doubts, 0.5 * v);
        assert_eq!((run.impacts()[0].t, trust.horizon), (0.0, None), "{v}");
        let later = (v * v + 2.0 * doubt).sqrt() - v;
        let error = trust.errors[0] / later;
        assert!((1.0..1.2).contains(&error), "{v} {doubt}: {error}");
    }
}

/// A neighbour is in doubt if it may snap where the run opens, for its velocity or for
/// the direction of its string; if it may bounce where the run hangs; and if it may be
/// slack beside a cable that is taut.
#[test]
fn neighbours_that_may_begin_otherwise_end_trust_at_once() {
    let system = string(1.0, 1.0, 0.5);
    let doubtful = |start: State, doubts: [f64; 6]| {
        let (_, trust) = followed(&system, start, doubts, 0.1);
        begins_doubtful(&trust)
    };
    for (vy, doubt, expected) in [
        (1e-3, 1e-3, true),
        (1e-3, 6e-4, true),
        (1e-3, 5e-4, false),
        (-1e-3, 1e-3, true),
        (-1e-3, 5e-4, false),
        (0.0, 1e-6, true),
        (0.0, 1e-10, false),
    ] {
        let doubts = [0.0, 0.0, 0.0, 0.0, doubt, 0.0];
        assert_eq!(doubtful(at_end(0.0, vy), doubts), expected, "{vy} {doubt}");
    }
    for (vy, doubt, expected) in [(1e-3, 1e-3, true), (1e-3, 5e-4, false), (0.0, 1e-6, true)] {
        // With the string turned by δ the velocity 1 across it is δ along it.
        let doubts = [doubt, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(doubtful(at_end(1.0, vy), doubts), expected, "{vy} {doubt}");
    }
    assert!(doubtful(at_end(0.0, 0.0), [0.0, 1e-6, 0.0, 0.0, 0.0, 0.0]));
}

/// The direction of a cable, how far its anchor is, its fairlead, and by how much it is slack.
type Line = ((f64, f64, f64, f64), f64);

/// Cables on which a body begins at the end of its first cable, or of all, and how it moves: along
/// that cable slowly or fast, inwards mostly; and how uncertain that is.
fn starts() -> impl Strategy<Value = (System, State, f64)> {
    let cable = (0.0..std::f64::consts::TAU, 0.6..1.6, -0.2..0.2, -0.2..0.2);
    let more = prop_oneof![1 => Just(0.0), 3 => 0.001..0.4];
    let wave = (0.0..0.8, 0.3..4.0, 0.0..6.0, 0.0..6.0);
    let along = (-4.0..0.3, prop::bool::weighted(0.8));
    let velocity = (along, -1.0..1.0, -2.0..2.0);
    let cables = prop::collection::vec((cable, more), 1..4);
    let rest = (
        (prop::bool::ANY, prop::bool::ANY),
        0.0..6.0,
        prop_oneof![Just(0.0), Just(0.5), Just(1.0)],
    );
    (cables, wave, velocity, rest, -8.0..-2.5).prop_map(
        |(cables, wave, ((size, inwards), across, spin), ((point, heavy), down, e), doubt)| {
            let disc = Shape::Circle { radius: 0.3 };
            let at = |angle: f64| [f64::cos(angle), f64::sin(angle)];
            let cable = |(k, given): (usize, &Line)| {
                let ((angle, length, fx, fy), more) = *given;
                let [x, y] = at(angle).map(|d| -length * d);
                let fairlead = if point { [0.0, 0.0] } else { [fx, fy] };
                let more = if k == 0 { 0.0 } else { more };
                let length = (fairlead[0] - x).hypot(fairlead[1] - y) + more;
                Cable::new([x, y], fairlead, length)
            };
            let system = System {
                body: if point {
                    Body::point()
                } else if heavy {
                    let mass = [[2.5, 0.0, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 0.05]];
                    Body::with_mass_matrix(disc, mass).unwrap()
                } else {
                    Body::rigid(disc, 0.05)
                },
                cables: cables.iter().enumerate().map(cable).collect(),
                forcing: Forcing {
                    constant: at(down).into(),
                    harmonics: vec![Harmonic::with_phases(
                        wave.1,
                        [wave.0, 0.5 * wave.0],
                        [wave.2, wave.3],
                    )],
                },
                drag: None,
                floating: None,
                restitution: e,
            };
            let n = at(cables[0].0.0);
            let along = 10_f64.powf(size) * if inwards { -1.0 } else { 1.0 };
            let start = State {
                vx: along * n[0] - across * n[1],
                vy: along * n[1] + across * n[0],
                vtheta: if point { 0.0 } else { spin },
                ..State::default()
            };
            (system, start, 10_f64.powf(doubt))
        },
    )
}

/// Numbers between −1 and 1, the sum of whose squares is 3 at most: within three standard
/// deviations of a neighbour along any direction.
fn draw(k: u64) -> [f64; 6] {
    let mut bits = k.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let numbers = [0; 6].map(|_| {
        bits ^= bits >> 29;
        bits = bits.wrapping_mul(0xBF58_476D_1CE4_E5B9).wrapping_add(k);
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    });
    let square: f64 = numbers.iter().map(|number| number * number).sum();
    numbers.map(|number| number / (square / 3.0).sqrt().max(1.0))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    /// Up to the horizon all neighbours have the same impacts.
    #[test]
    fn neighbours_have_the_same_impacts_up_to_the_horizon((system, start, doubt) in starts()) {
        let turns = f64::from(start.vtheta != 0.0);
        let doubts = [doubt, doubt, turns * doubt, doubt, doubt, turns * doubt];
        let Ok(simulation) = Simulation::new(system.clone(), rules(1.5), 0.0, start) else {
            return Ok(());
        };
        let mut monitor = TrustMonitor::new(&simulation, &doubts, 1e-3);
        let run = record(simulation, &no_progress, |simulation, step| monitor.follow(simulation, step)).unwrap();
        let horizon = monitor.verdict().horizon;
        let known = known(&run, horizon);
        for k in 1..=24 {
            let (draw, ours) = (draw(k), start.components());
            let theirs = std::array::from_fn(|i| ours[i] + doubts[i] * draw[i]);
            let theirs = State::from_components(theirs);
            let Ok(simulation) = Simulation::new(system.clone(), rules(1.5), 0.0, theirs) else {
                continue;
            };
            let other = Trajectory::record(simulation);
            let cables: Vec<usize> = other.impacts().iter().map(|impact| impact.cable).collect();
            match horizon {
                Some(_) => prop_assert!(cables.starts_with(&known), "{cables:?} {known:?} {horizon:?}"),
                None => prop_assert_eq!(&cables, &known),
            }
        }
    }
}

/// The cables of the impacts before the horizon.
fn known(run: &Trajectory, horizon: Option<Horizon>) -> Vec<usize> {
    let impacts = run.impacts().iter();
    let count = horizon.map_or(usize::MAX, |horizon| horizon.impact - 1);
    impacts.take(count).map(|impact| impact.cable).collect()
}
