//! What several claims need.

use super::Verdict;
use snapload::Parameters;

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
