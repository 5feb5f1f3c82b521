//! Where several events come at one instant, and which of them is first decides what follows.

use crate::agrees_with_closed_forms::string;
use snapload::analysis::{Horizon, HorizonCause, TrustMonitor, no_progress, record};
use snapload::{
    Body, Cable, Limit, LimitBounds, Rules, Shape, Simulation, State, Stop, System, Trajectory,
};

/// A run without any uncertainty but rounding, and its horizon.
fn followed(system: &System, rules: Rules, start: State) -> (Trajectory, Option<Horizon>) {
    let simulation = Simulation::new(system.clone(), rules, 0.0, start).unwrap();
    let mut monitor = TrustMonitor::new(&simulation, &[0.0; 6], 1e-3);
    let run = record(simulation, &no_progress, |simulation, step| {
        monitor.follow(simulation, step);
    })
    .unwrap();
    (run, monitor.verdict().horizon)
}

/// A turning disc that hangs on a string from its centre, above the anchor's circle.
fn disc() -> (System, State) {
    let system = System {
        body: Body::rigid(Shape::Circle { radius: 0.2 }, 0.1),
        ..string(1.0, 1.0, 0.5)
    };
    let start = State {
        y: -0.5,
        vtheta: 0.5,
        ..State::default()
    };
    (system, start)
}

/// The disc falls by t²/2 and turns by t/2: at t = 1 the string snaps and the rotation is at its
/// limit. One that turns a little slower snaps before.
#[test]
fn a_limit_at_the_instant_of_a_snap_ends_trust() {
    let (system, start) = disc();
    let rules = |above: f64| Rules {
        limits: LimitBounds::none().with(Limit::Rotation, 0.5 + above),
        ..Rules::until(5.0)
    };
    let (run, horizon) = followed(&system, rules(0.0), start);
    assert_eq!(run.end().reason, Stop::RotationLimit);
    let horizon = horizon.unwrap();
    assert_eq!((horizon.cause, horizon.t), (HorizonCause::StopRule, 1.0));
    for (above, impacts) in [(-1e-6, 0), (1e-6, 1)] {
        let (run, horizon) = followed(&system, rules(above), start);
        assert_eq!((run.impacts().len(), horizon), (impacts, None), "{above}");
    }
}

/// Thrown up at 1/2 the disc rises by t/2 − t²/2, which is 0.1 at t = 1/2 − √0.05, where its
/// highest point is at the upper bound and it has turned by t/2.
#[test]
fn two_limits_at_one_instant_end_trust() {
    let (system, start) = disc();
    let start = State { vy: 0.5, ..start };
    let t = 0.5 - 0.05_f64.sqrt();
    let rules = |above: f64| Rules {
        limits: LimitBounds::none()
            .with(Limit::UpperBound, -0.2)
            .with(Limit::Rotation, 0.5 * t + above),
        ..Rules::until(5.0)
    };
    let (_, horizon) = followed(&system, rules(0.0), start);
    let horizon = horizon.unwrap();
    assert_eq!(horizon.cause, HorizonCause::StopRule);
    assert!((horizon.t - t).abs() < 1e-14);
    for (above, reason) in [(-1e-2, Stop::RotationLimit), (1e-2, Stop::UpperBound)] {
        let (run, horizon) = followed(&system, rules(above), start);
        assert_eq!((run.end().reason, horizon), (reason, None));
    }
}

/// A mass swings up on a string, which loses its tension where v² = sin φ, φ above the horizontal.
/// There a second string closes, longer by `more`, at an angle of 2π/3 to the first if it is to
/// load it, and of π/3 if it is to unload it. The run ends soon after.
fn swung(loads: bool, more: f64) -> (Trajectory, Option<Horizon>) {
    let (phi, before) = (0.6_f64, 0.5_f64);
    let along = [phi.cos(), phi.sin()];
    let sign = if loads { -0.5 } else { 0.5 };
    let speed = 0.75_f64.sqrt();
    let n = [
        sign * along[0] - speed * along[1],
        sign * along[1] + speed * along[0],
    ];
    let mut system = string(1.0, 1.0, 0.5);
    let anchor = [along[0] - 2.0 * n[0], along[1] - 2.0 * n[1]];
    let second = Cable::new(anchor, [0.0, 0.0], 2.0 + more);
    system.cables.push(second);
    let v = (3.0 * phi.sin() - 2.0 * before.sin()).sqrt();
    let start = State {
        x: before.cos(),
        y: before.sin(),
        vx: -v * before.sin(),
        vy: v * before.cos(),
        ..State::default()
    };
    followed(&system, Rules::until(0.2), start)
}

/// If the first string is still taut, the snap of the second passes an impulse into it, which stays
/// taut; if it has lost its tension, it snaps by itself and rebounds. Where the snap unloads it, it
/// opens in either order.
#[test]
fn a_tension_lost_at_the_instant_of_a_snap_that_loads_it_ends_trust() {
    let (run, horizon) = swung(true, 0.0);
    let horizon = horizon.unwrap();
    assert_eq!(horizon.cause, HorizonCause::Tension { cable: 0 });
    assert!((horizon.t - run.impacts()[0].t).abs() < 1e-9);
    let rebounds = |more: f64| {
        let (run, _) = swung(true, more);
        let mut impacts = run.impacts().iter();
        impacts.any(|impact| impact.cable == 0 && impact.v_n > 0.1)
    };
    assert_eq!([-1e-3, 1e-3].map(rebounds), [false, true]);

    let (run, horizon) = swung(false, 0.0);
    assert_eq!(horizon, None);
    let t = run.impacts()[0].t;
    for more in [-1e-3, 1e-3] {
        let (other, horizon) = swung(false, more);
        assert_eq!((other.impacts().len(), horizon), (1, None), "{more}");
        assert!((other.impacts()[0].t - t).abs() < 1e-2);
        let (ours, theirs) = (run.end().state, other.end().state);
        for (a, b) in ours.components().into_iter().zip(theirs.components()) {
            assert!((a - b).abs() < 1e-2, "{more}: {a} {b}");
        }
    }
}
