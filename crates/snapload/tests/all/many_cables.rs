//! Three, four and more cables: laws that hold in every run.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::analysis::{Uncertainty, no_progress, trusted_run};
use snapload::{
    Body, Cable, Case, CaseError, Forcing, Harmonic, Impact, Limit, LimitBounds, Parameters,
    Playback, Rules, Shape, Simulation, State, Stop, System, Trajectory, named_case,
};

/// Anchors above the body (the engine's picture is upside down), fairleads on it, and how much
/// longer than their reach at x = y = θ = 0 the cables are; 0 closes several at the start.
fn systems(forced: bool) -> impl Strategy<Value = System> {
    let more = prop_oneof![1 => Just(0.0), 2 => 0.0..0.3];
    let cable = (-1.5..1.5, 0.8..1.5, -0.3..0.3, -0.2..0.2, more);
    let wave = (0.05..0.8, -1.0..1.0, 0.3..3.0);
    let restitution = prop_oneof![Just(0.0), Just(1.0), Just(0.5), 0.0..1.0];
    (prop::collection::vec(cable, 3..6), restitution, wave).prop_map(
        move |(cables, restitution, wave)| {
            let cable = |&(x, y, fx, fy, more): &(f64, f64, f64, f64, f64)| {
                let span: [f64; 2] = [fx - x, fy - y];
                let reach = span[0].hypot(span[1]);
                if more == 0.0 {
                    Cable::taut_at_rest(span, [fx, fy], reach)
                } else {
                    Cable::new([x, y], [fx, fy], reach + more)
                }
            };
            let f_o = if forced { wave.0 } else { 0.0 };
            System {
                body: Body::rigid(Shape::Circle { radius: 0.3 }, 0.05),
                cables: cables.iter().map(cable).collect(),
                forcing: Forcing {
                    constant: [0.0, -1.0].into(),
                    harmonics: vec![Harmonic::ellipse(f_o, wave.1, wave.2)],
                },
                drag: None,
                floating: None,
                restitution,
            }
        },
    )
}

fn run(system: System, t_end: f64, start: State) -> Trajectory {
    let rules = Rules {
        max_impacts: 2000,
        v_stick: 1e-6,
        ..Rules::until(t_end)
    };
    let simulation = Simulation::new(system, rules, 0.0, start).expect("a legal start");
    Trajectory::record(simulation)
}

/// Gaps, tensions and the law of impact along a whole run.
fn holds(run: &Trajectory) -> Result<(), TestCaseError> {
    let system = run.system();
    let mut playback = Playback::new(run);
    for k in 0..=2000 {
        let motion = playback.at(run.end().t * f64::from(k) / 2000.0);
        for (cable, tether) in system.cables.iter().enumerate() {
            let gap = tether.gap(&motion.state);
            prop_assert!(gap <= 1e-9, "gap {gap} of cable {cable} at {}", motion.t);
            prop_assert!(
                motion.tensions[cable] >= -1e-7,
                "tension {} at {}",
                motion.tensions[cable],
                motion.t
            );
        }
    }
    let e = system.restitution;
    for rows in run
        .impacts()
        .chunk_by(|a, b| a.t == b.t && a.before == b.before)
    {
        let (before, after) = (&rows[0].before, &rows[0].after);
        let speed = 1.0 + before.vx.abs() + before.vy.abs() + before.vtheta.abs();
        let mut momentum = [before.vx - after.vx, before.vy - after.vy];
        for row in rows {
            prop_assert!(row.impulse > 0.0);
            let normal = system.cables[row.cable].normal(before);
            let left = normal.velocity(after) + e * row.v_n;
            prop_assert!(left.abs() < 1e-7 * speed, "{left} {row:?}");
            momentum = [
                momentum[0] - row.impulse * normal.n.x,
                momentum[1] - row.impulse * normal.n.y,
            ];
        }
        prop_assert!(
            momentum[0].abs() < 1e-9 * speed && momentum[1].abs() < 1e-9 * speed,
            "{momentum:?}"
        );
    }
    // An impulse may make another closed cable close on, which then snaps by itself at the same
    // time, up to rounding; after the last of these impacts no closed cable closes on.
    for instant in run.impacts().chunk_by(|a, b| b.t - a.t < 1e-12) {
        let Some(Impact { after, .. }) = instant.last() else {
            continue;
        };
        for tether in &system.cables {
            let v = tether.normal(after).velocity(after);
            // A gap of a few roundings is a closed one, unless the bounces themselves are that
            // small.
            let closed = tether.gap(after) > -1e-15 && v > 1e-4;
            prop_assert!(!closed, "a closed cable is passed through: {v}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(1999),
        ..ProptestConfig::default()
    })]

    #[test]
    fn laws_hold_with_many_cables(system in systems(true)) {
        holds(&run(system, 12.0, State::default()))?;
    }

    #[test]
    fn energy_never_rises_without_forcing(system in systems(false), vx in -1.0..1.0f64, vtheta in -2.0..2.0f64) {
        let run = run(system, 12.0, State { vx, vy: -0.5, vtheta, ..State::default() });
        holds(&run)?;
        let mut playback = Playback::new(&run);
        let mut before = f64::INFINITY;
        for k in 0..=2000 {
            let energy = playback.at(run.end().t * f64::from(k) / 2000.0).energy;
            prop_assert!(energy <= before + 1e-9 * (1.0 + before.abs()), "{before} {energy}");
            before = energy;
        }
    }
}

