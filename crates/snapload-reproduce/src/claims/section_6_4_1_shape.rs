//! Section 6.4.1, first part: the region's bottom, cable length and the shape of the body.

use super::near::{
    Near, ending, endings, exceeds, falling, first_rocking, judged, list, nominal, places, range,
    rising, turns,
};
use super::{Claim, Verdict, ensemble, robust, spearman};
use crate::study::Study;
use rayon::prelude::*;
use snapload::{CaseError, Parameters, Stop, Trajectory, natural_inertia};

const SECTION: &str = "6.4.1";
/// The shapes of the series of cable lengths, and its codes in the order of Figs 6.1-6.6.
const THREE: [(f64, f64); 3] = [(0.1, 0.0), (0.1, 0.1), (0.2, 0.1)];
const FIGURES: [&str; 6] = [
    "1910001000-359",
    "2910001000-359",
    "1911001000-359",
    "2911001000-359",
    "1921001000-359",
    "2921001000-359",
];
/// The shapes of Table 6.2 with their codes.
const EIGHT: [(f64, f64, &str); 8] = [
    (0.1, 0.0, "1910001000-359"),
    (0.2, 0.0, "1920001000-359"),
    (0.3, 0.0, "1930001000-359"),
    (0.1, 0.1, "1911001000-359"),
    (0.2, 0.2, "1922001000-359"),
    (0.3, 0.3, "1933001000-359"),
    (0.2, 0.1, "1921001000-359"),
    (0.3, 0.1, "1931001000-359"),
];
const RECTANGLES: [&str; 3] = ["1911001000-359", "1921001000-359", "1931001000-359"];

pub(super) fn claims(study: &Study, near: &Near) -> Result<Vec<Claim>, CaseError> {
    let mut all = vec![
        sharper(),
        wider(near),
        reaches(near),
        above_its_critical(study, near),
        flatter_with_size(),
        flatter_with_spacing(),
        flatter_with_length(),
        out_of_frame(near),
        smaller_rotates(near),
        inertia(near),
    ];
    all.extend(rectangles(study, near)?);
    Ok(all)
}

/// How the bottom of the region is shaped.
#[derive(Clone, Copy)]
struct Bottom {
    /// Slope of both boundaries.
    slope: f64,
    /// Curvature of the curve on which both cables are taut.
    curvature: f64,
}

impl Bottom {
    fn of(r: f64, a: f64, b: f64) -> Self {
        let h = (r * r - (1.0 - a).powi(2)).sqrt();
        let (x, y) = both_taut((r, a, b), 0.05);
        Self {
            slope: (1.0 - a) / h,
            curvature: 2.0 * y / (x * x),
        }
    }

    fn flatter_than(self, other: Self) -> bool {
        self.slope < other.slope && self.curvature < other.curvature
    }
}

/// The centre where both cables are taut at a tilt, by Newton's method from rest.
fn both_taut((r, a, b): (f64, f64, f64), theta: f64) -> (f64, f64) {
    let h = (r * r - (1.0 - a).powi(2)).sqrt();
    let (s, c) = theta.sin_cos();
    let (mut x, mut y) = (0.0, 0.0);
    for _ in 0..30 {
        let p = [x + c * a - s * b - 1.0, y + s * a + c * b - h - b];
        let q = [x - c * a - s * b + 1.0, y - s * a + c * b - h - b];
        let f = [p, q].map(|d| (d[0] * d[0] + d[1] * d[1] - r * r) / 2.0);
        let det = p[0] * q[1] - p[1] * q[0];
        x -= (f[0] * q[1] - f[1] * p[1]) / det;
        y -= (f[1] * p[0] - f[0] * q[0]) / det;
    }
    (x, y)
}

fn pairs(bottoms: &[(Bottom, Bottom)]) -> String {
    let words = bottoms.iter().map(|(p, q)| {
        let (s, k) = ((p.slope, q.slope), (p.curvature, q.curvature));
        format!(
            "slope {:.3}/{:.3}, curvature {:.2}/{:.2}",
            s.0, s.1, k.0, k.1
        )
    });
    words.collect::<Vec<_>>().join("; ")
}

fn sharper() -> Claim {
    let bottoms = THREE.map(|(a, b)| (Bottom::of(1.5, a, b), Bottom::of(2.5, a, b)));
    judged(
        ("6.4.1-01", SECTION),
        "The region comes to a sharper point at its bottom with the shorter cables.",
        Verdict::of(
            bottoms
                .iter()
                .all(|(short, long)| long.flatter_than(*short)),
        ),
        format!("r = 1.5/2.5: {}", pairs(&bottoms)),
        "",
    )
}

