//! The derivatives of the first impacts by each key: the question, its words and its JSON.
use crate::digits::digits;
use crate::question::{Answer, Options, Question};
use crate::run_with_trust::horizon_in_words;
use crate::summary::indented;
use crate::trust::HorizonRow;
use serde::Serialize;
use snapload::analysis::{
    Horizon, OnProgress, Sensitivity, TrustMonitor, Uncertainty, Unfinished, sensitivity,
};
use snapload::{Case, DefaultValue, Key, Kind};
use std::fmt::Write;

pub(crate) const SENSITIVITIES: Question = Question {
    name: "sensitivities",
    asks: "Compute the derivatives of the first impacts by every key that the motion depends on",
    help: "\
The derivatives of time, normal velocity and impulse are exact to rounding. All other keys are held fixed,
except that the inertia follows the size of the body where it is the natural one. Past the horizon of the run
the true motion may be another one; derivatives there are marked.

Examples:
  snapload sensitivities
      the standard case: its first three impacts
  snapload sensitivities --impacts 10 --json - | jq '.derivatives[] | select(.key == \"f_o\")'
      how ten impacts change with the force, as JSON for another program",
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

/// Its form in JSON: a row for each impact and key; none if the start, at the very edge of what is
/// legal, is not legal over dual numbers.
#[derive(Serialize)]
struct Derivatives {
    /// The horizon of the run, up to the last impact that was requested.
    horizon: HorizonRow,
    derivatives: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    impact: usize,
    key: &'static str,
    t: f64,
    v_n: f64,
    impulse: f64,
    /// Whether the impact is before the horizon.
    certain: bool,
}

/// How far the run is followed.
struct FollowedPart {
    impacts: usize,
    horizon: Option<Horizon>,
}

impl FollowedPart {
    /// Follows it up to `count` impacts, or, past the first, up to the horizon.
    fn at(case: &Case, count: usize) -> Result<Self, Unfinished> {
        let mut simulation = case.simulation();
        let mut monitor = TrustMonitor::of_case(case, &Uncertainty::default())?;
        let mut impacts = 0;
        while impacts == 0 || impacts < count && monitor.horizon().is_none() {
            let Some(step) = simulation.step() else { break };
            monitor.follow(&simulation, &step);
            impacts += step.impacts().count();
        }
        let horizon = monitor.horizon().filter(|horizon| horizon.impact <= count);
        Ok(Self { impacts, horizon })
    }

    fn is_certain(&self, impact: usize) -> bool {
        self.horizon.is_none_or(|horizon| horizon.is_after(impact))
    }
}

fn answer(case: &Case, options: &Options, on_progress: OnProgress) -> Result<Answer, Unfinished> {
    let count = options.get::<u64>("impacts")? as usize;
    let found = sensitivity(case, count, on_progress)?;
    let followed_part = FollowedPart::at(case, count)?;
    let words = in_words(&found, &followed_part);
    let rows = found
        .into_iter()
        .flat_map(|Sensitivity { impact, slopes }| {
            let certain = followed_part.is_certain(impact);
            slopes.into_iter().map(move |slope| Row {
                impact,
                key: slope.key,
                t: slope.t,
                v_n: slope.v_n,
                impulse: slope.impulse,
                certain,
            })
        });
    let row = Derivatives {
        derivatives: rows.collect(),
        horizon: HorizonRow::new(followed_part.horizon),
    };
    Ok(Answer::new(words, &row)?)
}

/// A table for each impact.
fn in_words(found: &[Sensitivity], followed_part: &FollowedPart) -> String {
    let mut text = String::new();
    for Sensitivity { impact, slopes } in found {
        let label = format!("Impact {impact}");
        let doubt = if followed_part.is_certain(*impact) {
            ""
        } else {
            "  (not certain)"
        };
        let head = ["of t", "of v_n", "of impulse"];
        let [t, v_n, impulse] = head;
        // Writing to a string can not fail.
        let _ = writeln!(
            text,
            "{label:<9} {:<7} {t:>11} {v_n:>11} {impulse:>11}{doubt}",
            "by key"
        );
        for slope in slopes {
            let [t, v_n, impulse] = [slope.t, slope.v_n, slope.impulse].map(digits);
            let key = slope.key;
            let _ = writeln!(text, "{:<9} {key:<7} {t:>11} {v_n:>11} {impulse:>11}", "");
        }
    }
    if found.is_empty() {
        text.push_str(match followed_part.impacts {
            0 => "Impacts   none, so there are no derivatives\n",
            _ => "Impacts   no derivatives: the start is exactly at the limit of what is legal\n",
        });
    }
    if followed_part.horizon.is_some() {
        let known = horizon_in_words(
            followed_part.horizon,
            Uncertainty::default().tolerance,
            found.len(),
        );
        let _ = writeln!(text, "Trust     {}", indented(&known));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::analysis::no_progress;
    use snapload::{CASE, Entries, Parameters, Value};

    fn answer_for(parameters: Parameters, impacts: i64) -> Result<Answer, Unfinished> {
        let case = Case::new(parameters)?;
        SENSITIVITIES.ask(
            &case,
            &Entries::new(&CASE),
            [("impacts", Value::from(impacts))],
            &no_progress,
        )
    }

    /// The standard case is certain before impact 191, where a near miss ends trust.
    #[test]
    fn what_is_past_the_horizon_is_marked() -> Result<(), Unfinished> {
        let known = answer_for(Parameters::STANDARD, 190)?;
        assert!(!known.words.contains("Trust") && !known.answer.get().contains("false"));
        let more = answer_for(Parameters::STANDARD, 192)?;
        let marked = more.words.matches("(not certain)").count();
        assert_eq!(marked, 2);
        assert!(more.words.contains("before impact 191 of 192"));
        assert_eq!(
            more.answer.get().matches("\"certain\":false").count(),
            2 * 13
        );
        Ok(())
    }

    #[test]
    fn a_run_without_a_snap_has_no_derivatives() -> Result<(), Unfinished> {
        let still = Parameters {
            t_end: 0.01,
            ..Parameters::STANDARD
        };
        assert!(
            answer_for(still, 3)?
                .words
                .contains("there are no derivatives")
        );
        Ok(())
    }
}
