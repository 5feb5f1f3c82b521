//! `snapload verify`: the same run with many digits, to see where the ordinary one goes wrong.
use crate::case_input::CaseArgs;
use crate::doubt::{TrustRow, Trusted, trust_in_words};
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::progress::Progress;
use crate::stage::Stage;
use crate::summary;
use serde::Serialize;
use snapload::analysis::{Doubt, MOST_DIGITS, Verification, sensitivity, verify};
use snapload_study::reason;
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The case is run twice, as usual and with 76 digits or more, through slack flight, impacts and the stop
rules; where a cable stays taut the proof ends. Numbers count as written: 0.1 is a tenth.

Examples:
  snapload verify
      the standard case: from which impact on the ordinary run is wrong by 1e-3
  snapload verify --case 1922001000-359 --tolerance 1e-6
      a square, in which errors grow fastest, to six digits
  snapload verify --digits 150 --json - | jq .proven
      with twice the digits, for the next program";

/// Which case, and with how many digits.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Decimal digits to compute with, at least
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_DIGITS)))]
    digits: u32,
    /// Error of state and time above which the ordinary run counts as wrong
    #[arg(
        long,
        value_name = "SIZE",
        default_value_t = 1e-3,
        allow_negative_numbers = true
    )]
    tolerance: f64,
    /// Write the answer as JSON to a file; - is standard output, which then gets nothing else
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let input = args.case.read()?;
    if !(args.tolerance > 0.0 && args.tolerance.is_finite()) {
        let tolerance = args.tolerance;
        return Err(Failure::BadInput(format!(
            "--tolerance {tolerance}: allowed is a number above 0, such as 1e-3"
        )));
    }
    let mut stage = Stage::default();
    let json = Json::open(&mut stage, args.json.as_deref())?;
    let mut progress = Progress::new("computing with many digits", input.case.parameters().t_end);
    let found = verify(&input.case, args.digits, args.tolerance, |t| {
        progress.show(t)
    })
    .map_err(Failure::bad_input)?;
    drop(progress);
    let answer = Answer::new(&input.case, found, args.tolerance);
    if let Some(written) = json.write(stage, &answer.row())? {
        let mut text = answer.told(&summary::case(&input));
        for path in written {
            let _ = writeln!(text, "Written   {}", path.display());
        }
        print(&text)?;
    }
    Ok(())
}

struct Answer {
    trusted: Trusted,
    found: Verification,
}

#[derive(Serialize)]
struct Row<'a> {
    digits: u32,
    digits_left: f64,
    proven: Option<usize>,
    predicted: Option<usize>,
    compared: usize,
    end: Option<&'static str>,
    t: f64,
    impacts: usize,
    ordinary: Ordinary,
    differences: &'a [f64],
    trust: TrustRow<'a>,
}

#[derive(Serialize)]
struct Ordinary {
    end: &'static str,
    t: f64,
    impacts: usize,
}

impl Answer {
    fn new(case: &snapload::Case, found: Verification, tolerance: f64) -> Self {
        let trusted = Trusted {
            run: found.run.clone(),
            trust: found.trust.clone(),
            doubt: Doubt {
                tolerance,
                ..Doubt::default()
            },
            seed: 0,
            tally: None,
            sensitivity: sensitivity(case, 0),
        };
        Self { trusted, found }
    }

    fn row(&self) -> Row<'_> {
        let Verification {
            digits,
            digits_left,
            run,
            trust,
            differences,
            proven,
            end,
            t,
            impacts,
        } = &self.found;
        Row {
            digits: *digits,
            digits_left: *digits_left,
            proven: *proven,
            predicted: trust.horizon.map(|horizon| horizon.impact),
            compared: differences.len(),
            end: end.map(reason),
            t: *t,
            impacts: *impacts,
            ordinary: Ordinary {
                end: reason(run.end().reason),
                t: run.end().t,
                impacts: run.impacts().len(),
            },
            differences,
            trust: TrustRow::new(&self.trusted),
        }
    }

    fn told(&self, name: &str) -> String {
        let found = &self.found;
        let mut text = format!("Case      {name}\n");
        let words = |reason: &str| reason.replace('_', " ");
        let _ = writeln!(
            text,
            "Ordinary  {} at t = {:.6}, {} impacts",
            words(reason(found.run.end().reason)),
            found.run.end().t,
            found.run.impacts().len()
        );
        let end = found.end.map_or_else(
            || "a cable stays taut, where the proof ends,".to_owned(),
            |end| words(reason(end)),
        );
        let _ = writeln!(
            text,
            "{:<9} {end} at t = {:.6}, {} impacts",
            format!("{} dig.", found.digits),
            found.t,
            found.impacts
        );
        let tolerance = self.trusted.doubt.tolerance;
        let _ = match found.proven {
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
            summary::indented(&trust_in_words(&self.trusted))
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
