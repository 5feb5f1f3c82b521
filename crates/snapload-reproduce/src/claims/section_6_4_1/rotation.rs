//! Section 6.4.1: the rotations of larger and smaller bodies.

use crate::claims::numbers::{falling, list, max, mean, min, rising, span, spearman};
use crate::claims::runs::{
    FEW, LARGE_SWING, MANY, Tabled, by_case, case, chapter, ending, first_rocking, from_starts,
    measured, past_settling, rotation, run, standard, swings, turns,
};
use crate::claims::verdict::{Finding, Judged, Judges, Verdict};
use snapload::{Impact, Parameters, Trajectory, natural_inertia};

pub(super) const JUDGES: &Judges<fn(&Tabled) -> Judged> = &[
    ("6.4.1-09", |tabled| {
        let shapes = tabled.of(SHAPES.map(|(_, code)| code))?;
        let found = with_rotation(&shapes, |[a, b]| a + b);
        let rotations = shapes[0].map(rotation);
        Ok(Finding::measured("rho", found, |rho| rho <= -RULE).list("rotations", rotations))
    }),
    ("6.4.1-35", |tabled| {
        let shapes = tabled.of(SHAPES.map(|(_, code)| code))?;
        let found = with_rotation(&shapes, inertia);
        // Each circle against the square as wide.
        let against = (0..3).all(|k| {
            inertia(SHAPES[k].0) > inertia(SHAPES[k + 3].0)
                && rotation(shapes[0][k]) > rotation(shapes[0][k + 3])
        });
        let rule = Finding::measured("rho", found, |rho| rho <= -RULE);
        Ok(rule.found("circles_against", against))
    }),
    ("6.4.1-37", |_| resisting()),
    ("6.4.1-10", |tabled| {
        let boxes = tabled.of(RECTANGLES)?;
        Ok(measured("rotations", &boxes, rotation, |all| rising(all)))
    }),
    ("6.4.1-11", rarer_swings),
    ("6.4.1-38", |tabled| {
        /// The fewest that are several.
        const SEVERAL: f64 = 2.0;
        let boxes = tabled.of(RECTANGLES)?;
        let costly = by_case(&boxes, |run| {
            mean_loss(run, true) > SEVERAL * mean_loss(run, false)
        });
        Ok(Finding::new(Verdict::all(costly))
            .value("size", LARGE_SWING)
            .list("large", boxes[0].map(|run| mean_loss(run, true)))
            .list("small", boxes[0].map(|run| mean_loss(run, false))))
    }),
    ("6.4.1-12", |tabled| {
        /// The last rotation over the largest, if the rotations get smaller.
        const SMALLER: f64 = 0.6;
        let ratios = tabled
            .of(RECTANGLES)?
            .into_iter()
            .map(|runs| runs.map(last_to_largest));
        let ratios: Vec<[f64; 3]> = ratios.collect();
        let all = || ratios.iter().flatten().copied();
        Ok(Finding::robust(&ratios, |of| max(*of) < SMALLER)
            .values("least most", [min(all()), max(all())]))
    }),
    ("6.4.1-13", more_frequent),
    ("6.4.1-14", close_to_rocking),
];

/// The shapes of Table 6.2 with their codes: circles, squares, rectangles.
const SHAPES: [([f64; 2], &str); 8] = [
    ([0.1, 0.0], "1910001000-359"),
    ([0.2, 0.0], "1920001000-359"),
    ([0.3, 0.0], "1930001000-359"),
    ([0.1, 0.1], "1911001000-359"),
    ([0.2, 0.2], "1922001000-359"),
    ([0.3, 0.3], "1933001000-359"),
    ([0.2, 0.1], "1921001000-359"),
    ([0.3, 0.1], "1931001000-359"),
];
/// Figs 6.8-6.10: a = 0.1, 0.2, 0.3 with b = 0.1.
const RECTANGLES: [&str; 3] = ["1911001000-359", "1921001000-359", "1931001000-359"];

/// A rank correlation from which on one speaks of a rule.
const RULE: f64 = 0.5;

fn inertia([a, b]: [f64; 2]) -> f64 {
    natural_inertia(a, b).unwrap_or(0.0)
}

/// Rank correlation of a measure of the shapes with their rotation, by start.
fn with_rotation(shapes: &[[&Trajectory; 8]], measure: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
    let of = |runs: &[&Trajectory; 8]| {
        let points = SHAPES.iter().zip(runs);
        let points = points.map(|((size, _), run)| (measure(*size), rotation(run)));
        spearman(&points.collect::<Vec<_>>())
    };
    shapes.iter().map(of).collect()
}

