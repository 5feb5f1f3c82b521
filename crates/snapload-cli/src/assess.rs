//! `snapload assess`: one structure in SI units, from its case to a verdict.
use crate::assess_json::report;
use crate::case_input::read_text;
use crate::failure::{Failure, print};
use crate::json::{Json, room_of};
use crate::progress::Progress;
use crate::stage::Stage;
use snapload_structure::{Assessment, Entries, Structure, Water, assess, end_words, note};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

const EXAMPLES: &str = "\
Examples:
  snapload assess docs/examples/cylinder.toml
      do the lines go slack, how hard do they snap, do they break?
  snapload assess cylinder.toml --set wave.height=2.5 --set line.diameter=0.05
      a higher wave, and all lines of thicker chain; --set line.1.length=6.2 changes one line
  snapload assess cylinder.toml --out note.html
      the same as a page for a design note: inputs, assumptions, warnings, plots, snaps, verdict
  snapload assess cylinder.toml --json - | jq .verdict
      everything as JSON, for the next program
  snapload assess --keys
      the keys of a structure's case with units, ranges and defaults

A case file has the tables [body], [[line]], [site], [wave] or [sea], and [run]; all in kg, m, N and s.";

/// Columns of the words beside a label.
const WIDTH: usize = 98;

/// Which structure, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// List the keys of a structure's case and end
    #[arg(long)]
    keys: bool,
    /// Write the note as one self-contained page of HTML
    #[arg(long, value_name = "NOTE.html")]
    out: Option<PathBuf>,
    /// Write the answer as JSON to a file; - is standard output, which then gets nothing else
    #[arg(long, value_name = "FILE|-")]
    json: Option<PathBuf>,
    /// Neighbours of the run, 1e-6 of the wave height away, that show how far it can be trusted
    #[arg(long, value_name = "NUMBER", default_value_t = 40, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    neighbours: u32,
    /// Leave the scan over wave heights and periods out of the page
    #[arg(long)]
    no_scan: bool,
}

/// Which structure.
#[derive(clap::Args)]
pub(crate) struct StructureArgs {
    /// Case file in TOML (keys: snapload assess --keys)
    #[arg(value_name = "CASE.toml")]
    file: Option<PathBuf>,
    /// Change one key after the file, such as wave.height=2 or line.1.length=6; may be repeated
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    set: Vec<String>,
}

impl StructureArgs {
    /// Reads and checks the case; returns it with its name.
    pub(crate) fn read(&self) -> Result<(String, Structure), Failure> {
        let path: &Path = self.file.as_deref().ok_or_else(|| {
            Failure::bad_input(
                "no case file; write snapload assess CASE.toml (docs/examples/cylinder.toml is one to begin with)",
            )
        })?;
        let name = path.display().to_string();
        let mut entries = Entries::parse(&name, &read_text(path)?).map_err(Failure::bad_input)?;
        for text in &self.set {
            entries.set(text).map_err(Failure::bad_input)?;
        }
        let structure = Structure::from_entries(&entries).map_err(Failure::bad_input)?;
        Ok((name, structure))
    }

    /// The command that reads it again.
    pub(crate) fn command(&self, verb: &str) -> String {
        let file = self.file.as_deref().map(|path| path.display().to_string());
        let mut command = format!("snapload {verb} {}", file.unwrap_or_default());
        for set in &self.set {
            let _ = write!(command, " --set '{set}'");
        }
        command
    }
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.keys {
        return print(&keys());
    }
    let (name, structure) = args.input.read()?;
    let mut stage = Stage::default();
    let json = Json::open(&mut stage, args.json.as_deref())?;
    let page = match &args.out {
        None => None,
        Some(path) => Some((room_of(&mut stage, path)?, path.clone())),
    };
    let progress = Mutex::new(Progress::new("running", f64::from(args.neighbours) + 1.0));
    let done = AtomicU64::new(0);
    let watch = || {
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        if let Ok(mut progress) = progress.try_lock() {
            progress.show(count as f64);
        }
    };
    let assessment = assess(structure, args.neighbours, watch)
        .map_err(|e| Failure::BadInput(format!("{name}: {e}")))?;
    drop(progress);
    if let Some((room, path)) = page {
        let scan = if args.no_scan {
            None
        } else {
            scan(&assessment)
        };
        let html = note::page(
            &name,
            &args.input.command("assess"),
            &assessment,
            scan.as_ref(),
        )
        .map_err(|error| Failure::Failed(format!("can not draw the page: {error}")))?;
        stage.write(room, path, |out| out.write_all(html.as_bytes()))?;
    }
    match json.write(stage, &report(&name, &assessment))? {
        Some(written) => print(&summary(&name, &assessment, &written)),
        None => Ok(()),
    }
}

