//! The pictures of coefficients, memory and response.

use super::{Floating, Report};
use crate::coefficients::FREEDOMS;
use crate::linear::Response;
use crate::memory::DampingCurve;
use snapload_figures::{
    Axis, Colour, Dash, FigureError, Layer, Picture, Plot, Point, Range, Shape, Stroke, Width, draw,
};
use std::f64::consts::PI;

/// Points of a smooth line.
const POINTS: usize = 400;
/// Kilo: masses are drawn in tonnes, forces in kilonewtons.
const KILO: f64 = 1e3;

const FILE: Stroke = Stroke::new(Colour::BLUE, 0.9, Dash::Solid);
const FIT: Stroke = Stroke::new(Colour::VERMILION, 0.9, Dash::Dashed);

fn plot(title: &str, description: String, axes: [(&str, &str); 2], layers: Vec<Layer>) -> Plot {
    let [x, y] = axes.map(|(label, unit)| format!("{label} ({unit})"));
    Plot {
        title: title.to_owned(),
        description,
        x: Axis::new(x, Range::AtLeast(0.0, 0.0)),
        y: Axis::new(y, Range::AtLeast(0.0, 0.0)),
        layers,
        ..Plot::default()
    }
}

fn line(points: Vec<Point>, stroke: Stroke, label: &str) -> Layer {
    Layer::Line(vec![points], stroke, label.to_owned())
}

/// All pictures, in the order of the page.
pub(super) fn all(report: &Report) -> Result<Vec<Picture>, FigureError> {
    let mut pictures = vec![
        draw(
            "added-mass",
            Width::Column,
            &each(|i| added_mass(report, i)),
        )?,
        draw("damping", Width::Column, &each(|i| damping(report, i)))?,
        draw("memory", Width::Column, &each(|i| memory(report, i)))?,
        draw(
            "excitation",
            Width::Column,
            &each(|i| excitation(report, i)),
        )?,
    ];
    if let Ok(floating) = &report.floating {
        let plots = each(|i| response(floating, i));
        pictures.push(draw("response", Width::Column, &plots)?);
    }
    Ok(pictures)
}

fn each(of: impl Fn(usize) -> Plot) -> Vec<Plot> {
    (0..3).map(of).collect()
}

/// Frequencies of a smooth line, from near zero to a little beyond the last.
fn smooth(report: &Report) -> impl Iterator<Item = f64> {
    let top = 1.15 * report.reading.hydro.range_rad_s()[1];
    (1..=POINTS).map(move |k| top * k as f64 / POINTS as f64)
}

fn markers(report: &Report, value: impl Fn(usize) -> f64) -> Layer {
    let omega = report.reading.hydro.omega_rad_s.iter().enumerate();
    let points = omega.map(|(k, omega)| [*omega, value(k)]).collect();
    Layer::Markers(points, Shape::Circle, Colour::BLUE, "file".to_owned())
}

const OMEGA: (&str, &str) = ("*ω*", "rad/s");

fn added_mass(report: &Report, i: usize) -> Plot {
    let (hydro, fit) = (&report.reading.hydro, &report.fit);
    let value = |omega: f64| {
        let memory = fit.memory.transform(omega)[(i, i)].im / omega;
        [omega, (fit.added_mass_inf[(i, i)] + memory) / KILO]
    };
    let inf = fit.added_mass_inf[(i, i)] / KILO;
    let layers = vec![
        markers(report, |k| hydro.added_mass[k][(i, i)] / KILO),
        line(smooth(report).map(value).collect(), FIT, "exponentials"),
        Layer::Horizontal(inf, "*A*(∞)".to_owned()),
    ];
    let description = format!("Added mass of {} against frequency", FREEDOMS[i]);
    let axes = [
        OMEGA,
        (["*A*₁₁", "*A*₃₃", "*A*₅₅"][i], ["t", "t", "t m²"][i]),
    ];
    let mut plot = plot(FREEDOMS[i], description, axes, layers);
    // The excitation may vary little from one frequency to another.
    plot.y.range = Range::Auto;
    plot
}

fn damping(report: &Report, i: usize) -> Plot {
    let (hydro, fit) = (&report.reading.hydro, &report.fit);
    let value = |omega: f64| [omega, fit.memory.transform(omega)[(i, i)].re / KILO];
    let layers = vec![
        markers(report, |k| hydro.damping[k][(i, i)] / KILO),
        line(smooth(report).map(value).collect(), FIT, "exponentials"),
    ];
    let description = format!("Damping of {} by waves against frequency", FREEDOMS[i]);
    let unit = ["kN s/m", "kN s/m", "kN m s"][i];
    let axes = [OMEGA, (["*B*₁₁", "*B*₃₃", "*B*₅₅"][i], unit)];
    plot(FREEDOMS[i], description, axes, layers)
}

