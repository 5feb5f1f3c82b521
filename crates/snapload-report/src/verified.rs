//! The same run with many digits, which shows where the ordinary one goes wrong: the question, its
//! JSON and its words.
use crate::digits::count;
use crate::question::{Answer, Options, Question, TOLERANCE};
use crate::summary::indented;
use crate::{RunWithTrust, TrustRow, trust_in_words};
use serde::Serialize;
use snapload::analysis::{OnProgress, Uncertainty, Unfinished};
use snapload::{Case, DefaultValue, Key, Kind, Stop};
use snapload_verify::{ExactImpact, MOST_DIGITS, Verification, verify_as_written};
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
            "decimal digits to compute with, rounded up to 76, 153 or 307",
        )
        .symbol("N"),
        TOLERANCE,
    ],
    answer,
};

fn answer(case: &Case, options: &Options, on_progress: OnProgress) -> Result<Answer, Unfinished> {
    let (digits, tolerance) = (options.get::<u64>("digits")?, options.get("tolerance")?);
    let found = verify_as_written(case, options.entries, digits as u32, tolerance, on_progress)?;
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
    t: Option<f64>,
    impacts: Option<usize>,
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
            t: t.as_ref().and_then(|t| t.parse().ok()),
            impacts: t.as_ref().map(|_| impacts.len()),
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
            "Ordinary  {} at t = {:.6}, {}",
            found.run.end().reason.label(),
            found.run.end().t,
            count(found.run.impacts().len(), "impact")
        );
        let label = format!("{} dig.", found.digits);
        let _ = writeln!(text, "{label:<9} {}", exact_end_in_words(found));
        let tolerance = self.trusted.uncertainty.tolerance;
        let _ = writeln!(text, "Compared  {}", compared_in_words(found, tolerance));
        let _ = writeln!(
            text,
            "Predicted {}",
            indented(&trust_in_words(&self.trusted))
        );
        let _ = writeln!(text, "          {}", digits_left_in_words(found));
        text
    }
}

/// How the run with many digits ends, or how far it is known.
fn exact_end_in_words(found: &Verification) -> String {
    let impacts = count(found.impacts.len(), "impact");
    match (&found.t, found.impacts.last()) {
        (Some(t), _) => {
            let end = found
                .end
                .map_or("the comparison ends, as a cable stays taut,", Stop::label);
            format!("{end} at t = {}, {impacts}", shortened(t, 6))
        }
        (None, Some(last)) => {
            let t = shortened(&last.t, 6);
            format!("known for {impacts}, up to t = {t}; its end is not")
        }
        (None, None) => "neither its end nor any impact is known".to_owned(),
    }
}

/// Where the ordinary run is wrong, among what is known with many digits.
fn compared_in_words(found: &Verification, tolerance: f64) -> String {
    let known = found.impacts.len();
    if let Some(impact) = found.first_wrong.filter(|impact| *impact <= known) {
        // Up to where the runs part each impact has a difference.
        if impact <= found.differences.len() {
            return format!("wrong by more than {tolerance:e} from impact {impact} on");
        }
        let parts = match found.run.impacts().len() < impact {
            true => "missing",
            false => "of another cable than in the true motion",
        };
        return match impact {
            1 => format!("impact 1 is {parts}"),
            _ => format!("impact {impact} is {parts}; correct to {tolerance:e} before it"),
        };
    }
    // Where a cable stays taut the run with many digits ends, and with it the comparison.
    if found.t.is_some() && found.end.is_none() {
        let all = count(found.run.impacts().len(), "impact");
        return match known {
            0 => format!(
                "nothing, as a cable stays taut before any impact; the ordinary run has {all}"
            ),
            known => {
                let those = match known {
                    1 => "impact".to_owned(),
                    _ => format!("{known} impacts"),
                };
                format!(
                    "correct to {tolerance:e} at the {those} before a cable stays taut; the ordinary run has {all}"
                )
            }
        };
    }
    let place = match (known, &found.t) {
        (0, None) => return "not possible".to_owned(),
        (_, None) => format!("the {} that many digits know", count(known, "impact")),
        (0, _) => "the end, without impacts".to_owned(),
        (1, _) => "the only impact".to_owned(),
        _ => format!("all {known} impacts"),
    };
    match (found.first_wrong, known) {
        (None, _) => format!("correct to {tolerance:e} at {place}"),
        (Some(_), 0) => format!("wrong by more than {tolerance:e} at the end"),
        (Some(_), _) => format!("correct to {tolerance:e} at {place}, but not at the end"),
    }
}

/// A decimal with at most so many places, and no more than it has.
fn shortened(decimal: &str, most: usize) -> String {
    let places = decimal
        .split_once('.')
        .map_or(0, |(_, places)| places.len());
    let number = decimal.parse::<f64>();
    number.map_or_else(
        |_| decimal.to_owned(),
        |number| format!("{number:.0$}", places.min(most)),
    )
}