fn resisting() -> Judged {
    // Each shape with half, all and twice its moment of inertia.
    let cases = SHAPES.iter().flat_map(|(size, _)| {
        [0.5, 1.0, 2.0].map(|factor| {
            let inertia = Some(factor * inertia(*size));
            chapter(standard(|p| ([p.a, p.b], p.inertia) = (*size, inertia)))
        })
    });
    let cases: Vec<Parameters> = cases.collect();
    let rotations = from_starts(&cases, FEW, |case| Ok(rotation(&run(case)?)))?;
    let reduced = rotations.iter().map(|all| {
        let doublings = all.chunks(3).flat_map(|shape| shape.windows(2));
        doublings.filter(|pair| falling(pair)).count() as f64
    });
    // As a rule: in three quarters of the doublings.
    let doublings = 2 * SHAPES.len();
    let finding = Finding::measured("reduced", reduced, |count| count >= 0.75 * doublings as f64);
    Ok(finding.value("doublings", doublings))
}

fn rarer_swings(tabled: &Tabled) -> Judged {
    let boxes = tabled.of(RECTANGLES)?;
    // What is large is a matter of taste: it holds around the chosen size, too, or not at all.
    let sizes = [0.9 * LARGE_SWING, LARGE_SWING, 1.1 * LARGE_SWING];
    // Swings above some size per unit time.
    let rates = |runs: &[&Trajectory; 3], size: f64| {
        runs.map(|run| {
            let large = swings(run).into_iter().filter(|swing| *swing > size);
            large.count() as f64 / run.end().t
        })
    };
    let words = sizes.map(|size| {
        let rates = list(&rates(&boxes[0], size), 3);
        format!("above {size:.2} rad {rates}")
    });
    let rarer = |runs: &_| sizes.iter().all(|size| falling(&rates(runs, *size)));
    Ok(Finding::robust(&boxes, rarer)
        .value("rates", words.join("; "))
        .list("inertia", [0.1, 0.2, 0.3].map(|a| inertia([a, 0.1]))))
}

/// Mean energy lost in the impacts of a large swing, or of a smaller one.
fn mean_loss(run: &Trajectory, large: bool) -> f64 {
    let turns = turns(run);
    let swings = turns.windows(2).map(|pair| (pair[0], pair[1]));
    let some = swings.filter(|(p, q)| ((q.1 - p.1).abs() > LARGE_SWING) == large);
    mean(some.map(|(p, q)| {
        let within = |hit: &&Impact| p.0 < hit.t && hit.t <= q.0;
        let hits = run.impacts().iter().filter(within);
        hits.map(|hit| hit.energy_lost).sum()
    }))
}

/// |θ| at the turns of a quarter of the run, 0 to 3.
fn quarter(run: &Trajectory, which: u8) -> Vec<f64> {
    let at = |k: u8| run.end().t * f64::from(k) / 4.0;
    let mut turns = turns(run);
    turns.retain(|turn| turn.0 >= at(which) && (turn.0 < at(which + 1) || which == 3));
    turns.into_iter().map(|turn| turn.1.abs()).collect()
}

/// Largest rotation in the last quarter over that in the strongest.
fn last_to_largest(run: &Trajectory) -> f64 {
    let largest = |which: u8| quarter(run, which).into_iter().fold(0.0, f64::max);
    let most = (0..4).map(largest).fold(0.0, f64::max);
    if most > 0.0 { largest(3) / most } else { 1.0 }
}

fn more_frequent(tabled: &Tabled) -> Judged {
    let boxes = tabled.of(RECTANGLES)?;
    let counts = |run: &Trajectory| [0, 3].map(|which| quarter(run, which).len());
    let verdicts = by_case(&boxes, |run| counts(run)[0] < counts(run)[1]);
    let words = boxes[0].map(|run| counts(run).map(|count| count.to_string()).join(" then "));
    let sure = verdicts.iter().zip([0.1, 0.2, 0.3]);
    let sure = sure.filter(|(verdict, _)| **verdict == Verdict::Reproduced);
    Ok(Finding::new(Verdict::all(verdicts))
        .value("turns", words.join(", "))
        .found("of_some", sure.clone().count() > 0)
        .list("widths", sure.map(|(_, a)| a)))
}

fn close_to_rocking(tabled: &Tabled) -> Judged {
    /// How long after the end rocking is still close to it.
    const AFTER: f64 = 10.0;
    let own = tabled.of(RECTANGLES)?[0];
    let mut cases = Vec::new();
    for (code, run) in RECTANGLES.iter().zip(own) {
        let t_end = run.end().t + AFTER;
        let case = past_settling(case(tabled.study, code)?.parameters);
        cases.push(Parameters { t_end, ..case });
    }
    let starts = from_starts(&cases, MANY, first_rocking)?;
    let of = |k: usize| starts.iter().map(move |all| all[k]);
    let rocks = (0..own.len()).map(|k| Verdict::robust(of(k).map(|t| t.is_some())));
    let words = [0, 1, 2].map(|k| {
        let times = span(of(k).flatten(), 2);
        format!("{}, rocks from {times}", ending(own[k]))
    });
    Ok(Finding::new(Verdict::all(rocks)).value("runs", words.join("; ")))
}
