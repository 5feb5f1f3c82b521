//! Section 6.4.1: cable length, and the region in which the body moves.

use crate::claims::numbers::{list, range};
use crate::claims::runs::{Tabled, endings, exceeds, places};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{Stop, Trajectory, anchor_height};

/// The shapes of Figs 6.1-6.6, and their codes in the order of the figures.
const THREE: [[f64; 2]; 3] = [[0.1, 0.0], [0.1, 0.1], [0.2, 0.1]];
const FIGURES: [&str; 6] = [
    "1910001000-359",
    "2910001000-359",
    "1911001000-359",
    "2911001000-359",
    "1921001000-359",
    "2921001000-359",
];

pub(super) fn claims(study: &Study, tabled: &Tabled) -> Vec<Claim> {
    vec![
        claim(
            "6.4.1-01",
            "The region comes to a sharper point at its bottom with the shorter cables.",
            sharper(),
        ),
        claim(
            "6.4.1-02",
            "With longer cables the centre moves over a wider and flatter range.",
            wider(tabled),
        ),
        claim(
            "6.4.1-03",
            "With r = 2.5 the rotation limit comes before any settling; with r = 1.5 the body \
             settles.",
            reaches(tabled),
        ),
        claim(
            "6.4.1-04",
            "With r = 2.5 the force amplitude of 0.3 is above the critical one.",
            above_its_critical(study, tabled),
        ),
        claim(
            "6.4.1-05",
            "The bottom gets flatter with the size of the body, width or height.",
            flatter_with_size(),
        ),
        claim(
            "6.4.1-06",
            "Connection points farther apart flatten the bottom.",
            flatter_with_spacing(),
        ),
        claim(
            "6.4.1-07",
            "Longer cables flatten it further, whatever the size.",
            flatter_with_length(study),
        ),
        claim(
            "6.4.1-08",
            "A frame that holds the motions of Figs 6.1-6.5 does not hold that of Fig. 6.6.",
            out_of_frame(tabled),
        ),
    ]
}

/// The height at which the width of the region is taken: half of that of the start.
const HEIGHT: f64 = 0.05;

/// How flat the bottom of the region is.
#[derive(Clone, Copy)]
struct Bottom {
    /// Slope of both boundaries where they meet, without rotation.
    slope: f64,
    /// The largest x of the centre at a height, at any rotation.
    reach: f64,
}

impl Bottom {
    fn of(r: f64, [a, b]: [f64; 2]) -> Self {
        Self {
            slope: (1.0 - a) / anchor_height(r, a),
            reach: range((-90..=90).filter_map(|k| reach(r, [a, b], f64::from(k)))).1,
        }
    }

    fn flatter_than(self, other: Self) -> bool {
        self.slope < other.slope && self.reach > other.reach
    }
}

/// The largest x that the cables allow at a tilt in degrees, if they allow any.
fn reach(r: f64, [a, b]: [f64; 2], tilt: f64) -> Option<f64> {
    let (s, c) = tilt.to_radians().sin_cos();
    let below = anchor_height(r, a) + b - HEIGHT - b * c;
    // How far each fairlead may be from its anchor, across.
    let [right, left] = [below - a * s, below + a * s].map(|d| (r * r - d * d).sqrt());
    let (least, most) = (1.0 - c * a + s * b - right, left - 1.0 + c * a + s * b);
    (least <= most).then_some(most)
}

fn measures(bottoms: &[Bottom]) -> String {
    let of = |value: fn(&Bottom) -> f64| bottoms.iter().map(value).collect::<Vec<_>>();
    let (slopes, reaches) = (of(|k| k.slope), of(|k| k.reach));
    format!(
        "slope {}, half-width at y = {HEIGHT} {}",
        list(&slopes, 3),
        list(&reaches, 3)
    )
}

fn sharper() -> Finding {
    let pairs = THREE.map(|size| [1.5, 2.5].map(|r| Bottom::of(r, size)));
    let words: Vec<String> = pairs.iter().map(|pair| measures(pair)).collect();
    Finding::new(
        Verdict::of(pairs.iter().all(|[short, long]| long.flatter_than(*short))),
        format!("r = 1.5, 2.5: {}", words.join("; ")),
    )
}

/// The spans of x and y up to a time.
fn spans(run: &Trajectory, until: f64) -> (f64, f64) {
    let points = places(run, (0.0, until), 0.005);
    let span = |(low, high): (f64, f64)| high - low;
    let x = span(range(points.iter().map(|p| p.0)));
    (x, span(range(points.iter().map(|p| p.1))))
}

fn wider(tabled: &Tabled) -> Finding {
    let members = tabled.of(&["1910001000-359", "2910001000-359"]);
    let measured: Vec<(f64, Vec<(f64, f64)>)> = members
        .iter()
        .map(|runs| {
            let (until, _) = range(runs.iter().map(|run| run.end().t));
            (until, runs.iter().map(|run| spans(run, until)).collect())
        })
        .collect();
    let holds = |spans: &[(f64, f64)]| match spans {
        [short, long] => long.0 > short.0 && long.1 / long.0 < short.1 / short.0,
        _ => false,
    };
    let evidence = measured.first().map_or(String::new(), |(until, spans)| {
        let flat: Vec<f64> = spans.iter().map(|s| s.1 / s.0).collect();
        let x: Vec<f64> = spans.iter().map(|s| s.0).collect();
        format!(
            "up to t = {until:.2}, r = 1.5, 2.5: range of x {}, height over width {}",
            list(&x, 3),
            list(&flat, 2)
        )
    });
    Finding::new(
        Verdict::robust(measured.iter().map(|(_, spans)| holds(spans))),
        evidence,
    )
}

