//! Sorted values, and their quantiles.

/// The values sorted in rising order.
pub(crate) fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The value below which this part of the sorted values lies.
pub fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let at = part.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(last);
    Some(sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64))
}

/// The part of sorted tensions in which the line is slack.
pub(crate) fn slack_part(sorted_n: &[f64]) -> f64 {
    let slack = sorted_n.partition_point(|tension| *tension <= 0.0);
    slack as f64 / sorted_n.len().max(1) as f64
}
