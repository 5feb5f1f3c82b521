//! The curves of critical force, Figs 6.27-6.30.

use super::table::{NEVER, SAME, rank, shown};
use crate::claims::numbers::{mean, span, spearman};
use crate::claims::runs::{FEW, chapter, clear, ensemble, run_all};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use crate::study::{CriticalCurve, CriticalPoint, Reading, Study, first_exceeding};
use rayon::prelude::*;
use snapload::analysis::ForceScan;
use snapload::{CaseError, Parameters, Trajectory};

/// Checks the claims on the curves.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let mut all = trends(study)?;
    all.push(claim(
        "6.4.2-15",
        "With the longer cables a faster forcing makes the body hit the boundaries less often.",
        impact_rates()?,
    ));
    all.push(claim(
        "6.4.2-16",
        "The curves of critical force have local maxima and minima.",
        local_extremes(study)?,
    ));
    all.push(claim(
        "6.4.2-18",
        "A small change of one variable may change the critical force much.",
        jumps(study)?,
    ));
    Ok(all)
}

fn trends(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let one = |id, text, key: &str, r: f64, sign: f64| -> Result<Claim, CaseError> {
        let found = study.curves.iter().find(|c| c.key == key && c.r == r);
        let finding = match found {
            Some(curve) => trend(curve, sign)?,
            None => Finding::new(Verdict::NotReproduced, "no such curve"),
        };
        Ok(claim(id, text, finding))
    };
    let falls = "Fig 6.27: the critical force falls with e at r = 1.5.";
    Ok(vec![
        one("6.4.2-11", falls, "e", 1.5, -1.0)?,
        one(
            "6.4.2-12",
            "Fig 6.28: it falls with Ω at r = 1.5.",
            "omega",
            1.5,
            -1.0,
        )?,
        one(
            "6.4.2-13",
            "Fig 6.29: it falls with e at r = 2.5.",
            "e",
            2.5,
            -1.0,
        )?,
        one(
            "6.4.2-14",
            "Fig 6.30: it rises with Ω at r = 2.5.",
            "omega",
            2.5,
            1.0,
        )?,
    ])
}

/// The part of a curve over which the key varies in Table 6.1.
fn tabled(curve: &CriticalCurve, reading: Reading) -> Vec<(f64, f64)> {
    let [from, to] = if curve.key == "e" {
        [0.5, 1.0]
    } else {
        [0.5, 2.0]
    };
    let points: &[CriticalPoint] = curve.points.of(reading);
    let inside = points
        .iter()
        .filter(|p| (from - 1e-9..=to + 1e-9).contains(&p.0));
    inside.map(|(value, f_cr)| (*value, rank(*f_cr))).collect()
}

/// A rank correlation that one sees as a trend.
const TREND: f64 = 0.5;

fn trend(curve: &CriticalCurve, sign: f64) -> Result<Finding, CaseError> {
    let own = tabled(curve, Reading::Chapter);
    let coarse: Vec<f64> = own.iter().step_by(5).map(|p| p.0).collect();
    let members = neighbours(curve, &coarse)?;
    let mut all = vec![own, tabled(curve, Reading::SlidingOn)];
    all.extend(members);
    let ends = |points: &[(f64, f64)]| match (points.first(), points.last()) {
        (Some(first), Some(last)) => [first.1, last.1],
        _ => [NEVER; 2],
    };
    let holds = |points: &Vec<(f64, f64)>| {
        let [first, last] = ends(points);
        sign * spearman(points) >= TREND && sign * (last - first) > 0.0
    };
    let [first, last] = ends(&all[0]).map(shown);
    let ranks = span(all.iter().map(|points| spearman(points)), 2);
    let evidence =
        format!("{first} at the left end, {last} at the right; rank correlation {ranks}");
    Ok(Finding::new(
        Verdict::robust(all.iter().map(holds)),
        evidence,
    ))
}

