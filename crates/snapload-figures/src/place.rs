//! Places texts inside a plot: next to the object that they name, where the least is drawn.

use crate::polyline::holds;
use crate::svg::{Anchor, FRAME, SvgCanvas};
use crate::text::{CAP_HEIGHT, SMALL, width};
use kurbo::{Point, Rect, Size, Vec2};

/// The radius of a dot at a mark, in points.
const DOT: f64 = 1.6;
/// Dots closer than this on paper coincide.
const SAME_PLACE: f64 = 2.5 * DOT;
/// The weight of a text or a dot, in units of that of a line: lines may be crossed, texts may not.
const WORD: u32 = 50;
/// The distance between texts.
const APART: f64 = 4.0;
/// A letter farther than this from its dot is connected to it by a line.
const CONNECTED_FROM: f64 = 10.0;
/// The cost of each point of distance between a letter and its dot, in units of that of a crossed
/// line.
const DISTANCE_COST: f64 = 0.4;
/// A letter may be mistaken for that of another dot, unless that is this many times as far away as
/// its own.
const NEARER: f64 = 2.0;
/// The cost of that.
const MISTAKEN_COST: f64 = 200.0;
/// The distance of texts from the frame, near which an I looks like a tick.
const RIM: f64 = 3.0;
/// The number of positions along a boundary that are tried for its name.
const TRIES: usize = 60;
/// From this distance on, the name of one boundary is not mistaken for that of another.
const DISTINCT_FROM: f64 = 40.0;
/// The eight directions in which a text can be placed next to a point, the best first.
const DIRECTIONS: [Vec2; 8] = [
    Vec2::new(1.0, -0.6),
    Vec2::new(-1.0, -0.6),
    Vec2::new(1.0, 0.6),
    Vec2::new(-1.0, 0.6),
    Vec2::new(1.0, 0.0),
    Vec2::new(-1.0, 0.0),
    Vec2::new(0.0, -1.0),
    Vec2::new(0.0, 1.0),
];

/// The weight of what is drawn on each square point of a plot.
pub(crate) struct OccupiedAreas {
    frame: Rect,
    columns: usize,
    cells: Vec<u32>,
}

impl OccupiedAreas {
    pub(crate) fn new(frame: Rect) -> Self {
        let [columns, rows] = [frame.width(), frame.height()].map(|side| side.ceil() as usize + 1);
        let cells = vec![0; columns * rows];
        Self {
            frame,
            columns,
            cells,
        }
    }

    pub(crate) fn add_lines(&mut self, pieces: &[Vec<Point>]) {
        self.add(along(pieces, 1.0), 1);
    }

    fn add_rect(&mut self, rect: Rect) {
        self.add(cells_of(rect), WORD);
    }

    fn add(&mut self, points: impl Iterator<Item = Point>, amount: u32) {
        for point in points {
            if let Some(cell) = self.index(point).and_then(|at| self.cells.get_mut(at)) {
                // Several passes of a line make a position no worse for a text than one.
                *cell = amount.max(*cell);
            }
        }
    }

    fn index(&self, at: Point) -> Option<usize> {
        let [column, row] = [at.x - self.frame.x0, at.y - self.frame.y0].map(|v| v as usize);
        holds(self.frame, at).then_some(row * self.columns + column)
    }

    /// The weight of what is drawn under a rectangle; none if it is too close to the frame.
    fn under(&self, rect: Rect) -> Option<u32> {
        let weight = |at| self.index(at).and_then(|at| self.cells.get(at));
        let with_rim = rect.inflate(RIM, RIM);
        let inside = self.frame.inflate(1e-6, 1e-6).contains_rect(with_rim);
        inside.then(|| cells_of(rect).filter_map(weight).sum())
    }

    /// Writes a text at the candidate with the least weight under it; of equal ones, at the first.
    /// Returns its position.
    fn write(
        &mut self,
        canvas: &mut SvgCanvas,
        word: &str,
        candidates: impl Iterator<Item = (Rect, f64)>,
    ) -> Option<Rect> {
        let costs = candidates.filter_map(|(rect, cost)| {
            let weight = self.under(rect)?;
            Some((rect, f64::from(weight) + cost))
        });
        let (rect, _) = costs.min_by(|a, b| a.1.total_cmp(&b.1))?;
        self.add_rect(rect.inflate(APART, 0.0));
        canvas.text_with_halo(word, Point::new(rect.x0, rect.y1), SMALL, Anchor::Start);
        Some(rect)
    }
}

