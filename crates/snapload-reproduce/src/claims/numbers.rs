//! Small statistics, and numbers in words.

/// Spearman's rank correlation; ties share their mean rank.
pub(super) fn spearman(points: &[(f64, f64)]) -> f64 {
    let ranks = |values: Vec<f64>| -> Vec<f64> {
        let rank = |v: &f64| {
            let below = values.iter().filter(|w| *w < v).count() as f64;
            let equal = values.iter().filter(|w| *w == v).count() as f64;
            below + 0.5 * (equal + 1.0)
        };
        values.iter().map(rank).collect()
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

/// Mean and standard deviation; zero for no values.
pub(super) fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let mean = mean(values.iter().copied());
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (square / values.len().max(1) as f64).sqrt())
}

/// Mean of values; 0 for none.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The number of items for which a statement holds.
pub(super) fn count<T>(of: &[T], holds: impl Fn(&T) -> bool) -> usize {
    of.iter().filter(|one| holds(one)).count()
}

/// The mean of the marked values divided by the mean of the others.
pub(super) fn marked_over_others(values: impl IntoIterator<Item = (bool, f64)>) -> f64 {
    let values: Vec<(bool, f64)> = values.into_iter().collect();
    let of = |marked| mean(values.iter().filter(|v| v.0 == marked).map(|v| v.1));
    of(true) / of(false)
}

/// The least value; infinity for none.
pub(super) fn min(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// The greatest value; minus infinity for none.
pub(super) fn max(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Whether each value is above the one before it; fewer than two values show nothing.
pub(super) fn rising(values: &[f64]) -> bool {
    values.len() > 1 && values.windows(2).all(|pair| pair[0] < pair[1])
}

/// Whether each value is below the one before it.
pub(super) fn falling(values: &[f64]) -> bool {
    values.len() > 1 && values.windows(2).all(|pair| pair[0] > pair[1])
}

/// Values as a list in words.
pub(super) fn list(values: &[f64], digits: usize) -> String {
    let words: Vec<String> = values.iter().map(|v| format!("{v:.digits$}")).collect();
    words.join(", ")
}

/// The least and the greatest value in words; a single number if both read the same.
pub(super) fn span(values: impl IntoIterator<Item = f64>, digits: usize) -> String {
    between(values, |v| format!("{v:.digits$}"))
}

/// The same, with each number formatted by a function.
pub(super) fn between(
    values: impl IntoIterator<Item = f64>,
    written: impl Fn(f64) -> String,
) -> String {
    let values: Vec<f64> = values.into_iter().collect();
    let low = written(min(values.iter().copied()));
    let high = written(max(values));
    if low == high {
        low
    } else {
        format!("{low} to {high}")
    }
}

/// Residuals below this are only rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

/// Whether an identity with this residual holds.
pub(super) fn holds(residual: f64) -> bool {
    residual < ROUNDING
}

/// A residual in words: the power of ten if it is rounding, and otherwise its value.
pub(super) fn residual(residual: f64) -> String {
    if !holds(residual) {
        return format!("{residual:.2}");
    }
    let mut bound = ROUNDING;
    let mut decade = 9;
    while decade < 16 && residual < bound / 10.0 {
        bound /= 10.0;
        decade += 1;
    }
    format!("below 1e-{decade}")
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
    fn numbers_are_written_as_text() {
        assert_eq!(list(&[1.0, 0.25], 1), "1.0, 0.2");
        assert_eq!(span([0.31, 0.3, 0.33], 2), "0.30 to 0.33");
        assert_eq!(span([0.311, 0.312], 2), "0.31");
        assert_eq!([3e-12, 0.25].map(residual), ["below 1e-11", "0.25"]);
        let (mean, deviation) = mean_and_deviation(&[1.0, 3.0]);
        assert_eq!((mean, deviation), (2.0, 1.0));
    }
}
