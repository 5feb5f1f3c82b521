//! `snapload elastic`: one structure on lines that stretch, beside the same on lines that do not.
use crate::bar::Bar;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::structure_input::{Answers, ReadStructure, StructureArgs, ending};
use snapload::analysis::{Progress, Unfinished};
use snapload_structure::{BothModels, Prepared, both_models};
use std::io;
use std::path::PathBuf;

const EXAMPLES: &str = include_str!("../help/elastic.txt").trim_ascii_end();

/// Which structure, how stiff, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// Take the lines this many times as stiff as they are
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = times)]
    stiffer: f64,
    /// Write the motion as CSV: time, place, rotation and the tension of each line
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Time between two rows of the CSV, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds)]
    every: f64,
    #[command(flatten)]
    json: JsonArgs,
}

/// The most rows of the CSV.
const MOST_ROWS: f64 = 1e7;

fn times(text: &str) -> Result<f64, String> {
    within(text, 1e-6, 1e9)
}

fn seconds(text: &str) -> Result<f64, String> {
    within(text, 1e-6, 1e6)
}

fn within(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    number
        .filter(|number| (low..=high).contains(number))
        .ok_or_else(|| format!("allowed: a number from {low:e} to {high:e}"))
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let ReadStructure {
        name, structure, ..
    } = args.input.read()?;
    if let Some(path) = &args.out {
        ending(path, &["csv"])?;
    }
    let rows = structure.duration_s / args.every;
    if args.out.is_some() && rows > MOST_ROWS {
        let message = format!(
            "--every {}: {rows:.1e} rows; allowed are at most {MOST_ROWS:e}, every {:e} s or less often",
            args.every,
            structure.duration_s / MOST_ROWS
        );
        return Err(Failure::BadInput(message));
    }
    let mut answers = Answers::open(&args.json, args.out.as_deref())?;
    let every_s = args.out.as_ref().map_or(f64::INFINITY, |_| args.every);
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let both = Prepared::for_springs(structure)
        .map_err(Unfinished::from)
        .and_then(|prepared| both_models(prepared, args.stiffer, every_s, &on_progress))
        .map_err(|error| Failure::from(error).with_prefix(&name))?;
    drop(bar);
    answers.write(|out| table(&both, out))?;
    answers.finish(&both.to_json(&name), both.summary(&name))
}

/// One row for each time.
fn table(both: &BothModels, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let lines = both.springs.len();
    let tensions = (1..=lines).map(|line| format!("tension_{line}_n"));
    let names = ["t_s", "x_m", "z_m", "theta_rad"].map(str::to_owned);
    table.write_record(names.into_iter().chain(tensions))?;
    for look in &both.elastic.looks {
        let state = &look.state;
        let [x, z] = both.sprung.model.scales.to_si([state.x, state.y]);
        let place = [look.t_s, x, z, 0.0 - state.theta];
        let row = place.iter().chain(&look.tension_n);
        table.write_record(row.map(f64::to_string))?;
    }
    table.flush()
}
