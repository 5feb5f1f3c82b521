//! `snapload branch`: an orbit as a key changes.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::orbit::{FromStart, NearArgs};
use crate::orbit_columns::{ORBIT_COLUMNS, of_orbit, text_columns};
use crate::orbit_picture::{Drawn, PlotArgs, PlotFile, branch_layers};
use crate::outputs::{Outputs, TABLE};
use serde::Serialize;
use snapload::Parameters;
use snapload::analysis::{OnProgress, Progress};
use snapload_figures::Layer;
use snapload_orbits::{
    Branch, BranchEvent, BranchOptions, BranchRow, Kind, Moored, POINTS, branch_summary,
    followed_key,
};
use snapload_report::{CaseEcho, case_in_words, case_without};
use snapload_study::{RandomRange, Values};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The command starts from the orbit near --start or, without it, from the orbit that the motion of the case
converges to. It follows that orbit in both directions by pseudo-arclength continuation, also around folds, with
the sequence of events held fixed. Folds, period doublings, Neimark-Sacker points, grazes, corners, lost tensions
and limits are located. Every point is also simulated, and `admissible` says whether it is a possible motion of
the body. With --switch, the branch that bifurcates at a period doubling is followed instead; its orbits are twice
as long. If --switch is repeated, the next branch has orbits that are four times as long, and so on.

Examples:
  snapload branch --set body=point --set r=1.7 --set e=0.35 --set f_o=1.4 --set nu=0.8 \\
      --set omega=3.1 --along f_o=1.2:4 --plot branch.svg --json -
  snapload branch --set omega=3 --along f_o=0.25:0.35 --out branch.parquet \\
      --start x=-0.065,y=0.118,theta=0.479,vx=0.387,vy=0.647,vtheta=-1.666
  snapload branch --set body=point --set r=1.7 --set e=0.35 --set f_o=1.4 --set nu=0.8 \\
      --set omega=3.1 --along f_o=1.2:2 --step 0.002 --switch period_doubling --json -
      the orbits of two periods that bifurcate at f_o = 1.6805";

/// Which case, which orbit, which key.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    near: NearArgs,
    /// Key to vary and the ends of its range
    #[arg(long, value_name = "KEY=low:high", allow_hyphen_values = true)]
    along: String,
    /// Switch to the period-doubled branch at the nearest period doubling along the branch, or at
    /// the N-th of those reported without this option; may be repeated
    #[arg(long, value_name = "period_doubling[:N]")]
    switch: Vec<String>,
    /// Length of the first step, in the space of the state, the event times and the key
    #[arg(long, default_value_t = 0.01)]
    step: f64,
    /// Maximum number of points in each direction
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = whole_number::<u32>(POINTS))]
    points: u32,
    /// Kinds of events to report, separated by commas
    #[arg(long, value_name = "all|fold,graze,...", default_value = "all")]
    events: String,
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
    branch: BranchRow,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (name, parameters) = args.case.parameters()?;
    let (key, value, options) = branch_options(args, &parameters)?;
    let kinds = kinds(&args.events)?;
    let switches: Vec<_> = args
        .switch
        .iter()
        .map(|text| switch(text))
        .collect::<Result<_, _>>()?;
    args.near.read(&parameters)?;
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let known = [&[key][..], &ORBIT_COLUMNS].concat();
    let plot = args.plot.open(&mut outputs, [key, "y"], &known)?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let family = Moored::case(parameters, [Some(key), None]);
    let (orbit, from_start) = args
        .near
        .orbit(&family, [value, 0.0], &parameters, &on_progress)?;
    let branch = family.branch(&orbit, &options, &on_progress)?;
    let (mut branch, from) = switched(&family, branch, &switches, &options, &on_progress)?;
    drop(bar);
    branch
        .events
        .retain(|event| kinds.is_empty() || kinds.contains(&event.kind.name()));
    outputs.table(table, &parameters, &columns(key, &branch))?;
    if let Some(plot) = plot {
        let layers = layers(key, &branch, &plot);
        let title = case_without(&[key], &name, &parameters);
        plot.add_to(&mut outputs, &title, layers)?;
    }
    let far = from_start.in_words();
    let row = Answer {
        case: CaseEcho(&parameters),
        from_start,
        branch: BranchRow::new(key, &branch, &from),
    };
    let mut text = format!("Case      {}\n", case_in_words(&name, &parameters));
    text += &far;
    for event in &from {
        let kind = event.kind.name().replace('_', " ");
        let _ = writeln!(
            text,
            "From      the {kind} at {key} = {:.12}",
            event.value[0]
        );
    }
    text.push_str(&branch_summary(key, &branch));
    outputs.finish(&row, text)
}

