//! The legend: rows of samples above the frame, where they do not cover data.

use crate::area::Area;
use crate::layers::marker_radius;
use crate::map::samples;
use crate::plot::{Colour, Layer, Plot, Shape, Stroke, drawable};
use crate::svg::{Anchor, Fill, SvgCanvas};
use crate::text::{CAP_HEIGHT, ROW, SMALL, fitted, width};
use kurbo::{Point, Rect, Vec2};

/// The distance from a sample to its text, in points.
const GAP: f64 = 3.0;
/// The distance between entries.
const BETWEEN: f64 = 10.0;

/// How a layer looks.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sample {
    Line(Stroke),
    Marker(Shape, Colour),
    Shade,
    Cell(Fill),
}

impl Sample {
    fn width(self) -> f64 {
        match self {
            Self::Line(_) => 16.0,
            Self::Marker(..) => 5.0,
            Self::Shade => 10.0,
            Self::Cell(_) => 7.0,
        }
    }

    /// Draws it to the right of `at`, on the base line of its text.
    fn draw(self, canvas: &mut SvgCanvas, at: Point) {
        let width = self.width();
        let left = at - Vec2::new(0.0, 0.5 * CAP_HEIGHT * SMALL);
        match self {
            Self::Line(stroke) => canvas.segment(left, left + Vec2::new(width, 0.0), stroke),
            Self::Marker(shape, colour) => {
                let middle = left + Vec2::new(width / 2.0, 0.0);
                canvas.markers(&[middle], shape, marker_radius(1), colour);
            }
            Self::Shade => canvas.shade(Rect::new(at.x, left.y - 3.0, at.x + width, left.y + 3.0)),
            Self::Cell(fill) => {
                let square = Rect::new(at.x, at.y - width + 1.0, at.x + width, at.y + 1.0);
                canvas.rects(&[square], fill);
                canvas.frame(square);
            }
        }
    }
}

/// The entries of a layer of which something is visible.
fn entries(layer: &Layer, area: &Area) -> Vec<(Sample, String)> {
    let (seen, sample, words) = match layer {
        Layer::Line(pieces, stroke, words) => {
            let seen = pieces.iter().flatten().any(drawable);
            (seen, Sample::Line(*stroke), words)
        }
        Layer::Markers(points, shape, colour, words) => {
            let seen = points.iter().any(drawable);
            (seen, Sample::Marker(*shape, *colour), words)
        }
        Layer::Shade(from, to, words) => (area.shaded(*from, *to).is_some(), Sample::Shade, words),
        Layer::Map(map) => {
            let cells = samples(map).into_iter();
            return cells
                .map(|(fill, words)| (Sample::Cell(fill), words))
                .collect();
        }
        Layer::Boundary(..) | Layer::Horizontal(..) | Layer::Letters(_) => return Vec::new(),
    };
    let shown = seen && !words.is_empty();
    shown.then(|| (sample, words.clone())).into_iter().collect()
}

/// The entries drawn so far: a panel does not repeat those of the panels above.
#[derive(Debug, Default)]
pub(crate) struct Legend {
    drawn: Vec<(Sample, String)>,
}

impl Legend {
    /// Draws the new entries of this panel below `top`; returns where the rows end.
    pub(crate) fn draw(
        &mut self,
        canvas: &mut SvgCanvas,
        plot: &Plot,
        area: &Area,
        top: f64,
    ) -> f64 {
        let (left, right) = (area.rect.x0, area.rect.x1);
        let mut at = Point::new(left, top);
        for entry in plot.layers.iter().flat_map(|layer| entries(layer, area)) {
            if self.drawn.contains(&entry) {
                continue;
            }
            let (sample, words) = &entry;
            let words_at = sample.width() + GAP;
            let size = fitted(words, SMALL, right - left - words_at);
            let wide = words_at + width(words) * size;
            // at.y is the base line of the current row; the first entry begins the first row.
            if at.y == top || at.x + wide > right {
                at = Point::new(left, at.y + ROW);
            }
            let base = at - Vec2::new(0.0, 2.5);
            sample.draw(canvas, base);
            canvas.text(words, base + Vec2::new(words_at, 0.0), size, Anchor::Start);
            at.x += wide + BETWEEN;
            self.drawn.push(entry);
        }
        at.y
    }
}
