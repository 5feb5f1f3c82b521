//! The curves of critical force, Figs 6.27-6.30.

use crate::ReportError;
use crate::claims::motions::clear;
use crate::claims::numbers::{mean, span, spearman};
use crate::claims::runs::{
    FEW, NEVER, SAME, chapter, critical_force, each, ensemble, of_runs, shown_span, standard,
};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use crate::study::{CriticalCurve, LARGEST, Reading, Study};
use snapload::{CaseError, Parameters};
use snapload_verify::RoundedRun;

pub(super) const CHECKS: &Checks<fn(&Study) -> Checked> = &[
    ("6.4.2-11", |study| trend(study, "e", 1.5, -1.0)),
    ("6.4.2-12", |study| trend(study, "omega", 1.5, -1.0)),
    ("6.4.2-13", |study| trend(study, "e", 2.5, -1.0)),
    ("6.4.2-14", |study| trend(study, "omega", 2.5, 1.0)),
    ("6.4.2-15", |_| impact_rates()),
    ("6.4.2-16", local_extremes),
    ("6.4.2-18", jumps),
];

/// Points of a curve: the value of its key, and f_cr.
type Points = Vec<(f64, f64)>;

/// A curve between two values of its key.
fn between(curve: &CriticalCurve, reading: Reading, [from, to]: [f64; 2]) -> Points {
    let points = curve.points.of(reading).iter();
    let inside = points.filter(|p| (from - 1e-9..=to + 1e-9).contains(&p.0));
    inside
        .map(|(value, f_cr)| (*value, f_cr.unwrap_or(NEVER)))
        .collect()
}

/// The values over which a key varies in Table 6.1.
fn of_table_6_1(key: &str) -> [f64; 2] {
    [0.5, if key == "e" { 1.0 } else { 2.0 }]
}

/// The part of a curve over which the key varies in Table 6.1.
fn points_in_table(curve: &CriticalCurve, reading: Reading) -> Points {
    between(curve, reading, of_table_6_1(curve.key))
}

/// The parts of a curve: that over which the key varies in Table 6.1, and the parts drawn below and
/// above it, if they have enough points for a trend.
fn parts(curve: &CriticalCurve) -> Vec<[f64; 2]> {
    /// The least number of points for a trend.
    const LEAST_POINTS: usize = 10;
    let [from, to] = of_table_6_1(curve.key);
    let values = || curve.points.chapter.iter().map(|p| p.0);
    let (below, above) = (|v: &f64| *v < from - 1e-9, |v: &f64| *v > to + 1e-9);
    let rest = [
        values().filter(below).collect(),
        values().filter(above).collect(),
    ];
    let rest = rest
        .iter()
        .filter(|part: &&Vec<f64>| part.len() >= LEAST_POINTS);
    let rest = rest.map(|part| [part[0], part[part.len() - 1]]);
    std::iter::once([from, to]).chain(rest).collect()
}

/// The curves of neighbouring starts over some values of its key.
fn neighbours(curve: &CriticalCurve, values: &[f64]) -> Result<Vec<Points>, CaseError> {
    let with = |value: f64| {
        let mut case = chapter(standard(|p| p.r = curve.r));
        match curve.key {
            "e" => case.e = value,
            _ => case.omega = value,
        }
        ensemble(&case, FEW)
    };
    let of_start = |k: usize| {
        let cases: Vec<Parameters> = values.iter().map(|value| with(*value)[k]).collect();
        let forces = each(&cases, critical_force)?;
        Ok(values.iter().copied().zip(forces).collect())
    };
    (1..=FEW).map(of_start).collect()
}

/// The least rank correlation that counts as a trend.
const TREND: f64 = 0.5;

/// Whether there is a curve, which is not the case if no amplitude exceeds in a whole part.
fn has_values(points: &Points) -> bool {
    points.iter().any(|p| p.1 < NEVER)
}

/// Whether points rise (1) or fall (-1).
fn has_trend(points: &Points, sign: f64) -> bool {
    match (points.first(), points.last()) {
        (Some(first), Some(last)) => {
            sign * spearman(points) >= TREND && sign * (last.1 - first.1) > 0.0
        }
        _ => false,
    }
}

