//! Motion with drag: known solutions, and laws that hold for any motion.

use crate::common::unending;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use snapload::{
    Body, Cable, Drag, Forcing, Harmonic, Rules, Shape, Simulation, State, System, Tangent,
    Trajectory, Vector2,
};

const NO_DRAG: Drag = Drag {
    linear: 0.0,
    quadratic: 0.0,
    turning: 0.0,
    water: Vec::new(),
};

/// A point mass under a constant force, on a cable so long that it is never taut.
fn falling(force: [f64; 2], drag: Drag) -> System {
    System {
        body: Body::point(),
        cables: vec![Cable::new([0.0, 0.0], [0.0, 0.0], 1e3)],
        forcing: Forcing {
            constant: force.into(),
            harmonics: vec![],
        },
        drag: Some(drag),
        floating: None,
        restitution: 0.5,
    }
}

fn run(system: System, t_end: f64, start: State) -> Trajectory {
    let simulation = Simulation::new(
        system,
        Rules {
            v_stick: 1e-6,
            ..Rules::until(t_end)
        },
        0.0,
        start,
    );
    Trajectory::record(simulation.expect("a legal start"))
}

/// v̇ = g − c v: v = g/c + (v₀ − g/c) e^{−ct}, from t = 0 and in any direction.
#[test]
fn linear_drag_has_its_exponential() {
    for (c, force, vx) in [
        (0.7_f64, [0.3_f64, -1.0_f64], 2.0_f64),
        (4.0, [0.0, -0.5], 0.0),
        (0.01, [1.0, 0.2], -3.0),
    ] {
        let drag = Drag {
            linear: c,
            ..NO_DRAG
        };
        let start = State {
            vx,
            vy: 0.4,
            ..State::default()
        };
        let run = run(falling(force, drag), 6.0, start);
        for k in 0..=60 {
            let t = 0.1 * f64::from(k);
            let state = run.at(t).state;
            let known = |v: f64, f: f64| {
                let (limit, left) = (f / c, (-c * t).exp());
                let way = limit * t + (v - limit) * (1.0 - left) / c;
                (limit + (v - limit) * left, way)
            };
            let ((ux, x), (uy, y)) = (known(vx, force[0]), known(0.4, force[1]));
            for (ours, theirs) in [(state.vx, ux), (state.x, x), (state.vy, uy), (state.y, y)] {
                let scale = theirs.abs().max(1.0);
                assert!(
                    (ours - theirs).abs() < 4e-13 * scale / c.min(1.0),
                    "{t} {ours} {theirs}"
                );
            }
        }
    }
}

/// From rest v̇ = g − c v² has v = sqrt(g/c) tanh(t sqrt(g c)), y = ln cosh(t sqrt(g c))/c. The law
/// is smoothed where the body is at rest, so that the solution differs slightly below 1e-5 of the
/// speed.
#[test]
fn quadratic_drag_has_its_hyperbolic_tangent() {
    for (c, g) in [(0.5_f64, 1.0_f64), (3.0, 0.2), (20.0, 1.0)] {
        let drag = Drag {
            quadratic: c,
            ..NO_DRAG
        };
        let run = run(falling([0.0, -g], drag), 5.0, State::default());
        for k in 1..=50 {
            let t = 0.1 * f64::from(k);
            let state = run.at(t).state;
            let turn = t * (g * c).sqrt();
            assert!((state.vy + (g / c).sqrt() * turn.tanh()).abs() < 1e-9);
            assert!((state.y + turn.cosh().ln() / c).abs() < 1e-9);
        }
    }
}

/// A body that is carried with the water has no drag: if f is the water's own acceleration, it
/// stays with the water.
#[test]
fn a_body_that_moves_with_the_water_feels_nothing() {
    let wave = Harmonic::with_phases(1.3, [0.4, 0.25], [0.3, 1.1]);
    let Harmonic {
        omega,
        cosine: Vector2 { x: cx, y: cy },
        sine: Vector2 { x: dx, y: dy },
    } = wave;
    let mut system = falling(
        [0.0, 0.0],
        Drag {
            linear: 0.8,
            quadratic: 2.0,
            turning: 0.0,
            water: vec![wave],
        },
    );
    // w = c cos Ωt + d sin Ωt, so ẇ = Ωd cos Ωt − Ωc sin Ωt.
    system.forcing.harmonics = vec![Harmonic {
        omega,
        cosine: [omega * dx, omega * dy].into(),
        sine: [-omega * cx, -omega * cy].into(),
    }];
    let start = State {
        vx: cx,
        vy: cy,
        ..State::default()
    };
    let run = run(system, 10.0, start);
    for k in 0..=100 {
        let t = 0.1 * f64::from(k);
        let state = run.at(t).state;
        let (s, c) = (omega * t).sin_cos();
        assert!((state.vx - (cx * c + dx * s)).abs() < 1e-12);
        assert!((state.vy - (cy * c + dy * s)).abs() < 1e-12);
    }
}