/// Four equal parallel tethers, all of which snap at once: four impulses for three degrees of
/// freedom, equal to each other by least norm and symmetry; and the body comes to rest on them.
#[test]
fn parallel_tethers_share_an_impact_evenly() {
    let tether = |x: f64| Cable::taut_at_rest([0.0, -1.0], [x, 0.0], 1.0);
    let system = System {
        body: Body::rigid(Shape::Circle { radius: 0.3 }, 0.05),
        cables: [-0.3, -0.1, 0.1, 0.3].map(tether).to_vec(),
        forcing: Forcing {
            constant: [0.0, -1.0].into(),
            harmonics: Vec::new(),
        },
        drag: None,
        floating: None,
        restitution: 0.5,
    };
    let start = State {
        vy: -0.4,
        ..State::default()
    };
    let run = run(system, 5.0, start);
    let first = &run.impacts()[..4];
    for (cable, impact) in first.iter().enumerate() {
        assert_eq!(impact.cable, cable);
        assert!((impact.impulse - 0.6 / 4.0).abs() < 1e-12, "{impact:?}");
    }
    assert_eq!(run.end().reason, Stop::EndTime);
    assert!(run.end().state.vy.abs() < 1e-9 && run.end().state.theta.abs() < 1e-9);
}

/// Every line doubled: a pair acts on the body as one line does, and each line of the pair carries
/// half, at impacts and while taut. In the cases the body slides and rocks, and lines become taut
/// and slack.
#[test]
fn twins_do_what_one_line_does_and_carry_half() -> Result<(), CaseError> {
    // One begins with both cables taut.
    let rocking = Parameters {
        y: 0.0,
        a: 0.3,
        stop_when_settled: false,
        t_end: 4.0,
        ..Parameters::STANDARD
    };
    let named = |code| Ok::<_, CaseError>((code, named_case(code)?.parameters));
    let cases = [
        named("sliding-example")?,
        named("1910001000-359")?,
        ("rocking", rocking),
    ];
    let mut carried = 0;
    for (code, parameters) in cases {
        let case = Case::new(parameters)?;
        let simulation = case.simulation();
        let mut twins = simulation.system().clone();
        twins.cables = twins.cables.iter().flat_map(|c| [*c, *c]).collect();
        let rules = *simulation.rules();
        let start = *simulation.state();
        let single = Trajectory::record(simulation);
        let double = Simulation::new(twins, rules, 0.0, start).expect("the same start");
        let double = Trajectory::record(double);

        // Rounding differs, and grows from impact to impact; only certain results are compared.
        let (_, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress).expect("legal");
        let sure = trust.horizon.map_or(f64::INFINITY, |h| h.t);
        let mut pairs = double.impacts().chunks_exact(2);
        let mut compared = 0;
        for (one, known) in single.impacts().iter().zip(&trust.errors) {
            let Some([a, b]) = pairs.next() else {
                panic!("{code}: impacts are missing from {} on", one.t)
            };
            if one.t >= sure || *known > 1e-6 {
                break;
            }
            assert_eq!([a.cable, b.cable], [2 * one.cable, 2 * one.cable + 1]);
            for twin in [a, b] {
                let off = (twin.impulse - 0.5 * one.impulse).abs();
                assert!(off < 1e-6 * (1.0 + one.impulse), "{code}: {off:e}");
                assert!((twin.t - one.t).abs() < 1e-6);
            }
            compared += 1;
        }
        assert!(code == "rocking" || compared > 20, "{code}: {compared}");

        let (mut one, mut two) = (Playback::new(&single), Playback::new(&double));
        for k in 0..2000 {
            let t = single.end().t.min(sure) * f64::from(k) / 2000.0;
            let (one, two) = (one.at(t), two.at(t));
            if one.taut.len() * 2 != two.taut.len() {
                // The instant of a change of mode differs in the last digit.
                continue;
            }
            for cable in one.taut.iter() {
                for twin in [2 * cable, 2 * cable + 1] {
                    let off = (two.tensions[twin] - 0.5 * one.tensions[cable]).abs();
                    assert!(off < 1e-5, "{code} at {t}: {off:e}");
                    carried += 1;
                }
            }
        }
    }
    assert!(carried > 1000, "{carried}");
    Ok(())
}

