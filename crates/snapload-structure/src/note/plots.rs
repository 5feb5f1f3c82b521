//! The plots of a note, in SI.

use crate::physics::snap::Snap;
use crate::physics::wave::LinearWave;
use crate::runs::assess::Assessment;
use crate::runs::gumbel::reduced_variate;
use crate::runs::quantile::sorted;
use crate::runs::scan::{Scan, ScanCell};
use crate::runs::seas::Seas;
use crate::structure::{Structure, THREE_HOURS_S, Water};
use snapload::{Motion, Playback};
use snapload_figures::{
    Axis, Cell, Colour, Dash, FigureError, Layer, Map, Picture, Plot, Point, Range, Shape, Stroke,
    Width, draw,
};

/// Points of a line over time.
const POINTS: u32 = 12_000;
/// Points of the water's surface over time.
const SURFACE: u32 = 1200;
/// The number of intervals of time, in each of which only the hardest snap of each line is drawn.
const TIME_BINS: usize = 400;
/// The number of wave periods in the detailed plots.
const CLOSE: f64 = 6.0;
/// An axis from zero on.
const FROM_ZERO: Range = Range::AtLeast(0.0, 0.0);

const INKS: [Colour; 6] = [
    Colour::BLUE,
    Colour::VERMILION,
    Colour::GREEN,
    Colour::PURPLE,
    Colour::ORANGE,
    Colour::SKY_BLUE,
];

fn line(pieces: Vec<Vec<Point>>, stroke: Stroke, legend: &str) -> Layer {
    Layer::Line(pieces, stroke, legend.to_owned())
}

fn horizontal(y: f64, label: &str) -> Layer {
    Layer::Horizontal(y, label.to_owned())
}

fn plot(description: &str, [x, y]: [(&str, Range); 2], layers: Vec<Layer>) -> Plot {
    let [x, y] = [x, y].map(|(label, range)| Axis::new(label, range));
    Plot {
        description: description.to_owned(),
        x,
        y,
        layers,
        ..Plot::default()
    }
}

/// Adds a point to the latest piece of a line, or begins a new one.
fn extend(pieces: &mut Vec<Vec<Point>>, joined: bool, point: Point) {
    match pieces.last_mut() {
        Some(piece) if joined => piece.push(point),
        _ => pieces.push(vec![point]),
    }
}

/// The time interval of the detailed plots: a few periods about the hardest judged snap, or the
/// last few \[s\].
pub fn window(assessment: &Assessment) -> [f64; 2] {
    let end = assessment.outcome.end_s;
    let period = match assessment.prepared.structure.water {
        Water::Still => end / CLOSE,
        Water::Wave(wave) => wave.period_s,
        Water::Sea(sea) => 2.0 * sea.peak_period_s,
    };
    let judged = assessment.judged();
    let hardest = judged.max_by(|a, b| a.by_hardness(b));
    let width = (CLOSE * period).min(end);
    let middle = hardest.map_or(end, |snap| snap.t_s);
    let from = (middle - width / 2.0).clamp(0.0, end - width);
    [from, from + width]
}

/// The path, the snaps, and tension and rotation over time.
pub(super) fn of_run(assessment: &Assessment) -> Result<Vec<Picture>, FigureError> {
    let window = window(assessment);
    let plots = [
        ("path", path(assessment, window)),
        ("snaps", peaks(assessment)),
        ("tension", tension(assessment, window)),
        ("rotation", rotation(assessment, window)),
        ("wave", surface(assessment, window)),
    ];
    let drawn = plots.into_iter();
    drawn
        .map(|(name, plot)| draw(name, Width::Column, &[plot]))
        .collect()
}

/// Calls `on_sample` with the motion at times within an interval in seconds.
fn sample_motion(
    assessment: &Assessment,
    [from, to]: [f64; 2],
    mut on_sample: impl FnMut(f64, &Motion),
) {
    let mut playback = Playback::new(&assessment.run);
    let unit = assessment.prepared.model.scales.time_s;
    for k in 0..=POINTS {
        let t = from + (to - from) * f64::from(k) / f64::from(POINTS);
        on_sample(t, &playback.at(t / unit));
    }
}

