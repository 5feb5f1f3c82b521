//! Motions whose answers are known exactly. The formulas are derived or cited beside each test.

use crate::common::{Breakwater, STANDARD};
use snapload::{Body, Cable, Forcing, Rules, Simulation, State, Stop, System, TautSet, Trajectory};
use std::f64::consts::PI;

/// A point mass on one cable anchored at the origin.
pub fn string(length: f64, weight: f64, restitution: f64) -> System {
    System {
        body: Body::point(),
        cables: vec![Cable::new([0.0, 0.0], [0.0, 0.0], length)],
        forcing: Forcing {
            constant: [0.0, -weight].into(),
            harmonics: vec![],
        },
        drag: None,
        floating: None,
        restitution,
    }
}

fn run(system: System, t_end: f64, v_stick: f64, start: State) -> Trajectory {
    let simulation = Simulation::new(
        system,
        Rules {
            v_stick,
            ..Rules::until(t_end)
        },
        0.0,
        start,
    );
    Trajectory::record(simulation.expect("a legal start"))
}

/// A mass that swings up on a string loses tension where v² = g L sin φ, φ above the horizontal.
/// Its parabola meets the circle again at −3φ exactly, after 4 sqrt(sin φ) cos φ sqrt(L/g).
#[test]
fn a_string_goes_slack_and_snaps() {
    for (phi, length, g) in [
        (0.6_f64, 1.0_f64, 1.0_f64),
        (0.2, 1.0, 1.0),
        (1.2, 0.7, 2.0),
        (0.9, 2.0, 0.4),
    ] {
        let at_bottom = (g * length * (3.0 * phi.sin() + 2.0)).sqrt();
        let start = State {
            y: -length,
            vx: at_bottom,
            ..State::default()
        };
        let run = run(string(length, g, 0.5), 40.0, 1e-6, start);
        let modes = run.modes();
        assert_eq!(modes[0].taut, TautSet::only(0));
        assert_eq!(modes[1].taut, TautSet::SLACK);
        let release = run.at(modes[1].t_start).state;
        assert!(
            (release.y.atan2(release.x) - phi).abs() < 1e-10,
            "φ = {phi}"
        );
        let snap = run.impacts()[0];
        let flight = 4.0 * phi.sin().sqrt() * phi.cos() * (length / g).sqrt();
        assert!(
            (snap.t - modes[1].t_start - flight).abs() < 1e-9,
            "φ = {phi}"
        );
        let angle = snap.before.y.atan2(snap.before.x);
        let known = -3.0 * phi;
        assert!(
            ((angle - known) / (2.0 * PI))
                .rem_euclid(1.0)
                .min(1.0 - ((angle - known) / (2.0 * PI)).rem_euclid(1.0))
                < 1e-10
        );
        // The parabola in the frame of the release: radial speed at the snap.
        let (v, t) = ((g * length * phi.sin()).sqrt(), flight);
        let (x, y) = (
            length * phi.cos() - v * phi.sin() * t,
            length * phi.sin() + v * phi.cos() * t - 0.5 * g * t * t,
        );
        let (vx, vy) = (-v * phi.sin(), v * phi.cos() - g * t);
        let radial = (x * vx + y * vy) / length;
        assert!((snap.v_n - radial).abs() < 1e-9);
        if (phi, length, g) == (0.6, 1.0, 1.0) {
            assert!((flight - 2.480_717_722).abs() < 1e-9);
            assert!((snap.v_n - 1.908_279_834).abs() < 1e-9);
        }
    }
}

