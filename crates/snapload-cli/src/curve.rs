//! `snapload curve`: special orbits as two keys change.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::orbit::{FromStart, NearArgs};
use crate::orbit_columns::{ORBIT_COLUMNS, of_orbit};
use crate::orbit_picture::{Drawn, PlotArgs, PlotFile, branch_layers};
use crate::outputs::{Outputs, TABLE};
use crate::table::names;
use serde::Serialize;
use snapload::analysis::{OnProgress, Progress};
use snapload::{Parameters, key_named};
use snapload_figures::Layer;
use snapload_orbits::{
    BranchEvent, BranchOptions, Curve, CurveOptions, CurvePoint, CurveRow, Kind, Moored, POINTS,
    curve_summary,
};
use snapload_report::{CaseEcho, case_in_words, case_without};
use snapload_study::{RandomRange, Values};
use std::path::PathBuf;

const EXAMPLES: &str = "\
A curve of bifurcation points in the plane of two keys separates cases that behave differently: beyond a fold there is
no orbit, beyond a period doubling another orbit, and beyond a graze another sequence of snaps. The command starts from
the orbit near --start or, without it, from the orbit that the motion of the case converges to, and follows it along
the first key until points of the given kind are found. From the nearest such point along the branch, or from the N-th,
both keys change. At each point of the curve the equations of the orbit and of the bifurcation are solved together, to
rounding. A curve ends at the ends of the ranges, at a corner, where the speed of another snap falls to zero, and where
a cable would have to be 0.02 longer; that of ns also at a resonance, 1:1 or 1:2, and where hardly any energy is lost.

  fold    an orbit and its unstable partner meet            pd      the period doubles
  ns      a pair of multipliers is on the unit circle       graze   a cable gets taut at zero speed

Examples:
  snapload curve --set body=point --set r=1.7 --set e=0.35 --set f_o=1.4 --set nu=0.8 \\
      --set omega=3.1 --follow fold --along f_o=1:2,omega=2.5:3.5 --plot fold.svg --out fold.parquet
      where in the plane (f_o, omega) the stable orbit of two snaps begins
  snapload curve --set body=point --set r=1.6 --set e=0.6 --set f_o=1.4 --set nu=1 --set omega=3.3 \\
      --start x=-0.0086,y=0.7632,vx=1.0527,vy=-0.7738 --follow ns --along f_o,e --json -
      where a torus replaces the orbit; the keys range from half to twice their values";

/// Which case, which orbit, which points, which keys.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    near: NearArgs,
    /// Kind of point to follow: the nearest one along the first key, or the
    /// N-th that snapload branch lists
    #[arg(long, value_name = "fold|pd|ns|graze[:N]")]
    follow: String,
    /// The two keys to vary and their ranges; by default from half to twice the values of the case
    #[arg(
        long,
        value_name = "K1[=low:high],K2[=low:high]",
        allow_hyphen_values = true
    )]
    along: String,
    /// Length of the first step, in the space of the state, the event times and the keys
    #[arg(long, default_value_t = 0.01)]
    step: f64,
    /// Maximum number of points in each direction
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = whole_number::<u32>(POINTS))]
    points: u32,
    /// Write a table with one row per point, FILE.parquet or FILE.csv
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
    #[serde(flatten)]
    from_start: FromStart,
    #[serde(flatten)]
    curve: CurveRow,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, parameters) = args.case.parameters()?;
    let what = follow(&args.follow)?;
    let (keys, options) = curve_options(args, &parameters)?;
    args.near.read(&parameters)?;
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let known = [&keys[..], &ORBIT_COLUMNS, &COEFFICIENTS].concat();
    let plot = args.plot.open(&mut outputs, keys, &known)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let along = (keys, &options);
    let (from_start, event, curve) = found(args, &parameters, along, what, &on_progress)?;
    drop(bar);
    outputs.table(table, &parameters, &columns(keys, &curve))?;
    if let Some(plot) = plot {
        let layers = layers(keys, &curve, &plot);
        let title = case_without(&keys, &name, &parameters);
        plot.add_to(&mut outputs, &title, layers)?;
    }
    let far = from_start.in_words();
    let row = Answer {
        case: CaseEcho(&parameters),
        from_start,
        curve: CurveRow::new(keys, &curve, &event),
    };
    let mut text = format!("Case      {}\n", case_in_words(&name, &parameters));
    text += &far;
    text.push_str(&curve_summary(keys, &curve, &event));
    outputs.finish(&row, text)
}

