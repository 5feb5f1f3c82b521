//! Motions with given sets of taut cables, against the steps of runs.

use snapload::{Case, PrescribedTaut, Stop, TautSet, named_case};

/// Every step of a run is a motion with given taut cables, forwards and backwards, and its single
/// impacts follow this law.
#[test]
fn the_steps_of_a_run_are_motions_of_held_cables() {
    let (mut slack, mut taut, mut struck) = (0, 0, 0);
    for code in ["sliding-example", "rocking-example"] {
        let mut simulation = Case::new(named_case(code).unwrap().parameters)
            .unwrap()
            .simulation();
        let prescribed = PrescribedTaut::new(simulation.system().clone());
        while let Some(step) = simulation.step() {
            if step.stop == Some(Stop::EndTime) {
                continue;
            }
            let s = step.t_end - step.t_start;
            let carried = prescribed.carried(step.taut, step.t_start, &step.start, s);
            let back = prescribed.carried(step.taut, step.t_end, &step.before, -s);
            for (found, known) in [(carried, step.before), (back, step.start)] {
                for (a, b) in found.components().into_iter().zip(known.components()) {
                    assert!((a - b).abs() < 1e-12, "{a} {b}");
                }
            }
            // The same motion at times within the step.
            for (from, z, s) in [
                (step.t_start, &step.start, s),
                (step.t_end, &step.before, -s),
            ] {
                let path = prescribed.path(step.taut, from, z, s);
                for part in [0.0, 0.3, 0.77, 1.0] {
                    let known = prescribed
                        .carried(step.taut, from, z, part * s)
                        .components();
                    for (a, b) in path.state(part * s).components().into_iter().zip(known) {
                        assert!((a - b).abs() < 1e-13, "{a} {b}");
                    }
                }
            }
            let impacts: Vec<_> = step.impacts().collect();
            if let [impact] = impacts[..]
                && step.taut.is_empty()
            {
                let only = TautSet::only(impact.cable);
                let (after, impulse) = prescribed.struck(&step.before, only, only);
                assert!((impulse[impact.cable] - impact.impulse).abs() < 1e-14);
                assert!((after.vx - impact.after.vx).abs() < 1e-14);
                struck += 1;
            }
            *(if step.taut.is_empty() {
                &mut slack
            } else {
                &mut taut
            }) += 1;
        }
    }
    assert!(
        slack > 20 && taut > 20 && struck > 20,
        "{slack} {taut} {struck}"
    );
}

/// Over many Taylor steps, in either direction, a path agrees at any time with the motion.
#[test]
fn a_long_path_is_the_motion_carried_there() {
    let parameters = named_case("sliding-example").unwrap().parameters;
    let mut simulation = Case::new(parameters).unwrap().simulation();
    let prescribed = PrescribedTaut::new(simulation.system().clone());
    let sliding = std::iter::from_fn(|| simulation.step()).find(|step| step.taut.len() == 1);
    let step = sliding.expect("it slides");
    for s in [5.0, -5.0] {
        // A step of a series is at most 1 long.
        let path = prescribed.path(step.taut, step.t_start, &step.start, s);
        for k in 0..=200 {
            let part = s * f64::from(k) / 200.0;
            let known = prescribed.carried(step.taut, step.t_start, &step.start, part);
            let found = path.state(part).components().into_iter();
            for (a, b) in found.zip(known.components()) {
                assert!((a - b).abs() < 1e-11, "{part}: {a} {b}");
            }
        }
    }
}
