//! `snapload section`: a long motion, once a period of the forcing.
use crate::bar::Bar;
use crate::case_input::CaseArgs;
use crate::failure::Failure;
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::orbit_picture::{PlotArgs, PlotFile};
use crate::outputs::{Outputs, TABLE};
use crate::table::numbers;
use serde::Serialize;
use snapload::analysis::{Progress, START_KEYS};
use snapload_figures::{Colour, Layer, Shape};
use snapload_orbits::{
    ImpactPoint, KEEP, MOST_KEPT, PERIODS, Section, SectionOptions, SectionRow, section_options,
    section_summary, without_points_summary,
};
use snapload_report::{CaseEcho, case_in_words};
use snapload_study::Values;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The result is the state at t = (phase + k) T after the transient, where T is the period of the forcing. It also has
the period of the motion, if the motion is periodic, and the Lyapunov exponents per unit of time with their standard
errors. An exponent is -inf where a taut cable removes a direction. Runs do not stop when the body settles. With --at
impacts the table and the picture have one point per impact instead: its time, the phase of the forcing, the cable,
v_n, and the states just before and after the impact.

Examples:
  snapload section --set body=point --set r=1.976 --set e=0.71 --set nu=0.87 --set omega=4.847 \\
      --set f_o=1.6 --set x=0 --set y=0.4 --set vx=0.1 --phase 0.25 --periods 2000 --keep 1500 \\
      --plot torus.svg --show x,y
      a point mass whose motion never repeats itself; its points lie on two closed curves
  snapload section --set f_o=0.1 --periods 200 --keep 50 --out points.csv
      a table of the points of the last 50 periods
  snapload section --set body=point --set r=1.976 --set e=0.71 --set nu=0.87 --set omega=4.847 \\
      --set f_o=1.6 --set x=0 --set y=0.4 --set vx=0.1 --at impacts --periods 2000 --keep 1500 \\
      --out impacts.parquet --plot impacts.svg
      v_n of each impact against the phase of the forcing";

/// Which case, and how long.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    options: SectionArgs,
    /// Where points are taken: once per forcing period, or at impacts
    #[arg(long, default_value = "periods", value_parser = ["periods", "impacts"])]
    at: String,
    /// Write the points as a table, FILE.parquet or FILE.csv
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    json: JsonArgs,
}

/// How long a motion is followed.
#[derive(clap::Args)]
pub(crate) struct SectionArgs {
    /// Total number of forcing periods
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = whole_number::<u64>(PERIODS))]
    periods: u64,
    /// Number of forcing periods to keep, at the end of the motion
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = whole_number::<u64>(KEEP))]
    keep: u64,
    /// Time of the section, in forcing periods; the start is the state at that time, so
    /// another phase gives another motion
    #[arg(long, value_name = "P", default_value_t = 0.0)]
    phase: f64,
}