/// The curves of neighbouring starts over some values of its key.
fn neighbours(curve: &CriticalCurve, values: &[f64]) -> Result<Vec<Vec<(f64, f64)>>, CaseError> {
    let with = |value: f64| {
        let mut parameters = Parameters {
            r: curve.r,
            ..Parameters::STANDARD
        };
        match curve.key {
            "e" => parameters.e = value,
            _ => parameters.omega = value,
        }
        ensemble(&chapter(parameters), FEW)
    };
    let cases: Vec<(f64, Parameters)> = (1..=FEW)
        .flat_map(|k| {
            values
                .iter()
                .filter_map(move |v| Some((*v, *with(*v).get(k)?)))
        })
        .collect();
    let points = cases
        .par_iter()
        .map(|(value, case)| {
            let found = first_exceeding(case, ForceScan::default())?;
            Ok((*value, rank(found.map(|x| x.0))))
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    Ok(points
        .chunks(values.len().max(1))
        .map(<[_]>::to_vec)
        .collect())
}

/// Clear impacts per unit time, early in the motion.
fn impact_rate(run: &Trajectory) -> f64 {
    let until = run.end().t.min(5.0);
    clear(run).filter(|hit| hit.t <= until).count() as f64 / until
}

fn impact_rates() -> Result<Finding, CaseError> {
    let steps = || (0..=20).map(|k: u32| 0.5 + 0.075 * f64::from(k));
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.05, 0.09] {
        let members = (0..=FEW).map(|member| {
            let case = |omega: f64| {
                let case = chapter(Parameters {
                    r: 2.5,
                    f_o,
                    omega,
                    ..Parameters::STANDARD
                });
                ensemble(&case, FEW)[member]
            };
            let cases: Vec<Parameters> = steps().map(case).collect();
            let runs = run_all(&cases)?;
            let rates = cases
                .iter()
                .zip(&runs)
                .map(|(c, run)| (c.omega, impact_rate(run)));
            Ok(rates.collect())
        });
        let members: Vec<Vec<(f64, f64)>> = members.collect::<Result<_, CaseError>>()?;
        let ranks: Vec<f64> = members.iter().map(|rates| spearman(rates)).collect();
        verdicts.push(Verdict::robust(ranks.iter().map(|rho| *rho <= -TREND)));
        texts.push(format!("{} at f_o = {f_o}", span(ranks, 2)));
    }
    let travel = [0.5, 2.0].map(|omega| 0.09 / (omega * omega));
    let why = format!(
        "The impacts do not get rarer as a rule. What does get less is how far the force alone \
         would carry the body, f_o/Ω²: {:.2} at Ω = 0.5, {:.2} at Ω = 2 with f_o = 0.09.",
        travel[0], travel[1]
    );
    Ok(Finding::new(
        Verdict::all(verdicts),
        format!(
            "rank correlation of the rate of impacts with Ω: {}",
            texts.join(", ")
        ),
    )
    .because(Verdict::NotReproduced, true, why))
}

/// A point of a curve that lies above (or below) both neighbours, with those.
struct Extreme<'a> {
    curve: &'a CriticalCurve,
    /// +1 for a maximum, -1 for a minimum.
    sign: f64,
    points: [(f64, f64); 3],
}

impl Extreme<'_> {
    /// By how much it stands out.
    fn height(points: &[(f64, f64)], sign: f64) -> f64 {
        match points {
            [left, middle, right] => (sign * (middle.1 - left.1)).min(sign * (middle.1 - right.1)),
            _ => 0.0,
        }
    }

    fn text(&self) -> String {
        let [_, (value, f_cr), _] = self.points;
        let (key, r, f_cr) = (self.curve.key, self.curve.r, shown(f_cr));
        format!("{f_cr} at {key} = {value}, r = {r}")
    }
}

fn extremes(curve: &CriticalCurve, sign: f64) -> Vec<Extreme<'_>> {
    let mut points = tabled(curve, Reading::Chapter);
    points.dedup_by(|b, a| (a.1 - b.1).abs() < SAME);
    points
        .windows(3)
        .filter_map(|three| <[(f64, f64); 3]>::try_from(three).ok())
        .filter(|three| Extreme::height(three, sign) > SAME)
        .map(|points| Extreme {
            curve,
            sign,
            points,
        })
        .collect()
}

fn local_extremes(study: &Study) -> Result<Finding, CaseError> {
    let mut verdicts = Vec::new();
    let mut texts = Vec::new();
    for (sign, name) in [(1.0, "maxima"), (-1.0, "minima")] {
        let all: Vec<Extreme> = study
            .curves
            .iter()
            .flat_map(|c| extremes(c, sign))
            .collect();
        let height = |x: &Extreme| Extreme::height(&x.points, x.sign);
        let Some(clearest) = all.iter().max_by(|p, q| height(p).total_cmp(&height(q))) else {
            return Ok(Finding::new(Verdict::NotReproduced, format!("no {name}")));
        };
        let members = neighbours(clearest.curve, &clearest.points.map(|p| p.0))?;
        verdicts.push(Verdict::robust(
            members
                .iter()
                .map(|points| Extreme::height(points, sign) > SAME),
        ));
        texts.push(format!(
            "{} {name}, the clearest {}",
            all.len(),
            clearest.text()
        ));
    }
    Ok(Finding::new(Verdict::all(verdicts), texts.join("; ")))
}

fn jumps(study: &Study) -> Result<Finding, CaseError> {
    /// A change of the critical force that is much: a third of that of the standard case.
    const MUCH: f64 = 0.1;
    let rise = |pair: &[(f64, f64)]| match pair {
        [p, q] if p.1 < NEVER && q.1 < NEVER => (q.1 - p.1).abs(),
        _ => 0.0,
    };
    let own = study
        .curves
        .iter()
        .map(|c| (c, tabled(c, Reading::Chapter)));
    let all = own.flat_map(|(curve, points)| {
        let pairs: Vec<[(f64, f64); 2]> = points.windows(2).map(|p| [p[0], p[1]]).collect();
        pairs.into_iter().map(move |pair| (curve, pair))
    });
    let all: Vec<_> = all.collect();
    let Some((curve, pair)) = all.iter().max_by(|p, q| rise(&p.1).total_cmp(&rise(&q.1))) else {
        return Ok(Finding::new(Verdict::NotReproduced, "no curves"));
    };
    let members = neighbours(curve, &pair.map(|p| p.0))?;
    let much = members.iter().map(|pair| rise(pair) >= MUCH);
    let typical = mean(all.iter().map(|(_, pair)| rise(pair)));
    let [p, q] = pair;
    Ok(Finding::new(
        Verdict::robust(much.chain([rise(pair) >= MUCH])),
        format!(
            "{} at {key} = {}, {} at {key} = {}, r = {}; the mean step of the curves is \
             {typical:.3}",
            shown(p.1),
            p.0,
            shown(q.1),
            q.0,
            curve.r,
            key = curve.key
        ),
    ))
}