/// Impacts accumulate inside a circle without weight: each rebound shortens the chord, until the
/// mass slides along the circle at its tangential speed, which no impact changes.
#[test]
fn impacts_accumulate_in_a_circle() {
    for (radius, e, v_n, v_t) in [
        (1.0_f64, 0.5_f64, 0.7_f64, 0.4_f64),
        (1.0, 0.9, 0.7, 0.4),
        (2.0, 0.3, 1.5, -0.8),
        (0.5, 0.7, 0.1, 1.0),
    ] {
        let (mut time, mut angle) = (0.0, 0.0);
        let mut v = v_n;
        while v > 1e-18 {
            time += 2.0 * radius * v / (v_t * v_t + v * v);
            angle += 2.0 * (v / v_t).atan();
            v *= e;
        }
        if (radius, e, v_n, v_t) == (1.0, 0.5, 0.7, 0.4) {
            assert!((time - 8.597_943_306).abs() < 1e-9 && (angle - 5.233_006_209).abs() < 1e-9);
        }
        let start = State {
            x: radius,
            vx: -v_n,
            vy: v_t,
            ..State::default()
        };
        let later = time + 3.0;
        let run = run(string(radius, 0.0, e), later, 1e-9, start);
        let last = run.modes()[1];
        assert_eq!(last.taut, TautSet::only(0), "it slides at the end");
        // The series is cut where v_n < v_stick; its remainder is 2 R e v_n / ((1 − e) v_t²).
        let rest = 2.0 * radius * e * 1e-9 / ((1.0 - e) * v_t * v_t);
        assert!(last.t_start <= time + 1e-11 && time - last.t_start < rest + 1e-11);
        let end = run.at(later).state;
        let known = angle + 3.0 * v_t / radius;
        assert!(
            (end.x - radius * known.cos()).abs() < 1e-8,
            "{radius} {e}: {end:?}"
        );
        assert!((end.y - radius * known.sin()).abs() < 1e-8);
        assert!((end.vx.hypot(end.vy) - v_t.abs()).abs() < 1e-12);
    }
}

/// Both cables snap at one instant and the body rebounds vertically: a bouncing ball, whose bounces
/// accumulate at sqrt(2 y0)(1 + e)/(1 − e).
#[test]
fn the_symmetric_drop_is_a_bouncing_ball() {
    for e in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95] {
        for (y0, a, b) in [(1.0 / 9.8, 0.1, 0.0), (0.04, 0.2, 0.1), (0.1, 0.3, 0.3)] {
            let it = Breakwater {
                e,
                a,
                b,
                f_o: 0.0,
                start: State {
                    y: y0,
                    ..State::default()
                },
                ..STANDARD
            };
            let run = it.run();
            assert_eq!(run.end().reason, Stop::Settled);
            assert!(
                run.impacts()
                    .iter()
                    .all(|i| i.before.x == 0.0 && i.after.vtheta == 0.0)
            );
            assert_eq!(run.impacts().len() % 2, 0, "two at a time");
            let known = (2.0 * y0).sqrt() * (1.0 + e) / (1.0 - e);
            if let Some(limit) = run.end().t_limit {
                assert!((limit - known).abs() < 1e-12, "e = {e}: {limit} {known}");
            } else {
                assert!(run.impacts().len() < 10, "e = {e}");
                assert!((run.end().t - known).abs() < 1e-4);
            }
        }
    }
    // A widely used solver documents this value, with wrong last digits.
    let ball: f64 = (2.0_f64 / 9.8).sqrt() * 3.0;
    assert!((ball - 1.355_261_854_357_876_7).abs() < 1e-15);
}

