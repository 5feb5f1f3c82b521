//! The legend: a row of samples above the frame, where it can hide no data.

use crate::area::{Area, SMALL, fitted, marker_radius};
use crate::plot::{Colour, Layer, Plot, Shape, Stroke};
use crate::polyline::Rect;
use crate::svg::{Anchor, Sheet};
use crate::text::{CAP_HEIGHT, width};

/// The height of a row, in points.
const ROW: f64 = 10.0;
/// From a sample to its words.
const GAP: f64 = 3.0;
/// From one entry to the next.
const BETWEEN: f64 = 10.0;

/// How a layer looks, for the legend.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sample {
    Line(Stroke),
    Marker(Shape, Colour),
    Shade,
}

impl Sample {
    fn of(layer: &Layer) -> Option<Self> {
        match layer {
            Layer::Line { stroke, .. } => Some(Self::Line(*stroke)),
            Layer::Markers { shape, colour, .. } => Some(Self::Marker(*shape, *colour)),
            Layer::Shade { .. } => Some(Self::Shade),
            Layer::Boundary { .. } | Layer::Horizontal { .. } | Layer::Letters(_) => None,
        }
    }

    fn width(self) -> f64 {
        match self {
            Self::Line(_) => 16.0,
            Self::Marker(..) => 5.0,
            Self::Shade => 10.0,
        }
    }

    fn draw(self, sheet: &mut Sheet, left: f64, middle: f64) {
        match self {
            Self::Line(stroke) => {
                sheet.segment([left, middle], [left + self.width(), middle], stroke);
            }
            Self::Marker(shape, colour) => {
                let at = [left + self.width() / 2.0, middle];
                sheet.markers(&[at], shape, marker_radius(1), colour);
            }
            Self::Shade => {
                let (width, height) = (self.width(), 6.0);
                sheet.shade(&Rect {
                    left,
                    top: middle - height / 2.0,
                    width,
                    height,
                });
            }
        }
    }
}

/// The entries drawn so far: a panel does not repeat those of the panels above.
#[derive(Debug, Default)]
pub(crate) struct Legend {
    drawn: Vec<(Sample, String)>,
}

impl Legend {
    /// Draws what is new in this panel from `top` down; returns where the rows end.
    pub(crate) fn draw(&mut self, sheet: &mut Sheet, plot: &Plot, area: &Area, top: f64) -> f64 {
        let (left, room) = (area.rect.left, area.rect.width);
        let mut cursor = left;
        let mut row = top;
        let mut any = false;
        for layer in plot.layers.iter().filter(|layer| area.shows(layer)) {
            let Some(sample) = Sample::of(layer) else {
                continue;
            };
            let entry = (sample, layer.legend().to_string());
            if entry.1.is_empty() || self.drawn.contains(&entry) {
                continue;
            }
            let words_at = sample.width() + GAP;
            let size = fitted(&entry.1, SMALL, room - words_at);
            let wide = words_at + width(&entry.1) * size;
            if any && cursor + wide > left + room {
                (cursor, row) = (left, row + ROW);
            }
            let base = row + ROW - 2.5;
            sample.draw(sheet, cursor, base - 0.5 * CAP_HEIGHT * SMALL);
            sheet.text(&entry.1, [cursor + words_at, base], size, Anchor::Start);
            cursor += wide + BETWEEN;
            any = true;
            self.drawn.push(entry);
        }
        if any { row + ROW } else { top }
    }
}
