//! det M of a lap by the law of impact and by the damping.

use snapload::{
    Body, Cable, Drag, Exponential, Floating, Forcing, Harmonic, Real, Rules, Shape, System,
};
use snapload_orbits::{Family, Moored, Orbit, OrbitRequest};
use std::f64::consts::TAU;

const E: f64 = 0.7;
const SIZE: f64 = 1.9;
const OMEGA: f64 = 3.0;
/// The rate at which a velocity decays.
const RATE: f64 = 0.05;

/// What slows the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    Drag,
    Water,
    Both,
}

/// A ball of some mass that bounces on a cable of length 1 once in a period: its weight and the
/// force on it are those of the ball of unit mass times its mass.
fn ball<T: Real>(mass: Option<f64>, slowed: By) -> (System<T>, Rules<T>) {
    let number = |x: f64| T::from_f64(x);
    let zero = T::ZERO;
    let m = mass.unwrap_or(1.0);
    let diagonal = |x: f64, y: f64, turn: f64| {
        let row = |k: usize, x: f64| {
            let mut row = [zero; 3];
            row[k] = number(x);
            row
        };
        [row(0, x), row(1, y), row(2, turn)]
    };
    let body = match mass {
        Some(m) => Body::with_mass_matrix(Shape::Point, diagonal(m, m, 0.3 * m)).unwrap(),
        None => Body::point(),
    };
    let share = if slowed == By::Both { 0.5 } else { 1.0 };
    let drag = (slowed != By::Water).then(|| Drag {
        linear: number(share * RATE * m),
        quadratic: zero,
        turning: number(7.0),
        water: vec![],
    });
    let floating = (slowed != By::Drag).then(|| Floating {
        stiffness: [[zero; 3]; 3],
        damping: diagonal(share * RATE * m, share * RATE * m, 7.0),
        constant: [zero; 3],
        memory: vec![],
        excitation: vec![],
    });
    let system = System {
        body,
        cables: vec![Cable::new([zero, T::ONE], [zero, zero], T::ONE)],
        forcing: Forcing {
            constant: [zero, number(-m)].into(),
            harmonics: vec![Harmonic {
                omega: number(OMEGA),
                cosine: [zero, number(SIZE * m)].into(),
                sine: [zero, zero].into(),
            }],
        },
        drag,
        floating,
        restitution: number(E),
    };
    (system, Rules::until(number(100.0)))
}

/// The state at t = 0 of the undamped ball that snaps once in a period T: between snaps its speed
/// falls by T, so that v⁻ = T/(1 + e), and it returns to the same height if the phase φ of the snap
/// has sin φ = (Ω/a) (e v⁻ − T/2).
fn start() -> [f64; 6] {
    let period = TAU / OMEGA;
    let rebound = E * period / (1.0 + E);
    let phase = (OMEGA / SIZE * (rebound - 0.5 * period)).asin();
    let since = period - phase.rem_euclid(TAU) / OMEGA;
    let sine = (OMEGA * -since).sin();
    let speed = rebound - since - SIZE / OMEGA * sine;
    let rise = (OMEGA * since).cos() - 1.0;
    let height = (rebound - 0.5 * since) * since + SIZE / OMEGA * (rise / OMEGA - sine * since);
    [0.0, height, 0.0, 0.0, speed, 0.0]
}

/// One snap multiplies volumes by e², and a time T of flight by e^(−2cT), as the velocity in either
/// direction decays at the rate c: that is M⁻¹ times the damping, whatever the mass.
#[test]
fn volumes_shrink_by_the_damping_over_the_mass() {
    let expected = E * E * (-2.0 * RATE * TAU / OMEGA).exp();
    for mass in [None, Some(1.0), Some(5.0)] {
        for slowed in [By::Drag, By::Water, By::Both] {
            let family = Moored::new(
                false,
                move |_| ball(mass, slowed),
                move |_| ball(mass, slowed),
            );
            let orbit = Orbit::find(&family, [0.0; 2], &start(), &OrbitRequest::default());
            let orbit = orbit.unwrap_or_else(|why| panic!("{mass:?} {slowed:?}: {why}"));
            let rule = orbit.rule.unwrap();
            let close = |value: f64| (value / expected - 1.0).abs();
            assert!(
                close(rule) < 1e-12,
                "{mass:?} {slowed:?}: {rule} {expected}"
            );
            let product = orbit.multipliers.product;
            assert!(close(product) < 1e-9, "{mass:?} {slowed:?}: {product}");
        }
    }
}

/// A body that turns loses the damping of its rotation, too; neither the force of quadratic drag
/// nor that of a memory is a constant times the velocity.
#[test]
fn the_rate_is_the_trace_of_the_damping_over_the_mass() {
    let of = |change: fn(&mut System)| {
        let made = move || {
            let (mut system, rules) = ball::<f64>(Some(5.0), By::Drag);
            change(&mut system);
            (system, rules)
        };
        let jets = |_| ball(Some(5.0), By::Drag);
        Moored::new(true, move |_| made(), jets).contraction([0.0; 2])
    };
    let rate = of(|_| {}).unwrap();
    assert!((rate - (2.0 * RATE + 7.0)).abs() < 1e-12, "{rate}");
    let rigid = of(|system| system.body = Body::rigid(Shape::Point, 0.3)).unwrap();
    assert!((rigid - (10.0 * RATE + 7.0)).abs() < 1e-12, "{rigid}");
    let quadratic = |system: &mut System| {
        if let Some(drag) = &mut system.drag {
            drag.quadratic = 0.1;
        }
    };
    assert_eq!(of(quadratic), None);
    let memory = |system: &mut System| {
        system.floating = Some(Floating {
            memory: vec![Exponential {
                pole: [-1.0, 0.0],
                residue: [[[0.1, 0.0]; 3]; 3],
            }],
            ..Floating::default()
        });
    };
    assert_eq!(of(memory), None);
}
