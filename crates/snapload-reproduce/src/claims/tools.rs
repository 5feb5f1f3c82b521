//! What several claims need.

use super::{Claim, Verdict};
use rayon::prelude::*;
use snapload::analysis::{ForceScan, Outcome};
use snapload::{Case, CaseError, Impact, Parameters, Stop, Trajectory};

/// How far the neighbours of a start are from it.
const NEAR: f64 = 1e-12;

/// Directions in x, y and θ in which the neighbours lie.
const DIRECTIONS: [[f64; 3]; 8] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [-1.0, -1.0, 1.0],
];

/// The case itself and up to eight `neighbours`, started 1e-12 away in directions that are always the
/// same.
pub fn ensemble(parameters: &Parameters, neighbours: usize) -> Vec<Parameters> {
    let near = DIRECTIONS
        .iter()
        .take(neighbours)
        .map(|[x, y, theta]| Parameters {
            x: parameters.x + NEAR * x,
            y: parameters.y + NEAR * y,
            theta: parameters.theta + NEAR * theta,
            ..*parameters
        });
    std::iter::once(*parameters).chain(near).collect()
}

/// The verdict on a statement that holds for some members of an ensemble: all, none, or neither.
pub fn robust(members: impl IntoIterator<Item = bool>) -> Verdict {
    let (mut yes, mut no) = (false, false);
    for holds in members {
        yes |= holds;
        no |= !holds;
    }
    match (yes, no) {
        (true, false) => Verdict::Reproduced,
        (true, true) => Verdict::NotDecidable,
        _ => Verdict::NotReproduced,
    }
}

/// Spearman's rank correlation; ties share their mean rank.
pub fn spearman(points: &[(f64, f64)]) -> f64 {
    let ranks = |values: Vec<f64>| -> Vec<f64> {
        values
            .iter()
            .map(|v| {
                let below = values.iter().filter(|w| *w < v).count() as f64;
                let equal = values.iter().filter(|w| *w == v).count() as f64;
                below + 0.5 * (equal + 1.0)
            })
            .collect()
    };
    let x = ranks(points.iter().map(|p| p.0).collect());
    let y = ranks(points.iter().map(|p| p.1).collect());
    let mean = (points.len() as f64 + 1.0) / 2.0;
    let sum = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).map(|(p, q)| (p - mean) * (q - mean)).sum()
    };
    let scale = (sum(&x, &x) * sum(&y, &y)).sqrt();
    if scale > 0.0 {
        sum(&x, &y) / scale
    } else {
        0.0
    }
}

/// What the computation says, and the figures behind it.
pub(super) type Finding = (Verdict, String);

/// A claim with what was found; its section is the head of its id, and the remark stands only where the
/// computation disagrees.
pub(super) fn claim(
    id: &'static str,
    claim: &'static str,
    verdict: Verdict,
    evidence: String,
    remark: &'static str,
) -> Claim {
    let agrees = verdict == Verdict::Reproduced;
    Claim {
        id,
        section: id.rsplit_once('-').map_or(id, |(section, _)| section),
        claim,
        verdict,
        evidence,
        remark: if agrees { "" } else { remark },
    }
}

/// The same of a finding.
pub(super) fn judged(
    id: &'static str,
    text: &'static str,
    (verdict, evidence): Finding,
    remark: &'static str,
) -> Claim {
    claim(id, text, verdict, evidence, remark)
}

/// The runs of many cases, in their order.
pub(super) fn run_all(cases: &[Parameters]) -> Result<Vec<Trajectory>, CaseError> {
    cases
        .par_iter()
        .map(|parameters| Ok(Case::new(*parameters)?.run()))
        .collect()
}

/// The first force amplitude of a scan that exceeds, with the reason; nothing beyond it is run.
pub(super) fn first_exceeding(
    parameters: &Parameters,
    scan: ForceScan,
) -> Result<Option<(f64, Stop)>, CaseError> {
    for f_o in scan.amplitudes() {
        let outcome = Outcome::of(&Case::new(Parameters { f_o, ..*parameters })?);
        if outcome.exceeds() {
            return Ok(Some((f_o, outcome.end.reason)));
        }
    }
    Ok(None)
}

/// Whether an impact is one that a reader of a printed plot can see.
pub(super) fn is_clear(impact: &Impact) -> bool {
    impact.v_n > 1e-2
}

/// Mean and standard deviation; zero of nothing.
pub(super) fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    (mean, square.sqrt())
}

/// The least and the greatest value.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values
        .into_iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_correlate() {
        assert_eq!(spearman(&[(1.0, 2.0), (2.0, 5.0), (3.0, 9.0)]), 1.0);
        assert_eq!(spearman(&[(1.0, 9.0), (2.0, 5.0), (3.0, 2.0)]), -1.0);
        assert_eq!(spearman(&[(1.0, 1.0), (2.0, 1.0)]), 0.0);
    }

    #[test]
    fn neighbours_are_near_and_differ() {
        let all = ensemble(&Parameters::STANDARD, 8);
        assert_eq!((all.len(), all[0]), (9, Parameters::STANDARD));
        for (k, member) in all.iter().enumerate() {
            assert!(all[..k].iter().all(|other| other != member));
            assert!((member.y - 0.1).abs() <= 1.1 * NEAR);
        }
        assert_eq!(robust([true, true]), Verdict::Reproduced);
        assert_eq!(robust([true, false]), Verdict::NotDecidable);
        assert_eq!(robust([false]), Verdict::NotReproduced);
    }
}