fn path(assessment: &Assessment, window: [f64; 2]) -> Plot {
    let scales = &assessment.prepared.model.scales;
    let mut pieces: [Vec<Vec<Point>>; 2] = [Vec::new(), Vec::new()];
    let mut last = None;
    sample_motion(assessment, window, |_, motion| {
        let kind = usize::from(!motion.taut.is_empty());
        let point = scales.to_si([motion.state.x, motion.state.y]);
        extend(&mut pieces[kind], last == Some(kind), point);
        last = Some(kind);
    });
    let [slack, taut] = pieces;
    let layers = vec![
        line(
            slack,
            Stroke::new(Colour::BLACK, 0.5, Dash::Solid),
            "no line taut",
        ),
        line(
            taut,
            Stroke::new(Colour::BLUE, 1.0, Dash::Solid),
            "a line taut",
        ),
    ];
    let axes = [("*x* (m)", Range::Auto), ("*z* (m)", Range::Auto)];
    let mut plot = plot("Path of the body's centre, z against x", axes, layers);
    plot.equal_scale = true;
    plot
}

/// The measure of a snap that is drawn: its tension \[kN\], or its part of the line's own breaking
/// load if those differ, or its speed if a line has no stiffness.
pub(super) struct Hardness {
    of: fn(&Snap) -> f64,
    /// The value at which lines break, if it is known.
    pub(super) breaks_at: Option<f64>,
    /// The label of the axis.
    label: &'static str,
    /// What is drawn, in words.
    pub(super) words: &'static str,
}

pub(super) fn hardness(assessment: &Assessment) -> Hardness {
    let lines = &assessment.prepared.structure.lines;
    let loads: Vec<_> = lines
        .iter()
        .filter_map(|line| line.breaking_load_n)
        .collect();
    let all_known = loads.len() == lines.len();
    if assessment.snaps.iter().any(|snap| snap.peak_n.is_none()) {
        Hardness {
            of: |snap| snap.speed_m_s,
            breaks_at: None,
            label: "speed of the snap (m/s)",
            words: "Speeds",
        }
    } else if all_known && loads.iter().any(|load| *load != loads[0]) {
        Hardness {
            of: |snap| snap.utilisation.unwrap_or(0.0),
            breaks_at: Some(1.0),
            label: "tension over breaking load",
            words: "Estimated peaks, over the line's own breaking load,",
        }
    } else {
        let load = loads.first().filter(|_| all_known);
        Hardness {
            of: |snap| snap.peak_n.map_or(0.0, |peak| peak / 1e3),
            breaks_at: load.map(|load| load / 1e3),
            label: "tension (kN)",
            words: "Estimated peaks",
        }
    }
}

fn peaks(assessment: &Assessment) -> Plot {
    let structure = &assessment.prepared.structure;
    let Hardness {
        of,
        breaks_at: limit,
        label,
        words,
    } = hardness(assessment);
    let mut layers = vec![Layer::Shade(
        f64::NEG_INFINITY,
        structure.transient_s,
        String::new(),
    )];
    let counted = || assessment.snaps.iter().filter(|snap| snap.counts());
    for line in 0..structure.lines.len() {
        let of_line = counted().filter(|snap| snap.line == line);
        let points = of_line.map(|snap| [snap.t_s, of(snap)]);
        let points = hardest_of_each(points, assessment.outcome.end_s);
        let (shape, colour) = (
            [Shape::Cross, Shape::Circle][line % 2],
            INKS[line % INKS.len()],
        );
        layers.push(Layer::Markers(
            points,
            shape,
            colour,
            format!("line {}", line + 1),
        ));
    }
    layers.extend(limit.map(|load| horizontal(load, "breaks")));
    let t = Range::AtLeast(0.0, assessment.outcome.end_s);
    // The axis includes the value at which a line breaks, however small the tensions are.
    let from_zero = Range::AtLeast(0.0, limit.unwrap_or(0.0));
    let axes = [("*t* (s)", t), (label, from_zero)];
    let title = format!("{words} of the snaps against time");
    let mut plot = plot(&title, axes, layers);
    if counted().next().is_none() {
        plot.note = "no line snapped".to_owned();
    }
    plot
}

