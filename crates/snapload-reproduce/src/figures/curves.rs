//! Figs 6.27-6.38: critical force over restitution and frequency, and norms over the force amplitude.

use super::{Figure, Row, Source, finish};
use crate::ReportError;
use crate::study::{Both, CriticalCurve, NormCurve, Reading, Study};
use snapload::Outcome;
use snapload_figures::{Axis, Colour, Dash, Layer, Plot, Point, Range, Shape, Stroke};

const CHAPTER: Stroke = Stroke::new(Colour::BLUE, 0.9, Dash::Solid);
const SLIDING_ON: Stroke = Stroke::new(Colour::VERMILION, 0.9, Dash::Dashed);

fn stroke(reading: Reading) -> Stroke {
    match reading {
        Reading::Chapter => CHAPTER,
        Reading::SlidingOn => SLIDING_ON,
    }
}

/// A command for each of some values, which `values` prints in hundredths: so the shell hands the program
/// the very decimals of the report. Sums such as 0.3 + 68 · 0.01 miss them in the last bit, which is
/// enough to change a critical force.
fn for_each(verb: &str, values: &str, key: &str, r: f64, reading: Reading) -> String {
    format!(
        "for k in $({values}); do snapload {verb} --set r={r} --set {key}=${{k}}e-2{} --json -; done",
        reading.option()
    )
}

pub(super) fn critical_rows(study: &Study) -> Result<Vec<Row>, ReportError> {
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
            columns: 2,
            figures,
        },
        Row {
            title: "Critical force, r = 2.5",
            columns: 2,
            figures: long,
        },
    ])
}

fn critical(number: &'static str, curve: &CriticalCurve) -> Result<Figure, ReportError> {
    let layer = |reading: Reading| {
        let points = curve.points.of(reading).iter();
        let points = points.filter_map(|(x, f)| Some([*x, (*f)?])).collect();
        Layer::Line(vec![points], stroke(reading), reading.words().to_owned())
    };
    let (symbol, name, (from, to), values) = match curve.key {
        "e" => ("*e*", "the restitution e", (0.3, 1.0), "seq 30 100"),
        _ => (
            "*Ω* (nondimensional)",
            "the frequency Ω of the forcing",
            (0.4, 2.4),
            "seq 40 2 240",
        ),
    };
    let plot = Plot {
        description: format!("Critical force against {name}"),
        x: Axis::new(symbol, Range::AtLeast(from, to)),
        y: Axis::new("critical force (nondimensional)", Range::AtLeast(0.0, 0.0)),
        layers: Reading::BOTH.map(layer).to_vec(),
        ..Plot::default()
    };
    let absent = Reading::BOTH.map(|reading| {
        let points = curve.points.of(reading).iter();
        points.filter(|(_, f)| f.is_none()).count()
    });
    let gaps = if absent == [0, 0] {
        ""
    } else {
        " Where a curve is missing no amplitude up to 1 exceeds them."
    };
    let caption = format!(
        "Critical force against {name}, r = {}: the smallest force amplitude, in steps of 0.01, whose run \
         exceeds the limits.{gaps}",
        curve.r
    );
    let sources = Reading::BOTH.map(|reading| Source {
        what: reading.words(),
        command: for_each("critical", values, curve.key, curve.r, reading),
        place: ".f_cr",
    });
    finish(number, caption, sources.to_vec(), plot)
}