/// Whether a curve rises (1) or falls (-1), in each of its parts.
fn trend(study: &Study, key: &str, r: f64, sign: f64) -> Checked {
    let mut curves = study.curves.iter();
    let curve = curves
        .find(|curve| curve.key == key && curve.r == r)
        .ok_or_else(|| ReportError::Claim(format!("no curve over {key} at r = {r}")))?;
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for part in parts(curve) {
        let own = between(curve, Reading::Chapter, part);
        let step = (own.len() / 10).max(1);
        let coarse: Vec<f64> = own.iter().step_by(step).map(|p| p.0).collect();
        let mut all = vec![own, between(curve, Reading::SlidingOn, part)];
        let without = Reading::BOTH
            .iter()
            .zip(&all)
            .filter(|(_, points)| !has_values(points))
            .map(|(reading, _)| format!(", no curve where {}", reading.heading()))
            .collect::<String>();
        all.extend(neighbours(curve, &coarse)?);
        all.retain(has_values);
        verdicts.push(Verdict::robust(
            all.iter().map(|points| has_trend(points, sign)),
        ));
        let ends = |k: fn(&Points) -> Option<&(f64, f64)>| {
            shown_span(all.iter().filter_map(k).map(|p| p.1))
        };
        let rho = span(all.iter().map(|points| spearman(points)), 2);
        texts.push(format!(
            "from {} to {}: {} at the left end, {} at the right, rank correlation {rho}{without}",
            part[0],
            part[1],
            ends(|points| points.first()),
            ends(|points| points.last())
        ));
    }
    Ok(Finding::new(Verdict::families(verdicts))
        .value("parts", texts.join("; "))
        .values("trend largest", [TREND, LARGEST]))
}

/// The end of the time in which impacts are counted.
const EARLY: f64 = 5.0;

/// Clear impacts per unit time, early in the motion.
fn impact_rate(run: &RoundedRun) -> f64 {
    let until = run.end().t.min(EARLY);
    clear(run).filter(|hit| hit.t <= until).count() as f64 / until
}

fn impact_rates() -> Checked {
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.05, 0.09] {
        let steps = (0..=20).map(|k| 0.5 + 0.075 * f64::from(k));
        let with = |omega| chapter(standard(|p| (p.r, p.f_o, p.omega) = (2.5, f_o, omega)));
        let cases: Vec<Parameters> = steps.map(with).collect();
        let rates = of_runs(&cases, FEW, impact_rate)?;
        let rank = |rates: &Vec<f64>| {
            let points = cases
                .iter()
                .zip(rates)
                .map(|(case, rate)| (case.omega, *rate));
            spearman(&points.collect::<Vec<_>>())
        };
        let ranks: Vec<f64> = rates.iter().map(rank).collect();
        verdicts.push(Verdict::robust(ranks.iter().map(|rho| *rho <= -TREND)));
        texts.push(format!("{} at f_o = {f_o}", span(ranks, 2)));
    }
    // The displacement of the body by the force alone.
    let travel = |omega: f64| 0.09 / (omega * omega);
    Ok(Finding::new(Verdict::all(verdicts))
        .value("ranks", texts.join(", "))
        .values("slow fast", [travel(0.5), travel(2.0)])
        .values("trend early", [-TREND, EARLY]))
}

/// The symbol of the key over which a curve is drawn.
fn symbol(curve: &CriticalCurve) -> String {
    let known = if curve.key == "e" { "e" } else { "Ω" };
    known.to_owned()
}

/// The height of the second of three points above (1) or below (-1) the others.
fn height(points: &[(f64, f64)], sign: f64) -> f64 {
    (sign * (points[1].1 - points[0].1)).min(sign * (points[1].1 - points[2].1))
}

/// The local maxima (1) or minima (-1) of a curve, each with its neighbours on the curve.
fn extremes(curve: &CriticalCurve, sign: f64) -> Vec<(&CriticalCurve, Points)> {
    let mut points = points_in_table(curve, Reading::Chapter);
    points.dedup_by(|b, a| (a.1 - b.1).abs() < SAME);
    let found = points.windows(3).filter(|three| height(three, sign) > SAME);
    found.map(|three| (curve, three.to_vec())).collect()
}

