//! Section 6.4.1: the rotations of larger and smaller bodies.

use crate::claims::numbers::{falling, list, mean, range, rising, span, spearman};
use crate::claims::runs::{
    FEW, LARGE_SWING, MANY, Tabled, by_member, chapter, ending, ensemble, first_rocking, near_all,
    nominal, of_all, swings, turns,
};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{CaseError, Parameters, Trajectory, natural_inertia};

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

type Members<'a> = [Vec<&'a Trajectory>];

pub(super) fn claims(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    let shapes = tabled.of(&SHAPES.map(|(_, code)| code));
    let boxes = tabled.of(&RECTANGLES);
    Ok(vec![
        claim("6.4.1-09", "Smaller bodies rotate more.", smaller(&shapes)),
        claim(
            "6.4.1-35",
            "Bodies with a smaller moment of inertia rotate more.",
            lighter(&shapes),
        ),
        claim(
            "6.4.1-37",
            "The less the moment of inertia resists, the more a body rotates.",
            resisting()?,
        ),
        claim(
            "6.4.1-10",
            "Along Figs 6.8-6.10, ever wider bodies, the rotations get larger.",
            larger_rotations(&boxes),
        ),
        claim(
            "6.4.1-11",
            "Along the same figures large swings get rarer.",
            rarer_swings(&boxes),
        ),
        claim(
            "6.4.1-38",
            "A large swing takes more energy than several small ones.",
            costly_swings(&boxes),
        ),
        claim(
            "6.4.1-12",
            "Towards the end of these runs the rotations get smaller.",
            smaller_in_the_end(&boxes),
        ),
        claim(
            "6.4.1-13",
            "Towards the end of these runs the rotations get more frequent.",
            more_frequent(&boxes),
        ),
        claim(
            "6.4.1-14",
            "These runs end close to rocking.",
            close_to_rocking(study, &boxes)?,
        ),
    ])
}

fn rotation(run: &Trajectory) -> f64 {
    run.norms().theta_max
}

/// Rank correlation of a measure of the shapes with their rotation, by member.
fn with_rotation(shapes: &Members, measure: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
    let of = |runs: &Vec<&Trajectory>| {
        let points = SHAPES.iter().zip(runs);
        let points = points.map(|((size, _), run)| (measure(*size), rotation(run)));
        spearman(&points.collect::<Vec<_>>())
    };
    shapes.iter().map(of).collect()
}

fn smaller(shapes: &Members) -> Finding {
    let found = with_rotation(shapes, |[a, b]| a + b);
    Finding::new(
        Verdict::robust(found.iter().map(|rho| *rho <= -RULE)),
        format!(
            "rank correlation of a + b and largest rotation {}; circles, squares, rectangles: {}",
            span(found, 2),
            nominal(shapes, 3, rotation)
        ),
    )
}

fn lighter(shapes: &Members) -> Finding {
    let inertia = |[a, b]: [f64; 2]| natural_inertia(a, b).unwrap_or(0.0);
    let found = with_rotation(shapes, inertia);
    let own = shapes.first().map_or(&[][..], Vec::as_slice);
    let rings = (0..3).filter_map(|k| Some((k, own.get(k)?, own.get(k + 3)?)));
    let against = rings.filter(|(k, ring, square)| {
        inertia(SHAPES[*k].0) > inertia(SHAPES[k + 3].0) && rotation(ring) > rotation(square)
    });
    Finding::new(
        Verdict::robust(found.iter().map(|rho| *rho <= -RULE)),
        format!(
            "rank correlation of I and largest rotation {}",
            span(found, 2)
        ),
    )
    .because(
        Verdict::NotReproduced,
        against.count() == 3,
        "Each circle, a thin ring, has more inertia than the solid square as wide, and rotates \
         more: from shape to shape other things change than the inertia.",
    )
}

fn resisting() -> Result<Finding, CaseError> {
    let of_shape = |[a, b]: [f64; 2]| {
        [0.5, 1.0, 2.0].map(|factor| {
            chapter(Parameters {
                a,
                b,
                inertia: natural_inertia(a, b).map(|inertia| factor * inertia),
                ..Parameters::STANDARD
            })
        })
    };
    let cases: Vec<Parameters> = SHAPES
        .iter()
        .flat_map(|(size, _)| of_shape(*size))
        .collect();
    let runs = near_all(&cases, FEW)?;
    let steps = |member: &Vec<&Trajectory>| {
        let shapes = member.chunks(3);
        let pairs = shapes.flat_map(|shape| shape.windows(2));
        pairs
            .filter(|pair| rotation(pair[1]) < rotation(pair[0]))
            .count() as f64
    };
    let counts: Vec<f64> = by_member(&runs).iter().map(steps).collect();
    // As a rule: in three quarters of the doublings.
    let holds = |count: &f64| *count >= 12.0;
    Ok(Finding::new(
        Verdict::robust(counts.iter().map(holds)),
        format!(
            "of one shape with half, all and twice its I, {} of 16 doublings reduce the largest \
             rotation",
            span(counts, 0)
        ),
    )
    .because(
        Verdict::NotReproduced,
        true,
        "One impact does turn a body the less the larger its inertia, by (1 + e) v_n s/(I + s²) \
         at a lever arm s. The largest rotation of a motion of many impacts follows no such rule.",
    ))
}

fn larger_rotations(boxes: &Members) -> Finding {
    let grows = |runs: &Vec<&Trajectory>| {
        let rotations: Vec<f64> = runs.iter().map(|run| rotation(run)).collect();
        rising(&rotations)
    };
    Finding::new(
        Verdict::robust(boxes.iter().map(grows)),
        format!("largest rotation {}", nominal(boxes, 3, rotation)),
    )
}

