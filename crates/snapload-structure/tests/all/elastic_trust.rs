//! How far a motion on elastic lines is known.

use super::elastic::{CYLINDER, structure};
use serde_json::json;
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, ElasticComparison, ModelAtRest, Outcome, VerdictKind, compare_elastic, elastic_lines,
    run_elastic,
};
use std::sync::OnceLock;

/// A motion that is let go in short waves, in which it is chaotic, and in long ones.
const CHAOTIC: [&str; 3] = ["wave.height=2.5", "wave.period=5", "run.start=[0.3, -4.2]"];
const REGULAR: [&str; 3] = ["wave.height=1", "wave.period=9", "run.start=[0.3, -4.2]"];

fn compared(set: &[&str]) -> ElasticComparison {
    let prepared = ModelAtRest::new(structure(CYLINDER, set)).expect("a start");
    compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).expect("a run")
}

/// The chaotic motion over 300 s with eleven neighbours, its lines far from breaking, with checks by
/// factors of one; run once.
fn chaotic() -> ElasticComparison {
    static RUN: OnceLock<ElasticComparison> = OnceLock::new();
    let run = || {
        let more = [
            "run.duration=300",
            "line.breaking_load=1e9",
            "design.pretension_factor=1",
            "design.environment_factor=1",
            "design.strength_factor=1",
        ];
        let set: Vec<&str> = CHAOTIC.into_iter().chain(more).collect();
        let run = compared(&set).with_neighbours(11, &no_progress);
        run.expect("runs")
    };
    RUN.get_or_init(run).clone()
}

/// The same without neighbours.
fn alone(mut comparison: ElasticComparison) -> ElasticComparison {
    comparison.neighbours.clear();
    comparison
}

/// The same with another breaking load of a line, on which the motion does not depend.
fn breaking_at(mut comparison: ElasticComparison, line: usize, load_n: f64) -> ElasticComparison {
    let lines = &mut comparison.elastic_case.structure.lines;
    lines[line].breaking_load_n = Some(load_n);
    comparison
}

/// When motions that begin 1e-9 m apart are 1e-3 of the unit of length apart, if ever \[s\].
fn apart_s(set: &[&str]) -> Option<f64> {
    let [one, other] = ["0.3", "0.300000001"].map(|x| {
        let start = format!("run.start=[{x}, -4.2]");
        let set: Vec<&str> = set.iter().copied().chain([&*start]).collect();
        let prepared = ModelAtRest::new(structure(CYLINDER, &set)).expect("a start");
        let law = elastic_lines(&prepared, 1.0).expect("elastic lines");
        let elastic_case = prepared.with_elastic_lines(&law).expect("a rest");
        run_elastic(&elastic_case, &law, 0.05, &no_progress).expect("a run")
    });
    let mut both = one.samples.iter().zip(&other.samples);
    let far = both.find(|(one, other)| {
        let [one, other] = [one, other].map(|sample| sample.state);
        (one.x - other.x).hypot(one.y - other.y) > 1e-3
    });
    far.map(|(one, _)| one.t_s)
}

/// Two motions that begin 1e-9 m apart, far more than rounding, are apart before the motion is said
/// to be unknown, and as errors grow exponentially not long before. Where they stay together it is
/// known to the end, and to all the digits that are shown.
#[test]
fn a_motion_is_known_as_long_as_errors_are_small() {
    let duration = "run.duration=300";
    for (set, chaotic) in [(CHAOTIC, true), (REGULAR, false)] {
        let set: Vec<&str> = set.into_iter().chain([duration]).collect();
        let ElasticComparison {
            repeated, elastic, ..
        } = compared(&set);
        match (apart_s(&set), repeated.horizon_s) {
            (Some(apart_s), Some(horizon_s)) if chaotic => {
                assert!(apart_s < horizon_s, "{apart_s} {horizon_s}");
                assert!(horizon_s < 3.0 * apart_s, "{apart_s} {horizon_s}");
            }
            (None, None) if !chaotic => {
                for (line, peak_n) in elastic.peaks_n.iter().enumerate() {
                    let other_n = repeated.outcome.lines[line].largest_taut_n;
                    assert!((peak_n / other_n - 1.0).abs() < 1e-4, "{peak_n} {other_n}");
                }
            }
            other => panic!("{other:?} at {set:?}"),
        }
    }
}

