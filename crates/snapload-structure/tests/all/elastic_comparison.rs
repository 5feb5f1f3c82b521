//! What the comparison with elastic lines says of the run on inextensible ones.

use crate::verdicts::structure;
use snapload::analysis::no_progress;
use snapload_structure::{ModelAtRest, assess, compare_elastic};

const EXAMPLE: &str = include_str!("../../../../docs/examples/cylinder.toml");

/// The text on one line, as its line breaks do not matter.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Where the body turns over on inextensible lines, and not on elastic ones, or where there are
/// more snaps than allowed, the end of that run is that of `assess`, in JSON and with its reason in
/// words. Where it does not end early nothing is said of its end.
#[test]
fn the_early_end_of_the_run_beside_it_is_reported() {
    let text = EXAMPLE.replace("[run]", "[run]\nduration = 45");
    for (height, period, most, why) in [
        ("2.5", "4", "1000", Some("had turned by 90 degrees")),
        (
            "2",
            "6",
            "3",
            Some("at the largest number of snaps allowed"),
        ),
        ("1.5", "6", "1000", None),
    ] {
        let text = text
            .replace("height = 2\n", &format!("height = {height}\n"))
            .replace("period = 6\n", &format!("period = {period}\n"))
            .replace("[run]", &format!("[run]\nmax_snaps = {most}"));
        let assessed = assess(structure(&text), 0, &no_progress).unwrap();
        let prepared = ModelAtRest::for_elastic_lines(structure(&text)).unwrap();
        let comparison = compare_elastic(prepared, 1.0, f64::INFINITY, &no_progress).unwrap();
        assert_eq!(comparison.elastic.stop, None);
        let json = comparison.to_json("case");
        let end = &json["inextensible"]["end"];
        assert_eq!(*end, assessed.to_json("case")["end"]);
        let end_s = end["t_s"].as_f64().unwrap();
        assert_eq!(end_s < 45.0, why.is_some(), "{end_s}");
        let summary = flat(&comparison.summary("case"));
        let Some(why) = why else {
            assert!(!summary.contains("compared") && !summary.contains("of the first"));
            continue;
        };
        let up_to =
            format!("compared with inextensible lines up to {end_s:.1} s, as the run on them");
        let part = format!("of the first {end_s:.1} s if inextensible");
        for words in [&up_to, why, &part] {
            assert!(summary.contains(words), "{words} in {summary}");
        }
    }
}
