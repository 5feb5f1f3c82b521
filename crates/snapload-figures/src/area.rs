//! The inside of one plot: from the data's units to places on paper, and the layers drawn there.

use crate::axis::Span;
use crate::place::{Ink, name_boundaries, place_letters};
use crate::plot::{Layer, Mark, Plot, Point, drawable};
use crate::polyline::{Rect, clip, thin, thin_markers};
use crate::svg::{ACROSS, Anchor, BOUNDARY, Sheet};
use crate::text::{CAP_HEIGHT, width};

/// The size of letters beside ticks, in legends and at marks, in points.
pub(crate) const SMALL: f64 = 7.0;
/// The most markers drawn in one layer; more would cover the paper.
const MOST_MARKERS: usize = 6_000;

/// A rectangle of paper and the ranges of the two axes on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    pub(crate) rect: Rect,
    pub(crate) x: Span,
    pub(crate) y: Span,
}

impl Area {
    /// Where a point of the data is on paper.
    pub(crate) fn to_page(self, [x, y]: Point) -> Point {
        let along = |v: f64, (lo, hi): Span| (v - lo) / (hi - lo);
        [
            self.rect.left + along(x, self.x) * self.rect.width,
            self.rect.bottom() - along(y, self.y) * self.rect.height,
        ]
    }

    /// A polyline on paper, cut to the frame and to its drawable points, and thinned.
    fn line(self, points: &[Point]) -> Vec<Vec<Point>> {
        points
            .split(|point| !drawable(point))
            .map(|run| {
                run.iter()
                    .map(|&point| self.to_page(point))
                    .collect::<Vec<_>>()
            })
            .flat_map(|run| clip(&run, &self.rect))
            .map(|run| thin(&run))
            .collect()
    }

    /// The part of the rectangle between two values of x.
    fn shaded(self, from: f64, to: f64) -> Option<Rect> {
        let (from, to) = (from.min(to).max(self.x.0), from.max(to).min(self.x.1));
        let [left, _] = self.to_page([from, self.y.0]);
        let [right, _] = self.to_page([to, self.y.0]);
        (right > left).then_some(Rect {
            left,
            width: right - left,
            ..self.rect
        })
    }

    /// Whether anything of a layer is seen in this area.
    pub(crate) fn shows(self, layer: &Layer) -> bool {
        match layer {
            Layer::Shade { from, to, .. } => self.shaded(*from, *to).is_some(),
            Layer::Line { pieces, .. } => pieces.iter().flatten().any(drawable),
            Layer::Markers { points, .. } => points.iter().any(drawable),
            Layer::Boundary { .. } | Layer::Horizontal { .. } | Layer::Letters(_) => true,
        }
    }
}

/// Draws all layers, then the frame, then what is written on top of both.
pub(crate) fn draw_layers(sheet: &mut Sheet, area: Area, plot: &Plot) {
    let mut ink = Ink::new(area.rect);
    // Backgrounds first, whatever their place in the list.
    for layer in &plot.layers {
        if let Layer::Shade { from, to, .. } = layer
            && let Some(rect) = area.shaded(*from, *to)
        {
            sheet.shade(&rect);
        }
    }
    let markers = plot.layers.iter().map(|layer| match layer {
        Layer::Markers { points, .. } => points.len(),
        _ => 0,
    });
    let marker = marker_radius(markers.sum());
    for layer in &plot.layers {
        draw_layer(sheet, area, layer, marker, &mut ink);
    }
    sheet.frame(&area.rect);
    write_names(sheet, area, plot, &mut ink);
}

/// Draws one layer; `marker` is the radius of a marker.
fn draw_layer(sheet: &mut Sheet, area: Area, layer: &Layer, marker: f64, ink: &mut Ink) {
    match layer {
        Layer::Line { pieces, stroke, .. } => {
            let pieces: Vec<_> = pieces.iter().flat_map(|piece| area.line(piece)).collect();
            ink.add_lines(&pieces);
            sheet.line(&pieces, *stroke);
        }
        Layer::Markers {
            points,
            shape,
            colour,
            ..
        } => {
            let at: Vec<Point> = points
                .iter()
                .filter(|point| drawable(point))
                .map(|&point| area.to_page(point))
                .filter(|&point| area.rect.contains(point))
                .collect();
            sheet.markers(&thin_markers(&at, MOST_MARKERS), *shape, marker, *colour);
        }
        Layer::Boundary { points, .. } => {
            let pieces = area.line(points);
            ink.add_lines(&pieces);
            sheet.line(&pieces, BOUNDARY);
        }
        Layer::Horizontal { y, label } => {
            let [_, height] = area.to_page([area.x.0, *y]);
            let (left, right) = (area.rect.left, area.rect.right());
            if area.rect.contains([left, height]) {
                sheet.segment([left, height], [right, height], ACROSS);
                let base = height + 0.5 * CAP_HEIGHT * SMALL;
                sheet.text(label, [right + 2.5, base], SMALL, Anchor::Start);
            }
        }
        Layer::Shade { .. } | Layer::Letters(_) => {}
    }
}

/// Half the size of a marker: many must not blot one another out, few must be seen.
pub(crate) fn marker_radius(count: usize) -> f64 {
    (2.2 * (60.0 / count.max(1) as f64).sqrt()).clamp(1.0, 2.2)
}

/// Writes the letters, the names of the boundaries and the note.
fn write_names(sheet: &mut Sheet, area: Area, plot: &Plot, ink: &mut Ink) {
    let marks: Vec<Mark> = plot
        .layers
        .iter()
        .filter_map(|layer| {
            if let Layer::Letters(marks) = layer {
                Some(marks)
            } else {
                None
            }
        })
        .flatten()
        .filter(|mark| drawable(&mark.at))
        .map(|mark| Mark {
            at: area.to_page(mark.at),
            letter: mark.letter.clone(),
        })
        .filter(|mark| area.rect.contains(mark.at))
        .collect();
    place_letters(sheet, ink, &marks);
    let boundaries: Vec<(&str, Vec<Vec<Point>>)> = plot
        .layers
        .iter()
        .filter_map(|layer| match layer {
            Layer::Boundary { points, label } => Some((label.as_str(), area.line(points))),
            _ => None,
        })
        .collect();
    name_boundaries(sheet, ink, &boundaries);
    let empty = plot.note.is_empty() && plot.data().next().is_none();
    let note = if empty { "no data" } else { plot.note.as_str() };
    let size = fitted(note, SMALL + 1.0, area.rect.width - 8.0);
    let middle = [
        area.rect.left + area.rect.width / 2.0,
        area.rect.top + area.rect.height / 2.0 + size / 3.0,
    ];
    sheet.text_with_halo(note, middle, size, Anchor::Middle);
}

/// The size at which a text fits the room, at most `size`.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> f64 {
    let wide = width(text) * size;
    if wide > room {
        size * (room / wide).max(0.05)
    } else {
        size
    }
}
