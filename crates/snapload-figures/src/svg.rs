//! The SVG itself: a sheet of paper that takes lines, shapes and letters.
//!
//! All lengths are points on paper (1/72 inch), written with two decimals.

use crate::plot::{Colour, Dash, Point, Shape, Stroke};
use crate::polyline::Rect;
use crate::text;
use std::fmt::Write;

/// The thin grey of boundaries.
pub(crate) const BOUNDARY: Stroke = Stroke {
    colour: Colour::Grey,
    width_pt: 0.6,
    dash: Dash::Solid,
};
/// A dashed line across a plot.
pub(crate) const ACROSS: Stroke = Stroke {
    colour: Colour::Grey,
    width_pt: 0.6,
    dash: Dash::Dashed,
};
/// The frame of a plot and its ticks.
pub(crate) const FRAME: Stroke = Stroke {
    colour: Colour::Black,
    width_pt: 0.5,
    dash: Dash::Solid,
};
/// The grey of a shaded background.
const SHADE: &str = "#e6e6e6";
/// The width of the line of a marker.
const MARKER_LINE: f64 = 0.6;

/// Which part of a text stands at its place.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// What fills a cell of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fill {
    /// Red, green and blue.
    Colour([u8; 3]),
    /// Light grey.
    Blank,
    /// Grey lines, told from every colour in print, too.
    Hatch,
}

/// What has been drawn so far.
#[derive(Debug, Default)]
pub(crate) struct Sheet {
    body: String,
}

impl Sheet {
    /// One path for all the pieces of a line.
    pub(crate) fn line(&mut self, pieces: &[Vec<Point>], stroke: Stroke) {
        let d: String = pieces.iter().map(|piece| path(piece)).collect();
        if d.is_empty() {
            return;
        }
        let dash = match stroke.dash {
            Dash::Solid => "",
            Dash::Dashed => " stroke-dasharray=\"3.5 1.8\"",
            Dash::Dotted => " stroke-dasharray=\"0.9 1.4\"",
        };
        // Round caps make a piece of one point a dot; they would fill the gaps between dashes.
        let lone = pieces.iter().any(|piece| piece.len() == 1);
        let cap = if lone || stroke.dash == Dash::Solid {
            " stroke-linecap=\"round\""
        } else {
            ""
        };
        self.push(format_args!(
            "<path d=\"{d}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{cap}{dash}/>",
            stroke.colour.hex(),
            number(stroke.width_pt.clamp(0.1, 20.0)),
        ));
    }

    /// A straight line.
    pub(crate) fn segment(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.line(&[vec![from, to]], stroke);
    }

    /// One path for all the markers of a layer.
    pub(crate) fn markers(&mut self, at: &[Point], shape: Shape, radius: f64, colour: Colour) {
        let d: String = at
            .iter()
            .map(|&point| marker(point, shape, radius))
            .collect();
        if !d.is_empty() {
            let (colour, width) = (colour.hex(), number(MARKER_LINE));
            self.push(format_args!(
                "<path d=\"{d}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
            ));
        }
    }

    /// A black dot with a white rim.
    pub(crate) fn dot(&mut self, [x, y]: Point, radius: f64) {
        let (x, y, r) = (number(x), number(y), number(radius));
        self.push(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" stroke=\"#fff\" stroke-width=\"0.6\"/>"
        ));
    }

    /// A light grey background.
    pub(crate) fn shade(&mut self, rect: &Rect) {
        self.push(format_args!("<rect {} fill=\"{SHADE}\"/>", box_of(rect)));
    }

    /// The lines of [`Fill::Hatch`].
    pub(crate) fn define_hatch(&mut self) {
        self.push(format_args!(
            "<pattern id=\"hatch\" width=\"3\" height=\"3\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">\
             <rect width=\"3\" height=\"3\" fill=\"#fff\"/><rect width=\"1\" height=\"3\" fill=\"#666\"/></pattern>"
        ));
    }

    /// One path for rectangles of one fill, without seams between neighbours.
    pub(crate) fn rects(&mut self, rects: &[Rect], fill: Fill) {
        let mut d = String::new();
        for rect in rects {
            let (left, right) = (number(rect.left), number(rect.left + rect.width));
            let (top, bottom) = (number(rect.top), number(rect.top + rect.height));
            // Places and no lengths: what two share is rounded alike.
            d.push_str(&format!("M{left} {top}H{right}V{bottom}H{left}z"));
        }
        let paint = match fill {
            Fill::Colour([r, g, b]) => format!("#{r:02x}{g:02x}{b:02x}"),
            Fill::Blank => SHADE.to_string(),
            Fill::Hatch => "url(#hatch)".to_string(),
        };
        self.push(format_args!(
            "<path d=\"{d}\" fill=\"{paint}\" shape-rendering=\"crispEdges\"/>"
        ));
    }

    /// The frame of a plot.
    pub(crate) fn frame(&mut self, rect: &Rect) {
        let (colour, width) = (FRAME.colour.hex(), number(FRAME.width_pt));
        self.push(format_args!(
            "<rect {} fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>",
            box_of(rect)
        ));
    }

    /// A text whose base line is at `at`.
    pub(crate) fn text(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) {
        self.text_with(text, at, size, anchor, "");
    }

    /// A text that stays readable on top of lines.
    pub(crate) fn text_with_halo(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) {
        let halo =
            " stroke=\"#fff\" stroke-width=\"2\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
        self.text_with(text, at, size, anchor, halo);
    }

    /// A text that reads upwards.
    pub(crate) fn text_upwards(&mut self, text: &str, at: Point, size: f64) {
        let turn = format!(
            " transform=\"rotate(-90 {} {})\"",
            number(at[0]),
            number(at[1])
        );
        self.text_with(text, at, size, Anchor::Middle, &turn);
    }

    fn text_with(&mut self, text: &str, [x, y]: Point, size: f64, anchor: Anchor, more: &str) {
        if text.is_empty() {
            return;
        }
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        self.push(format_args!(
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{anchor}{more}>{}</text>",
            number(x),
            number(y),
            number(size),
            text::markup(text),
        ));
    }

    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.body, "{element}");
    }

    /// The finished document.
    pub(crate) fn finish(self, width: f64, height: f64, title: &str) -> String {
        let (w, h) = (number(width), number(height));
        let millimetres = |points: f64| number(points * 25.4 / 72.0);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {w} {h}\">\n\
             <title>{}</title>\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n\
             <g font-family=\"{}\" fill=\"#000\">\n{}</g>\n</svg>\n",
            millimetres(width),
            millimetres(height),
            text::escape(title),
            text::FAMILY,
            self.body,
        )
    }
}

