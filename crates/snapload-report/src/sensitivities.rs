//! How the first impacts change with each key: the question, its words and its JSON.
use crate::digits::digits;
use crate::question::{Answer, Options, Question};
use serde::Serialize;
use snapload::analysis::{OnProgress, Sensitivity, Unfinished, sensitivity};
use snapload::{Case, DefaultValue, Key, Kind};
use std::fmt::Write;

pub(crate) const SENSITIVITIES: Question = Question {
    name: "sensitivities",
    asks: "Derive the first impacts by every key that the motion depends on",
    help: "\
The derivatives of time, normal velocity and impulse are exact to rounding, all other keys held; the
inertia follows the size of the body where it is the natural one.

Examples:
  snapload sensitivities
      the standard case: its first three impacts
  snapload sensitivities --impacts 10 --json - | jq '.derivatives[] | select(.key == \"f_o\")'
      how ten impacts change with the force, for the next program",
    options: &[Key::new(
        "impacts",
        "1",
        Kind::Count(1, 1_000_000),
        DefaultValue::Count(3),
        "how many impacts, from the first on",
    )
    .symbol("N")],
    answer,
};

/// Its shape in JSON: a row an impact and key; none where the start, on the very edge of what is
/// legal, has no neighbours.
#[derive(Serialize)]
struct Derivatives {
    derivatives: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    impact: usize,
    key: &'static str,
    t: f64,
    v_n: f64,
    impulse: f64,
}

fn answer(case: &Case, options: &Options, on_progress: OnProgress) -> Result<Answer, Unfinished> {
    let count: u64 = options.get("impacts")?;
    let found = sensitivity(case, count as usize, on_progress)?;
    let words = in_words(&found);
    let rows = found
        .into_iter()
        .flat_map(|Sensitivity { impact, slopes }| {
            slopes.into_iter().map(move |slope| Row {
                impact,
                key: slope.key,
                t: slope.t,
                v_n: slope.v_n,
                impulse: slope.impulse,
            })
        });
    let derivatives = rows.collect();
    Ok(Answer::new(words, &Derivatives { derivatives })?)
}

/// A table for each impact.
fn in_words(found: &[Sensitivity]) -> String {
    let mut text = String::new();
    for Sensitivity { impact, slopes } in found {
        let label = format!("Impact {impact}");
        let head = ["of t", "of v_n", "of impulse"];
        let [t, v_n, impulse] = head;
        // Writing to a string can not fail.
        let _ = writeln!(
            text,
            "{label:<9} {:<7} {t:>11} {v_n:>11} {impulse:>11}",
            "by"
        );
        for slope in slopes {
            let [t, v_n, impulse] = [slope.t, slope.v_n, slope.impulse].map(digits);
            let key = slope.key;
            let _ = writeln!(text, "{:<9} {key:<7} {t:>11} {v_n:>11} {impulse:>11}", "");
        }
    }
    if found.is_empty() {
        text.push_str("Impacts   none, or the start has no neighbours\n");
    }
    text
}
