//! The plots of a note, in SI.

use super::Scan;
use crate::assess::Assessment;
use crate::gumbel::reduced;
use crate::seas::Seas;
use crate::snap::Snap;
use crate::structure::{Structure, Water};
use snapload::Playback;
use snapload_figures::{
    Axis, Cell, Colour, Dash, FigureError, Layer, Map, Picture, Plot, Point, Range, Shape, Stroke,
    Width, draw,
};

/// Points of a line over time.
const POINTS: u32 = 12_000;
/// A closer look takes so many wave periods.
const CLOSE: f64 = 6.0;

const INKS: [Colour; 6] = [
    Colour::BLUE,
    Colour::VERMILION,
    Colour::GREEN,
    Colour::PURPLE,
    Colour::ORANGE,
    Colour::GREY,
];

/// The plots with their captions.
pub(super) fn all(assessment: &Assessment) -> Result<Vec<(Picture, String)>, FigureError> {
    let window = window(assessment);
    let named = [
        ("path", path(assessment, window), format!("Path of the body's centre from t = {:.0} to {:.0} s, about the hardest snap.", window[0], window[1])),
        ("snaps", peaks(assessment), "Estimated peak of every snap of 1 cm/s or more; where lines break at different loads, over the line's own. Dashed: there it breaks. Grey: not judged.".to_owned()),
        ("tension", tension(assessment, window), "Tension of the lines while they are taut, in the same time. Snaps are not in it: they last no time here, and have an impulse, not a tension.".to_owned()),
        ("rotation", rotation(assessment, window), "Rotation of the body in the same time.".to_owned()),
    ];
    named
        .into_iter()
        .map(|(name, plot, words)| Ok((draw(name, Width::Column, &[plot])?, words)))
        .collect()
}

/// A few periods about the hardest snap that is judged, or the last few.
fn window(assessment: &Assessment) -> [f64; 2] {
    let structure = &assessment.prepared.structure;
    let end = assessment.outcome.end_s;
    let period = match structure.water {
        Water::Still => end / CLOSE,
        Water::Wave(wave) => wave.period_s,
        Water::Sea(sea) => 2.0 * sea.peak_period_s,
    };
    let judged = assessment
        .snaps
        .iter()
        .filter(|snap| snap.counts() && snap.t_s >= structure.transient_s);
    let hardest = judged.max_by(|a, b| a.speed_m_s.total_cmp(&b.speed_m_s));
    let width = (CLOSE * period).min(end);
    let middle = hardest.map_or(end, |snap| snap.t_s);
    let from = (middle - width / 2.0).clamp(0.0, end - width);
    [from, from + width]
}

/// Looks at the motion within a window, in SI: time, place, rotation, tensions.
fn looks(
    assessment: &Assessment,
    [from, to]: [f64; 2],
    mut see: impl FnMut(f64, &snapload::Motion),
) {
    let mut playback = Playback::new(&assessment.run);
    let unit = assessment.prepared.model.scales.time_s;
    for k in 0..=POINTS {
        let t = from + (to - from) * f64::from(k) / f64::from(POINTS);
        see(t, &playback.at(t / unit));
    }
}

fn path(assessment: &Assessment, window: [f64; 2]) -> Plot {
    let scales = &assessment.prepared.model.scales;
    let mut pieces: [Vec<Vec<Point>>; 2] = [Vec::new(), Vec::new()];
    let mut last = None;
    looks(assessment, window, |_, motion| {
        let kind = usize::from(!motion.taut.is_empty());
        let point = scales.to_si([motion.state.x, motion.state.y]);
        if last != Some(kind) {
            pieces[kind].push(Vec::new());
        }
        if let Some(piece) = pieces[kind].last_mut() {
            piece.push(point);
        }
        last = Some(kind);
    });
    let [slack, taut] = pieces;
    let line = |pieces, colour, width_pt, legend: &str| {
        let stroke = Stroke::new(colour, width_pt, Dash::Solid);
        Layer::Line(pieces, stroke, legend.to_owned())
    };
    Plot {
        description: "Path of the body's centre, z against x".to_owned(),
        x: Axis::new("*x* (m)", Range::Auto),
        y: Axis::new("*z* (m)", Range::Auto),
        equal_scale: true,
        layers: vec![
            line(slack, Colour::BLACK, 0.5, "no line taut"),
            line(taut, Colour::BLUE, 1.0, "a line taut"),
        ],
        ..Plot::default()
    }
}

fn over_time(description: &str, label: &str, range: Range, layers: Vec<Layer>) -> Plot {
    Plot {
        description: description.to_owned(),
        x: Axis::new("*t* (s)", Range::Auto),
        y: Axis::new(label, range),
        layers,
        ..Plot::default()
    }
}

