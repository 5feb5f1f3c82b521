//! The SVG document: a sheet of paper with lines, shapes and letters.
//!
//! All lengths are points on paper (1/72 inch), written with two decimals.

use crate::plot::{Colour, Dash, Shape, Stroke};
use crate::text;
use kurbo::{Point, Rect};
use std::fmt::{Arguments, Display, Formatter, Result, Write};

/// The stroke of boundaries.
pub(crate) const BOUNDARY: Stroke = Stroke::new(Colour::BLACK, 0.6, Dash::Dotted);
/// The stroke of a line across a plot.
pub(crate) const ACROSS: Stroke = Stroke::new(Colour::BLACK, 0.4, Dash::Dashed);
/// The stroke of the frame of a plot and its ticks.
pub(crate) const FRAME: Stroke = Stroke::new(Colour::BLACK, 0.5, Dash::Solid);
/// The grey of a shaded background, which is reserved for what is past the horizon of trust.
const SHADE: &str = "#e6e6e6";
/// The width of the line of a marker.
const MARKER_LINE: f64 = 0.6;
/// The attributes that keep a text readable on top of lines.
const HALO: &str =
    r##" stroke="#fff" stroke-width="2" stroke-linejoin="round" paint-order="stroke""##;

/// The part of a text that is at its position.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// The fill of a cell of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fill {
    Colour(Colour),
    /// White.
    Blank,
    /// Grey lines, which differ from every colour in print, too.
    Hatch,
    /// Thin lines on top of a colour, black next to white, so that they are visible on every
    /// colour.
    Uncertain,
}

/// The elements drawn so far.
#[derive(Debug, Default)]
pub(crate) struct SvgCanvas {
    body: String,
}

impl SvgCanvas {
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
        // Round caps make a piece of one point a dot; but they would fill the gaps between dashes.
        let lone = pieces.iter().any(|piece| piece.len() == 1);
        let round = lone || stroke.dash == Dash::Solid;
        let cap = if round {
            " stroke-linecap=\"round\""
        } else {
            ""
        };
        let (colour, width) = (hex(stroke.colour), number(stroke.width_pt.clamp(0.1, 20.0)));
        self.push(format_args!(
            r#"<path d="{d}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{cap}{dash}/>"#
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
            let (colour, width) = (hex(colour), number(MARKER_LINE));
            self.push(format_args!(
                r#"<path d="{d}" fill="none" stroke="{colour}" stroke-width="{width}"/>"#
            ));
        }
    }

    /// A black dot with a white rim.
    pub(crate) fn dot(&mut self, at: Point, radius: f64) {
        let (x, y, r) = (number(at.x), number(at.y), number(radius));
        self.push(format_args!(
            r##"<circle cx="{x}" cy="{y}" r="{r}" stroke="#fff" stroke-width="0.6"/>"##
        ));
    }

