//! The five pictures of a motion on two cables, each from plain lists of points.
//!
//! Each function returns a [`Plot`], so that a caller can still change a label or a range, draw it
//! alone, or stack several over one time axis.

use crate::plot::{Axis, Colour, Dash, Layer, Mark, Plot, Point, Range, Shape, Stroke, TickStyle};
use std::f64::consts::FRAC_PI_2;

/// The ink of cable 1.
const CABLE_1: Stroke = Stroke {
    colour: Colour::Blue,
    width_pt: 0.9,
    dash: Dash::Solid,
};
/// The ink of cable 2.
const CABLE_2: Stroke = Stroke {
    colour: Colour::Vermilion,
    width_pt: 0.9,
    dash: Dash::Dashed,
};

/// A part of the path of the body's centre.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// How the body moves along it.
    pub mode: Mode,
    /// The centre's places, `[x, y]`.
    pub points: Vec<Point>,
}

/// How the body moves along a part of its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// No cable is taut.
    Slack,
    /// One cable is taut.
    Sliding,
    /// Both cables are taut.
    Rocking,
    /// Past the time up to which the computed motion can be trusted, in whatever mode.
    BeyondHorizon,
}

impl Mode {
    /// In the order of drawing: what lasts shortest is on top.
    const ALL: [Self; 4] = [
        Self::BeyondHorizon,
        Self::Slack,
        Self::Rocking,
        Self::Sliding,
    ];

    fn stroke(self) -> Stroke {
        let (colour, width_pt, dash) = match self {
            Self::Slack => (Colour::Black, 0.5, Dash::Solid),
            Self::Sliding => (Colour::Blue, 1.8, Dash::Solid),
            // Solid: rocking goes over its own path, which would fill the gaps of a dashed line.
            Self::Rocking => (Colour::Vermilion, 1.0, Dash::Solid),
            Self::BeyondHorizon => (Colour::SkyBlue, 0.5, Dash::Solid),
        };
        Stroke {
            colour,
            width_pt,
            dash,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Slack => "slack",
            Self::Sliding => "sliding",
            Self::Rocking => "rocking",
            Self::BeyondHorizon => "beyond the horizon",
        }
    }
}

/// The path of the body's centre, y against x, inside the boundaries of its region.
///
/// `boundaries` are the polylines on which cable 1 and cable 2 become taut. The letters of the
/// marks are the caller's: I start, S sliding starts, R rocking starts, G the other boundary is
/// hit while one cable is taut, E end. A legend appears where the path has more than one mode.
pub fn trajectory(path: &[Leg], boundaries: [&[Point]; 2], marks: &[Mark]) -> Plot {
    let boundary = |(points, label): (&[Point], &str)| Layer::Boundary {
        points: points.to_vec(),
        label: label.to_string(),
    };
    let mut layers: Vec<Layer> = boundaries
        .into_iter()
        .zip(["*g*₁ = 0, *θ* = 0", "*g*₂ = 0, *θ* = 0"])
        .map(boundary)
        .collect();
    let has = |mode: Mode| path.iter().any(|leg| leg.mode == mode);
    let several = Mode::ALL.into_iter().filter(|&mode| has(mode)).count() > 1;
    for mode in Mode::ALL {
        let legs = path.iter().filter(|leg| leg.mode == mode);
        layers.push(Layer::Line {
            pieces: legs.map(|leg| leg.points.clone()).collect(),
            stroke: mode.stroke(),
            legend: if several {
                mode.words().to_string()
            } else {
                String::new()
            },
        });
    }
    layers.push(Layer::Letters(marks.to_vec()));
    Plot {
        description: "Path of the body's centre, y against x".to_string(),
        x: axis("*x* (nondimensional)", Range::Auto),
        y: axis("*y* (nondimensional)", Range::Auto),
        equal_scale: true,
        layers,
        ..Plot::default()
    }
}

