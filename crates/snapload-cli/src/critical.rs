//! `snapload critical`: the smallest force amplitude at which the limits are exceeded, and all
//! others.
use crate::bar::Bar;
use crate::case_input::{CaseArgs, Input};
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::outputs::Outputs;
use crate::uncertainty::{UncertaintyArgs, with_option};
use serde::Serialize;
use snapload::analysis::{
    CriticalForce, ExceedanceCurve, ForceScan, NEIGHBOURS, NONZERO_MEMBERS, OnProgress, Progress,
};
use snapload::{CaseError, Value};
use snapload_report::tables::in_digits;
use snapload_report::{CriticalRow, Probability, case_in_words};
use snapload_study::Axis;
use std::fmt::Write;

const EXAMPLES: &str = "\
The critical force is the smallest amplitude f_o = step, 2 step, ... whose run stops at a limit of the motion,
such as the rotation limit or the upper bound. Runs with larger amplitudes may settle again, so all amplitudes
that exceed a limit are listed as intervals. So are those at which rounding decides whether they exceed: their
runs pass their horizon of trust, and neighbours disagree: 20 within rounding, or those of --ensemble. With --set stop_when_sliding=true a run ends when the body begins to
slide, as in the studies of the thesis's chapter 6.

Examples:
  snapload critical
      the standard case, with the result 0.31
  snapload critical --case 2910001000-359 --set stop_when_sliding=true
      a built-in case, with runs that end at sliding as in the chapter
  snapload critical --ensemble 200 --max 0.5
      the probability that each amplitude exceeds a limit, where one run can not decide
  snapload critical --over e=0.5:1:51 --json - | jq -c '.points[] | [.value, .f_cr]'
      critical force against the coefficient of restitution, for another program";

/// Which case, and which amplitudes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Repeat for n evenly spaced values of another key from a to b
    #[arg(long, value_name = "KEY=a:b:n", allow_hyphen_values = true)]
    over: Option<String>,
    /// Step of the force amplitude
    #[arg(long, default_value_t = 0.01)]
    step: f64,
    /// Largest force amplitude
    #[arg(long, default_value_t = 1.0)]
    max: f64,
    /// Run N neighbours at each amplitude where one run can not decide, and report the
    /// probability of exceeding a limit
    #[arg(long, value_name = "N", conflicts_with = "over", value_parser = whole_number::<u32>(NONZERO_MEMBERS.called("ensemble")))]
    ensemble: Option<u32>,
    #[command(flatten)]
    uncertainty: UncertaintyArgs,
    #[command(flatten)]
    json: JsonArgs,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if let (Some(option), None) = (args.uncertainty.given(), args.ensemble) {
        return Err(Failure::BadInput(format!(
            "{option} needs neighbours, but none are run; add --ensemble N, such as --ensemble 200"
        )));
    }
    let input = args.case.read()?;
    let uncertainty = args.uncertainty.read(&input.case)?;
    let scan = ForceScan::new(args.step, args.max)
        .map_err(|error| Failure::BadInput(format!("--{error}")))?;
    let outputs = Outputs::open(&args.json)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let answer = match &args.over {
        None => {
            let parameters = input.case.parameters();
            let seed = args.uncertainty.seed();
            match args.ensemble {
                None => Answer::One {
                    row: CriticalRow::new(CriticalForce::scan(parameters, scan, &on_progress)?),
                    curve: None,
                },
                Some(members) => {
                    let curve = ExceedanceCurve::scan(
                        parameters,
                        scan,
                        &uncertainty,
                        members,
                        seed,
                        &on_progress,
                    )
                    .map_err(with_option)?;
                    Answer::One {
                        row: CriticalRow::new(curve.critical_force()),
                        curve: Some(Probability::new(&curve, members, seed)),
                    }
                }
            }
        }
        Some(text) => over(&input, text, scan, &on_progress)
            .map_err(|failure| failure.with_prefix("--over"))?,
    };
    drop(bar);
    let text = answer.in_words(&case_in_words(&input.name, input.case.parameters()), args);
    outputs.finish(&answer, text)
}

/// What is not known of runs that are cut short.
const CUT_SHORT: &str = "not known whether these exceed, as their runs stopped at the impact limit or a standstill \
                         (max_impacts sets the limit)";