/// Swings above some size per unit time.
fn rate(run: &Trajectory, above: f64) -> f64 {
    let large = swings(run).into_iter().filter(|swing| *swing > above);
    large.count() as f64 / run.end().t
}

fn rarer_swings(boxes: &Members) -> Finding {
    // What is large is a matter of taste: it holds around the chosen size, too, or not at all.
    let sizes = [0.9 * LARGE_SWING, LARGE_SWING, 1.1 * LARGE_SWING];
    let falls = |runs: &Vec<&Trajectory>| {
        sizes.iter().all(|size| {
            let rates: Vec<f64> = runs.iter().map(|run| rate(run, *size)).collect();
            falling(&rates)
        })
    };
    let words = sizes.map(|size| {
        let rates = nominal(boxes, 3, |run| rate(run, size));
        format!("above {size:.2} rad {rates}")
    });
    let inertia = [0.1, 0.2, 0.3].map(|a| natural_inertia(a, 0.1).unwrap_or(0.0));
    Finding::new(
        Verdict::robust(boxes.iter().map(falls)),
        format!(
            "swings per T {}; moments of inertia {}",
            words.join("; "),
            list(&inertia, 4)
        ),
    )
}

/// Mean energy lost in the impacts of a large swing, and of a smaller one.
fn losses(run: &Trajectory) -> [f64; 2] {
    let turns = turns(run);
    let of = |large: bool| {
        let pairs = turns.windows(2).filter_map(|pair| match pair {
            [p, q] => Some((p, q)),
            _ => None,
        });
        let some = pairs.filter(|(p, q)| ((q.1 - p.1).abs() > LARGE_SWING) == large);
        mean(some.map(|(p, q)| {
            let within = |hit: &&snapload::Impact| p.0 < hit.t && hit.t <= q.0;
            let hits = run.impacts().iter().filter(within);
            hits.map(|hit| hit.energy_lost).sum()
        }))
    };
    [of(true), of(false)]
}

fn costly_swings(boxes: &Members) -> Finding {
    /// The fewest that are several.
    const SEVERAL: f64 = 2.0;
    let verdicts = (0..RECTANGLES.len()).map(|k| {
        let runs = boxes.iter().filter_map(|runs| runs.get(k));
        Verdict::robust(runs.map(|run| {
            let [large, small] = losses(run);
            large > SEVERAL * small
        }))
    });
    let large = nominal(boxes, 5, |run| losses(run)[0]);
    let small = nominal(boxes, 5, |run| losses(run)[1]);
    Finding::new(
        Verdict::all(verdicts),
        format!(
            "mean energy lost in a swing above {LARGE_SWING} rad {large}; in a smaller one {small}"
        ),
    )
}

/// The turns of a quarter of the run, 0 to 3.
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

fn smaller_in_the_end(boxes: &Members) -> Finding {
    let holds = |runs: &Vec<&Trajectory>| runs.iter().all(|run| last_to_largest(run) < 0.6);
    let (low, high) = range(boxes.iter().flatten().map(|run| last_to_largest(run)));
    Finding::new(
        Verdict::robust(boxes.iter().map(holds)),
        format!("rotation in the last quarter over that in the strongest: {low:.2} to {high:.2}"),
    )
}

fn more_frequent(boxes: &Members) -> Finding {
    let counts = |run: &Trajectory| (quarter(run, 0).len(), quarter(run, 3).len());
    let verdicts: Vec<Verdict> = (0..RECTANGLES.len())
        .map(|k| {
            let runs = boxes.iter().filter_map(|runs| runs.get(k));
            Verdict::robust(runs.map(|run| counts(run).0 < counts(run).1))
        })
        .collect();
    let own = boxes.first().into_iter().flatten();
    let words: Vec<String> = own
        .map(|run| format!("{} then {}", counts(run).0, counts(run).1))
        .collect();
    let clear = verdicts.iter().zip([0.1, 0.2, 0.3]);
    let clear = clear.filter(|(verdict, _)| **verdict == Verdict::Reproduced);
    let clear: Vec<f64> = clear.map(|(_, a)| a).collect();
    let why = format!(
        "It holds from every start for a = {} only.",
        list(&clear, 1)
    );
    Finding::new(
        Verdict::all(verdicts),
        format!(
            "turns in the first and in the last quarter: {}",
            words.join(", ")
        ),
    )
    .because(Verdict::NotReproduced, !clear.is_empty(), why)
}

fn close_to_rocking(study: &Study, boxes: &Members) -> Result<Finding, CaseError> {
    /// How long after the end rocking is still close to it.
    const AFTER: f64 = 10.0;
    let settled = RECTANGLES.iter().zip(boxes.first().into_iter().flatten());
    let cases: Vec<(Parameters, &Trajectory)> = settled
        .filter_map(|(code, run)| {
            let case = Parameters {
                stop_when_settled: false,
                t_end: run.end().t + AFTER,
                ..study.case(code)?.parameters
            };
            Some((case, *run))
        })
        .collect();
    let starts: Vec<Vec<Option<f64>>> = cases
        .iter()
        .map(|(case, _)| of_all(&ensemble(case, MANY), |case| first_rocking(&case)))
        .collect::<Result<_, _>>()?;
    let rocks = starts
        .iter()
        .map(|starts| Verdict::robust(starts.iter().map(Option::is_some)));
    let words = cases.iter().zip(&starts).map(|((_, run), starts)| {
        let times = span(starts.iter().flatten().copied(), 2);
        format!("{}, rocks from {times}", ending(run))
    });
    let words: Vec<String> = words.collect();
    Ok(Finding::new(Verdict::all(rocks), words.join("; ")))
}