    /// A light grey background.
    pub(crate) fn shade(&mut self, rect: Rect) {
        self.rect(rect, format_args!(r#"fill="{SHADE}""#));
    }

    /// A white background.
    pub(crate) fn blank(&mut self, rect: Rect) {
        self.rect(rect, format_args!(r##"fill="#fff""##));
    }

    /// The frame of a plot.
    pub(crate) fn frame(&mut self, rect: Rect) {
        let (colour, width) = (hex(FRAME.colour), number(FRAME.width_pt));
        let paint = format_args!(r#"fill="none" stroke="{colour}" stroke-width="{width}""#);
        self.rect(rect, paint);
    }

    fn rect(&mut self, rect: Rect, paint: Arguments<'_>) {
        let (x, y, width, height) = (
            number(rect.x0),
            number(rect.y0),
            number(rect.width()),
            number(rect.height()),
        );
        self.push(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" {paint}/>"#
        ));
    }

    /// The lines of [`Fill::Hatch`].
    pub(crate) fn define_hatch(&mut self) {
        self.push(format_args!(concat!(
            r#"<pattern id="hatch" width="3" height="3" patternUnits="userSpaceOnUse" "#,
            r#"patternTransform="rotate(45)">"#,
            r##"<rect width="3" height="3" fill="#fff"/><rect width="1" height="3" fill="#666"/>"##,
            "</pattern>"
        )));
    }

    /// The lines of [`Fill::Uncertain`], which lean the other way.
    pub(crate) fn define_uncertain(&mut self) {
        self.push(format_args!(concat!(
            r#"<pattern id="doubt" width="3.6" height="3.6" patternUnits="userSpaceOnUse" "#,
            r#"patternTransform="rotate(-45)">"#,
            r##"<rect width=".5" height="3.6" fill="#fff"/>"##,
            r##"<rect x=".5" width=".5" height="3.6" fill="#000"/>"##,
            "</pattern>"
        )));
    }

    /// One path for rectangles of one fill, without seams between neighbours.
    pub(crate) fn rects(&mut self, rects: &[Rect], fill: Fill) {
        let mut d = String::new();
        for rect in rects {
            let [left, top, right, bottom] = [rect.x0, rect.y0, rect.x1, rect.y1].map(number);
            // Absolute coordinates: an edge that two rectangles share is rounded alike for both.
            d.push_str(&format!("M{left} {top}H{right}V{bottom}H{left}z"));
        }
        let paint = match fill {
            Fill::Colour(colour) => hex(colour),
            Fill::Blank => "#fff".to_string(),
            Fill::Hatch => "url(#hatch)".to_string(),
            Fill::Uncertain => "url(#doubt)".to_string(),
        };
        self.push(format_args!(
            r#"<path d="{d}" fill="{paint}" shape-rendering="crispEdges"/>"#
        ));
    }

    /// A text whose base line is at `at`.
    pub(crate) fn text(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) {
        self.text_with(text, at, size, anchor, "");
    }

    /// A text that stays readable on top of lines.
    pub(crate) fn text_with_halo(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) {
        self.text_with(text, at, size, anchor, HALO);
    }

    /// A text that reads upwards.
    pub(crate) fn text_upwards(&mut self, text: &str, at: Point, size: f64) {
        let turn = format!(
            r#" transform="rotate(-90 {} {})""#,
            number(at.x),
            number(at.y)
        );
        self.text_with(text, at, size, Anchor::Middle, &turn);
    }

    fn text_with(&mut self, text: &str, at: Point, size: f64, anchor: Anchor, more: &str) {
        if text.is_empty() {
            return;
        }
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (x, y, size, text) = (number(at.x), number(at.y), number(size), text::markup(text));
        self.push(format_args!(
            r#"<text x="{x}" y="{y}" font-size="{size}"{anchor}{more}>{text}</text>"#
        ));
    }

    fn push(&mut self, element: Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.body, "{element}");
    }

    /// The finished document.
    pub(crate) fn finish(self, width: f64, height: f64, title: &str) -> String {
        let (w, h) = (number(width), number(height));
        let [w_mm, h_mm] = [width, height].map(|points| number(points * 25.4 / 72.0));
        let (title, family, body) = (text::escape(title), text::FAMILY, self.body);
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{w_mm}mm" height="{h_mm}mm" viewBox="0 0 {w} {h}">
<title>{title}</title>
<rect width="{w}" height="{h}" fill="#fff"/>
<g font-family="{family}" fill="#000">
{body}</g>
</svg>
"##
        )
    }
}

/// A colour in its shortest SVG notation.
fn hex(Colour([r, g, b]): Colour) -> String {
    if [r, g, b].iter().all(|part| part.is_multiple_of(0x11)) {
        format!("#{:x}{:x}{:x}", r % 16, g % 16, b % 16)
    } else {
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// A polyline as path data: the first point, then relative steps, which are shorter to write.
fn path(points: &[Point]) -> String {
    let Some((first, rest)) = points.split_first() else {
        return String::new();
    };
    let (mut x, mut y) = (number(first.x), number(first.y));
    let mut d = format!("M{x} {y}l");
    let start = d.len();
    for point in rest {
        let (to_x, to_y) = (number(point.x), number(point.y));
        if (to_x, to_y) == (x, y) {
            continue;
        }
        for step in [Hundredths(to_x.0 - x.0), Hundredths(to_y.0 - y.0)] {
            let gap = if step.0 < 0 || d.len() == start {
                ""
            } else {
                " "
            };
            let _ = write!(d, "{gap}{step}");
        }
        (x, y) = (to_x, to_y);
    }
    // A piece of zero length is a dot.
    if d.len() == start {
        d.push_str("0 0");
    }
    d
}

fn marker(at: Point, shape: Shape, radius: f64) -> String {
    let (left, d) = (number(at.x - radius), number(2.0 * radius));
    match shape {
        Shape::Cross => format!("M{left} {}l{d} {d}m0-{d}l-{d} {d}", number(at.y - radius)),
        Shape::Circle => {
            let (y, r) = (number(at.y), number(radius));
            format!("M{left} {y}a{r} {r} 0 1 1 {d} 0a{r} {r} 0 1 1-{d} 0z")
        }
    }
}

/// A number with two decimals, in its shortest notation.
#[derive(Clone, Copy, PartialEq)]
struct Hundredths(i64);

fn number(v: f64) -> Hundredths {
    Hundredths((v * 100.0).round() as i64)
}

impl Display for Hundredths {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (whole, rest) = (self.0.unsigned_abs() / 100, self.0.unsigned_abs() % 100);
        if self.0 < 0 {
            f.write_char('-')?;
        }
        if whole > 0 || rest == 0 {
            write!(f, "{whole}")?;
        }
        match rest {
            0 => Ok(()),
            rest if rest % 10 == 0 => write!(f, ".{}", rest / 10),
            rest => write!(f, ".{rest:02}"),
        }
    }
}
