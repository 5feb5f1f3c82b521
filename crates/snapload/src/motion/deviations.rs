//! Deviations side by side along taut motion, and the matrix A of ẇ = A w.

/// Deviations at one time, as columns; two columns are unused.
pub(super) type Columns = [[f64; 8]; 6];

/// A w, where the upper rows of A say that positions change at the velocities.
#[inline(always)]
pub(super) fn change(lower: &[[f64; 6]; 3], w: &Columns) -> Columns {
    let mut changed = [[0.0; 8]; 6];
    let (positions, velocities) = changed.split_at_mut(3);
    positions.copy_from_slice(&w[3..]);
    for (velocity, slopes) in velocities.iter_mut().zip(lower) {
        for (slope, row) in slopes.iter().zip(w) {
            for (sum, entry) in velocity.iter_mut().zip(row) {
                *sum += slope * entry;
            }
        }
    }
    changed
}

/// A between the substeps, from four values of it.
#[inline(always)]
pub(super) fn cubic(nodes: &[[[f64; 6]; 3]; 4], weights: [f64; 4]) -> [[f64; 6]; 3] {
    let mut sum = [[0.0; 6]; 3];
    for (node, weight) in nodes.iter().zip(weights) {
        for (sum, row) in sum.iter_mut().zip(node) {
            for (sum, entry) in sum.iter_mut().zip(row) {
                *sum += weight * entry;
            }
        }
    }
    sum
}

/// w + h k.
#[inline(always)]
pub(super) fn plus(w: &Columns, k: &Columns, h: f64) -> Columns {
    let mut sum = *w;
    for (row, more) in sum.iter_mut().zip(k) {
        for (entry, more) in row.iter_mut().zip(more) {
            *entry += h * more;
        }
    }
    sum
}

/// A bound on the rate at which deviations oscillate or decay \[1/T\]: from the accelerations per
/// unit of position and per unit of velocity, with θ in units in which the inertia is 1.
#[inline(always)]
pub(super) fn pace_of_deviations(lower: &[[f64; 6]; 3], inertia: f64) -> f64 {
    let turn = if inertia > 0.0 { inertia.sqrt() } else { 1.0 };
    let units = [1.0, 1.0, turn];
    let [mut by_position, mut by_velocity] = [0.0; 2];
    for (row, unit) in lower.iter().zip(units) {
        for j in 0..3 {
            by_position += (row[j] * unit / units[j]).powi(2);
            by_velocity += (row[j + 3] * unit / units[j]).powi(2);
        }
    }
    by_position.sqrt().sqrt() + by_velocity.sqrt()
}

#[inline(always)]
pub(super) fn identity() -> Columns {
    let mut columns = [[0.0; 8]; 6];
    for (i, row) in columns.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    columns
}
