//! Where words go inside a plot: beside what they name, where the least ink is.

use crate::area::SMALL;
use crate::plot::{Mark, Point};
use crate::polyline::Rect;
use crate::svg::{Anchor, Sheet};
use crate::text::{CAP_HEIGHT, width};

/// The radius of a dot at a mark, in points.
const DOT: f64 = 1.6;
/// Dots closer than this on paper are one.
const SAME_PLACE: f64 = 2.5 * DOT;
/// The ink of a word or a dot, where a line counts one: lines may be crossed, words may not.
const WORD: u32 = 50;
/// How far words stay from the frame.
const RIM: f64 = 3.0;
/// How many places along a boundary are tried for its name.
const TRIES: usize = 60;
/// From this distance on, nobody takes the name of one boundary for that of another.
const UNMISTAKABLE: f64 = 40.0;

/// How much is drawn on each square point of a plot.
pub(crate) struct Ink {
    frame: Rect,
    columns: usize,
    cells: Vec<u32>,
}

impl Ink {
    pub(crate) fn new(frame: Rect) -> Self {
        let columns = frame.width.ceil() as usize + 1;
        let rows = frame.height.ceil() as usize + 1;
        Self {
            frame,
            columns,
            cells: vec![0; columns * rows],
        }
    }

    pub(crate) fn add_lines(&mut self, pieces: &[Vec<Point>]) {
        for ends in pieces.iter().flat_map(|piece| piece.windows(2)) {
            let &[from, to] = ends else { continue };
            let d = [to[0] - from[0], to[1] - from[1]];
            let steps = f64::hypot(d[0], d[1]).ceil().max(1.0) as usize;
            for step in 0..=steps {
                let s = step as f64 / steps as f64;
                self.add([from[0] + s * d[0], from[1] + s * d[1]], 1);
            }
        }
    }

    fn add(&mut self, [x, y]: Point, amount: u32) {
        if self.frame.contains([x, y]) {
            let column = (x - self.frame.left).max(0.0) as usize;
            let row = (y - self.frame.top).max(0.0) as usize;
            if let Some(cell) = self.cells.get_mut(row * self.columns + column) {
                // A line that passes often is no worse to write on than one that passes once.
                *cell = (*cell).max(amount);
            }
        }
    }

    fn add_rect(&mut self, rect: &Rect) {
        for point in cells_of(rect) {
            self.add(point, WORD);
        }
    }

    /// The ink under a rectangle, or nothing if it comes too close to the frame.
    fn under(&self, rect: &Rect) -> Option<u32> {
        // Close to the frame an I looks like a tick.
        let corners = [
            [rect.left - RIM, rect.top - RIM],
            [rect.right() + RIM, rect.bottom() + RIM],
        ];
        if !corners
            .into_iter()
            .all(|corner| self.frame.contains(corner))
        {
            return None;
        }
        let at = |[x, y]: Point| {
            let column = (x - self.frame.left) as usize;
            let row = (y - self.frame.top) as usize;
            self.cells
                .get(row * self.columns + column)
                .copied()
                .unwrap_or(0)
        };
        Some(cells_of(rect).map(at).sum())
    }
}

/// A point in each cell that a rectangle, and half a point around it, touches.
fn cells_of(rect: &Rect) -> impl Iterator<Item = Point> {
    let (left, top) = (rect.left - 0.5, rect.top - 0.5);
    let columns = rect.width.ceil() as u32 + 1;
    let rows = rect.height.ceil() as u32 + 1;
    (0..rows).flat_map(move |row| {
        (0..columns).map(move |column| [left + f64::from(column), top + f64::from(row)])
    })
}

