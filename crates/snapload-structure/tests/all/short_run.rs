//! Runs of which only few periods of the waves are judged.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{
    Answer, Check, Criterion, Lines, ModelAtRest, NoDistribution, VerdictKind, assess,
    compare_elastic, seas,
};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// The example for so many seconds, in waves of 6 s and so high.
fn lasting(duration_s: f64, height_m: f64) -> snapload_structure::Structure {
    let text = EXAMPLE
        .replace("height = 2\n", &format!("height = {height_m}\n"))
        .replace(
            "[run]",
            &format!("[design]\nleast_share = 0.01\n[run]\nduration = {duration_s}"),
        );
    structure(&text)
}

/// Half a second of a wave of 6 s, in which no line goes slack, neither holds nor passes a check;
/// on elastic lines neither. A minute is warned of, and ten are not.
#[test]
fn a_part_of_a_wave_is_no_verdict() {
    let rule = |warnings: &[snapload_structure::Warning]| {
        warnings.iter().any(|warning| warning.rule == "short run")
    };
    let short = assess(lasting(1.0, 2.0), 4, &no_progress).unwrap();
    let verdict = short.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
    assert!(
        verdict.words.contains("Less than one period of the waves"),
        "{}",
        verdict.words
    );
    let checks = short.checks();
    assert!(!checks.is_empty());
    assert!(
        checks
            .iter()
            .all(|(check, _)| check.answer == Answer::Unknown),
        "{checks:?}"
    );
    assert!(rule(&short.warnings));

    let prepared = ModelAtRest::for_elastic_lines(lasting(1.0, 2.0)).unwrap();
    let elastic = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
    assert_eq!(elastic.verdict().standing, VerdictKind::Open);
    assert!(rule(&elastic.warnings()));

    let minute = assess(lasting(60.0, 0.5), 0, &no_progress).unwrap();
    assert_eq!(minute.verdict().standing, VerdictKind::Holds);
    assert!(rule(&minute.warnings));
    let long = assess(lasting(600.0, 0.5), 0, &no_progress).unwrap();
    assert!(!rule(&long.warnings));
}

/// 0.3 s of each record of a sea of 6 s, a 36,000th of three hours, give neither a verdict nor a
/// distribution, and two periods do.
#[test]
fn parts_of_a_wave_in_many_records_are_no_verdict() {
    let judged = |seconds: f64| {
        let run = format!("[run]\ntransient = 60\nduration = {}", 60.0 + seconds);
        let text = SEA.replace("hs = 1.2", "hs = 0.05").replace("[run]", &run);
        seas(structure(&text), 4, Lines::Inextensible, &no_progress).unwrap()
    };
    let short = judged(0.3);
    assert_eq!(short.standing(), VerdictKind::Open);
    let reason = Err(NoDistribution::PartOfAWave);
    assert_eq!(short.peak_in_three_hours(), reason);
    assert_eq!(short.speed_in_three_hours(), reason);
    let words = short.words();
    let told = "Less than one period of the waves is judged, so the verdict is open";
    assert!(
        words.contains(told) && !words.contains("is expected at"),
        "{words}"
    );
    let warning = short
        .warnings
        .iter()
        .find(|warning| warning.rule == "short records");
    let message = &warning.unwrap().message;
    assert!(
        message.contains("0.3 s of a record are judged"),
        "{message}"
    );
    assert!(message.contains("36000 times"), "{message}");
    assert_ne!(judged(12.0).peak_in_three_hours(), reason);
}

/// The check of the waves' force, whose limit no sea here reaches.
fn of_force(checks: &[Check]) -> Answer {
    let found = checks
        .iter()
        .find(|check| check.criterion == Criterion::WaveForce);
    let force = found.unwrap();
    assert!(force.value.unwrap() < force.limit, "{force:?}");
    force.answer
}

/// The check of the waves' force passes by as much of a sea as those of the lines: not by the one
/// record of `assess`, not by a third of a wave, and not by ten sinusoids. A regular wave has the
/// same force in each period, also in a part of one.
#[test]
fn the_waves_force_does_not_pass_by_little_of_a_sea() {
    let sea = |run: &str| {
        let rule = format!("[design]\nforce_share = 0.9\n[run]\n{run}");
        SEA.replace("[run]", &rule)
    };
    let records = |text: &str| {
        let found = seas(structure(text), 2, Lines::Inextensible, &no_progress).unwrap();
        let each = found.records.iter().map(|record| of_force(&record.checks));
        each.collect::<Vec<_>>()
    };
    let long = sea("duration = 200");
    let alone = assess(structure(&long), 0, &no_progress).unwrap();
    assert_eq!(of_force(&[alone.checks()[0].0.clone()]), Answer::Unknown);
    assert_eq!(records(&long), [Answer::Passes; 2]);
    let part = sea("transient = 61\nduration = 63");
    assert_eq!(records(&part), [Answer::Unknown; 2]);
    let coarse = long.replace("tp = 6", "tp = 6\ncomponents = 10");
    assert_eq!(records(&coarse), [Answer::Open; 2]);
    // Few sinusoids make the force too small, so that one which exceeds its limit fails.
    let strict = coarse.replace("force_share = 0.9", "force_share = 0.001");
    let found = seas(structure(&strict), 2, Lines::Inextensible, &no_progress).unwrap();
    for record in &found.records {
        assert_eq!(record.checks[0].answer, Answer::Fails);
    }

    let wave = EXAMPLE.replace("[run]", "[design]\nforce_share = 0.9\n[run]\nduration = 1");
    let wave = assess(structure(&wave), 0, &no_progress).unwrap();
    assert_eq!(of_force(&[wave.checks()[0].0.clone()]), Answer::Passes);
}

/// Waves of no height are still water, of which everything is judged.
#[test]
fn waves_of_no_height_have_no_transient() {
    for text in [
        EXAMPLE.replace("height = 2\n", "height = 0\n"),
        SEA.replace("hs = 1.2", "hs = 0"),
    ] {
        let flat = structure(&text.replace("[run]", "[run]\nstart = [0.3, -4.2]\nduration = 60"));
        assert!(!flat.water.eq(&snapload_structure::Water::Still));
        assert_eq!(flat.transient_s, 0.0);
    }
}