/// The body's rotation θ against time, with the lines ±π/2.
///
/// `horizon` is the time past which the motion cannot be trusted; the background is grey there.
pub fn rotation(theta: &[Point], horizon: Option<f64>) -> Plot {
    let mut layers = beyond(horizon);
    for (y, label) in [(FRAC_PI_2, "π/2"), (-FRAC_PI_2, "−π/2")] {
        layers.push(Layer::Horizontal {
            y,
            label: label.to_string(),
        });
    }
    layers.push(line(vec![theta.to_vec()], Stroke::default(), ""));
    let y = Axis {
        ticks: TickStyle::Angle,
        ..axis("*θ* (rad)", Range::AtLeast(-1.7, 1.7))
    };
    over_time("Rotation of the body against time", y, layers)
}

/// The normal velocity just before each snap against time, for cable 1 and cable 2.
///
/// Each point is the time of a snap and the velocity. For `horizon` see [`rotation`].
pub fn snap_velocities(cables: [&[Point]; 2], horizon: Option<f64>) -> Plot {
    let markers = |points: &[Point], shape, colour, legend: &str| Layer::Markers {
        points: points.to_vec(),
        shape,
        colour,
        legend: legend.to_string(),
    };
    let mut layers = beyond(horizon);
    layers.push(markers(cables[0], Shape::Cross, CABLE_1.colour, "cable 1"));
    layers.push(markers(cables[1], Shape::Circle, CABLE_2.colour, "cable 2"));
    let y = axis("*v*ₙ⁻ (nondimensional)", Range::AtLeast(0.0, 0.0));
    let plot = over_time("Normal velocity before each snap against time", y, layers);
    noted_if_empty(plot, "no cable snapped taut")
}

/// The tension of each cable against time: for each cable the pieces during which it was taut.
///
/// For `horizon` see [`rotation`].
pub fn tensions(cables: [&[Vec<Point>]; 2], horizon: Option<f64>) -> Plot {
    let mut layers = beyond(horizon);
    layers.push(line(cables[0].to_vec(), CABLE_1, "cable 1"));
    layers.push(line(cables[1].to_vec(), CABLE_2, "cable 2"));
    let y = axis("*T* (nondimensional)", Range::AtLeast(0.0, 0.0));
    let plot = over_time("Tension of each cable against time", y, layers);
    noted_if_empty(plot, "no cable stayed taut")
}

/// The energy against time; a snap is two points at one time. For `horizon` see [`rotation`].
pub fn energy(points: &[Point], horizon: Option<f64>) -> Plot {
    let mut layers = beyond(horizon);
    layers.push(line(vec![points.to_vec()], Stroke::default(), ""));
    over_time(
        "Energy against time",
        axis("*E* (nondimensional)", Range::Auto),
        layers,
    )
}

fn beyond(horizon: Option<f64>) -> Vec<Layer> {
    let shade = |from| Layer::Shade {
        from,
        to: f64::INFINITY,
        legend: Mode::BeyondHorizon.words().to_string(),
    };
    horizon.map(shade).into_iter().collect()
}

fn line(pieces: Vec<Vec<Point>>, stroke: Stroke, legend: &str) -> Layer {
    Layer::Line {
        pieces,
        stroke,
        legend: legend.to_string(),
    }
}

fn axis(label: &str, range: Range) -> Axis {
    Axis {
        label: label.to_string(),
        range,
        ticks: TickStyle::Decimal,
    }
}

fn over_time(description: &str, y: Axis, layers: Vec<Layer>) -> Plot {
    let x = axis("*t* (nondimensional)", Range::Auto);
    Plot {
        description: description.to_string(),
        x,
        y,
        layers,
        ..Plot::default()
    }
}

fn noted_if_empty(plot: Plot, note: &str) -> Plot {
    let note = if plot.data().next().is_none() {
        note.to_string()
    } else {
        String::new()
    };
    Plot { note, ..plot }
}
