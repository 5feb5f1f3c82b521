//! The five pictures of a motion on two cables, each from plain lists of points.
//!
//! Each function returns a [`Plot`], so that a caller can still change a label or a range, draw it
//! alone, or stack several over one time axis.

use crate::plot::{Axis, Colour, Dash, Layer, Mark, Plot, Point, Range, Shape, Stroke, TickStyle};
use std::f64::consts::FRAC_PI_2;

/// The names of the cables, and their strokes.
const CABLES: [(&str, Stroke); 2] = [
    ("cable 1", Stroke::new(Colour::BLUE, 0.9, Dash::Solid)),
    ("cable 2", Stroke::new(Colour::VERMILION, 0.9, Dash::Dashed)),
];

/// A part of the path of the body's centre.
#[derive(Debug, Clone, PartialEq)]
pub struct PathPart {
    /// How the body moves along it.
    pub mode: Mode,
    /// The centre's positions, `[x, y]`.
    pub points: Vec<Point>,
}

/// How the body moves along a part of its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Past the time up to which the computed motion can be trusted, in whatever mode.
    BeyondHorizon,
    /// No cable is taut.
    Slack,
    /// Both cables are taut.
    Rocking,
    /// One cable is taut.
    Sliding,
}

/// The stroke and the text of each mode. Short modes are drawn last, on top. Rocking is solid: its
/// path repeats itself, which would fill the gaps of a dashed line.
const MODES: [(Mode, Stroke, &str); 4] = [
    (
        Mode::BeyondHorizon,
        Stroke::new(Colour::GREY, 0.5, Dash::Solid),
        BEYOND,
    ),
    (
        Mode::Slack,
        Stroke::new(Colour::BLACK, 0.5, Dash::Solid),
        "slack",
    ),
    (
        Mode::Rocking,
        Stroke::new(Colour::VERMILION, 1.0, Dash::Solid),
        "rocking",
    ),
    (
        Mode::Sliding,
        Stroke::new(Colour::BLUE, 1.8, Dash::Solid),
        "sliding",
    ),
];
const BEYOND: &str = "past the horizon";

/// The path of the body's centre, y against x, inside the boundaries of its region.
///
/// `boundaries` are the polylines on which cable 1 and cable 2 become taut. The letters of the
/// marks are the caller's: I start, S sliding starts, R rocking starts, G the other boundary is
/// hit while one cable is taut, E end. A legend appears where the path has more than one mode.
pub fn trajectory(path: &[PathPart], boundaries: [&[Point]; 2], marks: &[Mark]) -> Plot {
    let [first, second] = boundaries.map(<[Point]>::to_vec);
    let mut layers = vec![
        Layer::Boundary(first, "*g*₁ = 0, *θ* = 0".to_string()),
        Layer::Boundary(second, "*g*₂ = 0, *θ* = 0".to_string()),
    ];
    let one = path.windows(2).all(|parts| parts[0].mode == parts[1].mode);
    for (mode, stroke, words) in MODES {
        let parts = path.iter().filter(|part| part.mode == mode);
        let pieces = parts.map(|part| part.points.clone()).collect();
        let words = if one { "" } else { words };
        layers.push(Layer::Line(pieces, stroke, words.to_string()));
    }
    layers.push(Layer::Letters(marks.to_vec()));
    Plot {
        description: "Path of the body's centre, y against x".to_string(),
        x: Axis::new("*x* (L)", Range::Auto),
        y: Axis::new("*y* (L)", Range::Auto),
        equal_scale: true,
        layers,
        ..Plot::default()
    }
}

/// The body's rotation θ against time, with the lines ±π/2.
///
/// `horizon` is the time past which the motion cannot be trusted; the background is grey there.
pub fn rotation(theta: &[Point], horizon: Option<f64>) -> Plot {
    let layers = vec![
        Layer::Horizontal(FRAC_PI_2, "π/2".to_string()),
        Layer::Horizontal(-FRAC_PI_2, "−π/2".to_string()),
        Layer::Line(vec![theta.to_vec()], Stroke::default(), String::new()),
    ];
    let mut y = Axis::new("*θ* (rad)", Range::AtLeast(-1.7, 1.7));
    y.ticks = TickStyle::Angle;
    over_time("Rotation of the body", y, horizon, layers)
}

/// The normal velocity just before each snap against time, for cable 1 and cable 2.
///
/// Each point is the time of a snap and the velocity. For `horizon` see [`rotation`].
pub fn snap_velocities(cables: [&[Point]; 2], horizon: Option<f64>) -> Plot {
    let of_cable = |k: usize, shape| {
        let (name, Stroke { colour, .. }) = CABLES[k];
        Layer::Markers(cables[k].to_vec(), shape, colour, name.to_string())
    };
    let layers = vec![of_cable(0, Shape::Cross), of_cable(1, Shape::Circle)];
    let y = Axis::new("*v*ₙ⁻ (L/T)", Range::AtLeast(0.0, 0.0));
    let plot = over_time("Normal velocity before each snap", y, horizon, layers);
    noted_if_empty(plot, "no cable snapped taut")
}

/// The tension of each cable against time: for each cable the pieces during which it was taut.
///
/// For `horizon` see [`rotation`].
pub fn tensions(cables: [&[Vec<Point>]; 2], horizon: Option<f64>) -> Plot {
    let lines = cables.into_iter().zip(CABLES);
    let line = |(pieces, (name, stroke)): (&[Vec<Point>], (&str, Stroke))| {
        Layer::Line(pieces.to_vec(), stroke, name.to_string())
    };
    let y = Axis::new("*T* (F)", Range::AtLeast(0.0, 0.0));
    let plot = over_time(
        "Tension of each cable",
        y,
        horizon,
        lines.map(line).collect(),
    );
    noted_if_empty(plot, "no interval with a taut cable")
}

/// The energy against time; a snap is two points at one time. For `horizon` see [`rotation`].
pub fn energy(points: &[Point], horizon: Option<f64>) -> Plot {
    let line = Layer::Line(vec![points.to_vec()], Stroke::default(), String::new());
    let y = Axis::new("*E* (F L)", Range::Auto);
    over_time("Energy", y, horizon, vec![line])
}

fn over_time(what: &str, y: Axis, horizon: Option<f64>, mut layers: Vec<Layer>) -> Plot {
    let shade = |from| Layer::Shade(from, f64::INFINITY, BEYOND.to_string());
    layers.splice(0..0, horizon.map(shade));
    Plot {
        description: format!("{what} against time"),
        x: Axis::new("*t* (T)", Range::Auto),
        y,
        layers,
        ..Plot::default()
    }
}

fn noted_if_empty(mut plot: Plot, note: &str) -> Plot {
    if plot.data().next().is_none() {
        plot.note = note.to_string();
    }
    plot
}
