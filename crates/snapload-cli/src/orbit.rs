//! `snapload orbit`: periodic orbits.
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::orbit_search::{FoundOrbits, Search, columns};
use crate::outputs::{Outputs, TABLE};
use crate::table::axis;
use serde::Serialize;
use snapload::analysis::{OnProgress, SEED, START_KEYS};
use snapload::{CaseError, Parameters, Value, parse_value};
use snapload_orbits::{
    Moored, ORBIT_PERIODS, Orbit, OrbitRequest, OrbitRow, Point, Proofs, STARTS, check_start,
    checked_phase, distance, of_attractor, orbit_summary, start_of,
};
use snapload_report::{CaseEcho, case_in_words};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
A periodic orbit is a motion that repeats itself after a whole number of forcing periods. Newton's method solves
for the orbit to rounding, for a given sequence of events. The orbit is then simulated, because a solution for a
sequence of events need not be a possible motion: `admissible` says whether it is and, if not, why. Runs do not
stop when the body settles.

Examples:
  snapload orbit --set body=point --set r=1.7 --set e=0.35 --set f_o=1.4 --set nu=0.8 \\
      --set omega=3.1
      the orbit that the motion from the start converges to
  snapload orbit --set omega=3 --start x=-0.06,y=0.12,theta=0.48,vx=0.39,vy=0.65,vtheta=-1.67
      the orbit near a given state, which may be unstable
  snapload orbit --set omega=3 --find 2000 --seed 1 --json - | jq '.orbits[].multipliers[0]'
      all orbits found from random starts, for another program
  snapload orbit --set a=0.3 --set b=0.3 --set omega=2.5 --find 1000 --vary f_o=0.4:0.6:21 --prove \\
      --out orbits.parquet
      more than a thousand orbits of a square body, each proved to exist

Exit status: 0 found, or searched with --find; 1 no orbit near the start, or with --prove one that is not
proved; 2 bad input.";

/// Which case, and which orbit.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    near: NearArgs,
    /// Cables that snap, in the order of their snaps
    #[arg(long, value_name = "2,1")]
    symbol: Option<String>,
    /// Try N random starts and report all orbits found
    #[arg(long, value_name = "N", conflicts_with = "start", value_parser = whole_number::<u32>(STARTS.called("find")))]
    find: Option<u32>,
    /// Seed of the random starts
    #[arg(
        long,
        value_name = "S",
        default_value_t = 0,
        value_parser = whole_number::<u64>(SEED),
        requires = "find"
    )]
    seed: u64,
    /// Search at each of these values of a key, from the random starts and from the orbits found at
    /// the previous value
    #[arg(
        long,
        value_name = "KEY=first:last:n",
        requires = "find",
        allow_hyphen_values = true
    )]
    vary: Option<String>,
    /// Prove with numbers of many digits that the orbit exists, and bound the error of the printed
    /// one; for orbits in slack flight, with the decimals of the case taken as exact
    #[arg(long)]
    prove: bool,
    /// Write a table with one row per orbit, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

/// Where an orbit is looked for.
#[derive(clap::Args)]
pub(crate) struct NearArgs {
    /// State at the section, near the orbit; keys left out have the values of the case
    #[arg(long, value_name = "x=..,y=..", allow_hyphen_values = true)]
    start: Option<String>,
    /// Period of the orbit in forcing periods; by default 1 with --start, else that of the motion
    #[arg(long, value_name = "N", value_parser = whole_number::<u32>(ORBIT_PERIODS))]
    periods: Option<u32>,
    /// Time of the section, in forcing periods
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    phase: f64,
}

impl NearArgs {
    /// The start, if there is one, and the wanted orbit.
    pub(crate) fn read(
        &self,
        parameters: &Parameters,
    ) -> Result<(Option<Point>, OrbitRequest), Failure> {
        let request = OrbitRequest {
            periods: self.periods,
            struck: None,
            phase: checked_phase(self.phase)?,
        };
        snapload_orbits::period_of(parameters)?;
        let start = self.start.as_deref();
        let start = start.map(|text| start_at(text, parameters)).transpose()?;
        Ok((start, request))
    }

    /// The orbit near the start, or that of the attractor, among those of a family; and how far it
    /// is from the start.
    pub(crate) fn orbit(
        &self,
        family: &Moored,
        at: [f64; 2],
        parameters: &Parameters,
        on_progress: OnProgress,
    ) -> Result<(Orbit, FromStart), Failure> {
        let (given, mut request) = self.read(parameters)?;
        let start = match given {
            Some(start) => Ok(start),
            None => of_attractor(parameters, &request, on_progress)?.map(|orbit| {
                request.periods = Some(orbit.periods);
                orbit.z
            }),
        };
        let orbit = start.and_then(|start| family.orbit(at, &start, &request));
        let orbit = orbit.map_err(|why| Failure::Failed(format!("no orbit was found: {why}")))?;
        let from = FromStart::new(given, &orbit);
        Ok((orbit, from))
    }
}

/// How far an orbit is from the given start, if there was one.
#[derive(Serialize)]
pub(crate) struct FromStart {
    /// The largest difference of the section's state from `--start`.
    start_distance: Option<f64>,
    /// The same where it is so large that another orbit may have been meant.
    #[serde(skip)]
    far: Option<f64>,
}

