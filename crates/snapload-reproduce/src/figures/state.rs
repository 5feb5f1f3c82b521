//! The chapter's drawings of configurations, Figs 6.39-6.42 and 6.44, from computed states.

use super::{About, Source};
use crate::ReportError;
use crate::source::Number;
use crate::study::{Known, Study};
use serde::Deserialize;
use snapload::{ModeInterval, Motion, Playback, System, TautSet, Trajectory, Vector2, named_case};
use snapload_figures::{Axis, Colour, Dash, Layer, Mark, Plot, Point, Range, Shape, Stroke};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A state of the run of a built-in case.
#[derive(Deserialize)]
pub(super) struct StateFigure {
    case: String,
    /// A force amplitude other than the case's own.
    f_o: Option<f64>,
    at: Instant,
    marks: Marks,
    /// Its caption.
    what: String,
    /// Whether the case is used in place of a box of Table 6.1, because none of them may slide with
    /// this cable taut.
    #[serde(default, rename = "stands_in")]
    is_substitute: bool,
}

/// The time in the run that is drawn.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Instant {
    /// Halfway through the longest slide with this cable taut.
    LongestSlide(usize),
    /// Halfway through the first slide.
    FirstSlide,
    /// At the largest rotation of the last mode.
    LargestRotation,
}

/// The marks beside body and cables.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Marks {
    /// The angles α of the taut cable and β of the body, and the sizes.
    Angles,
    /// Forces and virtual displacements.
    Forces,
    /// The wave's force.
    Wave,
    /// Rotation, and both cables' tensions.
    Rocking,
}

impl Instant {
    fn of(self, run: &Trajectory) -> Option<f64> {
        let length = |mode: &&ModeInterval| mode.t_end - mode.t_start;
        let mut modes = run.modes().iter();
        let slide = match self {
            Self::LongestSlide(cable) => modes
                .filter(|mode| mode.taut == TautSet::only(cable))
                .max_by(|p, q| length(p).total_cmp(&length(q))),
            Self::FirstSlide => modes.find(|mode| mode.taut.len() == 1),
            Self::LargestRotation => return most_turned(run),
        };
        slide.map(|mode| 0.5 * (mode.t_start + mode.t_end))
    }
}

fn most_turned(run: &Trajectory) -> Option<f64> {
    let mut playback = Playback::new(run);
    let from = run.modes().last().map_or(0.0, |mode| mode.t_start);
    let turned = (0..=2000).map(|k| {
        let t = from + (run.end().t - from) * f64::from(k) / 2000.0;
        (t, playback.at(t).state.theta.abs())
    });
    turned.max_by(|p, q| p.1.total_cmp(&q.1)).map(|(t, _)| t)
}

impl StateFigure {
    pub(super) fn draw(&self, study: &Study) -> Result<(Plot, About), ReportError> {
        let mut parameters = named_case(&self.case)?.parameters;
        let mut case = self.case.clone();
        if let Some(f_o) = self.f_o {
            parameters.f_o = f_o;
            case += &format!(" --set f_o={f_o}");
        }
        let known = Known::new(parameters)?;
        let run = &known.run;
        let t = self.at.of(run);
        let t = t.ok_or_else(|| ReportError::Missing(format!("a slide in the run of {case}")))?;
        // The time is rounded to a readable number.
        let t = (1000.0 * t).round() / 1000.0;
        let drawing = Drawing {
            system: run.system(),
            half_sizes: [parameters.a, parameters.b],
            motion: run.at(t),
        };
        let command = format!("snapload run --case {case} --sample {t} --json -");
        let number = |name, value: f64, key: &str| {
            let number = Number::new(value, 3, &command, format!(".motion[1].{key}"));
            let known = known.is_known_at(t);
            (
                name,
                if known {
                    number
                } else {
                    number.mark_past_horizon()
                },
            )
        };
        let motion = &drawing.motion;
        let mut numbers = vec![number("θ = ", motion.state.theta, "theta")];
        numbers.extend(motion.taut.iter().map(|cable| {
            let (name, key) = [("T₁ = ", "T1"), ("T₂ = ", "T2")][cable.min(1)];
            number(name, motion.tensions[cable], key)
        }));
        let why = if self.is_substitute && !self.is_in_table(study) {
            " No box of Table 6.1 slides with its left cable taut in our runs, so this is a square of the table under \
             a stronger force."
        } else {
            ""
        };
        let caption = format!("{}{why} A computed state, at t = {t}:", self.what);
        let plot = Plot {
            description: caption.clone(),
            x: Axis::new("*x* (L)", Range::Auto),
            y: Axis::new("*y* (L)", Range::Auto),
            equal_scale: true,
            layers: drawing.layers(self.marks),
            ..Plot::default()
        };
        let sources = Source::whole(command.clone(), ".motion[1]");
        let about = About {
            caption,
            numbers,
            sources,
        };
        Ok((plot, about))
    }

