//! `snapload basin` and `snapload erosion`: which starts stay below the limits.
use crate::bar::Bar;
use crate::basin_picture::{
    attraction_layers, basin_layers, erosion_layers, measure_label, numeric,
};
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::orbit_picture::{PlotArgs, PlotFile};
use crate::outputs::{Outputs, TABLE};
use crate::table::{axis, names, numbers};
use serde::Serialize;
use snapload::analysis::Progress;
use snapload::{CaseError, Parameters};
use snapload_orbits::{
    AttractedCell, Attraction, AttractionRow, BASIN_TRANSIENT, Basin, BasinRow, CellOutcome,
    Erosion, ErosionRow, Window, attraction_summary, basin_summary, erosion_summary,
};
use snapload_report::{CaseEcho, case_in_words, case_without};
use snapload_study::Values;
use std::path::PathBuf;

const EXAMPLES: &str = "\
A start is safe if its run reaches no limit of the motion, such as the rotation limit or the upper bound, up to
t_end. A run that settles is safe. Starts beyond the length of a cable or beyond a limit are not legal and are
left out of the window. A cell is decided if its neighbours at a distance of 1e-8 end alike; where rounding may
decide its run, nearer neighbours must end alike, too. A picture hatches the cells that are not decided.

Examples:
  snapload basin --set t_end=60 --vary x=-0.4:0.4:41 --vary y=0.02:0.72:36 --out basin.parquet \\
      --plot basin.svg
      starts at rest, with the standard body, and a map of them
  snapload basin --set t_end=60 --vary f_o=0.02:0.6:30 --vary omega=0.4:2.4:41 --json -
      a window of any two keys
  snapload erosion --set t_end=60 --vary x=-0.4:0.4:33 --vary y=0.02:0.72:29 --over f_o=0:0.6:21 \\
      --plot erosion.svg
      how the safe part shrinks as the force grows";

/// Forcing periods that are skipped before attractors are identified, unless another number is
/// given.
const TRANSIENT: u64 = 300;

/// Which case, and which window.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    window: WindowArgs,
    /// What to compute for each cell: whether it is safe, or which attractor its motion reaches
    #[arg(long, default_value = "safe", value_parser = ["safe", "attractor"])]
    kind: String,
    #[arg(long, value_name = "N", value_parser = whole_number::<u64>(BASIN_TRANSIENT))]
    #[arg(help = format!("Forcing periods to skip before attractors are identified [default: {TRANSIENT}]"))]
    transient: Option<u64>,
    /// Write a table with one row per cell, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw the window as a map
    #[arg(long, value_name = "FILE.svg|png")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
}

/// Which case, which window, and which values of a third key.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ErosionArgs {
    #[command(flatten)]
    window: WindowArgs,
    /// The third key and its values first:last:n
    #[arg(long, value_name = "KEY=first:last:n", allow_hyphen_values = true)]
    over: String,
    /// Write a table with one row per value, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    json: JsonArgs,
}

#[derive(clap::Args)]
struct WindowArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// One of the two keys of the window and its values; give this option twice
    #[arg(
        long,
        value_name = "KEY=first:last:n",
        allow_hyphen_values = true,
        required = true
    )]
    vary: Vec<String>,
    /// Do not compute which cells are decided, which takes most of the time
    #[arg(long)]
    no_trust: bool,
}

impl WindowArgs {
    fn read(&self) -> Result<(String, Parameters, Window), Failure> {
        let (name, base) = self.case.parameters()?;
        let [first, second] = &self.vary[..] else {
            return Err(Failure::BadInput(format!(
                "--vary: {} given; a window has two keys, such as --vary x=-0.4:0.4:41 --vary y=0.02:0.72:36",
                self.vary.len()
            )));
        };
        let ((a, rows), (b, columns)) = (axis("--vary", first)?, axis("--vary", second)?);
        let window = Window {
            base,
            keys: [a, b],
            values: [rows, columns],
        };
        window.check()?;
        Ok((name, base, window))
    }
}

#[derive(Serialize)]
struct Answer<'a, T> {
    case: CaseEcho<'a>,
    #[serde(flatten)]
    found: T,
}

/// Runs a window.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, base, window) = args.window.read()?;
    if let (Some(transient), "safe") = (args.transient, args.kind.as_str()) {
        let allowed = "--transient only with --kind attractor: a safe basin follows each start from its beginning";
        return Err(CaseError::value("--transient", transient, allowed).into());
    }
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let plot = PlotFile::open(&mut outputs, args.plot.as_deref(), window.keys)?;
    let title = case_without(&window.keys, &name, &base);
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    if args.kind == "attractor" {
        let transient = args.transient.unwrap_or(TRANSIENT);
        let found = Attraction::of(window, transient, !args.window.no_trust, &on_progress)?;
        drop(bar);
        outputs.table(table, &base, &outcome_columns(&found))?;
        if let Some(plot) = plot {
            plot.add_to(&mut outputs, &title, attraction_layers(&found))?;
        }
        let row = Answer {
            case: CaseEcho(&base),
            found: AttractionRow::new(&found),
        };
        return outputs.finish(&row, about(&name, &base, &attraction_summary(&found)));
    }
    let basin = Basin::of(window, !args.window.no_trust, &on_progress)?;
    drop(bar);
    outputs.table(table, &base, &cells(&basin))?;
    if let Some(plot) = plot {
        plot.add_to(&mut outputs, &title, basin_layers(&basin))?;
    }
    let row = Answer {
        case: CaseEcho(&base),
        found: BasinRow::new(&basin),
    };
    outputs.finish(&row, about(&name, &base, &basin_summary(&basin)))
}

