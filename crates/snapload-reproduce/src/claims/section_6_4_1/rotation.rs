//! Section 6.4.1: the rotations of larger and smaller bodies.

use crate::ReportError;
use crate::claims::motions::{LARGE, Swing, ending, rotation, swings, turns};
use crate::claims::numbers::{falling, max, mean, min, rising, span, spearman};
use crate::claims::runs::{
    FEW, MANY, TableRuns, by_case, case, chapter, first_rocking, from_starts, measured, of_runs,
    outcome, past_settling, standard,
};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::{Impact, Parameters, natural_inertia};
use snapload_verify::RoundedRun;

pub(super) const CHECKS: &Checks<fn(&TableRuns) -> Checked> = &[
    ("6.4.1-09", |table_runs| {
        let shapes = table_runs.of(SHAPES.map(|(_, code)| code))?;
        let of_sizes = SIZES.map(|(_, size)| with_rotation(&shapes, size));
        let words = SIZES.iter().zip(&of_sizes);
        let words = words.map(|((name, _), rho)| format!("{name} {}", span(rho.clone(), 2)));
        Ok(Finding::new(smaller_rotate_more(&of_sizes))
            .value("rho", words.collect::<Vec<_>>().join(", "))
            .value("rule", -RULE)
            .by_start("rotations", shapes.iter().map(|runs| runs.map(rotation))))
    }),
    ("6.4.1-35", |table_runs| {
        let shapes = table_runs.of(SHAPES.map(|(_, code)| code))?;
        let found = with_rotation(&shapes, inertia);
        // Each circle is compared with the square of the same width.
        let against = (0..3).all(|k| {
            inertia(SHAPES[k].0) > inertia(SHAPES[k + 3].0)
                && rotation(shapes[0][k]) > rotation(shapes[0][k + 3])
        });
        let rule = Finding::measured("rho", found, |rho| rho <= -RULE);
        Ok(rule
            .condition("circles_against", against)
            .value("rule", -RULE))
    }),
    ("6.4.1-37", |_| inertia_reduces_rotation()),
    ("6.4.1-10", |table_runs| {
        let boxes = table_runs.of(RECTANGLES)?;
        Ok(measured("rotations", &boxes, rotation, |all| rising(all)))
    }),
    ("6.4.1-11", rarer_swings),
    ("6.4.1-38", |table_runs| {
        /// The least number that counts as several.
        const SEVERAL: f64 = 2.0;
        // The cases that have large swings.
        let with = |k: &usize| {
            swings(&table_runs.own()[*k])
                .into_iter()
                .any(Swing::is_large)
        };
        let places: Vec<usize> = (0..table_runs.codes.len()).filter(with).collect();
        let large_swings_cost_more =
            |run: &RoundedRun| mean_loss(run, true) > SEVERAL * mean_loss(run, false);
        let of_case = |k: &usize| {
            Verdict::robust(
                table_runs
                    .members()
                    .map(|runs| large_swings_cost_more(&runs[*k])),
            )
        };
        let verdicts: Vec<Verdict> = places.iter().map(of_case).collect();
        let mean_of = |large| {
            mean(
                places
                    .iter()
                    .map(|k| mean_loss(&table_runs.own()[*k], large)),
            )
        };
        Ok(Finding::new(Verdict::families(verdicts.iter().copied()))
            .values("angle several", [LARGE, SEVERAL])
            .values("large small", [mean_of(true), mean_of(false)])
            .value("costly", Verdict::Reproduced.count(verdicts))
            .values("with cases", [places.len(), table_runs.codes.len()]))
    }),
    ("6.4.1-12", |table_runs| {
        /// Rotations count as decreasing if the ratio of the last to the largest is below this.
        const SMALLER: f64 = 0.6;
        let ratios = table_runs
            .of(RECTANGLES)?
            .into_iter()
            .map(|runs| runs.map(last_to_largest));
        let ratios: Vec<[f64; 3]> = ratios.collect();
        let all = || ratios.iter().flatten().copied();
        Ok(Finding::robust(&ratios, |of| max(*of) < SMALLER)
            .values("least most smaller", [min(all()), max(all()), SMALLER]))
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

/// The least rank correlation that counts as a rule.
const RULE: f64 = 0.5;

/// A measure of a body's size, from its half-sizes.
type Measure = fn([f64; 2]) -> f64;

/// The possible measures of size.
const SIZES: [(&str, Measure); 3] = [
    ("a + b", |[a, b]| a + b),
    ("half the diagonal", |[a, b]| a.hypot(b)),
    ("half the width", |[a, _]| a),
];

/// Whether smaller bodies rotate more, by the rank correlations of each measure of size with the
/// rotation from all starts: mixed if that depends on the measure.
fn smaller_rotate_more(of_sizes: &[Vec<f64>]) -> Verdict {
    let rule = |rho: &Vec<f64>| Verdict::robust(rho.iter().map(|rho| *rho <= -RULE));
    Verdict::families(of_sizes.iter().map(rule))
}

fn inertia([a, b]: [f64; 2]) -> f64 {
    natural_inertia(a, b).unwrap_or(0.0)
}

/// Rank correlation of a measure of the shapes with their rotation, by start.
fn with_rotation(shapes: &[[&RoundedRun; 8]], measure: impl Fn([f64; 2]) -> f64) -> Vec<f64> {
    let of = |runs: &[&RoundedRun; 8]| {
        let points = SHAPES.iter().zip(runs);
        let points = points.map(|((size, _), run)| (measure(*size), rotation(run)));
        spearman(&points.collect::<Vec<_>>())
    };
    shapes.iter().map(of).collect()
}

fn inertia_reduces_rotation() -> Checked {
    // Each shape with half, one and two times its moment of inertia.
    let cases = SHAPES.iter().flat_map(|(size, _)| {
        [0.5, 1.0, 2.0].map(|factor| {
            let inertia = Some(factor * inertia(*size));
            chapter(standard(|p| ([p.a, p.b], p.inertia) = (*size, inertia)))
        })
    });
    let cases: Vec<Parameters> = cases.collect();
    let rotations = of_runs(&cases, FEW, rotation)?;
    let reduced = rotations.iter().map(|all| {
        let doublings = all.chunks(3).flat_map(|shape| shape.windows(2));
        doublings.filter(|pair| falling(pair)).count() as f64
    });
    // A rule holds if it holds for three quarters of the doublings.
    let doublings = 2 * SHAPES.len();
    let rule = 0.75 * doublings as f64;
    let finding = Finding::measured("reduced", reduced, |count| count >= rule);
    Ok(finding.value("doublings", doublings).value("rule", rule))
}

fn rarer_swings(table_runs: &TableRuns) -> Checked {
    let boxes = table_runs.of(RECTANGLES)?;
    let large = |run: &RoundedRun| {
        swings(run)
            .into_iter()
            .filter(|swing| swing.is_large())
            .count()
    };
    let rates = |runs: &[&RoundedRun; 3]| runs.map(|run| large(run) as f64 / run.end().t);
    let counts = boxes[0].map(|run| large(run) as f64);
    let none = boxes.iter().flatten().all(|run| large(run) == 0);
    Ok(Finding::robust(&boxes, |runs| falling(&rates(runs)))
        .value("angle", LARGE)
        .list("counts", counts)
        .by_start("widest", boxes.iter().map(|runs| runs.map(widest)))
        .condition("none", none)
        .list("inertia", [0.1, 0.2, 0.3].map(|a| inertia([a, 0.1]))))
}

/// The widest swing of a run.
fn widest(run: &RoundedRun) -> f64 {
    max(swings(run).into_iter().map(Swing::size))
}

/// Mean energy lost in the impacts of a large swing, or of another one.
fn mean_loss(run: &RoundedRun, large: bool) -> f64 {
    let some = swings(run)
        .into_iter()
        .filter(|swing| swing.is_large() == large);
    mean(some.map(|swing| {
        let within = |hit: &&Impact| swing.from.0 < hit.t && hit.t <= swing.to.0;
        let hits = run.impacts().iter().filter(within);
        hits.map(|hit| hit.energy_lost).sum()
    }))
}

/// |θ| at the turning points of a quarter of the run, 0 to 3.
fn quarter(run: &RoundedRun, which: u8) -> Vec<f64> {
    let at = |k: u8| run.end().t * f64::from(k) / 4.0;
    let mut turns = turns(run);
    turns.retain(|turn| turn.0 >= at(which) && (turn.0 < at(which + 1) || which == 3));
    turns.into_iter().map(|turn| turn.1.abs()).collect()
}

/// Ratio of the largest rotation in the last quarter to that in the strongest quarter.
fn last_to_largest(run: &RoundedRun) -> f64 {
    let largest = |which: u8| quarter(run, which).into_iter().fold(0.0, f64::max);
    let most = (0..4).map(largest).fold(0.0, f64::max);
    if most > 0.0 { largest(3) / most } else { 1.0 }
}

fn more_frequent(table_runs: &TableRuns) -> Checked {
    let boxes = table_runs.of(RECTANGLES)?;
    let counts = |run: &RoundedRun| [0, 3].map(|which| quarter(run, which).len());
    let verdicts = by_case(&boxes, |run| counts(run)[0] < counts(run)[1]);
    let words = boxes[0].map(|run| counts(run).map(|count| count.to_string()).join(" then "));
    let sure = verdicts.iter().zip([0.1, 0.2, 0.3]);
    let sure = sure.filter(|(verdict, _)| **verdict == Verdict::Reproduced);
    Ok(Finding::new(Verdict::families(verdicts))
        .value("turns", words.join(", "))
        .condition("of_some", sure.clone().count() > 0)
        .list("widths", sure.map(|(_, a)| a)))
}

fn close_to_rocking(table_runs: &TableRuns) -> Checked {
    /// A run was close to rocking if it rocks within this time after its end: a seventh of the
    /// period of the forcing.
    const CLOSE: f64 = 1.0;
    /// The time after the end in which rocking is searched for.
    const AFTER: f64 = 10.0;
    let own = table_runs.of(RECTANGLES)?[0];
    let cases = RECTANGLES.map(|code| Ok(chapter(case(table_runs.study, code)?.parameters)));
    let cases: Vec<Parameters> = cases.into_iter().collect::<Result<_, ReportError>>()?;
    // The time from the end of a run to its first rocking.
    let starts = from_starts(&cases, MANY, |case| {
        let end = outcome(case)?.end.t;
        let on = Parameters {
            t_end: end + AFTER,
            stop_when_sliding: false,
            ..past_settling(*case)
        };
        Ok(first_rocking(&on)?.map(|t| t - end))
    })?;
    let waits = [0, 1, 2].map(|k| starts.iter().map(|all| all[k]).collect::<Vec<_>>());
    let words = [0, 1, 2].map(|k| {
        let known = span(waits[k].iter().flatten().copied(), 2);
        let never = waits[k].iter().filter(|wait| wait.is_none()).count();
        let never = match never {
            0 => String::new(),
            count => format!(" ({count} starts not within {AFTER} T)"),
        };
        format!("{}, rocks {known} T later{never}", ending(own[k].end()))
    });
    Ok(Finding::new(rocks_within(&waits, CLOSE))
        .value("runs", words.join("; "))
        .value("close", CLOSE))
}

/// Whether some cases all begin to rock within a time, by their waiting times from each start;
/// mixed if only some do.
fn rocks_within(waits: &[Vec<Option<f64>>], close: f64) -> Verdict {
    let near = |wait: &Option<f64>| wait.is_some_and(|wait| wait <= close);
    Verdict::families(
        waits
            .iter()
            .map(|all| Verdict::robust(all.iter().map(near))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_that_depends_on_the_measure_of_size_is_mixed() {
        let starts = |rho: f64| vec![rho; 3];
        let [strong, weak] = [starts(-0.7), starts(-0.3)];
        let judged = |all: &[&Vec<f64>]| {
            let all: Vec<Vec<f64>> = all.iter().copied().cloned().collect();
            smaller_rotate_more(&all)
        };
        assert_eq!(judged(&[&strong, &strong]), Verdict::Reproduced);
        assert_eq!(judged(&[&strong, &weak]), Verdict::Mixed);
        assert_eq!(judged(&[&weak, &weak]), Verdict::NotReproduced);
    }

    #[test]
    fn rocking_long_after_the_end_is_not_close_to_it() {
        let waits = |all: [f64; 2]| all.map(|wait| vec![Some(wait); 2]).to_vec();
        assert_eq!(rocks_within(&waits([0.1, 0.9]), 1.0), Verdict::Reproduced);
        assert_eq!(rocks_within(&waits([0.1, 8.0]), 1.0), Verdict::Mixed);
        assert_eq!(
            rocks_within(&waits([3.0, 8.0]), 1.0),
            Verdict::NotReproduced
        );
        assert_eq!(
            rocks_within(&[vec![None, None]], 1.0),
            Verdict::NotReproduced
        );
    }
}
