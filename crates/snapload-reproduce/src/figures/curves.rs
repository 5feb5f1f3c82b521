//! Figs 6.27-6.38: critical force over restitution and frequency, and norms over the force
//! amplitude.

use super::{About, Lists, Source};
use crate::ReportError;
use crate::study::{Both, LARGEST, Reading, Study};
use crate::tables::NORMS;
use serde::Deserialize;
use snapload::Outcome;
use snapload_figures::{Axis, Colour, Dash, Layer, Plot, Point, Range, Shape, Stroke};
use std::f64::consts::FRAC_PI_2;

/// A curve of the study.
#[derive(Deserialize)]
pub(super) struct Curve {
    /// Cable length.
    r: f64,
    /// The name of a [`Key`] or of [`Norms`].
    of: String,
}

/// A key over which critical forces are drawn.
#[derive(Deserialize)]
pub(super) struct Key {
    symbol: String,
    name: String,
    /// The shell command that counts its values in hundredths.
    hundredths: String,
}

/// The contents of a figure of norms.
#[derive(Deserialize)]
pub(super) struct Norms {
    what: String,
    axis: String,
    /// The first is drawn as circles, the second as crosses.
    keys: Vec<String>,
}

fn colour(reading: Reading) -> Colour {
    reading.either(Colour::BLUE, Colour::VERMILION)
}

impl Curve {
    /// Critical force over restitution or frequency.
    pub(super) fn critical(
        &self,
        study: &Study,
        lists: &Lists,
    ) -> Result<(Plot, About), ReportError> {
        let (r, of) = (self.r, self.of.as_str());
        let mut curves = study.curves.iter();
        let curve = curves.find(|curve| curve.r == r && curve.key == of);
        let points = &curve.ok_or_else(|| self.missing())?.points;
        let Key {
            symbol,
            name,
            hundredths,
        } = lists.keys.get(of).ok_or_else(|| self.missing())?;
        let existing = |reading| -> Vec<Point> {
            let points = points.of(reading).iter();
            points.filter_map(|(x, f)| Some([*x, (*f)?])).collect()
        };
        let layer = |reading: Reading| {
            let dash = reading.either(Dash::Solid, Dash::Dashed);
            let stroke = Stroke::new(colour(reading), 0.9, dash);
            Layer::Line(
                vec![existing(reading)],
                stroke,
                reading.heading().to_owned(),
            )
        };
        let [from, to] = [points.chapter.first(), points.chapter.last()]
            .map(|point| point.map_or(0.0, |(value, _)| *value));
        let gaps = if Reading::BOTH
            .iter()
            .any(|r| existing(*r).len() < points.of(*r).len())
        {
            format!(" Where a curve is missing no amplitude up to {LARGEST} exceeds them.")
        } else {
            String::new()
        };
        let caption = format!(
            "Critical force against {name}, r = {r}: the smallest force amplitude, in steps of 0.01, \
             whose run exceeds the limits, in doubles.{gaps}"
        );
        let plot = Plot {
            description: format!("Critical force against {name}"),
            x: Axis::new(symbol, Range::AtLeast(from, to)),
            y: Axis::new("critical force (F)", Range::AtLeast(0.0, 0.0)),
            layers: Reading::BOTH.map(layer).to_vec(),
            ..Plot::default()
        };
        let verb = format!("critical --max {LARGEST}");
        let command = |reading| self.for_each(&verb, hundredths, of, reading);
        Ok((plot, about(caption, ".f_cr", command)))
    }

