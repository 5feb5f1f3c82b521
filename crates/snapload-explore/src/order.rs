//! The order in which the cells of a map are computed: coarse first.

/// The distances between the cells of the passes.
const PASSES: [usize; 4] = [8, 4, 2, 1];

/// The indices of the cells, x fastest: every eighth row and column first, then those between.
pub(crate) fn coarse_first(columns: usize, rows: usize) -> Vec<usize> {
    let mut order = Vec::with_capacity(columns * rows);
    for (pass, distance) in PASSES.into_iter().enumerate() {
        for row in (0..rows).step_by(distance) {
            for column in (0..columns).step_by(distance) {
                let known =
                    |before: &usize| row.is_multiple_of(*before) && column.is_multiple_of(*before);
                if !PASSES[..pass].iter().any(known) {
                    order.push(row * columns + column);
                }
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::coarse_first;

    #[test]
    fn every_cell_comes_once_the_corner_first() {
        for (columns, rows) in [(1, 1), (3, 2), (8, 8), (17, 9), (200, 199)] {
            let mut order = coarse_first(columns, rows);
            assert_eq!(order[0], 0);
            let coarse = columns.div_ceil(8) * rows.div_ceil(8);
            let eighth = |cell: &usize| {
                (cell % columns).is_multiple_of(8) && (cell / columns).is_multiple_of(8)
            };
            assert!(order[..coarse].iter().all(eighth));
            order.sort_unstable();
            assert!(order.into_iter().eq(0..columns * rows));
        }
    }
}
