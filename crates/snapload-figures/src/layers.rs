//! The layers of a plot on paper.

use crate::area::Area;
use crate::map::draw_cells;
use crate::place::{OccupiedAreas, name_boundaries, place_letters};
use crate::plot::{Layer, Plot};
use crate::polyline::thin_markers;
use crate::svg::{ACROSS, Anchor, BOUNDARY, SvgCanvas};
use crate::text::{CAP_HEIGHT, NAME_GAP, SMALL, fitted};
use kurbo::{Point, Vec2};

/// The most markers drawn in one layer; more would cover the plot.
const MOST_MARKERS: usize = 6_000;

/// Draws all layers, then the frame, then the texts on top of both.
pub(crate) fn draw_layers(canvas: &mut SvgCanvas, area: Area, plot: &Plot) {
    let mut occupied = OccupiedAreas::new(area.rect);
    // Backgrounds first, whatever their place in the list.
    for layer in &plot.layers {
        if let Layer::Shade(from, to, _) = layer
            && let Some(rect) = area.shaded(*from, *to)
        {
            canvas.shade(rect);
        }
    }
    let markers = plot.layers.iter().map(|layer| match layer {
        Layer::Markers(points, ..) => points.len(),
        _ => 0,
    });
    let marker = marker_radius(markers.sum::<usize>().max(plot.markers));
    for layer in &plot.layers {
        draw_layer(canvas, area, layer, marker, &mut occupied);
    }
    canvas.frame(area.rect);
    write_names(canvas, area, plot, &mut occupied);
}

/// Draws one layer; `marker` is the radius of a marker.
fn draw_layer(
    canvas: &mut SvgCanvas,
    area: Area,
    layer: &Layer,
    marker: f64,
    occupied: &mut OccupiedAreas,
) {
    match layer {
        Layer::Line(pieces, stroke, _) => {
            let pieces: Vec<_> = pieces.iter().flat_map(|piece| area.line(piece)).collect();
            occupied.add_lines(&pieces);
            canvas.line(&pieces, *stroke);
        }
        Layer::Markers(points, shape, colour, _) => {
            let at = points
                .iter()
                .filter_map(|&point| area.seen(point))
                .collect();
            canvas.markers(&thin_markers(at, MOST_MARKERS), *shape, marker, *colour);
        }
        Layer::Boundary(points, _) => {
            let pieces = area.line(points);
            occupied.add_lines(&pieces);
            canvas.line(&pieces, BOUNDARY);
        }
        Layer::Horizontal(y, label) => {
            if let Some(left) = area.seen([area.x.0, *y]) {
                let right = Point::new(area.rect.x1, left.y);
                canvas.segment(left, right, ACROSS);
                let base = right + Vec2::new(NAME_GAP, 0.5 * CAP_HEIGHT * SMALL);
                canvas.text(label, base, SMALL, Anchor::Start);
            }
        }
        Layer::Map(map) => draw_cells(canvas, map, area),
        Layer::Shade(..) | Layer::Letters(_) => {}
    }
}

/// Half the size of a marker: many must not cover one another, few must be visible.
pub(crate) fn marker_radius(count: usize) -> f64 {
    (2.2 * (60.0 / count.max(1) as f64).sqrt()).clamp(1.0, 2.2)
}

/// Writes the letters, the names of the boundaries and the note.
fn write_names(canvas: &mut SvgCanvas, area: Area, plot: &Plot, occupied: &mut OccupiedAreas) {
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
    place_letters(canvas, occupied, &letters);
    name_boundaries(canvas, occupied, &boundaries);
    let empty = plot.note.is_empty() && plot.data().next().is_none() && plot.map().is_none();
    let note = if empty { "no data" } else { plot.note.as_str() };
    let size = fitted(note, SMALL + 1.0, area.rect.width() - 8.0);
    let middle = area.rect.center() + Vec2::new(0.0, size / 3.0);
    canvas.text_with_halo(note, middle, size, Anchor::Middle);
}