fn breakwater(b: f64, drag: Option<Drag>) -> System {
    let a = 0.2;
    let shape = Shape::of_half_sizes(a, b);
    let wave = Harmonic::ellipse(0.3, 0.5, 0.9);
    System {
        drag,
        ..System::moored_breakwater(Body::rigid(shape, 0.02), [a, b], 1.5, 0.9, wave)
    }
}

/// With drag coefficients of zero the Taylor series finds the flights and impacts of the closed
/// form. Errors grow from impact to impact, so that only the first ones are compared.
#[test]
fn drag_of_nothing_is_the_closed_form() {
    for b in [0.0, 0.1] {
        let start = State {
            y: 0.1,
            theta: 0.05,
            ..State::default()
        };
        let free = run(breakwater(b, None), 6.0, start);
        let dragged = run(breakwater(b, Some(NO_DRAG)), 6.0, start);
        for (ours, theirs) in dragged.impacts().iter().zip(free.impacts()).take(20) {
            assert_eq!(ours.cable, theirs.cable);
            assert!((ours.t - theirs.t).abs() < 1e-10);
            assert!((ours.v_n - theirs.v_n).abs() < 1e-10);
        }
        // Compared just before an impact: at its instant one run may have had it and the other not.
        let last = free.impacts()[19].t;
        for k in 0..100 {
            let t = 0.01 * (f64::from(k) + 0.5) * last;
            let (ours, theirs) = (dragged.at(t).state, free.at(t).state);
            for (ours, theirs) in ours.components().iter().zip(theirs.components()) {
                assert!((ours - theirs).abs() < 1e-10, "{t}");
            }
        }
    }
}

/// ∂(state)/∂(start) by the linearised motion, with the derivatives of drag, against neighbouring
/// runs.
#[test]
fn the_linearised_motion_knows_the_drag() {
    let drag = Drag {
        linear: 0.3,
        quadratic: 0.7,
        turning: 0.2,
        water: vec![Harmonic::with_phases(0.9, [0.3, 0.2], [1.0, 2.0])],
    };
    let start = State {
        y: 0.1,
        theta: 0.05,
        vtheta: 0.1,
        ..State::default()
    };
    let end = |state: State, t: f64| {
        run(breakwater(0.1, Some(drag.clone())), t, state)
            .at(t)
            .state
    };
    let mut simulation = unending(breakwater(0.1, Some(drag.clone())), 0.0, start);
    let tangent = Tangent::new(simulation.system());
    let mut columns = [[0.0; 6]; 6];
    for (k, column) in columns.iter_mut().enumerate() {
        column[k] = 1.0;
    }
    let mut impacts = 0;
    let mut steps = 0;
    while impacts < 3 {
        let step = simulation.step().expect("it goes on");
        let map = tangent.of_step(&simulation, &step);
        for column in &mut columns {
            *column = map.fundamental(column);
        }
        impacts += step.impacts().count();
        steps += 1;
    }
    assert!(steps > 5);
    // A little later than the impact, whose time differs between neighbours.
    let step = simulation.step().expect("it goes on");
    let map = tangent.of_step(&simulation, &step);
    let columns = columns.map(|column| map.fundamental(&column));
    assert!(!map.has_impact());
    let h = 1e-6;
    for (k, column) in columns.iter().enumerate() {
        let moved = |side: f64| {
            let mut components = start.components();
            components[k] += side * h;
            end(State::from_components(components), step.t_end).components()
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        for i in 0..6 {
            let known = (up[i] - down[i]) / (2.0 * h);
            let scale = 1.0 + known.abs();
            assert!(
                (column[i] - known).abs() < 2e-4 * scale,
                "{k} {i}: {} {known}",
                column[i]
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(1999),
        ..ProptestConfig::default()
    })]

    /// In still water, without waves, drag and impacts never increase the energy.
    #[test]
    fn energy_never_rises_in_still_water(
        linear in 0.0..1.0_f64, quadratic in 0.0..5.0_f64, turning in 0.0..1.0_f64, b in 0.0..0.2_f64,
        x in -0.05..0.05_f64, vx in -0.5..0.5_f64, vtheta in -0.5..0.5_f64, e in 0.0..1.0_f64,
    ) {
        let drag = Drag { linear, quadratic, turning, water: vec![] };
        let mut system = breakwater(b, Some(drag));
        system.forcing.harmonics.clear();
        system.restitution = e;
        let start = State { x, y: 0.3, vx, vtheta, ..State::default() };
        let rules = Rules { max_impacts: 300, v_stick: 1e-6, ..Rules::until(8.0) };
        let Ok(mut simulation) = Simulation::new(system.clone(), rules, 0.0, start) else {
            return Ok(());
        };
        let mut energy = system.energy(&start);
        while let Some(step) = simulation.step() {
            for state in [step.before, step.after] {
                let now = system.energy(&state);
                prop_assert!(now <= energy + 1e-12, "{now} after {energy}");
                energy = now;
                for cable in &system.cables {
                    prop_assert!(cable.gap(&state) < 1e-12);
                }
            }
        }
    }
}