/// The symbol of a norm, and its value.
type Norm = (&'static str, fn(&Outcome) -> f64);

/// A figure of norms, for r = 1.5 and r = 2.5.
struct NormFigure {
    numbers: [&'static str; 2],
    what: &'static str,
    axis: &'static str,
    /// The first is drawn as circles, the second as crosses.
    norms: &'static [Norm],
    /// Their place in the JSON of a run.
    place: &'static str,
}

const NORM_FIGURES: [NormFigure; 4] = [
    NormFigure {
        numbers: ["6.31", "6.35"],
        what: "Largest rotation",
        axis: "largest |*θ*| (rad)",
        norms: &[("|*θ*|", |o| o.norms.theta_max)],
        place: ".norms.theta_max",
    },
    NormFigure {
        numbers: ["6.32", "6.36"],
        what: "Largest height",
        axis: "largest *y* (nondimensional)",
        norms: &[("*y*", |o| o.norms.y_max)],
        place: ".norms.y_max",
    },
    NormFigure {
        numbers: ["6.33", "6.37"],
        what: "Largest snap velocity ρ₁, and the sum ρ₂ of snap velocities up to t = 10",
        axis: "*ρ*₁, *ρ*₂ (nondimensional)",
        norms: &[("*ρ*₁", |o| o.norms.rho1), ("*ρ*₂", |o| o.norms.rho2)],
        place: ".norms | .rho1, .rho2",
    },
    NormFigure {
        numbers: ["6.34", "6.38"],
        what: "Sum ρ₃ of all snap velocities",
        axis: "*ρ*₃ (nondimensional)",
        norms: &[("*ρ*₃", |o| o.norms.rho3)],
        place: ".norms.rho3",
    },
];

pub(super) fn norm_rows(study: &Study) -> Result<Vec<Row>, ReportError> {
    let rows = [
        ("Norms against force amplitude, r = 1.5", 1.5),
        ("Norms against force amplitude, r = 2.5", 2.5),
    ];
    let mut drawn = Vec::new();
    for (k, (title, r)) in rows.into_iter().enumerate() {
        let mut figures = Vec::new();
        for figure in &NORM_FIGURES {
            if let Some(curve) = study.norms.iter().find(|curve| curve.r == r) {
                figures.push(norm(figure.numbers[k], figure, curve)?);
            }
        }
        drawn.push(Row {
            title,
            columns: 2,
            figures,
        });
    }
    Ok(drawn)
}

fn norm(
    number: &'static str,
    figure: &NormFigure,
    curve: &NormCurve,
) -> Result<Figure, ReportError> {
    let (r, what) = (curve.r, figure.what);
    let outcomes = Reading::BOTH.map(|reading| curve.points.of(reading).iter());
    let values = outcomes.into_iter().flatten().flat_map(|(_, outcome)| {
        let norms = figure.norms.iter();
        norms.map(move |(_, of)| of(outcome))
    });
    let largest = values.fold(0.0, f64::max);
    let plot = Plot {
        description: format!("{what} against force amplitude"),
        x: Axis::new("*f*ₒ (nondimensional)", Range::AtLeast(0.0, 0.0)),
        // With room for a whole marker at the top.
        y: Axis::new(figure.axis, Range::AtLeast(0.0, 1.08 * largest)),
        layers: norm_layers(figure, &curve.points),
        ..Plot::default()
    };
    let caption = format!(
        "{what} against the force amplitude, up to the critical force, r = {r}. Black where both readings agree."
    );
    let sources = Reading::BOTH.map(|reading| {
        let values = format!("seq {}", curve.points.of(reading).len());
        Source {
            what: reading.words(),
            command: for_each("run", &values, "f_o", r, reading),
            place: figure.place,
        }
    });
    finish(number, caption, sources.to_vec(), plot)
}

/// The readings agree at most amplitudes: such a point is drawn once, or the second would hide the first.
fn norm_layers(figure: &NormFigure, points: &Both<Vec<(f64, Outcome)>>) -> Vec<Layer> {
    let mut layers = Vec::new();
    for (k, (symbol, of)) in figure.norms.iter().enumerate() {
        let all = Reading::BOTH.map(|reading| -> Vec<Point> {
            let points = points.of(reading).iter();
            points.map(|(f, o)| [*f, of(o)]).collect()
        });
        let [chapter, sliding_on] = &all;
        let only = |own: &[Point], other: &[Point]| -> Vec<Point> {
            let lone = own.iter().filter(|point| !other.contains(point));
            lone.copied().collect()
        };
        let both = chapter.iter().filter(|point| sliding_on.contains(point));
        let [first, second] = Reading::BOTH;
        for (points, colour, words) in [
            (both.copied().collect(), Colour::BLACK, "both readings"),
            (only(chapter, sliding_on), CHAPTER.colour, first.words()),
            (only(sliding_on, chapter), SLIDING_ON.colour, second.words()),
        ] {
            if !points.is_empty() {
                let shape = if k == 0 { Shape::Circle } else { Shape::Cross };
                let words = format!("{symbol}, {words}");
                layers.push(Layer::Markers(points, shape, colour, words));
            }
        }
    }
    layers
}