fn memory(report: &Report, i: usize) -> Plot {
    let hydro = &report.reading.hydro;
    let curve = DampingCurve::new(&hydro.omega_rad_s, &hydro.damping_entry(i, i));
    // Until most of the memory has decayed: a few periods of the middle of the file's range.
    let long = 16.0 * PI / hydro.range_rad_s()[1];
    let times = || (0..=POINTS).map(move |k| long * k as f64 / POINTS as f64);
    let of_damping = times().map(|t| [t, curve.kernel(t) / KILO]).collect();
    let of_fit = times()
        .map(|t| [t, report.fit.memory.kernel(t)[(i, i)] / KILO])
        .collect();
    let layers = vec![
        line(of_damping, FILE, "from the damping"),
        line(of_fit, FIT, "exponentials"),
    ];
    let description = format!("Memory of {} against time", FREEDOMS[i]);
    let unit = ["kN/m", "kN/m", "kN m"][i];
    let axes = [("*t*", "s"), (["*K*₁₁", "*K*₃₃", "*K*₅₅"][i], unit)];
    plot(FREEDOMS[i], description, axes, layers)
}

/// How a direction is drawn.
fn direction(direction: f64) -> (Stroke, &'static str) {
    match direction > 0.0 {
        true => (FILE, "waves to +*x*"),
        false => (FIT, "waves to −*x*"),
    }
}

fn excitation(report: &Report, i: usize) -> Plot {
    let hydro = &report.reading.hydro;
    let layers = hydro.excitation.iter().map(|excitation| {
        let points = hydro.omega_rad_s.iter().zip(&excitation.force);
        let points = points.map(|(omega, force)| [*omega, force[i].norm() / KILO]);
        let (stroke, label) = direction(excitation.direction);
        line(points.collect(), stroke, label)
    });
    let description = format!("Wave force on {} per metre against frequency", FREEDOMS[i]);
    let unit = ["kN/m", "kN/m", "kN m/m"][i];
    let axes = [OMEGA, (["|*X*₁|", "|*X*₃|", "|*X*₅|"][i], unit)];
    plot(FREEDOMS[i], description, axes, layers.collect())
}

/// Amplitudes in waves from either side that differ by no more than this part of the largest are
/// those of a mirror-symmetric body.
const ALIKE: f64 = 0.01;

/// Whether a freedom responds alike to waves from either side.
fn is_symmetric(floating: &Floating, i: usize) -> bool {
    let [[one, _], [other, _]] = floating.responses.as_slice() else {
        return true;
    };
    let sizes = |response: &Response| -> Vec<f64> {
        response.amplitude.iter().map(|xi| xi[i].norm()).collect()
    };
    let (one, other) = (sizes(one), sizes(other));
    let largest = one.iter().chain(&other).fold(0.0, |a: f64, b| a.max(*b));
    let mut pairs = one.iter().zip(&other);
    pairs.all(|(a, b)| (a - b).abs() <= ALIKE * largest)
}

/// The highest peak of a freedom in all responses, without what grows towards long waves.
fn highest_peak(floating: &Floating, i: usize) -> f64 {
    let peaks = floating.fine.iter().flatten().flat_map(|response| {
        let sizes: Vec<f64> = response.amplitude.iter().map(|xi| xi[i].norm()).collect();
        let is_peak = |three: &&[f64]| three[1] >= three[0] && three[1] >= three[2];
        let peaks = sizes.windows(3).filter(is_peak).map(|three| three[1]);
        peaks.collect::<Vec<f64>>()
    });
    peaks.fold(0.0, f64::max)
}

fn response(floating: &Floating, i: usize) -> Plot {
    let unit = if i == 2 { 180.0 / PI } else { 1.0 };
    let points = |response: &Response| {
        let pairs = response.omega_rad_s.iter().zip(&response.amplitude);
        pairs
            .map(|(omega, xi)| [*omega, xi[i].norm() * unit])
            .collect()
    };
    let symmetric = is_symmetric(floating, i);
    let drawn = if symmetric { 1 } else { 2 };
    let layers = floating.fine.iter().take(drawn).flat_map(|[file, memory]| {
        let to = match (symmetric, file.direction > 0.0) {
            (true, _) => "",
            (false, true) => ", to +*x*",
            (false, false) => ", to −*x*",
        };
        let [of_file, of_memory] = match symmetric || file.direction > 0.0 {
            true => [Colour::BLUE, Colour::VERMILION],
            false => [Colour::GREEN, Colour::PURPLE],
        };
        [
            line(
                points(file),
                Stroke::new(of_file, 0.9, Dash::Solid),
                &format!("file{to}"),
            ),
            line(
                points(memory),
                Stroke::new(of_memory, 0.9, Dash::Dashed),
                &format!("exponentials{to}"),
            ),
        ]
    });
    let description = format!(
        "Response of {} per metre of wave, without lines",
        FREEDOMS[i]
    );
    let axes = [
        OMEGA,
        (["|*ξ*₁|", "|*ξ*₃|", "|*ξ*₅|"][i], ["m/m", "m/m", "°/m"][i]),
    ];
    let mut plot = plot(FREEDOMS[i], description, axes, layers.collect());
    if i == 0 {
        // Surge grows without bound towards long waves.
        plot.y.range = Range::Fixed(0.0, f64::max(2.0, 1.1 * highest_peak(floating, i)));
    }
    plot
}