fn box_of(rect: &Rect) -> String {
    format!(
        "x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
        number(rect.left),
        number(rect.top),
        number(rect.width),
        number(rect.height),
    )
}

/// A polyline as path data: the first point, then steps, which are shorter to write.
fn path(points: &[Point]) -> String {
    let Some(first) = points.first() else {
        return String::new();
    };
    let [mut x, mut y] = first.map(hundredths);
    let mut d = format!("M{} {}", decimals(x), decimals(y));
    let mut steps = String::new();
    for point in &points[1..] {
        let next = point.map(hundredths);
        if next == [x, y] {
            continue;
        }
        let (dx, dy) = (decimals(next[0] - x), decimals(next[1] - y));
        let gap = |text: &str| if text.starts_with('-') { "" } else { " " };
        let before = if steps.is_empty() { "" } else { gap(&dx) };
        steps.push_str(&format!("{before}{dx}{}{dy}", gap(&dy)));
        [x, y] = next;
    }
    // A piece of no length is a dot.
    d.push('l');
    d.push_str(if steps.is_empty() { "0 0" } else { &steps });
    d
}

fn marker([x, y]: Point, shape: Shape, radius: f64) -> String {
    let r = number(radius);
    match shape {
        Shape::Cross => {
            let (left, top, d) = (number(x - radius), number(y - radius), number(2.0 * radius));
            format!("M{left} {top}l{d} {d}m0-{d}l-{d} {d}")
        }
        Shape::Circle => {
            let (left, d) = (number(x - radius), number(2.0 * radius));
            format!(
                "M{left} {}a{r} {r} 0 1 1 {d} 0a{r} {r} 0 1 1-{d} 0z",
                number(y)
            )
        }
    }
}

fn number(v: f64) -> String {
    decimals(hundredths(v))
}

fn hundredths(v: f64) -> i64 {
    (v * 100.0).round() as i64
}

/// A number of hundredths, as short as can be.
fn decimals(hundredths: i64) -> String {
    let sign = if hundredths < 0 { "-" } else { "" };
    let (whole, rest) = (
        hundredths.unsigned_abs() / 100,
        hundredths.unsigned_abs() % 100,
    );
    match (whole, rest) {
        (whole, 0) => format!("{sign}{whole}"),
        (0, rest) if rest % 10 == 0 => format!("{sign}.{}", rest / 10),
        (0, rest) => format!("{sign}.{rest:02}"),
        (whole, rest) if rest % 10 == 0 => format!("{sign}{whole}.{}", rest / 10),
        (whole, rest) => format!("{sign}{whole}.{rest:02}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written: Vec<String> = [0.0, -0.001, 0.5, -0.05, 12.3, -12.345, 7.0]
            .map(number)
            .into();
        assert_eq!(written, ["0", "0", ".5", "-.05", "12.3", "-12.35", "7"]);
    }

    #[test]
    fn a_path_is_a_point_and_steps() {
        assert_eq!(
            path(&[[1.0, 2.0], [1.5, 1.75], [2.0, 2.0]]),
            "M1 2l.5-.25 .5 .25"
        );
        assert_eq!(path(&[[1.0, 2.0]]), "M1 2l0 0");
        assert_eq!(path(&[]), "");
    }
}