    /// Norms over the force amplitude, up to the critical force.
    pub(super) fn norms(&self, study: &Study, lists: &Lists) -> Result<(Plot, About), ReportError> {
        let r = self.r;
        let curve = study.norms.iter().find(|curve| curve.r == r);
        let points = &curve.ok_or_else(|| self.missing())?.points;
        let figure = lists.norms.get(&self.of).ok_or_else(|| self.missing())?;
        let mut layers = Vec::new();
        let mut largest = 0.0;
        for (key, shape) in figure.keys.iter().zip([Shape::Circle, Shape::Cross]) {
            let norm = NORMS.iter().find(|(name, ..)| name == key);
            let (_, symbol, of) = norm.ok_or_else(|| self.missing())?;
            let values = Reading::BOTH.map(|reading| -> Vec<Point> {
                let points = points.of(reading).iter();
                points
                    .map(|(f_o, outcome)| [*f_o, of(&outcome.norms)])
                    .collect()
            });
            largest = values
                .iter()
                .flatten()
                .map(|point| point[1])
                .fold(largest, f64::max);
            layers.extend(markers(symbol, shape, values));
        }
        let what = &figure.what;
        if figure.keys.iter().any(|key| key == "theta_max") {
            layers.push(Layer::Horizontal(FRAC_PI_2, "π/2".to_owned()));
            layers.extend(critical_lines(points, largest));
        }
        let plot = Plot {
            description: format!("{what} against force amplitude"),
            x: Axis::new("*f*ₒ (F)", Range::AtLeast(0.0, 0.0)),
            // With room for a whole marker at the top.
            y: Axis::new(&figure.axis, Range::AtLeast(0.0, 1.08 * largest)),
            layers,
            // The marker size is common to the figures of both lengths, which are compared.
            markers: study
                .norms
                .iter()
                .map(|curve| curve.points.chapter.len())
                .sum(),
            ..Plot::default()
        };
        let caption = format!(
            "{what} against the force amplitude, up to the critical force, r = {r}, in doubles. Black where both \
             readings agree."
        );
        let place = match figure.keys.as_slice() {
            [key] => format!(".norms.{key}"),
            keys => format!(".norms | .{}", keys.join(", .")),
        };
        let command = |reading| {
            let hundredths = format!("seq {}", points.of(reading).len());
            self.for_each("run", &hundredths, "f_o", reading)
        };
        Ok((plot, about(caption, &place, command)))
    }

    fn missing(&self) -> ReportError {
        ReportError::Missing(format!("the curve of {} for r = {}", self.of, self.r))
    }

    /// A command for each of some values, which are counted in hundredths, so that the program
    /// receives exactly the decimals of the report. Sums such as 0.3 + 68 · 0.01 differ from them
    /// in the last bit, which is enough to change a critical force.
    fn for_each(&self, verb: &str, hundredths: &str, key: &str, reading: Reading) -> String {
        let (r, option) = (self.r, reading.option());
        format!(
            "for k in $({hundredths}); do snapload {verb} --set r={r} --set {key}=${{k}}e-2{option} --json -; done"
        )
    }
}

/// A line at the critical force of each reading, which is the last amplitude; one line if both are
/// the same.
fn critical_lines(points: &Both<Vec<(f64, Outcome)>>, top: f64) -> impl Iterator<Item = Layer> {
    let last = |reading| points.of(reading).last().map(|(f_cr, _)| *f_cr);
    let same = last(Reading::Chapter) == last(Reading::SlidingOn);
    let line = move |reading: Reading| {
        let (f_cr, _) = points.of(reading).last()?;
        let (colour, words) = match same {
            true if reading == Reading::Chapter => (Colour::BLACK, "critical force"),
            true => return None,
            false => (
                colour(reading),
                reading.either("critical, chapter", "critical, sliding on"),
            ),
        };
        let stroke = Stroke::new(colour, 0.6, Dash::Dashed);
        Some(Layer::Line(
            vec![vec![[*f_cr, 0.0], [*f_cr, top]]],
            stroke,
            words.to_owned(),
        ))
    };
    Reading::BOTH.into_iter().filter_map(line)
}

/// The readings agree at most amplitudes: such a point is drawn once, as the second marker would
/// hide the first.
fn markers(symbol: &str, shape: Shape, values: [Vec<Point>; 2]) -> impl Iterator<Item = Layer> {
    let [chapter, mut sliding_on] = values;
    let (both, ends): (Vec<_>, Vec<_>) =
        chapter.iter().partition(|point| sliding_on.contains(point));
    sliding_on.retain(|point| !chapter.contains(point));
    let [first, second] = Reading::BOTH;
    let sets = [
        (both, Colour::BLACK, "both readings"),
        (ends, colour(first), first.heading()),
        (sliding_on, colour(second), second.heading()),
    ];
    let drawn = sets.into_iter().filter(|(points, ..)| !points.is_empty());
    drawn.map(move |(points, colour, words)| {
        Layer::Markers(points, shape, colour, format!("{symbol}, {words}"))
    })
}

fn about(caption: String, place: &str, command: impl Fn(Reading) -> String) -> About {
    let source = |reading: Reading| Source {
        part: reading.heading(),
        command: command(reading),
        place: place.to_owned(),
    };
    About {
        caption,
        numbers: Vec::new(),
        sources: Reading::BOTH.map(source).to_vec(),
    }
}
