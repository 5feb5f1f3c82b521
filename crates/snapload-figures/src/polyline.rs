//! Polylines on paper: cut to the frame, and thinned where the eye cannot tell.
//!
//! All lengths here are points on paper (1/72 inch).

use crate::plot::Point;

/// How far a thinned line may stray from the given one.
#[cfg(test)]
const VISIBLE: f64 = 0.2;
/// How far the simplification may stray; [`columns`] adds at most [`COLUMN`].
const TOLERANCE: f64 = 0.05;
/// The width of the columns in which a long line over time keeps only its extremes.
const COLUMN: f64 = 0.1;
/// How many points a line has before its columns are looked at.
const LONG: usize = 5_000;
/// The simplification works on stretches of this length, which bounds its time.
const STRETCH: usize = 1_000;

/// A rectangle on paper; y grows downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(crate) fn contains(&self, [x, y]: Point) -> bool {
        // A point on the edge belongs to the frame, whatever the rounding of its place.
        let air = 1e-6;
        x >= self.left - air
            && x <= self.right() + air
            && y >= self.top - air
            && y <= self.bottom() + air
    }
}

/// The pieces of a polyline inside the rectangle.
pub(crate) fn clip(points: &[Point], frame: &Rect) -> Vec<Vec<Point>> {
    if let [only] = points {
        return if frame.contains(*only) {
            vec![vec![*only]]
        } else {
            Vec::new()
        };
    }
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    for ends in points.windows(2) {
        let &[from, to] = ends else { continue };
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

/// The part of a segment inside the rectangle (Liang and Barsky 1984).
fn clip_segment(from: Point, to: Point, frame: &Rect) -> Option<(Point, Point)> {
    let d = [to[0] - from[0], to[1] - from[1]];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let edges = [
        (-d[0], from[0] - frame.left),
        (d[0], frame.right() - from[0]),
        (-d[1], from[1] - frame.top),
        (d[1], frame.bottom() - from[1]),
    ];
    for (toward, room) in edges {
        if toward == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if toward < 0.0 {
            enter = enter.max(room / toward);
        } else {
            leave = leave.min(room / toward);
        }
    }
    if enter > leave {
        return None;
    }
    // Clamped, because rounding is large where the ends are far outside.
    let at = |s: f64| {
        [
            (from[0] + s * d[0]).clamp(frame.left, frame.right()),
            (from[1] + s * d[1]).clamp(frame.top, frame.bottom()),
        ]
    };
    let inside = |end: Point, s: f64| if frame.contains(end) { end } else { at(s) };
    Some((inside(from, enter), inside(to, leave)))
}

/// A polyline that looks the same and has far fewer points.
pub(crate) fn thin(points: &[Point]) -> Vec<Point> {
    let advances = points.windows(2).all(|ends| ends[0][0] <= ends[1][0]);
    if points.len() > LONG && advances {
        simplify(&columns(points))
    } else {
        simplify(points)
    }
}

/// Of a line over time, the first, lowest, highest and last point of each column.
fn columns(points: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| (a[0] / COLUMN).floor() == (b[0] / COLUMN).floor()) {
        let by_height = |a: &usize, b: &usize| column[*a][1].total_cmp(&column[*b][1]);
        let mut picks = vec![0, column.len() - 1];
        picks.extend((0..column.len()).min_by(by_height));
        picks.extend((0..column.len()).max_by(by_height));
        picks.sort_unstable();
        picks.dedup();
        kept.extend(picks.into_iter().map(|index| column[index]));
    }
    kept
}

/// Douglas and Peucker's simplification, stretch by stretch.
fn simplify(points: &[Point]) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let last = points.len() - 1;
    let mut keep = vec![false; points.len()];
    let mut open: Vec<(usize, usize)> = (0..last)
        .step_by(STRETCH)
        .map(|start| (start, (start + STRETCH).min(last)))
        .collect();
    while let Some((from, to)) = open.pop() {
        keep[from] = true;
        keep[to] = true;
        let distance =
            |&index: &usize| distance_to_segment(points[index], points[from], points[to]);
        let farthest = (from + 1..to).max_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(index) = farthest.filter(|index| distance(index) > TOLERANCE) {
            open.push((from, index));
            open.push((index, to));
        }
    }
    points
        .iter()
        .zip(keep)
        .filter(|(_, keep)| *keep)
        .map(|(point, _)| *point)
        .collect()
}

