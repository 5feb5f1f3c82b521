//! Bounces, which have their own formulas, against general steps.

use crate::common::matrix;
use snapload::{Case, Deviation, Harmonic, Parameters, Simulation, Tangent};

/// Deviations (w, τ), a column for each of them.
type Stage = [[f64; 7]; 7];

/// The general loop, which has no special step for bounces, finds the same impacts. It locates them
/// by other steps, so that the results differ by roundings; they are compared until these have
/// grown.
#[test]
fn bounces_are_what_the_general_search_finds() {
    let mut compared = 0;
    for k in 0..400 {
        let k = f64::from(k);
        let parameters = Parameters {
            f_o: 0.001 * k,
            e: 1.0 - 0.3 * (k * 0.1).sin().abs(),
            a: 0.3 * (k * 0.7).cos().abs(),
            b: 0.2 * (k * 0.3).sin().max(0.0),
            inertia: Some(0.01 + 0.02 * (k * 0.9).sin().abs()),
            omega: 0.01 * k,
            vx: 0.3 * k.sin(),
            vtheta: 0.5 * k.cos(),
            y: 0.4,
            ..Parameters::STANDARD
        };
        let Ok(case) = Case::new(parameters) else {
            continue;
        };
        let mut bounces = case.simulation();
        // With two sinusoids, even if one has no effect, no step is taken for a bounce.
        let mut system = bounces.system().clone();
        system
            .forcing
            .harmonics
            .push(Harmonic::ellipse(0.0, 1.0, 1.0));
        let (rules, start) = (*bounces.rules(), *bounces.state());
        let general = Simulation::new(system, rules, 0.0, start);
        let mut general = general.expect("the same start");
        let mut error = 1e-15;
        while let (Some(ours), Some(theirs)) = (bounces.step(), general.step()) {
            let (ours, theirs) = (ours.impacts().next(), theirs.impacts().next());
            let (Some(ours), Some(theirs)) = (ours, theirs) else {
                break;
            };
            error *= 1.0 + 4.0 * (1.0 + ours.before.vtheta.abs()) / ours.v_n.min(1.0);
            if error > 1e-6 {
                break;
            }
            assert_eq!(ours.cable, theirs.cable, "{parameters:?} at t = {}", ours.t);
            assert!((ours.t - theirs.t).abs() < error, "{parameters:?}");
            assert!((ours.v_n - theirs.v_n).abs() < error, "{parameters:?}");
            compared += 1;
        }
    }
    assert!(compared > 1000, "{compared}");
}

/// The deviations after a stage.
fn next(before: &Stage, stage: impl Fn(&Deviation) -> Deviation) -> Stage {
    let mut after = [[0.0; 7]; 7];
    for j in 0..7 {
        let column = before.map(|row| row[j]);
        for (row, entry) in after.iter_mut().zip(stage(&column)) {
            row[j] = entry;
        }
    }
    after
}

/// The largest entry of the difference of two blocks, relative to the largest entry of the first.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert!(a.iter().chain(b).all(|entry| entry.is_finite()));
    let largest = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    worst.fold(0.0, f64::max) / largest
}

/// On every bounce of runs with long and short cables and bodies of every kind, each stage equals
/// that of the linearised motion of a general step.
#[test]
fn a_bounce_is_one_of_the_steps() {
    let mut bounces = 0;
    for k in 0..60 {
        let k = f64::from(k);
        let point = k % 7.0 == 0.0;
        let size = if point { 0.0 } else { 1.0 };
        let parameters = Parameters {
            f_o: 0.02 * k - 0.6,
            e: 1.0 - 0.4 * k.sin().abs(),
            r: 1.2 + 0.1 * k,
            a: size * (0.3 * (k * 0.7).cos().abs() + 0.02),
            b: size * 0.2 * (k * 0.3).sin().max(0.0),
            inertia: (!point).then(|| 0.003 + 0.05 * (k * 0.9).sin().abs()),
            omega: 0.05 * k,
            vx: 0.3 * k.sin(),
            vtheta: size * 0.5 * k.cos(),
            y: 0.4,
            ..Parameters::STANDARD
        };
        let Ok(case) = Case::new(parameters) else {
            continue;
        };
        let mut simulation = case.simulation();
        let tangent = Tangent::new(simulation.system());
        while let Some(step) = simulation.step() {
            let Some(ours) = simulation.bounce_stages(&step) else {
                continue;
            };
            let theirs = tangent.of_step(&simulation, &step);
            let mut start = [[0.0; 7]; 7];
            for (i, row) in start.iter_mut().enumerate() {
                row[i] = 1.0;
            }
            let along = next(&start, |deviation| theirs.along(deviation));
            let met = next(&along, |deviation| theirs.meet(deviation));
            let after = next(&met, |deviation| theirs.through(deviation));
            for (ours, theirs) in [(ours.along, along), (ours.met, met), (ours.after, after)] {
                let off = difference(ours.as_flattened(), theirs.as_flattened());
                assert!(off < 1e-7, "{off:e}: {parameters:?}");
            }
            let mut at_one_time = [[0.0; 6]; 6];
            for (row, ours) in at_one_time.iter_mut().zip(ours.at_one_time) {
                row.copy_from_slice(&ours[..6]);
            }
            let off = difference(at_one_time.as_flattened(), matrix(&theirs).as_flattened());
            assert!(off < 1e-7, "{off:e}: {parameters:?}");
            let ratio = ours.magnification_squared / theirs.magnification_squared();
            assert!((ratio - 1.0).abs() < 1e-6, "{ratio}: {parameters:?}");
            bounces += 1;
        }
    }
    assert!(bounces > 1000, "{bounces}");
}
