//! What is said of a structure that an inextensible line does not describe, or that is hardly meant.

use snapload::analysis::unwatched;
use snapload_structure::{Standing, Structure, assess, seas};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");
const SEA: &str = include_str!("../../../../docs/examples/cylinder-sea.toml");

fn structure(text: &str) -> Structure {
    Structure::parse("case", text).unwrap()
}

/// Lines of polyester rope in place of chain.
fn soft(text: &str) -> String {
    text.replace("studless chain", "polyester")
        .replace("diameter = 0.038", "diameter = 0.04")
}

fn rules(text: &str) -> Vec<&'static str> {
    let assessment = assess(structure(text), 0, &unwatched).unwrap();
    assessment.warnings.iter().map(|w| w.rule).collect()
}

#[test]
fn soft_lines_leave_the_verdict_open() {
    let stiff = assess(structure(EXAMPLE), 2, &unwatched).unwrap();
    assert_eq!(stiff.verdict().standing, Standing::Holds);
    let soft = soft(EXAMPLE);
    let open = assess(structure(&soft), 2, &unwatched).unwrap();
    let rule = open.warnings.iter().find(|w| w.rule == "instant snap");
    assert_eq!(rule.unwrap().decided_by, Some("snapload elastic"));
    let verdict = open.verdict();
    assert_eq!(verdict.standing, Standing::Open);
    assert!(
        verdict.words.contains("snapload elastic decides"),
        "{}",
        verdict.words
    );
    assert!(!verdict.words.contains("No line breaks") && !verdict.words.contains("Would break"));
    assert!(!open.trust_words().contains("not in doubt"));
}

#[test]
fn a_sea_has_the_warnings_of_a_wave() {
    let text = soft(SEA).replace("[run]", "[run]\nduration = 300");
    let result = seas(structure(&text), 3, &unwatched).unwrap();
    let assessment = assess(structure(&text), 0, &unwatched).unwrap();
    // That of the phase is known from one motion alone.
    let assessed = assessment.warnings.iter().filter(|w| w.rule != "phase");
    assert!(assessed.eq(&result.warnings) && result.is_open());
    let words = result.words();
    assert!(words.contains("snapload elastic decides"), "{words}");
    assert!(!words.contains("probability"), "{words}");
    assert!(!words.contains("The largest tension"), "{words}");
    assert!(result.summary("case").contains("warning"));
    let json = result.to_json("case");
    assert_eq!(json["warnings"][0]["rule"], result.warnings[0].rule);
}

/// A record whose largest tension is held, and not that of a snap, counts with it.
#[test]
fn what_a_line_holds_is_among_the_largest() {
    let text = SEA.replace("[run]", "[run]\nduration = 600");
    let result = seas(structure(&text), 4, &unwatched).unwrap();
    let largest = result.largest_n().unwrap();
    for (record, largest) in result.records.iter().zip(largest) {
        let lines = &record.outcome.lines;
        let each = lines.iter().map(|l| l.held_n.max(l.peak_n.unwrap_or(0.0)));
        assert_eq!(each.fold(0.0, f64::max), largest);
        assert!(largest >= record.outcome.peak_n().unwrap_or(0.0));
    }
    // Without waves that make lines slack there is no snap, and all is held.
    let calm = text.replace("hs = 1.2", "hs = 0.05");
    let calm = seas(structure(&calm), 4, &unwatched).unwrap();
    let held = calm.largest_n().unwrap();
    let rest = calm
        .prepared
        .rest
        .tension_n
        .iter()
        .fold(0.0_f64, |a, b| a.max(*b));
    assert!(
        calm.records
            .iter()
            .all(|record| record.outcome.snaps() == 0)
    );
    assert!(
        held.iter().all(|largest| *largest >= rest),
        "{held:?} {rest}"
    );
    assert!(calm.peak_in_three_hours().is_some());
}

#[test]
fn too_few_records_are_not_too_few_snaps() {
    let text = SEA.replace("[run]", "[run]\nduration = 300");
    let words = seas(structure(&text), 2, &unwatched).unwrap().words();
    assert!(words.contains("2 records are too few"), "{words}");
}

#[test]
fn what_is_hardly_meant_is_told() {
    assert!(
        !rules(EXAMPLE)
            .iter()
            .any(|rule| ["proportions", "fairleads", "long lines"].contains(rule))
    );
    // A comma in the wrong place: a body of 3 mm, which is then twenty thousand kilometres long.
    let thin = EXAMPLE.replace("width = 3 ", "width = 0.003 ");
    let told = rules(&thin);
    assert!(
        told.contains(&"proportions") && told.contains(&"fairleads"),
        "{told:?}"
    );
    let long = EXAMPLE.replacen("length = 6", "length = 60", 1);
    assert!(rules(&long).contains(&"long lines"));
}

#[test]
fn a_run_that_ends_at_once_says_so() {
    let text = EXAMPLE.replace("[run]", "[run]\nmax_snaps = 1");
    let verdict = assess(structure(&text), 0, &unwatched).unwrap().verdict();
    assert!(
        verdict.words.contains("ended before the 60 s were over"),
        "{}",
        verdict.words
    );
}
