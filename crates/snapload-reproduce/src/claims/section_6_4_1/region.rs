//! Section 6.4.1: the cable length, and the region in which the body moves.

use crate::ReportError;
use crate::claims::motions::{endings, exceeds, places};
use crate::claims::numbers::{max, min};
use crate::claims::runs::{TableRuns, row};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::{Stop, anchor_height};
use snapload_verify::RoundedRun;

pub(super) const CHECKS: &Checks<fn(&TableRuns) -> Checked> = &[
    ("6.4.1-01", |_| {
        // The shapes of Figs 6.1-6.6.
        let pairs = [[0.1, 0.0], [0.1, 0.1], [0.2, 0.1]].map(by_length);
        Ok(Finding::of(pairs.iter().all(|pair| flattens(pair)))
            .value("bottoms", pairs.map(|pair| measures(&pair)).join("; ")))
    }),
    ("6.4.1-02", wider),
    ("6.4.1-03", |table_runs| {
        let members = table_runs.of(["2910001000-359", "1910001000-359"])?;
        let reasons = |runs: &[&RoundedRun; 2]| runs.map(|run| run.end().reason);
        let as_said = [Stop::RotationLimit, Stop::Settled];
        Ok(Finding::robust(&members, |runs| reasons(runs) == as_said)
            .value("endings", endings(&members)))
    }),
    ("6.4.1-04", |table_runs| {
        let first = row(table_runs.study, 2.5, [0.1, 0.0])?.first();
        let critical = first.map_or(f64::INFINITY, |(f_o, _)| f_o);
        let members = table_runs.of(["2910001000-359"])?;
        let finding = Finding::robust(&members, |[run]| critical < 0.3 && exceeds(run));
        Ok(finding.value("critical", critical))
    }),
    ("6.4.1-05", |_| {
        let (rings, high) = (by_width(1.5, 0.0), by_width(1.5, 0.1));
        let narrower = rings.iter().zip(&high).all(|(p, q)| q.reach < p.reach);
        let [by_width, by_height] = by_size(&rings, &high);
        Ok(Finding::new(Verdict::families([by_width, by_height]))
            .values("low high", [&rings, &high].map(|of| measures(of)))
            .condition("of_the_width", by_width == Verdict::Reproduced && narrower))
    }),
    ("6.4.1-06", |_| {
        let all = [(1.5, 0.0), (1.5, 0.1), (2.5, 0.0), (2.5, 0.1)];
        let words = all.map(|(r, b)| format!("r = {r}, b = {b}: {}", measures(&by_width(r, b))));
        let finding = Finding::of(all.iter().all(|(r, b)| flattens(&by_width(*r, *b))));
        Ok(finding.value("bottoms", words.join("; ")))
    }),
    ("6.4.1-07", |table_runs| {
        let rows = table_runs.study.critical.iter().filter(|row| row.r == 1.5);
        let flatter: Vec<bool> = rows.map(|row| flattens(&by_length(row.size))).collect();
        let count = flatter.iter().filter(|flatter| **flatter).count();
        Ok(Finding::of(count == flatter.len() && count > 0)
            .values("flatter shapes", [count, flatter.len()])
            .value("height", HEIGHT))
    }),
    ("6.4.1-08", |table_runs| {
        let frames = frames(table_runs)?;
        let finding = Finding::robust(&frames, |[others, last]| !within(*last, *others));
        Ok(finding
            .by_start("others", frames.iter().map(|f| f[0]))
            .by_start("last", frames.iter().map(|f| f[1])))
    }),
    ("6.4.1-40", |table_runs| {
        let frames = frames(table_runs)?;
        Ok(
            Finding::robust(&frames, |[others, last]| doubled(*others, *last).is_some())
                .by_start("least", frames.iter().filter_map(|[p, q]| doubled(*p, *q)))
                .by_start("most", frames.iter().map(|frames| frames[1]))
                .by_start("filled", frames.iter().filter_map(|[p, q]| filled(*p, *q))),
        )
    }),
];

/// The height at which the width of the region is taken: half of that of the start.
const HEIGHT: f64 = 0.05;

/// The flatness of the region's bottom.
#[derive(Clone, Copy)]
struct Bottom {
    /// Slope of both boundaries where they meet, without rotation.
    slope: f64,
    /// The largest x of the centre at that height, at any rotation.
    reach: f64,
}

impl Bottom {
    fn of(r: f64, [a, b]: [f64; 2]) -> Self {
        Self {
            slope: (1.0 - a) / anchor_height(r, a),
            reach: max((-90..=90).filter_map(|k| reach(r, [a, b], f64::from(k)))),
        }
    }

    fn flatter_than(self, other: Self) -> bool {
        self.slope < other.slope && self.reach > other.reach
    }
}

/// The largest x that the cables allow at a rotation in degrees, if they allow any.
fn reach(r: f64, [a, b]: [f64; 2], tilt: f64) -> Option<f64> {
    let (s, c) = tilt.to_radians().sin_cos();
    let below = anchor_height(r, a) + b - HEIGHT - b * c;
    // The largest horizontal distance of each fairlead from its anchor.
    let [right, left] = [below - a * s, below + a * s].map(|d| (r * r - d * d).sqrt());
    let (least, most) = (1.0 - c * a + s * b - right, left - 1.0 + c * a + s * b);
    (least <= most).then_some(most)
}

/// The bottoms for r = 1.5, 2.5.
fn by_length(size: [f64; 2]) -> [Bottom; 2] {
    [1.5, 2.5].map(|r| Bottom::of(r, size))
}