/// The highest point of each interval of time, so that the points of hours do not cover each other.
fn hardest_of_each(points: impl Iterator<Item = Point>, end: f64) -> Vec<Point> {
    let mut highest: Vec<Option<Point>> = vec![None; TIME_BINS];
    for point in points {
        let bin = (point[0] / end * TIME_BINS as f64) as usize;
        let kept = &mut highest[bin.min(TIME_BINS - 1)];
        if kept.is_none_or(|kept| kept[1] < point[1]) {
            *kept = Some(point);
        }
    }
    highest.into_iter().flatten().collect()
}

fn tension(assessment: &Assessment, window: [f64; 2]) -> Plot {
    let lines = assessment.prepared.structure.lines.len();
    let force = assessment.prepared.model.scales.force_n;
    let mut pieces: Vec<Vec<Vec<Point>>> = vec![Vec::new(); lines];
    let mut joined = vec![false; lines];
    sample_motion(assessment, window, |t, motion| {
        for line in 0..lines {
            let taut = motion.taut.contains(line);
            if taut {
                let point = [t, motion.tensions[line] * force / 1e3];
                extend(&mut pieces[line], joined[line], point);
            }
            joined[line] = taut;
        }
    });
    let layers = pieces.into_iter().enumerate().map(|(index, pieces)| {
        let dash = [Dash::Solid, Dash::Dashed][index % 2];
        let stroke = Stroke::new(INKS[index % INKS.len()], 0.9, dash);
        line(pieces, stroke, &format!("line {}", index + 1))
    });
    let t = Range::Fixed(window[0], window[1]);
    let axes = [("*t* (s)", t), ("tension (kN)", FROM_ZERO)];
    plot(
        "Tension of each line while it is taut",
        axes,
        layers.collect(),
    )
}

fn rotation(assessment: &Assessment, window: [f64; 2]) -> Plot {
    /// A rotation below it \[degrees\] is that of rounding, and drawn as none.
    const LEAST: f64 = 1e-9;
    let mut points = Vec::new();
    sample_motion(assessment, window, |t, motion| {
        let turned = -motion.state.theta.to_degrees();
        points.push([t, if turned.abs() < LEAST { 0.0 } else { turned }]);
    });
    let t = Range::Fixed(window[0], window[1]);
    let axes = [("*t* (s)", t), ("rotation (degrees)", Range::Auto)];
    let layers = vec![line(vec![points], Stroke::default(), "")];
    plot("Rotation of the body against time", axes, layers)
}

/// The surface of the water above the position of rest, in the waves of the case.
fn surface(assessment: &Assessment, [from, to]: [f64; 2]) -> Plot {
    let waves = &assessment.prepared.model.waves;
    let height = |t: f64| -> f64 {
        let one =
            |wave: &LinearWave| wave.amplitude_m * (wave.omega_rad_s * t + wave.phase_rad).sin();
        waves.iter().map(one).sum()
    };
    let times = (0..=SURFACE).map(|k| from + (to - from) * f64::from(k) / f64::from(SURFACE));
    let points = times.map(|t| [t, height(t)]).collect();
    let t = Range::Fixed(from, to);
    let axes = [("*t* (s)", t), ("surface (m)", Range::Auto)];
    let layers = vec![line(vec![points], Stroke::default(), "")];
    let mut plot = plot(
        "Surface of the water above the place of rest against time",
        axes,
        layers,
    );
    if waves.is_empty() {
        plot.note = "still water".to_owned();
    }
    plot
}

