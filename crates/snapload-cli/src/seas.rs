//! `snapload seas`: many records of one irregular sea, as distributions.
use crate::assess::{StructureArgs, told};
use crate::failure::{Failure, print};
use crate::json::{Json, room_of};
use crate::progress::Counter;
use crate::stage::Stage;
use serde_json::{Value, json};
use snapload_structure::{
    Estimate, Gumbel, SeaOutcome, Seas, Water, end_words, note, quantile, seas,
};
use std::io;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  snapload seas docs/examples/cylinder-sea.toml --seeds 50
      fifty three-hour records: how hard do the lines snap, and how sure is that?
  snapload seas cylinder-sea.toml --seeds 50 --out seas.html
      the same as a page, with the distributions as plots
  snapload seas cylinder-sea.toml --seeds 200 --set run.duration=1800 --out seas.csv
      half-hour records, a row each
  snapload seas cylinder-sea.toml --set sea.hs=1.5 --json - | jq .probability

The records have the seed of the case and those that follow it, so the same command gives the same numbers.";

/// Which sea, how often, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// How many records are run
    #[arg(long, value_name = "NUMBER", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    seeds: u32,
    /// Write the answer as a page of HTML, or a row a record as CSV, by the name's ending
    #[arg(long, value_name = "FILE.html|FILE.csv")]
    out: Option<PathBuf>,
    /// Write the answer as JSON to a file; - is standard output, which then gets nothing else
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, structure) = args.input.read()?;
    let mut stage = Stage::default();
    let json = Json::open(&mut stage, args.json.as_deref())?;
    let out = match &args.out {
        None => None,
        Some(path) => {
            let ending = path.extension().and_then(|ending| ending.to_str());
            if !matches!(ending, Some("html" | "csv")) {
                return Err(Failure::BadInput(format!(
                    "--out {}: allowed is a name that ends in .html or .csv",
                    path.display()
                )));
            }
            let room = room_of(&mut stage, path)?;
            Some((room, path.clone(), ending == Some("csv")))
        }
    };
    let counter = Counter::new("records", u64::from(args.seeds), 0);
    let result = seas(structure, args.seeds, || counter.one())
        .map_err(|e| Failure::BadInput(format!("{name}: {e}")))?;
    drop(counter);
    if let Some((room, path, as_csv)) = out {
        if as_csv {
            stage.write(room, path, |out| table(&result, out))?;
        } else {
            let html = note::seas_page(&name, &command(args), &result)
                .map_err(|error| Failure::Failed(format!("can not draw the page: {error}")))?;
            stage.write(room, path, |out| out.write_all(html.as_bytes()))?;
        }
    }
    match json.write(stage, &report(&name, &result))? {
        Some(written) => print(&summary(&name, &result, &written)),
        None => Ok(()),
    }
}

fn command(args: &Args) -> String {
    format!("{} --seeds {}", args.input.command("seas"), args.seeds)
}

/// A row a record.
fn table(seas: &Seas, out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "seed",
        "end_s",
        "end",
        "snaps",
        "fastest_snap_m_s",
        "peak_tension_n",
        "slack_fraction",
    ])?;
    for SeaOutcome { seed, outcome } in &seas.records {
        let snaps: u64 = outcome.lines.iter().map(|line| line.snaps).sum();
        let slack = outcome
            .lines
            .iter()
            .fold(0.0_f64, |slack, line| slack.max(line.slack_fraction));
        table.write_record([
            seed.to_string(),
            outcome.end_s.to_string(),
            end_words(outcome.stop).to_owned(),
            snaps.to_string(),
            outcome.speed_m_s().to_string(),
            outcome
                .peak_n()
                .map_or(String::new(), |peak| peak.to_string()),
            slack.to_string(),
        ])?;
    }
    table.flush()
}

fn report(name: &str, seas: &Seas) -> Value {
    let estimate = |e: Estimate| json!({ "value": e.value, "standard_error": e.error });
    let gumbel = |fit: Option<Gumbel>| {
        fit.map(|fit| json!({
            "location": fit.location + fit.scale * fit.log_times, "scale": fit.scale, "records": fit.count,
            "mean": estimate(fit.mean()), "median": estimate(fit.quantile(0.5)), "quantile_90": estimate(fit.quantile(0.9)),
        }))
    };
    json!({
        "case": name,
        "records": seas.records.len(),
        "words": seas.words(),
        "peak_tension_in_three_hours_n": gumbel(seas.peak_in_three_hours()),
        "fastest_snap_in_three_hours_m_s": gumbel(seas.speed_in_three_hours()),
        "probability": seas.failing().map(|share| json!({
            "failing": share.count, "of": share.of, "part": share.part(), "interval_95": share.interval(),
        })),
        "snaps_in_three_hours": seas.snaps_in_three_hours(),
        "slack_fraction": (0..seas.prepared.structure.lines.len()).map(|line| seas.slack_fraction(line)).collect::<Vec<_>>(),
        "peaks_n": seas.peaks_n(),
        "fastest_m_s": seas.speeds_m_s(),
    })
}

fn summary(name: &str, seas: &Seas, written: &[PathBuf]) -> String {
    let structure = &seas.prepared.structure;
    let mut text = String::new();
    let mut row = |label: &str, words: String| text += &told(label, &words);
    for line in 0..structure.lines.len() {
        row(
            &format!("line {}", line + 1),
            format!(
                "slack {:.2} % of the time",
                100.0 * seas.slack_fraction(line)
            ),
        );
    }
    let speeds = seas.all_speeds_m_s();
    let part = |p: f64| quantile(&speeds, p).unwrap_or(0.0);
    row(
        "snaps",
        format!(
            "{:.0} of 1 cm/s or more in three hours; half of them below {:.3} m/s, 99 % below {:.2}, the fastest {:.2}",
            seas.snaps_in_three_hours(),
            part(0.5),
            part(0.99),
            part(1.0)
        ),
    );
    if let Some(fit) = seas.speed_in_three_hours() {
        let (mean, high) = (fit.mean(), fit.quantile(0.9));
        row(
            "fastest",
            format!(
                "in three hours {:.2} +- {:.2} m/s expected, below {:.2} +- {:.2} in 90 % (Gumbel, L-moments)",
                mean.value, mean.error, high.value, high.error
            ),
        );
    }
    row("verdict", seas.words());
    for path in written {
        row("written", path.display().to_string());
    }
    let sea = match structure.water {
        Water::Sea(sea) => format!(
            "Hs = {} m, Tp = {} s, {}",
            sea.significant_height_m,
            sea.peak_period_s,
            sea.shape.words()
        ),
        Water::Still | Water::Wave(_) => String::new(),
    };
    format!(
        "{name}: {} records of {:.0} s, {sea}\n{text}",
        seas.records.len(),
        structure.duration_s
    )
}