/// A line that breaks in one of the two leaves the verdict open, or is told of, and so is a check of
/// its strength.
#[test]
fn a_verdict_says_where_rounding_decides() {
    for line in 0..2 {
        let first = chaotic();
        let peaks_n = [
            first.elastic.peaks_n[line],
            first.repeated.outcome.lines[line].largest_taut_n,
        ];
        let between_n = 0.5 * (peaks_n[0] + peaks_n[1]);
        let among = breaking_at(first, line, between_n);
        assert_eq!(among.checks()[line].0.answer, Answer::Open);
        assert_eq!(among.checks()[1 - line].0.answer, Answer::Passes);
        let comparison = alone(among);
        let verdict = comparison.verdict();
        let breaks = peaks_n[0] > between_n;
        let (standing, holds, so) = match breaks {
            true => (VerdictKind::Breaks, "holds", ""),
            false => (VerdictKind::Open, "would break", ", so the verdict is open"),
        };
        let words = format!("Integrated in shorter steps line {} {holds} (", line + 1);
        let end = format!("){so}.");
        assert_eq!(verdict.standing, standing, "{}", verdict.words);
        assert!(
            verdict.words.contains(&words) && verdict.words.ends_with(&end),
            "{}",
            verdict.words
        );
    }
}

/// Neighbours are runs in waves that differ by a millionth of their height at most: where the motion
/// is regular their largest tensions differ from its own by no more than that times the derivative
/// by the height, which is found from a wave that is a thousandth higher.
#[test]
fn neighbours_of_a_regular_motion_are_near_it() {
    let set: Vec<&str> = REGULAR.into_iter().chain(["run.duration=100"]).collect();
    let found = compared(&set)
        .with_neighbours(6, &no_progress)
        .expect("runs");
    let higher: Vec<&str> = set.iter().copied().chain(["wave.height=1.001"]).collect();
    let (peak_n, higher_n) = (
        found.outcome.largest_n(),
        compared(&higher).outcome.largest_n(),
    );
    let by_height = 1e3 * (higher_n - peak_n).abs();
    let apart: Vec<f64> = found
        .neighbours
        .iter()
        .map(|n| (n.largest_n() - peak_n).abs())
        .collect();
    assert!(
        apart.iter().all(|apart| *apart < 1.2e-6 * by_height),
        "{apart:?} {by_height}"
    );
    assert!(
        apart.iter().any(|apart| *apart > 1e-7 * by_height),
        "{apart:?} {by_height}"
    );
    let words = found.trust_text();
    assert!(
        words.contains("For 6 neighbours in waves that differ by at most 1e-6"),
        "{words}"
    );
    // In still water there are no waves to vary.
    let still = compared(&["wave.height=0", "run.start=[0.3, -4.2]", "run.duration=20"]);
    let still = still.with_neighbours(6, &no_progress).expect("runs");
    assert!(still.neighbours.is_empty() && still.spread().is_none());
    assert!(!still.trust_text().contains("neighbour"));
}

/// A line that holds in both integrations of a motion that is not known to its end does not hold for
/// sure, and passes no check: neighbours would show it breaking.
#[test]
fn what_is_known_in_part_does_not_hold() {
    let among = chaotic();
    let alone = alone(among.clone());
    let until_s = alone.repeated.horizon_s.expect("a horizon");
    let verdict = alone.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
    let words = format!("The motion is known only up to {until_s:.1} s, and fewer than 10");
    assert!(verdict.words.contains(&words), "{}", verdict.words);
    assert!(
        alone
            .checks()
            .iter()
            .all(|(check, _)| check.answer == Answer::Open)
    );
    // What nine have in common is not known of others.
    let mut nine = among.clone();
    nine.neighbours.truncate(9);
    assert_eq!(nine.verdict().standing, VerdictKind::Open);
    assert!(
        nine.checks()
            .iter()
            .all(|(check, _)| check.answer == Answer::Open)
    );
    // None of its neighbours comes near that load.
    assert_eq!(
        among.verdict().standing,
        VerdictKind::Holds,
        "{}",
        among.verdict().words
    );
    assert!(
        among
            .checks()
            .iter()
            .all(|(check, n)| check.answer == Answer::Passes && *n == 11)
    );
}

