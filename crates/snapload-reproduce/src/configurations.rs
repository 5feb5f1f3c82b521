//! The chapter's drawn configurations, Figs 6.39-6.42 and 6.44, from real states.

use crate::study::Study;
use snapload::{ModeInterval, Motion, Playback, System, TautSet, Trajectory};
use snapload_figures::{Axis, Colour, Dash, Layer, Mark, Plot, Point, Range, Shape, Stroke};

/// A state of a run, to be drawn.
pub(crate) struct Configuration<'a> {
    pub(crate) number: &'static str,
    pub(crate) caption: String,
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
    /// Both cables' tensions.
    Tensions,
}

const BODY: Stroke = line(Colour::Black, 1.1, Dash::Solid);
const TAUT: Stroke = line(Colour::Blue, 1.1, Dash::Solid);
const SLACK: Stroke = line(Colour::Grey, 0.8, Dash::Dashed);
const HELP: Stroke = line(Colour::Grey, 0.5, Dash::Dotted);
const ARROW: Stroke = line(Colour::Vermilion, 1.0, Dash::Solid);

const fn line(colour: Colour, width_pt: f64, dash: Dash) -> Stroke {
    Stroke {
        colour,
        width_pt,
        dash,
    }
}

/// Length of an arrow per unit of force.
const PER_FORCE: f64 = 0.5;

/// The states that are drawn: the longest sliding with either cable among the cases of Table 6.1 as
/// printed, the sliding example's first slide, and the rocking example at its largest rotation.
pub(crate) fn configurations(study: &Study) -> Vec<Configuration<'_>> {
    let mut all = Vec::new();
    for (number, cable, marks, what) in [
        (
            "6.39",
            0,
            Marks::Angles,
            "Right cable taut, with the angles α and β",
        ),
        (
            "6.40",
            1,
            Marks::Angles,
            "Left cable taut, with the angles α and β",
        ),
        (
            "6.41",
            1,
            Marks::Forces,
            "Left cable taut, with forces and virtual displacements",
        ),
    ] {
        if let Some((code, size, run, t)) = longest_slide(study, cable) {
            all.push(Configuration::new(
                number,
                what,
                code,
                (run, t),
                size,
                marks,
            ));
        }
    }
    let first = study
        .sliding
        .modes()
        .iter()
        .find(|mode| mode.taut.len() == 1);
    if let Some(mode) = first {
        let t = 0.5 * (mode.t_start + mode.t_end);
        let what = "One cable taut, the wave pushing the body to its boundary";
        let at = (&study.sliding, t);
        all.push(Configuration::new(
            "6.42",
            what,
            "sliding-example",
            at,
            [0.1, 0.0],
            Marks::Wave,
        ));
    }
    let t = most_turned(&study.rocking);
    let what = "Circular body rocking, with both tensions";
    let at = (&study.rocking, t);
    all.push(Configuration::new(
        "6.44",
        what,
        "rocking-example",
        at,
        [0.1, 0.0],
        Marks::Tensions,
    ));
    all
}