/// The scan over wave heights and periods of the page, under a progress bar.
fn scan(assessment: &Assessment) -> Option<note::Scan> {
    let progress = Mutex::new(Progress::new("scanning", 1.0));
    let watch = |part: f64| {
        if let Ok(mut progress) = progress.try_lock() {
            progress.show(part);
        }
    };
    note::scan(&assessment.prepared.structure, watch)
}

fn summary(name: &str, assessment: &Assessment, written: &[PathBuf]) -> String {
    let prepared = &assessment.prepared;
    let (structure, rest) = (&prepared.structure, &prepared.rest);
    let mut text = String::new();
    let mut row = |label: &str, words: String| text += &told(label, &words);
    let waves = match structure.water {
        Water::Still => "still water".to_owned(),
        Water::Wave(wave) => format!("waves of {} m and {} s", wave.height_m, wave.period_s),
        Water::Sea(sea) => format!(
            "a sea of Hs = {} m, Tp = {} s ({}, seed {})",
            sea.significant_height_m,
            sea.peak_period_s,
            sea.shape.words(),
            sea.seed
        ),
    };
    let [x, z] = rest.place_m;
    row(
        "at rest",
        format!(
            "x = {x:.3} m, z = {z:.3} m, turned by {:.2} degrees; net buoyancy {:.1} kN",
            rest.theta_rad.to_degrees() + 0.0,
            structure.net_buoyancy_n() / 1e3
        ),
    );
    if let ([wave], Some([f_o, nu, omega])) =
        (&prepared.model.waves[..], prepared.model.groups.wave)
    {
        row(
            "water",
            format!(
                "accelerates by up to {:.3} m/s^2 in x, {:.3} in z; force {:.3} and {:.3} of net buoyancy",
                wave.wave.a_x_m_s2,
                wave.wave.a_z_m_s2,
                f_o,
                nu * f_o
            ),
        );
        row(
            "groups",
            format!(
                "f_o = {f_o:.4}, nu = {nu:.4}, Omega = {omega:.4}; L = {:.3} m, T = {:.3} s",
                prepared.model.scales.length_m, prepared.model.scales.time_s
            ),
        );
    }
    let outcome = &assessment.outcome;
    row(
        "run",
        format!(
            "{:.0} s, judged from {:.0} s on; {}",
            outcome.end_s,
            structure.transient_s,
            end_words(outcome.stop)
        ),
    );
    let utilisations = outcome.utilisations(structure);
    for (index, line) in structure.lines.iter().enumerate() {
        let result = &outcome.lines[index];
        let mut words = format!(
            "{:.0} kN at rest, {:.0} kN held, slack {:.1} % of the time, {} snaps",
            rest.tension_n[index] / 1e3,
            result.held_n / 1e3,
            100.0 * result.slack_fraction,
            result.snaps
        );
        if result.snaps > 0 {
            let _ = write!(words, " up to {:.2} m/s", result.speed_m_s);
        }
        if result.jolts > 0 {
            let _ = write!(words, ", {} jolts while taut", result.jolts);
        }
        if let Some(peak) = result.peak_n {
            let _ = write!(words, ", about {:.0} kN", peak / 1e3);
        }
        if let Some(load) = line.breaking_load_n {
            let _ = write!(words, "; breaks at {:.0} kN", load / 1e3);
        }
        if let Some(utilisation) = utilisations[index] {
            let _ = write!(words, ", utilisation {utilisation:.2}");
        }
        row(&format!("line {}", index + 1), words);
    }
    for warning in &assessment.warnings {
        row("warning", format!("{}: {}", warning.rule, warning.message));
    }
    row("trust", assessment.trust_words());
    row("verdict", assessment.verdict().words);
    for path in written {
        row("written", path.display().to_string());
    }
    format!(
        "{name}: {} lines, {waves}, {} m deep\n{text}",
        structure.lines.len(),
        structure.site.depth_m
    )
}

/// A label and its words, broken to a width that reads well.
pub(crate) fn told(label: &str, words: &str) -> String {
    let mut text = format!("  {label:<10}");
    let mut column = 0;
    for word in words.split(' ') {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > WIDTH {
            text.push_str("\n            ");
            column = 0;
        }
        if column > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += width;
    }
    text.push('\n');
    text
}

/// The keys, a table of the case file each.
fn keys() -> String {
    let mut text = String::new();
    for table in snapload_structure::TABLES {
        let header = if table.many {
            format!("[[{}]]", table.name)
        } else {
            format!("[{}]", table.name)
        };
        let _ = writeln!(text, "{header}  {}", table.meaning);
        for key in table.keys {
            let _ = writeln!(text, "  {:<17}{}", key.name, key.meaning);
            let _ = writeln!(
                text,
                "  {:<17}allowed: {}; default: {}",
                "",
                key.allowed(),
                key.default_words()
            );
        }
        text.push('\n');
    }
    text
}
