//! A floating body, in doubles and with many digits: its series are those of one text, too.

use snapload::{
    Body, Cable, Excitation, Exponential, Floating, Forcing, Precise, Rules, Shape, Simulation,
    State, Steps, System,
};

/// A body of full mass matrix with one memory, damping, two waves and two cables, on its way.
fn body() -> (System, State) {
    let mass = [[1.3, 0.05, -0.04], [0.05, 1.6, 0.02], [-0.04, 0.02, 0.3]];
    let shares = [[0.3, 0.02, 0.05], [0.02, 0.4, 0.0], [0.05, 0.0, 0.1]];
    let (decay, swing) = (0.8, 1.7);
    let water = Floating {
        stiffness: [[0.0, 0.0, 0.0], [0.0, 1.1, 0.1], [0.0, 0.1, 0.4]],
        damping: [[0.2, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.05]],
        constant: [0.05, -0.4, 0.02],
        memory: vec![Exponential {
            pole: [-decay, swing],
            residue: shares.map(|row| row.map(|a| [a, a * decay / swing])),
        }],
        excitation: [0.9, 2.3]
            .map(|omega| Excitation {
                omega,
                cosine: [0.2, -0.1, 0.05],
                sine: [0.1, 0.3, -0.02],
            })
            .into(),
    };
    let system = System {
        body: Body::with_mass_matrix(Shape::Point, mass).expect("positive definite"),
        cables: vec![
            Cable::new([0.8, 1.1], [0.2, 0.1], 1.18),
            Cable::new([-0.7, 1.2], [-0.15, 0.05], 1.3),
        ],
        forcing: Forcing::default(),
        drag: None,
        floating: Some(water),
        restitution: 0.6,
    };
    let start = State {
        vx: -0.3,
        vy: -0.2,
        vtheta: 0.4,
        ..State::default()
    };
    (system, start)
}

/// The first impact, if there is one, and the state at the end of a motion.
fn first_impact_and_end<T: Steps>(system: &System, start: &State, end: f64) -> Vec<f64> {
    let over = system.map(T::from_f64);
    let state = State::from_components(start.components().map(T::from_f64));
    let rules = Rules::until(T::from_f64(end));
    let mut simulation = Simulation::new(over, rules, T::ZERO, state).expect("legal");
    let mut numbers = Vec::new();
    while let Some(step) = simulation.step() {
        if let (true, Some(impact)) = (numbers.is_empty(), step.impacts().next()) {
            numbers.extend([impact.t, impact.v_n, impact.impulse].map(T::to_f64));
        }
    }
    numbers.extend(simulation.state().components().map(T::to_f64));
    numbers.extend(simulation.memory_force().map(T::to_f64));
    numbers
}

/// Doubles against the same motion with 76 digits, through an impact.
#[test]
fn many_digits_find_the_same_motion() {
    let (system, start) = body();
    let ours = first_impact_and_end::<f64>(&system, &start, 0.4);
    let exact = first_impact_and_end::<Precise<4>>(&system, &start, 0.4);
    assert!(ours.len() > 9, "no impact");
    assert_eq!(ours.len(), exact.len());
    for (ours, exact) in ours.iter().zip(&exact) {
        assert!((ours - exact).abs() < 1e-13, "{ours} {exact}");
    }
}