/// How far the first orbit is from the given start, the special point that the curve begins at, and
/// the curve.
fn found(
    args: &Args,
    parameters: &Parameters,
    (keys, options): ([&'static str; 2], &CurveOptions),
    (kind, number): (Kind, Option<usize>),
    on_progress: OnProgress,
) -> Result<(FromStart, BranchEvent, Curve), Failure> {
    let keys = keys.map(Some);
    let family = Moored::case(*parameters, keys);
    let at = Moored::values(parameters, keys);
    let (orbit, from_start) = args.near.orbit(&family, at, parameters, on_progress)?;
    let here = BranchEvent::here(kind, &orbit).filter(|_| number.is_none());
    let event = match here {
        Some(event) => event,
        None => {
            let along = BranchOptions {
                range: options.ranges[0],
                step: options.step,
                most: args.points as usize,
            };
            let branch = family.branch(&orbit, &along, on_progress)?;
            let event = branch.event(kind, number);
            let event = event.map_err(|why| {
                Failure::Failed(format!(
                    "--follow: along {}: {why}",
                    keys[0].unwrap_or_default()
                ))
            })?;
            event.clone()
        }
    };
    let curve = family.curve(&event, options, on_progress)?;
    let curve = curve.map_err(|why| Failure::Failed(format!("--follow: {why}")))?;
    Ok((from_start, event, curve))
}

/// The kind that is followed, and the number of the point.
fn follow(text: &str) -> Result<(Kind, Option<usize>), Failure> {
    let (word, number) = match text.split_once(':') {
        Some((word, number)) => (word, Some(number)),
        None => (text, None),
    };
    let kind = match word.trim() {
        "fold" => Some(Kind::Fold),
        "pd" | "period_doubling" => Some(Kind::PeriodDoubling),
        "ns" | "neimark_sacker" => Some(Kind::NeimarkSacker),
        "graze" => Some(Kind::Graze),
        _ => None,
    };
    let count = number.map(|number| number.trim().parse().ok().filter(|n: &usize| *n > 0));
    match (kind, count) {
        (Some(kind), None) => Ok((kind, None)),
        (Some(kind), Some(Some(count))) => Ok((kind, Some(count))),
        _ => Err(Failure::BadInput(format!(
            "--follow {text:?}: write fold, pd, ns or graze, or one of them with :N, N = 1, 2, ..., for the N-th \
             of the branch along the first key"
        ))),
    }
}

/// The keys, and how they change.
fn curve_options(
    args: &Args,
    parameters: &Parameters,
) -> Result<([&'static str; 2], CurveOptions), Failure> {
    let text = &args.along;
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [first, second] = parts[..] else {
        return Err(Failure::BadInput(format!(
            "--along {text:?}: two keys are needed with a comma between them, such as --along f_o=1:2,omega=2.5:3.5"
        )));
    };
    let of = |part: &'_ str| match part.split_once('=') {
        Some((key, range)) => {
            let side = RandomRange::written(key.trim(), range.trim())
                .map_err(|error| Failure::from(error).with_prefix("--along"))?;
            Ok::<_, Failure>((side.key(), Some(side.ends())))
        }
        None => Ok((key_named(part)?.name, None)),
    };
    let keys = [of(first)?, of(second)?];
    let most = args.points as usize;
    Ok(snapload_orbits::curve_options(
        parameters, keys, args.step, most,
    )?)
}

/// The numeric columns of a point besides those of its orbit.
const COEFFICIENTS: [&str; 3] = ["coefficient", "normal_acceleration", "sqrt_coefficient"];

fn of_point(column: &str, keys: [&str; 2], point: &CurvePoint) -> f64 {
    let value = match column {
        "coefficient" => point.coefficient,
        "normal_acceleration" => point.normal_acceleration,
        "sqrt_coefficient" => point.sqrt_coefficient,
        other => Some(of_orbit(other, keys, &point.orbit, point.arclength)),
    };
    value.unwrap_or(f64::NAN)
}

fn columns(keys: [&'static str; 2], curve: &Curve) -> Vec<(&'static str, Values)> {
    let points = || curve.points.iter();
    let number = |column: &'static str| {
        let values = points().map(|point| of_point(column, keys, point));
        let values = values.map(|value| Some(value).filter(|value| value.is_finite()));
        (column, Values::Numbers(values.collect()))
    };
    let others = ORBIT_COLUMNS.into_iter().chain(COEFFICIENTS);
    let mut columns: Vec<_> = others.map(number).collect();
    columns.splice(1..1, keys.map(number));
    let symbols = points().map(|point| Some(point.orbit.lap.sequence.symbol().join(" ").into()));
    columns.push(("symbol", Values::Words(symbols.collect())));
    let others = points().map(|point| Some(point.others.name()));
    columns.push(("others", names(others)));
    let real = points().map(|point| Some(point.orbit.is_admissible()));
    columns.push(("admissible", Values::Flags(real.collect())));
    columns
}

/// The names of the sorts of points.
const CURVE_LABELS: [&str; 4] = [
    "of a stable orbit",
    "of a neutral orbit",
    "of an unstable orbit",
    "not admissible",
];

fn layers(keys: [&str; 2], curve: &Curve, plot: &PlotFile) -> Vec<Layer> {
    let [x, y] = &plot.axes;
    let at = |point| [x, y].map(|column| of_point(column, keys, point));
    let points = curve.points.iter();
    let all: Vec<Drawn> = points
        .map(|point| Drawn {
            at: at(point),
            orbit: &point.orbit,
            stability: point.others,
            event: None,
        })
        .collect();
    let velocities = ["vx", "vy", "vtheta"];
    let jumps = plot
        .axes
        .iter()
        .any(|column| velocities.contains(&column.as_str()));
    branch_layers(&all, jumps, CURVE_LABELS)
}