/// The distance of a point from the segment between two others.
fn distance_to_segment(point: Point, from: Point, to: Point) -> f64 {
    let d = [to[0] - from[0], to[1] - from[1]];
    let r = [point[0] - from[0], point[1] - from[1]];
    let length_squared = d[0] * d[0] + d[1] * d[1];
    let along = if length_squared > 0.0 {
        ((r[0] * d[0] + r[1] * d[1]) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    f64::hypot(r[0] - along * d[0], r[1] - along * d[1])
}

/// At most `most` of the points: where there are more, those that fall into one cell of a grid,
/// finer than a marker, are one.
pub(crate) fn thin_markers(points: &[Point], most: usize) -> Vec<Point> {
    let mut cell = COLUMN;
    let mut kept = points.to_vec();
    while kept.len() > most {
        let mut seen = std::collections::HashSet::new();
        kept.retain(|[x, y]| seen.insert(((x / cell) as i64, (y / cell) as i64)));
        cell *= 1.5;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Rect = Rect {
        left: 0.0,
        top: 0.0,
        width: 200.0,
        height: 100.0,
    };

    /// The largest distance of a given point from the thinned line.
    fn error(points: &[Point], thinned: &[Point]) -> f64 {
        let nearest = |point: &Point| {
            let to = |ends: &[Point]| distance_to_segment(*point, ends[0], ends[1]);
            thinned.windows(2).map(to).fold(f64::INFINITY, f64::min)
        };
        points.iter().map(nearest).fold(0.0, f64::max)
    }

    #[test]
    fn a_long_smooth_line_needs_few_points() {
        let wave = |i: u32| {
            [
                f64::from(i) / 500.0,
                50.0 + 40.0 * (f64::from(i) / 9000.0).sin(),
            ]
        };
        let points: Vec<Point> = (0..100_000).map(wave).collect();
        let thinned = thin(&points);
        assert!(thinned.len() < 600, "{}", thinned.len());
        let sample: Vec<Point> = points.iter().copied().step_by(97).collect();
        assert!(error(&sample, &thinned) < VISIBLE);
    }

    #[test]
    fn a_line_is_cut_at_the_frame() {
        let pieces = clip(
            &[[-10.0, 50.0], [10.0, 50.0], [10.0, 150.0], [20.0, 50.0]],
            &FRAME,
        );
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0], [[0.0, 50.0], [10.0, 50.0], [10.0, 100.0]]);
        assert_eq!(pieces[1], [[15.0, 100.0], [20.0, 50.0]]);
        assert!(clip(&[[-1.0, 0.0]], &FRAME).is_empty());
        assert!(clip(&[], &FRAME).is_empty());
    }

    #[test]
    fn an_end_far_away_does_not_pull_the_other_out_of_the_frame() {
        for to in [[500.0, 50.0], [1e20, 60.0], [100.0, 50.0]] {
            for point in clip(&[[1e200, 50.0], to], &FRAME).into_iter().flatten() {
                assert!(FRAME.contains(point), "{point:?}");
            }
        }
    }

    #[test]
    fn many_markers_are_thinned_and_few_are_not() {
        let points: Vec<Point> = (0..10_000).map(|i| [f64::from(i) / 50.0, 1.0]).collect();
        assert_eq!(thin_markers(&points[..100], 100).len(), 100);
        assert!((100..=1000).contains(&thin_markers(&points, 1000).len()));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn thinning_is_not_seen(
            noise in prop::collection::vec(0.0..100.0_f64, 2..800), repeat in 1..20_usize,
        ) {
            let n = noise.len() * repeat;
            let at = |i: usize| [200.0 * i as f64 / n as f64, noise[i % noise.len()]];
            let points: Vec<Point> = (0..n).map(at).collect();
            let thinned = thin(&points);
            prop_assert!(thinned.len() <= n);
            let sample: Vec<Point> = points.iter().copied().step_by(1 + n / 500).collect();
            prop_assert!(error(&sample, &thinned) < VISIBLE);
        }

        #[test]
        fn what_is_cut_lies_in_the_frame(
            points in prop::collection::vec(prop::array::uniform2(-300.0..300.0_f64), 0..50),
        ) {
            for point in clip(&points, &FRAME).into_iter().flatten() {
                prop_assert!(FRAME.contains(point), "{point:?}");
            }
        }
    }
}
