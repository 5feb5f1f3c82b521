//! A line that is given as several strands is the same line.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    ElasticComparison, ModelAtRest, compare_elastic, elastic_lines, warnings,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// The example, each line of which is given as strands that have these parts of its stiffness and
/// strength.
fn in_strands(parts: &[f64], stiffness: f64, duration_s: u32) -> ModelAtRest {
    let mut text = EXAMPLE.to_owned();
    let begin = text.find("[[line]]").unwrap();
    text.replace_range(begin..text.find("[site]").unwrap(), "");
    for side in [1.0, -1.0] {
        for part in parts {
            text += &format!(
                "\n[[line]]\nanchor = [{}, -10]\nfairlead = [{}, -4.561]\nlength = 6\n\
                 stiffness = {}\nbreaking_load = {}\nmass_per_length = {}\n",
                3.593 * side,
                1.061 * side,
                stiffness * part,
                1319e3 * part,
                28.7 * part
            );
        }
    }
    let run = format!("[run]\nduration = {duration_s}\ntransient = 0");
    text = text.replace("[run]", &run);
    ModelAtRest::for_elastic_lines(structure(&text)).unwrap()
}

/// The largest tension of each of the two lines, over all of its strands \[N\].
fn peaks_n(found: &ElasticComparison) -> [f64; 2] {
    let peaks = &found.elastic.peaks_n;
    let (one, other) = peaks.split_at(peaks.len() / 2);
    [one, other].map(|strands| strands.iter().sum())
}

/// Strands pull together, so that the springs and dampers of all of them are those of the line:
/// the motion and its tensions do not depend on the number of strands, nor on their parts.
#[test]
fn strands_pull_as_their_line() {
    let run = |parts: &[f64]| {
        let prepared = in_strands(parts, 123.3e6, 20);
        compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap()
    };
    let whole = run(&[1.0]);
    for parts in [&[0.5, 0.5][..], &[0.6, 0.3, 0.1], &[0.125; 8]] {
        let split = run(parts);
        for line in 0..2 {
            let dampers = &split.elastic_lines[line * parts.len()..][..parts.len()];
            let sum: f64 = dampers.iter().map(|strand| strand.damping).sum();
            assert!((sum / whole.elastic_lines[line].damping - 1.0).abs() < 1e-12);
        }
        for (one, other) in peaks_n(&split).iter().zip(peaks_n(&whole)) {
            // Peaks are seen at 16 places of steps of at most a quarter of 1/ω of one strand: with
            // sqrt(8) ω together they are missed by up to (sqrt(8)/128)²/2 of themselves.
            assert!(
                (one / other - 1.0).abs() < 2.5e-4,
                "{parts:?}: {one} {other}"
            );
        }
    }
}

/// Strands of chain are as stiff together as the chain, in which a snap is short; strands of a soft
/// line last as long as that line.
#[test]
fn strands_are_as_soft_as_their_line() {
    let lasts = |parts: &[f64], stiffness: f64| {
        let found = warnings(&in_strands(parts, stiffness, 20));
        let soft = found.iter().find(|found| found.rule == "instant snap")?;
        let (_, words) = soft.message.split_once(" = ")?;
        words.split(" s in line").next().map(ToOwned::to_owned)
    };
    assert_eq!(lasts(&[1.0], 123.3e6), None);
    assert_eq!(lasts(&[0.125; 8], 123.3e6), None);
    assert!(lasts(&[1.0], 5e6).is_some());
    assert_eq!(lasts(&[0.5, 0.3, 0.2], 5e6), lasts(&[1.0], 5e6));
}

/// Lines let the body oscillate no faster than by ω² = Σ k w, w = 1/m + a²/I with the arm a of a
/// fairlead, and damp it no faster than Σ c w. A run is refused if it is longer than 3e7 times 1/ω,
/// or one over that rate, whatever the number of strands.
#[test]
fn strands_are_as_quick_as_their_line() {
    let arm = 1.061_f64.hypot(4.561 - 3.5);
    let w = 1.0 / (72_452.0 + 144_904.0) + arm * arm / 163_017.0;
    let omega = (2.0 * 123.3e14 / 6.0 * w).sqrt();
    for parts in [&[1.0][..], &[0.5, 0.5], &[0.6, 0.3, 0.1], &[0.125; 8]] {
        let prepared = in_strands(parts, 123.3e6, 600);
        let scales = prepared.model.scales;
        let dampers = elastic_lines(&prepared, 1e8).unwrap();
        let damping: f64 = dampers.iter().map(|strand| strand.damping).sum();
        let quickest = omega.max(damping * scales.mass_kg / scales.time_s * w);

        let error = compare_elastic(prepared, 1e8, f64::INFINITY, &no_progress).unwrap_err();
        let error = error.to_string();
        let shown = error.split("allowed: at most ").nth(1);
        let shown = shown.and_then(|rest| rest.split(' ').next());
        let shown = shown.and_then(|number| number.parse::<f64>().ok());
        let most = shown.expect(&error) * quickest / 3e7;
        assert!(most <= 1.0 + 1e-9 && most > 0.99, "{parts:?}: {most}");
    }
}
