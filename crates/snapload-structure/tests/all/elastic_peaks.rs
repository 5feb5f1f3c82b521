//! The largest tension of an elastic line is that at the start of its pull if its damper is strong.

use crate::elastic::{run, vertical};
use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    Lines, ModelAtRest, SLOWEST_M_S, SeaOutcome, compare_elastic, elastic_lines, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// At e = exp(−2) the damping of a line on a mass M is critical, c = 2 sqrt(k M). Let go 1 m below,
/// the body rises to v = sqrt(2 F h/M) under its buoyancy F, and the pull of two lines, of M/2 each,
/// begins with c v. The force only falls from there, as c v' = −2 c² v/M = −4 k v exceeds k v.
#[test]
fn a_strong_damper_pulls_most_at_the_first_instant() {
    let prepared = vertical((-2.0_f64).exp(), -6.0);
    let (rate, mass): (f64, f64) = (3e6 / 15.0, 800.0);
    let speed = (2.0 * prepared.structure.net_buoyancy_n() / mass).sqrt();
    let known = 2.0 * (rate * mass / 2.0).sqrt() * speed;
    let motion = run(&prepared, &elastic_lines(&prepared, 1.0).unwrap());
    for line in 0..2 {
        for peak in [motion.peaks_n[line], motion.reliable_peaks_n[line]] {
            assert!((peak / known - 1.0).abs() < 1e-6, "{peak} {known}");
        }
        let pull = &motion.pulls[line];
        assert_eq!(
            (pull.peak_n, pull.peak_s),
            (motion.peaks_n[line], pull.from_s)
        );
    }
}

/// The largest tension of a line is the largest of its judged pulls, in a single run and in records
/// of a sea, and is the crest of a wave of tension.
#[test]
fn a_line_pulls_as_much_as_its_hardest_pull() {
    let plastic = |text: &str| {
        let run = "[run]\nduration = 60\ntransient = 0";
        let text = text.replace("[run]", run);
        structure(&text.replace("restitution = 0.5", "restitution = 0.05"))
    };
    let prepared = ModelAtRest::for_elastic_lines(plastic(EXAMPLE)).unwrap();
    let found = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    for (index, line) in found.outcome.lines.iter().enumerate() {
        let pulls = found.elastic.pulls.iter().filter(|pull| pull.line == index);
        let hardest = pulls.map(|pull| pull.peak_n).fold(0.0, f64::max);
        assert_eq!(line.largest_n(), Some(hardest), "line {}", index + 1);
    }
    // Pulls that are hardest at their first instant are crests.
    let outcome = &found.outcome;
    let pulls = found.elastic.pulls.iter();
    let mut at_once = pulls.filter(|pull| pull.peak_s == pull.from_s && pull.peak_s > 0.0);
    assert!(at_once.any(|pull| outcome.waves_n.iter().any(|wave| wave[0] == pull.peak_n)));
    // In records the largest tension is that of all pulls, and the snaps are among these.
    let records = seas(plastic(SEA), 2, Lines::Elastic, &no_progress).unwrap();
    for SeaOutcome { seed, outcome, .. } in &records.records {
        let text = SEA.replace("hs = 1.2", &format!("hs = 1.2\nseed = {seed}"));
        let prepared = ModelAtRest::for_elastic_lines(plastic(&text)).unwrap();
        let alone = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
        let hardest = alone.elastic.pulls.iter().map(|pull| pull.peak_n);
        assert_eq!(
            outcome.largest_n(),
            hardest.fold(0.0, f64::max),
            "seed {seed}"
        );
        let snapping = alone
            .elastic
            .pulls
            .iter()
            .filter(|pull| pull.speed_m_s >= SLOWEST_M_S);
        let snapping: Vec<f64> = snapping.map(|pull| pull.peak_n).collect();
        assert_eq!(outcome.peaks_n, snapping, "seed {seed}");
    }
}
