//! Small statistics, and numbers in words.

/// Spearman's rank correlation; ties share their mean rank.
pub(super) fn spearman(points: &[(f64, f64)]) -> f64 {
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

/// Mean and standard deviation; zero of nothing.
pub(super) fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let mean = mean(values.iter().copied());
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (square / values.len().max(1) as f64).sqrt())
}

/// Mean of values; 0 of none.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The least and the greatest value.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .into_iter()
        .fold(start, |(low, high), v| (low.min(v), high.max(v)))
}

/// Whether each value is above the one before it; of fewer than two there is nothing to say.
pub(super) fn rising(values: &[f64]) -> bool {
    let up = |pair: &[f64]| matches!(pair, [a, b] if a < b);
    values.len() > 1 && values.windows(2).all(up)
}

/// Whether each value is below the one before it.
pub(super) fn falling(values: &[f64]) -> bool {
    let down = |pair: &[f64]| matches!(pair, [a, b] if a > b);
    values.len() > 1 && values.windows(2).all(down)
}

/// Values as a list in words.
pub(super) fn list(values: &[f64], digits: usize) -> String {
    let words: Vec<String> = values.iter().map(|v| format!("{v:.digits$}")).collect();
    words.join(", ")
}

/// The least and the greatest value in words; one number where they read the same.
pub(super) fn span(values: impl IntoIterator<Item = f64>, digits: usize) -> String {
    let (low, high) = range(values);
    let [low, high] = [low, high].map(|v| format!("{v:.digits$}"));
    if low == high {
        low
    } else {
        format!("{low} to {high}")
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
    fn a_trend_turned_round_is_none() {
        let (up, level) = ([1.0, 2.0, 4.0], [1.0, 2.0, 2.0]);
        let down: Vec<f64> = up.iter().rev().copied().collect();
        assert!(rising(&up) && !rising(&down) && !rising(&level));
        assert!(falling(&down) && !falling(&up) && !falling(&level));
        assert!(!rising(&[1.0]) && !falling(&[]));
    }

    #[test]
    fn numbers_are_told_in_words() {
        assert_eq!(list(&[1.0, 0.25], 1), "1.0, 0.2");
        assert_eq!(span([0.31, 0.3, 0.33], 2), "0.30 to 0.33");
        assert_eq!(span([0.311, 0.312], 2), "0.31");
        let (mean, deviation) = mean_and_deviation(&[1.0, 3.0]);
        assert_eq!((mean, deviation), (2.0, 1.0));
    }
}
