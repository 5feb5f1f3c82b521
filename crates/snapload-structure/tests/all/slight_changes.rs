//! A regular wave that is known to one percent.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::note::page;
use snapload_structure::{Assessment, VerdictKind, assess};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

/// The cylinder in waves so high and so long, in which no line goes slack, on lines of this
/// strength.
fn held(height_m: f64, period_s: f64, breaking_load_n: f64) -> Assessment {
    let text = EXAMPLE
        .replace("height = 2\n", &format!("height = {height_m}\n"))
        .replace("period = 6\n", &format!("period = {period_s}\n"))
        .replace(
            "diameter = 0.038",
            &format!("diameter = 0.038\nbreaking_load = {breaking_load_n}"),
        )
        .replace("[run]", "[run]\nduration = 120\ntransient = 0");
    assess(structure(&text), 2, &no_progress).expect("an assessment")
}

/// Each row is that of a case with this very wave.
#[test]
fn the_wave_is_varied_by_one_percent() {
    let rows = held(0.2, 6.0, 1.3e6).by_wave();
    let waves: Vec<_> = rows
        .iter()
        .map(|row| [row.height_m, row.period_s])
        .collect();
    let known = [
        [0.2, 6.0],
        [0.198, 6.0],
        [0.202, 6.0],
        [0.2, 5.94],
        [0.2, 6.06],
    ];
    assert_eq!(waves, known);
    for row in rows {
        let alone = held(row.height_m, row.period_s, 1.3e6).by_wave()[0];
        assert_eq!(row, alone);
    }
}

/// Taut lines bear more in higher waves: if they just hold, they break in waves of one percent
/// more, and the verdict says so in every report. Lines with a reserve of a fifth hold in both.
#[test]
fn a_line_that_breaks_in_slightly_other_waves_leaves_the_verdict_open() {
    let most_n = held(0.2, 6.0, 1.3e6).outcome.largest_n();
    let firm = held(0.2, 6.0, 1.2 * most_n).verdict();
    assert_eq!(firm.standing, VerdictKind::Holds, "{}", firm.words);
    assert!(!firm.words.contains("1 %"), "{}", firm.words);

    let narrow = held(0.2, 6.0, 1.00001 * most_n);
    assert!(
        narrow
            .neighbours
            .iter()
            .all(|one| one.largest_n() < 1.00001 * most_n)
    );
    let verdict = narrow.verdict();
    assert_eq!(verdict.standing, VerdictKind::Open, "{}", verdict.words);
    for part in [
        "0.202 m and 6 s",
        "so the verdict is open",
        "better than 1 %",
    ] {
        assert!(verdict.words.contains(part), "{}", verdict.words);
    }
    assert!(!verdict.words.contains("0.198 m"), "{}", verdict.words);
    let summary = narrow.summary("case");
    assert!(
        summary.contains("with a height of 0.198, 0.2, 0.202 m"),
        "{summary}"
    );
    let json = narrow.to_json("case");
    assert_eq!(json["by_wave"][2]["height_m"], 0.202);
    assert!(json["by_wave"][2]["largest_utilisation"].as_f64() > Some(1.0));
    let html = page(source("case"), &narrow, None).expect("a page");
    assert!(html.contains("Height and period") && html.contains("<td>0.202</td>"));
    // A line that breaks only just breaks, and holds in lower waves.
    let broken = held(0.2, 6.0, 0.99999 * most_n).verdict();
    assert_eq!(broken.standing, VerdictKind::Breaks, "{}", broken.words);
    assert!(
        broken.words.contains("In waves of 0.198 m"),
        "{}",
        broken.words
    );
    assert!(
        broken.words.contains("no line would break"),
        "{}",
        broken.words
    );
}

/// Records of a sea vary by themselves, and still water has no wave.
#[test]
fn only_a_regular_wave_is_varied() {
    let still = EXAMPLE.replace("[wave]\nheight = 2\nperiod = 6\n", "");
    for text in [
        SEA,
        &still,
        &EXAMPLE.replace("height = 2\n", "height = 0\n"),
    ] {
        let text = text.replace("[run]", "[run]\nduration = 60");
        let assessment = assess(structure(&text), 0, &no_progress).expect("an assessment");
        assert!(assessment.by_wave().is_empty());
        assert_eq!(assessment.waves_text(), None);
        assert!(!assessment.summary("case").contains("\n  wave "));
    }
}