/// One point in each cell that a rectangle, enlarged by half a point, touches.
fn cells_of(rect: Rect) -> impl Iterator<Item = Point> {
    let corner = rect.origin() - Vec2::new(0.5, 0.5);
    let [columns, rows] = [rect.width(), rect.height()].map(|side| side.ceil() as u32 + 1);
    let row = move |row| {
        (0..columns).map(move |column| corner + Vec2::new(f64::from(column), f64::from(row)))
    };
    (0..rows).flat_map(row)
}

/// Points along a line, no further apart than `step`.
fn along(pieces: &[Vec<Point>], step: f64) -> impl Iterator<Item = Point> {
    let segments = pieces.iter().flat_map(|piece| piece.array_windows());
    segments.flat_map(move |&[from, to]| {
        let steps = (from.distance(to) / step).ceil().max(1.0) as u32;
        (0..=steps).map(move |k| from.lerp(to, f64::from(k) / f64::from(steps)))
    })
}

/// Rectangles for a text next to a point, each with the cost of its distance.
fn positions_next_to(at: Point, word: &str, gap: f64) -> impl Iterator<Item = (Rect, f64)> {
    let size = Size::new(width(word) * SMALL, CAP_HEIGHT * SMALL);
    let reach = size / 2.0 + Size::new(gap, gap);
    DIRECTIONS.into_iter().map(move |d| {
        let centre = at + Vec2::new(d.x * reach.width, d.y * reach.height);
        (Rect::from_center_size(centre, size), gap)
    })
}

/// The point of a rectangle that is nearest to another one.
fn nearest(rect: Rect, to: Point) -> Point {
    Point::new(to.x.clamp(rect.x0, rect.x1), to.y.clamp(rect.y0, rect.y1))
}

/// Draws dots, and their letters next to them; letters of coinciding dots are joined.
pub(crate) fn place_letters(
    canvas: &mut SvgCanvas,
    occupied: &mut OccupiedAreas,
    marks: &[(Point, &str)],
) {
    let mut places: Vec<(Point, String)> = Vec::new();
    for &(at, letter) in marks {
        match places
            .iter_mut()
            .find(|place| place.0.distance(at) < SAME_PLACE)
        {
            Some((_, letters)) => *letters += &format!(",{letter}"),
            None => places.push((at, letter.to_owned())),
        }
    }
    for &(at, _) in &places {
        occupied.add_rect(Rect::from_center_size(at, (2.0 * DOT, 2.0 * DOT)));
        canvas.dot(at, DOT);
    }
    for (own, (at, letters)) in places.iter().enumerate() {
        let others = || places[..own].iter().chain(&places[own + 1..]);
        let gaps = [3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 42.0].into_iter();
        let candidates = gaps.flat_map(|gap| positions_next_to(*at, letters, DOT + gap - 1.5));
        let candidates = candidates.map(|(rect, cost)| {
            let distances = others().map(|(other, _)| nearest(rect, *other).distance(*other));
            let other = distances.fold(f64::INFINITY, f64::min);
            let is_taken = other < NEARER * nearest(rect, *at).distance(*at);
            (
                rect,
                DISTANCE_COST * cost + if is_taken { MISTAKEN_COST } else { 0.0 },
            )
        });
        if let Some(rect) = occupied.write(canvas, letters, candidates) {
            let near = nearest(rect, *at);
            if near.distance(*at) > CONNECTED_FROM {
                canvas.segment(*at, near.lerp(*at, 2.0 / near.distance(*at)), FRAME);
            }
        }
    }
}

/// Writes the names of boundaries, each next to its own and away from the others.
pub(crate) fn name_boundaries(
    canvas: &mut SvgCanvas,
    occupied: &mut OccupiedAreas,
    boundaries: &[(Vec<Vec<Point>>, &str)],
) {
    let traces = boundaries
        .iter()
        .map(|(pieces, _)| along(pieces, 2.0).collect());
    let traces: Vec<Vec<Point>> = traces.collect();
    for (own, (_, name)) in boundaries.iter().enumerate() {
        let others = || traces[..own].iter().chain(&traces[own + 1..]).flatten();
        let candidates = traces[own]
            .iter()
            .step_by((traces[own].len() / TRIES).max(1));
        let candidates = candidates.flat_map(|&at| {
            let distances = others().map(|other| other.distance(at));
            let ambiguity = 2.0 * (DISTINCT_FROM - distances.fold(DISTINCT_FROM, f64::min));
            positions_next_to(at, name, 2.5).map(move |(rect, cost)| (rect, cost + ambiguity))
        });
        occupied.write(canvas, name, candidates);
    }
}
