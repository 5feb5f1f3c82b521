//! The chapter's figures, each under its number.

use crate::configurations::configurations;
use crate::study::{CaseRuns, CriticalCurve, NormCurve, Reading, Study};
use snapload::Trajectory;
use snapload::analysis::Outcome;
use snapload_figures::{
    Axis, Colour, Dash, FigureError, Layer, Picture, Plot, Point, Range, RunPlots, Shape, Stroke,
    Width, draw,
};

/// A figure of the report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The chapter's number, such as `6.12`.
    pub number: &'static str,
    /// What it shows, in our words.
    pub caption: String,
    /// The picture.
    pub picture: Picture,
    /// The points behind it, as CSV.
    pub data: String,
    /// The command that computes it.
    pub command: String,
}

/// Figures that the chapter compares, to be shown side by side.
#[derive(Clone, Debug)]
pub struct Row {
    /// What they have in common.
    pub title: &'static str,
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

/// The figures of single runs: the rows in which they stand, and for each its number and case.
type RunRow = (&'static str, View, &'static [(&'static str, &'static str)]);
const RUN_ROWS: [RunRow; 10] = [
    (
        "Cable length, circle",
        View::Path(1.0),
        &[("6.1", "1910001000-359"), ("6.2", "2910001000-359")],
    ),
    (
        "Cable length, square",
        View::Path(1.0),
        &[("6.3", "1911001000-359"), ("6.4", "2911001000-359")],
    ),
    (
        "Cable length, rectangle",
        View::Path(1.0),
        &[("6.5", "1921001000-359"), ("6.6", "2921001000-359")],
    ),
    (
        "The rectangle on long cables, at twice the scale",
        View::Path(2.0),
        &[("6.7", "2921001000-359")],
    ),
    (
        "Rotation against the width of a rectangle",
        View::Rotation,
        &[
            ("6.8", "1911001000-359"),
            ("6.9", "1921001000-359"),
            ("6.10", "1931001000-359"),
        ],
    ),
    (
        "Snap velocity against restitution",
        View::Snaps,
        &[
            ("6.11", "1110001000-359"),
            ("6.12", "1910001000-359"),
            ("6.13", "1710001000-359"),
            ("6.14", "1510001000-359"),
        ],
    ),
    (
        "Without loss",
        View::Path(0.4),
        &[("6.15", "1110001000-359")],
    ),
    (
        "Without loss, rotation",
        View::Rotation,
        &[("6.16", "1110001000-359")],
    ),
    (
        "Rotation against frequency",
        View::Rotation,
        &[
            ("6.17", "1910001000-355"),
            ("6.18", "1910001000-3575"),
            ("6.19", "1910001000-359"),
            ("6.20", "1910001000-3515"),
            ("6.21", "1910001000-3520"),
        ],
    ),
    (
        "Snap velocity against frequency",
        View::Snaps,
        &[
            ("6.22", "1910001000-355"),
            ("6.23", "1910001000-3575"),
            ("6.24", "1910001000-359"),
            ("6.25", "1910001000-3515"),
            ("6.26", "1910001000-3520"),
        ],
    ),
];

/// The window that Figs 6.1-6.6 share: x from, x to, y from, y to.
const WINDOW: [f64; 4] = [-0.8, 0.8, -0.05, 0.75];

/// Draws all of them, in the chapter's order.
///
/// # Errors
/// [`FigureError`] only for a fault of the program.
pub fn figures(study: &Study) -> Result<Vec<Row>, FigureError> {
    let mut rows = Vec::new();
    for (title, view, list) in RUN_ROWS {
        let cases: Vec<(&'static str, &CaseRuns)> = list
            .iter()
            .filter_map(|(number, code)| Some((*number, study.case(code)?)))
            .collect();
        let common = Common::of(&cases);
        let figures = cases
            .iter()
            .map(|(number, case)| of_run(number, case, view, common))
            .collect::<Result<_, _>>()?;
        rows.push(Row { title, figures });
    }
    rows.extend(critical_rows(study)?);
    rows.extend(norm_rows(study)?);
    let mut drawn = Vec::new();
    for configuration in configurations(study) {
        let (caption, command) = (configuration.caption.clone(), configuration.command.clone());
        drawn.push(finish(
            configuration.number,
            caption,
            command,
            configuration.plot(),
        )?);
    }
    let rocking = drawn.split_off(drawn.len().saturating_sub(1));
    rows.push(Row {
        title: "Sliding: configurations and path",
        figures: drawn
            .into_iter()
            .chain([example("6.43", "sliding-example", &study.sliding)?])
            .collect(),
    });
    rows.push(Row {
        title: "Rocking: configuration and path",
        figures: rocking
            .into_iter()
            .chain([example("6.45", "rocking-example", &study.rocking)?])
            .collect(),
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
    fn of(cases: &[(&'static str, &CaseRuns)]) -> Self {
        let runs = || {
            cases
                .iter()
                .map(|(number, case)| (*number, &case.runs.chapter))
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
    command: String,
    plot: Plot,
) -> Result<Figure, FigureError> {
    let name = format!("figure-{}", number.replace('.', "-"));
    Ok(Figure {
        number,
        caption,
        data: csv(&plot),
        picture: draw(&name, Width::Column, &[plot])?,
        command,
    })
}

fn of_run(
    number: &'static str,
    case: &CaseRuns,
    view: View,
    common: Common,
) -> Result<Figure, FigureError> {
    let run = &case.runs.chapter;
    let plots = RunPlots::new(run);
    let (what, plot) = match view {
        View::Path(scale) => {
            let mut plot = plots.trajectory();
            let [left, right, bottom, top] = WINDOW.map(|side| side * scale);
            plot.x.range = Range::Fixed(left, right);
            plot.y.range = Range::Fixed(bottom, top);
            ("Path of the body's centre", plot)
        }
        View::Rotation => ("Rotation against time", plots.rotation()),
        View::Snaps => {
            let mut plot = plots.snaps();
            plot.y.range = Range::AtLeast(0.0, common.v_n);
            ("Normal velocity before each snap against time", plot)
        }
    };
    let mut plot = plot;
    if !matches!(view, View::Path(_)) && number != OWN_TIME_AXIS {
        plot.x.range = Range::AtLeast(0.0, common.t);
    }
    let p = &case.parameters;
    let caption = format!(
        "{what}, case {}: r = {}, e = {}, a = {}, b = {}, f_o = {}, Ω = {}.",
        case.code, p.r, p.e, p.a, p.b, p.f_o, p.omega
    );
    let command = format!(
        "snapload run --case {}{} --out DIR",
        case.code,
        Reading::Chapter.option()
    );
    finish(number, caption, command, plot)
}

fn example(number: &'static str, code: &str, run: &Trajectory) -> Result<Figure, FigureError> {
    let caption = format!(
        "Path of the body's centre in the {code}, sliding and rocking included: I start, S sliding \
         starts, G the other boundary is struck while one cable is taut, R rocking starts, E end."
    );
    let command = format!("snapload run --case {code} --out DIR");
    finish(number, caption, command, RunPlots::new(run).trajectory())
}

const CHAPTER: Stroke = Stroke {
    colour: Colour::Blue,
    width_pt: 0.9,
    dash: Dash::Solid,
};
const SLIDING_ON: Stroke = Stroke {
    colour: Colour::Vermilion,
    width_pt: 0.9,
    dash: Dash::Dashed,
};

fn stroke(reading: Reading) -> Stroke {
    match reading {
        Reading::Chapter => CHAPTER,
        Reading::SlidingOn => SLIDING_ON,
    }
}

fn critical_rows(study: &Study) -> Result<Vec<Row>, FigureError> {
    let numbers = [
        ("6.27", 1.5, "e"),
        ("6.28", 1.5, "omega"),
        ("6.29", 2.5, "e"),
        ("6.30", 2.5, "omega"),
    ];
    let mut figures = Vec::new();
    for (number, r, key) in numbers {
        if let Some(curve) = study.curves.iter().find(|c| c.r == r && c.key == key) {
            figures.push(critical(number, curve)?);
        }
    }
    let long = figures.split_off(figures.len().min(2));
    Ok(vec![
        Row {
            title: "Critical force, r = 1.5",
            figures,
        },
        Row {
            title: "Critical force, r = 2.5",
            figures: long,
        },
    ])
}

fn critical(number: &'static str, curve: &CriticalCurve) -> Result<Figure, FigureError> {
    let layer = |reading: Reading| {
        let points = curve.points.of(reading).iter();
        Layer::Line {
            pieces: vec![points.filter_map(|(x, f)| Some([*x, (*f)?])).collect()],
            stroke: stroke(reading),
            legend: reading.words().to_owned(),
        }
    };
    let (symbol, from, to) = match curve.key {
        "e" => ("*e*", 0.3, 1.0),
        _ => ("*Ω* (nondimensional)", 0.4, 2.4),
    };
    let plot = Plot {
        description: format!("Critical force against {}", curve.key),
        x: axis(symbol, Range::AtLeast(from, to)),
        y: axis("*f*_cr (nondimensional)", Range::AtLeast(0.0, 0.0)),
        layers: Reading::BOTH.map(layer).to_vec(),
        ..Plot::default()
    };
    let name = if curve.key == "e" {
        "the restitution"
    } else {
        "the frequency of the forcing"
    };
    let caption = format!(
        "Smallest force amplitude that exceeds the limits against {name}, r = {}, in steps of 0.01.",
        curve.r
    );
    let range = if curve.key == "e" {
        "e=0.3:1:71"
    } else {
        "omega=0.4:2.4:101"
    };
    let command = format!(
        "snapload critical --set r={}{} --over {range}",
        curve.r,
        Reading::Chapter.option()
    );
    finish(number, caption, command, plot)
}

/// A figure of norms: its number, cable length, what it shows, and the norms with their markers.
type NormFigure = (
    &'static str,
    f64,
    &'static str,
    &'static [(&'static str, fn(&Outcome) -> f64)],
);
const NORM_FIGURES: [NormFigure; 8] = [
    (
        "6.31",
        1.5,
        "Largest rotation",
        &[("|*θ*|_max (rad)", |o| o.norms.theta_max)],
    ),
    (
        "6.32",
        1.5,
        "Largest height",
        &[("*y*_max (nondimensional)", |o| o.norms.y_max)],
    ),
    (
        "6.33",
        1.5,
        "Largest snap velocity, and their sum up to t = 10",
        &[("*ρ*₁", |o| o.norms.rho1), ("*ρ*₂", |o| o.norms.rho2)],
    ),
    (
        "6.34",
        1.5,
        "Sum of all snap velocities",
        &[("*ρ*₃", |o| o.norms.rho3)],
    ),
    (
        "6.35",
        2.5,
        "Largest rotation",
        &[("|*θ*|_max (rad)", |o| o.norms.theta_max)],
    ),
    (
        "6.36",
        2.5,
        "Largest height",
        &[("*y*_max (nondimensional)", |o| o.norms.y_max)],
    ),
    (
        "6.37",
        2.5,
        "Largest snap velocity, and their sum up to t = 10",
        &[("*ρ*₁", |o| o.norms.rho1), ("*ρ*₂", |o| o.norms.rho2)],
    ),
    (
        "6.38",
        2.5,
        "Sum of all snap velocities",
        &[("*ρ*₃", |o| o.norms.rho3)],
    ),
];

fn norm_rows(study: &Study) -> Result<Vec<Row>, FigureError> {
    let mut rows = vec![
        Row {
            title: "Norms against force amplitude, r = 1.5",
            figures: Vec::new(),
        },
        Row {
            title: "Norms against force amplitude, r = 2.5",
            figures: Vec::new(),
        },
    ];
    for figure in NORM_FIGURES {
        if let Some(curve) = study.norms.iter().find(|curve| curve.r == figure.1) {
            rows[usize::from(figure.1 > 2.0)]
                .figures
                .push(norm(figure, curve)?);
        }
    }
    Ok(rows)
}

fn norm((number, r, what, norms): NormFigure, curve: &NormCurve) -> Result<Figure, FigureError> {
    let mut layers = Vec::new();
    for reading in Reading::BOTH {
        for (k, (symbol, of)) in norms.iter().enumerate() {
            let points: Vec<Point> = curve
                .points
                .of(reading)
                .iter()
                .map(|(f, o)| [*f, of(o)])
                .collect();
            let several = if norms.len() > 1 {
                format!("{symbol}, ")
            } else {
                String::new()
            };
            layers.push(Layer::Markers {
                points,
                shape: if k == 0 { Shape::Circle } else { Shape::Cross },
                colour: stroke(reading).colour,
                legend: format!("{several}{}", reading.words()),
            });
        }
    }
    let symbols: Vec<&str> = norms.iter().map(|(symbol, _)| *symbol).collect();
    let plot = Plot {
        description: format!("{what} against force amplitude"),
        x: axis("*f*ₒ (nondimensional)", Range::AtLeast(0.0, 0.0)),
        y: axis(&symbols.join(", "), Range::AtLeast(0.0, 0.0)),
        layers,
        ..Plot::default()
    };
    let caption = format!("{what} against the force amplitude, up to the critical force, r = {r}.");
    let command = format!(
        "snapload run --set r={r} --set f_o=F{} --json -",
        Reading::Chapter.option()
    );
    finish(number, caption, command, plot)
}

fn axis(label: &str, range: Range) -> Axis {
    Axis {
        label: label.to_owned(),
        range,
        ..Axis::default()
    }
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
            Layer::Line { pieces, legend, .. } => {
                for (k, points) in pieces.iter().enumerate() {
                    add(if legend.is_empty() { "line" } else { legend }, k, points);
                }
            }
            Layer::Markers { points, legend, .. } => add(legend, 0, points),
            Layer::Boundary { points, label } => add(label, 0, points),
            _ => {}
        }
    }
    text
}