/// How hard a snap is, as it is drawn.
enum PeakScale {
    /// Tension, all lines breaking at this load, if that is known \[N\].
    Tension(Option<f64>),
    /// Tension over the line's own breaking load.
    Utilisation,
    /// Of lines without a stiffness only the speed is known.
    Speed,
}

impl PeakScale {
    fn of(assessment: &Assessment) -> Self {
        let lines = &assessment.prepared.structure.lines;
        let loads: Vec<f64> = lines
            .iter()
            .filter_map(|line| line.breaking_load_n)
            .collect();
        if assessment.snaps.iter().any(|snap| snap.peak_n.is_none()) {
            Self::Speed
        } else if loads.len() < lines.len() {
            Self::Tension(None)
        } else if loads.iter().all(|load| *load == loads[0]) {
            Self::Tension(loads.first().copied())
        } else {
            Self::Utilisation
        }
    }

    fn value(&self, snap: &Snap) -> f64 {
        let peak_kn = snap.peak_n.map_or(0.0, |peak| peak / 1e3);
        match self {
            Self::Tension(_) => peak_kn,
            Self::Utilisation => snap.utilisation.unwrap_or(0.0),
            Self::Speed => snap.speed_m_s,
        }
    }

    fn limit(&self) -> Option<f64> {
        match self {
            Self::Tension(load) => load.map(|load| load / 1e3),
            Self::Utilisation => Some(1.0),
            Self::Speed => None,
        }
    }

    fn label(&self) -> &'static str {
        match self {
            Self::Tension(_) => "tension (kN)",
            Self::Utilisation => "tension over breaking load",
            Self::Speed => "speed of the snap (m/s)",
        }
    }
}

fn peaks(assessment: &Assessment) -> Plot {
    let structure = &assessment.prepared.structure;
    let scale = PeakScale::of(assessment);
    let shade = Layer::Shade(f64::NEG_INFINITY, structure.transient_s, String::new());
    let mut layers = vec![shade];
    for line in 0..structure.lines.len() {
        let of_line = assessment
            .snaps
            .iter()
            .filter(|snap| snap.counts() && snap.line == line);
        let points = of_line.map(|snap| [snap.t_s, scale.value(snap)]);
        let shape = [Shape::Cross, Shape::Circle][line % 2];
        let (colour, name) = (INKS[line % INKS.len()], format!("line {}", line + 1));
        layers.push(Layer::Markers(points.collect(), shape, colour, name));
    }
    if let Some(load) = scale.limit() {
        layers.push(Layer::Horizontal(load, "breaks".to_owned()));
    }
    let label = scale.label();
    let mut plot = over_time(
        "Estimated tension of each snap against time",
        label,
        Range::AtLeast(0.0, 0.0),
        layers,
    );
    plot.x.range = Range::AtLeast(0.0, assessment.outcome.end_s);
    if !assessment.snaps.iter().any(Snap::counts) {
        plot.note = "no line snapped".to_owned();
    }
    plot
}

fn tension(assessment: &Assessment, window: [f64; 2]) -> Plot {
    let lines = assessment.prepared.structure.lines.len();
    let force = assessment.prepared.model.scales.force_n;
    let mut pieces: Vec<Vec<Vec<Point>>> = vec![Vec::new(); lines];
    let mut joined = vec![false; lines];
    looks(assessment, window, |t, motion| {
        for line in 0..lines {
            let taut = motion.taut.contains(line);
            if taut {
                let point = [t, motion.tensions[line] * force / 1e3];
                match pieces[line].last_mut() {
                    Some(piece) if joined[line] => piece.push(point),
                    _ => pieces[line].push(vec![point]),
                }
            }
            joined[line] = taut;
        }
    });
    let layers = pieces.into_iter().enumerate().map(|(line, pieces)| {
        let dash = [Dash::Solid, Dash::Dashed][line % 2];
        let stroke = Stroke::new(INKS[line % INKS.len()], 0.9, dash);
        Layer::Line(pieces, stroke, format!("line {}", line + 1))
    });
    let mut plot = over_time(
        "Tension of each line while it is taut",
        "tension (kN)",
        Range::AtLeast(0.0, 0.0),
        layers.collect(),
    );
    plot.x.range = Range::Fixed(window[0], window[1]);
    plot
}

fn rotation(assessment: &Assessment, window: [f64; 2]) -> Plot {
    let mut points = Vec::new();
    looks(assessment, window, |t, motion| {
        points.push([t, -motion.state.theta.to_degrees()])
    });
    let line = Layer::Line(vec![points], Stroke::default(), String::new());
    let mut plot = over_time(
        "Rotation of the body against time",
        "rotation (degrees)",
        Range::Auto,
        vec![line],
    );
    plot.x.range = Range::Fixed(window[0], window[1]);
    plot
}