/// Runs it for the values of a third key.
pub(crate) fn run_erosion(args: &ErosionArgs) -> Result<(), Failure> {
    let (name, base, window) = args.window.read()?;
    let (key, values) = axis("--over", &args.over)?;
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let none_yet = Erosion {
        key,
        points: Vec::new(),
    };
    let known = numeric(&points(&none_yet));
    let plot = args.plot.open(&mut outputs, [key, "gim"], &known)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let erosion = Erosion::of(&window, key, &values, !args.window.no_trust, &on_progress)?;
    drop(bar);
    let rows = points(&erosion);
    outputs.table(table, &base, &rows)?;
    if let Some(mut plot) = plot {
        plot.spans(key, &values);
        plot.upwards = measure_label(&plot.axes[1], window.keys);
        let layers = erosion_layers(&erosion, &rows, plot.axes());
        let [x, y] = window.keys;
        let title = case_without(&[x, y, key], &name, &base);
        plot.add_to(&mut outputs, &title, layers)?;
    }
    let row = Answer {
        case: CaseEcho(&base),
        found: ErosionRow::new(&erosion),
    };
    outputs.finish(&row, about(&name, &base, &erosion_summary(&erosion)))
}

fn about(name: &str, base: &Parameters, words: &str) -> String {
    format!("Case      {}\n{words}", case_in_words(name, base))
}

fn cells(basin: &Basin) -> Vec<(&'static str, Values)> {
    let window = &basin.window;
    let count = window.count();
    let key = |axis: usize| numbers((0..count).map(|k| window.at(k)[axis]));
    let cells = || basin.cells.iter();
    let flags = |flag: fn(&snapload_orbits::Cell) -> bool| {
        let of = |cell: &snapload_orbits::Cell| {
            (basin.neighbours_run && cell.end.is_some()).then(|| flag(cell))
        };
        Values::Flags(cells().map(of).collect())
    };
    vec![
        (window.keys[0], key(0)),
        (window.keys[1], key(1)),
        (
            "outcome",
            names(cells().map(|cell| cell.end.map(|(stop, _)| stop.name()))),
        ),
        (
            "t",
            Values::Numbers(cells().map(|cell| cell.end.map(|(_, t)| t)).collect()),
        ),
        ("decided", flags(|cell| cell.decided)),
        ("trusted", flags(|cell| cell.trusted)),
    ]
}

fn points(erosion: &Erosion) -> Vec<(&'static str, Values)> {
    let basins = || erosion.points.iter().map(|(_, basin)| &basin.measures);
    let number = |of: fn(&snapload_orbits::Measures) -> f64| numbers(basins().map(of));
    let maybe = |of: fn(&snapload_orbits::Measures) -> Option<f64>| {
        Values::Numbers(basins().map(of).collect())
    };
    let counts = |of: &dyn Fn(&Basin) -> Option<usize>| {
        let all = erosion.points.iter().map(|(_, basin)| of(basin));
        Values::Counts(all.map(|count| count.map(|count| count as i64)).collect())
    };
    let count =
        |of: fn(&snapload_orbits::Measures) -> usize| counts(&|basin| Some(of(&basin.measures)));
    vec![
        (
            erosion.key,
            numbers(erosion.points.iter().map(|(value, _)| *value)),
        ),
        ("legal", count(|m| m.legal)),
        ("safe", count(|m| m.safe)),
        (
            "undecided",
            counts(&|basin| basin.neighbours_run.then_some(basin.measures.undecided)),
        ),
        ("cut_short", count(|m| m.cut_short)),
        ("gim", number(|m| m.gim)),
        ("low", number(|m| m.interval[0])),
        ("high", number(|m| m.interval[1])),
        ("decided_fraction", maybe(|m| m.decided_part())),
        ("lim", maybe(|m| m.lim)),
        ("if", maybe(|m| m.integrity_factor)),
        (
            "iim",
            Values::Numbers(erosion.points.iter().map(|(_, b)| b.iim()).collect()),
        ),
    ]
}

fn outcome_columns(found: &Attraction) -> Vec<(&'static str, Values)> {
    let window = &found.window;
    let key = |axis: usize| numbers((0..window.count()).map(|k| window.at(k)[axis]));
    let outcome = |outcome: &CellOutcome| match outcome {
        CellOutcome::Illegal => None,
        CellOutcome::Stopped(stop, _) => Some(stop.name()),
        CellOutcome::Attracted(_) => Some("attracted"),
        CellOutcome::Aperiodic => Some("aperiodic"),
    };
    let time = |outcome: &CellOutcome| match outcome {
        CellOutcome::Stopped(_, t) => Some(*t),
        _ => None,
    };
    let outcomes = || found.cells.iter().map(|cell| &cell.outcome);
    let flags = |flag: fn(&AttractedCell) -> bool| {
        let of = |cell: &AttractedCell| {
            let is_known = found.neighbours_run && cell.outcome != CellOutcome::Illegal;
            is_known.then(|| flag(cell))
        };
        Values::Flags(found.cells.iter().map(of).collect())
    };
    let number = |outcome: &CellOutcome| match outcome {
        CellOutcome::Attracted(k) => Some(*k as i64 + 1),
        _ => None,
    };
    vec![
        (window.keys[0], key(0)),
        (window.keys[1], key(1)),
        ("outcome", names(outcomes().map(outcome))),
        ("t", Values::Numbers(outcomes().map(time).collect())),
        (
            "attractor",
            Values::Counts(outcomes().map(number).collect()),
        ),
        ("decided", flags(|cell| cell.decided)),
        ("trusted", flags(|cell| cell.trusted)),
    ]
}
