//! The plots of a run: which quantities of the motion are in each.

use crate::area::Area;
use crate::draw::{draw, ranges};
use crate::error::FigureError;
use crate::figures::{self, Mode, PathPart};
use crate::picture::Picture;
use crate::plot::{Inset, Mark, Plot, Point, Range, Width};
use kurbo::Rect;
use snapload::{ModeInterval, Motion, Playback, TautSet, Trajectory, Vector2};

/// Longest time step between two drawn points, if a run has at most [`MOST_STEPS`] of them.
const STEP: f64 = 0.01;
const MOST_STEPS: f64 = 20_000.0;
/// Shorter pieces than this are not visible.
const SHORTEST: f64 = 2e-3;

/// Where the inset of the whole run may be in the picture of snaps, the best place first.
const INSET_PLACES: [[f64; 4]; 6] = [
    [0.6, 0.5, 0.99, 0.98],
    [0.3, 0.5, 0.69, 0.98],
    [0.01, 0.5, 0.4, 0.98],
    [0.6, 0.02, 0.99, 0.5],
    [0.3, 0.02, 0.69, 0.5],
    [0.01, 0.02, 0.4, 0.5],
];

/// The plots of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RunPlot {
    /// y against x.
    Trajectory,
    /// θ against t.
    Rotation,
    /// v_n⁻ against t.
    Snaps,
    /// Tensions against t.
    Tensions,
    /// Energy against t.
    Energy,
}

impl RunPlot {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Trajectory,
        Self::Rotation,
        Self::Snaps,
        Self::Tensions,
        Self::Energy,
    ];

    /// Its name, which is also that of its file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Trajectory => "trajectory",
            Self::Rotation => "rotation",
            Self::Snaps => "snaps",
            Self::Tensions => "tensions",
            Self::Energy => "energy",
        }
    }
}

/// A run, sampled once for all its plots.
#[derive(Clone, Debug)]
pub struct RunPlots<'a> {
    run: &'a Trajectory,
    segments: Vec<Segment>,
    horizon: Option<f64>,
}

/// A segment of motion between two events, at the times at which it is drawn: the last one is just
/// before the event at its end.
#[derive(Clone, Debug)]
struct Segment {
    taut: TautSet,
    motion: Vec<Motion>,
}

