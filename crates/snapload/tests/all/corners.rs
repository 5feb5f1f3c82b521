//! Bodies at the corners between their cables: swinging past, and coming to rest.

use snapload::{
    Body, Cable, CaseError, Forcing, Harmonic, Parameters, Rules, Simulation, State, Stop, System,
    Value,
};

/// A point of unit mass and weight, on cables at its centre from these anchors that are as long as
/// the way to a place.
fn hung(anchors: &[[f64; 2]], place: [f64; 2], restitution: f64, wave: Harmonic) -> System {
    let cable = |anchor: &[f64; 2]| {
        let length = (place[0] - anchor[0]).hypot(place[1] - anchor[1]);
        Cable::new(*anchor, [0.0, 0.0], length)
    };
    System {
        body: Body::point(),
        cables: anchors.iter().map(cable).collect(),
        forcing: Forcing {
            constant: [0.0, -1.0].into(),
            harmonics: vec![wave],
        },
        drag: None,
        floating: None,
        restitution,
    }
}

fn still_air() -> Harmonic {
    Harmonic {
        omega: 1.0,
        cosine: [0.0, 0.0].into(),
        sine: [0.0, 0.0].into(),
    }
}

/// Where e = 0, each time that a pendulum passes the corner of two cables the new one takes away
/// the part of its velocity that would stretch it: cos 2α remains, sin α = 1/r, and cos α at the
/// first snap, as the motion begins at the corner. So it does however slow a snap counts as slow.
#[test]
fn a_pendulum_swings_past_the_corner_of_nearly_parallel_cables() -> Result<(), CaseError> {
    for v_stick in [1e-2, 1e-3, 1e-6] {
        let number = |key: &'static str, value: f64| (key, Value::Number(value));
        let entries = [
            ("body", Value::Text("point".into())),
            ("stop_when_settled", Value::Bool(false)),
            number("a", 0.0),
            number("e", 0.0),
            number("f_o", 0.0),
            number("x", 0.0),
            number("y", 0.0),
            number("r", 1000.0),
            number("vx", 1.0),
            number("t_end", 700.0),
            number("v_stick", v_stick),
        ];
        let case = snapload::Case::new(Parameters::from_entries(entries)?)?;
        let run = case.run();
        let (end, passes) = (run.end(), run.impacts().len());
        assert_eq!(end.reason, Stop::EndTime);
        assert!(passes >= 7, "{v_stick}: {passes}");
        let energy = |s: &State| 0.5 * (s.vx * s.vx + s.vy * s.vy) + s.y;
        let square_of_sine = 1.0 / (1000.0 * 1000.0);
        let cos_2_alpha: f64 = 1.0 - 2.0 * square_of_sine;
        let first = 0.5 * (1.0 - square_of_sine);
        let known = first * cos_2_alpha.powi(2 * (passes as i32 - 1));
        let found = energy(&end.state);
        assert!((found - known).abs() < 1e-9, "{v_stick}: {found} {known}");
    }
    Ok(())
}

/// Two cables of length 1 whose anchors are 4e-7 apart are one to a body that swings: it keeps its
/// energy up to some (4e-7)² a snap, whether it rebounds from them or not.
#[test]
fn a_body_on_two_cables_that_are_nearly_one_swings_on() {
    for restitution in [0.0, 0.5, 0.9] {
        let anchors = [[-2e-7, 0.0], [2e-7, 0.0]];
        let system = hung(&anchors, [0.0, -1.0], restitution, still_air());
        let start = State {
            y: -1.0,
            vx: 1.0,
            ..State::default()
        };
        let rules = Rules {
            max_impacts: 100_000,
            v_stick: 1e-6,
            ..Rules::until(40.0)
        };
        let mut simulation = Simulation::new(system, rules, 0.0, start).expect("on both cables");
        while simulation.step().is_some() {}
        let state = simulation.state();
        let energy = 0.5 * (state.vx * state.vx + state.vy * state.vy) + state.y;
        assert_eq!(simulation.stop(), Some(Stop::EndTime), "{restitution}");
        assert!((energy + 0.5).abs() < 1e-6, "{restitution}: {energy}");
    }
}

/// A point on three cables from above that a force throws about and that comes back to their
/// common corner: none of them is ever longer than its length.
#[test]
fn no_cable_is_passed_at_a_corner_of_three() {
    let mut rested = 0;
    for k in 0..300_u32 {
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let anchor = |j: f64| [3.0 * at(2.0 + j) - 1.5, 0.3 + 1.2 * at(7.0 + j)];
        let wave = Harmonic {
            omega: 0.5 + 3.5 * at(17.0),
            cosine: [1.6 * at(19.0) - 0.8, 1.6 * at(23.0) - 0.8].into(),
            sine: [0.0, 0.0].into(),
        };
        let anchors = [anchor(0.0), anchor(3.0), anchor(11.0)];
        let restitution = [0.0, 0.3, 0.7][k as usize % 3];
        let system = hung(&anchors, [0.0, 0.0], restitution, wave);
        let rules = Rules {
            max_impacts: 5000,
            v_stick: 1e-6,
            ..Rules::until(8.0)
        };
        let start = State::default();
        let mut simulation = Simulation::new(system, rules, 0.0, start).expect("closed");
        while let Some(step) = simulation.step() {
            rested += u32::from(step.taut.len() >= 2);
            for part in 0..=10 {
                let s = (step.t_end - step.t_start) * f64::from(part) / 10.0;
                let state = simulation.within(&step, s);
                for cable in &simulation.system().cables {
                    let gap = cable.gap(&state);
                    assert!(gap < 1e-9, "{k}, t = {}: {gap:e}", step.t_start + s);
                }
            }
        }
    }
    assert!(rested > 1000, "{rested}");
}