fn agm(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

/// With a = 1 the cables are parallel and rocking is the translation of a pendulum of length r.
#[test]
fn parallel_cables_make_a_pendulum() {
    for (r, amplitude) in [(2.5_f64, 1.0_f64), (2.5, 0.3), (1.5, 0.7), (4.0, -1.2)] {
        let it = Breakwater {
            r,
            a: 1.0,
            f_o: 0.0,
            settle: false,
            t_end: 30.0,
            start: State {
                x: r * amplitude.sin(),
                y: r * (1.0 - amplitude.cos()),
                ..State::default()
            },
            ..STANDARD
        };
        let run = it.run();
        assert_eq!(run.end().reason, Stop::EndTime);
        assert_eq!(run.modes().len(), 1);
        let period = 2.0 * PI * r.sqrt() / agm(1.0, (amplitude / 2.0).cos());
        if (r, amplitude) == (2.5, 1.0) {
            assert!((period / (2.0 * PI * r.sqrt()) - 1.066_334_246).abs() < 1e-9);
        }
        for (fraction, x) in [(0.25, 0.0), (0.5, -it.start.x), (1.0, it.start.x)] {
            let state = run.at(fraction * period).state;
            assert!(
                (state.x - x).abs() < 1e-10,
                "r = {r}, {fraction} periods: {state:?}"
            );
            assert!(state.theta.abs() < 1e-12);
        }
    }
}

/// Small rocking about θ = 0: frequency² = y''/(I + x'²), with x(θ), y(θ) of chapter eqs 6.61-6.62:
/// x' = −h a/(1 − a), y'' = a/h + a h/(1 − a)² − a h/(1 − a).
#[test]
fn small_rocking_has_the_known_frequency() {
    for (r, a) in [(1.5, 0.1), (2.5, 0.1), (1.5, 0.3), (1.2, 0.5)] {
        let mut it = Breakwater {
            r,
            a,
            f_o: 0.0,
            settle: false,
            ..STANDARD
        };
        let h = it.h();
        let slope = -h * a / (1.0 - a);
        let curvature = a / h + a * h / (1.0 - a).powi(2) - a * h / (1.0 - a);
        let omega = (curvature / (it.inertia() + slope * slope)).sqrt();
        let theta = 1e-5;
        it.start = State {
            x: slope * theta,
            y: 0.5 * curvature * theta * theta,
            theta,
            ..State::default()
        };
        it.t_end = 20.0;
        let run = it.run();
        assert_eq!(run.modes().len(), 1, "it stays in rocking");
        for t in [1.0, 5.0, 19.0] {
            let known = theta * (omega * t).cos();
            // The linear theory neglects terms of the third power of the amplitude.
            let found = run.at(t).state.theta;
            assert!(
                (found - known).abs() < 1e-8 * theta + 1e3 * theta.powi(3) * t,
                "{r} {a} {t}: {found} {known}"
            );
        }
    }
}

/// Free sliding conserves energy, and each single impact loses (1 − e²) v_n²/(2w).
#[test]
fn each_impact_loses_energy_by_its_effective_mass() {
    for e in [0.0, 0.4, 0.9, 1.0] {
        let it = Breakwater { e, ..STANDARD };
        let run = it.run();
        let system = it.system();
        for impact in run.impacts() {
            let normal = system.cables[impact.cable].normal(&impact.before);
            let w = normal.coupling(&normal, system.body.inverse_inertia());
            let known = (1.0 - e * e) * impact.v_n.powi(2) / (2.0 * w);
            assert!((impact.energy_lost - known).abs() < 1e-14);
            let fell = system.energy(&impact.before) - system.energy(&impact.after);
            assert!((fell - known).abs() < 1e-14, "e = {e}");
        }
    }
}

/// A cable started exactly at rest on its circle with tension slides at once; pushed inward it
/// flies; pushed outward it snaps at t = 0.
#[test]
fn starts_on_the_boundary_do_what_the_signs_say() {
    let base = Breakwater {
        f_o: 0.0,
        settle: false,
        t_end: 0.5,
        ..STANDARD
    };
    // On g2 = 0 at θ = 0: the centre is on the circle of radius r about (−1 + a, h).
    let (r, h, alpha) = (base.r, base.h(), 0.7_f64);
    let on = State {
        x: -1.0 + base.a + r * alpha.sin(),
        y: h - r * alpha.cos(),
        ..State::default()
    };
    let with = |start: State| Breakwater { start, ..base }.run();
    let rest = with(on);
    assert_eq!(rest.modes()[0].taut, TautSet::only(1));
    assert!(rest.impacts().is_empty() || rest.impacts()[0].t > 0.0);
    let along = with(State {
        vx: alpha.cos(),
        vy: alpha.sin(),
        ..on
    });
    assert_eq!(along.modes()[0].taut, TautSet::only(1));
    let inward = with(State {
        vx: -0.3 * alpha.sin(),
        vy: 0.3 * alpha.cos(),
        ..on
    });
    assert_eq!(inward.modes()[0].taut, TautSet::SLACK);
    assert!(inward.impacts().is_empty() || inward.impacts()[0].t > 0.0);
    let outward = with(State {
        vx: 0.3 * alpha.sin(),
        vy: -0.3 * alpha.cos(),
        ..on
    });
    assert_eq!(outward.impacts()[0].t, 0.0);
    assert!((outward.impacts()[0].v_n - 0.3).abs() < 1e-12);
    assert_eq!(outward.modes()[0].t_start, 0.0);
    // A gap within 1e-9 counts as closed, one beyond is an error or flight.
    let near = |offset: f64| State {
        x: on.x + offset * alpha.sin(),
        y: on.y - offset * alpha.cos(),
        ..on
    };
    assert_eq!(with(near(3e-10)).modes()[0].taut, TautSet::only(1));
    assert_eq!(with(near(-3e-10)).modes()[0].taut, TautSet::only(1));
    assert_eq!(with(near(-1e-8)).modes()[0].taut, TautSet::SLACK);
    let too_far = Simulation::new(base.system(), base.rules(), 0.0, near(1e-8));
    assert!(too_far.is_err());
}