impl<'a> RunPlots<'a> {
    /// The plots of a run.
    pub fn new(run: &'a Trajectory) -> Self {
        let mut playback = Playback::new(run);
        let end = run.end().t;
        let mut events: Vec<f64> = run.impacts().iter().map(|impact| impact.t).collect();
        events.extend(run.modes().iter().map(|mode| mode.t_start));
        events.push(end);
        events.sort_by(f64::total_cmp);
        events.dedup();
        let step = STEP.max(end / MOST_STEPS);
        let segments = events.windows(2).map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            // A flight is a curve however long the run; very short ones are not visible as curves.
            let curved = ((to - from) / SHORTEST).ceil().min(16.0);
            let pieces = ((to - from) / step).ceil().max(curved).max(1.0) as usize;
            let inner = (0..pieces).map(|k| from + (to - from) * k as f64 / pieces as f64);
            let times = inner.chain([to.next_down()]);
            Segment {
                taut: playback.at(from).taut,
                motion: times.map(|t| playback.at(t)).collect(),
            }
        });
        let segments = segments.collect();
        Self {
            run,
            segments,
            horizon: None,
        }
    }

    /// The same with the motion past a time, from which on it can not be trusted, drawn
    /// differently.
    pub fn with_horizon(self, horizon: Option<f64>) -> Self {
        Self { horizon, ..self }
    }

    /// One of the plots.
    pub fn plot(&self, which: RunPlot) -> Plot {
        let over_time = |of: fn(&Motion) -> f64| joined(&self.segments, |m| [m.t, of(m)]);
        let mut plot = match which {
            RunPlot::Trajectory => return self.trajectory(),
            RunPlot::Rotation => figures::rotation(&over_time(|m| m.state.theta), self.horizon),
            RunPlot::Snaps => {
                let [first, second] = [0, 1].map(|cable| self.snaps(cable));
                figures::snap_velocities([&first, &second], self.horizon)
            }
            RunPlot::Tensions => {
                let [first, second] = [0, 1].map(|cable| self.tensions(cable));
                figures::tensions([&first, &second], self.horizon)
            }
            RunPlot::Energy => figures::energy(&over_time(|m| m.energy), self.horizon),
        };
        plot.x.range = Range::AtLeast(0.0, self.run.end().t);
        match which {
            RunPlot::Snaps => self.windowed(plot),
            _ => plot,
        }
    }

    /// Snap velocities over the time with snaps, with the whole run as an inset, if it continues
    /// without any for more than half of its time and there is a place for the inset.
    fn windowed(&self, whole: Plot) -> Plot {
        let last = self.run.impacts().iter().rfind(|impact| impact.v_n > 0.0);
        let last = last.map_or(0.0, |impact| impact.t);
        if last <= 0.0 || last >= 0.5 * self.run.end().t {
            return whole;
        }
        let mut part = whole.clone();
        part.x.range = Range::Fixed(0.0, 1.05 * last);
        match INSET_PLACES
            .into_iter()
            .find(|place| is_free(&part, *place))
        {
            Some(place) => Plot {
                inset: Some(Box::new(Inset { place, plot: whole })),
                ..part
            },
            None => whole,
        }
    }

    /// One of the plots on a page of its own.
    ///
    /// # Errors
    /// Those of [`draw()`].
    pub fn picture(&self, which: RunPlot, title: &str) -> Result<Picture, FigureError> {
        let plot = Plot {
            title: title.to_owned(),
            ..self.plot(which)
        };
        draw(which.name(), Width::Page, &[plot])
    }

    /// y against x, with the region's boundaries and the letters of chapter Figs 6.43 and 6.45.
    fn trajectory(&self) -> Plot {
        let mode_of = |segment: &Segment| {
            let begins = segment.motion.first().map_or(0.0, |motion| motion.t);
            match segment.taut.mode() {
                _ if self.horizon.is_some_and(|horizon| begins >= horizon) => Mode::BeyondHorizon,
                snapload::Mode::Slack => Mode::Slack,
                snapload::Mode::Sliding => Mode::Sliding,
                snapload::Mode::Rocking => Mode::Rocking,
            }
        };
        let same = |a: &Segment, b: &Segment| mode_of(a) == mode_of(b);
        let parts = self.segments.chunk_by(same).map(|segments| PathPart {
            mode: mode_of(&segments[0]),
            points: joined(segments, place),
        });
        let parts: Vec<PathPart> = parts.collect();
        let boundaries = [0, 1].map(|cable| boundary(self.run, cable));
        figures::trajectory(&parts, [&boundaries[0], &boundaries[1]], &self.marks())
    }

    fn snaps(&self, cable: usize) -> Vec<Point> {
        let impacts = self.run.impacts().iter();
        let snaps = impacts.filter(|impact| impact.cable == cable && impact.v_n > 0.0);
        snaps.map(|snap| [snap.t, snap.v_n]).collect()
    }

    /// The tension of a cable in each piece of time during which it is taut.
    fn tensions(&self, cable: usize) -> Vec<Vec<Point>> {
        let is_taut = |segment: &Segment| segment.taut.contains(cable);
        let pieces = self.segments.chunk_by(|a, b| is_taut(a) == is_taut(b));
        let taut = pieces.filter(|piece| is_taut(&piece[0]));
        let tension = |motion: &Motion| [motion.t, motion.tensions[cable]];
        taut.map(|piece| joined(piece, tension)).collect()
    }

    /// The letters I start, S sliding starts, R rocking starts, G the other boundary is struck
    /// while one cable is taut, E end; each at its first occurrence.
    fn marks(&self) -> Vec<Mark> {
        let run = self.run;
        let starts = |taut: usize| {
            let of_mode = |mode: &&ModeInterval| mode.taut.len() == taut;
            let first = run.modes().iter().find(of_mode);
            first.map(|mode| mode.t_start)
        };
        let mut playback = Playback::new(run);
        let struck_while_sliding = run.impacts().iter().find(|impact| {
            let before = playback.at(impact.t.next_down()).taut;
            before.len() == 1 && !before.contains(impact.cable)
        });
        let letters = [
            ("I", Some(0.0)),
            ("S", starts(1)),
            ("G", struck_while_sliding.map(|impact| impact.t)),
            ("R", starts(2)),
            ("E", Some(run.end().t)),
        ];
        let mark = |(letter, t): (&str, Option<f64>)| Some(Mark::new(letter, place(&run.at(t?))));
        letters.into_iter().filter_map(mark).collect()
    }
}

/// Whether a part of the frame of a plot, as of [`Inset::place`], is free of its data.
fn is_free(plot: &Plot, [left, bottom, right, top]: [f64; 4]) -> bool {
    /// The distance that markers have from it.
    const APART: f64 = 0.02;
    let rect = Rect::new(0.0, 0.0, 1.0, 1.0);
    let area = Area {
        rect,
        ..ranges(plot)
    };
    let place = Rect::new(left, 1.0 - top, right, 1.0 - bottom).inflate(APART, APART);
    !plot.data().any(|point| place.contains(area.to_page(point)))
}

/// A point for each time of some segments.
fn joined(segments: &[Segment], of: impl Fn(&Motion) -> Point) -> Vec<Point> {
    let motions = segments.iter().flat_map(|segment| &segment.motion);
    motions.map(of).collect()
}

fn place(motion: &Motion) -> Point {
    [motion.state.x, motion.state.y]
}

/// The positions of the centre at which a cable is taut with the body upright, from the lowest
/// point of the region up to a little above the path.
fn boundary(run: &Trajectory, cable: usize) -> Vec<Point> {
    const POINTS: u32 = 200;
    let Some(tether) = run.system().cables.get(cable) else {
        return Vec::new();
    };
    let [anchor, fairlead] = [tether.anchor(), tether.fairlead()].map(Vector2::components);
    let centre = [anchor[0] - fairlead[0], anchor[1] - fairlead[1]];
    // The arc on the side away from the anchor, which passes through x = y = 0.
    let outward = match centre[0] {
        x if x > 0.0 => -1.0,
        x if x < 0.0 => 1.0,
        _ if cable == 0 => -1.0,
        _ => 1.0,
    };
    let radius = tether.length();
    let top = (1.15 * run.norms().y_max.max(0.05)).min(centre[1]);
    (0..=POINTS)
        .map(|k| {
            let y = top * f64::from(k) / f64::from(POINTS);
            let half = (radius * radius - (y - centre[1]).powi(2)).max(0.0).sqrt();
            [centre[0] + outward * half, y]
        })
        .collect()
}
