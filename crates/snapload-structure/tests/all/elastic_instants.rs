//! The instants of a motion on elastic lines: those of its samples, and those at which lines pull.

use super::elastic::{run, vertical};
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, elastic_lines, run_elastic};

/// The state is kept at the times that one writes, whatever steps the integrator makes, and at the
/// end: let go below, the body rises by F/M t²/2 until its lines take hold.
#[test]
fn samples_are_at_the_requested_times() {
    let prepared = vertical(1.0, -6.0);
    let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
    let rise = prepared.structure.net_buoyancy_n() / 800.0;
    for (every, written) in [(0.3, "3.9"), (0.07, "3.99"), (0.5, "3.5")] {
        let motion = run_elastic(&prepared, &law, every, &no_progress).expect("a run");
        let times: Vec<String> = motion.samples.iter().map(|l| l.t_s.to_string()).collect();
        assert_eq!(times[..2], ["0".to_owned(), every.to_string()]);
        assert_eq!(times[times.len() - 2..], [written, "4"]);
        let taken = motion.pulls[0].from_s;
        let free = motion.samples.iter().filter(|sample| sample.t_s < taken);
        for sample in free.clone() {
            let [_, z] = prepared
                .model
                .scales
                .to_si([sample.state.x, sample.state.y]);
            let known = -6.0 + 0.5 * rise * sample.t_s * sample.t_s;
            assert!((z - known).abs() < 1e-9, "{} {z} {known}", sample.t_s);
            assert_eq!(sample.tension_n, [0.0, 0.0]);
        }
        assert_eq!(free.count(), (taken / every) as usize + 1);
    }
    for every in [0.0, -1.0, f64::NAN, 1e-9] {
        let refused = run_elastic(&prepared, &law, every, &no_progress).expect_err("a refusal");
        assert!(refused.to_string().contains("every ="), "{refused}");
    }
}

/// Two lines that become taut half a millisecond apart, much less than a step of the slack motion,
/// both begin to pull when they are at their length, in whatever order they are given.
#[test]
fn lines_that_become_taut_one_after_the_other_pull_in_turn() {
    for lengths in [[15.0, 15.002], [15.002, 15.0]] {
        let mut prepared = vertical(1.0, -6.0);
        for (line, length) in lengths.into_iter().enumerate() {
            prepared.structure.lines[line].length_m = length;
        }
        let prepared = ModelAtRest::new(prepared.structure).expect("a start");
        let law = elastic_lines(&prepared, 100.0).expect("elastic lines");
        let elastic_case = prepared.with_elastic_lines(&law).expect("a rest");
        let motion = run(&elastic_case, &law);
        let longer = usize::from(lengths[1] > lengths[0]);
        let order: Vec<usize> = motion.pulls[..2].iter().map(|pull| pull.line).collect();
        assert_eq!(order, [1 - longer, longer], "{lengths:?}");
        // With a force F and a spring k from the first on, δ̈ = (F − k δ)/M until δ = 2 mm.
        let (mass, rate) = (800.0, 100.0 * 3e6 / 15.0);
        let force = prepared.structure.net_buoyancy_n();
        let speed = (2.0 * force * 1.0 / mass).sqrt();
        let [first_s, second_s] = [0, 1].map(|pull| motion.pulls[pull].from_s);
        assert!((first_s - speed * mass / force).abs() < 1e-9);
        let (omega, later) = ((rate / mass).sqrt(), second_s - first_s);
        let (sine, cosine) = (omega * later).sin_cos();
        let stretch = force / rate * (1.0 - cosine) + speed / omega * sine;
        assert!((stretch - 0.002).abs() < 1e-10, "{stretch}");
    }
}
