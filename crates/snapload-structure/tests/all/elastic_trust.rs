//! How far a motion on elastic lines is known.

use super::elastic::{CYLINDER, structure};
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, ElasticComparison, ModelAtRest, VerdictKind, compare_elastic, elastic_lines,
    run_elastic,
};

/// A motion that is let go in short waves, in which it is chaotic, and in long ones.
const CHAOTIC: [&str; 3] = ["wave.height=2.5", "wave.period=5", "run.start=[0.3, -4.2]"];
const REGULAR: [&str; 3] = ["wave.height=1", "wave.period=9", "run.start=[0.3, -4.2]"];

fn compared(set: &[&str]) -> ElasticComparison {
    let prepared = ModelAtRest::new(structure(CYLINDER, set)).expect("a start");
    compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).expect("a run")
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
    let set = ["run.duration=300"];
    let set: Vec<&str> = set.into_iter().chain(CHAOTIC).collect();
    let first = compared(&set);
    for line in 0..2 {
        let peaks_n = [
            first.elastic.peaks_n[line],
            first.repeated.outcome.lines[line].largest_taut_n,
        ];
        let between_n = 0.5 * (peaks_n[0] + peaks_n[1]);
        let [own, other] = match line {
            0 => [between_n, 1e9],
            _ => [1e9, between_n],
        };
        let loads = [
            format!("line.1.breaking_load={own}"),
            format!("line.2.breaking_load={other}"),
        ];
        let set: Vec<&str> = set
            .iter()
            .copied()
            .chain(loads.iter().map(String::as_str))
            .collect();
        let design = ["pretension", "environment", "strength"];
        let design = design.map(|name| format!("design.{name}_factor=1"));
        let checked: Vec<&str> = set
            .iter()
            .copied()
            .chain(design.iter().map(String::as_str))
            .collect();
        let comparison = compared(&checked);
        assert_eq!(comparison.checks()[line].answer, Answer::Open);
        assert_eq!(comparison.checks()[1 - line].answer, Answer::Passes);
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