fn local_extremes(study: &Study) -> Checked {
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for (sign, name) in [(1.0, "maxima"), (-1.0, "minima")] {
        let all = study.curves.iter().flat_map(|c| extremes(c, sign));
        let all: Vec<(&CriticalCurve, Points)> = all.collect();
        let by_height =
            |p: &&(_, Points), q: &&(_, Points)| height(&p.1, sign).total_cmp(&height(&q.1, sign));
        let Some((curve, points)) = all.iter().max_by(by_height) else {
            verdicts.push(Verdict::NotReproduced);
            texts.push(format!("no {name}"));
            continue;
        };
        let values: Vec<f64> = points.iter().map(|p| p.0).collect();
        let mut members = neighbours(curve, &values)?;
        members.push(points.clone());
        verdicts.push(Verdict::robust(
            members.iter().map(|points| height(points, sign) > SAME),
        ));
        let clearest = shown_span(members.iter().map(|points| points[1].1));
        let (key, value, r) = (symbol(curve), points[1].0, curve.r);
        texts.push(format!(
            "{} {name}, the clearest, {clearest}, at {key} = {value}, r = {r}",
            all.len()
        ));
    }
    Ok(Finding::new(Verdict::all(verdicts))
        .value("extremes", texts.join("; "))
        .value("same", SAME))
}

fn jumps(study: &Study) -> Checked {
    /// The least change of the critical force that counts as large: a third of that of the standard
    /// case.
    const LEAST_RISE: f64 = 0.1;
    let rise = |pair: &[(f64, f64)]| {
        let known = pair.iter().all(|p| p.1 < NEVER);
        if known {
            (pair[1].1 - pair[0].1).abs()
        } else {
            0.0
        }
    };
    let steps = |curve| {
        let points = points_in_table(curve, Reading::Chapter);
        let pairs: Vec<Points> = points.windows(2).map(<[_]>::to_vec).collect();
        pairs.into_iter().map(move |pair| (curve, pair))
    };
    let all: Vec<(&CriticalCurve, Points)> = study.curves.iter().flat_map(steps).collect();
    let largest = all.iter().max_by(|p, q| rise(&p.1).total_cmp(&rise(&q.1)));
    let (curve, pair) = largest.ok_or_else(|| ReportError::Claim("no curves".to_owned()))?;
    let (p, q) = (pair[0], pair[1]);
    let mut members = neighbours(curve, &[p.0, q.0])?;
    members.push(pair.clone());
    let typical = mean(all.iter().map(|(_, pair)| rise(pair)));
    let of = |k: usize| shown_span(members.iter().map(|pair| pair[k].1));
    Ok(Finding::robust(&members, |pair| rise(pair) >= LEAST_RISE)
        .values("key before after", [symbol(curve), of(0), of(1)])
        .values("from to r mean", [p.0, q.0, curve.r, typical])
        .value("much", LEAST_RISE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Both;

    #[test]
    fn a_curve_that_turns_beyond_the_range_of_the_table_is_mixed() {
        // Falls up to 2, rises from there on.
        let point = |k: i32| {
            let omega = 0.5 + 0.02 * f64::from(k);
            (omega, Some(0.2 + 0.1 * (omega - 2.0).abs()))
        };
        let points: Vec<(f64, Option<f64>)> = (0..=95).map(point).collect();
        let curve = CriticalCurve {
            r: 1.5,
            key: "omega",
            points: Both {
                chapter: points.clone(),
                sliding_on: points,
            },
        };
        let parts = parts(&curve);
        assert_eq!(parts.len(), 2);
        let falls = parts
            .iter()
            .map(|part| has_trend(&between(&curve, Reading::Chapter, *part), -1.0));
        let verdicts: Vec<Verdict> = falls.map(Verdict::of).collect();
        assert_eq!(verdicts, [Verdict::Reproduced, Verdict::NotReproduced]);
        assert_eq!(Verdict::families(verdicts), Verdict::Mixed);
    }
}
