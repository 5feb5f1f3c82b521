//! The chapter's figures, each under its number.

mod curves;

use crate::ReportError;
use crate::configurations::{Configuration, Slides, rocking};
use crate::source::{self, Number, decimals};
use crate::study::{CaseRuns, Reading, Study};
use crate::tables::reason;
use curves::{critical_rows, norm_rows};
use snapload::Trajectory;
use snapload_figures::{Layer, Picture, Plot, Point, Range, RunPlot, RunPlots, Width, draw};

/// A figure of the report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The chapter's number, such as `6.12`.
    pub number: &'static str,
    /// What it shows, in our words.
    pub caption: String,
    /// What its run comes to.
    pub numbers: Vec<Number>,
    /// The picture.
    pub picture: Picture,
    /// The points behind it, as CSV.
    pub data: String,
    /// The commands that compute it.
    pub sources: Vec<Source>,
}

/// A command that computes a figure, or a part of it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The part; empty for all of it.
    pub what: &'static str,
    /// The command.
    pub command: String,
    /// Where in what it prints or writes the points stand.
    pub place: &'static str,
}

/// Figures that the chapter compares, to be shown side by side.
#[derive(Clone, Debug)]
pub struct Row {
    /// What they have in common.
    pub title: &'static str,
    /// How many stand side by side where there is room.
    pub columns: usize,
    /// The figures.
    pub figures: Vec<Figure>,
}

/// What a figure of one run shows.
#[derive(Clone, Copy)]
enum View {
    /// y against x, on the scale that Figs 6.1-6.6 share, times a factor.
    Path(f64),
    /// θ against t.
    Rotation,
    /// v_n⁻ against t.
    Snaps,
}

/// The rows in which the figures of single runs stand: title, columns, and for each figure its number,
/// what it shows, and its case.
type RunRow = (&'static str, usize, &'static [RunFigure]);
type RunFigure = (&'static str, View, &'static str);
#[rustfmt::skip] // a table
const RUN_ROWS: [RunRow; 8] = [
    ("Cable length, circle", 2, &[
        ("6.1", View::Path(1.0), "1910001000-359"),
        ("6.2", View::Path(1.0), "2910001000-359"),
    ]),
    ("Cable length, square", 2, &[
        ("6.3", View::Path(1.0), "1911001000-359"),
        ("6.4", View::Path(1.0), "2911001000-359"),
    ]),
    ("Cable length, rectangle", 2, &[
        ("6.5", View::Path(1.0), "1921001000-359"),
        ("6.6", View::Path(1.0), "2921001000-359"),
        ("6.7", View::Path(2.0), "2921001000-359"),
    ]),
    ("Rotation against the width of a rectangle", 3, &[
        ("6.8", View::Rotation, "1911001000-359"),
        ("6.9", View::Rotation, "1921001000-359"),
        ("6.10", View::Rotation, "1931001000-359"),
    ]),
    ("Snap velocity against restitution", 2, &[
        ("6.11", View::Snaps, "1110001000-359"),
        ("6.12", View::Snaps, "1910001000-359"),
        ("6.13", View::Snaps, "1710001000-359"),
        ("6.14", View::Snaps, "1510001000-359"),
    ]),
    ("Without loss: path and rotation", 2, &[
        ("6.15", View::Path(0.4), "1110001000-359"),
        ("6.16", View::Rotation, "1110001000-359"),
    ]),
    ("Rotation against frequency", 3, &[
        ("6.17", View::Rotation, "1910001000-355"),
        ("6.18", View::Rotation, "1910001000-3575"),
        ("6.19", View::Rotation, "1910001000-359"),
        ("6.20", View::Rotation, "1910001000-3515"),
        ("6.21", View::Rotation, "1910001000-3520"),
    ]),
    ("Snap velocity against frequency", 3, &[
        ("6.22", View::Snaps, "1910001000-355"),
        ("6.23", View::Snaps, "1910001000-3575"),
        ("6.24", View::Snaps, "1910001000-359"),
        ("6.25", View::Snaps, "1910001000-3515"),
        ("6.26", View::Snaps, "1910001000-3520"),
    ]),
];

