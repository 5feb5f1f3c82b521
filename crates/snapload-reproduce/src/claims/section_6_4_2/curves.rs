//! The curves of critical force, Figs 6.27-6.30.

use super::{NEIGHBOURS, NEVER, SAME, rank, shown};
use crate::claims::tools::{
    Finding, ensemble, first_exceeding, is_clear, judged, robust, run_all, spearman,
};
use crate::claims::{Claim, Verdict};
use crate::study::{CriticalCurve, CriticalPoint, Reading, Study};
use rayon::prelude::*;
use snapload::analysis::ForceScan;
use snapload::{CaseError, Parameters};

/// Checks the claims on the curves.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let mut all = trends(study)?;
    all.push(judged(
        "6.4.2-15",
        "With the longer cables a faster forcing makes the body hit the boundaries less often.",
        impact_rates()?,
        "Impacts do not get rarer. A faster force moves the body less, as f_o/Ω², which explains a \
         higher critical force more simply.",
    ));
    all.push(judged(
        "6.4.2-16",
        "The curves of critical force have local maxima and minima.",
        local_extremes(study)?,
        "The extremes of the curves are not the same for all neighbouring starts.",
    ));
    Ok(all)
}

fn trends(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let one = |id, claim, key: &str, r: f64, sign: f64| -> Result<Claim, CaseError> {
        let least = if key == "e" { 0.8 } else { 0.5 };
        let found = study.curves.iter().find(|c| c.key == key && c.r == r);
        let finding = match found {
            Some(curve) => trend(curve, sign, least)?,
            None => (Verdict::NotReproduced, "no such curve".to_owned()),
        };
        Ok(judged(id, claim, finding, "The curve has no such trend."))
    };
    Ok(vec![
        one(
            "6.4.2-11",
            "Fig 6.27: the critical force falls with e at r = 1.5.",
            "e",
            1.5,
            -1.0,
        )?,
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

/// The part of a curve that the chapter draws.
fn drawn(curve: &CriticalCurve, reading: Reading) -> Vec<(f64, f64)> {
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

fn trend(curve: &CriticalCurve, sign: f64, least: f64) -> Result<Finding, CaseError> {
    let own = drawn(curve, Reading::Chapter);
    let coarse: Vec<f64> = own.iter().step_by(5).map(|p| p.0).collect();
    let members = neighbours(curve, &coarse)?;
    let mut all = vec![own, drawn(curve, Reading::SlidingOn)];
    all.extend(members);
    let ends = |points: &[(f64, f64)]| match (points.first(), points.last()) {
        (Some(first), Some(last)) => [first.1, last.1],
        _ => [NEVER; 2],
    };
    let holds = |points: &Vec<(f64, f64)>| {
        let [first, last] = ends(points);
        sign * spearman(points) >= least && sign * (last - first) > 0.0
    };
    let ranks: Vec<String> = all.iter().map(|p| format!("{:.2}", spearman(p))).collect();
    let [first, last] = ends(&all[0]).map(shown);
    let ranks = ranks.join(", ");
    let evidence =
        format!("{first} at the left end, {last} at the right; rank correlations {ranks}");
    Ok((robust(all.iter().map(holds)), evidence))
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
        ensemble(&Reading::Chapter.apply(parameters), NEIGHBOURS[1])
    };
    let cases: Vec<(f64, Parameters)> = (1..=NEIGHBOURS[1])
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

fn impact_rates() -> Result<Finding, CaseError> {
    let mut correlations = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.09, 0.05] {
        let case = |k: u32| {
            let omega = 0.5 + 0.075 * f64::from(k);
            let standard = Parameters::STANDARD;
            Reading::Chapter.apply(Parameters {
                r: 2.5,
                f_o,
                omega,
                ..standard
            })
        };
        let cases: Vec<Parameters> = (0..=20).map(case).collect();
        let rate = |(case, run): (&Parameters, &snapload::Trajectory)| {
            let until = run.end().t.min(5.0);
            let count = run
                .impacts()
                .iter()
                .filter(|i| is_clear(i) && i.t <= until)
                .count();
            (case.omega, count as f64 / until)
        };
        let runs = run_all(&cases)?;
        let rates: Vec<(f64, f64)> = cases.iter().zip(&runs).map(rate).collect();
        let rho = spearman(&rates);
        texts.push(format!("{rho:+.2} at f_o = {f_o}"));
        correlations.push(rho);
    }
    let verdict = if correlations.iter().all(|rho| *rho <= -0.5) {
        Verdict::Reproduced
    } else if correlations.iter().all(|rho| *rho > 0.0) {
        Verdict::NotReproduced
    } else {
        Verdict::NotDecidable
    };
    Ok((
        verdict,
        format!(
            "rank correlation of the rate of impacts with Ω: {}",
            texts.join(", ")
        ),
    ))
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
    let mut points = drawn(curve, Reading::Chapter);
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
            return Ok((Verdict::NotReproduced, format!("no {name}")));
        };
        let members = neighbours(clearest.curve, &clearest.points.map(|p| p.0))?;
        verdicts.push(robust(
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
    let both = verdicts.iter().all(|v| *v == Verdict::Reproduced);
    let verdict = if both {
        Verdict::Reproduced
    } else {
        Verdict::NotDecidable
    };
    Ok((verdict, texts.join("; ")))
}
