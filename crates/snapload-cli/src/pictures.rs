//! The pictures of a run: what of the motion goes into which, and the files they become.
use crate::failure::Failure;
use snapload::{Case, Motion, Playback, TautSet, Trajectory};
use snapload_figures as figures;
use snapload_figures::{Leg, Mark, Mode, Plot, Point, Range, Width, draw};

/// A picture, ready to be written.
pub(crate) struct Picture {
    /// File name with its ending, such as `trajectory.svg`.
    pub(crate) name: String,
    /// Contents.
    pub(crate) bytes: Vec<u8>,
}

/// Pixels per point of the PNGs: 300 dpi, what journals ask of a line drawing in a raster format.
const PNG_SCALE: f32 = 300.0 / 72.0;
/// Longest step of time between two drawn points, where a run has no more than [`MOST_STEPS`] of them.
const STEP: f64 = 0.01;
const MOST_STEPS: f64 = 20_000.0;

/// Draws the pictures of a run; `title` is the code or the file name of the case.
pub(crate) fn pictures(
    title: &str,
    case: &Case,
    trajectory: &Trajectory,
) -> Result<Vec<Picture>, Failure> {
    let drawn = Drawn::new(trajectory);
    let plots = [
        ("trajectory", path(case, trajectory, &drawn)),
        (
            "rotation",
            figures::rotation(&drawn.points(|m| [m.t, m.state.theta]), None),
        ),
        ("snaps", snaps(trajectory)),
        ("tensions", tensions(&drawn)),
        (
            "energy",
            figures::energy(&drawn.points(|m| [m.t, m.energy]), None),
        ),
    ];
    let mut files = Vec::new();
    for (name, plot) in plots {
        let mut plot = Plot {
            title: title.to_owned(),
            ..plot
        };
        if name != "trajectory" {
            plot.x.range = Range::AtLeast(0.0, trajectory.end().t);
        }
        let picture = draw(name, Width::Page, &[plot]).map_err(|error| broken(name, &error))?;
        let png = picture
            .png(PNG_SCALE)
            .map_err(|error| broken(name, &error))?;
        files.push(Picture {
            name: format!("{name}.svg"),
            bytes: picture.svg().as_bytes().to_vec(),
        });
        files.push(Picture {
            name: format!("{name}.png"),
            bytes: png,
        });
    }
    Ok(files)
}

fn broken(name: &str, error: &figures::FigureError) -> Failure {
    Failure::Failed(format!("the picture {name} can not be drawn: {error}"))
}

/// A stretch of motion between two events, at the times at which it is drawn: its last one is just
/// before the event at its end.
struct Stretch {
    taut: TautSet,
    motion: Vec<Motion>,
}

impl Stretch {
    fn points(&self, of: impl Fn(&Motion) -> Point) -> impl Iterator<Item = Point> {
        self.motion.iter().map(of)
    }
}

/// The run as it is drawn.
struct Drawn {
    stretches: Vec<Stretch>,
}

impl Drawn {
    fn new(trajectory: &Trajectory) -> Self {
        let mut playback = Playback::new(trajectory);
        let end = trajectory.end().t;
        let mut events: Vec<f64> = trajectory.impacts().iter().map(|i| i.t).collect();
        events.extend(trajectory.modes().iter().map(|mode| mode.t_start));
        events.push(end);
        events.sort_by(f64::total_cmp);
        events.dedup();
        let step = STEP.max(end / MOST_STEPS);
        let stretches = events
            .windows(2)
            .map(|pair| {
                let (from, to) = (pair[0], pair[1]);
                let pieces = ((to - from) / step).ceil().max(1.0) as usize;
                let inner = (0..pieces).map(|k| from + (to - from) * k as f64 / pieces as f64);
                let motion: Vec<Motion> = inner
                    .chain([to.next_down()])
                    .map(|t| playback.at(t))
                    .collect();
                Stretch {
                    taut: motion[0].taut,
                    motion,
                }
            })
            .collect();
        Self { stretches }
    }

    fn points(&self, of: impl Fn(&Motion) -> Point) -> Vec<Point> {
        self.stretches
            .iter()
            .flat_map(|stretch| stretch.points(&of))
            .collect()
    }
}