    /// Whether a box of Table 6.1 slides like this in one of our runs.
    fn is_in_table(&self, study: &Study) -> bool {
        let boxes = study.cases.iter().filter(|case| case.parameters.b > 0.0);
        let mut modes = boxes.flat_map(|case| case.runs.sliding_on.run.modes());
        modes.any(|mode| matches!(self.at, Instant::LongestSlide(cable) if mode.taut == TautSet::only(cable)))
    }
}

const BODY: Stroke = Stroke::new(Colour::BLACK, 1.1, Dash::Solid);
const TAUT: Stroke = Stroke::new(Colour::BLUE, 1.1, Dash::Solid);
const SLACK: Stroke = Stroke::new(Colour::BLACK, 0.6, Dash::Dashed);
const AUXILIARY: Stroke = Stroke::new(Colour::BLACK, 0.4, Dash::Dotted);
const ARROW: Stroke = Stroke::new(Colour::VERMILION, 1.0, Dash::Solid);

/// Length of an arrow per unit of force.
const PER_FORCE: f64 = 0.5;

/// The drawing of body and cables.
struct Drawing<'a> {
    system: &'a System,
    half_sizes: [f64; 2],
    motion: Motion,
}

impl Drawing<'_> {
    fn layers(&self, marks: Marks) -> Vec<Layer> {
        let mut layers = Vec::new();
        if marks == Marks::Angles {
            // Drawn below the lines that they name.
            layers.extend(self.sizes());
        }
        layers.push(plain_line(vec![self.outline()], BODY, "body"));
        let mut letters = vec![Mark::new("c", self.centre())];
        for (cable, letter) in ["V", "W"].into_iter().enumerate() {
            let (anchor, fairlead) = self.ends(cable);
            let (points, stroke, state) = if self.motion.taut.contains(cable) {
                (vec![anchor, fairlead], TAUT, "taut")
            } else {
                let length = self.system.cables[cable].length();
                (sagging(anchor, fairlead, length), SLACK, "slack")
            };
            let legend = format!("cable {}, {state}", cable + 1);
            layers.push(plain_line(vec![points], stroke, &legend));
            let (shape, colour) = (Shape::Cross, Colour::BLACK);
            layers.push(Layer::Markers(vec![anchor], shape, colour, String::new()));
            letters.push(Mark::new(letter, fairlead));
        }
        if marks == Marks::Angles {
            layers.extend(self.angles());
        }
        if marks == Marks::Rocking {
            layers.extend(self.rotation());
        }
        for (name, from, by) in self.arrows(marks) {
            layers.push(labelled_line(vec![from, plus(from, by, 1.0)], name));
            layers.push(plain_line(vec![headed(from, by)], ARROW, ""));
        }
        layers.push(Layer::Letters(letters));
        layers
    }

    fn centre(&self) -> Point {
        [self.motion.state.x, self.motion.state.y]
    }

    /// A point of the body's frame.
    fn placed(&self, [u, v]: Point) -> Point {
        let (sine, cosine) = self.motion.state.theta.sin_cos();
        let [x, y] = self.centre();
        [x + u * cosine - v * sine, y + u * sine + v * cosine]
    }

    /// Anchor and fairlead of a cable.
    fn ends(&self, cable: usize) -> (Point, Point) {
        let cable = &self.system.cables[cable];
        let [anchor, fairlead] = [cable.anchor(), cable.fairlead()].map(Vector2::components);
        (anchor, self.placed(fairlead))
    }

    /// The taut cable, or the first of two.
    fn taut(&self) -> usize {
        self.motion.taut.iter().next().unwrap_or(0)
    }

    fn outline(&self) -> Vec<Point> {
        let [a, b] = self.half_sizes;
        if b > 0.0 {
            let corners = [[a, b], [-a, b], [-a, -b], [a, -b], [a, b]];
            return corners.map(|corner| self.placed(corner)).to_vec();
        }
        let turn = |k: f64| k * TAU / 72.0;
        trace(72, |k| self.placed([a * turn(k).cos(), a * turn(k).sin()]))
    }

    /// Forces and displacements: name, origin, and vector.
    fn arrows(&self, marks: Marks) -> Vec<(&'static str, Point, Point)> {
        let forcing = &self.system.forcing;
        let constant = forcing.constant.y * PER_FORCE;
        let [fx, fy] = forcing.at(self.motion.t).components();
        let [fx, fy] = [fx * PER_FORCE, fy * PER_FORCE - constant];
        let centre = self.centre();
        let tension = |cable: usize| {
            let (anchor, fairlead) = self.ends(cable);
            let pull = self.motion.tensions[cable] * PER_FORCE / self.system.cables[cable].length();
            let by = [0, 1].map(|i| (anchor[i] - fairlead[i]) * pull);
            (["*T*₁", "*T*₂"][cable.min(1)], fairlead, by)
        };
        match marks {
            Marks::Angles => Vec::new(),
            Marks::Forces => vec![
                ("*fx*", centre, [fx, 0.0]),
                ("*fy*", centre, [0.0, fy]),
                ("1", centre, [0.0, constant]),
                tension(self.taut()),
                // Beside the body, where there is room.
                ("*δx*", [-0.8, 0.0], [0.2, 0.0]),
                ("*δy*", [-0.8, 0.0], [0.0, 0.2]),
            ],
            Marks::Wave => vec![("*f*", centre, [fx, fy])],
            Marks::Rocking => self.motion.taut.iter().map(tension).collect(),
        }
    }

    /// α, from the vertical at the anchor to the cable; β, from the vertical at the fairlead to the
    /// body.
    fn angles(&self) -> Vec<Layer> {
        let cable = self.taut();
        let (anchor, fairlead) = self.ends(cable);
        // The chapter's angles open to the inside: to the right of the left cable's vertical.
        let side = if cable == 1 { 1.0 } else { -1.0 };
        let alpha = (side * (fairlead[0] - anchor[0])).atan2(-(fairlead[1] - anchor[1]));
        let beta = FRAC_PI_2 + side * self.motion.state.theta;
        let angle = |(name, at, angle, radius): (&str, Point, f64, f64)| {
            let down = [at[0], at[1] - 1.5 * radius];
            let direction = |part: f64| side * angle * part - FRAC_PI_2;
            let arc = labelled_line(arc(at, radius, direction), name);
            [plain_line(vec![vec![at, down]], AUXILIARY, ""), arc]
        };
        let angles = [("*α*", anchor, alpha, 0.45), ("*β*", fairlead, beta, 0.2)];
        angles.into_iter().flat_map(angle).collect()
    }

    /// r, a and b beside the lines that have these lengths.
    fn sizes(&self) -> Vec<Layer> {
        let [_, b] = self.half_sizes;
        let (anchor, fairlead) = self.ends(self.taut());
        let top = self.placed([0.0, b]);
        // Each name is at the middle of its line or away from the fairlead, where V or W and β are.
        let part = |from: Point, to: Point, [p, q]: [f64; 2]| {
            let by = [to[0] - from[0], to[1] - from[1]];
            vec![plus(from, by, p), plus(from, by, q)]
        };
        let mut sizes = vec![
            labelled_line(part(anchor, fairlead, [0.45, 0.55]), "*r*"),
            labelled_line(part(top, fairlead, [0.0, 0.4]), "*a*"),
        ];
        if b > 0.0 {
            sizes.push(labelled_line(vec![self.centre(), top], "*b*"));
        }
        sizes
    }

    /// θ, from the horizontal at the centre to the line between the fairleads.
    fn rotation(&self) -> [Layer; 2] {
        let (centre, theta) = (self.centre(), self.motion.state.theta);
        let level = vec![centre, [centre[0] + 0.45, centre[1]]];
        let line = vec![centre, self.placed([0.45, 0.0])];
        let arc = arc(centre, 0.35, |part| theta * part);
        [
            plain_line(vec![level, line], AUXILIARY, ""),
            labelled_line(arc, "*θ*"),
        ]
    }
}