/// Four equal parallel tethers: released from the side, the body swings as a point on one tether
/// does, and each tether carries a quarter of the tension.
#[test]
fn parallel_tethers_swing_as_one_pendulum() {
    let swing = |lines: &[f64]| {
        let tether = |x: f64| Cable::taut_at_rest([0.0, -1.0], [x, 0.0], 1.0);
        let system = System {
            body: Body::rigid(Shape::Circle { radius: 0.3 }, 0.05),
            cables: lines.iter().map(|x| tether(*x)).collect(),
            forcing: Forcing {
                constant: [0.0, -1.0].into(),
                harmonics: Vec::new(),
            },
            drag: None,
            floating: None,
            restitution: 0.5,
        };
        let start = State {
            x: 0.6,
            y: 0.2,
            ..State::default()
        };
        run(system, 10.0, start)
    };
    let (one, four) = (swing(&[0.0]), swing(&[-0.3, -0.1, 0.1, 0.3]));
    assert_eq!(four.end().reason, Stop::EndTime);
    assert!(four.impacts().is_empty());
    let (mut one, mut four) = (Playback::new(&one), Playback::new(&four));
    for k in 0..=1000 {
        let (one, four) = (one.at(f64::from(k) * 0.01), four.at(f64::from(k) * 0.01));
        assert!((one.state.x - four.state.x).abs() < 1e-12);
        assert!((one.energy - four.energy).abs() < 1e-12);
        assert_eq!(four.taut.len(), 4);
        for cable in 0..4 {
            let off = four.tensions[cable] - 0.25 * one.tensions[0];
            assert!(off.abs() < 1e-9, "{off:e}");
        }
    }
}

