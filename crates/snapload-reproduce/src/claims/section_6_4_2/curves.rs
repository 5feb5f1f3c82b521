//! The curves of critical force, Figs 6.27-6.30.

use crate::ReportError;
use crate::claims::numbers::{mean, span, spearman};
use crate::claims::runs::{
    FEW, NEVER, SAME, chapter, clear, critical_force, each, ensemble, from_starts, run, shown,
    standard,
};
use crate::claims::verdict::{Finding, Judged, Judges, Verdict};
use crate::study::{CriticalCurve, Reading, Study};
use snapload::{CaseError, Parameters, Trajectory};

pub(super) const JUDGES: &Judges<fn(&Study) -> Judged> = &[
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

/// The part of a curve over which the key varies in Table 6.1.
fn tabled(curve: &CriticalCurve, reading: Reading) -> Points {
    let to = if curve.key == "e" { 1.0 } else { 2.0 };
    let points = curve.points.of(reading).iter();
    let inside = points.filter(|p| (0.5 - 1e-9..=to + 1e-9).contains(&p.0));
    inside
        .map(|(value, f_cr)| (*value, f_cr.unwrap_or(NEVER)))
        .collect()
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

/// A rank correlation that one sees as a trend.
const TREND: f64 = 0.5;

/// Whether a curve rises (1) or falls (-1).
fn trend(study: &Study, key: &str, r: f64, sign: f64) -> Judged {
    let mut curves = study.curves.iter();
    let curve = curves
        .find(|curve| curve.key == key && curve.r == r)
        .ok_or_else(|| ReportError::Claim(format!("no curve over {key} at r = {r}")))?;
    let own = tabled(curve, Reading::Chapter);
    let coarse: Vec<f64> = own.iter().step_by(5).map(|p| p.0).collect();
    let mut all = vec![own, tabled(curve, Reading::SlidingOn)];
    all.extend(neighbours(curve, &coarse)?);
    let ends = |points: &Points| [points[0].1, points[points.len() - 1].1];
    let holds = |points: &Points| {
        let [first, last] = ends(points);
        sign * spearman(points) >= TREND && sign * (last - first) > 0.0
    };
    let [left, right] = ends(&all[0]).map(shown);
    Ok(Finding::robust(&all, holds)
        .values("left right", [left, right])
        .list("rho", all.iter().map(|points| spearman(points))))
}

/// Clear impacts per unit time, early in the motion.
fn impact_rate(run: &Trajectory) -> f64 {
    let until = run.end().t.min(5.0);
    clear(run).filter(|hit| hit.t <= until).count() as f64 / until
}

fn impact_rates() -> Judged {
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.05, 0.09] {
        let steps = (0..=20).map(|k| 0.5 + 0.075 * f64::from(k));
        let with = |omega| chapter(standard(|p| (p.r, p.f_o, p.omega) = (2.5, f_o, omega)));
        let cases: Vec<Parameters> = steps.map(with).collect();
        let rates = from_starts(&cases, FEW, |case| {
            Ok((case.omega, impact_rate(&run(case)?)))
        })?;
        let ranks: Vec<f64> = rates.iter().map(|rates| spearman(rates)).collect();
        verdicts.push(Verdict::robust(ranks.iter().map(|rho| *rho <= -TREND)));
        texts.push(format!("{} at f_o = {f_o}", span(ranks, 2)));
    }
    // How far the force alone would carry the body.
    let travel = |omega: f64| 0.09 / (omega * omega);
    Ok(Finding::new(Verdict::all(verdicts))
        .value("ranks", texts.join(", "))
        .values("slow fast", [travel(0.5), travel(2.0)]))
}

/// By how much the second of three points stands out, up (1) or down (-1).
fn height(points: &[(f64, f64)], sign: f64) -> f64 {
    (sign * (points[1].1 - points[0].1)).min(sign * (points[1].1 - points[2].1))
}

/// The local maxima (1) or minima (-1) of a curve, each with its neighbours on the curve.
fn extremes(curve: &CriticalCurve, sign: f64) -> Vec<(&CriticalCurve, Points)> {
    let mut points = tabled(curve, Reading::Chapter);
    points.dedup_by(|b, a| (a.1 - b.1).abs() < SAME);
    let found = points.windows(3).filter(|three| height(three, sign) > SAME);
    found.map(|three| (curve, three.to_vec())).collect()
}

fn local_extremes(study: &Study) -> Judged {
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
        let members = neighbours(curve, &values)?;
        verdicts.push(Verdict::robust(
            members.iter().map(|points| height(points, sign) > SAME),
        ));
        let (value, f_cr) = points[1];
        texts.push(format!(
            "{} {name}, the clearest {} at {} = {value}, r = {}",
            all.len(),
            shown(f_cr),
            curve.key,
            curve.r
        ));
    }
    Ok(Finding::new(Verdict::all(verdicts)).value("extremes", texts.join("; ")))
}

fn jumps(study: &Study) -> Judged {
    /// A change of the critical force that is much: a third of that of the standard case.
    const MUCH: f64 = 0.1;
    let rise = |pair: &[(f64, f64)]| {
        let known = pair.iter().all(|p| p.1 < NEVER);
        if known {
            (pair[1].1 - pair[0].1).abs()
        } else {
            0.0
        }
    };
    let steps = |curve| {
        let points = tabled(curve, Reading::Chapter);
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
    Ok(Finding::robust(&members, |pair| rise(pair) >= MUCH)
        .values(
            "key before after",
            [curve.key.to_owned(), shown(p.1), shown(q.1)],
        )
        .values("from to r mean", [p.0, q.0, curve.r, typical]))
}
