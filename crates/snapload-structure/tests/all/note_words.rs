//! What a design note says of the run that it shows.

use crate::afloat;
use crate::implausible::PONTOON;
use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::note::{page, window};
use snapload_structure::{Assessment, assess};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

fn note(assessment: &Assessment) -> String {
    page(source("case"), assessment, None).expect("a page")
}

/// A body without a file makes no waves, and its note speaks of none that damp it; one with a file
/// has a memory.
#[test]
fn only_a_body_that_makes_waves_is_damped_by_them() {
    let without = assess(structure(PONTOON), 0, &no_progress).expect("an assessment");
    let wave = "[wave]\nheight = 0.2\nperiod = 5";
    let file = afloat::case(0.0, 2.4, 9.666, wave, "duration = 60\ntransient = 0");
    let file = file.replace("pairs = 6", "pairs = 6\ndamping = [0, 0, 8000]");
    let with = assess(afloat::structure(&file), 0, &no_progress).expect("an assessment");
    for (assessment, makes_waves) in [(&without, false), (&with, true)] {
        let html = note(assessment);
        for words in [
            "radiation damping with its memory",
            "pitch (besides radiation) 8000",
        ] {
            assert_eq!(html.contains(words), makes_waves, "{words}");
        }
        assert_eq!(html.contains("The body makes no waves"), !makes_waves);
        assert!(html.contains("8000 N m s"));
    }
}

/// With a line of 2.3 times the strength beside one of chain the fastest snap is not the one that
/// comes nearest to breaking its line, and the figures are about the latter, which leads the list.
#[test]
fn figures_and_list_have_one_hardest_snap() {
    let text = EXAMPLE
        .replacen("diameter = 0.038", "diameter = 0.06", 1)
        .replace("height = 2\nperiod = 6", "height = 2.5\nperiod = 4.5")
        .replace("[run]", "[run]\nduration = 240");
    let assessment = assess(structure(&text), 0, &no_progress).expect("an assessment");
    let most = |of: fn(&snapload_structure::Snap) -> f64| {
        let all = assessment.judged().map(|snap| (of(snap), snap.t_s));
        all.reduce(|a, b| if b.0 > a.0 { b } else { a })
            .expect("a snap")
            .1
    };
    let hardest_s = most(|snap| snap.utilisation.expect("a strength"));
    let fastest_s = most(|snap| snap.speed_m_s);
    let [from, to] = window(&assessment);
    assert!((from..=to).contains(&hardest_s), "{hardest_s} {from} {to}");
    assert!(!(from..=to).contains(&fastest_s), "{fastest_s} {from} {to}");
    assert!(note(&assessment).contains(&format!("<tr><td>{hardest_s:.2}</td>")));
}

/// Of two lines side by side the longer one is slack if neither stretches, and bears as much on
/// springs, up to 2 % for 0.1 mm of 5 m: the rows say that their tensions at rest are the latter's.
#[test]
fn tensions_at_rest_on_elastic_lines_are_called_so() {
    let pair = |length: &str| {
        let (head, tail) = EXAMPLE.split_once("[[line]]").expect("lines");
        let (_, tail) = tail.split_once("[site]").expect("a site");
        let line = |length: &str| {
            format!(
                "[[line]]\nanchor = [0, -10]\nfairlead = [0, -5]\nlength = {length}\n\
                 spring_rate = 2.05e7\nbreaking_load = 1.3e6\n"
            )
        };
        let (one, other) = (line("5"), line(length));
        let text = format!("{head}{one}{other}[site]{tail}");
        let text = text.replace("[run]", "[run]\nduration = 10\ntransient = 0");
        assess(structure(&text), 0, &no_progress).expect("an assessment")
    };
    for (length, is_shared) in [("5", false), ("5.0001", true)] {
        let assessment = pair(length);
        let summary = assessment.summary("case");
        let words = "kN at rest on elastic lines, up to";
        assert_eq!(summary.contains(words), is_shared, "{summary}");
        let html = note(&assessment);
        assert_eq!(html.contains("At rest: on elastic lines"), is_shared);
    }
}