/// The spans of x and y up to a time.
fn spans(run: &Trajectory, until: f64) -> (f64, f64) {
    let points = places(run, (0.0, until), 0.005);
    let span = |(low, high): (f64, f64)| high - low;
    let x = span(range(points.iter().map(|p| p.0)));
    (x, span(range(points.iter().map(|p| p.1))))
}

fn wider(near: &Near) -> Claim {
    let members = near.of(&["1910001000-359", "2910001000-359"]);
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
    judged(
        ("6.4.1-02", SECTION),
        "With longer cables the centre moves over a wider and flatter range.",
        robust(measured.iter().map(|(_, spans)| holds(spans))),
        evidence,
        "",
    )
}

fn reaches(near: &Near) -> Claim {
    let members = near.of(&["2910001000-359", "1910001000-359"]);
    let reasons = |runs: &Vec<&Trajectory>| {
        let reasons: Vec<Stop> = runs.iter().map(|run| run.end().reason).collect();
        reasons == [Stop::RotationLimit, Stop::Settled]
    };
    judged(
        ("6.4.1-03", SECTION),
        "With r = 2.5 the rotation limit comes before any settling; with r = 1.5 the body settles.",
        robust(members.iter().map(reasons)),
        format!("r = 2.5, 1.5: {}", endings(&members)),
        "",
    )
}

fn above_its_critical(study: &Study, near: &Near) -> Claim {
    let row = study
        .critical
        .iter()
        .find(|row| row.r == 2.5 && row.size == [0.1, 0.0]);
    let critical = row
        .and_then(|row| row.computed.chapter.first)
        .map(|first| first.f_o);
    let members = near.of(&["2910001000-359"]);
    let holds = |runs: &Vec<&Trajectory>| {
        critical.is_some_and(|f_o| f_o < 0.3) && runs.iter().all(|run| exceeds(run))
    };
    judged(
        ("6.4.1-04", SECTION),
        "With r = 2.5 the force amplitude of 0.3 is above the critical one.",
        robust(members.iter().map(holds)),
        critical.map_or("none exceeds".to_owned(), |f_o| {
            format!("critical: {f_o:.2}")
        }),
        "",
    )
}

/// The bottoms for a = 0.1, 0.2, 0.3.
fn by_width(r: f64, b: f64) -> [Bottom; 3] {
    [0.1, 0.2, 0.3].map(|a| Bottom::of(r, a, b))
}

fn flattens(bottoms: &[Bottom]) -> bool {
    bottoms
        .windows(2)
        .all(|pair| matches!(pair, [p, q] if q.flatter_than(*p)))
}

fn measures(bottoms: &[Bottom]) -> String {
    let of = |value: fn(&Bottom) -> f64| bottoms.iter().map(value).collect::<Vec<_>>();
    let (slopes, curvatures) = (of(|k| k.slope), of(|k| k.curvature));
    format!(
        "slope {}, curvature {}",
        list(&slopes, 3),
        list(&curvatures, 2)
    )
}

fn flatter_with_size() -> Claim {
    let (rings, high) = (by_width(1.5, 0.0), by_width(1.5, 0.1));
    let not_sharper = rings
        .iter()
        .zip(&high)
        .all(|(low, high)| high.slope <= low.slope && high.curvature <= low.curvature);
    judged(
        ("6.4.1-05", SECTION),
        "The bottom gets flatter with the size of the body, width or height.",
        Verdict::of(flattens(&rings) && not_sharper),
        format!(
            "a = 0.1, 0.2, 0.3: with b = 0 {}; with b = 0.1 {}",
            measures(&rings),
            measures(&high)
        ),
        "True of the width, which sets the connection points apart; a higher body makes the curve of \
         both cables taut sharper.",
    )
}

fn flatter_with_spacing() -> Claim {
    let all = [(1.5, 0.0), (1.5, 0.1), (2.5, 0.0), (2.5, 0.1)].map(|(r, b)| by_width(r, b));
    let words: Vec<String> = all.iter().map(|bottoms| measures(bottoms)).collect();
    judged(
        ("6.4.1-06", SECTION),
        "Connection points farther apart flatten the bottom.",
        Verdict::of(all.iter().all(|bottoms| flattens(bottoms))),
        format!("a = 0.1, 0.2, 0.3, by r and b: {}", words.join("; ")),
        "",
    )
}

fn flatter_with_length() -> Claim {
    let bottoms = EIGHT.map(|(a, b, _)| (Bottom::of(1.5, a, b), Bottom::of(2.5, a, b)));
    let flatter = bottoms
        .iter()
        .filter(|(short, long)| long.flatter_than(*short));
    let count = flatter.count();
    judged(
        ("6.4.1-07", SECTION),
        "Longer cables flatten it further, whatever the size.",
        Verdict::of(count == bottoms.len()),
        format!("{count} of {} shapes", bottoms.len()),
        "",
    )
}