/// Where a chaotic motion and its neighbours disagree on whether a line breaks, verdict and check
/// say of how many: for a breaking load between their largest tensions.
#[test]
fn a_verdict_counts_the_neighbours_that_differ() {
    let found = chaotic();
    let of_line = |outcome: &Outcome| outcome.lines[0].largest_taut_n;
    let mut peaks_n: Vec<f64> = found.neighbours.iter().map(of_line).collect();
    peaks_n.sort_by(f64::total_cmp);
    assert!(peaks_n[10] > 1.02 * peaks_n[0], "{peaks_n:?}");
    let load_n = 0.5 * (peaks_n[5] + peaks_n[6]);
    let found = breaking_at(found, 0, load_n);
    let breaks = of_line(&found.outcome) >= load_n;
    let breaking = peaks_n.iter().filter(|peak| **peak >= load_n).count();
    assert_eq!(breaking, 5);
    let (differing, what) = match breaks {
        true => (6, "no line breaks and the mooring holds"),
        false => (5, "a line would break or the mooring fail"),
    };
    let verdict = found.verdict();
    let words = format!(" In {differing} of 11 neighbours {what}");
    assert!(verdict.words.contains(&words), "{}", verdict.words);
    let expected = if breaks {
        VerdictKind::Breaks
    } else {
        VerdictKind::Open
    };
    assert_eq!(verdict.standing, expected);
    let (check, agreeing) = found.checks()[0].clone();
    assert_eq!(agreeing, 11 - differing);
    assert_eq!(found.checks()[1].1, 11);
    let (answer, words) = match breaks {
        true => (
            Answer::Fails,
            format!("fails, in {agreeing} of 11 neighbours"),
        ),
        false => (
            Answer::Open,
            format!("open; {agreeing} of 11 neighbours have the answer of this run"),
        ),
    };
    assert_eq!(check.answer, answer);
    let summary = found.summary("case");
    let summary = summary.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(summary.contains(&words), "{summary}");
    assert!(
        found
            .trust_text()
            .contains("Only the distribution of the peaks is meaningful")
    );
}

/// Neighbours that hold by less than the run are told of: the breaking load is a hundredth above the
/// largest tension of all.
#[test]
fn a_verdict_names_the_neighbour_that_comes_nearest() {
    let found = chaotic();
    let of_line = |outcome: &Outcome| outcome.lines[0].largest_taut_n;
    let theirs = found.neighbours.iter().map(of_line).fold(0.0, f64::max);
    assert!(theirs > 1.03 * of_line(&found.outcome));
    let verdict = breaking_at(found, 0, 1.01 * theirs).verdict();
    assert_eq!(verdict.standing, VerdictKind::Holds);
    let words = "In neighbours the ratio is up to 0.99.";
    assert!(verdict.words.contains(words), "{}", verdict.words);
}

/// In still water no neighbours can be run, and the verdict does not ask for them.
#[test]
fn still_water_has_no_neighbours() {
    let thrown = [
        "wave.height=0",
        "run.restitution=1",
        "run.start=[0.3, -4.2]",
    ];
    let more = ["run.duration=100", "line.breaking_load=1e9"];
    let set: Vec<&str> = thrown.into_iter().chain(more).collect();
    let found = compared(&set)
        .with_neighbours(10, &no_progress)
        .expect("runs");
    assert!(found.repeated.horizon_s.is_some());
    let verdict = found.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open);
    let words = "and in still water there are no neighbours to run, so the verdict is open.";
    assert!(verdict.words.contains(words), "{}", verdict.words);
}

/// Neighbours that end before anything is judged have no largest tension.
#[test]
fn neighbours_that_are_not_judged_have_no_peak() {
    let turning = ["wave.height=3.1", "wave.period=5"];
    let found = compared(&turning)
        .with_neighbours(2, &no_progress)
        .expect("runs");
    assert!(found.neighbours.iter().all(Outcome::is_unjudged));
    assert_eq!(
        found.to_json("case")["neighbour_peaks_n"],
        json!([null, null])
    );
    assert!(
        found.trust_text().contains("Of 2 neighbours"),
        "{}",
        found.trust_text()
    );
}
