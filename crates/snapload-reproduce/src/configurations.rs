//! The chapter's drawn configurations, Figs 6.39-6.42 and 6.44, from real states.

use crate::source::{Number, decimals};
use crate::study::Study;
use snapload::{
    Case, CaseError, ModeInterval, Motion, Parameters, Playback, TautSet, Trajectory, named_case,
};
use snapload_figures::{Axis, Colour, Dash, Layer, Mark, Plot, Point, Range, Shape, Stroke};
use std::f64::consts::FRAC_PI_2;

/// A state of a run, to be drawn.
pub(crate) struct Configuration<'a> {
    pub(crate) number: &'static str,
    pub(crate) caption: String,
    pub(crate) numbers: Vec<Number>,
    pub(crate) command: String,
    run: &'a Trajectory,
    half_sizes: [f64; 2],
    motion: Motion,
    marks: Marks,
}

/// What is marked beside body and cables.
#[derive(Clone, Copy, PartialEq)]
enum Marks {
    /// The angles α of the taut cable and β of the body.
    Angles,
    /// Forces and virtual displacements.
    Forces,
    /// The wave's force.
    Wave,
    /// Rotation, and both cables' tensions.
    Rocking,
}

const BODY: Stroke = Stroke::new(Colour::BLACK, 1.1, Dash::Solid);
const TAUT: Stroke = Stroke::new(Colour::BLUE, 1.1, Dash::Solid);
const SLACK: Stroke = Stroke::new(Colour::GREY, 0.8, Dash::Dashed);
const HELP: Stroke = Stroke::new(Colour::GREY, 0.5, Dash::Dotted);
const ARROW: Stroke = Stroke::new(Colour::VERMILION, 1.0, Dash::Solid);

/// Length of an arrow per unit of force.
const PER_FORCE: f64 = 0.5;

/// The box that slides on its right cable in the run of this built-in case.
const RIGHT: &str = "1931001000-559";
/// The box that slides on its left cable under this force; it does so early, where the run can be trusted.
const LEFT: &str = "1922001000-559";
const FORCE: f64 = 0.65;

/// A box and its run: the chapter draws a box, with both half-sizes.
struct Boxed {
    case: String,
    half_sizes: [f64; 2],
    run: Trajectory,
}

impl Boxed {
    fn new(case: String, parameters: Parameters) -> Result<Self, CaseError> {
        Ok(Self {
            case,
            half_sizes: [parameters.a, parameters.b],
            run: Case::new(parameters)?.run(),
        })
    }
}

/// The runs of boxes that slide with either cable.
pub(crate) struct Slides {
    right: Boxed,
    left: Boxed,
    /// Whether a box of Table 6.1 slides on its left cable in a run of ours.
    printed: bool,
}

impl Slides {
    pub(crate) fn compute(study: &Study) -> Result<Self, CaseError> {
        let left = Parameters {
            f_o: FORCE,
            ..named_case(LEFT)?.parameters
        };
        let boxes = study.cases.iter().filter(|case| case.parameters.b > 0.0);
        let mut modes = boxes.flat_map(|case| case.runs.sliding_on.modes());
        Ok(Self {
            right: Boxed::new(RIGHT.to_owned(), named_case(RIGHT)?.parameters)?,
            left: Boxed::new(format!("{LEFT} --set f_o={FORCE}"), left)?,
            printed: modes.any(|mode| mode.taut == TautSet::only(1)),
        })
    }