/// What decides where neighbours disagree.
const DECIDED_BY: &str = "(--ensemble N gives the probability, snapload certify a proof)";

/// The most values of another key.
const MOST_VALUES: u64 = 100_000;

/// The critical force for values of another key.
fn over(
    input: &Input,
    text: &str,
    scan: ForceScan,
    on_progress: OnProgress,
) -> Result<Answer, Failure> {
    let (key, range) = text.split_once('=').ok_or_else(|| {
        let form = "write --over KEY=a:b:n, such as --over e=0.5:1:11";
        Failure::BadInput(format!("{text:?}: no values; {form}"))
    })?;
    let axis = Axis::written(key.trim(), range)?;
    let key = axis.key();
    if key == "f_o" {
        return Err(Failure::bad_input(
            "f_o is the key that is searched; choose another key",
        ));
    }
    if axis.count() > MOST_VALUES {
        let message = format!("{text:?}: n must be a whole number from 1 to {MOST_VALUES}");
        return Err(Failure::BadInput(message));
    }
    let case = |k: u64| match axis.value(k) {
        Value::Number(value) => Ok((value, input.with(key, value.into())?)),
        value => Err(CaseError::value(key, value, "a number")),
    };
    // All cases are checked before the first one is run.
    let cases = (0..axis.count()).map(case).collect::<Result<Vec<_>, _>>();
    let cases = cases.map_err(Failure::bad_input)?;
    let all = cases.len() as f64;
    let mut points = Vec::new();
    for (value, parameters) in cases {
        let progress = Progress::new("critical force", points.len() as f64, all);
        let row = CriticalForce::scan(&parameters, scan, &|_| on_progress(progress))?;
        let row = CriticalRow::new(row);
        points.push(Point { value, row });
    }
    Ok(Answer::Many { over: key, points })
}

/// A value rounded to six digits.
fn significant(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The answer, in the form of its JSON.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer {
    One {
        #[serde(flatten)]
        row: CriticalRow,
        #[serde(flatten)]
        curve: Option<Probability>,
    },
    Many {
        over: &'static str,
        points: Vec<Point>,
    },
}

/// The result at one value of the other key.
#[derive(Serialize)]
struct Point {
    value: f64,
    #[serde(flatten)]
    row: CriticalRow,
}

impl Answer {
    fn in_words(&self, case: &str, args: &Args) -> String {
        match self {
            Self::One { row, curve } => {
                let mut text = format!("Case      {case}\n");
                let sure = if row.certain { "" } else { " (not certain)" };
                let _ = match (row.f_cr, row.reason, row.t) {
                    (Some(f_cr), Some(reason), Some(t)) => writeln!(
                        text,
                        "Critical  f_cr = {f_cr}: {} at t = {t:.4}{sure}\nExceeding f_o = {}",
                        reason.replace('_', " "),
                        row.exceeding()
                    ),
                    _ => writeln!(text, "Critical  none up to f_o = {}{sure}", row.up_to),
                };
                if let Some(cut_short) = row.cut_short() {
                    let _ = writeln!(text, "Cut short f_o = {cut_short}: {CUT_SHORT}");
                }
                if let Some(uncertain) = row.uncertain() {
                    let _ = writeln!(
                        text,
                        "Uncertain f_o = {uncertain}: not all of {} neighbours do as the run does, or some are cut short",
                        args.ensemble.unwrap_or(NEIGHBOURS)
                    );
                    if curve.is_none() {
                        let _ = writeln!(text, "          {DECIDED_BY}");
                    }
                }
                if let Some(curve) = curve {
                    curve.in_words(&mut text);
                }
                text
            }
            Self::Many { over, points } => {
                let mut text = format!("{over:<12} {:<8} exceeding\n", "f_cr");
                for Point { value, row } in points {
                    let first = row.f_cr.map_or("none".to_owned(), |f_cr| f_cr.to_string());
                    let first = if row.certain {
                        first
                    } else {
                        format!("~{first}")
                    };
                    let value = in_digits(significant(*value));
                    let _ = writeln!(text, "{value:<12} {first:<8} {}", row.exceeding());
                }
                if points.iter().any(|point| !point.row.certain) {
                    let _ = writeln!(
                        text,
                        "~ not certain: its run passes its horizon, or at or below it neighbours disagree or runs stopped \
                         at the impact limit"
                    );
                }
                text
            }
        }
    }
}