/// The map of a scan.
pub(super) fn of_scan(scan: &Scan, structure: &Structure) -> Result<Picture, FigureError> {
    let known = structure
        .lines
        .iter()
        .all(|line| line.breaking_load_n.is_some() && line.stiffness_n.is_some());
    let cells = scan.cells.iter().map(|cell| match cell {
        None => Cell::Class(0),
        Some(value) => Cell::Value(*value),
    });
    let label = if known {
        "utilisation"
    } else {
        "fastest snap (m/s)"
    };
    let map = Map {
        x: scan.periods_s.clone(),
        y: scan.heights_m.clone(),
        cells: cells.collect(),
        value_label: label.to_owned(),
        classes: vec!["turned over or touched the floor".to_owned()],
    };
    let plot = Plot {
        description: "Result for other waves, by period and height".to_owned(),
        x: Axis::new("*T* (s)", Range::Auto),
        y: Axis::new("*H* (m)", Range::Auto),
        layers: vec![Layer::Map(map)],
        ..Plot::default()
    };
    draw("scan", Width::Column, &[plot])
}

/// Largest tensions on Gumbel's paper, where his distribution is a straight line, and how often tensions are exceeded.
pub(super) fn of_seas(seas: &Seas) -> Result<Vec<(Picture, String)>, FigureError> {
    let structure = &seas.prepared.structure;
    let (mut largest, all, fit, unit, label) = match seas.peaks_n() {
        Some(peaks) => (
            peaks,
            seas.all_peaks_n(),
            seas.peak_in_three_hours(),
            1e3,
            "tension (kN)",
        ),
        None => (
            seas.speeds_m_s(),
            seas.all_speeds_m_s(),
            seas.speed_in_three_hours(),
            1.0,
            "speed of the snap (m/s)",
        ),
    };
    largest.sort_by(f64::total_cmp);
    let count = largest.len() as f64;
    let points: Vec<Point> = largest
        .iter()
        .enumerate()
        .map(|(rank, value)| [value / unit, reduced((rank as f64 + 0.56) / (count + 0.12))])
        .collect();
    let words = "records".to_owned();
    let mut layers = vec![Layer::Markers(points, Shape::Circle, Colour::BLUE, words)];
    // The fit is for three hours; on this paper it stands where the records are.
    let judged = structure.duration_s - structure.transient_s;
    if let Some(fit) = fit.map(|fit| fit.over_times(judged / crate::THREE_HOURS_S)) {
        let ends = [0.01, 0.995].map(|p| [fit.quantile(p).value / unit, reduced(p)]);
        let words = "Gumbel fit".to_owned();
        layers.push(Layer::Line(vec![ends.to_vec()], Stroke::default(), words));
    }
    for (p, words) in [(0.5, "50 %"), (0.9, "90 %"), (0.99, "99 %")] {
        layers.push(Layer::Horizontal(reduced(p), words.to_owned()));
    }
    let gumbel = Plot {
        description: "Largest snap of each record on Gumbel's paper".to_owned(),
        x: Axis::new(label, Range::Auto),
        y: Axis::new("−ln(−ln *P*)", Range::AtLeast(-1.6, 4.8)),
        layers,
        ..Plot::default()
    };
    let hours = seas.judged_s() / crate::THREE_HOURS_S;
    let exceeded: Vec<Point> = all
        .iter()
        .enumerate()
        .map(|(below, value)| [value / unit, ((all.len() - below) as f64 / hours).log10()])
        .collect();
    let often = Plot {
        description: "How often a snap is harder than a value, in three hours".to_owned(),
        x: Axis::new(label, Range::AtLeast(0.0, 0.0)),
        y: Axis::new("log₁₀ of snaps in 3 h", Range::Auto),
        layers: vec![Layer::Line(
            vec![exceeded],
            Stroke::default(),
            String::new(),
        )],
        note: if all.is_empty() {
            "no line snapped".to_owned()
        } else {
            String::new()
        },
        ..Plot::default()
    };
    let words = [
        "The hardest snap of each record against the part P of records that stay below it; on this paper a Gumbel distribution is a straight line.",
        "How many snaps in three hours are harder than a value.",
    ];
    [("gumbel", gumbel), ("exceedance", often)]
        .into_iter()
        .zip(words)
        .map(|((name, plot), words)| Ok((draw(name, Width::Column, &[plot])?, words.to_owned())))
        .collect()
}