fn longest_slide(
    study: &Study,
    cable: usize,
) -> Option<(&'static str, [f64; 2], &Trajectory, f64)> {
    let cases = study.cases.iter().map(|case| {
        let size = [case.parameters.a, case.parameters.b];
        (case.code, size, &case.runs.sliding_on)
    });
    let examples = [("sliding-example", [0.1, 0.0], &study.sliding)];
    let slides = cases.chain(examples).flat_map(|(code, size, run)| {
        let of_cable = move |mode: &&ModeInterval| mode.taut == TautSet::only(cable);
        let modes = run.modes().iter().filter(of_cable);
        modes.map(move |mode| (code, size, run, mode))
    });
    // Boxes first: they show both half-sizes.
    let (code, size, run, mode) = slides.max_by(|p, q| {
        let rank = |(_, size, _, mode): &(&str, [f64; 2], &Trajectory, &ModeInterval)| {
            (size[1] > 0.0, mode.t_end - mode.t_start)
        };
        let (p, q) = (rank(p), rank(q));
        p.0.cmp(&q.0).then(p.1.total_cmp(&q.1))
    })?;
    Some((code, size, run, 0.5 * (mode.t_start + mode.t_end)))
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
        code: &str,
        (run, t): (&'a Trajectory, f64),
        half_sizes: [f64; 2],
        marks: Marks,
    ) -> Self {
        let motion = run.at(t);
        let tensions: Vec<String> = motion
            .taut
            .iter()
            .map(|cable| format!("T{} = {:.3}", cable + 1, motion.tensions[cable]))
            .collect();
        Self {
            number,
            caption: format!(
                "{what}: {code} at t = {t:.3}, θ = {:.3}, {}.",
                motion.state.theta,
                tensions.join(", ")
            ),
            command: format!("snapload run --case {code} --sample {t} --json -"),
            run,
            half_sizes,
            motion,
            marks,
        }
    }

    /// Draws it.
    pub(crate) fn plot(&self) -> Plot {
        let mut layers = vec![ink(vec![self.outline()], BODY, "body")];
        let mut letters = vec![mark("c", self.centre())];
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
            layers.push(Layer::Markers {
                points: vec![anchor],
                shape: Shape::Cross,
                colour: Colour::Black,
                legend: String::new(),
            });
            letters.push(mark(["V", "W"][cable], fairlead));
        }
        self.add_marks(&mut layers, &mut letters);
        layers.push(Layer::Letters(letters));
        let axis = |label: &str| Axis {
            label: label.to_owned(),
            range: Range::Auto,
            ..Axis::default()
        };
        Plot {
            description: self.caption.clone(),
            x: axis("*x* (nondimensional)"),
            y: axis("*y* (nondimensional)"),
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

    fn add_marks(&self, layers: &mut Vec<Layer>, letters: &mut Vec<Mark>) {
        let system = self.run.system();
        let taut = self.motion.taut.iter().next().unwrap_or(0);
        let mut arrows = Vec::new();
        let mut arrow = |letter: &str, from: Point, by: Point| {
            arrows.push(headed(from, by));
            letters.push(mark(letter, [from[0] + by[0], from[1] + by[1]]));
        };
        let force = system.forcing.at(self.motion.t).map(|f| f * PER_FORCE);
        match self.marks {
            Marks::Angles => self.add_angles(taut, layers, letters),
            Marks::Forces => {
                let weight = system.forcing.constant[1] * PER_FORCE;
                arrow("fₓ", self.centre(), [force[0], 0.0]);
                arrow("f_y", self.centre(), [0.0, force[1] - weight]);
                arrow("1", self.centre(), [0.0, weight]);
                self.add_tension(taut, &mut arrow);
                // Beside the body, where there is room.
                arrow("δx", [-0.8, 0.0], [0.2, 0.0]);
                arrow("δy", [-0.8, 0.0], [0.0, 0.2]);
            }
            Marks::Wave => {
                let weight = system.forcing.constant[1] * PER_FORCE;
                arrow("f", self.centre(), [force[0], force[1] - weight]);
            }
            Marks::Tensions => {
                for cable in self.motion.taut.iter() {
                    self.add_tension(cable, &mut arrow);
                }
            }
        }
        if !arrows.is_empty() {
            layers.push(ink(arrows, ARROW, ""));
        }
    }

    fn add_tension(&self, cable: usize, arrow: &mut impl FnMut(&str, Point, Point)) {
        let system = self.run.system();
        let (anchor, fairlead) = (system.cables[cable].anchor(), self.fairlead(cable));
        let pull = self.motion.tensions[cable] * PER_FORCE / system.cables[cable].length();
        let by = [0, 1].map(|i| (anchor[i] - fairlead[i]) * pull);
        arrow(["T₁", "T₂"][cable.min(1)], fairlead, by);
    }

    /// α, from the vertical at the anchor to the cable; β, from the vertical at the fairlead to the body.
    fn add_angles(&self, cable: usize, layers: &mut Vec<Layer>, letters: &mut Vec<Mark>) {
        let system: &System = self.run.system();
        let (anchor, fairlead) = (system.cables[cable].anchor(), self.fairlead(cable));
        // The chapter's angles open to the inside: to the right of the left cable's vertical.
        let side = if cable == 1 { 1.0 } else { -1.0 };
        let span = [fairlead[0] - anchor[0], fairlead[1] - anchor[1]];
        let alpha = (side * span[0]).atan2(-span[1]);
        let beta = std::f64::consts::FRAC_PI_2 + side * self.motion.state.theta;
        for (letter, at, angle, radius) in [("α", anchor, alpha, 0.35), ("β", fairlead, beta, 0.22)]
        {
            let down = [at[0], at[1] - 1.3 * radius];
            let on_arc = |part: f64| {
                let (sine, cosine) = (angle * part).sin_cos();
                [at[0] + side * radius * sine, at[1] - radius * cosine]
            };
            let arc = (0..=24).map(|k| on_arc(f64::from(k) / 24.0)).collect();
            layers.push(ink(vec![vec![at, down], arc], HELP, ""));
            letters.push(mark(letter, on_arc(0.5)));
        }
    }
}

fn ink(pieces: Vec<Vec<Point>>, stroke: Stroke, legend: &str) -> Layer {
    Layer::Line {
        pieces,
        stroke,
        legend: legend.to_owned(),
    }
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

fn mark(letter: &str, at: Point) -> Mark {
    Mark {
        at,
        letter: letter.to_owned(),
    }
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