/// Draws dots, and their letters beside them; the places are on paper.
pub(crate) fn place_letters(sheet: &mut Sheet, ink: &mut Ink, marks: &[Mark]) {
    let mut merged: Vec<Mark> = Vec::new();
    for mark in marks {
        let near = |other: &&mut Mark| distance(other.at, mark.at) < SAME_PLACE;
        match merged.iter_mut().find(near) {
            Some(other) => other.letter = format!("{},{}", other.letter, mark.letter),
            None => merged.push(mark.clone()),
        }
    }
    for mark in &merged {
        let [x, y] = mark.at;
        let size = 2.0 * DOT;
        ink.add_rect(&Rect {
            left: x - DOT,
            top: y - DOT,
            width: size,
            height: size,
        });
        sheet.dot(mark.at, DOT);
    }
    for mark in &merged {
        let size = word_size(&mark.letter);
        let candidates = [3.0, 5.0, 8.0, 12.0]
            .into_iter()
            .flat_map(|gap| beside(mark.at, size, DOT + gap - 1.5));
        write_best(sheet, ink, &mark.letter, candidates);
    }
}

/// Writes the names of boundaries, each beside its own and away from the others; the pieces are on
/// paper.
pub(crate) fn name_boundaries(
    sheet: &mut Sheet,
    ink: &mut Ink,
    boundaries: &[(&str, Vec<Vec<Point>>)],
) {
    let traces: Vec<Vec<Point>> = boundaries.iter().map(|(_, pieces)| along(pieces)).collect();
    for (own, (name, _)) in boundaries.iter().enumerate() {
        let size = word_size(name);
        let every = (traces[own].len() / TRIES).max(1);
        let others = || traces.iter().enumerate().filter(|&(index, _)| index != own);
        let uncertainty = |at: Point| {
            let points = others().flat_map(|(_, trace)| trace);
            let nearest = points
                .map(|&other| distance(at, other))
                .fold(UNMISTAKABLE, f64::min);
            2.0 * (UNMISTAKABLE - nearest)
        };
        let candidates = traces[own].iter().step_by(every).flat_map(|&at| {
            let uncertainty = uncertainty(at);
            beside(at, size, 2.5).map(|(rect, cost)| (rect, cost + uncertainty))
        });
        write_best(sheet, ink, name, candidates);
    }
}

/// Points a small step apart along a line.
fn along(pieces: &[Vec<Point>]) -> Vec<Point> {
    let mut points = Vec::new();
    for ends in pieces.iter().flat_map(|piece| piece.windows(2)) {
        let &[from, to] = ends else { continue };
        let steps = (distance(from, to) / 2.0).ceil().max(1.0) as usize;
        points.extend((0..=steps).map(|step| {
            let s = step as f64 / steps as f64;
            [
                from[0] + s * (to[0] - from[0]),
                from[1] + s * (to[1] - from[1]),
            ]
        }));
    }
    points
}

fn distance(a: Point, b: Point) -> f64 {
    f64::hypot(a[0] - b[0], a[1] - b[1])
}

fn word_size(word: &str) -> [f64; 2] {
    [width(word) * SMALL, CAP_HEIGHT * SMALL]
}

/// Eight boxes around a point, nearest first, each with what it costs to stand so far away.
fn beside(at: Point, [wide, high]: [f64; 2], gap: f64) -> [(Rect, f64); 8] {
    const DIRECTIONS: [Point; 8] = [
        [1.0, -0.6],
        [-1.0, -0.6],
        [1.0, 0.6],
        [-1.0, 0.6],
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [0.0, 1.0],
    ];
    DIRECTIONS.map(|[dx, dy]| {
        let centre = [
            at[0] + dx * (gap + wide / 2.0),
            at[1] + dy * (gap + high / 2.0),
        ];
        let rect = Rect {
            left: centre[0] - wide / 2.0,
            top: centre[1] - high / 2.0,
            width: wide,
            height: high,
        };
        (rect, gap)
    })
}

/// Writes a word in the candidate with the least ink under it; of equal ones, in the first.
fn write_best(
    sheet: &mut Sheet,
    ink: &mut Ink,
    word: &str,
    candidates: impl Iterator<Item = (Rect, f64)>,
) {
    let best = candidates
        .filter_map(|(rect, cost)| ink.under(&rect).map(|ink| (rect, f64::from(ink) + cost)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((rect, _)) = best {
        ink.add_rect(&rect);
        sheet.text_with_halo(word, [rect.left, rect.bottom()], SMALL, Anchor::Start);
    }
}
