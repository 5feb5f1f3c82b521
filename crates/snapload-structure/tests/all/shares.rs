//! How lines that pull together share a load.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::note::page;
use snapload_structure::{Assessment, assess};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

fn calm() -> String {
    EXAMPLE
        .replace("height = 2\n", "height = 0.5\n")
        .replace("[run]", "[run]\nduration = 120")
}

/// Every line of the case twice, the second of each pair with its length and diameter changed.
fn doubled(length: &str, diameter: &str) -> Assessment {
    let text = calm();
    let (lines, rest) = text.split_once("[site]").expect("a site");
    let (body, lines) = lines.split_once("[[line]]").expect("lines");
    let others = lines
        .replace("length = 6", length)
        .replace("0.038", diameter);
    let text = format!("{body}[[line]]{lines}[[line]]{others}[site]{rest}");
    assess(structure(&text), 0, &no_progress).expect("an assessment")
}

/// Two equal lines with the same ends are as one of twice its area: the same verdict, in which each
/// has half of its tension. Of unlike lines the stiffness decides who carries how much.
#[test]
fn equal_lines_with_the_same_ends_share_evenly() {
    let chain = |d: f64| {
        let square = d * d;
        let ends = 22.3e6 * square * (44.0 - 80.0 * d);
        format!(
            "stiffness = {}\nmass_per_length = {}\nbreaking_load = {}",
            2.0 * 0.854e11 * square,
            2.0 * 19.9e3 * square,
            2.0 * ends
        )
    };
    let twice = calm().replace("type = \"studless chain\"\ndiameter = 0.038", &chain(0.038));
    let one = assess(structure(&twice), 0, &no_progress).expect("an assessment");
    let pair = doubled("length = 6", "0.038");
    let is_shared = |assessment: &Assessment| {
        let mut warnings = assessment.warnings.iter();
        warnings.any(|w| w.rule == "shared loads")
    };
    assert!(!is_shared(&pair) && !pair.prepared.rest.indeterminate);
    assert_eq!(pair.verdict().standing, one.verdict().standing);
    // The order of the lines: both of one side, of the other, and once more.
    for (strand, whole) in [(0, 0), (1, 1), (2, 0), (3, 1)] {
        let tensions = [&pair, &one].map(|a| &a.prepared.rest.tension_n);
        assert!((2.0 * tensions[0][strand] / tensions[1][whole] - 1.0).abs() < 1e-9);
        let pulls = [(&pair, strand), (&one, whole)].map(|(a, line)| a.outcome.lines[line].clone());
        let most = pulls.map(|line| line.largest_taut_n);
        assert!((2.0 * most[0] / most[1] - 1.0).abs() < 1e-3, "{most:?}");
    }
    assert!(is_shared(&doubled("length = 6", "0.05")));
}

/// Three tethers side by side, of which the third is 0.5 mm longer: it pulls only as the others
/// stretch, and has then, as three springs under one load, what is left of a common stretch.
const TETHERS: &str = "[body]\nwidth = 4\ndisplaced_volume = 150\nmass = 60e3\nposition = [0, -8]\n\
    turning_damping = 2e5\n\
    [[line]]\nanchor = [0, -30]\nfairlead = [0, -10]\nlength = 20\nspring_rate = 4e8\n\
    breaking_load = 2e6\n\
    [[line]]\nanchor = [0, -30]\nfairlead = [0, -10]\nlength = 20\nspring_rate = 1e8\n\
    breaking_load = 5e5\n\
    [[line]]\nanchor = [0, -30]\nfairlead = [0, -10]\nlength = 20.0005\nspring_rate = 1e8\n\
    breaking_load = 5e5\n\
    [site]\ndepth = 30\n[wave]\nheight = 0.2\nperiod = 20\n[run]\nrestitution = 0.3\n\
    duration = 60\ntransient = 20\n";

/// Such a line is not called slack at rest, and has at least the utilisation of its tension there.
#[test]
fn a_line_that_pulls_only_as_others_stretch_has_its_share() {
    let found = assess(structure(TETHERS), 0, &no_progress).expect("an assessment");
    let buoyancy_n = (150.0 * 1025.0 - 60e3) * 9.80665;
    let stretch_m = (buoyancy_n + 1e8 * 0.0005) / 6e8;
    let part = 1e8 * (stretch_m - 0.0005) / 5e5;
    assert_eq!(found.outcome.lines[2].largest_n(), Some(0.0));
    let utilisation = found.utilisations()[2].expect("a utilisation");
    assert!((utilisation / part - 1.0).abs() < 1e-6, "{utilisation}");
    let json = found.to_json("case");
    assert_eq!(json["lines"][2]["utilisation"], utilisation);
    assert!(
        found
            .summary("case")
            .contains(&format!("utilisation {part:.2}"))
    );
    let page = page(source("case"), &found, None).expect("a page");
    assert!(page.contains(&format!("<td>500</td><td>{part:.2}</td>")));
    let words = found.verdict().words;
    let said = "Line 3 is slack as long as lines do not stretch, at rest and in the judged time.";
    assert!(words.contains(said), "{words}");
    assert!(!words.contains("slack at rest"), "{words}");
}
