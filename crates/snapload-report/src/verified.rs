//! The same run with many digits, which shows where the ordinary one goes wrong: the question, its
//! JSON and its words.
use crate::question::{Answer, Options, Question, TOLERANCE};
use crate::summary::indented;
use crate::{RunWithTrust, TrustRow, trust_in_words};
use serde::Serialize;
use snapload::analysis::{OnProgress, Uncertainty, Unfinished};
use snapload::{Case, DefaultValue, Key, Kind, Stop};
use snapload_verify::{ExactImpact, MOST_DIGITS, Verification, verify};
use std::fmt::Write;

pub(crate) const VERIFY: Question = Question {
    name: "verify",
    asks: "Run one case again with many digits, and say where the ordinary run goes wrong",
    help: "\
The case is run twice: as usual, and with 76 digits or more. The comparison covers slack flight, impacts and
the stop rules; it ends where a cable stays taut. Numbers count as written: 0.1 is a tenth.

Examples:
  snapload verify
      the standard case: from which impact on the ordinary run is wrong by 1e-3
  snapload verify --case 1922001000-359 --tolerance 1e-6
      a square body, in which errors grow fastest, to six digits
  snapload verify --digits 150 --json - | jq .first_wrong
      with twice the digits, as JSON for another program",
    options: &[
        Key::new(
            "digits",
            "1",
            Kind::Count(1, MOST_DIGITS as u64),
            DefaultValue::Count(60),
            "decimal digits to compute with, at least: 76, 153 or 307 are",
        )
        .symbol("N"),
        TOLERANCE,
    ],
    answer,
};

fn answer(case: &Case, options: &Options, on_progress: OnProgress) -> Result<Answer, Unfinished> {
    let (digits, tolerance) = (options.get::<u64>("digits")?, options.get("tolerance")?);
    let found = verify(case, digits as u32, tolerance, on_progress)?;
    let verified = Verified::new(found, tolerance);
    Ok(Answer::new(verified.in_words(), &verified.row())?)
}

/// An ordinary run together with the same run in many digits.
struct Verified {
    /// The ordinary run.
    trusted: RunWithTrust,
    /// The comparison with the other.
    found: Verification,
}

/// Its form in JSON.
#[derive(Serialize)]
struct VerifiedRow<'a> {
    digits: u32,
    digits_left: f64,
    first_wrong: Option<usize>,
    predicted: Option<usize>,
    compared: usize,
    end: Option<&'static str>,
    t: f64,
    impacts: usize,
    ordinary: Ordinary,
    differences: &'a [f64],
    exact: Vec<ExactRow<'a>>,
    trust: TrustRow<'a>,
}

/// An impact with many digits: decimals as text, as a JSON number would be read as a double.
#[derive(Serialize)]
struct ExactRow<'a> {
    t: &'a str,
    cable: usize,
    v_n: &'a str,
    impulse: &'a str,
}

impl<'a> ExactRow<'a> {
    fn new(impact: &'a ExactImpact) -> Self {
        Self {
            t: &impact.t,
            cable: impact.cable + 1,
            v_n: &impact.v_n,
            impulse: &impact.impulse,
        }
    }
}

#[derive(Serialize)]
struct Ordinary {
    end: &'static str,
    t: f64,
    impacts: usize,
}

impl Verified {
    /// The result for a tolerance.
    fn new(found: Verification, tolerance: f64) -> Self {
        let trusted = RunWithTrust {
            run: found.run.clone(),
            trust: found.trust.clone(),
            uncertainty: Uncertainty {
                tolerance,
                ..Uncertainty::default()
            },
            seed: 0,
            tally: None,
            sensitivity: Vec::new(),
        };
        Self { trusted, found }
    }

    /// The row for JSON.
    fn row(&self) -> VerifiedRow<'_> {
        let Verification {
            digits,
            digits_left,
            run,
            trust,
            differences,
            first_wrong,
            end,
            t,
            impacts,
        } = &self.found;
        VerifiedRow {
            digits: *digits,
            digits_left: *digits_left,
            first_wrong: *first_wrong,
            predicted: trust.horizon.map(|horizon| horizon.impact),
            compared: differences.len(),
            end: end.map(Stop::name),
            t: *t,
            impacts: impacts.len(),
            exact: impacts.iter().map(ExactRow::new).collect(),
            ordinary: Ordinary {
                end: run.end().reason.name(),
                t: run.end().t,
                impacts: run.impacts().len(),
            },
            differences,
            trust: TrustRow::new(&self.trusted),
        }
    }

    /// The result in a few lines.
    fn in_words(&self) -> String {
        let found = &self.found;
        let mut text = String::new();
        let _ = writeln!(
            text,
            "Ordinary  {} at t = {:.6}, {} impacts",
            found.run.end().reason.label(),
            found.run.end().t,
            found.run.impacts().len()
        );
        let end = found.end.map_or_else(
            || "the comparison ends, as a cable stays taut,".to_owned(),
            |end| end.label().to_owned(),
        );
        let _ = writeln!(
            text,
            "{:<9} {end} at t = {:.6}, {} impacts",
            format!("{} dig.", found.digits),
            found.t,
            found.impacts.len()
        );
        let tolerance = self.trusted.uncertainty.tolerance;
        let _ = match found.first_wrong {
            Some(impact) if impact > found.impacts.len() => writeln!(
                text,
                "Compared  correct to {tolerance:e} at all {} impacts, but not at the end",
                found.impacts.len()
            ),
            Some(impact) => writeln!(
                text,
                "Compared  wrong by more than {tolerance:e} from impact {impact} on"
            ),
            None => writeln!(
                text,
                "Compared  correct to {tolerance:e} at {}",
                match found.differences.len() {
                    0 => "the end, without impacts".to_owned(),
                    1 => "the only impact".to_owned(),
                    count => format!("all {count} impacts"),
                }
            ),
        };
        let _ = writeln!(
            text,
            "Predicted {}",
            indented(&trust_in_words(&self.trusted))
        );
        let _ = writeln!(text, "          {}", digits_left_in_words(found));
        text
    }
}

/// How many digits are left at the end, or how many would be needed.
fn digits_left_in_words(found: &Verification) -> String {
    let (digits, left) = (found.digits, found.digits_left);
    if left >= 1.0 {
        let end = found.t;
        return format!("{left:.0} of the {digits} digits are left at t = {end:.4}");
    }
    // The next of the sizes that numbers have.
    let next = (2 * digits + 1).min(MOST_DIGITS);
    let advice = if next > digits {
        format!("use --digits {next}")
    } else {
        format!("more than {MOST_DIGITS} are not possible")
    };
    format!("the {digits} digits are lost before the end; {advice}")
}
