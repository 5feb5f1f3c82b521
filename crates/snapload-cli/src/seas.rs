//! `snapload seas`: many records of one irregular sea, as distributions.
use crate::bar::Bar;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::outputs::Outputs;
use crate::structure_input::{ReadStructure, StructureArgs};
use snapload_structure::note::{self, Source};
use snapload_structure::{Lines, SEEDS, SeaOutcome, Seas, end_text, seas};
use snapload_study::in_digits_with_fraction;
use std::io;
use std::path::PathBuf;

const EXAMPLES: &str = include_str!("../help/seas.txt").trim_ascii_end();

/// Which sea, how often, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// Number of records to run
    #[arg(long, value_name = "NUMBER", default_value_t = 20, value_parser = whole_number::<u32>(SEEDS))]
    seeds: u32,
    /// Model the lines as springs, which is slower; needed if they are too soft for instant snaps
    #[arg(long)]
    elastic: bool,
    /// Write the results as an HTML page, or as CSV with one row per record, whose slack_fraction
    /// is the largest of its lines; the file extension decides
    #[arg(long, value_name = "FILE.html|FILE.csv")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let ReadStructure {
        name,
        structure,
        sha256,
    } = args.input.read()?;
    let mut outputs = Outputs::open(&args.json)?;
    let out = outputs.file("--out", args.out.as_deref(), &["html", "csv"])?;
    let bar = Bar::counting();
    let lines = match args.elastic {
        true => Lines::Elastic,
        false => Lines::Inextensible,
    };
    let result = seas(structure, args.seeds, lines, &|progress| bar.show(progress))
        .map_err(|error| Failure::from(error).with_prefix(&name))?;
    drop(bar);
    match out {
        None => {}
        Some(out) if out.ending == "csv" => outputs.write(out, |out| table(&result, out))?,
        Some(out) => {
            let elastic = if args.elastic { " --elastic" } else { "" };
            let verb = args.input.command("seas");
            let command = format!("{verb} --seeds {}{elastic}", args.seeds);
            let source = Source {
                name: &name,
                command: &command,
                sha256: Some(&sha256),
            };
            let page = note::seas_page(source, &result)
                .map_err(|error| Failure::Failed(format!("can not draw the page: {error}")))?;
            outputs.write(out, |out| out.write_all(page.as_bytes()))?;
        }
    }
    outputs.finish_with_text(&result.to_json(&name), result.summary(&name))
}

/// One row for each record.
fn table(seas: &Seas, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "seed",
        "end_s",
        "end",
        "snaps",
        "fastest_snap_m_s",
        "peak_tension_n",
        "largest_tension_n",
        "least_tension_n",
        "slack_fraction",
    ])?;
    for SeaOutcome { seed, outcome, .. } in &seas.records {
        let slack = outcome.lines.iter().map(|line| line.slack_fraction);
        let least = outcome.lines.iter().filter_map(|line| line.least_n);
        let least = least.reduce(f64::min);
        let text = |value: Option<f64>| value.map(in_digits_with_fraction).unwrap_or_default();
        // Of a record that ends before anything is judged there is nothing to tell.
        let judged = |text: String| match outcome.is_unjudged() {
            true => String::new(),
            false => text,
        };
        table.write_record([
            seed.to_string(),
            in_digits_with_fraction(outcome.end_s),
            end_text(outcome.stop).to_owned(),
            judged(outcome.snaps().to_string()),
            judged(in_digits_with_fraction(outcome.speed_m_s())),
            text(outcome.known_peak_n()),
            text(outcome.known_largest_n()),
            text(least),
            judged(in_digits_with_fraction(slack.fold(0.0, f64::max))),
        ])?;
    }
    table.flush()
}