/// The window that Figs 6.1-6.6 share: x from, x to, y from, y to. Twice as large it holds the whole path
/// of Fig. 6.7, which reaches y = 1.52.
const WINDOW: [f64; 4] = [-0.8, 0.8, -0.05, 0.8];

/// Draws all of them, in the chapter's order.
///
/// # Errors
/// [`ReportError`] only for a fault of the program.
pub fn figures(study: &Study) -> Result<Vec<Row>, ReportError> {
    let mut rows = Vec::new();
    for (title, columns, list) in RUN_ROWS {
        let cases: Vec<(&'static str, View, &CaseRuns)> = list
            .iter()
            .filter_map(|(number, view, code)| Some((*number, *view, study.case(code)?)))
            .collect();
        let common = Common::of(&cases);
        let figures = cases
            .iter()
            .map(|(number, view, case)| of_run(number, *view, case, common))
            .collect::<Result<_, _>>()?;
        rows.push(Row {
            title,
            columns,
            figures,
        });
    }
    rows.extend(critical_rows(study)?);
    rows.extend(norm_rows(study)?);
    let slides = Slides::compute(study)?;
    let mut sliding = Vec::new();
    for configuration in slides.configurations(study) {
        sliding.push(drawn(&configuration)?);
    }
    sliding.push(example(&EXAMPLES[0], &study.sliding)?);
    rows.push(Row {
        title: "Sliding: configurations and path",
        columns: 3,
        figures: sliding,
    });
    rows.push(Row {
        title: "Rocking: configuration and path",
        columns: 2,
        figures: vec![
            drawn(&rocking(study))?,
            example(&EXAMPLES[1], &study.rocking)?,
        ],
    });
    Ok(rows)
}

/// The axes that the figures of a row share.
#[derive(Clone, Copy)]
struct Common {
    t: f64,
    v_n: f64,
}

impl Common {
    fn of(cases: &[(&'static str, View, &CaseRuns)]) -> Self {
        let runs = || {
            let runs = cases.iter();
            runs.map(|(number, _, case)| (*number, &case.runs.chapter))
        };
        // Fig. 6.11 has a time axis of its own, as the run without loss is so much longer.
        let same = runs().filter(|(number, _)| *number != OWN_TIME_AXIS);
        Self {
            t: same.map(|(_, run)| run.end().t).fold(0.0, f64::max),
            v_n: runs().map(|(_, run)| run.norms().rho1).fold(0.0, f64::max),
        }
    }
}

/// The figure whose time axis differs from that of its row.
const OWN_TIME_AXIS: &str = "6.11";

fn finish(
    number: &'static str,
    caption: String,
    sources: Vec<Source>,
    plot: Plot,
) -> Result<Figure, ReportError> {
    let name = format!("figure-{}", number.replace('.', "-"));
    Ok(Figure {
        number,
        caption,
        numbers: Vec::new(),
        data: csv(&plot),
        picture: draw(&name, Width::Column, &[plot])?,
        sources,
    })
}

/// The command that writes tables and pictures of a run into a directory named after the figure.
fn written(number: &str, case: &str, place: &'static str) -> Vec<Source> {
    let directory = number.replace('.', "-");
    vec![Source {
        what: "",
        command: format!("snapload run --case {case} --out figure-{directory}"),
        place,
    }]
}

fn of_run(
    number: &'static str,
    view: View,
    case: &CaseRuns,
    common: Common,
) -> Result<Figure, ReportError> {
    let run = &case.runs.chapter;
    let plots = RunPlots::new(run);
    let (what, place, mut plot) = match view {
        View::Path(_) => (
            "Path of the body's centre",
            "x and y in motion.csv; trajectory.svg",
            plots.plot(RunPlot::Trajectory),
        ),
        View::Rotation => (
            "Rotation against time",
            "t and theta in motion.csv; rotation.svg",
            plots.plot(RunPlot::Rotation),
        ),
        View::Snaps => (
            "Normal velocity before each snap against time",
            "t and v_n in impacts.csv; snaps.svg",
            plots.plot(RunPlot::Snaps),
        ),
    };
    if let View::Path(scale) = view {
        let [left, right, bottom, top] = WINDOW.map(|side| side * scale);
        plot.x.range = Range::Fixed(left, right);
        plot.y.range = Range::Fixed(bottom, top);
    } else if number != OWN_TIME_AXIS {
        plot.x.range = Range::AtLeast(0.0, common.t);
    }
    if let View::Snaps = view {
        // With room for a whole marker at the top.
        plot.y.range = Range::AtLeast(0.0, 1.05 * common.v_n);
    }
    let p = &case.parameters;
    let scale = match view {
        View::Path(1.0) => " On the scale of Figs 6.1-6.6.",
        View::Path(2.0) => " The run of Fig. 6.6 in full, in a window twice as large.",
        _ => "",
    };
    let caption = format!(
        "{what}, case {}: r = {}, e = {}, a = {}, b = {}, f_o = {}, Ω = {}.{scale}",
        case.code, p.r, p.e, p.a, p.b, p.f_o, p.omega
    );
    let option = Reading::Chapter.option();
    let sources = written(number, &format!("{}{option}", case.code), place);
    let numbers = vec![
        Number {
            name: "Ends: ",
            shown: reason(run.end().reason).to_owned(),
            command: source::run(case.code, Reading::Chapter),
            key: ".end.reason".to_owned(),
        },
        Number {
            name: "t = ",
            shown: decimals(run.end().t, 4),
            command: source::run(case.code, Reading::Chapter),
            key: ".end.t".to_owned(),
        },
    ];
    Ok(Figure {
        numbers,
        ..finish(number, caption, sources, plot)?
    })
}

fn drawn(configuration: &Configuration) -> Result<Figure, ReportError> {
    let Configuration {
        number,
        caption,
        numbers,
        command,
        ..
    } = configuration;
    let source = Source {
        what: "",
        command: command.clone(),
        place: ".motion[1]",
    };
    Ok(Figure {
        numbers: numbers.clone(),
        ..finish(number, caption.clone(), vec![source], configuration.plot())?
    })
}

/// Figs 6.43 and 6.45: number, built-in case, and what the chapter says of it.
const EXAMPLES: [[&str; 3]; 2] = [
    [
        "6.43",
        "sliding-example",
        "the chapter's case 1910001000-2759, eq. 6.57",
    ],
    [
        "6.45",
        "rocking-example",
        "the chapter's case 1910001000-159, eq. 6.69",
    ],
];

fn example(
    [number, code, theirs]: &[&'static str; 3],
    run: &Trajectory,
) -> Result<Figure, ReportError> {
    let caption = format!(
        "Path of the body's centre in the {code} ({theirs}), the settling rule off: I start, S sliding \
         starts, G the other boundary is struck while one cable is taut, R rocking starts, E the end at \
         t = {}, where it still rocks.",
        run.end().t
    );
    let place = "x and y in motion.csv; trajectory.svg";
    let plot = RunPlots::new(run).plot(RunPlot::Trajectory);
    finish(number, caption, written(number, code, place), plot)
}

/// The points of a plot: series, piece, x, y.
fn csv(plot: &Plot) -> String {
    let mut text = String::from("series,piece,x,y\n");
    let mut add = |series: &str, piece: usize, points: &[Point]| {
        for [x, y] in points {
            text.push_str(&format!(
                "{},{piece},{x},{y}\n",
                series.replace([',', '*'], "")
            ));
        }
    };
    for layer in &plot.layers {
        match layer {
            Layer::Line(pieces, _, legend) => {
                for (k, points) in pieces.iter().enumerate() {
                    add(if legend.is_empty() { "line" } else { legend }, k, points);
                }
            }
            Layer::Markers(points, .., legend) => add(legend, 0, points),
            Layer::Boundary(points, label) => add(label, 0, points),
            _ => {}
        }
    }
    text
}