/// The bottoms for a = 0.1, 0.2, 0.3.
fn by_width(r: f64, b: f64) -> [Bottom; 3] {
    [0.1, 0.2, 0.3].map(|a| Bottom::of(r, [a, b]))
}

fn flattens(bottoms: &[Bottom]) -> bool {
    bottoms.len() > 1 && bottoms.windows(2).all(|pair| pair[1].flatter_than(pair[0]))
}

/// Whether the bottom becomes flatter with the width, for low bodies and for high ones, and whether
/// no width's bottom becomes sharper with the height.
fn by_size(low: &[Bottom], high: &[Bottom]) -> [Verdict; 2] {
    let flatter = |(p, q): (&Bottom, &Bottom)| q.reach >= p.reach && q.slope <= p.slope;
    [
        Verdict::of(flattens(low) && flattens(high)),
        Verdict::of(low.iter().zip(high).all(flatter)),
    ]
}

fn measures(bottoms: &[Bottom]) -> String {
    let list = |value: fn(&Bottom) -> f64| -> String {
        let words: Vec<String> = bottoms.iter().map(|k| format!("{:.3}", value(k))).collect();
        words.join(", ")
    };
    let (slopes, reaches) = (list(|k| k.slope), list(|k| k.reach));
    format!("slope {slopes}, half-width at y = {HEIGHT} {reaches}")
}

/// The points of a run up to a time.
fn points(run: &RoundedRun, until: f64) -> Vec<[f64; 2]> {
    places(|t| run.at(t), (0.0, until), 0.005)
}

fn wider(table_runs: &TableRuns) -> Checked {
    let members = table_runs.of(["1910001000-359", "2910001000-359"])?;
    let until = |runs: &[&RoundedRun; 2]| min(runs.map(|run| run.end().t));
    // The range of x of both runs, and the range of y in parts of it.
    let ranges = members.iter().map(|runs| {
        let points = runs.map(|run| points(run, until(runs)));
        let range = |points: &[[f64; 2]], k: usize| {
            max(points.iter().map(|p| p[k])) - min(points.iter().map(|p| p[k]))
        };
        let x = points.each_ref().map(|points| range(points, 0));
        (x, [0, 1].map(|run| range(&points[run], 1) / x[run]))
    });
    let ranges: Vec<([f64; 2], [f64; 2])> = ranges.collect();
    Ok(Finding::robust(&ranges, |(x, flatness)| {
        x[1] > x[0] && flatness[1] < flatness[0]
    })
    .by_start("until", members.iter().map(|runs| [until(runs)]))
    .by_start("x", ranges.iter().map(|of| of.0))
    .by_start("flatness", ranges.iter().map(|of| of.1)))
}

/// Half-width and height of the smallest frame around the motions of Figs 6.1-6.5, and of the one
/// around that of Fig. 6.6, by start.
fn frames(table_runs: &TableRuns) -> Result<Vec<[[f64; 2]; 2]>, ReportError> {
    // Figs 6.1-6.6.
    let members = table_runs.of([
        "1910001000-359",
        "2910001000-359",
        "1911001000-359",
        "2911001000-359",
        "1921001000-359",
        "2921001000-359",
    ])?;
    let extent = |run: &RoundedRun| {
        let points = points(run, run.end().t);
        let x = points.iter().map(|p| p[0].abs());
        [max(x), max(points.iter().map(|p| p[1]))]
    };
    let frames = members.iter().map(|runs| {
        let [others @ .., last] = runs.map(extent);
        [[0, 1].map(|k| max(others.map(|p| p[k]))), last]
    });
    Ok(frames.collect())
}

/// Whether a motion stays within a frame.
fn within(extent: [f64; 2], frame: [f64; 2]) -> bool {
    extent
        .iter()
        .zip(frame)
        .all(|(extent, side)| *extent <= side)
}

/// The least frame that contains the other motions and, when twice as large, the last one; none if
/// it contains the last one as it is.
fn doubled(others: [f64; 2], last: [f64; 2]) -> Option<[f64; 2]> {
    let frame = [0, 1].map(|k| others[k].max(0.5 * last[k]));
    (!within(last, frame)).then_some(frame)
}

/// The part of the least such frame that the other motions fill, horizontally and vertically.
fn filled(others: [f64; 2], last: [f64; 2]) -> Option<[f64; 2]> {
    let frame = doubled(others, last)?;
    Some([0, 1].map(|k| others[k] / frame[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bottom_is_flat_by_geometry_alone() {
        // Without a body the region is the lens of two circles.
        let r: f64 = 1.5;
        let below = anchor_height(r, 0.0) - HEIGHT;
        let lens = (r * r - below * below).sqrt() - 1.0;
        assert!((Bottom::of(r, [0.0; 2]).reach - lens).abs() < 1e-12);
        assert_eq!(doubled([0.3, 0.2], [1.4, 1.6]), Some([0.7, 0.8]));
        // A motion that is no larger than the others is not cut off by a frame that contains these.
        assert_eq!(doubled([0.3, 0.2], [0.2, 0.2]), None);
        let widths = by_width(r, 0.0);
        let narrowing: Vec<Bottom> = widths.iter().rev().copied().collect();
        assert!(flattens(&widths) && !flattens(&narrowing) && !flattens(&widths[..1]));
        assert!(!widths[0].flatter_than(widths[0]));
        // Bodies that narrow the region, and bodies that are no flatter when high.
        let judged = by_size(&narrowing, &narrowing);
        assert_eq!(judged, [Verdict::NotReproduced, Verdict::Reproduced]);
        assert_eq!(by_size(&widths, &narrowing)[1], Verdict::NotReproduced);
    }
}