/// The branch after switching at period doublings, and these.
fn switched(
    family: &Moored,
    mut branch: Branch,
    switches: &[Option<usize>],
    options: &BranchOptions,
    on_progress: OnProgress,
) -> Result<(Branch, Vec<BranchEvent>), Failure> {
    let mut from = Vec::new();
    for number in switches {
        let event = branch.event(Kind::PeriodDoubling, *number);
        let event = event.map_err(|why| Failure::Failed(format!("--switch: {why}")))?;
        let event = event.clone();
        let doubled = family.branch_of_doubling(&event, options, on_progress)?;
        branch = doubled.ok_or_else(|| {
            let message = "--switch: no direction of a branch of twice the length is found there";
            Failure::Failed(message.to_owned())
        })?;
        from.push(event);
    }
    Ok((branch, from))
}

/// The key, its value, and how it is followed.
fn branch_options(
    args: &Args,
    parameters: &Parameters,
) -> Result<(&'static str, f64, BranchOptions), Failure> {
    let text = &args.along;
    let Some((key, range)) = text.split_once('=') else {
        return Err(Failure::BadInput(format!(
            "--along {text:?}: no range; write --along KEY=low:high, such as --along f_o=0.6:1.0"
        )));
    };
    followed_key("along", parameters, key.trim())?;
    let side = RandomRange::written(key.trim(), range.trim())
        .map_err(|error| Failure::from(error).with_prefix("--along"))?;
    let most = args.points as usize;
    let found =
        snapload_orbits::branch_options(parameters, side.key(), side.ends(), args.step, most)?;
    Ok(found)
}

/// The number of a period doubling; none for the nearest.
fn switch(text: &str) -> Result<Option<usize>, Failure> {
    let (kind, number) = match text.split_once(':') {
        Some((kind, number)) => (kind, Some(number)),
        None => (text, None),
    };
    let count = number.map(|number| number.trim().parse().ok().filter(|n| *n > 0));
    match (kind.trim(), count) {
        ("period_doubling", None) => Ok(None),
        ("period_doubling", Some(Some(count))) => Ok(Some(count)),
        _ => Err(Failure::BadInput(format!(
            "--switch {text:?}: write period_doubling, or period_doubling:N with N = 1, 2, ... for the N-th one \
             of the branch"
        ))),
    }
}

/// The kinds of events that are listed; none for all.
fn kinds(text: &str) -> Result<Vec<&'static str>, Failure> {
    if text == "all" {
        return Ok(Vec::new());
    }
    let kind = |word: &str| {
        let names = Kind::all().map(Kind::name).collect::<Vec<_>>();
        let known = names.iter().copied().find(|name| *name == word.trim());
        known.ok_or_else(|| {
            Failure::BadInput(format!(
                "--events {word:?}: all, or some of {}",
                names.join(", ")
            ))
        })
    };
    text.split(',').map(kind).collect()
}

fn columns(key: &'static str, branch: &Branch) -> Vec<(&'static str, Values)> {
    let points = || branch.points.iter();
    let number = |column: &'static str| {
        let values = points().map(|p| of_orbit(column, [key, ""], &p.orbit, p.arclength));
        let values = values.map(|value| Some(value).filter(|value| value.is_finite()));
        (column, Values::Numbers(values.collect()))
    };
    let others = ORBIT_COLUMNS.into_iter().filter(|column| *column != key);
    let mut columns: Vec<_> = others.map(number).collect();
    columns.insert(1, number(key));
    columns.extend(text_columns(
        &points().map(|point| &point.orbit).collect::<Vec<_>>(),
    ));
    columns
}

/// The names of the sorts of orbits.
const BRANCH_LABELS: [&str; 4] = ["stable", "neutral", "unstable", "not admissible"];

/// The branch in the order of its arclength, special points among the others.
fn layers(key: &str, branch: &Branch, plot: &PlotFile) -> Vec<Layer> {
    let [x, y] = &plot.axes;
    let drawn = |orbit, arclength, event| {
        let at = [x, y].map(|column| of_orbit(column, [key, ""], orbit, arclength));
        let stability = orbit.stability();
        let drawn = Drawn {
            at,
            orbit,
            stability,
            event,
        };
        (arclength, drawn)
    };
    let points = branch
        .points
        .iter()
        .map(|p| drawn(&p.orbit, p.arclength, None));
    let events = branch.events.iter();
    let events = events.map(|event| drawn(&event.orbit, event.arclength, Some(event)));
    let mut all: Vec<_> = points.chain(events).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: Vec<Drawn> = all.into_iter().map(|(_, drawn)| drawn).collect();
    // The velocity at the section jumps where an event passes it.
    let jumps = plot
        .axes
        .iter()
        .any(|column| ["vx", "vy", "vtheta"].contains(&column.as_str()));
    branch_layers(&all, jumps, BRANCH_LABELS)
}
