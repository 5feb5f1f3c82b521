//! `snapload critical`: the smallest force amplitude at which the limits are exceeded, and all others.
use crate::case_input::{CaseArgs, Input};
use crate::doubt::DoubtArgs;
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::progress::Progress;
use crate::stage::Stage;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use snapload::analysis::{CriticalForce, ExceedanceCurve, ForceScan, Uncertainty};
use snapload::{Parameters, Value, key_named};
use snapload_report::{CriticalRow, Probability};
use snapload_study::{Grid, reason};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The critical force is the smallest f_o = step, 2 step, ... whose run stops at the rotation limit or the
upper bound. Larger ones may settle again, so all that exceed are listed as intervals.
--set stop_when_sliding=true ends a run that begins to slide, as the chapter's own studies did.

Examples:
  snapload critical
      the standard case: 0.31
  snapload critical --case 2910001000-359 --set stop_when_sliding=true
      a built-in case, read as the chapter read it
  snapload critical --ensemble 200 --max 0.5
      how probable it is that each amplitude exceeds, where one run can not tell
  snapload critical --over e=0.5:1:51 --json - | jq -c '.points[] | [.value, .f_cr]'
      against the restitution, for the next program";

/// Which case, and which amplitudes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Repeat it for n values of another key, evenly from a to b
    #[arg(long, value_name = "KEY=a:b:n", allow_hyphen_values = true)]
    over: Option<String>,
    /// Step of the amplitude
    #[arg(long, default_value_t = 0.01, allow_negative_numbers = true)]
    step: f64,
    /// Largest amplitude
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    max: f64,
    /// Run N neighbours at each amplitude where one run can not tell, and give the probability of exceeding
    #[arg(long, value_name = "N", conflicts_with = "over", value_parser = clap::value_parser!(u32).range(1..))]
    ensemble: Option<u32>,
    #[command(flatten)]
    uncertainty: DoubtArgs,
    /// Write the answer as JSON to a file; - is standard output, which then gets nothing else
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.uncertainty.is_given() && args.ensemble.is_none() {
        return Err(Failure::bad_input(
            "--uncertainty asks for neighbours, but none are to be run; add --ensemble N, such as --ensemble 200",
        ));
    }
    let input = args.case.read()?;
    let uncertainty = args.uncertainty.read(&input.case)?;
    let scan = ForceScan::new(args.step, args.max)
        .map_err(|error| Failure::BadInput(format!("--{error}")))?;
    let mut stage = Stage::default();
    let json = Json::open(&mut stage, args.json.as_deref())?;
    let answer = match &args.over {
        None => {
            let parameters = input.case.parameters();
            let row =
                CriticalRow(CriticalForce::scan(parameters, scan).map_err(Failure::bad_input)?);
            let curve = args.ensemble.map(|members| {
                probability(
                    parameters,
                    scan,
                    &uncertainty,
                    members,
                    args.uncertainty.seed(),
                )
            });
            Answer::One(row, curve.transpose()?)
        }
        Some(over) => Answer::Many(Many::compute(&input, &Over::parse(over)?, scan)?),
    };
    let Some(written) = json.write(stage, &answer)? else {
        return Ok(());
    };
    let mut text = answer.told(&input.name, args);
    for path in written {
        let _ = writeln!(text, "Written   {}", path.display());
    }
    print(&text)
}

/// The values of another key.
struct Over {
    key: &'static str,
    values: Vec<f64>,
}

/// The most values of another key.
const MOST_VALUES: u64 = 100_000;