fn path(case: &Case, trajectory: &Trajectory, drawn: &Drawn) -> Plot {
    let mut legs: Vec<Leg> = Vec::new();
    for stretch in &drawn.stretches {
        let mode = match stretch.taut.len() {
            0 => Mode::Slack,
            1 => Mode::Sliding,
            _ => Mode::Rocking,
        };
        let points = stretch.points(place);
        match legs.last_mut() {
            Some(leg) if leg.mode == mode => leg.points.extend(points),
            _ => legs.push(Leg {
                mode,
                points: points.collect(),
            }),
        }
    }
    let highest = trajectory.norms().y_max;
    let boundaries = [0, 1].map(|cable| boundary(case, cable, highest));
    let marks = marks(trajectory);
    figures::trajectory(&legs, [&boundaries[0], &boundaries[1]], &marks)
}

/// Where the centre is when a cable is taut with the body upright, from the lowest place of the region
/// up to a little above the path.
fn boundary(case: &Case, cable: usize, highest: f64) -> Vec<Point> {
    const POINTS: u32 = 200;
    let simulation = case.simulation();
    let Some(tether) = simulation.system().cables.get(cable) else {
        return Vec::new();
    };
    let (anchor, fairlead) = (tether.anchor(), tether.fairlead());
    let centre = [anchor[0] - fairlead[0], anchor[1] - fairlead[1]];
    // The arc on the far side of the anchor, which passes through x = y = 0.
    let outward = match centre[0] {
        x if x > 0.0 => -1.0,
        x if x < 0.0 => 1.0,
        _ if cable == 0 => -1.0,
        _ => 1.0,
    };
    let radius = tether.length();
    let top = (1.15 * highest.max(0.05)).min(centre[1]);
    (0..=POINTS)
        .map(|k| {
            let y = top * f64::from(k) / f64::from(POINTS);
            let half = (radius * radius - (y - centre[1]).powi(2)).max(0.0).sqrt();
            [centre[0] + outward * half, y]
        })
        .collect()
}

/// The letters of chapter Figs 6.43 and 6.45: I start, S sliding starts, R rocking starts, G the other
/// boundary is struck while one cable is taut, E end; each where it happens first.
fn marks(trajectory: &Trajectory) -> Vec<Mark> {
    let starts = |taut: usize| {
        let of_mode = |mode: &&snapload::ModeInterval| mode.taut.len() == taut;
        let first = trajectory.modes().iter().find(of_mode);
        first.map(|mode| mode.t_start)
    };
    let struck_while_sliding = trajectory.impacts().iter().find(|impact| {
        let before = trajectory.at(impact.t.next_down()).taut;
        before.len() == 1 && !before.contains(impact.cable)
    });
    let letters = [
        ("I", Some(0.0)),
        ("S", starts(1)),
        ("G", struck_while_sliding.map(|impact| impact.t)),
        ("R", starts(2)),
        ("E", Some(trajectory.end().t)),
    ];
    let mark = |(letter, t): (&str, Option<f64>)| {
        t.map(|t| Mark {
            at: place(&trajectory.at(t)),
            letter: letter.to_owned(),
        })
    };
    letters.into_iter().filter_map(mark).collect()
}

fn snaps(trajectory: &Trajectory) -> Plot {
    let of_cable = |cable: usize| -> Vec<Point> {
        let impacts = trajectory.impacts().iter();
        impacts
            .filter(|impact| impact.cable == cable && impact.v_n > 0.0)
            .map(|impact| [impact.t, impact.v_n])
            .collect()
    };
    figures::snap_velocities([&of_cable(0), &of_cable(1)], None)
}

fn tensions(drawn: &Drawn) -> Plot {
    let of_cable = |cable: usize| -> Vec<Vec<Point>> {
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        let mut joined = false;
        for stretch in &drawn.stretches {
            let taut = stretch.taut.contains(cable);
            if taut {
                let points = stretch.points(|motion| [motion.t, motion.tensions[cable]]);
                match pieces.last_mut() {
                    Some(piece) if joined => piece.extend(points),
                    _ => pieces.push(points.collect()),
                }
            }
            joined = taut;
        }
        pieces
    };
    figures::tensions([&of_cable(0), &of_cable(1)], None)
}

fn place(motion: &Motion) -> Point {
    [motion.state.x, motion.state.y]
}