fn plus(from: Point, by: Point, part: f64) -> Point {
    [from[0] + part * by[0], from[1] + part * by[1]]
}

/// The points of a curve that is divided into some pieces.
fn trace(pieces: i32, point: impl Fn(f64) -> Point) -> Vec<Point> {
    (0..=pieces).map(f64::from).map(point).collect()
}

/// An arc of a circle, from the direction at each part of it.
fn arc(centre: Point, radius: f64, direction: impl Fn(f64) -> f64) -> Vec<Point> {
    trace(24, |k| {
        let (sine, cosine) = direction(k / 24.0).sin_cos();
        plus(centre, [cosine, sine], radius)
    })
}

/// A thin line with its name beside it.
fn labelled_line(points: Vec<Point>, name: &str) -> Layer {
    Layer::Boundary(points, name.to_owned())
}

fn plain_line(pieces: Vec<Vec<Point>>, stroke: Stroke, legend: &str) -> Layer {
    Layer::Line(pieces, stroke, legend.to_owned())
}

/// An arrow in one stroke: shaft, then both sides of the head.
fn headed(from: Point, by: Point) -> Vec<Point> {
    let tip = plus(from, by, 1.0);
    let barb = |side: f64| {
        let [u, v] = [-by[0], -by[1]];
        let size = 0.05 / u.hypot(v).max(0.05);
        plus(tip, [u - 0.5 * side * v, v + 0.5 * side * u], size)
    };
    vec![from, tip, barb(1.0), tip, barb(-1.0)]
}

/// A slack line of the given length between two points, as a parabola that hangs towards −y.
fn sagging(from: Point, to: Point, length: f64) -> Vec<Point> {
    let by = [to[0] - from[0], to[1] - from[1]];
    let span = by[0].hypot(by[1]);
    // Length of a shallow parabola: span + 8 sag² / (3 span).
    let sag = (0.375 * span * (length - span).max(0.0)).sqrt();
    trace(30, |k| {
        let part = k / 30.0;
        let [x, y] = plus(from, by, part);
        [x, y - 4.0 * sag * part * (1.0 - part)]
    })
}