    /// Figs 6.39-6.42: the longest slide of either run, and the sliding example's first, halfway.
    pub(crate) fn configurations<'a>(&'a self, study: &'a Study) -> Vec<Configuration<'a>> {
        let why = if self.printed {
            ""
        } else {
            " No box of Table 6.1 slides on its left cable in our runs, so this is a square of the table under a \
             stronger force."
        };
        let angles = "with half-sizes and the angles α and β";
        let forces = "with forces (1 is the net buoyancy) and virtual displacements";
        let right = ("Right", &self.right, 0, "");
        let left = ("Left", &self.left, 1, why);
        let mut all = Vec::new();
        for (number, (side, boxed, cable, why), marks, what) in [
            ("6.39", right, Marks::Angles, angles),
            ("6.40", left, Marks::Angles, angles),
            ("6.41", left, Marks::Forces, forces),
        ] {
            if let Some(t) = longest_slide(&boxed.run, cable) {
                let what = format!("{side} cable taut, {what}.{why}");
                let at = (&boxed.run, t);
                let sizes = boxed.half_sizes;
                all.push(Configuration::new(
                    number,
                    &what,
                    &boxed.case,
                    at,
                    sizes,
                    marks,
                ));
            }
        }
        let mut slides = study.sliding.modes().iter();
        if let Some(mode) = slides.find(|mode| mode.taut.len() == 1) {
            let at = (&study.sliding, 0.5 * (mode.t_start + mode.t_end));
            let what = "One cable taut (sliding), the wave pushing the body to its boundary.";
            let code = "sliding-example";
            all.push(Configuration::new(
                "6.42",
                what,
                code,
                at,
                [0.1, 0.0],
                Marks::Wave,
            ));
        }
        all
    }
}

/// Fig. 6.44: the rocking example at its largest rotation.
pub(crate) fn rocking(study: &Study) -> Configuration<'_> {
    let at = (&study.rocking, most_turned(&study.rocking));
    let what = "Circular body rocking, with its rotation and both tensions.";
    Configuration::new(
        "6.44",
        what,
        "rocking-example",
        at,
        [0.1, 0.0],
        Marks::Rocking,
    )
}

/// The middle of the longest slide with a cable.
fn longest_slide(run: &Trajectory, cable: usize) -> Option<f64> {
    let length = |mode: &ModeInterval| mode.t_end - mode.t_start;
    let slides = run.modes().iter();
    slides
        .filter(|mode| mode.taut == TautSet::only(cable))
        .max_by(|p, q| length(p).total_cmp(&length(q)))
        .map(|mode| 0.5 * (mode.t_start + mode.t_end))
}

fn most_turned(run: &Trajectory) -> f64 {
    let mut playback = Playback::new(run);
    let from = run.modes().last().map_or(0.0, |mode| mode.t_start);
    (0..=2000)
        .map(|k| from + (run.end().t - from) * f64::from(k) / 2000.0)
        .max_by(|s, t| {
            let turned = [*s, *t].map(|t| playback.at(t).state.theta.abs());
            turned[0].total_cmp(&turned[1])
        })
        .unwrap_or(from)
}

