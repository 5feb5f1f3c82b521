//! The map of other waves, and the row of other restitutions: what they compare is one quantity.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::note::{ScanCell, page, scan};
use snapload_structure::{ModelAtRest, Outcome, Structure, assess};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// The example in waves so high and so long, on lines whose breaking load is known and whose
/// stiffness is not.
fn without_stiffness(height_m: f64, period_s: f64) -> Structure {
    let text = EXAMPLE
        .replace("type = \"studless chain\"\n", "")
        .replace("diameter = 0.038", "breaking_load = 1319e3")
        .replace("height = 2\n", &format!("height = {height_m}\n"))
        .replace("period = 6\n", &format!("period = {period_s}\n"))
        .replace("[run]", "[run]\nduration = 100");
    structure(&text)
}

/// Waves in which no line goes slack have no snap, 0 m/s, in the map of a case whose tensions in
/// snaps are not known; with a stiffness that map shows the part of the strength that they use.
#[test]
fn a_map_of_speeds_has_no_utilisations() {
    let gentle = scan(&without_stiffness(0.05, 6.0), &no_progress).unwrap();
    let all = gentle.unwrap().cells;
    assert_eq!(all, vec![ScanCell::Known(0.0); all.len()]);

    let text = EXAMPLE.replace("height = 2\n", "height = 0.05\n");
    let known = scan(&structure(&text), &no_progress).unwrap().unwrap();
    for cell in known.cells {
        let ScanCell::Known(part) = cell else {
            panic!("{cell:?}");
        };
        // At rest the lines bear 392 kN of 1319; these waves add little.
        assert!((392.0 / 1319.0..0.5).contains(&part), "{part}");
    }
}

/// Two of three restitutions make the lines snap, whose tension is not known; all three runs are
/// judged, and have a fastest snap.
#[test]
fn restitutions_are_compared_by_what_all_runs_have() {
    let assessment = assess(without_stiffness(0.95, 4.0), 0, &no_progress).unwrap();
    let rows = assessment.by_restitution();
    let known = rows
        .iter()
        .filter(|row| row.numbers.largest_utilisation.is_some());
    assert!((1..rows.len()).contains(&known.count()), "{rows:?}");
    let speeds = rows.iter().map(|row| row.numbers.fastest_snap_m_s.unwrap());
    let speeds: Vec<String> = speeds.map(|speed| format!("{speed:.2}")).collect();
    let words = assessment.rebound_text();
    let told = format!("fastest snap (m/s) {} with", speeds.join(", "));
    assert!(words.starts_with(&told), "{words} {told}");
}

/// Waves of no height are still water, which has no other waves about it.
#[test]
fn still_water_has_no_map() {
    for waves in ["height = 2\nperiod = 6", "height = 0\nperiod = 6"] {
        let text = EXAMPLE.replace("height = 2\nperiod = 6", waves);
        let text = text.replace("[run]", "[run]\nmax_snaps = 1");
        let found = scan(&structure(&text), &no_progress).unwrap();
        assert_eq!(found.is_some(), waves.contains('2'), "{waves}");
    }
}

/// A wave of the map is judged as a case of that wave and of 60 periods is: after ten of its own
/// periods, or after a transient that is given.
#[test]
fn other_waves_are_judged_as_cases_of_those_waves() {
    for given in ["", "transient = 70", "transient = 60"] {
        let with = |wave: &str, run: &str| {
            let text = EXAMPLE
                .replace("type = \"studless chain\"\n", "")
                .replace("diameter = 0.038", "breaking_load = 1319e3")
                .replace("height = 2\nperiod = 6", wave)
                .replace("[run]", &format!("[run]\n{run}\n{given}"));
            structure(&text)
        };
        let found = scan(&with("height = 2\nperiod = 6", ""), &no_progress);
        let found = found.unwrap().unwrap();
        assert_eq!(found.periods_s[0], 4.0);
        for (height_m, cell) in found.heights_m.iter().zip(&found.cells) {
            let alone = with(
                &format!("height = {height_m}\nperiod = 4"),
                "duration = 240",
            );
            let outcome =
                Outcome::of(&ModelAtRest::new(alone).unwrap(), 1.0, &no_progress).unwrap();
            let speeds = outcome.lines.iter().map(|line| line.speed_m_s);
            let known = match outcome.stop.exceeds() {
                true => ScanCell::Fails,
                false => ScanCell::Known(speeds.fold(0.0, f64::max)),
            };
            assert_eq!(*cell, known, "{given} {height_m}");
        }
    }
}

/// The caption below the snaps names what is drawn: without a stiffness their speeds, of which none
/// breaks a line; tensions beside the breaking load of lines that are alike; and parts of it where
/// lines differ.
#[test]
fn the_caption_of_the_snaps_names_what_is_drawn() {
    let chain = |text: &str| structure(&text.replace("[run]", "[run]\nduration = 100"));
    let stronger = EXAMPLE.replacen("diameter = 0.038", "diameter = 0.042", 1);
    for (case, words, breaks) in [
        (without_stiffness(2.0, 6.0), "Speeds of the snaps", false),
        (chain(EXAMPLE), "Estimated peaks of the snaps", true),
        (chain(&stronger), "over the line's own breaking load", true),
    ] {
        let assessment = assess(case, 0, &no_progress).unwrap();
        let page = page(source("case"), &assessment, None).unwrap();
        let (_, caption) = page.rsplit_once(words).unwrap();
        let (caption, _) = caption.split_once("</figcaption>").unwrap();
        assert_eq!(caption.contains("breaking load."), breaks, "{caption}");
    }
}