fn out_of_frame(near: &Near) -> Claim {
    let extents: Vec<Vec<(f64, f64)>> = near
        .of(&FIGURES)
        .iter()
        .map(|runs| {
            let extent = |run: &&Trajectory| {
                let points = places(run, (0.0, run.end().t), 0.005);
                let x = range(points.iter().map(|p| p.0.abs())).1;
                (x, range(points.iter().map(|p| p.1)).1)
            };
            runs.iter().map(extent).collect()
        })
        .collect();
    let frame = |all: &[(f64, f64)]| -> Option<[(f64, f64); 2]> {
        let (last, others) = all.split_last()?;
        let x = range(others.iter().map(|p| p.0)).1;
        Some([(x, range(others.iter().map(|p| p.1)).1), *last])
    };
    // A scale that holds the others, is passed by the last, and is wide enough when doubled.
    let holds = |[(x, y), last]: [(f64, f64); 2]| {
        let (inner, outer) = (x.max(y), last.0.max(last.1));
        (last.0 > x || last.1 > y) && inner.max(outer / 2.0) < outer
    };
    let frames: Vec<[(f64, f64); 2]> = extents.iter().filter_map(|all| frame(all)).collect();
    let evidence = frames.first().map_or(String::new(), |[others, last]| {
        format!(
            "|x| and y up to {:.3} and {:.3} in Figs 6.1-6.5, {:.3} and {:.3} in Fig. 6.6",
            others.0, others.1, last.0, last.1
        )
    });
    judged(
        ("6.4.1-08", SECTION),
        "Fig. 6.6 leaves the frame that holds Figs 6.1-6.5; twice the scale holds it.",
        robust(frames.into_iter().map(holds)),
        evidence,
        "",
    )
}

fn rotation(run: &Trajectory) -> f64 {
    run.norms().theta_max
}

/// Rank correlation of a measure of the eight shapes with their rotation, by member.
fn with_rotation(near: &Near, measure: impl Fn(f64, f64) -> f64) -> (Vec<f64>, String) {
    let members = near.of(&EIGHT.map(|(_, _, code)| code));
    let correlations = members
        .iter()
        .map(|runs| {
            let points = EIGHT.iter().zip(runs);
            let points: Vec<(f64, f64)> = points
                .map(|((a, b, _), run)| (measure(*a, *b), rotation(run)))
                .collect();
            spearman(&points)
        })
        .collect();
    (correlations, nominal(&members, 3, rotation))
}

fn smaller_rotates(near: &Near) -> Claim {
    let (found, rotations) = with_rotation(near, |a, b| a + b);
    let (low, high) = range(found.iter().copied());
    judged(
        ("6.4.1-09", SECTION),
        "Smaller bodies rotate more.",
        robust(found.iter().map(|c| *c <= -0.5)),
        format!(
            "rank correlation of a + b and largest rotation {low:.2} to {high:.2}; circles, squares, \
             rectangles: {rotations}"
        ),
        "",
    )
}

fn inertia(near: &Near) -> Claim {
    let (found, _) = with_rotation(near, |a, b| natural_inertia(a, b).unwrap_or(0.0));
    let (low, high) = range(found.iter().copied());
    judged(
        ("6.4.1-35", SECTION),
        "A smaller moment of inertia goes with more rotation.",
        robust(found.iter().map(|c| *c <= -0.5)),
        format!("rank correlation of I and largest rotation {low:.2} to {high:.2}"),
        "A ring has more inertia than a solid square as wide, and still rotates far more: the arm of \
         the cable's force, set by where it is attached, weighs more.",
    )
}

fn rectangles(study: &Study, near: &Near) -> Result<Vec<Claim>, CaseError> {
    let members = near.of(&RECTANGLES);
    let grows = |runs: &Vec<&Trajectory>| {
        let rotations: Vec<f64> = runs.iter().map(|run| rotation(run)).collect();
        rising(&rotations)
    };
    Ok(vec![
        judged(
            ("6.4.1-10", SECTION),
            "Along Figs 6.8-6.10, ever wider bodies, the rotations get larger.",
            robust(members.iter().map(grows)),
            format!("largest rotation {}", nominal(&members, 3, rotation)),
            "",
        ),
        fewer_large_swings(&members),
        smaller_in_the_end(&members),
        more_frequent(&members),
        close_to_rocking(study, &members)?,
    ])
}

