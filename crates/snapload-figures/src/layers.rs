//! The layers of a plot on paper.

use crate::area::Area;
use crate::map::draw_cells;
use crate::place::{Ink, name_boundaries, place_letters};
use crate::plot::{Layer, Plot};
use crate::polyline::thin_markers;
use crate::svg::{ACROSS, Anchor, BOUNDARY, Sheet};
use crate::text::{CAP_HEIGHT, NAME_GAP, SMALL, fitted};
use kurbo::{Point, Vec2};

/// The most markers drawn in one layer; more would cover the plot.
const MOST_MARKERS: usize = 6_000;

/// Draws all layers, then the frame, then the texts on top of both.
pub(crate) fn draw_layers(sheet: &mut Sheet, area: Area, plot: &Plot) {
    let mut ink = Ink::new(area.rect);
    // Backgrounds first, whatever their place in the list.
    for layer in &plot.layers {
        if let Layer::Shade(from, to, _) = layer
            && let Some(rect) = area.shaded(*from, *to)
        {
            sheet.shade(rect);
        }
    }
    let markers = plot.layers.iter().map(|layer| match layer {
        Layer::Markers(points, ..) => points.len(),
        _ => 0,
    });
    let marker = marker_radius(markers.sum::<usize>().max(plot.markers));
    for layer in &plot.layers {
        draw_layer(sheet, area, layer, marker, &mut ink);
    }
    sheet.frame(area.rect);
    write_names(sheet, area, plot, &mut ink);
}

/// Draws one layer; `marker` is the radius of a marker.
fn draw_layer(sheet: &mut Sheet, area: Area, layer: &Layer, marker: f64, ink: &mut Ink) {
    match layer {
        Layer::Line(pieces, stroke, _) => {
            let pieces: Vec<_> = pieces.iter().flat_map(|piece| area.line(piece)).collect();
            ink.add_lines(&pieces);
            sheet.line(&pieces, *stroke);
        }
        Layer::Markers(points, shape, colour, _) => {
            let at = points
                .iter()
                .filter_map(|&point| area.seen(point))
                .collect();
            sheet.markers(&thin_markers(at, MOST_MARKERS), *shape, marker, *colour);
        }
        Layer::Boundary(points, _) => {
            let pieces = area.line(points);
            ink.add_lines(&pieces);
            sheet.line(&pieces, BOUNDARY);
        }
        Layer::Horizontal(y, label) => {
            if let Some(left) = area.seen([area.x.0, *y]) {
                let right = Point::new(area.rect.x1, left.y);
                sheet.segment(left, right, ACROSS);
                let base = right + Vec2::new(NAME_GAP, 0.5 * CAP_HEIGHT * SMALL);
                sheet.text(label, base, SMALL, Anchor::Start);
            }
        }
        Layer::Map(map) => draw_cells(sheet, map, area),
        Layer::Shade(..) | Layer::Letters(_) => {}
    }
}

/// Half the size of a marker: many must not cover one another, few must be visible.
pub(crate) fn marker_radius(count: usize) -> f64 {
    (2.2 * (60.0 / count.max(1) as f64).sqrt()).clamp(1.0, 2.2)
}

/// Writes the letters, the names of the boundaries and the note.
fn write_names(sheet: &mut Sheet, area: Area, plot: &Plot, ink: &mut Ink) {
    let (mut letters, mut boundaries) = (Vec::new(), Vec::new());
    for layer in &plot.layers {
        match layer {
            Layer::Letters(marks) => letters.extend(marks.iter().filter_map(|mark| {
                let at = area.seen(mark.at)?;
                Some((at, mark.letter.as_str()))
            })),
            Layer::Boundary(points, name) => boundaries.push((area.line(points), name.as_str())),
            _ => {}
        }
    }
    place_letters(sheet, ink, &letters);
    name_boundaries(sheet, ink, &boundaries);
    let empty = plot.note.is_empty() && plot.data().next().is_none() && plot.map().is_none();
    let note = if empty { "no data" } else { plot.note.as_str() };
    let size = fitted(note, SMALL + 1.0, area.rect.width() - 8.0);
    let middle = area.rect.center() + Vec2::new(0.0, size / 3.0);
    sheet.text_with_halo(note, middle, size, Anchor::Middle);
}
