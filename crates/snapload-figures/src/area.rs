//! The inside of one plot: from the data's units to positions on paper.

use crate::axis::Span;
use crate::plot::{self, drawable};
use crate::polyline::{clip, holds, thin};
use kurbo::{Point, Rect};

/// A rectangle on paper and the ranges of the two axes on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    pub(crate) rect: Rect,
    pub(crate) x: Span,
    pub(crate) y: Span,
}

impl Area {
    /// The position of a point of the data on paper.
    pub(crate) fn to_page(self, [x, y]: plot::Point) -> Point {
        let along = |v: f64, (lo, hi): Span| (v - lo) / (hi - lo);
        Point::new(
            self.rect.x0 + along(x, self.x) * self.rect.width(),
            self.rect.y1 - along(y, self.y) * self.rect.height(),
        )
    }

    /// A polyline on paper, clipped to the frame and to its drawable points, and thinned.
    pub(crate) fn line(self, points: &[plot::Point]) -> Vec<Vec<Point>> {
        let runs = points.split(|point| !drawable(point));
        let on_page = |run: &[plot::Point]| -> Vec<Point> {
            run.iter().map(|&point| self.to_page(point)).collect()
        };
        let pieces = runs.flat_map(|run| clip(&on_page(run), self.rect));
        pieces.map(|piece| thin(&piece)).collect()
    }

    /// The position of a point on paper, if it is inside the frame.
    pub(crate) fn seen(self, point: plot::Point) -> Option<Point> {
        let place = drawable(&point).then(|| self.to_page(point))?;
        holds(self.rect, place).then_some(place)
    }

    /// The part of the rectangle between two values of x.
    pub(crate) fn shaded(self, from: f64, to: f64) -> Option<Rect> {
        let (from, to) = (from.min(to).max(self.x.0), from.max(to).min(self.x.1));
        let [x0, x1] = [from, to].map(|x| self.to_page([x, self.y.0]).x);
        (x1 > x0).then_some(Rect {
            x0,
            x1,
            ..self.rect
        })
    }
}
