//! A body on any number of cables: a disc hung from five anchors along a beam, shaken sideways.

use snapload::{
    Body, Cable, Forcing, Harmonic, Rules, Shape, Simulation, StartError, State, System,
};

const CABLES: usize = 5;

fn main() -> Result<(), StartError> {
    let radius = 0.2;
    let cables = (0..CABLES).map(|k| {
        let across = -1.0 + 2.0 * k as f64 / (CABLES - 1) as f64;
        let (anchor, fairlead) = ([across, 1.2], [radius * across, 0.0]);
        // A tenth longer than it has to be at rest, so that every cable begins slack.
        let reach = f64::hypot(anchor[0] - fairlead[0], anchor[1] - fairlead[1]);
        Cable::new(anchor, fairlead, 1.1 * reach)
    });
    let system = System {
        body: Body::rigid(Shape::Circle { radius }, 0.5 * radius * radius),
        cables: cables.collect(),
        forcing: Forcing {
            constant: [0.0, -1.0].into(),
            harmonics: vec![Harmonic::ellipse(0.4, 0.3, 1.7)],
        },
        drag: None,
        floating: None,
        restitution: 0.6,
    };
    let rules = Rules {
        v_stick: 1e-6,
        ..Rules::until(20.0)
    };
    let mut simulation = Simulation::new(system, rules, 0.0, State::default())?;

    let mut snaps = [0; CABLES];
    let mut hardest = [0.0_f64; CABLES];
    while let Some(step) = simulation.step() {
        for impact in step.impacts() {
            snaps[impact.cable] += 1;
            hardest[impact.cable] = hardest[impact.cable].max(impact.impulse);
        }
    }
    for cable in 0..CABLES {
        let (snaps, impulse) = (snaps[cable], hardest[cable]);
        println!(
            "cable {}: {snaps} snaps, the hardest an impulse of {impulse:.4}",
            cable + 1
        );
    }
    // The disc begins in free fall, so that something has to catch it.
    assert!(snaps.iter().sum::<i32>() > 0);
    let gaps = simulation
        .system()
        .cables
        .iter()
        .map(|cable| cable.gap(simulation.state()));
    assert!(
        gaps.into_iter().all(|gap| gap < 1e-12),
        "no cable is longer than it is"
    );
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