impl SectionArgs {
    /// Checks it.
    pub(crate) fn read(&self) -> Result<SectionOptions, Failure> {
        Ok(section_options(self.periods, self.keep, self.phase)?)
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
    let options = SectionOptions {
        impacts: args.at == "impacts",
        ..args.options.read()?
    };
    let parameters = input.case.parameters();
    let mut outputs = Outputs::open(&args.json)?;
    let table = outputs.file("--out", args.out.as_deref(), &TABLE)?;
    let (usual, known) = match options.impacts {
        true => (["phase", "v_n"], &IMPACT_COLUMNS[..]),
        false => (["x", "vx"], &START_KEYS[..]),
    };
    let plot = args.plot.open(&mut outputs, usual, known)?;
    let bar = Bar::new();
    let section = Section::of(parameters, &options, &|progress: Progress| {
        bar.show(progress)
    })?;
    drop(bar);
    if let Some(why) = without_points_summary(&section) {
        return Err(Failure::Failed(format!(
            "no section: the motion from this start {why}; use fewer --periods, or another start"
        )));
    }
    let impacts = kept_impacts(&section)?;
    match impacts {
        Some(impacts) => outputs.table(table, parameters, &impact_columns(impacts))?,
        None => outputs.table(table, parameters, &columns(&section))?,
    }
    if let Some(mut plot) = plot {
        let layers = match impacts {
            Some(impacts) => {
                plot.phase_from = phase_from(impacts);
                impact_layers(impacts, &plot)
            }
            None => section_layers(&section, &plot),
        };
        plot.add_to(
            &mut outputs,
            &case_in_words(&input.name, parameters),
            layers,
        )?;
    }
    let row = Answer {
        case: CaseEcho(parameters),
        section: SectionRow::new(&section, options.phase),
    };
    let mut text = format!("Case      {}\n", case_in_words(&input.name, parameters));
    text.push_str(&section_summary(&section));
    outputs.finish(&row, text)
}

/// The impacts, if they were asked for.
fn kept_impacts(section: &Section) -> Result<Option<&[ImpactPoint]>, Failure> {
    match &section.impacts {
        Some(kept) if kept.left_out > 0 => Err(Failure::BadInput(format!(
            "--at impacts: {} impacts, and at most {MOST_KEPT} are kept; write a smaller --keep",
            kept.points.len() as u64 + kept.left_out
        ))),
        kept => Ok(kept.as_ref().map(|kept| &kept.points[..])),
    }
}

/// The numeric columns of an impact.
const IMPACT_COLUMNS: [&str; 13] = [
    "t",
    "phase",
    "v_n",
    "impulse",
    "x",
    "y",
    "theta",
    "vx_before",
    "vy_before",
    "vtheta_before",
    "vx_after",
    "vy_after",
    "vtheta_after",
];

fn of_impact(impact: &ImpactPoint, column: &str) -> f64 {
    let (key, state) = match column.strip_suffix("_after") {
        Some(key) => (key, &impact.after),
        None => (column.trim_end_matches("_before"), &impact.before),
    };
    match column {
        "t" => impact.t,
        "phase" => impact.phase,
        "v_n" => impact.v_n,
        "impulse" => impact.impulse,
        _ => {
            let place = START_KEYS.iter().position(|name| *name == key);
            place.map_or(f64::NAN, |place| state[place])
        }
    }
}

fn impact_columns(impacts: &[ImpactPoint]) -> Vec<(&'static str, Values)> {
    let cables = impacts.iter().map(|impact| Some(impact.cable as i64));
    let number = |name| numbers(impacts.iter().map(|impact| of_impact(impact, name)));
    let mut columns: Vec<_> = IMPACT_COLUMNS
        .iter()
        .map(|name| (*name, number(name)))
        .collect();
    columns.insert(2, ("cable", Values::Counts(cables.collect())));
    columns
}

/// At a phase this far from all impacts no marker is cut off.
const CLEAR: f64 = 0.03;

/// The phase at which the drawn period begins: 0, or if impacts are near that, the multiple of a
/// tenth that is farthest from all of them, so that a group of impacts is not divided.
fn phase_from(impacts: &[ImpactPoint]) -> f64 {
    let clear = |tenths: &i32| {
        let off = |impact: &ImpactPoint| impact.phase - f64::from(*tenths) / 10.0;
        let distances = impacts
            .iter()
            .map(|impact| (off(impact) - off(impact).round()).abs());
        distances.fold(f64::INFINITY, f64::min)
    };
    let farthest = (-5..5).max_by(|a, b| clear(a).total_cmp(&clear(b)));
    match farthest {
        Some(tenths) if clear(&0) < CLEAR => f64::from(tenths) / 10.0,
        _ => 0.0,
    }
}

fn impact_layers(impacts: &[ImpactPoint], plot: &PlotFile) -> Vec<Layer> {
    let [x, y] = &plot.axes;
    let drawn = [
        (1, Shape::Cross, Colour::BLUE),
        (2, Shape::Circle, Colour::VERMILION),
    ];
    let layer = |(cable, shape, colour)| {
        let of_cable = impacts.iter().filter(|impact| impact.cable == cable);
        let points: Vec<_> = of_cable
            .map(|impact| [x, y].map(|column| plot.placed(column, of_impact(impact, column))))
            .collect();
        let words = format!("cable {cable}");
        (!points.is_empty()).then_some(Layer::Markers(points, shape, colour, words))
    };
    drawn.into_iter().filter_map(layer).collect()
}

fn section_layers(section: &Section, plot: &PlotFile) -> Vec<Layer> {
    let place = |name: &String| START_KEYS.iter().position(|key| key == name);
    let [Some(x), Some(y)] = plot.axes.each_ref().map(place) else {
        return Vec::new();
    };
    let points: Vec<_> = section.points.iter().map(|z| [z[x], z[y]]).collect();
    if points.is_empty() {
        return Vec::new();
    }
    vec![Layer::Markers(
        points,
        Shape::Circle,
        Colour::BLACK,
        String::new(),
    )]
}

fn columns(section: &Section) -> Vec<(&'static str, Values)> {
    let points = || section.points_with_times();
    let ks = points().map(|(k, ..)| Some(k as i64)).collect();
    let mut columns = vec![
        ("k", Values::Counts(ks)),
        ("t", numbers(points().map(|(_, t, _)| t))),
    ];
    for (i, name) in START_KEYS.into_iter().enumerate() {
        columns.push((name, numbers(section.points.iter().map(|point| point[i]))));
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn impacts(phases: &[f64]) -> Vec<ImpactPoint> {
        let at = |phase: &f64| ImpactPoint {
            t: *phase,
            phase: *phase,
            cable: 1,
            v_n: 1.0,
            impulse: 1.0,
            before: [0.0; 6],
            after: [0.0; 6],
        };
        phases.iter().map(at).collect()
    }

    #[test]
    fn a_period_is_drawn_from_where_no_impact_is_near() {
        assert_eq!(phase_from(&impacts(&[])), 0.0);
        assert_eq!(phase_from(&impacts(&[0.2, 0.5, 0.9])), 0.0);
        assert_eq!(phase_from(&impacts(&[0.001, 0.11, 0.98, 0.999])), -0.5);
        assert_eq!(phase_from(&impacts(&[0.99, 0.2, 0.5, 0.6])), -0.2);
    }
}