/// The map of a scan.
pub(super) fn of_scan(scan: &Scan, structure: &Structure) -> Result<Picture, FigureError> {
    let value_label = match structure.utilisations_known() {
        true => "utilisation",
        false => "fastest snap (m/s)",
    };
    let cell = |cell: &ScanCell| match *cell {
        ScanCell::Known(value) | ScanCell::AtLeast(value) => Cell::Value(value),
        ScanCell::NotJudged => Cell::Empty,
        ScanCell::Fails => Cell::Class(0),
    };
    let at_least = |cell: &ScanCell| matches!(cell, ScanCell::AtLeast(_));
    let map = Map {
        x: scan.periods_s.clone(),
        y: scan.heights_m.clone(),
        cells: scan.cells.iter().map(cell).collect(),
        value_label: value_label.to_owned(),
        classes: vec!["turned over or touched the floor".to_owned()],
        uncertain: scan.cells.iter().map(at_least).collect(),
        uncertain_words: "at least, as the run was cut short".to_owned(),
        empty: "nothing is judged".to_owned(),
    };
    let axes = [("*T* (s)", Range::Auto), ("*H* (m)", Range::Auto)];
    let description = "Result for other waves, by period and height";
    let plot = plot(description, axes, vec![Layer::Map(map)]);
    draw("scan", Width::Column, &[plot])
}

/// Largest tensions on Gumbel paper, where his distribution is a straight line, and how often
/// tensions are exceeded; speeds if tensions are not known.
pub(super) fn of_seas(seas: &Seas) -> Result<[Picture; 2], FigureError> {
    let peaks = seas.largest_n();
    let (all, fit, unit, label) = match &peaks {
        Some(_) => {
            let fit = seas.peak_in_three_hours().ok();
            (seas.all_peaks_n(), fit, 1e3, "tension (kN)")
        }
        None => {
            let fit = seas.speed_in_three_hours().ok();
            (seas.all_speeds_m_s(), fit, 1.0, "speed of the snap (m/s)")
        }
    };
    let largest = peaks.unwrap_or_else(|| seas.speeds_m_s());
    let largest = sorted(largest.into_iter().flatten());
    let count = largest.len() as f64;
    let on_paper = |(rank, value): (usize, &f64)| {
        let below = (rank as f64 + 0.56) / (count + 0.12);
        [value / unit, reduced_variate(below)]
    };
    let mut layers = vec![Layer::Markers(
        largest.iter().enumerate().map(on_paper).collect(),
        Shape::Circle,
        Colour::BLUE,
        "records".to_owned(),
    )];
    // The fit is for three hours; on this paper it is drawn for the records.
    if let Some(fit) = fit.map(|fit| fit.of_one()) {
        let ends = [0.01, 0.995].map(|p| [fit.quantile(p).value / unit, reduced_variate(p)]);
        layers.push(line(vec![ends.to_vec()], Stroke::default(), "Gumbel fit"));
    }
    let parts = [(0.5, "50 %"), (0.9, "90 %"), (0.99, "99 %")];
    layers.extend(parts.map(|(p, words)| horizontal(reduced_variate(p), words)));
    let axes = [
        (label, Range::Auto),
        ("−ln(−ln *P*)", Range::AtLeast(-1.6, 4.8)),
    ];
    let gumbel = plot(
        "The largest value of each record on Gumbel probability paper",
        axes,
        layers,
    );
    let exceedance = exceedance(seas, &all, unit, label);
    Ok([
        draw("gumbel", Width::Column, &[gumbel])?,
        draw("exceedance", Width::Column, &[exceedance])?,
    ])
}

/// The part of all snaps that exceed a value.
fn exceedance(seas: &Seas, all: &[f64], unit: f64, label: &str) -> Plot {
    let three_hours = seas.judged_s() / THREE_HOURS_S;
    let harder = |(below, value): (usize, &f64)| {
        let often = (all.len() - below) as f64 / three_hours;
        [value / unit, often.log10()]
    };
    let points = all.iter().enumerate().map(harder).collect();
    let axes = [(label, FROM_ZERO), ("log₁₀ of snaps in 3 h", Range::Auto)];
    let layers = vec![line(vec![points], Stroke::default(), "")];
    let description = "Number of snaps above a value, in three hours";
    let mut plot = plot(description, axes, layers);
    if all.is_empty() {
        let note = match three_hours > 0.0 {
            true => "no line snapped",
            false => "nothing is judged",
        };
        plot.note = note.to_owned();
    }
    plot
}
