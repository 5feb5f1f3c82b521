//! `snapload elastic`: one structure on elastic lines, beside the same on inextensible lines.
use crate::bar::Bar;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::{number, whole_number};
use crate::outputs::Outputs;
use crate::structure_input::{ReadStructure, StructureArgs};
use snapload::CaseError;
use snapload::analysis::{Progress, Unfinished};
use snapload_structure::{
    DEFAULT_ELASTIC_NEIGHBOURS, EVERY, ElasticComparison, ModelAtRest, NEIGHBOURS, STIFFER,
    checked_every, compare_elastic,
};
use snapload_study::in_digits_with_fraction;
use std::io;
use std::path::PathBuf;

const EXAMPLES: &str = include_str!("../help/elastic.txt").trim_ascii_end();

/// Which structure, how stiff, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// Factor by which the stiffness of all lines is multiplied
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = number(STIFFER))]
    stiffer: f64,
    /// Number of neighbours of the motion on elastic lines, 1e-6 of the wave height away, that
    /// show how far it can be trusted; each takes as long as the motion itself
    #[arg(long, value_name = "NUMBER", default_value_t = DEFAULT_ELASTIC_NEIGHBOURS, value_parser = whole_number::<u32>(NEIGHBOURS))]
    neighbours: u32,
    /// Write the motion as CSV: time, position, rotation and the tension of each line
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Time between two rows of the CSV file, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = number(EVERY))]
    every: f64,
    #[command(flatten)]
    json: JsonArgs,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let ReadStructure {
        name, structure, ..
    } = args.input.read()?;
    let every_s = match &args.out {
        Some(_) => checked_every(structure.duration_s, args.every).map_err(as_option)?,
        None => f64::INFINITY,
    };
    let mut outputs = Outputs::open(&args.json)?;
    let out = outputs.file("--out", args.out.as_deref(), &["csv"])?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let comparison = ModelAtRest::for_elastic_lines(structure)
        .map_err(Unfinished::from)
        .and_then(|prepared| compare_elastic(prepared, args.stiffer, every_s, &on_progress))
        .and_then(|alone| alone.with_neighbours(args.neighbours, &on_progress))
        .map_err(|error| Failure::from(error).with_prefix(&name))?;
    drop(bar);
    if let Some(out) = out {
        outputs.write(out, |out| table(&comparison, out))?;
    }
    outputs.finish_with_text(&comparison.to_json(&name), comparison.summary(&name))
}

/// An error that names an option, with the option as it is written on a command line.
fn as_option(mut error: CaseError) -> CaseError {
    error.key = format!("--{}", error.key);
    error
}

/// A row a sample.
fn table(comparison: &ElasticComparison, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let lines = comparison.elastic_lines.len();
    let tensions = (1..=lines).map(|line| format!("tension_{line}_n"));
    let names = ["t_s", "x_m", "z_m", "theta_rad"].map(str::to_owned);
    table.write_record(names.into_iter().chain(tensions))?;
    for sample in &comparison.elastic.samples {
        let state = &sample.state;
        let [x, z] = comparison
            .elastic_case
            .model
            .scales
            .to_si([state.x, state.y]);
        let place = [sample.t_s, x, z, 0.0 - state.theta];
        let row = place.iter().chain(&sample.tension_n);
        table.write_record(row.copied().map(in_digits_with_fraction))?;
    }
    table.flush()
}