impl Over {
    fn parse(text: &str) -> Result<Self, Failure> {
        let wrong = |what: &str| {
            let form = "write --over KEY=a:b:n, such as --over e=0.5:1:11";
            Failure::BadInput(format!("--over {text:?}: {what}; {form}"))
        };
        let (key, range) = text.split_once('=').ok_or_else(|| wrong("no values"))?;
        let key = key_named(key.trim())
            .map_err(|error| Failure::BadInput(format!("--over: {error}")))?
            .name;
        if key == "f_o" {
            return Err(wrong("f_o is what is sought"));
        }
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, count] = parts[..] else {
            return Err(wrong("three numbers are needed, first:last:how many"));
        };
        let count = count.parse().ok().filter(|n| (1..=MOST_VALUES).contains(n));
        let count = count.ok_or_else(|| wrong("n must be a whole number from 1 to 100000"))?;
        let grid = Grid::new(from, to, count).ok_or_else(|| {
            let text = if Grid::new(from, from, 1).is_some() {
                to
            } else {
                from
            };
            wrong(&format!("{text:?} is not a number"))
        })?;
        let values = (0..count).map(|k| grid.value(k)).collect();
        Ok(Self { key, values })
    }
}

/// The probability of exceeding, under a progress bar.
fn probability(
    parameters: &Parameters,
    scan: ForceScan,
    uncertainty: &Uncertainty,
    members: u32,
    seed: u64,
) -> Result<Probability, Failure> {
    let mut progress = Progress::new("force amplitudes", scan.amplitudes().count() as f64);
    let watch = |done: usize| progress.show(done as f64);
    let curve = ExceedanceCurve::scan(parameters, scan, uncertainty, members, seed, watch)
        .map_err(Failure::bad_input)?;
    Ok(Probability {
        curve,
        members,
        seed,
    })
}

enum Answer {
    One(CriticalRow, Option<Probability>),
    Many(Many),
}

struct Many {
    key: &'static str,
    points: Vec<(f64, CriticalRow)>,
}

impl Many {
    fn compute(input: &Input, over: &Over, scan: ForceScan) -> Result<Self, Failure> {
        let cases = over.values.iter().map(|&value| {
            let parameters = input.with(over.key, Value::Number(value));
            parameters.map_err(|error| Failure::BadInput(format!("--over: {error}")))
        });
        // All are checked before the first is run.
        let cases: Vec<_> = cases.collect::<Result<_, Failure>>()?;
        let mut progress = Progress::new("critical force", cases.len() as f64);
        let mut points = Vec::new();
        for (value, parameters) in over.values.iter().zip(&cases) {
            let found = CriticalForce::scan(parameters, scan)
                .map_err(|error| Failure::BadInput(format!("--over: {error}")))?;
            points.push((*value, CriticalRow(found)));
            progress.show(points.len() as f64);
        }
        Ok(Self {
            key: over.key,
            points,
        })
    }
}

impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        match self {
            Self::One(row, curve) => {
                row.entries(&mut map)?;
                if let Some(curve) = curve {
                    curve.entries(&mut map)?;
                }
            }
            Self::Many(many) => {
                map.serialize_entry("over", many.key)?;
                let points: Vec<Point> = many.points.iter().map(Point).collect();
                map.serialize_entry("points", &points)?;
            }
        }
        map.end()
    }
}

struct Point<'a>(&'a (f64, CriticalRow));

impl Serialize for Point<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("value", &self.0.0)?;
        self.0.1.entries(&mut map)?;
        map.end()
    }
}

impl Answer {
    fn told(&self, name: &str, args: &Args) -> String {
        match self {
            Self::One(row, curve) => {
                let mut text = format!("Case      {name}\n");
                let _ = match row.0.first {
                    Some(first) => writeln!(
                        text,
                        "Critical  f_cr = {}: {} at t = {:.4}\nExceeding f_o = {}",
                        first.f_o,
                        reason(first.reason).replace('_', " "),
                        first.t,
                        row.exceeding()
                    ),
                    None => writeln!(text, "Critical  none up to f_o = {}", args.max),
                };
                if let Some(curve) = curve {
                    curve.told(&mut text);
                }
                text
            }
            Self::Many(many) => {
                let mut text = format!("{:<12} {:<8} exceeding\n", many.key, "f_cr");
                for (value, row) in &many.points {
                    let first = row.0.first.map_or("none".to_owned(), |f| f.f_o.to_string());
                    let value = format!("{value:.6}");
                    let value = value.trim_end_matches('0').trim_end_matches('.');
                    let _ = writeln!(text, "{value:<12} {first:<8} {}", row.exceeding());
                }
                text
            }
        }
    }
}
