//! `snapload verify`: the same run with many digits, to see where the ordinary one goes wrong.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::{Failure, print};
use crate::json::JsonArgs;
use crate::stage::Stage;
use crate::uncertainty::ToleranceArgs;
use crate::whole::whole;
use snapload::analysis::Progress;
use snapload_report::{Verified, case_in_words};
use snapload_verify::{MOST_DIGITS, verify};
use std::fmt::Write;

const EXAMPLES: &str = "\
The case is run twice, as usual and with 76 digits or more, through slack flight, impacts and the stop
rules; where a cable stays taut the proof ends. Numbers count as written: 0.1 is a tenth.

Examples:
  snapload verify
      the standard case: from which impact on the ordinary run is wrong by 1e-3
  snapload verify --case 1922001000-359 --tolerance 1e-6
      a square, in which errors grow fastest, to six digits
  snapload verify --digits 150 --json - | jq .first_wrong
      with twice the digits, for the next program";

/// Which case, and with how many digits.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Decimal digits to compute with, at least
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = whole::<u32>(1, MOST_DIGITS))]
    digits: u32,
    #[command(flatten)]
    tolerance: ToleranceArgs,
    #[command(flatten)]
    json: JsonArgs,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let input = args.case.read()?;
    let tolerance = args.tolerance.read()?;
    let mut stage = Stage::default();
    let json = args.json.open(&mut stage)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let found = verify(&input.case, args.digits, tolerance, &on_progress)?;
    drop(bar);
    let answer = Verified::new(&input.case, found, tolerance);
    if let Some(written) = json.write(stage, &answer.row())? {
        let mut text = answer.in_words(&case_in_words(&input.name, input.case.parameters()));
        for path in written {
            let _ = writeln!(text, "Written   {}", path.display());
        }
        print(&text)?;
    }
    Ok(())
}
