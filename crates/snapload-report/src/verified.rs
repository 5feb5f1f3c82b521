//! The answer of a verification, in JSON and in words.
use crate::summary::indented;
use crate::{TrustRow, Trusted, trust_in_words};
use serde::Serialize;
use snapload::Stop;
use snapload::analysis::{Uncertainty, sensitivity};
use snapload_verify::{ExactImpact, Verification};
use std::fmt::Write;

/// An ordinary run beside the same run with many digits.
pub struct Verified {
    /// The ordinary run.
    pub trusted: Trusted,
    /// What came of the other.
    pub found: Verification,
}

/// Its shape in JSON.
#[derive(Serialize)]
pub struct VerifiedRow<'a> {
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

/// An impact with many digits: decimals as words, as a number of JSON is read as a double.
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
    /// Of a case, and what was found of it to a tolerance.
    pub fn new(case: &snapload::Case, found: Verification, tolerance: f64) -> Self {
        let trusted = Trusted {
            run: found.run.clone(),
            trust: found.trust.clone(),
            uncertainty: Uncertainty {
                tolerance,
                ..Uncertainty::default()
            },
            seed: 0,
            tally: None,
            sensitivity: sensitivity(case, 0),
        };
        Self { trusted, found }
    }

    /// For JSON.
    pub fn row(&self) -> VerifiedRow<'_> {
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

    /// In a few lines.
    pub fn in_words(&self, name: &str) -> String {
        let found = &self.found;
        let mut text = format!("Case      {name}\n");
        let _ = writeln!(
            text,
            "Ordinary  {} at t = {:.6}, {} impacts",
            found.run.end().reason.words(),
            found.run.end().t,
            found.run.impacts().len()
        );
        let end = found.end.map_or_else(
            || "a cable stays taut, where the proof ends,".to_owned(),
            |end| end.words().to_owned(),
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
                "Proven    right to {tolerance:e} at all {} impacts, and wrong at the end",
                found.impacts.len()
            ),
            Some(impact) => writeln!(
                text,
                "Proven    wrong by more than {tolerance:e} from impact {impact} on"
            ),
            None => writeln!(
                text,
                "Proven    right to {tolerance:e} at all {} impacts",
                found.differences.len()
            ),
        };
        let _ = writeln!(
            text,
            "Predicted {}",
            indented(&trust_in_words(&self.trusted))
        );
        let left = found.digits_left;
        let _ = if left >= 1.0 {
            writeln!(
                text,
                "          {left:.0} of the {} digits are left at the end",
                found.digits
            )
        } else {
            let more = f64::from(found.digits) - left + 10.0;
            writeln!(
                text,
                "          the {} digits are used up before the end; --digits {more:.0} would do",
                found.digits
            )
        };
        text
    }
}