/// Swings above 0.5 rad per unit time.
fn large_swings(run: &Trajectory) -> f64 {
    let turns = turns(run);
    let large = |pair: &&[(f64, f64)]| matches!(pair, [p, q] if (q.1 - p.1).abs() > 0.5);
    turns.windows(2).filter(large).count() as f64 / run.end().t
}

fn fewer_large_swings(members: &[Vec<&Trajectory>]) -> Claim {
    let falls = |runs: &Vec<&Trajectory>| {
        let rates: Vec<f64> = runs.iter().map(|run| large_swings(run)).collect();
        falling(&rates)
    };
    judged(
        ("6.4.1-11", SECTION),
        "Along the same figures large swings get rarer.",
        robust(members.iter().map(falls)),
        format!(
            "swings above 0.5 rad per T: {}",
            nominal(members, 3, large_swings)
        ),
        "",
    )
}

/// The turns of a quarter of the run, 0 to 3.
fn quarter(run: &Trajectory, which: u8) -> Vec<f64> {
    let at = |k: u8| run.end().t * f64::from(k) / 4.0;
    let mut turns = turns(run);
    turns.retain(|turn| turn.0 >= at(which) && (turn.0 < at(which + 1) || which == 3));
    turns.into_iter().map(|turn| turn.1.abs()).collect()
}

fn last_to_largest(run: &Trajectory) -> f64 {
    let largest = |which: u8| quarter(run, which).into_iter().fold(0.0, f64::max);
    let most = (0..4).map(largest).fold(0.0, f64::max);
    if most > 0.0 { largest(3) / most } else { 1.0 }
}

fn smaller_in_the_end(members: &[Vec<&Trajectory>]) -> Claim {
    let holds = |runs: &Vec<&Trajectory>| runs.iter().all(|run| last_to_largest(run) < 0.6);
    let (low, high) = range(members.iter().flatten().map(|run| last_to_largest(run)));
    judged(
        ("6.4.1-12", SECTION),
        "Towards the end of these runs the rotations get smaller.",
        robust(members.iter().map(holds)),
        format!("rotation in the last quarter over that in the strongest: {low:.2} to {high:.2}"),
        "",
    )
}

fn more_frequent(members: &[Vec<&Trajectory>]) -> Claim {
    let counts = |run: &Trajectory| (quarter(run, 0).len(), quarter(run, 3).len());
    let verdicts: Vec<Verdict> = (0..RECTANGLES.len())
        .map(|k| {
            let runs = members.iter().filter_map(|runs| runs.get(k));
            robust(runs.map(|run| counts(run).0 < counts(run).1))
        })
        .collect();
    let verdict = if verdicts.contains(&Verdict::NotReproduced) {
        Verdict::NotReproduced
    } else if verdicts.contains(&Verdict::NotDecidable) {
        Verdict::NotDecidable
    } else {
        Verdict::Reproduced
    };
    let words: Vec<String> = members
        .first()
        .into_iter()
        .flatten()
        .map(|run| format!("{} then {}", counts(run).0, counts(run).1))
        .collect();
    judged(
        ("6.4.1-13", SECTION),
        "Towards the end of these runs the rotations get more frequent.",
        verdict,
        format!(
            "turns in the first and in the last quarter: {}",
            words.join(", ")
        ),
        "Clear of the widest body alone, where impacts pile up before it settles.",
    )
}

fn close_to_rocking(study: &Study, members: &[Vec<&Trajectory>]) -> Result<Claim, CaseError> {
    let settled = members.first().into_iter().flatten();
    let cases: Vec<(Parameters, String)> = RECTANGLES
        .iter()
        .zip(settled)
        .filter_map(|(code, run)| {
            let case = Parameters {
                stop_when_settled: false,
                t_end: run.end().t + 10.0,
                ..study.case(code)?.parameters
            };
            Some((case, ending(run)))
        })
        .collect();
    let starts: Vec<Vec<Option<f64>>> = cases
        .par_iter()
        .map(|(case, _)| ensemble(case, 8).into_iter().map(first_rocking).collect())
        .collect::<Result<_, CaseError>>()?;
    let rocks = (0..9).map(|m| {
        starts
            .iter()
            .all(|runs| matches!(runs.get(m), Some(Some(_))))
    });
    let words = cases.iter().zip(&starts).map(|((_, ending), starts)| {
        let (low, high) = range(starts.iter().flatten().copied());
        format!("{ending}, rocks from {low:.2}-{high:.2}")
    });
    Ok(judged(
        ("6.4.1-14", SECTION),
        "These runs end close to rocking.",
        robust(rocks),
        words.collect::<Vec<_>>().join("; "),
        "",
    ))
}