/// Moorings in which many cables constrain the same directions: pairs to one fairlead, parallel
/// tethers between which the load shifts, twins that differ slightly, ten lines at one place. Each
/// run reaches its end, and every law holds along it, as it is played back.
#[test]
fn moorings_with_more_lines_than_freedoms_run_to_the_end() {
    type Line = ([f64; 2], [f64; 2]);
    let pairs: Vec<Line> = vec![
        ([1.0, 1.2], [0.2, 0.1]),
        ([0.5, 1.2], [0.2, 0.1]),
        ([-1.0, 1.2], [-0.2, 0.1]),
        ([-0.5, 1.2], [-0.2, 0.1]),
    ];
    let parallel: Vec<Line> = [-0.3, -0.1, 0.1, 0.3]
        .map(|x| ([x, 1.1], [x, 0.0]))
        .to_vec();
    let near: Vec<Line> = [0.0, 1e-7]
        .iter()
        .flat_map(|off| {
            [
                ([1.0 + off, 1.1], [0.1, 0.0]),
                ([-1.0 + off, 1.1], [-0.1, 0.0]),
            ]
        })
        .collect();
    let ten: Vec<Line> = (0..10)
        .map(|k| {
            if k % 2 == 0 {
                ([1.0, 1.1], [0.1, 0.0])
            } else {
                ([-1.0, 1.1], [-0.1, 0.0])
            }
        })
        .collect();
    let waves = [(0.3, 0.5, 0.9), (0.3, 0.871, 0.853), (0.18, 0.7, 1.0)];
    for (name, lines) in [
        ("pairs", pairs),
        ("parallel", parallel),
        ("near", near),
        ("ten", ten),
    ] {
        for (f_o, nu, omega) in waves {
            for e in [0.7, 0.3] {
                let cable = |(anchor, fairlead): &Line| {
                    let span: [f64; 2] = std::array::from_fn(|i| fairlead[i] - anchor[i]);
                    Cable::taut_at_rest(span, *fairlead, span[0].hypot(span[1]))
                };
                let system = System {
                    body: Body::rigid(Shape::Circle { radius: 0.3 }, 0.02),
                    cables: lines.iter().map(cable).collect(),
                    forcing: Forcing {
                        constant: [0.0, -1.0].into(),
                        harmonics: vec![Harmonic::ellipse(f_o, nu, omega)],
                    },
                    drag: None,
                    floating: None,
                    restitution: e,
                };
                let rules = Rules {
                    max_impacts: 20_000,
                    // Parallel tethers coincide where they are level with their anchors.
                    limits: LimitBounds::none().with(Limit::UpperBound, 0.9),
                    v_stick: 1e-6,
                    ..Rules::until(40.0)
                };
                let begun = Simulation::new(system, rules, 0.0, State::default());
                let run = Trajectory::record(begun.expect("a legal start"));
                let case = format!("{name} {f_o} {e}");
                let (reason, t) = (run.end().reason, run.end().t);
                assert!(
                    matches!(reason, Stop::EndTime | Stop::UpperBound),
                    "{case}: {reason:?} at {t}"
                );
                assert!(t > 2.0, "{case} at {t}");
                // With constraints that nearly coincide, roundings are amplified 1e7 times
                // (docs/limits.md).
                if name == "near" {
                    continue;
                }
                holds(&run).unwrap_or_else(|error| panic!("{case}: {error}"));
            }
        }
    }
}

/// A cable counts as resting only if its normal velocity is zero. The bodies hang on four cables,
/// and fast snaps stick, too, so that a cable that is then released has a velocity far above
/// rounding.
#[test]
fn what_rests_has_no_normal_velocity() {
    let mut rested = 0;
    for k in 0..600 {
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let radius = 0.1 + 0.5 * at(2.0);
        let inertia = radius * radius * (0.05 + at(3.0));
        let cables = [5.0, 7.0, 11.0, 13.0].map(|root| {
            let (anchor, angle) = ([3.0 * at(root) - 1.5, 1.0], 9.0 * at(root + 40.0));
            let fairlead = [radius * f64::cos(angle), radius * f64::sin(angle)];
            let reach = f64::hypot(anchor[0] - fairlead[0], anchor[1] - fairlead[1]);
            Cable::new(anchor, fairlead, reach * (1.0 + 0.2 * at(root + 20.0)))
        });
        let system = System {
            body: Body::rigid(Shape::Circle { radius }, inertia),
            cables: cables.to_vec(),
            forcing: Forcing {
                constant: [0.0, -1.0].into(),
                harmonics: vec![Harmonic::ellipse(1.2 * at(17.0), 0.5, 0.5 + 3.0 * at(19.0))],
            },
            drag: None,
            floating: None,
            restitution: 0.2 + 0.7 * at(23.0),
        };
        let rules = Rules {
            v_stick: 0.3 * at(29.0) + 1e-6,
            ..Rules::until(20.0)
        };
        let start = State::default();
        let simulation = Simulation::new(system, rules, 0.0, start);
        let mut simulation = simulation.expect("slack, or taut at rest");
        while simulation.step().is_some() {
            for cable in simulation.resting().iter() {
                let normal = simulation.system().cables[cable].normal(simulation.state());
                let v = normal.velocity(simulation.state());
                let t = simulation.time();
                assert!(v.abs() < 1e-11, "{k}: {v:e} of cable {cable} at t = {t}");
                rested += 1;
            }
        }
    }
    assert!(rested > 1000, "{rested}");
}
