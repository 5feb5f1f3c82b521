//! `snapload section`: a long motion, once a period of the forcing.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::{Failure, print};
use crate::json::JsonArgs;
use crate::stage::Stage;
use crate::table::{TableFile, numbers};
use serde::Serialize;
use snapload::analysis::{Progress, START_KEYS};
use snapload_orbits::{Section, SectionRow, Stretch, section_in_words};
use snapload_report::{CaseEcho, case_in_words};
use snapload_study::Values;
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The state at t = (phase + k) T, T the period of the forcing, once the transient is over; with it the period of
the motion, if it has one, and its Lyapunov exponents with their standard errors. The stops by settling are off.

Examples:
  snapload section --set body=point --set r=1.976 --set e=0.71 --set nu=0.87 --set omega=4.847 --set f_o=1.6
      a point mass whose motion never repeats itself
  snapload section --set f_o=0.1 --periods 200 --keep 50 --out points.csv
      a table of the last 50 points";

/// Which case, and how long.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    stretch: StretchArgs,
    /// Write the points as a table, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

/// How long a motion is followed.
#[derive(clap::Args)]
pub(crate) struct StretchArgs {
    /// Periods of the forcing in all
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    periods: u64,
    /// Periods that are kept, the last ones
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    keep: u64,
    /// Time of the section, in periods of the forcing
    #[arg(
        long,
        value_name = "P",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    phase: f64,
}

impl StretchArgs {
    /// Checks it.
    pub(crate) fn read(&self) -> Result<Stretch, Failure> {
        let Some(skip) = self.periods.checked_sub(self.keep) else {
            return Err(Failure::BadInput(format!(
                "--keep {}: more than there are in all; write at most --periods {}",
                self.keep, self.periods
            )));
        };
        Ok(Stretch {
            phase: crate::orbit::phase(self.phase)?,
            skip,
            keep: self.keep,
            exponents: true,
        })
    }
}

#[derive(Serialize)]
struct Answer<'a> {
    case: CaseEcho<'a>,
    #[serde(flatten)]
    section: SectionRow,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let input = args.case.read()?;
    let stretch = args.stretch.read()?;
    let parameters = input.case.parameters();
    let mut stage = Stage::default();
    let table = TableFile::open(&mut stage, args.out.as_deref())?;
    let json = args.json.open(&mut stage)?;
    let bar = Bar::new();
    let section = Section::of(parameters, &stretch, &|progress: Progress| {
        bar.show(progress)
    })?;
    drop(bar);
    table.stage(&mut stage, &columns(&section))?;
    let row = Answer {
        case: CaseEcho(parameters),
        section: SectionRow::new(&section, stretch.phase),
    };
    let Some(written) = json.write(stage, &row)? else {
        return Ok(());
    };
    let mut text = format!("Case      {}\n", case_in_words(&input.name, parameters));
    text.push_str(&section_in_words(&section));
    for path in written {
        let _ = writeln!(text, "Written   {}", path.display());
    }
    print(&text)
}

fn columns(section: &Section) -> Vec<(&'static str, Values)> {
    let count = section.points.len() as i64;
    let ks = (0..count).map(|k| Some(k + section.first as i64)).collect();
    let mut columns = vec![("k", Values::Counts(ks))];
    for (i, name) in START_KEYS.into_iter().enumerate() {
        columns.push((name, numbers(section.points.iter().map(|point| point[i]))));
    }
    columns
}