impl<'a> Configuration<'a> {
    fn new(
        number: &'static str,
        what: &str,
        case: &str,
        (run, t): (&'a Trajectory, f64),
        half_sizes: [f64; 2],
        marks: Marks,
    ) -> Self {
        // A time that one would write.
        let t = (1000.0 * t).round() / 1000.0;
        let motion = run.at(t);
        let command = format!("snapload run --case {case} --sample {t} --json -");
        let read = |name, value: f64, key: &str| Number {
            name,
            shown: decimals(value, 3),
            command: command.clone(),
            key: format!(".motion[1].{key}"),
        };
        let mut numbers = vec![read("θ = ", motion.state.theta, "theta")];
        for cable in motion.taut.iter() {
            let (name, key) = [("T₁ = ", "T1"), ("T₂ = ", "T2")][cable.min(1)];
            numbers.push(read(name, motion.tensions[cable], key));
        }
        Self {
            number,
            caption: format!("{what} A state of a real run, at t = {t}:"),
            numbers,
            command,
            run,
            half_sizes,
            motion,
            marks,
        }
    }

    /// Draws it.
    pub(crate) fn plot(&self) -> Plot {
        let mut layers = Vec::new();
        if self.marks == Marks::Angles {
            // Under the lines that they name.
            self.add_sizes(&mut layers);
        }
        layers.push(ink(vec![self.outline()], BODY, "body"));
        let mut letters = vec![Mark::new("c", self.centre())];
        let system = self.run.system();
        for cable in 0..2 {
            let (anchor, fairlead) = (system.cables[cable].anchor(), self.fairlead(cable));
            let name = format!("cable {}", cable + 1);
            layers.push(if self.motion.taut.contains(cable) {
                ink(vec![vec![anchor, fairlead]], TAUT, &format!("{name}, taut"))
            } else {
                let sag = sagging(anchor, fairlead, system.cables[cable].length());
                ink(vec![sag], SLACK, &format!("{name}, slack"))
            });
            let (shape, colour) = (Shape::Cross, Colour::BLACK);
            layers.push(Layer::Markers(vec![anchor], shape, colour, String::new()));
            letters.push(Mark::new(["V", "W"][cable], fairlead));
        }
        self.add_marks(&mut layers);
        layers.push(Layer::Letters(letters));
        Plot {
            description: self.caption.clone(),
            x: Axis::new("*x* (nondimensional)", Range::Auto),
            y: Axis::new("*y* (nondimensional)", Range::Auto),
            equal_scale: true,
            layers,
            ..Plot::default()
        }
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

    fn fairlead(&self, cable: usize) -> Point {
        self.placed(self.run.system().cables[cable].fairlead())
    }

    fn outline(&self) -> Vec<Point> {
        let [a, b] = self.half_sizes;
        if b > 0.0 {
            let corners = [[a, b], [-a, b], [-a, -b], [a, -b], [a, b]];
            return corners.map(|corner| self.placed(corner)).to_vec();
        }
        let turn = |k: i32| f64::from(k) * std::f64::consts::TAU / 72.0;
        (0..=72)
            .map(|k| self.placed([a * turn(k).cos(), a * turn(k).sin()]))
            .collect()
    }

    fn add_marks(&self, layers: &mut Vec<Layer>) {
        let constant = self.run.system().forcing.constant[1] * PER_FORCE;
        let [fx, fy] = self.run.system().forcing.at(self.motion.t);
        let wave = [fx * PER_FORCE, fy * PER_FORCE - constant];
        let centre = self.centre();
        let arrows = match self.marks {
            Marks::Angles => {
                self.add_angles(layers);
                Vec::new()
            }
            Marks::Forces => vec![
                ("*fx*", centre, [wave[0], 0.0]),
                ("*fy*", centre, [0.0, wave[1]]),
                ("1", centre, [0.0, constant]),
                self.tension(self.taut()),
                // Beside the body, where there is room.
                ("*δx*", [-0.8, 0.0], [0.2, 0.0]),
                ("*δy*", [-0.8, 0.0], [0.0, 0.2]),
            ],
            Marks::Wave => vec![("*f*", centre, wave)],
            Marks::Rocking => {
                self.add_rotation(layers);
                let cables = self.motion.taut.iter();
                cables.map(|cable| self.tension(cable)).collect()
            }
        };
        for (name, from, by) in arrows {
            let shaft = vec![from, [from[0] + by[0], from[1] + by[1]]];
            layers.push(named(shaft, name));
            layers.push(ink(vec![headed(from, by)], ARROW, ""));
        }
    }

    /// The taut cable, or the first of two.
    fn taut(&self) -> usize {
        self.motion.taut.iter().next().unwrap_or(0)
    }

    fn tension(&self, cable: usize) -> (&'static str, Point, Point) {
        let system = self.run.system();
        let (anchor, fairlead) = (system.cables[cable].anchor(), self.fairlead(cable));
        let pull = self.motion.tensions[cable] * PER_FORCE / system.cables[cable].length();
        let by = [0, 1].map(|i| (anchor[i] - fairlead[i]) * pull);
        (["*T*₁", "*T*₂"][cable.min(1)], fairlead, by)
    }

    /// α, from the vertical at the anchor to the cable; β, from the vertical at the fairlead to the body.
    fn add_angles(&self, layers: &mut Vec<Layer>) {
        let cable = self.taut();
        let anchor = self.run.system().cables[cable].anchor();
        let fairlead = self.fairlead(cable);
        // The chapter's angles open to the inside: to the right of the left cable's vertical.
        let side = if cable == 1 { 1.0 } else { -1.0 };
        let span = [fairlead[0] - anchor[0], fairlead[1] - anchor[1]];
        let alpha = (side * span[0]).atan2(-span[1]);
        let beta = FRAC_PI_2 + side * self.motion.state.theta;
        for (name, at, angle, radius) in
            [("*α*", anchor, alpha, 0.45), ("*β*", fairlead, beta, 0.2)]
        {
            let down = [at[0], at[1] - 1.5 * radius];
            let turn = |part: f64| side * angle * part - FRAC_PI_2;
            layers.push(ink(vec![vec![at, down]], HELP, ""));
            layers.push(named(arc(at, radius, turn), name));
        }
    }

    /// r, a and b along the lines that have these lengths.
    fn add_sizes(&self, layers: &mut Vec<Layer>) {
        let [_, b] = self.half_sizes;
        let cable = self.taut();
        let fairlead = self.fairlead(cable);
        let anchor = self.run.system().cables[cable].anchor();
        let top = self.placed([0.0, b]);
        // Each names its line in the middle or away from the fairlead, where V or W and β stand.
        let part = |from: Point, to: Point, [p, q]: [f64; 2]| {
            let at = |s: f64| [0, 1].map(|i| from[i] + s * (to[i] - from[i]));
            vec![at(p), at(q)]
        };
        layers.push(named(part(anchor, fairlead, [0.45, 0.55]), "*r*"));
        layers.push(named(part(top, fairlead, [0.0, 0.4]), "*a*"));
        if b > 0.0 {
            layers.push(named(vec![self.centre(), top], "*b*"));
        }
    }

    /// θ, from the horizontal at the centre to the line between the fairleads.
    fn add_rotation(&self, layers: &mut Vec<Layer>) {
        let centre = self.centre();
        let theta = self.motion.state.theta;
        let level = vec![centre, [centre[0] + 0.45, centre[1]]];
        let line = vec![centre, self.placed([0.45, 0.0])];
        layers.push(ink(vec![level, line], HELP, ""));
        layers.push(named(arc(centre, 0.35, |part| theta * part), "*θ*"));
    }
}

/// An arc of a circle, by the direction at each part of it.
fn arc(centre: Point, radius: f64, direction: impl Fn(f64) -> f64) -> Vec<Point> {
    let point = |k: i32| {
        let (sine, cosine) = direction(f64::from(k) / 24.0).sin_cos();
        [centre[0] + radius * cosine, centre[1] + radius * sine]
    };
    (0..=24).map(point).collect()
}

/// A thin line with its name beside it.
fn named(points: Vec<Point>, name: &str) -> Layer {
    Layer::Boundary(points, name.to_owned())
}

fn ink(pieces: Vec<Vec<Point>>, stroke: Stroke, legend: &str) -> Layer {
    Layer::Line(pieces, stroke, legend.to_owned())
}

/// An arrow in one stroke: shaft, then both sides of the head.
fn headed(from: Point, by: Point) -> Vec<Point> {
    let tip = [from[0] + by[0], from[1] + by[1]];
    let barb = |side: f64| {
        let [u, v] = [-by[0], -by[1]];
        let size = 0.05 / u.hypot(v).max(0.05);
        [
            tip[0] + size * (u - 0.5 * side * v),
            tip[1] + size * (v + 0.5 * side * u),
        ]
    };
    vec![from, tip, barb(1.0), tip, barb(-1.0)]
}

/// A slack line of the given length between two points, as a parabola that hangs towards −y.
fn sagging(from: Point, to: Point, length: f64) -> Vec<Point> {
    let chord = (to[0] - from[0]).hypot(to[1] - from[1]);
    // Length of a shallow parabola: chord + 8 sag² / (3 chord).
    let sag = (0.375 * chord * (length - chord).max(0.0)).sqrt();
    (0..=30)
        .map(|k| {
            let part = f64::from(k) / 30.0;
            let hang = 4.0 * sag * part * (1.0 - part);
            [
                from[0] + (to[0] - from[0]) * part,
                from[1] + (to[1] - from[1]) * part - hang,
            ]
        })
        .collect()
}
