//! What is reported of runs that stop before their motion does.

use crate::verdicts::{source, structure};
use snapload::Stop;
use snapload::analysis::no_progress;
use snapload_structure::note::{ScanCell, page, scan};
use snapload_structure::{ModelAtRest, Outcome, Structure, assess};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// Runs that stop at the largest number of snaps had no time for their largest tension: the
/// comparison of restitutions and that of waves say so.
#[test]
fn what_is_cut_short_is_at_least_as_much() {
    let text = EXAMPLE.replace("[run]", "[run]\nmax_snaps = 150\ntransient = 1");
    let own = structure(&text);
    let assessment = assess(own.clone(), 0, &no_progress).unwrap();
    let rows = assessment.by_restitution();
    for row in &rows {
        let changed = Structure {
            restitution: row.restitution,
            ..own.clone()
        };
        let outcome = Outcome::of(&ModelAtRest::new(changed).unwrap(), 1.0, &no_progress).unwrap();
        let cut_short = outcome.stop == Stop::ImpactLimit;
        assert_eq!(row.numbers.cut_short, cut_short, "{}", row.restitution);
    }
    let cut_short = rows.iter().filter(|row| row.numbers.cut_short).count();
    assert!(cut_short > 0);
    assert_eq!(
        assessment.rebound_text().matches("at least").count(),
        cut_short
    );
    let found = scan(&own, &no_progress).unwrap().unwrap();
    let at_least = |cell: &ScanCell| matches!(cell, ScanCell::AtLeast(_));
    assert!(found.cells.iter().any(at_least));
    let page = page(source("case"), &assessment, Some(&found)).unwrap();
    assert!(page.contains("at least, as the run was cut short"));
    // Of runs that stop before the judged time nothing is known.
    let early = structure(&EXAMPLE.replace("[run]", "[run]\nmax_snaps = 1"));
    let found = scan(&early, &no_progress).unwrap().unwrap();
    let known = |cell: &ScanCell| matches!(cell, ScanCell::Known(_) | ScanCell::AtLeast(_));
    assert!(found.cells.contains(&ScanCell::NotJudged));
    for cell in found.cells.iter().filter(|cell| known(cell)) {
        // Lines that never go slack do not snap.
        assert!(matches!(cell, ScanCell::Known(_)), "{cell:?}");
    }
}

/// A run that stops by itself is not said to have a short judged time, which it does not reach.
#[test]
fn a_run_that_ended_by_itself_needs_no_longer_duration() {
    for (limit, is_short) in [("", true), ("max_snaps = 1\n", false)] {
        let text = EXAMPLE.replace("[run]", &format!("[run]\nduration = 60\n{limit}"));
        let assessment = assess(structure(&text), 0, &no_progress).unwrap();
        assert_eq!(assessment.outcome.stop == Stop::EndTime, is_short);
        let short = assessment.warnings.iter().any(|w| w.rule == "short run");
        assert_eq!(short, is_short, "{limit}");
    }
}