/// How many digits are left at the end, or how many would be needed.
fn digits_left_in_words(found: &Verification) -> String {
    let (digits, left) = (found.digits, found.digits_left);
    if let Some(end) = &found.t {
        let end = shortened(end, 4);
        return format!("{left:.0} of the {digits} digits are left at t = {end}");
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

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use snapload::analysis::no_progress;
    use snapload::{CASE, Entries, Parameters};
    use snapload_verify::verify;

    fn answered(parameters: Parameters) -> Result<(String, Value), Unfinished> {
        let case = Case::new(parameters)?;
        let answer = VERIFY.ask(
            &case,
            &Entries::new(&CASE),
            [("digits", 60_i64.into()); 1],
            &no_progress,
        )?;
        let json = serde_json::from_str(answer.answer.get()).expect("JSON");
        Ok((answer.words, json))
    }

    /// Where a cable stays taut nothing is compared, and nothing is said to be correct.
    #[test]
    fn what_comes_after_a_cable_stays_taut_is_not_called_correct() -> Result<(), Unfinished> {
        let (words, json) = answered(Parameters {
            y: 0.0,
            f_o: -0.92,
            nu: 0.0,
            omega: 1.0,
            t_end: 10.0,
            stop_when_settled: false,
            ..Parameters::STANDARD
        })?;
        assert!(json["end"].is_null() && json["compared"] != json["ordinary"]["impacts"]);
        assert!(words.contains("the ordinary run has"), "{words}");
        assert!(!words.contains("at the end"), "{words}");
        let (words, json) = answered(Parameters {
            e: 0.01,
            y: 0.2,
            t_end: 5.0,
            stop_when_settled: false,
            ..Parameters::STANDARD
        })?;
        let known = json["exact"].as_array().map_or(0, Vec::len);
        let compared = format!("at the {known} impacts before a cable stays taut; the ordinary");
        assert!(known > 1 && words.contains(&compared), "{words}");
        Ok(())
    }

    /// Impacts are compared as long as those of the same number are of the same cable.
    #[test]
    fn nothing_is_compared_after_the_runs_part() -> Result<(), Unfinished> {
        let case = Case::new(Parameters::STANDARD)?;
        for tolerance in [1e-3, 0.5] {
            let found = verify(&case, 60, tolerance, &no_progress)?;
            let cables = found.run.impacts().iter().zip(&found.impacts);
            let alike = cables.take_while(|(ours, exact)| ours.cable == exact.cable);
            let alike = alike.count();
            assert!(alike < found.impacts.len().min(found.run.impacts().len()));
            assert_eq!(found.differences.len(), alike);
            assert!(found.differences.iter().all(|d| *d < tolerance));
            assert_eq!(found.first_wrong, Some(alike + 1));
            let verified = Verified::new(found, tolerance);
            assert_eq!(verified.row().compared, alike);
            let words = verified.in_words();
            let parts = format!("impact {} is of another cable than in", alike + 1);
            assert!(words.contains(&parts), "{words}");
            assert!(!words.contains("wrong by more than"), "{words}");
        }
        Ok(())
    }

    /// With 153 digits this run has 322 impacts.
    #[test]
    fn an_end_that_is_not_known_is_not_stated() -> Result<(), Unfinished> {
        let square = snapload::named_case("1922001000-359")?;
        let (words, json) = answered(square.parameters)?;
        for key in ["end", "t", "impacts"] {
            assert!(json[key].is_null(), "{key}");
        }
        assert_eq!(json["digits_left"], 0.0);
        let known = json["exact"].as_array().map_or(0, Vec::len);
        assert!((200..322).contains(&known), "{known}");
        let line = format!("\n76 dig.   known for {known} impacts, up to t = ");
        assert!(words.contains(&line), "{words}");
        assert!(words.contains("; its end is not\n"), "{words}");
        let advice = "the 76 digits are lost before the end; use --digits 153";
        assert!(words.contains(advice), "{words}");
        Ok(())
    }

    #[test]
    fn one_impact_has_no_plural() -> Result<(), Unfinished> {
        let (words, json) = answered(Parameters {
            e: 0.0,
            f_o: 0.0,
            x: 0.1,
            y: 0.5,
            ..Parameters::STANDARD
        })?;
        assert_eq!(json["impacts"], 1);
        assert!(words.contains(", 1 impact\n"), "{words}");
        assert!(!words.contains("1 impacts"), "{words}");
        Ok(())
    }

    #[test]
    fn no_more_places_are_printed_than_are_known() {
        let shown = ["26.1", "28.787654321", "3.0", "100.00000000000"];
        let shown = shown.map(|decimal| shortened(decimal, 6));
        assert_eq!(shown, ["26.1", "28.787654", "3.0", "100.000000"]);
    }
}
