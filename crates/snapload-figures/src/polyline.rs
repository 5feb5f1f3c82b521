//! Polylines on paper: clipped to the frame, and thinned where this is not visible.
//!
//! All lengths here are points on paper (1/72 inch).

use kurbo::{Line, ParamCurveNearest, Point, Rect};
use std::collections::HashSet;

/// The largest deviation of the simplification; [`columns`] adds at most [`COLUMN`].
const TOLERANCE: f64 = 0.05;
/// The width of the columns in which a long line over time keeps only its extremes.
const COLUMN: f64 = 0.1;
/// The number of points from which on a line is reduced to its columns' extremes.
const LONG_LINE: usize = 5_000;
/// The simplification works on parts of this length, which limits its time.
const SEGMENT_POINTS: usize = 1_000;

/// Whether a point is in a frame; one on the edge is, whatever the rounding of its position.
pub(crate) fn holds(frame: Rect, point: Point) -> bool {
    frame.inflate(1e-6, 1e-6).contains(point)
}

/// The pieces of a polyline inside the frame.
pub(crate) fn clip(points: &[Point], frame: Rect) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    if let &[only] = points
        && holds(frame, only)
    {
        pieces.push(vec![only]);
    }
    for &[from, to] in points.array_windows() {
        let Some((from, to)) = clip_segment(from, to, frame) else {
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

/// The part of a segment inside the frame (Liang and Barsky 1984).
fn clip_segment(from: Point, to: Point, frame: Rect) -> Option<(Point, Point)> {
    let d = to - from;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (d, low, high) in [
        (d.x, frame.x0 - from.x, frame.x1 - from.x),
        (d.y, frame.y0 - from.y, frame.y1 - from.y),
    ] {
        if d != 0.0 {
            let (low, high) = (low / d, high / d);
            enter = enter.max(low.min(high));
            leave = leave.min(low.max(high));
        } else if low > 0.0 || high < 0.0 {
            return None;
        }
    }
    let end = |end: Point, part: f64| {
        if holds(frame, end) {
            return end;
        }
        // Clamped, because rounding is large if the ends are far outside.
        let at = from + part * d;
        Point::new(
            at.x.clamp(frame.x0, frame.x1),
            at.y.clamp(frame.y0, frame.y1),
        )
    };
    (enter <= leave).then(|| (end(from, enter), end(to, leave)))
}

/// A polyline with the same appearance and far fewer points.
pub(crate) fn thin(points: &[Point]) -> Vec<Point> {
    if points.len() > LONG_LINE && points.is_sorted_by(|a, b| a.x <= b.x) {
        simplify(&columns(points))
    } else {
        simplify(points)
    }
}

/// For a line over time, the first, lowest, highest and last point of each column.
fn columns(points: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| (a.x / COLUMN).floor() == (b.x / COLUMN).floor()) {
        let by_height = |a: &usize, b: &usize| column[*a].y.total_cmp(&column[*b].y);
        let mut picks = vec![0, column.len() - 1];
        picks.extend((0..column.len()).min_by(by_height));
        picks.extend((0..column.len()).max_by(by_height));
        picks.sort_unstable();
        picks.dedup();
        kept.extend(picks.into_iter().map(|index| column[index]));
    }
    kept
}

/// The simplification of Douglas and Peucker (1973), part by part.
fn simplify(points: &[Point]) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let last = points.len() - 1;
    let mut keep = vec![false; points.len()];
    let pieces = (0..last).step_by(SEGMENT_POINTS);
    let mut open: Vec<(usize, usize)> = pieces
        .map(|start| (start, (start + SEGMENT_POINTS).min(last)))
        .collect();
    while let Some((from, to)) = open.pop() {
        keep[from] = true;
        keep[to] = true;
        let chord = Line::new(points[from], points[to]);
        let distance_sq = |index: usize| chord.nearest(points[index], 0.0).distance_sq;
        let inner = (from + 1..to).map(|index| (distance_sq(index), index));
        let farthest = inner.max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, index)) = farthest.filter(|far| far.0 > TOLERANCE * TOLERANCE) {
            open.extend([(from, index), (index, to)]);
        }
    }
    let kept = points.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(point, _)| *point).collect()
}

/// At most `most` of the points: if there are more, those within one cell of a grid, which is finer
/// than a marker, are replaced by one.
pub(crate) fn thin_markers(mut points: Vec<Point>, most: usize) -> Vec<Point> {
    let mut cell = COLUMN;
    while points.len() > most {
        let mut seen = HashSet::new();
        points.retain(|at| seen.insert(((at.x / cell) as i64, (at.y / cell) as i64)));
        cell *= 1.5;
    }
    points
}
