//! The drawing of a structure: body, lines, anchors and water, to scale.

use crate::physics::model_at_rest::ModelAtRest;
use crate::structure::Outline;
use snapload_figures::{
    Axis, Colour, Dash, FigureError, Layer, Mark, Picture, Plot, Point, Range, Stroke, Width, draw,
};
use std::f64::consts::TAU;

/// Corners of the polygon that a circle is drawn as.
const CORNERS: u32 = 90;
/// The drawing extends past the outermost objects by this part of the width.
const MARGIN: f64 = 0.08;

/// The drawing extends above the still water by this part of its depth.
const AIR: f64 = 0.06;

/// The structure at rest in still water, in metres.
pub(super) fn of(prepared: &ModelAtRest) -> Result<Picture, FigureError> {
    let description = "The structure at rest: body, lines with their numbers at the anchors, still water and floor";
    let axis = |label: &str| Axis {
        label: label.to_owned(),
        ..Axis::default()
    };
    // Without this margin the still water would coincide with the frame.
    let air = AIR * prepared.structure.site.depth_m;
    let plot = Plot {
        description: description.to_owned(),
        x: axis("*x* (m)"),
        y: Axis {
            range: Range::AtLeast(-prepared.structure.site.depth_m, air),
            ..axis("*z* (m)")
        },
        equal_scale: true,
        layers: layers(prepared),
        ..Plot::default()
    };
    draw("layout", Width::Column, &[plot])
}

fn layers(prepared: &ModelAtRest) -> Vec<Layer> {
    let (structure, rest) = (&prepared.structure, &prepared.rest);
    let outline: Vec<Point> = outline(prepared);
    let outline = outline.into_iter().map(|point| placed(prepared, point));
    let outline: Vec<Point> = outline.collect();
    let spans: Vec<Vec<Point>> = spans(prepared);
    let all = || spans.iter().flatten().chain(&outline).map(|point| point[0]);
    let left = all().fold(f64::INFINITY, f64::min);
    let right = all().fold(f64::NEG_INFINITY, f64::max);
    let margin = MARGIN * (right - left);
    let level = |z: f64| vec![vec![[left - margin, z], [right + margin, z]]];
    let is_taut = |line: &usize| rest.taut.contains(line) || rest.tension_n[*line] > 0.0;
    let (taut, slack): (Vec<usize>, Vec<usize>) = (0..spans.len()).partition(is_taut);
    let drawn = |lines: &[usize]| lines.iter().map(|&line| spans[line].clone()).collect();
    let mark = |(line, span): (usize, &Vec<Point>)| Mark {
        at: span[0],
        letter: (line + 1).to_string(),
    };
    let line = |pieces: Vec<Vec<Point>>, colour: Colour, width: f64, label: &str| {
        let stroke = Stroke::new(colour, width, Dash::Solid);
        Layer::Line(pieces, stroke, label.to_owned())
    };
    let floor = level(-structure.site.depth_m);
    let mut layers = vec![
        line(level(0.0), Colour::SKY_BLUE, 1.0, "still water"),
        line(floor, Colour::BLACK, 1.5, "floor"),
        line(drawn(&taut), Colour::VERMILION, 1.0, "line"),
        line(vec![outline], Colour::BLUE, 1.2, "body"),
        Layer::Letters(spans.iter().enumerate().map(mark).collect()),
    ];
    if !slack.is_empty() {
        let stroke = Stroke::new(Colour::VERMILION, 0.7, Dash::Dashed);
        let label = "line, slack at rest".to_owned();
        layers.push(Layer::Line(drawn(&slack), stroke, label));
    }
    layers
}

/// The position at rest of a point of the unturned body, given about its centre.
fn placed(prepared: &ModelAtRest, [x, z]: Point) -> Point {
    let rest = &prepared.rest;
    let (sine, cosine) = rest.theta_rad.sin_cos();
    let [x0, z0] = rest.place_m;
    [x0 + cosine * x - sine * z, z0 + sine * x + cosine * z]
}

/// Anchor and fairlead of each line at rest.
fn spans(prepared: &ModelAtRest) -> Vec<Vec<Point>> {
    let position = prepared.structure.body.position_m;
    let lines = prepared.structure.lines.iter();
    lines
        .map(|line| {
            let [x, z] = line.fairlead_m;
            let fairlead = placed(prepared, [x - position[0], z - position[1]]);
            vec![line.anchor_m, fairlead]
        })
        .collect()
}

/// The outline about the centre of the unturned body, closed.
fn outline(prepared: &ModelAtRest) -> Vec<Point> {
    let body = &prepared.structure.body;
    let [half_width, half_height] = [body.width_m / 2.0, body.height_m / 2.0];
    match body.outline {
        Outline::Circle => {
            let angles = (0..=CORNERS).map(|k| TAU * f64::from(k) / f64::from(CORNERS));
            angles
                .map(|angle| [half_width * angle.cos(), half_width * angle.sin()])
                .collect()
        }
        Outline::Rectangle => vec![
            [-half_width, -half_height],
            [half_width, -half_height],
            [half_width, half_height],
            [-half_width, half_height],
            [-half_width, -half_height],
        ],
    }
}