fn reaches(tabled: &Tabled) -> Finding {
    let members = tabled.of(&["2910001000-359", "1910001000-359"]);
    let reasons = |runs: &Vec<&Trajectory>| {
        let reasons: Vec<Stop> = runs.iter().map(|run| run.end().reason).collect();
        reasons == [Stop::RotationLimit, Stop::Settled]
    };
    Finding::new(
        Verdict::robust(members.iter().map(reasons)),
        format!("r = 2.5, 1.5: {}", endings(&members)),
    )
}

fn above_its_critical(study: &Study, tabled: &Tabled) -> Finding {
    let row = study
        .critical
        .iter()
        .find(|row| row.r == 2.5 && row.size == [0.1, 0.0]);
    let critical = row
        .and_then(|row| row.computed.chapter.first)
        .map(|first| first.f_o);
    let members = tabled.of(&["2910001000-359"]);
    let holds = |runs: &Vec<&Trajectory>| {
        critical.is_some_and(|f_o| f_o < 0.3) && runs.iter().all(|run| exceeds(run))
    };
    Finding::new(
        Verdict::robust(members.iter().map(holds)),
        critical.map_or("none exceeds".to_owned(), |f_o| {
            format!("critical: {f_o:.2}")
        }),
    )
}

/// The bottoms for a = 0.1, 0.2, 0.3.
fn by_width(r: f64, b: f64) -> [Bottom; 3] {
    [0.1, 0.2, 0.3].map(|a| Bottom::of(r, [a, b]))
}

fn flattens(bottoms: &[Bottom]) -> bool {
    let flatter = |pair: &[Bottom]| matches!(pair, [p, q] if q.flatter_than(*p));
    bottoms.len() > 1 && bottoms.windows(2).all(flatter)
}

fn flatter_with_size() -> Finding {
    let (rings, high) = (by_width(1.5, 0.0), by_width(1.5, 0.1));
    let mut pairs = rings.iter().zip(&high);
    let not_sharper = pairs.all(|(low, high)| high.reach >= low.reach && high.slope <= low.slope);
    let narrower = rings
        .iter()
        .zip(&high)
        .all(|(low, high)| high.reach < low.reach);
    Finding::new(
        Verdict::of(flattens(&rings) && not_sharper),
        format!(
            "a = 0.1, 0.2, 0.3: with b = 0 {}; with b = 0.1 {}",
            measures(&rings),
            measures(&high)
        ),
    )
    .because(
        Verdict::NotReproduced,
        flattens(&rings) && flattens(&high) && narrower,
        "True of the width, which sets the connection points apart. A higher body hangs farther \
         below them, and has less room at the bottom.",
    )
}

fn flatter_with_spacing() -> Finding {
    let all = [(1.5, 0.0), (1.5, 0.1), (2.5, 0.0), (2.5, 0.1)];
    let bottoms = all.map(|(r, b)| by_width(r, b));
    let words = all.iter().zip(&bottoms).map(|((r, b), bottoms)| {
        let measures = measures(bottoms);
        format!("r = {r}, b = {b}: {measures}")
    });
    Finding::new(
        Verdict::of(bottoms.iter().all(|bottoms| flattens(bottoms))),
        format!(
            "a = 0.1, 0.2, 0.3: {}",
            words.collect::<Vec<_>>().join("; ")
        ),
    )
}

fn flatter_with_length(study: &Study) -> Finding {
    let sizes = study.critical.iter().filter(|row| row.r == 1.5);
    let pairs = sizes.map(|row| [1.5, 2.5].map(|r| Bottom::of(r, row.size)));
    let flatter: Vec<bool> = pairs
        .map(|[short, long]| long.flatter_than(short))
        .collect();
    let count = flatter.iter().filter(|flatter| **flatter).count();
    Finding::new(
        Verdict::of(count == flatter.len() && count > 0),
        format!("{count} of {} shapes", flatter.len()),
    )
}

fn out_of_frame(tabled: &Tabled) -> Finding {
    let extent = |run: &&Trajectory| {
        let points = places(run, (0.0, run.end().t), 0.005);
        let x = range(points.iter().map(|p| p.0.abs())).1;
        [x, range(points.iter().map(|p| p.1)).1]
    };
    // The frame of the others, and what the last needs.
    let frame = |runs: &Vec<&Trajectory>| {
        let all: Vec<[f64; 2]> = runs.iter().map(extent).collect();
        let (last, others) = all.split_last()?;
        Some([[0, 1].map(|k| range(others.iter().map(|p| p[k])).1), *last])
    };
    let members = tabled.of(&FIGURES);
    let frames: Vec<[[f64; 2]; 2]> = members.iter().filter_map(frame).collect();
    let evidence = frames.first().map_or(String::new(), |[[x, y], last]| {
        format!(
            "|x| and y up to {x:.3} and {y:.3} in Figs 6.1-6.5, {:.3} and {:.3} in Fig. 6.6",
            last[0], last[1]
        )
    });
    let leaves = |[frame, last]: &[[f64; 2]; 2]| last[0] > frame[0] || last[1] > frame[1];
    Finding::new(Verdict::robust(frames.iter().map(leaves)), evidence)
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
        let widths = by_width(r, 0.0);
        let narrowing: Vec<Bottom> = widths.iter().rev().copied().collect();
        assert!(flattens(&widths) && !flattens(&narrowing) && !flattens(&widths[..1]));
        assert!(!widths[0].flatter_than(widths[0]));
    }
}