impl FromStart {
    fn new(start: Option<Point>, orbit: &Orbit) -> Self {
        Self {
            start_distance: start.map(|start| distance(&orbit.z, &start)),
            far: start.and_then(|start| orbit.far_from(&start)),
        }
    }

    /// A line about it, if another orbit may have been meant.
    pub(crate) fn in_words(&self) -> String {
        self.far.map_or(String::new(), |far| {
            format!(
                "Distance  {far:.3} from the start in one coordinate; no nearer orbit was found\n"
            )
        })
    }
}

#[derive(Serialize)]
struct OneAnswer<'a> {
    case: CaseEcho<'a>,
    #[serde(flatten)]
    from_start: FromStart,
    #[serde(flatten)]
    orbit: OrbitRow,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, parameters, entries) = args.case.parameters_as_given()?;
    let (start, mut request) = args.near.read(&parameters)?;
    request.struck = args.symbol.as_deref().map(cables).transpose()?;
    let values = args.vary.as_deref().map(|text| axis("--vary", text));
    let search = Search {
        parameters: &parameters,
        entries: &entries,
        request: &request,
        along: values.transpose()?,
        prove: args.prove,
    };
    let cases = search.cases()?;
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let found = match args.find {
        Some(starts) => search.many(&cases, (starts, args.seed))?,
        None => search.one(&cases[0], start)?,
    };
    outputs.table(table, &parameters, &columns(&found))?;
    let case = CaseEcho(&parameters);
    let text = format!(
        "Case      {}\n{}",
        case_in_words(&name, &parameters),
        in_words(args, &found, start)
    );
    match args.find {
        Some(starts) => outputs.finish(&found.row(case, starts, args.seed), text)?,
        None => {
            let row = OneAnswer {
                case,
                from_start: FromStart::new(start, &found.orbits[0]),
                orbit: OrbitRow::new(&found.orbits[0]),
            };
            outputs.finish(&row, text)?;
        }
    }
    match found.proofs {
        Some(proofs) if args.find.is_none() && proofs.proved == 0 => Err(Failure::ExitStatus(1)),
        _ => Ok(()),
    }
}

/// The most orbits that are listed one by one.
const MOST_LISTED: usize = 12;

fn in_words(args: &Args, found: &FoundOrbits, start: Option<Point>) -> String {
    let mut text = String::new();
    let orbits = &found.orbits;
    if let Some(starts) = args.find {
        let of_each = if args.vary.is_some() {
            " at each value"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "Found     {} {} from {starts} random starts{of_each}",
            orbits.len(),
            if orbits.len() == 1 { "orbit" } else { "orbits" }
        );
        if let Some(Proofs { proved, distinct }) = found.proofs {
            let _ = writeln!(
                text,
                "Proved    {proved} of them, {distinct} of which are certainly different orbits"
            );
        }
    }
    for orbit in orbits.iter().take(MOST_LISTED) {
        text.push_str(&orbit_summary(orbit));
    }
    if let Some(left) = orbits
        .len()
        .checked_sub(MOST_LISTED)
        .filter(|left| *left > 0)
    {
        let _ = writeln!(
            text,
            "More      {left}, which --json FILE or --out FILE writes"
        );
    }
    if let Some(orbit) = orbits.first() {
        text += &FromStart::new(start, orbit).in_words();
    }
    text
}

/// A start from `x=..,y=..`.
fn start_at(text: &str, parameters: &Parameters) -> Result<Point, Failure> {
    let mut z = start_of(parameters);
    for part in text.split(',') {
        let named = part.split_once('=').and_then(|(key, value)| {
            let place = START_KEYS.iter().position(|name| *name == key.trim())?;
            Some((place, key.trim(), value.trim()))
        });
        let Some((place, key, value)) = named else {
            return Err(Failure::BadInput(format!(
                "--start {part:?}: write KEY=VALUE with one of the keys {}, such as --start x=0.1,y=0.2",
                START_KEYS.join(", ")
            )));
        };
        let number = parse_value(value).ok().as_ref().and_then(Value::number);
        let Some(number) = number.filter(|number| number.abs() <= 1e3) else {
            return Err(Failure::BadInput(format!(
                "--start {part:?}: {key} must be a number from -1000 to 1000"
            )));
        };
        if parameters.is_point() && place % 3 == 2 && number != 0.0 {
            return Err(Failure::BadInput(format!(
                "--start {part:?}: a point mass has no rotation; leave {key} out"
            )));
        }
        z[place] = number;
    }
    let illegal = |error: CaseError| Failure::from(error).with_prefix("--start");
    check_start(parameters, &z).map_err(illegal)?;
    Ok(z)
}

/// Cables from `2,1`.
fn cables(text: &str) -> Result<Vec<usize>, Failure> {
    let cable = |part: &str| match part.trim() {
        "1" => Some(0),
        "2" => Some(1),
        _ => None,
    };
    let all: Option<Vec<usize>> = match text.trim() {
        "" | "none" => Some(Vec::new()),
        text => text.split(',').map(cable).collect(),
    };
    all.ok_or_else(|| {
        Failure::BadInput(format!(
            "--symbol {text:?}: write the numbers of the cables that snap, 1 or 2, with commas between them, \
             or none"
        ))
    })
}
