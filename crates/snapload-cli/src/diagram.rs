//! `snapload diagram`: the attractor along a key.
use crate::bar::Bar;
use crate::basin_picture::{diagram_layers, numeric};
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::orbit_picture::PlotArgs;
use crate::outputs::{Outputs, TABLE};
use crate::section::SectionArgs;
use crate::table::{axis, names};
use serde::Serialize;
use snapload::analysis::{Progress, START_KEYS};
use snapload_orbits::{DiagramPoint, DiagramRow, Point, diagram, diagram_summary};
use snapload_report::{CaseEcho, case_in_words, case_without};
use snapload_study::Values;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The motion at each value starts from the final state at the previous value, so that one attractor is followed. If
a motion stops at a limit, or its final state is not legal at the next value, the next value starts from the start
of the case again, and `restarted` says so.

Examples:
  snapload diagram --set body=point --set r=1.976 --set e=0.71 --set nu=0.87 --set omega=4.847 \\
      --vary f_o=1.5:2.1:61 --out up.parquet --plot up.svg
  snapload diagram --set body=point --set r=1.976 --set e=0.71 --set nu=0.87 --set omega=4.847 \\
      --vary f_o=1.5:2.1:61 --down --out down.parquet
      from the largest value down, which may find another attractor";

/// Which case, which values, and how long.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Key to vary and its values first:last:n
    #[arg(long, value_name = "KEY=first:last:n", allow_hyphen_values = true)]
    vary: String,
    /// Go from the last value to the first
    #[arg(long)]
    down: bool,
    #[command(flatten)]
    options: SectionArgs,
    /// Write a table of all section points, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    json: JsonArgs,
}

#[derive(Serialize)]
struct Answer<'a> {
    case: CaseEcho<'a>,
    vary: &'static str,
    down: bool,
    phase: f64,
    periods: u64,
    keep: u64,
    rows: Vec<DiagramRow>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, parameters) = args.case.parameters()?;
    let (key, mut values) = axis("--vary", &args.vary)?;
    if args.down {
        values.reverse();
    }
    let options = args.options.read()?;
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let known = numeric(&columns(key, &[]));
    let plot = args.plot.open(&mut outputs, [key, "x"], &known)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let found = diagram(&parameters, key, &values, &options, &on_progress)?;
    drop(bar);
    let rows = columns(key, &found);
    outputs.table(table, &parameters, &rows)?;
    if let Some(mut plot) = plot {
        plot.spans(key, &values);
        let layers = diagram_layers(&found, &rows, plot.axes());
        let mut title = case_without(&[key], &name, &parameters);
        title += &followed(key, &values, args.down, plot.axes());
        plot.add_to(&mut outputs, &title, layers)?;
    }
    let row = Answer {
        case: CaseEcho(&parameters),
        vary: key,
        down: args.down,
        phase: options.phase,
        periods: options.skip + options.keep,
        keep: options.keep,
        rows: found.iter().map(DiagramRow::new).collect(),
    };
    let mut text = format!("Case      {}\n", case_in_words(&name, &parameters));
    text.push_str(&diagram_summary(key, &found));
    outputs.finish(&row, text)
}

/// What the axes of a picture do not show of the values that were followed.
fn followed(key: &str, values: &[f64], down: bool, axes: [&str; 2]) -> String {
    match (values, axes.contains(&key)) {
        ([first, .., last], false) => format!(", {key} from {first} to {last}"),
        (_, true) if down => ", downwards".to_owned(),
        _ => String::new(),
    }
}

/// A point of a diagram: the value that it belongs to, its index, its time, and its state; a value
/// at which the motion stopped before the first point has one row without them.
type Row<'a> = (&'a DiagramPoint, Option<(u64, f64, &'a Point)>);

fn rows(found: &[DiagramPoint]) -> impl Iterator<Item = Row<'_>> {
    found.iter().flat_map(|at| {
        let points = at
            .section
            .points_with_times()
            .map(move |point| (at, Some(point)));
        points.chain(at.section.points.is_empty().then_some((at, None)))
    })
}

fn columns(key: &'static str, found: &[DiagramPoint]) -> Vec<(&'static str, Values)> {
    let rows = || rows(found);
    let by_value = |of: &dyn Fn(&DiagramPoint) -> Option<f64>| {
        Values::Numbers(rows().map(|(at, _)| of(at)).collect())
    };
    let exponent = |place: usize| {
        move |at: &DiagramPoint| {
            let known = at.section.exponents.first().filter(|_| at.stop().is_none());
            known.map(|both| both[place])
        }
    };
    let k = rows().map(|(_, point)| point.map(|(k, ..)| k as i64));
    let t = rows().map(|(_, point)| point.map(|(_, t, _)| t));
    let mut columns = vec![
        (key, by_value(&|at| Some(at.value))),
        ("k", Values::Counts(k.collect())),
        ("t", Values::Numbers(t.collect())),
    ];
    for (i, name) in START_KEYS.into_iter().enumerate() {
        let state = rows().map(|(_, point)| point.map(|(.., state)| state[i]));
        columns.push((name, Values::Numbers(state.collect())));
    }
    let period = rows().map(|(at, _)| at.period.map(|period| period as i64));
    columns.push(("period", Values::Counts(period.collect())));
    columns.push(("snaps", by_value(&DiagramPoint::snaps)));
    columns.push(("exponent", by_value(&exponent(0))));
    // An error that is not known is missing; one without bound is a value.
    let error = exponent(1);
    columns.push((
        "exponent_se",
        by_value(&|at| error(at).filter(|se| !se.is_nan())),
    ));
    columns.push((
        "stop",
        names(rows().map(|(at, _)| at.stop().map(|stop| stop.name()))),
    ));
    columns.push((
        "stop_t",
        by_value(&|at| at.stop().map(|_| at.section.end.1)),
    ));
    let certain = rows().map(|(at, _)| at.stop_is_certain());
    columns.push(("stop_certain", Values::Flags(certain.collect())));
    let restarted = rows().map(|(at, _)| Some(at.restarted));
    columns.push(("restarted", Values::Flags(restarted.collect())));
    columns
}
