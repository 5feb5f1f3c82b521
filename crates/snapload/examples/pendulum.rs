//! A pendulum that goes slack: a point mass on one cable, thrown from its lowest place.
//!
//! With the speed v₀ at the bottom the tension is v²/l + g cos φ, and energy gives v² = v₀² − 2 g l
//! (1 − cos φ): it is lost where cos φ = (2 g l − v₀²)/(3 g l), φ being measured from the bottom.
//! From there the mass flies along a parabola until the cable snaps taut.

use snapload::{Body, Cable, Forcing, Mode, Rules, Simulation, StartError, State, System};

fn main() -> Result<(), StartError> {
    let system = System {
        body: Body::point(),
        cables: vec![Cable::new([0.0, 0.0], [0.0, 0.0], 1.0)],
        forcing: Forcing {
            constant: [0.0, -1.0].into(),
            harmonics: Vec::new(),
        },
        drag: None,
        floating: None,
        restitution: 0.5,
    };
    let start = State {
        y: -1.0,
        vx: 3.5_f64.sqrt(),
        ..State::default()
    };
    let mut swing = Simulation::new(system, Rules::until(5.0), 0.0, start)?;

    let mut released = None;
    while let Some(step) = swing.step() {
        if step.taut.mode() == Mode::Sliding && step.taut_after.mode() == Mode::Slack {
            let angle = step.after.x.atan2(-step.after.y);
            println!(
                "t = {:.6}: slack at {:.4} degrees",
                step.t_end,
                angle.to_degrees()
            );
            released.get_or_insert(angle);
        }
        for impact in step.impacts() {
            println!("t = {:.6}: taut again, v_n = {:.6}", impact.t, impact.v_n);
        }
    }

    // (2 − 3.5)/3 = −1/2: at 120 degrees.
    let expected = 120.0_f64.to_radians();
    assert!(released.is_some_and(|angle: f64| (angle - expected).abs() < 1e-12));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
